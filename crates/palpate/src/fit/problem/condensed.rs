//! A hold condensed to a few dozen nodes that carry nearly all it says.

use std::ops::Range;

use crate::fit::{Model, Scaled};
use crate::optimise::Target;
use crate::vector::{LANES, accelerated, moments, multiply};

/// The nodes that stand for scaled samples.
pub(crate) fn condense(scaled: &Scaled) -> Condensed {
    condense_to(scaled, WIDTH)
}

/// The same with bins of another relative width, 0 for a node each sample.
pub(crate) fn condense_to(scaled: &Scaled, width: f64) -> Condensed {
    match &scaled.roots {
        None => Condensed::with_width(&scaled.times, &scaled.values, None, width),
        Some(roots) => {
            let bare: Vec<f64> =
                scaled.values.iter().zip(roots).map(|(y, root)| if *root > 0.0 { y / root } else { 0.0 }).collect();
            Condensed::with_width(&scaled.times, &bare, Some(roots), width)
        }
    }
}

/// Relative width in time of the bins; the shape of a law is close to a cubic inside one.
pub(crate) const WIDTH: f64 = 0.2;

/// The same for nodes that residuals are formed on, to 10⁻⁴ of them.
const FINE_WIDTH: f64 = 0.05;

/// The same for nodes that only show where valleys are.
const COARSE_WIDTH: f64 = 0.6;

/// Evenly spaced samples lie at ends of bins: the rounding of a clock, which begins anywhere, is not to decide which bin they are in.
const CLEARLY: f64 = 1.0 - 1e-6;

/// Samples gathered in bins that widen with time, each bin replaced by two weighted nodes.
///
/// The nodes are those of Gauss's rule for the sample times of the bin: a sum of cubics over the samples equals that over the
/// nodes, and the values at the nodes are those of the line through the bin's samples. The squared distance of a smooth
/// curve from all samples is then nearly the weighted one from the nodes plus the constant `inside`: what is lost is how the samples
/// bend inside a bin, which moves an optimum by some hundredths of its standard errors. Early samples stay as they are.
#[derive(Debug, Clone, Default)]
pub(crate) struct Condensed {
    pub(crate) times: Vec<f64>,
    /// Values times `roots`.
    pub(crate) values: Vec<f64>,
    /// Square roots of the weights.
    pub(crate) roots: Vec<f64>,
    /// Weighted square of what the lines in the bins leave over.
    pub(crate) inside: f64,
    /// Number of samples condensed.
    pub(crate) samples: usize,
}

impl Condensed {
    /// Fewer nodes, for a search that needs no accuracy.
    pub(crate) fn coarser(&self) -> Self {
        let bare: Vec<f64> = self.values.iter().zip(&self.roots).map(|(value, root)| value / root).collect();
        Self {
            samples: self.samples,
            ..Self::with_width(&self.times, &bare, Some(&self.roots), COARSE_WIDTH)
        }
    }

    /// More nodes, for a residual square that counts: what bends inside a bin goes with the fourth power of its width.
    pub(crate) fn finer(times: &[f64], values: &[f64]) -> Self {
        Self::with_width(times, values, None, FINE_WIDTH)
    }

    /// Condenses samples at rising times ≥ 0 in bins of a relative width; `roots` are square roots of weights, `None` for all 1.
    pub(crate) fn with_width(times: &[f64], values: &[f64], roots: Option<&[f64]>, width: f64) -> Self {
        // Some seven bins an e-fold of time, two nodes a bin.
        let room = times.len().min(128);
        let mut condensed = Self {
            times: Vec::with_capacity(room),
            values: Vec::with_capacity(room),
            roots: Vec::with_capacity(room),
            inside: 0.0,
            samples: times.len(),
        };
        let mut pending = Pending::default();
        let mut from = 0;
        while from < times.len() {
            let end = times[from] * (1.0 + width) * CLEARLY;
            let until = from + 1 + count_below(&times[from + 1..], end);
            if until - from > 2 {
                pending.push(times, values, roots, from..until);
                if pending.is_full() {
                    pending.empty_into(&mut condensed);
                }
            } else {
                pending.empty_into(&mut condensed);
                for i in from..until {
                    let root = roots.map_or(1.0, |roots| roots[i]);
                    condensed.node(times[i], values[i] * root, root);
                }
            }
            from = until;
        }
        pending.empty_into(&mut condensed);
        condensed
    }

    /// Share of the residual square by which noise alone makes one valley deeper than another: `variances` of the noise of a sample.
    pub(crate) fn noise(&self, variances: f64) -> f64 {
        variances / self.samples as f64
    }

