//! Values between samples.

/// `values` given at rising `knots`, linearly interpolated at rising `times` that lie inside them.
pub(super) fn interpolated(knots: &[f64], values: &[f64], times: &[f64]) -> Vec<f64> {
    let mut after = 1;
    let at = |time: f64| {
        while after + 1 < knots.len() && knots[after] < time {
            after += 1;
        }
        let (t0, t1) = (knots[after - 1], knots[after]);
        let share = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
        values[after - 1] + share * (values[after] - values[after - 1])
    };
    times.iter().copied().map(at).collect()
}
