//! Units that a line of words states of whole columns: `Force unit: kN`, `all forces in mN`, `Units: s, mm, N`.

use palpate::units::Dimension;

use super::{
    names::{measures_another, rank_of_name},
    quantity::Quantity,
    unit_words::unit_factor,
    vocabulary::{VOCABULARY, is_listed},
};

/// Words for a unit; alone, or at the end of a compound such as `Krafteinheit`.
const UNITS: &str =
    "unit units einheit einheiten unité unités unidad unidades unità 单位 単位 단위 единица единицы измерения";

/// Words that such a line has beside these.
const FILLERS: &str = "all the of are is in and values data alle der die sind und werte daten toutes tous les de sont en et valeurs \
    todas todos las los valores y tutte tutti le i valori в и все si";

/// Most words and bytes of such a line.
const MOST_WORDS: usize = 24;
const LONGEST: usize = 200;

/// The quantities of which lines state units.
const STATED: [Quantity; 4] = [Quantity::Time, Quantity::Displacement, Quantity::Force, Quantity::Stress];

/// What a word of a line is.
enum Word<'t> {
    Filler,
    Unit,
    Quantity(Quantity),
    Symbol(Dimension, &'t str),
    /// A unit of another kind, or of a ratio.
    Other,
}

/// The units that a line states, each with its dimension; none unless every word of it serves that, so that a limit, a range or a title
/// states nothing. Quantities that it names must be those of its units; without any it must have a word for a unit.
pub(crate) fn stated_units(line: &str) -> Vec<(Dimension, &str)> {
    // Most lines have a number, which states no unit, and words cost more to look up than to pass over.
    if line.len() > LONGEST || line.bytes().any(|byte| byte.is_ascii_digit()) {
        return Vec::new();
    }
    let separators = |letter: char| letter.is_whitespace() || ",;:=：，；".contains(letter);
    let words: Vec<&str> = line.split(separators).filter(|word| !word.is_empty()).take(MOST_WORDS + 1).collect();
    if words.len() < 2 || words.len() > MOST_WORDS {
        return Vec::new();
    }
    let (mut units, mut named, mut has_unit_word) = (Vec::<(Dimension, &str)>::new(), Vec::new(), false);
    for (index, word) in words.iter().enumerate() {
        let word = word.trim_matches(|letter| has_unit_word && "()[]{}".contains(letter));
        // An inch at the end and in a list of units.
        let is_inch = word == "in" && (index + 1 == words.len() || named.is_empty() && !units.is_empty());
        let (stem, of_unit) = without_unit_word(word);
        has_unit_word |= of_unit;
        match if is_inch { Some(Word::Symbol(Dimension::Length, "in")) } else { kind(stem) } {
            Some(Word::Filler | Word::Other | Word::Unit) => {}
            Some(Word::Quantity(quantity)) => named.push(quantity.dimension()),
            Some(Word::Symbol(dimension, unit)) if units.iter().all(|known| known.0 != dimension) => {
                units.push((dimension, unit));
            }
            Some(Word::Symbol(dimension, unit)) if units.contains(&(dimension, unit)) => {}
            _ => return Vec::new(),
        }
    }
    let has_unit = |dimension: &Dimension| units.iter().any(|unit| unit.0 == *dimension);
    let is_matched = named.iter().all(has_unit) && units.iter().all(|unit| named.contains(&unit.0));
    if is_matched || named.is_empty() && has_unit_word { units } else { Vec::new() }
}

/// A word less the word for a unit that it ends in, and whether it does.
fn without_unit_word(word: &str) -> (&str, bool) {
    let lower = word.to_lowercase();
    let of_unit = UNITS.split_whitespace().filter(|unit| lower.ends_with(unit)).max_by_key(|unit| unit.len());
    let stem = of_unit.and_then(|unit| word.get(..word.len().checked_sub(unit.len())?));
    (stem.map_or(word, |stem| stem.trim_end_matches(['-', '_', '/'])), stem.is_some())
}

fn kind(word: &str) -> Option<Word<'_>> {
    let lower = word.to_lowercase();
    if lower.is_empty() {
        return Some(Word::Unit);
    }
    if is_listed(&lower, FILLERS) {
        return Some(Word::Filler);
    }
    let singular = lower.strip_suffix('s').filter(|stem| stem.len() > 2);
    let rank = |quantity: &Quantity| {
        let vocabulary = VOCABULARY.iter().find(|vocabulary| vocabulary.quantity == *quantity)?;
        [Some(word), singular].into_iter().flatten().filter_map(|name| rank_of_name(name, vocabulary)).min()
    };
    let named = |most: u8| STATED.into_iter().find(|quantity| rank(quantity).is_some_and(|rank| rank <= most));
    let symbol = || {
        let measures = |quantity: &Quantity| unit_factor(word, quantity.dimension()).is_some();
        STATED.into_iter().find(measures).map(|quantity| Word::Symbol(quantity.dimension(), word))
    };
    // "minutes" is a unit and may name a time; a letter names nothing here.
    let quantity = named(0).map(Word::Quantity).or_else(symbol).or_else(|| named(3).map(Word::Quantity));
    quantity.or_else(|| measures_another(word, Quantity::Time).then_some(Word::Other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_state_units() {
        let (time, length, force) = (Dimension::Time, Dimension::Length, Dimension::Force);
        for (line, expected) in [
            ("Force unit: kN", &[(force, "kN")][..]),
            ("Force unit, kN", &[(force, "kN")]),
            ("all forces in mN", &[(force, "mN")]),
            ("Force: kN", &[(force, "kN")]),
            ("Units: s, mm, N", &[(time, "s"), (length, "mm"), (force, "N")]),
            ("Units: s, in, lbf", &[(time, "s"), (length, "in"), (force, "lbf")]),
            ("Displacement unit: in", &[(length, "in")]),
            ("Units: s mm % kN", &[(time, "s"), (length, "mm"), (force, "kN")]),
            ("Einheit Kraft;kN", &[(force, "kN")]),
            ("Krafteinheit: kN", &[(force, "kN")]),
            ("Crosshead in mm, load in kN", &[(length, "mm"), (force, "kN")]),
            ("Unit (force): [kN]", &[(force, "kN")]),
            ("Time unit: minutes", &[(time, "minutes")]),
            ("力单位：kN", &[(force, "kN")]),
        ] {
            assert_eq!(stated_units(line), expected, "{line}");
        }
    }

    #[test]
    fn limits_ranges_titles_and_contradictions_state_nothing() {
        for line in [
            "Load cell: 5 kN",
            "Load cell: kN",
            "Force threshold,5,N",
            "Preload: N",
            "Max force (kN): 12",
            "Force (kN), Displacement (mm)",
            "Force unit: mm",
            "Force unit",
            "Units: SI",
            "Units: N, kN",
            "Force, stress: N",
            "Speed unit: mm/min",
            "Test in N",
            "s, mm, N",
            "Sample 5 in water",
            "kN",
            "",
        ] {
            assert!(stated_units(line).is_empty(), "{line}");
        }
    }
}
