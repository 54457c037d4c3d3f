//! How numbers are written: rounded for people, exact for machines.

/// Largest number of significant digits a double can carry.
const MOST_DIGITS: usize = 17;

/// `value` rounded to `digits` significant digits, for people.
///
/// Trailing zeros are written because they show the precision of the value. Very large and very
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

/// `value [low, high]`, rounded to two significant digits of the nearer half of the interval, for people.
///
/// An end that is open reads `∞` and stands behind a round bracket. An interval that is open on both sides, as is (0, ∞) for a
/// parameter above 0, leaves the value no digits to be known to: only the interval is written.
///
/// ```
/// use palpate::number::with_interval;
/// assert_eq!(with_interval(12.3456, (12.28, 12.41)), "12.346 [12.280, 12.410]");
/// assert_eq!(with_interval(2.93, (0.81, 10.7)), "2.9 [0.8, 10.7]");
/// assert_eq!(with_interval(2.93, (0.81, f64::INFINITY)), "2.9 [0.8, ∞)");
/// assert_eq!(with_interval(0.31, (-0.12, 5.9957e8)), "0.31 [−0.12, 6.0×10⁸]");
/// assert_eq!(with_interval(1.2345e-5, (1.2e-5, 1.27e-5)), "(1.234 [1.200, 1.270])×10⁻⁵");
/// ```
#[must_use]
pub fn with_interval(value: f64, (low, high): (f64, f64)) -> String {
    if low == 0.0 && high.is_infinite() {
        return "(0, ∞)".to_owned();
    }
    let halves = [value - low, high - value].into_iter().filter(|half| half.is_finite() && *half > 0.0);
    let nearer = halves.fold(f64::INFINITY, f64::min);
    let farthest = low.abs().max(high.abs());
    let is_wide = low > 0.0 && high > WIDE * low || farthest > WIDE * value.abs().max(nearer);
    if is_wide && farthest.is_finite() {
        let two = |value: f64| significant(value, 2);
        return format!("{} {}", two(value), brackets(&two(low), &two(high), (low, high)));
    }
    if !value.is_finite() || nearer.is_infinite() {
        let same = low == value && high == value;
        return if same {
            significant(value, 4)
        } else {
            brackets(&significant(low, 3), &significant(high, 3), (low, high))
        };
    }
    let (_, nearer_exponent) = rounded_parts(nearer, 2);
    let (_, exponent) = rounded_parts(rounded_to(value, nearer_exponent - 1), MOST_DIGITS);
    let largest = exponent.max(nearer_exponent);
    // No more digits than the value can have: an interval of rounding alone.
    let last = (nearer_exponent - 1).max(largest - 8);
    let plain = (-3..4).contains(&largest) || (largest == 4 && last <= 2);
    let scale = if plain { 1.0 } else { 10f64.powi(largest) };
    let places = usize::try_from(if plain { -last } else { largest - last }).unwrap_or(0);
    let text = |end: f64| match end.is_infinite() {
        true => significant(end, 1),
        false => without_negative_zero(&format!("{:.places$}", rounded_to(end, last) / scale)).replace('-', "−"),
    };
    let shown = format!("{} {}", text(value), brackets(&text(low), &text(high), (low, high)));
    if plain { shown } else { format!("({shown})×10{}", superscript(largest)) }
}

/// Ratio of the ends of an interval, or of an end to what is known of the value, beyond which each has digits of its own.
const WIDE: f64 = 100.0;

/// An interval; an end that is not reached has a round bracket.
fn brackets(low: &str, high: &str, ends: (f64, f64)) -> String {
    let open = if ends.0.is_infinite() { '(' } else { '[' };
    let close = if ends.1.is_infinite() { ')' } else { ']' };
    format!("{open}{low}, {high}{close}")
}

/// The shortest decimal text that reads back as exactly `value`; empty when it is not a number.
///
/// ```
/// use palpate::number::exact;
/// assert_eq!(exact(0.1 + 0.2), "0.30000000000000004");
/// assert_eq!(exact(5.0), "5");
/// assert_eq!(exact(0.000_012), "1.2e-05");
/// ```
#[must_use]
pub fn exact(value: f64) -> String {
    if value.is_nan() {
        return String::new();
    }
    let text = format!("{value:?}");
    match (text.strip_suffix(".0"), text.split_once('e')) {
        (Some(whole), _) => whole.to_owned(),
        // Two digits of the exponent, as C, Python and R write it.
        (None, Some((mantissa, exponent))) => {
            let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
            format!("{mantissa}e{sign}{digits:0>2}")
        }
        (None, None) => text,
    }
}

/// The shortest decimal text of `value` rounded to `digits` significant digits, as machines read it.
///
/// ```
/// use palpate::number::shortest;
/// assert_eq!(shortest(1e3 * 1e-10, 10), "1e-07");
/// assert_eq!(shortest(100.0 / 3.0, 6), "33.3333");
/// assert_eq!(shortest(250.0, 6), "250");
/// ```
#[must_use]
pub fn shortest(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.clamp(1, MOST_DIGITS) - 1).parse();
    exact(rounded.unwrap_or(value))
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

/// `-0.00` without its misleading sign.
fn without_negative_zero(text: &str) -> String {
    let is_zero = !text.chars().any(|c| ('1'..='9').contains(&c));
    if is_zero { text.replace('-', "") } else { text.to_owned() }
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
    fn intervals_decide_the_digits() {
        assert_eq!(with_interval(0.0728, (0.071_42, 0.0742)), "0.0728 [0.0714, 0.0742]");
        assert_eq!(with_interval(22_480.0, (19_200.0, 25_800.0)), "22500 [19200, 25800]");
        assert_eq!(with_interval(5.4321e6, (5.39e6, 5.47e6)), "(5.432 [5.390, 5.470])×10⁶");
        assert_eq!(with_interval(-0.001, (-0.6, 0.6)), "0.00 [−0.60, 0.60]");
        assert_eq!(with_interval(2.0, (f64::NEG_INFINITY, 3.0)), "2.0 (−∞, 3.0]");
        assert_eq!(with_interval(2.0, (0.0, f64::INFINITY)), "(0, ∞)");
        assert_eq!(with_interval(2.0, (f64::NEG_INFINITY, f64::INFINITY)), "(−∞, ∞)");
        assert_eq!(with_interval(7200.0, (36.0, 1.42e6)), "7200 [36, 1.4×10⁶]");
        assert_eq!(with_interval(2.0, (2.0, 2.0)), "2.000");
        assert_eq!(with_interval(1.0, (1.0 - 1e-14, 1.0 + 1e-14)), "1.00000000 [1.00000000, 1.00000000]");
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
