//! The exponential integral E1 and its entire part Ein.
//!
//! statrs has E1 too, right to 1e-14, but its continued fraction takes 125 ns and for some arguments finds no end.

use crate::vector::elementary::exp;

/// Euler's constant γ.
const EULER: f64 = 0.577_215_664_901_532_9;

/// (u, w) with eˣ E1(x) = ∫ e^(−u)/(x + u) du = Σ w/(x + u) for x ≥ 1, to 6e-16: a Gauss rule in u/(u + 4.5),
/// computed by `validation/special_functions.py`. All are positive, so nothing cancels.
#[rustfmt::skip]
pub(super) const RULE: [(f64, f64); 16] = [
    (0.015_907_394_156_962_965, 0.040_256_400_470_872_05),
    (0.084_505_983_828_522_58, 0.088_942_039_271_669_02),
    (0.210_787_199_329_583_8, 0.126_858_969_056_693),
    (0.399_891_500_307_515_63, 0.149_418_328_691_911_4),
    (0.659_672_100_728_012_7, 0.154_342_978_670_237_8),
    (1.001_275_965_951_822_4, 0.142_264_672_808_617_54),
    (1.439_971_159_605_171_9, 0.116_946_916_606_075_44),
    (1.996_337_872_337_612_8, 0.084_719_878_269_765_86),
    (2.697_992_213_344_059, 0.052_911_846_979_906_51),
    (3.582_142_807_571_593_8, 0.027_563_570_569_802_236),
    (4.699_562_946_431_251, 0.011_424_626_729_577_576),
    (6.121_229_670_074_639, 0.003_523_390_543_437_105_6),
    (7.950_655_627_348_062, 0.000_733_178_652_596_734_3),
    (10.350_452_552_441_888, 8.841_675_057_324_172e-05),
    (13.613_527_697_976_691, 4.725_660_667_564_163e-06),
    (18.444_801_663_581_753, 6.026_759_638_322_465e-08),
];

/// E1(x) = ∫ₓ^∞ e^(−u)/u du for x > 0 (dimensionless), with e^(−x), at no cost.
///
/// Relative error below 1e-14; 0 from x = 700 on. E1(1) = 0.219 383 934 395 520 27. Abramowitz and Stegun 5.1.1.
///
/// ```
/// use palpate::special::exponential_integral;
/// assert!((exponential_integral(1.0).0 - 0.219_383_934_395_520_27).abs() < 1e-15);
/// ```
#[must_use]
#[inline]
pub fn exponential_integral(x: f64) -> (f64, f64) {
    let exponential = exp(-x);
    if x < 1.0 {
        return (entire_exponential_integral(x) - EULER - x.ln(), exponential);
    }
    // Four sums side by side keep the divider busy.
    let mut sums = [0.0; 4];
    for four in RULE.as_chunks::<4>().0 {
        for (sum, (u, w)) in sums.iter_mut().zip(four) {
            *sum += w / (x + u);
        }
    }
    (exponential * ((sums[0] + sums[2]) + (sums[1] + sums[3])), exponential)
}

/// Ein(x) = ∫₀ˣ (1 − e^(−u))/u du = E1(x) + γ + ln x = Σ −(−x)^k/(k k!), for 0 ≤ x ≤ 1.
#[must_use]
#[inline]
pub(super) fn entire_exponential_integral(x: f64) -> f64 {
    // Odd and even powers apart, two short chains instead of a long one. 1/(19·19!) is below 1e-18.
    let square = x * x;
    let (mut odd, mut even) = (0.0, 0.0);
    for pair in SERIES.as_chunks::<2>().0.iter().rev() {
        odd = odd * square + pair[0];
        even = even * square + pair[1];
    }
    x * (odd - x * even)
}

/// 1/(k k!) from k = 1 on.
const SERIES: [f64; 18] = {
    let mut terms = [0.0; 18];
    let (mut k, mut factorial) = (1, 1.0);
    while k <= 18 {
        factorial *= k as f64;
        terms[k - 1] = 1.0 / (k as f64 * factorial);
        k += 1;
    }
    terms
};
