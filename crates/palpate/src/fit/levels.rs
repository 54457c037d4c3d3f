//! Values that were rounded.

/// The step of values that were rounded to few levels, on which most of them lie; 0 where there is none. Values that occur once, as outliers do, do not
/// count.
pub(crate) fn step_between_levels(values: &[f64]) -> f64 {
    /// Fewest levels that show a step: a level and dropouts to zero are two.
    const FEWEST: usize = 4;
    /// Samples of which at least one equals the next, in values so rounded that it matters.
    const SELDOM: usize = 8;
    let repeats = values.windows(2).map(|pair| usize::from(pair[0] == pair[1])).sum::<usize>();
    if repeats * SELDOM < values.len() {
        return 0.0;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (mut levels, mut on_levels) = (Vec::new(), 0);
    for same in sorted.chunk_by(|a, b| a == b).filter(|same| same.len() > 1) {
        levels.push(same[0]);
        on_levels += same.len();
    }
    let (Some(low), Some(high)) = (levels.first(), levels.last()) else {
        return 0.0;
    };
    if levels.len() < FEWEST || 2 * on_levels <= values.len() {
        return 0.0;
    }
    // Levels that differ by less are one, rounded.
    let rounding = 1e-9 * low.abs().max(high.abs());
    let step = levels
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| *step > rounding)
        .fold(f64::INFINITY, f64::min);
    if step.is_finite() { step } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::step_between_levels;

    #[test]
    fn levels_of_most_samples_show_a_step() {
        let mut rounded: Vec<f64> = (0..60).map(|i| 0.2 * f64::from(i / 3 % 6)).collect();
        rounded[10] = 7.77;
        assert!((step_between_levels(&rounded) - 0.2).abs() < 1e-12);
        let smooth: Vec<f64> = (0..60).map(|i| f64::from(i).sqrt()).collect();
        let dropouts: Vec<f64> = (0..60).map(|i| if i % 9 == 0 { 0.0 } else { 50.0 }).collect();
        for values in [smooth, dropouts, Vec::new()] {
            assert_eq!(step_between_levels(&values), 0.0);
        }
    }
}
