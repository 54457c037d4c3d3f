//! A contact, whichever law it obeys.

use super::{ContactModel, LinearContact, Separation, VaryingContact};
use crate::contact::Specimen;

/// A contact to simulate, whichever law it obeys.
///
/// The simulations take anything that turns into it: `&ContactModel`, `&VaryingContact` and `&LinearContact`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Contact<'a> {
    /// The latency law in layers.
    Latency(&'a ContactModel),
    /// The same with a rate coefficient that depends on the state of the layer.
    Varying(&'a VaryingContact),
    /// A linear law.
    Linear(&'a LinearContact),
}

impl<'a> From<&'a ContactModel> for Contact<'a> {
    fn from(contact: &'a ContactModel) -> Self {
        Self::Latency(contact)
    }
}

impl<'a> From<&'a VaryingContact> for Contact<'a> {
    fn from(contact: &'a VaryingContact) -> Self {
        Self::Varying(contact)
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
            Self::Varying(contact) => &contact.model.specimen,
            Self::Linear(contact) => &contact.specimen,
        }
    }

    /// Whether the jaw can pull.
    #[must_use]
    pub fn separation(self) -> Separation {
        match self {
            Self::Latency(contact) => contact.separation,
            Self::Varying(contact) => contact.model.separation,
            Self::Linear(contact) => contact.separation,
        }
    }
}

/// Runs what is written once for every law with the law of a contact.
macro_rules! by_law {
    ($contact:expr, $name:ident => $work:expr) => {
        match $contact {
            $crate::simulate::Contact::Latency($name) => $work,
            $crate::simulate::Contact::Varying($name) => $work,
            $crate::simulate::Contact::Linear($name) => $work,
        }
    };
}

pub(super) use by_law;
