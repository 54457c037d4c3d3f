//! The topics of the logs that palpate writes: readings of the contact, and what was computed of them.
//!
//! [`JOINT_STATES`] and [`WRENCH`] are readings, which a log can be analysed by. Every other topic under [`PREFIX`] is a result: it is named
//! after its quantity, with its unit behind (`/palpate/equilibrium_force_n`), and is no measurement.

use super::{names::topic_and_field, quantity::Quantity};

/// What all of them begin with.
pub const PREFIX: &str = "/palpate/";

/// `sensor_msgs/JointState` of [`FINGER`]: displacement of the jaw (m), its velocity (m/s), the contact force (N).
pub const JOINT_STATES: &str = "/palpate/joint_states";

/// The joint of [`JOINT_STATES`].
pub const FINGER: &str = "finger";

/// `geometry_msgs/WrenchStamped`: the contact force along z, positive in compression.
pub const WRENCH: &str = "/palpate/wrench";

/// The frame of [`WRENCH`]: z points into the body.
pub const FRAME: &str = "palpate_contact";

/// `diagnostic_msgs/DiagnosticArray`: what happened.
pub const DIAGNOSTICS: &str = "/palpate/diagnostics";

/// What the column of a field of an own topic holds: a quantity of a record, or none that is measured. `None` for another column.
pub(crate) fn holds(name: &str) -> Option<Option<Quantity>> {
    let (topic, field) = topic_and_field(name).filter(|(topic, _)| topic.starts_with(PREFIX))?;
    Some(match (topic, field) {
        (JOINT_STATES, field) if field.starts_with("position[") => Some(Quantity::Displacement),
        (WRENCH, "wrench.force.z") => Some(Quantity::Force),
        _ => None,
    })
}

/// Ends of the names of topics, and their units; a longer one stands before one that it ends in.
#[cfg(feature = "robot-log")]
const SUFFIXES: [(&str, &str); 6] =
    [("_m_per_s", "m/s"), ("_per_s", "1/s"), ("_n", "N"), ("_m", "m"), ("_s", "s"), ("_j", "J")];

/// The unit of a field of an own topic.
#[cfg(feature = "robot-log")]
pub(crate) fn unit(topic: &str, field: &str) -> Option<&'static str> {
    let known = |starts: &[(&str, &'static str)]| {
        starts.iter().find(|(start, _)| field.starts_with(start)).map(|(_, unit)| *unit)
    };
    match topic {
        JOINT_STATES => known(&[("position[", "m"), ("velocity[", "m/s"), ("effort[", "N")]),
        _ if topic.starts_with(PREFIX) && field == "data" => {
            SUFFIXES.iter().find(|(end, _)| topic.ends_with(end)).map(|(_, unit)| *unit)
        }
        _ => None,
    }
}

#[cfg(all(test, feature = "robot-log"))]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_topic_states_its_unit() {
        for (topic, field, expected) in [
            (JOINT_STATES, "position[finger]", Some("m")),
            (JOINT_STATES, "effort[finger]", Some("N")),
            ("/joint_states", "position[finger]", None),
            ("/palpate/creep_rate_m_per_s", "data", Some("m/s")),
            ("/palpate/strain_rate_per_s", "data", Some("1/s")),
            ("/palpate/equilibrium_force_n", "data", Some("N")),
            ("/palpate/strain", "data", None),
            ("/gripper/force_n", "data", None),
        ] {
            assert_eq!(unit(topic, field), expected, "{topic}");
        }
    }
}
