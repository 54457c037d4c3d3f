//! Batches of rows, whatever the format.

use std::ops::Range;

use arrow_schema::SchemaRef;

use super::{batches::Visitor, ipc, kind::Kind, parquet::Parquet};
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
    parquet: Option<Parquet>,
}

impl Source {
    pub(super) fn open(input: &Input, kind: Kind) -> Result<Self, FileError> {
        let (schema, parquet) = contained(input, || match kind {
            Kind::Parquet => Parquet::open(input).map(|parquet| (parquet.schema(), Some(parquet))),
            Kind::File | Kind::Stream => Ok((ipc::schema(input, kind)?, None)),
        })?;
        Ok(Self {
            input: input.clone(),
            kind,
            schema,
            rows: parquet.as_ref().and_then(Parquet::rows),
            parquet,
        })
    }

    /// Visits the columns with these indices (rising) of all batches that hold a row in `rows`.
    pub(super) fn visit(&self, columns: &[usize], rows: Range<u64>, each: &mut Visitor<'_>) -> Result<(), FileError> {
        contained(&self.input, || match &self.parquet {
            Some(parquet) => parquet.visit(&self.input, columns, &rows, each),
            None => ipc::visit(&self.input, self.kind, columns, &rows, each),
        })
    }
}
