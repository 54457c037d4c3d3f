//! What can be wrong with a description.

use std::{fmt, path::PathBuf};

use palpate::units::{Dimension, UnitError};

use super::{kind::DescriptionKind, quantity::usual};
use crate::error::{FileError, FileProblem, plain, shown};

/// Ends the words for what is accepted where a value is out of all proportion.
pub(crate) const BELIEVABLE: &str = "as bodies have it";

/// Where in a description a key stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyPosition {
    /// The file.
    pub path: PathBuf,
    /// Line, from 1, where it is known. A key that is missing stands on the line of its table.
    pub line: Option<usize>,
    /// Path of the key, such as `specimen.radius` or `step[2].rate`; entries of a list count from 1.
    pub key: String,
}

impl fmt::Display for KeyPosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line.map_or_else(String::new, |line| format!(", line {line}"));
        let key = if self.key.is_empty() { String::new() } else { format!(": {}", shown(&self.key)) };
        write!(f, "{}{line}{key}", self.path.display())
    }
}

/// Why a description cannot be used. [`DescriptionError::hint`] says what would help.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DescriptionError {
    /// The operating system does not hand the file out.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file is far longer than anybody writes.
    #[error("{}: expected a description of at most {limit} bytes, found more", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// The most that is read.
        limit: u64,
    },
    /// The file is not text in UTF-8.
    #[error("{}, line {line}: expected text in UTF-8, found other bytes", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Line of the first such bytes, from 1.
        line: usize,
    },
    /// The text is no TOML.
    #[error("{}, line {line}, column {column}: expected TOML, found `{}` ({message})", path.display(), shown(text))]
    Syntax {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Character in the line, from 1.
        column: usize,
        /// What the TOML reader says.
        message: String,
        /// The line.
        text: String,
    },
    /// The file is a description of another kind.
    #[error("{}: expected {expected}, found {found}", path.display())]
    Kind {
        /// The file.
        path: PathBuf,
        /// The kind that is needed.
        expected: DescriptionKind,
        /// The kind that it is.
        found: DescriptionKind,
    },
    /// Something is wrong with a key or its value.
    #[error("{place}{problem}")]
    Key {
        /// The key.
        place: KeyPosition,
        /// What is wrong with it.
        problem: KeyProblem,
    },
}

/// What can be wrong with a key of a description, as it is written behind its place.
#[derive(Debug, thiserror::Error)]
pub enum KeyProblem {
    /// It means nothing here; these would.
    #[error(": unknown key (accepted: {})", .0.join(", "))]
    Unknown(Vec<String>),
    /// A sweep over a number that does not stand in the protocol.
    #[error(": unknown parameter of this protocol (its parameters: {})", accepted.join(", "))]
    UnknownParameter {
        /// The path of the number that it names.
        number: String,
        /// The numbers that stand in the protocol.
        accepted: Vec<String>,
    },
    /// It is needed and not there; what it should hold.
    #[error(": missing, expected {0}")]
    Missing(String),
    /// A quantity that cannot be read.
    #[error(" = {}: {}", shown(found), shown(&error.to_string()))]
    Quantity {
        /// What it holds, as written.
        found: String,
        /// What is wrong with it.
        error: UnitError,
    },
    /// A value of the wrong kind or size.
    #[error(": expected {expected}, found {}", shown(found))]
    Value {
        /// What would be accepted.
        expected: String,
        /// What it holds.
        found: String,
    },
    /// It has no effect beside the others.
    #[error(": not used {reason}")]
    Unused {
        /// When and why it has none.
        reason: String,
        /// What would help.
        remedy: String,
    },
    /// It and this other key exclude each other.
    #[error(": expected either this or {0}, found both")]
    Both(String),
    /// Something else that the TOML reader says about the value.
    #[error(": {}", shown(.0))]
    Other(String),
}

impl DescriptionError {
    /// The key that is wrong, such as `specimen.radius`; `None` where it is the file.
    #[must_use]
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Key { place, .. } => Some(&place.key),
            _ => None,
        }
    }

    /// What would help, if that is known.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        let help = match self {
            Self::File(error) if matches!(error.problem, FileProblem::Directory) => {
                "name the TOML file inside it".to_owned()
            }
            Self::File(error) => error.hint()?,
            Self::TooLong { .. } => "give a description in TOML here, not the record itself".to_owned(),
            Self::NotText { .. } => "save the description as UTF-8".to_owned(),
            Self::Syntax { text, message, .. } => syntax(text, message),
            Self::Kind { expected, found, .. } => expected.instead_of(*found).to_owned(),
            Self::Key { place, problem } => problem.help(place.key.rsplit('.').next().unwrap_or(&place.key)),
        };
        Some(plain(&help))
    }
}

impl KeyProblem {
    /// What would help, of a key by its last name.
    fn help(&self, key: &str) -> String {
        match self {
            Self::Unknown(accepted) => meant(key, accepted, "remove the key, or use an accepted one"),
            Self::UnknownParameter { number, accepted } => {
                let otherwise = "a sweep replaces parameters of the file: add this one to its table first";
                meant(number, accepted, otherwise)
            }
            Self::Missing(expected) => match expected.split_once("such as ") {
                Some((_, example)) if example.contains(" = ") => format!("add a line such as {example}"),
                Some((_, example)) => format!("add a line such as {key} = {example}"),
                None => format!("add {expected}"),
            },
            Self::Quantity { found, error } => quantity(key, error, found),
            Self::Value { expected, found } => value(key, expected, found),
            Self::Unused { remedy, .. } => remedy.clone(),
            Self::Both(other) => format!("remove {key} or {other}"),
            Self::Other(_) => format!("change or remove {key}"),
        }
    }
}

