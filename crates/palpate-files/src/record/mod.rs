//! From a file to a record: which column holds what, in which unit.
//!
//! | file | what |
//! |---|---|
//! | `parts.rs` | which parts of a file are tests ([`tests`]) |
//! | `read.rs` | reads a record ([`read_record`]) |
//! | `choose.rs`, `choose_units.rs` | chooses the columns and their units, from a description or by the header |
//! | `column_use.rs`, `named.rs` | a column that was chosen, and one as messages name it |
//! | `describe.rs`, `describe_body.rs` | a first description of a test ([`describe`]) |
//! | `error.rs`, `snippet.rs`, `lever.rs` | what is not clear, and the lines of a description that would clear it up |

mod choose;
mod choose_units;
mod column_use;
mod describe;
mod describe_body;
mod error;
mod lever;
mod named;
mod parts;
mod read;
mod snippet;

pub use column_use::{ColumnUse, Role};
pub use describe::{describe, describe_all};
pub use error::{ColumnError, Counted, ReadError, UnitProblem};
pub use named::NamedColumn;
pub use parts::{Tests, tests};
pub use read::{RecordFile, read_part, read_record};
