//! The force of a first ramp under the latency law, and where it begins.

use std::ops::Range;
use std::rc::Rc;

use crate::contact::Specimen;
use crate::fit::{ExponentChoice, FitOptions, LatencyFit, fit_hold};
use crate::record::Record;
use crate::segment::segmentation::Segment;
use crate::statistics::{effective_count, lag_one_correlation, mean, median, noise, slope};

/// Where a loading curve begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// Displacement of first touch, m.
    pub(super) displacement: f64,
    /// Its standard error, m.
    pub(super) error: f64,
    /// Force without contact, N.
    pub(super) base: f64,
    /// Root mean square residual, N.
    pub(super) noise: f64,
    /// The curve leaves more of the ramp than the noise of the force.
    pub(super) misses: bool,
    /// Rise of the force in the ramp, N.
    pub(super) rise: f64,
    /// The likeliest law by its place among those of the hold, with its d₀, ln X and F₀.
    best: (usize, [f64; 3]),
}

/// A first ramp at constant speed, and the law of the hold behind it.
///
/// With s = d − d₀ the travel since first touch, S the stiffness of the body and index 1 for the end of the ramp,
///
/// ```text
/// F(s) = F₀ + S(s)/S(s₁) · [ (F_e − F₀) s/s₁ + X y(s/s₀) ],    dy/dτ = 1 − yⁿ, y(0) = 0,    s₀ = ḋ X¹⁻ⁿ/v
/// ```
///
/// is equation (11) with the excess strain that (10) gives at a constant drive: X is the excess force at which the drive and
/// the relaxation balance. n, v and F_e come from the hold; d₀, X and F₀ are found here. A jaw that came at another speed, ḋ₁, up to a corner, balances
/// at X (ḋ₁/ḋ)^(1/n) there, and y goes on from what it has reached.
pub(super) struct LoadingCurve<'a> {
    displacement: Vec<f64>,
    force: Vec<f64>,
    /// Displacement of the hold, m.
    level: f64,
    speeds: Speeds,
    /// The body, of any modulus; `None` for a constant section.
    body: Option<&'a Specimen>,
    /// Laws of the hold with one exponent each.
    laws: Vec<HoldLaw>,
    rise: f64,
    deviation: f64,
}

/// What the hold says, in N and s, with the excess curve of its exponent.
#[derive(Clone)]
struct HoldLaw {
    fit: LatencyFit,
    coefficient: f64,
    relaxed: f64,
    curve: Rc<ExcessCurve>,
}

impl HoldLaw {
    fn new(fit: LatencyFit) -> Self {
        Self {
            coefficient: fit.rate_coefficient().value,
            relaxed: fit.equilibrium().value,
            curve: Rc::new(ExcessCurve::new(fit.exponent().value)),
            fit,
        }
    }
}

/// Speeds of the jaw in a ramp, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Speeds {
    last: f64,
    /// Another one before, and the displacement (m) at which it ends: a jaw that searches for the body and presses it faster or more slowly.
    earlier: Option<(f64, f64)>,
}

/// Logarithms of the ratios of two speeds of a ramp: the least, and one of a jaw that as good as stood, whose excess would be beyond the curves.
const DIFFER: f64 = 0.05;
const FARTHEST: f64 = 3.0;
/// Share of the squared residual of one line that two lines leave at most.
const LEFT: f64 = 0.05;
/// Samples on each side of a corner at least, and corners that are tried at most.
const BESIDE: usize = 4;
const CORNERS: usize = 60;

