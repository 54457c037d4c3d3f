//! Options as they are typed on a command line: what parses them, and what one of several may be.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use palpate::fit::{BootstrapOptions, IntervalMethod, Loss, SampleChoice};
use palpate::forecast::RampChoice;
use palpate::grip::{Control, Objective};
use palpate::laws::Law;
use palpate::units::{Dimension, parse, split_number};
use palpate_files::description::NamedColumns;
use palpate_report::table::CsvLocale;

/// A value of an option: its name, what it is, and what it says.
pub type Choice<T> = (&'static str, &'static str, T);

/// What the gripper holds.
pub(crate) const CONTROLS: &[Choice<Control>] = &[
    ("position", "Position hold: the force relaxes", Control::Position),
    ("force", "Force hold: the body creeps", Control::Force),
];

/// What a squeeze should have least of.
pub(crate) const OBJECTIVES: &[Choice<Objective>] = &[
    ("squeeze", "Travel of the jaws", Objective::Squeeze),
    ("peak-force", "Peak force, to avoid bruising", Objective::PeakForce),
    ("work", "Work of the jaws", Objective::Work),
];

/// Loading history before a hold, as linear laws take it.
pub(crate) const RAMPS: &[Choice<RampChoice>] = &[
    ("step", "A step at the start of the fit", RampChoice::Step),
    ("measured", "The measured displacement", RampChoice::Measured),
];

/// What intervals rest on.
pub(crate) const INTERVALS: &[Choice<IntervalMethod>] = &[
    (
        "automatic",
        "Curvature where the law is nearly linear within the interval, else profile likelihood",
        IntervalMethod::Automatic,
    ),
    ("curvature", "Curvature of the residual sum of squares at the optimum", IntervalMethod::Curvature),
    (
        "profile",
        "Profile likelihood: asymmetric, unbounded where the data do not determine a parameter",
        IntervalMethod::Profile,
    ),
    (
        "bootstrap",
        "Refits to resampled residuals, which take long",
        IntervalMethod::Bootstrap(BootstrapOptions::USUAL),
    ),
];

/// Language of the readers of CSV files.
pub const CSV_LOCALES: &[Choice<CsvLocale>] = &[
    ("en", "English: decimal point, cells separated by commas", CsvLocale::En),
    ("de", "German: decimal comma, cells separated by semicolons", CsvLocale::De),
    ("es", "Spanish (Spain): decimal comma, cells separated by semicolons", CsvLocale::Es),
    ("fr", "French: decimal comma, cells separated by semicolons", CsvLocale::Fr),
    ("it", "Italian: decimal comma, cells separated by semicolons", CsvLocale::It),
    ("nl", "Dutch: decimal comma, cells separated by semicolons", CsvLocale::Nl),
    ("pl", "Polish: decimal comma, cells separated by semicolons", CsvLocale::Pl),
    ("pt", "Portuguese: decimal comma, cells separated by semicolons", CsvLocale::Pt),
];

/// Loss function of the residuals.
pub(crate) const LOSSES: &[Choice<Loss>] = &[
    ("squares", "Least squares", Loss::Squares),
    ("huber", "Quadratic for small residuals, linear for large ones", Loss::Huber),
    ("tukey", "Quadratic for small residuals, constant for large ones", Loss::Tukey),
];

/// One of such values.
pub fn one_of<T: Clone + Send + Sync>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T> {
    let names = choices.iter().map(|(name, about, _)| PossibleValue::new(*name).help(*about));
    PossibleValuesParser::new(names).try_map(|typed| {
        let chosen = choices.iter().find(|(name, ..)| *name == typed).map(|(.., value)| value.clone());
        chosen.ok_or("unknown choice")
    })
}

/// A time as it is typed.
#[must_use]
pub fn seconds(time: f64) -> String {
    format!("{time} s")
}

/// A time above 0.
///
/// # Errors
/// What was expected.
pub fn time(text: &str) -> Result<f64, String> {
    positive(text, Dimension::Time)
}

/// A force above 0.
///
/// # Errors
/// What was expected.
pub fn force(text: &str) -> Result<f64, String> {
    positive(text, Dimension::Force)
}

/// A length above 0.
///
/// # Errors
/// What was expected.
pub fn length(text: &str) -> Result<f64, String> {
    positive(text, Dimension::Length)
}

/// A mass above 0.
///
/// # Errors
/// What was expected.
pub fn mass(text: &str) -> Result<f64, String> {
    positive(text, Dimension::Mass)
}

