//! What a column of a record can hold.

use palpate::units::Dimension;
use serde::Serialize;

/// What a column of a record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Time, in s.
    Time,
    /// Travel of the jaw, in m.
    Displacement,
    /// Force, in N.
    Force,
    /// Stress, in Pa.
    Stress,
}

impl Quantity {
    /// Which units it takes.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Time => Dimension::Time,
            Self::Displacement => Dimension::Length,
            Self::Force => Dimension::Force,
            Self::Stress => Dimension::Pressure,
        }
    }

    /// The unit that was most likely meant by one that it cannot have: who weighs writes kg for the force.
    pub(crate) fn unit_meant(self, written: &str) -> &'static str {
        match (self, written.trim().to_lowercase().as_str()) {
            (Self::Force, "kg" | "kilogram" | "kilograms") => "kgf",
            (Self::Force, "g" | "gr" | "gram" | "grams" | "gramm") => "gf",
            (Self::Force, "lb" | "lbs" | "pound" | "pounds") => "lbf",
            _ => self.usual_unit(),
        }
    }

    /// The unit that it most often has.
    pub(crate) fn usual_unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Displacement => "mm",
            Self::Force => "N",
            Self::Stress => "MPa",
        }
    }
}

shown_as_written!(
    /// Its key in a description: `time`, `displacement`, `force` or `stress`.
    Quantity
);
