//! Phases from the displacement of the jaw.
//!
//! 1. Single-row dropouts are passed over.
//! 2. Noise and step of the encoder give the tolerance; the speed at which most of the way is travelled gives the speed
//!    of the ramps; a jaw slower than a small share of it stands still.
//! 3. A standstill that drifts by more than a twentieth of the range is a slow ramp and is searched again by itself.
//! 4. The edges of a standstill are set where the ramp meets the level. One in which the ramp beside it would have gone
//!    far, and that is no turning point, is a hold.

use super::edges::{Level, Limits, Neighbours, grown, trimmed};
use super::ramps::fill_gaps;
use super::slope::{slopes, travel_median};
use super::{Phase, SegmentError, SegmentOptions, SegmentSettings, Segmentation};
use crate::statistics::{median, noise_in_time, quantum};

/// Speed of a standstill as a share of the speed of the ramps.
const STILL_BELOW: f64 = 0.03;
/// Share up to which noise may raise that: wider windows would see no short hold.
const NOISY_BELOW: f64 = 0.06;
/// Fewest samples of a hold.
const MINIMUM_SAMPLES: usize = 8;
/// A standstill that drifts by more than this share of the range is a slow ramp.
const DRIFT: f64 = 0.05;
/// How many tolerances the jaw would have moved on in the shortest hold, at the speed of the ramp beside it.
const SHORTEST: f64 = 4.0;

pub(super) fn phases(
    time: &[f64],
    displacement: &[f64],
    options: &SegmentOptions,
) -> Result<Segmentation, SegmentError> {
    let values = without_spikes(displacement);
    let (low, high) = bounds(&values);
    let (range, noise) = (high - low, noise_in_time(time, &values));
    if range == 0.0 || range < 8.0 * noise {
        return Err(SegmentError::NoMotion {
            column: "displacement",
            range,
            noise,
            unit: "m",
        });
    }
    let tolerance = options.tolerance.unwrap_or_else(|| (5.0 * noise).max(1.5 * quantum(&values)).max(0.002 * range));
    let (window, ramp_speed, still) = thresholds(time, &values, noise, range, options);
    let mut runs = Vec::new();
    standstills(time, &values, (0, values.len()), (window, still), noise, DRIFT * range, options, &mut runs);
    let minimum_hold = options.minimum_hold.unwrap_or(SHORTEST * tolerance / ramp_speed);
    let minimum_samples = if options.minimum_hold.is_some() { 3 } else { MINIMUM_SAMPLES };
    let settings = SegmentSettings {
        from_displacement: true,
        noise,
        tolerance,
        ramp_speed,
        still_speed: still,
        slope_window: window,
        minimum_hold,
        minimum_samples,
    };
    let mut levels: Vec<Level> = Vec::new();
    let (mut longest, mut samples) = (0.0f64, 0);
    for level in candidates(time, &values, &runs, &settings) {
        let duration = time[level.end - 1] - time[level.start];
        if level.start != 0 && duration > longest {
            (longest, samples) = (duration, level.end - level.start);
        }
        let asked = options.minimum_hold.map(|least| duration >= least);
        let long = asked.unwrap_or_else(|| stands(time, &values, level, &settings));
        if long && level.end - level.start >= minimum_samples {
            join(time, values[0], &mut levels, level, &settings);
        }
    }
    let segments = fill_gaps(&values, &levels, 2.0 * tolerance);
    if !segments.iter().any(|segment| segment.phase == Phase::Hold) {
        return Err(SegmentError::NoHold {
            longest,
            samples,
            minimum_hold,
            minimum_samples,
        });
    }
    Ok(Segmentation { segments, settings })
}

/// Window, speed of the ramps and speed of a standstill.
fn thresholds(time: &[f64], values: &[f64], noise: f64, range: f64, options: &SegmentOptions) -> (usize, f64, f64) {
    let share = options.still_below.unwrap_or(STILL_BELOW);
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let interval = median(&mut steps);
    let mut window = 1;
    loop {
        // Noise of a difference of means of w samples, w intervals apart.
        let slope_noise = noise * (2.0 / window as f64).sqrt() / (window as f64 * interval);
        let speeds = slopes(time, values, window);
        let ramp = travel_median(time, &speeds, 4.0 * slope_noise);
        let still = (share * ramp).max(4.0 * slope_noise);
        // Wider windows until the noise alone never crosses the threshold.
        if 6.0 * slope_noise <= share.max(NOISY_BELOW) * ramp || window * 16 > values.len() {
            let floor = 1e-9 * range / (time[time.len() - 1] - time[0]);
            return (window, ramp, still.max(floor));
        }
        window *= 2;
    }
}

