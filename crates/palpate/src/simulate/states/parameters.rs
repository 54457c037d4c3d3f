//! Parameters that differ between contacts of one description, as columns.

use std::ops::Range;

use crate::contact::{Equilibrium, Layers, LayersError, ShapeDimension, Specimen, SpecimenError};
use crate::latency::{LatencyLaw, LawError};
use crate::simulate::{ContactModel, LinearContact};
use crate::vector::LANES;

/// A parameter of a contact that may have a value for every contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ContactParameter {
    /// Young's modulus, Pa.
    Modulus,
    /// Radius of a ball, a pad or a round tip, m. The number of layers stays.
    Radius,
    /// Exponent n of the latency law.
    Exponent,
    /// Rate coefficient v of the latency law, 1/s.
    RateCoefficient,
    /// Thickness of a layer of the latency law, m.
    LayerThickness,
}

impl ContactParameter {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Modulus, Self::Radius, Self::Exponent, Self::RateCoefficient, Self::LayerThickness];

    /// Its name, with its unit.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Modulus => "modulus_pa",
            Self::Radius => "radius_m",
            Self::Exponent => "exponent",
            Self::RateCoefficient => "rate_coefficient_per_s",
            Self::LayerThickness => "layer_thickness_m",
        }
    }
}

/// Contacts that cannot be moved together, or a value that no contact has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactModelsError {
    /// No contact.
    #[error("expected one contact or more, found none")]
    Empty,
    /// A rate coefficient that depends on strain or direction.
    #[error("contact {index}: a contact is stepped by a latency law with one rate coefficient")]
    RateDependence {
        /// Number of the contact, from 0.
        index: usize,
    },
    /// Contacts of both kinds of laws.
    #[error("contact {index}: expected a law of the kind of contact 0, latency or linear, found the other kind")]
    Mixed {
        /// Number of the contact, from 0.
        index: usize,
    },
    /// A parameter that the body or its law does not have.
    #[error("{name}: the body and its law have no such parameter")]
    NoSuchParameter {
        /// Its name.
        name: &'static str,
    },
    /// Another number of values than before.
    #[error("{name}: expected {expected} values, one a contact, found {found}")]
    Count {
        /// Its name.
        name: &'static str,
        /// Number of contacts.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// Values beside models of which each contact has its own.
    #[error("{name}: values for each contact need one model for all, found {models} models")]
    SeveralModels {
        /// Its name.
        name: &'static str,
        /// How many models there are.
        models: usize,
    },
    /// A value that no body or law has.
    #[error("{name}, contact {index}: {problem}")]
    Value {
        /// Name of the parameter.
        name: &'static str,
        /// Number of the contact, from 0.
        index: usize,
        /// What is wrong with it.
        problem: ValueProblem,
    },
}

/// Why a value is none.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ValueProblem {
    /// Not of a body.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// Not of a law.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Not of layers.
    #[error(transparent)]
    Layers(#[from] LayersError),
}

/// The value of a parameter, where a contact has one of its own.
pub(super) type Value<'a> = &'a dyn Fn(ContactParameter) -> Option<f64>;

/// A body with values of its own.
fn own_specimen(specimen: &Specimen, value: Value<'_>) -> Result<Specimen, SpecimenError> {
    let shape = match value(ContactParameter::Radius) {
        Some(radius) => specimen.shape().clone().with(ShapeDimension::Radius, |_| radius),
        None => specimen.shape().clone(),
    };
    let modulus = value(ContactParameter::Modulus).unwrap_or(specimen.modulus());
    let equilibrium = specimen.equilibrium().clone();
    Ok(Specimen::new(shape, modulus, specimen.sides())?.with_equilibrium(equilibrium)?)
}

/// A model with values of its own.
pub(super) fn own_model(model: &ContactModel, value: Value<'_>) -> Result<ContactModel, ValueProblem> {
    let specimen = own_specimen(&model.specimen, value)?;
    let exponent = value(ContactParameter::Exponent).unwrap_or(model.law.exponent());
    let rate_coefficient = value(ContactParameter::RateCoefficient).unwrap_or(model.law.rate_coefficient());
    let layers = match value(ContactParameter::LayerThickness) {
        Some(thickness) => Layers::of_thickness(thickness, specimen.depth())?,
        None => model.layers,
    };
    Ok(ContactModel {
        specimen,
        law: LatencyLaw::new(exponent, rate_coefficient)?,
        layers,
        separation: model.separation,
    })
}

