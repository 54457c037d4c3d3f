//! Error-controlled integration of ordinary differential equations with dense output.
//!
//! One method, Dormand–Prince 8(5,3), for the two equations that have no closed form: the contact layer in a ramp
//! (one number) and the layers behind it (a vector). It is explicit because nothing here is stiff once a ramp hands
//! over to its steady state (`contact::element`); it is of high order because the golden numbers are asked for to
//! nine digits and a reader of the strain wave should not meet the integrator in it.

mod column;
mod lanes;
mod tableau;

pub(crate) use column::{Column, Slopes, WIDTH};
pub(crate) use lanes::Lanes;

use tableau::{A, C, D, E3, E5};

/// Stages of one step; the last one is the derivative at the new point.
const STAGES: usize = 13;
/// Stages once the dense output is asked for.
const DENSE_STAGES: usize = 16;

/// Hairer's combination of the squares of both estimates, over `len` numbers.
///
/// Where the right-hand side is a power that is not whole, at x = 0, the fifth-order estimate may pass through zero by accident, the power's part
/// and the smooth part cancelling. It is taken to be no smaller than the third-order one tells: along smooth solutions the two are of sixth and
/// fourth order in the width, so that the first is some hundredth of the second to the power 3/2, in units of the slope.
#[inline(always)]
fn combined(width: f64, fifth: f64, third: f64, slope: f64, len: f64) -> f64 {
    // All of them are squares; 1e-300 is no slope at all.
    let least = ACCIDENT * ACCIDENT * third * (third / if slope > 1e-300 { slope } else { 1e-300 }).sqrt();
    let fifth = if fifth > least { fifth } else { least };
    let both = (fifth + 0.01 * third) * len;
    // No error at all, and one too small to be squared: no division by zero.
    width * fifth / if both > f64::MIN_POSITIVE { both } else { f64::MIN_POSITIVE }.sqrt()
}

/// The least that the fifth-order estimate is of the third-order one to the power 3/2 along smooth solutions.
const ACCIDENT: f64 = 0.004;

/// A point of phase space: one number or many.
pub(crate) trait State: Clone {
    /// Number of components.
    fn len(&self) -> usize;
    /// Component `index`.
    fn get(&self, index: usize) -> f64;
    /// A state of `len` components.
    fn build(len: usize, component: impl FnMut(usize) -> f64) -> Self;
}

impl<const N: usize> State for [f64; N] {
    fn len(&self) -> usize {
        N
    }
    #[inline(always)]
    fn get(&self, index: usize) -> f64 {
        self[index]
    }
    #[inline(always)]
    fn build(_: usize, component: impl FnMut(usize) -> f64) -> Self {
        std::array::from_fn(component)
    }
}

impl State for Vec<f64> {
    fn len(&self) -> usize {
        self.len()
    }
    #[inline(always)]
    fn get(&self, index: usize) -> f64 {
        self[index]
    }
    fn build(len: usize, component: impl FnMut(usize) -> f64) -> Self {
        (0..len).map(component).collect()
    }
}

/// One accepted step and the polynomial that stands for the solution inside it.
#[derive(Debug, Clone)]
pub(crate) struct Step<S> {
    start: f64,
    width: f64,
    from: S,
    terms: [S; 7],
}

impl<S: State> Step<S> {
    /// The solution at `time` inside the step.
    #[inline(always)]
    pub(crate) fn at(&self, time: f64) -> S {
        let x = (time - self.start) / self.width;
        S::build(self.from.len(), |i| {
            let mut y = 0.0;
            for (order, term) in self.terms.iter().rev().enumerate() {
                y = (y + term.get(i)) * if order % 2 == 0 { x } else { 1.0 - x };
            }
            self.from.get(i) + y
        })
    }

    /// The same step `by` later.
    pub(crate) fn later(&self, by: f64) -> Self {
        Self {
            start: self.start + by,
            ..self.clone()
        }
    }

