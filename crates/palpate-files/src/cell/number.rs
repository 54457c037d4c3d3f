//! Reading numbers out of cells, and saying what a cell is that holds none.

use lexical_core::{ParseFloatOptions, format::STANDARD};

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

/// How numbers are written with a decimal mark. Words such as `inf` are none.
const fn written(mark: u8) -> ParseFloatOptions {
    let options = ParseFloatOptions::builder().decimal_point(mark);
    options.nan_string(None).inf_string(None).infinity_string(None).build_strict()
}

const POINT: ParseFloatOptions = written(b'.');
const COMMA: ParseFloatOptions = written(b',');

fn options(decimal: DecimalMark) -> &'static ParseFloatOptions {
    match decimal {
        DecimalMark::Point => &POINT,
        DecimalMark::Comma => &COMMA,
    }
}

/// The number in a cell, if it holds a finite one written with this decimal mark. Marks between thousands are passed over where they can be
/// nothing else: `1.185,1`, `1.234.567`, `1'185`.
#[inline]
pub(crate) fn parse(cell: &[u8], decimal: DecimalMark) -> Option<f64> {
    ungrouped(cell, decimal).or_else(|| grouped(cell, decimal, false))
}

#[inline]
fn ungrouped(cell: &[u8], decimal: DecimalMark) -> Option<f64> {
    let value: f64 = lexical_core::parse_with_options::<_, STANDARD>(cell, options(decimal)).ok()?;
    value.is_finite().then_some(value)
}

/// What sets off thousands besides the other of point and comma: blanks and apostrophes, in UTF-8 and in Latin-1.
const GAPS: [&[u8]; 8] = [
    b" ",
    b"'",
    "\u{a0}".as_bytes(),
    "\u{202f}".as_bytes(),
    "\u{2009}".as_bytes(),
    "\u{2019}".as_bytes(),
    b"\xa0",
    b"\x92",
];

/// The number in a cell with marks between its thousands. One point or comma alone may as well mark decimals: `1.185` is 1185 only `by_column`.
#[cold]
pub(crate) fn grouped(cell: &[u8], decimal: DecimalMark, by_column: bool) -> Option<f64> {
    let other: &[u8] = if decimal == DecimalMark::Point { b"," } else { b"." };
    let bare = cell.strip_prefix(b"-").or_else(|| cell.strip_prefix(b"+")).unwrap_or(cell);
    let end = bare.iter().position(|byte| *byte == decimal.byte()).unwrap_or(bare.len());
    let (whole, fraction) = bare.split_at(end);
    let digits = |part: &[u8]| part.iter().all(u8::is_ascii_digit);
    let mark = [other].into_iter().chain(GAPS).find(|mark| memchr::memmem::find(whole, mark).is_some())?;
    let mut plain = cell[..cell.len() - bare.len()].to_vec();
    let (mut rest, mut marks) = (whole, 0);
    while let Some(at) = memchr::memmem::find(rest, mark) {
        let group = &rest[..at];
        let fits = if marks == 0 { (1..=3).contains(&at) && group[0] != b'0' } else { at == 3 };
        if !fits || !digits(group) {
            return None;
        }
        plain.extend_from_slice(group);
        rest = &rest[at + mark.len()..];
        marks += 1;
    }
    let is_clear = by_column || mark != other || marks > 1 || !fraction.is_empty();
    if rest.len() != 3 || !digits(rest) || !is_clear {
        return None;
    }
    plain.extend_from_slice(rest);
    plain.extend_from_slice(fraction);
    ungrouped(&plain, decimal)
}

/// The finite number that some bytes begin with, and where it ends; `None` is no verdict.
#[inline]
pub(crate) fn leading(bytes: &[u8], decimal: DecimalMark) -> Option<(f64, usize)> {
    let (value, end) = lexical_core::parse_partial_with_options::<f64, STANDARD>(bytes, options(decimal)).ok()?;
    value.is_finite().then_some((value, end))
}

/// What a cell holds, whatever the decimal mark of its file.
pub(crate) fn classify(cell: &[u8]) -> Cell {
    if cell.is_empty() {
        Cell::Empty
    } else if parse(cell, DecimalMark::Point).is_some() {
        if cell.contains(&b'.') { Cell::Point } else { Cell::Whole }
    } else if is_not_finite(cell) {
        Cell::NotFinite
    } else if parse(cell, DecimalMark::Comma).is_some() && !cell.ends_with(b",") {
        Cell::Comma
    } else {
        Cell::Text
    }
}

