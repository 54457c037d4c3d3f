//! What a calibrated body does under any drive, with intervals.

use serde::{Deserialize, Serialize};

use super::{CalibrateError, CalibrationData, Material};
use crate::analysis::{AnalysisOptions, Geometry};
use crate::number::significant;
use crate::record::Record;
use crate::simulate::{Contact, Drive, ProgramStep, Sampling, SimulateError, Trajectory, simulate_watched};
use crate::statistics::coverage_factor;
use crate::watch::{Cancelled, Stages, Unwatched, Watch};

/// A question beyond what the test has tested.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Extrapolation {
    /// A longer hold than any of the test.
    LongerHold {
        /// What was requested, s.
        requested: f64,
        /// What was tested, s.
        tested: f64,
    },
    /// A deeper squeeze.
    DeeperSqueeze {
        /// What was requested, m.
        requested: f64,
        /// What was tested, m.
        tested: f64,
    },
    /// A faster ramp.
    FasterRamp {
        /// What was requested, m/s.
        requested: f64,
        /// What was tested, m/s.
        tested: f64,
    },
    /// A larger force.
    LargerForce {
        /// What was requested, N.
        requested: f64,
        /// What was tested, N.
        tested: f64,
    },
    /// A force that is held, which no test in displacement shows.
    ForceHeld,
}

impl std::fmt::Display for Extrapolation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = |value: f64| significant(value, 3);
        match *self {
            Self::LongerHold { requested, tested } => write!(
                f,
                "the longest hold lasts {} s, that of the test {} s: later forces are extrapolated by the law",
                digits(requested),
                digits(tested)
            ),
            Self::DeeperSqueeze { requested, tested } => write!(
                f,
                "the largest displacement is {} mm, that of the test {} mm: the equilibrium force beyond it is extrapolated",
                digits(1e3 * requested),
                digits(1e3 * tested)
            ),
            Self::FasterRamp { requested, tested } => write!(
                f,
                "the fastest ramp is {} mm/s, that of the test {} mm/s: the peak force may differ",
                digits(1e3 * requested),
                digits(1e3 * tested)
            ),
            Self::LargerForce { requested, tested } => {
                write!(
                    f,
                    "the largest force is {} N, that of the test {} N: the equilibrium force beyond it is extrapolated",
                    digits(requested),
                    digits(tested)
                )
            }
            Self::ForceHeld => {
                write!(
                    f,
                    "the force is held, while the test held the displacement: the law predicts creep that was not observed"
                )
            }
        }
    }
}

/// A predicted course with its uncertainty; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Prediction {
    /// The course with the best parameters.
    pub trajectory: Trajectory,
    /// Standard error of the force (N) from the uncertainty of the calibration; 0 everywhere if that is not determined.
    pub force_standard_error: Vec<f64>,
    /// The same of the displacement of the jaw (m); 0 where the displacement is requested for.
    pub displacement_standard_error: Vec<f64>,
    /// Standard deviation of the force residuals of the calibration, N: noise of one reading.
    pub noise: f64,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// How many standard deviations they are wide, on either side.
    pub factor: f64,
    /// What was requested beyond the test.
    pub extrapolations: Vec<Extrapolation>,
}

checked_when_read!(Prediction, "a standard error for each sample", |found: &Prediction| {
    let count = found.trajectory.len();
    found.force_standard_error.len() == count && found.displacement_standard_error.len() == count
});

impl Prediction {
    /// Ends of the interval of the mean force at sample `index`, N: what the parameters leave open.
    #[must_use]
    pub fn force_interval(&self, index: usize) -> (f64, f64) {
        let (force, half) = (self.trajectory.force[index], self.factor * self.force_standard_error[index]);
        (force - half, force + half)
    }

    /// Ends of the interval of the displacement of the jaw at sample `index`, m; they coincide where the displacement is prescribed.
    #[must_use]
    pub fn displacement_interval(&self, index: usize) -> (f64, f64) {
        let (place, half) =
            (self.trajectory.displacement[index], self.factor * self.displacement_standard_error[index]);
        (place - half, place + half)
    }

    /// Ends of the interval of one reading of the force at sample `index`, N: parameters and noise.
    #[must_use]
    pub fn reading_interval(&self, index: usize) -> (f64, f64) {
        let half = self.factor * self.force_standard_error[index].hypot(self.noise);
        let force = self.trajectory.force[index];
        (force - half, force + half)
    }
}

