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

/// Newton's method with differences, between bounds; a compass search where it has no bottom to go to. `None` where the function is not below
/// `promise` at the start.
///
/// `evaluate` takes points together: what computes several at once takes hardly longer than for one.
pub(crate) fn minimise<V: Level>(
    evaluate: &impl Fn(&[Few]) -> Vec<Option<V>>,
    start: &[f64],
    bounds: &[(f64, f64)],
    promise: f64,
) -> Option<Minimum<V>> {
    let at = Few::from_slice(start);
    let mut around = Around::new(&at, bounds);
    let mut points = around.points();
    points.push(at.clone());
    let mut found = evaluate(&points);
    let mut here = Minimum {
        at,
        value: found.pop()??,
        curvature: None,
    };
    if here.value.level() > promise {
        return None;
    }
    for _ in 0..STEPS {
        let Some((to, curvature)) = around.newton(&found, bounds) else {
            return Some(compass(evaluate, here));
        };
        let steps = || to.iter().zip(&here.at).map(|(to, x)| to - x);
        let longest = steps().fold(0.0, |most: f64, by| most.max(by.abs()));
        let is_last = longest <= ENOUGH;
        let shortened = (LONGEST / longest).min(1.0);
        let at: Few = here.at.iter().zip(steps()).map(|(x, by)| x + shortened * by).collect();
        let next = Around::new(&at, bounds);
        here.curvature = around.is_inside(&here.at).then_some(curvature);
        let mut points = if is_last { Vec::new() } else { next.points() };
        points.push(at.clone());
        found = evaluate(&points);
        around = next;
        match found.pop()? {
            Some(value) if value.level() < here.value.level() => (here.at, here.value) = (at, value),
            // So near the bottom rounding and the next term of the series decide.
            _ if is_last => {}
            _ => return Some(compass(evaluate, here)),
        }
        if is_last {
            return Some(here);
        }
    }
    Some(compass(evaluate, here))
}

/// Points that a parabola is laid through.
struct Around {
    /// As near to a point as bounds leave room for the others.
    middle: Few,
}

impl Around {
    fn new(at: &Few, bounds: &[(f64, f64)]) -> Self {
        let inside = at.iter().zip(bounds).map(|(x, (low, high))| x.min(high - STEP).max(low + STEP));
        Self {
            middle: inside.collect(),
        }
    }

    /// Whether this point is the middle: no bound is near.
    fn is_inside(&self, at: &Few) -> bool {
        self.middle == *at
    }

    fn points(&self) -> Vec<Few> {
        std::iter::once(self.middle.clone()).chain(ring(&self.middle)).collect()
    }

    /// Where the parabola is least between the bounds, and its curvature; `None` where there is no bottom.
    fn newton<V: Level>(&self, found: &[Option<V>], bounds: &[(f64, f64)]) -> Option<(Few, Square)> {
        let (gradient, curvature) = parabola(self.middle.len(), (*found.first()?)?, &found[1..])?;
        let size = gradient.len();
        let mut held = vec![None; size];
        loop {
            // The equations of those that are free, and of those at a bound that they stay there.
            let (mut matrix, mut step) = (curvature.clone(), Few::new());
            for i in 0..size {
                let of_held = (0..size).filter_map(|j| Some(curvature[i * size + j] * held[j]?));
                step.push(match held[i] {
                    Some(by) => curvature[i * (size + 1)] * by,
                    None => -gradient[i] - of_held.sum::<f64>(),
                });
                for j in (0..size).filter(|j| *j != i && (held[i].is_some() || held[*j].is_some())) {
                    matrix[i * size + j] = 0.0;
                }
            }
            Cholesky::new(&matrix, size)?.solve(&mut step);
            let to = |i: usize| self.middle[i] + step[i];
            let over = |i: usize| (bounds[i].0 - to(i)).max(to(i) - bounds[i].1);
            let outside = (0..size).filter(|i| held[*i].is_none() && over(*i) > 0.0);
            let Some(farthest) = outside.max_by(|i, j| over(*i).total_cmp(&over(*j))) else {
                return Some(((0..size).map(|i| to(i).clamp(bounds[i].0, bounds[i].1)).collect(), curvature));
            };
            let (low, high) = bounds[farthest];
            held[farthest] = Some(to(farthest).clamp(low, high) - self.middle[farthest]);
        }
    }
}

/// Points around one that differences are taken between: two along each axis, and two along the diagonal of every two.
fn ring(middle: &Few) -> Vec<Few> {
    let beside = |axes: &[usize], by: f64| {
        let mut at = middle.clone();
        axes.iter().for_each(|axis| at[*axis] += by);
        at
    };
    let mut points = Vec::new();
    for i in 0..middle.len() {
        points.extend([STEP, -STEP].map(|by| beside(&[i], by)));
    }
    for i in 0..middle.len() {
        for j in 0..i {
            points.extend([STEP, -STEP].map(|by| beside(&[i, j], by)));
        }
    }
    points
}

/// Slopes and curvature, from values on a [`ring`]. `None` at an edge.
fn parabola<V: Level>(size: usize, middle: V, around: &[Option<V>]) -> Option<(Few, Square)> {
    let middle = middle.level();
    let levels: Option<Vec<f64>> = around.iter().map(|found| found.as_ref().map(Level::level)).collect();
    let levels = levels?;
    let (pairs, _) = levels.as_chunks::<2>();
    let (mut gradient, mut curvature) = (Few::new(), Square::from_elem(0.0, size * size));
    let mut diagonals = pairs[size..].iter();
    for i in 0..size {
        let [above, below] = pairs[i];
        gradient.push((above - below) / (2.0 * STEP));
        curvature[i * (size + 1)] = (above - 2.0 * middle + below) / (STEP * STEP);
        for (j, axis) in pairs[..i].iter().enumerate() {
            let both = diagonals.next()?.iter().sum::<f64>();
            let entry = (both - above - below - axis.iter().sum::<f64>() + 2.0 * middle) / (2.0 * STEP * STEP);
            curvature[i * size + j] = entry;
            curvature[j * size + i] = entry;
        }
    }
    Some((gradient, curvature))
}

