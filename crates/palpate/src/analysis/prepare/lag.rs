//! How much later the force answers than the jaw moves where one clock stamps both: two loggers, a filter or a buffer.

use crate::analysis::Finding;
use crate::record::Record;
use crate::segment::{Segment, Segmentation};
use crate::statistics::{interpolated, median, range};

/// By how much one column lags behind the other, from the rates of both over the ramps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ColumnLag {
    /// Time by which the force follows the displacement, s; negative where the displacement follows the force.
    pub lag: f64,
    /// Correlation of the rates once the lag is taken out.
    pub correlation: f64,
    /// The same as they are.
    pub as_recorded: f64,
}

impl From<ColumnLag> for Finding {
    fn from(found: ColumnLag) -> Self {
        Self::ColumnsLag {
            lag: found.lag,
            correlation: found.correlation,
            as_recorded: found.as_recorded,
        }
    }
}

/// Parts of a ramp whose rates are compared, and fewest of its samples.
const PARTS: f64 = 20.0;
const FEWEST: usize = 6;
/// Lengths of the ramp before and behind it that are compared too, and farthest lag in such lengths.
const BESIDE: f64 = 2.0;
const FARTHEST: f64 = 1.5;
/// Share of the ranges of both columns that a ramp covers at least.
const COVERS: f64 = 0.1;
/// Least correlation with the lag taken out, and most of it that there is without.
const ALIKE: f64 = 0.85;
const UNLIKE: f64 = 0.9;
/// Fewest sample intervals that a lag lasts.
const INTERVALS: f64 = 2.0;
/// Share of what the lag predicts by which the force moves on after the jaw stands, or before the jaw moves.
const MOVES_ALONE: f64 = 0.5;
/// Share of its median by which the lags of ramps differ at most.
const AGREE: f64 = 0.2;

/// The lag of the columns of a record of one clock; `None` where they have none, or the ramps do not agree on it.
///
/// The rates of displacement and force correlate best without a lag, whatever the law of the body: it pushes as it is pressed. A lag counts where they
/// correlate far better with it, and the force moves on while the jaw stands, or moves before the jaw does, as no body makes it.
pub(super) fn column_lag(record: &Record, segmentation: &Segmentation) -> Option<ColumnLag> {
    let displacement = record.displacement()?;
    let ramps = segmentation.segments.iter().filter(|segment| segment.is_ramp());
    let judged: Vec<Option<ColumnLag>> = ramps.filter_map(|ramp| of_ramp(record, displacement, ramp)).collect();
    let mut found: Vec<ColumnLag> = judged.iter().flatten().copied().collect();
    found.sort_by(|a, b| a.lag.total_cmp(&b.lag));
    let middle = median(&mut found.iter().map(|found| found.lag).collect::<Vec<f64>>());
    let agree = found.iter().filter(|found| (found.lag - middle).abs() <= AGREE * middle.abs()).count();
    found.get(found.len() / 2).copied().filter(|_| 3 * agree >= 2 * judged.len())
}

