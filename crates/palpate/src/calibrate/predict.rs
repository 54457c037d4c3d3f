//! What a calibrated body does under any drive, with intervals.

use serde::{Deserialize, Serialize};

use super::extrapolation::{Beyond, Extrapolation};
use super::{CalibrateError, CalibrationData, Material};
use crate::analysis::{AnalysisOptions, Geometry};
use crate::record::Record;
use crate::simulate::{Contact, Drive, ProgramStep, Sampling, SimulateError, Trajectory, simulate_watched};
use crate::statistics::{coverage_factor, normal_factor};
use crate::watch::{Cancelled, Stages, Unwatched, Watch};

/// A predicted course with its uncertainty; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Prediction {
    /// The course with the best parameters.
    pub trajectory: Trajectory,
    /// Standard error of the force (N) from the uncertainty of the calibration, and from what lies beyond the test; `None` where the test
    /// leaves a parameter open, so that it is not known.
    pub force_standard_error: Option<Vec<f64>>,
    /// The same of the displacement of the jaw (m); 0 where the displacement is prescribed.
    pub displacement_standard_error: Option<Vec<f64>>,
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
    let is_complete = |errors: &Option<Vec<f64>>| errors.as_ref().is_none_or(|errors| errors.len() == count);
    is_complete(&found.force_standard_error) && is_complete(&found.displacement_standard_error)
});

impl Prediction {
    /// Ends of the interval of the mean force at sample `index`, N: what the parameters leave open, and what lies beyond the test. `None` where
    /// it is not known.
    #[must_use]
    pub fn force_interval(&self, index: usize) -> Option<(f64, f64)> {
        let error = self.force_standard_error.as_ref()?[index];
        Some(self.interval(self.trajectory.force[index], error))
    }

    /// Ends of the interval of the displacement of the jaw at sample `index`, m; they coincide where the displacement is prescribed. `None`
    /// where it is not known.
    #[must_use]
    pub fn displacement_interval(&self, index: usize) -> Option<(f64, f64)> {
        let error = self.displacement_standard_error.as_ref()?[index];
        Some(self.interval(self.trajectory.displacement[index], error))
    }

    /// Ends of the interval of one reading of the force at sample `index`, N: those of its mean, and noise. `None` where it is not known.
    #[must_use]
    pub fn reading_interval(&self, index: usize) -> Option<(f64, f64)> {
        let error = self.force_standard_error.as_ref()?[index].hypot(self.noise);
        Some(self.interval(self.trajectory.force[index], error))
    }

    fn interval(&self, value: f64, error: f64) -> (f64, f64) {
        (value - self.factor * error, value + self.factor * error)
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
        let beyond = Beyond::of(self, drive, &trajectory, &mut stages)?;
        stages.finish()?;
        let factor = coverage_factor(confidence, freedom);
        // A judgement is no sample: few degrees of freedom of the calibration do not widen it.
        let share = (normal_factor(confidence) / factor).powi(2);
        let errors = |inside: Vec<f64>, beyond: &[f64]| {
            let sum = inside.iter().zip(beyond).map(|(inside, beyond)| (inside + share * beyond).sqrt());
            self.uncertainty().map(|_| sum.collect())
        };
        Ok(Prediction {
            trajectory,
            force_standard_error: errors(force, &beyond.force),
            displacement_standard_error: errors(displacement, &beyond.displacement),
            extrapolations: beyond.extrapolations,
            noise: self.noise(),
            confidence,
            factor,
        })
    }

    /// Columns of a root of the covariance of the logarithms of the parameters, and of the dimensions of the body where these are
    /// uncertain: independent directions, each one standard deviation long.
    #[must_use]
    pub fn directions(&self) -> Vec<Vec<f64>> {
        let Some(uncertainty) = self.uncertainty() else {
            return Vec::new();
        };
        let mut joint = uncertainty.covariance.clone();
        let known = joint.len();
        let size = uncertainty.systematic.first().map_or(known, |effect| effect.logs.len());
        joint.iter_mut().for_each(|row| row.resize(size, 0.0));
        joint.resize(size, vec![0.0; size]);
        for effect in &uncertainty.systematic {
            let beyond = (0..size).flat_map(|i| (0..size).map(move |j| (i, j))).filter(|(i, j)| *i.max(j) >= known);
            beyond.for_each(|(i, j)| joint[i][j] += effect.logs[i] * effect.logs[j]);
        }
        root(&joint)
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
