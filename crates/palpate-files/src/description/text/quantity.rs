//! A quantity as it stands in a description: text, not yet a number.

use std::{borrow::Cow, fmt};

use palpate::units::Dimension;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer,
    de::{Error, Visitor},
};

/// A number and its unit, as written. A bare number is kept too, so that what is wrong with it (it lacks a
/// unit) can be stated with the right words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct QuantityText {
    /// Less the quotes.
    pub(crate) text: String,
    bare: bool,
}

impl QuantityText {
    /// A text with its unit.
    pub(crate) fn of(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            bare: false,
        }
    }

    pub(crate) fn bare(number: &impl ToString) -> Self {
        Self {
            text: number.to_string(),
            bare: true,
        }
    }
}

impl JsonSchema for QuantityText {
    fn schema_name() -> Cow<'static, str> {
        "Quantity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "string",
            "description": "A number and its unit, such as \"35 mm\", \"28 kPa\", \"500 mm/min\", \"2e4 /s\" or \"10 s\".",
            "pattern": r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[^\d\s.eE+-].*$",
        })
    }
}

impl fmt::Display for QuantityText {
    /// As it stands in the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.bare { f.write_str(&self.text) } else { write!(f, "\"{}\"", self.text) }
    }
}

impl<'de> Deserialize<'de> for QuantityText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Written)
    }
}

struct Written;

impl Visitor<'_> for Written {
    type Value = QuantityText;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number with its unit in quotes, such as \"35 mm\"")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<QuantityText, E> {
        Ok(QuantityText::of(text))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<QuantityText, E> {
        Ok(QuantityText::bare(&number))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<QuantityText, E> {
        Ok(QuantityText::bare(&number))
    }
}

/// How quantities of a dimension are mostly written: their unit, and numbers of it as a range and as a list.
pub(crate) fn usual(dimension: Dimension) -> (&'static str, &'static str, &'static str) {
    match dimension {
        Dimension::Length => ("mm", "20..40", "20, 25, 40"),
        Dimension::Area => ("mm^2", "10..40", "10, 20, 40"),
        Dimension::Time => ("s", "1..100", "1, 10, 100"),
        Dimension::Force => ("N", "1..20", "1, 5, 20"),
        Dimension::Pressure => ("kPa", "10..100", "10, 30, 100"),
        Dimension::Speed => ("mm/min", "5..500", "5, 50, 500"),
        Dimension::Rate => ("/s", "1e3..1e6", "1e3, 1e4, 1e5"),
        Dimension::Frequency => ("Hz", "10..1000", "10, 100, 1000"),
        Dimension::ForceRate => ("N/s", "1..20", "1, 5, 20"),
        Dimension::Compliance => ("um/N", "0.1..10", "0.1, 1, 10"),
        Dimension::Stiffness => ("N/m", "0.01..10", "0.01, 0.1, 1"),
        Dimension::Voltage => ("V", "1..10", "1, 5, 10"),
        Dimension::Mass => ("g", "10..500", "10, 100, 500"),
        Dimension::Acceleration => ("m/s^2", "1..10", "1, 5, 10"),
        Dimension::Torque => ("N mm", "1..10", "1, 5, 10"),
        Dimension::Share => ("%", "0.1..1", "0.1, 0.5, 1"),
        Dimension::Temperature => ("K", "1..10", "1, 5, 10"),
        Dimension::PerKelvin => ("%/K", "0.1..1", "0.1, 0.5, 1"),
        Dimension::Angle => ("deg", "20..70", "20, 35, 70"),
        Dimension::PerPressure => ("1/kPa", "0.1..10", "0.1, 1, 10"),
    }
}
