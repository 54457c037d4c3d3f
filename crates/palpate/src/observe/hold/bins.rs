//! A hold in a bounded number of means.

use crate::observe::{Normal, kept};

/// Most means.
pub(in crate::observe) const MOST: usize = 64;
/// Length of a mean as a share of the time since the hold began.
const SHARE: f64 = 0.08;

/// Mean of successive readings.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Bin {
    /// Mean time since the hold began, s.
    pub(in crate::observe) time: f64,
    /// Half the time from the first to the last reading over √3, s: nodes at time ± this make Gauss's rule of two points.
    pub(in crate::observe) spread: f64,
    /// Mean value.
    pub(in crate::observe) value: f64,
    /// Number of readings.
    pub(in crate::observe) count: f64,
    from: f64,
    to: f64,
}
kept!(Bin: time, spread, value, count, from, to);

/// Means over lengths that grow with the time since the hold began.
#[derive(Debug, Clone, Copy)]
pub(in crate::observe) struct Bins {
    bins: [Bin; MOST],
    len: usize,
}
kept!(Bins: bins, len; |bins| bins.len <= MOST);

impl Default for Bins {
    fn default() -> Self {
        let bins = [Bin::default(); MOST];
        Self { bins, len: 0 }
    }
}

impl Bins {
    pub(in crate::observe) fn clear(&mut self) {
        self.len = 0;
    }

    pub(in crate::observe) fn as_slice(&self) -> &[Bin] {
        &self.bins[..self.len]
    }

    /// Takes a reading `time` (s) after the hold began.
    pub(in crate::observe) fn push(&mut self, time: f64, value: f64) {
        if let Some(last) = self.bins[..self.len].last_mut()
            && time - last.from <= SHARE * time
        {
            last.take(time, value);
            return;
        }
        if self.len == MOST {
            self.merge();
        }
        self.bins[self.len] = Bin {
            time,
            spread: 0.0,
            value,
            count: 1.0,
            from: time,
            to: time,
        };
        self.len += 1;
    }

    /// Rate over the later half of the time, by a straight line through its means; `None` for fewer than four.
    pub(in crate::observe) fn late_slope(&self) -> Option<Normal> {
        let bins = self.as_slice();
        let last = bins.last()?.time;
        let later = || bins.iter().filter(|bin| bin.time >= 0.5 * last);
        let weight: f64 = later().map(|bin| bin.count).sum();
        let mean = |of: fn(&Bin) -> f64| later().map(|bin| bin.count * of(bin)).sum::<f64>() / weight;
        let (time, value) = (mean(|bin| bin.time), mean(|bin| bin.value));
        let (mut squares, mut product, mut all) = (0.0, 0.0, 0.0);
        for bin in later() {
            let (x, y) = (bin.time - time, bin.value - value);
            squares += bin.count * x * x;
            product += bin.count * x * y;
            all += bin.count * y * y;
        }
        let freedom = later().count() as f64 - 2.0;
        if freedom < 2.0 || squares <= 0.0 {
            return None;
        }
        let rate = product / squares;
        Some(Normal::new(rate, ((all - rate * product).max(0.0) / freedom / squares).sqrt()))
    }

    /// Makes one of the two neighbours that are the shortest for their age.
    fn merge(&mut self) {
        let length = |first: usize| {
            let (a, b) = (&self.bins[first], &self.bins[first + 1]);
            (b.to - a.from) / b.to
        };
        let mut first = 0;
        for candidate in 1..self.len - 1 {
            if length(candidate) < length(first) {
                first = candidate;
            }
        }
        let (a, b) = (self.bins[first], self.bins[first + 1]);
        let count = a.count + b.count;
        let mean = |a_value: f64, b_value: f64| a_value + (b_value - a_value) * (b.count / count);
        self.bins[first] = Bin {
            time: mean(a.time, b.time),
            spread: (b.to - a.from) * HALF_OVER_ROOT_3,
            value: mean(a.value, b.value),
            count,
            from: a.from,
            to: b.to,
        };
        self.bins.copy_within(first + 2..self.len, first + 1);
        self.len -= 1;
    }
}

/// 1/(2√3).
const HALF_OVER_ROOT_3: f64 = 0.288_675_134_594_812_9;

impl Bin {
    fn take(&mut self, time: f64, value: f64) {
        self.count += 1.0;
        self.time += (time - self.time) / self.count;
        self.value += (value - self.value) / self.count;
        self.to = time;
        self.spread = (time - self.from) * HALF_OVER_ROOT_3;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_readings_are_kept_as_few_means_none_long_for_its_age() {
        let mut bins = Bins::default();
        for i in 0..1_000_000 {
            bins.push(1e-3 * f64::from(i), f64::from(i));
        }
        let bins = bins.as_slice();
        assert!(bins.len() <= MOST);
        assert_eq!(bins.iter().map(|bin| bin.count).sum::<f64>(), 1e6);
        for bin in bins {
            assert!((bin.value - 1e3 * bin.time).abs() < 1e-6 * bin.value.max(1.0));
            assert!(bin.to - bin.from <= 0.45 * bin.to, "{bin:?}");
        }
    }
}
