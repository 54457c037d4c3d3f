//! A record and a body with a quantity of the instrument off its estimate.

use super::InstrumentQuantity;
use crate::contact::{Shape, ShapeDimension};

/// What one or several quantities off their estimates change, in SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Deviation {
    force: f64,
    /// Slope, N/s, and the time at which it is no error, s.
    drift: (f64, f64),
    force_gain: f64,
    displacement: f64,
    displacement_gain: f64,
    compliance: f64,
    clock: f64,
    dimension: Option<(ShapeDimension, f64)>,
    modulus: f64,
    /// Relative changes at the stated temperature.
    pub(crate) modulus_at_temperature: f64,
    pub(crate) rate_at_temperature: f64,
}

impl Deviation {
    /// `quantity` off its estimate by `by`.
    pub(crate) fn of(quantity: InstrumentQuantity, by: f64) -> Self {
        let none = Self::default();
        match quantity {
            InstrumentQuantity::Force => Self { force: by, ..none },
            InstrumentQuantity::ForceDrift { about } => Self {
                drift: (by, about),
                ..none
            },
            InstrumentQuantity::ForceGain => Self { force_gain: by, ..none },
            InstrumentQuantity::Displacement | InstrumentQuantity::Touch => Self {
                displacement: by,
                ..none
            },
            InstrumentQuantity::DisplacementGain => Self {
                displacement_gain: by,
                ..none
            },
            InstrumentQuantity::Compliance => Self { compliance: by, ..none },
            InstrumentQuantity::Clock => Self { clock: by, ..none },
            InstrumentQuantity::Body { dimension } => Self {
                dimension: Some((dimension, by)),
                ..none
            },
            InstrumentQuantity::Modulus => Self { modulus: by, ..none },
            InstrumentQuantity::Temperature {
                modulus_per_k,
                rate_per_k,
            } => Self {
                modulus_at_temperature: modulus_per_k * by,
                rate_at_temperature: rate_per_k * by,
                ..none
            },
        }
    }

    /// The force where `measured` was read, N.
    pub(crate) fn force(&self, measured: f64) -> f64 {
        measured * (1.0 + self.force_gain) + self.force
    }

    /// The force where `measured` was read at a time (s), N.
    pub(crate) fn force_at(&self, measured: f64, time: f64) -> f64 {
        self.force(measured) + self.drift.0 * (time - self.drift.1)
    }

    /// How fast the force changes in time beside what was read, N/s.
    pub(crate) fn drift(&self) -> f64 {
        self.drift.0
    }

    /// The displacement since first touch where `measured` was read under a force, m.
    pub(crate) fn displacement(&self, measured: f64, force: f64) -> f64 {
        measured * (1.0 + self.displacement_gain) + self.displacement - self.compliance * force
    }

    /// The time where `measured` was read, s.
    pub(crate) fn time(&self, measured: f64) -> f64 {
        measured * (1.0 + self.clock)
    }

    /// The shape.
    pub(crate) fn shape(&self, described: &Shape) -> Shape {
        match self.dimension {
            Some((dimension, by)) => described.clone().with(dimension, |value| value + by),
            None => described.clone(),
        }
    }

    /// The modulus of a body at the temperature of the test, where `given` was stated, Pa.
    pub(crate) fn given_modulus(&self, given: f64) -> f64 {
        (given + self.modulus) * (1.0 + self.modulus_at_temperature)
    }
}
