//! Parquet and Arrow (IPC files, streams, Feather version 2): tables of typed columns.
//!
//! A file holds one test, or several one below the other where a column such as `test_id` tells them apart.
//!
//! | file | what |
//! |---|---|
//! | `part.rs` | a file as one test or several, and reading their columns |
//! | `tests.rs` | which rows belong to which test |
//! | `batches.rs` | how batches of rows are written, and who looks at them |
//! | `source.rs` | batches of rows, whatever the format |
//! | `parquet.rs` | batches of a Parquet file |
//! | `pages.rs` | what the pages of a Parquet file say they unpack to |
//! | `ipc.rs` | batches of an Arrow file or stream |
//! | `values.rs` | columns of a type as numbers or texts |

mod batches;
mod ipc;
mod pages;
mod parquet;
mod part;
mod source;
mod tests;
mod values;

pub(crate) use batches::Kind;
pub(crate) use part::{look_into, recognise};
