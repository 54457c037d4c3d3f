//! A hold fitted at one exponent: F(t) = F_e + A φ(t; λ, n), with everything that its readings leave open.
//!
//! For a given λ the best F_e and A follow from means, so the search is for ln λ alone: a coarse grid, then halvings of the bracket. What
//! is left open is kept as *nodes*, values of λ on either side of the best, up to where the sum of squares has grown by z²s²: with the
//! best F_e and A of each they hold the region of confidence of all three numbers (profile likelihood). Where n is known to a deviation
//! only, the ends of its interval have nodes of their own: the readings of a hold are not requested n, of which they tell little.

use super::bins::{Bin, MOST};
use crate::latency::decay;
use crate::observe::{Normal, kept};

/// Most values of λ on either side of the best.
const SIDE: usize = 10;
/// Fewest means: three numbers and two over.
pub(in crate::observe) const FEWEST: usize = 5;
/// Slowest relaxation that is sought: λ times the time that was observed. Slower ones are straight lines to the eye, and to a fit.
const SLOWEST: f64 = 0.05;
/// Fastest: λ times the time of the first mean. Faster ones are one pure power.
const FASTEST: f64 = 100.0;
/// Step of the coarse grid in ln λ; the sum of squares bends over two to three of them.
const GRID: f64 = 1.2;

/// The best F_e and A at one λ.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Node {
    exponent: f64,
    log_rate: f64,
    rate: f64,
    squares: f64,
    amplitude: f64,
    mean: f64,
    mean_shape: f64,
    shape_squares: f64,
    /// z²s² less what the sum of squares has grown by.
    budget: f64,
}
kept!(Node: exponent, log_rate, rate, squares, amplitude, mean, mean_shape, shape_squares, budget);

impl Node {
    fn new(bins: &[Bin], weight: f64, exponent: f64, log_rate: f64) -> Self {
        let rate = log_rate.exp();
        let (mut shapes, mut values) = (0.0, 0.0);
        let mut shape = [0.0; MOST];
        for (shape, bin) in shape.iter_mut().zip(bins) {
            *shape = mean_shape(bin, rate, exponent);
            shapes += bin.count * *shape;
            values += bin.count * bin.value;
        }
        let (mean_shape, mean) = (shapes / weight, values / weight);
        let (mut shape_squares, mut product, mut all) = (0.0, 0.0, 0.0);
        for (shape, bin) in shape.iter().zip(bins) {
            let (x, y) = (shape - mean_shape, bin.value - mean);
            shape_squares += bin.count * x * x;
            product += bin.count * x * y;
            all += bin.count * y * y;
        }
        let amplitude = if shape_squares > 0.0 { product / shape_squares } else { 0.0 };
        Self {
            exponent,
            log_rate,
            rate,
            squares: (all - amplitude * product).max(0.0),
            amplitude,
            mean,
            mean_shape,
            shape_squares,
            budget: 0.0,
        }
    }

    /// F(t) with the best F_e and A of this λ, N; that of the end of time for an infinite t.
    fn force(&self, time: f64) -> (f64, f64) {
        let off = shape_at(self.rate * time, self.exponent) - self.mean_shape;
        (self.mean + self.amplitude * off, off)
    }
}

fn shape_at(scaled: f64, exponent: f64) -> f64 {
    if scaled.is_infinite() {
        0.0
    } else if exponent == 5.0 {
        1.0 / (1.0 + 4.0 * scaled).sqrt().sqrt()
    } else {
        decay(scaled, exponent)
    }
}

/// Mean of φ over the readings of a bin.
fn mean_shape(bin: &Bin, rate: f64, exponent: f64) -> f64 {
    if bin.spread <= 0.02 * bin.time {
        return shape_at(rate * bin.time, exponent);
    }
    let early = shape_at(rate * (bin.time - bin.spread).max(0.0), exponent);
    0.5 * (early + shape_at(rate * (bin.time + bin.spread), exponent))
}

/// A fitted hold.
#[derive(Debug, Clone, Copy)]
pub(in crate::observe) struct HoldFit {
    best: Node,
    nodes: [Node; 3 * (2 * SIDE + 1)],
    len: usize,
    /// Variance of one reading.
    variance: f64,
    weight: f64,
    /// Half an interval in standard deviations.
    factor: f64,
}
kept!(HoldFit: best, nodes, len, variance, weight, factor; |fit| fit.len <= fit.nodes.len());

