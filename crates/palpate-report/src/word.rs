//! Words for what is one of several.

use serde::Serialize;

/// A text with its first letter large, but for a symbol: n and N are not the same.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    if text.split(' ').next().is_some_and(|first| first.len() == 1 && first != "a") {
        return text.to_owned();
    }
    letters
        .next()
        .map_or(String::new(), |first| std::iter::once(first.to_ascii_uppercase()).chain(letters).collect())
}

/// The stable word for one of several: the name of a variant as it is stored, in small letters.
///
/// ```
/// assert_eq!(palpate_report::result::word(palpate::fit::Termination::RateAtBound), "rate_at_bound");
/// ```
#[must_use]
pub fn word(variant: impl Serialize) -> String {
    let stored = serde_json::to_value(variant).unwrap_or_default();
    stored.as_str().unwrap_or_default().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_symbol_stays_small() {
        // "N = 7 is the best of the listed exponents" spoke of newtons.
        let written = ["n = 7 is the best", "a hold", "the force", ""].map(capitalised);
        assert_eq!(written, ["n = 7 is the best", "A hold", "The force", ""]);
    }
}
