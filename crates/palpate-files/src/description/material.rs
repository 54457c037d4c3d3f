//! A material file: a calibrated body as a protocol has it, with how sure its numbers are.
//!
//! Its tables `[specimen]`, `[law]` and `[contact]` are those of a protocol, so that whatever takes a body takes a material; the table
//! `[calibration]` holds the same numbers with their errors, and where they come from.

use std::{fmt::Write, path::Path};

use palpate::{
    calibrate::{
        Body, CalibratedContact, Candidate, EquilibriumLaw, Material, MaterialNumber, MaterialUncertainty,
        MaterialUnit, RateLaw, Shown,
    },
    contact::{Equilibrium, RateDependence, Shape, Sides},
    fit::Estimate,
    latency::LatencyLaw,
    laws::Law,
    number::{exact, significant},
    simulate::{ContactModel, LinearContact, Memory, Separation},
    units::Dimension,
};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    error::DescriptionError,
    law::{LawTable, Model},
    protocol::{self, ContactTable},
    quantity::QuantityText,
    source::{self, Source},
    specimen::SpecimenTable,
};

/// Version of the table `[calibration]` that is written and read.
pub const MATERIAL_VERSION: u64 = 1;

/// A calibrated body with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialFile {
    /// The body.
    pub material: Material,
    /// Where its numbers come from.
    pub origin: MaterialOrigin,
}

/// Where the numbers of a material come from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MaterialOrigin {
    /// The record.
    pub record: String,
    /// SHA-256 of the record's file, hexadecimal.
    pub sha256: String,
    /// Its test description, if there was one.
    pub test: Option<String>,
    /// Version of palpate that calibrated.
    pub palpate: String,
    /// Samples that were fitted.
    pub samples: usize,
}

/// A calibrated body: a protocol's specimen, law and contact, and the same numbers with their errors.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate material", rename = "Material")]
pub(super) struct MaterialTables {
    pub(super) specimen: SpecimenTable,
    pub(super) law: LawTable,
    #[serde(default)]
    pub(super) contact: ContactTable,
    calibration: CalibrationTable,
}

