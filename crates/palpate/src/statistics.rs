//! Statistics that several steps share: means over specimens, medians, quantiles, noise.

pub(crate) use crate::vector::dot;
use std::cell::Cell;

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Mean and scatter of independent values, such as a parameter over the specimens of a material (ISO 2602).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleMean {
    /// Number of values, N.
    pub count: usize,
    /// x̄ = Σx/N.
    pub mean: f64,
    /// s = √(Σ(x − x̄)²/(N − 1)); `None` for one value.
    pub standard_deviation: Option<f64>,
    /// Confidence interval of the mean of all specimens, x̄ ± t s/√N with Student's t for N − 1 degrees of freedom; `None` for one value.
    pub interval: Option<(f64, f64)>,
    /// Whether all of this is that of the logarithms, taken back.
    pub is_geometric: bool,
}

impl SampleMean {
    /// Of all finite values, with intervals of this coverage, between 0 and 1; `None` without one.
    ///
    /// ```
    /// use palpate::statistics::SampleMean;
    /// let found = SampleMean::of(&[20.1, 21.3, 19.7, 20.9], 0.95).unwrap();
    /// assert_eq!((found.count, found.mean), (4, 20.5));
    /// assert!((found.standard_deviation.unwrap() - 0.730_297).abs() < 1e-6);
    /// // t = 3.182446 for 3 degrees of freedom.
    /// let (low, high) = found.interval.unwrap();
    /// assert!((low - 19.337_936).abs() < 1e-5 && (high - 21.662_064).abs() < 1e-5);
    /// assert_eq!(SampleMean::of(&[5.0], 0.95).unwrap().interval, None);
    /// assert_eq!(SampleMean::of(&[f64::NAN], 0.95), None);
    /// ```
    #[must_use]
    pub fn of(values: &[f64], confidence: f64) -> Option<Self> {
        let values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let freedom = count.checked_sub(1)? as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (freedom > 0.0).then(|| (squares / freedom).sqrt());
        let half = deviation.map(|deviation| coverage_factor(confidence, freedom) * deviation / (count as f64).sqrt());
        Some(Self {
            count,
            mean,
            standard_deviation: deviation,
            interval: half.map(|half| (mean - half, mean + half)),
            is_geometric: false,
        })
    }

    /// The same of the natural logarithms, for positive scales such as rates and times: the geometric mean exp(m) with the interval of m taken
    /// back, and the standard deviation of a log-normal variable of that geometric mean, exp(m) √(exp(s²) − 1), with m and s those of ln x. `None`
    /// where a value is not positive.
    ///
    /// ```
    /// use palpate::statistics::SampleMean;
    /// let found = SampleMean::geometric(&[1.0, 10.0, 100.0], 0.95).unwrap();
    /// assert!((found.mean - 10.0).abs() < 1e-12 && found.is_geometric);
    /// // ln x = 0, 2.302585, 4.60517: s = 2.302585, t = 4.302653.
    /// let (low, high) = found.interval.unwrap();
    /// assert!((low - 0.032_799).abs() < 1e-6 && (high - 3_048.86).abs() < 0.01);
    /// assert_eq!(SampleMean::geometric(&[1.0, -1.0], 0.95), None);
    /// ```
    #[must_use]
    pub fn geometric(values: &[f64], confidence: f64) -> Option<Self> {
        if values.iter().any(|value| *value <= 0.0) {
            return None;
        }
        let logarithms: Vec<f64> = values.iter().map(|value| value.ln()).collect();
        let found = Self::of(&logarithms, confidence)?;
        let mean = found.mean.exp();
        Some(Self {
            count: found.count,
            mean,
            standard_deviation: found.standard_deviation.map(|s| mean * (s * s).exp_m1().sqrt()),
            interval: found.interval.map(|(low, high)| (low.exp(), high.exp())),
            is_geometric: true,
        })
    }
}

/// Median; reorders `values`. NaN for an empty slice.
pub fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value that a share `share` of `values` lies below; reorders `values`. NaN for an empty slice.
pub(crate) fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let index = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(index, f64::total_cmp).1
}

/// The least and the greatest value.
pub(crate) fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)))
}

/// From the least to the greatest value.
pub(crate) fn range(values: &[f64]) -> f64 {
    let (low, high) = bounds(values);
    high - low
}