/// To the lowest of the neighbours, on in that direction for as long as the function falls, with ever shorter steps (after Hooke and Jeeves 1961).
fn compass<V: Level>(evaluate: &impl Fn(&[Few]) -> Vec<Option<V>>, from: Minimum<V>) -> Minimum<V> {
    /// Steps on in a direction that are looked at together.
    const ON: i32 = 4;
    /// Most axes of which the diagonals of every two are neighbours too: of more there are many.
    const DIAGONALS: usize = 2;
    let Minimum {
        mut at,
        value: mut best,
        ..
    } = from;
    let size = at.len();
    // The lowest of some points, if it is below this level.
    let lowest = |points: Vec<Few>, level: f64| {
        let found = evaluate(&points);
        let found = points.into_iter().zip(found).filter_map(|(at, found)| Some((at, found?)));
        found.filter(|(_, found)| found.level() < level).min_by(|a, b| a.1.level().total_cmp(&b.1.level()))
    };
    let mut step = 0.5;
    while step > ENOUGH {
        let beside = |moves: &[(usize, f64)]| {
            let mut at = at.clone();
            moves.iter().for_each(|(axis, side)| at[*axis] += side * step);
            at
        };
        let sides = [1.0, -1.0];
        let along = (0..size).flat_map(|axis| sides.map(|side| beside(&[(axis, side)])));
        let pairs = (0..size).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|_| size <= DIAGONALS);
        let across = pairs.flat_map(|(i, j)| {
            sides
                .into_iter()
                .flat_map(move |one| sides.map(|other| [(i, one), (j, other)]))
                .map(|moves| beside(&moves))
        });
        let Some((next, found)) = lowest(along.chain(across).collect(), best.level()) else {
            step *= 0.5;
            continue;
        };
        let direction: Few = next.iter().zip(&at).map(|(next, at)| next - at).collect();
        (at, best) = (next, found);
        loop {
            let on =
                |times: i32| -> Few { at.iter().zip(&direction).map(|(x, by)| x + f64::from(times) * by).collect() };
            let Some((next, found)) = lowest((1..=ON).map(on).collect(), best.level()) else {
                break;
            };
            (at, best) = (next, found);
        }
    }
    let around = evaluate(&ring(&at));
    Minimum {
        curvature: parabola(size, best, &around)
            .map(|(_, curvature)| curvature)
            .filter(|curvature| Cholesky::new(curvature, size).is_some()),
        at,
        value: best,
    }
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

    const OPEN: [(f64, f64); 2] = [(f64::NEG_INFINITY, f64::INFINITY); 2];

    /// Some points together.
    fn each(of: impl Fn(&Few) -> Option<f64>) -> impl Fn(&[Few]) -> Vec<Option<f64>> {
        move |points| points.iter().map(&of).collect()
    }

    fn valley(x: &Few) -> Option<f64> {
        let (a, b) = (x[0] - 1.3, x[1] + 0.4);
        (x[0] < 4.0).then_some(3.0 * a * a + a * b + b * b + 0.02 * a.powi(4))
    }

    #[test]
    fn a_valley_is_found_from_afar_with_its_curvature() {
        let found = minimise(&each(valley), &[3.5, 3.0], &OPEN, f64::INFINITY).unwrap();
        assert!((found.at[0] - 1.3).abs() < 2e-3 && (found.at[1] + 0.4).abs() < 2e-3, "{:?}", found.at);
        let expected = [6.0, 1.0, 1.0, 2.0];
        assert!(found.curvature.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.01));
    }

    #[test]
    fn at_an_edge_the_compass_goes_on() {
        let slope = each(|x| (x[0] >= 0.0).then_some(x[0] + (x[1] - 1.0).powi(2)));
        let found = minimise(&slope, &[2.0, 3.0], &OPEN, f64::INFINITY).unwrap();
        assert!(
            found.at[0] < 0.04 && (found.at[1] - 1.0).abs() < 0.04 && found.curvature.is_none(),
            "{:?}",
            found.at
        );
        assert!(minimise(&slope, &[-1.0, 0.0], &OPEN, f64::INFINITY).is_none());
        assert!(minimise(&slope, &[2.0, 3.0], &OPEN, 5.9).is_none());
    }

    /// At a bound the compass took some fifteen evaluations of points together.
    #[test]
    fn a_bottom_at_a_bound_is_found_in_few_steps() {
        let rounds = std::cell::Cell::new(0);
        let evaluate = |points: &[Few]| {
            rounds.set(rounds.get() + 1);
            each(|x: &Few| valley(x).filter(|_| x[0] <= 0.5))(points)
        };
        let found = minimise(&evaluate, &[-1.0, 2.0], &[(-5.0, 0.5), (-5.0, 5.0)], f64::INFINITY).unwrap();
        // At x = 0.5 the least of b² + a b is at b = −a/2 = 0.4.
        assert!((found.at[0] - 0.5).abs() < 1e-9 && found.at[1].abs() < 2e-2, "{:?}", found.at);
        assert!(found.directions().is_none() && rounds.get() <= 6, "{}", rounds.get());
    }
}
