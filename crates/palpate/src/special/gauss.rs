//! Legendre's polynomials and Gauss's rule.

/// P₀ … P_(N−1) at x, N ≥ 2.
pub(crate) fn legendre<const N: usize>(x: f64) -> [f64; N] {
    let mut values = [1.0; N];
    values[1] = x;
    for k in 2..N {
        values[k] = ((2 * k - 1) as f64 * x * values[k - 1] - (k - 1) as f64 * values[k - 2]) / k as f64;
    }
    values
}

/// Nodes and weights of Gauss's rule on [−1, 1]: zeros of P_N by Newton's method from Tricomi's guess.
pub(crate) fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    std::array::from_fn(|i| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=N {
                (before, value) = (value, ((2 * k - 1) as f64 * x * value - (k - 1) as f64 * before) / k as f64);
            }
            slope = N as f64 * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_rule_is_that_of_the_tables() {
        let rule = gauss_legendre::<8>();
        let expected = (0.183_434_642_495_649_8, 0.362_683_783_378_362);
        assert!((rule[3].0 - expected.0).abs() < 1e-15 && (rule[3].1 - expected.1).abs() < 1e-15, "{rule:?}");
    }
}
