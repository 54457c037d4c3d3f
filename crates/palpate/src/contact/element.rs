//! The contact layer through one straight piece of motion.
//!
//! While the contact moves at constant speed the excess strain obeys an autonomous scalar equation,
//!
//! ẋ = g − v sgn(x) |x|ⁿ,  g = u̇₁ (m − 1)/depth.
//!
//! A hold (g = 0) has the closed form (4), (5). A ramp tends to the steady excess x* = sgn(g)(|g|/v)^(1/n). With z = x/x*
//! and y = −ln|1 − z| its equation becomes
//!
//! ẏ = (g/x*) q(z),  q(z) = (1 − sgn(z)|z|ⁿ)/(1 − z),
//!
//! which is smooth, turns into a straight line of slope n g/x* as the steady state is neared, and keeps 1 − z to full
//! relative accuracy on the way. An error-controlled Runge–Kutta method with dense output takes a few dozen steps
//! for it, however long the ramp and however fast the layer.
//!
//! In units of x*/g time is the same for every ramp of a law: all of them are stretches of one curve on either side of the steady
//! state. A ramp that comes to where an earlier one was goes on along its steps.

use super::Work;
use crate::latency::LatencyLaw;
use crate::ode::{Dop853, Step};
use crate::vector::elementary::{exp, exp_m1};
use crate::vector::replace;

/// Distance from the steady state, times n, below which the law expanded to second order is exact to rounding: what the
/// expansion leaves out is of third order.
const NEAR: f64 = 3e-4;

/// Tolerance of a step, relative to what the excess passes through.
const TOLERANCE: f64 = 1e-13;

/// Whether a power that is not smooth at rest, x = 0, is met or near on the way from z: any but whole exponents, and even ones where the way
/// goes through.
#[inline(always)]
pub(crate) fn is_kinked(exponent: f64, z: f64) -> bool {
    let is_odd = exponent % 2.0 == 1.0;
    let is_even = exponent % 2.0 == 0.0;
    !(is_odd || (is_even && z >= 0.0))
}

/// |z| below which the power moves nothing that matters: what a step through rest may pass over.
#[inline(always)]
pub(crate) fn rest_of(exponent: f64, reach: f64) -> f64 {
    (TOLERANCE * reach).powf(1.0 / (exponent + 1.0))
}

/// The longest step from z with ẏ = `slope` there, in units of x*/g, where rest is met: steps shrink towards it and grow away from it, so
/// that each sees a smooth power.
#[inline(always)]
pub(crate) fn longest_step(z: f64, slope: f64, rest: f64) -> f64 {
    match z {
        _ if z > 0.5 => f64::INFINITY,
        _ if z >= 0.0 => z.max(rest),
        _ if z >= -2.0 * rest => rest - z,
        // |z|/|ż|, a lower bound of the time to rest.
        _ => 0.4 * -z / ((1.0 - z) * slope),
    }
}

/// Excess strain x(t) of the contact layer over one straight piece, from t = 0 at its start.
#[derive(Debug)]
pub(crate) enum Element {
    /// The jaw stands still: closed form.
    Hold { law: LatencyLaw, initial: f64 },
    /// The jaw moves.
    Ramp(Ramp),
}

/// The way to the steady excess.
#[derive(Debug)]
pub(crate) struct Ramp {
    /// x*.
    steady: f64,
    /// Sign of 1 − z; zero if the ramp begins at its steady state.
    side: f64,
    /// g/x*, 1/s: what turns time into that of the steps and of the approach.
    rate: f64,
    /// Length of the piece, in that time.
    until: f64,
    /// y over time, until the steady state is near or the piece ends.
    steps: Vec<Step<[f64; 1]>>,
    /// What follows.
    approach: Approach,
}

/// The last stretch: x = x* (1 + δ) with δ' = −n δ (1 + c δ), the law to second order around its steady state.
#[derive(Debug, Clone, Copy)]
struct Approach {
    from: f64,
    deviation: f64,
    exponent: f64,
    curvature: f64,
}

impl Approach {
    /// δ(t) = δ₀ e^(−nt)/(1 + c δ₀ (1 − e^(−nt))).
    #[inline(always)]
    fn deviation_at(&self, time: f64) -> f64 {
        let decay = exp(-self.exponent * (time - self.from));
        self.deviation * decay / (1.0 + self.curvature * self.deviation * (1.0 - decay))
    }
}

