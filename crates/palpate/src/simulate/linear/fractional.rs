//! E_α(−s^α) as a sum of exponentials.

use std::f64::consts::PI;

use crate::special::mittag_leffler_decay;

/// Weights and rates, and by how much the sum is off at most.
pub(super) struct Sum {
    pub(super) terms: Vec<(f64, f64)>,
    pub(super) error: f64,
}

/// Steps of ln r that are tried, until the sum is as good as doubles and the window allow.
const STEPS: [f64; 4] = [0.6, 0.4, 0.25, 0.15];

/// Error that is good enough.
const ENOUGH: f64 = 1e-9;

/// E_α(−s^α) for s from `shortest` to `longest`, by the trapezoidal rule over ln r.
///
/// The density is analytic in a strip about the real axis of q = ln r, and so the rule converges exponentially in its step. Its poles at
/// ±iw, w = π (1 − α)/α, come near the axis as α nears 1; evenly spaced are therefore values of q + arsinh(q/w), which crowd there.
pub(super) fn sum_of(order: f64, (shortest, longest): (f64, f64)) -> Sum {
    let mut best: Option<Sum> = None;
    for step in STEPS {
        let terms = trapezoid(order, (shortest, longest), step);
        let error = error_of(&terms, order, (shortest, longest));
        if best.as_ref().is_none_or(|best| error < best.error) {
            best = Some(Sum { terms, error });
        }
        if best.as_ref().is_some_and(|best| best.error < ENOUGH) {
            break;
        }
    }
    best.unwrap_or(Sum {
        terms: Vec::new(),
        error: f64::INFINITY,
    })
}

/// Rates beyond which exp(−r s) is over at once, or never begins, in the window.
const OVER: f64 = 40.0;
const NEVER: f64 = 1e-9;

fn trapezoid(order: f64, (shortest, longest): (f64, f64), step: f64) -> Vec<(f64, f64)> {
    let density = |log_rate: f64| {
        // r^α/(r^2α + 2 r^α cos πα + 1), the same from both ends.
        let power = (order * log_rate).exp();
        (order * PI).sin() / PI / (power + 2.0 * (order * PI).cos() + 1.0 / power)
    };
    let (slow, fast) = ((NEVER / longest).ln(), (OVER / shortest).ln());
    let width = PI * (1.0 - order) / order;
    let crowded = |node: f64| node + (node / width).asinh();
    let stretch = |node: f64| 1.0 / (1.0 + 1.0 / node.hypot(width));
    let from = crowded(slow);
    let count = ((crowded(fast) - from) / step).ceil() as usize;
    let (mut node, mut terms) = (slow, Vec::with_capacity(count + 1));
    for i in 0..=count {
        let place = from + step * i as f64;
        for _ in 0..50 {
            let by = (place - crowded(node)) * stretch(node);
            node += by;
            if by.abs() <= 1e-15 * (1.0 + node.abs()) {
                break;
            }
        }
        terms.push((step * stretch(node) * density(node), node.exp()));
    }
    // What is slower still counts as the slowest: ∫ density to −∞ is arctan.
    if let Some(first) = terms.first_mut() {
        let power = (order * (slow - 0.5 * step * stretch(slow))).exp();
        let angle = order * PI;
        first.0 += ((power + angle.cos()) / angle.sin()).atan() / angle - ((angle.cos() / angle.sin()).atan()) / angle;
    }
    terms
}

/// The largest difference from the function itself, over times evenly spaced in their logarithm.
fn error_of(terms: &[(f64, f64)], order: f64, (shortest, longest): (f64, f64)) -> f64 {
    const TIMES: i32 = 120;
    let time = |i: i32| shortest * (longest / shortest).powf(f64::from(i) / f64::from(TIMES));
    let off = |s: f64| {
        let sum: f64 = terms.iter().map(|(weight, rate)| weight * (-rate * s).exp()).sum();
        (sum - mittag_leffler_decay(s, order).value).abs()
    };
    (0..=TIMES).map(|i| off(time(i))).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_of_exponentials_is_the_function_to_its_error() {
        for order in [0.05, 0.2, 0.5, 0.8, 0.95] {
            let sum = sum_of(order, (1e-3, 1e4));
            println!("{order}: {} terms, {:.1e}", sum.terms.len(), sum.error);
            assert!(sum.error < 1e-6 && sum.terms.len() < 300, "{order}: {:e}, {}", sum.error, sum.terms.len());
            assert!(sum.terms.iter().all(|(weight, rate)| *weight > 0.0 && *rate > 0.0));
        }
    }
}