    /// One shape at the nodes, times their roots.
    pub(crate) fn column(&self, model: &Model, shape: usize, parameters: &[f64]) -> Vec<f64> {
        let mut column = vec![0.0; self.times.len()];
        model.shape_value(shape, &self.times, parameters, &mut column);
        multiply(&mut column, &self.roots);
        column
    }

    pub(crate) fn target(&self) -> Target<'_> {
        Target::nodes(&self.values, &self.roots)
    }

    /// A node, unless it has no weight; `value` is times `root`.
    fn node(&mut self, time: f64, value: f64, root: f64) {
        if root > 0.0 {
            self.times.push(time);
            self.values.push(value);
            self.roots.push(root);
        }
    }
}

/// Bins whose nodes are made together, side by side: one at a time, each would wait for its own roots and quotients.
#[derive(Default)]
struct Pending {
    count: usize,
    /// Sums over the samples of each bin, about its place and level.
    sums: [[f64; LANES]; 7],
    places: [f64; LANES],
    levels: [f64; LANES],
    /// From a bin's place to its ends.
    reaches: [f64; LANES],
}

impl Pending {
    fn push(&mut self, times: &[f64], values: &[f64], roots: Option<&[f64]>, range: Range<usize>) {
        let (first, last, level) = (times[range.start], times[range.end - 1], values[range.start]);
        let place = 0.5 * (first + last);
        let sums = moments(times, values, roots, range, (place, level));
        for (lanes, sum) in self.sums.iter_mut().zip(sums) {
            lanes[self.count] = sum;
        }
        (self.places[self.count], self.levels[self.count]) = (place, level);
        self.reaches[self.count] = last - place;
        self.count += 1;
    }

    fn is_full(&self) -> bool {
        self.count == LANES
    }

    fn empty_into(&mut self, condensed: &mut Condensed) {
        if self.count == 0 {
            return;
        }
        let nodes = self.nodes();
        for lane in 0..self.count {
            condensed.inside += nodes.inside[lane];
            for [times, values, roots] in &nodes.both {
                condensed.node(times[lane], values[lane], roots[lane]);
            }
        }
        self.count = 0;
    }

    /// From sums to moments about the mean, near to which the place is; from these to nodes.
    fn nodes(&self) -> Nodes {
        accelerated(
            #[inline(always)]
            || {
                let mut nodes = Nodes::default();
                for lane in 0..LANES {
                    let [w, t, tt, ttt, y, ty, yy] = std::array::from_fn(|k| self.sums[k][lane]);
                    let each = if w > 0.0 { 1.0 / w } else { 0.0 };
                    let (t, y) = (t * each, y * each);
                    let ttt = ttt - 3.0 * t * tt + 2.0 * w * t * t * t;
                    let (tt, ty, yy) = (tt - w * t * t, ty - w * t * y, yy - w * y * y);
                    // A bin whose weight lies on one sample has no width, and one node.
                    let wide = tt > 1e-14 * w * self.reaches[lane] * self.reaches[lane];
                    let per_square = if wide { 1.0 / tt } else { 0.0 };
                    let width = if wide { (tt * each).sqrt() } else { 0.0 };
                    let slope = ty * per_square;
                    let inside = yy - slope * ty;
                    nodes.inside[lane] = if inside > 0.0 { inside } else { 0.0 };
                    // Gauss's rule with two nodes: zeros of x² − skewness · x − 1 in units of the width, with shares of the
                    // weight 1/(1 + x²).
                    let skewness = ttt * per_square * (w * per_square) * width;
                    let root = (skewness * skewness + 4.0).sqrt();
                    let (early, late) = (0.5 * (skewness - root), 0.5 * (skewness + root));
                    let share = if wide { 1.0 / (1.0 + early * early) } else { 1.0 };
                    for ([times, values, roots], (x, share)) in
                        nodes.both.iter_mut().zip([(early, share), (late, 1.0 - share)])
                    {
                        let along = x * width;
                        roots[lane] = (w * share).sqrt();
                        times[lane] = self.places[lane] + t + along;
                        values[lane] = (self.levels[lane] + y + slope * along) * roots[lane];
                    }
                }
                nodes
            },
        )
    }
}

/// Nodes of bins side by side.
#[derive(Default)]
struct Nodes {
    /// Times, values times roots, and roots, of the early and of the late node.
    both: [[[f64; LANES]; 3]; 2],
    /// Weighted squares of what the lines leave over.
    inside: [f64; LANES],
}

/// How many of rising parameters lie below `end`: one look at eight of them.
fn count_below(rising: &[f64], end: f64) -> usize {
    let (blocks, rest) = rising.as_chunks::<8>();
    let whole = blocks.iter().take_while(|block| block[7] < end).count();
    let last = blocks.get(whole).map_or(rest, |block| block);
    8 * whole + last.iter().filter(|parameter| **parameter < end).count()
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