impl Material {
    /// Simulates the body under a drive, with intervals from its calibration.
    ///
    /// The variance by the parameters is that of differences of simulations along the columns of a root L of their covariance C = L Lᵀ, one
    /// standard deviation to either side: Σ_k ((f(+L_k) − f(−L_k))/2)².
    ///
    /// # Errors
    /// As for [`simulate`](crate::simulate::simulate()).
    pub fn predict<'a>(
        &self,
        drive: impl Into<Drive<'a>>,
        sampling: &Sampling,
        confidence: f64,
    ) -> Result<Prediction, SimulateError> {
        self.predict_watched(drive, sampling, confidence, &mut Unwatched)
    }

    /// As [`predict`](Self::predict), heard by `watch` as each of the simulations is.
    ///
    /// # Errors
    /// As for [`simulate`](crate::simulate::simulate()), and [`SimulateError::Cancelled`].
    pub fn predict_watched<'a>(
        &self,
        drive: impl Into<Drive<'a>>,
        sampling: &Sampling,
        confidence: f64,
        watch: &mut dyn Watch,
    ) -> Result<Prediction, SimulateError> {
        self.predicted(drive.into(), sampling, confidence, watch)
    }

    /// The same along the measured displacement of a record, at the times (s) `at` on its clock, or at its samples if there are none: corrected,
    /// cut and set to zero at first touch as [`CalibrationData::of_record`] does, with this body in place of the one of `options`. The
    /// record's force serves to find first touch alone.
    ///
    /// # Errors
    /// As for [`CalibrationData::of_record`] and [`predict`](Self::predict).
    pub fn predict_record(
        &self,
        record: &Record,
        options: &AnalysisOptions,
        at: &[f64],
        confidence: f64,
        watch: &mut dyn Watch,
    ) -> Result<Prediction, CalibrateError> {
        let options = AnalysisOptions {
            geometry: Some(Geometry {
                shape: self.body().shape.clone(),
                sides: self.body().sides,
                modulus: None,
                equilibrium: self.contact().specimen().equilibrium().clone(),
            }),
            separation: self.body().separation,
            ..options.clone()
        };
        let data = CalibrationData::of_record(record, &options)?;
        let times = if at.is_empty() { data.times() } else { at };
        Ok(self.predict_watched(data.motion(), &Sampling::Times(times.to_vec()), confidence, watch)?)
    }

    /// Without generics, so that it is compiled here, once, and not wherever it is called.
    fn predicted(
        &self,
        drive: Drive<'_>,
        sampling: &Sampling,
        confidence: f64,
        watch: &mut dyn Watch,
    ) -> Result<Prediction, SimulateError> {
        let best = self.contact();
        let directions = self.directions();
        let share = 1.0 / (1.0 + 2.0 * directions.len() as f64);
        let mut stages = Stages::new("predicting".to_owned(), watch);
        stages.enter(share);
        let trajectory = simulate_watched(drive, best, sampling, &mut stages)?;
        let count = trajectory.len();
        let (mut force, mut displacement) = (vec![0.0; count], vec![0.0; count]);
        let times = Sampling::Times(trajectory.time.clone());
        let longer = continued(drive, &trajectory);
        let others = longer.as_ref().map_or(drive, Drive::from);
        for direction in directions {
            let mut course = |contact: &Contact| {
                stages.enter(share);
                match simulate_watched(others, contact, &times, &mut stages) {
                    Err(SimulateError::Cancelled(cancelled)) => Err(cancelled),
                    course => Ok(course.ok()),
                }
            };
            let Some((high, low, width)) = both_sides(self, &direction, &mut course)? else {
                continue;
            };
            for (sum, (high, low)) in force.iter_mut().zip(high.force.iter().zip(&low.force)) {
                *sum += ((high - low) / width).powi(2);
            }
            for (sum, (high, low)) in displacement.iter_mut().zip(high.displacement.iter().zip(&low.displacement)) {
                *sum += ((high - low) / width).powi(2);
            }
        }
        let freedom = self.uncertainty().map_or(f64::INFINITY, |uncertainty| uncertainty.freedom);
        stages.finish()?;
        Ok(Prediction {
            extrapolations: self.extrapolations(drive, &trajectory),
            trajectory,
            force_standard_error: force.into_iter().map(f64::sqrt).collect(),
            displacement_standard_error: displacement.into_iter().map(f64::sqrt).collect(),
            noise: self.noise(),
            confidence,
            factor: coverage_factor(confidence, freedom),
        })
    }

    /// Columns of a root of the covariance of the logarithms of the parameters: independent directions, each one standard deviation long.
    #[must_use]
    pub fn directions(&self) -> Vec<Vec<f64>> {
        self.uncertainty().map_or_else(Vec::new, |uncertainty| root(&uncertainty.covariance))
    }

    fn extrapolations(&self, drive: Drive<'_>, course: &Trajectory) -> Vec<Extrapolation> {
        /// By how much more than was tested a question may ask.
        const MORE: f64 = 1.05;
        let tested = self.range();
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let (mut longest, mut fastest, mut held) = (0.0f64, 0.0f64, false);
        match drive {
            Drive::Motion(motion) => {
                let still = 0.01 * most(motion.displacements());
                let simple = motion.simplified(still);
                for (times, places) in simple.times().windows(2).zip(simple.displacements().windows(2)) {
                    let (duration, way) = (times[1] - times[0], (places[1] - places[0]).abs());
                    if way <= 2.0 * still {
                        longest = longest.max(duration);
                    } else {
                        fastest = fastest.max(way / duration);
                    }
                }
            }
            Drive::Force(_) => held = true,
            Drive::Program(steps) => {
                for step in steps {
                    match *step {
                        ProgramStep::Move { rate, .. } | ProgramStep::MoveToForce { rate, .. } => {
                            fastest = fastest.max(rate);
                        }
                        ProgramStep::HoldPosition { duration } => longest = longest.max(duration),
                        ProgramStep::Press { .. } | ProgramStep::HoldForce { .. } => held = true,
                    }
                }
            }
        }
        type Requested = (f64, f64, fn(f64, f64) -> Extrapolation);
        let kinds: [Requested; 4] = [
            (longest, tested.longest_hold, |requested, tested| Extrapolation::LongerHold { requested, tested }),
            (most(&course.displacement), tested.deepest, |requested, tested| Extrapolation::DeeperSqueeze {
                requested,
                tested,
            }),
            (fastest, tested.fastest, |requested, tested| Extrapolation::FasterRamp { requested, tested }),
            (most(&course.force), tested.largest_force, |requested, tested| Extrapolation::LargerForce {
                requested,
                tested,
            }),
        ];
        let beyond = kinds.into_iter().filter(|(requested, tested, _)| *requested > MORE * tested);
        let found = beyond.map(|(requested, tested, kind)| kind(requested, tested));
        found.chain(held.then_some(Extrapolation::ForceHeld)).collect()
    }
}