impl HoldFit {
    /// Fits means of a hold at an exponent that is known to its deviation; `deviation` is the least that one reading scatters (N), `correlated` the
    /// variance of one reading as if readings were independent, where they are observed to follow each other, with its degrees of freedom, and
    /// `factor` half an interval in standard deviations by the degrees of freedom.
    pub(in crate::observe) fn new(
        bins: &[Bin],
        exponent: Normal,
        deviation: f64,
        correlated: Option<(f64, f64)>,
        factor: impl Fn(f64) -> f64,
    ) -> Option<Self> {
        if bins.len() < FEWEST {
            return None;
        }
        let weight: f64 = bins.iter().map(|bin| bin.count).sum();
        let last = bins[bins.len() - 1].time;
        let first = bins.iter().map(|bin| bin.time).find(|time| *time > 0.0)?;
        let (low, high) = ((SLOWEST / last).ln(), (FASTEST / first).ln());
        let node = |log_rate: f64| Node::new(bins, weight, exponent.mean, log_rate);
        let least = best(&node, (low, high))?;
        let freedom = (bins.len() - 3) as f64;
        // Means that scatter more than their readings tell of noise that is slow, or of a hold that the law does not describe.
        let largest = bins.iter().map(|bin| bin.value.abs()).fold(0.0, f64::max);
        let all = (deviation * deviation).max(least.squares / freedom).max((1e-12 * largest).powi(2));
        let late = late_variance(bins, &least, freedom);
        let (variance, freedom) = [(all, freedom), late]
            .into_iter()
            .chain(correlated)
            .fold((0.0, freedom), |a, b| if b.0 > a.0 { b } else { a });
        let factor = factor(freedom);
        let mut fit = Self {
            best: least,
            nodes: [Node::default(); 3 * (2 * SIDE + 1)],
            len: 0,
            variance,
            weight,
            factor,
        };
        fit.open(&node, &least, (low, high));
        if exponent.deviation > 0.0 {
            for side in [-1.0, 1.0] {
                let end = (exponent.mean + side * factor * exponent.deviation).max(1.0);
                let node = |log_rate: f64| Node::new(bins, weight, end, log_rate);
                if let Some(there) = best(&node, (low, high)) {
                    fit.open(&node, &there, (low, high));
                }
            }
        }
        Some(fit)
    }

    /// Adds the nodes about the best of an exponent.
    fn open(&mut self, node: &impl Fn(f64) -> Node, best: &Node, (low, high): (f64, f64)) {
        let most = self.factor * self.factor * self.variance;
        let mut keep = |mut node: Node| {
            node.budget = most - (node.squares - best.squares).max(0.0);
            let inside = node.budget > 0.0 && self.len < self.nodes.len();
            if inside {
                self.nodes[self.len] = node;
                self.len += 1;
            }
            inside
        };
        keep(*best);
        // From the curvature of the sum of squares: S(ln λ ± h) = S + s² (h/σ)².
        let probe = 0.05;
        let grown = 0.5 * (node(best.log_rate - probe).squares + node(best.log_rate + probe).squares) - best.squares;
        let sigma = if grown > 0.0 { probe * (self.variance / grown).sqrt() } else { 1.0 };
        for (end, side) in [(low, -1.0), (high, 1.0)] {
            let (mut step, mut at) = ((0.4 * sigma).clamp(1e-6, 1.0), best.log_rate);
            for _ in 0..SIDE {
                if (at - end) * side >= 0.0 {
                    break;
                }
                at += side * step;
                step = (1.35 * step).min(1.5);
                let clamped = if (at - end) * side > 0.0 { end } else { at };
                if !keep(node(clamped)) {
                    break;
                }
            }
        }
    }

    /// Best force at `time` (s since the hold began, perhaps infinite), N.
    pub(in crate::observe) fn force(&self, time: f64) -> f64 {
        self.best.force(time).0
    }

