//! Levels of the column that the machine holds: the displacement of the jaw, or the force.
//!
//! 1. Single rows that stray are passed over.
//! 2. The column is cut into straight pieces, as fine as its noise allows.
//! 3. Pieces that go by far less than those beside them are standstills.
//! 4. The edges of a standstill are where the lines through ramp and level meet.

use super::edges::sharpened;
use super::evidence::Stillness;
use super::pieces::{Piece, Roughness, pieces};
use super::ripples::without_ripples;
use super::standstills::{Refused, Standstill, joined, standstills};
use crate::segment::{SegmentError, SegmentOptions, SegmentSettings, hear};
use crate::statistics::{at, median, noise_in_time, quantum, range, updates};
use crate::watch::Watch;

/// Drift of a standstill as a share of the way at the speed of the slower ramp beside it.
const STILL_BELOW: f64 = 0.12;
/// Fewest samples of a hold.
const MINIMUM_SAMPLES: usize = 8;
/// A standstill that drifts by more than this share of the range is a slow ramp.
const DRIFT: f64 = 0.05;
/// How far the column would have gone on in a hold, in standard deviations of the noise, on its faster and slower side.
const GOES_ON: [f64; 2] = [6.0, 3.5];
/// The same in units of the tolerance.
const GOES_ON_TOLERANCES: [f64; 2] = [3.0, 1.5];

/// Steps of a rounded column that are no motion.
const STEPS: f64 = 5.5;

/// A column that a machine may hold, and what is known of it beforehand.
pub(in crate::segment) struct Held<'a> {
    /// Its name and unit.
    pub(in crate::segment) name: (&'static str, &'static str),
    /// Its values.
    pub(in crate::segment) values: &'a [f64],
    /// How far a machine wanders about what it holds, where noise is less.
    pub(in crate::segment) wander: f64,
    /// Whether it wanders slowly.
    pub(in crate::segment) hunts: bool,
}

impl<'a> Held<'a> {
    pub(in crate::segment) fn new(
        name: (&'static str, &'static str),
        values: &'a [f64],
        wander: f64,
        hunts: bool,
    ) -> Self {
        Self {
            name,
            values,
            wander,
            hunts,
        }
    }
}

/// The levels of a column, and the thresholds that found them.
pub(in crate::segment) struct Levels {
    /// The column without spikes.
    pub(in crate::segment) values: Vec<f64>,
    pub(in crate::segment) levels: Vec<Level>,
    pub(in crate::segment) settings: SegmentSettings,
    refused: Refused,
    /// How long the record stands still before anything moves, s.
    rest: f64,
    pieces: Vec<Piece>,
    /// How near to a level its samples are where a ramp has no line.
    near: f64,
}

impl Levels {
    /// A standstill that another column shows, with the edges that this column gives it.
    pub(in crate::segment) fn edges_of(&self, time: &[f64], other: &Level) -> Level {
        let mut found = [Standstill {
            start: other.start,
            end: other.end,
        }];
        sharpened(time, &self.values, &self.pieces, self.near, &mut found);
        // The corners of this column may lie elsewhere; what they cut short is not better.
        let [found] = found;
        if found.end - found.start < other.end - other.start {
            *other
        } else {
            Level::of(&self.values, found.start, found.end)
        }
    }

    /// The same in the rows of a record of which the column was searched at some, the first among them.
    fn of_rows(self, column: &[f64], rows: &[usize]) -> Self {
        let row = |place: usize| rows.get(place).copied().unwrap_or(column.len());
        let mut values = Vec::with_capacity(column.len());
        for (place, value) in self.values.iter().enumerate() {
            values.resize(row(place + 1), *value);
        }
        let level = |level: &Level| Level {
            start: row(level.start),
            end: row(level.end),
            ..*level
        };
        let piece = |piece: &Piece| Piece {
            start: row(piece.start),
            end: row(piece.end),
            ..*piece
        };
        let each = column.len().div_ceil(rows.len());
        Self {
            values,
            levels: self.levels.iter().map(level).collect(),
            pieces: self.pieces.iter().map(piece).collect(),
            settings: SegmentSettings {
                minimum_samples: each * self.settings.minimum_samples,
                ..self.settings
            },
            refused: Refused {
                samples: each * self.refused.samples,
                ..self.refused
            },
            ..self
        }
    }

