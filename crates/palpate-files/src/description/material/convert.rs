//! A material file: a calibrated body as a protocol has it, with how sure its parameters are.
//!
//! Its tables `[specimen]`, `[law]` and `[contact]` are those of a protocol, so that whatever takes a body takes a material; the table
//! `[calibration]` holds the same parameters with their errors, and where they come from.

use std::path::Path;

use palpate::{
    budget::InputQuantity,
    calibrate::{
        Body, CalibrationRange, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts,
        MaterialUncertainty, Misfit, RateLaw, SystematicEffect,
    },
    contact::{Equilibrium, RateDependence},
    fit::Estimate,
    laws::Law,
    simulate::Contact,
    units::Dimension,
};

use super::{
    file::{MATERIAL_VERSION, MaterialFile, MaterialOrigin},
    tables::{
        CalibratedEquilibriumName, CalibrationTable, MaterialTables, ParameterTable, RangeTable, SystematicTable, UNITS,
    },
};
use crate::description::{
    body::model::model,
    text::{
        error::DescriptionError,
        kind::DescriptionKind,
        quantity::QuantityText,
        quoted,
        source::{self, Source},
    },
    uncertainty::CauseText,
};

/// Reads and checks the material in the file at `path`.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, has another version, or holds parameters that make no body or that are not
/// the same in `[calibration]` as in the other tables.
pub fn read_material(path: &Path) -> Result<MaterialFile, DescriptionError> {
    parse_material(&source::read_text(path)?, path)
}

/// Checks a material that was read already; `path` is used in messages alone.
///
/// # Errors
/// As for [`read_material`], less those of the file.
pub fn parse_material(text: &str, path: &Path) -> Result<MaterialFile, DescriptionError> {
    let source = &Source { path, text };
    version(source)?;
    let tables: MaterialTables = source.tables()?;
    let model = model(source, &tables.specimen, &tables.law, &tables.contact)?;
    let table = &tables.calibration;
    let law: Law = table.law.parse().map_err(|error| {
        source.value("calibration.law", "a law such as \"latency\" or \"prony:2\"", &format!("{error}"))
    })?;
    let (equilibrium, levels) = equilibrium(source, table.equilibrium, &model)?;
    let candidate = Candidate {
        law,
        equilibrium,
        rate: match &model {
            Contact::Latency { rate, .. } => rate_law(*rate).0,
            Contact::Linear(_) => RateLaw::Constant,
        },
    };
    let parameters = parameters(source, &table.parameter)?;
    let uncertainty = uncertainty(source, table)?;
    let residual = source.si("calibration.residual", &table.residual, Dimension::Force)?;
    let parts = MaterialParts {
        body: Body {
            shape: model.specimen().shape().clone(),
            sides: model.specimen().sides(),
            separation: model.separation(),
            levels,
        },
        candidate,
        parameters,
        uncertainty,
        noise: source.number("calibration.residual", residual, "0 N or more", |noise| noise >= 0.0)?,
        range: range(source, &table.range)?,
    };
    let names: Vec<&str> = table.parameter.iter().map(|parameter| parameter.name.as_str()).collect();
    let material = Material::new(parts).map_err(|error| {
        let expected = format!("the parameters of the law {law}, each above 0, and a covariance with one row each");
        source.value("calibration.parameter", format!("{expected} ({error})"), &names.join(", "))
    })?;
    if let Some((key, there, here)) = disagreement(&model, material.contact()) {
        let expected =
            format!("{here}, the parameter of [calibration]; a value edited by hand is no longer calibrated");
        return Err(source.value(key, expected, &there));
    }
    Ok(MaterialFile {
        material,
        origin: MaterialOrigin {
            record: table.record.clone(),
            sha256: table.sha256.clone(),
            specimens: table.specimens,
            test: table.test.clone(),
            palpate: table.palpate.clone(),
            samples: table.samples,
            misfit: misfit(source, table.misfit.as_deref())?,
        },
    })
}

