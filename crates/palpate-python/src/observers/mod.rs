//! Contacts watched tick by tick.

pub(crate) mod observation;
pub(crate) mod observer;
