//! What no panic passes.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::Status;

/// Does the work of a call; a panic inside becomes a code.
pub(crate) fn guarded(work: impl FnOnce() -> Result<(), Status>) -> Status {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => Status::Ok,
        Ok(Err(status)) => status,
        Err(payload) => {
            // What a panic carries could panic again when it is dropped.
            std::mem::forget(payload);
            Status::Internal
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_code() {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(|_| {}));
        let status = guarded(|| panic!("a defect"));
        std::panic::set_hook(hook);
        assert_eq!(status, Status::Internal);
        assert_eq!(guarded(|| Err(Status::Force)), Status::Force);
    }
}
