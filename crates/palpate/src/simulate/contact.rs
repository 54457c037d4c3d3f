//! A contact, whichever law it obeys.

use super::{ContactModel, LinearContact, Separation};
use crate::contact::{RateDependence, Specimen};

/// A soft body between jaws with all its parameters, under any law.
///
/// ```
/// use palpate::contact::RateDependence;
/// use palpate::simulate::{Contact, Motion, Separation, simulate_force};
/// use palpate::test_problems::paper_ball;
/// let plain = Contact::from(paper_ball(Separation::Unilateral));
/// // Ten times slower per 0.1 of strain: more force remains after the same squeeze.
/// let rate = RateDependence::Strain { factor: 0.1 };
/// let slower = Contact::Latency { model: paper_ball(Separation::Unilateral), rate };
/// let squeeze = Motion::new(vec![0.0, 0.6, 10.6], vec![0.0, 0.005, 0.005])?;
/// let [plain, slow] = [simulate_force(&squeeze, &plain, &[10.6])?, simulate_force(&squeeze, &slower, &[10.6])?];
/// assert!((plain[0] - 1.5561).abs() < 1e-4 && (slow[0] - 1.8079).abs() < 1e-4); // N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Contact {
    /// The latency law in layers.
    Latency {
        /// The body with its law; the rate coefficient is that at first touch, or while the strain falls.
        model: ContactModel,
        /// How the rate coefficient depends on the state of the layer.
        rate: RateDependence,
    },
    /// A linear law.
    Linear(LinearContact),
}

impl Contact {
    /// The body.
    #[must_use]
    pub fn specimen(&self) -> &Specimen {
        match self {
            Self::Latency { model, .. } => &model.specimen,
            Self::Linear(contact) => &contact.specimen,
        }
    }

    /// The latency law of one rate coefficient, if it is that: what single steps, batches and strain waves take.
    #[must_use]
    pub fn latency(&self) -> Option<&ContactModel> {
        match self {
            Self::Latency {
                model,
                rate: RateDependence::Constant,
            } => Some(model),
            Self::Latency { .. } | Self::Linear(_) => None,
        }
    }

    /// Whether the jaw can pull.
    #[must_use]
    pub fn separation(&self) -> Separation {
        match self {
            Self::Latency { model, .. } => model.separation,
            Self::Linear(contact) => contact.separation,
        }
    }
}

impl From<ContactModel> for Contact {
    fn from(model: ContactModel) -> Self {
        Self::Latency {
            model,
            rate: RateDependence::Constant,
        }
    }
}

impl From<LinearContact> for Contact {
    fn from(contact: LinearContact) -> Self {
        Self::Linear(contact)
    }
}

/// A [`Contact`] as simulations borrow it: they take `&Contact`, and `&ContactModel` and `&LinearContact` as well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactRef<'a> {
    /// The latency law in layers, with how its rate coefficient depends on the state of the layer.
    Latency(&'a ContactModel, RateDependence),
    /// A linear law.
    Linear(&'a LinearContact),
}

impl<'a> From<&'a Contact> for ContactRef<'a> {
    fn from(contact: &'a Contact) -> Self {
        match contact {
            Contact::Latency { model, rate } => Self::Latency(model, *rate),
            Contact::Linear(contact) => Self::Linear(contact),
        }
    }
}

impl<'a> From<&'a ContactModel> for ContactRef<'a> {
    fn from(model: &'a ContactModel) -> Self {
        Self::Latency(model, RateDependence::Constant)
    }
}

impl<'a> From<&'a LinearContact> for ContactRef<'a> {
    fn from(contact: &'a LinearContact) -> Self {
        Self::Linear(contact)
    }
}

/// Runs what is written once for every law with the layer of a contact.
macro_rules! by_law {
    ($contact:expr, $name:ident => $work:expr) => {
        match $contact {
            $crate::simulate::ContactRef::Latency(model, rate) => {
                let $name = &$crate::simulate::latency::Latency { model, rate };
                $work
            }
            $crate::simulate::ContactRef::Linear($name) => $work,
        }
    };
}

pub(super) use by_law;
