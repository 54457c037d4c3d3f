//! The search for all parameters of several holds: few are shared, the others belong to one hold each.
//!
//! The normal equations are a block arrow: a small block for each hold, one for the shared parameters, and borders between.
//! Eliminating the holds leaves a small system in the shared parameters, whose right-hand side is the slope of the residual
//! square with every hold's own parameters at their best. For a law that is linear in these it is variable projection.

use super::hold::{Part, View, moved};
use crate::optimise::{Effort, Ending, Termination, stepped_within};
use crate::watch::Cancelled;

/// All holds at one point.
pub(crate) struct Point {
    pub(crate) shared: Vec<f64>,
    pub(crate) parts: Vec<Part>,
    pub(crate) square: f64,
}

impl Point {
    pub(crate) fn new(
        views: &[View<'_>],
        shared: &[f64],
        own: &[Vec<f64>],
        effort: &mut Effort<'_>,
    ) -> Result<Self, Cancelled> {
        let mut point = Self {
            shared: shared.to_vec(),
            parts: views.iter().zip(own).map(|(view, own)| Part::new(*view, own, shared.len())).collect(),
            square: f64::INFINITY,
        };
        point.settle(views, shared, own, effort)?;
        Ok(point)
    }

    /// Moves to these shared parameters and finds the holds' own ones, from those given.
    pub(crate) fn settle(
        &mut self,
        views: &[View<'_>],
        shared: &[f64],
        own: &[Vec<f64>],
        effort: &mut Effort<'_>,
    ) -> Result<(), Cancelled> {
        self.shared.copy_from_slice(shared);
        self.square = 0.0;
        for ((part, view), own) in self.parts.iter_mut().zip(views).zip(own) {
            part.settle(*view, shared, own, effort)?;
            self.square += view.hold.weight.powi(2) * part.square;
        }
        if !self.square.is_finite() {
            self.square = f64::INFINITY;
        }
        Ok(())
    }

    pub(crate) fn own(&self) -> Vec<Vec<f64>> {
        self.parts.iter().map(|part| part.own.clone()).collect()
    }

    /// Gauss–Newton matrix and gradient in the shared parameters, every hold's own ones eliminated.
    fn reduced(&self, views: &[View<'_>]) -> Option<(Vec<f64>, Vec<f64>)> {
        let q = self.shared.len();
        let (mut hessian, mut gradient) = (vec![0.0; q * q], vec![0.0; q]);
        for (part, view) in self.parts.iter().zip(views) {
            let (l, size, weight) = (part.own.len(), part.gradient.len(), view.hold.weight.powi(2));
            let factor = part.own_block()?;
            let mut own = part.gradient[..l].to_vec();
            factor.solve(&mut own);
            for j in 0..q {
                let mut border: Vec<f64> = (0..l).map(|k| part.normal[k * size + l + j]).collect();
                let imitated: f64 = border.iter().zip(&own).map(|(entry, step)| entry * step).sum();
                gradient[j] += weight * (part.gradient[l + j] - imitated);
                factor.solve(&mut border);
                for i in 0..q {
                    let imitated: f64 = (0..l).map(|k| part.normal[k * size + l + i] * border[k]).sum();
                    hessian[i * q + j] += weight * (part.normal[(l + i) * size + l + j] - imitated);
                }
            }
        }
        Some((hessian, gradient))
    }

    /// Own parameters of every hold after a step of the shared ones.
    fn following(&self, views: &[View<'_>], step: &[f64]) -> Vec<Vec<f64>> {
        let follow = |(part, view): (&Part, &View<'_>)| {
            let (l, size) = (part.own.len(), part.gradient.len());
            let left = |k: usize| {
                let border = step.iter().enumerate().map(|(j, change)| part.normal[k * size + l + j] * change);
                part.gradient[k] - border.sum::<f64>()
            };
            let mut change: Vec<f64> = (0..l).map(left).collect();
            match part.own_block() {
                Some(factor) => factor.solve(&mut change),
                None => change.fill(0.0),
            }
            moved(view.hold, &part.own, &change, 1.0)
        };
        self.parts.iter().zip(views).map(follow).collect()
    }
}

/// Share of the residual square below which steps are taken undamped, for as long as they promise ever less.
const NEAR: f64 = 1e-9;

/// Refines a point to the nearest optimum inside the bounds of the shared parameters (Levenberg–Marquardt on the eliminated system).
pub(crate) fn refine(
    views: &[View<'_>],
    bounds: &[(f64, f64)],
    mut here: Point,
    ending: Ending,
    effort: &mut Effort<'_>,
) -> Result<(Point, Termination), Cancelled> {
    effort.work.starts += 1;
    let values = views
        .iter()
        .map(|view| view.hold.weight.powi(2) * view.target.values.iter().map(|y| y * y).sum::<f64>());
    let floor = 1e-31 * values.sum::<f64>();
    let mut trial = Point {
        shared: here.shared.clone(),
        parts: here.parts.clone(),
        square: f64::INFINITY,
    };
    let mut damping = 1e-4;
    for _ in 0..ending.most_iterations {
        let Some((hessian, gradient)) = here.reduced(views).filter(|_| here.square.is_finite()) else {
            return Ok((here, Termination::Singular));
        };
        let promised = |step: &[f64], gradient: &[f64]| step.iter().zip(gradient).map(|(a, b)| a * b).sum::<f64>();
        let full = stepped(&here.shared, &hessian, &gradient, 0.0, bounds);
        let promise = promised(&full, &gradient);
        if promise <= ending.gain * here.square + floor {
            return Ok((here, Termination::Converged));
        }
        let near = promise < NEAR * here.square;
        loop {
            let step = if near { full.clone() } else { stepped(&here.shared, &hessian, &gradient, damping, bounds) };
            let next: Vec<f64> = here.shared.iter().zip(&step).map(|(value, change)| value + change).collect();
            trial.settle(views, &next, &here.following(views, &step), effort)?;
            let better = if near {
                let left = trial.reduced(views).map_or(f64::INFINITY, |(hessian, gradient)| {
                    promised(&stepped(&trial.shared, &hessian, &gradient, 0.0, bounds), &gradient)
                });
                left < 0.5 * promise && trial.square <= here.square * (1.0 + 1e-10)
            } else {
                trial.square < here.square
            };
            if better {
                std::mem::swap(&mut here, &mut trial);
                effort.work.iterations += 1;
                damping = (damping * 0.1).max(1e-14);
                break;
            }
            // A step that was to be the last one and brings nothing is rounding.
            if near || damping > 1e12 || step.iter().all(|change| change.abs() < 1e-14) {
                return Ok((here, Termination::Converged));
            }
            damping = (damping * 8.0).max(1e-6);
        }
    }
    Ok((here, Termination::IterationLimit))
}

/// A damped step that stays inside the bounds; a parameter pushed out of them stays where it is.
fn stepped(at: &[f64], hessian: &[f64], gradient: &[f64], damping: f64, bounds: &[(f64, f64)]) -> Vec<f64> {
    let next = stepped_within(at, hessian, gradient, damping, |i| bounds[i]);
    next.iter().zip(at).map(|(next, at)| next - at).collect()
}
