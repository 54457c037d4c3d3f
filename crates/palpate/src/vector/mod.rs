//! Whole series at the speed of the processor's vector units, with the same bits on every processor.
//!
//! A binary for all of x86-64 may use vectors of two numbers only. [`accelerated`] runs code that was compiled once more
//! for AVX2 and for AVX-512 on machines that have them, and the compiler turns plain branch-free loops into vectors of
//! four or eight. Nothing depends on how many: products and sums are never fused into one rounding, and sums run in
//! lanes whose number is written in the source.
//!
//! | file | what |
//! |---|---|
//! | `aligned.rs` | a column that begins at a cache line |
//! | `columns.rs` | finite, rising, extremes; one column made of another |
//! | `elementary.rs` | exp, ln and ln(1 + z) without branches |
//! | `moments.rs` | sums over a run of samples |
//! | `normal.rs` | the tail of the normal distribution without branches |
//! | `products.rs` | scalar products, normal equations, residuals |
//! | `shapes.rs` | exponential, stretched exponential and logarithm of time with their derivatives |

mod aligned;
mod columns;
pub(crate) mod elementary;
mod moments;
pub(crate) mod normal;
mod products;
mod shapes;

pub(crate) use aligned::Aligned;
pub(crate) use columns::{add_multiple, all_finite, extremes, multiply, rises, rises_or_stays, shifted};
pub(crate) use moments::{block_sums, moments, sum};
pub(crate) use products::{LANES, cross_products, dot, form_residuals, lane_sums, normal_equations};
pub(crate) use shapes::{exponential_columns, logarithm_columns, stretched_columns};

use fearless_simd::{Level, dispatch};

/// Runs `work` as compiled for the best instruction set of this machine.
///
/// That covers what is inlined into `work`: closures and helpers carry `#[inline(always)]`.
#[inline(always)]
pub(crate) fn accelerated<R>(work: impl FnOnce() -> R) -> R {
    dispatch!(level(), _simd => work())
}

#[cfg(not(test))]
#[inline(always)]
pub(crate) fn level() -> Level {
    Level::new()
}

/// Numbers that run through a kernel together: one vector of AVX-512, two of AVX2. More run out of registers.
const BLOCK: usize = 8;

/// `outputs[k][i] = f(inputs[i])[k]` for every i, as fast as the machine can if `f` has no branch.
///
/// # Panics
/// If the slices differ in length.
#[inline(always)]
pub(crate) fn fill<const N: usize>(inputs: &[f64], mut outputs: [&mut [f64]; N], f: impl Fn(f64) -> [f64; N] + Copy) {
    for output in &outputs {
        assert_eq!(inputs.len(), output.len(), "one output an input");
    }
    accelerated(
        #[inline(always)]
        || {
            let (blocks, rest) = inputs.as_chunks::<BLOCK>();
            for (index, block) in blocks.iter().enumerate() {
                let results = results_of(block, f);
                for (output, result) in outputs.iter_mut().zip(&results) {
                    output[index * BLOCK..][..BLOCK].copy_from_slice(result);
                }
            }
            if let Some(&last) = rest.last() {
                let mut block = [last; BLOCK];
                block[..rest.len()].copy_from_slice(rest);
                let results = results_of(&block, f);
                for (output, result) in outputs.iter_mut().zip(&results) {
                    output[blocks.len() * BLOCK..].copy_from_slice(&result[..rest.len()]);
                }
            }
        },
    );
}

/// The first `N` of `all`.
#[inline(always)]
pub(crate) fn first<const N: usize, const M: usize>(all: [f64; M]) -> [f64; N] {
    std::array::from_fn(|index| all[index])
}

/// Replaces numbers by what `work` makes of a copy of them, part by part.
pub(crate) fn in_place(values: &mut [f64], work: impl Fn(&[f64], &mut [f64])) {
    let mut copy = [0.0; 256];
    for part in values.chunks_mut(copy.len()) {
        let copy = &mut copy[..part.len()];
        copy.copy_from_slice(part);
        work(copy, part);
    }
}

/// `f` of a block, one row a result: the loop that becomes vector code.
#[inline(always)]
fn results_of<const N: usize>(block: &[f64; BLOCK], f: impl Fn(f64) -> [f64; N]) -> [[f64; BLOCK]; N] {
    let mut results = [[0.0; BLOCK]; N];
    for lane in 0..BLOCK {
        let result = f(block[lane]);
        for row in 0..N {
            results[row][lane] = result[row];
        }
    }
    results
}

#[cfg(test)]
pub(crate) use tests::level;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::cell::Cell;

    thread_local! {
        /// The instruction set that this thread pretends to have.
        static PRETENDED: Cell<Option<Level>> = const { Cell::new(None) };
    }

    pub(crate) fn level() -> Level {
        PRETENDED.get().unwrap_or_else(Level::new)
    }

    /// Everything this machine has, worst first.
    fn levels() -> Vec<Level> {
        let best = Level::new();
        #[cfg(target_arch = "x86_64")]
        {
            use fearless_simd::Simd;
            let tokens = [
                best.as_sse2().map(Simd::level),
                best.as_sse4_2().map(Simd::level),
                best.as_avx2().map(Simd::level),
                best.as_avx512().map(Simd::level),
            ];
            tokens.into_iter().flatten().collect()
        }
        #[cfg(not(target_arch = "x86_64"))]
        vec![best]
    }

    /// What `kernel` returns, after having checked that it returns the same bits on every instruction set.
    pub(crate) fn on_every_level(kernel: impl Fn() -> Vec<f64>) -> Vec<f64> {
        let run = |level| {
            PRETENDED.set(Some(level));
            let result = kernel();
            PRETENDED.set(None);
            result
        };
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let levels = levels();
        let first = run(levels[0]);
        for level in &levels[1..] {
            assert_eq!(bits(&first), bits(&run(*level)), "{level:?}");
        }
        first
    }

    /// A few units in the last place.
    pub(crate) fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
        let close = (found - expected).abs() <= tolerance * expected.abs();
        assert!(close, "{what}: {found:e}, expected {expected:e}");
    }

    #[test]
    fn blocks_and_rests_are_filled_alike() {
        for count in [0, 1, 15, 16, 17, 100] {
            let inputs: Vec<f64> = (0..count).map(f64::from).collect();
            let (mut twice, mut square) = (vec![f64::NAN; inputs.len()], vec![f64::NAN; inputs.len()]);
            fill(&inputs, [&mut twice, &mut square], |x| [2.0 * x, x * x]);
            for (i, x) in inputs.iter().enumerate() {
                assert_eq!((twice[i], square[i]), (2.0 * x, x * x));
            }
        }
    }

    #[test]
    #[should_panic(expected = "one output an input")]
    fn outputs_of_another_length_are_refused() {
        fill(&[1.0, 2.0], [&mut [0.0]], |x| [x]);
    }
}