/// The way of an earlier ramp of the same law to its steady state.
#[derive(Debug, Default)]
pub(crate) struct Ramps {
    side: f64,
    reach: f64,
    steps: Vec<Step<[f64; 1]>>,
    /// y at the ends of the steps, rising.
    ends: Vec<f64>,
}

impl Ramps {
    /// Whether the curve passes y on this side, to the accuracy that a ramp of this reach needs.
    fn serves(&self, side: f64, reach: f64, y: f64) -> bool {
        let passed = || self.steps[0].from()[0] <= y && y < self.ends[self.ends.len() - 1];
        !self.steps.is_empty() && self.side == side && self.reach <= reach && passed()
    }

    /// Appends the steps from where the curve is at y, moved to `time`, as far as `until`; slope is ẏ there. Returns time and y at the end of
    /// the curve.
    fn follow(&self, y: f64, slope: f64, time: f64, until: f64, steps: &mut Vec<Step<[f64; 1]>>) -> (f64, f64) {
        let index = self.ends.partition_point(|end| *end <= y);
        let step = &self.steps[index];
        // Newton's method; the slope is that of the goal, which is near.
        let mut at = step.end() - (self.ends[index] - y) / slope;
        for _ in 0..12 {
            let off = (y - step.at(at)[0]) / slope;
            at = (at + off).min(step.end());
            if off.abs() <= f64::EPSILON * at.abs().max(1e-3) {
                break;
            }
        }
        let moved = time - at;
        let rest = self.steps[index..].iter().map(|step| step.later(moved));
        steps.extend(rest.take_while(|step| step.start() < until));
        let last = self.steps.len() - 1;
        (self.steps[last].end() + moved, self.ends[last])
    }
}

impl Element {
    /// Solves one piece of `duration` (s) from excess strain `initial` under drive `drive` = g (1/s).
    pub(crate) fn solve(
        law: LatencyLaw,
        initial: f64,
        drive: f64,
        duration: f64,
        ramps: &mut Ramps,
        work: &mut Work,
    ) -> Self {
        if drive == 0.0 {
            work.closed_forms += 1;
            return Self::Hold { law, initial };
        }
        work.ramps += 1;
        let steady = law.steady_excess(drive);
        let z = initial / steady;
        let side = if z == 1.0 { 0.0 } else { (1.0 - z).signum() };
        let rate = drive / steady;
        let is_whole = law.exponent().fract() == 0.0;
        let slope = |y: f64| {
            let distance = side * exp(-y);
            // Powers that are not whole tell z far below 1 from 0.
            let z = if is_whole || side < 0.0 { 1.0 - distance } else { -exp_m1(-y) };
            attraction(z, distance, law.exponent())
        };
        // z may be far below 1, where 1 − z would lose it.
        let start = if side > 0.0 { -(-z).ln_1p() } else { -(z - 1.0).ln() };
        let until = rate * duration;
        // What the piece passes through, in units of x*: errors are measured by it.
        let reach = z.abs().max(until).min(1.0);
        let first = until.min(0.5 / slope(start));
        let mut solver = Dop853::new([start], TOLERANCE * reach, if first > 0.0 { first } else { until });
        let far = (law.exponent().max(1.0) / NEAR).ln();
        let (passes_rest, rest) = (side > 0.0 && is_kinked(law.exponent(), z), rest_of(law.exponent(), reach));
        let mut steps = Vec::with_capacity(32);
        let mut end = (0.0, start);
        while side != 0.0 && end.0 < until && end.1 < far {
            let (time, y) = end;
            if ramps.serves(side, reach, y) {
                end = ramps.follow(y, slope(y), time, until, &mut steps);
                break;
            }
            // An error of y matters as far as it moves x = x* (1 ∓ e^(−y)).
            solver.set_tolerance(TOLERANCE * reach * y.exp().clamp(1.0, 1e9));
            let longest = if passes_rest { longest_step(-exp_m1(-y), slope(y), rest) } else { f64::INFINITY };
            steps.push(solver.step(until.min(time + longest), |_, &[y]| [slope(y)]));
            end = (solver.time(), solver.state()[0]);
        }
        work.steps += solver.steps;
        work.evaluations += solver.evaluations;
        let is_longer = ramps.steps.is_empty() || ramps.side != side || start < ramps.steps[0].from()[0];
        if solver.steps > 0 && end.1 >= far && end.0 <= until && (is_longer || reach < ramps.reach) {
            *ramps = Ramps {
                side,
                reach,
                ends: steps.iter().map(|step| step.at(step.end())[0]).collect(),
                steps: steps.clone(),
            };
        }
        let approach = Approach {
            from: end.0,
            deviation: -side * (-end.1).exp(),
            exponent: law.exponent(),
            curvature: 0.5 * (law.exponent() - 1.0),
        };
        Self::Ramp(Ramp {
            steady,
            side,
            rate,
            until,
            steps,
            approach,
        })
    }