/// A linear contact with values of its own.
pub(super) fn own_contact(contact: &LinearContact, value: Value<'_>) -> Result<LinearContact, ValueProblem> {
    Ok(LinearContact {
        specimen: own_specimen(&contact.specimen, value)?,
        ..contact.clone()
    })
}

/// The value of a parameter of a body.
pub(super) fn of_specimen(parameter: ContactParameter, specimen: &Specimen) -> Option<f64> {
    match parameter {
        ContactParameter::Radius => specimen.shape().dimension(ShapeDimension::Radius),
        // The rows of a table are forces.
        ContactParameter::Modulus if matches!(specimen.equilibrium(), Equilibrium::Measured { .. }) => None,
        ContactParameter::Modulus => Some(specimen.modulus()),
        _ => None,
    }
}

/// The value of a parameter of a model.
pub(super) fn of_model(parameter: ContactParameter, model: &ContactModel) -> Option<f64> {
    match parameter {
        ContactParameter::Exponent => Some(model.law.exponent()),
        ContactParameter::RateCoefficient => Some(model.law.rate_coefficient()),
        ContactParameter::LayerThickness => Some(model.layers.thickness(model.specimen.depth())),
        _ => of_specimen(parameter, &model.specimen),
    }
}

/// Columns of values, a value for each contact.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Parameters {
    /// In the order of [`ContactParameter`].
    columns: Vec<(ContactParameter, Vec<f64>)>,
}

impl Parameters {
    pub(super) fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// How many contacts have values, if any.
    pub(super) fn count(&self) -> Option<usize> {
        self.columns.first().map(|(_, values)| values.len())
    }

    /// The values of a parameter.
    #[inline(always)]
    pub(super) fn values(&self, parameter: ContactParameter) -> Option<&[f64]> {
        self.columns.iter().find(|(found, _)| *found == parameter).map(|(_, values)| values.as_slice())
    }

    /// The columns, in the order of [`ContactParameter`].
    pub(super) fn columns(&self) -> impl Iterator<Item = (ContactParameter, &[f64])> {
        self.columns.iter().map(|(parameter, values)| (*parameter, values.as_slice()))
    }

    /// With values of a parameter, in the place of those that it had.
    pub(super) fn insert(&mut self, parameter: ContactParameter, values: Vec<f64>) {
        self.columns.retain(|(found, _)| *found != parameter);
        self.columns.push((parameter, values));
        self.columns.sort_by_key(|(parameter, _)| *parameter);
    }

    /// The value of a parameter for a contact.
    pub(super) fn value(&self, parameter: ContactParameter, index: usize) -> Option<f64> {
        self.values(parameter).map(|values| values[index])
    }

    /// Puts values in the place of those of the contacts that `mask` marks; of a parameter without values yet, `base` for the others.
    pub(super) fn replace(&mut self, parameter: ContactParameter, base: f64, values: &[f64], mask: &[bool]) {
        if self.values(parameter).is_none() {
            self.insert(parameter, vec![base; mask.len()]);
        }
        let column = self.columns.iter_mut().find(|(found, _)| *found == parameter);
        let marked = column.into_iter().flat_map(|(_, column)| column.iter_mut().zip(mask).enumerate());
        for (index, (slot, _)) in marked.filter(|(_, (_, marked))| **marked) {
            *slot = values[index.min(values.len() - 1)];
        }
    }
}

/// Makes blocks of contacts anew: those with contacts that `mask` marks, or all where there was one for all contacts.
pub(super) fn renew<B>(blocks: &mut Vec<B>, mask: &[bool], block: impl Fn(Range<usize>) -> B) {
    let count = mask.len().div_ceil(LANES);
    let of = |index: usize| block(index * LANES..mask.len().min((index + 1) * LANES));
    if blocks.len() != count {
        *blocks = (0..count).map(of).collect();
        return;
    }
    for (index, marks) in mask.chunks(LANES).enumerate() {
        if marks.contains(&true) {
            blocks[index] = of(index);
        }
    }
}
