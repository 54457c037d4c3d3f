//! Columns laid side by side, sample after sample, for recursions that wait for their own last step: all columns together take as long
//! as one.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::model::NoiseModel;
use crate::vector::{accelerated, cross_products, level};

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
                let nothing = [f64x8::splat(simd, 0.0); 2];
                let (mut expected, mut at) = (nothing, 0);
                products(simd, left, right, #[inline(always)] |left, right| {
                    if at == length {
                        (expected, at) = (nothing, 0);
                    }
                    let [kept, taken, root] = filter.steps[at.min(last)].map(|parameter| f64x8::splat(simd, parameter));
                    at += 1;
                    let [of_left, of_right] = expected;
                    expected = [kept * of_left + taken * left, kept * of_right + taken * right];
                    [(left - of_left) * root, (right - of_right) * root]
                })
            })
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

/// Kalman's filter of white noise with AR(1), as it takes a column: what it expects of the next sample is `kept` of what it expected
/// and `taken` of what came; the difference counts times `root`.
pub(crate) struct Filter {
    /// kept, taken and root of the first samples; the last of them for all that follow.
    pub(crate) steps: Vec<[f64; 3]>,
    /// ln |R|.
    pub(crate) log_determinant: f64,
}

impl Filter {
    /// The filter for this correlation of neighbours and this share of the correlated part.
    pub(crate) fn new(rho: f64, share: f64, samples: usize) -> Self {
        let mut steps = Vec::new();
        let (mut ahead, mut log_determinant) = (share, 0.0);
        for index in 0..samples {
            let innovation = ahead + 1.0 - share;
            let gain = ahead / innovation;
            steps.push([rho * (1.0 - gain), rho * gain, 1.0 / innovation.sqrt()]);
            log_determinant += innovation.ln();
            let next = rho * rho * ahead * (1.0 - gain) + share * (1.0 - rho * rho);
            // Gains and variances settle soon.
            if (next - ahead).abs() <= 1e-14 * ahead {
                log_determinant += (samples - index - 1) as f64 * innovation.ln();
                break;
            }
            ahead = next;
        }
        Self { steps, log_determinant }
    }
}

/// Σ of the squares of one column whitened by each of several filters, side by side.
pub(crate) fn whitened_squares(column: &[f64], filters: &[Filter]) -> Vec<f64> {
    let many = |filters: &[Filter]| {
        let longest = filters.iter().map(|filter| filter.steps.len()).max().unwrap_or(0);
        let step = |index: usize, what: usize| -> [f64; LANES] {
            std::array::from_fn(|lane| {
                let steps = &filters[lane.min(filters.len() - 1)].steps;
                steps[index.min(steps.len() - 1)][what]
            })
        };
        let steps: Vec<[[f64; LANES]; 3]> = (0..longest).map(|index| [0, 1, 2].map(|what| step(index, what))).collect();
        let mut squares = [0.0; LANES];
        accelerated(
            #[inline(always)]
            || {
                let mut expected = [0.0; LANES];
                for (index, entry) in column.iter().enumerate() {
                    let [kept, taken, root] = &steps[index.min(longest - 1)];
                    for lane in 0..LANES {
                        let white = (entry - expected[lane]) * root[lane];
                        squares[lane] += white * white;
                        expected[lane] = kept[lane] * expected[lane] + taken[lane] * entry;
                    }
                }
            },
        );
        squares.into_iter().take(filters.len())
    };
    filters.chunks(LANES).flat_map(many).collect()
}

/// The columns of a Jacobian J, ready for products with correlations between them.
pub(crate) struct Columns {
    size: usize,
    /// JᵀJ.
    product: Vec<f64>,
    rows: Rows,
}

impl Columns {
    pub(crate) fn new(columns: &[&[f64]]) -> Self {
        let size = columns.len();
        let mut product = vec![0.0; size * size];
        cross_products(columns, columns, &mut product);
        Self {
            size,
            product,
            rows: Rows::new(columns),
        }
    }

    /// JᵀRJ, row-major, with R the correlations of this noise, in one pass over the columns.
    ///
    /// F_i = ρ (F_{i−1} + J_{i−1}) sums all that came before, so that JᵀRJ = JᵀJ + s (JᵀF + FᵀJ).
    pub(crate) fn quadratic(&self, model: NoiseModel) -> Vec<f64> {
        let (correlation, share) = model.parameters();
        let mut product = self.product.clone();
        let across = self.rows.with_sums_before(correlation);
        for i in 0..self.size {
            for j in 0..self.size {
                product[i * self.size + j] += share * (across[i * self.size + j] + across[j * self.size + i]);
            }
        }
        product
    }
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
        let mut expected = 0.0;
        let white = |(i, entry): (usize, &f64)| {
            let [kept, taken, root] = filter.steps[i.min(filter.steps.len() - 1)];
            let white = (entry - expected) * root;
            expected = kept * expected + taken * entry;
            white
        };
        column.iter().enumerate().map(white).collect()
    }

    #[test]
    fn side_by_side_is_one_after_the_other() {
        let filter = Filter::new(0.8, 0.6, COUNT);
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
            }
        }
        assert!(Rows::new(&[]).whitened(&filter, COUNT).is_empty());
    }

    #[test]
    fn many_filters_of_one_column() {
        let filters: Vec<Filter> = (0..19).map(|i| Filter::new(0.05 * f64::from(i), 0.5, COUNT)).collect();
        let column = &columns(1)[0];
        let squares = whitened_squares(column, &filters);
        assert_eq!(squares.len(), 19);
        for (square, filter) in squares.iter().zip(&filters) {
            let white = whitened(column, filter);
            assert!((square / dot(&white, &white) - 1.0).abs() < 1e-13);
        }
    }
}
