//! Whether a signal stands still, reported within a few readings.

use crate::observe::{Normal, kept};

/// Fewest readings of a stand.
const FEWEST: u32 = 3;
/// Readings after which a stand is reported where no speed is known, at the beginning of a record.
const AT_FIRST: u32 = 20;
/// How many tolerances a signal may wander about a place before it has left it, once the stand was reported.
const LEAVES: f64 = 3.0;
/// Readings outside that make it leave: one alone may be a dropout.
const OUTSIDE: u32 = 2;
/// Readings that make the mean place of a stand; those later no longer move it, or a creep would never leave.
const PLACE: f64 = 64.0;

/// A place that a signal may have come to, and its speed on the way there.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Stand {
    /// First reading of the stand, s.
    pub(in crate::observe) start: f64,
    /// Mean time of the readings that made the place, s.
    middle: f64,
    last: f64,
    place: f64,
    count: f64,
    /// Mean of the readings of the stand, of which the last [`PLACE`] count most: it follows a creep.
    mean: f64,
    readings: u32,
    outside: u32,
    /// Since when the signal has been farther from the place than one tolerance, s.
    drifts_since: Option<f64>,
    speed: Option<f64>,
    /// The highest speed since it last stood.
    fastest: f64,
    /// Whether the last motion went up (1), down (−1), or there was none (0).
    pub(in crate::observe) direction: f64,
    /// Whether the stand was reported.
    pub(in crate::observe) stands: bool,
}
kept!(Stand: start, middle, last, place, count, mean, readings, outside, drifts_since, speed, fastest, direction, stands);

/// A signal creeps where it leaves this much slower than it came.
const CREEPS: f64 = 0.2;

/// What a reading changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::observe) enum Change {
    /// Nothing.
    Same,
    /// The signal is at a new place, where a stand may begin.
    Moved,
    /// The stand is reported with this reading.
    Stands,
    /// It left where it stood, at a speed like that with which it came.
    Left,
    /// It left much slower than it came.
    Crept,
}

impl Stand {
    /// Takes a reading; `tolerance` is how far the signal may be from a place and still be there, `None` where that is not known yet. A stand
    /// is reported once the signal, at its last speed, would have gone `patience` tolerances.
    pub(in crate::observe) fn feed(&mut self, time: f64, value: f64, tolerance: Option<f64>, patience: f64) -> Change {
        if self.readings == 0 {
            self.begin(time, value);
            return Change::Moved;
        }
        let Some(tolerance) = tolerance else {
            self.stay(time, value);
            return Change::Same;
        };
        let off = value - self.place;
        if self.stands {
            return self.stay_or_leave(time, value, off, tolerance);
        }
        if off.abs() > tolerance {
            // A signal that slows down forgets its speed soon, one that hurries at once.
            let speed = off.abs() / (time - self.middle);
            let speed = self.speed.map_or(speed, |before| speed.max(0.7 * before + 0.3 * speed));
            self.speed = Some(speed);
            self.fastest = self.fastest.max(speed);
            self.direction = off.signum();
            self.begin(time, value);
            return Change::Moved;
        }
        self.stay(time, value);
        let reported = match self.speed {
            Some(speed) => self.readings >= FEWEST && (time - self.start) * speed >= patience * tolerance,
            None => self.readings >= AT_FIRST,
        };
        self.stands = reported;
        if reported { Change::Stands } else { Change::Same }
    }

    fn stay_or_leave(&mut self, time: f64, value: f64, off: f64, tolerance: f64) -> Change {
        let since = if off.abs() > tolerance { Some(self.drifts_since.unwrap_or(self.last)) } else { None };
        self.drifts_since = since;
        self.outside = if off.abs() > LEAVES * tolerance { self.outside + 1 } else { 0 };
        if self.outside < OUTSIDE {
            self.stay(time, value);
            return Change::Same;
        }
        let speed = off.abs() / (time - since.unwrap_or(self.last));
        let crept = self.speed.is_some_and(|before| speed < CREEPS * before);
        (self.speed, self.direction) = (Some(speed), off.signum());
        self.fastest = if crept { self.fastest } else { speed };
        self.begin(time, value);
        if crept { Change::Crept } else { Change::Left }
    }

