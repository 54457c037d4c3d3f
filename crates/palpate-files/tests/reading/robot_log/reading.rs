//! What is in a log, in every way in which it may be written.

use mcap::WriteOptions;
use palpate_files::{
    input::Input,
    naming::Quantity,
    open::Format,
    record::{ColumnError, ReadError, Role},
    table::ColumnKind,
};

use super::{
    names, opened, record, values,
    writing::{Cdr, Log, Packing, START, force_at, gripper, joint_state, wrench},
};

const STATED: &str = r#"
    columns.displacement = { column = "/joint_states.position[finger]", unit = "m" }
    columns.force.column = "/ft.wrench.force.z"
"#;

#[test]
fn topics_become_columns_with_clocks() {
    let contents = opened(&gripper(Log::chunked()));
    assert_eq!(contents.format, Format::RobotLog);
    let part = &contents.parts[0];
    let expected = [
        "/joint_states time",
        "/joint_states log time",
        "/joint_states.position[arm]",
        "/joint_states.position[finger]",
        "/joint_states.effort[arm]",
        "/joint_states.effort[finger]",
        "/ft time",
        "/ft log time",
        "/ft.wrench.force.x",
    ];
    assert_eq!(names(&contents)[..9], expected);
    assert_eq!(part.columns.len(), 14);
    // The effort is NaN throughout: nothing.
    assert_eq!((part.columns[4].kind, part.columns[3].kind), (ColumnKind::Empty, ColumnKind::Number));
    let units: Vec<Option<&str>> = part.columns.iter().map(|column| column.unit.as_deref()).collect();
    assert_eq!((units[3], units[10], units[13]), (None, Some("N"), Some("N m")));
    assert_eq!(part.clock_of(4).map(|clock| clock.column), Some(1));
    assert_eq!(part.clock_of(9).map(|clock| clock.column), Some(7));
    assert!(part.clock_of(7).is_none());
    assert_eq!(part.written, "MCAP of ros2, 150 messages, 2 topics with numbers");
    assert_eq!(part.metadata[0].value, "1724504945.200464400");
    assert!(part.metadata[1].value.contains("50 messages, times of its headers"), "{:?}", part.metadata);
    // The stamps are 1 ms before what was written down first; times of the log are not.
    assert_eq!(values(&contents, "/joint_states time")[..2], [-0.001, 0.019]);
    assert_eq!(values(&contents, "/joint_states log time")[..2], [0.0, 0.02]);
    let read = contents.read(0, &[9, 4, 7, 9], &mut |_, _| Ok(())).unwrap();
    let lengths: Vec<usize> = read.values.iter().map(Vec::len).collect();
    assert_eq!((lengths.as_slice(), read.rows()), ([100, 50, 100, 100].as_slice(), 100));
    assert_eq!(read.values[0], read.values[3]);
}

#[test]
fn a_record_is_made_of_two_topics() {
    let file = record(&gripper(Log::chunked()), STATED).unwrap();
    let roles: Vec<Role> = file.columns.iter().map(|column| column.role).collect();
    let [displacement, force] = [Quantity::Displacement, Quantity::Force];
    let clocks = [Role::ClockOf(displacement), Role::ClockOf(force)];
    assert_eq!(roles, [clocks[0], clocks[1], Role::Values(displacement), Role::Values(force)]);
    // The joints were stamped first 1 ms after the force and last 9 ms before its end.
    assert_eq!(file.record.len(), 98);
    let travel = file.record.displacement().unwrap();
    for (index, step) in (1..99).enumerate() {
        assert!((file.record.time()[index] - (0.01 * step as f64 - 0.002)).abs() < 1e-12);
        assert_eq!(file.record.force()[index], force_at(step));
        let ramp = (0.01 * (0.01 * step as f64 - 0.001)).min(0.004);
        assert!((travel[index] - ramp).abs() < 1.1e-5, "{step}: {} {ramp}", travel[index]);
    }
}

