//! What several holds say together.

use serde::{Deserialize, Serialize};

use super::joint::{JointAnalysis, JointHolds, Misfit, joint};
use crate::analysis::{AnalysisOptions, Finding, HoldAnalysis, Signal};
use crate::fit::{ExponentChoice, LatencyFit, TrendVerdict};
use crate::forecast::{REFUTED, Row};
use crate::laws::Law;
use crate::segment::After;
use crate::statistics::{coverage_factor, range};
use crate::watch::{Cancelled, Watch};

/// Trend of ln v with the equilibrium strain over the holds after loading (Table I).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Trend {
    /// d ln v/dε_e.
    pub slope: f64,
    /// Its standard error from the scatter of the holds; `None` for two holds, which always lie on a line.
    pub standard_error: Option<f64>,
    /// Its confidence interval.
    pub interval: Option<(f64, f64)>,
    /// Holds.
    pub holds: usize,
}

/// Equilibria of two holds at one displacement, one after loading, one after unloading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LevelAgreement {
    /// Displacement, m.
    pub displacement: f64,
    /// Number of the hold after loading.
    pub loading: usize,
    /// Number of the hold after unloading.
    pub unloading: usize,
    /// Equilibrium after loading.
    pub loading_equilibrium: f64,
    /// Equilibrium after unloading.
    pub unloading_equilibrium: f64,
    /// Their difference over its standard error, where both have one.
    pub z: Option<f64>,
}

/// Results over all holds.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Across {
    /// The lowest listed exponent that fits all holds best: the sum of their information criteria is within 2 of the lowest.
    pub common_exponent: Option<f64>,
    /// Summed criterion of every listed exponent, less the lowest sum.
    pub evidence: Vec<(f64, f64)>,
    /// Trend of v.
    pub trend: Option<Trend>,
    /// One law for several holds against one for each: the holds after loading, then all; n common, then free.
    pub joint: Vec<JointAnalysis>,
    /// Agreement of equilibria.
    pub agreements: Vec<LevelAgreement>,
    /// What stands against a trend of v at the common exponent.
    pub misfit: Option<Misfit>,
}

pub(in crate::analysis) fn across(
    holds: &[HoldAnalysis],
    exponents: &[f64],
    options: &AnalysisOptions,
    displacement_tolerance: f64,
    watch: &mut dyn Watch,
) -> Result<Across, Cancelled> {
    let evidence = summed_evidence(holds, exponents);
    let common_exponent = evidence.iter().filter(|(_, delta)| *delta <= 2.0).map(|(n, _)| *n).min_by(f64::total_cmp);
    let fit = |hold: &HoldAnalysis| {
        common_exponent.and_then(|n| hold.fit_with(n).cloned()).filter(|fit| fit.termination.is_good())
    };
    // Holds at one level show no trend: between them v has nothing to go with.
    let levels_differ = levels_differ(holds, displacement_tolerance);
    let misfit = match exponent_not_listed(holds, &evidence) {
        _ if refutes_latency(holds) => Some(Misfit::Law),
        found => found.map(|_| Misfit::Exponents),
    };
    Ok(Across {
        trend: if levels_differ { trend(holds, fit) } else { None },
        joint: joint(holds, common_exponent, (levels_differ, misfit), options, watch)?,
        misfit,
        agreements: agreements(holds, fit, displacement_tolerance),
        common_exponent,
        evidence,
    })
}

/// Whether the jaw held more than one displacement after loading; true where it was not recorded.
fn levels_differ(holds: &[HoldAnalysis], tolerance: f64) -> bool {
    let loading = holds.iter().filter(|hold| hold.after == Some(After::Loading));
    let levels: Option<Vec<f64>> = loading.map(|hold| hold.displacement).collect();
    levels.is_none_or(|levels| range(&levels) > tolerance)
}

fn summed_evidence(holds: &[HoldAnalysis], exponents: &[f64]) -> Vec<(f64, f64)> {
    let mut sums: Vec<(f64, f64)> = exponents.iter().map(|n| (*n, 0.0)).collect();
    let mut counted = 0;
    for order in holds.iter().filter_map(|hold| hold.order.as_ref()) {
        counted += 1;
        for (n, sum) in &mut sums {
            let candidate = order.candidates.iter().find(|c| !c.free && c.exponent == *n);
            *sum += candidate.map_or(f64::INFINITY, |c| c.delta_bic);
        }
    }
    sums.retain(|(_, sum)| sum.is_finite() && counted > 0);
    let lowest = sums.iter().map(|(_, sum)| *sum).fold(f64::INFINITY, f64::min);
    sums.into_iter().map(|(n, sum)| (n, sum - lowest)).collect()
}

/// A finding if a free exponent refutes the best of the listed ones.
pub(in crate::analysis) fn exponent_not_listed(holds: &[HoldAnalysis], evidence: &[(f64, f64)]) -> Option<Finding> {
    let best = evidence.iter().min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let better = holds.iter().filter_map(|hold| {
        let candidates = &hold.order.as_ref()?.candidates;
        let (free, listed) =
            (candidates.iter().find(|c| c.free)?, candidates.iter().find(|c| !c.free && c.exponent == best)?);
        Some((hold.number, free.exponent, listed.delta_bic - free.delta_bic))
    });
    let better: Vec<_> = better.filter(|(_, _, delta)| *delta > REFUTED).collect();
    (!better.is_empty()).then(|| Finding::ExponentNotListed {
        best,
        delta_bic: better.iter().map(|(_, _, delta)| delta).sum(),
        free: better.iter().map(|(hold, exponent, _)| (*hold, *exponent)).collect(),
    })
}

