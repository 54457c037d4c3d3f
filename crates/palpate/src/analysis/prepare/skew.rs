//! How much later the force is stamped than the displacement, from the edges of the ramps.

use serde::{Deserialize, Serialize};

use super::kink::{Kink, kink};
use crate::record::Record;
use crate::segment::{Segment, Segmentation};
use crate::statistics::median;
use crate::watch::{Cancelled, Progress, Unwatched, Watch};

/// By how much the stamps of the force lag behind those of the displacement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ClockSkew {
    /// Time that the force is stamped too late, s; negative where it is too early.
    pub skew: f64,
    /// Its standard error, s: scatter between the edges, and the difference from estimates over half the stretch around each edge.
    pub standard_error: f64,
    /// Number of starts and ends of ramps used.
    pub edges: usize,
    /// Time between samples around them, s.
    pub interval: f64,
}

impl ClockSkew {
    /// Whether it differs significantly from zero.
    #[must_use]
    pub fn is_observed(&self) -> bool {
        self.skew.abs() > OBSERVED * self.standard_error
    }

    /// Whether it stands out from what samples every `interval` s leave open as well: it is longer than that, and than its
    /// error together with interval/√12, since all edges may lie alike between two samples.
    pub(super) fn is_resolved(&self, interval: f64) -> bool {
        let open = interval / 12f64.sqrt();
        self.skew.abs() > interval && self.skew.abs() > OBSERVED * self.standard_error.hypot(open)
    }
}

/// Standard errors from which on a skew is accepted.
const OBSERVED: f64 = 3.0;
/// Fewest edges whose scatter says anything.
const FEWEST: usize = 3;
/// Samples on each side of an edge: fewest and most.
const SAMPLES: (usize, usize) = (5, 50);

/// Delay of the force stamps after those of the displacement. `None` where fewer than three edges of ramps appear in both, or
/// where they disagree by more than the stretches around them are long.
///
/// Where a ramp starts or ends the displacement bends, and the force of any body bends in the same moment, however it
/// relaxes before and after. Both kinks are found by least squares between samples: straight pieces for the displacement;
/// for the force a straight piece and a parabola, over half a ramp at most. The mean of their differences is weighted by
/// their errors; edges far from the median are left out (first touch is no kink of the force at the start of its ramp).
/// A relaxation much faster than half a ramp pulls the kink to earlier times; the difference to the same over half the
/// stretch tells how far, and is part of the error.
#[must_use]
pub fn clock_skew(record: &Record, segmentation: &Segmentation) -> Option<ClockSkew> {
    skew_watched(record, segmentation, &mut Unwatched).ok().flatten()
}

/// [`clock_skew`] with a watch.
pub(super) fn skew_watched(
    record: &Record,
    segmentation: &Segmentation,
    watch: &mut dyn Watch,
) -> Result<Option<ClockSkew>, Cancelled> {
    let Some(displacement) = record.displacement() else {
        return Ok(None);
    };
    let pairs = segmentation.segments.windows(2).map(|pair| (&pair[0], &pair[1]));
    let pairs: Vec<(&Segment, &Segment)> =
        pairs.filter(|(before, after)| before.is_ramp() != after.is_ramp()).collect();
    let edges = |share: usize, lag: f64| -> Vec<Edge> {
        pairs.iter().filter_map(|pair| edge(record, displacement, *pair, (share, lag))).collect()
    };
    let mut found = |lag: f64| -> Result<Option<ClockSkew>, Cancelled> {
        watch.report(Progress::open("comparing the clocks", 0))?;
        let Some(whole) = combined(&edges(2, lag)) else {
            return Ok(None);
        };
        let systematic = combined(&edges(4, lag)).map_or(0.0, |half| (half.skew - whole.skew).abs());
        Ok(Some(ClockSkew {
            standard_error: whole.standard_error.hypot(systematic),
            ..whole
        }))
    };
    let near = found(0.0)?;
    let stretch = median(&mut pairs.iter().map(|pair| stretch(record, *pair)).collect::<Vec<f64>>());
    let is_sure = |skew: &ClockSkew| SURE * skew.edges > pairs.len() && skew.standard_error < 0.2 * stretch;
    if near.as_ref().is_some_and(is_sure) || pairs.len() < FEWEST || pairs.len() > MOST_EDGES {
        return Ok(near);
    }
    // Farther off than the stretches around the edges are long, a skew shows where most edges agree again.
    let lags = (1..=FARTHEST).flat_map(|step| [1.0, -1.0].map(|sign| 0.5 * sign * f64::from(step) * stretch));
    let far = lags.filter_map(|lag| found(lag).transpose()).collect::<Result<Vec<ClockSkew>, Cancelled>>()?;
    let far = far.into_iter().filter(|skew| is_sure(skew) && skew.is_observed());
    let surest = far.max_by(|a, b| a.edges.cmp(&b.edges).then(b.standard_error.total_cmp(&a.standard_error)));
    Ok(surest.or(near))
}

