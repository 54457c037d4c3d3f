//! A signal without most of its noise, and its rate: two numbers.

use crate::observe::kept::kept;

/// Share of a surprise that corrects the level.
const LEVEL: f64 = 0.25;
/// Share that corrects the rate: critically damped, α²/(2 − α).
const RATE: f64 = LEVEL * LEVEL / (2.0 - LEVEL);
/// Surprises (standard deviations of a reading) beyond which the filter begins anew.
const CORNER: f64 = 5.0;
/// A pause longer than this many usual ones is a gap, after which the filter begins anew.
const GAP: f64 = 20.0;

/// An α-β filter: it follows a ramp without lag (Benedict and Bordner 1962).
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Smooth {
    pub(in crate::observe) level: f64,
    rate: f64,
    usual: f64,
    observed: bool,
    /// Whether the last reading was far from what was expected.
    is_strange: bool,
    /// Whether it was the first of such, which may be one that a cable or a converter made.
    pub(in crate::observe) is_doubtful: bool,
}
kept!(Smooth: level, rate, usual, observed, is_strange, is_doubtful);

impl Smooth {
    /// Takes a reading `dt` (s) after the last; `noise` is its standard deviation, if that is known.
    pub(in crate::observe) fn feed(&mut self, dt: f64, value: f64, noise: Option<f64>) {
        let gap = self.usual > 0.0 && dt > GAP * self.usual;
        if !self.observed || gap {
            (self.level, self.rate, self.observed) = (value, 0.0, true);
            (self.is_strange, self.is_doubtful) = (false, false);
        } else {
            let expected = self.level + self.rate * dt;
            let surprise = value - expected;
            let is_strange = noise.is_some_and(|noise| surprise.abs() > CORNER * noise);
            self.is_doubtful = is_strange && !self.is_strange;
            self.is_strange = is_strange;
            if self.is_doubtful {
                // The next reading tells.
                self.level = expected;
            } else if is_strange {
                // A corner, or a motion in few readings: the reading knows more than the filter, which would swing past it.
                (self.level, self.rate) = (value, 0.0);
            } else {
                self.level = expected + LEVEL * surprise;
                self.rate += RATE * surprise / dt;
            }
        }
        if dt > 0.0 {
            self.usual += (dt - self.usual) * if self.usual == 0.0 { 1.0 } else { 0.05 };
        }
    }

    /// The share of the noise of a reading that the level keeps, as a standard deviation.
    pub(in crate::observe) fn kept() -> f64 {
        // For white noise, (2α² + 2β − 3αβ)/(α(4 − 2α − β)).
        let (a, b) = (LEVEL, RATE);
        ((2.0 * a * a + 2.0 * b - 3.0 * a * b) / (a * (4.0 - 2.0 * a - b))).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_followed_without_lag_and_a_gap_is_no_ramp() {
        let mut smooth = Smooth::default();
        for i in 0..400 {
            smooth.feed(0.01, 0.03 * f64::from(i), None);
        }
        assert!((smooth.level - 0.03 * 399.0).abs() < 1e-9);
        smooth.feed(5.0, 2.0, None);
        assert_eq!(smooth.level, 2.0);
        // The first reading of a motion may be none.
        for (value, level) in [(3.0, 2.0), (4.0, 4.0), (5.0, 5.0), (5.0, 5.0), (9.0, 5.0), (5.0, 5.0)] {
            smooth.feed(0.05, value, Some(0.05));
            assert_eq!((smooth.level, smooth.is_doubtful), (level, level != value));
        }
    }
}
