//! From a force that falls and its interval to the time when it has fallen to the force of slip.

use crate::grip::TimeToSlip;
use crate::observe::{SlipForecast, kept};

/// What lies later than this (s) is called never.
const END: f64 = 1e9;
/// Halvings of the logarithm of a time: to a thousandth of it.
const HALVINGS: usize = 16;

/// When, on the clock of a hold, its force falls to that of slip; `None` where its interval stays above for good.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::observe) struct Crossing {
    falls: Option<Falls>,
}
kept!(Crossing: falls);

/// Times (s since the hold began): somewhere from `low` on; `value` and `high` are `None` where the force, or its upper end, stays above.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Falls {
    low: f64,
    value: Option<f64>,
    high: Option<f64>,
}
kept!(Falls: low, value, high);

impl Crossing {
    /// Where the interval `force(t)` = (low, best, high) falls to `slip`, from `now` (s) on.
    ///
    /// The interval of the time is the set of times at which the force may be at `slip`: from where its lower end gets there to where its
    /// upper end does. It covers as often as those of the forces do.
    pub(in crate::observe) fn find(now: f64, slip: f64, force: impl Fn(f64) -> (f64, f64, f64)) -> Self {
        let falls = |end: fn((f64, f64, f64)) -> f64| crossing(now, |time| end(force(time)) - slip);
        let falls = falls(|force| force.0).map(|low| {
            let value = falls(|force| force.1).map(|value| value.max(low));
            let high = falls(|force| force.2).map(|high| high.max(value.unwrap_or(low)));
            Falls { low, value, high }
        });
        Self { falls }
    }

    /// How much is left open: ln of the ratio of the ends of the interval, as observed `now` seconds after the hold began.
    pub(in crate::observe) fn width(self, now: f64) -> f64 {
        self.falls.map_or(0.0, |Falls { low, high, .. }| {
            // Less than a millisecond is now.
            high.map_or(f64::INFINITY, |high| ((high - now).max(1e-3) / (low - now).max(1e-3)).ln())
        })
    }

    /// As observed `now` seconds after the hold began.
    pub(in crate::observe) fn observed(self, now: f64) -> SlipForecast {
        let left = |time: Option<f64>| time.map_or(TimeToSlip::Never, |time| TimeToSlip::After((time - now).max(0.0)));
        SlipForecast::Known {
            best: left(self.falls.and_then(|falls| falls.value)),
            low: left(self.falls.map(|falls| falls.low)),
            high: left(self.falls.and_then(|falls| falls.high)),
        }
    }
}

/// First time from `now` on at which `above` is no more; `None` where it is for good.
fn crossing(now: f64, above: impl Fn(f64) -> f64) -> Option<f64> {
    if above(now) <= 0.0 {
        return Some(now);
    }
    if above(END) > 0.0 {
        return None;
    }
    let start = now.max(1e-6);
    // Steps of ten in the time from now on, then halves of one.
    let (mut early, mut late) = (0.0, 1e-3 * start);
    while late < END && above(now + late) > 0.0 {
        (early, late) = (late, 10.0 * late);
    }
    let mut least = if early > 0.0 { early } else { 1e-3 * late };
    for _ in 0..HALVINGS {
        let middle = (least * late).sqrt();
        if above(now + middle) > 0.0 { least = middle } else { late = middle }
    }
    Some(now + late)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_at_which_the_ends_of_the_interval_cross() {
        let force = |t: f64| {
            let f = 1.0 + 1.0 / (1.0 + t);
            (f - 0.05, f, f + 0.05)
        };
        let Falls { low, value, high } = Crossing::find(2.0, 1.1, force).falls.unwrap();
        for (found, truth) in [(low, 1.0 / 0.15 - 1.0), (value.unwrap(), 9.0), (high.unwrap(), 19.0)] {
            assert!((found / truth - 1.0).abs() < 1e-3, "{found} {truth}");
        }
        assert_eq!(Crossing::find(2.0, 0.9, force).falls, None);
        assert_eq!(Crossing::find(2.0, 0.9, force).observed(2.0), SlipForecast::NEVER);
        let Falls { value, high, .. } = Crossing::find(2.0, 0.96, force).falls.unwrap();
        assert_eq!((value, high), (None, None));
        let low = Crossing::find(60.0, 1.1, force).falls.unwrap().low;
        assert_eq!(
            Crossing::find(60.0, 1.1, force).observed(60.0),
            SlipForecast::Known {
                best: TimeToSlip::After(0.0),
                low: TimeToSlip::After(0.0),
                high: TimeToSlip::After(0.0)
            }
        );
        assert_eq!(low, 60.0);
    }
}
