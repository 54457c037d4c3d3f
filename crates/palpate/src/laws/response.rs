//! What a law describes.

use serde::{Deserialize, Serialize};

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// Force, stress or strain of a contact held at constant displacement.
    #[default]
    Relaxation,
    /// Displacement or strain at constant force, and recovery after release.
    Creep,
}
