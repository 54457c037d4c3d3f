//! Sentences in lines of a terminal.

/// Width of a terminal.
const WIDTH: usize = 100;

/// A sentence in lines of a terminal.
pub(crate) fn wrapped(sentence: &str) -> String {
    let mut text = String::new();
    indented(&mut text, ("", 0), sentence);
    text
}

/// A text behind `head`, its further lines set in.
pub(crate) fn indented(out: &mut String, (head, indent): (&str, usize), text: &str) {
    let mut used = head.chars().count();
    out.push_str(head);
    let mut fresh = true;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if !fresh && used + 1 + length > WIDTH {
            out.push('\n');
            out.push_str(&" ".repeat(indent));
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminal_lines_are_wrapped() {
        let mut text = String::new();
        indented(&mut text, ("info    code  ", 9), &"word ".repeat(40));
        assert!(text.lines().count() > 2 && text.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(text.lines().skip(1).all(|line| line.starts_with("         w")));
    }
}
