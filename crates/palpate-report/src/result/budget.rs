//! Uncertainty budgets of results.

use palpate::analysis::Analysis;
use palpate::budget::Budget;
use palpate::calibrate::Material;
use palpate::fit::{Fit, Parameter, ParameterKind, ParameterRole};

use super::{ComparedRecord, law_of_record, parameters_of, si_unit};

/// A result with its budget.
#[derive(Debug, Clone, PartialEq)]
pub struct BudgetedResult {
    /// Number of the hold, from 1; none of a result of the whole record.
    pub hold: Option<usize>,
    /// The law whose parameter it is; none of the modulus that the equilibrium forces imply.
    pub law: Option<String>,
    /// Its name.
    pub name: String,
    /// Its unit, `1` of a dimensionless result.
    pub unit: String,
    /// The budget.
    pub budget: Budget,
}

/// Budgets of the estimated parameters and the rate coefficient of the law of the record on every hold, and of an estimated modulus; none where no instrument is described.
#[must_use]
pub fn budgets_of_analysis(analysis: &Analysis, record: &ComparedRecord) -> Vec<BudgetedResult> {
    let law = law_of_record(record);
    let modulus = analysis.budget_of_modulus().map(|budget| BudgetedResult {
        hold: None,
        law: None,
        name: "modulus_pa".to_owned(),
        unit: "Pa".to_owned(),
        budget,
    });
    let of_hold = analysis.holds.iter().flat_map(|hold| {
        let rows = hold.comparison.as_ref().map_or(&[][..], |comparison| &comparison.rows);
        let of_record = rows.iter().find(|row| Some(row.law) == law).and_then(|row| row.fit.as_ref().ok());
        let fit: Option<&Fit> = of_record.or_else(|| hold.preferred().map(std::ops::Deref::deref));
        fit.map_or_else(Vec::new, |fit| {
            let documents = parameters_of(fit, hold.signal.into());
            let result = |parameter: &Parameter| {
                let name = parameter.name.to_string();
                Some(BudgetedResult {
                    hold: Some(hold.number),
                    law: Some(fit.law.to_string()),
                    unit: documents.get(&name)?.unit.clone(),
                    name,
                    budget: analysis.budget(fit, parameter)?,
                })
            };
            let of_interest = |parameter: &&Parameter| {
                parameter.role == ParameterRole::Estimated || parameter.name.kind == ParameterKind::RateCoefficient
            };
            fit.parameters.iter().filter(of_interest).filter_map(result).collect()
        })
    });
    modulus.into_iter().chain(of_hold).collect()
}

/// Budgets of the parameters of a calibrated material; none where no instrument was described.
#[must_use]
pub fn budgets_of_material(material: &Material) -> Vec<BudgetedResult> {
    if material.uncertainty().is_none_or(|uncertainty| uncertainty.systematic.is_empty()) {
        return Vec::new();
    }
    let result = |parameter: &palpate::calibrate::MaterialParameter| {
        Some(BudgetedResult {
            hold: None,
            law: Some(material.candidate().to_string()),
            name: parameter.name.clone(),
            unit: si_unit(parameter.unit).to_owned(),
            budget: material.budget(&parameter.name)?,
        })
    };
    material.parameters().iter().filter_map(result).collect()
}
