//! Batches of an Arrow file or stream: messages one behind the other. The footer of a file is needed only where a writer put
//! its first message down in another way.

use std::{
    collections::HashMap,
    io::{BufRead, BufReader, Read, SeekFrom},
    ops::{ControlFlow, Range},
    sync::Arc,
};

use arrow_array::ArrayRef;
use arrow_buffer::Buffer;
use arrow_ipc::{Block, MessageHeader, convert::fb_to_schema, reader, root_as_footer, root_as_message};
use arrow_schema::SchemaRef;

use super::{
    batches::{Visitor, damaged},
    kind::{Kind, MAGIC, MARK},
};
use crate::{
    error::FileError,
    faults::admits,
    input::{Input, InputReader, MOST_IN_MEMORY},
};

/// Most zeros between the magic word of a file and its first message.
const MOST_PADDING: usize = 64;
/// Most bytes of the description of a message (64 MiB).
const MOST_OF_MESSAGE: u64 = 64 << 20;

/// The messages of a file.
struct Messages<'a> {
    input: &'a Input,
    bytes: BufReader<InputReader>,
    count: usize,
    /// The footer, where the file begins in another way than with a message.
    footer: Option<Vec<u8>>,
    ended: bool,
}

impl<'a> Messages<'a> {
    fn of(input: &'a Input, kind: Kind) -> Result<Self, FileError> {
        if kind == Kind::File {
            ends_well(input)?;
        }
        let mut messages = Self {
            input,
            bytes: BufReader::new(input.reader()?),
            count: 0,
            footer: None,
            ended: false,
        };
        if kind == Kind::File {
            messages.take(8, "the beginning")?;
            let mut place = 8;
            // Some writers begin the first message at a round place.
            for _ in 0..MOST_PADDING / 8 {
                let ahead = messages.bytes.fill_buf().map_err(|error| input.failed(error))?;
                if ahead.get(..8) != Some(&[0; 8]) {
                    break;
                }
                messages.bytes.consume(8);
                place += 8;
            }
            let ahead = messages.bytes.fill_buf().map_err(|error| input.failed(error))?;
            if !ahead.starts_with(&MARK) {
                messages.go_by_footer(place)?;
            }
        }
        Ok(messages)
    }

    /// Goes on to the first batch that the footer names: polars writes the schema without a length before it.
    fn go_by_footer(&mut self, place: u64) -> Result<(), FileError> {
        let wrong = |found: &str| damaged(self.input, "the footer", found);
        let footer = footer(self.input)?;
        let named = root_as_footer(&footer).map_err(|error| wrong(&error.to_string()))?;
        let blocks = named.dictionaries().into_iter().flatten().chain(named.recordBatches().into_iter().flatten());
        let Some(first) = blocks.map(Block::offset).min() else {
            (self.footer, self.ended) = (Some(footer), true);
            return Ok(());
        };
        let ahead = u64::try_from(first).ok().and_then(|first| first.checked_sub(place));
        let ahead = ahead.ok_or_else(|| wrong("a batch before the beginning"))?;
        let skipped = std::io::copy(&mut self.bytes.by_ref().take(ahead), &mut std::io::sink());
        if skipped.map_err(|error| self.input.failed(error))? < ahead {
            return Err(wrong("a batch beyond the end"));
        }
        self.footer = Some(footer);
        Ok(())
    }

    /// So many bytes, or an error; room is made as they arrive.
    fn take(&mut self, count: u64, what: &str) -> Result<Vec<u8>, FileError> {
        let mut bytes = Vec::new();
        let read = self.bytes.by_ref().take(count).read_to_end(&mut bytes);
        read.map_err(|error| self.input.failed(error))?;
        if bytes.len() as u64 == count {
            Ok(bytes)
        } else {
            Err(self.wrong(&format!("the end of the file in {what}")))
        }
    }

    fn wrong(&self, found: &str) -> FileError {
        damaged(self.input, &format!("message {}", self.count), found)
    }

    /// The description and the body of the next message; `None` at the end.
    fn next(&mut self) -> Result<Option<(Vec<u8>, Buffer)>, FileError> {
        self.count += 1;
        if self.ended {
            return Ok(None);
        }
        let mut length = Vec::new();
        let read = self.bytes.by_ref().take(4).read_to_end(&mut length);
        read.map_err(|error| self.input.failed(error))?;
        // A stream may just end.
        if length.is_empty() {
            return Ok(None);
        }
        if length[..] == MARK {
            length = self.take(4, "a length")?;
        }
        let Some(length) = length.first_chunk::<4>().map(|four| u32::from_le_bytes(*four)) else {
            return Err(self.wrong("the end of the file in a length"));
        };
        if length == 0 {
            return Ok(None);
        }
        if u64::from(length) > MOST_OF_MESSAGE {
            return Err(self.wrong("a length beyond any"));
        }
        let head = self.take(u64::from(length), "a message")?;
        let body = root_as_message(&head).map_err(|error| self.wrong(&error.to_string()))?.bodyLength();
        let body = u64::try_from(body).map_err(|_| self.wrong("a negative length"))?;
        if !admits(body, MOST_IN_MEMORY) {
            return Err(self.input.too_large("a batch of rows", MOST_IN_MEMORY));
        }
        let body = self.take(body, "a batch of rows")?;
        Ok(Some((head, Buffer::from_vec(body))))
    }

