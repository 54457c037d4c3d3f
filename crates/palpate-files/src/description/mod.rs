//! Descriptions that people write in TOML: protocols to simulate, and tests to evaluate.
//!
//! A quantity is a text with a unit (`"35 mm"`, `"28 kPa"`, `"500 mm/min"`); what comes out is checked and in SI.
//! Nothing is passed over: an unknown key, a missing unit or a size that no body has is a [`DescriptionError`]
//! that names the file, the line, the key and what would be accepted.
//!
//! | file | what |
//! |---|---|
//! | `protocol.rs` | a protocol: body, law and steps of the jaw ([`Protocol`]) |
//! | `test.rs`, `test_tables.rs`, `settings.rs` | a test: its record, its body, how to evaluate it ([`TestDescription`]) |
//! | `machine.rs`, `machines/` | grippers and machines whose conventions are known ([`machines`]) |
//! | `material.rs` | a calibrated body with its intervals ([`MaterialFile`]) |
//! | `law.rs` | the law of a protocol, with its body a [`Model`] |
//! | `specimen.rs`, `contact.rs`, `columns.rs`, `column_tables.rs`, `corrections.rs` | tables that they are made of |
//! | `choices.rs` | choices that a command line offers too |
//! | `sweep/` | numbers of a protocol replaced by many ([`Sweep`]) |
//! | `numbers.rs` | the numbers of a protocol that can be replaced |
//! | `quantity.rs` | a quantity as written |
//! | `source.rs`, `places.rs`, `words.rs`, `error.rs` | what is wrong, where, and in plain words |
//! | `schema.rs` | JSON Schemas for editors |

mod choices;
mod column_tables;
mod columns;
mod contact;
mod corrections;
mod error;
mod file;
mod law;
mod machine;
mod material;
mod numbers;
mod places;
mod protocol;
mod quantity;
mod schema;
mod settings;
mod source;
mod specimen;
mod sweep;
mod test;
mod test_tables;
mod words;

pub use choices::{ChoiceError, parse_hold_start, parse_touch};
pub use columns::{ClockChoice, ColumnChoice, ColumnChoices, ColumnRef};
pub use error::{DescriptionError, KeyPlace};
pub use law::Model;
pub(crate) use machine::contradicts;
pub use machine::{Machine, machines, machines_of};
pub use material::{MATERIAL_VERSION, MaterialFile, MaterialOrigin, parse_material, read_material};
pub use protocol::{
    Protocol, parse_protocol, parse_protocol_of, parse_scene, read_protocol, read_protocol_of, read_scene,
    self_contained,
};
pub use schema::{schema_material, schema_protocol, schema_test};
pub use sweep::{Plan, Spacing, Sweep, SweptNumber, parse_runs, parse_sweep, read_sweep};
pub use test::{About, TestDescription, parse_test, read_test};
