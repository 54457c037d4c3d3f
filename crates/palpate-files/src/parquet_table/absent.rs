//! A build without Parquet: no table is ever opened, so that nothing can be done with one.

use std::{convert::Infallible, fs::File, io::Write, marker::PhantomData};

use super::{
    error::TableError,
    rows::{Field, Rows, Values},
};

/// Not in this build.
pub struct TableWriter<W: Write + Send>(Infallible, PhantomData<W>);

#[expect(missing_docs, clippy::missing_errors_doc, reason = "as where the feature is there")]
impl<W: Write + Send> TableWriter<W> {
    pub fn new(_: W, _: &[Field]) -> Result<Self, TableError> {
        Err(TableError::NotInThisBuild)
    }

    pub fn write(&mut self, _: Rows) -> Result<(), TableError> {
        match self.0 {}
    }

    pub fn finish(self, _: &[(&str, &str)]) -> Result<(), TableError> {
        match self.0 {}
    }
}

/// Not in this build.
pub struct TableReader(Infallible);

#[expect(missing_docs, clippy::missing_errors_doc, reason = "as where the feature is there")]
impl TableReader {
    pub fn new(_: File) -> Result<Self, TableError> {
        Err(TableError::NotInThisBuild)
    }

    #[must_use]
    pub fn fields(&self) -> &[Field] {
        match self.0 {}
    }

    #[must_use]
    pub fn rows(&self) -> u64 {
        match self.0 {}
    }

    #[must_use]
    pub fn mark(&self, _: &str) -> Option<&str> {
        match self.0 {}
    }

    #[must_use]
    pub fn groups(&self) -> usize {
        match self.0 {}
    }

    pub fn read(&self, _: usize) -> Result<Rows, TableError> {
        match self.0 {}
    }

    pub fn values(&self, _: usize, _: usize) -> Result<Values, TableError> {
        match self.0 {}
    }
}