/// What was calibrated, from what, and how sure it is.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Calibration")]
struct CalibrationTable {
    /// Version of this table: 1.
    #[serde(rename = "version")]
    _version: u64,
    /// The record that was calibrated on.
    record: String,
    /// SHA-256 of its file.
    sha256: String,
    /// Its test description.
    test: Option<String>,
    /// Version of palpate that calibrated.
    palpate: String,
    /// Samples that were fitted.
    samples: usize,
    /// The law as it was fitted: latency (n found), latency:5 (n given), standard-linear-solid, prony:K or fung:K.
    law: String,
    /// The law of the relaxed force as it was fitted.
    equilibrium: EquilibriumName,
    /// Standard deviation of what the model left of the measured force.
    residual: QuantityText,
    /// Coverage of the intervals, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    confidence: Option<f64>,
    /// Degrees of freedom of the residual variance.
    freedom: Option<f64>,
    /// The numbers in order.
    #[schemars(extend("minItems" = 1))]
    number: Vec<NumberTable>,
    /// Covariance of the natural logarithms of the numbers, row by row in their order.
    covariance: Option<Vec<Vec<f64>>>,
    /// What the test has shown: questions beyond it are extrapolations.
    shown: ShownTable,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[schemars(rename = "CalibratedEquilibrium")]
enum EquilibriumName {
    /// Force = modulus × displacement/depth × contact area.
    #[serde(rename = "even strain")]
    EvenStrain,
    /// Hertz's law.
    #[serde(rename = "hertz")]
    Hertz,
    /// The rows of specimen.equilibrium_forces.
    #[serde(rename = "table")]
    Table,
}

/// One number with its errors; a number that was given has none.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CalibratedNumber")]
struct NumberTable {
    /// Its name, such as modulus, exponent, rate_coefficient, layer_thickness or time_1.
    name: String,
    /// Its unit; none of a pure number.
    unit: Option<String>,
    /// The best value, in its unit.
    value: f64,
    /// Standard error, in its unit.
    standard_error: Option<f64>,
    /// Lower and upper end of the confidence interval, in its unit.
    #[schemars(extend("minItems" = 2, "maxItems" = 2))]
    interval: Option<Vec<f64>>,
}

/// What the test has shown.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Shown")]
struct ShownTable {
    /// The longest hold.
    longest_hold: QuantityText,
    /// The deepest squeeze, as travel of the jaw since first touch.
    deepest: QuantityText,
    /// The fastest ramp.
    fastest: QuantityText,
    /// The slowest ramp.
    slowest: QuantityText,
    /// The largest force.
    largest_force: QuantityText,
}

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
    let model = protocol::model(source, &tables.specimen, &tables.law, &tables.contact)?;
    let table = &tables.calibration;
    let law: Law = table.law.parse().map_err(|error| {
        source.value("calibration.law", "a law such as \"latency\" or \"prony:2\"", &format!("{error}"))
    })?;
    let candidate = Candidate {
        law,
        equilibrium: equilibrium(source, table.equilibrium, &model)?,
        rate: match &model {
            Model::Varying(contact) => rate_law(contact.rate),
            Model::Latency(_) | Model::Linear(_) => RateLaw::Constant,
        },
    };
    let material = Material {
        body: Body {
            shape: model.specimen().shape().clone(),
            sides: model.specimen().sides(),
            separation: model.contact().separation(),
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

fn equilibrium(source: &Source<'_>, name: EquilibriumName, model: &Model) -> Result<EquilibriumLaw, DescriptionError> {
    match (name, model.specimen().equilibrium()) {
        (EquilibriumName::EvenStrain, Equilibrium::EvenStrain) => Ok(EquilibriumLaw::EvenStrain),
        (EquilibriumName::Hertz, Equilibrium::Hertz { poisson_ratio }) => Ok(EquilibriumLaw::Hertz {
            poisson_ratio: *poisson_ratio,
        }),
        (EquilibriumName::Table, Equilibrium::Measured { .. }) => Ok(EquilibriumLaw::Table),
        (written, other) => {
            let of_body = match other {
                Equilibrium::EvenStrain => "\"even strain\"",
                Equilibrium::Hertz { .. } => "\"hertz\"",
                Equilibrium::Measured { .. } => "\"table\"",
            };
            let written = match written {
                EquilibriumName::EvenStrain => "\"even strain\"",
                EquilibriumName::Hertz => "\"hertz\"",
                EquilibriumName::Table => "\"table\"",
            };
            let expected = format!("{of_body} as in [specimen], what was changed by hand is calibrated no more");
            Err(source.value("calibration.equilibrium", expected, written))
        }
    }
}

fn rate_law(rate: RateDependence) -> RateLaw {
    match rate {
        RateDependence::Constant => RateLaw::Constant,
        RateDependence::Strain { .. } => RateLaw::ByStrain,
        RateDependence::Direction { .. } => RateLaw::ByDirection,
    }
}

/// The factor by which v differs, if it does.
fn factor(rate: RateDependence) -> Option<f64> {
    match rate {
        RateDependence::Constant => None,
        RateDependence::Strain { factor } | RateDependence::Direction { factor } => Some(factor),
    }
}

/// Contact displacements of the rows of a table of relaxed forces, but for first touch.
fn levels(model: &Model) -> Vec<f64> {
    match model.specimen().equilibrium() {
        Equilibrium::Measured { force_per_displacement } => {
            force_per_displacement.points().into_iter().skip(1).map(|(place, _)| place).collect()
        }
        Equilibrium::EvenStrain | Equilibrium::Hertz { .. } => Vec::new(),
    }
}

fn unit_of(name: Option<&str>) -> Option<MaterialUnit> {
    UNITS.iter().find(|(_, symbol)| *symbol == name).map(|(unit, _)| *unit)
}

/// Units of numbers as they are written.
const UNITS: [(MaterialUnit, Option<&str>); 6] = [
    (MaterialUnit::One, None),
    (MaterialUnit::Second, Some("s")),
    (MaterialUnit::PerSecond, Some("/s")),
    (MaterialUnit::Metre, Some("m")),
    (MaterialUnit::Newton, Some("N")),
    (MaterialUnit::Pascal, Some("Pa")),
];

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
fn disagreement(model: &Model, contact: &CalibratedContact) -> Option<(String, f64, f64)> {
    let mut pairs = Vec::new();
    match (model, contact) {
        (Model::Latency(there), CalibratedContact::Latency(here)) => pairs.extend(latency_pairs(there, here)),
        (Model::Varying(there), CalibratedContact::Varying(here)) => {
            pairs.extend(latency_pairs(&there.model, &here.model));
            if let (Some(a), Some(b), Some(name)) =
                (factor(there.rate), factor(here.rate), rate_law(here.rate).factor_name())
            {
                pairs.push((format!("law.{name}"), a, b));
            }
        }
        (Model::Linear(there), CalibratedContact::Linear(here)) => {
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

impl MaterialFile {
    /// The file as text, with intervals in comments.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut out = self.head();
        self.write_body(&mut out);
        self.write_law(&mut out);
        self.write_calibration(&mut out);
        out
    }

    fn head(&self) -> String {
        let Self { material, origin } = self;
        format!(
            "# Calibrated by palpate {} on {}: {}, {} samples,\n# {} N left over. palpate predict takes this file, and a protocol that says material = \"…\".\n",
            origin.palpate,
            comment(&origin.record),
            material.candidate,
            origin.samples,
            significant(material.noise, 3)
        )
    }

    /// The interval of a number as a comment, in `factor` of its SI unit.
    fn interval(&self, name: &str, factor: f64, unit: &str) -> String {
        let share = self.material.uncertainty.as_ref().map(|uncertainty| 100.0 * uncertainty.confidence);
        let interval = self.material.estimate(name).and_then(|estimate| estimate.interval);
        match (interval, share) {
            (Some((low, high)), Some(share)) => format!(
                "   # {} to {}{unit} ({} %)",
                significant(factor * low, 4),
                significant(factor * high, 4),
                exact(round(share))
            ),
            _ => String::new(),
        }
    }

    fn write_body(&self, out: &mut String) {
        let body = &self.material.body;
        out.push_str("\n[specimen]\n");
        let mut line = |text: String| {
            out.push_str(&text);
            out.push('\n');
        };
        let length = |value: f64| format!("\"{} m\"", exact(value));
        match &body.shape {
            Shape::Ball { radius } => line(format!("shape = \"ball\"\nradius = {}", length(*radius))),
            Shape::Pad { radius, thickness } => {
                line(format!("shape = \"pad\"\nradius = {}\nthickness = {}", length(*radius), length(*thickness)));
            }
            Shape::Prism { area, length: free } => {
                line(format!("shape = \"block\"\narea = \"{} m^2\"\nlength = {}", exact(*area), length(*free)));
            }
            Shape::Profile { depth, area } => {
                let row = |(place, area): (f64, f64)| format!("  [{}, \"{} m^2\"],", length(place), exact(area));
                let rows: Vec<String> = area.points().into_iter().map(row).collect();
                line(format!("shape = \"profile\"\ndepth = {}\nareas = [\n{}\n]", length(*depth), rows.join("\n")));
            }
        }
        let contact = self.material.contact();
        let specimen = contact.specimen();
        let modulus =
            format!("modulus = \"{} Pa\"{}", exact(specimen.modulus()), self.interval("modulus", 1e-3, " kPa"));
        match specimen.equilibrium() {
            Equilibrium::EvenStrain => line(modulus),
            Equilibrium::Hertz { poisson_ratio } => {
                line(format!("{modulus}\nequilibrium = \"hertz\"\npoisson_ratio = {poisson_ratio:?}"));
            }
            Equilibrium::Measured { force_per_displacement } => {
                line("equilibrium_forces = [".to_owned());
                for (row, (place, ratio)) in force_per_displacement.points().into_iter().enumerate() {
                    let interval = self.interval(&format!("equilibrium_force_{row}"), 1.0, " N");
                    line(format!("  [{}, \"{} N\"],{interval}", length(place), exact(ratio * place)));
                }
                line("]".to_owned());
            }
        }
        let sides = match body.sides {
            Sides::One => "one side",
            Sides::Two => "two sides",
        };
        line(format!(
            "\n[contact]\nsqueezed_from = \"{sides}\"\nseparation = {}",
            body.separation == Separation::Unilateral
        ));
        if let Some(thickness) = self.material.estimate("layer_thickness") {
            let interval = self.interval("layer_thickness", 1e3, " mm");
            line(format!("layer_thickness = {}{interval}", length(thickness.value)));
        }
    }

    fn write_law(&self, out: &mut String) {
        out.push_str("\n[law]\n");
        match self.material.contact() {
            CalibratedContact::Latency(model) => self.write_latency(out, model.law),
            CalibratedContact::Varying(contact) => {
                self.write_latency(out, contact.model.law);
                if let (Some(name), Some(factor)) = (rate_law(contact.rate).factor_name(), factor(contact.rate)) {
                    let _ = writeln!(out, "{name} = {factor:?}{}", self.interval(name, 1.0, ""));
                }
            }
            CalibratedContact::Linear(LinearContact { law, memory, .. }) => {
                let time = |rate: f64| format!("\"{} s\"", exact(1.0 / rate));
                let _ = match law.terms() {
                    [only] if memory == Memory::Strain => writeln!(
                        out,
                        "name = \"standard-linear-solid\"\novershoot = {:?}{}\ntime = {}{}",
                        only.overshoot,
                        self.interval("overshoot_1", 1.0, ""),
                        time(only.rate),
                        self.interval("time_1", 1.0, " s"),
                    ),
                    terms => {
                        let row = |(index, term): (usize, &palpate::simulate::LinearTerm)| {
                            let interval = self.interval(&format!("time_{}", index + 1), 1.0, " s");
                            format!("  {{ overshoot = {:?}, time = {} }},{interval}", term.overshoot, time(term.rate))
                        };
                        let rows: Vec<String> = terms.iter().enumerate().map(row).collect();
                        let memory = if memory == Memory::Force { "\nmemory = \"force\"" } else { "" };
                        writeln!(out, "name = \"prony\"{memory}\nterms = [\n{}\n]", rows.join("\n"))
                    }
                };
            }
        }
    }

    fn write_latency(&self, out: &mut String, law: LatencyLaw) {
        let _ = writeln!(
            out,
            "name = \"latency\"\nexponent = {:?}{}\nrate_coefficient = \"{} /s\"{}",
            law.exponent(),
            self.interval("exponent", 1.0, ""),
            exact(law.rate_coefficient()),
            self.interval("rate_coefficient", 1.0, " /s"),
        );
    }

    fn write_calibration(&self, out: &mut String) {
        let Self { material, origin } = self;
        let equilibrium = match material.candidate.equilibrium {
            EquilibriumLaw::EvenStrain => "even strain",
            EquilibriumLaw::Hertz { .. } => "hertz",
            EquilibriumLaw::Table => "table",
        };
        let _ = write!(
            out,
            "\n# What follows is not for editing: the numbers above with their errors, and where they come from.\n[calibration]\nversion = {MATERIAL_VERSION}\nrecord = {}\nsha256 = {}\n",
            quoted(&origin.record),
            quoted(&origin.sha256)
        );
        if let Some(test) = &origin.test {
            let _ = writeln!(out, "test = {}", quoted(test));
        }
        let _ = writeln!(
            out,
            "palpate = {}\nsamples = {}\nlaw = {}\nequilibrium = \"{equilibrium}\"\nresidual = \"{} N\"",
            quoted(&origin.palpate),
            origin.samples,
            quoted(&material.candidate.law.to_string()),
            exact(material.noise)
        );
        let list = |values: &[f64]| {
            let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            format!("[{}]", values.join(", "))
        };
        if let Some(uncertainty) = &material.uncertainty {
            let rows: Vec<String> = uncertainty.covariance.iter().map(|row| format!("  {},", list(row))).collect();
            let _ = writeln!(
                out,
                "confidence = {:?}\nfreedom = {:?}\n# of the natural logarithms of the numbers, in their order\ncovariance = [\n{}\n]",
                uncertainty.confidence,
                uncertainty.freedom,
                rows.join("\n")
            );
        }
        let shown = &material.shown;
        let _ = writeln!(
            out,
            "\n[calibration.shown]\nlongest_hold = \"{} s\"\ndeepest = \"{} m\"\nfastest = \"{} m/s\"\nslowest = \"{} m/s\"\nlargest_force = \"{} N\"",
            exact(shown.longest_hold),
            exact(shown.deepest),
            exact(shown.fastest),
            exact(shown.slowest),
            exact(shown.largest_force)
        );
        for number in &material.numbers {
            let estimate = &number.estimate;
            let _ = writeln!(out, "\n[[calibration.number]]\nname = {}", quoted(&number.name));
            if let Some((_, Some(unit))) = UNITS.iter().find(|(unit, _)| *unit == number.unit) {
                let _ = writeln!(out, "unit = \"{unit}\"");
            }
            let _ = writeln!(out, "value = {:?}", estimate.value);
            if let Some(error) = estimate.standard_error {
                let _ = writeln!(out, "standard_error = {error:?}");
            }
            if let Some((low, high)) = estimate.interval {
                let _ = writeln!(out, "interval = {}", list(&[low, high]));
            }
        }
    }
}

/// A share in per cent without the last digits of its product with 100.
fn round(share: f64) -> f64 {
    (1e9 * share).round() / 1e9
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A text that ends no comment.
fn comment(text: &str) -> String {
    text.replace(|letter: char| letter.is_control(), " ")
}

/// The tables of a protocol whose body may be that of a material file: `material = "file"` stands for specimen, law and contact.
pub(super) fn protocol_tables<T: serde::de::DeserializeOwned>(source: &Source<'_>) -> Result<T, DescriptionError> {
    #[derive(Deserialize)]
    struct Named {
        material: Option<toml::Value>,
    }
    let named: Named = source.tables()?;
    let Some(named) = named.material else {
        return source.tables();
    };
    let toml::Value::String(name) = &named else {
        return Err(source.value("material", "the path of a material file", &named.to_string()));
    };
    let tables: toml::Table = source.tables()?;
    if let Some(key) = BODY.into_iter().find(|key| tables.contains_key(*key)) {
        return Err(source.both(key, "material"));
    }
    let path = source.path.parent().unwrap_or(Path::new("")).join(name);
    let text = source::read(&path, source::LONGEST)?;
    parse_material(&text, &path)?;
    tables_with(source, &text)
}

/// The tables of a protocol with the body of a material that was checked already.
pub(super) fn tables_with<T: serde::de::DeserializeOwned>(
    source: &Source<'_>,
    material: &str,
) -> Result<T, DescriptionError> {
    let path = Path::new("material");
    let mut body: toml::Table = Source { path, text: material }.tables()?;
    let mut tables: toml::Table = source.tables()?;
    tables.remove("material");
    for key in BODY {
        tables.remove(key);
        tables.extend(body.remove_entry(key));
    }
    source.unplaced(tables)
}

/// The tables that say what a body is.
const BODY: [&str; 3] = ["specimen", "law", "contact"];
