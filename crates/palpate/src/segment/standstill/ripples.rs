//! Standstills that are waves of a ripple on a ramp.

use super::standstills::Standstill;
use crate::statistics::median;

/// Samples of ramp on one side, in lengths of the standstill, that show how the column ripples; and most that are looked at.
const BESIDE: [usize; 2] = [4, 16];
/// Least way of a ramp over the sum of its ways of the length of the standstill: of a jaw that goes to and fro it is less.
const GOES: f64 = 0.5;
/// How many times more a standstill bends the column than it bends all along.
const STANDS_OUT: f64 = 2.5;
/// A median of magnitudes as a standard deviation.
const DEVIATION: f64 = 1.482_6;
/// How many times more than white noise a ripple bends a column: what bends it less is judged as noise, with the corners.
const RIPPLES: f64 = 12.0;
/// Standstills without those that are waves of a ripple on a ramp.
///
/// A standstill of L samples in a ramp changes the difference of the ways of L samples before and after its corners by all the way
/// that it lacks; in a ramp that ripples such differences are found everywhere. What goes to and fro beside
/// it is no ramp, and shows no ripple. Differences of white noise of deviation `noise` are √6 of it. A standstill with others right beside it has no ramp there until these are known for waves, so the search goes on as long as it
/// finds some. A ramp that stands still in every wave looks like stairs, and is read as such.
pub(super) fn without_ripples(values: &[f64], noise: f64, found: &[Standstill]) -> Vec<Standstill> {
    let mut found = found.to_vec();
    loop {
        let stand: Vec<Standstill> = (0..found.len())
            .filter(|index| stands_out(values, noise, &found, *index))
            .map(|index| found[index])
            .collect();
        if stand.len() == found.len() {
            return stand;
        }
        found = stand;
    }
}

/// Whether a standstill bends the column by more than the ramps beside it bend.
fn stands_out(values: &[f64], noise: f64, found: &[Standstill], index: usize) -> bool {
    let Standstill { start, end } = found[index];
    let length = end - start;
    let before = index.checked_sub(1).map_or(0, |before| found[before].end);
    let after = found.get(index + 1).map_or(values.len(), |after| after.start);
    let far = BESIDE[1] * length;
    let sides = [before.max(start.saturating_sub(far))..start, end..after.min(end + far)];
    let mut usual: Vec<f64> = sides
        .iter()
        .filter(|side| side.len() >= BESIDE[0] * length && goes_one_way(&values[(*side).clone()], length))
        .flat_map(|side| side.start + length..side.end - length)
        .map(|at| bend(values, at, length))
        .collect();
    let usual = if usual.is_empty() { 0.0 } else { DEVIATION * median(&mut usual) };
    // A corner too near to an end of the record says nothing, but the other does.
    let inside = length..values.len().saturating_sub(length);
    let corners = [start, end - 1].into_iter().filter(|at| inside.contains(at)).map(|at| bend(values, at, length));
    let sharpest = corners.reduce(f64::max).unwrap_or(f64::MAX);
    usual <= RIPPLES * 6f64.sqrt() * noise || sharpest > STANDS_OUT * usual
}

/// Whether a column goes from its first sample to its last, if with a ripple: cycles are no ramp.
fn goes_one_way(values: &[f64], length: usize) -> bool {
    let places: Vec<f64> = values.iter().copied().step_by(length).collect();
    let ways: f64 = places.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return false;
    };
    (last - first).abs() >= GOES * ways
}

/// Difference of the ways of `length` samples after and before a sample.
fn bend(values: &[f64], at: usize, length: usize) -> f64 {
    (values[at + length] - 2.0 * values[at] + values[at - length]).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp that vibrates stood still for 8 ms in every wave.
    #[test]
    fn waves_of_a_ramp_are_no_standstills() {
        let wave = |i: u32| 0.06 * f64::from(i) + 0.2 * (f64::from(i) * std::f64::consts::TAU / 15.0).sin();
        let mut values: Vec<f64> = (0..600).map(wave).collect();
        let still = |start: usize| Standstill { start, end: start + 8 };
        assert!(without_ripples(&values, 0.001, &[still(300)]).is_empty());
        // Those of a burst have no ramp between them.
        assert!(without_ripples(&values, 0.001, &[285, 300, 315].map(still)).is_empty());
        // A true standstill of 40 samples stays.
        let last = values[599];
        values.extend([last; 40]);
        values.extend((0..600).map(|i| last + wave(i)));
        let hold = Standstill { start: 600, end: 640 };
        assert_eq!(without_ripples(&values, 0.001, &[hold]).len(), 1);
    }

    /// Ten cycles before a pause and five holds were a ripple: the pause was a wave of it, then each hold was one of what lay before it.
    #[test]
    fn holds_behind_cycles_are_no_waves() {
        let cycles = (0..2500).map(|i| (f64::from(i % 250) - 125.0).abs());
        let steps = (0..6).flat_map(|step| {
            let level = 125.0 + 94.0 * f64::from(step);
            let ramp = (0..150).map(move |i| level + 94.0 * f64::from(i) / 150.0);
            (0..if step == 0 { 300 } else { 665 }).map(move |_| level).chain(ramp)
        });
        let values: Vec<f64> = cycles.chain(steps).collect();
        let starts = (0..6_usize).map(|step| 2500 + if step == 0 { 0 } else { 450 + 815 * (step - 1) });
        let found: Vec<Standstill> = starts
            .zip([300, 665, 665, 665, 665, 665])
            .map(|(start, length)| Standstill {
                start,
                end: start + length,
            })
            .collect();
        assert_eq!(without_ripples(&values, 1e-3, &found).len(), 6);
    }
}
