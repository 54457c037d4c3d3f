//! Readers of other crates that panic on damaged files.

use std::{
    cell::Cell,
    panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook},
    sync::Once,
};

use super::source::Input;
use crate::error::FileError;

thread_local! {
    /// Whether a panic of this thread is caught and reported as damage, so that nothing else need be stated of it.
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

static SILENCE: Once = Once::new();

/// What `read` gives. The readers of some formats take some counts in a file at their word and then panic: such a file
/// is damaged.
pub(crate) fn contained<T>(input: &Input, read: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    let torn = || input.damaged("the file", "what the format has there", "numbers out of bounds");
    caught(read).unwrap_or_else(|| Err(torn()))
}

/// What `read` gives, if it does not panic.
pub(crate) fn caught<T>(read: impl FnOnce() -> T) -> Option<T> {
    SILENCE.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !CAUGHT.try_with(Cell::get).unwrap_or(false) {
                before(panic);
            }
        }));
    });
    let outside = CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(read));
    CAUGHT.set(outside);
    result.ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_damage_and_what_comes_after_is_none() {
        let input = Input::from_bytes("book", [0_u8; 4]).expect("bytes");
        let torn = contained(&input, || -> Result<(), _> { contained(&input, || panic!("torn")) });
        let text = torn.expect_err("damage").to_string();
        assert_eq!(text, "book: the file: expected what the format has there, found numbers out of bounds");
        assert!(!CAUGHT.get());
        assert_eq!(contained(&input, || Ok(7)).ok(), Some(7));
    }
}
