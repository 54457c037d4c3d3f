//! What the name of a column stands for.

use palpate::units::Dimension;

use super::{
    quantity::Quantity,
    unit_words::{is_share, unit_factor},
    vocabulary::{
        BENDING, COMMANDED, COUNTS, OF_A_PART, OTHER_CHARACTERS, VOCABULARY, Vocabulary, is_listed, other_words,
    },
};

/// The topic and the field in the name of a column of a robot's log, such as `/gripper/ft.wrench.force.z`.
pub(crate) fn topic_and_field(name: &str) -> Option<(&str, &str)> {
    name.split_once('.').filter(|(topic, _)| topic.starts_with('/'))
}

/// Whether a name says any quantity.
pub(crate) fn names_quantity(name: &str) -> bool {
    VOCABULARY.iter().any(|vocabulary| rank_of_name(name, vocabulary).is_some())
}

/// Whether a name says a quantity that this unit measures.
pub(crate) fn is_named_in(name: &str, unit: &str) -> bool {
    let measures = |quantity: Quantity| unit_factor(unit, quantity.dimension()).is_some();
    let says = |vocabulary: &Vocabulary| rank_of_name(name, vocabulary).is_some();
    VOCABULARY.iter().any(|vocabulary| measures(vocabulary.quantity) && says(vocabulary))
}

/// The symbol of the unit that the last word of a name is, though it may be a part of the name: what a message may propose.
pub(crate) fn last_unit(name: &str, quantity: Quantity) -> Option<&'static str> {
    let (_, last) = name.rsplit_once(|letter: char| letter.is_whitespace() || letter == '_')?;
    let factor = unit_factor(last, quantity.dimension())?;
    quantity.dimension().units().iter().find(|(_, of)| *of == factor).map(|(symbol, _)| *symbol)
}

/// Whether a unit is one of another kind of quantity.
pub(crate) fn measures_another(unit: &str, quantity: Quantity) -> bool {
    let others = [
        Dimension::Time,
        Dimension::Length,
        Dimension::Force,
        Dimension::Pressure,
        Dimension::Speed,
        Dimension::Frequency,
        Dimension::Area,
        Dimension::Torque,
    ];
    let is_temperature =
        matches!(unit.trim().to_lowercase().as_str(), "°c" | "℃" | "degc" | "°f" | "degf" | "°k" | "k");
    let ratio = matches!(unit, "-" | "%" | "1" | "mm/mm" | "m/m") || is_share(unit);
    let other = |dimension: &Dimension| *dimension != quantity.dimension() && unit_factor(unit, *dimension).is_some();
    ratio || is_temperature || others.iter().any(other)
}

/// How well a name stands for the quantity of a vocabulary; 0 is best. One that says multiples does not.
pub(crate) fn rank_of_name(name: &str, vocabulary: &Vocabulary) -> Option<u8> {
    rank_of_words(name, vocabulary).filter(|_| !is_scaled(measured(name)))
}

/// Whether a name says multiples of a quantity: `Force x1000`, `Kraft (x 10^-3)`.
pub(crate) fn names_multiples_of(name: &str, quantity: Quantity) -> bool {
    let vocabulary = VOCABULARY.iter().find(|vocabulary| vocabulary.quantity == quantity);
    is_scaled(measured(name)) && vocabulary.is_some_and(|words| rank_of_words(name, words).is_some_and(|rank| rank < 4))
}

