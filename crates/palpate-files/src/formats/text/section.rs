//! Where one of several tests stands in a text.

use std::ops::Range;

use crate::{
    input::{Excerpt, lines},
    table::Layout,
};

/// Successive lines of a text.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    /// Number of the first, from 1.
    pub(super) first: usize,
    pub(super) lines: usize,
    pub(super) bytes: Range<usize>,
}

/// Where one test stands.
pub(super) struct Section {
    /// What the file calls it.
    pub(super) title: Option<String>,
    /// Rows of a step that its title says to be a hold.
    pub(super) held: Option<usize>,
    /// The lines of names, where they do not stand among the lines of the test, and its lines.
    pub(super) stretches: Vec<Stretch>,
    /// How these lines are written.
    pub(super) layout: Layout,
    /// How many times lines of names among its own, which are left out, repeat.
    pub(super) repeated: usize,
}

impl Section {
    /// Its lines.
    pub(super) fn text(&self, text: &str) -> String {
        let stretches: Vec<&str> = self.stretches.iter().map(|stretch| &text[stretch.bytes.clone()]).collect();
        stretches.join("\n")
    }

    /// Which lines of the text its lines are.
    pub(super) fn excerpt(&self) -> Excerpt {
        let mut excerpt = Excerpt::default();
        self.stretches.iter().for_each(|stretch| excerpt.push(stretch.first, stretch.lines));
        excerpt
    }

    /// Its lines but those above its rows.
    pub(super) fn below_names(self, text: &str) -> Vec<Stretch> {
        let mut above = self.layout.first_data_line - 1;
        let mut rows = self.stretches;
        rows.retain_mut(|stretch| {
            let passed = above.min(stretch.lines);
            above -= passed;
            let own = &text[stretch.bytes.clone()];
            if let Some(line) = lines::of_text(own).get(passed) {
                stretch.bytes.start += line.as_ptr() as usize - own.as_ptr() as usize;
            }
            (stretch.first, stretch.lines) = (stretch.first + passed, stretch.lines - passed);
            stretch.lines > 0
        });
        rows
    }

    /// The lines above its rows.
    pub(super) fn names<'t>(&self, text: &'t str) -> Vec<&'t str> {
        let own = self.stretches.iter().flat_map(|stretch| lines::of_text(&text[stretch.bytes.clone()]));
        own.take(self.layout.first_data_line - 1).collect()
    }
}
