//! Where one of several tests stands in a text.

use std::ops::Range;

use crate::{input::lines, table::Layout};

/// Where one test stands.
pub(super) struct Section {
    /// What the file calls it.
    pub(super) title: Option<String>,
    /// Rows of a step that its title says to be a hold.
    pub(super) held: Option<usize>,
    /// Bytes of the lines of names, where they do not stand among the lines of the test.
    pub(super) head: Range<usize>,
    /// Bytes of its lines.
    pub(super) body: Range<usize>,
    /// Number of the first of them, less the lines of the head, from 0.
    pub(super) before: usize,
    /// How its head and its lines are written.
    pub(super) layout: Layout,
    /// Bytes of lines of names among its own that repeat.
    pub(super) repeated: Vec<Range<usize>>,
}

impl Section {
    /// Its lines, those of names that repeat left blank.
    pub(super) fn rows(&self, text: &str) -> String {
        let (mut rows, mut from) = (String::new(), self.body.start);
        for lines in &self.repeated {
            rows.push_str(&text[from..lines.start]);
            rows.extend(text[lines.clone()].chars().filter(|letter| matches!(letter, '\r' | '\n')));
            from = lines.end;
        }
        rows.push_str(&text[from..self.body.end]);
        rows
    }

    /// The part of its lines above its rows.
    pub(super) fn names<'t>(&self, text: &'t str) -> &'t str {
        let body = &text[self.body.clone()];
        let first = lines::of_text(body).into_iter().nth(self.layout.first_data_line - 1);
        first.map_or(body, |line| &body[..line.as_ptr() as usize - body.as_ptr() as usize])
    }
}