impl Speeds {
    /// From times and places of a ramp and the sample before it; `None` where the jaw does not advance.
    fn of(times: &[f64], places: &[f64]) -> Option<Self> {
        // The last sample belongs to the ramp only if the jaw was still moving there.
        let (last, middle) = (times.len() - 1, (times.len() - 1) / 4);
        let mean = (places[last] - places[middle]) / (times[last] - times[middle]);
        let lines = |at: usize| [0..at, at..last + 1].map(|part| Line::of(&times[part.clone()], &places[part]));
        let left = |lines: &[Line; 2]| lines.iter().map(|line| line.square).sum::<f64>();
        let every = last.div_ceil(CORNERS).max(1);
        let corners = (BESIDE..(last + 1).saturating_sub(BESIDE)).step_by(every).map(lines);
        let best = corners.min_by(|a, b| left(a).total_cmp(&left(b)));
        let whole = Line::of(times, places).square;
        let earlier = best.filter(|lines| {
            let [first, then] = lines.each_ref().map(|line| line.speed);
            let apart = (then / first).ln().abs();
            first > 0.0 && then > 0.0 && (DIFFER..FARTHEST).contains(&apart) && left(lines) < LEFT * whole
        });
        let speeds = match earlier {
            Some([first, then]) => Self {
                last: then.speed,
                earlier: Some((first.speed, first.meets(&then))),
            },
            None => Self {
                last: mean,
                earlier: None,
            },
        };
        (speeds.last.is_finite() && speeds.last > 0.0).then_some(speeds)
    }
}

/// A line through places over time.
struct Line {
    /// m/s
    speed: f64,
    /// Place at time 0, m.
    start: f64,
    /// Sum of squared residuals, m².
    square: f64,
}

impl Line {
    fn of(times: &[f64], places: &[f64]) -> Self {
        let speed = slope(times, places);
        let start = mean(places) - speed * mean(times);
        let off = |(time, place): (&f64, &f64)| (place - start - speed * time).powi(2);
        Self {
            speed,
            start,
            square: times.iter().zip(places).map(off).sum(),
        }
    }

    /// The place where it meets another one, m.
    fn meets(&self, other: &Self) -> f64 {
        self.start + self.speed * (other.start - self.start) / (self.speed - other.speed)
    }
}

/// How many times the noise of the force a curve leaves of the ramp that does not describe it.
const MISSES: f64 = 1.2;

/// Samples of ramp and rest that are fitted, at most.
const MOST: usize = 600;

impl<'a> LoadingCurve<'a> {
    /// With samples at rest before the ramp; `None` if the hold has no law, or does not relax downwards.
    pub(super) fn of(
        record: &Record,
        displacement: &[f64],
        rest: Range<usize>,
        ramp: &Segment,
        hold: &Segment,
        body: Option<&'a Specimen>,
    ) -> Option<Self> {
        let laws = laws(record, hold)?;
        let foot = ramp.start.saturating_sub(1);
        let speeds = Speeds::of(&record.time()[foot..ramp.end], &displacement[foot..ramp.end])?;
        let every = (ramp.end - foot).div_ceil(MOST);
        let rest = rest.start.max(rest.end.saturating_sub(MOST))..rest.end;
        let samples: Vec<usize> = rest.chain((foot..ramp.end).step_by(every)).collect();
        let force = record.force();
        let top = force[foot..ramp.end].iter().fold(f64::MIN, |most, f| most.max(*f));
        Some(Self {
            displacement: samples.iter().map(|i| displacement[*i]).collect(),
            force: samples.iter().map(|i| force[*i]).collect(),
            level: median(&mut displacement[hold.start..hold.end].to_vec()),
            speeds,
            body,
            laws,
            rise: top - force[foot],
            deviation: noise(&force[..ramp.end]),
        })
    }

