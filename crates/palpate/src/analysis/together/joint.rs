//! One law for several holds of a record, against one for each.

use serde::{Deserialize, Serialize};

use crate::analysis::AnalysisOptions;
use crate::analysis::holds::{HoldAnalysis, Signal};
use crate::fit::{
    ExponentChoice, HoldWeights, JointComparison, JointFit, JointOptions, Samples, TrendVerdict, compare_joint_watched,
    fit_joint_watched, fitted,
};
use crate::laws::Law;
use crate::segment::After;
use crate::watch::{Cancelled, Watch};

/// Which holds were fitted together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JointHolds {
    /// Those after loading.
    Loading,
    /// Those after loading and after unloading.
    All,
}

/// Why a trend of v over the holds has no meaning: it would be that of a misfit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Misfit {
    /// A free exponent refutes every listed one.
    Exponents,
    /// Most holds refute the latency law with any exponent, and not every other law.
    Law,
}

/// The latency law with one v (and n) for several holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointAnalysis {
    /// Which holds.
    pub which: JointHolds,
    /// Whether n is the common exponent or was estimated.
    pub choice: ExponentChoice,
    /// Numbers of the holds in the record.
    pub holds: Vec<usize>,
    /// The fit; holds count by the inverse of the variance of their own residuals.
    pub fit: JointFit,
    /// Against each hold by itself.
    pub comparison: JointComparison,
}

/// Joint fits of the holds after loading and of all holds, with the common exponent and with a free one.
///
/// Only strains are fitted: v of a force depends on the contact area, which differs from hold to hold.
pub(super) fn joint(
    holds: &[HoldAnalysis],
    common: Option<f64>,
    (levels_differ, misfit): (bool, Option<Misfit>),
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Vec<JointAnalysis>, Cancelled> {
    let Some(n) = common else { return Ok(Vec::new()) };
    let usable = |hold: &&HoldAnalysis| {
        hold.signal == Signal::Strain && hold.fit_with(n).is_some_and(|fit| fit.termination.is_good())
    };
    let all: Vec<&HoldAnalysis> = holds.iter().filter(usable).collect();
    let loading: Vec<&HoldAnalysis> = all.iter().copied().filter(|hold| hold.after == Some(After::Loading)).collect();
    let more = all.len() > loading.len();
    let groups = [Some((JointHolds::Loading, loading)), more.then_some((JointHolds::All, all))];
    let choices = [Some(ExponentChoice::Fixed(n)), options.free_exponent.then_some(ExponentChoice::Free)];
    let mut found = Vec::new();
    for (which, holds) in groups.into_iter().flatten().filter(|(_, holds)| holds.len() > 1) {
        for choice in choices.into_iter().flatten() {
            let mut analysis = together(which, &holds, choice, options, watch)?;
            if let Some(analysis) = analysis.as_mut().filter(|_| !levels_differ && which == JointHolds::Loading) {
                analysis.comparison.without_trend();
            }
            let is_free = choice == ExponentChoice::Free;
            if misfit.is_some_and(|misfit| misfit == Misfit::Law || !is_free) {
                analysis.iter_mut().for_each(|analysis| analysis.comparison.verdict = TrendVerdict::Undecided);
            }
            found.extend(analysis);
        }
    }
    Ok(found)
}

fn together(
    which: JointHolds,
    holds: &[&HoldAnalysis],
    choice: ExponentChoice,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Option<JointAnalysis>, Cancelled> {
    let samples: Vec<Samples<'_>> = holds.iter().map(|hold| hold.samples()).collect();
    let options = JointOptions {
        weights: HoldWeights::SeparateVariance,
        fit: options.fit,
        ..JointOptions::default()
    };
    // Each of these holds was fitted by itself before, so that only the search itself can fail.
    let fit = fitted(fit_joint_watched(&samples, Law::Latency { exponent: choice }, &options, watch))?;
    let Some(fit) = fit else { return Ok(None) };
    let comparison = fitted(compare_joint_watched(&samples, &fit, None, watch))?;
    Ok(comparison.map(|comparison| JointAnalysis {
        which,
        choice,
        holds: holds.iter().map(|hold| hold.number).collect(),
        fit,
        comparison,
    }))
}