/// Arithmetic mean. NaN for an empty slice.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The slope of the least-squares line through points; not finite where all have one x.
pub(crate) fn slope(x: &[f64], y: &[f64]) -> f64 {
    let (middle, level) = (mean(x), mean(y));
    let square: f64 = x.iter().map(|x| (x - middle).powi(2)).sum();
    x.iter().zip(y).map(|(x, y)| (x - middle) * (y - level)).sum::<f64>() / square
}

/// Root of the mean square of measured less simulated.
pub(crate) fn rms(measured: &[f64], simulated: &[f64]) -> f64 {
    let square: f64 = measured.iter().zip(simulated).map(|(m, s)| (m - s).powi(2)).sum();
    (square / measured.len() as f64).sqrt()
}

/// Standard deviation of white noise on top of a signal that is straight over three samples.
///
/// From the median absolute second difference, so that ramps, holds and the odd spike do not count:
/// second differences of white noise have √6 times its deviation, and 0.6745 turns a median into a deviation.
/// A coarse signal that seldom moves has none of that; its rounding, the quantum over √12, is the least it can have.
/// Of a column that is read more often than it is updated the new values count.
pub(crate) fn noise(values: &[f64]) -> f64 {
    let new = updates(values).map(|rows| at(values, &rows));
    let values = new.as_deref().unwrap_or(values);
    if values.len() < 3 {
        return 0.0;
    }
    let mut second: Vec<f64> = values.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).collect();
    let step = quantum(values);
    let scatter = median_of_classes(&mut second, step) / (0.674_489_750_196_081_7 * 6f64.sqrt());
    scatter.max(step / 12f64.sqrt())
}

/// As [`noise`], for samples at these times: what an uneven clock does to a ramp is no noise.
pub(crate) fn noise_in_time(time: &[f64], values: &[f64]) -> f64 {
    if let Some(rows) = updates(values) {
        return noise_of_rows(&at(time, &rows), &at(values, &rows));
    }
    noise_of_rows(time, values)
}

fn noise_of_rows(time: &[f64], values: &[f64]) -> f64 {
    if values.len() < 3 {
        return 0.0;
    }
    let mut off: Vec<f64> = values
        .windows(3)
        .zip(time.windows(3))
        .map(|(v, t)| {
            let share = (t[1] - t[0]) / (t[2] - t[0]);
            let line = v[0] + share * (v[2] - v[0]);
            (v[1] - line).abs() / (1.0 + share * share + (1.0 - share) * (1.0 - share)).sqrt()
        })
        .collect();
    let step = quantum(values);
    // With even stamps these are multiples of half a step over √1.5.
    (median_of_classes(&mut off, step / 6f64.sqrt()) / 0.674_489_750_196_081_7).max(step / 12f64.sqrt())
}

/// The rows with the new values of a column that is read more often than it is updated, as that of a camera beside a machine. `None` where every row
/// may be new.
///
/// Of three signs two decide: values go to and fro by their noise; most last for about as many rows; and they were not rounded to steps that noise could
/// repeat. Steps of a coarse signal at constant speed are as regular, but go one way; where noise makes them, they are short as often as long.
pub(crate) fn updates(values: &[f64]) -> Option<Vec<usize>> {
    const FEWEST: usize = 20;
    /// Share of the values that are read more than once, at least.
    const REPEAT: f64 = 0.15;
    /// Share of the values that may last for a shorter time than they should.
    const SHORT: f64 = 0.1;
    /// Share of the changes that turn back, at least.
    const TURNS: f64 = 0.1;
    /// A value that lasts for so many usual times stayed.
    const STAYED: f64 = 4.0;
    // What differs by less has been averaged or printed in another order.
    let step = least_change(values);
    if step == 0.0 {
        return None;
    }
    let changes: Vec<usize> = (1..values.len()).filter(|row| (values[*row] - values[*row - 1]).abs() >= step).collect();
    let lengths: Vec<f64> = changes.windows(2).map(|pair| (pair[1] - pair[0]) as f64).collect();
    let share = |count: usize| count as f64 / changes.len() as f64;
    if changes.len() < FEWEST || share(lengths.iter().filter(|length| **length > 1.0).count()) < REPEAT {
        return None;
    }
    let change = |row: usize| values[row] - values[row - 1];
    let turns = changes.windows(2).filter(|pair| change(pair[0]) * change(pair[1]) < 0.0).count();
    let steps = changes.iter().filter(|row| change(**row).abs() < 1.5 * step).count();
    let is_fine = 3 * steps <= changes.len() && 2 * steps <= values.len() - changes.len();
    let least = quantile(&mut lengths.clone(), SHORT);
    let is_usual = |length: &f64| (least..2.0 * least).contains(length);
    let is_regular = least >= 2.0 && share(lengths.iter().filter(|length| is_usual(length)).count()) >= 0.5;
    if [share(turns) >= TURNS, is_fine, is_regular].iter().filter(|speaks| **speaks).count() < 2 {
        return None;
    }
    let stayed = if is_fine { STAYED * median(&mut lengths.clone()) } else { 2.0 * least };
    let period = mean(&lengths.into_iter().filter(|length| *length < stayed).collect::<Vec<f64>>());
    let starts = [0].into_iter().chain(changes.iter().copied());
    let ends = changes.iter().copied().chain([values.len()]);
    let updates = starts.zip(ends).flat_map(|(start, end)| {
        let length = (end - start) as f64;
        let count = if is_fine && length < stayed { 1 } else { (length / period).round().max(1.0) as usize };
        (0..count).map(move |update| start + (end - start) * update / count)
    });
    Some(updates.collect())
}