/// What a ramp shows: `None` if it is too short or too small to tell, `Some(None)` if there is no lag.
fn of_ramp(record: &Record, displacement: &[f64], ramp: &Segment) -> Option<Option<ColumnLag>> {
    let (time, force) = (record.time(), record.force());
    let (first, last) = (ramp.start.saturating_sub(1), ramp.end.min(time.len() - 1));
    let way = displacement[last] - displacement[first];
    let place = |share: f64| {
        let beyond = |i: &usize| (displacement[*i] - displacement[first] - share * way) * way.signum() >= 0.0;
        (first..=last).find(beyond).unwrap_or(last)
    };
    let (begin, end) = (place(0.02).saturating_sub(1), place(0.98));
    let length = time[end] - time[begin];
    if end < begin + FEWEST || way.abs() < COVERS * range(displacement) {
        return None;
    }
    let step = length / PARTS;
    let (from, until) = (
        (time[begin] - BESIDE * length).max(time[0]),
        (time[end] + BESIDE * length).min(time[time.len() - 1]),
    );
    let grid: Vec<f64> = (0..=((until - from) / step) as usize).map(|i| from + step * i as f64).collect();
    let rates = |values: &[f64]| -> Vec<f64> {
        interpolated(time, values, &grid).windows(2).map(|pair| pair[1] - pair[0]).collect()
    };
    let (jaw, answer) = (rates(displacement), rates(force));
    let square = |rates: &[f64]| rates.iter().map(|rate| rate * rate).sum::<f64>();
    let scale = (square(&jaw) * square(&answer)).sqrt();
    if range(&interpolated(time, force, &grid)) < COVERS * range(force) || scale <= 0.0 {
        return None;
    }
    let correlation = |lag: isize| {
        let pairs = jaw.iter().enumerate().filter_map(|(i, rate)| Some(rate * answer.get(i.checked_add_signed(lag)?)?));
        pairs.sum::<f64>() / scale
    };
    let most = (FARTHEST * PARTS) as isize;
    let best = (-most..=most).max_by(|a, b| correlation(*a).total_cmp(&correlation(*b)))?;
    let [before, most, after] = [best - 1, best, best + 1].map(correlation);
    let bend = before - 2.0 * most + after;
    let lag = step * (best as f64 + if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 });
    let found = ColumnLag {
        lag,
        correlation: most,
        as_recorded: correlation(0),
    };
    let at = |time_s: f64| interpolated(time, force, &[time_s])[0];
    let rise = at(time[end] + lag) - at(time[begin] + lag);
    let alone = if lag > 0.0 {
        at(time[end] + lag) - at(time[end])
    } else {
        at(time[begin]) - at(time[begin] + lag)
    };
    let moves_alone = alone / rise > MOVES_ALONE * (lag.abs() / length).min(1.0);
    let is_lag = most >= ALIKE
        && found.as_recorded < UNLIKE * most
        && lag.abs() > INTERVALS * record.sample_interval()
        && moves_alone;
    Some(is_lag.then_some(found))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

    use super::*;
    use crate::analysis::{AnalysisOptions, Finding, analyze};
    use crate::random::Rng;

    /// A squeeze and its release, in which the displacement is stamped `late` (s), with `air` (mm) to go first.
    fn record(late: f64, air: f64, stiffens: f64) -> Record {
        let mut random = Rng::new(3);
        let time: Vec<f64> = (0..1800).map(|i| 0.05 * f64::from(i)).collect();
        let jaw = |t: f64| 5.0 * (((t - 5.0) / 2.0).clamp(0.0, 1.0) - ((t - 50.0) / 2.0).clamp(0.0, 1.0));
        let relaxes = |t: f64| 0.6 + 0.4 * (-(t - 7.0).max(0.0) / 8.0).exp();
        let force = |t: f64| 20.0 * ((jaw(t) - air).max(0.0) / (5.0 - air)).powf(stiffens) * relaxes(t);
        let force = time.iter().map(|t| force(*t) + 0.01 * random.normal()).collect();
        Record::new(time.clone(), Some(time.iter().map(|t| 1e-3 * jaw(t - late)).collect()), force).unwrap()
    }

    /// Fits began 1 s into the relaxation, or in the rise, without a word; where the force was late the displacement was "saturated".
    #[test]
    fn a_displacement_that_lags_behind_the_force_is_stated() {
        for late in [1.0, 0.5, -0.5, -1.0] {
            let found = analyze(&record(late, 0.0, 1.0), &AnalysisOptions::default()).unwrap().findings;
            let lag = found.iter().find_map(|finding| match finding {
                Finding::ColumnsLag { lag, .. } => Some(*lag),
                _ => None,
            });
            assert!(lag.is_some_and(|lag| (lag + late).abs() < 0.1), "{late}: {found:?}");
            assert!(found.iter().all(|finding| finding.code() != "saturated"), "{found:?}");
        }
        for (air, stiffens) in [(0.0, 1.0), (0.0, 1.5), (2.5, 1.5), (4.0, 1.0)] {
            let found = analyze(&record(0.0, air, stiffens), &AnalysisOptions::default()).unwrap().findings;
            assert!(found.iter().all(|finding| finding.code() != "columns_lag"), "{found:?}");
        }
    }
}
