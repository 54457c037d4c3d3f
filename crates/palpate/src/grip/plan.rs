//! Ways to close the jaws.

use serde::{Deserialize, Serialize};

use crate::simulate::ProgramStep;

/// A way to close the jaws; what follows is a hold. SI units, displacements of the jaw since first touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum PlanKind {
    /// To a displacement at one speed.
    Squeeze {
        /// Where the hold is, m.
        displacement: f64,
        /// m/s.
        speed: f64,
    },
    /// To a force at one speed, which is kept while the body creeps; then the jaws are locked.
    Settle {
        /// The force, N.
        force: f64,
        /// m/s.
        speed: f64,
        /// How long the force is kept, s.
        settling: f64,
    },
    /// Farther than the hold, and back.
    BackOff {
        /// Where the jaw turns, m.
        over: f64,
        /// Where the hold is, m.
        displacement: f64,
        /// Speed of both ways, m/s.
        speed: f64,
    },
}

/// A way to close the jaws and the steps that it has.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What it is.
    pub kind: PlanKind,
    /// The steps up to the hold.
    pub steps: Vec<ProgramStep>,
}

impl Plan {
    /// To a displacement (m) at a speed (m/s).
    #[must_use]
    pub fn squeeze(displacement: f64, speed: f64) -> Self {
        Self {
            kind: PlanKind::Squeeze { displacement, speed },
            steps: vec![ProgramStep::Move {
                to: displacement,
                rate: speed,
            }],
        }
    }

    /// To a force (N) at a speed (m/s), which is kept for `settling` (s) before the jaws are locked.
    #[must_use]
    pub fn settle(force: f64, speed: f64, settling: f64) -> Self {
        let mut steps = vec![ProgramStep::MoveToForce { force, rate: speed }];
        if settling > 0.0 {
            steps.push(ProgramStep::HoldForce { duration: settling });
        }
        Self {
            kind: PlanKind::Settle { force, speed, settling },
            steps,
        }
    }

    /// To `over` (m) and back to `displacement` (m), both at a speed (m/s).
    #[must_use]
    pub fn back_off(over: f64, displacement: f64, speed: f64) -> Self {
        let step = |to| ProgramStep::Move { to, rate: speed };
        Self {
            kind: PlanKind::BackOff {
                over,
                displacement,
                speed,
            },
            steps: vec![step(over), step(displacement)],
        }
    }

    /// Its speed, m/s.
    #[must_use]
    pub fn speed(&self) -> f64 {
        match self.kind {
            PlanKind::Squeeze { speed, .. } | PlanKind::Settle { speed, .. } | PlanKind::BackOff { speed, .. } => speed,
        }
    }

    /// How far it goes, m, as far as it says so itself.
    pub(super) fn farthest(&self) -> f64 {
        match self.kind {
            PlanKind::Squeeze { displacement, .. } => displacement,
            PlanKind::BackOff { over, .. } => over,
            PlanKind::Settle { .. } => 0.0,
        }
    }

    /// The steps with a hold of `duration` (s) behind them.
    #[must_use]
    pub fn held(&self, duration: f64) -> Vec<ProgramStep> {
        let mut steps = self.steps.clone();
        if duration > 0.0 {
            steps.push(ProgramStep::HoldPosition { duration });
        }
        steps
    }
}
