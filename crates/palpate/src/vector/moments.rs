//! Sums over a run of samples, of which its moments are made.

use std::ops::Range;

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::products::{LANES, total};
use super::{accelerated, level};

/// The sum of a column.
pub(crate) fn sum(column: &[f64]) -> f64 {
    accelerated(
        #[inline(always)]
        || lane_sum(column),
    )
}

/// Sums over blocks of `length` samples; those behind the last whole block are left out.
pub(crate) fn block_sums(column: &[f64], length: usize) -> Vec<f64> {
    let mut sums = vec![0.0; column.len() / length];
    accelerated(
        #[inline(always)]
        || sums.iter_mut().zip(column.chunks_exact(length)).for_each(|(sum, block)| *sum = lane_sum(block)),
    );
    sums
}

/// A sum in [`LANES`] interleaved parts.
#[inline(always)]
fn lane_sum(column: &[f64]) -> f64 {
    let (blocks, rest) = column.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for block in blocks {
        for lane in 0..LANES {
            sums[lane] += block[lane];
        }
    }
    sums.iter_mut().zip(rest).for_each(|(sum, entry)| *sum += entry);
    total(sums)
}

/// Of the samples in `range`, with x = t − `place`, z = y − `level` and weights w (squares of `roots`, 1 if there are none):
/// Σw, Σwx, Σwx², Σwx³, Σwz, Σwxz, Σwz².
///
/// # Panics
/// If the range goes beyond the columns.
pub(crate) fn moments(
    times: &[f64],
    values: &[f64],
    roots: Option<&[f64]>,
    range: Range<usize>,
    (place, level_of_values): (f64, f64),
) -> [f64; 7] {
    dispatch!(level(), simd => moments_with(simd, times, values, roots, range, (place, level_of_values)))
}

#[inline(always)]
fn moments_with<S: Simd>(
    simd: S,
    times: &[f64],
    values: &[f64],
    roots: Option<&[f64]>,
    range: Range<usize>,
    (place, level): (f64, f64),
) -> [f64; 7] {
    let mut sums = [f64x8::splat(simd, 0.0); 7];
    let (mut from, one) = (range.start, f64x8::splat(simd, 1.0));
    while from + LANES <= range.end {
        let weight = match roots {
            None => one,
            Some(roots) => {
                let root = f64x8::from_slice(simd, block(roots, from));
                root * root
            }
        };
        add(simd, &mut sums, weight, [block(times, from), block(values, from)], (place, level));
        from += LANES;
    }
    if from < range.end {
        // Neighbours beyond the range come along without weight; at the end of the columns there are none.
        let left = range.end - from;
        let root = |lane: usize| roots.map_or(1.0, |roots| roots[from + lane]);
        let weights: [f64; LANES] = std::array::from_fn(|lane| if lane < left { root(lane) * root(lane) } else { 0.0 });
        let weights = f64x8::from_slice(simd, &weights);
        if from + LANES <= times.len() {
            add(simd, &mut sums, weights, [block(times, from), block(values, from)], (place, level));
        } else {
            let padded = |column: &[f64]| std::array::from_fn(|lane| column[from + lane.min(left - 1)]);
            add(simd, &mut sums, weights, [&padded(times), &padded(values)], (place, level));
        }
    }
    sums.map(
        #[inline(always)]
        |sum| total(sum.into()),
    )
}

#[inline(always)]
fn add<S: Simd>(
    simd: S,
    sums: &mut [f64x8<S>; 7],
    w: f64x8<S>,
    [t, y]: [&[f64; LANES]; 2],
    (place, level): (f64, f64),
) {
    let (x, z) = (f64x8::from_slice(simd, t) - place, f64x8::from_slice(simd, y) - level);
    let (along, up) = (w * x, w * z);
    let square = along * x;
    let terms = [w, along, square, square * x, up, along * z, up * z];
    for k in 0..7 {
        sums[k] += terms[k];
    }
}

#[inline(always)]
fn block(column: &[f64], from: usize) -> &[f64; LANES] {
    column[from..].first_chunk().unwrap_or(&[0.0; LANES])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::on_every_level;

    #[test]
    fn moments_are_the_plain_sums_of_any_run() {
        // Whole numbers, so that every sum is exact in any order.
        let column =
            |seed: usize| -> Vec<f64> { (0..70).map(|i| ((i * i * 31 + i * seed) % 23) as f64 - 11.0).collect() };
        let (times, values, roots) = (column(3), column(5), column(8));
        for roots in [None, Some(roots.as_slice())] {
            for (from, until) in [(0, 0), (0, 3), (2, 10), (5, 30), (60, 70), (67, 70), (69, 70)] {
                let found = on_every_level(|| moments(&times, &values, roots, from..until, (2.0, -3.0)).to_vec());
                let mut expected = [0.0; 7];
                for i in from..until {
                    let (w, x, z) = (roots.map_or(1.0, |roots| roots[i] * roots[i]), times[i] - 2.0, values[i] + 3.0);
                    let terms = [w, w * x, w * x * x, w * x * x * x, w * z, w * x * z, w * z * z];
                    for (sum, term) in expected.iter_mut().zip(terms) {
                        *sum += term;
                    }
                }
                assert_eq!(found, expected, "{from}..{until}");
            }
        }
    }
}
