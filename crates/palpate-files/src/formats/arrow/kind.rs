//! Telling files of typed columns by their first bytes.

use crate::input::Input;

/// First and last bytes of an Arrow file.
pub(super) const MAGIC: &[u8] = b"ARROW1";
/// Stands before every message of an Arrow stream.
pub(super) const MARK: [u8; 4] = [0xFF; 4];

/// How a file of typed columns is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Parquet.
    Parquet,
    /// Arrow IPC, with a footer.
    File,
    /// Arrow IPC, without one.
    Stream,
}

/// Whether a file is one of these, and which.
pub(crate) fn recognise(input: &Input) -> Option<Kind> {
    let beginning = &input.beginning;
    if beginning.starts_with(b"PAR1") {
        Some(Kind::Parquet)
    } else if beginning.starts_with(MAGIC) {
        Some(Kind::File)
    } else {
        // The mark and the length of a schema, which is small.
        let small = beginning.get(4..8).is_some_and(|length| length[3] == 0 && length != [0; 4]);
        (beginning.starts_with(&MARK) && small).then_some(Kind::Stream)
    }
}
