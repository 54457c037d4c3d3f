//! Sums over whole columns: scalar products, normal equations, residuals.
//!
//! Sums run in [`LANES`] interleaved parts and are closed every [`CHUNK`] samples, so that columns are read from memory
//! once however many products they enter, and rounding errors grow slowly.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};
use smallvec::SmallVec;

use super::{accelerated, level};

/// Columns side by side; those of every usual law without a trip to the heap.
type Columns<'a> = SmallVec<[&'a [f64]; 8]>;

/// Interleaved parts of a sum.
pub(crate) const LANES: usize = 8;
/// Samples that stay in the nearest cache while every product of them is formed.
const CHUNK: usize = 1024;
/// Columns on a side of a tile: 2 × 2 running sums stay in registers, and more were slower.
const SIDE: usize = 2;

/// Σ aᵢ bᵢ over the shorter of the two lengths.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len());
    let (a, b) = (&a[..count], &b[..count]);
    accelerated(
        #[inline(always)]
        || {
            // A single sum would wait for its own additions: two are twice as fast.
            const WIDE: usize = 2 * LANES;
            let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<WIDE>(), b.as_chunks::<WIDE>());
            let mut sums = [0.0; WIDE];
            for (x, y) in a.iter().zip(b) {
                for lane in 0..WIDE {
                    sums[lane] += x[lane] * y[lane];
                }
            }
            for ((sum, x), y) in sums.iter_mut().zip(a_rest).zip(b_rest) {
                *sum += x * y;
            }
            let mut folded = [0.0; LANES];
            for lane in 0..LANES {
                folded[lane] = sums[lane] + sums[lane + LANES];
            }
            total(folded)
        },
    )
}

/// Normal equations of y ≈ Σ aᵢ cᵢ: `gram[i k + j]` = cᵢ·cⱼ for k columns, and `right[i]` = cᵢ·y.
///
/// # Panics
/// If lengths do not fit.
pub(crate) fn normal_equations(columns: &[impl AsRef<[f64]>], values: &[f64], gram: &mut [f64], right: &mut [f64]) {
    let size = columns.len();
    assert_eq!((gram.len(), right.len()), (size * size, size), "a square and a vector");
    gram.fill(0.0);
    right.fill(0.0);
    for from in (0..values.len()).step_by(CHUNK) {
        let range = from..values.len().min(from + CHUNK);
        let parts: Columns<'_> = columns.iter().map(|column| &column.as_ref()[range.clone()]).collect();
        let (pairs, rest) = parts.as_chunks::<SIDE>();
        for (index, pair) in pairs.iter().enumerate() {
            add_rows(*pair, &pairs[..index], &values[range.clone()], gram, right);
        }
        if let [one] = *rest {
            add_rows([one], pairs, &values[range], gram, right);
        }
    }
    for i in 0..size {
        for j in 0..i {
            gram[j * size + i] = gram[i * size + j];
        }
    }
}

/// Adds the products of `rows` with the columns `before` them, with themselves and with `values`.
fn add_rows<const R: usize>(
    rows: [&[f64]; R],
    before: &[[&[f64]; SIDE]],
    values: &[f64],
    gram: &mut [f64],
    right: &mut [f64],
) {
    let (size, first) = (right.len(), SIDE * before.len());
    for (index, columns) in before.iter().enumerate() {
        for (i, products) in tile(rows, *columns).iter().enumerate() {
            for (j, product) in products.iter().enumerate() {
                gram[(first + i) * size + SIDE * index + j] += product;
            }
        }
    }
    let (among, with_values) = triangle(rows, values);
    for i in 0..R {
        right[first + i] += with_values[i];
        for j in 0..=i {
            gram[(first + i) * size + first + j] += among[i][j];
        }
    }
}

