//! A material file: a calibrated body as a protocol has it, with how sure its numbers are.
//!
//! Its tables `[specimen]`, `[law]` and `[contact]` are those of a protocol, so that whatever takes a body takes a material; the table
//! `[calibration]` holds the same numbers with their errors, and where they come from.

use std::path::Path;

use palpate::{
    calibrate::{Body, Candidate, EquilibriumLaw, Material, MaterialNumber, MaterialUncertainty, RateLaw, Shown},
    contact::{Equilibrium, RateDependence},
    fit::Estimate,
    laws::Law,
    simulate::{Contact, ContactModel},
    units::Dimension,
};
use serde::Deserialize;

use super::{
    file::{MATERIAL_VERSION, MaterialFile, MaterialOrigin},
    tables::{CalibratedEquilibriumName, CalibrationTable, MaterialTables, NumberTable, ShownTable, unit_of},
};
use crate::description::{
    body::model::model,
    text::{
        error::DescriptionError,
        quantity::QuantityText,
        source::{self, Source},
    },
};

/// Reads and checks the material in the file at `path`.
///
/// # Errors
/// [`DescriptionError`] where the file cannot be read, is no TOML, has another version, or holds numbers that make no body or that are not
/// the same in `[calibration]` as in the other tables.
pub fn read_material(path: &Path) -> Result<MaterialFile, DescriptionError> {
    parse_material(&source::read(path, source::LONGEST)?, path)
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
    let candidate = Candidate {
        law,
        equilibrium: equilibrium(source, table.equilibrium, &model)?,
        rate: match &model {
            Contact::Latency { rate, .. } => rate_law(*rate),
            Contact::Linear(_) => RateLaw::Constant,
        },
    };
    let material = Material {
        body: Body {
            shape: model.specimen().shape().clone(),
            sides: model.specimen().sides(),
            separation: model.separation(),
            levels: levels(&model),
        },
        candidate,
        numbers: numbers(source, &table.number)?,
        uncertainty: uncertainty(source, table)?,
        noise: source.number(
            "calibration.residual",
            source.si("calibration.residual", &table.residual, Dimension::Force)?,
            "0 N or more",
            |noise| noise >= 0.0,
        )?,
        shown: shown(source, &table.shown)?,
    };
    if !material.is_whole() {
        let expected = format!("the numbers of the law {law}, each above 0, and a covariance with a row for each");
        let names: Vec<&str> = table.number.iter().map(|number| number.name.as_str()).collect();
        return Err(source.value("calibration.number", expected, &names.join(", ")));
    }
    if let Some((key, there, here)) = disagreement(&model, &material.contact()) {
        let unit = match key.rsplit('.').next().unwrap_or_default() {
            "modulus" => " Pa",
            "layer_thickness" => " m",
            "rate_coefficient" => " /s",
            "time" => " s",
            row if row.starts_with("equilibrium_forces") => " N",
            _ => "",
        };
        let (there, here) = (format!("{there}{unit}"), format!("{here}{unit}"));
        let expected = format!("{here}, the number of [calibration]; what was changed by hand is calibrated no more");
        return Err(source.value(key, expected, &there));
    }
    Ok(MaterialFile {
        material,
        origin: MaterialOrigin {
            record: table.record.clone(),
            sha256: table.sha256.clone(),
            test: table.test.clone(),
            palpate: table.palpate.clone(),
            samples: table.samples,
        },
    })
}

/// Refuses a file of another version before anything else that may have changed with it.
fn version(source: &Source<'_>) -> Result<(), DescriptionError> {
    #[derive(Deserialize)]
    struct Versioned {
        calibration: Option<Version>,
    }
    #[derive(Deserialize)]
    struct Version {
        version: Option<u64>,
    }
    let found: Versioned = source.tables()?;
    let Some(calibration) = found.calibration else {
        let expected = "the table that palpate calibrate writes; a body without it is a protocol's";
        return Err(source.missing("calibration", expected));
    };
    match calibration.version {
        Some(MATERIAL_VERSION) => Ok(()),
        Some(other) => {
            let expected = format!("{MATERIAL_VERSION}; calibrate again with this version of palpate");
            Err(source.value("calibration.version", expected, &other))
        }
        None => Err(source.missing("calibration.version", "the version of the table, 1")),
    }
}

