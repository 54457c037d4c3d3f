//! Calibrated bodies: what they predict, how to grip them, and their cards for other simulators.

pub(crate) mod calibration;
pub(crate) mod card;
pub(crate) mod grip;
pub(crate) mod grip_parts;
pub(crate) mod material;
pub(crate) mod prediction;
