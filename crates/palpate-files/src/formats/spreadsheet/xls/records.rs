//! Records of a stream, and numbers and texts in them.

/// A record: its type and its bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record<'a> {
    pub(super) kind: u16,
    pub(super) bytes: &'a [u8],
}

/// The records of a stream from a place on; ends where the stream ends or breaks off.
#[derive(Debug, Clone)]
pub(super) struct Records<'a> {
    stream: &'a [u8],
    place: usize,
}

impl<'a> Records<'a> {
    pub(super) fn from(stream: &'a [u8], place: usize) -> Self {
        Self { stream, place }
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        let kind = u16_at(self.stream, self.place)?;
        let length = usize::from(u16_at(self.stream, self.place + 2)?);
        let start = self.place + 4;
        let bytes = self.stream.get(start..start + length)?;
        self.place = start + length;
        Some(Record { kind, bytes })
    }
}

pub(super) fn u16_at(bytes: &[u8], place: usize) -> Option<u16> {
    let two = bytes.get(place..)?.first_chunk::<2>()?;
    Some(u16::from_le_bytes(*two))
}

pub(super) fn u32_at(bytes: &[u8], place: usize) -> Option<u32> {
    let four = bytes.get(place..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*four))
}

/// Letters of one byte each (the lower half of UTF-16), or of two.
pub(super) fn letters(bytes: &[u8], wide: bool) -> String {
    let text = match wide {
        true => encoding_rs::UTF_16LE.decode_without_bom_handling(&bytes[..bytes.len() / 2 * 2]).0,
        false => encoding_rs::mem::decode_latin1(bytes),
    };
    text.into_owned()
}
