//! Calibrated bodies: what they predict, and how to grip them.

pub(crate) mod calibration;
pub(crate) mod grip;
pub(crate) mod grip_parts;
pub(crate) mod material;
pub(crate) mod prediction;
