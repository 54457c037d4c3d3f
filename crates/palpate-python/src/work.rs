//! Long work beside the interpreter: without the GIL, ended by Ctrl-C, and no panic crosses.

use std::any::Any;
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use palpate::watch::{Cancelled, Progress, Watch};
use palpate_jobs::JobError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::Serialize;

use crate::errors::{PalpateError, failed, refused, refused_plainly};

/// How often signals are looked for.
const LOOK: Duration = Duration::from_millis(20);

/// How long an interrupted call waits for work that has no effect but its result: it looks up between steps, and one of them over
/// millions of samples takes longer.
const PATIENCE: Duration = Duration::from_millis(50);

/// What work does beside computing its result.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effects {
    /// Nothing: an interrupted call leaves it behind, and it ends at its next step.
    None,
    /// It writes files: an interrupted call ends after it.
    Files,
}

/// A document as plain objects.
pub(crate) fn plain<'py>(py: Python<'py>, document: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let json = serde_json::to_string(document).map_err(refused_plainly::<PalpateError>)?;
    py.import("json")?.call_method1("loads", (json,))
}

/// A document as the command prints it.
pub(crate) fn printed(document: &impl Serialize) -> PyResult<String> {
    let text = serde_json::to_string_pretty(document).map_err(refused_plainly::<PalpateError>)?;
    Ok(text + "\n")
}

/// The watch of work on a thread of its own: it says how much is done, and hears whether it is to end.
#[derive(Clone, Default)]
pub(crate) struct Heard {
    done: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
}

impl Heard {
    /// Whether it goes on.
    pub(crate) fn look(&self) -> Result<(), Cancelled> {
        if self.stop.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// One more is done.
    pub(crate) fn step(&self) -> Result<(), Cancelled> {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.look()
    }
}

impl Watch for Heard {
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled> {
        self.done.store(progress.done, Ordering::Relaxed);
        self.look()
    }
}

fn broken(panic: &(dyn Any + Send)) -> PyErr {
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

/// Computes for seconds on a thread of its own; Ctrl-C ends it.
pub(crate) fn at_length<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Heard) -> T + Send + 'static,
) -> PyResult<T> {
    on_a_thread(py, Effects::None, None, work)
}

/// Computes and writes files on a thread of its own; Ctrl-C ends it, and nothing is written behind the back of the caller.
pub(crate) fn writing<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Heard) -> T + Send + 'static,
) -> PyResult<T> {
    on_a_thread(py, Effects::Files, None, work)
}

/// As [`at_length`], and calls `tell` with how much is done; an exception of it ends the work too.
pub(crate) fn at_length_reported<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Py<PyAny>>,
    work: impl FnOnce(Heard) -> T + Send + 'static,
) -> PyResult<T> {
    on_a_thread(py, Effects::None, tell, work)
}

fn on_a_thread<T: Send + 'static>(
    py: Python<'_>,
    effects: Effects,
    tell: Option<&Py<PyAny>>,
    work: impl FnOnce(Heard) -> T + Send + 'static,
) -> PyResult<T> {
    let work = Box::new(move |heard| Box::new(work(heard)) as Anything);
    let made = awaited(py, effects, tell, work)?;
    made.downcast()
        .map(|made| *made)
        .map_err(|_| broken(&"the work ended with a result of another type"))
}

/// The result of any work. The thread and the channel for it are compiled once, in place of once for each type of result.
type Anything = Box<dyn Any + Send>;

fn awaited(
    py: Python<'_>,
    effects: Effects,
    tell: Option<&Py<PyAny>>,
    work: Box<dyn FnOnce(Heard) -> Anything + Send>,
) -> PyResult<Anything> {
    let (heard, (sender, mut receiver)) = (Heard::default(), channel());
    let (stop, done) = (Arc::clone(&heard.stop), Arc::clone(&heard.done));
    let worker = thread::spawn(move || {
        // Where the call has ended before, nobody receives it.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(|| work(heard))));
    });
    // An exception ends the work before it ends the call, or soon after.
    let ended = |worker: thread::JoinHandle<()>, receiver: Receiver<thread::Result<Anything>>| {
        stop.store(true, Ordering::Relaxed);
        py.detach(move || match effects {
            Effects::None => receiver.recv_timeout(PATIENCE).map_or(Ok(()), |done| done.map(drop)),
            Effects::Files => worker.join(),
        })
        .map_err(|panic| broken(panic.as_ref()))
    };
    let look = || match tell {
        Some(tell) => tell.call1(py, (done.load(Ordering::Relaxed),)).map(drop),
        None => Ok(()),
    };
    loop {
        let (back, waited) = py.detach(move || {
            let waited = receiver.recv_timeout(LOOK);
            (receiver, waited)
        });
        receiver = back;
        match waited {
            Ok(done) => {
                // Ctrl-C in the last moment is not lost.
                py.check_signals().and_then(|()| look())?;
                return done.map_err(|panic| broken(panic.as_ref()));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(exception) = py.check_signals().and_then(|()| look()) {
                    ended(worker, receiver)?;
                    return Err(exception);
                }
            }
            Err(RecvTimeoutError::Disconnected) => return Err(broken(&"the work ended without a result")),
        }
    }
}

