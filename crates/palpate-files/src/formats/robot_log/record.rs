//! What the content of a record says, by the lengths that are really there.
//!
//! The reader of the library `mcap` makes room for as many bytes as a text says it has before it looks for them.

use mcap::records::op;

use super::channel::Definition;

/// What stands in a log, as far as it is of use here.
#[derive(Debug)]
pub(super) enum Entry<'a> {
    /// How the file was made.
    Header { profile: &'a str },
    /// How the messages of a channel are laid out.
    Schema(u16, Definition),
    /// A topic.
    Channel {
        id: u16,
        schema: u16,
        topic: &'a str,
        encoding: &'a str,
    },
    /// A message.
    Message {
        channel: u16,
        /// When it was written down, ns.
        log_time: u64,
        data: &'a [u8],
    },
}

/// The head of a chunk, and its packed records.
#[derive(Debug)]
pub(super) struct Chunk<'a> {
    pub(super) unpacked_size: u64,
    /// Of the unpacked records; 0 where there is none.
    pub(super) checksum: u32,
    pub(super) compression: &'a str,
    pub(super) packed: &'a [u8],
}

/// What is wrong with a record: what was expected.
pub(super) type Fault = &'static str;

/// What a record of a kind that is of use here says; `None` of another kind.
pub(super) fn entry(opcode: u8, content: &[u8]) -> Result<Option<Entry<'_>>, Fault> {
    let mut bytes = Bytes { rest: content };
    Ok(Some(match opcode {
        op::HEADER => Entry::Header {
            profile: bytes.text("a header with the name of a profile")?,
        },
        op::SCHEMA => {
            let id = bytes.u16("a schema with a number")?;
            let definition = Definition {
                name: bytes.text("a schema with a name")?.to_owned(),
                encoding: bytes.text("a schema with an encoding")?.to_owned(),
                text: bytes.block("a schema with a definition")?.to_vec(),
            };
            Entry::Schema(id, definition)
        }
        op::CHANNEL => Entry::Channel {
            id: bytes.u16("a channel with a number")?,
            schema: bytes.u16("a channel with the number of a schema")?,
            topic: bytes.text("a channel with a topic")?,
            encoding: bytes.text("a channel with an encoding")?,
        },
        op::MESSAGE => {
            let channel = bytes.u16("a message with the number of a channel")?;
            bytes.number(4, "a message with a number")?;
            let log_time = bytes.u64("a message with a time")?;
            bytes.u64("a message with two times")?;
            Entry::Message {
                channel,
                log_time,
                data: bytes.rest,
            }
        }
        _ => return Ok(None),
    }))
}

/// The head of a chunk.
pub(super) fn chunk(content: &[u8]) -> Result<Chunk<'_>, Fault> {
    let mut bytes = Bytes { rest: content };
    bytes.u64("a chunk with a first time")?;
    bytes.u64("a chunk with a last time")?;
    Ok(Chunk {
        unpacked_size: bytes.u64("a chunk with a size")?,
        checksum: bytes.number(4, "a chunk with a checksum")? as u32,
        compression: bytes.text("a chunk with the name of a compression")?,
        packed: {
            let length = bytes.u64("a chunk with the length of its records")?;
            let length = usize::try_from(length).unwrap_or(usize::MAX);
            bytes.take(length, "a chunk with as many bytes of records as it states")?
        },
    })
}

/// Bytes that are taken from the front.
struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize, expected: Fault) -> Result<&'a [u8], Fault> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(expected)?;
        self.rest = rest;
        Ok(taken)
    }

    /// A whole number of so many bytes, the lowest first.
    fn number(&mut self, size: usize, expected: Fault) -> Result<u64, Fault> {
        let bytes = self.take(size, expected)?;
        Ok(bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte)))
    }

    fn u16(&mut self, expected: Fault) -> Result<u16, Fault> {
        Ok(self.number(2, expected)? as u16)
    }

    fn u64(&mut self, expected: Fault) -> Result<u64, Fault> {
        self.number(8, expected)
    }

    /// Bytes behind their number.
    fn block(&mut self, expected: Fault) -> Result<&'a [u8], Fault> {
        let length = self.number(4, expected)?;
        self.take(usize::try_from(length).unwrap_or(usize::MAX), expected)
    }

    fn text(&mut self, expected: Fault) -> Result<&'a str, Fault> {
        str::from_utf8(self.block(expected)?).map_err(|_| expected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_that_end_early_say_what_they_lack() {
        let channel = [&[7, 0, 3, 0, 3, 0, 0, 0][..], b"/ft", &[3, 0, 0, 0], b"cdr", &[0; 4]].concat();
        let whole = entry(op::CHANNEL, &channel);
        assert!(matches!(
            whole,
            Ok(Some(Entry::Channel {
                id: 7,
                schema: 3,
                topic: "/ft",
                encoding: "cdr"
            }))
        ));
        for length in 0..channel.len() - 4 {
            assert!(entry(op::CHANNEL, &channel[..length]).is_err(), "{length}");
        }
        assert_eq!(entry(op::SCHEMA, &[1, 0, 0xFF, 0xFF, 0xFF, 0xFF, b'a']).err(), Some("a schema with a name"));
        assert_eq!(entry(op::HEADER, &[1, 0, 0, 0, 0xFF]).err(), Some("a header with the name of a profile"));
        assert!(matches!(entry(op::ATTACHMENT, &[]), Ok(None)));
    }

    #[test]
    fn a_chunk_has_as_many_bytes_as_it_says() {
        let head = [&[0; 16][..], &5_u64.to_le_bytes(), &9_u32.to_le_bytes(), &[0; 4], &3_u64.to_le_bytes()].concat();
        let whole = [&head[..], b"abc"].concat();
        let chunk = super::chunk(&whole).expect("a chunk");
        assert_eq!((chunk.unpacked_size, chunk.checksum, chunk.compression, chunk.packed), (5, 9, "", &b"abc"[..]));
        for length in 0..whole.len() {
            assert!(super::chunk(&whole[..length]).is_err(), "{length}");
        }
    }
}
