//! What the columns of a file are used for.

use serde::Serialize;

use crate::naming::Quantity;

/// What a column of a file is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Its values are a quantity.
    Values(Quantity),
    /// Its values are added to those of the column of a quantity: the second finger of a gripper.
    Added(Quantity),
    /// Its values, the deflection of a cantilever, are taken off the displacement.
    Deflection,
    /// Its values are the time stamps of one quantity alone.
    ClockOf(Quantity),
}

impl Role {
    /// What the values of the column measure: time, for a clock.
    #[must_use]
    pub fn measured(self) -> Quantity {
        match self {
            Self::Values(quantity) | Self::Added(quantity) => quantity,
            Self::Deflection => Quantity::Displacement,
            Self::ClockOf(_) => Quantity::Time,
        }
    }
}

/// How the unit of a column begins that counts samples.
pub(super) const SAMPLES: &str = "samples at ";

/// A column that a record was made of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ColumnUse {
    /// What for.
    pub role: Role,
    /// Its number, from 1.
    pub number: usize,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Its unit, as the description or the header writes it.
    pub unit: String,
    /// 1, or −1 where the file has the opposite sign.
    pub sign: f64,
    /// What turns the unit into SI.
    pub factor: f64,
    /// It is a time counted from 1970, to be counted from the first row on.
    pub epoch: bool,
    /// What is then added, in SI, before the sign.
    pub offset: f64,
    /// Of a deflection whose column is the force: the spring constant, N/m, which is part of the factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spring_constant: Option<f64>,
}
