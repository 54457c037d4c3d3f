//! Progress of long work and its cancellation, in one trait.
//!
//! Whoever starts long work passes a [`Watch`]; the work reports to it how far it is, between steps that take a fraction of a second,
//! and ends with [`Cancelled`] once the watch says so. Nothing else is shared: the library has no threads to stop and no clock.
//!
//! ```
//! use palpate::watch::{Cancelled, Progress, Unwatched, Watch};
//!
//! fn sum(values: &[f64], watch: &mut dyn Watch) -> Result<f64, Cancelled> {
//!     let mut sum = 0.0;
//!     for (done, value) in values.iter().enumerate() {
//!         watch.report(Progress::counted("adding", done, values.len()))?;
//!         sum += value;
//!     }
//!     Ok(sum)
//! }
//!
//! assert_eq!(sum(&[1.0, 2.0], &mut Unwatched), Ok(3.0));
//! let mut patience = |progress: Progress<'_>| if progress.done < 1 { Ok(()) } else { Err(Cancelled) };
//! assert_eq!(sum(&[1.0, 2.0], &mut patience), Err(Cancelled));
//! ```

/// Work that its watch cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// How far a step of long work is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress<'a> {
    /// What is being done, such as "calibrating latency".
    pub task: &'a str,
    /// How much of it is done.
    pub done: u64,
    /// How much there is to do, where that is known beforehand.
    pub total: Option<u64>,
}

impl<'a> Progress<'a> {
    /// Of work of unknown length.
    #[must_use]
    pub fn open(task: &'a str, done: usize) -> Self {
        Self {
            task,
            done: done as u64,
            total: None,
        }
    }

    /// Of work that is counted.
    #[must_use]
    pub fn counted(task: &'a str, done: usize, total: usize) -> Self {
        Self {
            task,
            done: done as u64,
            total: Some(total as u64),
        }
    }
}

/// Hears of the progress of long work and may end it.
pub trait Watch {
    /// Hears how far the work is.
    ///
    /// # Errors
    /// [`Cancelled`] ends the work.
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled>;
}

impl<F: FnMut(Progress<'_>) -> Result<(), Cancelled>> Watch for F {
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled> {
        self(progress)
    }
}

/// Progress of work whose length is not known beforehand, but how much of the whole each of its stages is.
///
/// It is reported in thousandths, which never fall and end at the whole.
#[cfg(feature = "std")]
pub(crate) struct Stages<'a> {
    watch: &'a mut dyn Watch,
    task: String,
    /// Shares of the whole at which the present stage begins and ends.
    stage: (f64, f64),
    done: usize,
    /// Once ended it stays so, whatever the watch says later.
    cancelled: bool,
}

#[cfg(feature = "std")]
impl std::fmt::Debug for Stages<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stages").field("task", &self.task).field("done", &self.done).finish_non_exhaustive()
    }
}

#[cfg(feature = "std")]
impl<'a> Stages<'a> {
    const WHOLE: usize = 1000;

    pub(crate) fn new(task: String, watch: &'a mut dyn Watch) -> Self {
        Self {
            watch,
            task,
            stage: (0.0, 0.0),
            done: 0,
            cancelled: false,
        }
    }

    /// The last stage is over; the next is `share` of the whole.
    pub(crate) fn enter(&mut self, share: f64) {
        self.stage = (self.stage.1, (self.stage.1 + share).min(1.0));
    }

    /// Reports that `share` of the present stage is done.
    pub(crate) fn reach(&mut self, share: f64) -> Result<(), Cancelled> {
        let (start, end) = self.stage;
        let reached = (start + (end - start) * share.clamp(0.0, 1.0)) * Self::WHOLE as f64;
        self.done = self.done.max(reached as usize);
        self.hear()
    }

    /// Reports that work goes on, no further than it was.
    pub(crate) fn hear(&mut self) -> Result<(), Cancelled> {
        self.cancelled |= self.watch.report(Progress::counted(&self.task, self.done, Self::WHOLE)).is_err();
        if self.cancelled { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports that all is done.
    pub(crate) fn finish(&mut self) -> Result<(), Cancelled> {
        self.done = Self::WHOLE;
        self.hear()
    }
}

/// Work inside a stage: how far it is counts as that share of the stage.
#[cfg(feature = "std")]
impl Watch for Stages<'_> {
    fn report(&mut self, progress: Progress<'_>) -> Result<(), Cancelled> {
        let total = progress.total.filter(|total| *total > 0);
        self.reach(total.map_or(0.0, |total| progress.done as f64 / total as f64))
    }
}

/// No watch: the work runs to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn report(&mut self, _: Progress<'_>) -> Result<(), Cancelled> {
        Ok(())
    }
}
