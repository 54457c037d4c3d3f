//! A hold as it goes on: its readings in at most 64 means, the law fitted to them, and when its force has fallen to that of slip.

mod bins;
mod fit;
mod forecast;

pub(super) use bins::Bins;
pub(super) use fit::{FEWEST, HoldFit};
pub(super) use forecast::Crossing;
