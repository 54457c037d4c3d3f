//! Text in figures: how wide it is, and raised or lowered characters.

use crate::escape::escape;
use crate::script::{Level, runs};

/// Widths of the characters from space to tilde, in thousandths of the font size.
///
/// They are those of Arimo, which Arial, Helvetica and Liberation Sans share.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];

/// Size of raised and lowered characters relative to the text around them.
const SMALL: f64 = 0.72;

/// Width of the dot relative to the font size.
const DOT: f64 = 0.333;

/// Width of `text` at a font size.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    runs(text)
        .iter()
        .map(|(level, run)| {
            let scale = match level {
                Level::Base => 1.0,
                Level::Raised | Level::Lowered => SMALL,
                Level::Dot => 0.0,
            };
            run.chars().map(advance).sum::<f64>() * scale * size
        })
        .sum()
}

/// `text` as the inside of an SVG text element.
///
/// Unicode superscripts and subscripts become ordinary characters, shifted and made smaller, so
/// that they look alike in every font.
pub(crate) fn markup(text: &str, size: f64) -> String {
    let mut out = String::new();
    let mut height = 0.0;
    let mut back = 0.0;
    let mut letter = 0.0;
    for (level, run) in runs(text) {
        let (target, font) = match level {
            Level::Base | Level::Dot => (0.0, size),
            Level::Raised => (-0.36 * size, size * SMALL),
            Level::Lowered => (0.16 * size, size * SMALL),
        };
        // A dot steps back over its letter, and what follows steps forward again.
        let aside = if level == Level::Dot { -(letter + DOT * size) / 2.0 } else { back };
        back = if level == Level::Dot { (letter - DOT * size) / 2.0 } else { 0.0 };
        letter = run.chars().last().map_or(0.0, advance) * font;
        let run = escape(&run);
        if level == Level::Base && height == 0.0 && aside == 0.0 {
            out.push_str(&run);
        } else {
            let dx = if aside == 0.0 { String::new() } else { format!(" dx=\"{aside:.2}\"") };
            let dy = target - height;
            out.push_str(&format!("<tspan{dx} dy=\"{dy:.2}\" font-size=\"{font:.2}\">{run}</tspan>"));
        }
        height = target;
    }
    out
}

fn advance(c: char) -> f64 {
    let table = (c as usize).checked_sub(32).and_then(|i| WIDTHS.get(i));
    let thousandths = match (table, c) {
        (Some(width), _) => *width,
        (None, '\u{300}'..='\u{36F}') => 0,
        (None, 'ε') => 446,
        (None, '−' | '×' | '±' | '≈' | '≤' | '≥') => 584,
        (None, '·' | '\u{2009}' | '\u{202F}') => 300,
        (None, _) => 580,
    };
    f64::from(thousandths) / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raised_characters_return_to_the_line() {
        let text = markup("Rate (10⁻³ s⁻¹) <E₀>", 10.0);
        assert!(text.starts_with("Rate (10<tspan dy=\"-3.60\" font-size=\"7.20\">−3</tspan>"));
        assert!(text.contains("&lt;E</tspan><tspan dy=\"1.60\""));
        assert!(text.ends_with("<tspan dy=\"-1.60\" font-size=\"10.00\">&gt;</tspan>"));
    }

    #[test]
    fn a_dot_sits_on_its_letter() {
        let text = markup("ε\u{307} (x)", 10.0);
        assert!(text.starts_with("ε<tspan dx=\"-"), "{text}");
        assert!(text.contains("\">˙</tspan><tspan dx=\""), "{text}");
        assert_eq!(width("x\u{307}", 10.0), width("x", 10.0));
    }

    #[test]
    fn widths_add_up() {
        assert!((width("00", 10.0) - 11.12).abs() < 1e-9);
        assert!(width("10⁻³", 10.0) < width("10-3", 10.0) + 3.0);
        assert_eq!(width("", 10.0), 0.0);
    }
}
