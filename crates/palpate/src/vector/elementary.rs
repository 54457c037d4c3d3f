//! Elementary functions without branches, which the compiler turns into vector code.
//!
//! Reductions and error bounds are those of Tang (ACM TOMS 15, 1989) and of FreeBSD's msun (`e_log.c`, whose
//! coefficients stand here); accurate to about one unit in the last place.

use std::f64::consts::LOG2_E;

const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// 1.5 · 2⁵²: a small whole number added to it stands in the lowest bits.
const MAGIC: f64 = 6_755_399_441_055_744.0;
const SQRT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcd;
const MANTISSA: u32 = 52;

/// eˣ; below x = −708 (3e-308) it is 0, above 709 it stays at e⁷⁰⁹ = 8.2e307.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    let clamped = if x < LOWEST { LOWEST } else { x };
    let clamped = if clamped > HIGHEST { HIGHEST } else { clamped };
    let (series, power) = reduced(clamped);
    let scaled = (1.0 + series) * power;
    if x < LOWEST { 0.0 } else { scaled }
}

/// eˣ − 1, as accurate near x = 0 as elsewhere; −1 below x = −708, and above 709 it stays at e⁷⁰⁹.
#[inline(always)]
pub(crate) fn exp_m1(x: f64) -> f64 {
    let clamped = if x < LOWEST { LOWEST } else { x };
    let clamped = if clamped > HIGHEST { HIGHEST } else { clamped };
    let (series, power) = reduced(clamped);
    // With power = 1 nothing cancels; otherwise the result is no smaller than a quarter.
    (power - 1.0) + series * power
}

const LOWEST: f64 = -708.0;
const HIGHEST: f64 = 709.0;

/// eʳ − 1 and 2ᵏ with x = k ln 2 + r and |r| ≤ ln 2 / 2, for x from [`LOWEST`] to [`HIGHEST`].
#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let shifted = x * LOG2_E + MAGIC;
    let k = shifted - MAGIC;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    // Minimax (eʳ − 1 − r)/r²; eʳ within 1.6e-17.
    // Pairs of terms side by side, so that additions need not wait for each other.
    let square = r * r;
    let fourth = square * square;
    let first = (0.500_000_000_000_000_1 + 1.666_666_666_666_666_9e-1 * r)
        + (4.166_666_666_662_413e-2 + 8.333_333_333_330_062e-3 * r) * square;
    let second = (1.388_888_891_721_371_7e-3 + 1.984_126_987_130_536e-4 * r)
        + (2.480_152_129_595_437_6e-5 + 2.755_726_845_999_706_4e-6 * r) * square;
    let third = 2.762_008_844_540_974_6e-7 + 2.510_038_549_551_032e-8 * r;
    let series = first + (second + third * fourth) * fourth;
    let power = f64::from_bits((shifted.to_bits() << MANTISSA).wrapping_add(1f64.to_bits()));
    (r + square * series, power)
}

/// w = 2ᵏ m with m from √½ to √2, for normal w > 0: k, k in the place of the exponent, and m.
#[inline(always)]
fn split(w: f64) -> (f64, u64, f64) {
    const BIAS: u64 = 1024;
    let bits = w.to_bits();
    // Distance of the exponent field from that of √½, made positive; a mantissa above √2 moves to the next power.
    let field = bits.wrapping_sub(SQRT_HALF_BITS).wrapping_add(BIAS << MANTISSA) >> MANTISSA;
    let moved = field.wrapping_sub(BIAS) << MANTISSA;
    // A small whole number to double without a conversion instruction (AVX2 has none for 64 bits).
    let power = f64::from_bits(MAGIC.to_bits() | field) - (MAGIC + BIAS as f64);
    (power, moved, f64::from_bits(bits.wrapping_sub(moved)))
}

/// A logarithm in pieces: ln w = k ln 2 + 2 artanh(q), artanh as an odd series.
#[derive(Clone, Copy)]
pub(crate) struct Logarithm {
    /// k: whole, w = 2ᵏ m with m from √½ to √2.
    pub(crate) power: f64,
    /// q = (m − 1)/(m + 1), |q| ≤ 0.1716.
    pub(crate) quotient: f64,
    /// (2 artanh(q) − 2 q)/q², near 2q/3.
    pub(crate) tail: f64,
}

impl Logarithm {
    /// The pieces of ln(1 + z) for −1 < z ≤ 1e308. What 1 + z loses in rounding is put back.
    #[inline(always)]
    pub(crate) fn of_one_plus(z: f64) -> Self {
        let w = 1.0 + z;
        let lost = z - (w - 1.0);
        let (power, moved, m) = split(w);
        let scale = f64::from_bits(1f64.to_bits().wrapping_sub(moved));
        Self::of_mantissa(power, (m - 1.0) + lost * scale)
    }