/// A column at some of its rows.
pub(crate) fn at(column: &[f64], rows: &[usize]) -> Vec<f64> {
    rows.iter().map(|row| column[*row]).collect()
}

/// Median of magnitudes that rounding has gathered in classes of a width: as if those of a class lay evenly in it.
///
/// Few classes make a plain median jump by a class, hence a noise of one or two steps come out a third too small or too large.
fn median_of_classes(magnitudes: &mut [f64], width: f64) -> f64 {
    let plain = median(magnitudes);
    if width <= 0.0 {
        return plain;
    }
    // Of zeros only the half above zero is a class of magnitudes.
    let (low, high) = ((plain - 0.5 * width).max(0.0), plain + 0.5 * width);
    let below = magnitudes.iter().filter(|value| **value < low).count() as f64;
    let inside = magnitudes.iter().filter(|value| (low..high).contains(value)).count() as f64;
    low + (0.5 * magnitudes.len() as f64 - below) / inside.max(1.0) * (high - low)
}

/// Step of a signal that was rounded to multiples of it; 0 where no rounding shows.
///
/// The smallest change counts if nearly all others are multiples of it, and if the signal staggers: a jaw at constant
/// speed changes by equal steps too, but in unbroken rows, so that its second differences vanish.
pub(crate) fn quantum(values: &[f64]) -> f64 {
    const FEWEST: usize = 20;
    let (low, high) = bounds(values);
    let rounding = 1e-9 * low.abs().max(high.abs());
    let moves = |change: &f64| *change > rounding;
    let changes: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(moves).collect();
    let step = changes.iter().copied().fold(f64::MAX, f64::min);
    if changes.len() < FEWEST || step > 0.02 * (high - low) {
        return 0.0;
    }
    let is_multiple = |change: &&f64| (**change / step - (**change / step).round()).abs() < 0.05;
    let bends = values
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
        .filter(|bend| *bend > 0.1 * step)
        .count();
    let multiples = changes.iter().filter(is_multiple).count();
    if 10 * multiples >= 9 * changes.len() && 5 * bends >= changes.len() { step } else { 0.0 }
}

