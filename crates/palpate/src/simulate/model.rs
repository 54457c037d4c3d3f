//! The contact model: everything but the motion.

use serde::{Deserialize, Serialize};

use crate::contact::{Layers, Specimen};
use crate::latency::LatencyLaw;

/// Whether the jaw can pull on the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Separation {
    /// The jaw can only push: it leaves the body when the force reaches zero, and meets it again.
    #[default]
    Unilateral,
    /// Body and jaw are bonded: the force may become tension (the paper's simulation; strips in grips).
    Bonded,
}

/// A soft body between jaws, obeying the latency law in layers (section IV of the paper).
#[derive(Debug, Clone, PartialEq)]
pub struct ContactModel {
    /// Shape and modulus.
    pub specimen: Specimen,
    /// The law of every layer.
    pub law: LatencyLaw,
    /// How many layers.
    pub layers: Layers,
    /// Whether the jaw can pull.
    pub separation: Separation,
}
