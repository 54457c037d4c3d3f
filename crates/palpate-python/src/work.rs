//! Long work beside the interpreter: without the GIL, ended by Ctrl-C, and no panic crosses.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::PyTypeInfo;
use pyo3::prelude::*;
use serde::Serialize;

use crate::errors::{PalpateError, refused, refused_plainly};

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(50);

/// What makes an object again: a function and its arguments.
pub(crate) type Made<'py, T> = (Bound<'py, PyAny>, T);

/// What makes an object again from its parts as JSON: `_from_json` of its class.
pub(crate) fn made_again<'py, T: PyTypeInfo>(
    py: Python<'py>,
    parts: &impl Serialize,
) -> PyResult<Made<'py, (String,)>> {
    let json = serde_json::to_string(parts).map_err(refused_plainly::<PalpateError>)?;
    Ok((py.get_type::<T>().getattr("_from_json")?, (json,)))
}

/// How much of some work is done, for those who wait for it.
#[derive(Clone, Default)]
pub(crate) struct Progress {
    done: Arc<AtomicU64>,
    /// Called with how much is done, or nobody.
    tell: Option<Arc<Py<PyAny>>>,
}

impl Progress {
    /// Tells a callable of Python, or nobody.
    pub(crate) fn of(tell: Option<Py<PyAny>>) -> Self {
        Self {
            done: Arc::default(),
            tell: tell.map(Arc::new),
        }
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn look(&self, py: Python<'_>) -> PyResult<()> {
        match &self.tell {
            Some(tell) => tell.call1(py, (self.done.load(Ordering::Relaxed),)).map(drop),
            None => Ok(()),
        }
    }
}

fn broken(panic: &(dyn std::any::Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    refused::<PalpateError>(
        format!("palpate made a mistake of its own: {text}"),
        Some("please report it with the data"),
    )
}

/// Does work of microseconds to milliseconds without the GIL.
pub(crate) fn briefly<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| broken(panic.as_ref()))
}

/// Does work of seconds on a thread of its own; Ctrl-C leaves it alone and returns.
pub(crate) fn at_length<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    at_length_told(py, &Progress::default(), work)
}

/// Likewise, and tells how much is done.
pub(crate) fn at_length_told<T: Send + 'static>(
    py: Python<'_>,
    progress: &Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
    });
    let mut receiver = receiver;
    loop {
        let (back, waited) = py.detach(move || {
            let waited = receiver.recv_timeout(LOOK);
            (receiver, waited)
        });
        receiver = back;
        match waited {
            Ok(done) => {
                progress.look(py)?;
                return done.map_err(|panic| broken(panic.as_ref()));
            }
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals()?;
                progress.look(py)?;
            }
            Err(RecvTimeoutError::Disconnected) => return Err(broken(&"the work ended without a result")),
        }
    }
}
