//! One equation of many numbers, of which each is moved by the one before it.

use fearless_simd::{Simd, SimdBase, f64x8};

use super::tableau::{A, C, D, E3, E5};
use super::{DENSE_STAGES, STAGES, combined};

/// Numbers in one vector, and room before the first one for what moves it.
pub(crate) const WIDTH: usize = 8;

/// Dormand–Prince 8(5,3) with dense output for a chain: number i is moved by number i − 1 alone, the first one from outside.
///
/// Numbers stand from index [`WIDTH`] on, the one that moves the first at `WIDTH − 1`. Only the first [`active`](Self::active) numbers are
/// followed; the rest has not been reached yet and stays as it is.
#[derive(Debug)]
pub(crate) struct Column {
    pub(crate) state: Vec<f64>,
    /// Numbers that are followed, a multiple of [`WIDTH`].
    pub(crate) active: usize,
    len: usize,
    time: f64,
    width: f64,
    narrowest: f64,
    tolerance: f64,
    has_slope: bool,
    stages: Vec<f64>,
    point: Vec<f64>,
    before: Vec<f64>,
    /// Start and width of the last step.
    last: (f64, f64),
    /// Accepted steps.
    pub(crate) steps: u64,
    /// Evaluations of the right-hand side.
    pub(crate) evaluations: u64,
}

/// Numbers that go through all stages of a step before the next ones do: what they need stays in the nearest cache.
const TILE: usize = 128;

/// The right-hand side: time, state (with the number before the first at `WIDTH − 1`, which it has to set), slopes.
pub(crate) trait Slopes<S: Simd> {
    /// Fills the slopes of the indices from `range.0` up to `range.1`.
    fn fill(&self, simd: S, time: f64, state: &mut [f64], slopes: &mut [f64], range: (usize, usize));

    /// Whether the last of the active numbers has begun to move its neighbour.
    fn passes_on(&self, last: f64) -> bool;
}

impl Column {
    /// `len` numbers at 0, errors kept below `tolerance` a step.
    pub(crate) fn new(len: usize, tolerance: f64) -> Self {
        let room = WIDTH + len.next_multiple_of(WIDTH);
        Self {
            state: vec![0.0; room],
            active: WIDTH.min(len.next_multiple_of(WIDTH)),
            len,
            time: 0.0,
            width: 0.0,
            narrowest: 0.0,
            tolerance,
            has_slope: false,
            stages: vec![0.0; DENSE_STAGES * room],
            point: vec![0.0; room],
            before: vec![0.0; room],
            last: (0.0, 0.0),
            steps: 0,
            evaluations: 0,
        }
    }

    /// Starts from other numbers than 0, all of them followed.
    pub(crate) fn start_at(&mut self, numbers: impl Iterator<Item = f64>) {
        self.state[WIDTH..].iter_mut().zip(numbers).for_each(|(slot, number)| *slot = number);
        self.active = self.len.next_multiple_of(WIDTH);
    }

    /// The numbers.
    pub(crate) fn numbers(&self) -> &[f64] {
        &self.state[WIDTH..WIDTH + self.len]
    }

