//! Batches of a Parquet file.

use std::{
    io::{BufReader, Read, Seek, SeekFrom},
    ops::{ControlFlow, Range},
};

use arrow_schema::SchemaRef;
use bytes::Bytes;
use parquet::{
    arrow::{
        ProjectionMask,
        arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder},
    },
    basic::Compression,
    errors::ParquetError,
    file::reader::{ChunkReader, Length},
};

use super::{
    batches::{Visitor, damaged},
    pages::page,
};
use crate::{
    error::{FileError, FileProblem},
    input::{Input, Seekable},
};

/// Last bytes of a file whose footer is encrypted.
const ENCRYPTED: &[u8] = b"PARE";

/// Bytes that the head of a page mostly has, and most that it may have (16 MiB).
const USUAL_HEAD: u64 = 4096;
/// See [`USUAL_HEAD`].
const MOST_OF_HEAD: u64 = 16 << 20;

/// Rows of a batch.
const BATCH: usize = 8192;

/// The bytes of an input; no more of them are made room for than there are.
struct Chunks {
    input: Input,
    size: u64,
}

impl Chunks {
    fn of(input: &Input) -> Result<Self, FileError> {
        let input = input.unpacked()?;
        let size = input.size;
        Ok(Self { input, size })
    }
}

impl Length for Chunks {
    fn len(&self) -> u64 {
        self.size
    }
}

impl ChunkReader for Chunks {
    type T = BufReader<Box<dyn Seekable>>;

    fn get_read(&self, start: u64) -> Result<Self::T, ParquetError> {
        let mut bytes = self.input.seekable().map_err(|error| ParquetError::External(Box::new(error)))?;
        bytes.seek(SeekFrom::Start(start))?;
        Ok(BufReader::new(bytes))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes, ParquetError> {
        if start.checked_add(length as u64).is_none_or(|end| end > self.size) {
            return Err(ParquetError::EOF(format!("{length} bytes at {start} of a file of {}", self.size)));
        }
        let mut bytes = Vec::with_capacity(length);
        self.get_read(start)?.take(length as u64).read_to_end(&mut bytes)?;
        if bytes.len() == length {
            Ok(bytes.into())
        } else {
            Err(ParquetError::EOF("the end of the file".to_owned()))
        }
    }
}

fn metadata(input: &Input, chunks: &Chunks) -> Result<ArrowReaderMetadata, FileError> {
    let length = ENCRYPTED.len();
    if chunks.get_bytes(chunks.size.wrapping_sub(length as u64), length).is_ok_and(|end| end == ENCRYPTED) {
        return Err(input.wrong(FileProblem::Encrypted));
    }
    let metadata = ArrowReaderMetadata::load(chunks, ArrowReaderOptions::new());
    metadata.map_err(|error| damaged(input, "footer", &error.to_string()))
}

/// What the pages of the chosen columns say they unpack to must be within reason before room is made for it.
fn check(input: &Input, chunks: &Chunks, metadata: &ArrowReaderMetadata, columns: &[usize]) -> Result<(), FileError> {
    let schema = metadata.parquet_schema();
    for group in metadata.metadata().row_groups() {
        for (leaf, column) in group.columns().iter().enumerate() {
            if column.compression() == Compression::UNCOMPRESSED || !columns.contains(&schema.get_column_root_idx(leaf))
            {
                continue;
            }
            let start = column.dictionary_page_offset().unwrap_or(i64::MAX).min(column.data_page_offset());
            let (Ok(start), Ok(length)) = (u64::try_from(start), u64::try_from(column.compressed_size())) else {
                continue;
            };
            check_pages(input, chunks, start, start.saturating_add(length).min(chunks.size))?;
        }
    }
    Ok(())
}

fn check_pages(input: &Input, chunks: &Chunks, mut start: u64, end: u64) -> Result<(), FileError> {
    while start < end {
        let in_next =
            |most: u64| chunks.get_bytes(start, (end - start).min(most) as usize).ok().and_then(|head| page(&head));
        // The least and greatest value of a page of texts stand in its head.
        let Some(page) = in_next(USUAL_HEAD).or_else(|| in_next(MOST_OF_HEAD)) else {
            return Ok(());
        };
        if page.unpacked > input.warranted() {
            return Err(input.beyond_limit());
        }
        start = start.saturating_add(page.head).saturating_add(page.packed);
    }
    Ok(())
}

pub(super) fn outline(input: &Input) -> Result<(SchemaRef, Option<u64>), FileError> {
    let metadata = metadata(input, &Chunks::of(input)?)?;
    let rows = metadata.metadata().file_metadata().num_rows();
    Ok((metadata.schema().clone(), u64::try_from(rows).ok()))
}

pub(super) fn visit(
    input: &Input,
    columns: &[usize],
    rows: &Range<u64>,
    each: &mut Visitor<'_>,
) -> Result<(), FileError> {
    let chunks = Chunks::of(input)?;
    let metadata = metadata(input, &chunks)?;
    check(input, &chunks, &metadata, columns)?;
    let mask = ProjectionMask::roots(metadata.parquet_schema(), columns.iter().copied());
    // The groups from the first to the last that hold a row that is wanted.
    let mut start = 0_u64;
    let (mut groups, mut first) = (Vec::new(), None);
    for (group, about) in metadata.metadata().row_groups().iter().enumerate() {
        let end = start.saturating_add(about.num_rows().max(0) as u64);
        if start < rows.end && end > rows.start {
            first.get_or_insert(start);
            groups.push(group);
        }
        start = end;
    }
    let total = start;
    let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(chunks, metadata)
        .with_projection(mask)
        .with_row_groups(groups)
        .with_batch_size(BATCH);
    let reader = builder.build().map_err(|error| damaged(input, "rows", &error.to_string()))?;
    let mut row = first.unwrap_or(0);
    for batch in reader {
        let batch = batch.map_err(|error| damaged(input, &format!("rows from {}", row + 1), &error.to_string()))?;
        let count = batch.num_rows() as u64;
        if each(row, &batch, (row.saturating_add(count), total))? == ControlFlow::Break(()) {
            break;
        }
        row = row.saturating_add(count);
    }
    Ok(())
}
