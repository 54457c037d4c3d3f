//! Where a function of one or two numbers is least that is known by its values alone.

use super::cholesky::{Cholesky, Few, Square};

/// Step of the differences, a good part of an error.
const STEP: f64 = 0.1;

/// Steps shorter than this, an eighth of an error, change nothing.
const ENOUGH: f64 = 2e-2;

/// Longest step of Newton's method: the function is no parabola.
const LONGEST: f64 = 2.0;

/// Most steps of Newton's method.
const STEPS: usize = 8;

/// A value of the function, with what else is known there.
pub(crate) trait Level: Copy {
    /// What is to be least.
    fn level(&self) -> f64;
}

/// Where the function is least.
pub(crate) struct Minimum<V> {
    pub(crate) at: Few,
    pub(crate) value: V,
    /// Second derivatives there; `None` at an edge, and where it has no bottom.
    curvature: Option<Square>,
}

/// Newton's method with differences; a compass search where it has no bottom to go to.
pub(crate) fn minimise<V: Level>(evaluate: &impl Fn(&[f64]) -> Option<V>, start: &[f64]) -> Option<Minimum<V>> {
    let mut here = Minimum {
        at: Few::from_slice(start),
        value: evaluate(start)?,
        curvature: None,
    };
    for _ in 0..STEPS {
        let Some((step, curvature)) = newton(evaluate, &here) else {
            return Some(compass(evaluate, here));
        };
        let longest = step.iter().fold(0.0, |most: f64, by| most.max(by.abs()));
        let at: Few = here.at.iter().zip(&step).map(|(x, by)| x + by).collect();
        here.curvature = Some(curvature);
        match evaluate(&at) {
            Some(found) if found.level() < here.value.level() => (here.at, here.value) = (at, found),
            // So near the bottom rounding and the next term of the series decide.
            _ if longest <= ENOUGH => {}
            _ => return Some(compass(evaluate, here)),
        }
        if longest <= ENOUGH {
            return Some(here);
        }
    }
    Some(compass(evaluate, here))
}

/// A step, no longer than some along any axis, and the curvature it rests on. `None` at an edge, and where there is no bottom.
fn newton<V: Level>(evaluate: &impl Fn(&[f64]) -> Option<V>, here: &Minimum<V>) -> Option<(Few, Square)> {
    let size = here.at.len();
    let middle = here.value.level();
    let at = |moves: &[(usize, f64)]| {
        let mut x = here.at.clone();
        moves.iter().for_each(|(axis, by)| x[*axis] += by);
        evaluate(&x).map(|found| found.level())
    };
    let (mut gradient, mut curvature) = (Few::new(), Square::from_elem(0.0, size * size));
    let mut sums = Few::new();
    for i in 0..size {
        let (above, below) = (at(&[(i, STEP)])?, at(&[(i, -STEP)])?);
        gradient.push((above - below) / (2.0 * STEP));
        sums.push(above + below);
        curvature[i * (size + 1)] = (above - 2.0 * middle + below) / (STEP * STEP);
        for j in 0..i {
            let both = at(&[(i, STEP), (j, STEP)])? + at(&[(i, -STEP), (j, -STEP)])?;
            let entry = (both - sums[i] - sums[j] + 2.0 * middle) / (2.0 * STEP * STEP);
            curvature[i * size + j] = entry;
            curvature[j * size + i] = entry;
        }
    }
    let mut step: Few = gradient.iter().map(|slope| -slope).collect();
    Cholesky::new(&curvature, size)?.solve(&mut step);
    let longest = step.iter().fold(LONGEST, |most: f64, by| most.max(by.abs()));
    step.iter_mut().for_each(|by| *by *= LONGEST / longest);
    Some((step, curvature))
}

/// Along each axis to where the function stops falling, then on in the direction of both, with ever shorter steps (Hooke and Jeeves 1961).
fn compass<V: Level>(evaluate: &impl Fn(&[f64]) -> Option<V>, from: Minimum<V>) -> Minimum<V> {
    let Minimum {
        mut at,
        value: mut best,
        ..
    } = from;
    let mut step = 0.5;
    while step > ENOUGH {
        let from = at.clone();
        for axis in 0..at.len() {
            for side in [step, -step] {
                let mut trial = at.clone();
                trial[axis] += side;
                if let Some(found) = evaluate(&trial)
                    && found.level() < best.level()
                {
                    (at, best) = (trial, found);
                    break;
                }
            }
        }
        if at == from {
            step *= 0.5;
        }
        // As far again for as long as that helps.
        while at != from {
            let on: Few = at.iter().zip(&from).map(|(x, from)| 2.0 * x - from).collect();
            match evaluate(&on) {
                Some(found) if found.level() < best.level() => (at, best) = (on, found),
                _ => break,
            }
        }
    }
    let mut found = Minimum {
        at,
        value: best,
        curvature: None,
    };
    found.curvature = newton(evaluate, &found).map(|(_, curvature)| curvature);
    found
}

impl<V: Level> Minimum<V> {
    /// Vectors d with Σ d dᵀ = 2 (∂²level)⁻¹; none at an edge, where the curvature says nothing.
    pub(crate) fn directions(&self) -> Option<Vec<Vec<f64>>> {
        let size = self.at.len();
        let half: Option<Square> =
            self.curvature.as_ref().map(|matrix| matrix.iter().map(|entry| 0.5 * entry).collect());
        let covariance = half.and_then(|matrix| Cholesky::new(&matrix, size)).map(|factor| factor.inverse());
        let factor = covariance.and_then(|covariance| Cholesky::new(&covariance, size))?;
        Some((0..size).map(|j| factor.column(j)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Level for f64 {
        fn level(&self) -> f64 {
            *self
        }
    }

    fn valley(x: &[f64]) -> Option<f64> {
        let (a, b) = (x[0] - 1.3, x[1] + 0.4);
        (x[0] < 4.0).then_some(3.0 * a * a + a * b + b * b + 0.02 * a.powi(4))
    }

    #[test]
    fn a_valley_is_found_from_afar_with_its_curvature() {
        let found = minimise(&valley, &[3.5, 3.0]).unwrap();
        assert!((found.at[0] - 1.3).abs() < 2e-3 && (found.at[1] + 0.4).abs() < 2e-3, "{:?}", found.at);
        let expected = [6.0, 1.0, 1.0, 2.0];
        assert!(found.curvature.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01));
    }

    #[test]
    fn at_an_edge_the_compass_goes_on() {
        let slope = |x: &[f64]| (x[0] >= 0.0).then_some(x[0] + (x[1] - 1.0).powi(2));
        let found = minimise(&slope, &[2.0, 3.0]).unwrap();
        assert!(
            found.at[0] < 0.04 && (found.at[1] - 1.0).abs() < 0.04 && found.curvature.is_none(),
            "{:?}",
            found.at
        );
        assert!(minimise(&slope, &[-1.0, 0.0]).is_none());
    }
}
