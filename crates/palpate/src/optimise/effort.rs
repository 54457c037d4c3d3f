//! What a search has done so far, and who may end it.

use std::cell::RefCell;

use super::Work;
use crate::watch::{Cancelled, Progress, Watch};

/// The work of a search, counted as it is done and reported to a watch after every evaluation of the columns: over many samples that is
/// what takes long.
///
/// Default is a search that nobody watches.
#[derive(Default)]
pub(crate) struct Effort<'w> {
    pub(crate) work: Work,
    report: Option<&'w Report<'w>>,
    /// What is reported while the search goes on; of none the count of evaluations.
    reached: Option<Progress<'w>>,
}

type Report<'w> = dyn Fn(Progress<'_>) -> Result<(), Cancelled> + 'w;

impl Effort<'_> {
    /// What `search` finds under a watch.
    pub(crate) fn watched<T>(watch: &mut dyn Watch, search: impl FnOnce(&mut Effort<'_>) -> T) -> T {
        let watch = RefCell::new(watch);
        let report = |progress: Progress<'_>| watch.borrow_mut().report(progress);
        search(&mut Effort {
            report: Some(&report),
            ..Effort::default()
        })
    }

    /// Counts an evaluation of the columns, and reports it.
    pub(crate) fn evaluated(&mut self) -> Result<(), Cancelled> {
        self.work.evaluations += 1;
        self.hear()
    }

    /// Reports that the search goes on.
    pub(crate) fn hear(&self) -> Result<(), Cancelled> {
        let Some(report) = self.report else {
            return Ok(());
        };
        report(self.reached.unwrap_or_else(|| Progress::open("fitting", self.work.evaluations as usize)))
    }
}

impl<'w> Effort<'w> {
    /// The same watch with counts of its own.
    pub(crate) fn aside(&self) -> Self {
        Self {
            work: Work::default(),
            ..*self
        }
    }

    /// Reports how far the search is.
    pub(crate) fn reach(&mut self, progress: Progress<'w>) -> Result<(), Cancelled> {
        self.reached = Some(progress);
        self.hear()
    }
}
