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

use super::Work;
use crate::latency::LatencyLaw;
use crate::ode::{Dop853, Step};

/// Distance from the steady state, times n, below which the law expanded to second order is exact to rounding: what the
/// expansion leaves out is of third order.
const NEAR: f64 = 3e-4;

/// Tolerance of a step, relative to what the excess passes through.
const TOLERANCE: f64 = 1e-12;

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
    /// y over time, until the steady state is near or the piece ends.
    steps: Vec<Step<[f64; 1]>>,
    /// What follows.
    approach: Approach,
}

/// The last stretch: x = x* (1 + δ) with δ' = −κ δ (1 + c δ), the law to second order around its steady state.
#[derive(Debug, Clone, Copy)]
struct Approach {
    from: f64,
    deviation: f64,
    rate: f64,
    curvature: f64,
}

impl Approach {
    /// δ(t) = δ₀ e^(−κt)/(1 + c δ₀ (1 − e^(−κt))).
    fn deviation_at(&self, time: f64) -> f64 {
        let decay = (-self.rate * (time - self.from)).exp();
        self.deviation * decay / (1.0 + self.curvature * self.deviation * (1.0 - decay))
    }
}

impl Element {
    /// Solves one piece of `duration` (s) from excess strain `initial` under drive `drive` = g (1/s).
    pub(crate) fn solve(law: LatencyLaw, initial: f64, drive: f64, duration: f64, work: &mut Work) -> Self {
        if drive == 0.0 {
            work.closed_forms += 1;
            return Self::Hold { law, initial };
        }
        work.ramps += 1;
        let steady = law.steady_excess(drive);
        let z = initial / steady;
        let side = if z == 1.0 { 0.0 } else { (1.0 - z).signum() };
        let rate = drive / steady;
        let slope = |y: f64| rate * attraction(side * (-y).exp(), law.exponent());
        // z may be far below 1, where 1 − z would lose it.
        let start = if side > 0.0 { -(-z).ln_1p() } else { -(z - 1.0).ln() };
        // What the piece passes through, in units of x*: errors are measured by it.
        let reach = z.abs().max(rate * duration).min(1.0);
        let first = duration.min(0.5 / slope(start));
        let mut solver = Dop853::new([start], TOLERANCE, if first > 0.0 { first } else { duration });
        let far = (law.exponent().max(1.0) / NEAR).ln();
        let mut steps = Vec::with_capacity(32);
        while side != 0.0 && solver.time() < duration && solver.state()[0] < far {
            // An error of y matters as far as it moves x = x* (1 ∓ e^(−y)).
            let [y] = *solver.state();
            solver.set_tolerance(TOLERANCE * reach * y.exp().clamp(1.0, 1e9));
            steps.push(solver.step(duration, |_, &[y]| [slope(y)]));
        }
        work.steps += solver.steps;
        work.evaluations += solver.evaluations;
        let approach = Approach {
            from: solver.time(),
            deviation: -side * (-solver.state()[0]).exp(),
            rate: law.exponent() * rate,
            curvature: 0.5 * (law.exponent() - 1.0),
        };
        Self::Ramp(Ramp {
            steady,
            side,
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
            Self::Ramp(ramp) => out.extend(elapsed.map(|elapsed| ramp.excess_at(elapsed))),
        }
    }

    /// Ends of the integration steps (s from the start of the piece); between two of them the excess is smooth.
    pub(crate) fn step_ends(&self) -> impl Iterator<Item = f64> + '_ {
        let steps = match self {
            Self::Ramp(ramp) => ramp.steps.as_slice(),
            Self::Hold { .. } => &[],
        };
        steps.iter().map(Step::end)
    }
}

impl Ramp {
    /// x = x* (1 ∓ e^(−y)), without cancellation where x is far below x*.
    fn excess(&self, y: f64) -> f64 {
        if self.side > 0.0 {
            -self.steady * (-y).exp_m1()
        } else {
            self.steady * (1.0 - self.side * (-y).exp())
        }
    }

    fn excess_at(&self, elapsed: f64) -> f64 {
        let index = self.steps.partition_point(|step| step.end() < elapsed);
        match self.steps.get(index) {
            Some(step) => {
                let [y] = step.at(elapsed);
                self.excess(y)
            }
            None => self.steady * (1.0 + self.approach.deviation_at(elapsed)),
        }
    }
}

/// q = (1 − sgn(z)|z|ⁿ)/(1 − z) from `distance` = 1 − z ≠ 0; positive, and n at z = 1.
fn attraction(distance: f64, n: f64) -> f64 {
    let z = 1.0 - distance;
    // Whole odd n: the geometric sum, without a power and without cancellation.
    match n {
        1.0 => 1.0,
        3.0 => 1.0 + z * (1.0 + z),
        5.0 => 1.0 + z * (1.0 + z * (1.0 + z * (1.0 + z))),
        _ if z > 0.0 => -(n * (-distance).ln_1p()).exp_m1() / distance,
        _ => (1.0 + (-z).powf(n)) / distance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_from_rest_follows_the_hyperbolic_tangent_for_n_2() {
        // ẋ = g − v x² from 0: x = √(g/v) tanh(√(g v) t)
        let law = LatencyLaw::new(2.0, 3.0).unwrap();
        let element = Element::solve(law, 0.0, 0.7, 9.0, &mut Work::default());
        for i in 0..=90 {
            let t = 0.1 * f64::from(i);
            let exact = (0.7f64 / 3.0).sqrt() * ((0.7f64 * 3.0).sqrt() * t).tanh();
            let error = (element.excess_at(t) - exact).abs();
            assert!(error < 5e-12, "t = {t}: {error:e}");
        }
    }

    #[test]
    fn long_and_fast_ramps_cost_no_more_steps() {
        for (v, duration) in [(2e4, 0.6), (2e4, 6e5), (2e14, 6e5)] {
            let law = LatencyLaw::new(5.0, v).unwrap();
            let mut work = Work::default();
            let element = Element::solve(law, 0.0, 0.83, duration, &mut work);
            assert!(work.steps < 60, "{work:?}");
            assert!(element.excess_at(duration) > 0.999 * law.steady_excess(0.83));
        }
    }
}