/// The line that most often goes wrong is a quantity without quotes.
fn syntax(line: &str, message: &str) -> String {
    if message.starts_with("duplicate key") {
        return "the key appears twice: remove one of the two".to_owned();
    }
    let written = line.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
    match written {
        Some((key, value)) if value.starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first)) => {
            let value = value.split('#').next().unwrap_or(value).trim_end();
            format!("write a quantity in quotes: {key} = \"{value}\"")
        }
        _ => {
            "each line is a [table], a key = value, a # comment or blank; texts and quantities are in quotes".to_owned()
        }
    }
}

/// What helps against a value that is not accepted.
fn value(key: &str, expected: &str, found: &str) -> String {
    if expected.contains(" above 0 ") {
        return format!("{key} must be above zero: check its sign and value");
    }
    if expected.contains(BELIEVABLE) {
        return format!("check the value and the unit of {key}");
    }
    if expected.contains("no longer calibrated") {
        return format!("restore {}, or calibrate again", expected.split(", ").next().unwrap_or(expected));
    }
    if expected.contains("calibrate again") {
        return "calibrate again with this version of palpate".to_owned();
    }
    let names = expected.split('"').skip(1).step_by(2).map(str::to_owned);
    let names: Vec<String> =
        names.filter(|name| !found.contains(name.as_str()) || found.trim_matches('"') == name).collect();
    if let Some(name) = nearest(found.trim_matches('"'), &names) {
        return format!("did you mean \"{name}\"?");
    }
    match key {
        "shape" if names.iter().any(|name| name == "none") => {
            "a body of constant section is a \"block\"; with \"none\" palpate fits forces".to_owned()
        }
        _ if names.len() > 1 => format!("write {expected}"),
        _ => match expected.rsplit_once("such as ") {
            Some((_, example)) => format!("write a value such as {example} for {key}"),
            None => format!("change {key} to {}", expected.split(", ").next().unwrap_or(expected)),
        },
    }
}

fn quantity(key: &str, error: &UnitError, found: &str) -> String {
    let named = |value: &str| {
        if key.ends_with(']') { format!("\"{value}\"") } else { format!("{key} = \"{value}\"") }
    };
    match error {
        UnitError::MissingUnit { dimension, found } => {
            // Of both the usual and the SI unit, lest one of them be taken for what was meant.
            let (usual, ..) = usual(*dimension);
            let si = dimension.units().iter().find(|(symbol, factor)| *factor == 1.0 && *symbol != usual);
            let other = si.map_or_else(String::new, |(si, _)| format!(" or \"{} {si}\"", found.trim()));
            format!("add the unit, such as {}{other}", named(&format!("{} {usual}", found.trim())))
        }
        UnitError::NotANumber { dimension, .. } | UnitError::NotFinite { dimension, .. } => {
            let (unit, ..) = usual(*dimension);
            format!("write a number and a unit, such as {}", named(&format!("10 {unit}")))
        }
        UnitError::UnknownUnit { dimension, unit } => {
            let digits = unit.strip_prefix(',').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
            let same = dimension.units().iter().find(|(symbol, _)| symbol.eq_ignore_ascii_case(unit));
            let volts = key == "unit" && crate::naming::unit_factor(unit, Dimension::Voltage).is_some();
            let force = key == "to" && crate::naming::unit_factor(unit, Dimension::Force).is_some();
            match same {
                _ if force => format!("for a force write to_force = \"{}\"", found.trim_matches('"')),
                _ if volts => {
                    format!("also give the scale of a volt, such as scale = \"12.5 {}/V\"", usual(*dimension).0)
                }
                _ if digits => {
                    format!("write a decimal point: {}", named(&found.trim_matches('"').replacen(',', ".", 1)))
                }
                Some((symbol, _)) => format!("did you mean {symbol}? Capitals count in units"),
                None => format!("use one of {}", dimension.accepted()),
            }
        }
    }
}

/// Asks whether the accepted key that differs little from `key` was meant, or else says `otherwise`.
fn meant(key: &str, accepted: &[String], otherwise: &str) -> String {
    nearest(key, accepted).map_or_else(|| otherwise.to_owned(), |near| format!("did you mean {near}?"))
}

/// The accepted key that differs least from `key`, if it differs little.
fn nearest<'a>(key: &str, accepted: &'a [String]) -> Option<&'a String> {
    let distances = accepted.iter().map(|other| (strsim::levenshtein(key, other), other));
    let (edits, other) = distances.min_by_key(|(edits, _)| *edits)?;
    (edits <= 1 + key.chars().count() / 4).then_some(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_keys() {
        let accepted = ["radius", "modulus", "shape"].map(str::to_owned);
        assert_eq!(nearest("raduis", &accepted), Some(&accepted[0]));
        assert_eq!(nearest("Modulus", &accepted), Some(&accepted[1]));
        assert_eq!(nearest("temperature", &accepted), None);
        assert_eq!(nearest("shpae", &accepted), Some(&accepted[2]));
        assert_eq!(nearest("", &accepted), None);
    }
}
