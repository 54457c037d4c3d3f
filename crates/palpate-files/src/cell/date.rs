//! Dates with times of day, as ISO 8601 and the logs of programs write them.
//!
//! `2024-08-24T21:09:40.123Z`, `2024-08-24 21:09:40,123`, `2024-08-24 21:09:40+02:00`: year first, seconds and all;
//! `24.08.2024 21:09:40`, where points stand between day, month and year; `21:09:40.123` or `09:09:40.123 PM`, a time of day or of a
//! stopwatch, whose hours go on beyond 24; `10:15` or `10:15.5`, two fields of which the last counts the unit of the column: minutes and seconds, or hours and minutes.
//! Without a zone, times are taken as they stand: differences are right unless clocks were changed in between. Dates with
//! slashes that end in the year are none: nothing says whether the day or the month comes first.

/// Seconds since 1970 of a date with its time of day, or since midnight of a time of day; a leap second counts as the one
/// behind it. Of two fields sixty times the first and the last.
pub(crate) fn parse(cell: &[u8]) -> Option<f64> {
    if let Some((seconds, fraction, [])) = time_of_day(cell) {
        return Some(seconds as f64 + fraction);
    }
    if let Some(time) = elapsed(cell).or_else(|| two_fields(cell)) {
        return Some(time);
    }
    let (date, rest) = year_first(cell).or_else(|| year_last(cell))?;
    let (of_day, fraction, rest) = time_of_day(behind(rest, b"T t")?)?;
    Some((days(date)? * 86_400 + of_day - zone(rest)?) as f64 + fraction)
}

/// Seconds from 1970 to the beginning of a day, of a date without a time of day.
pub(crate) fn day(cell: &[u8]) -> Option<f64> {
    match year_first(cell).or_else(|| year_last(cell))? {
        (date, []) => Some((days(date)? * 86_400) as f64),
        _ => None,
    }
}

/// Whether a cell is a time of day without a date.
pub(crate) fn is_time_of_day(cell: &[u8]) -> bool {
    matches!(time_of_day(cell), Some((.., [])))
}

/// Whether a cell is a clock of two fields, `10:15`.
pub(crate) fn has_two_fields(cell: &[u8]) -> bool {
    two_fields(cell).is_some()
}

/// Hours, minutes and seconds of a stopwatch, which goes on beyond a day: `37:21:04.5`.
fn elapsed(cell: &[u8]) -> Option<f64> {
    let hours = |count| digits(cell, count).filter(|(_, rest)| rest.starts_with(b":"));
    let (hours, rest) = [2, 3].into_iter().find_map(hours)?;
    let (minutes, rest) = digits(behind(rest, b":")?, 2)?;
    let (seconds, rest) = digits(behind(rest, b":")?, 2)?;
    let (fraction, rest) = match behind(rest, b".,") {
        Some(rest) => fraction(rest)?,
        None => (0.0, rest),
    };
    let sound = minutes < 60 && seconds < 60 && rest.is_empty();
    sound.then(|| (hours * 3600 + minutes * 60 + seconds) as f64 + fraction)
}

fn two_fields(cell: &[u8]) -> Option<f64> {
    let (first, rest) = digits(cell, 3).or_else(|| one_or_two_digits(cell))?;
    let (last, rest) = digits(behind(rest, b":")?, 2)?;
    let (fraction, rest) = match behind(rest, b".,") {
        Some(rest) => fraction(rest)?,
        None => (0.0, rest),
    };
    (last < 60 && rest.is_empty()).then(|| (60 * first + last) as f64 + fraction)
}

/// Year, month and day.
type Date = (i64, i64, i64);

/// Days from 1970 to a date that the calendar has.
fn days((year, month, day): Date) -> Option<i64> {
    let days = days_since_1970(year, month, day);
    ((1..=12).contains(&month) && day > 0 && days < days_since_1970(year, month + 1, 1)).then_some(days)
}

fn year_first(cell: &[u8]) -> Option<(Date, &[u8])> {
    let (year, rest) = digits(cell, 4)?;
    let (month, rest) = digits(behind(rest, b"-/")?, 2)?;
    let (day, rest) = digits(behind(rest, b"-/")?, 2)?;
    Some(((year, month, day), rest))
}

fn year_last(cell: &[u8]) -> Option<(Date, &[u8])> {
    let (day, rest) = one_or_two_digits(cell)?;
    let (month, rest) = one_or_two_digits(behind(rest, b".")?)?;
    let (year, rest) = digits(behind(rest, b".")?, 4)?;
    Some(((year, month, day), rest))
}

/// Hours, minutes and seconds as seconds, the fraction of a second, and what stands behind.
fn time_of_day(text: &[u8]) -> Option<(i64, f64, &[u8])> {
    let (hour, rest) = one_or_two_digits(text)?;
    let (minute, rest) = digits(behind(rest, b":")?, 2)?;
    let (second, rest) = match behind(rest, b":") {
        Some(rest) => digits(rest, 2)?,
        // "10:15 AM"
        None if rest.trim_ascii_end().to_ascii_lowercase().ends_with(b"m") => (0, rest),
        None => return None,
    };
    let (fraction, rest) = match behind(rest, b".,") {
        Some(rest) => fraction(rest)?,
        None => (0.0, rest),
    };
    let (hour, rest) = half_day(hour, rest)?;
    let sound = hour < 24 && minute < 60 && second <= 60;
    sound.then_some((hour * 3600 + minute * 60 + second, fraction, rest))
}