/// The least change from a sample to the next that is one; 0 if there is none.
pub(crate) fn least_change(values: &[f64]) -> f64 {
    let (none, changes) = (1e-9 * range(values), values.windows(2).map(|pair| (pair[1] - pair[0]).abs()));
    let least = changes.filter(|change| *change > none).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Correlation of neighbouring values about zero; 0 for fewer than three or for none at all.
pub(crate) fn lag_one_correlation(residuals: &[f64]) -> f64 {
    let square = dot(residuals, residuals);
    if residuals.len() < 3 || square == 0.0 {
        return 0.0;
    }
    let product = dot(&residuals[1..], &residuals[..residuals.len() - 1]);
    (product / square).clamp(-1.0, 1.0)
}

/// How many independent samples carry as much as `count` samples whose neighbours correlate by `correlation`.
///
/// N (1 − ρ)/(1 + ρ) for an AR(1) series; a negative ρ counts as none, and two samples are always left.
pub(crate) fn effective_count(count: usize, correlation: f64) -> f64 {
    let rho = correlation.clamp(0.0, 0.9999);
    (count as f64 * (1.0 - rho) / (1.0 + rho)).max(2.0)
}

/// Two-sided probability that a standard normal number is at least `z` away from zero.
pub(crate) fn two_sided_p(z: f64) -> f64 {
    if z.is_infinite() {
        return 0.0;
    }
    2.0 * Normal::standard().sf(z.abs())
}

/// The factor that turns a standard error into half a confidence interval of `level` with `freedom` degrees of freedom.
///
/// All numbers of a fit ask for the same one, and it costs as much as a pass over a thousand samples: the last is kept.
pub(crate) fn coverage_factor(level: f64, freedom: f64) -> f64 {
    thread_local! {
        static LAST: Cell<[f64; 3]> = const { Cell::new([0.0; 3]) };
    }
    let [last_level, last_freedom, last] = LAST.get();
    if level == last_level && freedom == last_freedom {
        return last;
    }
    let factor = student_factor(level, freedom);
    LAST.set([level, freedom, factor]);
    factor
}

/// Effective degrees of freedom of a combined standard uncertainty by Welch and Satterthwaite (JCGM 100, G.2b), of parts with their own; endless
/// where all parts are known.
pub(crate) fn effective_freedom(combined: f64, parts: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let sum: f64 = parts.into_iter().map(|(part, freedom)| part.powi(4) / freedom).sum();
    if sum == 0.0 { f64::INFINITY } else { combined.powi(4) / sum }
}

/// Student's factor of effective degrees of freedom, truncated (JCGM 100, G.4.1).
pub(crate) fn effective_factor(level: f64, freedom: f64) -> f64 {
    // A whole number comes out of fourth powers a rounding below itself.
    coverage_factor(level, (freedom * (1.0 + 1e-9)).floor().max(1.0))
}

/// The factor of a bound that holds on one side with a probability of `level`: below 0 for a level below a half.
pub(crate) fn one_sided_factor(level: f64, freedom: f64) -> f64 {
    let factor = coverage_factor((2.0 * level - 1.0).abs(), freedom);
    if level < 0.5 { -factor } else { factor }
}

/// The probability that a number with Student's distribution is at most `t`.
pub(crate) fn student_probability(t: f64, freedom: f64) -> f64 {
    if t.is_infinite() {
        return if t > 0.0 { 1.0 } else { 0.0 };
    }
    // Of so many degrees of freedom it is the normal one to five digits.
    match StudentsT::new(0.0, 1.0, freedom.max(1.0)) {
        Ok(student) if freedom < 1e4 => student.cdf(t),
        _ => Normal::standard().cdf(t),
    }
}

/// The same for a normal number of known variance.
pub(crate) fn normal_factor(level: f64) -> f64 {
    Normal::standard().inverse_cdf(0.5 + 0.5 * level)
}

fn student_factor(level: f64, freedom: f64) -> f64 {
    if !(0.0..1.0).contains(&level) {
        return f64::INFINITY;
    }
    // The inverse of the library never ends for endless freedom and loses digits long before; with this much of it, t in terms of the normal
    // number z is exact to rounding (Abramowitz & Stegun 26.7.5).
    if freedom > 1e4 {
        let z = normal_factor(level);
        return z
            + z * (z * z + 1.0) / (4.0 * freedom)
            + z * ((5.0 * z * z + 16.0) * z * z + 3.0) / (96.0 * freedom * freedom);
    }
    match StudentsT::new(0.0, 1.0, freedom.max(1.0)) {
        Ok(t) => t.inverse_cdf(0.5 + 0.5 * level),
        Err(_) => f64::INFINITY,
    }
}

/// `values` given at rising `knots`, linearly interpolated at rising `times`; outside they stay what they are at the ends.
pub(crate) fn interpolated(knots: &[f64], values: &[f64], times: &[f64]) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy: stats.t.ppf(0.95, 7), stats.t.cdf(-1.2, 7), stats.norm.cdf(1.5).
    #[test]
    fn probabilities_on_one_side_are_those_of_scipy() {
        assert!((one_sided_factor(0.95, 7.0) - 1.894_578_605_090_007).abs() < 1e-9);
        assert_eq!(one_sided_factor(0.5, 7.0).abs(), 0.0);
        assert!((one_sided_factor(0.05, 7.0) + one_sided_factor(0.95, 7.0)).abs() < 1e-12);
        assert!((student_probability(-1.2, 7.0) - 0.134_585_968_413_603_3).abs() < 1e-9);
        assert!((student_probability(1.5, f64::INFINITY) - 0.933_192_798_731_141_9).abs() < 1e-9);
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY].map(|t| student_probability(t, 7.0)), [1.0, 0.0]);
    }

    #[test]
    fn noise_does_not_count_ramps() {
        let wiggle = |i: u32| [1.0, -0.3, -1.2, 0.7, 0.1, -0.4, 1.3][(i * i % 7) as usize];
        let flat: Vec<f64> = (0..700).map(wiggle).collect();
        let ramp: Vec<f64> = (0..700).map(|i| wiggle(i) + 5.0 * f64::from(i)).collect();
        assert!((noise(&flat) - noise(&ramp)).abs() < 1e-9);
        assert_eq!(noise(&[1.0, 2.0, 3.0, 4.0]), 0.0);
    }

    /// Rounding to steps as wide as the noise adds a twelfth of their square to its variance, and takes nothing away.
    #[test]
    fn noise_of_rounded_values_is_that_of_the_values() {
        let mut random = crate::random::Rng::new(5);
        for step in [0.5, 0.8, 1.0, 1.3, 2.0] {
            let level = |i: i32| if i < 2000 { 0.0 } else { 200.0 };
            let values: Vec<f64> = (0..4000).map(|i| ((level(i) + random.normal()) / step).round() * step).collect();
            let time: Vec<f64> = (0..4000).map(|i| 0.1 * f64::from(i)).collect();
            let expected = (1.0 + step * step / 12.0f64).sqrt();
            for found in [noise(&values), noise_in_time(&time, &values)] {
                assert!((found / expected - 1.0).abs() < 0.08, "{step}: {found} for {expected}");
            }
        }
    }

    /// A camera of 10 or 20 Hz beside a machine of 50 Hz had no noise at all.
    #[test]
    fn noise_of_values_that_are_read_several_times_is_that_of_the_new_ones() {
        let mut random = crate::random::Rng::new(8);
        for (period, step) in [(1.25, 1e-3), (1.67, 0.0), (2.0, 0.0), (2.5, 1e-3), (5.0, 0.8), (10.0, 0.0)] {
            let level = |i: f64| if i < 3000.0 { 0.0 } else { 0.1 * (i - 3000.0) };
            let mut last = (f64::NAN, 0.0);
            let mut value = |i: f64| {
                if (i / period).floor() != last.0 {
                    let new = level(i) + random.normal();
                    last = ((i / period).floor(), if step > 0.0 { (new / step).round() * step } else { new });
                }
                last.1
            };
            let values: Vec<f64> = (0..4000).map(|i| value(f64::from(i))).collect();
            let time: Vec<f64> = (0..4000).map(|i| 0.1 * f64::from(i)).collect();
            let expected = (1.0 + step * step / 12.0f64).sqrt();
            for found in [noise(&values), noise_in_time(&time, &values)] {
                assert!((found / expected - 1.0).abs() < 0.15, "{period}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn a_coarse_signal_is_new_in_every_row() {
        let mut random = crate::random::Rng::new(9);
        let steady: Vec<f64> = (0..4000).map(|i| (0.23 * f64::from(i)).floor()).collect();
        let noisy: Vec<f64> = (0..4000).map(|i| (0.01 * f64::from(i) + 0.3 * random.normal()).round()).collect();
        let held: Vec<f64> = (0..4000).map(|i| 2.0 * f64::from(i % 1000).min(50.0)).collect();
        let quiet: Vec<f64> = (0..4000).map(|_| (0.3 * random.normal()).round()).collect();
        let wide: Vec<f64> = (0..4000).map(|_| (1.5 * random.normal()).round()).collect();
        for values in [steady, noisy, held, quiet, wide] {
            assert_eq!(updates(&values), None);
        }
    }

    #[test]
    fn quantiles_of_known_distributions() {
        // Student t, 10 degrees of freedom, 95 %: 2.228139 (standard table)
        assert!((coverage_factor(0.95, 10.0) - 2.228_139).abs() < 1e-5);
        // scipy.stats.t.ppf(0.975, [9999, 10001]), norm.ppf(0.975)
        for (freedom, expected) in [(9_999.0, 1.960201263621357), (10_001.0, 1.960201216164641)] {
            let found = coverage_factor(0.95, freedom);
            assert!((found - expected).abs() < 1e-10, "{freedom}: {found}");
        }
        assert!((coverage_factor(0.95, f64::INFINITY) - 1.959_963_984_540_054).abs() < 1e-12);
        assert!(coverage_factor(0.95, f64::NAN) > 12.0);
        assert!((two_sided_p(1.959_964) - 0.05).abs() < 1e-6);
    }
}
