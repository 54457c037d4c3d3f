//! The contact layer through one straight piece of motion.
//!
//! While the contact moves at constant speed the excess strain obeys an autonomous scalar equation,
//!
//! ẋ = g − v sgn(x) |x|ⁿ,  g = u̇₁ (m − 1)/depth.
//!
//! A hold (g = 0) has the closed form (4), (5). A ramp tends to the steady excess x* = sgn(g)(|g|/v)^(1/n). With z = x/x* its equation
//! becomes, in units x*/g of time,
//!
//! ż = 1 − sgn(z)|z|ⁿ.
//!
//! An error-controlled Runge–Kutta method with dense output takes a few dozen steps for it, until the steady state is near, and from there
//! on the law expanded to second order has a closed form, however long the ramp and however fast the layer. For n = 1 and, once z ≥ 0, for
//! n = 2 that is the law itself.
//!
//! In these units all ramps of a law are stretches of one curve on either side of the steady state. A ramp that comes to where an earlier
//! one was goes on along its steps. The first ramp of a contact depends on nothing but the exponent, where it starts and how far it comes:
//! of many contacts with the same exponent, one is integrated on every thread.

use std::cell::RefCell;

use super::SimulationWork;
use crate::latency::{LatencyLaw, signed_power};
use crate::ode::{Dop853, Step};
use crate::vector::elementary::exp_m1;
use crate::vector::{fill, in_place};

/// Distance from the steady state, times n, below which the law expanded to second order is exact to rounding: what the
/// expansion leaves out is of third order.
const NEAR: f64 = 3e-4;

/// Tolerance of a step, relative to what the excess passes through.
const TOLERANCE: f64 = 1e-13;

/// Whether a power that is not smooth at rest, x = 0, is met or near on the way from z: any but whole exponents, and even ones where the way
/// goes through.
#[inline(always)]
fn is_kinked(exponent: f64, z: f64) -> bool {
    let is_odd = exponent % 2.0 == 1.0;
    let is_even = exponent % 2.0 == 0.0;
    !(is_odd || (is_even && z >= 0.0))
}

/// |z| below which the power moves nothing that matters: what a step through rest may pass over.
#[inline(always)]
fn rest_of(exponent: f64, reach: f64) -> f64 {
    (TOLERANCE * reach).powf(1.0 / (exponent + 1.0))
}

/// The longest step from z with ż = `speed` there, in units of x*/g, where rest is met: steps shrink towards it and grow away from it, so
/// that each sees a smooth power. After a long way to rest a step is still one to a clock that has come as far as `time`.
#[inline(always)]
fn longest_step(z: f64, speed: f64, rest: f64, time: f64) -> f64 {
    let longest = match z {
        _ if z > 0.5 => f64::INFINITY,
        _ if z >= 0.0 => z.max(rest),
        _ if z >= -2.0 * rest => rest - z,
        // |z|/|ż|, a lower bound of the time to rest.
        _ => 0.4 * -z / speed,
    };
    longest.max(8.0 * f64::EPSILON * time)
}

/// Excess strain x(t) of the contact layer over one straight piece, from t = 0 at its start.
#[derive(Debug)]
pub(crate) enum Element {
    /// The jaw is at rest: closed form.
    Hold { law: LatencyLaw, initial: f64 },
    /// The jaw moves.
    Ramp(Ramp),
}

/// The way to the steady excess.
#[derive(Debug)]
pub(crate) struct Ramp {
    /// x*.
    steady: f64,
    /// g/x*, 1/s: what turns time into that of the steps and of the approach.
    rate: f64,
    /// Length of the piece, in that time.
    until: f64,
    /// z over time, until the steady state is near or the piece ends.
    steps: Vec<Step>,
    /// What follows.
    approach: Approach,
}

/// The last stretch: z = 1 + δ with δ' = −n δ (1 + c δ), the law to second order around its steady state.
#[derive(Debug, Clone, Copy)]
struct Approach {
    /// Time at its start.
    from: f64,
    /// z then.
    excess: f64,
    exponent: f64,
    /// c = (n − 1)/2.
    curvature: f64,
}

