//! Columns laid side by side, sample after sample, for recursions that wait for their own last step: all columns together take as long
//! as one.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::filter::{LANES, MarkovStep, Noises};
use crate::vector::level;

/// The columns of a fit, as many at a time as a vector holds; those beyond the last are zero.
pub(crate) struct Rows {
    columns: usize,
    pub(crate) samples: usize,
    blocks: Vec<Vec<[f64; LANES]>>,
}

impl Rows {
    pub(crate) fn new(columns: &[&[f64]]) -> Self {
        let samples = columns.first().map_or(0, |column| column.len());
        let block = |columns: &[&[f64]]| {
            let mut rows = vec![[0.0; LANES]; samples];
            for (lane, column) in columns.iter().enumerate() {
                for (row, entry) in rows.iter_mut().zip(*column) {
                    row[lane] = *entry;
                }
            }
            rows
        };
        Self {
            columns: columns.len(),
            samples,
            blocks: columns.chunks(LANES).map(block).collect(),
        }
    }

    /// ZᵀF with F_i = ρ (F_{i−1} + Z_{i−1}).
    pub(crate) fn with_sums_before(&self, rho: f64) -> Vec<f64> {
        self.tiled(|left, right| {
            dispatch!(level(), simd => {
                let rho = f64x8::splat(simd, rho);
                let mut before = f64x8::splat(simd, 0.0);
                products(simd, left, right, #[inline(always)] |left, right| {
                    let now = before;
                    before = rho * (now + right);
                    [left, now]
                })
            })
        })
    }

    /// WᵀW with W the columns whitened by these steps, the last of them for all that follow.
    pub(super) fn filtered(&self, steps: &[MarkovStep]) -> Vec<f64> {
        let last = steps.len() - 1;
        self.tiled(|left, right| {
            dispatch!(level(), simd => {
                let (mut expected, mut at) = ([f64x8::splat(simd, 0.0); 2], 0);
                products(simd, left, right, #[inline(always)] |left, right| {
                    let MarkovStep { root, gain, kept } = &steps[at.min(last)];
                    at += 1;
                    let new = [left - expected[0], right - expected[1]];
                    for side in 0..2 {
                        expected[side] = (expected[side] + new[side] * *gain) * *kept;
                    }
                    new.map(|new| new * *root)
                })
            })
        })
    }

    /// ZᵀF with F_i = Σ_k cov(x_i, x_k) Z_k over the samples k before, and half of that with itself.
    pub(crate) fn with_process_before(&self, left_over: &[f64], variances: &[f64]) -> Vec<f64> {
        self.tiled(|left, right| {
            dispatch!(level(), simd => {
                let (mut before, mut at) = (f64x8::splat(simd, 0.0), left_over.iter().zip(variances));
                products(simd, left, right, #[inline(always)] |left, right| {
                    let Some((kept, variance)) = at.next() else { return [left * 0.0; 2] };
                    let earlier = before * *kept;
                    let own = right * *variance;
                    before = earlier + own;
                    [left, earlier + own * 0.5]
                })
            })
        })
    }

    /// For white noise beside a walk, of [`LANES`] sizes side by side: WᵀW, row-major, with W the columns as Kalman's filter whitens them, and
    /// ln |R|. A step has a variance of `squares` of the white one; `since` are the mean steps from the first sample to each.
    pub(super) fn beside_walks(&self, squares: &[f64; LANES], since: &[f64]) -> [(Vec<f64>, f64); LANES] {
        dispatch!(level(), simd => self.beside_walks_with(simd, squares, since))
    }

    #[inline(always)]
    fn beside_walks_with<S: Simd>(&self, simd: S, squares: &[f64; LANES], since: &[f64]) -> [(Vec<f64>, f64); LANES] {
        let nothing = f64x8::splat(simd, 0.0);
        // The columns of most fits: so many sums stay in registers.
        match self.columns {
            4 => self.walk_sums(simd, 4, &mut [nothing; 4 * 6], squares, since),
            5 => self.walk_sums(simd, 5, &mut [nothing; 5 * 7], squares, since),
            6 => self.walk_sums(simd, 6, &mut [nothing; 6 * 8], squares, since),
            size => self.walk_sums(simd, size, &mut vec![nothing; size * (size + 2)], squares, since),
        }
    }

    /// The same of `size` columns, with zeros in `room` for the products, what is expected and what weighs.
    #[inline(always)]
    fn walk_sums<S: Simd>(
        &self,
        simd: S,
        size: usize,
        room: &mut [f64x8<S>],
        squares: &[f64; LANES],
        since: &[f64],
    ) -> [(Vec<f64>, f64); LANES] {
        let (products, rest) = room.split_at_mut(size * size);
        let (expected, weighed) = rest.split_at_mut(size);
        let (squares, one) = (f64x8::from_slice(simd, squares), f64x8::splat(simd, 1.0));
        let (mut log_determinants, mut determinants) = ([0.0; LANES], one);
        let mut ahead = squares * since[0];
        for (index, now) in since.iter().enumerate() {
            let innovation = ahead + one;
            let weight = one / innovation;
            let gain = ahead * weight;
            for row in 0..size {
                let new = f64x8::splat(simd, self.blocks[row / LANES][index][row % LANES]) - expected[row];
                expected[row] += new * gain;
                weighed[row] = new * weight;
                for column in 0..=row {
                    products[row * size + column] += new * weighed[column];
                }
            }
            determinants *= innovation;
            // One logarithm for many factors.
            let so_far: [f64; LANES] = determinants.into();
            if index + 1 == since.len() || so_far.iter().any(|factor| *factor > 1e100) {
                log_determinants.iter_mut().zip(so_far).for_each(|(sum, factor)| *sum += factor.ln());
                determinants = one;
            }
            let added = since.get(index + 1).map_or(0.0, |next| (next - now).max(0.0));
            ahead = ahead * (one - gain) + squares * added;
        }
        unpacked(products, size, &log_determinants)
    }

    /// WᵀW, row-major, with W the columns whitened by Kalman's filters of noises side by side, which begin anew every `length` samples, and ln |R|.
    pub(super) fn whitened<const P: usize>(&self, noises: &Noises<P>, length: usize) -> [(Vec<f64>, f64); LANES] {
        dispatch!(level(), simd => self.whitened_with(simd, noises, length))
    }

    #[inline(always)]
    fn whitened_with<S: Simd, const P: usize>(
        &self,
        simd: S,
        noises: &Noises<P>,
        length: usize,
    ) -> [(Vec<f64>, f64); LANES] {
        let nothing = f64x8::splat(simd, 0.0);
        let (size, series) = (self.columns, self.samples / length);
        let mut filter = noises.begun(simd);
        let (mut products, mut weighed) = (vec![nothing; size * size], vec![nothing; size]);
        // What is expected of each column in each series, and its parts.
        let mut columns = vec![(nothing, [nothing; P]); size * series];
        for index in 0..length {
            for (place, columns) in columns.chunks_exact_mut(size).enumerate() {
                let at = place * length + index;
                for (row, (expected, parts)) in columns.iter_mut().enumerate() {
                    let new = f64x8::splat(simd, self.blocks[row / LANES][at][row % LANES]) - *expected;
                    weighed[row] = new * filter.weight;
                    *expected = nothing;
                    for ((part, gain), kept) in parts.iter_mut().zip(filter.gains).zip(filter.kept) {
                        *part = (*part + new * gain) * kept;
                        *expected += *part;
                    }
                    for (product, weighed) in products[row * size..].iter_mut().zip(&weighed[..=row]) {
                        *product += new * *weighed;
                    }
                }
            }
            filter.go_on();
        }
        let log_determinants = filter.log_determinants().map(|of_one| series as f64 * of_one);
        unpacked(&products, size, &log_determinants)
    }

    /// All products, row-major, from those of every two blocks.
    fn tiled(&self, products: impl Fn(&[[f64; LANES]], &[[f64; LANES]]) -> [[f64; LANES]; LANES]) -> Vec<f64> {
        let size = self.columns;
        let mut all = vec![0.0; size * size];
        for (a, left) in self.blocks.iter().enumerate() {
            for (b, right) in self.blocks.iter().enumerate() {
                let rows = all[a * LANES * size..].chunks_exact_mut(size);
                for (row, tile) in rows.zip(products(left, right)) {
                    let row = &mut row[b * LANES..];
                    let count = row.len().min(LANES);
                    row[..count].copy_from_slice(&tile[..count]);
                }
            }
        }
        all
    }
}

