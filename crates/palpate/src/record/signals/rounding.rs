//! The step that values were rounded to.

use std::convert::Infallible;

/// The smallest common step of values: all their differences are whole multiples of it. `None` where there is none that
/// stands out from the rounding of floating-point numbers, as in values that were computed.
///
/// A converter of 12 bits leaves such a step, and so does a text with a fixed number of decimals. Differences of
/// neighbours in order of size are multiples of the step, and their greatest common divisor (Euclid's, with a tolerance)
/// is the step, even where no two values are one step apart. Costs O(n log n).
///
/// ```
/// use palpate::record::rounding_step;
/// let values: Vec<f64> = (0..50).map(|i| f64::from(i * i % 37) * 0.004 - 0.1).collect();
/// assert!((rounding_step(&values).unwrap() - 0.004).abs() < 1e-12);
/// assert_eq!(rounding_step(&(0..50).map(|i| f64::from(i).sqrt()).collect::<Vec<_>>()), None);
/// ```
#[must_use]
pub fn rounding_step(values: &[f64]) -> Option<f64> {
    let Ok(step) = rounding_step_heard(values, &mut || Ok::<(), Infallible>(()));
    step
}

/// The same, where `hear` says in between whether to go on.
pub(super) fn rounding_step_heard<E>(
    values: &[f64],
    hear: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Option<f64>, E> {
    /// Fewest differences that show a step.
    const FEWEST: usize = 4;
    /// A step below this share of the range is that of decimals that nobody measured.
    const FINEST: f64 = 1e-7;
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    hear()?;
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
        return Ok(None);
    };
    let largest = low.abs().max(high.abs());
    // What a decimal loses on its way to a double and through a scaling, twice.
    let rounding = 8.0 * f64::EPSILON * largest;
    let least = rounding.max(FINEST * (high - low));
    let mut differences: Vec<f64> = sorted
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|difference| *difference > rounding)
        .collect();
    if differences.len() < FEWEST {
        return Ok(None);
    }
    differences.sort_unstable_by(f64::total_cmp);
    hear()?;
    let mut step = differences[0];
    for difference in &differences {
        step = divisor(*difference, step, rounding.max(0.02 * step.min(least)));
        if step < least {
            return Ok(None);
        }
    }
    Ok(Some(refined(&differences, step)))
}

/// Greatest common divisor of two positive numbers that are multiples of it to within `tolerance`.
fn divisor(a: f64, b: f64, tolerance: f64) -> f64 {
    let (mut a, mut b) = (a, b);
    loop {
        let rest = (a - (a / b).round() * b).abs();
        // A difference of k steps carries the error of the step k times.
        if rest <= tolerance * (a / b).max(1.0) {
            return b;
        }
        (a, b) = (b, rest);
    }
}

/// The step that the short ones among differences in order of size have on average.
fn refined(differences: &[f64], step: f64) -> f64 {
    // Values may all be many steps apart.
    let longest = differences[0].max(20.5 * step);
    let short = differences.iter().filter(|difference| **difference <= longest);
    let (sum, steps) = short.fold((0.0, 0.0), |(sum, steps), d| (sum + d, steps + (d / step).round()));
    sum / steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_of_a_text_are_a_step() {
        for digits in [0, 1, 2, 4] {
            let text = |i: u32| format!("{:.digits$}", 3.0 * (0.37 * f64::from(i)).sin()).parse::<f64>().unwrap();
            let values: Vec<f64> = (0..2000).map(text).collect();
            let step = rounding_step(&values).unwrap();
            assert!((step / 10f64.powi(-(digits as i32)) - 1.0).abs() < 1e-9, "{digits}: {step}");
            let scaled: Vec<f64> = values.iter().map(|value| value / 1000.0).collect();
            let step = rounding_step(&scaled).unwrap();
            assert!((step / 10f64.powi(-3 - (digits as i32)) - 1.0).abs() < 1e-9, "{digits}: {step}");
        }
    }

    #[test]
    fn no_two_values_need_be_one_step_apart() {
        let values: Vec<f64> = [0, 4, 10, 14, 24, 28, 34].map(|k| 0.3 * f64::from(k)).to_vec();
        assert!((rounding_step(&values).unwrap() - 0.6).abs() < 1e-12);
        let values: Vec<f64> = [0, 6, 10, 25, 31, 41].map(|k| 0.3 * f64::from(k)).to_vec();
        assert!((rounding_step(&values).unwrap() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn all_values_may_be_many_steps_apart() {
        let values: Vec<f64> = [0, 101, 252, 375, 1003, 2041, 4000].map(|k| 1e-3 * f64::from(k)).to_vec();
        assert!((rounding_step(&values).unwrap() / 1e-3 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn computed_values_have_none() {
        assert_eq!(rounding_step(&(0..5000).map(|i| (0.01 * f64::from(i)).exp()).collect::<Vec<_>>()), None);
        assert_eq!(rounding_step(&[1.0; 100]), None);
        assert_eq!(rounding_step(&[]), None);
        assert_eq!(rounding_step(&[f64::NAN, 1.0, 2.0]), None);
    }
}
