//! What a hold and a ramp leave of a stretch.

use super::points::Point;
use crate::optimise::{BoundedProblem, BoundedSolver, LinearFit, fit_linear};

/// Number of decays.
const K: usize = 16;
/// Times of decay, as shares of a stretch. A decay slower than the last is a straight line, hence a ramp.
const DECAYS: [f64; K] = [
    5e-7, 1.6e-6, 5e-6, 1.6e-5, 5e-5, 1.6e-4, 5e-4, 0.0015, 0.004, 0.011, 0.03, 0.065, 0.12, 0.2, 0.35, 0.6,
];
/// How many of the first are for holds that are sampled ever more rarely, and how many points such a decay needs within three times its time.
const FAST: usize = 7;
const POINTS_OF_FAST: usize = 4;
/// Those of what relaxes when a ramp begins.
const AT_RAMPS: [usize; 5] = [9, 10, 12, 14, 15];
/// Parameters that a relaxation is counted as: its level, its size and its time.
const RELAXATION: f64 = 3.0;
/// What a decay must still amount to at the first point, as a share of itself.
const SHOWS: f64 = 0.1;
/// Parameters, in prices of one, that a parabola must leave before a decay is tried beside it.
const LEFT: f64 = 8.0;

/// What is unsure of the points, and what a parameter costs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weighing {
    /// Standard deviation of a sample, N.
    pub(super) noise: f64,
    /// What rounding leaves unsure of any mean, N.
    pub(super) rounding: f64,
    /// How far a shape may be off the truth, as a share of the range of its stretch.
    pub(super) off: f64,
    /// What a parameter costs, in squares of the noise.
    pub(super) price: f64,
}

/// A shape that was fitted to a stretch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    start: f64,
    span: f64,
    polynomial: [f64; 3],
    decays: [f64; K],
    pub(super) parameters: f64,
    /// Squares left, and the price of the parameters.
    pub(super) cost: f64,
}

impl Shape {
    /// Becomes a ramp that costs less.
    fn improve(&mut self, polynomial: [f64; 3], decay: Option<(usize, f64)>, parameters: f64, cost: f64) {
        if cost < self.cost {
            (self.polynomial, self.parameters, self.cost) = (polynomial, parameters, cost);
            self.decays = [0.0; K];
            if let Some((place, size)) = decay {
                self.decays[place] = size;
            }
        }
    }

    /// The force at a time.
    pub(super) fn at(&self, time: f64) -> f64 {
        let u = (time - self.start) / self.span;
        let [a, b, c] = self.polynomial;
        let decay = |(size, time): (&f64, &f64)| if *size == 0.0 { 0.0 } else { size * (-u / time).exp() };
        a + u * (b + u * c) + self.decays.iter().zip(&DECAYS).map(decay).sum::<f64>()
    }

    /// How far it goes from its first moment to its last, N.
    pub(super) fn change(&self) -> f64 {
        self.at(self.start + self.span) - self.at(self.start)
    }

    /// Its slope where the stretch begins (u = 0) or ends (u = 1), N/s.
    pub(super) fn slope(&self, u: f64) -> f64 {
        let decay = |(size, time): (&f64, &f64)| size / time * (-u / time).exp();
        let [_, b, c] = self.polynomial;
        (b + 2.0 * c * u - self.decays.iter().zip(&DECAYS).map(decay).sum::<f64>()) / self.span
    }
}

/// The best hold and the best ramp of a stretch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shapes {
    pub(super) hold: Shape,
    pub(super) ramp: Shape,
}

impl Shapes {
    /// Numbers that a solver for holds has.
    pub(super) const DECAYS: usize = K;

    /// Fits both to the points of a stretch from one time to another.
    pub(super) fn of(
        points: &[Point],
        (start, end): (f64, f64),
        weighing: Weighing,
        solver: &mut BoundedSolver,
    ) -> Self {
        let span = if end > start { end - start } else { 1.0 };
        let (low, high) =
            points.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.value), high.max(p.value)));
        let fixed = (weighing.off * (high - low)).powi(2) + weighing.rounding.powi(2);
        let reference = points[points.len() - 1].value;
        let weigh = |p: &Point| Weighed {
            u: (p.time - start) / span,
            value: p.value - reference,
            weight: 1.0 / (weighing.noise * weighing.noise / p.samples + fixed),
        };
        let weighed: Vec<Weighed> = points.iter().map(weigh).collect();
        let blank = Shape {
            start,
            span,
            polynomial: [0.0; 3],
            decays: [0.0; K],
            parameters: 0.0,
            cost: f64::INFINITY,
        };
        let mut both = Self {
            hold: hold(&weighed, blank, weighing.price, solver),
            ramp: ramp(&weighed, blank, weighing.price),
        };
        both.hold.polynomial[0] += reference;
        both.ramp.polynomial[0] += reference;
        both
    }
}