    /// First touch in a ramp that starts at `from` and travels `travel` (m).
    ///
    /// The mean over the laws, each weighted by how likely it makes ramp and hold together; a hold that leaves the exponent
    /// open adds the scatter of first touch over the laws to the error.
    pub(super) fn touch(&self, from: f64, travel: f64) -> Option<Touch> {
        let pairs = self.laws.iter().enumerate();
        let pairs = pairs.map(|(place, law)| (self.fitted(law, self.starts(law, from, travel)), place));
        let fits: Vec<(Curve, usize)> = pairs.filter_map(|(curve, place)| Some((curve?, place))).collect();
        let total = |fit: &(Curve, usize)| fit.0.square + self.laws[fit.1].fit.residual_square;
        let best = fits.iter().min_by(|a, b| total(a).total_cmp(&total(b)))?;
        let samples = self.force.len() + self.laws[best.1].fit.samples;
        let variance = (total(best) / samples as f64).max(f64::MIN_POSITIVE);
        let weights: Vec<f64> = fits.iter().map(|fit| (0.5 * (total(best) - total(fit)) / variance).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let average = |value: &dyn Fn(&Curve) -> f64| {
            fits.iter().zip(&weights).map(|(fit, weight)| weight * value(&fit.0)).sum::<f64>() / sum
        };
        let displacement = average(&|curve| curve.parameters[0]);
        let square = average(&|curve| curve.error.powi(2) + (curve.parameters[0] - displacement).powi(2));
        let by_hold = self.error_by_hold(&best.0, &self.laws[best.1]);
        let left = (best.0.square / self.force.len() as f64).sqrt();
        Some(Touch {
            displacement,
            error: square.sqrt().hypot(by_hold),
            base: average(&|curve| curve.parameters[2]),
            noise: left.max(self.deviation),
            misses: left > MISSES * self.deviation.max(1e-9 * self.rise),
            rise: self.rise,
            best: (best.1, best.0.parameters),
        })
    }

    /// The force of the likeliest curve of a touch at a displacement (m), N.
    pub(super) fn force_of(&self, touch: &Touch, displacement: f64) -> f64 {
        let (law, parameters) = &touch.best;
        self.force_at(&self.laws[*law], parameters, displacement)
    }

    /// Standard error of d₀ that the errors of F_e and v bring in: √(gᵀ C g) with the slopes g of d₀ along the numbers of the
    /// hold and their covariance C.
    fn error_by_hold(&self, best: &Curve, law: &HoldLaw) -> f64 {
        // Of the equilibrium force, the amplitude and ln λ.
        let Some(covariance) = law.fit.covariance() else {
            return 0.0;
        };
        let moved = |relaxed: f64, log_coefficient: f64| {
            let law = HoldLaw {
                relaxed: law.relaxed + relaxed,
                coefficient: law.coefficient * log_coefficient.exp(),
                ..law.clone()
            };
            self.fitted(&law, vec![best.parameters])
                .map_or(0.0, |curve| curve.parameters[0] - best.parameters[0])
        };
        let relaxed_error = covariance[0][0].max(0.0).sqrt();
        if relaxed_error <= 1e-12 * self.rise {
            return 0.0;
        }
        let log_error = (covariance[2][2].max(0.0).sqrt() * 0.5).clamp(1e-6, 0.1);
        let by_relaxed = moved(relaxed_error, 0.0) / relaxed_error;
        let by_log = moved(0.0, log_error) / log_error;
        // v = λ Δ¹⁻ⁿ
        let slopes = [by_relaxed, by_log * (1.0 - law.curve.exponent) / law.fit.amplitude().value, by_log];
        let rows = (0..3).map(|i: usize| slopes[i] * (0..3).map(|j: usize| covariance[i][j] * slopes[j]).sum::<f64>());
        rows.sum::<f64>().max(0.0).sqrt()
    }

    /// Starting points: first touch anywhere in the ramp, the balance at the amplitude of the hold or beyond.
    fn starts(&self, law: &HoldLaw, from: f64, travel: f64) -> Vec<[f64; 3]> {
        const TOUCHES: u32 = 48;
        let base = self.force[0];
        let mut starts: Vec<([f64; 3], f64)> = (0..TOUCHES)
            .flat_map(|i| {
                let touch = from + travel * f64::from(i) / f64::from(TOUCHES);
                [0.9, 1.1, 2.0, 5.0].map(|share| [touch, (share * law.fit.amplitude().value).ln(), base])
            })
            .map(|start| (start, self.square(law, &start)))
            .collect();
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
        starts.into_iter().take(2).map(|(start, _)| start).collect()
    }

    fn force_at(&self, law: &HoldLaw, parameters: &[f64; 3], displacement: f64) -> f64 {
        let [touch, balance, base] = *parameters;
        let (s, whole) = (displacement - touch, self.level - touch);
        if s <= 0.0 {
            return base;
        }
        let stiffness = |s: f64| self.body.map_or(1.0, |body| body.stiffness(body.contact_displacement(s)).0);
        let excess = self.excess(law, balance.exp(), touch, s);
        base + stiffness(s) / stiffness(whole) * ((law.relaxed - base) * s / whole + excess)
    }

    /// The excess force (N) at a travel s (m) since first touch, with its balance (N) at the last speed.
    fn excess(&self, law: &HoldLaw, balance: f64, touch: f64, s: f64) -> f64 {
        let n = law.curve.exponent;
        let transient = |speed: f64, balance: f64| speed * balance.powf(1.0 - n) / law.coefficient;
        let Speeds { last, earlier } = self.speeds;
        let rest = transient(last, balance);
        let Some((first, corner)) = earlier.map(|(first, corner)| (first, corner - touch)).filter(|(_, at)| *at > 0.0)
        else {
            return balance * law.curve.at(s / rest);
        };
        let balanced = balance * (first / last).powf(1.0 / n);
        let before = balanced * law.curve.at(s.min(corner) / transient(first, balanced));
        if s <= corner {
            before
        } else {
            balance * law.curve.on_from(before / balance, (s - corner) / rest)
        }
    }

    fn residuals(&self, law: &HoldLaw, parameters: &[f64; 3]) -> Vec<f64> {
        let pairs = self.displacement.iter().zip(&self.force);
        pairs.map(|(d, force)| force - self.force_at(law, parameters, *d)).collect()
    }

    fn square(&self, law: &HoldLaw, parameters: &[f64; 3]) -> f64 {
        let square: f64 = self.residuals(law, parameters).iter().map(|r| r * r).sum();
        if square.is_finite() { square } else { f64::INFINITY }
    }

    /// Levenberg–Marquardt from every start; the best curve.
    fn fitted(&self, law: &HoldLaw, starts: Vec<[f64; 3]>) -> Option<Curve> {
        let runs = starts.into_iter().map(|start| self.descended(law, start));
        let (best, square) = runs.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, square)| square.is_finite())?;
        let residuals = self.residuals(law, &best);
        let count = residuals.len();
        if count < 6 {
            return None;
        }
        let (normal, _) = self.normal(law, &best, &residuals);
        let column = solved(normal, [1.0, 0.0, 0.0])?;
        // A curve that misses the shape leaves residuals that go together; fewer of them count.
        let freedom = (effective_count(count, lag_one_correlation(&residuals)) - 3.0).max(1.0);
        let error = (column[0].max(0.0) * square / freedom).sqrt();
        let curve = Curve {
            parameters: best,
            error,
            square,
        };
        error.is_finite().then_some(curve)
    }

    fn descended(&self, law: &HoldLaw, start: [f64; 3]) -> ([f64; 3], f64) {
        let (mut at, mut square, mut damping) = (start, self.square(law, &start), 1e-3);
        for _ in 0..60 {
            let (normal, gradient) = self.normal(law, &at, &self.residuals(law, &at));
            let mut damped = normal;
            for (i, row) in damped.iter_mut().enumerate() {
                row[i] += damping * normal[i][i].max(f64::MIN_POSITIVE);
            }
            let Some(step) = solved(damped, gradient) else { break };
            let next = [at[0] + step[0], at[1] + step[1], at[2] + step[2]];
            let reached = if next[0] < self.level { self.square(law, &next) } else { f64::INFINITY };
            if reached < square {
                let gain = (square - reached) / square;
                (at, square, damping) = (next, reached, 0.2 * damping);
                if gain < 1e-12 {
                    break;
                }
            } else {
                damping *= 5.0;
                if damping > 1e10 {
                    break;
                }
            }
        }
        (at, square)
    }

    /// JᵀJ and Jᵀr, by central differences.
    fn normal(&self, law: &HoldLaw, at: &[f64; 3], residuals: &[f64]) -> ([[f64; 3]; 3], [f64; 3]) {
        let steps = [1e-6 * (self.level - at[0]), 1e-6, 1e-6 * self.rise];
        let columns: Vec<Vec<f64>> = (0..3)
            .map(|k| {
                let (mut low, mut high) = (*at, *at);
                low[k] -= steps[k];
                high[k] += steps[k];
                let slope = |d: &f64| (self.force_at(law, &high, *d) - self.force_at(law, &low, *d)) / (2.0 * steps[k]);
                self.displacement.iter().map(slope).collect()
            })
            .collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let row = |i: usize| [0, 1, 2].map(|j: usize| product(&columns[i], &columns[j]));
        ([row(0), row(1), row(2)], [0, 1, 2].map(|i: usize| product(&columns[i], residuals)))
    }
}

