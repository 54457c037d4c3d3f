//! The text of a description: reading it, and saying where in it something is wrong.

use std::path::Path;

use palpate::units::{self, Dimension, UnitError};
use serde::de::DeserializeOwned;
use toml::{Spanned, de::DeTable};

use super::{
    error::{BELIEVABLE, DescriptionError, KeyPosition, KeyProblem},
    kind::DescriptionKind as Kind,
    places::Places,
    quantity::QuantityText,
    words,
};
use crate::input::read_whole;

/// The longest description that is read, in bytes.
pub(crate) const LONGEST: u64 = 1 << 20;

/// The text of a test description or a material file, or of standard input where `path` is `-`; of at most 1 MiB.
///
/// # Errors
/// [`DescriptionError`] where it cannot be read, is longer, or is not text in UTF-8.
pub fn read_text(path: &Path) -> Result<String, DescriptionError> {
    read(path, LONGEST)
}

/// The text of the file at `path`, which may have `longest` bytes.
pub(crate) fn read(path: &Path, longest: u64) -> Result<String, DescriptionError> {
    let bytes = read_whole(path, longest)?.ok_or_else(|| DescriptionError::TooLong {
        path: path.to_owned(),
        limit: longest,
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        DescriptionError::NotText {
            path: path.to_owned(),
            line: 1 + good.iter().filter(|&&byte| byte == b'\n').count(),
        }
    })
}

/// A description's text and the file it came from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'t> {
    pub(crate) path: &'t Path,
    pub(crate) text: &'t str,
}

