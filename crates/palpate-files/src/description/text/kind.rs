//! Which kind of description a text is.

use serde::Serialize;

/// The kinds of descriptions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum DescriptionKind {
    /// What a record is a test of: specimen, columns, machine.
    #[serde(rename = "a test description")]
    Test,
    /// What a simulation does: body, law, steps; a sweep over its numbers.
    #[serde(rename = "a protocol")]
    Protocol,
    /// A calibrated body.
    #[serde(rename = "a material file")]
    Material,
}

shown_as_written!(DescriptionKind);

/// Tables that tell a kind from those below it.
const TABLES: [(DescriptionKind, &[&str]); 3] = [
    (DescriptionKind::Protocol, &["step", "sweep"]),
    (DescriptionKind::Material, &["calibration"]),
    (DescriptionKind::Test, &["about", "file", "columns", "clock", "force", "machine", "phases", "fit"]),
];

impl DescriptionKind {
    /// The kind, by the tables that only it has; `None` where there are none of those.
    pub(crate) fn of(has: impl Fn(&str) -> bool) -> Option<Self> {
        let known = TABLES.into_iter().find(|(_, own)| own.iter().any(|key| has(key)));
        known.map(|(kind, _)| kind)
    }

    /// What helps who gave a description of kind `found` where this one is expected.
    pub(super) fn instead_of(self, found: Self) -> &'static str {
        match (self, found) {
            (Self::Material, Self::Test) => "calibrate a record of this test: palpate calibrate writes a material file",
            (Self::Material, _) => "give a material file that palpate calibrate wrote",
            (Self::Protocol, Self::Material) => "write a protocol with material = \"FILE\" and the steps as [[step]]",
            (Self::Protocol, _) => "add [law] and [[step]]; records of this test are for palpate analyze and calibrate",
            (Self::Test, _) => {
                "give a file with [specimen] and [columns]; palpate inspect --write-test drafts one for a record"
            }
        }
    }
}
