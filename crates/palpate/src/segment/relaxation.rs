//! Type I and Type II relaxation.

use serde::{Deserialize, Serialize};

use crate::statistics::{mean, noise, two_sided_p};

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
#[non_exhaustive]
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
/// The first twentieth (three samples at least) is compared with the last fifth. The noise is the larger of what second
/// differences show and of the spread about a line through the last fifth; samples count as independent as far as the
/// correlation about that line allows, so that slow noise (filters, rounding, hunting) seldom makes a drift. Of a thousand
/// holds of 600 samples that do not drift, some three are stated to where neighbours correlate by 0.5, thirty at 0.9 and a hundred
/// at 0.97, of which a fifth of the hold shows two correlation times.
///
/// The type is that of the change from the first three samples to the last hundredth where that differs in sign, significantly:
/// a signal that falls at first and recovers most of it ends below its start, and is not of Type II.
///
/// ```
/// use palpate::segment::{RelaxationType, classify_relaxation};
/// let falling: Vec<f64> = (0..100).map(|i| 1.0 / (1.0 + 0.1 * f64::from(i))).collect();
/// assert_eq!(classify_relaxation(&falling).kind, RelaxationType::TypeI);
/// ```
#[must_use]
pub fn classify_relaxation(signal: &[f64]) -> Relaxation {
    let count = signal.len();
    let whole = drift(signal, [(count / 20).max(3), count / 5]);
    let ends = drift(signal, [3, count / 100]);
    let is_opposite =
        whole.kind != RelaxationType::None && ends.kind != RelaxationType::None && ends.kind != whole.kind;
    if is_opposite { ends } else { whole }
}

