//! The force without contact, taken off the whole record.

use std::ops::Range;

use crate::record::{Baseline, Correction, Record, RecordError};
use crate::statistics::median;

impl Record {
    /// The record less the force that it shows without contact, in the samples of `free`.
    ///
    /// The constant is the median there. The line goes through medians of up to 201 blocks, its slope the median of the
    /// slopes between all pairs of them (Theil 1950, Sen 1968): a third of the blocks may be wrong without harm.
    ///
    /// # Errors
    /// [`RecordError::NoBaseline`] if fewer than five samples are free, or two for a line do not differ in time.
    pub fn without_baseline(&self, baseline: Baseline, free: &[Range<usize>]) -> Result<Self, RecordError> {
        const FEWEST: usize = 5;
        let samples: Vec<usize> = free.iter().flat_map(|range| range.start..range.end.min(self.len())).collect();
        if samples.len() < FEWEST {
            return Err(RecordError::NoBaseline {
                needed: FEWEST,
                found: samples.len(),
            });
        }
        let start = self.time[0];
        let slope = match baseline {
            Baseline::Constant => 0.0,
            Baseline::Sloped => self.slope(&samples),
        };
        let level = |sample: &usize| self.force[*sample] - slope * (self.time[*sample] - start);
        let level = median(&mut samples.iter().map(level).collect::<Vec<_>>());
        let pairs = self.force.iter().zip(&self.time);
        let force = pairs.map(|(force, time)| force - level - slope * (time - start)).collect();
        let done = Correction::BaselineRemoved {
            baseline,
            level,
            slope,
            samples: samples.len(),
        };
        self.with_force(force, done)
    }

    /// The median slope of the force between blocks of the samples, N/s.
    fn slope(&self, samples: &[usize]) -> f64 {
        const BLOCKS: usize = 201;
        let middle =
            |values: &[f64], block: &[usize]| median(&mut block.iter().map(|i| values[*i]).collect::<Vec<_>>());
        let size = samples.len().div_ceil(BLOCKS);
        let points: Vec<(f64, f64)> =
            samples.chunks(size).map(|block| (middle(&self.time, block), middle(&self.force, block))).collect();
        let mut slopes = Vec::new();
        for (index, (t0, f0)) in points.iter().enumerate() {
            slopes.extend(points[index + 1..].iter().filter(|(t1, _)| t1 > t0).map(|(t1, f1)| (f1 - f0) / (t1 - t0)));
        }
        if slopes.is_empty() { 0.0 } else { median(&mut slopes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    /// A drifting load cell, touched between samples 200 and 700; two rows of the free part are wrong.
    fn drifting() -> Record {
        let mut random = Rng::new(3);
        let time: Vec<f64> = (0..900).map(|i| 7.0 + 0.01 * f64::from(i)).collect();
        let touched = |i: usize| if (200..700).contains(&i) { 5.0 } else { 0.0 };
        let drift = |i: usize| 0.3 + 0.05 * (time[i] - 7.0);
        let mut force: Vec<f64> = (0..900).map(|i| touched(i) + drift(i) + 0.01 * random.normal()).collect();
        (force[20], force[800]) = (4.0, -9.0);
        Record::new(time, None, force).unwrap()
    }

    #[test]
    fn a_line_through_both_ends_takes_the_drift_away() {
        let record = drifting();
        let net = record.without_baseline(Baseline::Sloped, &[0..200, 700..900]).unwrap();
        let [
            Correction::BaselineRemoved {
                level,
                slope,
                samples: 400,
                ..
            },
        ] = net.corrections()
        else {
            panic!("{:?}", net.corrections())
        };
        assert!((level - 0.3).abs() < 3e-3 && (slope - 0.05).abs() < 1e-3, "{level} {slope}");
        let worst = (200..700).map(|i| (net.force()[i] - 5.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.05, "{worst}");
    }

    #[test]
    fn a_constant_is_a_median() {
        let net = drifting().without_baseline(Baseline::Constant, std::slice::from_ref(&(0..9))).unwrap();
        let [
            Correction::BaselineRemoved {
                level,
                slope: 0.0,
                samples: 9,
                ..
            },
        ] = net.corrections()
        else {
            panic!("{:?}", net.corrections())
        };
        assert!((level - 0.302).abs() < 0.02);
    }

    #[test]
    fn too_little_free_force_is_an_error() {
        let error = drifting().without_baseline(Baseline::Constant, std::slice::from_ref(&(0..3))).unwrap_err();
        assert_eq!(error.to_string(), "a baseline needs 5 or more samples without contact, found 3");
        assert!(drifting().without_baseline(Baseline::Sloped, std::slice::from_ref(&(899..5000))).is_err());
    }
}