/// A skew is sure if this many times its edges are more than there are.
const SURE: usize = 2;
/// Half stretches by which a skew is sought on either side.
const FARTHEST: u32 = 12;
/// Edges of a record beyond which a skew is not sought farther than next to them.
const MOST_EDGES: usize = 40;

/// Half of the shorter of two segments, s.
fn stretch(record: &Record, (before, after): (&Segment, &Segment)) -> f64 {
    let time = record.time();
    let lasts = |segment: &Segment| time[segment.end - 1] - time[segment.start];
    0.5 * lasts(before).min(lasts(after))
}

/// Force less displacement at one edge.
struct Edge {
    difference: f64,
    error: f64,
    /// Length of the stretch on one side, s.
    stretch: f64,
    /// Time between samples on the side where they are sparser, s.
    interval: f64,
}

/// The kinks at the border of two segments, one of which moves; over a share of 1/`part` of the shorter one, and in the force `lag` s later.
fn edge(
    record: &Record,
    displacement: &[f64],
    (before, after): (&Segment, &Segment),
    (part, lag): (usize, f64),
) -> Option<Edge> {
    let side = (before.len().min(after.len()) / part).min(SAMPLES.1);
    if side < SAMPLES.0 {
        return None;
    }
    let range = after.start - side..after.start + side;
    let times = &record.time()[range.clone()];
    let border = record.time()[after.start];
    let stretch = 0.5 * (times[times.len() - 1] - times[0]);
    let jaw = kink::<3>(times, &displacement[range.clone()], border, 0.6 * stretch)?;
    let late = if lag == 0.0 { after.start } else { record.time().partition_point(|t| *t < border + lag) };
    if late < side || late + side > record.len() {
        return None;
    }
    let range = late - side..late + side;
    let force = kink::<4>(&record.time()[range.clone()], &record.force()[range], border + lag, 0.6 * stretch)?;
    let stands_out = |kink: &Kink| kink.bend.abs() * stretch > 4.0 * kink.noise;
    (stands_out(&jaw) && stands_out(&force)).then_some(Edge {
        difference: force.time - jaw.time,
        error: force.error.hypot(jaw.error),
        stretch,
        interval: (times[side] - times[0]).max(times[2 * side - 1] - times[side - 1]) / side as f64,
    })
}

/// The weighted mean of the edges that agree, with an error that their scatter may widen.
fn combined(edges: &[Edge]) -> Option<ClockSkew> {
    if edges.len() < FEWEST {
        return None;
    }
    let middle = median(&mut edges.iter().map(|edge| edge.difference).collect::<Vec<_>>());
    let away = |edge: &Edge| (edge.difference - middle).abs();
    let deviation = 1.482_6 * median(&mut edges.iter().map(away).collect::<Vec<_>>());
    let stretch = median(&mut edges.iter().map(|edge| edge.stretch).collect::<Vec<_>>());
    let kept: Vec<&Edge> = edges.iter().filter(|edge| away(edge) <= 3.5 * deviation.max(edge.error)).collect();
    if kept.len() < FEWEST || deviation > stretch {
        return None;
    }
    // No edge may count for more than its like: what formal errors leave out is common to all.
    let typical = median(&mut kept.iter().map(|edge| edge.error).collect::<Vec<_>>());
    let weight = |edge: &Edge| 1.0 / edge.error.max(0.5 * typical).max(f64::MIN_POSITIVE.sqrt()).powi(2);
    let sum: f64 = kept.iter().map(|edge| weight(edge)).sum();
    let skew = kept.iter().map(|edge| weight(edge) * edge.difference).sum::<f64>() / sum;
    let scatter = kept.iter().map(|edge| weight(edge) * (edge.difference - skew).powi(2)).sum::<f64>();
    let reduced = scatter / (kept.len() - 1) as f64;
    Some(ClockSkew {
        skew,
        standard_error: (reduced.max(1.0) / sum).sqrt(),
        edges: kept.len(),
        interval: median(&mut kept.iter().map(|edge| edge.interval).collect::<Vec<_>>()),
    })
}
