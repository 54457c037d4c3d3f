//! Raised and lowered characters in text.

/// Where a run of characters stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Level {
    Base,
    Raised,
    Lowered,
    /// A dot above the letter before it, as for a rate.
    Dot,
}

/// `text` in runs of one level, with ordinary characters in place of Unicode superscripts and
/// subscripts, which look different in every font.
pub(crate) fn runs(text: &str) -> Vec<(Level, String)> {
    let mut runs: Vec<(Level, String)> = Vec::new();
    for c in text.chars() {
        let (level, c) = plain(c);
        match runs.last_mut() {
            Some((last, run)) if *last == level => run.push(c),
            _ => runs.push((level, c.to_string())),
        }
    }
    runs
}

fn plain(c: char) -> (Level, char) {
    let digit = |base: u32| char::from_digit(c as u32 - base, 10).unwrap_or(c);
    match c {
        '¹' => (Level::Raised, '1'),
        '²' => (Level::Raised, '2'),
        '³' => (Level::Raised, '3'),
        '⁰' | '⁴'..='⁹' => (Level::Raised, digit(0x2070)),
        '⁻' => (Level::Raised, '−'),
        '⁺' => (Level::Raised, '+'),
        'ⁿ' => (Level::Raised, 'n'),
        '₀'..='₉' => (Level::Lowered, digit(0x2080)),
        '\u{307}' => (Level::Dot, '˙'),
        c => (Level::Base, c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_change_where_characters_do() {
        let run = |level, text: &str| (level, text.to_owned());
        let expected =
            [run(Level::Base, "E"), run(Level::Lowered, "0"), run(Level::Base, " ×10"), run(Level::Raised, "−12")];
        assert_eq!(runs("E₀ ×10⁻¹²"), expected);
        assert!(runs("").is_empty());
    }
}