/// Runs of samples over which the jaw stands still.
#[expect(clippy::too_many_arguments, reason = "a recursion over parts of one record")]
fn standstills(
    time: &[f64],
    values: &[f64],
    part: (usize, usize),
    (window, still): (usize, f64),
    noise: f64,
    drift: f64,
    options: &SegmentOptions,
    runs: &mut Vec<(usize, usize)>,
) {
    let (from, until) = part;
    let speeds = slopes(&time[from..until], &values[from..until], window);
    let mut start = None;
    for gap in 0..=speeds.len() {
        let is_still = speeds.get(gap).is_some_and(|speed| speed.abs() < still);
        match (is_still, start) {
            (true, None) => start = Some(gap),
            (false, Some(first)) => {
                start = None;
                let run = (from + first, from + gap + 1);
                if run.1 - run.0 < 3 {
                    continue;
                }
                let travelled = (values[run.1 - 1] - values[run.0]).abs();
                if travelled <= drift || run == part {
                    runs.push(run);
                } else {
                    let (window, _, still) =
                        thresholds(&time[run.0..run.1], &values[run.0..run.1], noise, travelled, options);
                    standstills(time, values, run, (window, still), noise, drift, options, runs);
                }
            }
            _ => {}
        }
    }
}

/// Standstills with their edges, each cut where the ramps beside it begin.
fn candidates(time: &[f64], values: &[f64], runs: &[(usize, usize)], settings: &SegmentSettings) -> Vec<Level> {
    let limits = Limits {
        tolerance: settings.tolerance,
        still: 1e-6 * settings.still_speed,
    };
    // Runs on one level with nothing but noise between are one; what the jaw hardly stays at is part of a ramp.
    let mut wide: Vec<((usize, usize), Level)> = Vec::new();
    for run in runs {
        // Noise cuts a long standstill into thousands of runs; those inside the level that one of them grew to are it.
        if let Some((whole, last)) = wide.last_mut()
            && run.1 <= last.end
        {
            whole.1 = run.1;
            continue;
        }
        let level = grown(values, *run, limits.tolerance);
        match wide.last_mut() {
            Some((whole, last)) if level.start <= last.end && (level.value - last.value).abs() <= limits.tolerance => {
                whole.1 = run.1;
                *last = grown(values, *whole, limits.tolerance);
            }
            _ => wide.push((*run, level)),
        }
    }
    for (whole, level) in &mut wide {
        *level = grown(values, *whole, limits.tolerance);
    }
    wide.retain(|(_, level)| far(time, values, *level) > SHORTEST * limits.tolerance);
    (0..wide.len())
        .map(|i| {
            let between = Neighbours {
                before: if i == 0 { 0 } else { wide[i - 1].1.end },
                after: wide.get(i + 1).map_or(values.len(), |(_, next)| next.start),
            };
            trimmed(time, values, wide[i].1, wide[i].0, &between, limits)
        })
        .collect()
}

/// Whether the jaw would have gone on by some tolerances at the speed it has beside this level, had it not stopped, and
/// did not merely turn.
fn stands(time: &[f64], values: &[f64], level: Level, settings: &SegmentSettings) -> bool {
    // Where the noise makes the tolerance, it hides the bend of a turning point, too.
    let noisy = if settings.tolerance <= 5.0 * settings.noise { 2.5 } else { 1.0 };
    far(time, values, level) > noisy * SHORTEST * settings.tolerance
        && !turns(time, values, level, settings.tolerance, 0.95)
}

/// How far the jaw would have gone on at the speed it has beside a level.
///
/// At the turning point of a triangle or a sine it is slow just outside the tolerance, too. The speed is that over half
/// the length of the level on either side; the faster side counts.
fn far(time: &[f64], values: &[f64], level: Level) -> f64 {
    let duration = time[level.end - 1] - time[level.start];
    let half = 0.5 * duration;
    // The farthest point counts: a stretch that reaches the next hold may end on the same level.
    let speed = |a: usize, b: usize, edge: usize| {
        let farthest = values[a..=b].iter().map(|v| (v - values[edge]).abs()).fold(0.0, f64::max);
        if a < b { farthest / (time[b] - time[a]) } else { 0.0 }
    };
    let from = time.partition_point(|t| *t < time[level.start] - half).min(level.start.saturating_sub(1));
    let until = time.partition_point(|t| *t <= time[level.end - 1] + half).max(level.end + 1).min(values.len()) - 1;
    speed(from, level.start, level.start).max(speed(level.end - 1, until, level.end - 1)) * duration
}

