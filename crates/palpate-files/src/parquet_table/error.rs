//! What can go wrong with a table.

use std::io;

#[cfg(feature = "arrow")]
use parquet::errors::ParquetError;

/// Why a table cannot be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// The operating system refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// This build has no Parquet.
    #[cfg(not(feature = "arrow"))]
    #[error("expected a build with Parquet, found one without the feature `arrow`")]
    NotInThisBuild,
    /// The file is no Parquet, or a damaged one; what the reader says.
    #[error("expected a complete Parquet file ({0})")]
    Parquet(String),
    /// A column of this name that palpate does not write.
    #[error("expected columns of whole numbers, numbers or texts, found {0} of another kind")]
    Foreign(String),
    /// Rows that do not belong to the table.
    #[error("expected rows of the columns of the table, found others")]
    OtherColumns,
}

#[cfg(feature = "arrow")]
impl From<ParquetError> for TableError {
    fn from(error: ParquetError) -> Self {
        match error {
            // An error of the disk comes wrapped, and its kind says what would help.
            ParquetError::External(source) => match source.downcast::<io::Error>() {
                Ok(error) => Self::Io(*error),
                Err(source) => Self::Parquet(source.to_string()),
            },
            error => Self::Parquet(error.to_string()),
        }
    }
}
