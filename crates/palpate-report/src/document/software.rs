//! The software that wrote a document.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The software that wrote a document.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Software {
    /// Always `palpate`.
    pub name: String,
    /// Its version.
    pub version: String,
}

impl Software {
    /// This build.
    #[must_use]
    pub fn this() -> Self {
        Self {
            name: "palpate".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}
