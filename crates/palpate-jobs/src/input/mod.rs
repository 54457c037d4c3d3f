//! Where records come from: each file is opened and hashed once.
//!
//! In: the names that a front end was given. Out: a [`Measurement`], which the jobs take; records that are in memory already become one
//! without a file.
//!
//! | file | what |
//! |---|---|
//! | `source.rs` | a file as it is named ([`NamedFile`]), its bytes and their digest |
//! | `described.rs` | the description of a test |
//! | `opened.rs` | a file of records that was looked into ([`OpenedFile`]) |
//! | `named.rs` | the files that were named: one by one, by a folder, by a pattern ([`NamedRecords`]) |

mod described;
mod named;
mod opened;
mod source;

pub use described::Described;
pub use named::{NamedRecords, Part};
pub(crate) use opened::averaged;
pub use opened::{Measurement, OpenedFile, called, record_sha256};
pub(crate) use source::Source;
pub use source::{Fetch, NamedFile};
