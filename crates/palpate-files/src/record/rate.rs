//! The rate at which the rows of a file without a time were recorded, by its named values.

use palpate::units::Dimension;

use crate::{
    cell::{DecimalMark, number},
    naming::{COUNTS, is_listed, unit_factor, words},
    table::{ColumnInfo, ColumnKind, Metadata},
};

/// Words for a sample of a signal.
const SAMPLES: &str =
    "sample samples sampling scan acquisition abtastrate abtastfrequenz abtast échantillonnage muestreo";
/// Words for how many of them there are in a second.
const RATES: &str = "rate frequency frequenz abtastrate abtastfrequenz fréquence frecuencia";
/// Words for the time from one to the next.
const INTERVALS: &str = "interval period time intervall intervalle période";

/// Rows a second, Hz.
pub(super) fn of_rows(metadata: &[Metadata]) -> Option<f64> {
    metadata.iter().find_map(rate).filter(|rate| rate.is_finite() && *rate > 0.0)
}

fn rate(entry: &Metadata) -> Option<f64> {
    let words = words(&entry.name);
    let has = |list: &str| words.iter().any(|word| is_listed(word, list));
    let value = entry.value.trim().as_bytes();
    let value = number::parse(value, DecimalMark::Point).or_else(|| number::parse(value, DecimalMark::Comma))?;
    let factor = |dimension| unit_factor(entry.unit.as_deref()?, dimension);
    match (has(SAMPLES), factor(Dimension::Frequency), factor(Dimension::Time)) {
        (true, Some(hertz), _) if has(RATES) => Some(value * hertz),
        (true, _, Some(seconds)) if has(INTERVALS) => Some(1.0 / (value * seconds)),
        _ => None,
    }
}

/// Whether a column counts the samples: its name says nothing else.
pub(super) fn counts_samples(column: &ColumnInfo) -> bool {
    let words = words(column.name.as_deref().unwrap_or_default());
    column.kind == ColumnKind::Number
        && column.unit.is_none()
        && column.sample.parse::<i64>().is_ok()
        && words.iter().any(|word| is_listed(word, "sample samples index"))
        && words.iter().all(|word| is_listed(word, COUNTS))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(name: &str, value: &str, unit: Option<&str>) -> Metadata {
        let unit = unit.map(str::to_owned);
        Metadata {
            name: name.to_owned(),
            value: value.to_owned(),
            unit,
        }
    }

    #[test]
    fn rates_and_intervals_with_their_unit() {
        for (name, value, unit, expected) in [
            ("Sample Frequency", "10000", Some("Hz"), Some(1e4)),
            ("Sampling rate", "2,5", Some("kHz"), Some(2500.0)),
            ("Sampling interval", "4", Some("ms"), Some(250.0)),
            ("Sampling rate", "10", None, None),
            ("Frequency", "1", Some("Hz"), None),
            ("Sample time", "0", Some("s"), None),
            ("Sample Frequency", "x", Some("Hz"), None),
        ] {
            assert_eq!(of_rows(&[entry(name, value, unit)]), expected, "{name} {value}");
        }
    }
}