#[test]
fn every_way_to_write_it_gives_the_same() {
    let plain = record(&gripper(Log::chunked()), STATED).unwrap().record;
    let chunked = || WriteOptions::new().chunk_size(Some(1500));
    let ways = [
        ("zstd", Log::chunked().packed(Packing::Zstd)),
        ("lz4", Log::chunked().packed(Packing::Lz4)),
        ("one chunk", Log::new(WriteOptions::new()).packed(Packing::Zstd)),
        ("no chunks", Log::new(WriteOptions::new().use_chunks(false))),
        ("no summary", Log::new(chunked().emit_summary_records(false).emit_summary_offsets(false))),
        ("no index", Log::new(chunked().emit_message_indexes(false).emit_chunk_indexes(false))),
        ("no checksums", Log::new(chunked().calculate_chunk_crcs(false).calculate_data_section_crc(false))),
    ];
    for (way, log) in ways {
        assert_eq!(record(&gripper(log), STATED).unwrap().record, plain, "{way}");
    }
}

#[test]
fn a_packed_log_is_unpacked() {
    use std::io::Write;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&gripper(Log::chunked())).unwrap();
    let input = Input::from_bytes("log.mcap.gz", packer.finish().unwrap()).unwrap();
    let contents = palpate_files::open::Contents::of(input, &Default::default()).unwrap();
    assert_eq!(contents.format, Format::RobotLog);
}

#[test]
fn a_field_may_be_named_without_its_topic_and_needs_no_name_if_it_is_alone() {
    let log = gripper(Log::chunked());
    let short = r#"
        columns.displacement = { column = "position[finger]", unit = "m" }
        columns.force.column = "wrench.force.z"
    "#;
    assert_eq!(record(&log, short).unwrap().record, record(&log, STATED).unwrap().record);
    let error = record(&log, "columns.displacement = { column = \"position[finger]\", unit = \"m\" }").unwrap_err();
    let text = error.to_string();
    assert!(text.contains("expected one column of force, found column 9 (/ft.wrench.force.x) and"), "{text}");

    let mut log = Log::chunked()
        .topic("/gripper/force", "cdr", ("std_msgs/msg/Float32", "ros2msg", "float32 data\n"))
        .topic("/gripper/target_force", "cdr", ("std_msgs/msg/Float32", "ros2msg", "float32 data\n"))
        .joints("/joint_states");
    for step in 0..20 {
        let time = START + step * 1_000_000;
        log.say("/gripper/force", time, &Cdr::new(true).f32(step as f32).bytes());
        log.say("/gripper/target_force", time, &Cdr::new(true).f32(5.0).bytes());
        log.say("/joint_states", time, &joint_state(time, &[("f", 0.001 * step as f64)], f64::NAN));
    }
    let units = "columns.force.unit = \"N\"\ncolumns.displacement.unit = \"m\"";
    let file = record(&log.finish(), units).unwrap();
    let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
    let clocks = ["/joint_states time", "/gripper/force log time"];
    assert_eq!(used[..1], clocks[..1]);
    assert_eq!(used[2..], ["/joint_states.position[f]", "/gripper/force.data"]);
    assert_eq!(file.record.force()[19], 19.0);
}

#[test]
fn messages_without_stamps_take_the_time_of_the_log() {
    let mut log = Log::chunked().wrenches("/ft").wrenches("/sometimes");
    for step in 0..4_u64 {
        let time = START + step * 500_000_000;
        log.say("/ft", time, &wrench(false, 0, step as f64));
        log.say("/sometimes", time, &wrench(false, if step == 2 { 0 } else { time - 1000 }, 1.0));
    }
    let contents = opened(&log.finish());
    assert_eq!(names(&contents).iter().filter(|name| name.ends_with("time")).count(), 2);
    for topic in ["/ft time", "/sometimes time"] {
        assert_eq!(values(&contents, topic), [0.0, 0.5, 1.0, 1.5]);
    }
    // Written most significant byte first.
    assert_eq!(values(&contents, "/ft.wrench.force.z"), [0.0, 1.0, 2.0, 3.0]);
    assert!(contents.parts[0].metadata[1].value.ends_with("times of the log"));
}