/// Whether a stretch about a level, half as long again on either side, is one smooth turning point.
///
/// The parabola must leave no more than `share` of the square deviation from the mean.
pub(super) fn turns(time: &[f64], values: &[f64], level: Level, tolerance: f64, share: f64) -> bool {
    let duration = time[level.end - 1] - time[level.start];
    let from = time.partition_point(|t| *t < time[level.start] - 0.25 * duration);
    let until = time.partition_point(|t| *t <= time[level.end - 1] + 0.25 * duration);
    let centre = 0.5 * (time[level.start] + time[level.end - 1]);
    let scaled: Vec<(f64, f64)> =
        (from..until).map(|i| (2.0 * (time[i] - centre) / duration, values[i] - level.value)).collect();
    let Some((fit, curvature, vertex)) = parabola(&scaled) else {
        return false;
    };
    let inside: Vec<&(f64, f64)> = scaled.iter().filter(|(u, _)| u.abs() <= 1.0).collect();
    let square =
        |f: &dyn Fn(f64) -> f64| inside.iter().map(|(u, v)| (v - f(*u)).powi(2)).sum::<f64>() / inside.len() as f64;
    let mean = inside.iter().map(|(_, v)| v).sum::<f64>() / inside.len() as f64;
    let (flat, bent) = (square(&|_| mean), square(&|u| fit[0] + u * (fit[1] + u * fit[2])));
    // A flat level with ramps beside it is fitted worse by the parabola than by its own mean.
    curvature.abs() > 0.1 * tolerance && vertex.abs() < 0.5 && bent < share * flat
}

/// Least-squares parabola: its coefficients, curvature and vertex.
fn parabola(points: &[(f64, f64)]) -> Option<([f64; 3], f64, f64)> {
    let sum = |f: &dyn Fn(f64, f64) -> f64| points.iter().map(|(u, v)| f(*u, *v)).sum::<f64>() / points.len() as f64;
    let (u1, u2, u3, u4) = (sum(&|u, _| u), sum(&|u, _| u * u), sum(&|u, _| u.powi(3)), sum(&|u, _| u.powi(4)));
    let (v0, v1, v2) = (sum(&|_, v| v), sum(&|u, v| u * v), sum(&|u, v| u * u * v));
    let (a, b, c) = (u2 - u1 * u1, u3 - u1 * u2, u4 - u2 * u2);
    let (d, e) = (v1 - u1 * v0, v2 - u2 * v0);
    let determinant = a * c - b * b;
    if points.len() < 4 || determinant <= 0.0 {
        return None;
    }
    let (slope, bend) = ((d * c - b * e) / determinant, (a * e - b * d) / determinant);
    Some(([v0 - slope * u1 - bend * u2, slope, bend], bend, -0.5 * slope / bend))
}

/// Adds a level to those before it, which it may go on, overlap or be part of.
fn join(time: &[f64], origin: f64, levels: &mut Vec<Level>, level: Level, settings: &SegmentSettings) {
    let before = levels.len().checked_sub(2).map_or(origin, |index| levels[index].value);
    let Some(last) = levels.last_mut() else {
        levels.push(level);
        return;
    };
    let apart = (last.value - level.value).abs();
    // The same level twice with nothing but noise between: one hold.
    if apart <= settings.tolerance && level.start <= last.end + 2 * settings.slope_window {
        last.end = last.end.max(level.end);
        return;
    }
    let length = |level: &Level| time[level.end - 1] - time[level.start];
    let gap = time[level.start] - time[last.end - 1];
    let ramp = (level.value - before).abs();
    // A servo that overshoots rests a moment beyond the level it comes back to.
    if length(last) < 0.2 * length(&level) && gap < 0.2 * length(&level) && apart < 0.015 * ramp && last.start > 0 {
        *last = Level {
            start: last.start,
            ..level
        };
        return;
    }
    if level.start >= last.end {
        levels.push(level);
    } else if length(&level) > length(last) {
        // Levels that overlap are one standstill that settles.
        let start = if apart < 0.015 * ramp && last.start > 0 { last.start } else { level.start };
        *last = Level { start, ..level };
    }
}

/// The column with every sample replaced by the median of itself and its neighbours: spikes of one row vanish, edges stay.
pub(super) fn without_spikes(values: &[f64]) -> Vec<f64> {
    let mut clean = values.to_vec();
    for i in 1..values.len() - 1 {
        let (a, b, c) = (values[i - 1], values[i], values[i + 1]);
        clean[i] = a.min(b).max(a.max(b).min(c));
    }
    clean
}

fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)))
}
