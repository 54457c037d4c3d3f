//! Bytes to tables, one folder a format; none knows another.
//!
//! A format tells a file by its content, looks into it for tests, and reads their columns.
//!
//! | folder | what |
//! |---|---|
//! | `text/` | delimited text, as machines and scripts write it |
//! | `spreadsheet/` | workbooks (`.xlsx`, `.xls`) |
//! | `arrow/` | Parquet and Arrow |
//! | `afm/` | force curves of atomic force microscopes |
//! | `arrays/` | files of named arrays (`.mat`) |
//! | `robot_log/` | logs of robots (MCAP), whose topics have clocks of their own |

pub(crate) mod afm;
pub(crate) mod arrays;
pub(crate) mod arrow;
pub(crate) mod robot_log;
pub(crate) mod spreadsheet;
pub mod text;
