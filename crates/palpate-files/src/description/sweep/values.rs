//! The values of one swept number, as people write them: `"log 1e3..1e6 /s, 50"`, `"linear 20..40 mm, 9"`, `"1, 2, 5"`.

use palpate::units::{self, Dimension, UnitError};

use crate::description::text::quantity::{QuantityText, usual};

/// The values that a number takes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Values {
    /// These, in this order.
    List(Vec<Value>),
    /// Any between two ends.
    Range(Range),
}

/// One value of a list.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Value {
    pub(super) si: f64,
    /// As written, with its unit.
    pub(super) text: QuantityText,
}

impl Value {
    pub(super) fn of(si: f64, text: impl Into<String>) -> Self {
        let text = QuantityText::of(text);
        Self { si, text }
    }
}

/// Numbers from one end to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) logarithmic: bool,
    pub(super) first: f64,
    pub(super) last: f64,
    pub(super) count: Option<usize>,
}

/// What is wrong with a text.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wrong {
    /// Another text was expected.
    Expected(String),
    /// A number in it lacks its unit, or has one that it does not take.
    Quantity(String, UnitError),
}

/// Most values of one number.
const MOST_VALUES: usize = 1_000_000;

/// Reads the values of a quantity of a dimension, or of a number without a unit.
pub(super) fn parse(text: &str, dimension: Option<Dimension>) -> Result<Values, Wrong> {
    if text.contains("..") {
        return range(text, dimension).map(Values::Range);
    }
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.iter().any(|part| part.is_empty() || part.starts_with(|c: char| c.is_alphabetic())) {
        return Err(Wrong::Expected(forms(dimension)));
    }
    list(&parts, dimension)
}

/// Reads a list of values, each a text.
pub(super) fn list(parts: &[&str], dimension: Option<Dimension>) -> Result<Values, Wrong> {
    let unit = parts.last().map_or("", |last| units::split_number(last.trim()).1);
    let mut values: Vec<Value> = Vec::with_capacity(parts.len());
    for part in parts {
        let value = value(part, unit, dimension)?;
        if values.iter().any(|before| before.si == value.si) {
            return Err(Wrong::Expected(format!("each value once ({part} appears twice)")));
        }
        values.push(value);
    }
    match values.len() {
        0 => Err(Wrong::Expected("one value or more".to_owned())),
        1..=MOST_VALUES => Ok(Values::List(values)),
        _ => Err(Wrong::Expected(format!("at most {MOST_VALUES} values"))),
    }
}

fn range(text: &str, dimension: Option<Dimension>) -> Result<Range, Wrong> {
    let expected = |words: &str| Wrong::Expected(words.to_owned());
    let wrong = || Wrong::Expected(forms(dimension));
    let text = text.trim();
    let (logarithmic, rest) = match (text.strip_prefix("log "), text.strip_prefix("linear ")) {
        (Some(rest), _) => (true, rest),
        (_, Some(rest)) => (false, rest),
        _ => return Err(wrong()),
    };
    let (ends, count) = match rest.split_once(',') {
        Some((ends, count)) => (ends, Some(count.trim())),
        None => (rest, None),
    };
    let (first, last) = ends.split_once("..").ok_or_else(wrong)?;
    let unit = units::split_number(last.trim()).1;
    let (first, last) = (value(first, unit, dimension)?.si, value(last, unit, dimension)?.si);
    if logarithmic && first <= 0.0 {
        return Err(expected("ends above 0 for log"));
    }
    if first >= last {
        return Err(expected("a rising range: its second end above the first"));
    }
    if !(last - first).is_finite() {
        return Err(expected("ends whose difference is finite"));
    }
    let count = match count.map(str::parse) {
        None => None,
        Some(Ok(count @ 2..=MOST_VALUES)) => Some(count),
        Some(Ok(0 | 1)) => {
            let more = "a number of values of 2 or more after the comma (write a single value as it is)";
            return Err(expected(more));
        }
        Some(_) => {
            return Err(Wrong::Expected(format!("a whole number of values from 2 to {MOST_VALUES} after the comma")));
        }
    };
    Ok(Range {
        logarithmic,
        first,
        last,
        count,
    })
}

/// One value; where it has no unit, it takes that of the last one.
fn value(text: &str, unit: &str, dimension: Option<Dimension>) -> Result<Value, Wrong> {
    let text = text.trim();
    let Some(dimension) = dimension else {
        return match text.parse::<f64>() {
            Ok(si) if si.is_finite() => Ok(Value::of(si, text)),
            _ => Err(Wrong::Expected(format!("a number without a unit instead of \"{text}\""))),
        };
    };
    let whole = match units::split_number(text) {
        (number, "") if !number.is_empty() && !unit.is_empty() => format!("{text} {unit}"),
        _ => text.to_owned(),
    };
    match units::parse(&whole, dimension) {
        Ok(si) => Ok(Value::of(si, whole)),
        Err(error) => Err(Wrong::Quantity(whole, error)),
    }
}

