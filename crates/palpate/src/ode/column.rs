//! One equation of many numbers, of which each is moved by the one before it.

use fearless_simd::{Simd, SimdBase, f64x8};

use crate::vector::Aligned;

use super::{A, C, D, DENSE_STAGES, E3, E5, STAGES, combined};

/// Numbers in one vector.
pub(crate) const WIDTH: usize = 8;

/// Dormand–Prince 8(5,3) with dense output for a chain: number i is moved by number i − 1 alone, the first one from outside.
///
/// Only the first [`active`](Self::active) numbers are followed; the rest has not been reached yet and stays as it is.
#[derive(Debug, Default)]
pub(crate) struct Column {
    pub(crate) state: Aligned,
    /// Numbers that are followed, a multiple of [`WIDTH`].
    pub(crate) active: usize,
    len: usize,
    /// Numbers that share the tolerance: these, and those of other columns.
    sharers: f64,
    pub(crate) time: f64,
    width: f64,
    narrowest: f64,
    tolerance: f64,
    has_slope: bool,
    stages: Aligned,
    point: Aligned,
    before: Aligned,
    /// Start and width of the last step.
    last: (f64, f64),
    /// Accepted steps.
    pub(crate) steps: u64,
    /// Evaluations of the right-hand side.
    pub(crate) evaluations: u64,
}

/// The right-hand side.
pub(crate) trait Slopes<S: Simd> {
    /// What moves the first number, at `time`; `first` is that number then.
    fn input(&self, time: f64, first: f64) -> f64;

    /// Slopes of the eight numbers from index `at` on, each beside the one that moves it.
    fn of(&self, simd: S, at: usize, movers: f64x8<S>, numbers: f64x8<S>) -> f64x8<S>;

    /// Whether the last of the active numbers has begun to move its neighbour.
    fn passes_on(&self, last: f64) -> bool;
}

impl Column {
    /// `len` numbers at 0. The root of the mean square of the errors of a step, over these and others that make `sharers` together, is kept below
    /// `tolerance`.
    pub(crate) fn new(len: usize, sharers: usize, tolerance: f64) -> Self {
        let room = len.next_multiple_of(WIDTH);
        Self {
            state: Aligned::zeros(room),
            active: WIDTH.min(room),
            len,
            sharers: sharers as f64,
            tolerance,
            stages: Aligned::zeros(DENSE_STAGES * room),
            point: Aligned::zeros(room),
            before: Aligned::zeros(room),
            ..Self::default()
        }
    }

    /// Starts from other numbers than 0, all of them followed.
    pub(crate) fn start_at(&mut self, numbers: impl Iterator<Item = f64>) {
        self.state.iter_mut().zip(numbers).for_each(|(slot, number)| *slot = number);
        self.active = self.state.len();
    }

    /// The numbers.
    pub(crate) fn numbers(&self) -> &[f64] {
        &self.state[..self.len]
    }

    /// Whether all numbers are followed.
    pub(crate) fn is_valid(&self) -> bool {
        self.active == self.state.len()
    }

    /// Sets the clock to 0 and the next step to `width`.
    pub(crate) fn restart(&mut self, width: f64) {
        self.time = 0.0;
        self.width = width;
        self.narrowest = width * 1e-12;
        self.has_slope = false;
    }

    /// Takes one step towards `until`, not beyond it.
    #[inline(always)]
    pub(crate) fn step<S: Simd>(&mut self, simd: S, until: f64, rhs: &impl Slopes<S>) {
        let mut rejected = false;
        loop {
            if !self.has_slope {
                self.first_stage(simd, rhs);
                self.evaluations += 1;
                self.has_slope = true;
            }
            let remaining = until - self.time;
            // A last sliver is taken together with the step before it.
            let is_last = self.width >= remaining * (1.0 - 1e-12);
            let width = if is_last { remaining } else { self.width };
            for stage in 1..STAGES {
                self.stage(simd, stage, width, rhs);
            }
            self.evaluations += STAGES as u64 - 1;
            if !self.is_valid() && rhs.passes_on(self.point[self.active - 1]) {
                self.active += WIDTH;
                self.has_slope = false;
                continue;
            }
            let error = self.error(simd, width);
            // err^(−1/8)
            let growth = if error == 0.0 { 10.0 } else { 0.8 / error.sqrt().sqrt().sqrt() };
            if (error.is_nan() || error > 1.0) && width > self.narrowest {
                self.width = (width * growth.max(0.2)).max(self.narrowest);
                rejected = true;
                continue;
            }
            let growth = growth.clamp(0.2, if rejected { 1.0 } else { 10.0 });
            if !is_last || growth < 1.0 {
                self.width = width * growth;
            }
            self.last = (self.time, width);
            self.before.copy_from_slice(&self.state);
            self.state.copy_from_slice(&self.point);
            // The slope at the end is that at the start of the next step; the first one is kept for the dense output.
            self.time = if is_last { until } else { self.time + width };
            self.steps += 1;
            return;
        }
    }

