//! The law, the contact and its simulation.

#[path = "../common/mod.rs"]
mod common;
mod contact_events;
mod contact_properties;
mod creep;
mod crossval;
mod energy;
mod export;
mod linear_contact;
mod paper;
mod properties;
mod real_time_step;
mod refinement;
mod work;