/// `products[i k + j]` = rᵢ·cⱼ for k columns.
///
/// # Panics
/// If lengths do not fit.
pub(crate) fn cross_products(rows: &[impl AsRef<[f64]>], columns: &[impl AsRef<[f64]>], products: &mut [f64]) {
    let size = columns.len();
    assert_eq!(products.len(), rows.len() * size, "one product a pair");
    products.fill(0.0);
    let count = rows.first().map_or(0, |row| row.as_ref().len());
    for from in (0..count).step_by(CHUNK) {
        let range = from..count.min(from + CHUNK);
        let across: Columns<'_> = columns.iter().map(|column| &column.as_ref()[range.clone()]).collect();
        let (pairs, rest) = across.as_chunks::<SIDE>();
        for (row, out) in rows.iter().zip(products.chunks_exact_mut(size.max(1))) {
            let row = [&row.as_ref()[range.clone()]];
            let mut add = |at: usize, more: &[f64]| out[at..].iter_mut().zip(more).for_each(|(sum, x)| *sum += x);
            for (index, pair) in pairs.iter().enumerate() {
                add(SIDE * index, &tile(row, *pair)[0]);
            }
            if let [one] = *rest {
                add(SIDE * pairs.len(), &tile(row, [one])[0]);
            }
        }
    }
}

/// Forms the residuals y − Σ aᵢ cᵢ and returns the sum of their squares.
///
/// # Panics
/// If lengths do not fit.
pub(crate) fn form_residuals(
    values: &[f64],
    columns: &[impl AsRef<[f64]>],
    amplitudes: &[f64],
    residuals: &mut [f64],
) -> f64 {
    assert_eq!(columns.len(), amplitudes.len(), "one amplitude a column");
    let mut square = 0.0;
    for (index, (values, residuals)) in values.chunks(CHUNK).zip(residuals.chunks_mut(CHUNK)).enumerate() {
        let range = index * CHUNK..index * CHUNK + values.len();
        let part = |i: usize| &columns[i].as_ref()[range.clone()];
        // The first two columns, all that most laws have, go with the copy.
        let from = columns.len().min(2);
        let mut sum = match from {
            0 => subtract(Some(values), [], [], residuals),
            1 => subtract(Some(values), [part(0)], [amplitudes[0]], residuals),
            _ => subtract(Some(values), [part(0), part(1)], [amplitudes[0], amplitudes[1]], residuals),
        };
        for i in (from..columns.len()).step_by(2) {
            sum = if i + 1 < columns.len() {
                subtract(None, [part(i), part(i + 1)], [amplitudes[i], amplitudes[i + 1]], residuals)
            } else {
                subtract(None, [part(i)], [amplitudes[i]], residuals)
            };
        }
        square += sum;
    }
    square
}

/// residual = `values` (or what it was) − Σ aᵢ cᵢ; returns the sum of squares.
fn subtract<const C: usize>(
    values: Option<&[f64]>,
    columns: [&[f64]; C],
    amplitudes: [f64; C],
    residuals: &mut [f64],
) -> f64 {
    dispatch!(level(), simd => subtract_with(simd, values, columns, amplitudes, residuals))
}

#[inline(always)]
fn subtract_with<S: Simd, const C: usize>(
    simd: S,
    values: Option<&[f64]>,
    columns: [&[f64]; C],
    amplitudes: [f64; C],
    residuals: &mut [f64],
) -> f64 {
    let count = residuals.len();
    if let Some(values) = values
        && C == 0
    {
        residuals.copy_from_slice(values);
    }
    let values = values.filter(|_| C > 0).map(|values| &values[..count]);
    let columns = columns.map(|column| &column[..count]);
    let mut sum = f64x8::splat(simd, 0.0);
    let whole = columns.map(blocks);
    let last = std::array::from_fn(|i| padded(columns[i]));
    let (residual_blocks, rest) = residuals.as_chunks_mut::<LANES>();
    let mut late = [0.0; LANES];
    match values {
        // Two loops: one that picks its source at every block becomes code that copies by way of memory.
        Some(values) => {
            let value_blocks = &blocks(values)[..residual_blocks.len()];
            for (index, block) in residual_blocks.iter_mut().enumerate() {
                *block = less(simd, &mut sum, &value_blocks[index], whole.map(|blocks| &blocks[index]), amplitudes);
            }
            late = padded(values);
        }
        None => {
            for (index, block) in residual_blocks.iter_mut().enumerate() {
                *block = less(simd, &mut sum, block, whole.map(|blocks| &blocks[index]), amplitudes);
            }
            late[..rest.len()].copy_from_slice(rest);
        }
    }
    if !rest.is_empty() {
        let now = less(simd, &mut sum, &late, last.each_ref(), amplitudes);
        rest.copy_from_slice(&now[..rest.len()]);
    }
    total(sum.into())
}

