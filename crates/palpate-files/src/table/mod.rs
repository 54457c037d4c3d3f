//! Columns with names and units, parts, header, blocks of rows: what every format gives, whatever it is.
//!
//! A format looks into a file and tells its tests ([`Part`]s) with their columns; chosen columns of one of them are then
//! read as `f64`, as they are written ([`Columns`]). Units and signs are matters of [`record`](crate::record).
//!
//! | file | what |
//! |---|---|
//! | `part.rs` | one test in a file: columns, named values, labels |
//! | `column_ref.rs` | a column as people name it |
//! | `columns.rs` | columns of numbers as they were read, in bounded memory |
//! | `footer.rs`, `lacking.rs` | lines behind the data; rows that lack a number |
//! | `layout.rs` | how a text is written |
//! | `keyed.rs` | tests that a column tells apart |
//! | `reader.rs` | what every format can do, and what a caller may fix in advance |
//! | `block.rs`, `decimal.rs` | the rows of numbers among other lines, and their decimal mark |
//! | `stacked.rs` | tables one below the other |
//! | `header.rs`, `metadata.rs`, `stated.rs` | names and units above them, named values, and units that lines state |
//! | `recognise.rs`, `epoch.rs` | which column holds a quantity; times counted from 1970 |

pub(crate) mod block;
mod column_ref;
mod columns;
pub(crate) mod decimal;
pub(crate) mod epoch;
mod footer;
pub(crate) mod header;
mod keyed;
mod lacking;
mod layout;
pub(crate) mod metadata;
mod part;
mod reader;
pub(crate) mod recognise;
mod stacked;
mod stated;

pub(crate) use block::Block;
pub use column_ref::ColumnRef;
pub use columns::{Columns, Footer, IgnoredLines, LackingRows, MOST_ROWS};
pub(crate) use decimal::Doubt;
pub(crate) use epoch::EPOCH;
pub(crate) use footer::Suspect;
pub(crate) use header::Header;
pub(crate) use keyed::{Key, KeyedTest, KeyedTests, titled};
pub(crate) use lacking::Lacking;
pub use layout::{Day, Layout};
pub(crate) use part::EXACT_DIGITS;
pub use part::{Clock, ColumnInfo, ColumnKind, Label, Metadata, Part, SkippedPart};
pub(crate) use reader::{Found, ReadPart, not_finite, share};
pub use reader::{Heard, ReadOptions};
pub(crate) use recognise::{candidates, names_time};
pub(crate) use stacked::{MOST_RESULTS, RowKind, Starts};