fn equilibrium(
    source: &Source<'_>,
    name: CalibratedEquilibriumName,
    model: &Contact,
) -> Result<EquilibriumLaw, DescriptionError> {
    match (name, model.specimen().equilibrium()) {
        (CalibratedEquilibriumName::EvenStrain, Equilibrium::EvenStrain) => Ok(EquilibriumLaw::EvenStrain),
        (CalibratedEquilibriumName::Hertz, Equilibrium::Hertz { poisson_ratio }) => Ok(EquilibriumLaw::Hertz {
            poisson_ratio: *poisson_ratio,
        }),
        (CalibratedEquilibriumName::Table, Equilibrium::Measured { .. }) => Ok(EquilibriumLaw::Table),
        (written, other) => {
            let of_body = match other {
                Equilibrium::EvenStrain => "\"even strain\"",
                Equilibrium::Hertz { .. } => "\"hertz\"",
                Equilibrium::Measured { .. } => "\"table\"",
            };
            let written = match written {
                CalibratedEquilibriumName::EvenStrain => "\"even strain\"",
                CalibratedEquilibriumName::Hertz => "\"hertz\"",
                CalibratedEquilibriumName::Table => "\"table\"",
            };
            let expected = format!("{of_body} as in [specimen], what was changed by hand is calibrated no more");
            Err(source.value("calibration.equilibrium", expected, written))
        }
    }
}

/// The law by which v differs.
pub(crate) fn rate_law(rate: RateDependence) -> RateLaw {
    match rate {
        RateDependence::Constant => RateLaw::Constant,
        RateDependence::Strain { .. } => RateLaw::ByStrain,
        RateDependence::Direction { .. } => RateLaw::ByDirection,
    }
}

/// The factor by which v differs, if it does.
pub(crate) fn factor(rate: RateDependence) -> Option<f64> {
    match rate {
        RateDependence::Constant => None,
        RateDependence::Strain { factor } | RateDependence::Direction { factor } => Some(factor),
    }
}

/// Contact displacements of the rows of a table of relaxed forces, but for first touch.
fn levels(model: &Contact) -> Vec<f64> {
    match model.specimen().equilibrium() {
        Equilibrium::Measured { force_per_displacement } => {
            force_per_displacement.points().into_iter().skip(1).map(|(place, _)| place).collect()
        }
        Equilibrium::EvenStrain | Equilibrium::Hertz { .. } => Vec::new(),
    }
}

fn numbers(source: &Source<'_>, tables: &[NumberTable]) -> Result<Vec<MaterialNumber>, DescriptionError> {
    let number = |(index, table): (usize, &NumberTable)| {
        let key = |name: &str| format!("calibration.number[{}].{name}", index + 1);
        let above = |name: &str, value: f64| source.number(&key(name), value, "a number above 0", |value| value > 0.0);
        let unit = unit_of(table.unit.as_deref()).ok_or_else(|| {
            source.value(key("unit"), "Pa, N, m, s or /s, or none", table.unit.as_deref().unwrap_or_default())
        })?;
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
        if let Some(error) = table.standard_error {
            source.number(&key("standard_error"), error, "a number of 0 or more", |error| error >= 0.0)?;
        }
        Ok(MaterialNumber {
            name: table.name.clone(),
            unit,
            estimate: Estimate {
                value,
                standard_error: table.standard_error,
                interval,
            },
        })
    };
    tables.iter().enumerate().map(number).collect()
}

fn uncertainty(source: &Source<'_>, table: &CalibrationTable) -> Result<Option<MaterialUncertainty>, DescriptionError> {
    let Some(covariance) = &table.covariance else {
        return Ok(None);
    };
    let key = "calibration.covariance";
    let size = table.number.len();
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
    for (index, number) in table.number.iter().enumerate() {
        let deviation = entry(index, index).sqrt();
        agrees_with(source, number, index, deviation, confidence)?;
    }
    let freedom = table.freedom.unwrap_or(f64::INFINITY);
    if freedom.is_nan() || freedom <= 0.0 {
        return Err(source.value("calibration.freedom", "a number above 0", &freedom));
    }
    Ok(Some(MaterialUncertainty {
        confidence,
        freedom,
        covariance: covariance.clone(),
    }))
}

