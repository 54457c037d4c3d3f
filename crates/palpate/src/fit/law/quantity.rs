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

    /// What is reported of these, with errors.
    pub(crate) fn reported(all: Vec<Self>, assessed: &Assessed) -> Vec<Parameter> {
        let found: Vec<&Self> = all.iter().filter(|quantity| quantity.role != ParameterRole::Given).collect();
        let values: Vec<f64> = found.iter().map(|quantity| quantity.value).collect();
        let size = found.first().map_or(0, |quantity| quantity.gradient.len());
        let column = |parameter: usize| found.iter().map(|quantity| quantity.gradient[parameter]).collect();
        let gradients: Vec<Vec<f64>> = (0..size).map(column).collect();
        let mut estimates = assessed.estimates(&values, &gradients, |index| found[index].scale).into_iter();
        let estimated: Vec<Estimate> = all
            .iter()
            .map(|quantity| match quantity.role {
                ParameterRole::Given => Estimate::fixed(quantity.value),
                _ => estimates.next().unwrap_or_else(|| Estimate::fixed(quantity.value)),
            })
            .collect();
        let parameter = |(quantity, estimate): (Self, Estimate)| Parameter {
            name: quantity.name,
            unit: quantity.unit,
            estimate,
            role: quantity.role,
            parts: None,
        };
        all.into_iter().zip(estimated).map(parameter).collect()
    }
}
