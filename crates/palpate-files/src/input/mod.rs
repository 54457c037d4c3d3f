//! Where the bytes of a file come from: a disk or memory, as they are or unpacked; and the lines in them.
//!
//! A file that is packed by gzip, or in a zip archive, is read as if it were unpacked. Packed bytes are
//! unpacked as they are needed, and never beyond a stated limit, so that a small file cannot fill a memory.
//!
//! | file | what |
//! |---|---|
//! | `source.rs` | bytes under a name for messages ([`Input`]) |
//! | `regular.rs` | the one way in: regular files, up to a limit |
//! | `packing.rs` | telling packed files by their content, and unpacking them |
//! | `counting.rs` | how far a reader has got |
//! | `idle.rs` | bytes of a packed file that hold nothing |
//! | `binary.rs` | numbers as bytes |
//! | `contained.rs` | readers of other crates that panic on damaged files |
//! | `hdf5.rs` | the groups and datasets of an HDF5 file |
//! | `parquet_pages.rs` | what the pages of a Parquet file state |
//! | `encoding.rs` | bytes as letters ([`Encoding`]) |
//! | `feed.rs`, `lines.rs` | a file line by line, in UTF-8 |

mod binary;
mod contained;
mod counting;
pub(crate) mod encoding;
mod feed;
#[cfg(feature = "hdf5")]
mod hdf5;
mod idle;
pub(crate) mod lines;
mod packing;
#[cfg(feature = "arrow")]
mod parquet_pages;
mod regular;
mod source;

pub(crate) use binary::Number;
#[cfg(feature = "arrow")]
pub(crate) use contained::caught;
pub(crate) use contained::contained;
pub use encoding::Encoding;
#[cfg(feature = "hdf5")]
pub(crate) use hdf5::{Content, Hdf5, HeldInGroup};
pub use idle::IDLE_A_ROW;
pub(crate) use idle::Idle;
pub(crate) use lines::{Excerpt, LONGEST_LINE, LineReader};
pub use packing::{MOST_UNPACKED, Member, Packing};
pub(crate) use packing::{is_hdf5, is_zip};
#[cfg(feature = "arrow")]
pub(crate) use parquet_pages::{PageProblem, check_pages};
pub use regular::{is_standard_input, kind, read_whole};
#[cfg(feature = "arrow")]
pub(crate) use source::InputReader;
pub(crate) use source::Seekable;
pub use source::{ALWAYS_UNPACKED, Input, MOST_IN_MEMORY, MOST_TIMES};