    pub(crate) fn time(&self) -> f64 {
        self.time
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
        let room = self.state.len();
        let mut rejected = false;
        loop {
            if !self.has_slope {
                let range = (WIDTH, WIDTH + self.active);
                rhs.fill(simd, self.time, &mut self.state, &mut self.stages[..room], range);
                self.evaluations += 1;
                self.has_slope = true;
            }
            let remaining = until - self.time;
            // A last sliver is taken together with the step before it.
            let is_last = self.width >= remaining * (1.0 - 1e-12);
            let width = if is_last { remaining } else { self.width };
            let (mut squares, mut edge) = ([[0.0; WIDTH]; 3], [0.0; STAGES]);
            let end = WIDTH + self.active;
            for from in (WIDTH..end).step_by(TILE) {
                let until = (from + TILE).min(end);
                for (stage, edge) in edge.iter_mut().enumerate().skip(1) {
                    // What moves the first number of a tile is the last one of the tile before, at this stage.
                    let before = std::mem::replace(&mut self.point[from - 1], *edge);
                    self.stage(simd, stage, width, rhs, (from, until));
                    if stage < STAGES - 1 && from > WIDTH {
                        self.point[from - 1] = before;
                    }
                    *edge = self.point[until - 1];
                }
                self.estimate(simd, (from, until), &mut squares);
            }
            self.evaluations += STAGES as u64 - 1;
            let most = self.state.len() - WIDTH;
            if self.active < most && rhs.passes_on(self.point[WIDTH + self.active - 1]) {
                self.active = (self.active + WIDTH).min(most);
                self.has_slope = false;
                continue;
            }
            let error = self.error(width, &squares);
            let growth = if error == 0.0 { 10.0 } else { 0.8 * error.powf(-0.125) };
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
            self.stage(simd, stage, self.last.1, rhs, (WIDTH, WIDTH + self.active));
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

    /// The numbers at `time` inside the last step.
    #[inline(always)]
    pub(crate) fn at<S: Simd>(&self, simd: S, time: f64, out: &mut Vec<f64>) {
        let (room, (start, width)) = (self.state.len(), self.last);
        let x = (time - start) / width;
        let splat = |value: f64| f64x8::splat(simd, value);
        out.clear();
        out.resize(room, 0.0);
        out.copy_from_slice(&self.state);
        for at in (WIDTH..WIDTH + self.active).step_by(WIDTH) {
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
        out.drain(..WIDTH);
        out.truncate(self.len);
    }

    #[inline(always)]
    fn stage<S: Simd>(&mut self, simd: S, stage: usize, width: f64, rhs: &impl Slopes<S>, range: (usize, usize)) {
        let room = self.state.len();
        let (known, new) = self.stages.split_at_mut(stage * room);
        let (state, point) = (&self.state, &mut self.point);
        sums_of_any(
            simd,
            A[stage],
            (known, room),
            range,
            #[inline(always)]
            |at, sum| {
                let from = f64x8::from_slice(simd, &state[at..at + WIDTH]);
                (from + f64x8::splat(simd, width) * sum).store_slice(&mut point[at..at + WIDTH]);
            },
        );
        let time = self.time + C[stage] * width;
        rhs.fill(simd, time, &mut self.point, &mut new[..room], range);
    }

    /// Adds the squares of both estimates and of the slope at the end, in units of the tolerance.
    #[inline(always)]
    fn estimate<S: Simd>(&self, simd: S, range: (usize, usize), squares: &mut [[f64; WIDTH]; 3]) {
        let scale = f64x8::splat(simd, 1.0 / self.tolerance);
        for (squares, terms) in squares.iter_mut().zip([E5, E3]) {
            let mut total = f64x8::from_slice(simd, squares);
            sums::<S, ESTIMATE>(
                simd,
                terms,
                (&self.stages, self.state.len()),
                range,
                #[inline(always)]
                |_, sum| {
                    let estimate = sum * scale;
                    total += estimate * estimate;
                },
            );
            total.store_slice(squares);
        }
        let last = &self.stages[(STAGES - 1) * self.state.len()..];
        let mut total = f64x8::from_slice(simd, &squares[2]);
        for slope in last[range.0..range.1].chunks_exact(WIDTH) {
            let slope = f64x8::from_slice(simd, slope) * scale;
            total += slope * slope;
        }
        total.store_slice(&mut squares[2]);
    }

    /// The error of a step, in units of the tolerance.
    fn error(&self, width: f64, squares: &[[f64; WIDTH]; 3]) -> f64 {
        let [fifth, third, slope] = squares.map(|squares| squares.iter().sum::<f64>());
        if fifth == 0.0 && third == 0.0 {
            return 0.0;
        }
        combined(width.abs(), fifth, third, slope, self.len as f64)
    }
}

/// Calls `use_sum` with every eighth index from `from` up to `until` and the Σ weight · stage of the eight numbers there.
///
/// The number of terms is a constant of the loop: with weights in registers and nothing to decide it runs four times as fast.
#[inline(always)]
pub(super) fn sums<S: Simd, const N: usize>(
    simd: S,
    terms: &[(usize, f64)],
    (stages, room): (&[f64], usize),
    (from, until): (usize, usize),
    mut use_sum: impl FnMut(usize, f64x8<S>),
) {
    let weights: [f64x8<S>; N] = std::array::from_fn(|term| f64x8::splat(simd, terms[term].1));
    let columns: [&[[f64; WIDTH]]; N] = std::array::from_fn(|term| {
        let column = terms[term].0 * room;
        stages[column + from..column + until].as_chunks().0
    });
    for (block, first) in columns[0].iter().enumerate() {
        let mut sum = weights[0] * f64x8::from_slice(simd, first);
        for term in 1..N {
            sum += weights[term] * f64x8::from_slice(simd, &columns[term][block]);
        }
        use_sum(from + WIDTH * block, sum);
    }
}

/// [`sums`] for the rows of the tableau, which have one to twelve terms.
#[inline(always)]
pub(super) fn sums_of_any<S: Simd>(
    simd: S,
    terms: &[(usize, f64)],
    stages: (&[f64], usize),
    range: (usize, usize),
    use_sum: impl FnMut(usize, f64x8<S>),
) {
    match terms.len() {
        1 => sums::<S, 1>(simd, terms, stages, range, use_sum),
        2 => sums::<S, 2>(simd, terms, stages, range, use_sum),
        3 => sums::<S, 3>(simd, terms, stages, range, use_sum),
        4 => sums::<S, 4>(simd, terms, stages, range, use_sum),
        5 => sums::<S, 5>(simd, terms, stages, range, use_sum),
        6 => sums::<S, 6>(simd, terms, stages, range, use_sum),
        7 => sums::<S, 7>(simd, terms, stages, range, use_sum),
        8 => sums::<S, 8>(simd, terms, stages, range, use_sum),
        9 => sums::<S, 9>(simd, terms, stages, range, use_sum),
        10 => sums::<S, 10>(simd, terms, stages, range, use_sum),
        _ => sums::<S, 12>(simd, terms, stages, range, use_sum),
    }
}

/// Terms of an error estimate.
pub(super) const ESTIMATE: usize = 8;
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
        fn fill(&self, _: S, time: f64, state: &mut [f64], slopes: &mut [f64], (from, until): (usize, usize)) {
            if from == WIDTH {
                state[WIDTH - 1] = (-time).exp();
            }
            for at in from..until {
                slopes[at] = state[at - 1] - state[at];
            }
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
        let mut column = Column::new(6, f64::INFINITY);
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
            ends = ends.max(off(column.numbers(), column.time()));
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
