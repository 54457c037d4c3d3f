//! Holds of a force that relaxes so slowly that nothing of it stands still.
//!
//! Between two turning points the force goes one way: it ramps, or it relaxes and then ramps on. Relaxation is fast first and
//! slow later, and slower than the ramp before it; where it ends and the next ramp begins the curve has its corner.

use super::turning::extremes;
use crate::segment::standstill::Level;

/// Share of the change that is done half way, from which on a force relaxes. A straight ramp has done a half; the release of a
/// ball (force as the power 3/2 of the displacement) two thirds.
const BENT: f64 = 0.7;
/// Longest ramp, as a share of the hold behind it.
const RAMP: f64 = 0.25;
/// Fastest relaxation on the average, as a share of the speed of the ramp.
const SLOW: f64 = 0.2;
/// How far the time must run ahead of the force at a corner, both as shares of what is between the turning points.
const CORNER: f64 = 0.15;

/// The relaxations that follow a turning point of the force by more than `turn`, of `fewest` samples or more.
pub(super) fn relaxations(time: &[f64], force: &[f64], turn: f64, fewest: usize) -> Vec<Level> {
    let extremes = extremes(force, turn);
    let mut found = Vec::new();
    for three in extremes.windows(3) {
        let &[before, start, next] = three else { continue };
        let ramp = corner(time, force, before, start).unwrap_or(before)..start;
        let hold = start..corner(time, force, start, next).unwrap_or(next);
        if hold.len() < fewest || ramp.is_empty() {
            continue;
        }
        let duration = |range: &std::ops::Range<usize>| time[range.end] - time[range.start];
        let change = |from: usize, until: usize| force[until] - force[from];
        let half = time.partition_point(|t| *t < 0.5 * (time[start] + time[hold.end]));
        let bent = change(start, half) / change(start, hold.end) > BENT;
        let slow =
            change(start, hold.end).abs() / duration(&hold) < SLOW * change(ramp.start, start).abs() / duration(&ramp);
        if bent && slow && duration(&ramp) < RAMP * duration(&hold) {
            found.push(Level::of(force, start, hold.end));
        }
    }
    found
}

/// The corner between two turning points behind which the force runs: where the time is farthest ahead of the force.
fn corner(time: &[f64], force: &[f64], from: usize, until: usize) -> Option<usize> {
    let (span, way) = (time[until] - time[from], force[until] - force[from]);
    let ahead = |i: &usize| (time[*i] - time[from]) / span - (force[*i] - force[from]) / way;
    let corner = (from..=until).max_by(|a, b| ahead(a).total_cmp(&ahead(b)));
    corner.filter(|corner| ahead(corner) > CORNER)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rest of 2 s, ramp of 1 s, 20 s of relaxation (time 5 s), release.
    fn held(relaxed: f64) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..2600).map(|i| 0.01 * f64::from(i)).collect();
        let force = |t: &f64| match t {
            t if *t < 2.0 => 0.0,
            t if *t < 3.0 => 10.0 * (t - 2.0),
            t if *t < 23.0 => relaxed + (10.0 - relaxed) * (-(t - 3.0) / 5.0).exp(),
            t => (relaxed - 10.0 * (t - 23.0)).max(0.0),
        };
        let force = time.iter().map(force).collect();
        (time, force)
    }

    #[test]
    fn a_slow_relaxation_lies_between_its_corners() {
        let (time, force) = held(5.0);
        let found = relaxations(&time, &force, 0.1, 8);
        assert!(matches!(found[..], [Level { start: 300, end, .. }] if end.abs_diff(2300) < 3), "{found:?}");
        let (time, force) = (&time[..2200], &force[..2200]);
        let found = relaxations(time, force, 0.1, 8);
        assert!(
            matches!(
                found[..],
                [Level {
                    start: 300,
                    end: 2199,
                    ..
                }]
            ),
            "{found:?}"
        );
    }

    #[test]
    fn ramps_and_waves_do_not_relax() {
        let time: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
        let ball = |t: &f64| (5.0 - (t - 5.0).abs()).powf(1.5);
        let wave = |t: &f64| (2.0 * t).sin();
        let quick = |t: &f64| if *t < 1.0 { 8.0 * t } else { 8.0 - (t - 1.0) * 8.0 / 9.0 };
        for force in [ball, wave, quick] {
            let force: Vec<f64> = time.iter().map(force).collect();
            assert_eq!(relaxations(&time, &force, 0.02, 8).len(), 0);
        }
    }
}
