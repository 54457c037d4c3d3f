//! File formats of palpate: from bytes on a disk to columns of numbers with names and units, to records and
//! to descriptions of tests.
//!
//! A module uses only modules that stand above it in this table.
//!
//! | module | what |
//! |---|---|
//! | [`cell`] | the text of one cell: numbers, dates, decimal marks, names with units |
//! | [`message_log`] | messages of ROS 2, written as a log in MCAP |
//! | [`naming`] | what names and units of columns stand for, in the languages of headers |
//! | `error` | what can be wrong with a file, and what would help ([`FileError`]) |
//! | [`input`] | where bytes come from: a disk or memory, as they are or unpacked; their lines |
//! | [`table`] | columns with names and units, parts, header, blocks of rows: what every format gives |
//! | [`formats`] | bytes to tables, one folder a format; none knows another |
//! | [`description`] | what people write in TOML: tests, protocols, materials and sweeps, as types of the library |
//! | [`open`] | a path or bytes to the format that it is ([`open::Contents`]) |
//! | [`record`] | columns and a description joined to a checked record in SI ([`record::read_record`]) |
//! | [`parquet_table`] | tables of many rows, written as Parquet and read back |

/// Shows types as they are written in a file.
macro_rules! shown_as_written {
    ($(#[$about:meta])* $name:ty) => {
        $(#[$about])*
        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                serde::Serialize::serialize(self, f)
            }
        }
    };
}

pub mod cell;
pub mod description;
mod error;
#[doc(hidden)]
pub mod faults;
pub mod formats;
pub mod input;
pub mod message_log;
pub mod naming;
pub mod open;
pub mod parquet_table;
pub mod record;
pub mod table;

pub use crate::error::{CellPosition, DecimalDoubt, FileError, FileProblem, Foreign, is_unprintable};
