//! What stands in one place of a table.

use palpate::fit::Estimate;

use crate::number::{exact, significant, with_interval};

/// One value of a table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cell {
    /// A number and the significant digits that people see.
    Number(f64, usize),
    /// A number below which people see that it is smaller than the second one; machines get it as it is.
    AtLeast(f64, f64),
    /// A value with its interval, which decides how many digits people see; machines get the standard error too.
    Estimate(Estimate),
    /// A count.
    Integer(i64),
    /// Words.
    Text(String),
    /// No value, and why.
    Missing(String),
}

impl Cell {
    /// Words.
    #[must_use]
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// No value, and why.
    #[must_use]
    pub fn missing(reason: impl Into<String>) -> Self {
        Self::Missing(reason.into())
    }

    /// A number if there is one, otherwise why there is none.
    #[must_use]
    pub fn number_or(value: Option<f64>, digits: usize, reason: &str) -> Self {
        value.map_or_else(|| Self::missing(reason), |value| Self::Number(value, digits))
    }

    /// What a person reads of a value `factor` times as large; a missing value is a dash.
    #[must_use]
    pub fn shown(&self, factor: f64) -> String {
        match self {
            Self::Number(value, digits) => significant(value * factor, *digits),
            Self::AtLeast(value, least) if value < least => format!("< {}", significant(least * factor, 1)),
            Self::AtLeast(value, _) => significant(value * factor, 2),
            Self::Estimate(estimate) => match estimate.interval {
                Some((low, high)) => with_interval(estimate.value * factor, (low * factor, high * factor)),
                None => significant(estimate.value * factor, 4),
            },
            Self::Integer(value) => value.to_string().replace('-', "−"),
            Self::Text(text) => text.clone(),
            Self::Missing(_) => "–".to_owned(),
        }
    }

    /// What a machine reads; a missing value is empty.
    #[must_use]
    pub fn stored(&self) -> String {
        match self {
            // Adding zero turns −0 into 0.
            Self::Number(value, _) | Self::AtLeast(value, _) | Self::Estimate(Estimate { value, .. }) => {
                exact(*value + 0.0)
            }
            Self::Integer(value) => value.to_string(),
            Self::Text(text) => text.clone(),
            Self::Missing(_) => String::new(),
        }
    }

    /// Standard error, lower and upper end, as a machine reads them; an end that is open is empty.
    pub(crate) fn stored_errors(&self) -> [String; 3] {
        let stored = |value: Option<f64>| value.filter(|value| value.is_finite()).map(exact).unwrap_or_default();
        match self {
            Self::Estimate(estimate) => {
                let (low, high) = estimate.interval.unzip();
                [estimate.standard_error, low, high].map(stored)
            }
            _ => [const { String::new() }; 3],
        }
    }

    /// The size of its value, if it has one.
    pub(crate) fn size(&self) -> Option<f64> {
        match self {
            Self::Number(value, _) | Self::AtLeast(value, _) | Self::Estimate(Estimate { value, .. }) => {
                Some(value.abs()).filter(|v| v.is_finite())
            }
            _ => None,
        }
    }

    /// Which of these reasons is that of a missing value.
    pub(crate) fn reason_in(&self, reasons: &[&str]) -> Option<usize> {
        match self {
            Self::Missing(reason) => reasons.iter().position(|other| other == reason),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Cell;

    /// A probability of 2.2e-308 was 1e-06 in `holds.csv`, as if it were one.
    #[test]
    fn a_floor_is_for_people_alone() {
        let cell = Cell::AtLeast(f64::MIN_POSITIVE, 1e-6);
        assert_eq!((cell.shown(1.0).as_str(), cell.stored().parse()), ("< 1×10⁻⁶", Ok(f64::MIN_POSITIVE)));
        assert_eq!(Cell::AtLeast(0.031_25, 1e-6).shown(1.0), "0.031");
    }
}