impl Approach {
    /// δ(t) = δ₀ e/(1 + c δ₀ E) and z(t) = z₀ − δ₀ (1 + c δ₀) E/(1 + c δ₀ E) with e = e^(−nt) and E = 1 − e: the first loses nothing of a large
    /// deviation that fades, the second nothing of a small z that grows.
    #[inline(always)]
    fn excess_at(&self, time: f64) -> f64 {
        let deviation = self.excess - 1.0;
        let bend = self.curvature * deviation;
        let change = exp_m1(-self.exponent * (time - self.from));
        let slower = 1.0 - bend * change;
        if self.excess.abs() < 0.5 {
            self.excess + deviation * (1.0 + bend) * change / slower
        } else {
            1.0 + deviation * (1.0 + change) / slower
        }
    }

    /// Times that cut it, as far as it is not steady yet, into parts of half a time constant.
    fn parts(&self) -> impl Iterator<Item = f64> + use<> {
        let (from, width) = (self.from, 0.5 / self.exponent);
        let count = (2.0 * ((self.excess - 1.0).abs() * self.exponent / NEAR).ln()).max(0.0) as u32;
        (1..=count).map(move |part| from + width * f64::from(part))
    }
}

/// The way of an earlier ramp of the same law to its steady state.
#[derive(Debug, Default)]
pub(crate) struct Ramps {
    /// Sign of 1 − z.
    side: f64,
    reach: f64,
    steps: Vec<Step>,
    /// z at the ends of the steps.
    ends: Vec<f64>,
}

impl Ramps {
    /// Whether the curve passes z on this side, to the accuracy that a ramp of this reach needs.
    fn serves(&self, side: f64, reach: f64, z: f64) -> bool {
        let passed =
            || self.side * (z - self.steps[0].from) >= 0.0 && self.side * (self.ends[self.ends.len() - 1] - z) > 0.0;
        !self.steps.is_empty() && self.side == side && self.reach <= reach && passed()
    }

    /// Appends the steps from where the curve is at z, moved to `time`, as far as `until`; speed is ż there. Returns time and z at the end of
    /// the curve.
    fn follow(&self, z: f64, speed: f64, time: f64, until: f64, steps: &mut Vec<Step>) -> (f64, f64) {
        let index = self.ends.partition_point(|end| self.side * (z - end) >= 0.0);
        let step = &self.steps[index];
        // Newton's method; the slope is that of the goal, which is near.
        let mut at = step.end() - (self.ends[index] - z) / speed;
        for _ in 0..12 {
            let off = (z - step.at(at)) / speed;
            at = (at + off).min(step.end());
            if off.abs() <= f64::EPSILON * at.abs().max(1e-3) {
                break;
            }
        }
        let moved = time - at;
        let rest = self.steps[index..].iter().map(|step| step.later(moved));
        steps.extend(rest.take_while(|step| step.start < until));
        let last = self.steps.len() - 1;
        (self.steps[last].end() + moved, self.ends[last])
    }
}

/// A way to near the steady state that no end of a piece cut short, with what it depends on and what it cost.
#[derive(Debug, Clone)]
struct Way {
    /// Exponent, z at its start and reach, to the last bit.
    requested: [u64; 3],
    steps: Vec<Step>,
    /// Time and z at its end.
    end: (f64, f64),
    /// The latest time that a step looked at, rejected ones among them: a piece that lasts longer has the same steps.
    latest: f64,
    taken: u64,
    evaluations: u64,
}

thread_local! {
    static LAST_WAY: RefCell<Option<Way>> = const { RefCell::new(None) };
}

