//! Undamped steps close to the optimum, to where the gradient vanishes.

use super::finish::finish;
use super::point::Point;
use super::step::{Slope, projected, promise};
use crate::optimise::{
    Cholesky, Effort, Few, Refined, Shapes, Solution, Square, Target, Termination, distance, stepped,
};
use crate::watch::Cancelled;

/// The slope of half the residual square by the nonlinear numbers, the linear ones at their best, from differences of its gradient.
/// `None` where its curvature is not positive definite, or a number lies at a bound.
pub(crate) fn curvature(
    shapes: &impl Shapes,
    target: Target<'_>,
    theta: &[f64],
    effort: &mut Effort<'_>,
) -> Result<Option<Slope>, Cancelled> {
    /// Of the width of bounds; the error of the difference is some 10⁻⁸ of the curvature.
    const STEP: f64 = 1e-4;
    let count = theta.len();
    let mut point = Point::new(shapes, count, target.values.len());
    let (mut hessian, mut mean) = (Square::from_elem(0.0, count * count), Few::from_elem(0.0, count));
    for j in 0..count {
        let (low, high) = shapes.bounds(j);
        if theta[j] - STEP < low || theta[j] + STEP > high {
            return Ok(None);
        }
        for side in [-1.0, 1.0] {
            let mut beside = Few::from_slice(theta);
            beside[j] += side * STEP;
            point.evaluate(shapes, &beside, target);
            effort.evaluated()?;
            if point.singular || point.held.contains(&true) {
                return Ok(None);
            }
            for (i, entry) in point.gradient(shapes).into_iter().enumerate() {
                // The gradient points downhill.
                hessian[i * count + j] -= side * entry / (2.0 * STEP);
                mean[i] += entry / (2.0 * count as f64);
            }
        }
    }
    point.release(shapes);
    for i in 0..count {
        for j in 0..i {
            let mean = 0.5 * (hessian[i * count + j] + hessian[j * count + i]);
            hessian[i * count + j] = mean;
            hessian[j * count + i] = mean;
        }
    }
    Ok(Cholesky::new(&hessian, count).map(|_| (hessian, mean)))
}

/// Most steps of [`descend`].
const STEPS: usize = 12;

/// Newton's method from a point near the optimum, with a curvature from elsewhere: the gradient comes from all samples, the
/// curvature from few. A step that is `near` is the last, and is taken along the tangent. `None` if it does not lead downhill to
/// where the gradient vanishes.
pub(crate) fn descend(
    shapes: &impl Shapes,
    target: Target<'_>,
    theta: &[f64],
    hessian: &[f64],
    near: Near,
    effort: &mut Effort<'_>,
) -> Result<Option<Refined>, Cancelled> {
    let mut here = Point::new(shapes, theta.len(), target.values.len());
    here.evaluate(shapes, theta, target);
    effort.evaluated()?;
    effort.work.starts += 1;
    let outlook = |point: &Point| {
        let gradient = point.gradient(shapes);
        let next = stepped(&point.theta, hessian, &gradient, 0.0, shapes);
        let gain = promise(&point.theta, &next, &gradient);
        (next, gain)
    };
    let (mut next, mut gain) = outlook(&here);
    for _ in 0..STEPS {
        if here.singular || here.held.contains(&true) {
            return Ok(None);
        }
        let short = near.holds(distance(&here.theta, &next), gain.abs() / here.square);
        let arrived = gain.abs() <= NOTHING * here.square + target.floor();
        let leans = gain.abs() <= SLIGHT * here.square && shapes.linear_bounds().is_empty();
        if short && !arrived {
            if !leans {
                here.slide(shapes, &next, target);
            }
            effort.work.iterations += 1;
        }
        if short || arrived {
            // A step that promises nothing is rounding.
            let rest = |(next, here): (&f64, &f64)| if arrived { 0.0 } else { next - here };
            let step = next.iter().zip(&here.theta).map(rest);
            return Ok(Some(Refined {
                last: short.then(|| step.collect()),
                point: here,
                termination: Termination::Converged,
            }));
        }
        let (square, promised) = (here.square, gain);
        here.evaluate(shapes, &next, target);
        effort.evaluated()?;
        effort.work.iterations += 1;
        (next, gain) = outlook(&here);
        if gain.abs() > 0.5 * promised.abs() || here.square > square * (1.0 + 1e-10) + target.floor() {
            // What is left of the gain is rounding once it stops falling far below the residual.
            return Ok((promised.abs() < 1e-16 * square).then_some(Refined {
                last: None,
                point: here,
                termination: Termination::Converged,
            }));
        }
    }
    Ok(None)
}

