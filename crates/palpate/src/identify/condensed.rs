//! A hold condensed to a few dozen nodes that carry nearly all it says.

use super::separable::Target;
use crate::vector::accelerated;

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
            let later = &times[from + 1..];
            let alone = later.first().is_none_or(|next| *next >= end);
            let until = from + 1 + if alone { 0 } else { later.partition_point(|time| *time < end) };
            let range = from..until;
            condensed.bin(&times[range.clone()], &values[range.clone()], roots.map(|roots| &roots[range]));
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

    fn bin(&mut self, times: &[f64], values: &[f64], roots: Option<&[f64]>) {
        if times.len() <= 2 {
            for (i, (&time, &value)) in times.iter().zip(values).enumerate() {
                self.node(time, value, roots.map_or(1.0, |roots| roots[i]));
            }
            return;
        }
        let moments = match roots {
            None => Moments::of(times, values, EqualWeights),
            Some(roots) => Moments::of(times, values, roots),
        };
        self.inside += moments.inside;
        if moments.weight == 0.0 {
            return;
        }
        if moments.width == 0.0 {
            self.node(moments.time, moments.value, moments.weight.sqrt());
            return;
        }
        // Gauss's rule with two nodes: zeros of x² − skewness · x − 1 in units of the spread.
        let root = (moments.skewness * moments.skewness + 4.0).sqrt();
        for x in [0.5 * (moments.skewness - root), 0.5 * (moments.skewness + root)] {
            let weight = moments.weight / (1.0 + x * x);
            let along = x * moments.width;
            self.node(moments.time + along, moments.value + moments.slope * along, weight.sqrt());
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
    fn of(times: &[f64], values: &[f64], roots: impl Roots) -> Self {
        let [w, wt, wy] = sums(
            times,
            values,
            roots,
            #[inline(always)]
            |w, t, y| [w, w * t, w * y],
        );
        let (time, value) = if w > 0.0 { (wt / w, wy / w) } else { (0.0, 0.0) };
        let [tt, ttt, ty, yy] = sums(
            times,
            values,
            roots,
            #[inline(always)]
            |w, t, y| {
                let (dt, dy) = (t - time, y - value);
                let along = w * dt;
                [along * dt, along * dt * dt, along * dy, w * dy * dy]
            },
        );
        // A bin whose weight lies on one sample has no width.
        let wide = tt > 1e-24 * w * time * time;
        let width = if wide { (tt / w).sqrt() } else { 0.0 };
        let slope = if wide { ty / tt } else { 0.0 };
        Self {
            weight: w,
            time,
            value,
            width,
            skewness: if wide { ttt / (w * width * width * width) } else { 0.0 },
            slope,
            inside: (yy - slope * ty).max(0.0),
        }
    }
}

/// Square roots of the weights of the samples of a bin.
trait Roots: Copy {
    fn at(&self, index: usize) -> f64;
}

/// All one.
#[derive(Clone, Copy)]
struct EqualWeights;

impl Roots for EqualWeights {
    #[inline(always)]
    fn at(&self, _: usize) -> f64 {
        1.0
    }
}

impl Roots for &[f64] {
    #[inline(always)]
    fn at(&self, index: usize) -> f64 {
        self[index]
    }
}

/// Σ f(weight, time, value) over the samples, in lanes.
#[inline(always)]
fn sums<const N: usize>(
    times: &[f64],
    values: &[f64],
    roots: impl Roots,
    f: impl Fn(f64, f64, f64) -> [f64; N],
) -> [f64; N] {
    const LANES: usize = 8;
    if times.len() < 2 * LANES {
        let mut sums = [0.0; N];
        for (index, (t, y)) in times.iter().zip(values).enumerate() {
            let root = roots.at(index);
            let terms = f(root * root, *t, *y);
            for k in 0..N {
                sums[k] += terms[k];
            }
        }
        return sums;
    }
    accelerated(
        #[inline(always)]
        || {
            let mut sums = [[0.0; LANES]; N];
            let ((times, late_times), (values, late_values)) =
                (times.as_chunks::<LANES>(), values.as_chunks::<LANES>());
            for (index, (t, y)) in times.iter().zip(values).enumerate() {
                for lane in 0..LANES {
                    let root = roots.at(index * LANES + lane);
                    let terms = f(root * root, t[lane], y[lane]);
                    for k in 0..N {
                        sums[k][lane] += terms[k];
                    }
                }
            }
            for (lane, (t, y)) in late_times.iter().zip(late_values).enumerate() {
                let root = roots.at(times.len() * LANES + lane);
                let terms = f(root * root, *t, *y);
                for k in 0..N {
                    sums[k][lane] += terms[k];
                }
            }
            sums.map(|lanes| lanes.iter().sum())
        },
    )
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