impl Way {
    /// The way that this thread followed last, if a piece that lasts `until` has the same to the last bit.
    fn followed(requested: [u64; 3], until: f64) -> Option<Self> {
        let is_same = |way: &&Self| way.requested == requested && way.latest < until * (1.0 - 1e-9);
        LAST_WAY.with_borrow(|last| last.as_ref().filter(is_same).cloned())
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
        work: &mut SimulationWork,
    ) -> Self {
        if drive == 0.0 {
            work.closed_forms += 1;
            return Self::Hold { law, initial };
        }
        work.ramps += 1;
        let steady = law.steady_excess(drive);
        let n = law.exponent();
        let start = initial / steady;
        let side = if start > 1.0 { -1.0 } else { 1.0 };
        let rate = drive / steady;
        let speed = |z: f64| 1.0 - signed_power(z, n);
        let until = rate * duration;
        // What the piece passes through, in units of x*: errors are measured by it.
        let reach = start.abs().max(until).min(1.0);
        let near = if n == 1.0 { f64::INFINITY } else { NEAR / n.max(1.0) };
        // What is not a number is near: nothing is left to follow.
        let is_far = |z: f64| (1.0 - z).abs() > near && !(n == 2.0 && z >= 0.0);
        let (is_first, requested) = (ramps.steps.is_empty(), [n, start, reach].map(f64::to_bits));
        let followed = is_first.then(|| Way::followed(requested, until)).flatten();
        let is_new = followed.is_none();
        let way = followed.unwrap_or_else(|| {
            let first = until.min(0.5 * ((1.0 - start) / speed(start)));
            let mut solver = Dop853::new(start, TOLERANCE * reach, if first > 0.0 { first } else { until });
            let (passes_rest, rest) = (side > 0.0 && is_kinked(n, start), rest_of(n, reach));
            let mut steps = Vec::with_capacity(32);
            let mut end = (0.0, start);
            while end.0 < until && is_far(end.1) {
                let (time, z) = end;
                if ramps.serves(side, reach, z) {
                    end = ramps.follow(z, speed(z), time, until, &mut steps);
                    break;
                }
                solver.tolerance = TOLERANCE * reach * (1.0 - z).abs().max(1.0);
                let longest = if passes_rest { longest_step(z, speed(z), rest, time) } else { f64::INFINITY };
                steps.push(solver.step(until.min(time + longest), |_, z| speed(z)));
                end = (solver.time, solver.state);
            }
            Way {
                requested,
                steps,
                end,
                latest: solver.latest,
                taken: solver.steps,
                evaluations: solver.evaluations,
            }
        });
        work.steps += way.taken;
        work.evaluations += way.evaluations;
        let is_valid = way.taken > 0 && !is_far(way.end.1);
        if is_first && is_new && is_valid && way.latest < until {
            LAST_WAY.set(Some(way.clone()));
        }
        let (steps, end) = (way.steps, way.end);
        let is_longer = is_first || ramps.side != side || side * (ramps.steps[0].from - start) > 0.0;
        if is_valid && end.0 <= until && (is_longer || reach < ramps.reach) {
            *ramps = Ramps {
                side,
                reach,
                ends: steps.iter().map(|step| step.at(step.end())).collect(),
                steps: steps.clone(),
            };
        }
        let approach = Approach {
            from: end.0,
            excess: end.1,
            exponent: n,
            curvature: 0.5 * (n - 1.0),
        };
        Self::Ramp(Ramp {
            steady,
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
        let ramp = match self {
            Self::Ramp(ramp) => Some(ramp),
            Self::Hold { .. } => None,
        };
        ramp.into_iter().flat_map(|ramp| {
            let ends = ramp.steps.iter().map(Step::end).chain(ramp.approach.parts());
            ends.take_while(|end| *end < ramp.until).map(|end| end / ramp.rate)
        })
    }
}

impl Ramp {
    fn excess_at(&self, elapsed: f64) -> f64 {
        let time = self.rate * elapsed;
        let index = self.steps.partition_point(|step| step.end() < time);
        self.steady * self.steps.get(index).map_or_else(|| self.approach.excess_at(time), |step| step.at(time))
    }

    /// Replaces rising times by the excess strains then: the same numbers.
    fn replace_by_excess(&self, times: &mut [f64]) {
        let (rate, steady) = (self.rate, self.steady);
        let (mut steps, mut done) = (self.steps.iter().peekable(), 0);
        for slot in times.iter_mut() {
            let time = rate * *slot;
            while steps.next_if(|step| step.end() < time).is_some() {}
            let Some(step) = steps.peek() else { break };
            *slot = steady * step.at(time);
            done += 1;
        }
        let rest = &mut times[done..];
        in_place(rest, |elapsed, out| {
            fill(
                elapsed,
                [out],
                #[inline(always)]
                |elapsed| [steady * self.approach.excess_at(rate * elapsed)],
            );
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    #[test]
    fn a_ramp_from_rest_follows_the_hyperbolic_tangent_for_n_2() {
        // ẋ = g − v x² from 0: x = √(g/v) tanh(√(g v) t)
        let law = LatencyLaw::new(2.0, 3.0).unwrap();
        let element = Element::solve(law, 0.0, 0.7, 9.0, &mut Ramps::default(), &mut SimulationWork::default());
        for i in 0..=90 {
            let t = 0.1 * f64::from(i);
            let exact = (0.7f64 / 3.0).sqrt() * ((0.7f64 * 3.0).sqrt() * t).tanh();
            let error = (element.excess_at(t) - exact).abs();
            assert!(error < 5e-12, "t = {t}: {error:e}");
        }
    }

    /// Steps shrink towards rest, where a power below 1 is not smooth; once they were shorter than a tick of their clock, for ever.
    #[test]
    fn a_slow_drive_after_a_far_larger_excess_comes_to_its_steady_state() {
        let law = LatencyLaw::new(0.2, 1.4e-3).unwrap();
        let mut work = SimulationWork::default();
        let element = Element::solve(law, -9.55e-3, 1.48e-6, 24.6, &mut Ramps::default(), &mut work);
        let end = element.excess_at(24.6);
        assert!(
            (end / law.steady_excess(1.48e-6) - 1.0).abs() < 1e-6 && work.steps < 2000,
            "{end:e}, {} steps",
            work.steps
        );
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
        let mut noise = Rng::new(5);
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
            let element = Element::solve(law, start, 1.0, until, &mut Ramps::default(), &mut SimulationWork::default());
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
            let (mut ramps, mut work) = (Ramps::default(), SimulationWork::default());
            Element::solve(law, 0.0, 0.8, 9.0, &mut ramps, &mut work);
            // From further away, from a place on the curve, and from beyond the steady state, where there is none yet.
            let steady = law.steady_excess(0.8);
            for (part, drive) in [(-0.3, 0.8f64), (0.1, 1.3), (0.6, -0.4)] {
                let initial = part * steady * drive.signum();
                let before = work.steps;
                let element = Element::solve(law, initial, drive, 9.0, &mut ramps, &mut work);
                let mut own = SimulationWork::default();
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

    /// What a thread knows of other contacts saves it work and changes no bit, whether a piece ends before or behind what it knows.
    #[test]
    fn the_way_of_another_contact_is_that_of_this_one_to_the_last_bit() {
        let solved = |law: LatencyLaw, drive: f64, duration: f64| {
            let mut work = SimulationWork::default();
            let element = Element::solve(law, 0.0, drive, duration, &mut Ramps::default(), &mut work);
            let excess = [0.1, 0.5, 0.9, 1.0].map(|part| element.excess_at(part * duration).to_bits());
            (excess, work)
        };
        for n in [0.7, 1.0, 2.0, 2.5, 5.0, 7.3] {
            let reference = LatencyLaw::new(n, 2e4).unwrap();
            solved(reference, 0.5, 1e3);
            let pace = 0.5 / reference.steady_excess(0.5);
            let known = |until| Way::followed([n, 0.0, 1.0].map(f64::to_bits), until).is_some();
            assert_eq!(known(1e3 * pace), n != 1.0 && n != 2.0, "n = {n}");
            for i in 1..=60 {
                let law = LatencyLaw::new(n, 1e3 * f64::from(1 + i % 7)).unwrap();
                let drive = if i % 3 == 0 { -0.2 } else { 0.9 };
                // From a tenth of the way to the steady state to far behind it.
                let until = 0.1 * 1.15f64.powi(i);
                let duration = until * (law.steady_excess(drive) / drive);
                let alone = std::thread::spawn(move || solved(law, drive, duration)).join().unwrap();
                assert_eq!(solved(law, drive, duration), alone, "n = {n}, as far as {until}");
                solved(reference, 0.5, 1e3);
            }
        }
    }

    #[test]
    fn long_and_fast_ramps_cost_no_more_steps() {
        for (v, duration) in [(2e4, 0.6), (2e4, 6e5), (2e14, 6e5)] {
            let law = LatencyLaw::new(5.0, v).unwrap();
            let mut work = SimulationWork::default();
            let element = Element::solve(law, 0.0, 0.83, duration, &mut Ramps::default(), &mut work);
            assert!(work.steps < 60, "{work:?}");
            assert!(element.excess_at(duration) > 0.999 * law.steady_excess(0.83));
        }
    }
}
