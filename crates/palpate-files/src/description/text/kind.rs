//! Which kind of description a text is.

use std::fmt;

/// The kinds of descriptions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum DescriptionKind {
    /// What a record is a test of: specimen, columns, machine.
    Test,
    /// What a simulation does: body, law, steps; a sweep over its numbers.
    Protocol,
    /// A calibrated body.
    Material,
}

/// Tables that test descriptions alone have.
const TEST_TABLES: [&str; 8] = ["about", "file", "columns", "clock", "force", "machine", "phases", "fit"];

impl DescriptionKind {
    /// The kind, by tables that no other kind has; `None` where there are none of those.
    pub(crate) fn of(tables: &toml::Table) -> Option<Self> {
        let has = |key: &str| tables.contains_key(key);
        if has("step") || has("sweep") {
            Some(Self::Protocol)
        } else if has("calibration") {
            Some(Self::Material)
        } else {
            TEST_TABLES.into_iter().any(has).then_some(Self::Test)
        }
    }

    /// What helps who gave a description of kind `found` where this one is expected.
    pub(super) fn instead_of(self, found: Self) -> &'static str {
        match (self, found) {
            (Self::Material, Self::Test) => {
                "calibrate a record of this test (palpate calibrate) and give the material file that it writes"
            }
            (Self::Material, _) => "give a material file that palpate calibrate wrote",
            (Self::Protocol, Self::Material) => {
                "write a protocol that names it, material = \"FILE\", with the steps to take as [[step]]"
            }
            (Self::Protocol, _) => {
                "give a file with [law] and [[step]]; records of this test are for palpate analyze and palpate calibrate"
            }
            (Self::Test, _) => "give a file with [specimen] and [columns]; palpate inspect writes one for a record",
        }
    }
}

impl fmt::Display for DescriptionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Test => "a test description",
            Self::Protocol => "a protocol",
            Self::Material => "a material file",
        })
    }
}
