//! No bytes, read as a law, options and columns, make a fit panic or end well with numbers that are none.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/palpate/tests/any_hold/mod.rs"]
mod any_hold;
#[allow(dead_code, reason = "tests use the rest of it")]
#[path = "../../crates/palpate-files/tests/budget/mod.rs"]
mod budget;

fuzz_target!(|bytes: &[u8]| budget::bounded(bytes.len(), || any_hold::fit_any(bytes)));
