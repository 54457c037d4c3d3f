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
    /// Strain, a ratio.
    Strain,
    /// Relaxation modulus E(t) or G(t), in Pa.
    Modulus,
    /// Creep compliance J(t) or D(t), in 1/Pa.
    Compliance,
    /// Torque, in N m.
    Torque,
    /// Angle, in rad.
    Angle,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Time,
        Self::Displacement,
        Self::Force,
        Self::Stress,
        Self::Strain,
        Self::Modulus,
        Self::Compliance,
        Self::Torque,
        Self::Angle,
    ];

    /// Whether it becomes the force of a record.
    pub(crate) fn is_load(self) -> bool {
        matches!(self, Self::Force | Self::Stress | Self::Modulus | Self::Torque)
    }

    /// Whether it becomes the displacement of a record.
    pub(crate) fn is_travel(self) -> bool {
        matches!(self, Self::Displacement | Self::Strain | Self::Compliance | Self::Angle)
    }

    /// Which units it takes.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Time => Dimension::Time,
            Self::Displacement => Dimension::Length,
            Self::Force => Dimension::Force,
            Self::Stress | Self::Modulus => Dimension::Pressure,
            Self::Strain => Dimension::Share,
            Self::Compliance => Dimension::PerPressure,
            Self::Torque => Dimension::Torque,
            Self::Angle => Dimension::Angle,
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
            Self::Strain => "%",
            Self::Modulus => "Pa",
            Self::Compliance => "1/Pa",
            Self::Torque => "N m",
            Self::Angle => "rad",
        }
    }
}

shown_as_written!(
    /// Its key in a description, such as `force`.
    Quantity
);
