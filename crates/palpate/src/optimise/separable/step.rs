//! The Gauss–Newton step in the nonlinear numbers, the linear ones projected out.

use smallvec::SmallVec;

use super::point::{Point, Shapes};
use crate::optimise::cholesky::{Cholesky, Few, Square};

/// A matrix of second derivatives and a gradient that points downhill, both of half the residual square.
pub(crate) type Slope = (Square, Few);

/// The Gauss–Newton matrix and gradient in θ with the linear numbers projected out.
pub(crate) fn projected(here: &Point, shapes: &impl Shapes) -> Option<Slope> {
    if here.singular {
        return None;
    }
    let (l, p) = (here.columns.len(), here.theta.len());
    let size = l + p;
    let (normal, gradient) = here.normal(shapes);
    // Linear numbers at a bound do not move with θ.
    let free: SmallVec<[usize; 8]> = (0..l).filter(|&i| !here.held[i]).collect();
    let linear = Cholesky::new(&block(&normal, size, &free), free.len())?;
    let mut hessian = Square::from_elem(0.0, p * p);
    for (i, row) in hessian.chunks_exact_mut(p.max(1)).enumerate() {
        row.copy_from_slice(&normal[(l + i) * size + l..][..p]);
    }
    let mut cross = Few::from_elem(0.0, free.len());
    for j in 0..p {
        for (entry, &i) in cross.iter_mut().zip(&free) {
            *entry = normal[i * size + l + j];
        }
        linear.solve(&mut cross);
        for i in 0..p {
            let imitated: f64 = free.iter().zip(&cross).map(|(&k, entry)| normal[k * size + l + i] * entry).sum();
            hessian[i * p + j] -= imitated;
        }
    }
    Some((hessian, gradient))
}

/// The rows and columns `kept` of a square matrix.
pub(crate) fn block(matrix: &[f64], size: usize, kept: &[usize]) -> Square {
    let mut block = Square::from_elem(0.0, kept.len() * kept.len());
    for (row, i) in block.chunks_exact_mut(kept.len().max(1)).zip(kept) {
        for (entry, j) in row.iter_mut().zip(kept) {
            *entry = matrix[i * size + j];
        }
    }
    block
}

/// θ after a damped step, clipped to the bounds of these shapes.
pub(crate) fn stepped(theta: &[f64], hessian: &[f64], gradient: &[f64], damping: f64, shapes: &impl Shapes) -> Few {
    stepped_within(theta, hessian, gradient, damping, |i| shapes.bounds(i))
}

/// θ after a damped step, clipped to bounds; a number that sits at a bound and is pushed outwards stays out of the step.
pub(crate) fn stepped_within(
    theta: &[f64],
    hessian: &[f64],
    gradient: &[f64],
    damping: f64,
    bounds: impl Fn(usize) -> (f64, f64),
) -> Few {
    let p = theta.len();
    let pinned = |i: usize| {
        let (low, high) = bounds(i);
        (theta[i] <= low && gradient[i] < 0.0) || (theta[i] >= high && gradient[i] > 0.0)
    };
    let free: SmallVec<[usize; 8]> = (0..p).filter(|&i| !pinned(i)).collect();
    let mut matrix = block(hessian, p, &free);
    let mut step: Few = free.iter().map(|&i| gradient[i]).collect();
    // Scaled damping, with a floor for a number that the data do not feel at all.
    let damped = |i: usize| hessian[i * p + i].max(f64::MIN_POSITIVE) * (1.0 + damping);
    for (a, &i) in free.iter().enumerate() {
        matrix[a * (free.len() + 1)] = damped(i);
    }
    match Cholesky::new(&matrix, free.len()) {
        Some(factor) => factor.solve(&mut step),
        None => step.iter_mut().zip(&free).for_each(|(value, &i)| *value /= damped(i)),
    }
    let mut next = Few::from_slice(theta);
    for (&i, change) in free.iter().zip(step) {
        let (low, high) = bounds(i);
        // No step longer than a quarter of the range: the model is trusted only so far.
        let most = 0.25 * (high - low);
        next[i] = (theta[i] + change.clamp(-most, most)).clamp(low, high);
    }
    next
}

/// Largest change of one nonlinear number.
pub(crate) fn distance(here: &[f64], next: &[f64]) -> f64 {
    here.iter().zip(next).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// How much a Gauss–Newton step from `here` to `next` takes off the residual square, to first order.
pub(crate) fn promise(here: &[f64], next: &[f64], gradient: &[f64]) -> f64 {
    next.iter().zip(here).zip(gradient).map(|((a, b), g)| (a - b) * g).sum()
}
