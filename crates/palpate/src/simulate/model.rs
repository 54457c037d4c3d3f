//! The contact model: everything but the motion.

use serde::{Deserialize, Serialize};

use super::LinearContact;
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

/// A contact to simulate, whichever law it obeys.
///
/// The simulations take anything that turns into it: `&ContactModel` and `&LinearContact`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact<'a> {
    /// The latency law in layers.
    Latency(&'a ContactModel),
    /// A linear law.
    Linear(&'a LinearContact),
}

impl<'a> From<&'a ContactModel> for Contact<'a> {
    fn from(contact: &'a ContactModel) -> Self {
        Self::Latency(contact)
    }
}

impl<'a> From<&'a LinearContact> for Contact<'a> {
    fn from(contact: &'a LinearContact) -> Self {
        Self::Linear(contact)
    }
}

impl<'a> Contact<'a> {
    /// The body.
    #[must_use]
    pub fn specimen(self) -> &'a Specimen {
        match self {
            Self::Latency(contact) => &contact.specimen,
            Self::Linear(contact) => &contact.specimen,
        }
    }

    /// Whether the jaw can pull.
    #[must_use]
    pub fn separation(self) -> Separation {
        match self {
            Self::Latency(contact) => contact.separation,
            Self::Linear(contact) => contact.separation,
        }
    }
}

/// Runs what is written once for every law with the law of a contact.
macro_rules! by_law {
    ($contact:expr, $name:ident => $work:expr) => {
        match $contact {
            $crate::simulate::Contact::Latency($name) => $work,
            $crate::simulate::Contact::Linear($name) => $work,
        }
    };
}

pub(super) use by_law;
