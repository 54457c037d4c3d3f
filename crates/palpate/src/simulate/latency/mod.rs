//! The contact layer by the latency law: its rate coefficient one number (`constant.rs`), or a function of strain or direction
//! (`varying.rs`).

mod constant;
mod varying;

pub(super) use varying::Varying;
