//! Pointers of the caller, checked for null.

use super::Status;

/// What a pointer points to.
///
/// # Safety
/// Null, or valid for reading for as long as the result lives, and written by nothing meanwhile.
pub(crate) unsafe fn shared<'a, T>(pointer: *const T) -> Result<&'a T, Status> {
    // SAFETY: null or valid, by the contract of this function.
    unsafe { pointer.as_ref() }.ok_or(Status::NullPointer)
}

/// What a pointer points to, to be changed.
///
/// # Safety
/// Null, or valid for reading and writing for as long as the result lives, and used by nothing else meanwhile.
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T) -> Result<&'a mut T, Status> {
    // SAFETY: null or valid, by the contract of this function.
    unsafe { pointer.as_mut() }.ok_or(Status::NullPointer)
}

/// Writes a result that the caller need not want.
///
/// # Safety
/// Null, or valid for writing.
pub(crate) unsafe fn write<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: not null, and valid by the contract of this function.
        unsafe { pointer.write(value) };
    }
}
