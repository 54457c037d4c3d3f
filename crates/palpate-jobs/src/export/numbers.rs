//! Numbers as plain ASCII, which every simulator reads.

use palpate::number::significant;

/// For people, three significant digits.
pub(super) fn short(value: f64) -> String {
    digits(value, 3)
}

/// For people, with a number of significant digits.
pub(super) fn digits(value: f64, count: usize) -> String {
    let text = significant(value, count).replace('−', "-");
    if text.is_ascii() { text } else { format!("{value:.*e}", count - 1) }
}

/// For people, with its sign.
pub(super) fn signed(value: f64) -> String {
    let text = short(value);
    if value > 0.0 { format!("+{text}") } else { text }
}

/// For programs: ten significant digits, more than any contact is known to.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:.9e}");
    let rounded: f64 = text.parse().unwrap_or(value);
    palpate::number::exact(rounded)
}
