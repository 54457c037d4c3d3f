//! A column of a file as people name it.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer,
    de::{Error, SeqAccess, Visitor, value::SeqAccessDeserializer},
};

/// A column of a record: its number, counted from 1 at the left, or its name; or several, of which the first that the file has is meant.
#[derive(Debug, Clone, PartialEq, Eq, JsonSchema)]
#[schemars(untagged)]
pub enum ColumnRef {
    /// Its number, from 1.
    Number(#[schemars(range(min = 1))] usize),
    /// Its name in the header, without the unit.
    Name(String),
    /// The first of these that the file has.
    First(Vec<ColumnRef>),
}

impl fmt::Display for ColumnRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "\"{name}\""),
            Self::First(columns) => {
                let columns: Vec<String> = columns.iter().map(ToString::to_string).collect();
                f.write_str(&columns.join(" or "))
            }
        }
    }
}

impl<'de> Deserialize<'de> for ColumnRef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrName)
    }
}

struct NumberOrName;

impl<'de> Visitor<'de> for NumberOrName {
    type Value = ColumnRef;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the number of a column, from 1, or its name in quotes, or a list of these")
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<ColumnRef, E> {
        match usize::try_from(number) {
            Ok(number) if number > 0 => Ok(ColumnRef::Number(number)),
            _ => Err(E::invalid_value(serde::de::Unexpected::Signed(number), &self)),
        }
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<ColumnRef, E> {
        Ok(ColumnRef::Name(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, columns: A) -> Result<ColumnRef, A::Error> {
        match Vec::deserialize(SeqAccessDeserializer::new(columns))? {
            columns if columns.is_empty() => Err(A::Error::invalid_length(0, &self)),
            columns => Ok(ColumnRef::First(columns)),
        }
    }
}
