//! Contacts that are simulated: a protocol, one with many numbers, step by step.

pub(crate) mod contact_state;
mod described;
pub(crate) mod simulate;
pub(crate) mod simulate_many;
