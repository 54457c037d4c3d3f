//! One look at a whole column, one column made of another.

use fearless_simd::{Simd, SimdBase, dispatch, f64x8};

use super::{LANES, accelerated, level};

/// Whether every number is finite.
pub(crate) fn all_finite(column: &[f64]) -> bool {
    accelerated(
        #[inline(always)]
        || column.iter().fold(true, |good, x| good & (x.abs() < f64::INFINITY)),
    )
}

/// Whether no number is less than the one before it, and none is NaN.
pub(crate) fn rises_or_stays(column: &[f64]) -> bool {
    !column.first().is_some_and(|x| x.is_nan()) && is_ordered(column, |before, after| before <= after)
}

/// Whether every number is above the one before it.
pub(crate) fn rises(column: &[f64]) -> bool {
    is_ordered(column, |before, after| before < after)
}

fn is_ordered(column: &[f64], is_good: impl Fn(&f64, &f64) -> bool) -> bool {
    let later = column.get(1..).unwrap_or(&[]);
    accelerated(
        #[inline(always)]
        || column.iter().zip(later).fold(true, |good, (before, after)| good & is_good(before, after)),
    )
}

/// Least and greatest number; (∞, −∞) if there is none.
pub(crate) fn extremes(column: &[f64]) -> (f64, f64) {
    dispatch!(level(), simd => extremes_with(simd, column))
}

#[inline(always)]
fn extremes_with<S: Simd>(simd: S, column: &[f64]) -> (f64, f64) {
    let (blocks, rest) = column.as_chunks::<LANES>();
    let (mut low, mut high) = (f64x8::splat(simd, f64::INFINITY), f64x8::splat(simd, f64::NEG_INFINITY));
    for block in blocks {
        let block = f64x8::from_slice(simd, block);
        (low, high) = (low.min(block), high.max(block));
    }
    let (low, high): ([f64; LANES], [f64; LANES]) = (low.into(), high.into());
    let least = low.iter().chain(rest).copied().fold(f64::INFINITY, f64::min);
    let greatest = high.iter().chain(rest).copied().fold(f64::NEG_INFINITY, f64::max);
    (least, greatest)
}

/// (x − `offset`) · `factor` for every x.
pub(crate) fn shifted(column: &[f64], offset: f64, factor: f64) -> Vec<f64> {
    let mut out = vec![0.0; column.len()];
    accelerated(
        #[inline(always)]
        || out.iter_mut().zip(column).for_each(|(out, x)| *out = (x - offset) * factor),
    );
    out
}

/// column · factors, number by number.
pub(crate) fn multiply(column: &mut [f64], factors: &[f64]) {
    accelerated(
        #[inline(always)]
        || column.iter_mut().zip(factors).for_each(|(x, factor)| *x *= factor),
    );
}

/// column + `factor` · other, number by number.
pub(crate) fn add_multiple(column: &mut [f64], factor: f64, other: &[f64]) {
    accelerated(
        #[inline(always)]
        || column.iter_mut().zip(other).for_each(|(x, more)| *x += factor * more),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::on_every_level;

    #[test]
    fn one_bad_number_is_found_wherever_it_is() {
        for count in [1, 7, 8, 9, 40] {
            let good: Vec<f64> = (0..count).map(f64::from).collect();
            assert!(all_finite(&good) && rises(&good));
            for at in 0..good.len() {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut column = good.clone();
                    column[at] = bad;
                    assert!(!all_finite(&column));
                }
                let mut column = good.clone();
                column[at] = f64::NAN;
                assert!(count == 1 || !rises(&column));
                column[at] = good[at.saturating_sub(1)];
                assert!(at == 0 || !rises(&column));
            }
        }
        assert!(all_finite(&[]) && rises(&[]) && rises(&[f64::NAN]));
    }

    #[test]
    fn extremes_and_copies_are_those_of_plain_loops() {
        for count in [1, 7, 8, 9, 1000] {
            let column: Vec<f64> = (0..count).map(|i| f64::from(i * 7919 % 1009) - 500.0).collect();
            let (low, high) = extremes(&column);
            assert_eq!(low, column.iter().copied().fold(f64::INFINITY, f64::min));
            assert_eq!(high, column.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let found = on_every_level(|| {
                let mut out = shifted(&column, 3.0, 0.1);
                multiply(&mut out, &column);
                out
            });
            assert!(found.iter().zip(&column).all(|(out, x)| *out == (x - 3.0) * 0.1 * x));
        }
        assert_eq!(extremes(&[]), (f64::INFINITY, f64::NEG_INFINITY));
    }
}
