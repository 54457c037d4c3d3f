//! What can be wrong with a description.

use std::{fmt, io, path::PathBuf};

use palpate::units::{Dimension, UnitError};

use crate::error::{allowed, plain, reason, shown};

/// Ends the words for what is accepted where a value is out of all proportion.
pub(crate) const BELIEVABLE: &str = "as bodies have it";

/// Where in a description a key stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyPlace {
    /// The file.
    pub path: PathBuf,
    /// Line, from 1, where it is known. A key that is missing stands on the line of its table.
    pub line: Option<usize>,
    /// Path of the key, such as `specimen.radius` or `step[2].rate`; entries of a list count from 1.
    pub key: String,
}

impl fmt::Display for KeyPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if self.key.is_empty() {
            return Ok(());
        }
        write!(f, ": {}", shown(&self.key))
    }
}

/// Why a description cannot be used. [`DescriptionError::hint`] says what would help.
#[derive(Debug, thiserror::Error)]
pub enum DescriptionError {
    /// There is no such file.
    #[error("{}: no such file", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The path leads to a directory.
    #[error("{}: expected a file, found a directory", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
    },
    /// The operating system does not hand the file out.
    #[error("{}: cannot be read ({})", path.display(), reason(source))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The file is far longer than anybody writes.
    #[error("{}: expected a description of at most {limit} bytes, found {bytes} bytes", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
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
    /// A key that means nothing here.
    #[error("{place}: unknown key (accepted: {})", accepted.join(", "))]
    UnknownKey {
        /// The key.
        place: KeyPlace,
        /// The keys that have a meaning here.
        accepted: Vec<String>,
    },
    /// A sweep over a number that does not stand in the protocol.
    #[error("{place}: no such number in this protocol (its numbers: {})", accepted.join(", "))]
    UnknownNumber {
        /// The key of the sweep.
        place: KeyPlace,
        /// The path of the number that it names.
        number: String,
        /// The numbers that stand in the protocol.
        accepted: Vec<String>,
    },
    /// A key that is needed is not there.
    #[error("{place}: missing, expected {expected}")]
    Missing {
        /// The key.
        place: KeyPlace,
        /// What it should hold.
        expected: String,
    },
    /// A quantity that cannot be read.
    #[error("{place} = {}: {}", shown(found), shown(&source.to_string()))]
    Quantity {
        /// The key.
        place: KeyPlace,
        /// What it holds, as written.
        found: String,
        /// What is wrong with it.
        source: UnitError,
    },
    /// A value of the wrong kind or size.
    #[error("{place}: expected {expected}, found {}", shown(found))]
    Value {
        /// The key.
        place: KeyPlace,
        /// What would be accepted.
        expected: String,
        /// What it holds.
        found: String,
    },
    /// A key that has no effect beside the others.
    #[error("{place}: not used {reason}")]
    Unused {
        /// The key.
        place: KeyPlace,
        /// When and why it has none.
        reason: String,
        /// What would help.
        remedy: String,
    },
    /// Two keys that exclude each other.
    #[error("{place}: expected either this or {other}, found both")]
    Both {
        /// One of the keys.
        place: KeyPlace,
        /// The other.
        other: String,
    },
    /// Something else that the TOML reader says about a value.
    #[error("{place}: {}", shown(message))]
    Other {
        /// The key.
        place: KeyPlace,
        /// What the reader says.
        message: String,
    },
}

