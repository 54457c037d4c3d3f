//! Measured records, what they are analysed to, and the laws compared on their holds.

pub(crate) mod analysis;
mod columns;
pub(crate) mod compare;
pub(crate) mod forecast;
mod hold_fit;
pub(crate) mod kept;
mod keywords;
pub(crate) mod read;
pub(crate) mod record;
mod record_of;
pub(crate) mod several;
