//! A hold condensed to a few dozen nodes that carry nearly all it says.

use std::ops::Range;

use super::separable::Target;
use crate::vector::moments::moments;

/// Relative width in time of the bins; the shape of a law is close to a cubic inside one.
pub(super) const WIDTH: f64 = 0.2;

/// The same for nodes that residuals are formed on, to 10⁻⁴ of them.
const FINE_WIDTH: f64 = 0.05;

/// The same for nodes that only show where valleys are.
const COARSE_WIDTH: f64 = 0.6;

/// Samples gathered in bins that widen with time, each bin replaced by two weighted nodes.
///
/// The nodes are those of Gauss's rule for the sample times of the bin: a sum of cubics over the samples equals that over the
/// nodes, and the values at the nodes are those of the line through the bin's samples. The squared distance of a smooth
/// curve from all samples is then nearly the weighted one from the nodes plus the constant `inside`: what is lost is how the samples
/// bend inside a bin, which moves an optimum by some hundredths of its standard errors. Early samples stay as they are.
#[derive(Debug, Clone, Default)]
pub(super) struct Condensed {
    pub(super) times: Vec<f64>,
    /// Values times `roots`.
    pub(super) values: Vec<f64>,
    /// Square roots of the weights.
    pub(super) roots: Vec<f64>,
    /// Weighted square of what the lines in the bins leave over.
    pub(super) inside: f64,
    /// Number of samples condensed.
    pub(super) samples: usize,
}

impl Condensed {
    /// Fewer nodes, for a search that needs no accuracy.
    pub(super) fn coarser(&self) -> Self {
        let bare: Vec<f64> = self.values.iter().zip(&self.roots).map(|(value, root)| value / root).collect();
        Self {
            samples: self.samples,
            ..Self::with_width(&self.times, &bare, Some(&self.roots), COARSE_WIDTH)
        }
    }

    /// More nodes, for a residual square that counts: what bends inside a bin goes with the fourth power of its width.
    pub(super) fn finer(times: &[f64], values: &[f64]) -> Self {
        Self::with_width(times, values, None, FINE_WIDTH)
    }

    /// Condenses samples at rising times ≥ 0 in bins of a relative width; `roots` are square roots of weights, `None` for all 1.
    pub(super) fn with_width(times: &[f64], values: &[f64], roots: Option<&[f64]>, width: f64) -> Self {
        // Some seven bins an e-fold of time, two nodes a bin.
        let room = times.len().min(128);
        let mut condensed = Self {
            times: Vec::with_capacity(room),
            values: Vec::with_capacity(room),
            roots: Vec::with_capacity(room),
            inside: 0.0,
            samples: times.len(),
        };
        let mut from = 0;
        while from < times.len() {
            let end = times[from] * (1.0 + width);
            let until = from + 1 + count_below(&times[from + 1..], end);
            condensed.bin(times, values, roots, from..until);
            from = until;
        }
        condensed
    }

    /// Share of the residual square by which noise alone makes one valley deeper than another: `variances` of the noise of a sample.
    pub(super) fn noise(&self, variances: f64) -> f64 {
        variances / self.samples as f64
    }

    pub(super) fn target(&self) -> Target<'_> {
        Target::nodes(&self.values, &self.roots)
    }

    fn bin(&mut self, times: &[f64], values: &[f64], roots: Option<&[f64]>, range: Range<usize>) {
        if range.len() <= 2 {
            for i in range {
                self.node(times[i], values[i], roots.map_or(1.0, |roots| roots[i]));
            }
            return;
        }
        let moments = Moments::of(times, values, roots, range);
        self.inside += moments.inside;
        if moments.weight == 0.0 {
            return;
        }
        if moments.width == 0.0 {
            self.node(moments.time, moments.value, moments.weight.sqrt());
            return;
        }
        // Gauss's rule with two nodes: zeros of x² − skewness · x − 1 in units of the spread, with shares of the weight 1/(1 + x²).
        let root = (moments.skewness * moments.skewness + 4.0).sqrt();
        let (early, late) = (0.5 * (moments.skewness - root), 0.5 * (moments.skewness + root));
        let share = 1.0 / (1.0 + early * early);
        for (x, share) in [(early, share), (late, 1.0 - share)] {
            let along = x * moments.width;
            self.node(moments.time + along, moments.value + moments.slope * along, (moments.weight * share).sqrt());
        }
    }

    fn node(&mut self, time: f64, value: f64, root: f64) {
        if root > 0.0 {
            self.times.push(time);
            self.values.push(value * root);
            self.roots.push(root);
        }
    }
}