/// Symmetric matrices side by side of which the lower half is there, each with a number.
#[inline(always)]
fn unpacked<S: Simd>(products: &[f64x8<S>], size: usize, numbers: &[f64; LANES]) -> [(Vec<f64>, f64); LANES] {
    let products: Vec<[f64; LANES]> = products.iter().map(|sum| (*sum).into()).collect();
    std::array::from_fn(|lane| {
        let entry = |at: usize| {
            let (row, column) = (at / size, at % size);
            products[row.max(column) * size + row.min(column)][lane]
        };
        ((0..size * size).map(entry).collect(), numbers[lane])
    })
}

/// Σ over the samples of the outer product of two vectors that `step` makes of those of two blocks.
#[inline(always)]
fn products<S: Simd>(
    simd: S,
    left: &[[f64; LANES]],
    right: &[[f64; LANES]],
    mut step: impl FnMut(f64x8<S>, f64x8<S>) -> [f64x8<S>; 2],
) -> [[f64; LANES]; LANES] {
    let mut sums = [f64x8::splat(simd, 0.0); LANES];
    for (left, right) in left.iter().zip(right) {
        let [left, right] = step(f64x8::from_slice(simd, left), f64x8::from_slice(simd, right));
        let factors: [f64; LANES] = left.into();
        for lane in 0..LANES {
            sums[lane] += right * factors[lane];
        }
    }
    sums.map(Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::Cholesky;
    use crate::statistics::dot;

    const COUNT: usize = 50;

    fn columns(count: usize) -> Vec<Vec<f64>> {
        let entry = |column: usize, i: usize| ((i * i * 31 + i * (2 * column + 7)) % 101) as f64 / 50.0 - 1.0;
        (0..count).map(|column| (0..COUNT).map(|i| entry(column, i)).collect()).collect()
    }

    /// ZᵀR⁻¹Z and ln |R| by whole matrices, for series of `length` samples.
    fn whole(all: &[Vec<f64>], parts: &[(f64, f64)], length: usize) -> (Vec<f64>, f64) {
        let white = 1.0 - parts.iter().map(|(share, _)| share).sum::<f64>();
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            _ if i / length != j / length => 0.0,
            0 => 1.0,
            lag => parts.iter().map(|(share, rho)| share * rho.powi(lag as i32)).sum(),
        };
        assert!(white >= 0.0);
        let matrix: Vec<f64> = (0..COUNT * COUNT).map(|at| entry(at / COUNT, at % COUNT)).collect();
        let factor = Cholesky::new(&matrix, COUNT).unwrap();
        let solved: Vec<Vec<f64>> = all
            .iter()
            .map(|column| {
                let mut solved = column.clone();
                factor.solve(&mut solved);
                solved
            })
            .collect();
        let product = all.iter().flat_map(|one| solved.iter().map(|other| dot(one, other)));
        (product.collect(), factor.log_determinant())
    }

    #[test]
    fn side_by_side_is_one_after_the_other() {
        const NOISES: [&[(f64, f64)]; 3] = [&[(0.6, 0.8)], &[(0.6, 0.8), (0.2, 0.99)], &[(1.0, 0.9)]];
        for count in [1, 3, 8, 9, 17, 30] {
            let all = columns(count);
            let slices: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
            let rows = Rows::new(&slices);
            for length in [COUNT, COUNT / 2] {
                let several = rows.whitened(&Noises::<3>::new(&NOISES), length);
                let [alone, ..] = rows.whitened(&Noises::<1>::new(&NOISES[..1]), length);
                let found = several.iter().zip(NOISES).chain([(&alone, NOISES[0])]);
                for ((products, log_determinant), parts) in found {
                    let (expected, of_whole) = whole(&all, parts, length);
                    let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-11 * (1.0 + b.abs());
                    assert!(products.iter().zip(&expected).all(close), "{count} {length} {parts:?}");
                    assert!((log_determinant - of_whole).abs() < 1e-11, "{log_determinant} {of_whole}");
                }
            }
            let before = |column: &Vec<f64>| {
                let mut sum = 0.0;
                let mut step = |entry: &f64| {
                    let now = sum;
                    sum = 0.8 * (now + entry);
                    now
                };
                column.iter().map(&mut step).collect::<Vec<f64>>()
            };
            let sums: Vec<Vec<f64>> = all.iter().map(before).collect();
            let across = rows.with_sums_before(0.8);
            for i in 0..count {
                for j in 0..count {
                    assert!((across[i * count + j] - dot(&all[i], &sums[j])).abs() < 1e-12);
                }
            }
        }
        assert!(Rows::new(&[]).with_sums_before(0.8).is_empty());
    }
}