/// Whether a cell spells "no number" or "infinite" in one of the usual ways, or overflows.
pub(crate) fn is_not_finite(cell: &[u8]) -> bool {
    // The errors of a spreadsheet in English, German, French, Italian and Spanish.
    const WORDS: [&[u8]; 17] = [
        b"na",
        b"n/a",
        b"null",
        b"infinite",
        b"#div/0!",
        b"#n/a",
        b"#value!",
        b"#num!",
        b"#nv",
        b"#wert!",
        b"#zahl!",
        b"#valeur!",
        b"#nombre!",
        b"#n/d",
        b"#valore!",
        "#¡valor!".as_bytes(),
        "#¡num!".as_bytes(),
    ];
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

/// Whether a cell is empty, or says that there is no number; infinity is stated of one that there was.
pub(crate) fn is_absent(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    let is_infinite = || {
        let word = String::from_utf8_lossy(cell).to_lowercase();
        word.contains("inf") || word.parse::<f64>().is_ok_and(f64::is_infinite)
    };
    let is_none = matches!(cell, b"-" | b"--" | b"---" | b"?") || cell.eq_ignore_ascii_case(b"none");
    cell.is_empty() || is_none || is_not_finite(cell) && !is_infinite()
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
    let grouped = |mark: u8| {
        // The other of point and comma marks decimals.
        let fraction = bare.iter().rposition(|byte| b".,".contains(byte) && *byte != mark);
        let (whole, fraction) = bare.split_at(fraction.unwrap_or(bare.len()));
        let digits = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
        let mut groups = whole.split(|&byte| byte == mark);
        groups.next().is_some_and(|first| first.len() <= 3 && digits(first))
            && whole.contains(&mark)
            && groups.all(|group| group.len() == 3 && digits(group))
            && fraction.get(1..).is_none_or(digits)
    };
    [b',', b'.', b' ', b'\''].into_iter().any(grouped)
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
    fn numbers_equal_those_of_the_standard_library() {
        let mut state = 1_u64;
        for _ in 0..20_000 {
            // Any step that mixes the bits will do.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let sign = ["", "-"][(state >> 63) as usize];
            let digits = ((state >> 20) % 1_000_000_000_000).to_string();
            let (whole, fraction) = digits.split_at((state >> 8) as usize % (digits.len() + 1));
            let text = format!("{sign}{whole}.{fraction}");
            let general = text.parse::<f64>().ok().map(f64::to_bits);
            assert_eq!(parse(text.as_bytes(), DecimalMark::Point).map(f64::to_bits), general, "{text}");
        }
        for text in [
            "-0.0",
            ".",
            "-",
            "",
            "1.2.3",
            "1e5",
            "1E+05",
            "1e",
            ".e5",
            "5.",
            "+.5",
            " 1",
            "1_0",
            "9007199254740993",
            "1234567890123456789",
            "2.2250738585072011e-308",
            "5e-324",
            "1e-400",
        ] {
            let general = text.parse::<f64>().ok().map(f64::to_bits);
            assert_eq!(parse(text.as_bytes(), DecimalMark::Point).map(f64::to_bits), general, "{text}");
            let with_comma = text.replace('.', ",");
            assert_eq!(parse(with_comma.as_bytes(), DecimalMark::Comma).map(f64::to_bits), general, "{text}");
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

    /// `1.185,1` was a text.
    #[test]
    fn thousands_are_read_where_their_marks_can_be_nothing_else() {
        for (cell, mark, value) in [
            ("1.185,1", DecimalMark::Comma, 1185.1),
            ("-1.234.567", DecimalMark::Comma, -1_234_567.0),
            ("1,185.1", DecimalMark::Point, 1185.1),
            ("1'185.1", DecimalMark::Point, 1185.1),
            ("1 185,1", DecimalMark::Comma, 1185.1),
            ("1\u{202f}185,1", DecimalMark::Comma, 1185.1),
            ("12\u{2019}345", DecimalMark::Point, 12_345.0),
        ] {
            assert_eq!(parse(cell.as_bytes(), mark), Some(value), "{cell}");
        }
        assert_eq!(parse(b"1\xa0185,1", DecimalMark::Comma), Some(1185.1));
        for cell in ["1.185", "0.185,1", "1.18,1", "1.1855,1", "1.185 200,1", "1.,5", ".185,1"] {
            assert_eq!(parse(cell.as_bytes(), DecimalMark::Comma), None, "{cell}");
        }
        assert_eq!(grouped(b"1.185", DecimalMark::Comma, true), Some(1185.0));
        assert_eq!(classify(b"1.185,1"), Cell::Comma);
        assert_eq!(classify(b"1,185.1"), Cell::Point);
        assert_eq!(classify(b"1'185"), Cell::Whole);
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