    /// Excess strain a time `elapsed` (s) after the start of the piece.
    pub(crate) fn excess_at(&self, elapsed: f64) -> f64 {
        match self {
            Self::Hold { law, initial } => law.excess_after(*initial, elapsed),
            Self::Ramp(ramp) => ramp.excess_at(elapsed),
        }
    }

    /// Appends the excess strain at every one of `times`, which lie in the piece that began at `start`.
    pub(crate) fn extend_excess(&self, start: f64, times: &[f64], out: &mut Vec<f64>) {
        let elapsed = times.iter().map(|time| time - start);
        match self {
            Self::Hold { law, initial } => {
                let from = out.len();
                out.extend(elapsed);
                law.relax(*initial, &mut out[from..]);
            }
            Self::Ramp(ramp) => {
                let from = out.len();
                out.extend(elapsed);
                ramp.replace_by_excess(&mut out[from..]);
            }
        }
    }

    /// Ends of the integration steps inside the piece (s from its start); between two of them the excess is smooth. The last step may
    /// be that of an earlier ramp and reach beyond the piece.
    pub(crate) fn step_ends(&self) -> impl Iterator<Item = f64> + '_ {
        let (steps, rate, until) = match self {
            Self::Ramp(ramp) => (ramp.steps.as_slice(), ramp.rate, ramp.until),
            Self::Hold { .. } => (&[] as &[_], 1.0, 0.0),
        };
        steps.iter().map(Step::end).take_while(move |end| *end < until).map(move |end| end / rate)
    }
}

impl Ramp {
    /// x = x* (1 ∓ e^(−y)), without cancellation where x is far below x*.
    #[inline(always)]
    fn excess(&self, y: f64) -> f64 {
        if self.side > 0.0 { -self.steady * exp_m1(-y) } else { self.steady * (1.0 - self.side * exp(-y)) }
    }

    fn excess_at(&self, elapsed: f64) -> f64 {
        let time = self.rate * elapsed;
        let index = self.steps.partition_point(|step| step.end() < time);
        match self.steps.get(index) {
            Some(step) => {
                let [y] = step.at(time);
                self.excess(y)
            }
            None => self.steady * (1.0 + self.approach.deviation_at(time)),
        }
    }

    /// Replaces rising times by the excess strains then: the same numbers, a step at a time.
    fn replace_by_excess(&self, times: &mut [f64]) {
        let rate = self.rate;
        let mut rest = times;
        for step in &self.steps {
            let count = rest.partition_point(|elapsed| rate * elapsed <= step.end());
            let (inside, after) = rest.split_at_mut(count);
            replace(
                inside,
                #[inline(always)]
                |elapsed| self.excess(step.at(rate * elapsed)[0]),
            );
            rest = after;
        }
        replace(
            rest,
            #[inline(always)]
            |elapsed| self.steady * (1.0 + self.approach.deviation_at(rate * elapsed)),
        );
    }
}

