//! Escaping of text that goes into SVG and HTML.

/// `text` with the five markup characters replaced and characters that XML forbids dropped.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(c),
            c if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn markup_and_forbidden_characters_are_neutralised() {
        assert_eq!(escape("a<b & \"c\" 'd'>\u{0}\u{1b}\u{FFFF}"), "a&lt;b &amp; &quot;c&quot; &#39;d&#39;&gt;");
    }
}
