//! No bytes make the reader of text of afmformats panic, hang, fill the memory, or break its promises.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[allow(dead_code, unused_imports, reason = "every target uses a part of it")]
#[path = "../../crates/palpate-files/tests/any_file/mod.rs"]
mod any_file;

fuzz_target!(|bytes: &[u8]| any_file::read_any(any_file::Kind::AfmTab, bytes));