/// Weighted moments of the samples of a bin.
struct Moments {
    weight: f64,
    time: f64,
    value: f64,
    /// Standard deviation of the times.
    width: f64,
    /// Third central moment of the times over `width`³.
    skewness: f64,
    /// Slope of the line through the samples.
    slope: f64,
    /// Weighted square of the distances from that line.
    inside: f64,
}

impl Moments {
    /// In one pass, about a place inside the bin, from which those about the mean are near.
    fn of(times: &[f64], values: &[f64], roots: Option<&[f64]>, range: Range<usize>) -> Self {
        let (first, last) = (times[range.start], times[range.end - 1]);
        let (place, level) = (0.5 * (first + last), values[range.start]);
        let [w, t, tt, ttt, y, ty, yy] = moments(times, values, roots, range, (place, level));
        let each = if w > 0.0 { 1.0 / w } else { 0.0 };
        let (t, y) = (t * each, y * each);
        let ttt = ttt - 3.0 * t * tt + 2.0 * w * t * t * t;
        let (tt, ty, yy) = (tt - w * t * t, ty - w * t * y, yy - w * y * y);
        // A bin whose weight lies on one sample has no width.
        let wide = tt > 1e-14 * w * (last - place).powi(2);
        let per_square = if wide { 1.0 / tt } else { 0.0 };
        let width = if wide { (tt * each).sqrt() } else { 0.0 };
        let slope = ty * per_square;
        Self {
            weight: w,
            time: place + t,
            value: level + y,
            width,
            skewness: ttt * per_square * (w * per_square) * width,
            slope,
            inside: (yy - slope * ty).max(0.0),
        }
    }
}

/// How many of rising numbers lie below `end`: one look at eight of them.
fn count_below(rising: &[f64], end: f64) -> usize {
    let (blocks, rest) = rising.as_chunks::<8>();
    let whole = blocks.iter().take_while(|block| block[7] < end).count();
    let last = blocks.get(whole).map_or(rest, |block| block);
    8 * whole + last.iter().filter(|number| **number < end).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(times: &[f64], values: &[f64], roots: &[f64], curve: impl Fn(f64) -> f64) -> f64 {
        times.iter().zip(values).zip(roots).map(|((t, y), root)| (root * curve(*t) - y).powi(2)).sum()
    }

    #[test]
    fn a_condensed_hold_has_the_residual_of_the_whole_one() {
        let times: Vec<f64> = (0..3000).map(|i| f64::from(i) / 2999.0).collect();
        let noise = |i: usize| 1e-2 * (1.7 * (i * i) as f64).sin();
        let values: Vec<f64> = times.iter().enumerate().map(|(i, t)| 1.0 / (1.0 + 9.0 * t) + noise(i)).collect();
        let roots: Vec<f64> = (0..3000).map(|i| if i % 7 == 3 { 0.0 } else { 1.0 + f64::from(i) / 3e3 }).collect();
        let rooted: Vec<f64> = values.iter().zip(&roots).map(|(y, root)| y * root).collect();
        let condensed = Condensed::with_width(&times, &values, Some(&roots), WIDTH);
        assert!(condensed.times.len() < 90, "{}", condensed.times.len());
        for rate in [0.3, 3.0, 30.0] {
            let curve = |t: f64| 0.1 + 0.8 * (-rate * t).exp();
            let whole = square(&times, &rooted, &roots, curve);
            let few = square(&condensed.times, &condensed.values, &condensed.roots, curve) + condensed.inside;
            assert!((few / whole - 1.0).abs() < 1e-5, "{rate}: {few} {whole}");
        }
    }

    #[test]
    fn few_samples_stay_as_they_are() {
        let times = [0.0, 0.1, 0.2, 0.5, 1.0];
        let condensed = Condensed::with_width(&times, &[5.0, 4.0, 3.0, 2.0, 1.0], None, WIDTH);
        assert_eq!(condensed.times, times);
        assert_eq!(condensed.inside, 0.0);
    }
}
