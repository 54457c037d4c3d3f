//! A quantity as it stands in a description: text, not yet a number.

use std::{borrow::Cow, fmt};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer,
    de::{Error, Visitor},
};

/// A number and its unit, as written. A bare number is kept too, so that what is wrong with it (it lacks a
/// unit) can be said with the right words.
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
        let text = text.to_owned();
        Ok(QuantityText { text, bare: false })
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<QuantityText, E> {
        let text = number.to_string();
        Ok(QuantityText { text, bare: true })
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<QuantityText, E> {
        let text = number.to_string();
        Ok(QuantityText { text, bare: true })
    }
}
