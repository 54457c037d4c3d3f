//! Faults that tests have the operating system make: what an operation on a file may meet, one at a time.
//!
//! Nothing is replaced: every operation is done as always, after it was announced here. Without a hook an announcement is one load.

use std::{
    io,
    sync::{
        RwLock,
        atomic::{AtomicBool, Ordering},
    },
};

/// What is about to be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A folder is made.
    MakeFolder,
    /// A new file is made.
    Create,
    /// Bytes are written.
    Write,
    /// A file or a folder is synced to the disk.
    Sync,
    /// A file is renamed.
    Rename,
    /// A file or a folder is removed.
    Remove,
    /// A size that the input states is compared with its limit.
    Admit,
}

/// Hears of operations before they are done, and may let them fail.
pub trait Hook: Send + Sync {
    /// Hears of one.
    ///
    /// # Errors
    /// The fault that it meets instead of being done.
    fn before(&self, operation: Operation) -> io::Result<()>;
}

static IS_SET: AtomicBool = AtomicBool::new(false);
static HOOK: RwLock<Option<Box<dyn Hook>>> = RwLock::new(None);

/// Sets the hook of this process, or takes it away.
pub fn set(hook: Option<Box<dyn Hook>>) {
    IS_SET.store(hook.is_some(), Ordering::SeqCst);
    if let Ok(mut here) = HOOK.write() {
        *here = hook;
    }
}

/// Announces an operation.
///
/// # Errors
/// The fault that a hook has it meet.
pub fn before(operation: Operation) -> io::Result<()> {
    if !IS_SET.load(Ordering::Relaxed) {
        return Ok(());
    }
    match HOOK.read() {
        Ok(hook) => hook.as_ref().map_or(Ok(()), |hook| hook.before(operation)),
        Err(_) => Ok(()),
    }
}

/// Whether a size keeps to its limit: the one comparison for all sizes that an input states.
pub(crate) fn admits(size: u64, most: u64) -> bool {
    size <= most && before(Operation::Admit).is_ok()
}