/// Refuses a file of another version before anything else that may have changed with it; what is no version, or no table, is
/// refused with the other tables.
fn version(source: &Source<'_>) -> Result<(), DescriptionError> {
    source.refuse(&[DescriptionKind::Test, DescriptionKind::Protocol], DescriptionKind::Material)?;
    let tables: toml::Table = source.tables()?;
    let Some(calibration) = tables.get("calibration") else {
        let expected = "the table that palpate calibrate writes; a body without it belongs in a protocol";
        return Err(source.missing("calibration", expected));
    };
    let key = "calibration.version";
    let version = calibration.get("version");
    match version.and_then(toml::Value::as_integer).map(u64::try_from) {
        Some(Ok(other)) if other != MATERIAL_VERSION => {
            let expected = format!("{MATERIAL_VERSION}; calibrate again with this version of palpate");
            Err(source.value(key, expected, &other))
        }
        None if version.is_none() && calibration.is_table() => Err(source.missing(key, "the version of the table, 1")),
        _ => Ok(()),
    }
}

/// What the record shows against the law, where the file says so.
fn misfit(source: &Source<'_>, written: Option<&str>) -> Result<Option<Misfit>, DescriptionError> {
    let read = |text: &str| {
        text.parse().map_err(|_| {
            let expected = "a law such as \"prony:2\" that describes the record better, or \"residuals\"";
            source.value("calibration.misfit", expected, &quoted(text))
        })
    };
    written.map(read).transpose()
}

/// The law of the equilibrium force, and the contact displacements of its table, if it is one, but for first touch.
fn equilibrium(
    source: &Source<'_>,
    name: CalibratedEquilibriumName,
    model: &Contact,
) -> Result<(EquilibriumLaw, Vec<f64>), DescriptionError> {
    let equilibrium = model.specimen().equilibrium();
    let law = EquilibriumLaw::from(equilibrium);
    let levels = match equilibrium {
        Equilibrium::UniformStrain | Equilibrium::Hertz { .. } => Vec::new(),
        Equilibrium::Measured { force_per_displacement } => {
            force_per_displacement.points().into_iter().skip(1).map(|(place, _)| place).collect()
        }
    };
    let of_body = CalibratedEquilibriumName::from(law);
    if name == of_body {
        return Ok((law, levels));
    }
    let expected = format!("\"{of_body}\" as in [specimen], a value edited by hand is no longer calibrated");
    Err(source.value("calibration.equilibrium", expected, &format!("\"{name}\"")))
}

/// The law by which v differs, and the factor if it does.
pub(super) fn rate_law(rate: RateDependence) -> (RateLaw, Option<f64>) {
    match rate {
        RateDependence::Constant => (RateLaw::Constant, None),
        RateDependence::Strain { factor } => (RateLaw::ByStrain, Some(factor)),
        RateDependence::Direction { factor } => (RateLaw::ByDirection, Some(factor)),
    }
}

fn parameters(source: &Source<'_>, tables: &[ParameterTable]) -> Result<Vec<MaterialParameter>, DescriptionError> {
    let parameter = |(index, table): (usize, &ParameterTable)| {
        let key = |name: &str| format!("calibration.parameter[{}].{name}", index + 1);
        let above = |name: &str, value: f64| source.number(&key(name), value, "a number above 0", |value| value > 0.0);
        let written = table.unit.as_deref();
        let Some((unit, _)) = UNITS.iter().find(|(_, symbol)| *symbol == written) else {
            return Err(source.value(key("unit"), "Pa, N, m, s or /s, or none", written.unwrap_or_default()));
        };
        let value = above("value", table.value)?;
        let interval = match table.interval.as_deref() {
            None => None,
            Some(&[low, high]) => Some((low, high)),
            Some(other) => return Err(source.value(key("interval"), "two numbers", &format!("{other:?}"))),
        };
        if let Some((low, high)) = interval {
            above("interval", low)?;
            source.number(&key("interval"), high, "an upper end that is not below the lower", |high| high >= low)?;
            let within = format!("a value within its interval, {low} to {high}");
            source.number(&key("value"), value, &within, |value| (low..=high).contains(&value))?;
        }
        let errors = [("standard_error", table.standard_error), ("white_standard_error", table.white_standard_error)];
        for (name, error) in errors {
            if let Some(error) = error {
                source.number(&key(name), error, "a number of 0 or more", |error| error >= 0.0)?;
            }
        }
        Ok(MaterialParameter {
            name: table.name.clone(),
            unit: *unit,
            estimate: Estimate {
                value,
                standard_error: table.standard_error,
                white_standard_error: table.white_standard_error,
                interval,
            },
        })
    };
    tables.iter().enumerate().map(parameter).collect()
}

