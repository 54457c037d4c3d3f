//! Batches of rows, whatever the format.

use std::ops::{ControlFlow, Range};

use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;

use super::{ipc, parquet};
use crate::{
    error::FileError,
    input::{Input, contained},
};

/// How a file of typed columns is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Parquet.
    Parquet,
    /// Arrow IPC, with a footer.
    File,
    /// Arrow IPC, without one.
    Stream,
}

/// What is told of every batch: its first row, the batch, bytes or rows done, and how many there are.
pub(super) type Visitor<'a> = dyn FnMut(u64, &RecordBatch, (u64, u64)) -> Result<ControlFlow<()>, FileError> + 'a;

/// A file whose schema is known.
#[derive(Debug)]
pub(super) struct Source {
    pub(super) input: Input,
    pub(super) kind: Kind,
    pub(super) schema: SchemaRef,
    /// Number of rows, where the file says it before they are read.
    pub(super) rows: Option<u64>,
}

impl Source {
    pub(super) fn open(input: &Input, kind: Kind) -> Result<Self, FileError> {
        let (schema, rows) = contained(input, || match kind {
            Kind::Parquet => parquet::outline(input),
            Kind::File | Kind::Stream => Ok((ipc::schema(input, kind)?, None)),
        })?;
        Ok(Self {
            input: input.clone(),
            kind,
            schema,
            rows,
        })
    }

    /// Visits the columns with these indices (rising) of all batches that hold a row in `rows`.
    pub(super) fn visit(&self, columns: &[usize], rows: Range<u64>, each: &mut Visitor<'_>) -> Result<(), FileError> {
        contained(&self.input, || match self.kind {
            Kind::Parquet => parquet::visit(&self.input, columns, &rows, each),
            Kind::File | Kind::Stream => ipc::visit(&self.input, self.kind, columns, &rows, each),
        })
    }
}

pub(super) fn damaged(input: &Input, place: &str, found: &str) -> FileError {
    FileError::Damaged {
        path: input.name().to_owned(),
        place: place.to_owned(),
        expected: "what the format has there".to_owned(),
        found: found.to_owned(),
    }
}
