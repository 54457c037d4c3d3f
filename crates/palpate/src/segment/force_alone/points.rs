//! A stretch of samples as a few weighted means.

/// The mean of some samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) time: f64,
    pub(super) value: f64,
    pub(super) samples: f64,
}

impl Point {
    fn with(self, other: Self) -> Self {
        let samples = self.samples + other.samples;
        let mean = |a: f64, b: f64| (a * self.samples + b * other.samples) / samples;
        Self {
            time: mean(self.time, other.time),
            value: mean(self.value, other.value),
            samples,
        }
    }
}

/// Samples from..until as at most `most` means of equally many samples.
pub(super) fn points(time: &[f64], values: &[f64], (from, until): (usize, usize), most: usize) -> Vec<Point> {
    let count = (until - from).min(most);
    let cut = |part: usize| from + (until - from) * part / count;
    let mean = |part: usize| {
        let (a, b) = (cut(part), cut(part + 1));
        let samples = (b - a) as f64;
        Point {
            time: time[a..b].iter().sum::<f64>() / samples,
            value: values[a..b].iter().sum::<f64>() / samples,
            samples,
        }
    };
    (0..count).map(mean).collect()
}

/// Half as many points, each the mean of two.
pub(super) fn thinned(points: &[Point]) -> Vec<Point> {
    let two = |pair: &[Point]| if let [a, b] = *pair { a.with(b) } else { pair[0] };
    points.chunks(2).map(two).collect()
}
