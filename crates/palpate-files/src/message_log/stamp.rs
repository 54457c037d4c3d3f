//! Times of a record as the stamps of a log.

use super::error::LogError;

/// Nanoseconds in a second.
const SECOND: i128 = 1_000_000_000;

/// A time in a log, ns, above 0: zero stands for "no stamp" in ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stamp(u64);

impl Stamp {
    /// The time, ns.
    #[must_use]
    pub fn nanoseconds(self) -> u64 {
        self.0
    }

    /// Whole seconds and nanoseconds, as `builtin_interfaces/Time` has them.
    #[cfg(feature = "robot-log")]
    pub(super) fn parts(self) -> (i32, u32) {
        let (seconds, rest) = (self.0 / SECOND as u64, self.0 % SECOND as u64);
        // A stamp is below 2^31 s.
        (i32::try_from(seconds).unwrap_or(i32::MAX), rest as u32)
    }
}

/// Which stamp the time 0 of a series has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LogClock {
    zero: i128,
}

impl LogClock {
    /// The clock of a series whose time 0 is `nanoseconds` after 1970.
    #[must_use]
    pub fn since_1970(nanoseconds: u64) -> Self {
        Self {
            zero: i128::from(nanoseconds),
        }
    }

    /// The clock of a series without a date, from the time of its first sample, s: time 0 is stamped 1 s, and where the series begins
    /// before 0, as many whole seconds later as make the stamp of its first sample 1 s or more.
    ///
    /// ```
    /// use palpate_files::message_log::LogClock;
    /// let stamp = |first: f64, time: f64| LogClock::beginning_at(first).stamp(time).map(|stamp| stamp.nanoseconds());
    /// assert_eq!((stamp(0.0, 0.6)?, stamp(12.5, 12.5)?, stamp(-0.25, -0.25)?), (1_600_000_000, 13_500_000_000, 1_750_000_000));
    /// # Ok::<(), palpate_files::message_log::LogError>(())
    /// ```
    #[must_use]
    pub fn beginning_at(first_s: f64) -> Self {
        // A conversion of a float saturates, and is 0 for NaN: such a first time has no stamp.
        let shift = (-first_s).ceil().max(0.0) as u32;
        Self {
            zero: (1 + i128::from(shift)) * SECOND,
        }
    }

    /// The stamp of time 0, ns.
    #[must_use]
    pub fn zero_ns(self) -> i128 {
        self.zero
    }

    /// The stamp of a time in the series, rounded to the nearest nanosecond.
    ///
    /// # Errors
    /// [`LogError::Time`] where it is not finite, not above 0, or 2³¹ s and more, which the 32 bits of a ROS stamp do not hold.
    pub fn stamp(self, time_s: f64) -> Result<Stamp, LogError> {
        // Whole seconds and the fraction are exact; their sum in ns would not be.
        let whole = time_s.floor();
        let nanoseconds = ((time_s - whole) * 1e9).round() as i128;
        let stamp = self.zero.saturating_add((whole as i128).saturating_mul(SECOND)).saturating_add(nanoseconds);
        let refused = || LogError::Time {
            time_s,
            stamp_s: self.zero as f64 / 1e9 + time_s,
        };
        match u64::try_from(stamp) {
            Ok(stamp) if time_s.is_finite() && stamp > 0 && i128::from(stamp) < (1 << 31) * SECOND => Ok(Stamp(stamp)),
            _ => Err(refused()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamped(clock: LogClock, time: f64) -> u64 {
        clock.stamp(time).unwrap().nanoseconds()
    }

    #[test]
    fn times_are_rounded_to_the_nearest_nanosecond() {
        let clock = LogClock::beginning_at(0.0);
        for (time, expected) in [
            (0.0, 1_000_000_000),
            (0.1, 1_100_000_000),
            (1.0 / 3.0, 1_333_333_333),
            (2.0 / 3.0, 1_666_666_667),
            (0.999_999_999_9, 2_000_000_000),
            (86_400.000_000_001, 86_401_000_000_001),
        ] {
            assert_eq!(stamped(clock, time), expected, "{time}");
        }
        let dated = LogClock::since_1970(1_724_504_945_198_464_400);
        assert_eq!(stamped(dated, -0.001), 1_724_504_945_197_464_400);
        #[cfg(feature = "robot-log")]
        assert_eq!(dated.stamp(0.0).unwrap().parts(), (1_724_504_945, 198_464_400));
    }

    #[test]
    fn a_series_that_begins_before_zero_is_shifted_by_whole_seconds() {
        for (first, zero) in [(-0.0, 1), (-1e-9, 2), (-1.0, 2), (-10.5, 12), (7.0, 1), (f64::NAN, 1)] {
            assert_eq!(LogClock::beginning_at(first).zero_ns(), zero * SECOND, "{first}");
        }
    }

    #[test]
    fn times_without_a_stamp_are_refused() {
        let clock = LogClock::beginning_at(0.0);
        assert_eq!(stamped(clock, 2_147_483_646.5), 2_147_483_647_500_000_000);
        for time in [2_147_483_647.0, 1e30, f64::MAX, f64::INFINITY, f64::NAN, -1.0, -1e30, f64::NEG_INFINITY] {
            assert!(matches!(clock.stamp(time), Err(LogError::Time { .. })), "{time}");
        }
        for first in [-1e12, f64::NEG_INFINITY] {
            assert!(LogClock::beginning_at(first).stamp(first).is_err(), "{first}");
        }
        let error = clock.stamp(3e9).unwrap_err();
        let expected = "expected times that ROS 2 can stamp, above 0 and below 2147483648 s, found 3000000001 s (time 3000000000 s of the series)";
        assert_eq!(error.to_string(), expected);
    }
}
