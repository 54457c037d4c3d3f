//! The contact layer through one straight piece of motion.
//!
//! While the contact moves at constant speed the excess strain obeys an autonomous scalar equation,
//!
//! ẋ = g − v sgn(x) |x|ⁿ,  g = u̇₁ (m − 1)/depth.
//!
//! A hold (g = 0) has the closed form (4), (5). A ramp tends to the steady excess x* = sgn(g)(|g|/v)^(1/n); it is
//! integrated by an error-controlled Runge–Kutta method with dense output until it is so near to x* that the rest is a
//! closed form too, so that neither long ramps nor fast layers cost more steps.

use super::Work;
use crate::latency::LatencyLaw;
use crate::ode::{Dop853, Step};

/// Relative distance from the steady state below which the second-order expansion around it is exact to rounding:
/// the third-order term is of relative size (1e-6)² against the distance itself.
const NEAR_STEADY: f64 = 1e-6;

/// Tolerance of ramps, relative to the larger of the start and the steady excess.
const TOLERANCE: f64 = 1e-13;

/// Excess strain x(t) of the contact layer over one straight piece, from t = 0 at its start.
#[derive(Debug)]
pub(crate) enum Element {
    /// The jaw stands still: closed form.
    Hold { law: LatencyLaw, initial: f64 },
    /// The jaw moves: integrated part, then the closed-form approach to the steady excess.
    Ramp {
        steps: Vec<Step<[f64; 1]>>,
        approach: Option<Approach>,
    },
}

/// x = x* (1 + δ) with δ' = −κ δ (1 + c δ): the law expanded to second order around its steady state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Approach {
    from: f64,
    steady: f64,
    deviation: f64,
    rate: f64,
    curvature: f64,
}

impl Element {
    /// Solves one piece of `duration` (s) from excess strain `initial` under drive `drive` = g (1/s).
    pub(crate) fn solve(law: LatencyLaw, initial: f64, drive: f64, duration: f64, work: &mut Work) -> Self {
        if drive == 0.0 {
            work.closed_forms += 1;
            return Self::Hold { law, initial };
        }
        let steady = law.steady_excess(drive);
        // Rate at which a small deviation from the steady state dies: n v |x*|ⁿ⁻¹ = n g/x*.
        let rate = law.exponent() * drive / steady;
        let approach = |from: f64, excess: f64| Approach {
            from,
            steady,
            deviation: excess / steady - 1.0,
            rate,
            curvature: 0.5 * (law.exponent() - 1.0),
        };
        let scale = steady.abs().max(initial.abs());
        let slope = (drive + law.rate(initial)).abs();
        let first = duration.min(0.1 * scale / slope);
        let mut solver = Dop853::new([initial], TOLERANCE * scale, if first > 0.0 { first } else { duration });
        let is_near = |x: f64| (x / steady - 1.0).abs() < NEAR_STEADY;
        let mut steps = Vec::new();
        while !is_near(solver.state()[0]) && solver.time() < duration {
            steps.push(solver.step(duration, |_, &[x]| [drive + law.rate(x)]));
        }
        work.ramps += 1;
        work.steps += solver.steps;
        work.evaluations += solver.evaluations;
        let excess = solver.state()[0];
        Self::Ramp {
            approach: is_near(excess).then(|| approach(solver.time(), excess)),
            steps,
        }
    }

    /// Excess strain a time `elapsed` (s) after the start of the piece.
    pub(crate) fn excess_at(&self, elapsed: f64) -> f64 {
        match self {
            Self::Hold { law, initial } => law.excess_after(*initial, elapsed),
            Self::Ramp { steps, approach } => match approach {
                Some(approach) if elapsed >= approach.from => approach.excess_at(elapsed),
                _ => {
                    let index = steps.partition_point(|step| step.end() < elapsed);
                    steps[index.min(steps.len() - 1)].at(elapsed)[0]
                }
            },
        }
    }

    /// Ends of the integration steps (s from the start of the piece); between two of them the excess is smooth.
    pub(crate) fn step_ends(&self) -> impl Iterator<Item = f64> + '_ {
        let steps = match self {
            Self::Ramp { steps, .. } => steps.as_slice(),
            Self::Hold { .. } => &[],
        };
        steps.iter().map(Step::end)
    }
}

impl Approach {
    fn excess_at(&self, elapsed: f64) -> f64 {
        let decay = (-self.rate * (elapsed - self.from)).exp();
        let deviation = self.deviation * decay / (1.0 + self.curvature * self.deviation * (1.0 - decay));
        self.steady * (1.0 + deviation)
    }
}
