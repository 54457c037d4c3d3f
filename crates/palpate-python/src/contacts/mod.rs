//! Contacts that are simulated: a protocol, one with many numbers, a sweep to a file, step by step.

pub(crate) mod contact_state;
mod described;
mod protocol;
pub(crate) mod simulate;
pub(crate) mod simulate_many;
pub(crate) mod sweep;