    /// Why there is no hold.
    pub(in crate::segment) fn none(&self) -> SegmentError {
        SegmentError::NoHold {
            rest: self.rest,
            longest: self.refused.duration,
            samples: self.refused.samples,
            minimum_hold: self.settings.minimum_hold,
            minimum_samples: self.settings.minimum_samples,
        }
    }
}

/// Finds the levels of a column. One that is read more often than it is updated is searched at its new values: in between, stairs of a ramp would stand.
pub(in crate::segment) fn levels(
    time: &[f64],
    held: &Held<'_>,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Levels, SegmentError> {
    let Some(rows) = updates(held.values) else {
        return levels_of_new(time, held, options, watch);
    };
    let values = &at(held.values, &rows);
    let found = levels_of_new(&at(time, &rows), &Held { values, ..*held }, options, watch)?;
    Ok(found.of_rows(held.values, &rows))
}

fn levels_of_new(
    time: &[f64],
    held: &Held<'_>,
    options: &SegmentOptions,
    watch: &mut dyn Watch,
) -> Result<Levels, SegmentError> {
    let noise = noise_in_time(time, held.values);
    hear(watch)?;
    let values = without_spikes(held.values, noise);
    let range = range(&values);
    let step = rounding(held.values);
    hear(watch)?;
    if range == 0.0 || range < (8.0 * noise).max(STEPS * step) {
        return Err(SegmentError::NoMotion {
            column: held.name.0,
            range,
            noise,
            unit: held.name.1,
        });
    }
    let tolerance = (2.5 * noise).max(held.wander).max(1.5 * step);
    let stray = (0.25 * held.wander).max(0.35 * step);
    let pieces = pieces(
        time,
        &values,
        Roughness {
            noise,
            stray,
            hunts: held.hunts,
        },
        watch,
    )?;
    let stillness = Stillness {
        noise,
        band: tolerance,
        share: options.still_below.unwrap_or(STILL_BELOW),
        drift: DRIFT * range,
        goes_on: [0, 1].map(|side| (GOES_ON[side] * noise).max(GOES_ON_TOLERANCES[side] * held.wander)),
        smooth: held.hunts,
        samples: if options.minimum_hold.is_some() { 3 } else { MINIMUM_SAMPLES },
        duration: options.minimum_hold,
    };
    let (mut found, refused) = standstills(time, &values, &pieces, &stillness);
    hear(watch)?;
    let near = (3.0 * noise).max(0.5 * held.wander);
    sharpened(time, &values, &pieces, near, &mut found);
    hear(watch)?;
    let mut found = joined(&values, &found, &stillness);
    // What is left of a standstill between its ramps may be too little for one.
    found.retain(|found| found.end - found.start >= stillness.samples);
    // A force that relaxes bends everywhere.
    let found = if held.name.0 == "displacement" { without_ripples(&values, noise, &found) } else { found };
    let ramp_speed = ramp_speed(time, &pieces, &found);
    let settings = SegmentSettings {
        from_displacement: true,
        noise,
        tolerance,
        ramp_speed,
        still_speed: stillness.share * ramp_speed,
        slope_window: 1,
        minimum_hold: options.minimum_hold.unwrap_or(stillness.goes_on[0] / ramp_speed),
        minimum_samples: stillness.samples,
    };
    let rest = found.first().filter(|first| first.start == 0).map_or(0.0, |first| time[first.end - 1] - time[0]);
    let levels = found.iter().map(|found| Level::of(&values, found.start, found.end)).collect();
    Ok(Levels {
        values,
        levels,
        settings,
        refused,
        rest,
        pieces,
        near,
    })
}

