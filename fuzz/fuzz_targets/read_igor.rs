//! No bytes make the reader of Igor waves panic, hang, fill the memory, or break its promises.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, unused_imports, reason = "every target uses a part of it")]
#[path = "../../crates/palpate-files/tests/any_file/mod.rs"]
mod any_file;
#[allow(dead_code, reason = "tests use the rest of it")]
#[path = "../../crates/palpate-files/tests/budget/mod.rs"]
mod budget;

fuzz_target!(|bytes: &[u8]| budget::bounded(bytes.len(), || any_file::read_any(any_file::Kind::Igor, bytes)));
