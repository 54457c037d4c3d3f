//! Dates and times of day as numbers.

use crate::cell::date::days_since_1970;

/// Days from 1 January 1970 to a date with or without a time such as `2026-11-22T08:30:00.5`.
///
/// Without an offset and with `Z` it is taken for universal time; another offset is not understood.
pub(super) fn of_iso(text: &str) -> Option<f64> {
    let text = text.trim().trim_end_matches('Z');
    let (date, time) = text.split_once(['T', ' ']).unwrap_or((text, "0:0:0"));
    let mut date = date.splitn(3, '-').map(|part| part.parse::<i64>().ok());
    let (year, month, day) = (date.next()??, date.next()??, date.next()??);
    let mut time = time.splitn(3, ':');
    let hours: f64 = time.next()?.parse().ok()?;
    let minutes: f64 = time.next()?.parse().ok()?;
    let seconds: f64 = time.next().unwrap_or("0").parse().ok()?;
    let sound = (1900..=9999).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
    let clock = (0.0..=24.0).contains(&hours) && (0.0..60.0).contains(&minutes) && (0.0..61.0).contains(&seconds);
    let of_day = ((hours * 60.0 + minutes) * 60.0 + seconds) / 86_400.0;
    (sound && clock).then(|| days_since_1970(year, month, day) as f64 + of_day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_of_dates() {
        // What Excel counts, 25,569 days later.
        assert_eq!(of_iso("1970-01-01"), Some(0.0));
        assert_eq!(of_iso("2000-02-29T12:00:00"), Some(36_585.5 - 25_569.0));
        assert_eq!(of_iso("2023-05-15T06:00:00.000Z"), Some(45_061.25 - 25_569.0));
        for text in ["", "2023", "2023-13-01", "2023-05-15T25:00", "2023-05-15T10:00:00+02:00", "a-b-c"] {
            assert_eq!(of_iso(text), None, "{text}");
        }
    }
}
