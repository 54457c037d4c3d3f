//! Checks of the settings in `[contact]`, `[phases]` and `[fit]` of a test.

use palpate::{
    analysis::AnalysisOptions,
    fit::FitOptions,
    segment::{ContactChoice, GivenHold, HoldMode, SegmentOptions},
    units::Dimension,
};

use super::{
    choices::{self, ChoiceError},
    tables::{FitTable, HoldModeName, PhasesTable},
};
use crate::description::text::{error::DescriptionError, source::Source};

pub(crate) fn touch(source: &Source<'_>, text: &str) -> Result<ContactChoice, DescriptionError> {
    let key = "contact.touch";
    choices::parse_touch(text).map_err(|error| match error.source {
        Some(unit) => source.no_quantity(key, text, unit),
        None => source.value(key, error.expected, &format!("\"{text}\"")),
    })
}

pub(crate) fn segment(source: &Source<'_>, phases: &PhasesTable) -> Result<SegmentOptions, DescriptionError> {
    let usual = SegmentOptions::default();
    let still_below = phases.still_below.map(|share| {
        let expected = "a number between 0 and 1";
        source.number("phases.still_below", share, expected, |share| share > 0.0 && share < 1.0)
    });
    let hold_start = phases.hold_start.as_deref().map(|text| {
        let refused = |error: ChoiceError| source.value("phases.hold_start", error.expected, &format!("\"{text}\""));
        choices::parse_hold_start(text).map_err(refused)
    });
    Ok(SegmentOptions {
        tolerance: source.positive_if("phases.tolerance", phases.tolerance.as_ref(), Dimension::Length)?,
        minimum_hold: source.positive_if("phases.minimum_hold", phases.minimum_hold.as_ref(), Dimension::Time)?,
        still_below: still_below.transpose()?,
        hold_start: hold_start.transpose()?.unwrap_or(usual.hold_start),
    })
}

/// The holds whose limits are given, each after itself; whether a record has them is observed when they meet.
pub(crate) fn given_holds(source: &Source<'_>, phases: &PhasesTable) -> Result<Vec<GivenHold>, DescriptionError> {
    let mut holds: Vec<GivenHold> = Vec::with_capacity(phases.hold.len());
    for (index, hold) in phases.hold.iter().enumerate() {
        let key = |name: &str| format!("phases.hold[{}].{name}", index + 1);
        let from = source.si(&key("from"), &hold.from, Dimension::Time)?;
        let to = source.si(&key("to"), &hold.to, Dimension::Time)?;
        if to <= from {
            let expected = format!("a time after its start (from = \"{}\")", hold.from.text);
            return Err(source.value(key("to"), expected, &format!("\"{}\"", hold.to.text)));
        }
        if let Some(other) = holds.iter().position(|other| from < other.to && other.from < to) {
            let expected = format!("a hold that does not overlap hold {}", other + 1);
            let found = format!("\"{}\" to \"{}\"", hold.from.text, hold.to.text);
            return Err(source.value(key("from"), expected, &found));
        }
        let mode = hold.mode.map(|mode| match mode {
            HoldModeName::Displacement => HoldMode::DisplacementHeld,
            HoldModeName::Force => HoldMode::ForceHeld,
            HoldModeName::Neither => HoldMode::Neither,
        });
        holds.push(GivenHold { from, to, mode });
    }
    Ok(holds)
}

pub(crate) fn fit(source: &Source<'_>, fit: &FitTable) -> Result<(FitOptions, Vec<f64>), DescriptionError> {
    let mut options = FitOptions::default();
    if let Some(share) = fit.confidence {
        let inside = |share| share > 0.0 && share < 1.0;
        let expected = "a number between 0 and 1, such as 0.95";
        options.confidence = source.number("fit.confidence", share, expected, inside)?;
    }
    if let Some([low, high]) = fit.exponent_range {
        if !(low > 0.0 && low < high && high.is_finite()) {
            let expected = "two numbers above 0, the smaller first";
            return Err(source.value("fit.exponent_range", expected, &format!("[{low}, {high}]")));
        }
        options.exponent_range = (low, high);
    }
    let exponents = match &fit.exponents {
        None => AnalysisOptions::default().exponents,
        Some(list) if list.is_empty() && fit.free_exponent == Some(false) => {
            let expected = "one exponent or more, or free_exponent = true";
            return Err(source.value("fit.exponents", expected, "an empty list"));
        }
        Some(list) => list.clone(),
    };
    for (index, exponent) in exponents.iter().enumerate() {
        let key = format!("fit.exponents[{}]", index + 1);
        source.number(&key, *exponent, "a number above 0", |exponent| exponent > 0.0)?;
    }
    Ok((options, exponents))
}
