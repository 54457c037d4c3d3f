//! Soft contact that remembers.
pub mod analysis;
pub mod contact;
pub mod identify;
pub mod latency;
mod ode;
pub mod record;
pub mod segment;
pub mod simulate;
mod statistics;
pub mod strain;
pub mod test_problems;
pub mod units;
