//! Elementary functions in single precision, without branches, which the compiler turns into vector code.
//!
//! The exponential is that of Moshier's Cephes (`expf.c`), the logarithm that of FreeBSD's msun (`e_logf.c`); both are accurate to
//! two units in the last place. No result is a subnormal number.

const LN_2_HIGH: f32 = 0.693_359_4;
const LN_2_LOW: f32 = -2.121_944_4e-4;
/// 1.5 · 2²³: a small whole number added to it stands in the lowest bits.
const MAGIC: f32 = 12_582_912.0;
const SQRT_HALF_BITS: i32 = 0x3f35_04f3;
const MANTISSA: u32 = 23;

const LOWEST: f32 = -87.0;
const HIGHEST: f32 = 88.0;

/// eˣ; below x = −87 (2e-38) it is 0, above 88 it stays at e⁸⁸ = 1.7e38.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    let (series, power) = reduced(clamped(x));
    let scaled = (1.0 + series) * power;
    if x < LOWEST { 0.0 } else { scaled }
}

/// eˣ − 1, as accurate near x = 0 as elsewhere; −1 below x = −87, and above 88 it stays at e⁸⁸.
#[inline(always)]
pub(crate) fn exp_m1(x: f32) -> f32 {
    let (series, power) = reduced(clamped(x));
    // With power = 1 nothing cancels; otherwise the result is no smaller than a quarter.
    (power - 1.0) + series * power
}

#[inline(always)]
fn clamped(x: f32) -> f32 {
    let x = if x < LOWEST { LOWEST } else { x };
    if x > HIGHEST { HIGHEST } else { x }
}

/// eʳ − 1 and 2ᵏ with x = k ln 2 + r and |r| ≤ ln 2 / 2.
#[inline(always)]
fn reduced(x: f32) -> (f32, f32) {
    let shifted = x * std::f32::consts::LOG2_E + MAGIC;
    let k = shifted - MAGIC;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let square = r * r;
    let low = 0.5 + 1.666_666_5e-1 * r;
    let middle = 4.166_579_6e-2 + 8.333_452e-3 * r;
    let high = 1.398_199_9e-3 + 1.987_569_1e-4 * r;
    let series = low + (middle + high * square) * square;
    let power = f32::from_bits((shifted.to_bits() << MANTISSA).wrapping_add(1f32.to_bits()));
    (r + square * series, power)
}

/// ln(w + lost) of a normal w > 0 and of what rounding took from it.
#[inline(always)]
pub(crate) fn ln_of_sum(w: f32, lost: f32) -> f32 {
    // w = 2ᵏ m with m from √½ to √2.
    let bits = w.to_bits().cast_signed();
    let power = bits.wrapping_sub(SQRT_HALF_BITS) >> MANTISSA;
    let moved = power << MANTISSA;
    let mantissa = f32::from_bits(bits.wrapping_sub(moved).cast_unsigned());
    let scale = f32::from_bits(1f32.to_bits().cast_signed().wrapping_sub(moved).cast_unsigned());
    let f = (mantissa - 1.0) + lost * scale;
    let k = power as f32;
    let s = f / (2.0 + f);
    let square = s * s;
    let fourth = square * square;
    let series = square * (0.666_666_6 + 0.284_987_87 * fourth) + fourth * (0.400_009_72 + 0.242_790_79 * fourth);
    let half = 0.5 * f * f;
    k * 0.693_138_1 - ((half - (s * (half + series) + k * 9.058_001e-6)) - f)
}

/// Natural logarithm of a normal positive number.
#[inline(always)]
pub(crate) fn ln(w: f32) -> f32 {
    ln_of_sum(w, 0.0)
}

/// ln(1 + z) for −1 < z ≤ 1e37, as accurate near z = 0 as elsewhere.
#[inline(always)]
pub(crate) fn ln_1p(z: f32) -> f32 {
    let w = 1.0 + z;
    ln_of_sum(w, z - (w - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: i32 = 200_000;

    /// Two units in the last place, against double precision.
    fn assert_close(found: f32, expected: f64, what: &str) {
        assert!(
            (f64::from(found) - expected).abs() <= 2.4e-7 * expected.abs(),
            "{what}: {found:e}, expected {expected:e}"
        );
    }

    #[test]
    fn exponential_matches_double_precision() {
        for i in 0..COUNT {
            let x = 88.0 - i as f32 * 8.7e-4;
            let expected = if x < -87.0 { 0.0 } else { f64::from(x).exp() };
            assert_close(exp(x), expected, "exp");
            let small = 10f32.powf(i as f32 * 1.9e-4 - 37.0);
            for x in [x, small, -small] {
                let expected = if x < -87.0 { -1.0 } else { f64::from(x).exp_m1() };
                assert_close(exp_m1(x), expected, "exp_m1");
            }
        }
        assert_eq!((exp(0.0), exp_m1(0.0), exp(-87.1), exp_m1(-1e30)), (1.0, 0.0, 0.0, -1.0));
        assert_eq!((exp(90.0), exp(f32::INFINITY)), (exp(88.0), exp(88.0)));
        assert!(exp(f32::NAN).is_nan() && exp_m1(f32::NAN).is_nan());
    }

    #[test]
    fn logarithm_matches_double_precision() {
        for i in 0..COUNT {
            let w = 10f32.powf(i as f32 * 3.7e-4 - 37.0);
            assert_close(ln(w), f64::from(w).ln(), "ln");
            assert_close(ln_1p(w), f64::from(w).ln_1p(), "ln_1p");
            let near = 0.5 + 1.5 * i as f32 / COUNT as f32;
            assert_close(ln(near), f64::from(near).ln(), "ln");
            let negative = -10f32.powf(i as f32 * -1.8e-4);
            if negative > -1.0 {
                assert_close(ln_1p(negative), f64::from(negative).ln_1p(), "ln_1p");
            }
        }
        assert_eq!((ln(1.0), ln_1p(0.0), ln_1p(1e-37)), (0.0, 0.0, 1e-37));
    }
}
