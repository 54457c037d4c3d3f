//! Phases from the displacement of the jaw.
//!
//! 1. Single-row dropouts are passed over.
//! 2. Noise and step of the encoder give the tolerance; the speed at which most of the way is travelled gives the speed
//!    of the ramps; a jaw slower than a small share of it stands still.
//! 3. A standstill that drifts by more than a twentieth of the range is a slow ramp and is searched again by itself.
//! 4. A standstill that is long enough is a hold; its edges are set where the ramp meets the level.

use super::edges::{Level, edges};
use super::ramps::fill_gaps;
use super::slope::{slopes, travel_median};
use super::{Phase, SegmentError, SegmentOptions, SegmentSettings, Segmentation};
use crate::statistics::{median, noise};

/// Speed of a standstill as a share of the speed of the ramps.
const STILL_BELOW: f64 = 0.03;
/// Fewest samples of a hold.
const MINIMUM_SAMPLES: usize = 8;
/// A standstill that drifts by more than this share of the range is a slow ramp.
const DRIFT: f64 = 0.05;
/// Shortest hold as a share of the median duration of the ramps.
const SHORTEST: f64 = 0.05;

pub(super) fn phases(
    time: &[f64],
    displacement: &[f64],
    options: &SegmentOptions,
) -> Result<Segmentation, SegmentError> {
    let values = without_spikes(displacement);
    let (low, high) = bounds(&values);
    let (range, noise) = (high - low, noise(&values));
    if range == 0.0 || range < 8.0 * noise {
        return Err(SegmentError::NoMotion {
            column: "displacement",
            range,
            noise,
            unit: "m",
        });
    }
    let tolerance = options
        .tolerance
        .unwrap_or_else(|| (5.0 * noise).max(1.5 * encoder_step(&values, range)).max(0.002 * range));
    let (window, ramp_speed, still) = thresholds(time, &values, noise, range, options);
    let mut runs = Vec::new();
    standstills(time, &values, (0, values.len()), window, still, DRIFT * range, options, &mut runs);
    let ramp_duration = median_ramp(time, &runs, tolerance, &values);
    let minimum_hold = options.minimum_hold.unwrap_or(SHORTEST * ramp_duration);
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
    for &(start, end) in &runs {
        let level = edges(time, &values, (start, end), tolerance);
        let duration = time[level.end - 1] - time[level.start];
        let is_first = level.start == 0;
        if !is_first && duration > longest {
            (longest, samples) = (duration, level.end - level.start);
        }
        if duration >= minimum_hold && level.end - level.start >= minimum_samples {
            match levels.last_mut() {
                // The same level twice with nothing but noise between: one hold.
                Some(last) if (last.value - level.value).abs() <= tolerance && level.start <= last.end + 2 * window => {
                    last.end = level.end;
                }
                _ => levels.push(level),
            }
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
        if 6.0 * slope_noise <= share * ramp || window * 16 > values.len() || ramp == 0.0 {
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
    window: usize,
    still: f64,
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
                        thresholds(&time[run.0..run.1], &values[run.0..run.1], 0.0, travelled, options);
                    standstills(time, values, run, window, still, drift, options, runs);
                }
            }
            _ => {}
        }
    }
}

/// Median duration of what lies between the standstills.
fn median_ramp(time: &[f64], runs: &[(usize, usize)], tolerance: f64, values: &[f64]) -> f64 {
    let mut starts: Vec<usize> = vec![0];
    let mut ends = Vec::new();
    for (start, end) in runs {
        ends.push(*start);
        starts.push(end - 1);
    }
    ends.push(time.len() - 1);
    let mut durations: Vec<f64> = starts
        .into_iter()
        .zip(ends)
        .filter(|(start, end)| end > start && (values[*end] - values[*start]).abs() > 4.0 * tolerance)
        .map(|(start, end)| time[end] - time[start])
        .collect();
    // A jaw that only comes back to where it was counts as one long ramp.
    if durations.is_empty() { time[time.len() - 1] - time[0] } else { median(&mut durations) }
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

/// Step of the encoder: the median of the small changes between neighbours that are not zero.
fn encoder_step(values: &[f64], range: f64) -> f64 {
    let mut changes: Vec<f64> = values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|change| *change > 0.0 && *change < 0.005 * range)
        .collect();
    if changes.is_empty() { 0.0 } else { median(&mut changes) }
}

fn bounds(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)))
}
