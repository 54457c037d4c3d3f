//! The tail of the normal distribution without branches.

/// Where t = 5/(5 + z) divides z from 0 to ∞ evenly for the series.
const MIDDLE: f64 = 5.0;

/// Q(z) e^{z²/2}/t in powers of 2t − 1: Chebyshev's series of degree 20, of which the terms left out are below 1.2e-15.
const SERIES: [f64; 21] = [
    0.153_838_609_950_012_58,
    0.133_076_500_578_013_68,
    0.099_061_123_193_998_75,
    0.062_706_631_334_087_23,
    0.033_004_073_233_821_47,
    0.013_823_727_745_090_612,
    0.004_159_013_365_495_867,
    0.000_598_675_314_943_832_3,
    -0.000_159_573_934_220_685_52,
    -0.000_108_979_589_335_549_97,
    -1.187_485_091_476_740_1e-5,
    9.951_778_813_458_968e-6,
    3.335_294_408_236_903_4e-6,
    -7.944_080_976_337_71e-7,
    -5.519_749_894_306_453e-7,
    6.469_950_324_937_218e-8,
    8.436_038_554_805_549e-8,
    -5.965_718_040_188_528e-9,
    -1.162_815_263_092_233_2e-8,
    4.725_559_777_974_452e-10,
    1.030_298_459_879_204_6e-9,
];

/// Q(z) e^{z²/2} for z ≥ 0, with Q(z) the probability that a standard normal number is above z; within 2e-15 of itself.
#[inline(always)]
pub(crate) fn scaled_tail(z: f64) -> f64 {
    let t = MIDDLE / (MIDDLE + z);
    let s = 2.0 * t - 1.0;
    // Triples of terms side by side, so that additions need not wait for each other; without a loop, for the sake of vector code.
    let (square, cube) = (s * s, s * s * s);
    let triple = |first: usize| SERIES[first] + SERIES[first + 1] * s + SERIES[first + 2] * square;
    let sixth = cube * cube;
    let six = |first: usize| triple(first) + triple(first + 3) * cube;
    t * (six(0) + (six(6) + (six(12) + triple(18) * sixth) * sixth) * sixth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::assert_close;

    /// mpmath: exp(z²/2) erfc(z/√2)/2 to 17 digits.
    #[test]
    fn tails_are_those_of_mpmath() {
        for (z, expected) in [
            (0.0, 0.5),
            (0.1, 0.462_478_785_287_535_6),
            (1.0, 0.261_578_291_865_123_4),
            (1.959_963_984_540_054, 0.170_648_389_048_147_58),
            (5.0, 0.076_919_304_975_006_29),
            (38.0, 0.010_491_225_699_639_976),
        ] {
            assert_close(scaled_tail(z), expected, 2e-15, "tail");
        }
        assert_eq!(scaled_tail(f64::INFINITY), 0.0);
        assert!(scaled_tail(f64::NAN).is_nan());
    }
}
