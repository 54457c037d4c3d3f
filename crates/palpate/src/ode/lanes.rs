//! Many independent equations at once, each with steps of its own.

use fearless_simd::{Simd, SimdBase, f64x8};

use super::column::{ESTIMATE, WIDTH, sums, sums_of_any};
use super::tableau::{A, C, E3, E5};
use super::{STAGES, combined};

/// Dormand–Prince 8(5,3) for `L` systems of the same size side by side, `L` a multiple of eight.
///
/// Every lane has its own time, step and tolerance, and what it computes does not depend on its neighbours. Component c of lane l is
/// `state[c * L + l]`.
#[derive(Debug)]
pub(crate) struct Lanes<const L: usize> {
    pub(crate) state: Vec<f64>,
    pub(crate) time: [f64; L],
    pub(crate) width: [f64; L],
    /// Largest error of a step in every lane.
    pub(crate) tolerance: [f64; L],
    narrowest: [f64; L],
    /// Whether stage 0 holds the slope at `state`.
    has_slope: bool,
    stages: Vec<f64>,
    point: Vec<f64>,
    /// Steps accepted, all lanes together.
    pub(crate) steps: u64,
    /// Steps tried, all lanes together; each costs twelve evaluations.
    pub(crate) tried: u64,
}

impl<const L: usize> Lanes<L> {
    /// Room for `components` numbers a lane.
    pub(crate) fn new(components: usize) -> Self {
        let len = components * L;
        Self {
            state: vec![0.0; len],
            time: [0.0; L],
            width: [0.0; L],
            tolerance: [0.0; L],
            narrowest: [0.0; L],
            has_slope: false,
            stages: vec![0.0; STAGES * len],
            point: vec![0.0; len],
            steps: 0,
            tried: 0,
        }
    }

    /// Sets the clock of every lane to 0 and the first steps to `width`; call it after `state` or the right-hand side was changed.
    pub(crate) fn restart(&mut self, width: [f64; L]) {
        self.time = [0.0; L];
        self.width = width;
        self.narrowest = width.map(|width| width * 1e-12);
        self.has_slope = false;
    }

    /// Tries one step in every lane that is not at `until` yet, along ẏ = `rhs`(times, state, slopes).
    #[inline(always)]
    pub(crate) fn step<S: Simd>(&mut self, simd: S, until: &[f64; L], rhs: impl Fn(&[f64; L], &[f64], &mut [f64])) {
        let len = self.state.len();
        if !self.has_slope {
            rhs(&self.time, &self.state, &mut self.stages[..len]);
            self.has_slope = true;
        }
        let (mut width, mut remaining) = ([0.0; L], [0.0; L]);
        for lane in 0..L {
            let left = until[lane] - self.time[lane];
            let left = if left > 0.0 { left } else { 0.0 };
            // A last sliver is taken together with the step before it.
            let is_last = self.width[lane] >= left * (1.0 - 1e-12);
            remaining[lane] = left;
            width[lane] = if is_last { left } else { self.width[lane] };
        }
        for stage in 1..STAGES {
            self.advance(simd, &width, A[stage], stage);
            let mut time = [0.0; L];
            for lane in 0..L {
                time[lane] = self.time[lane] + C[stage] * width[lane];
            }
            let (_, after) = self.stages.split_at_mut(stage * len);
            rhs(&time, &self.point, &mut after[..len]);
        }
        let error = self.errors(simd, &width);
        let mut taken = [0.0; L];
        // No branch, and nothing that can panic: this loop becomes vector code.
        for lane in 0..L {
            let (width, error, narrowest) = (width[lane], error[lane], self.narrowest[lane]);
            // err^(−1/8)
            let growth = 0.8 / error.sqrt().sqrt().sqrt();
            let growth = if growth > 0.2 { growth } else { 0.2 };
            let is_good = (error <= 1.0) | (width <= narrowest);
            let most = if is_good { 10.0 } else { 0.9 };
            let next = width * if growth < most { growth } else { most };
            let next = if next > narrowest { next } else { narrowest };
            let is_last = width >= remaining[lane];
            // A step cut short by the end says nothing about a longer one.
            let keeps = (width == 0.0) | (is_good & is_last & (growth >= 1.0));
            self.width[lane] = if keeps { self.width[lane] } else { next };
            let reached = if is_last { until[lane] } else { self.time[lane] + width };
            let takes = is_good & (width > 0.0);
            self.time[lane] = if takes { reached } else { self.time[lane] };
            taken[lane] = if takes { 1.0 } else { 0.0 };
        }
        self.tried += width.iter().filter(|width| **width > 0.0).count() as u64;
        self.steps += taken.iter().filter(|taken| **taken > 0.0).count() as u64;
        self.accept(&taken);
    }

