//! Tables as Parquet: columns of counts, numbers and texts, written row group by row group and read back.
//!
//! Only what palpate writes itself is read. Nothing is compressed: columns that repeat their values are kept as a dictionary, and
//! results differ in every digit.
//!
//! | file | what |
//! |---|---|
//! | `rows.rs` | rows in memory ([`Field`], [`Values`], [`Rows`]) |
//! | `arrays.rs` | their columns as arrays of Arrow |
//! | `write.rs` | rows to a file ([`TableWriter`]) |
//! | `read.rs` | a file to rows ([`TableReader`]) |
//! | `absent.rs` | both where the feature `arrow` is missing |
//! | `error.rs` | what can go wrong ([`TableError`]) |
//!
//! ```
//! use palpate_files::parquet_table::{Field, Kind, Rows, TableReader, TableWriter, Values};
//!
//! let fields = vec![Field::new("run", Kind::Count), Field::new("force_n", Kind::Number)];
//! let rows = Rows { columns: vec![Values::Count(vec![1, 2]), Values::Number(vec![Some(2.5), None])] };
//! let file = tempfile::tempfile()?;
//! let mut writer = TableWriter::new(file.try_clone()?, &fields)?;
//! writer.write(rows.clone())?;
//! writer.finish(&[("origin", "an example")])?;
//! let table = TableReader::new(file)?;
//! assert_eq!((table.rows(), table.mark("origin")), (2, Some("an example")));
//! assert_eq!(table.read(0)?, rows);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(not(feature = "arrow"))]
mod absent;
#[cfg(feature = "arrow")]
mod arrays;
mod error;
#[cfg(feature = "arrow")]
mod read;
mod rows;
#[cfg(feature = "arrow")]
mod write;

#[cfg(not(feature = "arrow"))]
pub use absent::{TableReader, TableWriter};
pub use error::TableError;
#[cfg(feature = "arrow")]
pub use read::TableReader;
pub use rows::{Field, Kind, Rows, Values};
#[cfg(feature = "arrow")]
pub use write::TableWriter;
