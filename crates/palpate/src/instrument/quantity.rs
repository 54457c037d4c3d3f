//! The quantities whose uncertainty may be stated.

use serde::{Deserialize, Serialize};

use crate::budget::{Cause, InputQuantity};
use crate::contact::{Shape, ShapeDimension};
use crate::segment::ContactPoint;

/// A quantity of the instrument or of the body that is known with an uncertainty. Each is one number for a whole record: an error that all
/// its samples have in common.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum InstrumentQuantity {
    /// Zero of the force, N: the same error in every sample, as left by the tare.
    Force,
    /// Slope of the zero of the force in time, N/s, as a baseline leaves it.
    ForceDrift {
        /// Time at which the force is free of it, s.
        about: f64,
    },
    /// Gain of the load cell, a share of the force.
    ForceGain,
    /// Zero of the displacement, m.
    Displacement,
    /// Gain of the displacement, a share of it.
    DisplacementGain,
    /// Compliance of machine and load cell, m/N.
    Compliance,
    /// First touch, m.
    Touch,
    /// Gain of the clock, a share of all times.
    Clock,
    /// A length or area of the body, m or m².
    Body {
        /// Which.
        dimension: ShapeDimension,
    },
    /// Modulus that was given, Pa.
    Modulus,
    /// Temperature, K, with its effects on the body.
    Temperature {
        /// Relative change of the modulus per kelvin.
        modulus_per_k: f64,
        /// Relative change of all rates of relaxation per kelvin.
        rate_per_k: f64,
    },
}

impl InstrumentQuantity {
    /// Its name in a description.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "force",
            Self::ForceDrift { .. } => "force_drift",
            Self::ForceGain => "force_gain",
            Self::Displacement => "displacement",
            Self::DisplacementGain => "displacement_gain",
            Self::Compliance => "compliance",
            Self::Touch => "touch",
            Self::Clock => "clock",
            Self::Body { dimension } => dimension.name(),
            Self::Modulus => "modulus",
            Self::Temperature { .. } => "temperature",
        }
    }

    /// Its name in a budget.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Force => "zero of the force",
            Self::ForceDrift { .. } => "slope of the baseline",
            Self::ForceGain => "gain of the force",
            Self::Displacement => "zero of the displacement",
            Self::DisplacementGain => "gain of the displacement",
            Self::Touch => "first touch",
            Self::Clock => "gain of the clock",
            _ => self.name(),
        }
    }

    /// Its SI unit, `1` of a share.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Force => "N",
            Self::ForceDrift { .. } => "N/s",
            Self::ForceGain | Self::DisplacementGain | Self::Clock => "1",
            Self::Displacement | Self::Touch => "m",
            Self::Compliance => "m/N",
            Self::Body { dimension } => dimension.unit(),
            Self::Modulus => "Pa",
            Self::Temperature { .. } => "K",
        }
    }

    /// Whether a body of this shape has it.
    #[must_use]
    pub fn belongs_to(self, shape: &Shape) -> bool {
        !matches!(self, Self::Body { dimension } if !shape.dimensions().contains(&dimension))
    }
}

/// A quantity with its uncertainty; the estimate is that of the deviation, 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InstrumentInput {
    /// Which.
    pub quantity: InstrumentQuantity,
    /// The uncertainty of its deviation from what the record and its description say, in SI.
    pub uncertainty: InputQuantity,
}

/// What is known of the instrument and of the body besides a record; what is not among it counts as exact, but for first touch and the zero of the
/// force where they are found in the record.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Instrument {
    /// The quantities with their uncertainties.
    pub inputs: Vec<InstrumentInput>,
}

impl Instrument {
    /// The same with the errors that were found in the record: of first touch, of the zero of the force and of the slope of its baseline. A zero of
    /// the force that is stated is that of the tare, and found no more. That of the displacement has no effect where first touch was found: it
    /// moves with it.
    #[must_use]
    pub(crate) fn with_found(&self, contact: &ContactPoint) -> Self {
        let touch = contact.displacement_error;
        let found = [
            (InstrumentQuantity::Touch, "first touch, as found", touch),
            (InstrumentQuantity::Force, "zero of the force, as found", contact.force_error),
        ];
        let drift = contact.force_drift.map(|drift| {
            let quantity = InstrumentQuantity::ForceDrift { about: drift.about };
            (quantity, "slope of the baseline, as found", Some(drift.standard_error))
        });
        let is_stated = self.inputs.iter().any(|input| input.quantity == InstrumentQuantity::Force);
        let found = found
            .into_iter()
            .chain(drift)
            .filter(|(quantity, ..)| !(is_stated && *quantity == InstrumentQuantity::Force));
        let mut with = self.clone();
        with.inputs.retain(|input| touch.is_none() || input.quantity != InstrumentQuantity::Displacement);
        with.inputs.extend(found.filter_map(|(quantity, title, error)| {
            let error = error.filter(|error| *error > 0.0)?;
            let uncertainty = InputQuantity::standard(title, quantity.unit(), 0.0, error).ok()?;
            Some(InstrumentInput {
                quantity,
                uncertainty: uncertainty.type_a().with_cause(Cause::EachRecord),
            })
        }));
        with
    }

    /// Whether nothing is stated.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A zero of 0.5 mm was added to the error of a first touch that moves with it.
    #[test]
    fn a_zero_of_the_displacement_has_no_effect_where_touch_is_found() {
        let quantity = InstrumentQuantity::Displacement;
        let uncertainty = InputQuantity::standard(quantity.title(), quantity.unit(), 0.0, 5e-4).unwrap();
        let stated = Instrument {
            inputs: vec![InstrumentInput { quantity, uncertainty }],
        };
        let quantities = |displacement_error| -> Vec<InstrumentQuantity> {
            let contact = ContactPoint {
                displacement_error,
                ..ContactPoint::default()
            };
            stated.with_found(&contact).inputs.iter().map(|input| input.quantity).collect()
        };
        assert_eq!(quantities(Some(1e-5)), [InstrumentQuantity::Touch]);
        assert_eq!(quantities(None), [quantity]);
    }
}
