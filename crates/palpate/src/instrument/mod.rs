//! The uncertainty of the instrument and of the body: what the scatter of the samples does not show.
//!
//! | file | what |
//! |---|---|
//! | `quantity.rs` | the quantities whose uncertainty may be stated |
//! | `deviation.rs` | a record and a body with one of them off its estimate |

mod deviation;
mod quantity;

pub(crate) use deviation::Deviation;
pub use quantity::{Instrument, InstrumentInput, InstrumentQuantity};
