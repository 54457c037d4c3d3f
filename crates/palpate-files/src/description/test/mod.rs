//! A test: what its record holds, what body was tested, and how to evaluate it.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs`, `column_tables.rs` | the tables as they stand |
//! | `description.rs` | a checked description ([`TestDescription`]) |
//! | `convert.rs` | the one to the other |
//! | `columns.rs` | which column of a file holds what ([`ColumnChoices`]) |
//! | `instrument.rs` | the uncertainty of instrument and body |
//! | `conditions.rs` | temperature, conditioning and the like; times at which relaxation is stated |
//! | `corrections.rs`, `settings.rs` | corrections of the record; settings of phases and fit |
//! | `choices.rs`, `named_columns.rs` | choices that a command line offers too |
//! | `preset.rs`, `machines/`, `machines.rs` | grippers and machines whose conventions are known, and telling them by a file |

mod choices;
mod column_tables;
mod columns;
mod conditions;
mod convert;
mod corrections;
mod description;
mod instrument;
mod machines;
mod named_columns;
mod preset;
mod settings;
pub(super) mod tables;

pub use choices::{ChoiceError, parse_hold_start, parse_touch};
pub use columns::{ClockChoice, ColumnChoice, ColumnChoices};
pub use convert::{parse_test, read_test};
pub use description::{About, TestDescription, Torsion};
pub(crate) use machines::contradicts;
pub use machines::machines_of;
pub use named_columns::NamedColumns;
pub use preset::{Machine, machines};