/// The hour of the whole day where `AM` or `PM` says which half of it is meant, and what stands behind that.
fn half_day(hour: i64, rest: &[u8]) -> Option<(i64, &[u8])> {
    let (half, behind) = match rest.trim_ascii_start() {
        [half @ (b'A' | b'a' | b'P' | b'p'), b'M' | b'm', behind @ ..] => (half.to_ascii_lowercase(), behind),
        _ => return Some((hour, rest)),
    };
    let after_noon = if half == b'p' { 12 } else { 0 };
    (1..=12).contains(&hour).then_some((hour % 12 + after_noon, behind))
}

fn one_or_two_digits(text: &[u8]) -> Option<(i64, &[u8])> {
    digits(text, 2).or_else(|| digits(text, 1))
}

/// The number in exactly `count` digits, and what stands behind.
fn digits(text: &[u8], count: usize) -> Option<(i64, &[u8])> {
    let (digits, rest) = text.split_at_checked(count)?;
    let number = digits
        .iter()
        .try_fold(0, |number, byte| byte.is_ascii_digit().then(|| number * 10 + i64::from(byte - b'0')));
    Some((number?, rest))
}

/// What stands behind one of `marks`.
fn behind<'t>(text: &'t [u8], marks: &[u8]) -> Option<&'t [u8]> {
    text.split_first().filter(|(first, _)| marks.contains(first)).map(|(_, rest)| rest)
}

/// The digits behind a decimal mark, up to 12.
fn fraction(text: &[u8]) -> Option<(f64, &[u8])> {
    let count = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (number, rest) = digits(text, count)?;
    (1..=12).contains(&count).then(|| (number as f64 / 10_f64.powi(count as i32), rest))
}

/// How many seconds a zone is ahead: nothing, `Z`, `+02:00`, `+0200` or `+02`.
fn zone(text: &[u8]) -> Option<i64> {
    let (sign, rest) = match text.trim_ascii_start() {
        [] | b"Z" | b"z" | b"UTC" => return Some(0),
        [b'+', rest @ ..] => (1, rest),
        [b'-', rest @ ..] => (-1, rest),
        _ => return None,
    };
    let (hours, rest) = digits(rest, 2)?;
    let (minutes, rest) = match behind(rest, b":").unwrap_or(rest) {
        [] => (0, &[][..]),
        rest => digits(rest, 2)?,
    };
    (rest.is_empty() && hours <= 14 && minutes < 60).then_some(sign * (hours * 3600 + minutes * 60))
}

/// Days from 1 January 1970 to a date of the Gregorian calendar.
pub(crate) fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    // Counted from March on, the day that leap years have more ends the year, and months differ by a rule.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    year * 365 + leap_days + (153 * month + 2) / 5 + day - 719_469
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_of_known_seconds() {
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-03-01T00:00:00Z", 951_868_800.0),
            ("2024-02-29 12:00:00", 1_709_208_000.0),
            ("2024-08-24T13:09:05.198Z", 1_724_504_945.198),
            ("2024-08-24 13:09:05,198", 1_724_504_945.198),
            ("2024/08/24 15:09:05.198 +02:00", 1_724_504_945.198),
            ("2024-08-24T10:39:05-0230", 1_724_504_945.0),
            ("2024-08-24T15:09:05+02", 1_724_504_945.0),
            ("1969-12-31T23:59:59Z", -1.0),
            ("2001-09-09T01:46:40Z", 1e9),
            ("2033-05-18T03:33:20Z", 2e9),
            ("24.08.2024 13:09:05,198", 1_724_504_945.198),
            ("1.3.2000 0:00:00", 951_868_800.0),
            ("00:00:05.250", 5.25),
            ("9:30:00", 34_200.0),
            ("23:59:59,5", 86_399.5),
            ("11:59:45.5 AM", 43_185.5),
            ("12:00:01 am", 1.0),
            ("1:00:00 PM", 46_800.0),
            ("1:15 PM", 47_700.0),
            ("01:05", 65.0),
            ("00:05.25", 5.25),
            ("125:30,5", 7530.5),
            // A record of 37 h was refused with a hint to write what stood in its first row.
            ("24:00:00", 86_400.0),
            ("37:21:04.5", 134_464.5),
            ("100:00:00,25", 360_000.25),
        ] {
            assert_eq!(parse(text.as_bytes()), Some(seconds), "{text}");
        }
    }

    #[test]
    fn what_is_no_date_with_a_time() {
        for text in [
            "",
            "2024-08-24",
            "9:4",
            "09:60",
            "1:09:60:00",
            "24:60:00",
            "24:00:00 PM",
            "1000:00:00",
            "2024:08:24",
            "24/08/2024 21:09:40",
            "24.13.2024 21:09:40",
            "2023-02-29T00:00:00",
            "2024-13-01T00:00:00",
            "2024-00-10T00:00:00",
            "2024-08-24T24:00:00",
            "2024-08-24T21:09:61",
            "2024-08-24T21:09:40.",
            "2024-08-24T21:09:40 PM",
            "2024-08-24T21:09:40+2",
            "2024-08-24T21:09:40.1234567890123",
            "1724504945",
        ] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
    }
}
