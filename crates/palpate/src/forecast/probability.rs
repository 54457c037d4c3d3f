//! How probable it is that no law predicts what follows better than the one that is named.
//!
//! *Better*: with an error that is smaller by more than a fifth ([`NEAR`]), the noise of what follows included, up to two or three times
//! the duration of the hold. The probability is a logistic regression on what is known before:
//!
//! ```text
//! p = 1/(1 + exp(−Σ β x))
//! ```
//!
//! with the signs x of [`Signs`]. `validation/law_probability.py --fit` found the coefficients β on first parts of measured and of simulated
//! holds, whose remainder was known, and `docs/validation/law-probability.md` holds probabilities against what came.

/// An error within this factor of the smallest is near the best.
pub(super) const NEAR: f64 = 1.2;

/// Noise counts as at least this share of the change.
const LEAST_NOISE: f64 = 1e-4;

/// Differences of BIC beyond this add nothing.
const MOST_EVIDENCE: f64 = 1000.0;

/// What the probability follows from where forecasts were tried.
#[derive(Debug, Clone, Copy)]
pub(super) struct Signs {
    /// Error of the last forecast, in the unit of the signal.
    pub(super) last_error: f64,
    /// Difference of BIC to the next law that has parameters.
    pub(super) evidence: f64,
    /// Forward score over the least of all laws.
    pub(super) behind: f64,
    /// Whether no other law is indistinguishable from the best.
    pub(super) is_alone: bool,
    /// Standard deviation of the noise, in the unit of the signal.
    pub(super) noise: f64,
    /// Change of the signal over the hold.
    pub(super) change: f64,
}

/// A probability, and the range of what different holds say of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Probability {
    pub(super) value: f64,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// Coefficients of 1, ln(last error/noise), the signed ln(1 + ΔBIC)/2, ln(behind), alone, and ln(noise/change) + 4: of measured and
/// simulated holds together, of measured ones, of simulated ones.
const FORWARD: [[f64; 6]; 3] = [
    [-0.14, -1.20, 0.16, -0.63, 1.06, -0.57],
    [-0.46, -1.33, 0.13, -0.48, 0.90, -0.66],
    [0.24, -0.67, 0.32, -1.00, 0.60, -0.31],
];

/// The same without any sign, where nothing was held out: shares of holds.
const NOTHING_HELD_OUT: [f64; 3] = [0.32, 0.19, 0.58];

impl Probability {
    /// The lower of both.
    pub(super) fn at_most(self, other: Self) -> Self {
        if self.value <= other.value { self } else { other }
    }
}

fn ranged([value, one, other]: [f64; 3]) -> Probability {
    Probability {
        value,
        low: value.min(one).min(other),
        high: value.max(one).max(other),
    }
}

/// The probability from signs; `None` where nothing was held out.
pub(super) fn probability(signs: Option<&Signs>) -> Probability {
    let Some(signs) = signs else {
        return ranged(NOTHING_HELD_OUT);
    };
    let noise = signs.noise.max(LEAST_NOISE * signs.change);
    let x = [
        1.0,
        (signs.last_error / noise).max(1.0).ln(),
        signs.evidence.signum() * 0.5 * signs.evidence.abs().min(MOST_EVIDENCE).ln_1p(),
        signs.behind.ln(),
        f64::from(u8::from(signs.is_alone)),
        (noise / signs.change).ln() + 4.0,
    ];
    ranged(FORWARD.map(|of| 1.0 / (1.0 + (-of.iter().zip(x).map(|(of, x)| of * x).sum::<f64>()).exp())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_beyond_the_noise_lower_it_and_a_law_alone_raises_it() {
        let signs = Signs {
            last_error: 0.01,
            evidence: 10.0,
            behind: 1.0,
            is_alone: true,
            noise: 0.01,
            change: 1.0,
        };
        let found = |signs: Signs| probability(Some(&signs)).value;
        let at_noise = found(signs);
        assert!(
            found(Signs {
                last_error: 0.05,
                ..signs
            }) < 0.5 * at_noise
        );
        assert!(
            found(Signs {
                is_alone: false,
                ..signs
            }) < at_noise
        );
        assert!(
            found(Signs {
                noise: 0.0,
                last_error: 1e-9,
                ..signs
            }) > at_noise,
            "noise-free"
        );
        let whole = probability(Some(&signs));
        assert!(whole.low <= whole.value && whole.value <= whole.high && whole.high < 1.0);
    }
}
