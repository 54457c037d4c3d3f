//! The contact layer through one straight piece of a force history.
//!
//! The force fixes the contact displacement u by E ε A(u) = F with ε = (u − u₂)/ℓ, and the node behind the layer follows by
//! u̇₂ = ℓ v sgn(x)|x|ⁿ, x = ε − u/depth. With S = E A the excess strain obeys
//!
//! ẋ = K [Ḟ (m − 1)/(depth Q) − v sgn(x)|x|ⁿ],  Q = S′ε + S/depth,  K = (S′ε depth + S)/(S′ε depth + m S).
//!
//! **While the force is held** (creep, recovery) this is the latency law in a time s of its own, ṡ = K with K between 1/m and 1: x(s) is
//! the closed form (4), (5) however stiff the law, and s is nearly straight, so that a few dozen steps do for any time. Of no force K is
//! 1/m exactly, the recovery of a free surface. A rate coefficient that depends on the state is one more factor of K.
//!
//! **While it changes** u₂ is integrated as it stands: it stays smooth at first touch, where the displacement of a ball begins like √t.

use super::{Layer, Layers, RateDependence, SimulationWork, Specimen, carried_at, share};
use crate::latency::LatencyLaw;
use crate::ode::{Dop853, Step};

/// Tolerance of s, relative to the time it stands for, and of u₂, relative to the depth.
const TOLERANCE: f64 = 1e-13;

/// The body and its law, as a force meets them.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) specimen: Specimen,
    pub(crate) law: LatencyLaw,
    pub(crate) rate: RateDependence,
    pub(crate) layers: Layers,
    pub(crate) bonded: bool,
}

/// State of the contact under a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Carried {
    /// Contact displacement u, m.
    pub(crate) displacement: f64,
    /// Excess strain x.
    pub(crate) excess: f64,
    /// ẋ, 1/s.
    pub(crate) excess_rate: f64,
    /// u̇, m/s.
    pub(crate) speed: f64,
}

/// A force that goes straight from t = 0 on, and ends where it is to end: what rounding leaves of a force of 0 N may be a pull.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ForceLine {
    /// Force at the start and at the end, N.
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// How long it takes, s.
    pub(crate) duration: f64,
}

impl ForceLine {
    /// Force at `elapsed` (s), N.
    pub(crate) fn at(&self, elapsed: f64) -> f64 {
        if elapsed <= 0.0 || self.duration == 0.0 {
            return self.from;
        }
        let part = elapsed / self.duration;
        if part >= 1.0 { self.to } else { self.from + (self.to - self.from) * part }
    }

    /// N/s
    pub(crate) fn slope(&self) -> f64 {
        if self.duration > 0.0 { (self.to - self.from) / self.duration } else { 0.0 }
    }
}

/// One straight piece of a force history, from t = 0 at its start.
#[derive(Debug)]
pub(crate) struct Forced {
    body: Body,
    force: ForceLine,
    path: Path,
}

#[derive(Debug)]
enum Path {
    /// Excess strain at the start, and s over time.
    Held { initial: f64, steps: Vec<Step> },
    /// u₂ over time.
    Changing(Vec<Step>),
}

/// A contact layer under a force that goes straight, a time `elapsed` (s) after the start of the piece.
pub(crate) trait UnderForce {
    /// What the layer has in excess of equilibrium.
    type Excess;
    /// What stands behind the layer and does not jump with the force.
    type Behind;

    /// Force, N.
    fn force_at(&self, elapsed: f64) -> f64;
    /// The contact; NaN where nothing carries the force.
    fn at(&self, elapsed: f64) -> Carried;
    /// Contact displacement, m.
    fn displacement_at(&self, elapsed: f64) -> f64 {
        self.at(elapsed).displacement
    }
    fn excess_at(&self, elapsed: f64) -> Self::Excess;
    fn behind_at(&self, elapsed: f64) -> Self::Behind;
    /// Ends of the integration steps (s from the start of the piece).
    fn step_ends(&self) -> Vec<f64>;
}

