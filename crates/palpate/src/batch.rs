//! Thousands of simulations at once on all cores: what each of many runs comes to, under any drive and law.

use crate::parallel::for_each;
use crate::simulate::{ContactRef, Drive, RunSummary, Sampling, SimulateError, run_summary};
use crate::watch::{Cancelled, Progress, Watch};

/// A run of a batch: what drives a contact, and where its force is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// What drives it: a motion, a force or a program.
    pub drive: Drive<'a>,
    /// The contact, whichever law it obeys.
    pub contact: ContactRef<'a>,
    /// Samples among which the largest force is.
    pub sampling: &'a Sampling,
    /// Further times (s) at which to compute the force.
    pub times: &'a [f64],
}

impl Run<'_> {
    /// What the run comes to, by one walk through its drive (two for a program, whose steps end where the contact has them end). Summary and
    /// ends of steps are those of [`summary`](crate::simulate::summary()) and [`step_ends`](crate::simulate::step_ends) to the last bit, forces
    /// those of [`simulate`](crate::simulate::simulate()) to rounding.
    ///
    /// # Errors
    /// As for `simulate`.
    pub fn summarize(&self) -> Result<RunSummary, SimulateError> {
        run_summary(self.drive, self.contact, self.sampling, self.times)
    }
}

/// Runs between two reports.
const AT_ONCE: usize = 256;

/// What each run comes to ([`Run::summarize`]), in the order of the runs, on all cores; the results do not depend on how many there are.
///
/// ```
/// use palpate::batch::{Run, summaries};
/// use palpate::simulate::{ProtocolStep, Sampling, Separation, protocol};
/// use palpate::test_problems::paper_ball;
/// use palpate::watch::Unwatched;
///
/// let model = paper_ball(Separation::Unilateral);
/// let motions = [4e-3, 5e-3].map(|to| protocol(&[ProtocolStep { to, rate: 0.5 / 60.0, hold: 10.0 }]).unwrap());
/// let sampling = Sampling::Rate(100.0);
/// let runs = motions.each_ref().map(|motion| Run { drive: motion.into(), contact: (&model).into(), sampling: &sampling, times: &[] });
/// let found = summaries(&runs, &mut Unwatched)?;
/// let second = found[1].as_ref().unwrap();
/// assert!((second.summary.peak_force - 3.035_025_007_5).abs() < 1e-9); // N, at the end of the ramp
/// assert_eq!((second.ends.len(), second.ends[1].force), (2, second.summary.force));
/// # Ok::<(), palpate::watch::Cancelled>(())
/// ```
///
/// # Errors
/// [`Cancelled`] once `watch` ends it, which hears of every 256 runs; what keeps a run from being simulated stands in its place.
pub fn summaries(runs: &[Run<'_>], watch: &mut dyn Watch) -> Result<Vec<Result<RunSummary, SimulateError>>, Cancelled> {
    let mut found = Vec::with_capacity(runs.len());
    for part in runs.chunks(AT_ONCE) {
        watch.report(Progress::counted("simulating", found.len(), runs.len()))?;
        found.extend(for_each(part.len(), |index| part[index].summarize()));
    }
    watch.report(Progress::counted("simulating", runs.len(), runs.len()))?;
    Ok(found)
}
