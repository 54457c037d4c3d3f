//! Parquet and Arrow (IPC files, streams, Feather version 2): tables of typed columns.
//!
//! Without the feature `arrow` such files are recognised by their content and refused.
//!
//! A file holds one test, or several one below the other where a column such as `test_id` tells them apart.
//!
//! | file | what |
//! |---|---|
//! | `kind.rs` | telling such files by their first bytes |
//! | `part.rs` | a file as one test or several, and reading their columns |
//! | `kept.rs` | batches that stay in memory between the reads of several tests |
//! | `tests.rs` | which rows belong to which test |
//! | `batches.rs` | who looks at batches of rows |
//! | `source.rs` | batches of rows, whatever the format |
//! | `parquet.rs` | batches of a Parquet file |
//! | `ipc.rs` | batches of an Arrow file or stream |
//! | `values.rs` | columns of a type as numbers or texts |

mod kind;

#[cfg(feature = "arrow")]
mod batches;
#[cfg(feature = "arrow")]
mod ipc;
#[cfg(feature = "arrow")]
mod kept;
#[cfg(feature = "arrow")]
mod parquet;
#[cfg(feature = "arrow")]
mod part;
#[cfg(feature = "arrow")]
mod source;
#[cfg(feature = "arrow")]
mod tests;
#[cfg(feature = "arrow")]
mod values;

pub(crate) use kind::{Kind, recognise};
#[cfg(feature = "arrow")]
pub(crate) use part::look_into;

/// Says which build would read it.
#[cfg(not(feature = "arrow"))]
pub(crate) fn look_into(
    input: &crate::input::Input,
    _options: &crate::table::ReadOptions,
) -> Result<crate::table::Found, crate::FileError> {
    Err(input.not_in_this_build(
        "a build that reads Parquet and Arrow",
        "build palpate with the feature `arrow`, which is enabled by default",
    ))
}