/// A speed above 0.
///
/// # Errors
/// What was expected.
pub fn speed(text: &str) -> Result<f64, String> {
    positive(text, Dimension::Speed)
}

/// An acceleration.
///
/// # Errors
/// What was expected.
pub fn acceleration(text: &str) -> Result<f64, String> {
    parse(text, Dimension::Acceleration).map_err(|error| error.to_string())
}

/// A torque.
///
/// # Errors
/// What was expected.
pub fn torque(text: &str) -> Result<f64, String> {
    parse(text, Dimension::Torque).map_err(|error| error.to_string())
}

/// A distance from an axis above 0, or "on the axis".
///
/// # Errors
/// What was expected.
pub fn off_centre(text: &str) -> Result<f64, String> {
    if text == "on the axis" { Ok(0.0) } else { length(text) }
}

/// How long something is to hold, or "always".
///
/// # Errors
/// What was expected.
pub fn hold_time(text: &str) -> Result<f64, String> {
    if text.trim() == "always" { Ok(f64::INFINITY) } else { time(text) }
}

/// `2.1..3 N`, or with a unit at both ends.
///
/// # Errors
/// What was expected.
pub fn band(text: &str) -> Result<(f64, f64), String> {
    let (low, high) = text.split_once("..").ok_or("expected two forces, such as \"2.1..3 N\"")?;
    let unit = split_number(high.trim()).1;
    let low = if split_number(low.trim()).1.is_empty() { format!("{low} {unit}") } else { low.to_owned() };
    Ok((force(&low)?, force(high)?))
}

fn positive(text: &str, dimension: Dimension) -> Result<f64, String> {
    match parse(text, dimension) {
        Ok(value) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("expected a {} above 0", dimension.name())),
        Err(error) => Err(error.to_string()),
    }
}

/// A number without a unit that is one of those `expected`.
///
/// # Errors
/// What was expected.
pub fn number(text: &str, is_one: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number| is_one(*number));
    number.ok_or_else(|| format!("expected {expected}"))
}

/// An exponent of a law.
///
/// # Errors
/// What was expected.
pub fn exponent(text: &str) -> Result<f64, String> {
    let list = one_by_one(text).unwrap_or_else(|| "1,3,5".to_owned());
    number(
        text,
        |n| n.is_finite() && n > 0.0,
        &format!("numbers above 0 with commas between them, such as {list}"),
    )
}

/// A list whose values something else than commas parts, as it should be written.
fn one_by_one(text: &str) -> Option<String> {
    let pieces = text.split([';', '|', '/', ' ']).filter(|piece| !piece.is_empty());
    let pieces: Vec<&str> = pieces.collect();
    (pieces.len() > 1).then(|| pieces.join(","))
}

/// A law by its name.
///
/// # Errors
/// What was expected.
pub fn law(text: &str) -> Result<Law, String> {
    text.trim().parse::<Law>().map_err(|error| match one_by_one(text) {
        Some(list) => format!("expected laws with commas between them, such as {list}"),
        None => error.to_string(),
    })
}

/// A share of a hold.
///
/// # Errors
/// What was expected.
pub fn share(text: &str) -> Result<f64, String> {
    let list = one_by_one(text).unwrap_or_else(|| "0.25,0.5".to_owned());
    let expected = format!("shares of the hold between 0 and 1 with commas between them, such as {list}");
    number(text, |share| share > 0.0 && share < 1.0, &expected)
}

/// Columns of a record by their names.
///
/// # Errors
/// What was expected.
pub fn columns(text: &str) -> Result<NamedColumns, String> {
    NamedColumns::parse(text).map_err(|error| match &error.source {
        Some(unit) => unit.to_string(),
        None => error.to_string(),
    })
}

/// A coverage of intervals.
///
/// # Errors
/// What was expected.
pub fn coverage(text: &str) -> Result<f64, String> {
    number(text, |share| share > 0.0 && share < 1.0, "a coverage between 0 and 1, such as 0.95")
}

/// Which samples are fitted.
///
/// # Errors
/// What was expected.
pub fn samples(text: &str) -> Result<SampleChoice, String> {
    /// Fewer can carry no law.
    const FEWEST: usize = 10;
    match text.trim().split_once(':') {
        None if text.trim() == "all" => Ok(SampleChoice::All),
        Some(("log", count)) => match count.parse() {
            Ok(count) if count >= FEWEST => Ok(SampleChoice::LogSpaced(count)),
            _ => Err(format!("expected at least {FEWEST} samples, such as log:400")),
        },
        _ => Err("expected all or log:N, such as log:400".to_owned()),
    }
}
