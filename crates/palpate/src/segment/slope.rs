//! Local slopes of a noisy column.

/// Means over sample ranges in constant time.
pub(super) struct Means {
    sums: Vec<f64>,
}

impl Means {
    pub(super) fn new(values: &[f64]) -> Self {
        // Counted from the first value, so that epoch seconds keep their digits.
        let origin = values.first().copied().unwrap_or(0.0);
        let mut sums = Vec::with_capacity(values.len() + 1);
        let mut sum = 0.0;
        sums.push(0.0);
        for value in values {
            sum += value - origin;
            sums.push(sum);
        }
        Self { sums }
    }

    /// Mean of samples from..until, less the first sample of the column.
    pub(super) fn of(&self, from: usize, until: usize) -> f64 {
        (self.sums[until] - self.sums[from]) / (until - from) as f64
    }
}

/// Slope at every gap between samples: the difference of the means of `window` samples on either side over that of their times.
///
/// Entry i stands between samples i and i + 1; near the ends the window shrinks to what there is.
pub(super) fn slopes(time: &[f64], values: &[f64], window: usize) -> Vec<f64> {
    let (times, means) = (Means::new(time), Means::new(values));
    let count = values.len();
    (1..count)
        .map(|middle| {
            let w = window.min(middle).min(count - middle);
            let rise = means.of(middle, middle + w) - means.of(middle - w, middle);
            rise / (times.of(middle, middle + w) - times.of(middle - w, middle))
        })
        .collect()
}

/// Speed of the ramps: half of the way is travelled faster than this.
pub(super) fn travel_median(time: &[f64], slopes: &[f64], above: f64) -> f64 {
    let mut parts: Vec<(f64, f64)> = slopes
        .iter()
        .zip(time.windows(2))
        .map(|(slope, pair)| (slope.abs(), slope.abs() * (pair[1] - pair[0])))
        .filter(|(speed, _)| *speed > above)
        .collect();
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = parts.iter().map(|(_, way)| way).sum();
    let mut sum = 0.0;
    for (speed, way) in parts {
        sum += way;
        if sum >= 0.5 * total {
            return speed;
        }
    }
    0.0
}