/// A program with its last hold going on: steps that end at a force end earlier with other parameters, and samples must not lie behind.
fn continued(drive: Drive<'_>, course: &Trajectory) -> Option<Vec<ProgramStep>> {
    let Drive::Program(steps) = drive else {
        return None;
    };
    let duration = course.time.last().copied().filter(|end| *end > 0.0)?;
    let last = match steps.last()? {
        ProgramStep::Press { .. } | ProgramStep::HoldForce { .. } => ProgramStep::HoldForce { duration },
        _ => ProgramStep::HoldPosition { duration },
    };
    Some(steps.iter().copied().chain([last]).collect())
}

/// What comes out on either side of the best parameters along a direction, and how many standard deviations lie between; closer by where
/// the full way cannot be simulated.
fn both_sides<T>(
    material: &Material,
    direction: &[f64],
    result: &mut impl FnMut(&Contact) -> Result<Option<T>, Cancelled>,
) -> Result<Option<(T, T, f64)>, Cancelled> {
    let mut off = |by: f64| {
        let factors: Vec<f64> = direction.iter().map(|log| (by * log).exp()).collect();
        material.contact_off(&factors).map_or(Ok(None), |contact| result(&contact))
    };
    let mut by = 1.0;
    for _ in 0..8 {
        if let (Some(high), Some(low)) = (off(by)?, off(-by)?) {
            return Ok(Some((high, low, 2.0 * by)));
        }
        by *= 0.25;
    }
    Ok(None)
}

/// Columns L_k with C = Σ L_k L_kᵀ, of a covariance that may be singular: Cholesky's method, the largest diagonal first.
fn root(covariance: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = covariance.len();
    let mut left: Vec<Vec<f64>> = covariance.to_vec();
    let largest = (0..size).map(|i| covariance[i][i]).fold(0.0, f64::max);
    let mut columns = Vec::new();
    for _ in 0..size {
        let Some(pivot) = (0..size).max_by(|a, b| left[*a][*a].total_cmp(&left[*b][*b])) else {
            break;
        };
        if left[pivot][pivot] <= 1e-14 * largest {
            break;
        }
        let scale = 1.0 / left[pivot][pivot].sqrt();
        let column: Vec<f64> = left.iter().map(|row| row[pivot] * scale).collect();
        for (row, a) in left.iter_mut().zip(&column) {
            for (entry, b) in row.iter_mut().zip(&column) {
                *entry -= a * b;
            }
        }
        columns.push(column);
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_gives_back_its_covariance_even_a_singular_one() {
        let covariance = vec![vec![4.0, 2.0, 0.0], vec![2.0, 1.0, 0.0], vec![0.0, 0.0, 9.0]];
        let columns = root(&covariance);
        assert_eq!(columns.len(), 2);
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = columns.iter().map(|column| column[i] * column[j]).sum();
                assert!((entry - covariance[i][j]).abs() < 1e-14);
            }
        }
    }
}
