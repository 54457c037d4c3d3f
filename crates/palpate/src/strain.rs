//! From force and displacement to strain at the contact, and to the strain rate of noisy, irregular samples: equations (6) to (9).

use serde::{Deserialize, Serialize};

use crate::contact::Specimen;

/// Strain ε = f/(E A(u₁)) of the contact layer, equations (6) and (8), or `None` where there is no contact area.
///
/// `force` in N and `displacement` of the jaw in m, both positive in the direction of loading and counted from first touch.
/// The area is taken at the contact's own share u₁ of the travel (half of it when squeezed from two sides), as in
/// equation (11). A ball at or before first touch has no area, and its strain is undefined.
///
/// ```
/// use palpate::contact::{Shape, Sides, Specimen};
/// use palpate::strain::contact_strain;
/// let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
/// // 5 mm of travel, 1.5561334317 N: equilibrium 2.5/35 plus excess 0.0334037
/// let strain = contact_strain(1.556_133_431_7, 0.005, &ball).unwrap();
/// assert!((strain - (2.5 / 35.0 + 0.033_403_736_6)).abs() < 1e-9);
/// assert_eq!(contact_strain(0.1, 0.0, &ball), None);
/// # Ok::<(), palpate::contact::SpecimenError>(())
/// ```
#[must_use]
pub fn contact_strain(force: f64, displacement: f64, specimen: &Specimen) -> Option<f64> {
    let (stiffness, _) = specimen.stiffness(specimen.contact_displacement(displacement));
    (stiffness > 0.0).then(|| force / stiffness)
}

/// Window of the smoothing differentiator: the wider of a number of samples and a share of the time since the hold began.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RateWindow {
    /// Samples on each side, at least.
    pub samples: usize,
    /// Half width as a share of the time since the hold began. Relaxation slows down as it goes on, so that its
    /// features widen with time and the window may widen with them.
    pub share: f64,
    /// Points at which the rate is taken, at most; more samples are thinned to points evenly spaced in log time.
    pub most_points: usize,
}

impl Default for RateWindow {
    fn default() -> Self {
        Self {
            samples: 3,
            share: 0.15,
            most_points: 400,
        }
    }
}

/// Strain and strain rate at a number of times.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct StrainRates {
    /// Time since the start of the hold, s.
    pub time: Vec<f64>,
    /// Smoothed strain.
    pub strain: Vec<f64>,
    /// Strain rate, 1/s.
    pub rate: Vec<f64>,
}

/// Strain rate dε/dt of a hold by local quadratic least squares, equation (9).
///
/// `times` (s, rising) and `strains` of one hold. At every point a parabola is fitted to the samples in the window; its value
/// and slope there are returned. Exact for a parabola whatever the spacing of the samples; near the ends the window
/// is one-sided. Fewer than three samples give nothing.
///
/// ```
/// use palpate::strain::{RateWindow, strain_rates};
/// let times = [0.0, 0.1, 0.25, 0.3, 0.45, 0.6, 0.7];
/// let strains = times.map(|t| 0.3 - 0.2 * t + 0.1 * t * t);
/// let rates = strain_rates(&times, &strains, &RateWindow::default());
/// assert!((rates.rate[2] + 0.15).abs() < 1e-12);
/// ```
#[must_use]
pub fn strain_rates(times: &[f64], strains: &[f64], window: &RateWindow) -> StrainRates {
    let mut rates = StrainRates::default();
    if times.len() < 3 || times.len() != strains.len() {
        return rates;
    }
    let start = times[0];
    for center in centers(times, window.most_points) {
        let half = window.share * (times[center] - start);
        let by_time = (
            times.partition_point(|t| *t < times[center] - half),
            times.partition_point(|t| *t <= times[center] + half),
        );
        let from = by_time.0.min(center.saturating_sub(window.samples.max(1)));
        let until = by_time.1.max((center + window.samples.max(1) + 1).min(times.len()));
        if let Some((strain, rate)) = parabola(&times[from..until], &strains[from..until], times[center]) {
            rates.time.push(times[center] - start);
            rates.strain.push(strain);
            rates.rate.push(rate);
        }
    }
    rates
}

/// Samples at which the rate is taken: all of them, or `most` evenly spaced in the logarithm of time.
fn centers(times: &[f64], most: usize) -> Vec<usize> {
    let count = times.len();
    if count <= most {
        return (0..count).collect();
    }
    let (first, last) = (times[1] - times[0], times[count - 1] - times[0]);
    let mut centers: Vec<usize> = (0..most)
        .map(|i| {
            let elapsed = first * (last / first).powf(i as f64 / (most - 1) as f64);
            times.partition_point(|t| *t - times[0] < elapsed).min(count - 1)
        })
        .collect();
    centers.insert(0, 0);
    centers.dedup();
    centers
}

/// Value and slope at `at` of the least-squares parabola; `None` if the samples do not determine one.
fn parabola(times: &[f64], values: &[f64], at: f64) -> Option<(f64, f64)> {
    let count = times.len() as f64;
    if times.len() < 3 {
        return None;
    }
    let scale = times[times.len() - 1] - times[0];
    let level = values.iter().sum::<f64>() / count;
    let (mut s1, mut s2, mut s3, mut s4) = (0.0, 0.0, 0.0, 0.0);
    let (mut y0, mut y1, mut y2) = (0.0, 0.0, 0.0);
    for (t, y) in times.iter().zip(values) {
        let (x, y) = ((t - at) / scale, y - level);
        let xx = x * x;
        s1 += x;
        s2 += xx;
        s3 += xx * x;
        s4 += xx * xx;
        y0 += y;
        y1 += x * y;
        y2 += xx * y;
    }
    // Cramer's rule for the normal equations of a + b x + c x².
    let determinant = count * (s2 * s4 - s3 * s3) - s1 * (s1 * s4 - s2 * s3) + s2 * (s1 * s3 - s2 * s2);
    let a = y0 * (s2 * s4 - s3 * s3) - s1 * (y1 * s4 - y2 * s3) + s2 * (y1 * s3 - y2 * s2);
    let b = count * (y1 * s4 - y2 * s3) - y0 * (s1 * s4 - s2 * s3) + s2 * (s1 * y2 - s2 * y1);
    let (value, slope) = (level + a / determinant, b / determinant / scale);
    (value.is_finite() && slope.is_finite()).then_some((value, slope))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::LatencyLaw;

    #[test]
    fn rates_of_a_relaxation_follow_the_law() {
        let law = LatencyLaw::new(5.0, 2e4).unwrap();
        let times: Vec<f64> = (0..2000).map(|i| 0.005 * f64::from(i)).collect();
        let strains: Vec<f64> = times.iter().map(|t| law.excess_after(0.13, *t)).collect();
        let rates = strain_rates(&times, &strains, &RateWindow::default());
        assert!(rates.time.len() <= 401);
        for i in 0..rates.time.len() {
            let exact = law.rate(law.excess_after(0.13, rates.time[i]));
            // The one-sided window at the start flattens the fastest part a little.
            let allowed = if rates.time[i] < 0.05 { 0.03 } else { 0.01 };
            assert!((rates.rate[i] / exact - 1.0).abs() < allowed, "{} s: {} {exact}", rates.time[i], rates.rate[i]);
        }
    }
}
