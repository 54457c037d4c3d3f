//! A material file: a calibrated body as a protocol has it, with how sure its parameters are.
//!
//! Its tables `[specimen]`, `[law]` and `[contact]` are those of a protocol, so that whatever takes a body takes a material; the table
//! `[calibration]` holds the same parameters with their errors, and where they come from.
//!
//! | file | what |
//! |---|---|
//! | `tables.rs` | the tables as they stand |
//! | `file.rs` | a material with where it comes from ([`MaterialFile`]) |
//! | `convert.rs` | the one to the other |
//! | `write.rs` | a material as the text of its file |

mod convert;
mod file;
pub(super) mod tables;
mod write;

pub use convert::{parse_material, read_material};
pub use file::{MATERIAL_VERSION, MaterialFile, MaterialOrigin};