    fn schema(&mut self) -> Result<SchemaRef, FileError> {
        let head;
        let schema = if let Some(footer) = &self.footer {
            let footer = root_as_footer(footer).map_err(|error| self.wrong(&error.to_string()))?;
            footer.schema()
        } else {
            let Some((first, _)) = self.next()? else {
                return Err(self.wrong("the end of the file"));
            };
            head = first;
            root_as_message(&head).map_err(|error| self.wrong(&error.to_string()))?.header_as_schema()
        };
        let schema = schema.ok_or_else(|| self.wrong("no schema"))?;
        if schema.endianness() != arrow_ipc::Endianness::Little {
            return Err(self.wrong("numbers of the other byte order"));
        }
        Ok(Arc::new(fb_to_schema(schema)))
    }

    /// What the buffers of a batch unpack to must be within reason before room is made for it.
    fn check(&self, batch: &arrow_ipc::RecordBatch<'_>, body: &Buffer) -> Result<(), FileError> {
        let buffers = batch.buffers().into_iter().flatten();
        let mut sum = 0_u64;
        for buffer in buffers {
            let place = |number: i64| usize::try_from(number).ok();
            let held = place(buffer.offset()).zip(place(buffer.length()));
            let held = held.and_then(|(start, length)| body.get(start..start.checked_add(length)?));
            let held = held.ok_or_else(|| self.wrong("a column beyond the batch"))?;
            if batch.compression().is_some() && !held.is_empty() {
                let length = held.first_chunk::<8>().map(|eight| i64::from_le_bytes(*eight));
                let length = length.filter(|length| *length >= -1).ok_or_else(|| self.wrong("a negative length"))?;
                sum = sum.saturating_add(length.max(0) as u64);
            }
        }
        self.input.bounded(sum, "a batch of rows", MOST_IN_MEMORY)
    }
}

/// Up to `count` bytes, the first of them so far from the end of the file.
fn near_end(input: &Input, from_end: u64, count: u64) -> Result<Vec<u8>, FileError> {
    let mut bytes = input.seekable()?;
    let mut part = Vec::new();
    let read = bytes.seek(SeekFrom::End(-(from_end as i64))).and_then(|_| bytes.take(count).read_to_end(&mut part));
    read.map(|_| part).map_err(|error| input.failed(error))
}

/// The footer of a file: before its length and the magic word at the end.
fn footer(input: &Input) -> Result<Vec<u8>, FileError> {
    let length = near_end(input, 10, 4)?;
    let length = length.first_chunk::<4>().map_or(0, |four| u64::from(u32::from_le_bytes(*four)));
    let within = (1..=MOST_OF_MESSAGE).contains(&length);
    let footer = within.then(|| near_end(input, length + 10, length).ok()).flatten();
    footer.ok_or_else(|| damaged(input, "the footer", "a length beyond the file"))
}

/// A file that is whole ends with its magic word.
fn ends_well(input: &Input) -> Result<(), FileError> {
    match near_end(input, 6, 6) {
        Ok(last) if last == MAGIC => Ok(()),
        _ => Err(damaged(input, "the end", "another end: the file may be cut off")),
    }
}

pub(super) fn schema(input: &Input, kind: Kind) -> Result<SchemaRef, FileError> {
    Messages::of(input, kind)?.schema()
}

pub(super) fn visit(
    input: &Input,
    kind: Kind,
    columns: &[usize],
    rows: &Range<u64>,
    each: &mut Visitor<'_>,
) -> Result<(), FileError> {
    let mut messages = Messages::of(input, kind)?;
    let schema = messages.schema()?;
    let mut dictionaries: HashMap<i64, ArrayRef> = HashMap::new();
    let mut row = 0_u64;
    while let Some((head, body)) = messages.next()? {
        let message = root_as_message(&head).map_err(|error| messages.wrong(&error.to_string()))?;
        match message.header_type() {
            MessageHeader::DictionaryBatch => {
                let batch = message.header_as_dictionary_batch();
                let batch = batch.ok_or_else(|| messages.wrong("no dictionary"))?;
                let data = batch.data().ok_or_else(|| messages.wrong("an empty dictionary"))?;
                messages.check(&data, &body)?;
                reader::read_dictionary(&body, batch, &schema, &mut dictionaries, &message.version())
                    .map_err(|error| messages.wrong(&error.to_string()))?;
            }
            MessageHeader::RecordBatch => {
                let batch = message.header_as_record_batch().ok_or_else(|| messages.wrong("no rows"))?;
                let count = u64::try_from(batch.length()).map_err(|_| messages.wrong("a negative number of rows"))?;
                if row < rows.end && row.saturating_add(count) > rows.start {
                    messages.check(&batch, &body)?;
                    let (schema, version) = (schema.clone(), message.version());
                    let batch = reader::read_record_batch(&body, batch, schema, &dictionaries, Some(columns), &version)
                        .map_err(|error| messages.wrong(&error.to_string()))?;
                    let (done, total) = messages.bytes.get_ref().progress();
                    if each(row, &batch, (done, total))? == ControlFlow::Break(()) {
                        return Ok(());
                    }
                }
                row = row.saturating_add(count);
                if row >= rows.end {
                    return Ok(());
                }
            }
            _ => return Err(messages.wrong("a message of another kind")),
        }
    }
    Ok(())
}
