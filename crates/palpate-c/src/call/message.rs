//! Messages into a buffer of the caller.

use std::ffi::c_char;
use std::fmt::{self, Write};
use std::slice;

/// A message into the buffer of a caller: as much as fits, then a zero. Nothing is allocated.
pub(crate) struct Message<'b> {
    buffer: &'b mut [u8],
    length: usize,
}

impl Message<'_> {
    /// The buffer at `pointer`, of `capacity` bytes; none where either is zero.
    ///
    /// # Safety
    /// `pointer` is null or writable for `capacity` bytes, and nothing else uses them while this lives.
    pub(crate) unsafe fn into(pointer: *mut c_char, capacity: usize) -> Self {
        let buffer = if pointer.is_null() || capacity == 0 {
            &mut []
        } else {
            // SAFETY: not null, and by the contract of this function writable for `capacity` bytes.
            unsafe { slice::from_raw_parts_mut(pointer.cast::<u8>(), capacity) }
        };
        let mut message = Self { buffer, length: 0 };
        message.end();
        message
    }

    /// Replaces the message.
    pub(crate) fn set(&mut self, message: fmt::Arguments<'_>) {
        self.length = 0;
        // A message that does not fit is cut.
        let _ = self.write_fmt(message);
        self.end();
    }

    fn end(&mut self) {
        if let Some(last) = self.buffer.get_mut(self.length) {
            *last = 0;
        }
    }
}

impl Write for Message<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let room = self.buffer.len().saturating_sub(self.length + 1);
        let mut fits = text.len().min(room);
        while !text.is_char_boundary(fits) {
            fits -= 1;
        }
        if fits > 0 {
            self.buffer[self.length..self.length + fits].copy_from_slice(&text.as_bytes()[..fits]);
            self.length += fits;
        }
        if fits == text.len() { Ok(()) } else { Err(fmt::Error) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    #[test]
    fn a_message_is_cut_between_characters_and_ends_with_a_zero() {
        let text = |capacity: usize| {
            let mut buffer = vec![0x7f as c_char; capacity];
            // SAFETY: the buffer has that many bytes and is used by nothing else.
            unsafe { Message::into(buffer.as_mut_ptr(), capacity) }.set(format_args!("{} m²", 12));
            let bytes: Vec<u8> = buffer.iter().map(|byte| *byte as u8).collect();
            CStr::from_bytes_until_nul(&bytes).map(|text| text.to_str().unwrap().to_owned())
        };
        assert_eq!(text(20).unwrap(), "12 m²");
        assert_eq!(text(7).unwrap(), "12 m²");
        assert_eq!(text(6).unwrap(), "12 m");
        assert_eq!(text(1).unwrap(), "");
        assert!(text(0).is_err());
    }
}