    /// Makes the last step ready to be looked into; the next [`step`](Self::step) has to follow [`leave`](Self::leave).
    #[inline(always)]
    pub(crate) fn look<S: Simd>(&mut self, simd: S, rhs: &impl Slopes<S>) {
        std::mem::swap(&mut self.state, &mut self.before);
        let time = std::mem::replace(&mut self.time, self.last.0);
        for stage in STAGES..DENSE_STAGES {
            self.stage(simd, stage, self.last.1, rhs);
        }
        self.evaluations += (DENSE_STAGES - STAGES) as u64;
        self.time = time;
        std::mem::swap(&mut self.state, &mut self.before);
    }

    /// The slope at the end of the last step becomes that at the start of the next.
    pub(crate) fn leave(&mut self) {
        let room = self.state.len();
        self.stages.copy_within((STAGES - 1) * room..STAGES * room, 0);
    }

    /// Time, value and slope of the last number at both ends of the last step, before [`leave`](Self::leave).
    pub(crate) fn ends_of_last(&self) -> [(f64, f64, f64); 2] {
        let (room, at) = (self.state.len(), self.len - 1);
        let slope = |stage: usize| self.stages[stage * room + at];
        [(self.last.0, self.before[at], slope(0)), (self.time, self.state[at], slope(STAGES - 1))]
    }

    /// Makes the next step no wider than `width`.
    pub(crate) fn cap(&mut self, width: f64) {
        self.width = self.width.min(width);
    }

    /// The numbers at `time` inside the last step.
    #[inline(always)]
    pub(crate) fn at<S: Simd>(&self, simd: S, time: f64, out: &mut Vec<f64>) {
        let (room, (start, width)) = (self.state.len(), self.last);
        let x = (time - start) / width;
        let splat = |value: f64| f64x8::splat(simd, value);
        out.clear();
        out.resize(room, 0.0);
        out.copy_from_slice(&self.state);
        for at in (0..self.active).step_by(WIDTH) {
            let read = |column: &[f64]| f64x8::from_slice(simd, &column[at..at + WIDTH]);
            let from = read(&self.before);
            let change = read(&self.state) - from;
            let (first, last) = (read(&self.stages), read(&self.stages[(STAGES - 1) * room..]));
            let spline = splat(width) * first - change;
            let twist = splat(2.0) * change - splat(width) * (last + first);
            let mut y = f64x8::splat(simd, 0.0);
            for (order, row) in D.iter().rev().enumerate() {
                let term = splat(width) * weighted(simd, row, &self.stages, room, at);
                y = (y + term) * splat(if order % 2 == 0 { x } else { 1.0 - x });
            }
            y = (y + twist) * splat(x);
            y = (y + spline) * splat(1.0 - x);
            y = (y + change) * splat(x);
            (from + y).store_slice(&mut out[at..at + WIDTH]);
        }
        out.truncate(self.len);
    }

    /// Calls `look` with every eighth index, the eight numbers that move those from there on, and those numbers; `input` makes what moves the
    /// first number of it.
    #[inline(always)]
    pub(crate) fn scan<S: Simd>(
        &self,
        simd: S,
        input: impl FnOnce(f64) -> f64,
        mut look: impl FnMut(usize, f64x8<S>, f64x8<S>),
    ) {
        let Some(&first) = self.state.first() else { return };
        let mut before = f64x8::splat(simd, input(first));
        for at in (0..self.active).step_by(WIDTH) {
            let numbers = f64x8::from_slice(simd, &self.state[at..at + WIDTH]);
            look(at, before.slide::<7>(numbers), numbers);
            before = numbers;
        }
    }

