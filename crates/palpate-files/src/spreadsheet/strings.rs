//! Texts that all sheets of a workbook share.

/// Texts by their number, one behind the other.
#[derive(Debug, Default)]
pub(super) struct Strings {
    all: String,
    ends: Vec<u32>,
}

impl Strings {
    /// Adds to the text that is being written.
    pub(super) fn extend(&mut self, text: &str) {
        self.all.push_str(text);
    }

    /// Ends the text that is being written.
    pub(super) fn end(&mut self) {
        self.ends.push(u32::try_from(self.all.len()).unwrap_or(u32::MAX));
    }

    pub(super) fn get(&self, number: usize) -> Option<&str> {
        let end = *self.ends.get(number)? as usize;
        let start = number.checked_sub(1).and_then(|before| self.ends.get(before)).map_or(0, |end| *end as usize);
        self.all.get(start..end)
    }
}
