//! File formats of palpate: from bytes on a disk to columns of numbers with names and units, to records and
//! to descriptions of tests.
//!
//! - [`input`] is where bytes come from: a disk or memory, as they are or unpacked.
//! - [`contents`] looks into a file of any format and reads columns of the tests in it ([`contents::Contents`]).
//! - [`text`] reads delimited text: it finds out how a file is written ([`text::detect`]) and streams chosen
//!   columns out of it ([`text::read_columns`]).
//! - Force curves of atomic force microscopes are read by a module of their own, through [`contents`].
//! - `robot_log` reads logs of robots (MCAP), whose topics have clocks of their own.
//! - [`description`] reads what people write in TOML: protocols to simulate ([`description::read_protocol`])
//!   and tests to evaluate ([`description::read_test`]).
//! - [`parquet_table`] writes tables of many rows as Parquet and reads them back.
//! - [`record_file`] puts text and descriptions together: a file becomes a checked record in SI ([`record_file::read_record`]).

mod afm;
mod arrow_file;
pub mod contents;
pub mod description;
mod error;
mod hint;
pub mod input;
pub mod parquet_table;
pub mod record_file;
mod robot_log;
mod shown;
mod spreadsheet;
pub mod text;

pub use error::{CellPlace, DecimalDoubt, FileError};
