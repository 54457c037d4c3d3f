//! Reading numbers out of cells, and saying what a cell is that holds none.

use super::mark::DecimalMark;

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cell {
    /// Nothing.
    Empty,
    /// A number without a decimal mark.
    Whole,
    /// A number with a decimal point.
    Point,
    /// A number with a decimal comma (or, it may be, one comma between thousands).
    Comma,
    /// A word that stands for no number or for an infinite one.
    NotFinite,
    /// Anything else.
    Text,
}

impl Cell {
    /// Whether a column of numbers would have such a cell.
    pub(crate) fn is_numeric(self) -> bool {
        !matches!(self, Self::Empty | Self::Text)
    }
}

/// Longest cell that is still read as a number. No printed `f64` comes near it.
const LONGEST: usize = 128;

/// The number in a cell, if it holds a finite one written with this decimal mark.
#[inline]
pub(crate) fn parse(cell: &[u8], decimal: DecimalMark) -> Option<f64> {
    short(cell, decimal.byte()).or_else(|| match decimal {
        DecimalMark::Point => finite(cell),
        DecimalMark::Comma => parse_comma(cell),
    })
}

/// Powers of ten that `f64` holds exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Reads a number of few digits without an exponent, which nearly every cell is; `None` is no verdict.
#[inline]
fn short(cell: &[u8], mark: u8) -> Option<f64> {
    leading(cell, mark).filter(|(_, end)| *end == cell.len()).map(|(value, _)| value)
}

/// Most digits that cannot overflow their sum.
const MOST_DIGITS: usize = 18;

/// The number of few digits without an exponent that some bytes begin with, and where it ends; `None` is no verdict.
///
/// The digits as a whole number and the power of ten are both exact, so their one rounded quotient is the
/// `f64` nearest to the text: the same value that the general parser gives, at a fraction of its time.
#[inline]
pub(crate) fn leading(bytes: &[u8], mark: u8) -> Option<(f64, usize)> {
    let negative = bytes.first() == Some(&b'-');
    let start = usize::from(negative);
    let (mut sum, whole) = digits(bytes, start, 0);
    let mut end = start + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&mark) {
        (sum, fraction) = digits(bytes, end + 1, sum);
        end += 1 + fraction;
    }
    if whole + fraction == 0 || whole + fraction > MOST_DIGITS || sum >= 1 << 53 {
        return None;
    }
    let value = sum as f64 / EXACT_POWERS[fraction];
    Some((if negative { -value } else { value }, end))
}

/// The digits from a place on, appended to those of a number, and how many there are.
#[inline]
fn digits(bytes: &[u8], from: usize, mut sum: u64) -> (u64, usize) {
    const POWERS: [u64; 9] = [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
    let mut at = from;
    while let Some(eight) = bytes.get(at..at + 8).and_then(|eight| <[u8; 8]>::try_from(eight).ok()) {
        let (value, count) = up_to_eight_digits(eight);
        sum = sum.wrapping_mul(POWERS[count]).wrapping_add(value);
        at += count;
        if count < 8 {
            return (sum, at - from);
        }
    }
    while let Some(digit) = bytes.get(at).map(|byte| byte.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
        sum = sum.wrapping_mul(10).wrapping_add(u64::from(digit));
        at += 1;
    }
    (sum, at - from)
}

/// The number that the digits at the front of eight bytes make, and how many they are: all at once, in the bytes of a word.
#[inline]
fn up_to_eight_digits(eight: [u8; 8]) -> (u64, usize) {
    const EACH: u64 = 0x0101_0101_0101_0101;
    let word = u64::from_le_bytes(eight) ^ (EACH * 0x30);
    // A byte above 9 reaches 0x80 when 0x76 is added, or has that bit already; what it carries changes only bytes behind it.
    let others = (word.wrapping_add(EACH * 0x76) | word) & (EACH * 0x80);
    let count = others.trailing_zeros() as usize / 8;
    if count == 0 {
        return (0, 0);
    }
    // Noughts in front of what is left, then pairs, fours and all eight.
    let digits = word << (64 - 8 * count);
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8);
    let odd = (pairs & 0x0000_00FF_0000_00FF).wrapping_mul(0x000F_4240_0000_0064);
    let even = ((pairs >> 16) & 0x0000_00FF_0000_00FF).wrapping_mul(0x0000_2710_0000_0001);
    (odd.wrapping_add(even) >> 32, count)
}

fn parse_comma(cell: &[u8]) -> Option<f64> {
    let mut copy = [0; LONGEST];
    let copy = copy.get_mut(..cell.len())?;
    for (to, &from) in copy.iter_mut().zip(cell) {
        *to = match from {
            b'.' => return None,
            b',' => b'.',
            other => other,
        };
    }
    finite(copy)
}