    /// `point` = state + width · Σ weight · stage.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, simd: S, width: &[f64; L], weights: &[(usize, f64)], before: usize) {
        let len = self.state.len();
        let stages = &self.stages[..before * len];
        let (state, point) = (&self.state, &mut self.point);
        sums_of_any(
            simd,
            weights,
            (stages, len),
            len,
            #[inline(always)]
            |at, sum| {
                let width = f64x8::from_slice(simd, &width[at % L..at % L + WIDTH]);
                let from = f64x8::from_slice(simd, &state[at..at + WIDTH]);
                (from + width * sum).store_slice(&mut point[at..at + WIDTH]);
            },
        );
    }

    /// The error of a step, in units of the tolerance.
    #[inline(always)]
    fn errors<S: Simd>(&self, simd: S, width: &[f64; L]) -> [f64; L] {
        let len = self.state.len();
        let (mut fifth, mut third) = ([0.0; L], [0.0; L]);
        for (squares, terms) in [(&mut fifth, E5), (&mut third, E3)] {
            let stages = (self.stages.as_slice(), len);
            sums::<S, ESTIMATE>(
                simd,
                terms,
                stages,
                len,
                #[inline(always)]
                |at, sum| {
                    let lane = at % L;
                    let estimate = sum / f64x8::from_slice(simd, &self.tolerance[lane..lane + WIDTH]);
                    let squares = &mut squares[lane..lane + WIDTH];
                    (f64x8::from_slice(simd, squares) + estimate * estimate).store_slice(squares);
                },
            );
        }
        let mut slope = [0.0; L];
        for last in self.stages[(STAGES - 1) * len..STAGES * len].chunks_exact(L) {
            for lane in 0..L {
                let last = last[lane] / self.tolerance[lane];
                slope[lane] += last * last;
            }
        }
        let components = (len / L) as f64;
        let mut error = [0.0; L];
        for lane in 0..L {
            error[lane] = combined(width[lane], fifth[lane], third[lane], slope[lane], components);
            error[lane] = if error[lane] < 1e-30 { 1e-30 } else { error[lane] };
        }
        error
    }

    /// Takes over the new state and its slope in the lanes marked with 1.
    #[inline(always)]
    fn accept(&mut self, taken: &[f64; L]) {
        let len = self.state.len();
        let (first, rest) = self.stages.split_at_mut(len);
        let last = &rest[(STAGES - 2) * len..];
        let blocks = self.state.chunks_exact_mut(L).zip(self.point.chunks_exact(L));
        let slopes = first.chunks_exact_mut(L).zip(last.chunks_exact(L));
        for ((state, point), (slope, next)) in blocks.zip(slopes) {
            for lane in 0..L {
                let takes = taken[lane] > 0.0;
                state[lane] = if takes { point[lane] } else { state[lane] };
                slope[lane] = if takes { next[lane] } else { slope[lane] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;

    /// Errors at t = 2 of ẏ = −rate y², y(0) = 1 with steps of fixed width, a rate each lane.
    fn errors(steps: u32) -> [f64; 8] {
        let rate: [f64; 8] = std::array::from_fn(|lane| 0.5 + 0.1 * lane as f64);
        let mut lanes = Lanes::<8>::new(1);
        lanes.state.fill(1.0);
        lanes.tolerance = [f64::INFINITY; 8];
        let width = 2.0 / f64::from(steps);
        for step in 1..=steps {
            lanes.width = [width; 8];
            let until = [width * f64::from(step); 8];
            dispatch!(Level::new(), simd => lanes.step(simd, &until, #[inline(always)] |_, y, out| {
                for lane in 0..8 {
                    out[lane] = -rate[lane] * y[lane] * y[lane];
                }
            }));
        }
        std::array::from_fn(|lane| (lanes.state[lane] - 1.0 / (1.0 + 2.0 * rate[lane])).abs())
    }

    #[test]
    fn order_of_convergence_is_eight_in_every_lane() {
        for (coarse, fine) in errors(8).into_iter().zip(errors(16)) {
            let order = (coarse / fine).log2();
            assert!((7.5..9.5).contains(&order), "order {order}: {coarse:e} {fine:e}");
        }
    }

    /// A lane goes the same way whatever the others do.
    #[test]
    fn lanes_do_not_feel_each_other() {
        let run = |rates: [f64; 8]| {
            let mut lanes = Lanes::<8>::new(2);
            lanes.state.fill(1.0);
            lanes.tolerance = [1e-10; 8];
            lanes.restart([0.1; 8]);
            let until = [3.0; 8];
            while lanes.time.iter().any(|time| *time < 3.0) {
                dispatch!(Level::new(), simd => lanes.step(simd, &until, #[inline(always)] |t, y, out| {
                    for lane in 0..8 {
                        out[lane] = -rates[lane] * y[lane];
                        out[8 + lane] = rates[lane] * (y[lane] - t[lane]);
                    }
                }));
            }
            lanes
        };
        let mut rates = [1.0; 8];
        let alike = run(rates);
        rates[3] = 40.0;
        let other = run(rates);
        assert_eq!(alike.state[..3], other.state[..3]);
        assert!((alike.state[0] - (-3.0f64).exp()).abs() < 1e-8);
        // ∫ (e^(−t) − t) from 0 to 3, on top of 1
        assert!((alike.state[8] - (1.0 + (1.0 - (-3.0f64).exp()) - 4.5)).abs() < 1e-8);
        assert!(other.tried > other.steps && other.steps > alike.steps);
    }
}
