//! What can be wrong with a file, and what would help.
//!
//! | file | what |
//! |---|---|
//! | `file_error.rs` | a file and what is wrong with it ([`FileError`]), one variant a cause ([`FileProblem`]) |
//! | `hint.rs` | what would help |
//! | `foreign.rs` | files that hold no record in any format known here ([`Foreign`]) |
//! | `shown.rs` | words out of a file, fit to be shown to people |

mod file_error;
mod foreign;
mod hint;
mod shown;

pub(crate) use file_error::shorten;
pub use file_error::{CellPosition, DecimalDoubt, FileError, FileProblem};
pub use foreign::Foreign;
pub(crate) use foreign::{mostly_control, recognise_foreign};
pub(crate) use hint::hint_of_text;
pub use shown::is_unprintable;
pub(crate) use shown::{few, is_plain, plain, shown};
