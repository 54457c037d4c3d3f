//! Times counted from 1970, as the clocks of computers count them.
//!
//! Such a time is large: in seconds it leaves `f64` steps of 0.2 µs, and every later difference would carry the rounding of
//! its unit. It is made relative to the first row before anything is computed, in the unit it is written in, which is
//! exact.

use super::part::ColumnInfo;
use crate::naming::{Quantity, last_unit};

/// The unit in a description that says: seconds, or parts of them, since 1970.
pub(crate) const EPOCH: &str = "epoch";

/// First second of 2000 and of 2100, counted from 1970.
const YEARS: std::ops::Range<f64> = 946_684_800.0..4_102_444_800.0;

/// Units that clocks count in. Each is a thousand times the next, and the years above differ by less than a factor of
/// five, so that a time lies in these years in one unit at most.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];

/// Words that mean such a time when they name a column.
const NAMES: [&str; 7] = ["timestamp", "time stamp", "epoch", "unix time", "unixtime", "unix timestamp", "epoch time"];

/// The unit in which the first cell of a column is a time between 2000 and 2100, and its factor.
pub(crate) fn unit(column: &ColumnInfo) -> Option<(&'static str, f64)> {
    let first = first(column)?;
    UNITS.into_iter().find(|(_, factor)| YEARS.contains(&(first * factor)))
}

/// Whether the first cell of a column with this factor, of a second or less, is a time between 2000 and 2100.
pub(crate) fn counts(column: &ColumnInfo, factor: f64) -> bool {
    factor <= 1.0 && first(column).is_some_and(|first| YEARS.contains(&(first * factor)))
}

/// Seconds in a day.
const DAY: f64 = 86_400.0;

/// 1 January 2000 and 2100 as spreadsheets count days, from 30 December 1899.
const SERIALS: std::ops::Range<f64> = 36_526.0..73_051.0;

/// The day of a spreadsheet from which clocks count.
const SERIAL_OF_1970: f64 = 25_569.0;

/// Seconds since 1970 of a time with this factor to s, if it lies between 2000 and 2100: counted from 1970, or in the days of a spreadsheet.
pub(crate) fn since_1970(time: f64, factor: f64) -> Option<f64> {
    let serial = Some((time - SERIAL_OF_1970) * DAY).filter(|_| factor == DAY && SERIALS.contains(&time));
    serial.or_else(|| Some(time * factor).filter(|seconds| YEARS.contains(seconds)))
}

/// Whether numbers look like the dates of a spreadsheet, of this century and all of one day. As seconds they would be a record of less than a
/// second, half a day or more after its clock began.
pub(crate) fn are_serials(times: &[f64]) -> bool {
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return false;
    };
    times.len() > 1 && SERIALS.contains(first) && (last - first).abs() < 1.0
}

/// The unit that a column without one most often has: days where a time begins like a date of a spreadsheet, 45123.4567; what its name ends with
/// where that is a unit.
pub(crate) fn usual_unit(column: &ColumnInfo, quantity: Quantity) -> &'static str {
    /// Decimals of a day that tell ten seconds.
    const FEWEST: usize = 4;
    let decimals = column.sample.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    let is_serial = || decimals >= FEWEST && first(column).is_some_and(|first| SERIALS.contains(&first));
    if quantity == Quantity::Time && is_serial() {
        return "d";
    }
    let in_name = column.name.as_deref().and_then(|name| last_unit(name, quantity));
    in_name.unwrap_or_else(|| quantity.usual_unit())
}

/// A date in s less another, both counted from 1970: to the µs, which is the most that dates are written to. What is beyond
/// that is rounding.
pub(crate) fn since(seconds: f64, first: f64) -> f64 {
    ((seconds - first) * 1e6).round() / 1e6
}

/// Whether a column without a unit is named as such a time.
pub(crate) fn is_named(column: &ColumnInfo) -> bool {
    let name = column.name.as_deref().unwrap_or("").trim().to_lowercase().replace('_', " ");
    NAMES.contains(&name.as_str())
}

/// Whether a cell that is read as a time begins with a date.
pub(crate) fn is_date(cell: &str) -> bool {
    // Hours, of a stopwatch up to three digits of them, are all that stands before the first colon of a time without a date.
    let before = cell.split(':').next().unwrap_or("").trim();
    before.bytes().any(|byte| !byte.is_ascii_digit())
}

/// Whether a cell that is read as a time of day is one of one o'clock or later.
pub(crate) fn is_late(cell: &str) -> bool {
    cell.split_once(':')
        .and_then(|(hour, _)| hour.trim().parse::<u32>().ok())
        .is_some_and(|hour| hour >= 1)
}

fn first(column: &ColumnInfo) -> Option<f64> {
    column.sample.replace(',', ".").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::part::ColumnKind;

    fn column(name: &str, sample: &str) -> ColumnInfo {
        ColumnInfo {
            number: 1,
            name: Some(name.to_owned()),
            unit: None,
            kind: ColumnKind::Number,
            sample: sample.to_owned(),
        }
    }

    #[test]
    fn a_time_since_the_start_of_a_test_is_not_late() {
        let late = ["09:00:00", "9:00:00,5", "12:30:00 PM", "00:59:59.9", "0:00:01", "12", ""].map(is_late);
        assert_eq!(late, [true, true, true, false, false, false, false]);
    }

    #[test]
    fn days_of_a_spreadsheet() {
        // 2023-07-16T12:00:00Z.
        assert_eq!(since_1970(45_123.5, DAY), Some(1_689_508_800.0));
        assert_eq!(since_1970(45_123.5, 1.0), None);
        assert_eq!(since_1970(1_689_508_800.0, 1.0), Some(1_689_508_800.0));
        assert!(
            are_serials(&[45_123.456_7, 45_123.456_8])
                && !are_serials(&[45_123.4, 45_133.4])
                && !are_serials(&[0.0, 0.1])
        );
        let units = ["45123.4567", "45123,45671", "45123.4", "0.4567"]
            .map(|sample| usual_unit(&column("Time", sample), Quantity::Time));
        assert_eq!(units, ["d", "d", "s", "s"]);
    }

    #[test]
    fn one_unit_or_none() {
        for (sample, expected) in [
            ("1724504945.1984644", Some("s")),
            ("1724504945,1984644", Some("s")),
            ("1724504945198", Some("ms")),
            ("1724504945198464", Some("us")),
            ("1724504945198464400", Some("ns")),
            ("946684800", Some("s")),
            ("946684799", None),
            ("4102444799999", Some("ms")),
            ("4102444800", None),
            ("0.01", None),
            ("x", None),
        ] {
            assert_eq!(unit(&column("t", sample)).map(|(unit, _)| unit), expected, "{sample}");
        }
        assert!(is_named(&column("Timestamp", "")) && is_named(&column("unix_time", "")));
        assert!(!is_named(&column("Time", "")) && !is_named(&column("force timestamp", "")));
    }
}
