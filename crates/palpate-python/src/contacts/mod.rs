//! Contacts that are simulated: a protocol, one with many numbers, a sweep to a file, step by step.

mod columns;
pub(crate) mod contact_state;
pub(crate) mod contact_states;
mod described;
pub(crate) mod numbers;
mod protocol;
pub(crate) mod simulate;
pub(crate) mod simulate_many;
mod states_made;
mod states_memory;
pub(crate) mod sweep;