/// A loading curve laid over a ramp.
struct Curve {
    /// d₀ (m), ln X (X in N) and F₀ (N).
    parameters: [f64; 3],
    /// Standard error of d₀, m.
    error: f64,
    /// Sum of squared residuals, N².
    square: f64,
}

/// Laws of the force in a hold: with a free exponent, a standard error to either side of it, and with common ones.
fn laws(record: &Record, hold: &Segment) -> Option<Vec<HoldLaw>> {
    const FIRST: usize = 400;
    let dense = hold.fit_start..hold.end.min(hold.fit_start + FIRST);
    let every = (hold.end - dense.end).div_ceil(1000).max(1);
    let samples: Vec<usize> = dense.clone().chain((dense.end..hold.end).step_by(every)).collect();
    let times: Vec<f64> = samples.iter().map(|i| record.time()[*i]).collect();
    let force: Vec<f64> = samples.iter().map(|i| record.force()[*i]).collect();
    let fit = |choice| {
        let fit = fit_hold(&times, &force, choice, &FitOptions::default()).ok()?;
        (fit.termination.is_good() && fit.amplitude().value > 0.0).then_some(fit)
    };
    let free = fit(ExponentChoice::Free);
    let near = free.as_ref().and_then(|free| Some((free.exponent().value, free.exponent().standard_error?)));
    let sides = near.map_or(Vec::new(), |(n, error)| vec![n - error, n + error]);
    let exponents = sides.into_iter().chain([1.0, 2.0, 3.0, 5.0, 7.0]).filter(|n| (0.2..=30.0).contains(n));
    let fixed = exponents.filter_map(|n| fit(ExponentChoice::Fixed(n)));
    let laws: Vec<HoldLaw> = free.into_iter().chain(fixed).map(HoldLaw::new).collect();
    (!laws.is_empty()).then_some(laws)
}

