//! What a file itself says of the phases of a record.

use serde::{Deserialize, Serialize};

/// A stretch of a record that its file labels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LabelledSegment {
    /// The label, as written.
    pub name: String,
    /// Its first moment, s, as the record counts time.
    pub from: f64,
    /// Its last moment, s.
    pub to: f64,
    /// Whether the machine holds something in it; else it moves.
    pub holds: bool,
}

/// Beginnings of labels under which a machine moves.
const MOVES: [&str; 10] = [
    "extend", "approach", "retract", "withdraw", "load", "unload", "ramp", "compress", "stretch", "recover",
];
/// Beginnings of labels under which it holds.
const HOLDS: [&str; 5] = ["pause", "hold", "dwell", "relax", "creep"];

impl LabelledSegment {
    /// A segment from `from` to `to` (s); `None` for a label that names no phase of a test.
    ///
    /// ```
    /// use palpate::record::LabelledSegment;
    /// assert!(LabelledSegment::new("pause (2)", 2.0, 32.0).unwrap().holds);
    /// assert!(!LabelledSegment::new("Retract", 32.0, 33.0).unwrap().holds);
    /// assert_eq!(LabelledSegment::new("segment 3", 0.0, 1.0), None);
    /// ```
    #[must_use]
    pub fn new(name: &str, from: f64, to: f64) -> Option<Self> {
        let word = name.trim().to_lowercase();
        let begins = |words: &[&str]| words.iter().any(|begin| word.starts_with(begin));
        let holds = begins(&HOLDS);
        (holds || begins(&MOVES)).then(|| Self {
            name: name.to_owned(),
            from,
            to,
            holds,
        })
    }
}