/// Speed of the ramps: half of the way outside standstills is travelled faster than this.
fn ramp_speed(time: &[f64], pieces: &[Piece], found: &[Standstill]) -> f64 {
    let still = |piece: &Piece| {
        let middle = piece.start.midpoint(piece.end);
        let next = found.partition_point(|hold| hold.end <= middle);
        found.get(next).is_some_and(|hold| hold.start <= middle)
    };
    let mut parts: Vec<(f64, f64)> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for piece in pieces {
        let times = [time[piece.start], time[piece.end - 1]];
        let ends = times.map(|t| piece.line.at(t));
        if let Some((t, v)) = last {
            parts.push(((ends[0] - v).abs() / (times[0] - t), (ends[0] - v).abs()));
        }
        if !still(piece) && times[1] > times[0] {
            parts.push((piece.line.slope().abs(), (ends[1] - ends[0]).abs()));
        }
        last = Some((times[1], ends[1]));
    }
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = parts.iter().map(|(_, way)| way).sum();
    let mut sum = 0.0;
    for (speed, way) in parts {
        sum += way;
        if sum >= 0.5 * total {
            return speed;
        }
    }
    0.0
}

/// Step of a column that was rounded. Repaired rows are means of two others and lie half a step off; few of them do not
/// make the step half as wide.
fn rounding(values: &[f64]) -> f64 {
    let step = quantum(values);
    if step == 0.0 {
        return 0.0;
    }
    let steps = || {
        values
            .windows(2)
            .map(|pair| ((pair[1] - pair[0]) / step).round() as i64)
            .filter(|steps| *steps != 0)
    };
    let odd = steps().filter(|steps| steps % 2 != 0).count();
    if 20 * odd < steps().count() { 2.0 * step } else { step }
}

/// The column without spikes of one row: a sample far off both neighbours, which agree, becomes their mean.
pub(in crate::segment) fn without_spikes(values: &[f64], noise: f64) -> Vec<f64> {
    let mut clean = values.to_vec();
    for i in 1..values.len().saturating_sub(1) {
        let (a, b, c) = (clean[i - 1], values[i], values[i + 1]);
        let stray = (b - a).abs().min((b - c).abs());
        if (b - a) * (b - c) > 0.0 && stray > 6.0 * noise && (c - a).abs() < 0.5 * stray {
            clean[i] = 0.5 * (a + c);
        }
    }
    clean
}

/// Samples in which a column stands still, and the value it has there.
#[derive(Debug, Clone, Copy)]
pub(in crate::segment) struct Level {
    pub(in crate::segment) start: usize,
    pub(in crate::segment) end: usize,
    pub(in crate::segment) value: f64,
}

impl Level {
    /// With the median of `values` there.
    pub(in crate::segment) fn of(values: &[f64], start: usize, end: usize) -> Self {
        let value = median(&mut values[start..end].to_vec());
        Self { start, end, value }
    }

    /// Samples by which edges of two columns that belong together may lie apart: a twentieth of the level.
    pub(in crate::segment) fn slack(&self) -> usize {
        (self.end - self.start) / 20
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use crate::watch::Unwatched;

    /// A hold of 60 s was 8 to 105 holds where a camera beside a machine of 50 Hz takes 5 to 30 pictures a second.
    #[test]
    fn a_column_that_repeats_its_values_stands_as_long_as_one_that_does_not() {
        let time: Vec<f64> = (0..3350).map(|i| 0.02 * f64::from(i)).collect();
        for (rate, noise) in [(50.0, 1e-4), (30.0, 1e-4), (20.0, 1e-3), (12.5, 1e-4), (5.0, 1e-5), (5.0, 1e-3)] {
            let mut random = Rng::new(11);
            let mut last = (f64::NAN, 0.0);
            let mut camera = |t: &f64| {
                let picture = (rate * t + 0.5).floor();
                if picture != last.0 {
                    last = (picture, 0.01 * (t - 3.0).clamp(0.0, 4.0) + noise * random.normal());
                }
                last.1
            };
            let values: Vec<f64> = time.iter().map(&mut camera).collect();
            let held = Held::new(("displacement", "m"), &values, 5e-4 * 0.04, false);
            let found = levels(&time, &held, &SegmentOptions::default(), &mut Unwatched).unwrap();
            let [rest, hold] = found.levels[..] else {
                panic!("{rate} Hz: {:?}", found.levels)
            };
            let near = |row: usize, expected: usize| row.abs_diff(expected) <= 4 + (60.0 / rate) as usize;
            assert!(rest.start == 0 && near(rest.end, 150), "{rate} Hz: {rest:?}");
            assert!(near(hold.start, 350) && hold.end == time.len(), "{rate} Hz: {hold:?}");
            assert_eq!(found.values.len(), values.len());
        }
    }
}
