//! How much work a simulation takes, and what its summary says of it.

mod counters;
mod simulation;
mod summary;
