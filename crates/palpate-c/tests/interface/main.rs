//! The C interface: the steps of the library to the last bit, refusals by code, no allocation, the header, and all of it from C.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]
#![allow(
    clippy::multiple_unsafe_ops_per_block,
    clippy::undocumented_unsafe_blocks,
    reason = "all blocks pass pointers to values of their test, or null"
)]

mod common;
mod from_c;
mod header;
mod many;
mod no_allocation;
mod refusals;
mod steps;
