//! The dense relaxation spectrum: exponentials of all times at once, none of opposite sign.
//!
//! ```text
//! y(t) = y_e + s Σ_j h_j exp(−t/τ_j),   h_j ≥ 0,   s = ±1
//! ```
//!
//! The times τ_j are a grid, not parameters to find, so the fit is linear least squares with bounds: it has one optimum and
//! needs no start. Parameters of the law it has none; it is what any sum of relaxing parts can do, and hence the alternative
//! that a law has to match in predicting a hold. The rule for grid and smoothing and its evidence:
//! `docs/theory/spectrum.md`.

mod normal;
mod result;
mod strength;

use normal::{GONE, Normal};
use serde::{Deserialize, Serialize};
use strength::Smoother;

use crate::fit::error::FitError;
use crate::fit::samples::check_finite;
use crate::latency::decay_many;
pub use result::{SpectrumFit, SpectrumPeak};

/// Grid times are no shorter than this share of the hold, however early its second sample.
const SHORTEST: f64 = 1e-6;

/// How strongly neighbouring amplitudes are drawn to each other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// As strongly as the residual allows: it may exceed the least by one standard deviation of its own noise,
    /// RSS ≤ RSS_least (1 + √(2 W)/N) with N samples of weights that add up to W; √(2/N) without weights.
    #[default]
    Automatic,
    /// With this μ in (mean square residual)/range² + μ Σ (h_{j+1} − h_j)²/range², from 10⁻¹² to 10¹².
    Given(f64),
}

/// Options of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SpectrumOptions {
    /// Grid times a factor of ten, 1 to 10.
    pub points_per_decade: u32,
    /// The slowest grid time in durations of the hold, 0.1 to 1000.
    pub slowest: f64,
    /// How strongly the spectrum is smoothed.
    pub smoothing: Smoothing,
    /// The equilibrium where it is known, in units of the signal; otherwise it is found.
    pub equilibrium: Option<f64>,
}

impl Default for SpectrumOptions {
    fn default() -> Self {
        Self {
            points_per_decade: 8,
            slowest: 10.0,
            smoothing: Smoothing::Automatic,
            equilibrium: None,
        }
    }
}

impl SpectrumOptions {
    fn check(&self) -> Result<(), FitError> {
        let refuse = |setting: &'static str, found: f64| Err(FitError::SpectrumSetting { setting, found });
        match (self.smoothing, self.equilibrium) {
            _ if !(1..=10).contains(&self.points_per_decade) => {
                refuse("points per decade (1 to 10)", f64::from(self.points_per_decade))
            }
            _ if !(0.1..=1000.0).contains(&self.slowest) => refuse("the slowest time (0.1 to 1000)", self.slowest),
            (Smoothing::Given(strength), _) if !(1e-12..=1e12).contains(&strength) => {
                refuse("the strength of smoothing (1e-12 to 1e12)", strength)
            }
            (_, Some(fixed)) if !fixed.is_finite() => refuse("a known equilibrium (a finite number)", fixed),
            _ => Ok(()),
        }
    }
}

/// Fits a spectrum of exponentials to a hold.
///
/// `times` in s rise from the start of the hold (their first value is its zero); `values` are strain, force or stress,
/// one a time. `roots` are square roots of weights: a weight of k counts a sample k times, as the mean of k samples
/// deserves, and one of 0 leaves it out. Weights that are no counts should have a mean of 1, for their sum is taken for
/// the number of samples. The units of time and signal change nothing but units.
///
/// The grid runs from the first sample step (no less than 10⁻⁶ of the hold) to [`SpectrumOptions::slowest`] durations.
/// Amplitudes are bounded, so they have no standard errors, and neighbours share their weight as the smoothing bids:
/// read [`SpectrumFit::peaks`] and [`SpectrumFit::predict`], not single amplitudes.
///
/// ```
/// use palpate::fit::{SpectrumOptions, fit_spectrum};
/// // 2 + exp(−t/0.5 s) + exp(−t/10 s) over 60 s
/// let times: Vec<f64> = (0..600).map(|i| 0.1 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 2.0 + (-t / 0.5).exp() + (-t / 10.0).exp()).collect();
/// let fit = fit_spectrum(&times, &values, None, &SpectrumOptions::default())?;
/// assert!((fit.equilibrium - 2.0).abs() < 2e-3);
/// let peaks = fit.peaks();
/// assert_eq!(peaks.len(), 2);
/// assert!((peaks[0].time / 0.5 - 1.0).abs() < 0.02 && (peaks[1].time / 10.0 - 1.0).abs() < 0.02);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for unequal lengths, fewer than five samples of weight, parameters that are not finite, times that do not
/// rise, weights that are none, options out of range, or values that are all the same.
pub fn fit_spectrum(
    times: &[f64],
    values: &[f64],
    roots: Option<&[f64]>,
    options: &SpectrumOptions,
) -> Result<SpectrumFit, FitError> {
    options.check()?;
    let scaled = Scaled::new(times, values, roots)?;
    let grid = scaled.grid(options);
    let constant = options.equilibrium.map(|fixed| (fixed - scaled.center) / scaled.range);
    if constant.is_some_and(|fixed| !fixed.is_finite()) {
        return Err(FitError::OutOfRange);
    }
    scaled.fit(&grid, constant, options.smoothing).ok_or(FitError::OutOfRange)
}

/// A hold in units of its own duration and range, without samples of no weight.
struct Scaled {
    times: Vec<f64>,
    values: Vec<f64>,
    roots: Vec<f64>,
    duration: f64,
    weight: f64,
    center: f64,
    range: f64,
}

