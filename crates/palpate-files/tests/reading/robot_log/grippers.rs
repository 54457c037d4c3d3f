//! Grippers whose conventions are known, in logs as their drivers write them.

use super::{
    record,
    writing::{Cdr, Log, START, joint_state, wrench},
};

const MS: u64 = 1_000_000;

/// Travel since the first sample, mm.
fn travel(log: &[u8], test: &str) -> Vec<f64> {
    let file = record(log, test).unwrap_or_else(|error| panic!("{error}"));
    let travel = file.record.displacement().expect("a record with displacement");
    travel.iter().map(|value| ((value - travel[0]) * 1e6).round() / 1e3).collect()
}

/// A log of joints and of a wrench, at the same times.
fn joints(joints_at: impl Fn(f64) -> Vec<(&'static str, f64)>) -> Vec<u8> {
    let mut log = Log::chunked().joints("/gripper/joint_states").wrenches("/ft");
    for step in 0..5_u64 {
        let time = START + step * 10 * MS;
        log.say("/gripper/joint_states", time, &joint_state(time, &joints_at(step as f64), 0.0));
        log.say("/ft", time, &wrench(true, time, step as f64));
    }
    log.finish()
}

const FORCE: &str = "\ncolumns.force.column = \"wrench.force.z\"\n";

#[test]
fn two_joints_of_half_the_width_add_up() {
    let log = joints(|step| {
        let half = 0.04 - 0.001 * step;
        vec![("panda_finger_joint1", half), ("panda_finger_joint2", half)]
    });
    let preset = format!("machine.preset = \"franka-hand\"{FORCE}");
    assert_eq!(travel(&log, &preset), [0.0, 2.0, 4.0, 6.0, 8.0]);
    let by_hand = format!(
        "columns.displacement = {{ column = \"position[panda_finger_joint1]\", unit = \"m\", sign = -1, doubled = true }}{FORCE}"
    );
    assert_eq!(travel(&log, &by_hand), [0.0, 2.0, 4.0, 6.0, 8.0]);
    let generic = format!(
        "machine.preset = \"ros2-two-fingers\"\ncolumns.displacement.column = \"position[panda_finger_joint2]\"{FORCE}"
    );
    assert_eq!(travel(&log, &generic), [0.0, 2.0, 4.0, 6.0, 8.0]);
}

#[test]
fn an_angle_becomes_a_travel() {
    let log = joints(|step| vec![("robotiq_85_left_knuckle_joint", 0.7929 * step / 4.0)]);
    let preset = format!("machine.preset = \"robotiq-2f85\"{FORCE}");
    let found = travel(&log, &preset);
    assert!((found[4] - 85.0).abs() < 0.01, "{found:?}");
    assert!((found[1] - 21.25).abs() < 0.01, "{found:?}");
}

#[test]
fn feedback_of_an_action_holds_gap_and_force() {
    let schema = "unique_identifier_msgs/UUID goal_id\nGripperCommand_Feedback feedback\n===\n\
        MSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n===\n\
        MSG: control_msgs/action/GripperCommand_Feedback\nfloat64 position\nfloat64 effort\nbool stalled\nbool reached_goal\n";
    let topic = "/gripper_controller/gripper_cmd/_action/feedback";
    let kind = "control_msgs/action/GripperCommand_FeedbackMessage";
    let mut log = Log::chunked().topic(topic, "cdr", (kind, "ros2msg", schema));
    for step in 0..4_u64 {
        let identified = (0..16).fold(Cdr::new(true), Cdr::u8);
        let message = identified.f64(0.05 - 0.002 * step as f64).f64(3.0 + step as f64).u8(0).u8(u8::from(step == 3));
        log.say(topic, START + step * 20 * MS, &message.bytes());
    }
    let log = log.finish();
    let file = record(&log, "machine.preset = \"ros2-gripper-command\"").unwrap();
    assert_eq!(file.record.force(), [3.0, 4.0, 5.0, 6.0]);
    assert_eq!(file.record.time(), [0.0, 0.02, 0.04, 0.06]);
    assert_eq!(travel(&log, "machine.preset = \"ros2-gripper-command\""), [0.0, 2.0, 4.0, 6.0]);
    // The units are those of the definition, and nothing else is called so: no description is needed but for the sign.
    assert_eq!(travel(&log, ""), [0.0, -2.0, -4.0, -6.0]);
}

#[test]
fn width_in_mm() {
    let schema = (
        "wsg_50_common/msg/Status",
        "ros2msg",
        "string status\nfloat32 width\nfloat32 speed\nfloat32 force\n",
    );
    let mut log = Log::chunked().topic("/wsg/status", "cdr", schema);
    for step in 0..4_u64 {
        let message = Cdr::new(true).text("HOLDING").f32(50.0 - step as f32).f32(0.0).f32(7.5 + step as f32);
        log.say("/wsg/status", START + step * 20 * MS, &message.bytes());
    }
    let test = "machine.preset = \"wsg-50\"\ncolumns.force.unit = \"N\"";
    assert_eq!(travel(&log.finish(), test), [0.0, 1.0, 2.0, 3.0]);
}