/// The threads of parallel work by process: one that was forked has none of its parent's, and makes its own.
static POOLS: Mutex<Vec<(u32, Arc<ThreadPool>)>> = Mutex::new(Vec::new());

/// Does `work` on all processors.
///
/// # Errors
/// Where the system gives no threads.
pub(crate) fn in_parallel<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, ThreadPoolBuildError> {
    Ok(threads()?.install(work))
}

/// The threads of this process for parallel work.
///
/// # Errors
/// Where the system gives none.
fn threads() -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
    let make = || ThreadPoolBuilder::new().build().map(Arc::new);
    // Another thread makes one; or it did when this process was forked, and never lets go here.
    let Ok(mut pools) = POOLS.try_lock() else { return make() };
    if let Some((_, threads)) = pools.iter().find(|(process, _)| *process == process::id()) {
        return Ok(Arc::clone(threads));
    }
    let threads = make()?;
    pools.push((process::id(), Arc::clone(&threads)));
    Ok(threads)
}

/// How long the threads stay awake at least when they have worked, ns.
const AWAKE: u64 = 8_000;

/// Does short work on all processors, which learns whether the threads are still awake from the last of it.
///
/// # Errors
/// Where the system gives no threads.
pub(crate) fn shortly<T>(work: impl FnOnce(&ThreadPool, bool) -> T) -> Result<T, ThreadPoolBuildError> {
    /// When the last work ended, ns since the first began.
    static ENDED: AtomicU64 = AtomicU64::new(0);
    static BEGINNING: OnceLock<Instant> = OnceLock::new();
    let now = || {
        let since = BEGINNING.get_or_init(Instant::now).elapsed();
        u64::try_from(since.as_nanos()).unwrap_or(u64::MAX)
    };
    let pool = threads()?;
    let ended = ENDED.load(Ordering::Relaxed);
    let result = work(&pool, ended != 0 && now().saturating_sub(ended) < AWAKE);
    ENDED.store(now().max(1), Ordering::Relaxed);
    Ok(result)
}

/// Runs a job that writes no file; Ctrl-C ends it.
pub(crate) fn job<T: Send + 'static>(
    py: Python<'_>,
    run: impl FnOnce(&mut dyn Watch) -> Result<T, JobError> + Send + 'static,
) -> PyResult<T> {
    at_length(py, move |mut heard| run(&mut heard))?.map_err(failed)
}

/// Runs a job that writes files; Ctrl-C ends it.
pub(crate) fn writing_job<T: Send + 'static>(
    py: Python<'_>,
    run: impl FnOnce(&mut dyn Watch) -> Result<T, JobError> + Send + 'static,
) -> PyResult<T> {
    writing(py, move |mut heard| run(&mut heard))?.map_err(failed)
}

/// Text that is put together piece by piece; Ctrl-C is heard in between.
pub(crate) struct Long<'py> {
    py: Python<'py>,
    bytes: Vec<u8>,
    heard: usize,
}

impl<'py> Long<'py> {
    /// The text that `write` writes.
    pub(crate) fn text(py: Python<'py>, write: impl FnOnce(&mut Self) -> io::Result<()>) -> PyResult<String> {
        let (bytes, heard) = (Vec::new(), 0);
        let mut long = Self { py, bytes, heard };
        // The exception of a signal is what an error of writing brings.
        write(&mut long)?;
        Ok(String::from_utf8(long.bytes)?)
    }
}

impl Write for Long<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        /// Bytes that are written in some milliseconds.
        const AT_ONCE: usize = 1 << 20;
        if self.bytes.len() >= self.heard + AT_ONCE {
            self.heard = self.bytes.len();
            self.py.check_signals().map_err(io::Error::other)?;
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
