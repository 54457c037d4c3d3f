//! A parameter with its gradient, before it has an error.

use crate::fit::{Assessed, Estimate, Parameter, ParameterName, ParameterRole, ParameterUnit, Scale};
use crate::optimise::Few;

/// A parameter before it has an error.
pub(crate) struct Quantity {
    pub(crate) name: ParameterName,
    pub(crate) unit: ParameterUnit,
    pub(crate) role: ParameterRole,
    pub(crate) value: f64,
    /// Derivatives of the value, on the logarithmic scale of ln value, by the searched parameters; empty if it was given.
    pub(crate) gradient: Few,
    pub(crate) scale: Scale,
}

impl Quantity {
    pub(crate) fn given(name: ParameterName, unit: ParameterUnit, value: f64) -> Self {
        Self {
            name,
            unit,
            role: ParameterRole::Given,
            value,
            gradient: Few::new(),
            scale: Scale::Linear,
        }
    }

    pub(crate) fn reported(self, assessed: &Assessed) -> Parameter {
        Parameter {
            name: self.name,
            unit: self.unit,
            estimate: match self.role {
                ParameterRole::Given => Estimate::fixed(self.value),
                _ => assessed.estimate(self.value, &self.gradient, self.scale),
            },
            role: self.role,
            parts: None,
        }
    }
}
