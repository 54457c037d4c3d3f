//! The records of an MCAP file in order, chunks unpacked.
//!
//! The file is streamed: memory is one record or one unpacked chunk, and neither beyond a stated limit. Checksums that
//! the file has are checked.

use std::io::{self, Read};

use mcap::{
    McapError,
    records::op,
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};

use super::record::{self, Chunk, Entry};
use crate::{
    error::FileError,
    input::{Input, InputReader},
    table::Heard,
};

/// Most bytes of one record, such as a packed chunk, and of one unpacked chunk (256 MiB).
const MOST_RECORD: usize = 256 << 20;

/// Most bytes required of the file at once, so that a length that lies costs no memory.
const PIECE: usize = 1 << 20;

/// Bytes in front of the content of every record: its kind and its length.
const LEAD: usize = 1 + 8;

/// Given every entry, in the order of the file.
pub(super) type Visit<'v> = dyn FnMut(Entry<'_>) -> Result<(), FileError> + 'v;

/// Goes through the data section of the log; what stands behind it only repeats and indexes.
pub(super) fn walk(input: &Input, progress: &mut Heard<'_>, visit: &mut Visit<'_>) -> Result<(), FileError> {
    let mut log = Log {
        input,
        bytes: input.reader()?,
        offset: 0,
        messages: 0,
    };
    let options = LinearReaderOptions::default()
        .with_emit_chunks(true)
        .with_validate_data_section_crc(true)
        .with_validate_summary_section_crc(true)
        .with_record_length_limit(MOST_RECORD);
    let mut reader = LinearReader::new_with_options(options);
    let mut in_data = true;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let got = log.bytes.read(reader.insert(wanted.min(PIECE))).map_err(|error| input.failed(error))?;
                reader.notify_read(got);
                let (done, total) = log.bytes.progress();
                progress(done, total)?;
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                in_data = in_data && opcode != op::DATA_END;
                if in_data {
                    log.record(opcode, data, visit)?;
                }
                log.offset += (LEAD + data.len()) as u64;
            }
            Err(error) => return Err(log.failed(&error)),
        }
    }
    Ok(())
}

struct Log<'a> {
    input: &'a Input,
    bytes: InputReader,
    /// Bytes of the records gone through.
    offset: u64,
    messages: u64,
}

impl Log<'_> {
    /// One record of the file.
    fn record(&mut self, opcode: u8, data: &[u8], visit: &mut Visit<'_>) -> Result<(), FileError> {
        if opcode != op::CHUNK {
            return self.entry(opcode, data, visit);
        }
        let chunk = record::chunk(data).map_err(|expected| self.other(expected))?;
        let content = self.unpacked(&chunk)?;
        self.chunk(&content, visit)
    }

    /// The records of an unpacked chunk.
    fn chunk(&mut self, mut content: &[u8], visit: &mut Visit<'_>) -> Result<(), FileError> {
        while let Some((lead, rest)) = content.split_at_checked(LEAD) {
            let (opcode, length) = (lead[0], lead[1..].iter().rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte)));
            let record = usize::try_from(length).ok().and_then(|length| rest.split_at_checked(length));
            let Some((data, behind)) = record else {
                let expected = format!("a record of {length} bytes inside a chunk");
                return Err(self.damaged(expected, format!("{} bytes", rest.len())));
            };
            self.entry(opcode, data, visit)?;
            content = behind;
        }
        if content.is_empty() {
            return Ok(());
        }
        Err(self.damaged("the end of a chunk".to_owned(), format!("{} bytes more", content.len())))
    }

    /// One record that is no chunk.
    fn entry(&mut self, opcode: u8, data: &[u8], visit: &mut Visit<'_>) -> Result<(), FileError> {
        match record::entry(opcode, data).map_err(|expected| self.other(expected))? {
            Some(entry) => {
                self.messages += u64::from(opcode == op::MESSAGE);
                visit(entry)
            }
            None => Ok(()),
        }
    }

    /// The content of a chunk, which must have the length and the checksum that its header says.
    fn unpacked(&self, chunk: &Chunk<'_>) -> Result<Vec<u8>, FileError> {
        let (length, packed) = (chunk.unpacked_size, chunk.packed);
        self.input.bounded(length, "a chunk of the log", MOST_RECORD as u64)?;
        let mut content = Vec::new();
        let most = length + 1;
        let result = match chunk.compression {
            "" => packed.take(most).read_to_end(&mut content),
            "zstd" => unzstd(packed, most, &mut content),
            "lz4" => lz4_flex::frame::FrameDecoder::new(packed).take(most).read_to_end(&mut content),
            other => {
                let expected = "chunks that are not compressed, or by zstd or lz4".to_owned();
                return Err(self.damaged(expected, format!("compression \"{other}\"")));
            }
        };
        if let Err(error) = result {
            let expected = format!("a chunk compressed by {}", chunk.compression);
            return Err(self.damaged(expected, error.to_string()));
        }
        if content.len() as u64 != length {
            let found = if content.len() as u64 > length { "more".to_owned() } else { content.len().to_string() };
            return Err(self.damaged(format!("a chunk of {length} bytes"), found));
        }
        let mut sum = flate2::Crc::new();
        sum.update(&content);
        if chunk.checksum != 0 && sum.sum() != chunk.checksum {
            let expected = format!("a chunk with checksum {:08x}", chunk.checksum);
            return Err(self.damaged(expected, format!("{:08x}", sum.sum())));
        }
        Ok(content)
    }

    fn damaged(&self, expected: String, found: String) -> FileError {
        let place =
            format!("record at byte {}, after {} messages", mcap::MAGIC.len() as u64 + self.offset, self.messages);
        self.input.damaged(place, expected, found)
    }

    fn other(&self, expected: &str) -> FileError {
        self.damaged(expected.to_owned(), "other bytes, or their end".to_owned())
    }

    /// What the reader of the container says.
    fn failed(&self, error: &McapError) -> FileError {
        match error {
            McapError::UnexpectedEof => {
                self.damaged("a whole log with its closing record".to_owned(), "the end of the file".to_owned())
            }
            McapError::RecordTooLarge { .. } | McapError::ChunkTooLarge(_) => {
                self.input.too_large("a record of the log", MOST_RECORD as u64)
            }
            other => self.damaged("an MCAP record".to_owned(), other.to_string()),
        }
    }
}

/// Most memory that a frame of zstd may ask for to look back in, 64 MiB, as a power of two.
const WINDOW: u32 = 26;

/// Unpacks every frame, up to `most` bytes.
fn unzstd(packed: &[u8], most: u64, content: &mut Vec<u8>) -> io::Result<usize> {
    let mut frames = zstd::stream::read::Decoder::with_buffer(packed)?;
    frames.window_log_max(WINDOW)?;
    frames.take(most).read_to_end(content)
}