/// Why a piece could not be followed to its end, and how long after its start, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stopped {
    /// No displacement carries the force.
    TooMuch { elapsed: f64 },
    /// The law is too fast for an explicit method beside so slow a change.
    TooStiff { elapsed: f64 },
}

/// Steps of a changing force after which it is given up: less than a second.
const MOST_STEPS: usize = 100_000;

impl Body {
    fn thickness(&self) -> f64 {
        self.layers.thickness(self.specimen.depth())
    }

    /// How many times its rate coefficient the law has at an excess strain and a contact displacement (m).
    fn faster(&self, excess: f64, u: f64) -> f64 {
        self.rate.times(excess, self.specimen.equilibrium_strain(u))
    }

    /// The state under `force` (N) with the node behind the layer at `behind` (m).
    fn carry(&self, force: f64, behind: f64) -> Option<(f64, f64)> {
        let thickness = self.thickness();
        let u = carried_at(&self.specimen, Layer::Behind { behind, thickness }, force, self.bonded)?;
        Some((u, (u - behind) / thickness - u / self.specimen.depth()))
    }
}

impl Forced {
    /// Solves one piece of `duration` (s) under a force that goes straight from `from` to `to` (N), the node behind the contact
    /// layer at `behind` (m).
    pub(crate) fn solve(
        body: Body,
        (from, to): (f64, f64),
        behind: f64,
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Self, Stopped> {
        let (_, initial) = body.carry(from, behind).ok_or(Stopped::TooMuch { elapsed: 0.0 })?;
        let force = ForceLine { from, to, duration };
        let path = if force.slope() == 0.0 {
            Self::held(&body, from, initial, duration, work)?
        } else {
            Self::changing(&body, force, behind, work)?
        };
        Ok(Self { body, force, path })
    }

    fn held(body: &Body, force: f64, initial: f64, duration: f64, work: &mut SimulationWork) -> Result<Path, Stopped> {
        let mut steps: Vec<Step> = Vec::new();
        work.closed_forms += 1;
        if initial != 0.0 && duration > 0.0 {
            let carried = |s: f64| {
                let excess = body.law.excess_after(initial, s.max(0.0));
                let u = carried_at(&body.specimen, Layer::Excess(excess), force, body.bonded);
                (u, excess)
            };
            let relative_rate = body.law.relative_rate(initial);
            // The first step sees the excess fall by a part of itself.
            let first = duration.min(0.1 / relative_rate);
            let mut solver = Dop853::new(0.0, TOLERANCE * first, first);
            while solver.time < duration {
                // s matters as far as it moves x: relative to itself once it is long.
                let reached = solver.state.max(1.0 / relative_rate).min(duration);
                solver.tolerance = TOLERANCE * reached;
                let step = solver.step(duration, |_, s| {
                    let (u, excess) = carried(s);
                    // Beyond what the body carries the step is thrown away below.
                    let u = u.unwrap_or(body.specimen.depth());
                    share(&body.specimen, body.layers, u, excess).0 * body.faster(excess, u)
                });
                if carried(solver.state).0.is_none() {
                    let start = steps.last().map_or(0.0, Step::end);
                    let good = |elapsed: f64| carried(step.at(elapsed)).0.is_some();
                    return Err(Stopped::TooMuch {
                        elapsed: last_good(start, solver.time, good),
                    });
                }
                steps.push(step);
            }
            work.steps += solver.steps;
            work.evaluations += solver.evaluations;
        }
        Ok(Path::Held { initial, steps })
    }

    fn changing(body: &Body, force: ForceLine, behind: f64, work: &mut SimulationWork) -> Result<Path, Stopped> {
        work.ramps += 1;
        let duration = force.duration;
        let (depth, thickness) = (body.specimen.depth(), body.thickness());
        let mut solver = Dop853::new(behind, TOLERANCE * depth, duration / 64.0);
        let mut steps: Vec<Step> = Vec::new();
        let carried = |elapsed: f64, behind: f64| body.carry(force.at(elapsed), behind);
        while solver.time < duration {
            if steps.len() == MOST_STEPS {
                return Err(Stopped::TooStiff { elapsed: solver.time });
            }
            let step = solver.step(duration, |elapsed, behind| {
                // Beyond what the body carries the step is thrown away below.
                let (u, excess) = carried(elapsed, behind).unwrap_or((0.0, 0.0));
                -thickness * body.law.rate(excess) * body.faster(excess, u)
            });
            if carried(solver.time, solver.state).is_none() {
                let good = |elapsed: f64| carried(elapsed, step.at(elapsed)).is_some();
                let start = steps.last().map_or(0.0, Step::end);
                return Err(Stopped::TooMuch {
                    elapsed: last_good(start, solver.time, good),
                });
            }
            steps.push(step);
        }
        work.steps += solver.steps;
        work.evaluations += solver.evaluations;
        Ok(Path::Changing(steps))
    }
}

impl UnderForce for Forced {
    type Excess = f64;
    /// Displacement of the node behind the contact layer, m.
    type Behind = f64;

