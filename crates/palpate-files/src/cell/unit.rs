//! Telling a unit from the name it is written behind.
//!
//! Units are recognised here, never interpreted: what comes out is the text as written less its brackets.

use palpate::units::{self, Dimension};

use crate::naming::{is_listed, is_named_in, is_strain_in, is_unit_in_words, names_quantity};

/// Words that units are made of, in lower case.
const WORDS: &[&str] = &[
    // time and frequency
    "s", "sec", "secs", "second", "seconds", "ms", "msec", "us", "usec", "µs", "μs", "ns", "nsec", "nanosec", "min",
    "mins", "minute", "minutes", "h", "hr", "hrs", "hour", "hours", "d", "day", "days", "hz", "khz", "mhz", "sekunde",
    "sekunden", "seconde", "secondes", "segundo", "segundos", "秒", "毫秒", "分", "分钟",
    "小时", // length and angle
    "m", "dm", "cm", "mm", "um", "µm", "μm", "nm", "pm", "km", "in", "inch", "inches", "\"", "ft", "mil", "deg", "°",
    "rad", "mrad", "米", "厘米", "毫米", "微米", "度", // force and mass
    "n", "dan", "cn", "kn", "mn", "un", "µn", "μn", "nn", "pn", "newton", "newtons", "lbf", "ozf", "kip", "lb", "lbs",
    "kgf", "gf", "g", "kg", "mg", "ug", "µg", "μg", "牛", "牛顿", "千牛", "毫牛", "克",
    "千克", // stress and pressure
    "pa", "hpa", "kpa", "mpa", "gpa", "psi", "ksi", "bar", "mbar", "atm", "帕", "千帕", "兆帕",
    // ratios and arbitrary units
    "%", "pct", "percent", "ppm", "strain", "1", "au", "a", "u", "count", "counts", "cycle", "cycles", "segment",
    "segments", "point", "points", // temperature
    "°c", "℃", "degc", "c", "°f", "degf", "f", "k", "°k", // electricity, work, textiles
    "v", "mv", "uv", "µv", "μv", "ma", "ua", "ohm", "ohms", "ω", "kω", "mω", "kohm", "pf", "nf", "uf", "µf", "μf", "j",
    "mj", "uj", "w", "mw", "tex", "dtex", "den",
];

/// Units of strains, in lower case.
const STRAINS: &str =
    "microstrain microstrains millistrain mstrain ustrain µstrain μstrain mε uε µε με µe μe µin μin uin";

/// Units that are taken for one behind an underscore. Single letters that often number or label something else
/// (`sensor_A`, `run_C`) are left out.
const SUFFIXES: &[&str] = &[
    "s", "sec", "secs", "seconds", "ms", "msec", "us", "usec", "µs", "μs", "ns", "nsec", "nanosec", "hz", "khz", "m",
    "cm", "mm", "um", "µm", "μm", "nm", "n", "kn", "mn", "un", "µn", "μn", "nn", "pn", "lbf", "kgf", "gf", "kg", "mg",
    "pa", "kpa", "mpa", "gpa", "psi", "percent", "pct", "deg", "rad", "degc",
];

/// Units that are taken for one behind a blank as well. Words that are names or ends of names too (`Time in`, `Force m`, `Load cell`) are left
/// out; single letters but the newton and the second are.
const LAST_WORDS: &[&str] = &["inch", "inches", "mil", "mils", "daN", "cN", "ozf", "kip", "kips", "ksi", "min"];

/// Opening and closing brackets that enclose units.
const BRACKETS: [(char, char); 8] = [
    ('(', ')'),
    ('[', ']'),
    ('{', '}'),
    ('（', '）'),
    ('［', '］'),
    ('｛', '｝'),
    ('【', '】'),
    ('〔', '〕'),
];

/// A name less its unit, and the unit, from a cell such as `Force (N)`, `Kraft [N]`, `Force_N`, `F / N` or
/// `Force, N`. Either is `None` if it is not there.
pub(crate) fn split(cell: &str) -> (Option<String>, Option<String>) {
    let cell = cell.trim();
    let (name, unit) = bracketed(cell)
        .or_else(|| behind_slash(cell))
        .or_else(|| behind_word(cell))
        .or_else(|| behind_underscore(cell))
        .or_else(|| behind_blank(cell))
        .unwrap_or((cell, ""));
    let owned = |text: &str| Some(text.trim().to_owned()).filter(|text| !text.is_empty());
    (owned(name), owned(&narrow(unit)))
}

/// A unit less the full width that Japanese and Chinese programs give letters: `ｍｍ`, `Ｎ／ｍｍ²`.
fn narrow(unit: &str) -> String {
    let narrowed = |letter: char| match letter {
        '！'..='～' => char::from_u32(u32::from(letter) - 0xFEE0).unwrap_or(letter),
        '\u{3000}' => ' ',
        other => other,
    };
    unit.chars().map(narrowed).collect()
}