/// Whether standard error and interval of a number are such as the deviation of its logarithm has.
///
/// The deviation is that for residuals that correlate, so the standard error for white ones is no larger; and an interval of half the coverage or more is
/// wider than the deviation.
fn agrees_with(
    source: &Source<'_>,
    number: &NumberTable,
    index: usize,
    deviation: f64,
    confidence: f64,
) -> Result<(), DescriptionError> {
    /// Room for residuals that alternate, and for rounding.
    const ROOM: f64 = 0.5;
    const HAND: &str = "what was changed by hand is calibrated no more";
    let key = |name: &str| format!("calibration.number[{}].{name}", index + 1);
    if let Some(error) = number.standard_error.filter(|error| ROOM * error / number.value > deviation) {
        let expected = format!("an error of {} at most by the covariance, {HAND}", deviation * number.value);
        return Err(source.value(key("standard_error"), expected, &error));
    }
    if let Some(&[low, high]) = number.interval.as_deref()
        && confidence >= 0.5
        && (high / low).ln() < ROOM * deviation
    {
        let expected = format!("an interval as wide as the covariance says, {HAND}");
        return Err(source.value(key("interval"), expected, &format!("{low} to {high}")));
    }
    Ok(())
}

fn shown(source: &Source<'_>, table: &ShownTable) -> Result<Shown, DescriptionError> {
    let quantity = |name: &str, written: &QuantityText, dimension| {
        let key = format!("calibration.shown.{name}");
        let value = source.si(&key, written, dimension)?;
        source.number(&key, value, "0 or more", |value| value >= 0.0)
    };
    let shown = Shown {
        longest_hold: quantity("longest_hold", &table.longest_hold, Dimension::Time)?,
        deepest: quantity("deepest", &table.deepest, Dimension::Length)?,
        fastest: quantity("fastest", &table.fastest, Dimension::Speed)?,
        slowest: quantity("slowest", &table.slowest, Dimension::Speed)?,
        largest_force: quantity("largest_force", &table.largest_force, Dimension::Force)?,
    };
    if shown.slowest > shown.fastest {
        let expected = format!("no more than the fastest, {} m/s", shown.fastest);
        return Err(source.value("calibration.shown.slowest", expected, &format!("{} m/s", shown.slowest)));
    }
    Ok(shown)
}

/// Numbers of the latency law and its layers, there and here.
fn latency_pairs(there: &ContactModel, here: &ContactModel) -> [(String, f64, f64); 3] {
    let thickness = |model: &ContactModel| model.specimen.depth() / model.layers.count();
    [
        ("law.exponent".to_owned(), there.law.exponent(), here.law.exponent()),
        ("law.rate_coefficient".to_owned(), there.law.rate_coefficient(), here.law.rate_coefficient()),
        ("contact.layer_thickness".to_owned(), thickness(there), thickness(here)),
    ]
}

/// A key whose number differs between the two, with both.
fn disagreement(model: &Contact, contact: &Contact) -> Option<(String, f64, f64)> {
    let mut pairs = Vec::new();
    match (model, contact) {
        (
            Contact::Latency { model: there, rate },
            Contact::Latency {
                model: here,
                rate: calibrated,
            },
        ) if rate_law(*rate) == rate_law(*calibrated) => {
            pairs.extend(latency_pairs(there, here));
            if let (Some(a), Some(b), Some(name)) =
                (factor(*rate), factor(*calibrated), rate_law(*calibrated).factor_name())
            {
                pairs.push((format!("law.{name}"), a, b));
            }
        }
        (Contact::Linear(there), Contact::Linear(here)) => {
            let terms = [there, here].map(|contact| contact.law.terms());
            let count = terms.map(<[_]>::len);
            if count[0] != count[1] || there.memory != here.memory {
                return Some(("law".to_owned(), count[0] as f64, count[1] as f64));
            }
            for (index, (a, b)) in terms[0].iter().zip(terms[1]).enumerate() {
                let key = |name: &str| {
                    if count[0] == 1 { format!("law.{name}") } else { format!("law.terms[{}].{name}", index + 1) }
                };
                pairs.push((key("overshoot"), a.overshoot, b.overshoot));
                pairs.push((key("time"), 1.0 / a.rate, 1.0 / b.rate));
            }
        }
        _ => return Some(("law.name".to_owned(), 0.0, 0.0)),
    }
    let (there, here) = (model.specimen(), contact.specimen());
    match (there.equilibrium(), here.equilibrium()) {
        (
            Equilibrium::Measured {
                force_per_displacement: a,
            },
            Equilibrium::Measured {
                force_per_displacement: b,
            },
        ) => {
            let key = |row: usize| format!("specimen.equilibrium_forces[{}]", row + 1);
            let rows = a.points().into_iter().zip(b.points()).enumerate();
            pairs.extend(rows.map(|(row, ((place, a), (_, b)))| (key(row), a * place, b * place)));
        }
        _ => pairs.push(("specimen.modulus".to_owned(), there.modulus(), here.modulus())),
    }
    pairs.into_iter().find(|(_, a, b)| (a - b).abs() > 1e-9 * b.abs())
}