/// y(τ) with dy/dτ = 1 − yⁿ and y(0) = 0: the approach of the excess strain to its balance under a constant drive.
struct ExcessCurve {
    exponent: f64,
    values: Vec<f64>,
    /// τ at y = 1 + e^u, from the largest y on, at evenly falling u.
    falling: Vec<f64>,
}

impl ExcessCurve {
    const STEP: f64 = 0.02;
    const STEPS: usize = 1000;

    /// Runge–Kutta of order 4; between the knots a cubic through values and slopes, to 1e-7 or better for n ≥ 1.
    fn new(exponent: f64) -> Self {
        let h = Self::STEP;
        let slope = |y: f64| 1.0 - y.clamp(0.0, 1.0).powf(exponent);
        let mut values = vec![0.0];
        let mut y: f64 = 0.0;
        for _ in 0..Self::STEPS {
            let a = slope(y);
            let b = slope(y + 0.5 * h * a);
            let c = slope(y + 0.5 * h * b);
            let d = slope(y + h * c);
            y = (y + h * (a + 2.0 * b + 2.0 * c + d) / 6.0).min(1.0);
            values.push(y);
        }
        let rate = |u: f64| u.exp() / ((1.0 + u.exp()).powf(exponent) - 1.0);
        let mut falling = vec![0.0];
        let mut tau = 0.0;
        for knot in 0..Self::FALLS {
            let u = Self::HIGHEST - Self::FALL * knot as f64;
            tau += Self::FALL * (rate(u) + 4.0 * rate(u - 0.5 * Self::FALL) + rate(u - Self::FALL)) / 6.0;
            falling.push(tau);
        }
        Self {
            exponent,
            values,
            falling,
        }
    }

    /// Highest u of the values above balance, its steps and their number: y from 21 down to 1 + 10⁻⁸.
    const HIGHEST: f64 = 3.0;
    const FALL: f64 = 0.05;
    const FALLS: usize = 430;

