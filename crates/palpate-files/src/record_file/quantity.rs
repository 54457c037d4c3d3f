//! What a column of a record can hold, and the units it can have.

use std::fmt;

use palpate::units::{self, Dimension};
use serde::Serialize;

/// What a column of a record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Time, in s.
    Time,
    /// Travel of the jaw, in m.
    Displacement,
    /// Force, in N.
    Force,
    /// Stress, in Pa.
    Stress,
}

impl Quantity {
    /// Which units it takes.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Time => Dimension::Time,
            Self::Displacement => Dimension::Length,
            Self::Force => Dimension::Force,
            Self::Stress => Dimension::Pressure,
        }
    }

    /// The unit that it most often has.
    pub(super) fn usual_unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Displacement => "mm",
            Self::Force => "N",
            Self::Stress => "MPa",
        }
    }
}

impl fmt::Display for Quantity {
    /// Its key in a description: `time`, `displacement`, `force` or `stress`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Time => "time",
            Self::Displacement => "displacement",
            Self::Force => "force",
            Self::Stress => "stress",
        })
    }
}

/// Words and spellings that machines write for a unit. Compared in lower case, so that none is here whose
/// meaning hangs on its case: "mpa" may be mega or milli.
const SYNONYMS: &[(Dimension, &str, &[&str])] = &[
    (
        Dimension::Time,
        "s",
        &[
            "s", "sec", "secs", "second", "seconds", "sekunde", "sekunden", "seconde", "secondes", "segundos", "秒",
        ],
    ),
    (Dimension::Time, "ms", &["msec", "millisecond", "milliseconds", "毫秒"]),
    (Dimension::Time, "min", &["min", "mins", "minute", "minutes", "minuten", "分", "分钟"]),
    (Dimension::Time, "h", &["h", "hr", "hrs", "hour", "hours", "小时"]),
    (Dimension::Length, "mm", &["mm", "millimeter", "millimeters", "millimetre", "millimetres", "毫米"]),
    (Dimension::Length, "cm", &["cm", "厘米"]),
    (Dimension::Length, "m", &["meter", "meters", "metre", "metres", "米"]),
    (Dimension::Length, "um", &["micron", "microns", "微米"]),
    (Dimension::Length, "in", &["inch", "inches"]),
    (Dimension::Force, "N", &["n", "newton", "newtons", "牛", "牛顿"]),
    (Dimension::Force, "kN", &["kn", "千牛"]),
    (Dimension::Force, "mN", &["毫牛"]),
    (Dimension::Pressure, "Pa", &["pa", "帕"]),
    (Dimension::Pressure, "kPa", &["kpa", "千帕"]),
    (Dimension::Pressure, "MPa", &["兆帕"]),
];

/// The factor that turns a unit, as people and machines write it in a header, into SI.
pub(crate) fn unit_factor(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim();
    units::factor(unit, dimension).or_else(|| {
        let word = unit.to_lowercase();
        // Clocks of computers count them; no description does.
        if dimension == Dimension::Time && matches!(word.as_str(), "ns" | "nsec" | "nanosecond" | "nanoseconds") {
            return Some(1e-9);
        }
        let same = |(of, _, words): &&(Dimension, &str, &[&str])| *of == dimension && words.contains(&word.as_str());
        let (_, symbol, _) = SYNONYMS.iter().find(same)?;
        units::factor(symbol, dimension)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_as_machines_write_them() {
        for (unit, dimension, factor) in [
            ("S", Dimension::Time, 1.0),
            ("seconds", Dimension::Time, 1.0),
            ("毫秒", Dimension::Time, 1e-3),
            ("ns", Dimension::Time, 1e-9),
            ("MM", Dimension::Length, 1e-3),
            ("\u{3bc}m", Dimension::Length, 1e-6),
            (" Newton ", Dimension::Force, 1.0),
            ("mN", Dimension::Force, 1e-3),
            ("N/mm²", Dimension::Pressure, 1e6),
        ] {
            assert_eq!(unit_factor(unit, dimension), Some(factor), "{unit}");
        }
        for (unit, dimension) in [
            ("mpa", Dimension::Pressure),
            ("MN", Dimension::Force),
            ("kg", Dimension::Force),
            ("mm", Dimension::Force),
            ("", Dimension::Time),
        ] {
            assert_eq!(unit_factor(unit, dimension), None, "{unit}");
        }
    }

    #[test]
    fn every_synonym_stands_for_a_unit() {
        for (dimension, symbol, words) in SYNONYMS {
            assert!(units::factor(symbol, *dimension).is_some(), "{symbol}");
            assert!(words.iter().all(|word| *word == word.to_lowercase()), "{symbol}");
        }
    }
}
