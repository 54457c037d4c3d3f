//! Forces in loading and hold by `simulate`, and the error of a model against them.

use super::{Conditions, ExportError};
use crate::simulate::{Contact, Motion, Sampling, simulate};

/// Times of the hold, s, at which the error of a model is stated.
pub const HOLD_TIMES: [f64; 3] = [1.0, 10.0, 60.0];

/// Number of speeds, evenly spaced in their logarithm.
const SPEEDS: usize = 5;

/// Number of depths for each speed.
const DEPTHS: usize = 60;

/// A force in a loading at constant speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadingSample {
    /// Displacement u of the contact (indentation), m.
    pub indentation: f64,
    /// Its speed u̇, m/s.
    pub speed: f64,
    /// Force, N.
    pub force: f64,
}

/// Simulated forces that a contact without memory is fitted to.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// Loadings at several speeds from first touch on, 60 depths each.
    pub samples: Vec<LoadingSample>,
    /// Force at the end of the fastest loading, N; the largest of all.
    pub peak: f64,
    /// Indentation at the end, m.
    pub indentation: f64,
    /// Force in the hold after the fastest loading at [`HOLD_TIMES`], N.
    pub held: [f64; 3],
}

/// Error of a model against [`simulate`](crate::simulate::simulate()), as shares of the peak force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CardError {
    /// Largest absolute error in loading.
    pub loading: f64,
    /// Root mean square error in loading.
    pub loading_rms: f64,
    /// Force of the model at first touch at the fastest speed; the material has none there.
    pub touch: f64,
    /// Error (model less simulation) in the hold at [`HOLD_TIMES`].
    pub hold: [f64; 3],
}

impl Loading {
    /// Simulates the loadings and the hold.
    ///
    /// # Errors
    /// [`ExportError::Simulate`] for a depth that the body does not have.
    pub fn of(contact: &Contact, conditions: Conditions) -> Result<Self, ExportError> {
        let Conditions {
            depth,
            slowest,
            fastest,
            ..
        } = conditions;
        let share = contact.specimen().contact_displacement(1.0);
        let count = if slowest < fastest { SPEEDS } else { 1 };
        let mut samples = Vec::with_capacity(count * DEPTHS);
        for index in 0..count {
            let speed = fastest * (slowest / fastest).powf(index as f64 / (SPEEDS - 1) as f64);
            let duration = depth / speed;
            let motion = Motion::new(vec![0.0, duration], vec![0.0, depth])?;
            let times: Vec<f64> = (1..=DEPTHS).map(|i| duration * (i as f64 / DEPTHS as f64)).collect();
            let course = simulate(&motion, contact, &Sampling::Times(times))?;
            let rows = course.contact_displacement.iter().zip(&course.force);
            samples.extend(rows.map(|(indentation, force)| LoadingSample {
                indentation: *indentation,
                speed: speed * share,
                force: *force,
            }));
        }
        let touched = depth / fastest;
        let times: Vec<f64> = [0.0].iter().chain(&HOLD_TIMES).map(|time| touched + time).collect();
        let motion = Motion::new(vec![0.0, touched, times[3]], vec![0.0, depth, depth])?;
        let course = simulate(&motion, contact, &Sampling::Times(times))?;
        Ok(Self {
            samples,
            peak: course.force[0],
            indentation: depth * share,
            held: [course.force[1], course.force[2], course.force[3]],
        })
    }

    /// The least indentation of the samples, m.
    #[must_use]
    pub fn shallowest(&self) -> f64 {
        self.indentation / DEPTHS as f64
    }

    /// Error of a contact whose force is a function of indentation (m) and its speed (m/s).
    #[must_use]
    pub fn error(&self, force: impl Fn(f64, f64) -> f64) -> CardError {
        let residual = |sample: &LoadingSample| (force(sample.indentation, sample.speed) - sample.force) / self.peak;
        let residuals = self.samples.iter().map(residual);
        let (largest, squares) =
            residuals.fold((0.0, 0.0), |(largest, squares): (f64, f64), by| (largest.max(by.abs()), squares + by * by));
        let still = force(self.indentation, 0.0);
        let fastest = self.samples.iter().map(|sample| sample.speed).fold(0.0, f64::max);
        CardError {
            loading: largest,
            loading_rms: (squares / self.samples.len() as f64).sqrt(),
            touch: force(f64::MIN_POSITIVE, fastest) / self.peak,
            hold: self.held.map(|held| (still - held) / self.peak),
        }
    }
}
