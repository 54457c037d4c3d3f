//! Versions of the interface and of the library.

use std::ffi::{CStr, c_char};

/// Version of this interface: another number where a function, a struct or a code has changed its meaning.
pub const PALPATE_ABI_VERSION: u32 = 1;

const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => c"",
};

/// PALPATE_ABI_VERSION of the library that is linked; that of the header must be the same.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_abi_version() -> u32 {
    PALPATE_ABI_VERSION
}

/// Version of palpate, such as "0.1.0", in static memory.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_version() -> *const c_char {
    VERSION.as_ptr()
}