/// q = (1 − sgn(z)|z|ⁿ)/(1 − z) from z and `distance` = 1 − z ≠ 0, of which one may be far smaller than the other can tell; positive, and n at
/// z = 1.
fn attraction(z: f64, distance: f64, n: f64) -> f64 {
    // Whole odd n: the geometric sum, without a power and without cancellation.
    match n {
        1.0 => 1.0,
        3.0 => 1.0 + z * (1.0 + z),
        5.0 => 1.0 + z * (1.0 + z * (1.0 + z * (1.0 + z))),
        _ if z > 0.5 => -(n * (-distance).ln_1p()).exp_m1() / distance,
        _ if z > 0.0 => (1.0 - z.powf(n)) / distance,
        _ => (1.0 + (-z).powf(n)) / distance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Noise;

    #[test]
    fn a_ramp_from_rest_follows_the_hyperbolic_tangent_for_n_2() {
        // ẋ = g − v x² from 0: x = √(g/v) tanh(√(g v) t)
        let law = LatencyLaw::new(2.0, 3.0).unwrap();
        let element = Element::solve(law, 0.0, 0.7, 9.0, &mut Ramps::default(), &mut Work::default());
        for i in 0..=90 {
            let t = 0.1 * f64::from(i);
            let exact = (0.7f64 / 3.0).sqrt() * ((0.7f64 * 3.0).sqrt() * t).tanh();
            let error = (element.excess_at(t) - exact).abs();
            assert!(error < 5e-12, "t = {t}: {error:e}");
        }
    }

    /// Time from rest to z in units of x*/g, for |z| < 1: the implicit closed form ∫ dz/(1 − sgn(z)|z|ⁿ).
    fn time_to(z: f64, n: f64) -> f64 {
        let (mut sum, mut k) = (0.0, 0.0);
        loop {
            let sign = if z < 0.0 && k % 2.0 == 1.0 { -1.0 } else { 1.0 };
            let term = sign * z.signum() * z.abs().powf(k * n + 1.0) / (k * n + 1.0);
            sum += term;
            if term.abs() < 1e-18 {
                return sum;
            }
            k += 1.0;
        }
    }

    #[test]
    fn ramps_from_and_through_rest_keep_their_time_for_any_exponent() {
        let mut noise = Noise::new(5);
        let mut worst: (f64, String) = (0.0, String::new());
        for i in 0..20_000 {
            let n = if i % 10 == 0 { f64::from(1 + i / 10 % 7) } else { 0.5 + 7.5 * noise.uniform() };
            let start = match i % 4 {
                0 => 0.0,
                1 => 0.9 * 1e-6f64.powf(noise.uniform()),
                _ => -0.9 * noise.uniform(),
            };
            let until = 0.01f64.powf(noise.uniform());
            let law = LatencyLaw::new(n, 1.0).unwrap();
            let element = Element::solve(law, start, 1.0, until, &mut Ramps::default(), &mut Work::default());
            for part in [0.1, 0.45, 1.0] {
                let z = element.excess_at(part * until);
                let off = time_to(z, n) - time_to(start, n) - part * until;
                if off.abs() > worst.0 {
                    worst = (off.abs(), format!("n = {n}, from {start} for {until}, at {part}: {off:e}"));
                }
            }
        }
        println!("{}", worst.1);
        assert!(worst.0 < 1e-10, "{}", worst.1);
    }

    #[test]
    fn a_ramp_goes_on_along_an_earlier_one() {
        for (n, v) in [(5.0, 2e4), (3.7, 800.0), (2.0, 5e3), (0.7, 9.0)] {
            let law = LatencyLaw::new(n, v).unwrap();
            let (mut ramps, mut work) = (Ramps::default(), Work::default());
            Element::solve(law, 0.0, 0.8, 9.0, &mut ramps, &mut work);
            // From further away, from a place on the curve, and from beyond the steady state, where there is none yet.
            let steady = law.steady_excess(0.8);
            for (part, drive) in [(-0.3, 0.8f64), (0.1, 1.3), (0.6, -0.4)] {
                let initial = part * steady * drive.signum();
                let before = work.steps;
                let element = Element::solve(law, initial, drive, 9.0, &mut ramps, &mut work);
                let mut own = Work::default();
                let alone = Element::solve(law, initial, drive, 9.0, &mut Ramps::default(), &mut own);
                let (used, on_curve) = (work.steps - before, part == 0.1);
                let most = if on_curve { 0 } else { own.steps };
                assert!(used <= most, "n = {n}, from {part}: {used}, alone {}", own.steps);
                for i in 1..=200 {
                    let t = 0.045 * f64::from(i);
                    let off = (element.excess_at(t) - alone.excess_at(t)).abs();
                    // At x = 0 a power that is not whole has a kink, which costs a step an order or two.
                    assert!(off < 5e-11 * steady, "n = {n}, from {part}, t = {t}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn long_and_fast_ramps_cost_no_more_steps() {
        for (v, duration) in [(2e4, 0.6), (2e4, 6e5), (2e14, 6e5)] {
            let law = LatencyLaw::new(5.0, v).unwrap();
            let mut work = Work::default();
            let element = Element::solve(law, 0.0, 0.83, duration, &mut Ramps::default(), &mut work);
            assert!(work.steps < 60, "{work:?}");
            assert!(element.excess_at(duration) > 0.999 * law.steady_excess(0.83));
        }
    }
}
