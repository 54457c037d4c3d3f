//! Words for what is one of several.

use serde::Serialize;

/// A text with its first letter large.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
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