    #[inline(always)]
    fn first_stage<S: Simd>(&mut self, simd: S, rhs: &impl Slopes<S>) {
        let mut slopes = std::mem::take(&mut self.stages);
        self.scan(
            simd,
            |first| rhs.input(self.time, first),
            #[inline(always)]
            |at, movers, numbers| rhs.of(simd, at, movers, numbers).store_slice(&mut slopes[at..at + WIDTH]),
        );
        self.stages = slopes;
    }

    #[inline(always)]
    fn stage<S: Simd>(&mut self, simd: S, stage: usize, width: f64, rhs: &impl Slopes<S>) {
        let (room, active) = (self.state.len(), self.active);
        let (known, new) = self.stages.split_at_mut(stage * room);
        let (state, point, new) = (&self.state[..active], &mut self.point[..active], &mut new[..active]);
        let (time, width) = (self.time + C[stage] * width, f64x8::splat(simd, width));
        let mut before = f64x8::splat(simd, 0.0);
        sums_of_any(
            simd,
            A[stage],
            (known, room),
            active,
            #[inline(always)]
            |at, sum| {
                let numbers = f64x8::from_slice(simd, &state[at..at + WIDTH]) + width * sum;
                numbers.store_slice(&mut point[at..at + WIDTH]);
                if at == 0 {
                    before = f64x8::splat(simd, rhs.input(time, point[0]));
                }
                rhs.of(simd, at, before.slide::<7>(numbers), numbers).store_slice(&mut new[at..at + WIDTH]);
                before = numbers;
            },
        );
    }

    /// The error of a step, in units of the tolerance.
    #[inline(always)]
    fn error<S: Simd>(&self, simd: S, width: f64) -> f64 {
        let (room, scale) = (self.state.len(), f64x8::splat(simd, 1.0 / self.tolerance));
        let mut squares = [f64x8::splat(simd, 0.0); 3];
        for (squares, terms) in squares.iter_mut().zip([E5, E3]) {
            sums::<S, ESTIMATE>(
                simd,
                terms,
                (&self.stages, room),
                self.active,
                #[inline(always)]
                |_, sum| {
                    let estimate = sum * scale;
                    *squares += estimate * estimate;
                },
            );
        }
        let last = &self.stages[(STAGES - 1) * room..];
        for slope in last[..self.active].chunks_exact(WIDTH) {
            let slope = f64x8::from_slice(simd, slope) * scale;
            squares[2] += slope * slope;
        }
        let [fifth, third, slope] = [total_of(squares[0]), total_of(squares[1]), total_of(squares[2])];
        if fifth == 0.0 && third == 0.0 {
            return 0.0;
        }
        combined(width.abs(), fifth, third, slope, self.sharers)
    }
}

/// The sum of eight numbers.
#[inline(always)]
fn total_of<S: Simd>(numbers: f64x8<S>) -> f64 {
    let numbers: [f64; WIDTH] = numbers.into();
    numbers.iter().sum()
}

/// Calls `use_sum` with every eighth index below `count` and the Σ weight · stage of the eight numbers there.
///
/// The number of terms is a constant of the loop: with weights in registers and nothing to decide it runs four times as fast.
#[inline(always)]
fn sums<S: Simd, const N: usize>(
    simd: S,
    terms: &[(usize, f64)],
    (stages, room): (&[f64], usize),
    count: usize,
    mut use_sum: impl FnMut(usize, f64x8<S>),
) {
    let weights: [f64x8<S>; N] = std::array::from_fn(|term| f64x8::splat(simd, terms[term].1));
    let columns: [&[[f64; WIDTH]]; N] = std::array::from_fn(|term| {
        let column = terms[term].0 * room;
        stages[column..column + count].as_chunks().0
    });
    for (block, first) in columns[0].iter().enumerate() {
        let mut sum = weights[0] * f64x8::from_slice(simd, first);
        for term in 1..N {
            sum += weights[term] * f64x8::from_slice(simd, &columns[term][block]);
        }
        use_sum(WIDTH * block, sum);
    }
}