/// The change from the mean of the first samples to that of the last, as many of each as `parts` says.
fn drift(signal: &[f64], parts: [usize; 2]) -> Relaxation {
    let count = signal.len();
    if count == 0 {
        return Relaxation {
            kind: RelaxationType::None,
            change: 0.0,
            standard_error: f64::INFINITY,
            p_value: 1.0,
        };
    }
    let [head, tail] = parts.map(|part| part.clamp(1, count));
    let change = mean(&signal[count - tail..]) - mean(&signal[..head]);
    let rest = without_line(&signal[count - (count / 5).clamp(1, count)..]);
    let alike = samples_alike(&rest);
    // Second differences miss slow noise and a quantised signal that seldom moves; the spread at the end does not.
    let freedom = rest.len().saturating_sub(2).max(1) as f64;
    let spread = if rest.len() > 8 { (rest.iter().map(|r| r * r).sum::<f64>() / freedom).sqrt() } else { 0.0 };
    let deviation = noise(signal).max(spread);
    let alone = |count: usize| (count as f64 / alike).max(1.0);
    // A line through slow noise takes the share of two of its independent samples with it.
    let kept = (1.0 - 2.0 / alone(rest.len())).max(0.25);
    let deviation = if alike > 1.0 { noise(signal).max(spread / kept.sqrt()) } else { deviation };
    let standard_error = deviation * (1.0 / alone(head) + 1.0 / alone(tail)).sqrt();
    let rounding = 1e-12 * signal.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let p_value = if change.abs() <= rounding {
        1.0
    } else {
        // What is possible is not 0, however small.
        two_sided_p(change / standard_error.max(f64::MIN_POSITIVE)).max(f64::MIN_POSITIVE)
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

/// How many successive samples say as much as one: 1 + 2 Σ ρₖ, from what a straight line left of them.
///
/// The correlations ρₖ are added in pairs as long as a pair is above zero (Geyer's initial positive sequence), which bears the
/// rounding of a slow signal. Taking out the line lowers each of them by twice the sum over the number of samples; that is put back.
fn samples_alike(rest: &[f64]) -> f64 {
    let count = rest.len();
    let square: f64 = rest.iter().map(|r| r * r).sum();
    if square <= 0.0 || count < 9 {
        return 1.0;
    }
    let correlation = |lag: usize| rest.iter().zip(&rest[lag..]).map(|(a, b)| a * b).sum::<f64>() / square;
    let (mut sum, mut lag) = (0.0, 1);
    while lag + 1 < count / 3 {
        let pair = correlation(lag) + correlation(lag + 1);
        if pair <= 0.0 {
            break;
        }
        sum += pair;
        lag += 2;
    }
    let first = 1.0 + 2.0 * sum;
    let put_back = 2.0 * (lag - 1) as f64 * 2.0 * first / count as f64;
    (first + put_back).clamp(1.0, count as f64 / 2.0)
}

/// What a straight line leaves of some values.
fn without_line(values: &[f64]) -> Vec<f64> {
    let (level, middle) = (mean(values), 0.5 * (values.len() as f64 - 1.0));
    let at = |index: usize| index as f64 - middle;
    let square: f64 = (0..values.len()).map(|i| at(i) * at(i)).sum();
    let product: f64 = values.iter().enumerate().map(|(i, value)| at(i) * (value - level)).sum();
    let slope = if square > 0.0 { product / square } else { 0.0 };
    values.iter().enumerate().map(|(i, value)| value - level - slope * at(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Rng, seed_of};

    /// Noise whose neighbours correlate by `rho`, with deviation 1.
    fn slow(rho: f64, count: usize, seed: u64) -> Vec<f64> {
        let mut random = Rng::new(seed);
        let mut last = random.normal();
        let mut next = || {
            last = rho * last + (1.0 - rho * rho).sqrt() * random.normal();
            last
        };
        (0..count).map(|_| next()).collect()
    }

    /// One hold in a thousand is called a drift by chance where noise is white; of slow noise a fifth of a hold shows little.
    /// The limits are three standard errors above what an independent program in Python counts: 1, 3, 44 and 138.
    #[test]
    fn slow_noise_is_seldom_a_drift() {
        for (rho, most) in [(0.0, 5), (0.5, 9), (0.9, 64), (0.97, 171)] {
            for quantum in [0.0, 2.0] {
                let kinds = (0..1000).filter(|number| {
                    let values = slow(rho, 600, seed_of(7, *number));
                    let rounded = |v: &f64| if quantum > 0.0 { (v / quantum).round() * quantum } else { *v };
                    let values: Vec<f64> = values.iter().map(rounded).collect();
                    classify_relaxation(&values).kind != RelaxationType::None
                });
                let wrong = kinds.count();
                assert!(wrong <= most, "{wrong} of 1000 at correlation {rho}, quantum {quantum}");
            }
        }
    }

    /// The probability of a change that no noise explains was 0.
    #[test]
    fn a_probability_too_small_for_a_number_is_the_smallest() {
        let values: Vec<f64> = (0..1000).map(|i| if i < 500 { 1e3 } else { 1.0 } + 1e-3 * f64::from(i % 2)).collect();
        assert_eq!(classify_relaxation(&values).p_value, f64::MIN_POSITIVE);
    }

    #[test]
    fn relaxation_is_observed_through_slow_noise() {
        for (sign, kind) in [(1.0, RelaxationType::TypeI), (-1.0, RelaxationType::TypeII)] {
            let noise = slow(0.9, 600, 3);
            let value = |(i, e): (usize, &f64)| sign * 20.0 * (-(i as f64) / 100.0).exp() + 0.5 * e;
            let values: Vec<f64> = noise.iter().enumerate().map(value).collect();
            assert_eq!(classify_relaxation(&values).kind, kind);
        }
    }

    /// A force of 1.24 N that fell to 0.9 N, rose to 1.16 N and ended there was "Type II"; one that rose from 6.4 to 7.8 N "Type I".
    #[test]
    fn the_type_is_that_of_the_first_and_last_level() {
        let noise = slow(0.0, 1000, 5);
        let of = |force: &dyn Fn(f64) -> f64| {
            let values: Vec<f64> = noise.iter().enumerate().map(|(i, e)| force(i as f64) + 0.001 * e).collect();
            classify_relaxation(&values).kind
        };
        let recovers = |t: f64| 0.9 + 0.34 * (-t / 10.0).exp() + 0.26 * (1.0 - (-t / 200.0).exp());
        assert_eq!(of(&recovers), RelaxationType::TypeI);
        let rises = |t: f64| 8.0 - 1.6 * (-t / 15.0).exp() - 0.23 * (1.0 - (-t / 300.0).exp());
        assert_eq!(of(&rises), RelaxationType::TypeII);
    }
}
