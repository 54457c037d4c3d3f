//! How far noise sums up over blocks of neighbours, whatever its model.

use crate::statistics::dot;

/// Blocks for each parameter, at least: their number is what the sums are divided by.
const FEWEST: usize = 4;

/// JᵀVJ from sums over blocks of neighbours: Σ_b s_b s_bᵀ with s_b = Σ_{i in b} J_i e_i, for as many blocks as samples in each, which are longer than
/// noise of such residuals remembers; times B/(B − p), as residuals lack what B blocks and p parameters take up. `None` of few blocks.
pub(super) fn by_blocks(columns: &[&[f64]], residuals: &[f64]) -> Option<Vec<f64>> {
    let size = columns.len();
    let length = residuals.len().isqrt().max(1);
    let blocks = residuals.len() / length;
    if blocks < FEWEST * size {
        return None;
    }
    let mut filling = vec![0.0; size * size];
    let mut sums = vec![0.0; size];
    for block in 0..blocks {
        // The last takes the rest.
        let end = if block + 1 == blocks { residuals.len() } else { (block + 1) * length };
        let own = block * length..end;
        sums.iter_mut()
            .zip(columns)
            .for_each(|(sum, column)| *sum = dot(&column[own.clone()], &residuals[own.clone()]));
        for (row, one) in filling.chunks_exact_mut(size).zip(&sums) {
            row.iter_mut().zip(&sums).for_each(|(entry, other)| *entry += one * other);
        }
    }
    let counts = blocks as f64 / (blocks - size) as f64;
    filling.iter_mut().for_each(|entry| *entry *= counts);
    Some(filling)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::Rng;

    #[test]
    fn blocks_know_how_noise_sums_up() {
        // The mean of noise that repeats each value four times has four times the variance of that of white noise.
        let ones = vec![1.0; 1600];
        let ratio = |repeats: usize| {
            let of_seed = |seed: u64| {
                let mut random = Rng::new(seed);
                let noise: Vec<f64> = (0..1600 / repeats).flat_map(|_| vec![random.normal(); repeats]).collect();
                let middle = noise.iter().sum::<f64>() / 1600.0;
                let left: Vec<f64> = noise.iter().map(|value| value - middle).collect();
                by_blocks(&[&ones], &left).unwrap()[0] / 1600.0
            };
            (0..100).map(of_seed).sum::<f64>() / 100.0
        };
        // 40 blocks each, 100 times: 4 %.
        for (repeats, expected) in [(1, 1.0), (4, 4.0)] {
            let found = ratio(repeats) / expected;
            assert!((found - 1.0).abs() < 0.12, "{repeats}: {found}");
        }
        assert!(by_blocks(&[&ones[..9]], &[1.0; 9]).is_none());
    }
}