impl Scaled {
    fn new(times: &[f64], values: &[f64], roots: Option<&[f64]>) -> Result<Self, FitError> {
        check(times, values, roots)?;
        let root = |i: usize| roots.map_or(1.0, |roots| roots[i]);
        let kept: Vec<usize> = (0..times.len()).filter(|i| root(*i) > 0.0).collect();
        FitError::check_samples(3, kept.len())?;
        let span = |(low, high): (f64, f64), i: &usize| (low.min(values[*i]), high.max(values[*i]));
        let (low, high) = kept.iter().fold((f64::MAX, f64::MIN), span);
        FitError::check_change(low, high, kept.len())?;
        let (start, range) = (times[0], high - low);
        let duration = times[kept[kept.len() - 1]] - start;
        let weight: f64 = kept.iter().map(|i| root(*i) * root(*i)).sum();
        let invertible = |span: f64| span.is_finite() && (1.0 / span).is_finite();
        if !(invertible(range * range) && invertible(duration) && invertible(weight)) {
            return Err(FitError::OutOfRange);
        }
        let center = low + 0.5 * range;
        let (per_duration, per_range) = (1.0 / duration, 1.0 / range);
        Ok(Self {
            times: kept.iter().map(|i| (times[*i] - start) * per_duration).collect(),
            values: kept.iter().map(|i| (values[*i] - center) * per_range).collect(),
            roots: kept.iter().map(|i| root(*i)).collect(),
            duration,
            weight,
            center,
            range,
        })
    }

    /// Share of the least residual that smoothing may add: one standard deviation of what noise alone leaves.
    ///
    /// A mean of w samples keeps a w-th of their variance, so N weighted squares add up to N σ², and what all W samples
    /// would have scattered by, σ² √(2 W), is √(2 W)/N of that.
    fn slack(&self) -> f64 {
        (2.0 * self.weight).sqrt() / self.times.len() as f64
    }

    /// Times of the spectrum in durations of the hold, evenly spaced in ln τ.
    fn grid(&self, options: &SpectrumOptions) -> Vec<f64> {
        let shortest = (self.times[1] - self.times[0]).clamp(SHORTEST, 0.5 * options.slowest);
        let decades = (options.slowest / shortest).log10();
        // A span of whole steps is not to gain one more by rounding.
        let steps = (decades * f64::from(options.points_per_decade) - 1e-6).ceil().max(1.0);
        (0..=steps as u32).map(|j| shortest * 10f64.powf(decades * f64::from(j) / steps)).collect()
    }

    /// The sign that fits better with next to no smoothing, and the smoothing requested; in the units of the caller.
    fn fit(&self, grid: &[f64], constant: Option<f64>, smoothing: Smoothing) -> Option<SpectrumFit> {
        let normal = Normal::new(&self.times, &self.values, &self.roots, grid);
        let mut tried = Vec::with_capacity(2);
        for sign in [1.0, -1.0] {
            let mut smoother = Smoother::new(&normal, sign, constant);
            let decades = smoother.decades();
            let least = decades.last()?.residual;
            tried.push((least, sign, smoother, decades));
        }
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (least, sign, mut smoother, decades) = tried.swap_remove(0);
        let limit = least * (1.0 + self.slack());
        let smoothed = match smoothing {
            Smoothing::Automatic => smoother.strongest(&decades, limit)?,
            Smoothing::Given(strength) => smoother.solve(strength)?,
        };
        let (amplitudes, constant) = smoothed.parameters.split_at(grid.len());
        let unit = self.weight * self.range * self.range;
        Some(SpectrumFit {
            equilibrium: self.center + constant[0] * self.range,
            sign,
            times: grid.iter().map(|time| time * self.duration).collect(),
            amplitudes: amplitudes.iter().map(|height| height.abs() * self.range).collect(),
            duration: self.duration,
            strength: smoothed.strength,
            effective_parameters: smoother.effective_parameters(&smoothed),
            residual_square: self.residual_square(grid, &smoothed.parameters) * self.range * self.range,
            least_residual_square: least * unit,
            residual_limit: limit * unit,
            samples: self.times.len(),
            weight: self.weight,
        })
    }

    /// Weighted sum of squares that `parameters` leave, from the samples themselves.
    fn residual_square(&self, grid: &[f64], parameters: &[f64]) -> f64 {
        let mut left: Vec<f64> = self.values.iter().map(|value| value - parameters[grid.len()]).collect();
        let mut term = vec![0.0; left.len()];
        for (time, height) in grid.iter().zip(parameters).filter(|(_, height)| **height != 0.0) {
            let until = self.times.partition_point(|t| *t <= GONE * time);
            decay_many(&self.times[..until], 1.0 / time, 1.0, &mut term[..until]);
            left.iter_mut().zip(&term[..until]).for_each(|(left, term)| *left -= height * term);
        }
        left.iter().zip(&self.roots).map(|(left, root)| (left * root).powi(2)).sum()
    }
}

/// Refuses what no fit can be made of.
fn check(times: &[f64], values: &[f64], roots: Option<&[f64]>) -> Result<(), FitError> {
    FitError::check_lengths(times.len(), values.len())?;
    FitError::check_lengths(times.len(), roots.map_or(times.len(), <[f64]>::len))?;
    check_finite([("time", times), ("value", values)])?;
    if let Some(index) = roots.and_then(|roots| roots.iter().position(|root| !(root.is_finite() && *root >= 0.0))) {
        return Err(FitError::Weight { index });
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(FitError::TimeNotRising { index: before + 1 }),
        None => Ok(()),
    }
}
