//! Workbooks of spreadsheet programs: `.xlsx` and `.xls`, one test a sheet, or several side by side or one below the other.
//!
//! They are read by `calamine`, which believes what a file says of itself. What it may not believe is checked before.
//!
//! | file | what |
//! |---|---|
//! | `part.rs` | a workbook as a file that holds several tests |
//! | `book.rs` | what a workbook of any make can do |
//! | `cell.rs`, `moment.rs` | cells, their places, dates |
//! | `sample.rs` | the beginning of a sheet |
//! | `table.rs` | finding the tables in it |
//! | `stacked.rs` | tables one below the other |
//! | `keyed.rs` | tests that a column of a table tells apart |
//! | `read.rs` | reading chosen columns of a table |
//! | `gathered.rs` | the cells of several tables of one sheet |
//! | `xlsx/` | workbooks of Office Open XML |
//! | `xls/` | workbooks of Excel 97 to 2003 |

mod book;
mod cell;
mod gathered;
mod keyed;
mod moment;
mod part;
mod read;
mod sample;
mod stacked;
mod table;
mod xls;
mod xlsx;

pub(crate) use part::{Make, look_into, recognise};
