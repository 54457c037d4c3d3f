//! Batches of rows, whatever the format.

use std::ops::Range;

use arrow_schema::SchemaRef;

use super::{batches::Visitor, ipc, kind::Kind, parquet};
use crate::{
    error::FileError,
    input::{Input, contained},
};

/// A file whose schema is known.
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
