//! Units that the definitions of common messages fix.
//!
//! Sources: `geometry_msgs/Wrench` is in SI by REP 103 (ros.org/reps/rep-0103.html); `sensor_msgs/Range` says "[m]" beside its
//! field; the action `control_msgs/GripperCommand` says "gap size (in meters)" and "effort exerted (in Newtons)"
//! (docs.ros.org/en/jazzy/p/control_msgs/action/GripperCommand.html). The position and effort of a `JointState` are rad
//! and N m, or m and N, by the kind of joint, which the message does not say; they have no unit here, except in the logs that palpate
//! writes, whose topics state their units.

use super::schema::short;
use crate::naming::own_topics;

/// Type, the beginning of the field, its unit.
const UNITS: &[(&str, &str, &str)] = &[
    ("geometry_msgs/Wrench", "force.", "N"),
    ("geometry_msgs/Wrench", "torque.", "N m"),
    ("geometry_msgs/WrenchStamped", "wrench.force.", "N"),
    ("geometry_msgs/WrenchStamped", "wrench.torque.", "N m"),
    ("sensor_msgs/Range", "range", "m"),
    ("control_msgs/GripperCommand_FeedbackMessage", "feedback.position", "m"),
    ("control_msgs/GripperCommand_FeedbackMessage", "feedback.effort", "N"),
    ("control_msgs/GripperCommand_Feedback", "position", "m"),
    ("control_msgs/GripperCommand_Feedback", "effort", "N"),
    ("control_msgs/GripperCommand_Result", "position", "m"),
    ("control_msgs/GripperCommand_Result", "effort", "N"),
];

/// The unit of a field of a message of this topic and type, if its definition or the topic fixes it.
pub(super) fn unit(topic: &str, kind: &str, field: &str) -> Option<&'static str> {
    if let Some(unit) = own_topics::unit(topic, field) {
        return Some(unit);
    }
    let kind = short(kind);
    let fits = |(of, start, _): &&(&str, &str, &str)| {
        *of == kind && if start.ends_with('.') { field.starts_with(start) } else { field == *start }
    };
    UNITS.iter().find(fits).map(|(_, _, unit)| *unit)
}