/// What may be written.
fn forms(dimension: Option<Dimension>) -> String {
    let (unit, ends, list) = dimension.map_or(("", "1..7", "1, 2, 5"), usual);
    let [ends, list] = [ends, list].map(|numbers| format!("{numbers} {unit}").trim_end().to_owned());
    format!("values such as \"linear {ends}, 9\", \"log {ends}, 50\" or \"{list}\"")
}

impl Range {
    /// The value at a place of those that are counted.
    pub(super) fn of_grid(&self, place: u64) -> f64 {
        self.at(place as f64 / (self.count.unwrap_or(1).max(2) - 1) as f64)
    }

    /// The value at a share of the way, to 14 digits: 10000 and not 9999.999999999998, the same on any machine.
    pub(super) fn at(&self, share: f64) -> f64 {
        if share <= 0.0 {
            return self.first;
        }
        if share >= 1.0 {
            return self.last;
        }
        let value = match self.logarithmic {
            true => self.first * (share * (self.last.ln() - self.first.ln())).exp(),
            false => self.first + share * (self.last - self.first),
        };
        let rounded = format!("{value:.13e}").parse().unwrap_or(value);
        // Between ends that agree in 13 digits, rounding would leave the range.
        if (self.first..=self.last).contains(&rounded) {
            rounded
        } else {
            value.clamp(self.first, self.last)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str, dimension: Option<Dimension>) -> Vec<f64> {
        match parse(text, dimension).unwrap() {
            Values::List(values) => values.iter().map(|value| value.si).collect(),
            Values::Range(range) => {
                let count = range.count.unwrap();
                (0..count).map(|i| range.at(i as f64 / (count - 1) as f64)).collect()
            }
        }
    }

    #[test]
    fn values_as_people_write_them() {
        assert_eq!(numbers("log 1e3..1e6 /s, 4", Some(Dimension::Rate)), [1e3, 1e4, 1e5, 1e6]);
        assert_eq!(numbers("linear 20 mm..4 cm, 5", Some(Dimension::Length)), [0.02, 0.025, 0.03, 0.035, 0.04]);
        assert_eq!(numbers("linear 20..40 mm, 3", Some(Dimension::Length)), [0.02, 0.03, 0.04]);
        assert_eq!(numbers("linear -1 .. 1, 3", None), [-1.0, 0.0, 1.0]);
        assert_eq!(numbers("1, 2, 5", None), [1.0, 2.0, 5.0]);
        assert_eq!(numbers(" 7 ", None), [7.0]);
        assert_eq!(numbers("500 um, 1, 2 mm", Some(Dimension::Length)), [0.0005, 0.001, 0.002]);
        // Where a log range is cut into decades, it hits them.
        let decades = numbers("log 1e-6..1e6, 13", None);
        assert_eq!(decades, (-6..=6).map(|k| format!("1e{k}").parse().unwrap()).collect::<Vec<f64>>());
    }

    #[test]
    fn values_that_are_none() {
        for (text, dimension, words) in [
            ("", None, "values such as"),
            ("1, , 2", None, "values such as"),
            ("log 1, 2", None, "values such as"),
            ("1..5, 3", None, "linear 1..7, 9"),
            ("linear 1..2..3, 3", None, "instead of"),
            ("linear 1.., 3", None, "instead of"),
            ("log 0..5, 3", None, "above 0"),
            ("log -5..5, 3", None, "above 0"),
            ("linear 5..5, 3", None, "a rising range"),
            ("linear 5..1, 3", None, "a rising range"),
            ("linear nan..1, 3", None, "instead of"),
            ("linear 0..inf, 3", None, "instead of"),
            ("linear -1e308..1e308, 3", None, "finite"),
            ("linear 1..5, 0", None, "2 or more"),
            ("linear 1..5, 1", None, "2 or more"),
            ("linear 1..5, 2.5", None, "whole number"),
            ("linear 1..5, -3", None, "whole number"),
            ("linear 1..5, 99999999", None, "whole number"),
            ("linear 1..5, many", None, "whole number"),
            ("1, 2, 1.0", None, "once"),
            ("1, 2 mm", None, "instead of \"2 mm\""),
        ] {
            match parse(text, dimension) {
                Err(Wrong::Expected(expected)) => assert!(expected.contains(words), "{text}: {expected}"),
                other => panic!("{text}: {other:?}"),
            }
        }
        for text in ["20, 30", "linear 20..40, 3", "linear 20..40 kPa, 3", "20 kPa, 30 mm", "linear a..b mm, 4"] {
            let wrong = parse(text, Some(Dimension::Length));
            assert!(matches!(wrong, Err(Wrong::Quantity(..) | Wrong::Expected(_))), "{text}: {wrong:?}");
        }
    }

    #[test]
    fn values_stay_in_their_range() {
        let Values::Range(range) = parse("log 0.1..0.30000000000000004, 3", None).unwrap() else {
            panic!("no range");
        };
        for i in 0..=1000 {
            let value = range.at(f64::from(i) / 1000.0);
            assert!((range.first..=range.last).contains(&value), "{value}");
        }
    }
}
