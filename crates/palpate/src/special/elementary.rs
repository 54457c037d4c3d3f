//! Exponential and logarithm without a branch, which the compiler turns into vector code.

/// Added to a small number, leaves it rounded to a whole one in the low bits.
const MAGIC: f64 = 6_755_399_441_055_744.0;
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// Applies `f` in blocks of eight, which the compiler unrolls into vector registers.
#[inline(always)]
pub(crate) fn map(values: &mut [f64], f: impl Fn(f64) -> f64) {
    let (blocks, rest) = values.as_chunks_mut::<8>();
    for block in blocks {
        for slot in block {
            *slot = f(*slot);
        }
    }
    for slot in rest {
        *slot = f(*slot);
    }
}

/// ln(1 + z) for z ≥ 0 without a branch: ln of the rounded sum plus the first-order correction for its rounding.
#[inline(always)]
pub(crate) fn ln_1p(z: f64) -> f64 {
    let w = 1.0 + z;
    let lost = z - (w - 1.0);
    ln(w) + lost / w
}

/// Natural logarithm of a finite, normal w > 0, no branch: w = 2ᵏ m with m in [√½, √2), then
/// ln m = 2 artanh((m − 1)/(m + 1)) as an odd series. Relative error below 4e-16 for w ≥ 1 and w ≤ ½.
#[inline(always)]
pub(crate) fn ln(w: f64) -> f64 {
    const SQRT_HALF_BITS: u64 = 0x3fe6_a09e_667f_3bcd;
    /// Keeps the distance of exponents positive; a multiple of 2⁵².
    const OFFSET: u64 = 1023;
    let bits = w.to_bits();
    // Distance of the exponent field from that of √½; a mantissa above √2 moves to the next power.
    let shifted = bits.wrapping_add(OFFSET << 52).wrapping_sub(SQRT_HALF_BITS);
    let k = (shifted >> 52) & 0xfff;
    let m = f64::from_bits(bits.wrapping_add(OFFSET << 52).wrapping_sub(k << 52));
    // A small whole number to double without a conversion instruction (AVX2 has none for 64 bits).
    let k = f64::from_bits(MAGIC.to_bits() | k) - (MAGIC + OFFSET as f64);
    let f = m - 1.0;
    let q = f / (2.0 + f);
    let q2 = q * q;
    // 2 artanh(q) = 2q + 2q³/3 + 2q⁵/5 + …; |q| ≤ 0.1716, so q²² / 23 is below 1e-18.
    let mut series = 2.0 / 23.0;
    series = series * q2 + 2.0 / 21.0;
    series = series * q2 + 2.0 / 19.0;
    series = series * q2 + 2.0 / 17.0;
    series = series * q2 + 2.0 / 15.0;
    series = series * q2 + 2.0 / 13.0;
    series = series * q2 + 2.0 / 11.0;
    series = series * q2 + 2.0 / 9.0;
    series = series * q2 + 2.0 / 7.0;
    series = series * q2 + 2.0 / 5.0;
    series = series * q2 + 2.0 / 3.0;
    let tail = series * q2 * q;
    k * LN_2_HIGH + (2.0 * q + (tail + k * LN_2_LOW))
}

/// eˣ for x ≤ 700 without a branch; results below 1e-304 are returned as 0.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    const LOWEST: f64 = -700.0;
    let clamped = if x < LOWEST { LOWEST } else { x };
    let shifted = clamped * std::f64::consts::LOG2_E + MAGIC;
    let k = shifted - MAGIC;
    let r = (clamped - k * LN_2_HIGH) - k * LN_2_LOW;
    // Taylor series on |r| ≤ ln 2 / 2: r¹⁴/14! is below 1e-17.
    let mut series = 1.0 / 6_227_020_800.0;
    series = series * r + 1.0 / 479_001_600.0;
    series = series * r + 1.0 / 39_916_800.0;
    series = series * r + 1.0 / 3_628_800.0;
    series = series * r + 1.0 / 362_880.0;
    series = series * r + 1.0 / 40_320.0;
    series = series * r + 1.0 / 5_040.0;
    series = series * r + 1.0 / 720.0;
    series = series * r + 1.0 / 120.0;
    series = series * r + 1.0 / 24.0;
    series = series * r + 1.0 / 6.0;
    series = series * r + 0.5;
    let value = 1.0 + (r + r * r * series);
    let power = (shifted.to_bits() << 52).wrapping_add(1f64.to_bits());
    let scaled = value * f64::from_bits(power);
    if x < LOWEST { 0.0 } else { scaled }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_exponential_and_logarithm_match_the_standard_library() {
        for i in 0..200_000 {
            let x = -f64::from(i) * 0.003_471;
            let expected = if x < -700.0 { 0.0 } else { x.exp() };
            assert!((exp(x) - expected).abs() <= 4e-16 * expected, "exp({x})");
            assert!((exp(-x.max(-700.0)) - (-x.max(-700.0)).exp()).abs() <= 4e-16 * (-x).exp(), "exp({})", -x);
        }
        for i in 0..200_000 {
            let z = 10f64.powf(f64::from(i) * 1.5e-4 - 15.0);
            assert!((ln_1p(z) - z.ln_1p()).abs() <= 6e-16 * z.ln_1p(), "ln_1p({z})");
        }
        for i in 0..60_000 {
            let w = 10f64.powf(f64::from(i) * 1e-2 - 300.0);
            assert!((ln(w) - w.ln()).abs() <= 4e-16 * w.ln().abs() + 1e-16, "ln({w})");
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln_1p(0.0), 0.0);
    }
}