/// before − Σ aᵢ cᵢ of a block; its squares are added to `sum`.
#[inline(always)]
fn less<S: Simd, const C: usize>(
    simd: S,
    sum: &mut f64x8<S>,
    before: &[f64; LANES],
    columns: [&[f64; LANES]; C],
    amplitudes: [f64; C],
) -> [f64; LANES] {
    let mut now = f64x8::from_slice(simd, before);
    for i in 0..C {
        now -= f64x8::from_slice(simd, columns[i]) * amplitudes[i];
    }
    *sum += now * now;
    now.into()
}

/// Of [`LANES`] columns side by side, `rows`: `sums[0]` = Σ wᵢ xᵢ² and `sums[k + 1]` = Σ fᵢ xᵢ for every column f of `factors`.
///
/// # Panics
/// If lengths do not fit.
pub(crate) fn lane_sums(rows: &[[f64; LANES]], weights: &[f64], factors: &[Vec<f64>], sums: &mut [[f64; LANES]]) {
    assert_eq!(sums.len(), factors.len() + 1, "one sum a column of factors, and that of squares");
    dispatch!(level(), simd => lane_sums_with(simd, rows, weights, factors, sums));
}

#[inline(always)]
fn lane_sums_with<S: Simd>(
    simd: S,
    rows: &[[f64; LANES]],
    weights: &[f64],
    factors: &[Vec<f64>],
    sums: &mut [[f64; LANES]],
) {
    let mut square = f64x8::splat(simd, 0.0);
    for (row, weight) in rows.iter().zip(weights) {
        let x = f64x8::from_slice(simd, row);
        square += x * x * *weight;
    }
    sums[0] = square.into();
    for (sum, factors) in sums[1..].iter_mut().zip(factors) {
        let mut product = f64x8::splat(simd, 0.0);
        for (row, factor) in rows.iter().zip(factors) {
            product += f64x8::from_slice(simd, row) * *factor;
        }
        *sum = product.into();
    }
}

/// Every row times every column.
fn tile<const R: usize, const C: usize>(rows: [&[f64]; R], columns: [&[f64]; C]) -> [[f64; C]; R] {
    dispatch!(level(), simd => tile_with(simd, rows, columns))
}

// Here the sums are vectors by name: of several sums in a plain loop the compiler makes scalar code.
#[inline(always)]
fn tile_with<S: Simd, const R: usize, const C: usize>(
    simd: S,
    rows: [&[f64]; R],
    columns: [&[f64]; C],
) -> [[f64; C]; R] {
    let mut sums = [[f64x8::splat(simd, 0.0); C]; R];
    for_blocks(
        rows,
        columns,
        #[inline(always)]
        |rows, columns| {
            let rows = rows.map(|block| f64x8::from_slice(simd, block));
            let columns = columns.map(|block| f64x8::from_slice(simd, block));
            for i in 0..R {
                for j in 0..C {
                    sums[i][j] += rows[i] * columns[j];
                }
            }
        },
    );
    sums.map(|row| row.map(|sum| total(sum.into())))
}

/// The products of rows with each other (the lower half is filled) and with `values`.
fn triangle<const R: usize>(rows: [&[f64]; R], values: &[f64]) -> ([[f64; R]; R], [f64; R]) {
    dispatch!(level(), simd => triangle_with(simd, rows, values))
}

