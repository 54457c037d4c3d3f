//! Sentences in lines of a terminal.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Width of a terminal that nobody measured.
pub(crate) const WIDTH: usize = 100;

/// The width that texts are laid out for.
static MEASURED: AtomicUsize = AtomicUsize::new(WIDTH);

/// Narrower than this nothing can be read.
const NARROWEST: usize = 60;

/// Lays out all texts made from now on for a terminal of this many columns.
///
/// The width is one of the process, as its terminal is; texts that go elsewhere than to a terminal keep 100 columns.
pub fn set_width(columns: usize) {
    MEASURED.store(columns.max(NARROWEST), Ordering::Relaxed);
}

/// The width that texts are laid out for.
pub(crate) fn width() -> usize {
    MEASURED.load(Ordering::Relaxed)
}

/// A sentence in lines of a terminal.
#[must_use]
pub fn wrapped(sentence: &str) -> String {
    indented("", 0, width(), sentence)
}

/// A text behind `head` in lines of this width, its further lines set in.
pub(crate) fn indented(head: &str, indent: usize, width: usize, text: &str) -> String {
    let (mut out, mut used, mut fresh) = (head.to_owned(), extent(head), true);
    for word in text.split_whitespace() {
        let length = extent(word);
        if !fresh && used + 1 + length > width {
            out.push_str(&format!("\n{}", " ".repeat(indent)));
            (used, fresh) = (indent, true);
        }
        if !fresh {
            out.push(' ');
            used += 1;
        }
        out.push_str(word);
        used += length;
        fresh = false;
    }
    out.push('\n');
    out
}

/// Number of places a text takes in a terminal; accents that sit on a letter take none.
pub(crate) fn extent(text: &str) -> usize {
    text.chars().filter(|c| !('\u{300}'..='\u{36F}').contains(c)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminal_lines_are_wrapped() {
        let text = indented("info    code  ", 9, WIDTH, &"word ".repeat(40));
        assert!(text.lines().count() > 2 && text.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(text.lines().skip(1).all(|line| line.starts_with("         w")));
    }
}