impl Source<'_> {
    /// The tables of the text, unchecked.
    pub(crate) fn tables<T: DeserializeOwned>(&self) -> Result<T, DescriptionError> {
        self.read(self.root()?)
    }

    /// The text as TOML.
    pub(crate) fn root(&self) -> Result<Spanned<DeTable<'_>>, DescriptionError> {
        DeTable::parse(self.text).map_err(|error| self.syntax(&error))
    }

    /// Its tables, unchecked.
    pub(crate) fn read<T: DeserializeOwned>(&self, root: Spanned<DeTable<'_>>) -> Result<T, DescriptionError> {
        T::deserialize(toml::Deserializer::from(root)).map_err(|error| self.unfit(&error))
    }

    /// Refuses a description of one of these kinds. What is no TOML, or of no kind, is for those to refuse who know what belongs there.
    pub(crate) fn refuse(&self, refused: &[Kind], expected: Kind) -> Result<(), DescriptionError> {
        let tables: toml::Table = self.tables().unwrap_or_default();
        self.refuse_if(|key| tables.contains_key(key), refused, expected)
    }

    /// The same by the keys that it has.
    pub(crate) fn refuse_if(
        &self,
        has: impl Fn(&str) -> bool,
        refused: &[Kind],
        expected: Kind,
    ) -> Result<(), DescriptionError> {
        let path = self.path.to_owned();
        match Kind::of(has).filter(|found| refused.contains(found)) {
            Some(found) => Err(DescriptionError::Kind { path, expected, found }),
            None => Ok(()),
        }
    }

    /// Tables that were put together from several texts, unchecked.
    pub(crate) fn unplaced<T: DeserializeOwned>(&self, tables: toml::Table) -> Result<T, DescriptionError> {
        T::deserialize(tables).map_err(|error| self.unfit(&error))
    }

    pub(crate) fn place(&self, key: impl Into<String>) -> KeyPosition {
        let places = Places::of(self.text);
        let key = places.numbered(key.into());
        let start = places.start_of(&key);
        KeyPosition {
            path: self.path.to_owned(),
            line: start.map(|start| self.line_and_column(start).0),
            key,
        }
    }

    /// Something is wrong with a key.
    pub(crate) fn wrong(&self, key: impl Into<String>, problem: KeyProblem) -> DescriptionError {
        DescriptionError::Key {
            place: self.place(key),
            problem,
        }
    }

    pub(crate) fn missing(&self, key: impl Into<String>, expected: impl Into<String>) -> DescriptionError {
        self.wrong(key, KeyProblem::Missing(expected.into()))
    }

    pub(crate) fn value(
        &self,
        key: impl Into<String>,
        expected: impl Into<String>,
        found: &(impl ToString + ?Sized),
    ) -> DescriptionError {
        let (expected, found) = (expected.into(), found.to_string());
        self.wrong(key, KeyProblem::Value { expected, found })
    }

    pub(crate) fn unused(
        &self,
        key: impl Into<String>,
        reason: impl Into<String>,
        remedy: impl Into<String>,
    ) -> DescriptionError {
        let (reason, remedy) = (reason.into(), remedy.into());
        self.wrong(key, KeyProblem::Unused { reason, remedy })
    }

    pub(crate) fn both(&self, key: impl Into<String>, other: impl Into<String>) -> DescriptionError {
        self.wrong(key, KeyProblem::Both(other.into()))
    }

    /// A text in quotes that is no quantity.
    pub(crate) fn no_quantity(&self, key: impl Into<String>, text: &str, error: UnitError) -> DescriptionError {
        let found = format!("\"{text}\"");
        self.wrong(key, KeyProblem::Quantity { found, error })
    }

    /// A quantity in SI.
    pub(crate) fn si(&self, key: &str, quantity: &QuantityText, dimension: Dimension) -> Result<f64, DescriptionError> {
        let wrong = |error| KeyProblem::Quantity {
            found: quantity.to_string(),
            error,
        };
        units::parse(&quantity.text, dimension).map_err(|error| self.wrong(key, wrong(error)))
    }

    /// A quantity in SI that must be above zero and, of a specimen, such as bodies have.
    pub(crate) fn positive(
        &self,
        key: &str,
        quantity: &QuantityText,
        dimension: Dimension,
    ) -> Result<f64, DescriptionError> {
        let si = self.si(key, quantity, dimension)?;
        if si <= 0.0 {
            let expected = format!("a {} above 0 {}", dimension.name(), dimension.units()[0].0);
            return Err(self.value(key, expected, quantity));
        }
        // What no body has is a slip of the exponent or of the unit.
        let (limits, words) = match dimension {
            _ if !key.starts_with("specimen.") => return Ok(si),
            Dimension::Length => (1e-9..=1e3, "a length from 1 nm to 1000 m"),
            Dimension::Area => (1e-18..=1e6, "an area from 1e-12 mm^2 to 1e6 m^2"),
            Dimension::Pressure => (1.0..=1e13, "a modulus from 1 Pa to 1e4 GPa"),
            _ => return Ok(si),
        };
        if limits.contains(&si) {
            return Ok(si);
        }
        Err(self.value(key, format!("{words}, {BELIEVABLE}"), quantity))
    }

    /// Likewise, if it is given.
    pub(crate) fn positive_if(
        &self,
        key: &str,
        quantity: Option<&QuantityText>,
        dimension: Dimension,
    ) -> Result<Option<f64>, DescriptionError> {
        quantity.map(|quantity| self.positive(key, quantity, dimension)).transpose()
    }

    /// Rows of two quantities in SI.
    pub(crate) fn rows(
        &self,
        key: &str,
        rows: &[(QuantityText, QuantityText)],
        (first, second): (Dimension, Dimension),
    ) -> Result<Vec<(f64, f64)>, DescriptionError> {
        rows.iter().map(|row| Ok((self.si(key, &row.0, first)?, self.si(key, &row.1, second)?))).collect()
    }

    /// A bare number that `accepts` must accept.
    pub(crate) fn number(
        &self,
        key: &str,
        number: f64,
        expected: &str,
        accepts: impl Fn(f64) -> bool,
    ) -> Result<f64, DescriptionError> {
        if number.is_finite() && accepts(number) {
            Ok(number)
        } else {
            Err(self.value(key, expected, &number))
        }
    }

    /// Line and character, both from 1, of a place in the text.
    fn line_and_column(&self, place: usize) -> (usize, usize) {
        let before = self.text.get(..place).unwrap_or(self.text);
        let line = before.rsplit('\n').next().unwrap_or("");
        (1 + before.matches('\n').count(), 1 + line.chars().count())
    }

    fn syntax(&self, error: &toml::de::Error) -> DescriptionError {
        let start = error.span().map_or(0, |span| span.start);
        let (line, column) = self.line_and_column(start);
        let text = self.text.lines().nth(line - 1).unwrap_or("");
        DescriptionError::Syntax {
            path: self.path.to_owned(),
            line,
            column,
            message: error.message().trim().replace('\n', ", "),
            text: crate::error::shorten(text),
        }
    }

    /// TOML that does not have the shape of the description.
    fn unfit(&self, error: &toml::de::Error) -> DescriptionError {
        let span = error.span().unwrap_or(0..0);
        let at = Places::of(self.text).key_at(&span);
        let (key, problem) = words::explain(error.message().trim(), &at);
        let mut place = self.place(&key);
        if key == at {
            place.line = (!key.is_empty()).then(|| self.line_and_column(span.start).0);
        }
        DescriptionError::Key { place, problem }
    }
}
