//! The end of loading observed in a force alone.

use super::stand::Change;
use crate::observe::kept::kept;

/// A hold is reported once the force, at the speed of its loading, would have risen this many tolerances above its peak.
const FAR: f64 = 8.0;
/// Readings off the fitted curve that end a hold.
const OFF: u32 = 3;

/// A force without a displacement: held is what no longer rises, and falls as a body relaxes.
///
/// A relaxation may begin faster than the loading was, so that its first moments look like unloading. It slows down; what goes on to fall off
/// the fitted curve, or has lost half its peak with no curve to follow, is unloading.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Alone {
    /// Where the rise began, s and N.
    foot: (f64, f64),
    peak: f64,
    since: f64,
    pub(in crate::observe) stands: bool,
    falls: bool,
    least: f64,
    off: u32,
    observed: bool,
}
kept!(Alone: foot, peak, since, stands, falls, least, off, observed);

impl Alone {
    /// Takes the filtered force; `off` is how far the reading itself is beyond what the fitted curve allows, in tolerances, where there is a curve: a
    /// filter lags behind the first moments of a relaxation.
    pub(in crate::observe) fn feed(
        &mut self,
        time: f64,
        level: f64,
        tolerance: Option<f64>,
        off: Option<f64>,
    ) -> Change {
        let Some(tolerance) = tolerance else {
            return self.moved(time, level);
        };
        if !self.observed {
            self.foot = (time, level);
            return self.moved(time, level);
        }
        if (level - self.foot.1).abs() < tolerance {
            self.foot.0 = time;
        }
        if self.stands {
            let lost = off.is_none() && level < 0.5 * self.peak;
            let off = off.unwrap_or(0.0);
            self.off = if off.abs() > 1.0 { self.off + 1 } else { 0 };
            if self.off < OFF && !lost {
                return Change::Same;
            }
            self.foot = (time, level);
            self.moved(time, level);
            self.falls = off < 0.0 || lost;
            self.least = level;
            return Change::Left;
        }
        if self.falls {
            // It has to rise again, or to stand, before it can be held.
            if level <= self.least {
                (self.least, self.foot) = (level, (time, level));
            }
            self.falls = level < self.least + tolerance;
            return self.moved(time, level);
        }
        if level > self.peak {
            return self.moved(time, level);
        }
        // As fast as the whole rise was; that of a few readings is mostly noise.
        let rise = (self.peak - self.foot.1) / (self.since - self.foot.0);
        self.stands = self.since > self.foot.0 && (time - self.since) * rise >= FAR * tolerance;
        if self.stands { Change::Stands } else { Change::Same }
    }

    fn moved(&mut self, time: f64, level: f64) -> Change {
        (self.peak, self.since, self.stands, self.off, self.observed) = (level, time, false, 0, true);
        Change::Moved
    }
}
