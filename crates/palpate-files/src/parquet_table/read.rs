//! A file to rows.

use std::fs::File;

use parquet::{
    basic::Type as PhysicalType,
    column::reader::ColumnReader,
    data_type::ByteArray,
    errors::ParquetError,
    file::{reader::FileReader, serialized_reader::SerializedFileReader},
};

use super::{
    error::TableError,
    rows::{Field, Kind, Rows, Values},
};
use crate::input::caught;

/// A table that [`TableWriter`](super::write::TableWriter) wrote.
pub struct TableReader {
    reader: SerializedFileReader<File>,
    fields: Vec<Field>,
}

impl TableReader {
    /// Looks at the end of the file, which says what is in it.
    ///
    /// # Errors
    /// [`TableError`] where the file is no Parquet, is cut off, or has columns of other kinds.
    pub fn new(file: File) -> Result<Self, TableError> {
        caught(|| Self::of(file)).unwrap_or_else(|| Err(out_of_bounds()))
    }

    fn of(file: File) -> Result<Self, TableError> {
        let reader = SerializedFileReader::new(file)?;
        let columns = reader.metadata().file_metadata().schema_descr().columns();
        let fields = columns.iter().map(|column| {
            let name = column.name();
            match (column.physical_type(), column.max_def_level()) {
                (PhysicalType::INT64, 0) => Ok(Field::new(name, Kind::Count)),
                (PhysicalType::DOUBLE, 1) => Ok(Field::new(name, Kind::Number)),
                (PhysicalType::BYTE_ARRAY, 1) => Ok(Field::new(name, Kind::Text)),
                _ => Err(TableError::Foreign {
                    column: name.to_owned(),
                }),
            }
        });
        let fields = fields.collect::<Result<_, _>>()?;
        Ok(Self { reader, fields })
    }

    /// The columns.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> u64 {
        u64::try_from(self.reader.metadata().file_metadata().num_rows()).unwrap_or(0)
    }

    /// The text that the writer put under a key.
    #[must_use]
    pub fn mark(&self, key: &str) -> Option<&str> {
        let marks = self.reader.metadata().file_metadata().key_value_metadata()?;
        marks.iter().find(|mark| mark.key == key)?.value.as_deref()
    }

    /// How many row groups there are.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// The rows of one row group, by its index.
    ///
    /// # Errors
    /// [`TableError`] where the file is damaged, or there is no such row group.
    pub fn read(&self, group: usize) -> Result<Rows, TableError> {
        let columns = (0..self.fields.len()).map(|column| self.values(group, column));
        Ok(Rows {
            columns: columns.collect::<Result<_, _>>()?,
        })
    }

    /// One column of one row group, both by their index.
    ///
    /// # Errors
    /// As for [`read`](Self::read).
    pub fn values(&self, group: usize, column: usize) -> Result<Values, TableError> {
        if group >= self.groups() || column >= self.fields.len() {
            return Err(TableError::Parquet {
                message: format!("no row group {group} with a column {column}"),
            });
        }
        caught(|| self.decoded(group, column)).unwrap_or_else(|| Err(out_of_bounds()))
    }

    fn decoded(&self, group: usize, column: usize) -> Result<Values, TableError> {
        let group = self.reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let found = read_column(group.get_column_reader(column)?, rows)?;
        found.ok_or_else(|| TableError::Foreign {
            column: self.fields[column].name.clone(),
        })
    }
}

/// The reader of the format takes some places in a file at their word and then panics.
fn out_of_bounds() -> TableError {
    TableError::Parquet {
        message: "places in the file that are out of bounds".to_owned(),
    }
}

fn read_column(column: ColumnReader, rows: usize) -> Result<Option<Values>, ParquetError> {
    let mut there = Vec::new();
    Ok(match column {
        ColumnReader::Int64ColumnReader(mut reader) => {
            let mut values = Vec::new();
            reader.read_records(rows, None, None, &mut values)?;
            Some(Values::Count(values))
        }
        ColumnReader::DoubleColumnReader(mut reader) => {
            let mut values = Vec::new();
            reader.read_records(rows, Some(&mut there), None, &mut values)?;
            Some(Values::Number(spread(values, &there)))
        }
        ColumnReader::ByteArrayColumnReader(mut reader) => {
            let mut values: Vec<ByteArray> = Vec::new();
            reader.read_records(rows, Some(&mut there), None, &mut values)?;
            let texts = values.iter().map(|text| text.as_utf8().map(str::to_owned));
            Some(Values::Text(spread(texts.collect::<Result<_, _>>()?, &there)))
        }
        _ => None,
    })
}

/// Puts values back beside the ones that are missing.
fn spread<T>(values: Vec<T>, there: &[i16]) -> Vec<Option<T>> {
    let mut values = values.into_iter();
    there.iter().map(|level| if *level > 0 { values.next() } else { None }).collect()
}