#[inline]
fn finite(cell: &[u8]) -> Option<f64> {
    // Words like "inf" parse as well; the check for finiteness turns them away.
    let value: f64 = std::str::from_utf8(cell).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

/// What a cell holds, whatever the decimal mark of its file.
pub(crate) fn classify(cell: &[u8]) -> Cell {
    if cell.is_empty() {
        Cell::Empty
    } else if finite(cell).is_some() {
        if cell.contains(&b'.') { Cell::Point } else { Cell::Whole }
    } else if is_not_finite(cell) {
        Cell::NotFinite
    } else if parse_comma(cell).is_some() && !cell.ends_with(b",") {
        Cell::Comma
    } else {
        Cell::Text
    }
}

/// Whether a cell spells "no number" or "infinite" in one of the usual ways, or overflows.
pub(crate) fn is_not_finite(cell: &[u8]) -> bool {
    const WORDS: [&[u8]; 8] = [b"na", b"n/a", b"#n/a", b"#value!", b"#div/0!", b"#num!", b"null", b"infinite"];
    let bare = match cell {
        [b'+' | b'-', rest @ ..] => rest,
        all => all,
    };
    let parsed = std::str::from_utf8(bare).map(str::parse::<f64>);
    matches!(parsed, Ok(Ok(value)) if !value.is_finite())
        || WORDS.iter().any(|word| bare.eq_ignore_ascii_case(word))
        // "1.#QNAN", "1.#INF", "1,#IND": how some C libraries print them.
        || bare.starts_with(b"1.#")
        || bare.starts_with(b"1,#")
}

/// Whether a text is made of what numbers are written with, whatever marks and gaps it has: `1,234.5`, `−0.5`, `1 234,5`.
pub(crate) fn looks_numeric(text: &str) -> bool {
    let of_numbers =
        |letter: char| letter.is_ascii_digit() || "+-\u{2212}.,'\u{2019} \u{a0}\u{202f}\u{2009}eE".contains(letter);
    let text = text.trim();
    text.contains(|letter: char| letter.is_ascii_digit()) && text.chars().all(of_numbers)
}

/// Whether a cell is a number with marks between its thousands: `1,234,567.8`, `1.234,5`, `1 234`, `12'345`.
pub(crate) fn has_thousands(cell: &[u8]) -> bool {
    let bare = match cell {
        [b'+' | b'-', rest @ ..] => rest,
        all => all,
    };
    let ends = |mark: u8| {
        let mut groups = bare.split(|&byte| byte == mark);
        let first = groups.next().unwrap_or_default();
        let rest: Vec<&[u8]> = groups.collect();
        let digits = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
        let Some((last, middle)) = rest.split_last() else {
            return false;
        };
        let whole = last.get(..3).is_some_and(digits);
        let fraction = last.get(3..).unwrap_or_default();
        let fraction_fits = match fraction {
            [] => true,
            [b'.' | b',', rest @ ..] => fraction[0] != mark && digits(rest),
            _ => false,
        };
        first.len() <= 3
            && digits(first)
            && middle.iter().all(|part| part.len() == 3 && digits(part))
            && whole
            && fraction_fits
    };
    [b',', b'.', b' ', b'\''].into_iter().any(ends)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_under_both_marks() {
        assert_eq!(parse(b"-1.5e-3", DecimalMark::Point), Some(-1.5e-3));
        assert_eq!(parse(b"+2", DecimalMark::Point), Some(2.0));
        assert_eq!(parse(b"1,1347E+05", DecimalMark::Comma), Some(113_470.0));
        assert_eq!(parse(b"1.5", DecimalMark::Comma), None);
        assert_eq!(parse(b"1,5", DecimalMark::Point), None);
        assert_eq!(parse(b"", DecimalMark::Point), None);
        assert_eq!(parse(b"nan", DecimalMark::Point), None);
        assert_eq!(parse(b"1e999", DecimalMark::Point), None);
        assert_eq!(parse(&[b'1'; 500], DecimalMark::Comma), None);
    }

    #[test]
    fn short_numbers_equal_the_general_parser() {
        let mut state = 1_u64;
        for _ in 0..20_000 {
            // Any step that mixes the bits will do.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let sign = ["", "-"][(state >> 63) as usize];
            let digits = ((state >> 20) % 1_000_000_000_000).to_string();
            let (whole, fraction) = digits.split_at((state >> 8) as usize % (digits.len() + 1));
            let text = format!("{sign}{whole}.{fraction}");
            let general = text.parse::<f64>().ok().map(f64::to_bits);
            assert_eq!(short(text.as_bytes(), b'.').map(f64::to_bits), general, "{text}");
        }
        assert_eq!(short(b"-0.0", b'.').map(f64::to_bits), Some((-0.0_f64).to_bits()));
        for text in [".", "-", "", "1.2.3", "1e5", "9007199254740993", "1234567890123456789"] {
            assert_eq!(short(text.as_bytes(), b'.'), None, "{text}");
        }
    }

    #[test]
    fn kinds_of_cells() {
        assert_eq!(classify(b""), Cell::Empty);
        assert_eq!(classify(b"12"), Cell::Whole);
        assert_eq!(classify(b".5"), Cell::Point);
        assert_eq!(classify(b"0,5"), Cell::Comma);
        assert_eq!(classify(b"0,"), Cell::Text);
        assert_eq!(classify(b"1-Hold"), Cell::Text);
        for word in [&b"NaN"[..], b"-inf", b"Infinity", b"#N/A", b"1.#QNAN", b"-1.#IND", b"1e999"] {
            assert_eq!(classify(word), Cell::NotFinite);
        }
    }

    #[test]
    fn thousands() {
        for cell in [&b"1,234"[..], b"1,234,567.8", b"1.234,5", b"-12 345", b"1'000"] {
            assert!(has_thousands(cell));
        }
        for cell in [&b"1,23"[..], b"1234,567,8", b"abc", b"", b"1,2345", b","] {
            assert!(!has_thousands(cell));
        }
    }
}