    /// The state at its start.
    pub(crate) fn from(&self) -> &S {
        &self.from
    }

    /// Start of the step.
    pub(crate) fn start(&self) -> f64 {
        self.start
    }

    /// End of the step.
    pub(crate) fn end(&self) -> f64 {
        self.start + self.width
    }
}

/// Dormand–Prince 8(5,3) with a fixed absolute tolerance for every component.
#[derive(Debug)]
pub(crate) struct Dop853<S> {
    time: f64,
    state: S,
    slope: Option<S>,
    /// Room for the stages, kept from step to step.
    room: Vec<S>,
    width: f64,
    narrowest: f64,
    tolerance: f64,
    /// Accepted steps.
    pub(crate) steps: u64,
    /// Evaluations of the right-hand side.
    pub(crate) evaluations: u64,
}

impl<S: State> Dop853<S> {
    /// Starts at time 0 in `state` with a first step of `width`; errors are kept below `tolerance` a step.
    pub(crate) fn new(state: S, tolerance: f64, width: f64) -> Self {
        Self {
            time: 0.0,
            state,
            slope: None,
            room: Vec::with_capacity(DENSE_STAGES),
            width,
            // At a point where the right-hand side has no derivative (x = 0, n < 1) the step may shrink to
            // this and no further; the error of so narrow a step is far below the tolerance.
            narrowest: width * 1e-12,
            tolerance,
            steps: 0,
            evaluations: 0,
        }
    }

    /// Changes the error allowed in the steps to come.
    pub(crate) fn set_tolerance(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
    }

    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    pub(crate) fn state(&self) -> &S {
        &self.state
    }

    /// Takes one step towards `until` (not beyond it) along ẏ = `rhs`(t, y) and returns its dense output.
    pub(crate) fn step(&mut self, until: f64, mut rhs: impl FnMut(f64, &S) -> S) -> Step<S> {
        let first = match self.slope.take() {
            Some(slope) => slope,
            None => {
                self.evaluations += 1;
                rhs(self.time, &self.state)
            }
        };
        let mut rejected = false;
        loop {
            let remaining = until - self.time;
            // A last sliver is taken together with the step before it.
            let last = self.width >= remaining * (1.0 - 1e-12);
            let width = if last { remaining } else { self.width };
            let stages = self.stages(width, first.clone(), &mut rhs);
            let error = self.error(width, &stages);
            let growth = if error == 0.0 { 10.0 } else { 0.8 * error.powf(-0.125) };
            if (error.is_nan() || error > 1.0) && width > self.narrowest {
                self.width = (width * growth.max(0.2)).max(self.narrowest);
                self.room = stages;
                rejected = true;
                continue;
            }
            let growth = growth.clamp(0.2, if rejected { 1.0 } else { 10.0 });
            if !last || growth < 1.0 {
                self.width = width * growth;
            }
            let step = self.dense(width, stages, &mut rhs);
            self.time = if last { until } else { self.time + width };
            self.steps += 1;
            return step;
        }
    }

    /// The thirteen stages of a step; the last is the slope at its end, whose state is `advanced`.
    fn stages(&mut self, width: f64, first: S, rhs: &mut impl FnMut(f64, &S) -> S) -> Vec<S> {
        let mut stages = std::mem::take(&mut self.room);
        stages.clear();
        stages.push(first);
        for i in 1..STAGES {
            let point = self.advanced(width, A[i], &stages);
            stages.push(rhs(self.time + C[i] * width, &point));
        }
        self.evaluations += STAGES as u64 - 1;
        stages
    }

    fn advanced(&self, width: f64, weights: &[(usize, f64)], stages: &[S]) -> S {
        S::build(self.state.len(), |i| self.state.get(i) + width * weighted(weights, stages, i))
    }