fn uncertainty(source: &Source<'_>, table: &CalibrationTable) -> Result<Option<MaterialUncertainty>, DescriptionError> {
    let Some(covariance) = &table.covariance else {
        return Ok(None);
    };
    let key = "calibration.covariance";
    let size = table.parameter.len();
    let square = covariance.len() == size && covariance.iter().all(|row| row.len() == size);
    let entry = |i: usize, j: usize| covariance[i][j];
    let pairs = || (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
    let sound = |(i, j): (usize, usize)| {
        let bound = (entry(i, i) * entry(j, j)).sqrt() * (1.0 + 1e-6);
        entry(i, j).is_finite()
            && entry(i, i) >= 0.0
            && entry(i, j).abs() <= bound
            && (entry(i, j) - entry(j, i)).abs() <= 1e-9 * bound
    };
    if !square || !pairs().all(sound) {
        let expected = format!("{size} rows of {size} finite numbers, symmetric, with correlations up to 1");
        return Err(source.value(key, expected, "another list"));
    }
    let within = |share: f64| share > 0.0 && share < 1.0;
    let confidence = table.confidence.ok_or_else(|| source.missing("calibration.confidence", "the coverage, 0.95"))?;
    let confidence = source.number("calibration.confidence", confidence, "a number between 0 and 1", within)?;
    for (index, parameter) in table.parameter.iter().enumerate() {
        let deviation = entry(index, index).sqrt();
        agrees_with(source, parameter, index, deviation, confidence)?;
    }
    let freedom = table.freedom.unwrap_or(f64::INFINITY);
    if freedom.is_nan() || freedom <= 0.0 {
        return Err(source.value("calibration.freedom", "a number above 0", &freedom));
    }
    Ok(Some(MaterialUncertainty {
        confidence,
        freedom,
        covariance: covariance.clone(),
        systematic: table
            .systematic
            .iter()
            .enumerate()
            .map(|(index, effect)| systematic(source, index, effect))
            .collect::<Result<_, _>>()?,
    }))
}

fn systematic(
    source: &Source<'_>,
    index: usize,
    table: &SystematicTable,
) -> Result<SystematicEffect, DescriptionError> {
    let key = |name: &str| format!("calibration.systematic[{}].{name}", index + 1);
    let least = |name: &str, value: f64, least: f64| {
        source.number(&key(name), value, &format!("a number of {least} or more"), |value| value >= least)
    };
    let freedom = table.freedom.map(|freedom| least("freedom", freedom, 1.0)).transpose()?;
    if let Some(log) = table.logs.iter().find(|log| !log.is_finite()) {
        return Err(source.value(key("logs"), "finite numbers", log));
    }
    Ok(SystematicEffect {
        input: InputQuantity {
            name: table.name.clone(),
            unit: table.unit.clone(),
            estimate: 0.0,
            standard_uncertainty: least("standard_uncertainty", table.standard_uncertainty, 0.0)?,
            freedom: freedom.unwrap_or(f64::INFINITY),
            distribution: table.distribution.into(),
            evaluation: table.evaluation.into(),
            cause: CauseText::cause(table.cause.as_ref()),
        },
        logs: table.logs.clone(),
    })
}

/// Whether standard error and interval of a parameter agree with the standard deviation of its logarithm by the covariance: the error
/// is that times the value, and an interval of half the coverage or more is wider.
fn agrees_with(
    source: &Source<'_>,
    parameter: &ParameterTable,
    index: usize,
    deviation: f64,
    confidence: f64,
) -> Result<(), DescriptionError> {
    /// Room for rounding, and for a degree of freedom or few.
    const ROOM: f64 = 0.5;
    const HAND: &str = "a value edited by hand is no longer calibrated";
    let key = |name: &str| format!("calibration.parameter[{}].{name}", index + 1);
    if let Some(error) = parameter.standard_error.filter(|error| ROOM * error / parameter.value > deviation) {
        let expected = format!("an error of {} at most by the covariance, {HAND}", deviation * parameter.value);
        return Err(source.value(key("standard_error"), expected, &error));
    }
    if let Some(&[low, high]) = parameter.interval.as_deref()
        && confidence >= 0.5
        && (high / low).ln() < ROOM * deviation
    {
        let expected = format!("an interval as wide as the covariance implies, {HAND}");
        return Err(source.value(key("interval"), expected, &format!("{low} to {high}")));
    }
    Ok(())
}

fn range(source: &Source<'_>, table: &RangeTable) -> Result<CalibrationRange, DescriptionError> {
    let quantity = |name: &str, written: &QuantityText, dimension| {
        let key = format!("calibration.range.{name}");
        let value = source.si(&key, written, dimension)?;
        source.number(&key, value, "0 or more", |value| value >= 0.0)
    };
    let none_if_omitted = |name: &str, written: &Option<QuantityText>, dimension| {
        written.as_ref().map_or(Ok(0.0), |written| quantity(name, written, dimension))
    };
    let range = CalibrationRange {
        longest_hold: quantity("longest_hold", &table.longest_hold, Dimension::Time)?,
        longest_force_hold: none_if_omitted("longest_force_hold", &table.longest_force_hold, Dimension::Time)?,
        deepest: quantity("deepest", &table.deepest, Dimension::Length)?,
        fastest: quantity("fastest", &table.fastest, Dimension::Speed)?,
        slowest: quantity("slowest", &table.slowest, Dimension::Speed)?,
        largest_force: quantity("largest_force", &table.largest_force, Dimension::Force)?,
        farthest_retreat: none_if_omitted("farthest_retreat", &table.farthest_retreat, Dimension::Length)?,
        loadings: table.loadings.unwrap_or(1).max(1),
    };
    if range.slowest > range.fastest {
        let expected = format!("no more than the fastest, {} m/s", range.fastest);
        return Err(source.value("calibration.range.slowest", expected, &format!("{} m/s", range.slowest)));
    }
    Ok(range)
}

/// Keys of the parameters of a body in the tables of a protocol, with their units behind a blank.
fn keys(contact: &Contact) -> Vec<(String, f64, &'static str)> {
    let mut keys = Vec::new();
    let mut is = |key: String, value: f64, unit| keys.push((key, value, unit));
    match contact {
        Contact::Latency { model, rate } => {
            is("law.exponent".to_owned(), model.law.exponent(), "");
            is("law.rate_coefficient".to_owned(), model.law.rate_coefficient(), " /s");
            is("contact.layer_thickness".to_owned(), model.specimen.depth() / model.layers.count(), " m");
            let (law, factor) = rate_law(*rate);
            if let (Some(name), Some(factor)) = (law.factor_name(), factor) {
                is(format!("law.{name}"), factor, "");
            }
        }
        Contact::Linear(linear) => {
            let terms = linear.law.terms();
            for (index, term) in terms.iter().enumerate() {
                let of = if terms.len() == 1 { "law".to_owned() } else { format!("law.terms[{}]", index + 1) };
                is(format!("{of}.overshoot"), term.overshoot, "");
                is(format!("{of}.time"), 1.0 / term.rate, " s");
            }
        }
    }
    match contact.specimen().equilibrium() {
        Equilibrium::Measured { force_per_displacement } => {
            for (row, (place, ratio)) in force_per_displacement.points().into_iter().enumerate() {
                is(format!("specimen.equilibrium_forces[{}]", row + 1), ratio * place, " N");
            }
        }
        _ => is("specimen.modulus".to_owned(), contact.specimen().modulus(), " Pa"),
    }
    keys
}

/// A key whose parameter differs between the two, with both.
fn disagreement(there: &Contact, here: &Contact) -> Option<(String, String, String)> {
    let of = |key: &str, there: usize, here: usize| Some((key.to_owned(), there.to_string(), here.to_string()));
    match (there, here) {
        (Contact::Latency { rate: there, .. }, Contact::Latency { rate: here, .. })
            if rate_law(*there).0 == rate_law(*here).0 => {}
        (Contact::Linear(there), Contact::Linear(here)) => {
            let counts = [there, here].map(|contact| contact.law.terms().len());
            if counts[0] != counts[1] || there.memory != here.memory {
                return of("law", counts[0], counts[1]);
            }
        }
        _ => return of("law.name", 0, 0),
    }
    let mut pairs = keys(there).into_iter().zip(keys(here));
    let ((key, there, unit), (_, here, _)) = pairs.find(|(a, b)| (a.1 - b.1).abs() > 1e-9 * b.1.abs())?;
    Some((key, format!("{there}{unit}"), format!("{here}{unit}")))
}
