//! How numbers are written: rounded for people, exact for machines.

/// Largest number of significant digits a double can carry.
const MOST_DIGITS: usize = 17;

/// `value` rounded to `digits` significant digits, for people.
///
/// Trailing zeros are kept because they say how far the value is known. Very large and very
/// small values read as `1.23×10⁻⁵`; the minus sign is U+2212.
///
/// ```
/// use palpate::number::significant;
/// assert_eq!(significant(-0.012_34, 3), "−0.0123");
/// assert_eq!(significant(1.5e-7, 2), "1.5×10⁻⁷");
/// ```
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "–".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "−∞" }.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.clamp(1, MOST_DIGITS);
    let (mantissa, exponent) = rounded_parts(value, digits);
    let text = if reads_plainly(exponent, digits) {
        fixed(value, digits, exponent)
    } else {
        format!("{mantissa}×10{}", superscript(exponent))
    };
    text.replace('-', "−")
}

/// `1 row`, `2 rows`.
///
/// ```
/// use palpate::number::counted;
/// assert_eq!((counted(1, "row"), counted(2, "row")), ("1 row".to_owned(), "2 rows".to_owned()));
/// ```
#[must_use]
pub fn counted(count: usize, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}

/// `value ± error`, both rounded to the digits the error warrants, for people.
///
/// The error keeps one significant digit, or two when it starts with 1. Without a usable error
/// (not finite, or not positive) only the value is written, to four digits.
///
/// ```
/// use palpate::number::with_error;
/// assert_eq!(with_error(12.3456, 0.0321), "12.35 ± 0.03");
/// assert_eq!(with_error(1.2345e-5, 1.4e-7), "(1.234 ± 0.014)×10⁻⁵");
/// ```
#[must_use]
pub fn with_error(value: f64, error: f64) -> String {
    if !error.is_finite() || error <= 0.0 || !value.is_finite() {
        return significant(value, 4);
    }
    let (one_digit, error_exponent) = rounded_parts(error, 1);
    let leading_one = one_digit == "1" || rounded_parts(error, 2).0.starts_with('1');
    let last = error_exponent - i32::from(leading_one);
    let (value, error) = (rounded_to(value, last), rounded_to(error, last));
    let (_, exponent) = rounded_parts(if value.abs() > error { value } else { error }, MOST_DIGITS);
    let text = if (-3..4).contains(&exponent) || (exponent == 4 && last <= 0) {
        let places = usize::try_from(-last).unwrap_or(0);
        format!("{value:.places$} ± {error:.places$}")
    } else {
        let places = usize::try_from(exponent - last).unwrap_or(0);
        let scale = 10f64.powi(exponent);
        let (v, e) = (value / scale, error / scale);
        format!("({v:.places$} ± {e:.places$})×10{}", superscript(exponent))
    };
    without_negative_zero(&text).replace('-', "−")
}

/// The shortest decimal text that reads back as exactly `value`; empty when it is not a number.
///
/// ```
/// use palpate::number::exact;
/// assert_eq!(exact(0.1 + 0.2), "0.30000000000000004");
/// assert_eq!(exact(5.0), "5");
/// ```
#[must_use]
pub fn exact(value: f64) -> String {
    if value.is_nan() {
        return String::new();
    }
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

/// An integer exponent as Unicode superscript characters.
#[must_use]
pub fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
        })
        .collect()
}

/// Mantissa text and decimal exponent of `value` after rounding to `digits` digits.
fn rounded_parts(value: f64, digits: usize) -> (String, i32) {
    let text = format!("{:.*e}", digits.saturating_sub(1), value.abs());
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let sign = if value < 0.0 { "-" } else { "" };
    (format!("{sign}{mantissa}"), exponent.parse().unwrap_or(0))
}

/// Whether a value of this exponent is easier to read without a power of ten.
fn reads_plainly(exponent: i32, digits: usize) -> bool {
    let digits = i32::try_from(digits).unwrap_or(i32::MAX);
    (-3..=4).contains(&exponent) && exponent < digits.max(3) + 2
}

fn fixed(value: f64, digits: usize, exponent: i32) -> String {
    let places = i32::try_from(digits).unwrap_or(0) - 1 - exponent;
    if let Ok(places) = usize::try_from(places) {
        format!("{value:.places$}")
    } else {
        let step = 10f64.powi(-places);
        format!("{:.0}", (value / step).round() * step)
    }
}

/// `value` rounded to the decimal place 10ᵖ, read back from text so that it is a short decimal again.
fn rounded_to(value: f64, place: i32) -> f64 {
    if place > 0 {
        let step = 10f64.powi(place);
        return (value / step).round() * step;
    }
    let places = usize::try_from(-place).unwrap_or(0);
    format!("{value:.places$}").parse().unwrap_or(value)
}

/// `-0.00 ± …` without its misleading sign.
fn without_negative_zero(text: &str) -> String {
    let (head, tail) = text.split_at(text.find(" ± ").unwrap_or(text.len()));
    let is_zero = head.contains('-') && !head.chars().any(|c| ('1'..='9').contains(&c));
    if is_zero { format!("{}{tail}", head.replace('-', "")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_kept_and_rounded() {
        assert_eq!(significant(1234.6, 3), "1230");
        assert_eq!(significant(0.5, 3), "0.500");
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(0.000_999_96, 3), "0.00100");
        assert_eq!(significant(123_456.0, 3), "1.23×10⁵");
        assert_eq!(significant(-4.2e10, 2), "−4.2×10¹⁰");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(significant(f64::NEG_INFINITY, 3), "−∞");
    }

    #[test]
    fn errors_decide_the_digits() {
        assert_eq!(with_error(0.123_456, 0.004_56), "0.123 ± 0.005");
        assert_eq!(with_error(-3.0, 0.12), "−3.00 ± 0.12");
        assert_eq!(with_error(2.0, 0.096), "2.00 ± 0.10");
        assert_eq!(with_error(-0.001, 0.3), "0.0 ± 0.3");
        assert_eq!(with_error(5.4321e6, 2e4), "(5.43 ± 0.02)×10⁶");
        assert_eq!(with_error(1234.0, 60.0), "1230 ± 60");
        assert_eq!(with_error(70.0, 41.0), "70 ± 40");
        assert_eq!(with_error(999.8, 41.0), "1000 ± 40");
        assert_eq!(with_error(9.998e5, 4.1e3), "(1.000 ± 0.004)×10⁶");
        assert_eq!(with_error(12_346.0, 20.0), "(1.235 ± 0.002)×10⁴");
        assert_eq!(with_error(1.5, f64::NAN), "1.500");
        assert_eq!(with_error(1.5, 0.0), "1.500");
    }

    #[test]
    fn exact_text_reads_back() {
        for value in [0.1, 1.0 / 3.0, 1e300, 5e-324, -0.0, 123_456_789.125, f64::INFINITY] {
            let back: f64 = exact(value).parse().expect("a number");
            assert_eq!(back.to_bits(), value.to_bits());
        }
        assert_eq!(exact(f64::NAN), "");
    }
}