/// Whether most of the holds on which the latency law was compared with others refute it with any exponent, and not every other law.
fn refutes_latency(holds: &[HoldAnalysis]) -> bool {
    let (mut compared, mut refuting) = (0, 0);
    for comparison in holds.iter().filter_map(|hold| hold.comparison.as_ref()) {
        let is_latency = |row: &&Row| matches!(row.law, Law::Latency { .. });
        // A fit that ended at a bound describes the hold as closely as it does.
        let latency = comparison.rows.iter().filter(is_latency).filter_map(|row| row.delta_bic).reduce(f64::min);
        let mut others =
            comparison.rows.iter().filter(|row| !is_latency(row) && row.law != Law::Spectrum && row.is_good());
        let Some(latency) = latency else { continue };
        let stands = others.any(|row| row.delta_bic.is_some_and(|bic| bic <= REFUTED));
        compared += 1;
        refuting += usize::from(stands && latency > REFUTED);
    }
    2 * refuting > compared
}

/// What the holds after loading say of v, unless it is that v is constant, or that it has no meaning: at the common exponent, or at the free one where
/// that refutes every listed exponent.
pub(in crate::analysis) fn changing_rate(across: &Across) -> Option<Finding> {
    let free = match across.misfit {
        None => false,
        Some(Misfit::Exponents) => true,
        Some(Misfit::Law) => return None,
    };
    let requested = |one: &&JointAnalysis| (one.choice == ExponentChoice::Free) == free;
    let found = across.joint.iter().filter(|one| one.which == JointHolds::Loading).find(requested)?;
    let trend = found.comparison.trend.as_ref()?;
    (found.comparison.verdict != TrendVerdict::Constant).then_some(Finding::RateCoefficientTrend {
        verdict: found.comparison.verdict,
        holds: trend.points.len(),
        slope: trend.slope,
        interval: trend.interval,
    })
}

fn trend(holds: &[HoldAnalysis], fit: impl Fn(&HoldAnalysis) -> Option<LatencyFit>) -> Option<Trend> {
    let points: Vec<(f64, f64)> = holds
        .iter()
        // v of a force goes with the level of the force by its unit alone.
        .filter(|hold| hold.after == Some(After::Loading) && hold.signal == Signal::Strain)
        .filter_map(|hold| {
            let fit = fit(hold)?;
            Some((fit.equilibrium().value, fit.rate_coefficient().value.ln()))
        })
        .collect();
    let count = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
    let (xx, xy) = points
        .iter()
        .fold((0.0, 0.0), |(xx, xy), p| (xx + (p.0 - mx).powi(2), xy + (p.0 - mx) * (p.1 - my)));
    // Holds at one level show no trend.
    if points.len() < 2 || xx <= (1e-3 * mx).powi(2) * count {
        return None;
    }
    let slope = xy / xx;
    let square: f64 = points.iter().map(|p| (p.1 - my - slope * (p.0 - mx)).powi(2)).sum();
    let freedom = count - 2.0;
    let standard_error = (freedom > 0.0).then(|| (square / freedom / xx).sqrt());
    Some(Trend {
        slope,
        standard_error,
        interval: standard_error.map(|error| {
            let half = error * coverage_factor(0.95, freedom);
            (slope - half, slope + half)
        }),
        holds: points.len(),
    })
}

fn agreements(
    holds: &[HoldAnalysis],
    fit: impl Fn(&HoldAnalysis) -> Option<LatencyFit>,
    tolerance: f64,
) -> Vec<LevelAgreement> {
    let mut agreements = Vec::new();
    for unloading in holds.iter().filter(|hold| hold.after == Some(After::Unloading)) {
        let (Some(level), Some(below)) = (unloading.displacement, fit(unloading)) else {
            continue;
        };
        // The nearest earlier hold after loading at this displacement.
        let partner = holds.iter().rev().filter(|hold| hold.after == Some(After::Loading)).find(|hold| {
            hold.number < unloading.number && hold.displacement.is_some_and(|d| (d - level).abs() <= tolerance)
        });
        let Some((loading, above)) = partner.and_then(|hold| Some((hold, fit(hold)?))) else {
            continue;
        };
        let error = match (above.equilibrium().standard_error, below.equilibrium().standard_error) {
            (Some(a), Some(b)) => Some(a.hypot(b)),
            _ => None,
        };
        let difference = above.equilibrium().value - below.equilibrium().value;
        agreements.push(LevelAgreement {
            displacement: level,
            loading: loading.number,
            unloading: unloading.number,
            loading_equilibrium: above.equilibrium().value,
            unloading_equilibrium: below.equilibrium().value,
            z: error.filter(|error| *error > 0.0).map(|error| difference / error),
        });
    }
    agreements
}
