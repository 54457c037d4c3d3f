//! A signal tick by tick: its noise, what it is without most of that, and whether it stands still.

mod alone;
mod correlation;
mod noise;
mod smooth;
mod stand;

pub(super) use alone::Alone;
pub(super) use correlation::Correlation;
pub(super) use noise::NoiseMeter;
pub(super) use smooth::Smooth;
pub(super) use stand::{Change, Stand};
