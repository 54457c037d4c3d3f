//! The straight line through some samples.

/// Moments of some samples about their mean, from which the straight line through them follows.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Line {
    pub(super) count: f64,
    time: f64,
    value: f64,
    tt: f64,
    tv: f64,
    vv: f64,
}

impl Line {
    pub(super) fn of_sample(time: f64, value: f64) -> Self {
        Self {
            count: 1.0,
            time,
            value,
            ..Self::default()
        }
    }

    /// The line through the samples of a range.
    pub(super) fn through(time: &[f64], values: &[f64], range: std::ops::Range<usize>) -> Self {
        range.fold(Self::default(), |line, i| line.joined(&Self::of_sample(time[i], values[i])))
    }

    /// The line through the samples of both.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let count = self.count + other.count;
        let (share, apart) = (other.count / count, (other.time - self.time, other.value - self.value));
        let weight = self.count * share;
        Self {
            count,
            time: self.time + share * apart.0,
            value: self.value + share * apart.1,
            tt: self.tt + other.tt + weight * apart.0 * apart.0,
            tv: self.tv + other.tv + weight * apart.0 * apart.1,
            vv: self.vv + other.vv + weight * apart.1 * apart.1,
        }
    }

    /// Slope; 0 for a single sample.
    pub(super) fn slope(&self) -> f64 {
        if self.tt > 0.0 { self.tv / self.tt } else { 0.0 }
    }

    /// Mean time of the samples.
    pub(super) fn middle(&self) -> f64 {
        self.time
    }

    /// Value of the line at a time.
    pub(super) fn at(&self, time: f64) -> f64 {
        self.value + self.slope() * (time - self.time)
    }

    /// Sum of the squares that the line leaves.
    pub(super) fn left(&self) -> f64 {
        if self.tt > 0.0 { (self.vv - self.tv * self.tv / self.tt).max(0.0) } else { self.vv }
    }
}