#[test]
fn two_drivers_on_one_topic_are_two_clocks() {
    let mut log = Log::chunked().joints("/joint_states");
    for step in 0..6_u64 {
        let time = START + step * 1_000_000;
        let value = step as f64;
        let joints: &[(&str, f64)] = match step % 3 {
            0 => &[("arm", value)],
            1 => &[("left", value), ("right", -value)],
            _ => &[("right", -value), ("left", value)],
        };
        log.say("/joint_states", time, &joint_state(time, joints, 0.0));
    }
    let contents = opened(&log.finish());
    assert_eq!(values(&contents, "position[arm]"), [0.0, 3.0]);
    // The order of the joints does not matter.
    assert_eq!(values(&contents, "position[left]"), [1.0, 2.0, 4.0, 5.0]);
    assert_eq!(values(&contents, "position[right]"), [-1.0, -2.0, -4.0, -5.0]);
    assert_eq!(values(&contents, "/joint_states time (2)"), [0.001, 0.002, 0.004, 0.005]);
}

#[test]
fn json_is_read_like_cdr() {
    let schema = ("sensor_msgs/JointState", "jsonschema", "{}");
    let force = ("geometry_msgs/Wrench", "jsonschema", "{}");
    let mut log = Log::chunked().packed(Packing::Lz4).topic("/joints", "json", schema).topic("/ft", "json", force);
    for step in 0..10_u64 {
        let time = START + step * 10_000_000;
        let stamp = format!("{{\"sec\":{},\"nanosec\":{}}}", time / 1_000_000_000, time % 1_000_000_000);
        let state = format!(
            "{{\"header\":{{\"stamp\":{stamp},\"frame_id\":\"\"}},\"name\":[\"l\",\"r\"],\"position\":[{step},0.5],\"effort\":[null,null]}}"
        );
        log.say("/joints", time + 7, state.as_bytes());
        log.say("/ft", time, format!("{{\"force\":{{\"x\":0,\"y\":0,\"z\":{step}.25}}}}").as_bytes());
    }
    let contents = opened(&log.finish());
    assert_eq!(values(&contents, "position[l]"), (0..10).map(f64::from).collect::<Vec<_>>());
    assert_eq!(values(&contents, "/joints time")[..3], [0.0, 0.01, 0.02]);
    let force = contents.parts[0].column_named("/ft.force.z").unwrap();
    assert_eq!((force.unit.as_deref(), force.sample.as_str()), (Some("N"), "0.25"));
    let effort = contents.parts[0].column_named("effort[l]").unwrap();
    assert_eq!(effort.kind, ColumnKind::Empty);
}

