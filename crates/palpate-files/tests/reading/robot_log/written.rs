//! Logs that palpate writes, read back: to the last bit, whatever their values and length.

use std::io::{self, Write};

use palpate_files::{
    message_log::{Diagnostic, JointState, Level, LogClock, LogError, LogWriter, Message, MessageType, Wrench},
    naming::own_topics::{DIAGNOSTICS, FINGER, FRAME, JOINT_STATES, WRENCH},
};

use super::{look, names, opened, record, values};

/// Values that decimal texts easily change.
const VALUES: [f64; 8] =
    [0.1, -1.0 / 3.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, -f64::EPSILON, 1e22, std::f64::consts::PI];

/// Values that a machine may measure.
const CALM: [f64; 8] = [
    0.1,
    -1.0 / 3.0,
    2.0 / 7.0,
    0.7,
    std::f64::consts::FRAC_1_PI,
    -f64::EPSILON,
    1.1,
    std::f64::consts::PI,
];

/// A log of so many samples at 100 Hz from a time on, s; displacements are half of `VALUES` in turn, forces those three places on.
fn log(count: usize, first: f64) -> Vec<u8> {
    log_of(&VALUES, count, first)
}

fn log_of(values: &[f64; 8], count: usize, first: f64) -> Vec<u8> {
    written(values, count, first).expect("a log in memory")
}

fn written(values: &[f64; 8], count: usize, first: f64) -> Result<Vec<u8>, LogError> {
    let clock = LogClock::beginning_at(first);
    let mut log = LogWriter::new(Vec::new(), &[("content", "a test")])?;
    log.declare(JOINT_STATES, MessageType::JointState)?;
    log.declare("/palpate/excess_strain", MessageType::Float64)?;
    for index in 0..count {
        let stamp = clock.stamp(first + index as f64 / 100.0)?;
        let (displacement, force) = (values[index % 8] / 2.0, values[(index + 3) % 8]);
        let state = JointState {
            name: FINGER,
            position: Some(displacement),
            velocity: None,
            effort: Some(force),
        };
        log.write(JOINT_STATES, stamp, &Message::JointState(state))?;
        let wrench = Wrench {
            frame: FRAME,
            force: [0.0, 0.0, force],
        };
        log.write(WRENCH, stamp, &Message::Wrench(wrench))?;
        log.write("/palpate/excess_strain", stamp, &Message::Float64(-displacement))?;
        log.write("/palpate/in_contact", stamp, &Message::Bool(index % 2 == 0))?;
        if index % 5 == 0 {
            let diagnostic = Diagnostic {
                level: Level::Warn,
                name: "palpate: contact",
                message: "slip soon",
                values: &[("time_to_slip_s".to_owned(), "0.5".to_owned())],
            };
            log.write(DIAGNOSTICS, stamp, &Message::Diagnostic(diagnostic))?;
        }
    }
    log.finish()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn every_number_comes_back_to_the_bit() {
    let bytes = log(40, 0.0);
    let contents = opened(&bytes);
    assert!(contents.skipped.is_empty(), "{:?}", contents.skipped);
    let expected = |shift: usize, scale: f64| (0..40).map(|i| scale * VALUES[(i + shift) % 8]).collect::<Vec<_>>();
    for (name, shift, scale) in [
        ("/palpate/joint_states.position[finger]", 0, 0.5),
        ("/palpate/joint_states.effort[finger]", 3, 1.0),
        ("/palpate/wrench.wrench.force.z", 3, 1.0),
        ("/palpate/excess_strain.data", 0, -0.5),
    ] {
        assert_eq!(bits(&values(&contents, name)), bits(&expected(shift, scale)), "{name}");
    }
    assert_eq!(values(&contents, "/palpate/in_contact.data")[..3], [1.0, 0.0, 1.0]);
    assert_eq!(values(&contents, "/palpate/diagnostics.status[0].level"), [1.0; 8]);
    assert!(
        names(&contents).iter().all(|name| !name.contains("velocity")),
        "an unknown velocity is an empty array"
    );
    // The stamps are those of the record to the nanosecond, from the first message on.
    let time: Vec<f64> = (0..40).map(|i| f64::from(i) / 100.0).collect();
    assert_eq!(values(&contents, "/palpate/joint_states time"), time);
    assert_eq!(values(&contents, "/palpate/excess_strain time"), time);
    let part = &contents.parts[0];
    assert!(part.written.starts_with("MCAP of ros2, "), "{}", part.written);
    assert_eq!(part.metadata[0].value, "1.000000000");
}

#[test]
fn a_record_needs_no_description() {
    for first in [0.0, -0.25, 100.0] {
        let file = record(&log_of(&CALM, 40, first), "").unwrap();
        let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
        assert_eq!(used[2..], ["/palpate/joint_states.position[finger]", "/palpate/wrench.wrench.force.z"]);
        let time: Vec<f64> = (0..40).map(|i| f64::from(i) / 100.0).collect();
        assert_eq!(file.record.time(), time, "{first}");
        assert_eq!(bits(file.record.force()), bits(&(0..40).map(|i| CALM[(i + 3) % 8]).collect::<Vec<_>>()));
    }
}

#[test]
fn the_same_messages_give_the_same_bytes_in_chunks_of_a_mebibyte() {
    let long = log(12_000, 0.0);
    assert!(long == log(12_000, 0.0));
    // 12,000 samples of about 420 bytes, in chunks and uncompressed.
    assert!((4_000_000..8_000_000).contains(&long.len()), "{} bytes", long.len());
    let contents = opened(&long);
    assert_eq!(values(&contents, "/palpate/wrench.wrench.force.z").len(), 12_000);
    let summary = mcap::Summary::read(&long).unwrap().unwrap();
    assert!(summary.chunk_indexes.len() > 3 && summary.chunk_indexes.iter().all(|chunk| chunk.compression.is_empty()));
    let statistics = summary.stats.unwrap();
    assert_eq!((statistics.message_count, statistics.message_start_time), (4 * 12_000 + 2400, 1_000_000_000));
    assert_eq!(statistics.message_end_time, 1_000_000_000 + 11_999 * 10_000_000);
}

#[test]
fn messages_are_those_that_the_reference_library_reads() {
    let bytes = log(3, 0.0);
    let messages: Vec<mcap::Message<'_>> = mcap::MessageStream::new(&bytes).unwrap().collect::<Result<_, _>>().unwrap();
    assert_eq!(messages.len(), 3 * 4 + 1);
    let first = &messages[0];
    assert_eq!((first.channel.topic.as_str(), first.sequence), (JOINT_STATES, 0));
    assert_eq!(first.channel.metadata["offered_qos_profiles"], "");
    let schema = first.channel.schema.as_ref().unwrap();
    assert_eq!((schema.name.as_str(), schema.encoding.as_str()), ("sensor_msgs/msg/JointState", "ros2msg"));
    assert_eq!(schema.data.as_ref(), MessageType::JointState.definition().as_bytes());
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.schemas.len(), MessageType::ALL.len());
}