#[inline(always)]
fn triangle_with<S: Simd, const R: usize>(simd: S, rows: [&[f64]; R], values: &[f64]) -> ([[f64; R]; R], [f64; R]) {
    let mut among = [[f64x8::splat(simd, 0.0); R]; R];
    let mut with_values = [f64x8::splat(simd, 0.0); R];
    for_blocks(
        rows,
        [values],
        #[inline(always)]
        |rows, [values]| {
            let rows = rows.map(|block| f64x8::from_slice(simd, block));
            let values = f64x8::from_slice(simd, values);
            for i in 0..R {
                with_values[i] += rows[i] * values;
                for j in 0..=i {
                    among[i][j] += rows[i] * rows[j];
                }
            }
        },
    );
    (among.map(|row| row.map(|sum| total(sum.into()))), with_values.map(|sum| total(sum.into())))
}

/// Hands over all columns a block of [`LANES`] at a time; the last block is filled up with zeros.
#[inline(always)]
fn for_blocks<const R: usize, const C: usize>(
    rows: [&[f64]; R],
    columns: [&[f64]; C],
    mut work: impl FnMut([&[f64; LANES]; R], [&[f64; LANES]; C]),
) {
    let count = columns[0].len();
    let (rows, columns) = (rows.map(|row| &row[..count]), columns.map(|column| &column[..count]));
    let (row_blocks, column_blocks) = (rows.map(blocks), columns.map(blocks));
    for index in 0..count / LANES {
        work(row_blocks.map(|blocks| &blocks[index]), column_blocks.map(|blocks| &blocks[index]));
    }
    if !count.is_multiple_of(LANES) {
        let (rows, columns) = (rows.map(padded), columns.map(padded));
        work(rows.each_ref(), columns.each_ref());
    }
}

#[inline(always)]
fn blocks(column: &[f64]) -> &[[f64; LANES]] {
    column.as_chunks().0
}

/// What remains after whole blocks, and zeros.
#[inline(always)]
fn padded(column: &[f64]) -> [f64; LANES] {
    let rest = column.as_chunks::<LANES>().1;
    let mut block = [0.0; LANES];
    block[..rest.len()].copy_from_slice(rest);
    block
}