#[test]
fn what_is_not_read_is_listed_with_why() {
    let mut log = Log::chunked()
        .wrenches("/ft")
        .topic("/proto", "protobuf", ("foxglove.Log", "protobuf", "x"))
        .topic("/idl", "cdr", ("a/msg/B", "ros2idl", "module a {};"))
        .topic("/circle", "cdr", ("a/msg/C", "ros2msg", "C c\n"))
        .topic("/lacks", "cdr", ("a/msg/D", "ros2msg", "other/Thing t\n"))
        .topic("/text", "cdr", ("std_msgs/msg/String", "ros2msg", "string data\n"))
        .topic("/short", "cdr", ("std_msgs/msg/Float64", "ros2msg", "float64 data\n"))
        .topic("/wide", "cdr", ("a/msg/E", "ros2msg", "F[64] f\n===\nMSG: a/F\nfloat32[64] x\n"));
    log.say("/ft", START, &wrench(true, START, 1.0));
    log.say("/proto", START, b"abc");
    log.say("/text", START, &Cdr::new(true).text("hello").bytes());
    log.say("/short", START, &Cdr::new(true).f64(1.0).bytes());
    log.say("/short", START, &Cdr::new(true).f32(1.0).bytes());
    log.say("/wide", START, &[&[0, 1, 0, 0][..], &[0; 64 * 64 * 4]].concat());
    let contents = opened(&log.finish());
    assert!(names(&contents).iter().all(|name| name.starts_with("/ft")));
    let skipped: Vec<String> = contents.skipped.iter().map(|part| format!("{}: {}", part.name, part.reason)).collect();
    let expected = [
        "/proto: its messages are encoded as \"protobuf\"; \"cdr\" and \"json\" are read",
        "/idl: the definition of its messages is written as \"ros2idl\"; \"ros2msg\" is read",
        "/circle: its definition has types that contain themselves",
        "/lacks: its definition lacks the type other/Thing",
        "/short: message 5 of the log, byte 4: expected 1 × 8 bytes, found 4 bytes",
        "/wide: message 6 of the log: expected at most 1024 numbers in a message, found more",
        "/text: no message of it holds a number",
    ];
    assert_eq!(skipped.len(), expected.len(), "{skipped:#?}");
    for (found, expected) in skipped.iter().zip(expected) {
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn a_log_without_numbers_is_no_test() {
    let mut log = Log::chunked().topic("/text", "cdr", ("std_msgs/msg/String", "ros2msg", "string data\n"));
    log.say("/text", START, &Cdr::new(true).text("hello").bytes());
    let error = super::look(&log.finish()).unwrap_err().to_string();
    assert_eq!(error, "log.mcap: expected a test, found none: /text: no message of it holds a number");
}

#[test]
fn a_number_that_is_none_is_refused_where_it_is_used() {
    let mut log = Log::chunked().wrenches("/ft");
    for step in 0..10 {
        let force = if step == 4 { f64::NAN } else { 1.0 };
        log.say("/ft", START + step, &wrench(true, START + step, force));
    }
    let error = record(&log.finish(), "columns.force.column = \"wrench.force.z\"").unwrap_err();
    assert!(matches!(error, ReadError::Record { .. }), "{error}");
    assert_eq!(error.to_string(), "log.mcap: force must be a finite number, found NaN in row 5");
}

#[test]
fn what_is_missing_is_answered_with_lines_that_help() {
    let mut log = Log::chunked().topic("/a", "cdr", ("x/msg/Two", "ros2msg", "float32 gap\nfloat32 grip\n"));
    for step in 0..9 {
        log.say("/a", START + step, &Cdr::new(true).f32(step as f32).f32(step as f32 + 0.5).bytes());
    }
    let log = log.finish();
    let error = record(&log, "").unwrap_err();
    assert!(
        matches!(
            &error,
            ReadError::Column {
                source: ColumnError::Missing(..),
                ..
            }
        ),
        "{error}"
    );
    let hint = error.hint().unwrap();
    let lines: Vec<&str> = hint.lines().skip(1).collect();
    assert!(lines[0] == "[columns]" && lines.len() == 3, "{hint}");
    assert!(
        lines[1].starts_with("displacement = { column = 2") && lines[2].starts_with("force = { column = 3"),
        "{hint}"
    );
    // What is proposed works as it stands.
    assert_eq!(record(&log, &lines.join("\n")).unwrap().record.len(), 9);
}

#[test]
fn columns_of_two_clocks_do_not_add_up() {
    let test = r#"
        columns.displacement = { column = "position[finger]", also = "wrench.force.x", unit = "m" }
        columns.force.column = "wrench.force.z"
    "#;
    let error = record(&gripper(Log::chunked()), test).unwrap_err();
    assert!(
        matches!(
            error,
            ReadError::Column {
                source: ColumnError::ClocksDiffer(..),
                ..
            }
        ),
        "{error}"
    );
}
