//! Bytes taken for a description: of a test, a protocol and a sweep.

use std::path::Path;

use palpate_files::description::{
    DescriptionError, parse_protocol, parse_sweep, parse_test, read_protocol, read_sweep, read_test,
};

use super::Complaint;

/// Which kind of description a text is taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DescriptionKind {
    Test,
    Protocol,
    Sweep,
}

/// Reads a text as a description of this kind; a sweep up to the first and the last of its runs.
pub(crate) fn read_description(kind: DescriptionKind, name: &str, bytes: &[u8]) -> Result<(), Complaint> {
    let path = Path::new(name);
    let Ok(text) = std::str::from_utf8(bytes) else {
        return from_disk(kind, name, bytes);
    };
    let complaint = |error: DescriptionError| Complaint::of(name, error.to_string(), error.hint());
    match kind {
        DescriptionKind::Test => parse_test(text, path).map(|test| drop(test.analysis)).map_err(complaint),
        DescriptionKind::Protocol => parse_protocol(text, path).map(drop).map_err(complaint),
        DescriptionKind::Sweep => {
            let sweep = parse_sweep(text, path).map_err(complaint)?;
            assert!(sweep.runs > 0);
            for run in [0, sweep.runs / 2, sweep.runs - 1] {
                let (numbers, protocol) = sweep.run(run);
                assert_eq!(numbers.len(), sweep.parameters.len());
                assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?}");
                let _either = protocol;
            }
            Ok(())
        }
    }
}

/// What is no text is recognised by those who read it from a disk.
fn from_disk(kind: DescriptionKind, name: &str, bytes: &[u8]) -> Result<(), Complaint> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("a file");
    let read = match kind {
        DescriptionKind::Test => read_test(&path).map(drop),
        DescriptionKind::Protocol => read_protocol(&path).map(drop),
        DescriptionKind::Sweep => read_sweep(&path).map(drop),
    };
    let less_folder = |text: String| text.replace(&format!("{}/", folder.path().display()), "");
    read.map_err(|error| Complaint::of(name, less_folder(error.to_string()), error.hint()))
}

/// The fuzz target of descriptions: a text is taken for one of every kind.
pub(crate) fn describe_any(bytes: &[u8]) {
    for kind in [DescriptionKind::Test, DescriptionKind::Protocol, DescriptionKind::Sweep] {
        let _either = read_description(kind, "fuzzed", bytes);
    }
}
