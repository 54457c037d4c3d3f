//! A file to rows.

use std::{fs::File, sync::Arc};

use arrow_schema::DataType;
use parquet::{
    arrow::{
        ProjectionMask,
        arrow_reader::{ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder},
    },
    errors::ParquetError,
    file::reader::Length,
};

use super::{
    error::TableError,
    rows::{Field, Kind, Rows, Values},
};
use crate::input::{ALWAYS_UNPACKED, MOST_TIMES, PageProblem, caught, check_pages};

/// A table that [`TableWriter`](super::write::TableWriter) wrote.
pub struct TableReader {
    file: Arc<File>,
    about: ArrowReaderMetadata,
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
        let about = ArrowReaderMetadata::load(&file, ArrowReaderOptions::new().with_skip_arrow_metadata(true))?;
        let fields = about.schema().fields().iter().map(|field| {
            let kind = match (field.data_type(), field.is_nullable()) {
                (DataType::Int64, false) => Kind::Count,
                (DataType::Int64, true) => Kind::OptionalCount,
                (DataType::Float64, true) => Kind::Number,
                (DataType::Utf8, true) => Kind::Text,
                _ => return Err(TableError::Foreign(field.name().clone())),
            };
            Ok(Field::new(field.name(), kind))
        });
        let fields = fields.collect::<Result<_, _>>()?;
        Ok(Self {
            file: Arc::new(file),
            about,
            fields,
        })
    }

    /// The columns.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> u64 {
        u64::try_from(self.about.metadata().file_metadata().num_rows()).unwrap_or(0)
    }

    /// The text that the writer put under a key.
    #[must_use]
    pub fn mark(&self, key: &str) -> Option<&str> {
        let marks = self.about.metadata().file_metadata().key_value_metadata()?;
        marks.iter().find(|mark| mark.key == key)?.value.as_deref()
    }

    /// How many row groups there are.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.about.metadata().num_row_groups()
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
            return Err(TableError::Parquet(format!("no row group {group} with a column {column}")));
        }
        caught(|| self.decoded(group, column)).unwrap_or_else(|| Err(out_of_bounds()))
    }

    fn decoded(&self, group: usize, column: usize) -> Result<Values, TableError> {
        let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(self.file.try_clone()?, self.about.clone());
        // Any file may be given; what its pages state is checked before room is made for it.
        let most = self.file.len().saturating_mul(MOST_TIMES).max(ALWAYS_UNPACKED);
        check_pages(&self.file, self.about.metadata().row_group(group).column(column), most)?;
        let mask = ProjectionMask::leaves(builder.parquet_schema(), [column]);
        let mut values = Values::empty(self.fields[column].kind);
        for batch in builder.with_row_groups(vec![group]).with_projection(mask).build()? {
            values.extend(batch.map_err(ParquetError::from)?.column(0));
        }
        Ok(values)
    }
}

/// The reader of the format takes some places in a file at their word and then panics.
fn out_of_bounds() -> TableError {
    TableError::Parquet("file offsets that are out of bounds".to_owned())
}

impl From<PageProblem> for TableError {
    fn from(problem: PageProblem) -> Self {
        match problem {
            PageProblem::Beyond => Self::Parquet(format!("a page unpacks to more than {MOST_TIMES} times the file")),
            PageProblem::Damaged { at, expected, found } => {
                Self::Parquet(format!("page at byte {at}: expected {expected}, found {found}"))
            }
            PageProblem::Unread(error) => error.into(),
        }
    }
}
