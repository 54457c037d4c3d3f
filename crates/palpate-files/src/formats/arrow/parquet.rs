//! Batches of a Parquet file.

use std::{
    io::{BufReader, Read, Seek, SeekFrom},
    ops::{ControlFlow, Range},
    sync::Arc,
};

use arrow_schema::SchemaRef;
use bytes::Bytes;
use parquet::{
    arrow::{
        ProjectionMask,
        arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder},
    },
    errors::ParquetError,
    file::reader::{ChunkReader, Length},
};

use super::batches::{Visitor, damaged};
use crate::{
    error::{FileError, FileProblem},
    faults::admits,
    input::{Input, PageProblem, Seekable, check_pages},
};

/// Last bytes of a file whose footer is encrypted.
const ENCRYPTED: &[u8] = b"PARE";

/// Rows of a batch.
const BATCH: usize = 8192;

/// Rows that any file may state, and beyond them how many for each of its bytes: a run of equal values takes no room, but its rows take time.
const ALWAYS_ROWS: u64 = 1 << 24;
/// See [`ALWAYS_ROWS`].
const ROWS_A_BYTE: u64 = 32;

/// The bytes of an input; no more of them are made room for than there are.
#[derive(Clone)]
struct Chunks {
    input: Arc<Input>,
    size: u64,
}

impl Chunks {
    fn of(input: &Input) -> Result<Self, FileError> {
        let input = Arc::new(input.unpacked()?);
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
    metadata.map_err(|error| damaged(input, "footer", &found(&error)))
}

/// What an error of `parquet` found; its errors about the schema of Arrow quote what parsing that did, over many lines.
fn found(error: &ParquetError) -> String {
    match error {
        ParquetError::General(found) | ParquetError::EOF(found) => found.clone(),
        ParquetError::ArrowError(_) => "a description of the columns (ARROW:schema) that is damaged".to_owned(),
        error => error.to_string(),
    }
}

/// What the pages of the chosen columns of some groups state must be within reason before room is made for it.
fn check(
    input: &Input,
    Parquet { chunks, metadata }: &Parquet,
    columns: &[usize],
    groups: &[usize],
) -> Result<(), FileError> {
    let schema = metadata.parquet_schema();
    let chunks = Arc::new(chunks.clone());
    for group in groups.iter().map(|group| metadata.metadata().row_group(*group)) {
        for (leaf, column) in group.columns().iter().enumerate() {
            if columns.contains(&schema.get_column_root_idx(leaf)) {
                check_pages(&chunks, column, input.warranted()).map_err(|problem| match problem {
                    PageProblem::Beyond => input.beyond_limit(),
                    PageProblem::Damaged { at, expected, found } => {
                        input.damaged(format!("page at byte {at}"), expected, found)
                    }
                    PageProblem::Unread(error) => damaged(input, "rows", &found(&error)),
                })?;
            }
        }
    }
    Ok(())
}

/// A file whose footer has been read.
pub(super) struct Parquet {
    chunks: Chunks,
    metadata: ArrowReaderMetadata,
}

impl Parquet {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let chunks = Chunks::of(input)?;
        let metadata = metadata(input, &chunks)?;
        let groups = metadata.metadata().row_groups().iter().map(|group| group.num_rows().max(0) as u64);
        let rows = groups.fold(0_u64, u64::saturating_add);
        if !admits(rows, chunks.size.saturating_mul(ROWS_A_BYTE).max(ALWAYS_ROWS)) {
            return Err(input.beyond_limit());
        }
        Ok(Self { chunks, metadata })
    }

    pub(super) fn schema(&self) -> SchemaRef {
        self.metadata.schema().clone()
    }

    pub(super) fn rows(&self) -> Option<u64> {
        u64::try_from(self.metadata.metadata().file_metadata().num_rows()).ok()
    }

    pub(super) fn visit(
        &self,
        input: &Input,
        columns: &[usize],
        rows: &Range<u64>,
        each: &mut Visitor<'_>,
    ) -> Result<(), FileError> {
        let metadata = self.metadata.metadata();
        // The groups from the first to the last that hold a row that is wanted.
        let mut start = 0_u64;
        let (mut groups, mut first) = (Vec::new(), None);
        for (group, about) in metadata.row_groups().iter().enumerate() {
            let end = start.saturating_add(about.num_rows().max(0) as u64);
            if start < rows.end && end > rows.start {
                first.get_or_insert(start);
                groups.push(group);
            }
            start = end;
        }
        let total = start;
        let first = first.unwrap_or(0);
        // Behind the beginning of the first group.
        let mut row = first.max(rows.start);
        let before = usize::try_from(row - first).unwrap_or(usize::MAX);
        check(input, self, columns, &groups)?;
        let mask = ProjectionMask::roots(self.metadata.parquet_schema(), columns.iter().copied());
        let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(self.chunks.clone(), self.metadata.clone())
            .with_projection(mask)
            .with_row_groups(groups)
            .with_offset(before)
            .with_batch_size(BATCH);
        let reader = builder.build().map_err(|error| damaged(input, "rows", &found(&error)))?;
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
}
