//! The text of one cell, and of a row of them.
//!
//! Texts of a file come in, numbers and words go out; nothing here knows where a cell stands.
//!
//! | file | what |
//! |---|---|
//! | `mark.rs` | the characters between cells and inside numbers ([`Delimiter`], [`DecimalMark`]) |
//! | `fields.rs` | a line cut into cells |
//! | `number.rs` | numbers, and what a cell holds that is none |
//! | `date.rs` | dates with times of day |
//! | `unit.rs` | names with their units: `Force (N)` |

pub(crate) mod date;
mod fields;
mod mark;
pub(crate) mod number;
pub(crate) mod unit;

pub(crate) use fields::{Fields, cells};
pub use mark::{DecimalMark, Delimiter};
pub(crate) use number::Cell;