    /// Ends of the interval of the force at a time, N: the widest that any λ of the region allows.
    pub(in crate::observe) fn interval(&self, time: f64) -> (f64, f64) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for node in &self.nodes[..self.len] {
            let (force, off) = node.force(time);
            let half = (node.budget * self.unit_variance(node, off)).sqrt();
            low = low.min(force - half);
            high = high.max(force + half);
        }
        (low, high)
    }

    fn unit_variance(&self, node: &Node, off: f64) -> f64 {
        let slope = if node.shape_squares > 0.0 { off * off / node.shape_squares } else { 0.0 };
        1.0 / self.weight + slope
    }

    /// The force at a time with its standard deviation.
    pub(in crate::observe) fn force_at(&self, time: f64) -> Normal {
        let (low, high) = self.interval(time);
        Normal::new(self.force(time), 0.5 * (high - low) / self.factor)
    }

    /// The force that the hold tends to; `None` until its interval is narrower than the force.
    pub(in crate::observe) fn equilibrium(&self) -> Option<Normal> {
        let equilibrium = self.force_at(f64::INFINITY);
        let known = 2.0 * self.factor * equilibrium.deviation < self.best.mean.abs();
        (known && equilibrium.deviation.is_finite()).then_some(equilibrium)
    }

    /// v|x|ⁿ⁻¹ at a time, 1/s.
    pub(in crate::observe) fn relative_rate(&self, time: f64) -> f64 {
        self.best.rate / (1.0 + (self.best.exponent - 1.0) * self.best.rate * time)
    }

    /// Whether the data show a relaxation: whether λ and A could not as well be anything.
    pub(in crate::observe) fn relaxes(&self) -> bool {
        let flat = self.best.amplitude.powi(2) * self.best.shape_squares;
        flat > self.factor * self.factor * self.variance
    }
}

/// Variance of one reading as if readings were independent, from how far means are off the fit, with its degrees of freedom.
///
/// Noise that correlates averages out slowly: means of many readings scatter by more than their number says, those of few do not. The former
/// decide what the fit says of the end, so that each counts by its readings. Means that follow each other to one side count as fewer.
fn late_variance(bins: &[Bin], best: &Node, freedom: f64) -> (f64, f64) {
    let off = |bin: &Bin| {
        let shape = mean_shape(bin, best.rate, best.exponent) - best.mean_shape;
        bin.count.sqrt() * (bin.value - best.mean - best.amplitude * shape)
    };
    let (mut counts, mut count_squares, mut square, mut product) = (0.0, 0.0, 0.0, 0.0);
    let mut before: Option<(f64, f64)> = None;
    for bin in bins {
        let here = off(bin);
        counts += bin.count;
        count_squares += bin.count * bin.count;
        square += bin.count * here * here;
        if let Some((count, there)) = before {
            product += (bin.count * count).sqrt() * here * there;
        }
        before = Some((bin.count, here));
    }
    if square <= 0.0 {
        return (0.0, freedom);
    }
    let total = bins.len() as f64;
    // Three fitted parameters take up as much of these as of all means.
    let independent = (counts * counts / count_squares * freedom / total).max(1.0);
    let correlation = (product / square + 1.0 / independent).clamp(0.0, 0.8);
    let excess = (1.0 + correlation) / (1.0 - correlation);
    // Below what chance alone does, means are as independent as they look.
    let excess = if correlation > 2.0 / independent.sqrt() { excess } else { 1.0 };
    (square / counts * total / freedom * excess, independent / excess)
}