impl DescriptionError {
    /// The key that is wrong, such as `specimen.radius`; `None` where it is the file.
    #[must_use]
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::UnknownKey { place, .. }
            | Self::UnknownNumber { place, .. }
            | Self::Missing { place, .. }
            | Self::Quantity { place, .. }
            | Self::Value { place, .. }
            | Self::Unused { place, .. }
            | Self::Both { place, .. }
            | Self::Other { place, .. } => Some(&place.key),
            _ => None,
        }
    }

    /// What would help, if that is known.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        self.help().map(|text| plain(&text))
    }

    fn help(&self) -> Option<String> {
        match self {
            Self::NotFound { .. } => Some("check the spelling of the path".to_owned()),
            Self::Directory { .. } => Some("name the TOML file inside it".to_owned()),
            Self::Unreadable { source, .. } => allowed(source),
            Self::Other { place, .. } => Some(format!("change or remove {}", last_key(&place.key))),
            Self::TooLong { .. } => Some("give a description in TOML here, not the record itself".to_owned()),
            Self::NotText { .. } => Some("save the description as UTF-8".to_owned()),
            Self::Syntax { text, message, .. } => Some(syntax(text, message)),
            Self::UnknownKey { place, accepted } => Some(nearest(last_key(&place.key), accepted).map_or_else(
                || "remove the key, or write one of those that are accepted".to_owned(),
                |key| format!("did you mean {key}?"),
            )),
            Self::UnknownNumber { number, accepted, .. } => Some(nearest(number, accepted).map_or_else(
                || "a sweep replaces numbers that stand in the file: write it where it belongs first".to_owned(),
                |number| format!("did you mean {number}?"),
            )),
            Self::Missing { place, expected } => {
                let key = last_key(&place.key);
                Some(match expected.split_once("such as ") {
                    Some((_, example)) if example.contains(" = ") => format!("add a line such as {example}"),
                    Some((_, example)) => format!("add a line such as {key} = {example}"),
                    None => format!("add {expected}"),
                })
            }
            Self::Quantity { place, source, found } => Some(quantity(last_key(&place.key), source, found)),
            Self::Value { place, expected, found } => Some(value(last_key(&place.key), expected, found)),
            Self::Unused { remedy, .. } => Some(remedy.clone()),
            Self::Both { place, other } => Some(format!("remove {} or {other}", last_key(&place.key))),
        }
    }
}

fn last_key(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

/// The line that most often goes wrong is a quantity without quotes.
fn syntax(line: &str, message: &str) -> String {
    if message.starts_with("duplicate key") {
        return "the key stands here a second time: remove one of the two".to_owned();
    }
    let written = line.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
    match written {
        Some((key, value)) if value.starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first)) => {
            let value = value.split('#').next().unwrap_or(value).trim_end();
            format!("a quantity stands in quotes: {key} = \"{value}\"")
        }
        _ => "every line is a [table], a key = value, a # comment or blank; texts and quantities stand in quotes"
            .to_owned(),
    }
}

/// What helps against a value that is not accepted.
fn value(key: &str, expected: &str, found: &str) -> String {
    if expected.contains(" above 0 ") {
        return format!("{key} must be above zero: check its sign and its number");
    }
    if expected.contains(BELIEVABLE) {
        return format!("check the number and the unit of {key}");
    }
    if expected.contains("calibrated no more") {
        return format!("put back {}, or calibrate again", expected.split(", ").next().unwrap_or(expected));
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
            "a body of constant section is a \"block\"; with \"none\" forces stay forces".to_owned()
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
            let usual = usual_unit(*dimension);
            let si = dimension.units().iter().find(|(symbol, factor)| *factor == 1.0 && *symbol != usual);
            let other = si.map_or_else(String::new, |(si, _)| format!(" or \"{} {si}\"", found.trim()));
            format!("add the unit, such as {}{other}", named(&format!("{} {usual}", found.trim())))
        }
        UnitError::NotANumber { dimension, .. } | UnitError::NotFinite { dimension, .. } => {
            let unit = usual_unit(*dimension);
            format!("write a number and a unit, such as {}", named(&format!("10 {unit}")))
        }
        UnitError::UnknownUnit { dimension, unit } => {
            let digits = unit.strip_prefix(',').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
            let same = dimension.units().iter().find(|(symbol, _)| symbol.eq_ignore_ascii_case(unit));
            let volts = key == "unit" && crate::naming::unit_factor(unit, Dimension::Voltage).is_some();
            match same {
                _ if volts => {
                    format!("say what a volt stands for as well, such as scale = \"12.5 {}/V\"", usual_unit(*dimension))
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

fn usual_unit(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Length => "mm",
        Dimension::Area => "mm^2",
        Dimension::Time => "s",
        Dimension::Force => "N",
        Dimension::Pressure => "kPa",
        Dimension::Speed => "mm/min",
        Dimension::Rate => "/s",
        Dimension::Frequency => "Hz",
        Dimension::ForceRate => "N/s",
        Dimension::Compliance => "um/N",
        Dimension::Voltage => "V",
        Dimension::Mass => "g",
        Dimension::Acceleration => "m/s^2",
        Dimension::Torque => "N mm",
    }
}

/// The accepted key that differs least from `key`, if it differs little.
fn nearest<'a>(key: &str, accepted: &'a [String]) -> Option<&'a String> {
    let distances = accepted.iter().map(|other| (distance(key, other), other));
    let (edits, other) = distances.min_by_key(|(edits, _)| *edits)?;
    (edits <= 1 + key.chars().count() / 4).then_some(other)
}

/// Letters to insert, drop or replace to turn `a` into `b`.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
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
        assert_eq!((distance("", "abc"), distance("kitten", "sitting")), (3, 3));
    }
}
