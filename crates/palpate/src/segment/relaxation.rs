//! Type I and Type II relaxation.

use serde::{Deserialize, Serialize};

use crate::statistics::{effective_count, lag_one_correlation, mean, noise, two_sided_p};

/// Which way the signal drifts in a hold (figure 1 of the paper).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RelaxationType {
    /// The signal falls: typical after loading.
    #[serde(rename = "type_1")]
    TypeI,
    /// The signal rises: typical after unloading.
    #[serde(rename = "type_2")]
    TypeII,
    /// It does neither, as far as the noise lets one see.
    None,
}

/// The drift of a hold and its significance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Relaxation {
    /// Which type.
    pub kind: RelaxationType,
    /// Change of the signal from the start of the hold to its last fifth, in the unit of the signal.
    pub change: f64,
    /// Standard error of that change.
    pub standard_error: f64,
    /// Two-sided probability that noise alone makes a change of this size.
    pub p_value: f64,
}

/// Probability below which a drift counts.
const SIGNIFICANT: f64 = 1e-3;

/// Judges the drift of a hold from its samples.
///
/// The first twentieth (three samples at least) is compared with the last fifth. Noise is taken from second differences,
/// neighbouring samples count as independent as far as the last fifth's own correlation allows.
///
/// ```
/// use palpate::segment::{RelaxationType, classify_relaxation};
/// let falling: Vec<f64> = (0..100).map(|i| 1.0 / (1.0 + 0.1 * f64::from(i))).collect();
/// assert_eq!(classify_relaxation(&falling).kind, RelaxationType::TypeI);
/// ```
#[must_use]
pub fn classify_relaxation(signal: &[f64]) -> Relaxation {
    let count = signal.len();
    if count == 0 {
        return Relaxation {
            kind: RelaxationType::None,
            change: 0.0,
            standard_error: f64::INFINITY,
            p_value: 1.0,
        };
    }
    let (head, tail) = ((count / 20).clamp(1, count), (count / 5).clamp(1, count));
    let head = head.max(3.min(count));
    let (first, last) = (&signal[..head], &signal[count - tail..]);
    let change = mean(last) - mean(first);
    let level = mean(last);
    let rest: Vec<f64> = last.iter().map(|value| value - level).collect();
    let independent = effective_count(rest.len(), lag_one_correlation(&rest));
    // Second differences miss a quantised signal that seldom moves; its spread at the end does not.
    let spread = (rest.iter().map(|r| r * r).sum::<f64>() / rest.len() as f64).sqrt();
    let deviation = noise(signal).max(if independent > 8.0 { spread } else { 0.0 });
    let standard_error = deviation * (1.0 / head as f64 + 1.0 / independent.max(1.0)).sqrt();
    let rounding = 1e-12 * signal.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let p_value = if change.abs() <= rounding {
        1.0
    } else {
        two_sided_p(change / standard_error.max(f64::MIN_POSITIVE))
    };
    let kind = match change {
        _ if p_value > SIGNIFICANT => RelaxationType::None,
        change if change < 0.0 => RelaxationType::TypeI,
        _ => RelaxationType::TypeII,
    };
    Relaxation {
        kind,
        change,
        standard_error,
        p_value,
    }
}