#[test]
fn a_log_without_messages_is_a_log_and_no_test() {
    let bytes = log(0, 0.0);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!((summary.channels.len(), summary.stats.unwrap().message_count), (2, 0));
    let error = look(&bytes).unwrap_err().to_string();
    assert!(error.contains("expected a test, found none"), "{error}");
}

#[test]
fn cut_off_or_changed_it_is_refused() {
    let whole = log(20, 0.0);
    for length in (8..whole.len()).step_by(97) {
        assert!(look(&whole[..length]).is_err(), "{length}");
    }
    let mut changed = whole;
    let middle = changed.len() / 3;
    changed[middle] ^= 0x10;
    assert!(look(&changed).is_err());
}

/// A disk that is full after so many bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.checked_sub(bytes.len()) {
            Some(left) => {
                self.0 = left;
                Ok(bytes.len())
            }
            None => Err(io::ErrorKind::StorageFull.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_is_an_error_with_its_kind_wherever_it_happens() {
    let write = |space: usize| -> Result<(), LogError> {
        let mut log = LogWriter::new(Full(space), &[("content", "a test")])?;
        let clock = LogClock::beginning_at(0.0);
        for index in 0..60_000 {
            log.write("/palpate/strain", clock.stamp(f64::from(index) * 1e-3)?, &Message::Float64(0.5))?;
        }
        log.finish().map(drop)
    };
    write(usize::MAX).unwrap();
    for space in [0, 50, 1 << 19, 1 << 20, 3 << 19, 2 << 20, 5 << 19] {
        match write(space) {
            Err(LogError::Io(error)) => assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{space}"),
            other => panic!("{space}: {other:?}"),
        }
    }
}
