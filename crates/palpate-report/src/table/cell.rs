//! What stands in one place of a table.

use crate::number::{exact, significant, with_error};

/// One value of a table.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cell {
    /// A number and the significant digits that people see.
    Number(f64, usize),
    /// A number and its standard error, which decides how far people see it; machines get the number alone.
    Uncertain(f64, f64),
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

    /// What a person reads; a missing value is a dash.
    #[must_use]
    pub fn shown(&self) -> String {
        match self {
            Self::Number(value, digits) => significant(*value, *digits),
            Self::Uncertain(value, error) => with_error(*value, *error),
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
            Self::Number(value, _) | Self::Uncertain(value, _) => exact(*value + 0.0),
            Self::Integer(value) => value.to_string(),
            Self::Text(text) => text.clone(),
            Self::Missing(_) => String::new(),
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