    /// The value a time τ after it was `start`.
    fn on_from(&self, start: f64, tau: f64) -> f64 {
        if start <= 1.0 {
            let knot = self.values.partition_point(|value| *value <= start).clamp(1, Self::STEPS);
            let (low, high) = (self.values[knot - 1], self.values[knot]);
            let share = if high > low { ((start - low) / (high - low)).clamp(0.0, 1.0) } else { 1.0 };
            return self.at(Self::STEP * ((knot - 1) as f64 + share) + tau);
        }
        let place = ((Self::HIGHEST - (start - 1.0).ln()) / Self::FALL).clamp(0.0, Self::FALLS as f64);
        let knot = (place as usize).min(Self::FALLS - 1);
        let since = self.falling[knot] + (place - knot as f64) * (self.falling[knot + 1] - self.falling[knot]);
        let reached = since + tau;
        let knot = self.falling.partition_point(|at| *at <= reached).clamp(1, Self::FALLS);
        let (low, high) = (self.falling[knot - 1], self.falling[knot]);
        let place = (knot - 1) as f64 + ((reached - low) / (high - low)).clamp(0.0, 1.0);
        1.0 + (Self::HIGHEST - Self::FALL * place).exp()
    }

    fn at(&self, tau: f64) -> f64 {
        let place = tau / Self::STEP;
        if place >= Self::STEPS as f64 {
            return 1.0;
        }
        let (knot, t) = (place as usize, place.fract());
        let (y0, y1) = (self.values[knot], self.values[knot + 1]);
        let slope = |y: f64| Self::STEP * (1.0 - y.powf(self.exponent));
        let (a, b) = (slope(y0) - (y1 - y0), (y1 - y0) - slope(y1));
        y0 + t * (y1 - y0) + t * (1.0 - t) * (a * (1.0 - t) + b * t)
    }
}

/// The solution of three linear equations with a symmetric matrix; `None` if it is singular.
pub(super) fn solved(matrix: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled to a unit diagonal: the parameters have different units.
    let scale = [0, 1, 2].map(|i: usize| matrix[i][i].sqrt());
    if scale.iter().any(|s| !(s.is_finite() && *s > 0.0)) {
        return None;
    }
    let m = |i: usize, j: usize| matrix[i][j] / (scale[i] * scale[j]);
    let cofactor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m(a, c) * m(b, d) - m(a, d) * m(b, c)
    };
    let determinant: f64 = [0, 1, 2].iter().map(|j| m(0, *j) * cofactor(0, *j)).sum();
    if determinant.abs() < 1e-14 {
        return None;
    }
    let entry = |i: usize| {
        let sum: f64 = [0, 1, 2].iter().map(|j: &usize| cofactor(*j, i) * right[*j] / scale[*j]).sum();
        sum / determinant / scale[i]
    };
    Some([entry(0), entry(1), entry(2)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against steps of 10⁻⁵ of the equation.
    #[test]
    fn an_excess_goes_on_from_where_it_is() {
        for exponent in [1.0, 2.0, 5.0] {
            let curve = ExcessCurve::new(exponent);
            for start in [0.0, 0.3, 0.999, 1.001, 1.5, 4.0] {
                let mut y: f64 = start;
                for _ in 0..70_000 {
                    y += 1e-5 * (1.0 - (y + 0.5e-5 * (1.0 - y.powf(exponent))).powf(exponent));
                }
                let found = curve.on_from(start, 0.7);
                assert!((found - y).abs() < 2e-4 * y, "{exponent} {start}: {found} {y}");
            }
        }
    }

    #[test]
    fn a_ramp_has_one_speed_or_two() {
        let times: Vec<f64> = (0..60).map(|i| 0.05 * f64::from(i)).collect();
        let two = |t: f64| if t < 1.23 { 2.0 * t } else { 2.46 + 8.0 * (t - 1.23) };
        let ripple = |t: f64| 1e-3 * (37.0 * t).sin();
        let places = |of: &dyn Fn(f64) -> f64| times.iter().map(|t| of(*t) + ripple(*t)).collect::<Vec<f64>>();
        let found = Speeds::of(&times, &places(&two)).unwrap();
        let (first, corner) = found.earlier.unwrap();
        assert!(
            (found.last - 8.0).abs() < 0.01 && (first - 2.0).abs() < 0.01 && (corner - 2.46).abs() < 0.02,
            "{found:?}"
        );
        let one = Speeds::of(&times, &places(&|t| 3.0 * t)).unwrap();
        assert!(one.earlier.is_none() && (one.last - 3.0).abs() < 0.01, "{one:?}");
        assert_eq!(Speeds::of(&times, &times.iter().map(|t| -t).collect::<Vec<f64>>()), None);
    }
}
