//! Rows to a file.

use std::{io::Write, sync::Arc};

use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{DataType, Field as Column, Schema, SchemaRef};
use parquet::{
    arrow::arrow_writer::{ArrowWriter, ArrowWriterOptions},
    file::{metadata::KeyValue, properties::WriterProperties},
};

use super::{
    error::TableError,
    rows::{Field, Kind, Rows, Values},
};

/// Rows that are held back until they make a row group.
const GROUP: usize = 1 << 16;

/// Rows that are encoded together, a divisor of [`GROUP`]: a page ends only behind so many, so that the bytes of a table do not depend on
/// how its rows were divided among calls.
const ENCODED: usize = 1 << 10;

/// Writes rows as they come, in memory for one row group.
pub struct TableWriter<W: Write + Send> {
    writer: ArrowWriter<W>,
    schema: SchemaRef,
    /// Fewer than [`ENCODED`].
    held: Rows,
}

impl<W: Write + Send> TableWriter<W> {
    /// A table with these columns and no rows.
    ///
    /// # Errors
    /// [`TableError`] where two columns share a name, or `out` refuses.
    pub fn new(out: W, fields: &[Field]) -> Result<Self, TableError> {
        let held = Rows {
            columns: fields.iter().map(|field| Values::empty(field.kind)).collect(),
        };
        let columns = fields.iter().map(|field| match field.kind {
            Kind::Count => Column::new(&field.name, DataType::Int64, false),
            Kind::OptionalCount => Column::new(&field.name, DataType::Int64, true),
            Kind::Number => Column::new(&field.name, DataType::Float64, true),
            Kind::Text => Column::new(&field.name, DataType::Utf8, true),
        });
        let schema = Arc::new(Schema::new(columns.collect::<Vec<_>>()));
        let properties = WriterProperties::builder()
            .set_created_by(format!("palpate {}", env!("CARGO_PKG_VERSION")))
            .set_max_row_group_row_count(Some(GROUP))
            .build();
        let options = ArrowWriterOptions::new()
            .with_properties(properties)
            .with_schema_root("table".to_owned())
            .with_skip_arrow_metadata(true);
        let writer = ArrowWriter::try_new_with_options(out, schema.clone(), options)?;
        Ok(Self { writer, schema, held })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// [`TableError`] where the rows have other columns, or the file cannot be written.
    pub fn write(&mut self, rows: Rows) -> Result<(), TableError> {
        self.held.append(rows).ok_or(TableError::OtherColumns)?;
        while self.held.len() >= ENCODED {
            let rest = self.held.split_off(ENCODED);
            let full = std::mem::replace(&mut self.held, rest);
            self.encode(full)?;
        }
        Ok(())
    }

    fn encode(&mut self, rows: Rows) -> Result<(), TableError> {
        let columns = rows.columns.into_iter().map(ArrayRef::from).collect();
        let batch = RecordBatch::try_new(self.schema.clone(), columns).map_err(|_| TableError::OtherColumns)?;
        Ok(self.writer.write(&batch)?)
    }

    /// Writes what is left and closes the table, with texts that say what it is.
    ///
    /// # Errors
    /// [`TableError`] where the file cannot be written.
    pub fn finish(mut self, marks: &[(&str, &str)]) -> Result<(), TableError> {
        let rest = self.held.split_off(0);
        if !rest.is_empty() {
            self.encode(rest)?;
        }
        for (key, value) in marks {
            let mark = KeyValue::new((*key).to_owned(), (*value).to_owned());
            self.writer.append_key_value_metadata(mark);
        }
        // Not `into_inner`, which makes a text of an error of the disk.
        self.writer.finish()?;
        self.writer.inner_mut().flush()?;
        Ok(())
    }
}
