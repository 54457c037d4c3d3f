//! From a file to a record: which column holds what, in which unit.
//!
//! | file | what |
//! |---|---|
//! | `parts.rs` | which parts of a file are tests ([`tests`]) |
//! | `read.rs` | reads a record ([`read_record`]) |
//! | `signals.rs` | which column becomes the force, the displacement and the time |
//! | `choose.rs`, `chooser.rs`, `choose_units.rs` | chooses the columns and their units, from a description or by the header |
//! | `conversion.rs`, `rate.rs` | strain, stress, torque and curves of a material made force and displacement; rows made time |
//! | `flow.rs` | flow curves, which are no tests |
//! | `column_use.rs`, `named.rs` | a column that was chosen, and one as messages name it |
//! | `position.rs` | where in a map a curve was measured ([`MapPosition`]) |
//! | `describe.rs`, `describe_body.rs` | a first description of a test ([`describe`]) |
//! | `error.rs`, `snippet.rs`, `lever.rs` | what is not clear, and the lines of a description that would clear it up |

mod choose;
mod choose_units;
mod chooser;
mod column_use;
mod conversion;
mod describe;
mod describe_body;
mod error;
mod flow;
mod lever;
mod named;
mod parts;
mod position;
mod rate;
mod read;
mod signals;
mod snippet;

pub use column_use::{ColumnUse, Role};
pub use describe::{describe, describe_all};
pub use error::{ColumnError, Counted, ReadError, UnitProblem};
pub use named::NamedColumn;
pub use parts::{Tests, tests};
pub use position::MapPosition;
pub use read::{RecordFile, read_part, read_record};