/// A point in the units of its stretch.
#[derive(Debug, Clone, Copy)]
struct Weighed {
    u: f64,
    value: f64,
    weight: f64,
}

/// A level, and decays of one sign towards it.
fn hold(points: &[Weighed], blank: Shape, price: f64, solver: &mut BoundedSolver) -> Shape {
    let (mut gram, mut right, mut mean) = ([0.0; K * K], [0.0; K], [0.0; K]);
    let (mut weight, mut sum, mut squares) = (0.0, 0.0, 0.0);
    let first = fastest(points);
    for p in points {
        let mut decays = [0.0; K];
        for i in first..K {
            decays[i] = (-p.u / DECAYS[i]).exp();
            mean[i] += p.weight * decays[i];
            right[i] += p.weight * decays[i] * p.value;
            for j in first..=i {
                gram[i * K + j] += p.weight * decays[i] * decays[j];
            }
        }
        weight += p.weight;
        sum += p.weight * p.value;
        squares += p.weight * p.value * p.value;
    }
    let spread = (squares - sum * sum / weight).max(0.0);
    let mut best = Shape {
        polynomial: [sum / weight, 0.0, 0.0],
        parameters: 1.0,
        cost: spread + price,
        ..blank
    };
    if points.len() < 3 {
        return best;
    }
    for i in 0..K {
        right[i] -= mean[i] * sum / weight;
        for j in 0..=i {
            gram[i * K + j] -= mean[i] * mean[j] / weight;
            gram[j * K + i] = gram[i * K + j];
        }
        gram[i * (K + 1)] += 1e-9 * weight;
    }
    // What is over before the first mean shows in none of them.
    let shows: [bool; K] = std::array::from_fn(|i| i >= first && (-points[0].u / DECAYS[i]).exp() > SHOWS);
    for (lower, upper) in [(0.0, f64::INFINITY), (f64::NEG_INFINITY, 0.0)] {
        let bound = |bound: f64| shows.map(|shows| if shows { bound } else { 0.0 });
        let problem = BoundedProblem {
            gram: &gram,
            right: &right,
            lower: &bound(lower),
            upper: &bound(upper),
        };
        if solver.solve(&problem).is_none() {
            continue;
        }
        let explained: f64 = (0..K)
            .map(|i| {
                let pulled: f64 = (0..K).map(|j| gram[i * K + j] * solver.solution[j]).sum();
                solver.solution[i] * (2.0 * right[i] - pulled)
            })
            .sum();
        let cost = (spread - explained).max(0.0) + RELAXATION * price;
        if cost < best.cost {
            let decays: [f64; K] = std::array::from_fn(|i| solver.solution[i]);
            let level = sum - decays.iter().zip(&mean).map(|(a, m)| a * m).sum::<f64>();
            best = Shape {
                polynomial: [level / weight, 0.0, 0.0],
                decays,
                parameters: RELAXATION,
                cost,
                ..blank
            };
        }
    }
    best
}

/// The fastest of the decays that the points of a stretch can show.
fn fastest(points: &[Weighed]) -> usize {
    let Some(fourth) = points.get(POINTS_OF_FAST - 1) else {
        return FAST;
    };
    DECAYS[..FAST].partition_point(|time| 3.0 * time < fourth.u)
}

/// A line, a parabola, or a parabola and a decay, whichever costs least.
fn ramp(points: &[Weighed], blank: Shape, price: f64) -> Shape {
    let mut best = blank;
    if let Some(LinearFit { factors: [a, b], left }) = fitted(points, |u| [1.0, u]) {
        best.improve([a, b, 0.0], None, 2.0, left + 2.0 * price);
    }
    if let Some(LinearFit { factors, left }) = fitted(points, |u| [1.0, u, u * u]) {
        best.improve(factors, None, 3.0, left + 3.0 * price);
    }
    if points.len() >= 5 && best.cost > LEFT * price {
        for place in AT_RAMPS {
            let fitted = fitted(points, |u| [1.0, u, u * u, (-u / DECAYS[place]).exp()]);
            if let Some(LinearFit {
                factors: [a, b, c, size],
                left,
            }) = fitted
            {
                best.improve([a, b, c], Some((place, size)), 5.0, left + 5.0 * price);
            }
        }
    }
    best
}

/// A fit of these functions of u.
fn fitted<const N: usize>(points: &[Weighed], functions: impl Fn(f64) -> [f64; N]) -> Option<LinearFit<N>> {
    fit_linear(points.iter().map(|p| (functions(p.u), p.value, p.weight)), 1e-13)
}
