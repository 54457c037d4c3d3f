//! Tasks that wait, and the threads that run them.

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use palpate::watch::{Cancelled, Progress, Watch};
use palpate_jobs::{BatchedTest, ErrorKind, JobError, RefusalDocument};
use serde::Serialize;
use tokio::sync::watch;

use super::{Made, Request};
use crate::folder::Folder;
use crate::refusal::refusal;

/// Tasks that are kept once they are done.
const KEPT: usize = 200;
/// Those of them that keep a whole record with its fits, which files are made of, or large files.
const KEPT_LARGE: usize = 12;
/// How often a page hears of progress.
const HEARD: Duration = Duration::from_millis(80);

/// How a task stands, for the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "snake_case")]
pub(crate) enum State {
    Waiting,
    Running {
        task: String,
        done: u64,
        total: Option<u64>,
    },
    Done,
    Failed(RefusalDocument),
    Cancelled,
}

/// A task in short, for the page.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Brief {
    pub(crate) id: u64,
    #[serde(flatten)]
    pub(crate) state: State,
    /// Rows of a batch that are done.
    pub(crate) rows: usize,
}

struct Task {
    request: Request,
    key: String,
    state: State,
    /// The revision at which it last changed.
    changed: u64,
    cancel: Arc<AtomicBool>,
    made: Option<Arc<Made>>,
    rows: Vec<BatchedTest>,
}

#[derive(Default)]
struct Inner {
    next: u64,
    revision: u64,
    /// The revision at which the folder last changed.
    folder: u64,
    tasks: BTreeMap<u64, Task>,
    quick: VecDeque<u64>,
    slow: VecDeque<u64>,
}

/// The tasks of the lab.
pub(crate) struct Tasks {
    folder: Arc<Folder>,
    inner: Mutex<Inner>,
    ready: Condvar,
    revision: watch::Sender<u64>,
}