/// The unit in a cell of its own, less its brackets.
pub(crate) fn alone(cell: &str) -> Option<String> {
    let cell = cell.trim();
    let inside = inside_brackets(cell).unwrap_or(cell).trim();
    Some(narrow(inside).trim().to_owned()).filter(|unit| !unit.is_empty())
}

/// Whether a cell is a unit in a cell of its own: anything in brackets, or a known unit.
pub(crate) fn stands_alone(cell: &str) -> bool {
    let in_words = || is_unit_in_words(cell) && !names_quantity(cell);
    inside_brackets(cell.trim()).is_some() || cell.trim() == "-" || is_known(cell) || in_words()
}

/// Whether all of a cell is in one pair of brackets.
pub(crate) fn inside_brackets(cell: &str) -> Option<&str> {
    BRACKETS.iter().find_map(|&(open, close)| {
        let inside = cell.strip_prefix(open)?.strip_suffix(close)?;
        (!inside.contains([open, close])).then_some(inside)
    })
}

/// Whether `text` is made of words that units are made of: `mm`, `N/mm²`, `mN·m`, `1/s`, `kg m^-3`.
pub(crate) fn is_known(text: &str) -> bool {
    let text = narrow(text);
    let mut words = text
        .split(|character: char| "/*·⋅×^-−. ()²³⁻¹".contains(character) || character.is_ascii_digit())
        .filter(|word| !word.is_empty())
        .peekable();
    let only_one = text.trim() == "1";
    only_one || (words.peek().is_some() && words.all(|word| is_one_of(WORDS, word) || is_of_strain(word)))
}

/// Whether a text behind a name is its unit.
fn is_unit(text: &str) -> bool {
    is_known(text) || is_unit_in_words(text)
}

fn is_one_of(known: &[&str], word: &str) -> bool {
    let word = word.to_lowercase();
    known.contains(&word.as_str())
}

fn is_of_strain(word: &str) -> bool {
    is_listed(&word.to_lowercase(), STRAINS)
}

fn bracketed(cell: &str) -> Option<(&str, &str)> {
    BRACKETS.iter().find_map(|&(open, close)| {
        let body = cell.strip_suffix(close)?;
        // The bracket that matches the last one: units may hold brackets, as in "(N/(m s))".
        let mut depth = 1;
        let opening = body.char_indices().rev().find(|&(_, character)| {
            depth += i32::from(character == close) - i32::from(character == open);
            depth == 0
        });
        let (place, _) = opening?;
        let unit = body[place + open.len_utf8()..].trim();
        // Round brackets also hold remarks: "Strain (Extension)". A share is a unit whatever it is one of: "(% FS)".
        let known = is_unit(unit) || unit.starts_with('%');
        let remark = matches!(open, '(' | '（') && !known && unit != "-";
        (!remark).then_some((cell[..place].trim_end().trim_end_matches('/'), unit))
    })
}

fn behind_slash(cell: &str) -> Option<(&str, &str)> {
    let (name, unit) = match cell.split_once(" / ") {
        Some(parts) => parts,
        // "mm/s" is a unit, no name with a unit.
        None => cell.split_once('/').filter(|(name, unit)| !is_known(name) || is_symbol_of(name, unit))?,
    };
    (!name.trim().is_empty() && is_unit(unit)).then_some((name, unit))
}

/// Whether a letter that is a unit as well is the symbol of a quantity in this unit: "F/mN", "s/mm".
fn is_symbol_of(name: &str, unit: &str) -> bool {
    let dimension = match name {
        "F" => Dimension::Force,
        "s" => Dimension::Length,
        _ => return false,
    };
    units::factor(&narrow(unit), dimension).is_some()
}

fn behind_word(cell: &str) -> Option<(&str, &str)> {
    let parts = [", ", " in ", " в "].iter().find_map(|mark| cell.rsplit_once(mark));
    parts.filter(|(name, unit)| !name.trim().is_empty() && is_unit(unit))
}

fn behind_underscore(cell: &str) -> Option<(&str, &str)> {
    let (name, unit) = cell.rsplit_once('_')?;
    let lower = name.to_lowercase();
    // "force_min" is the least force, "time_min" a time in minutes.
    let minutes = unit.eq_ignore_ascii_case("min") && (lower == "t" || lower.ends_with("time"));
    (!name.is_empty() && (minutes || is_one_of(SUFFIXES, unit) || is_of_strain(unit))).then_some((name, unit))
}