    fn begin(&mut self, time: f64, value: f64) {
        (self.start, self.middle, self.place, self.mean) = (time, time, value, value);
        (self.count, self.readings, self.outside, self.stands) = (1.0, 1, 0, false);
        (self.last, self.drifts_since) = (time, None);
    }

    fn stay(&mut self, time: f64, value: f64) {
        self.readings = self.readings.saturating_add(1);
        self.last = time;
        if self.outside == 0 {
            self.mean += (value - self.mean) / f64::from(self.readings).min(PLACE);
        }
        if self.count < PLACE {
            self.count += 1.0;
            self.place += (value - self.place) / self.count;
            self.middle += (time - self.middle) / self.count;
        }
    }

    /// Where the signal is that last read `value` with the standard deviation `noise`: the mean of its readings while it stands.
    pub(in crate::observe) fn at(&self, value: f64, noise: f64) -> Normal {
        if !self.stands {
            return Normal::new(value, noise);
        }
        // A mean that forgets has the variance α/(2 − α) of one reading, α = 1/PLACE, and before it forgets that of a plain mean.
        let count = f64::from(self.readings).min(2.0 * PLACE - 1.0);
        Normal::new(self.mean, noise / count.sqrt())
    }

    /// How far a filtered value lies below the place where the signal stands.
    pub(in crate::observe) fn below(&self, level: f64) -> f64 {
        self.place - level
    }

    /// How fast a signal falls whose filtered value is `level` at `time`: since it was at its place if it stands, else as on its way there, but not
    /// faster than if it had gone `unnoticed` farther since.
    pub(in crate::observe) fn fall_rate(&self, time: f64, level: f64, unnoticed: f64) -> f64 {
        if self.stands {
            self.below(level) / (time - self.middle)
        } else {
            let most = (self.below(level) + unnoticed).max(0.0) / (time - self.start);
            self.speed.filter(|_| self.direction < 0.0).map_or(0.0, |speed| speed.min(most))
        }
    }

    /// How far the signal would have gone since a time at its highest speed since it last stood.
    pub(in crate::observe) fn would_have_gone(&self, since: f64, time: f64) -> f64 {
        (time - since) * self.fastest
    }

    /// The signal stands on, at another place.
    pub(in crate::observe) fn settle(&mut self, time: f64, level: f64) {
        (self.place, self.mean, self.count) = (level, level, 1.0);
        (self.start, self.middle, self.drifts_since) = (time, time, None);
    }

    /// Whether a signal that came to a place may still be on the last tolerance of its way.
    pub(in crate::observe) fn arrives(&self, time: f64, tolerance: f64) -> bool {
        !self.stands && self.speed.is_some_and(|speed| (time - self.start) * speed < tolerance)
    }

    /// Whether the stand was reported, and the last reading is off its place: a dropout, or the first of a motion.
    pub(in crate::observe) fn is_doubtful(&self) -> bool {
        self.stands && self.outside > 0
    }

    /// Whether the signal stands, or goes at less than half its highest speed since it last stood.
    pub(in crate::observe) fn slowed(&self) -> bool {
        self.stands || self.speed.is_none_or(|speed| speed < 0.5 * self.fastest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    #[test]
    fn a_stop_is_reported_within_a_few_readings_and_no_ramp_is_a_stop() {
        for (speed, rate) in [(8e-3, 1000.0), (8e-3, 20.0), (2e-4, 100.0)] {
            for seed in 0..50 {
                let (mut stand, mut noise) = (Stand::default(), Rng::new(seed));
                let stop = 5e-3 / speed;
                let mut reported = None;
                for i in 0..((stop + 2.0) * rate) as usize {
                    let time = i as f64 / rate;
                    let value = speed * time.min(stop) + 1e-6 * noise.normal();
                    if stand.feed(time, value, Some(1e-5), 4.0) == Change::Stands && time > 0.3 * stop {
                        reported = reported.or(Some(time));
                    }
                }
                let late = reported.unwrap() - stop;
                assert!(late > -1e-9 && late < (5.0 * 1e-5 / speed).max(4.5 / rate), "{speed} {seed}: {late}");
            }
        }
    }
}
