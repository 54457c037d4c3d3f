//! Damped steps (Levenberg 1944, Marquardt 1963) from anywhere to the nearest local optimum.

use super::point::Point;
use super::step::{projected, promise};
use crate::optimise::{Effort, Ending, Few, Shapes, Target, Termination, distance, stepped};
use crate::watch::Cancelled;

/// Where a refinement ended.
pub(crate) struct Refined {
    pub(crate) point: Point,
    /// The last step, still to be taken along the tangent, after which none brings it any closer.
    pub(crate) last: Option<Few>,
    pub(crate) termination: Termination,
}

impl Refined {
    /// The nonlinear numbers alone.
    pub(crate) fn into_theta(self, shapes: &impl Shapes) -> Vec<f64> {
        let mut theta = self.point.theta.clone();
        let last = self.last.iter().flatten();
        theta.iter_mut().zip(last).for_each(|(value, step)| *value += step);
        self.point.release(shapes);
        theta
    }
}

/// Refines θ from `start` to the nearest local optimum inside the bounds.
pub(crate) fn refine(
    shapes: &impl Shapes,
    target: Target<'_>,
    start: &[f64],
    ending: Ending,
    effort: &mut Effort<'_>,
) -> Result<Refined, Cancelled> {
    let numbers = start.len();
    let samples = target.values.len();
    let mut here = Point::new(shapes, numbers, samples);
    let mut trial = Point::new(shapes, numbers, samples);
    here.evaluate(shapes, start, target);
    effort.evaluated()?;
    effort.work.starts += 1;
    let mut damping = 1e-4;
    let mut termination = Termination::IterationLimit;
    let floor = target.floor();
    'search: for _ in 0..ending.most_iterations {
        let Some((hessian, gradient)) = projected(&here, shapes) else {
            termination = Termination::Singular;
            break;
        };
        // What the full Gauss–Newton step promises; less than this is rounding, or far inside the errors.
        let full = stepped(&here.theta, &hessian, &gradient, 0.0, shapes);
        if promise(&here.theta, &full, &gradient) <= ending.gain * here.square + floor
            && distance(&here.theta, &full) < 1e-4
        {
            termination = Termination::Converged;
            break;
        }
        loop {
            let theta = stepped(&here.theta, &hessian, &gradient, damping, shapes);
            let moved = distance(&here.theta, &theta);
            if moved <= 1e-14 || damping > 1e12 {
                termination = Termination::Converged;
                break 'search;
            }
            trial.evaluate(shapes, &theta, target);
            effort.evaluated()?;
            if trial.square < here.square {
                let gain = here.square - trial.square;
                std::mem::swap(&mut here, &mut trial);
                effort.work.iterations += 1;
                damping = (damping * 0.1).max(1e-14);
                if gain <= ending.gain * here.square + floor {
                    termination = Termination::Converged;
                    break 'search;
                }
                break;
            }
            // At a flat bottom rounding decides; a step that would gain nothing measurable is the end.
            if moved < 1e-7 && damping < 1.0 && trial.square <= here.square * (1.0 + 1e-14) + floor {
                termination = Termination::Converged;
                break 'search;
            }
            damping = (damping * 8.0).max(1e-6);
        }
    }
    trial.release(shapes);
    Ok(Refined {
        point: here,
        last: None,
        termination,
    })
}