/// Share of the residual square that a step may promise at the optimum: of a thousand samples, some 10⁻⁸ of the errors.
const NOTHING: f64 = 1e-19;

/// Share of the residual square up to which a step changes residuals by too little to be formed anew.
const SLIGHT: f64 = 1e-11;

/// When a step is short enough for its tangent.
#[derive(Clone, Copy)]
pub(crate) struct Near {
    /// Largest change of a nonlinear number, a logarithm or a few units at most.
    step: f64,
    /// Largest share of the residual square that the step promises.
    gain: f64,
}

impl Near {
    /// The tangent is the shape itself to rounding, and errors stay as they are to eight digits.
    const STRAIGHT: Self = Self {
        step: 3e-9,
        gain: f64::INFINITY,
    };

    /// Of many noisy samples: the step ends within 10⁻⁵ standard errors of the optimum, the curvature being good to four digits, and
    /// so are the errors then.
    const NOISY: Self = Self { step: 3e-5, gain: 1e-7 };

    /// What the tangent misses is far below what condensing moves a bottom by.
    pub(crate) const TELLING: Self = Self {
        step: 3e-4,
        gain: f64::INFINITY,
    };

    /// The last step among these samples.
    pub(crate) fn of(target: Target<'_>) -> Self {
        if target.exact { Self::STRAIGHT } else { Self::NOISY }
    }

    /// Whether a step is that short.
    pub(crate) fn holds(self, step: f64, gain: f64) -> bool {
        step <= Self::STRAIGHT.step || (step <= self.step && gain <= self.gain)
    }
}

/// Most undamped steps after the residual has stopped falling.
const POLISHING: usize = 30;

/// The solution of a refinement, with undamped steps taken from it for as long as they make the gradient smaller.
///
/// The residual is flat to rounding within some 1e-8 of the optimum; the gradient is not, and shows the way further in.
pub(crate) fn polished(
    shapes: &impl Shapes,
    target: Target<'_>,
    refined: Refined,
    effort: &mut Effort<'_>,
) -> Result<Solution, Cancelled> {
    let mut here = refined.point;
    if refined.last.is_some() || refined.termination != Termination::Converged {
        return Ok(finish(here, refined.last.as_deref(), shapes, refined.termination));
    }
    // The gain that a full step promises, gᵀ H⁻¹ g, measures the gradient.
    let outlook = |point: &Point| {
        let (hessian, gradient) = projected(point, shapes)?;
        let next = stepped(&point.theta, &hessian, &gradient, 0.0, shapes);
        let gain = promise(&point.theta, &next, &gradient);
        Some((next, gain))
    };
    let Some((mut next, mut gain)) = outlook(&here) else {
        return Ok(finish(here, None, shapes, Termination::Converged));
    };
    // Few samples make wide errors and cost nothing to polish.
    let samples = target.values.len();
    let enough = 1e-32 * (samples as f64).powi(3);
    let mut trial = Point::new(shapes, here.theta.len(), samples);
    for _ in 0..POLISHING {
        // Far from flat it is no polishing; at this share of the residual the step is some 1e-10 of the errors.
        if !(gain > enough * here.square && gain < 1e-9 * here.square) {
            break;
        }
        trial.evaluate(shapes, &next, target);
        effort.evaluated()?;
        match outlook(&trial) {
            Some((after, less)) if less < 0.5 * gain && trial.square <= here.square * (1.0 + 1e-10) => {
                std::mem::swap(&mut here, &mut trial);
                (next, gain) = (after, less);
            }
            _ => break,
        }
    }
    trial.release(shapes);
    Ok(finish(here, None, shapes, Termination::Converged))
}