/// [`sums`] for the rows of the tableau, which have one to twelve terms.
#[inline(always)]
fn sums_of_any<S: Simd>(
    simd: S,
    terms: &[(usize, f64)],
    stages: (&[f64], usize),
    count: usize,
    use_sum: impl FnMut(usize, f64x8<S>),
) {
    match terms.len() {
        1 => sums::<S, 1>(simd, terms, stages, count, use_sum),
        2 => sums::<S, 2>(simd, terms, stages, count, use_sum),
        3 => sums::<S, 3>(simd, terms, stages, count, use_sum),
        4 => sums::<S, 4>(simd, terms, stages, count, use_sum),
        5 => sums::<S, 5>(simd, terms, stages, count, use_sum),
        6 => sums::<S, 6>(simd, terms, stages, count, use_sum),
        7 => sums::<S, 7>(simd, terms, stages, count, use_sum),
        8 => sums::<S, 8>(simd, terms, stages, count, use_sum),
        9 => sums::<S, 9>(simd, terms, stages, count, use_sum),
        10 => sums::<S, 10>(simd, terms, stages, count, use_sum),
        _ => sums::<S, 12>(simd, terms, stages, count, use_sum),
    }
}

/// Terms of an error estimate.
const ESTIMATE: usize = 8;
const _: () = assert!(E5.len() == ESTIMATE && E3.len() == ESTIMATE);

/// Σ weight · stage for eight numbers from `at` on.
#[inline(always)]
fn weighted<S: Simd>(simd: S, weights: &[(usize, f64)], stages: &[f64], room: usize, at: usize) -> f64x8<S> {
    let mut sum = f64x8::splat(simd, 0.0);
    for &(stage, weight) in weights {
        let from = stage * room + at;
        sum += f64x8::splat(simd, weight) * f64x8::from_slice(simd, &stages[from..from + WIDTH]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    /// ẏ_i = y_{i−1} − y_i behind y_0 = exp(−t): y_i = tⁱ/i! exp(−t).
    struct Queue;

    impl<S: Simd> Slopes<S> for Queue {
        fn input(&self, time: f64, _: f64) -> f64 {
            (-time).exp()
        }

        #[inline(always)]
        fn of(&self, _: S, _: usize, movers: f64x8<S>, numbers: f64x8<S>) -> f64x8<S> {
            movers - numbers
        }

        fn passes_on(&self, _: f64) -> bool {
            true
        }
    }

    /// Largest error at the end of steps of one width, and halfway through them, up to t = 3.
    fn errors(steps: u32) -> (f64, f64) {
        let width = 3.0 / f64::from(steps);
        let off = |numbers: &[f64], time: f64| {
            let mut exact = (-time).exp();
            let mut worst: f64 = 0.0;
            for (i, found) in numbers.iter().enumerate() {
                exact *= time / (i + 1) as f64;
                worst = worst.max((found - exact).abs());
            }
            worst
        };
        let mut column = Column::new(6, 6, f64::INFINITY);
        column.restart(width);
        let (mut ends, mut halfway, mut inside) = (0.0f64, 0.0f64, Vec::new());
        for step in 1..=steps {
            column.width = width;
            let end = width * f64::from(step);
            dispatch!(Level::new(), simd => {
                column.step(simd, end, &Queue);
                column.look(simd, &Queue);
                column.at(simd, end - 0.5 * width, &mut inside);
                column.leave();
            });
            ends = ends.max(off(column.numbers(), column.time));
            halfway = halfway.max(off(&inside, end - 0.5 * width));
        }
        (ends, halfway)
    }

    #[test]
    fn order_of_convergence_of_a_chain_is_eight_and_seven_between_steps() {
        let (coarse, fine) = (errors(6), errors(12));
        let (ends, halfway) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        println!("orders {ends:.2} and {halfway:.2}: {fine:?}");
        assert!((7.5..9.5).contains(&ends) && (6.7..9.5).contains(&halfway), "{ends} {halfway}");
    }
}