    fn force_at(&self, elapsed: f64) -> f64 {
        self.force.at(elapsed)
    }

    fn at(&self, elapsed: f64) -> Carried {
        let (body, force) = (&self.body, self.force_at(elapsed));
        let (displacement, excess) = match &self.path {
            Path::Held { initial, steps } => {
                let s = dense(steps, elapsed).unwrap_or(0.0).max(0.0);
                let excess = body.law.excess_after(*initial, s);
                let u = carried_at(&body.specimen, Layer::Excess(excess), force, body.bonded);
                (u.unwrap_or(f64::NAN), excess)
            }
            Path::Changing(steps) => {
                let behind = dense(steps, elapsed).unwrap_or(f64::NAN);
                body.carry(force, behind).unwrap_or((f64::NAN, f64::NAN))
            }
        };
        let (share, carrying) = share(&body.specimen, body.layers, displacement, excess);
        let depth = body.specimen.depth();
        let by_law = body.law.rate(excess) * body.faster(excess, displacement);
        let slope = self.force.slope();
        let by_force = if slope == 0.0 { 0.0 } else { slope / carrying };
        let excess_rate = share * (by_force * (body.layers.count() - 1.0) / depth + by_law);
        let (stiffness, _) = body.specimen.stiffness(displacement);
        let yielding = if stiffness == 0.0 { -depth } else { -stiffness / carrying };
        Carried {
            displacement,
            excess,
            excess_rate,
            speed: by_force + yielding * excess_rate,
        }
    }

    fn step_ends(&self) -> Vec<f64> {
        let (Path::Held { steps, .. } | Path::Changing(steps)) = &self.path;
        steps.iter().map(Step::end).collect()
    }

    fn excess_at(&self, elapsed: f64) -> f64 {
        self.at(elapsed).excess
    }

    fn behind_at(&self, elapsed: f64) -> f64 {
        match &self.path {
            Path::Changing(steps) => dense(steps, elapsed).unwrap_or(f64::NAN),
            Path::Held { .. } => {
                let state = self.at(elapsed);
                let strain = state.excess + state.displacement / self.body.specimen.depth();
                state.displacement - self.body.thickness() * strain
            }
        }
    }
}

/// The dense output at `elapsed`; `None` of no steps.
fn dense(steps: &[Step], elapsed: f64) -> Option<f64> {
    let index = steps.partition_point(|step| step.end() < elapsed).min(steps.len().checked_sub(1)?);
    Some(steps[index].at(elapsed))
}

/// The last moment at which `good` holds, by bisection to the last bit.
pub(crate) fn last_good(mut good_at: f64, mut bad_at: f64, good: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (good_at + bad_at);
        if middle <= good_at || middle >= bad_at {
            return good_at;
        }
        if good(middle) {
            good_at = middle;
        } else {
            bad_at = middle;
        }
    }
}
