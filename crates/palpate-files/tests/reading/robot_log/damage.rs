//! Logs that are cut off, overwritten, or lie about lengths: an answer or an error, soon, and never a panic.

use mcap::WriteOptions;
use palpate_files::{FileError, FileProblem};

use super::{
    look,
    writing::{Cdr, Log, Packing, START, gripper, joint_state, wrench},
};

/// A small log of two topics.
fn small(mut log: Log) -> Vec<u8> {
    log = log
        .joints("/joint_states")
        .topic("/f", "cdr", ("std_msgs/msg/Float64", "ros2msg", "float64 data\n"));
    for step in 0..3 {
        log.say("/joint_states", START + step, &joint_state(START + step, &[("finger", 0.5)], 1.0));
        log.say("/f", START + step, &Cdr::new(true).f64(1.5).bytes());
    }
    log.finish()
}

fn ways() -> [(&'static str, Log); 4] {
    [
        ("plain", Log::chunked()),
        ("zstd", Log::chunked().packed(Packing::Zstd)),
        ("lz4", Log::chunked().packed(Packing::Lz4)),
        ("no chunks", Log::new(WriteOptions::new().use_chunks(false))),
    ]
}

/// Looks into a log and reads all that is in it.
fn all(bytes: &[u8]) -> Result<(), FileError> {
    let contents = look(bytes)?;
    let columns: Vec<usize> = (1..=contents.parts[0].columns.len()).collect();
    contents.read(0, &columns, &mut |_, _| Ok(())).map(|_| ())
}

#[test]
fn a_log_cut_off_anywhere_is_refused_with_the_place() {
    for (way, log) in ways() {
        let whole = small(log);
        all(&whole).unwrap_or_else(|error| panic!("{way}: {error}"));
        for length in 0..whole.len() {
            assert!(all(&whole[..length]).is_err(), "{way}, {length} of {} bytes", whole.len());
        }
    }
    let whole = gripper(Log::chunked().packed(Packing::Zstd));
    let error = all(&whole[..whole.len() / 2]).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("record at byte ") && text.contains("expected a whole log"), "{text}");
    assert!(text.contains("found the end of the file"), "{text}");
    assert!(error.hint().unwrap().contains("cut off"));
}

#[test]
fn a_byte_that_is_wrong_anywhere_is_noticed() {
    for (way, log) in ways() {
        let whole = small(log);
        for place in 0..whole.len() {
            for flip in [0x01, 0x80, 0xFF] {
                let mut bytes = whole.clone();
                bytes[place] ^= flip;
                assert!(all(&bytes).is_err(), "{way}: byte {place} of {} by {flip:#x}", whole.len());
            }
        }
    }
}

#[test]
fn checksums_are_checked() {
    for packing in [None, Some(Packing::Zstd), Some(Packing::Lz4)] {
        let mut log = packing
            .map_or_else(|| Log::new(WriteOptions::new()), |packing| Log::new(WriteOptions::new()).packed(packing))
            .wrenches("/ft");
        for step in 0..50 {
            log.say("/ft", START + step, &wrench(true, START + step, 1.0 + step as f64 * 0.37));
        }
        let mut bytes = log.finish();
        let place = bytes.len() / 3;
        bytes[place] ^= 0x10;
        let error = all(&bytes).unwrap_err();
        assert!(matches!(error.problem, FileProblem::Unlike { .. }), "{error}");
    }
}

#[test]
fn lengths_that_lie_cost_no_memory() {
    // After the magic, one record of each kind with a length beyond the file.
    for kind in 0..=16_u8 {
        for length in [1_u64 << 20, 1 << 40, u64::MAX, u64::MAX - 8] {
            let bytes = [mcap::MAGIC, &[kind], &length.to_le_bytes(), &[0; 64]].concat();
            assert!(all(&bytes).is_err());
        }
    }
    // A chunk that says it unpacks to much more than it holds, and to more than is ever unpacked.
    for (size, packed) in [(200_u64 << 20, ""), (1 << 50, "zstd"), (1 << 50, ""), (5, "zstd"), (5, "lz4"), (5, "br")] {
        let mut chunk = [0_u64.to_le_bytes(), 0_u64.to_le_bytes(), size.to_le_bytes()].concat();
        chunk.extend(0_u32.to_le_bytes());
        chunk.extend((packed.len() as u32).to_le_bytes());
        chunk.extend(packed.as_bytes());
        chunk.extend(3_u64.to_le_bytes());
        chunk.extend(b"abc");
        let bytes = [mcap::MAGIC, &[6], &(chunk.len() as u64).to_le_bytes(), &chunk].concat();
        let error = all(&bytes).unwrap_err();
        assert!(
            matches!(
                error.problem,
                FileProblem::Unlike { .. } | FileProblem::TooLarge { .. } | FileProblem::DecompressionLimit(_)
            ),
            "{error}"
        );
    }
    // Texts and records inside a chunk that go on behind its end.
    for inner in [
        &[3_u8, 255, 255, 255, 255, 255, 255, 255, 255][..],
        &[3, 6, 0, 0, 0, 0, 0, 0, 0, 1, 0, 255, 255, 255, 255],
        &[1],
    ] {
        let mut chunk = [0_u64.to_le_bytes(), 0_u64.to_le_bytes(), (inner.len() as u64).to_le_bytes()].concat();
        chunk.extend([0; 8]);
        chunk.extend((inner.len() as u64).to_le_bytes());
        chunk.extend(inner);
        let bytes = [mcap::MAGIC, &[6], &(chunk.len() as u64).to_le_bytes(), &chunk].concat();
        let error = all(&bytes).unwrap_err();
        assert!(matches!(error.problem, FileProblem::Unlike { .. }), "{error}");
    }
}

#[test]
fn counts_inside_messages_that_lie_skip_the_topic() {
    let mut log = Log::chunked().joints("/joint_states").wrenches("/ft");
    log.say("/ft", START, &wrench(true, START, 1.0));
    log.say("/joint_states", START, &Cdr::new(true).header(START).u32(u32::MAX).bytes());
    let contents = look(&log.finish()).unwrap();
    assert_eq!(contents.skipped[0].name, "/joint_states");
    assert!(contents.skipped[0].reason.contains("message 2 of the log, byte "), "{:?}", contents.skipped);
}

#[test]
fn a_log_of_nothing_is_no_test() {
    let empty = Log::chunked().finish();
    assert!(matches!(look(&empty).unwrap_err().problem, FileProblem::NoParts(_)));
}