/// The sum of the lanes, halves first.
#[inline(always)]
pub(super) fn total(lanes: [f64; LANES]) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::on_every_level;

    // An interpreter that looks for undefined behaviour needs no more than a few.
    const COUNTS: &[usize] =
        if cfg!(miri) { &[0, 9, CHUNK + 13] } else { &[0, 1, 7, 8, 9, 100, CHUNK, 2 * CHUNK + 13] };
    const SIZES: &[usize] = if cfg!(miri) { &[0, 3, 8] } else { &[0, 1, 2, 3, 4, 5, 6, 7, 8] };

    /// Whole numbers from −50 to 50, so that every sum is exact in any order.
    fn column(count: usize, seed: usize) -> Vec<f64> {
        (0..count).map(|i| ((i * i * 31 + i * (2 * seed + 7) + 13 * seed) % 101) as f64 - 50.0).collect()
    }

    fn exact(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(x, y)| x * y).sum()
    }

    #[test]
    fn scalar_product_is_the_plain_sum() {
        for &count in COUNTS {
            let (a, b) = (column(count, 1), column(count, 2));
            assert_eq!(on_every_level(|| vec![dot(&a, &b)]), [exact(&a, &b)]);
        }
        assert_eq!(dot(&[1.0, 2.0, 3.0], &[4.0, 5.0]), 14.0);
    }

    #[test]
    fn normal_equations_hold_every_product() {
        for &count in COUNTS {
            for &size in SIZES {
                let columns: Vec<Vec<f64>> = (0..size).map(|seed| column(count, seed)).collect();
                let values = column(count, 11);
                let found = on_every_level(|| {
                    let (mut gram, mut right) = (vec![f64::NAN; size * size], vec![f64::NAN; size]);
                    normal_equations(&columns, &values, &mut gram, &mut right);
                    [gram, right].concat()
                });
                let (gram, right) = found.split_at(size * size);
                for (i, a) in columns.iter().enumerate() {
                    assert_eq!(right[i], exact(a, &values), "{count} samples, {size} columns");
                    for (j, b) in columns.iter().enumerate() {
                        assert_eq!(gram[i * size + j], exact(a, b), "{count} samples, {size} columns");
                    }
                }
            }
        }
    }

    #[test]
    fn cross_products_hold_every_pair() {
        for &count in COUNTS {
            for (down, across) in [(1, 1), (2, 3), (3, 2), (1, 5), (4, 8), (2, 0), (0, 2)] {
                let rows: Vec<Vec<f64>> = (0..down).map(|seed| column(count, seed)).collect();
                let columns: Vec<Vec<f64>> = (0..across).map(|seed| column(count, 20 + seed)).collect();
                let found = on_every_level(|| {
                    let mut products = vec![f64::NAN; down * across];
                    cross_products(&rows, &columns, &mut products);
                    products
                });
                let pairs = rows.iter().flat_map(|a| columns.iter().map(|b| exact(a, b)));
                assert_eq!(found, pairs.collect::<Vec<_>>(), "{count} samples, {down} × {across}");
            }
        }
    }

    #[test]
    fn sums_of_columns_side_by_side() {
        for &count in COUNTS {
            let all = column(LANES * count, 1);
            let (rows, weights) = (all.as_chunks::<LANES>().0, column(count, 2));
            for size in 0..4 {
                let factors: Vec<Vec<f64>> = (0..size).map(|seed| column(count, 5 + seed)).collect();
                let found = on_every_level(|| {
                    let mut sums = vec![[f64::NAN; LANES]; size + 1];
                    lane_sums(rows, &weights, &factors, &mut sums);
                    sums.concat()
                });
                for lane in 0..LANES {
                    let x: Vec<f64> = rows.iter().map(|row| row[lane]).collect();
                    let squares: Vec<f64> = x.iter().map(|x| x * x).collect();
                    assert_eq!(found[lane], exact(&squares, &weights), "{count} rows");
                    for (k, factors) in factors.iter().enumerate() {
                        assert_eq!(found[(k + 1) * LANES + lane], exact(&x, factors), "{count} rows, column {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn residuals_and_their_square() {
        let amplitudes = [2.0, -1.0, 0.5, 3.0, -0.25];
        for &count in COUNTS {
            for size in 0..=amplitudes.len() {
                let columns: Vec<Vec<f64>> = (0..size).map(|seed| column(count, seed)).collect();
                let values = column(count, 11);
                let found = on_every_level(|| {
                    let mut residuals = vec![f64::NAN; count];
                    let square = form_residuals(&values, &columns, &amplitudes[..size], &mut residuals);
                    residuals.push(square);
                    residuals
                });
                let expected: Vec<f64> = (0..count)
                    .map(|i| values[i] - columns.iter().zip(amplitudes).map(|(c, a)| a * c[i]).sum::<f64>())
                    .collect();
                assert_eq!(found[..count], expected, "{count} samples, {size} columns");
                assert_eq!(found[count], exact(&expected, &expected));
            }
        }
    }

    /// Numbers that no sum is exact for: still the same bits on every machine, and close to the plain sum.
    #[test]
    fn rounding_does_not_depend_on_the_machine() {
        let columns: Vec<Vec<f64>> =
            (1..=5).map(|k| (0..3000).map(|i| (0.001 * f64::from(k * i)).sin()).collect()).collect();
        let found = on_every_level(|| {
            let (mut gram, mut right) = (vec![0.0; 16], vec![0.0; 4]);
            normal_equations(&columns[..4], &columns[4], &mut gram, &mut right);
            let mut residuals = vec![0.0; 3000];
            let square = form_residuals(&columns[4], &columns[..4], &[0.3, 0.7, -0.2, 0.1], &mut residuals);
            [gram, right, residuals, vec![square]].concat()
        });
        assert!((found[1] - exact(&columns[0], &columns[1])).abs() < 1e-11);
    }
}
