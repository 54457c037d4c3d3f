//! Rows to a file.

use std::{io::Write, sync::Arc};

use parquet::{
    basic::{LogicalType, Repetition, Type as PhysicalType},
    data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type},
    errors::ParquetError,
    file::{
        metadata::KeyValue,
        properties::WriterProperties,
        writer::{SerializedColumnWriter, SerializedFileWriter},
    },
    schema::types::Type,
};

use super::{
    error::TableError,
    rows::{Field, Kind, Rows, Values},
};

/// Rows that are held back until they make a row group.
const GROUP: usize = 1 << 16;

/// Writes rows as they come, in memory for one row group.
pub struct TableWriter<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    fields: Vec<Field>,
    pending: Rows,
}

impl<W: Write + Send> TableWriter<W> {
    /// A table with these columns and no rows.
    ///
    /// # Errors
    /// [`TableError`] where two columns share a name, or `out` refuses.
    pub fn new(out: W, fields: &[Field]) -> Result<Self, TableError> {
        let columns = fields.iter().map(column).collect::<Result<_, _>>()?;
        let schema = Type::group_type_builder("table").with_fields(columns).build()?;
        let properties =
            WriterProperties::builder().set_created_by(format!("palpate {}", env!("CARGO_PKG_VERSION"))).build();
        Ok(Self {
            writer: SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?,
            fields: fields.to_vec(),
            pending: Rows::empty(fields),
        })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// [`TableError`] where the rows have other columns, or the file cannot be written.
    pub fn write(&mut self, rows: Rows) -> Result<(), TableError> {
        if !rows.fit(&self.fields) {
            return Err(TableError::OtherColumns);
        }
        self.pending.append(rows);
        if self.pending.len() >= GROUP { self.flush() } else { Ok(()) }
    }

    /// Writes what is left and closes the table, with texts that say what it is.
    ///
    /// # Errors
    /// [`TableError`] where the file cannot be written.
    pub fn finish(mut self, marks: &[(&str, &str)]) -> Result<(), TableError> {
        if !self.pending.is_empty() {
            self.flush()?;
        }
        for (key, value) in marks {
            let mark = KeyValue::new((*key).to_owned(), (*value).to_owned());
            self.writer.append_key_value_metadata(mark);
        }
        self.writer.finish()?;
        self.writer.inner_mut().flush()?;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), TableError> {
        let rows = std::mem::replace(&mut self.pending, Rows::empty(&self.fields));
        let mut group = self.writer.next_row_group()?;
        for values in rows.columns {
            let Some(mut column) = group.next_column()? else {
                return Err(TableError::OtherColumns);
            };
            write_column(&mut column, values)?;
            column.close()?;
        }
        group.close()?;
        Ok(())
    }
}

fn column(field: &Field) -> Result<Arc<Type>, ParquetError> {
    let (physical, repetition, logical) = match field.kind {
        Kind::Count => (PhysicalType::INT64, Repetition::REQUIRED, None),
        Kind::Number => (PhysicalType::DOUBLE, Repetition::OPTIONAL, None),
        Kind::Text => (PhysicalType::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String)),
    };
    let builder = Type::primitive_type_builder(&field.name, physical);
    builder.with_repetition(repetition).with_logical_type(logical).build().map(Arc::new)
}

fn write_column(column: &mut SerializedColumnWriter<'_>, values: Values) -> Result<(), ParquetError> {
    match values {
        Values::Count(values) => {
            column.typed::<Int64Type>().write_batch(&values, None, None)?;
        }
        Values::Number(values) => {
            let there: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            let values: Vec<f64> = values.into_iter().flatten().collect();
            column.typed::<DoubleType>().write_batch(&values, Some(&there), None)?;
        }
        Values::Text(values) => {
            let there: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            let values: Vec<ByteArray> =
                values.into_iter().flatten().map(|text| ByteArray::from(text.into_bytes())).collect();
            column.typed::<ByteArrayType>().write_batch(&values, Some(&there), None)?;
        }
    }
    Ok(())
}
