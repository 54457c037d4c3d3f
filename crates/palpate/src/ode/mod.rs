//! Error-controlled integration of ordinary differential equations with dense output.
//!
//! One method, Dormand–Prince 8(5,3), for the two equations that have no closed form: the contact layer in a ramp
//! (one number) and the layers behind it (a vector). It is explicit because nothing here is stiff once a ramp hands
//! over to its steady state (`contact::element`); it is of high order because the golden numbers are required to
//! nine digits and a reader of the strain wave should not meet the integrator in it.

mod column;
mod tableau;

pub(crate) use column::{Column, Slopes, WIDTH};

use tableau::{A, C, D, E3, E5};

/// Stages of one step; the last one is the derivative at the new point.
const STAGES: usize = 13;
/// Stages once the dense output is requested.
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

/// One accepted step and the polynomial that stands for the solution inside it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    /// Start of the step.
    pub(crate) start: f64,
    width: f64,
    /// The state at its start.
    pub(crate) from: f64,
    terms: [f64; 7],
}

impl Step {
    /// From the stages of a step.
    fn new(start: f64, width: f64, from: f64, stages: &[f64; DENSE_STAGES]) -> Self {
        let change = width * weighted(A[STAGES - 1], stages);
        let (first, last) = (stages[0], stages[STAGES - 1]);
        let [d, e, f, g] = D.map(|row| width * weighted(row, stages));
        let terms = [change, width * first - change, 2.0 * change - width * (last + first), d, e, f, g];
        Self {
            start,
            width,
            from,
            terms,
        }
    }

    /// The solution at `time` inside the step.
    #[inline(always)]
    pub(crate) fn at(&self, time: f64) -> f64 {
        let x = (time - self.start) / self.width;
        let rest = 1.0 - x;
        let [a, b, c, d, e, f, g] = self.terms;
        self.from + (a + (b + (c + (d + (e + (f + g * x) * rest) * x) * rest) * x) * rest) * x
    }

    /// The same step `by` later.
    pub(crate) fn later(&self, by: f64) -> Self {
        Self {
            start: self.start + by,
            ..*self
        }
    }

    /// End of the step.
    pub(crate) fn end(&self) -> f64 {
        self.start + self.width
    }
}

/// Dormand–Prince 8(5,3) for one number with an absolute tolerance.
#[derive(Debug, Default)]
pub(crate) struct Dop853 {
    pub(crate) time: f64,
    pub(crate) state: f64,
    slope: Option<f64>,
    width: f64,
    narrowest: f64,
    pub(crate) tolerance: f64,
    /// The latest time that a step was tried to.
    pub(crate) latest: f64,
    /// Accepted steps.
    pub(crate) steps: u64,
    /// Evaluations of the right-hand side.
    pub(crate) evaluations: u64,
}

/// Fills the stages with the given numbers, written out so that every row of the tableau becomes straight code.
macro_rules! fill {
    ($solver:ident, $width:ident, $stages:ident, $rhs:ident, $($stage:literal)*) => {$(
        let point = $solver.state + $width * weighted(A[$stage], &$stages);
        $stages[$stage] = $rhs($solver.time + C[$stage] * $width, point);
        $solver.evaluations += 1;
    )*};
}

impl Dop853 {
    /// Starts at time 0 in `state` with a first step of `width`; errors are kept below `tolerance` a step.
    pub(crate) fn new(state: f64, tolerance: f64, width: f64) -> Self {
        Self {
            state,
            width,
            // At a point where the right-hand side has no derivative (x = 0, n < 1) the step may shrink to
            // this and no further; the error of so narrow a step is far below the tolerance.
            narrowest: width * 1e-12,
            tolerance,
            ..Self::default()
        }
    }

    /// Takes one step towards `until` (not beyond it) along ẏ = `rhs`(t, y) and returns its dense output.
    #[inline]
    pub(crate) fn step(&mut self, until: f64, rhs: impl Fn(f64, f64) -> f64) -> Step {
        let mut stages = [0.0; DENSE_STAGES];
        stages[0] = self.slope.take().unwrap_or_else(|| {
            self.evaluations += 1;
            rhs(self.time, self.state)
        });
        let mut rejected = false;
        loop {
            let remaining = until - self.time;
            // A last sliver is taken together with the step before it.
            let last = self.width >= remaining * (1.0 - 1e-12);
            let width = if last { remaining } else { self.width };
            self.latest = self.latest.max(self.time + width);
            fill!(self, width, stages, rhs, 1 2 3 4 5 6 7 8 9 10 11 12);
            let error = self.error(width, &stages);
            // err^(−1/8)
            let growth = if error == 0.0 { 10.0 } else { 0.8 / error.sqrt().sqrt().sqrt() };
            if (error.is_nan() || error > 1.0) && width > self.narrowest {
                self.width = (width * growth.max(0.2)).max(self.narrowest);
                rejected = true;
                continue;
            }
            let growth = growth.clamp(0.2, if rejected { 1.0 } else { 10.0 });
            if !last || growth < 1.0 {
                self.width = width * growth;
            }
            fill!(self, width, stages, rhs, 13 14 15);
            let step = Step::new(self.time, width, self.state, &stages);
            self.state += step.terms[0];
            self.slope = Some(stages[STAGES - 1]);
            self.time = if last { until } else { self.time + width };
            self.steps += 1;
            return step;
        }
    }

    /// The error of a step, in units of the tolerance.
    fn error(&self, width: f64, stages: &[f64; DENSE_STAGES]) -> f64 {
        let [fifth, third, slope] = [weighted(E5, stages), weighted(E3, stages), stages[STAGES - 1]]
            .map(|part| (part / self.tolerance).powi(2));
        if fifth == 0.0 && third == 0.0 {
            return 0.0;
        }
        combined(width.abs(), fifth, third, slope, 1.0)
    }
}

#[inline(always)]
fn weighted(weights: &[(usize, f64)], stages: &[f64; DENSE_STAGES]) -> f64 {
    weights.iter().map(|&(stage, weight)| weight * stages[stage]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of fixed-width steps over ẏ = −y², y(0) = 1, at the step ends and inside the steps.
    fn errors(steps: u32) -> (f64, f64) {
        let width = 2.0 / f64::from(steps);
        let mut solver = Dop853::new(1.0, f64::INFINITY, width);
        let (mut ends, mut inside) = (0.0f64, 0.0f64);
        let exact = |t: f64| 1.0 / (1.0 + t);
        for i in 1..=steps {
            let step = solver.step(width * f64::from(i), |_, y| -y * y);
            ends = ends.max((solver.state - exact(solver.time)).abs());
            for part in [0.25, 0.5, 0.75] {
                let t = width * (f64::from(i) - part);
                inside = inside.max((step.at(t) - exact(t)).abs());
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
}
