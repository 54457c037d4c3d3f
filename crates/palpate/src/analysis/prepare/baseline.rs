//! The errors of a baseline that was taken off the force.

use std::ops::Range;

use crate::fit::{Assessed, Scale};
use crate::record::{Baseline, Record, rounding_step};
use crate::segment::{ContactPoint, ForceDrift};
use crate::statistics::{mean, median};

/// Samples that more of them are averaged to.
const MOST: usize = 1000;
/// Standard error of a median over that of the mean, of many samples of a normal distribution.
const MEDIAN: f64 = 1.253_3;

/// The standard errors of a baseline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::analysis) struct BaselineError {
    /// Of its level, N.
    level: f64,
    /// Of its slope, if it is a line.
    drift: Option<ForceDrift>,
}

impl BaselineError {
    /// Those of the baseline that was taken off the force of a record, from what is left in its samples without contact: the errors of least
    /// squares under the noise that these show, slow noise too, times 1.2533, since the baseline is one of medians.
    ///
    /// Samples beyond five robust standard deviations, which medians do not follow, count as that far off.
    pub(super) fn of(record: &Record, baseline: Baseline, free: &[Range<usize>]) -> Option<Self> {
        const FAR: f64 = 5.0 * 1.482_6;
        let free: Vec<usize> = free.iter().flat_map(|range| range.start..range.end.min(record.len())).collect();
        let together = free.len().div_ceil(MOST);
        let blocks = |values: &[f64]| -> Vec<f64> {
            let of_block = |block: &[usize]| mean(&block.iter().map(|index| values[*index]).collect::<Vec<_>>());
            free.chunks(together.max(1)).map(of_block).collect()
        };
        let (times, mut left) = (blocks(record.time()), blocks(record.force()));
        // Most samples of a coarse load cell may show the same force.
        let step = rounding_step(record.force()).unwrap_or(0.0);
        let far = (FAR * median(&mut left.iter().map(|force| force.abs()).collect::<Vec<_>>())).max(step);
        left.iter_mut().for_each(|force| *force = force.clamp(-far, far));
        let about = mean(&times);
        let mut columns = vec![vec![1.0; times.len()]];
        if baseline == Baseline::Sloped {
            columns.push(times.iter().map(|time| time - about).collect());
        }
        let size = columns.len();
        let line = Assessed::of_columns(columns, (&left.clone(), left), 0.95).ok()?;
        let error = |of: &[f64]| Some(MEDIAN * line.estimate(0.0, of, Scale::Linear).standard_error?);
        let drift = match baseline {
            Baseline::Constant => None,
            Baseline::Sloped => Some(ForceDrift {
                standard_error: error(&[0.0, 1.0])?,
                about,
            }),
        };
        Some(Self {
            level: error(&[1.0, 0.0][..size])?.hypot(step / 12f64.sqrt()),
            drift,
        })
    }

    /// First touch of the record with these errors: of the slope, and of the level where the zero of the force was not found anew, before first
    /// touch, where the slope is no error then.
    pub(super) fn added_to(self, contact: ContactPoint, record: &Record) -> ContactPoint {
        let before = &record.time()[..contact.sample.unwrap_or(0).min(record.len())];
        let is_anew = contact.force_error.is_some() && !before.is_empty();
        let drift = self.drift.map(|drift| ForceDrift {
            about: if is_anew { mean(before) } else { drift.about },
            ..drift
        });
        ContactPoint {
            force_error: contact.force_error.or(Some(self.level)),
            force_drift: drift,
            ..contact
        }
    }
}
