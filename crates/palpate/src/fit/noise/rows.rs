//! Columns laid side by side, sample after sample, for recursions that wait for their own last step: all columns together take as long
//! as one.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::model::MOST_PARTS;
use crate::vector::{accelerated, level};

/// Columns in one vector.
const LANES: usize = 8;

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

    /// WᵀW with W the columns whitened by a filter, which begins anew every `length` samples.
    pub(crate) fn whitened(&self, filter: &Filter, length: usize) -> Vec<f64> {
        let last = filter.steps.len() - 1;
        self.tiled(|left, right| {
            dispatch!(level(), simd => {
                let nothing = f64x8::splat(simd, 0.0);
                let (mut states, mut expected, mut at) = ([[nothing; 2]; MOST_PARTS], [nothing; 2], 0);
                let count = filter.kept.len();
                products(simd, left, right, #[inline(always)] |left, right| {
                    if at == length {
                        (states, expected, at) = ([[nothing; 2]; MOST_PARTS], [nothing; 2], 0);
                    }
                    let Step { root, gains } = &filter.steps[at.min(last)];
                    at += 1;
                    let new = [left - expected[0], right - expected[1]];
                    expected = [nothing; 2];
                    for ((state, kept), gain) in states[..count].iter_mut().zip(&filter.kept).zip(gains) {
                        for side in 0..2 {
                            state[side] = (state[side] + new[side] * *gain) * *kept;
                            expected[side] += state[side];
                        }
                    }
                    new.map(|new| new * *root)
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
    pub(super) fn with_process_before(&self, left_over: &[f64], variances: &[f64]) -> Vec<f64> {
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
        let (size, squares, one) = (self.columns, f64x8::from_slice(simd, squares), f64x8::splat(simd, 1.0));
        let mut products = vec![f64x8::splat(simd, 0.0); size * size];
        let mut expected = vec![f64x8::splat(simd, 0.0); size];
        let (mut weighed, mut log_determinants, mut determinants) = (expected.clone(), [0.0; LANES], one);
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
        let products: Vec<[f64; LANES]> = products.into_iter().map(Into::into).collect();
        std::array::from_fn(|lane| {
            let entry = |at: usize| {
                let (row, column) = (at / size, at % size);
                products[row.max(column) * size + row.min(column)][lane]
            };
            ((0..size * size).map(entry).collect(), log_determinants[lane])
        })
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

/// Kalman's filter of white noise with AR(1) parts, as it takes a column: each part is expected to be what it was, and its gain of what
/// came beyond expectation, times its correlation; what came beyond counts times `root`.
pub(crate) struct Filter {
    /// The correlation of each part with itself a sample later.
    pub(crate) kept: Vec<f64>,
    /// Of the first samples; the last of them for all that follow.
    pub(crate) steps: Vec<Step>,
    /// ln |R|.
    pub(crate) log_determinant: f64,
}

/// What a filter does with one sample.
pub(crate) struct Step {
    pub(crate) root: f64,
    pub(crate) gains: [f64; MOST_PARTS],
}

impl Filter {
    /// The filter for parts, each with its share in the variance and its correlation a sample later; the rest is white.
    pub(crate) fn new(parts: &[(f64, f64)], samples: usize) -> Self {
        accelerated(
            #[inline(always)]
            || Self::settled(parts, samples),
        )
    }

    #[inline(always)]
    fn settled(parts: &[(f64, f64)], samples: usize) -> Self {
        let white = (1.0 - parts.iter().map(|(share, _)| share).sum::<f64>()).max(0.0);
        let of = |part: fn(&(f64, f64)) -> f64| -> [f64; MOST_PARTS] {
            std::array::from_fn(|index| parts.get(index).map_or(0.0, part))
        };
        let (shares, kept) = (of(|part| part.0), of(|part| part.1));
        // Covariance of the parts before each sample.
        let mut ahead = [[0.0; MOST_PARTS]; MOST_PARTS];
        (0..MOST_PARTS).for_each(|i| ahead[i][i] = shares[i]);
        let (mut steps, mut log_determinant): (Vec<Step>, f64) = (Vec::with_capacity(samples), 0.0);
        for index in 0..samples {
            let mut with_sum = [0.0; MOST_PARTS];
            for row in &ahead {
                (0..MOST_PARTS).for_each(|j| with_sum[j] += row[j]);
            }
            let innovation = white + with_sum.iter().sum::<f64>();
            let root = 1.0 / innovation.sqrt();
            let gains = with_sum.map(|with_sum| with_sum / innovation);
            // Gains and variances settle soon, where no part outlasts the series.
            let is_settled = steps.last().is_some_and(|last| {
                (root - last.root).abs() <= 1e-14 * root
                    && (0..MOST_PARTS).all(|i| (gains[i] - last.gains[i]).abs() <= 1e-14 * gains[i])
            });
            if is_settled {
                log_determinant += (samples - index) as f64 * innovation.ln();
                break;
            }
            log_determinant += innovation.ln();
            for i in 0..MOST_PARTS {
                let (gain, kept_here) = (gains[i], kept[i]);
                for j in 0..MOST_PARTS {
                    ahead[i][j] = kept_here * kept[j] * (ahead[i][j] - gain * with_sum[j]);
                }
                ahead[i][i] += shares[i] * (1.0 - kept_here * kept_here);
            }
            steps.push(Step { root, gains });
        }
        Self {
            kept: parts.iter().map(|(_, correlation)| *correlation).collect(),
            steps,
            log_determinant,
        }
    }

    /// Σ of the squares of a column whitened.
    pub(crate) fn square(&self, column: &[f64]) -> f64 {
        let (mut states, mut expected, mut square) = ([0.0; MOST_PARTS], 0.0, 0.0);
        let (count, last) = (self.kept.len(), self.steps.len() - 1);
        for (index, entry) in column.iter().enumerate() {
            let Step { root, gains } = &self.steps[index.min(last)];
            let new = entry - expected;
            square += (new * root).powi(2);
            for i in 0..count {
                states[i] = (states[i] + gains[i] * new) * self.kept[i];
            }
            expected = states[..count].iter().sum();
        }
        square
    }
}

/// What a filter does with one sample: what came beyond expectation counts times `root`, and changes what is expected by `gain` of it; of all
/// that `kept` is left for the next.
pub(super) struct MarkovStep {
    pub(super) root: f64,
    pub(super) gain: f64,
    pub(super) kept: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::dot;

    const COUNT: usize = 50;

    fn columns(count: usize) -> Vec<Vec<f64>> {
        let entry = |column: usize, i: usize| ((i * i * 31 + i * (2 * column + 7)) % 101) as f64 / 50.0 - 1.0;
        (0..count).map(|column| (0..COUNT).map(|i| entry(column, i)).collect()).collect()
    }

    fn whitened(column: &[f64], filter: &Filter) -> Vec<f64> {
        let mut states = vec![0.0; filter.kept.len()];
        let white = |(i, entry): (usize, &f64)| {
            let Step { root, gains } = &filter.steps[i.min(filter.steps.len() - 1)];
            let new = entry - states.iter().sum::<f64>();
            for ((state, kept), gain) in states.iter_mut().zip(&filter.kept).zip(gains) {
                *state = kept * (*state + gain * new);
            }
            new * root
        };
        column.iter().enumerate().map(white).collect()
    }

    #[test]
    fn side_by_side_is_one_after_the_other() {
        let filter = Filter::new(&[(0.6, 0.8), (0.2, 0.99)], COUNT);
        for count in [1, 3, 8, 9, 17, 30] {
            let all = columns(count);
            let slices: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
            let rows = Rows::new(&slices);
            let white: Vec<Vec<f64>> = all.iter().map(|column| whitened(column, &filter)).collect();
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
            let (products, across) = (rows.whitened(&filter, COUNT), rows.with_sums_before(0.8));
            for i in 0..count {
                for j in 0..count {
                    assert!((products[i * count + j] - dot(&white[i], &white[j])).abs() < 1e-12);
                    assert!((across[i * count + j] - dot(&all[i], &sums[j])).abs() < 1e-12);
                }
                assert!((filter.square(&all[i]) / dot(&white[i], &white[i]) - 1.0).abs() < 1e-13);
            }
        }
        assert!(Rows::new(&[]).whitened(&filter, COUNT).is_empty());
    }
}
