//! How long the texts are that the sheets share.
//!
//! `calamine` copies such a text into every cell that has it, so that one text of 65,535 letters fills a memory with cells of 14 bytes.

use super::records::{u16_at, u32_at};

/// The record of shared texts, and those that it goes on in.
struct Pieces<'a> {
    data: &'a [u8],
    rest: std::slice::Iter<'a, &'a [u8]>,
}

impl<'a> Pieces<'a> {
    fn go_on(&mut self) -> Option<()> {
        self.data = self.rest.next()?;
        Some(())
    }

    fn skip(&mut self, mut count: usize) -> Option<()> {
        while count > 0 {
            if self.data.is_empty() {
                self.go_on()?;
            }
            let taken = count.min(self.data.len());
            (self.data, count) = (&self.data[taken..], count - taken);
        }
        Some(())
    }

    /// The letters of the next text, which ends in the piece where it ends for `calamine`.
    fn text(&mut self) -> Option<u32> {
        if self.data.is_empty() {
            return Some(0);
        }
        let (letters, flags) = (u16_at(self.data, 0)?, *self.data.get(2)?);
        self.data = &self.data[3..];
        let mut behind = 0_usize;
        if flags & 8 != 0 {
            behind += 4 * usize::from(u16_at(self.data, 0)?);
            self.data = &self.data[2..];
        }
        if flags & 4 != 0 {
            behind = behind.checked_add(u32_at(self.data, 0)? as usize)?;
            self.data = &self.data[4..];
        }
        let (mut left, mut width) = (usize::from(letters), usize::from(flags & 1) + 1);
        while left > 0 {
            let taken = left.min(self.data.len() / width);
            self.data = &self.data[taken * width..];
            left -= taken;
            if left > 0 {
                self.go_on()?;
                width = usize::from(self.data.first()? & 1) + 1;
                self.data = &self.data[1..];
            }
        }
        self.skip(behind)?;
        Some(u32::from(letters))
    }
}

/// The number of letters of every shared text. It ends where the texts break off, which `calamine` refuses.
pub(super) fn lengths(pieces: &[&[u8]]) -> Vec<u32> {
    let mut lengths = Vec::new();
    let mut rest = pieces.iter();
    let Some(data) = rest.next().and_then(|first| first.get(8..)) else {
        return lengths;
    };
    let mut pieces = Pieces { data, rest };
    while !pieces.data.is_empty() || pieces.go_on().is_some() {
        match pieces.text() {
            Some(length) => lengths.push(length),
            None => break,
        }
    }
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_both_widths_with_runs_and_in_pieces() {
        let plain = [&[0; 8][..], &[2, 0, 0, b'a', b'b'], &[1, 0, 1, b'c', 0]].concat();
        let runs = [3, 0, 8, 1, 0, b'd', b'e', b'f', 9, 9, 9, 9];
        assert_eq!(lengths(&[&plain, &runs]), [2, 1, 3]);
        // The second piece of a text says its width again.
        assert_eq!(lengths(&[&[&[0; 8][..], &[5, 0, 0, b'a', b'b']].concat(), &[1, b'c', 0, b'd', 0, b'e', 0]]), [5]);
        assert_eq!(lengths(&[&[0; 8], &[5, 0, 0, b'a']]), [0; 0]);
        assert_eq!(lengths(&[&[0; 3]]), [0; 0]);
    }
}