/// The best λ between two: the least of a coarse grid, its bracket halved in golden sections, and a parabola through the last three.
fn best(node: &impl Fn(f64) -> Node, (low, high): (f64, f64)) -> Option<Node> {
    let steps = ((high - low) / GRID).ceil().clamp(2.0, 60.0);
    let step = (high - low) / steps;
    let mut least: Option<Node> = None;
    for index in 0..=steps as usize {
        let here = node(low + step * index as f64);
        if least.is_none_or(|least| here.squares < least.squares) {
            least = Some(here);
        }
    }
    let mut middle = least?;
    if !middle.squares.is_finite() {
        return None;
    }
    let (mut a, mut b) = ((middle.log_rate - step).max(low), (middle.log_rate + step).min(high));
    for _ in 0..14 {
        // The longer side, at the golden section.
        let right = b - middle.log_rate > middle.log_rate - a;
        let at = if right {
            middle.log_rate + 0.381_966 * (b - middle.log_rate)
        } else {
            middle.log_rate - 0.381_966 * (middle.log_rate - a)
        };
        let there = node(at);
        if there.squares < middle.squares {
            if right {
                a = middle.log_rate;
            } else {
                b = middle.log_rate;
            }
            middle = there;
        } else if right {
            b = at;
        } else {
            a = at;
        }
    }
    Some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::hold::Bins;
    use crate::random::Rng;

    fn hold(seed: u64, exponent: f64, noise: f64, seconds: f64) -> HoldFit {
        let given = Normal::new(exponent, 0.0);
        fitted_at(given, seed, exponent, noise, seconds)
    }

    fn fitted_at(given: Normal, seed: u64, exponent: f64, noise: f64, seconds: f64) -> HoldFit {
        let (mut bins, mut noise_source) = (Bins::default(), Rng::new(seed));
        for i in 0..(seconds * 500.0) as usize {
            let t = i as f64 / 500.0;
            bins.push(t, 1.2 + 1.7 * decay(6.0 * t, exponent) + noise * noise_source.normal());
        }
        HoldFit::new(bins.as_slice(), given, noise, None, |_| 1.96).unwrap()
    }

    #[test]
    fn a_hold_without_noise_gives_its_numbers() {
        for exponent in [1.0, 2.0, 5.0, 9.0] {
            let fit = hold(1, exponent, 0.0, 10.0);
            assert!((fit.force(f64::INFINITY) - 1.2).abs() < 2e-3, "{exponent}: {}", fit.force(f64::INFINITY));
            assert!((fit.relative_rate(0.0) / 6.0 - 1.0).abs() < 5e-3, "{exponent}: {}", fit.relative_rate(0.0));
        }
    }

    #[test]
    fn an_exponent_that_is_known_to_a_deviation_widens_the_interval_until_it_holds_the_truth() {
        for noise in [0.001, 0.02] {
            for (deviation, expected) in [(0.0, 0..=230), (0.6, 366..=400)] {
                let mut spread = Rng::new(7);
                let inside = (0..400)
                    .filter(|seed| {
                        // The body's exponent is one of N(5, 0.6²), the fit knows no more of it.
                        let exponent = 5.0 + 0.6 * spread.normal();
                        let given = Normal { mean: 5.0, deviation };
                        let (low, high) = fitted_at(given, *seed, exponent, noise, 10.0).interval(f64::INFINITY);
                        low <= 1.2 && 1.2 <= high
                    })
                    .count();
                println!("noise {noise} N, n known to {deviation}: inside {inside} of 400");
                assert!(expected.contains(&inside), "{noise} {deviation}: {inside}");
            }
        }
    }

    /// Readings that correlate were counted as independent: 44 to 75 of 100 intervals contained the truth.
    #[test]
    fn noise_that_correlates_widens_the_intervals_until_they_contain_the_truth() {
        for (rate, rho, seconds) in [(500.0, 0.9, 4.0), (100.0, 0.9, 10.0), (100.0, 0.9, 40.0), (500.0, 0.98, 10.0)] {
            for time in [2.0 * seconds, f64::INFINITY] {
                let truth = 1.2 + 1.7 * shape_at(6.0 * time, 5.0);
                let inside = (0..400)
                    .filter(|seed| {
                        let (mut bins, mut random) = (Bins::default(), Rng::new(*seed));
                        let mut noise = random.normal();
                        for i in 0..(seconds * rate) as usize {
                            let t = i as f64 / rate;
                            noise = rho * noise + (1.0_f64 - rho * rho).sqrt() * random.normal();
                            bins.push(t, 1.2 + 1.7 * decay(6.0 * t, 5.0) + 0.05 * noise);
                        }
                        // What distances from lines through neighbours show of it.
                        let deviation = 0.05 * ((1.0 - rho) * (3.0 - rho) / 3.0_f64).sqrt();
                        let factor = |freedom| crate::statistics::coverage_factor(0.95, freedom);
                        let fit =
                            HoldFit::new(bins.as_slice(), Normal::new(5.0, 0.0), deviation, None, factor).unwrap();
                        let (low, high) = fit.interval(time);
                        low <= truth && truth <= high
                    })
                    .count();
                println!("{rate} Hz, {rho}, {seconds} s, at {time} s: {inside} of 400");
                assert!(inside >= 356, "{rate} {rho} {seconds} {time}: {inside}");
            }
        }
    }

    #[test]
    fn intervals_of_forces_then_and_at_the_end_contain_the_truth_as_often_as_they_say() {
        for exponent in [1.0, 5.0] {
            for time in [5.0, 40.0, f64::INFINITY] {
                let truth = 1.2 + 1.7 * shape_at(6.0 * time, exponent);
                let inside = (0..400)
                    .filter(|seed| {
                        let (low, high) = hold(*seed, exponent, 0.05, 4.0).interval(time);
                        low <= truth && truth <= high
                    })
                    .count();
                // 95 % of 400 is 380; three standard deviations are 13.
                assert!((366..=396).contains(&inside), "{exponent} {time}: {inside}");
            }
        }
    }
}
