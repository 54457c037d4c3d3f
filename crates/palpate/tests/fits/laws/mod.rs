//! What laws take, how they meet in their limits, and which of them is chosen.

mod bounds;
mod choosing;
mod forecasts;
mod inputs;
mod limits;
mod options;
mod outside;
mod prony_terms;
mod spectrum;
