//! The messages of a log, and the definitions of their types.
//!
//! The definitions are those of `common_interfaces` and `rcl_interfaces` of ROS 2 (Jazzy), without their remarks: the message, then the types
//! that it is made of, each behind a line of `=`, as rosbag2 writes them.

/// One message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Message<'a> {
    /// `sensor_msgs/JointState` of one joint.
    JointState(JointState<'a>),
    /// `geometry_msgs/WrenchStamped`.
    Wrench(Wrench<'a>),
    /// `std_msgs/Float64`.
    Float64(f64),
    /// `std_msgs/Bool`.
    Bool(bool),
    /// `diagnostic_msgs/DiagnosticArray` of one status.
    Diagnostic(Diagnostic<'a>),
}

/// The state of one joint; a quantity that is not known is an empty array in the message, as its definition requires.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointState<'a> {
    /// Name of the joint.
    pub name: &'a str,
    /// Position, m (of a prismatic joint).
    pub position: Option<f64>,
    /// Velocity, m/s.
    pub velocity: Option<f64>,
    /// Effort, N.
    pub effort: Option<f64>,
}

/// A force without a torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench<'a> {
    /// The frame of its components.
    pub frame: &'a str,
    /// Components along x, y and z, N.
    pub force: [f64; 3],
}

/// A report on something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Diagnostic<'a> {
    /// How serious it is.
    pub level: Level,
    /// What is reported on.
    pub name: &'a str,
    /// The report.
    pub message: &'a str,
    /// Values beside it, by key.
    pub values: &'a [(String, String)],
}

/// How serious a report is, as `DiagnosticStatus` numbers it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Nothing to do.
    Ok = 0,
    /// To be observed.
    Warn = 1,
    /// A failure.
    Error = 2,
}

/// The type of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MessageType {
    /// `sensor_msgs/msg/JointState`.
    JointState,
    /// `geometry_msgs/msg/WrenchStamped`.
    WrenchStamped,
    /// `std_msgs/msg/Float64`.
    Float64,
    /// `std_msgs/msg/Bool`.
    Bool,
    /// `diagnostic_msgs/msg/DiagnosticArray`.
    DiagnosticArray,
}

impl Message<'_> {
    /// Its type.
    #[must_use]
    pub fn kind(&self) -> MessageType {
        match self {
            Self::JointState(_) => MessageType::JointState,
            Self::Wrench(_) => MessageType::WrenchStamped,
            Self::Float64(_) => MessageType::Float64,
            Self::Bool(_) => MessageType::Bool,
            Self::Diagnostic(_) => MessageType::DiagnosticArray,
        }
    }
}

/// A type that messages are made of, behind the line that separates it.
macro_rules! part {
    ($name:literal, $text:literal) => {
        concat!(
            "================================================================================\nMSG: ",
            $name,
            "\n",
            $text
        )
    };
}

/// The types that every header is made of.
macro_rules! header {
    () => {
        concat!(
            part!("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
            part!("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n")
        )
    };
}

impl MessageType {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::JointState, Self::WrenchStamped, Self::Float64, Self::Bool, Self::DiagnosticArray];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::JointState => "sensor_msgs/msg/JointState",
            Self::WrenchStamped => "geometry_msgs/msg/WrenchStamped",
            Self::Float64 => "std_msgs/msg/Float64",
            Self::Bool => "std_msgs/msg/Bool",
            Self::DiagnosticArray => "diagnostic_msgs/msg/DiagnosticArray",
        }
    }

    /// Its definition in `ros2msg`, with those of the types that it is made of.
    #[must_use]
    pub fn definition(self) -> &'static str {
        match self {
            Self::JointState => concat!(
                "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n",
                header!()
            ),
            Self::WrenchStamped => concat!(
                "std_msgs/Header header\nWrench wrench\n",
                part!("geometry_msgs/Wrench", "Vector3 force\nVector3 torque\n"),
                part!("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
                header!()
            ),
            Self::Float64 => "float64 data\n",
            Self::Bool => "bool data\n",
            Self::DiagnosticArray => concat!(
                "std_msgs/Header header\nDiagnosticStatus[] status\n",
                part!(
                    "diagnostic_msgs/DiagnosticStatus",
                    "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\nstring hardware_id\nKeyValue[] values\n"
                ),
                part!("diagnostic_msgs/KeyValue", "string key\nstring value\n"),
                header!()
            ),
        }
    }
}
