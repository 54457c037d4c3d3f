//! What wrote a document.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The software that wrote a document.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Software {
    /// Always `palpate`.
    pub name: String,
    /// Its version.
    pub version: String,
    /// The commit that it was built from; `unknown` where the sources were not in a repository.
    pub commit: String,
    /// The platform that it was built for.
    pub target: String,
}

impl Software {
    /// Version and commit.
    #[must_use]
    pub fn release(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }

    /// This build.
    #[must_use]
    pub fn this() -> Self {
        Self {
            name: "palpate".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("PALPATE_COMMIT").to_owned(),
            target: env!("PALPATE_TARGET").to_owned(),
        }
    }
}

/// Name, version and commit, as figures, tables and pages state them.
impl fmt::Display for Software {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.release())
    }
}
