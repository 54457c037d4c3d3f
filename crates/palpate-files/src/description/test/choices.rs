//! Choices that are written the same in a description and on a command line.

use palpate::{
    segment::{ContactChoice, HoldStart, TouchMethod},
    units::{self, Dimension, UnitError},
};

/// A text that is none of the choices.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("expected {expected}, found \"{found}\"")]
pub struct ChoiceError {
    /// What would be accepted.
    pub expected: &'static str,
    /// What stood there.
    pub found: String,
    /// What is wrong with the quantity in it, if it seems to hold one.
    pub source: Option<UnitError>,
}

impl ChoiceError {
    /// What would help.
    #[must_use]
    pub fn hint(&self) -> String {
        match &self.source {
            Some(error) => error.to_string(),
            None => format!("write {}", self.expected),
        }
    }
}

const HOLD_START: &str = "\"peak\", \"settled\" or a time after the peak such as \"peak + 0.5 s\"";
const TOUCH: &str = "\"auto\", \"as recorded\", a rule (\"loading curve\", \"threshold\", \"two lines\", \"hertz\", \"ratio of variances\") or a displacement such as \"2.5 mm\"";
const RULES: [TouchMethod; 5] = [
    TouchMethod::LoadingCurve,
    TouchMethod::Threshold,
    TouchMethod::TwoLines,
    TouchMethod::Hertz,
    TouchMethod::VarianceRatio,
];

/// From where in a hold laws are fitted: `peak`, `settled`, or `peak + 0.5 s`.
///
/// # Errors
/// [`ChoiceError`] for any other text, also for a time that is negative.
///
/// ```
/// use palpate::segment::HoldStart;
/// use palpate_files::description::parse_hold_start;
/// assert_eq!(parse_hold_start("peak + 500 ms")?, HoldStart::AfterPeak(0.5));
/// # Ok::<(), palpate_files::description::ChoiceError>(())
/// ```
pub fn parse_hold_start(text: &str) -> Result<HoldStart, ChoiceError> {
    let error = |source| ChoiceError {
        expected: HOLD_START,
        found: text.to_owned(),
        source,
    };
    let delay = match text.trim() {
        "peak" => return Ok(HoldStart::Peak),
        "settled" => return Ok(HoldStart::Settled),
        other => other.strip_prefix("peak").map(str::trim_start),
    };
    let delay = delay.and_then(|rest| rest.strip_prefix('+')).ok_or_else(|| error(None))?;
    let seconds = units::parse(delay, Dimension::Time).map_err(|source| error(Some(source)))?;
    if seconds < 0.0 { Err(error(None)) } else { Ok(HoldStart::AfterPeak(seconds)) }
}

/// How first touch is found: `auto`, `as recorded`, by one rule such as `threshold`, or at a displacement such as `2.5 mm`.
///
/// # Errors
/// [`ChoiceError`] for any other text.
///
/// ```
/// use palpate::segment::ContactChoice;
/// use palpate_files::description::parse_touch;
/// assert_eq!(parse_touch("as recorded")?, ContactChoice::AsRecorded);
/// assert_eq!(parse_touch("2.5 mm")?, ContactChoice::Displacement(0.0025));
/// # Ok::<(), palpate_files::description::ChoiceError>(())
/// ```
pub fn parse_touch(text: &str) -> Result<ContactChoice, ChoiceError> {
    match text.trim() {
        "auto" => Ok(ContactChoice::Auto),
        "as recorded" | "as-recorded" => Ok(ContactChoice::AsRecorded),
        other => match (rule(other), units::parse(other, Dimension::Length)) {
            (Some(rule), _) => Ok(ContactChoice::By(rule)),
            (None, Ok(metres)) => Ok(ContactChoice::Displacement(metres)),
            (None, Err(source)) => Err(ChoiceError {
                expected: TOUCH,
                found: text.to_owned(),
                source: Some(source).filter(|source| !matches!(source, UnitError::NotANumber { .. })),
            }),
        },
    }
}

/// A rule by its name, whose words may be joined by hyphens.
fn rule(name: &str) -> Option<TouchMethod> {
    RULES.into_iter().find(|rule| rule.name() == name.replace('-', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_of_holds() {
        for (text, start) in [
            ("peak", HoldStart::Peak),
            (" settled ", HoldStart::Settled),
            ("peak + 0.5 s", HoldStart::AfterPeak(0.5)),
            ("peak+2s", HoldStart::AfterPeak(2.0)),
            ("peak + 0 s", HoldStart::AfterPeak(0.0)),
        ] {
            assert_eq!(parse_hold_start(text), Ok(start), "{text}");
        }
        for text in ["", "top", "peak 0.5 s", "peak + ", "peak + -1 s", "peak + 1 mm", "0.5 s"] {
            let error = parse_hold_start(text).unwrap_err();
            assert!(error.to_string().contains("peak + 0.5 s"), "{error}");
        }
        let error = parse_hold_start("peak + 3").unwrap_err();
        assert!(error.hint().contains("expected a unit"), "{}", error.hint());
    }

    #[test]
    fn touches() {
        assert_eq!(parse_touch("auto"), Ok(ContactChoice::Auto));
        assert_eq!(parse_touch("-1 mm"), Ok(ContactChoice::Displacement(-0.001)));
        let error = parse_touch("first").unwrap_err();
        assert!(error.to_string().contains("\"as recorded\""), "{error}");
        assert!(error.hint().contains("2.5 mm"), "{}", error.hint());
        let error = parse_touch("2.5").unwrap_err();
        assert!(error.hint().contains("expected a unit"), "{}", error.hint());
    }
}
