//! Words out of a file, fit to be shown to people.
//!
//! What a file holds may move the cursor of a terminal, or be as long as the file.

/// Most letters of a file's own words in a message.
const MOST: usize = 240;

/// Whether a letter is none to look at: it moves the cursor of a terminal, or changes the direction or the place of those around it.
#[must_use]
pub fn is_unprintable(letter: char) -> bool {
    letter.is_control()
        || matches!(
            letter,
            '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
        )
}

/// Whether every letter is one to look at.
pub(crate) fn is_plain(text: &str) -> bool {
    !text.chars().any(is_unprintable)
}

/// `text` on one line: ends of lines and tabs as blanks, other control characters and marks of direction as �.
pub(crate) fn plain(text: &str) -> String {
    let shown = |letter: char| match letter {
        '\t' | '\n' | '\r' => ' ',
        letter if is_unprintable(letter) => char::REPLACEMENT_CHARACTER,
        letter => letter,
    };
    text.chars().map(shown).collect()
}

/// `text` as messages show it: on one line, and no longer than anybody reads.
pub(crate) fn shown(text: &str) -> String {
    if text.trim().is_empty() {
        return "nothing".to_owned();
    }
    let mut letters = text.trim().chars();
    let mut short: String = letters.by_ref().take(MOST).collect();
    if letters.next().is_some() {
        short.push('…');
    }
    plain(&short)
}

/// At most so many of some texts, with a mark between them, and how many more there are.
pub(crate) fn few(texts: impl ExactSizeIterator<Item = String>, most: usize, between: &str) -> String {
    let more = texts.len().checked_sub(most).filter(|more| *more > 0).map(|more| format!("and {more} more"));
    let shown: Vec<String> = texts.take(most).chain(more).collect();
    shown.join(between)
}

/// The first few of the parts of a file, with why they are no tests.
pub(crate) fn skipped(parts: &[(String, String)]) -> String {
    let named = parts.iter().map(|(name, reason)| format!("{}: {}", shown(name), shown(reason)));
    let colon = if parts.is_empty() { "" } else { ": " };
    format!("{colon}{}", few(named, 3, "; "))
}

/// A number of bytes in words.
pub(crate) fn bytes(count: u64) -> String {
    match count {
        0..1024 => format!("{count} bytes"),
        1024..1_048_576 => format!("{} KiB", count >> 10),
        1_048_576..1_073_741_824 => format!("{} MiB", count >> 20),
        _ => format!("{} GiB", count >> 30),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_moves_the_cursor_or_fills_the_screen() {
        assert_eq!(shown("a\tb\r\nc\u{1b}[2J\u{9b}x\0"), "a b  c\u{fffd}[2J\u{fffd}x\u{fffd}");
        assert_eq!(shown("1\u{202e}N"), "1\u{fffd}N");
        assert_eq!(shown(&"ä".repeat(1000)).chars().count(), MOST + 1);
        assert_eq!(shown(" \t"), "nothing");
        assert!(is_plain("5 µm ≥ 力") && !is_plain("\u{7f}"));
    }
}