impl Tasks {
    /// Starts the threads: one for what a person waits for, and one a processor for the rest.
    pub(crate) fn start(folder: Arc<Folder>) -> Arc<Self> {
        let tasks = Arc::new(Self {
            folder,
            inner: Mutex::default(),
            ready: Condvar::new(),
            revision: watch::Sender::new(0),
        });
        let processors = thread::available_parallelism().map_or(1, usize::from);
        for number in 0..=processors {
            let tasks = Arc::clone(&tasks);
            thread::spawn(move || tasks.work(number == 0));
        }
        tasks
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Hears when anything has changed.
    pub(crate) fn heard(&self) -> watch::Receiver<u64> {
        self.revision.subscribe()
    }

    /// Says that the folder has changed.
    pub(crate) fn folder_changed(&self) {
        let mut inner = self.lock();
        inner.folder = self.turn(&mut inner);
    }

    fn turn(&self, inner: &mut Inner) -> u64 {
        inner.revision += 1;
        self.revision.send_replace(inner.revision);
        inner.revision
    }

    /// Starts a task, or finds the one that does the same; `first` puts it before those that wait.
    pub(crate) fn add(&self, request: Request, first: bool) -> u64 {
        let (key, place) = (request.key(&self.folder), request.place());
        let mut inner = self.lock();
        let is_good = |task: &Task| match task.state {
            State::Waiting | State::Running { .. } => !task.cancel.load(Ordering::Relaxed),
            // A file that was written may have gone since.
            State::Done => !task.request.writes(),
            State::Failed(_) | State::Cancelled => false,
        };
        let same = inner.tasks.iter().rev().find(|(_, task)| task.key == key && is_good(task));
        if let Some((id, task)) = same {
            let (id, waits) = (*id, task.state == State::Waiting);
            if first && waits {
                inner.slow.retain(|other| *other != id);
                inner.slow.push_front(id);
            }
            return id;
        }
        // Of an earlier state of the record: nobody waits for it any more.
        for task in inner.tasks.values().filter(|task| task.request.place() == place) {
            task.cancel.store(true, Ordering::Relaxed);
        }
        inner.next += 1;
        let id = inner.next;
        let changed = self.turn(&mut inner);
        let quick = request.is_quick();
        let task = Task {
            request,
            key,
            state: State::Waiting,
            changed,
            cancel: Arc::default(),
            made: None,
            rows: Vec::new(),
        };
        inner.tasks.insert(id, task);
        let queue = if quick { &mut inner.quick } else { &mut inner.slow };
        if first {
            queue.push_front(id);
        } else {
            queue.push_back(id);
        }
        self.ready.notify_all();
        id
    }

    /// Ends a task; false where there is none.
    pub(crate) fn cancel(&self, id: u64) -> bool {
        let mut inner = self.lock();
        let Some(task) = inner.tasks.get(&id) else { return false };
        task.cancel.store(true, Ordering::Relaxed);
        if task.state == State::Waiting {
            self.set(&mut inner, id, State::Cancelled);
        }
        true
    }

    /// The revision, the one at which the folder last changed, and the tasks that changed after a revision.
    pub(crate) fn since(&self, revision: u64) -> (u64, u64, Vec<Brief>) {
        let inner = self.lock();
        let changed = inner.tasks.iter().filter(|(_, task)| task.changed > revision);
        let briefs = changed.map(|(id, task)| brief(*id, task)).collect();
        (inner.revision, inner.folder, briefs)
    }

    /// How a task stands, with what it made.
    pub(crate) fn find(&self, id: u64) -> Option<(Brief, Option<Arc<Made>>)> {
        let inner = self.lock();
        let task = inner.tasks.get(&id)?;
        Some((brief(id, task), task.made.clone()))
    }

    /// The tests of a batch from one on, as far as they are done.
    pub(crate) fn rows(&self, id: u64, from: usize) -> Option<Vec<BatchedTest>> {
        let inner = self.lock();
        let rows = &inner.tasks.get(&id)?.rows;
        Some(rows.get(from..).unwrap_or_default().to_vec())
    }

    fn set(&self, inner: &mut Inner, id: u64, state: State) {
        let changed = self.turn(inner);
        if let Some(task) = inner.tasks.get_mut(&id) {
            (task.state, task.changed) = (state, changed);
        }
    }

    /// Runs tasks for as long as the process lives.
    fn work(&self, only_quick: bool) {
        loop {
            let (id, request, cancel) = self.next(only_quick);
            // What is stated may have changed while the task waited: it computes what is stated now.
            let key = request.key(&self.folder);
            if let Some(task) = self.lock().tasks.get_mut(&id) {
                task.key = key;
            }
            let mut watch = TaskWatch {
                tasks: self,
                id,
                cancel: &cancel,
                heard: None,
            };
            let take = |row: BatchedTest| self.take(id, row);
            // What a file makes a computation do must not take the lab with it.
            let made = catch_unwind(AssertUnwindSafe(|| request.run(&self.folder, &mut watch, take)));
            let broken = || Err(JobError::new(ErrorKind::Record, "the computation ended unexpectedly", None));
            self.done(id, made.unwrap_or_else(|_| broken()));
        }
    }

    fn next(&self, only_quick: bool) -> (u64, Request, Arc<AtomicBool>) {
        let mut inner = self.lock();
        loop {
            let id = inner.quick.pop_front().or_else(|| if only_quick { None } else { inner.slow.pop_front() });
            let Some(id) = id else {
                inner = self.ready.wait(inner).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let Some(task) = inner.tasks.get(&id) else { continue };
            let (request, cancel) = (task.request.clone(), Arc::clone(&task.cancel));
            if cancel.load(Ordering::Relaxed) {
                self.set(&mut inner, id, State::Cancelled);
                continue;
            }
            let task = "starting".to_owned();
            self.set(
                &mut inner,
                id,
                State::Running {
                    task,
                    done: 0,
                    total: None,
                },
            );
            return (id, request, cancel);
        }
    }

    fn take(&self, id: u64, row: BatchedTest) {
        let mut inner = self.lock();
        let changed = self.turn(&mut inner);
        if let Some(task) = inner.tasks.get_mut(&id) {
            task.rows.push(row);
            task.changed = changed;
        }
    }

    fn done(&self, id: u64, made: Result<Made, JobError>) {
        let mut inner = self.lock();
        let state = match made {
            Ok(made) => {
                let writes = inner.tasks.get(&id).is_some_and(|task| task.request.writes());
                if let Some(task) = inner.tasks.get_mut(&id) {
                    task.made = Some(Arc::new(made));
                }
                if writes {
                    inner.folder = self.turn(&mut inner);
                }
                State::Done
            }
            Err(error) if error.kind == ErrorKind::Cancelled => State::Cancelled,
            Err(error) => State::Failed(refusal(&error, &self.folder)),
        };
        self.set(&mut inner, id, state);
        let ended = |task: &&Task| !matches!(task.state, State::Waiting | State::Running { .. });
        let old: Vec<u64> = inner.tasks.iter().filter(|(_, task)| ended(task)).map(|(id, _)| *id).collect();
        for id in &old[..old.len().saturating_sub(KEPT)] {
            inner.tasks.remove(id);
        }
        let large = |task: &&Task| task.made.as_ref().is_some_and(|made| made.is_large());
        let large: Vec<u64> = inner.tasks.iter().filter(|(_, task)| large(task)).map(|(id, _)| *id).collect();
        for id in &large[..large.len().saturating_sub(KEPT_LARGE)] {
            inner.tasks.remove(id);
        }
    }
}

fn brief(id: u64, task: &Task) -> Brief {
    Brief {
        id,
        state: task.state.clone(),
        rows: task.rows.len(),
    }
}

/// The watch of a task: the page hears how far it is, and may have ended it.
struct TaskWatch<'a> {
    tasks: &'a Tasks,
    id: u64,
    cancel: &'a AtomicBool,
    heard: Option<Instant>,
}

impl Watch for TaskWatch<'_> {
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(Cancelled);
        }
        if self.heard.is_none_or(|heard| heard.elapsed() > HEARD) {
            self.heard = Some(Instant::now());
            let running = State::Running {
                task: progress.task.to_owned(),
                done: progress.done,
                total: progress.total,
            };
            self.tasks.set(&mut self.tasks.lock(), self.id, running);
        }
        Ok(())
    }
}
