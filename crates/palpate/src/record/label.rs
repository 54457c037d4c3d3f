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
const HOLDS: [&str; 6] = ["pause", "hold", "dwell", "relax", "stress relax", "creep"];
/// Those of them that say that a body relaxes, or that it answers, and not only that the machine waits.
const RELAXATIONS: [&str; 2] = ["relax", "stress relax"];
const ANSWERS: [&str; 3] = ["relax", "stress relax", "creep"];
/// What TRIOS writes before some names of steps.
const TRANSIENT: &str = "step (transient)";

impl LabelledSegment {
    /// A segment from `from` to `to` (s); `None` for a label that names no phase of a test.
    ///
    /// ```
    /// use palpate::record::LabelledSegment;
    /// assert!(LabelledSegment::new("pause (2)", 2.0, 32.0).unwrap().holds);
    /// assert!(!LabelledSegment::new("Retract", 32.0, 33.0).unwrap().holds);
    /// assert!(LabelledSegment::new("Stress relaxation - 7", 0.0, 1e4).unwrap().holds);
    /// assert_eq!(LabelledSegment::new("segment 3", 0.0, 1.0), None);
    /// ```
    #[must_use]
    pub fn new(name: &str, from: f64, to: f64) -> Option<Self> {
        let holds = begins(name, &HOLDS);
        (holds || begins(name, &MOVES)).then(|| Self {
            name: name.to_owned(),
            from,
            to,
            holds,
        })
    }

    /// Whether the label says that the force of a body relaxes.
    pub(crate) fn names_relaxation(&self) -> bool {
        begins(&self.name, &RELAXATIONS)
    }

    /// Whether the label says what a body does: it relaxes, or creeps.
    pub(crate) fn names_answer(&self) -> bool {
        begins(&self.name, &ANSWERS)
    }
}

/// Whether a label begins with one of some words.
fn begins(name: &str, words: &[&str]) -> bool {
    let name = name.trim().to_lowercase();
    let name = name.strip_prefix(TRANSIENT).unwrap_or(&name).trim_start_matches([' ', '-', ':']);
    words.iter().any(|begin| name.starts_with(begin))
}