    /// The error of a step, in units of the tolerance.
    fn error(&self, width: f64, stages: &[S]) -> f64 {
        let len = self.state.len();
        let (mut fifth, mut third, mut slope) = (0.0, 0.0, 0.0);
        for i in 0..len {
            fifth += (weighted(E5, stages, i) / self.tolerance).powi(2);
            third += (weighted(E3, stages, i) / self.tolerance).powi(2);
            slope += (stages[STAGES - 1].get(i) / self.tolerance).powi(2);
        }
        if fifth == 0.0 && third == 0.0 {
            return 0.0;
        }
        combined(width.abs(), fifth, third, slope, len as f64)
    }

    fn dense(&mut self, width: f64, mut stages: Vec<S>, rhs: &mut impl FnMut(f64, &S) -> S) -> Step<S> {
        let next = self.advanced(width, A[STAGES - 1], &stages);
        for i in STAGES..DENSE_STAGES {
            let point = self.advanced(width, A[i], &stages);
            stages.push(rhs(self.time + C[i] * width, &point));
        }
        self.evaluations += (DENSE_STAGES - STAGES) as u64;
        let len = self.state.len();
        let change = S::build(len, |i| next.get(i) - self.state.get(i));
        let (first, last) = (&stages[0], &stages[STAGES - 1]);
        let spline = [
            S::build(len, |i| width * first.get(i) - change.get(i)),
            S::build(len, |i| 2.0 * change.get(i) - width * (last.get(i) + first.get(i))),
        ];
        let higher = D.map(|row| S::build(len, |i| width * weighted(row, &stages, i)));
        let slope = stages.swap_remove(STAGES - 1);
        self.room = stages;
        let [b, c] = spline;
        let [d, e, f, g] = higher;
        let from = std::mem::replace(&mut self.state, next);
        self.slope = Some(slope);
        Step {
            start: self.time,
            width,
            from,
            terms: [change, b, c, d, e, f, g],
        }
    }
}

#[inline(always)]
fn weighted<S: State>(weights: &[(usize, f64)], stages: &[S], component: usize) -> f64 {
    weights.iter().map(|&(stage, weight)| weight * stages[stage].get(component)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of fixed-width steps over ẏ = −y², y(0) = 1, at the step ends and inside the steps.
    fn errors(steps: u32) -> (f64, f64) {
        let width = 2.0 / f64::from(steps);
        let mut solver = Dop853::new([1.0], f64::INFINITY, width);
        let (mut ends, mut inside) = (0.0f64, 0.0f64);
        let exact = |t: f64| 1.0 / (1.0 + t);
        for i in 1..=steps {
            let step = solver.step(width * f64::from(i), |_, [y]| [-y * y]);
            ends = ends.max((solver.state()[0] - exact(solver.time())).abs());
            for part in [0.25, 0.5, 0.75] {
                let t = width * (f64::from(i) - part);
                inside = inside.max((step.at(t)[0] - exact(t)).abs());
            }
        }
        (ends, inside)
    }

    #[test]
    fn order_of_convergence_is_eight_and_seven_between_steps() {
        let (coarse, fine) = (errors(10), errors(20));
        let order = |a: f64, b: f64| (a / b).log2();
        let (ends, inside) = (order(coarse.0, fine.0), order(coarse.1, fine.1));
        assert!(ends > 7.5, "order at step ends: {ends}");
        assert!(inside > 6.7, "order inside steps: {inside}");
    }

    #[test]
    fn vector_and_scalar_states_agree() {
        let mut one = Dop853::new([1.0], 1e-12, 0.1);
        let mut many = Dop853::new(vec![1.0, 1.0], 1e-12, 0.1);
        while one.time() < 3.0 {
            one.step(3.0, |t, [y]| [t - y]);
        }
        while many.time() < 3.0 {
            many.step(3.0, |t, y| vec![t - y[0], t - y[1]]);
        }
        let exact = 2.0 + 2.0 * (-3.0f64).exp();
        assert!((one.state()[0] - exact).abs() < 1e-11);
        assert!((many.state()[1] - exact).abs() < 1e-11);
    }
}
