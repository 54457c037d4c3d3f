//! No damage to a state or a result makes one that is read panic.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/palpate/tests/any_state/mod.rs"]
mod any_state;
#[allow(dead_code, reason = "tests use the rest of it")]
#[path = "../../crates/palpate-files/tests/budget/mod.rs"]
mod budget;

fuzz_target!(|bytes: &[u8]| budget::bounded(bytes.len(), || any_state::answer_any(bytes)));
