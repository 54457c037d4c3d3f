//! The ripple of a controller that hunts about what it holds.

use super::turning::extremes;
use crate::record::Record;
use crate::segment::segmentation::Ripple;
use crate::statistics::{median, noise_in_time, range};

/// Smallest and largest ripple of a force from peak to peak, as shares of its range: what is larger is a test of many cycles.
const OF_FORCE: [f64; 2] = [0.01, 0.2];
/// The same of a jaw, whose small cycles are more often meant.
const OF_JAW: [f64; 2] = [0.001, 0.06];
/// Smallest ripple in standard deviations of the noise.
const SMALLEST: f64 = 6.0;
/// Fewest half waves.
const FEWEST: usize = 16;
/// Share of the half waves that must last about as long as their median does.
const REGULAR: f64 = 0.7;

/// The record with its force averaged over one period of a regular ripple; `None` if it has none.
pub(super) fn without_ripple(record: &Record) -> Option<Record> {
    let (time, force) = (record.time(), record.force());
    let ripple = ripple(time, force, OF_FORCE)?;
    let calm = means_within(time, force, 0.5 * ripple.period);
    Record::new(time.to_vec(), record.displacement().map(<[f64]>::to_vec), calm).ok()
}

/// The ripple of a jaw about the places that it holds.
pub(super) fn of_jaw(time: &[f64], displacement: &[f64]) -> Option<Ripple> {
    ripple(time, displacement, OF_JAW)
}

fn ripple(time: &[f64], values: &[f64], [smallest, largest]: [f64; 2]) -> Option<Ripple> {
    let range = range(values);
    let turn = (smallest * range).max(SMALLEST * noise_in_time(time, values));
    let turns = extremes(values, turn);
    let small = |pair: &&[usize]| (values[pair[1]] - values[pair[0]]).abs() < largest * range;
    let halves: Vec<&[usize]> = turns.windows(2).filter(small).collect();
    if halves.len() < FEWEST {
        return None;
    }
    let usual = |of: &dyn Fn(&[usize]) -> f64| median(&mut halves.iter().map(|pair| of(pair)).collect::<Vec<f64>>());
    let lasts = |pair: &[usize]| time[pair[1]] - time[pair[0]];
    let half = usual(&lasts);
    let regular = halves.iter().filter(|pair| (0.6..1.4).contains(&(lasts(pair) / half))).count();
    (regular as f64 >= REGULAR * halves.len() as f64).then(|| Ripple {
        height: usual(&|pair| (values[pair[1]] - values[pair[0]]).abs()),
        period: 2.0 * half,
    })
}

/// Means of the samples within `half` of each, at the ends over what there is on both sides alike.
fn means_within(time: &[f64], values: &[f64], half: f64) -> Vec<f64> {
    let mut sums = vec![0.0];
    sums.extend(values.iter().scan(0.0, |sum, value| {
        *sum += value - values[0];
        Some(*sum)
    }));
    let (first, last) = (time[0], time[time.len() - 1]);
    let (mut from, mut until) = (0, 0);
    let mean = |t: &f64| {
        let reach = half.min(t - first).min(last - t) * (1.0 + 1e-12);
        while time[from] < t - reach {
            from += 1;
        }
        while until < time.len() && time[until] <= t + reach {
            until += 1;
        }
        values[0] + (sums[until] - sums[from]) / (until - from).max(1) as f64
    };
    time.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ripple_goes_and_what_it_rides_on_stays() {
        let time: Vec<f64> = (0..3000).map(|i| 0.01 * f64::from(i)).collect();
        let ramp = |t: &f64| (2.0 * t).min(10.0);
        let rippled = |share: f64| {
            let force = time.iter().map(|t| ramp(t) + 10.0 * share * (std::f64::consts::TAU * 3.0 * t).sin()).collect();
            Record::new(time.clone(), None, force).unwrap()
        };
        let calm = without_ripple(&rippled(0.03)).unwrap();
        let off = |(t, f): (&f64, &f64)| if (t - 5.0).abs() < 0.2 { 0.0 } else { (f - ramp(t)).abs() };
        // But for the first and last half wave, where there is nothing to average over.
        let inner = 20..2980;
        let worst = time[inner.clone()].iter().zip(&calm.force()[inner]).map(off).fold(0.0, f64::max);
        assert!(worst < 0.03, "{worst}");
        // Cycles of a test are no ripple, and a record without any has none.
        assert!(without_ripple(&rippled(0.5)).is_none() && without_ripple(&rippled(0.0)).is_none());
    }
}
