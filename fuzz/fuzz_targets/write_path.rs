//! No name of an output makes its writer panic, leave something half written, or write elsewhere.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/palpate-jobs/tests/any_path/mod.rs"]
mod any_path;

fuzz_target!(|bytes: &[u8]| any_path::write_any(bytes));