fn rank_of_words(name: &str, vocabulary: &Vocabulary) -> Option<u8> {
    let name = measured(name);
    let words = words(name);
    let has = |known: &str| words.iter().any(|word| is_listed(word, known));
    let is = |known: &str| matches!(words.as_slice(), [only] if is_listed(only, known));
    let contains = |parts: &str| parts.split_whitespace().any(|part| name.contains(part));
    let commanded =
        |word: &String| COMMANDED.split_whitespace().any(|start| word.len() > start.len() && word.starts_with(start));
    if other_words(&words).next().is_some() || contains(OTHER_CHARACTERS) || words.iter().any(commanded) {
        return None;
    }
    if vocabulary.quantity == Quantity::Displacement && BENDING.contains(&name.trim()) {
        return None;
    }
    // The sign for force is a part of the word for stress.
    let stress = contains("应力 応力 응력");
    if stress && vocabulary.quantity != Quantity::Stress {
        return None;
    }
    let ends = |word: &String| vocabulary.endings.split_whitespace().any(|end| word.ends_with(end));
    // The time of the whole test goes before that of a step.
    let late = if vocabulary.quantity == Quantity::Time && has(OF_A_PART) { 5 } else { 0 };
    let rank = if is(vocabulary.plain) || is_listed(name.trim(), vocabulary.characters) {
        Some(0)
    } else if has(vocabulary.plain) || words.iter().any(ends) || contains(vocabulary.characters) {
        Some(1)
    } else if is(vocabulary.loose) {
        Some(2)
    } else if has(vocabulary.loose) && !named_otherwise(&words, vocabulary) {
        Some(3)
    } else if vocabulary.letter == Some(name.trim()) {
        Some(4)
    } else {
        None
    };
    rank.map(|rank| rank + late)
}

/// Whether a name says that a column without a unit of `quantity` holds something else: another quantity, a command, a
/// temperature, the number of a row.
pub(crate) fn names_another(name: &str, quantity: Quantity) -> bool {
    let words = words(measured(name));
    let has = |known: &str| words.iter().any(|word| is_listed(word, known));
    let others = VOCABULARY.iter().filter(|other| other.quantity != quantity);
    let plainly = |other: &Vocabulary| rank_of_name(name, other).is_some_and(|rank| rank < 4);
    other_words(&words).next().is_some() || has(COUNTS) || others.into_iter().any(plainly)
}

/// Whether a name says that its values are multiples: `Force x1000`, `Weg*10`, `Load ×10^3`, `Kraft (x 10^-3)`.
fn is_scaled(name: &str) -> bool {
    name.match_indices(['×', '*', 'x', 'X']).any(|(at, sign)| {
        let ends_word = sign.eq_ignore_ascii_case("x") && name[..at].ends_with(char::is_alphanumeric);
        let behind = &name[at + sign.len()..];
        // "Force x 1" is the first force along x.
        !ends_word && (behind.starts_with('1') || behind.trim_start().starts_with("10"))
    })
}

/// Whether a word means another quantity and nothing else: a "compression force" is no compression.
fn named_otherwise(words: &[String], vocabulary: &Vocabulary) -> bool {
    let mut others = VOCABULARY.iter().filter(|other| other.quantity != vocabulary.quantity);
    others.any(|other| words.iter().any(|word| is_listed(word, other.plain)))
}

/// The part of a name that says what is measured. Of a log of a robot that is the field less the names of joints, since
/// topics are named after devices and commands (`/gripper_cmd/feedback`); where the field is called `data`, as in
/// `std_msgs/Float64`, the topic alone can say it.
pub(crate) fn measured(name: &str) -> &str {
    match topic_and_field(name) {
        Some((topic, "data")) => topic,
        Some((_, field)) => field.split('[').next().unwrap_or(field),
        None => name,
    }
}

/// The words of a name in lower case: `GoalForce`, `goal_force` and `Goal force` have the same two.
pub(crate) fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for letter in name.chars() {
        let starts = letter.is_uppercase() && before.is_lowercase();
        if starts || !letter.is_alphabetic() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut()
            && letter.is_alphabetic()
        {
            word.extend(letter.to_lowercase());
        }
        before = letter;
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_names() {
        assert_eq!(words("GoalForce"), ["goal", "force"]);
        assert_eq!(words("now_pos 2"), ["now", "pos"]);
        assert_eq!(words("Tensile strain (Extension)"), ["tensile", "strain", "extension"]);
        assert_eq!(words("FORCE"), ["force"]);
    }
}
