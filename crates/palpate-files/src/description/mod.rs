//! What people write in TOML, to types of the library and back: tests to evaluate, protocols to simulate, calibrated
//! materials, and sweeps.
//!
//! A quantity is a text with a unit (`"35 mm"`, `"28 kPa"`, `"500 mm/min"`); what comes out is checked and in SI.
//! Nothing is passed over: an unknown key, a missing unit or a size that no body has is a [`DescriptionError`]
//! that names the file, the line, the key and what would be accepted. A folder uses only folders above it in this table;
//! `tables.rs` of a folder is what stands in the file, `convert.rs` makes types of the library of it.
//!
//! | folder | what |
//! |---|---|
//! | `text/` | a description as it is written: quantities, places, what is wrong in plain words |
//! | `uncertainty.rs` | names of distributions and of evaluations |
//! | `body/` | the tables of a body and its contact, and the contact that they make |
//! | `test/` | a test: its record, its body, how to evaluate it ([`TestDescription`]); known machines ([`machines`]) |
//! | `material/` | a calibrated body with its intervals ([`MaterialFile`]), read and written |
//! | `protocol/` | a protocol: body, law and steps of the jaw ([`Protocol`]) |
//! | `edit.rs` | changes to the text of a description ([`edit_test`]) |
//! | `sweep/` | numbers of a protocol replaced by many ([`Sweep`]) |
//! | `schema.rs` | JSON Schemas for editors |

mod body;
mod edit;
mod material;
mod protocol;
mod schema;
mod sweep;
mod test;
mod text;
mod uncertainty;

pub use body::{ShapeAbout, shapes};
pub use edit::{Edit, edit_test};
pub use material::{MATERIAL_VERSION, MaterialFile, MaterialOrigin, parse_material, read_material};
pub use protocol::{
    Protocol, law_named, parse_protocol, parse_protocol_of, parse_scene, read_protocol, read_protocol_of,
    read_protocol_text, read_scene, self_contained,
};
pub use schema::{schema_material, schema_protocol, schema_test};
pub use sweep::{Plan, Spacing, Sweep, SweptParameter, parse_runs, parse_sweep, read_sweep};
pub(crate) use test::contradicts;
pub use test::{
    About, ChoiceError, ClockChoice, ColumnChoice, ColumnChoices, Machine, NamedColumns, TestDescription, Torsion,
    machines, machines_of, parse_hold_start, parse_test, parse_touch, read_test,
};
pub(crate) use text::quoted;
pub use text::{DescriptionError, DescriptionKind, KeyPosition, KeyProblem, read_text};