    /// The pieces of k ln 2 + ln(1 + f) for 1 + f from √½ to √2.
    #[inline(always)]
    fn of_mantissa(power: f64, f: f64) -> Self {
        let q = f / (2.0 + f);
        let square = q * q;
        // FreeBSD's Lg1 … Lg7, error below 2^-58.45.
        let fourth = square * square;
        let first = 6.666_666_666_666_735e-1 + 3.999_999_999_940_942e-1 * square;
        let second = 2.857_142_874_366_239e-1 + 2.222_219_843_214_978_4e-1 * square;
        let third = 1.818_357_216_161_805e-1 + 1.531_383_769_920_937_3e-1 * square;
        let series = first + (second + (third + 1.479_819_860_511_658_6e-1 * fourth) * fourth) * fourth;
        Self {
            power,
            quotient: q,
            tail: series * q,
        }
    }

    /// The logarithm itself.
    #[inline(always)]
    pub(crate) fn value(self) -> f64 {
        let Self { power, quotient, tail } = self;
        power * LN_2_HIGH + (2.0 * quotient + (tail * quotient * quotient + power * LN_2_LOW))
    }
}

/// Natural logarithm of a normal positive number.
#[inline(always)]
pub(crate) fn ln(w: f64) -> f64 {
    let (power, _, m) = split(w);
    Logarithm::of_mantissa(power, m - 1.0).value()
}

/// ln(1 + z) for −1 < z ≤ 1e308, as accurate near z = 0 as elsewhere.
#[inline(always)]
pub(crate) fn ln_1p(z: f64) -> f64 {
    Logarithm::of_one_plus(z).value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::assert_close;
    use std::f64::consts::SQRT_2;

    const COUNT: i32 = 200_000;

    /// Of these one in so many: an interpreter that looks for undefined behaviour needs no more.
    const STEP: usize = if cfg!(miri) { 1999 } else { 1 };

    #[test]
    fn exponential_matches_the_standard_library() {
        for i in (0..COUNT).step_by(STEP) {
            let x = 709.0 - f64::from(i) * 0.007_047;
            let expected = if x < -708.0 { 0.0 } else { x.exp() };
            assert_close(exp(x), expected, 4e-16, "exp");
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!((exp(-708.1), exp(f64::NEG_INFINITY)), (0.0, 0.0));
        assert_eq!((exp(710.0), exp(f64::INFINITY)), (exp(709.0), exp(709.0)));
        assert!(exp(f64::NAN).is_nan());
    }

    #[test]
    fn exponential_less_one_matches_the_standard_library() {
        for i in (0..COUNT).step_by(STEP) {
            let x = 10f64.powf(f64::from(i) * 9e-5 - 15.2);
            for x in [x, -x] {
                let expected = if x < -708.0 { -1.0 } else { x.exp_m1() };
                assert!(x > 709.0 || (exp_m1(x) - expected).abs() <= 5e-16 * expected.abs(), "{x:e}");
            }
        }
        assert_eq!((exp_m1(0.0), exp_m1(-1e300), exp_m1(1e-300)), (0.0, -1.0, 1e-300));
        assert!(exp_m1(f64::NAN).is_nan());
    }

    #[test]
    fn logarithm_matches_the_standard_library() {
        for i in (0..COUNT).step_by(STEP) {
            let w = 10f64.powf(f64::from(i) * 3.07e-3 - 307.0);
            assert_close(ln(w), w.ln(), 4e-16, "ln");
            let near = 0.5 + 1.5 * f64::from(i) / f64::from(COUNT);
            assert_close(ln(near), near.ln(), 4e-16, "ln");
        }
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(f64::MAX), f64::MAX.ln());
        assert_eq!(ln(f64::MIN_POSITIVE), f64::MIN_POSITIVE.ln());
    }

    #[test]
    fn logarithm_of_one_plus_matches_the_standard_library() {
        for i in (0..COUNT).step_by(STEP) {
            let z = 10f64.powf(f64::from(i) * 1.6e-3 - 15.0);
            assert_close(ln_1p(z), z.ln_1p(), 4e-16, "ln_1p");
            let negative = -10f64.powf(f64::from(i) * -8e-5);
            if negative > -1.0 {
                assert_close(ln_1p(negative), negative.ln_1p(), 4e-16, "ln_1p");
            }
        }
        assert_eq!(ln_1p(0.0), 0.0);
        assert_eq!(ln_1p(1e-300), 1e-300);
        assert_eq!(ln_1p(1e308), 1e308f64.ln());
        assert_close(ln_1p(-1.0 + f64::EPSILON), (-1.0 + f64::EPSILON).ln_1p(), 4e-16, "ln_1p");
    }

    /// The reduction leaves |q| ≤ (√2 − 1)/(√2 + 1), where the series was fitted.
    #[test]
    fn quotients_stay_in_the_range_of_the_series() {
        let widest = (SQRT_2 - 1.0) / (SQRT_2 + 1.0) * (1.0 + 1e-15);
        for i in (0..COUNT).step_by(STEP) {
            let pieces = Logarithm::of_one_plus(f64::from(i) * 0.01);
            assert!(pieces.quotient.abs() <= widest && pieces.power.fract() == 0.0);
        }
    }
}
