//! No text is a description that makes its reader panic, hang, or fill the memory.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, unused_imports, reason = "every target uses a part of it")]
#[path = "../../crates/palpate-files/tests/any_file/mod.rs"]
mod any_file;

fuzz_target!(|bytes: &[u8]| any_file::describe_any(bytes));