/// The unit behind the last blank of a name that says the quantity it measures: `Load kN`, `Extension inch`.
fn behind_blank(cell: &str) -> Option<(&str, &str)> {
    let (name, unit) = cell.rsplit_once(char::is_whitespace)?;
    let is_letter = unit.chars().count() == 1;
    let may_end = if is_letter {
        matches!(unit, "N" | "s" | "%")
    } else {
        is_one_of(SUFFIXES, unit)
            || is_of_strain(unit)
            || LAST_WORDS.iter().any(|known| known.eq_ignore_ascii_case(unit))
    };
    (may_end && (is_named_in(name, unit) || is_strain_in(name, unit))).then_some((name, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_units() {
        for (cell, name, unit) in [
            ("Force (N)", "Force", "N"),
            ("Kraft [N]", "Kraft", "N"),
            ("displacement_mm", "displacement", "mm"),
            ("Force_N", "Force", "N"),
            ("Time_S", "Time", "S"),
            ("Time_min", "Time", "min"),
            ("Displacement / mm", "Displacement", "mm"),
            ("Weg/mm", "Weg", "mm"),
            ("F/mN", "F", "mN"),
            ("s/um", "s", "um"),
            ("Stress (N/mm²)", "Stress", "N/mm²"),
            ("k (N/(m s))", "k", "N/(m s)"),
            ("时间（秒）", "时间", "秒"),
            ("荷重［N］", "荷重", "N"),
            ("変位（mm）", "変位", "mm"),
            ("変位（ｍｍ）", "変位", "mm"),
            ("時間【s】", "時間", "s"),
            ("応力〔Ｎ／ｍｍ²〕", "応力", "N/mm²"),
            ("試験力｛kN｝", "試験力", "kN"),
            ("Force, kN", "Force", "kN"),
            ("Temp (°C)", "Temp", "°C"),
            ("Disp (Millimeters)", "Disp", "Millimeters"),
            ("Load (pounds)", "Load", "pounds"),
            ("Kraft (Kilonewton)", "Kraft", "Kilonewton"),
            ("Weg in mm", "Weg", "mm"),
            ("Force (x10^-3 N)", "Force", "x10^-3 N"),
            ("Force (N x 1e-3)", "Force", "N x 1e-3"),
            ("Force / 10^3 N", "Force", "10^3 N"),
            ("Force/(10^3 N)", "Force", "10^3 N"),
            ("Load (% FS)", "Load", "% FS"),
            ("Время, с", "Время", "с"),
            ("Усилие (кгс)", "Усилие", "кгс"),
            ("하중(뉴턴)", "하중", "뉴턴"),
            ("Load kN", "Load", "kN"),
            ("Load lbf", "Load", "lbf"),
            ("Load mN", "Load", "mN"),
            ("Load N", "Load", "N"),
            ("Kraft kN", "Kraft", "kN"),
            ("Extension inch", "Extension", "inch"),
            ("Position um", "Position", "um"),
            ("Time sec", "Time", "sec"),
            ("Time min", "Time", "min"),
            ("Stress MPa", "Stress", "MPa"),
            ("Strain %", "Strain", "%"),
            ("Strain (in/in)", "Strain", "in/in"),
            ("Strain (microstrain)", "Strain", "microstrain"),
            ("Strain microstrain", "Strain", "microstrain"),
            ("Dehnung (µε)", "Dehnung", "µε"),
            ("strain_percent", "strain", "percent"),
        ] {
            assert_eq!(split(cell), (Some(name.to_owned()), Some(unit.to_owned())));
        }
    }

    #[test]
    fn names_without() {
        for cell in [
            "Tensile strain (Extension)",
            "Force_max",
            "Force_min",
            "sensor_A",
            "mm/s",
            "s/s",
            "PIP count",
            "Force (filtered)",
            "試験力（平均）",
            "_mm",
            "Load cell",
            "Time in",
            "Position in",
            "Force m",
            "Force mm",
            "Force min",
            "Displacement m",
            "Time std",
            "Load n",
            "Sensor mN",
            "Max force kN",
            "kN",
        ] {
            assert_eq!(split(cell), (Some(cell.to_owned()), None));
        }
        assert_eq!(split(" "), (None, None));
        assert_eq!(split("(N)"), (None, Some("N".to_owned())));
    }

    #[test]
    fn units_alone() {
        assert_eq!(alone("(mm/mm)"), Some("mm/mm".to_owned()));
        assert_eq!(alone("[°C]"), Some("°C".to_owned()));
        assert_eq!(alone("［ｓ］"), Some("s".to_owned()));
        assert_eq!(alone("Ｎ"), Some("N".to_owned()));
        assert!(stands_alone("〔anything〕") && stands_alone("ｍｍ"));
        assert_eq!(alone(""), None);
        assert!(stands_alone("(anything)") && stands_alone("-") && stands_alone("mN·m"));
        assert!(!stands_alone("Force") && !stands_alone(""));
    }
}
