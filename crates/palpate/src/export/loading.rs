//! Forces in loading and hold by `simulate`, and the error of a model against them.

use super::{Conditions, ExportError};
use crate::simulate::{Contact, Motion, Sampling, simulate};

/// Times of the hold, s, at which the error of a model is stated.
pub const HOLD_TIMES: [f64; 3] = [1.0, 10.0, 60.0];

/// Number of speeds, evenly spaced in their logarithm; a fit takes every `FITTED_SPEED`-th of them.
const SPEEDS: usize = 17;
const FITTED_SPEED: usize = 4;

/// Number of depths for each speed, closer together towards first touch, where errors have their narrowest peaks; a fit takes every
/// `FITTED_DEPTH`-th of them.
const DEPTHS: usize = 473;
const FITTED_DEPTH: usize = 8;

/// The least depth, as a share of the deepest.
const SHALLOWEST: f64 = 1.0 / 60.0;

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
    /// Loadings at several speeds from a sixtieth of the indentation on, 473 depths each, more densely near first touch.
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
    /// Largest absolute error in loading from [`Loading::shallowest`] on.
    pub loading: f64,
    /// Root mean square error in loading, over the depth.
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
            let times: Vec<f64> = (0..DEPTHS).map(|index| duration * depth_share(index)).collect();
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
        self.indentation * SHALLOWEST
    }

    /// The samples that a model is fitted to, 60 depths at up to 5 speeds; the others show what its error is between them.
    pub fn fitted(&self) -> impl Iterator<Item = &LoadingSample> {
        let speeds = self.samples.chunks(DEPTHS).step_by(FITTED_SPEED);
        speeds.flat_map(|depths| depths.iter().step_by(FITTED_DEPTH))
    }

    /// Error of a contact whose force is a function of indentation (m) and its speed (m/s).
    #[must_use]
    pub fn error(&self, force: impl Fn(f64, f64) -> f64) -> CardError {
        let residual = |sample: &LoadingSample| (force(sample.indentation, sample.speed) - sample.force) / self.peak;
        let (mut largest, mut squares, mut weights) = (0.0_f64, 0.0, 0.0);
        for depths in self.samples.chunks(DEPTHS) {
            let residuals: Vec<f64> = depths.iter().map(residual).collect();
            largest = residuals.iter().fold(largest, |largest, by| largest.max(by.abs()));
            for (pair, by) in depths.windows(2).zip(residuals.windows(2)) {
                let step = pair[1].indentation - pair[0].indentation;
                squares += 0.5 * step * (by[0] * by[0] + by[1] * by[1]);
                weights += step;
            }
        }
        let still = force(self.indentation, 0.0);
        let fastest = self.samples.iter().map(|sample| sample.speed).fold(0.0, f64::max);
        CardError {
            loading: largest,
            loading_rms: (squares / weights).sqrt(),
            touch: force(f64::MIN_POSITIVE, fastest) / self.peak,
            hold: self.held.map(|held| (still - held) / self.peak),
        }
    }
}

/// Depth of a sample as a share of the deepest: from the least on, with steps that grow in proportion to their number.
fn depth_share(index: usize) -> f64 {
    let way = index as f64 / (DEPTHS - 1) as f64;
    (SHALLOWEST + (1.0 - SHALLOWEST) * way * way).min(1.0)
}
