//! Measured columns: rows that stray alone, saturation, rounding.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::{Column, rounding_step_heard};
use crate::statistics::{bounds, noise, quantile};

/// What a measured column is like; its unit is that of the column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Values {
    /// Values that are no finite number.
    pub not_finite: usize,
    /// Single rows that leave and come back.
    pub strays: Strays,
    /// Rows stuck at the largest or smallest value, where there are any.
    pub saturation: Option<Saturation>,
    /// The step that the values were rounded to; `None` where no rounding shows.
    pub step: Option<f64>,
    /// Share of the rows that repeat the row before exactly.
    pub repeating: f64,
    /// Largest less smallest value.
    pub range: f64,
}

/// Single rows that leave their neighbours and come back.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Strays {
    /// How many.
    pub count: usize,
    /// How many of them are zero exactly, where their neighbours are not.
    pub zeros: usize,
    /// The first of them, from 0; at most twenty.
    pub rows: Vec<usize>,
}

/// A run of rows at one end of the range of a column.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Saturation {
    /// The value.
    pub level: f64,
    /// Rows at that value in runs of five or more.
    pub rows: usize,
    /// Rows of the longest run.
    pub longest: usize,
    /// First row of the longest run, from 0.
    pub first_row: usize,
    /// Whether the column was clipped there: the other column went on as before while this one stood still, or its noise
    /// vanished. Otherwise the value was held, as a displacement is in a hold.
    pub clipped: bool,
}

/// Fewest rows of a run.
const RUN: usize = 5;
/// Most rows that are listed.
const LISTED: usize = 20;

impl Values {
    /// Examines a column; `other` was measured in the same rows. `hear` says in between whether to go on.
    pub(super) fn heard<E>(
        column: Column,
        values: &[f64],
        other: Option<&[f64]>,
        hear: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        hear()?;
        let not_finite = values.iter().filter(|value| !value.is_finite()).count();
        let kept: Vec<f64>;
        // What is not finite would spoil every range; the rows of what is left count on.
        let (values, other) = if not_finite == 0 {
            (values, other)
        } else {
            kept = values.iter().copied().filter(|value| value.is_finite()).collect();
            (kept.as_slice(), None)
        };
        let (low, high) = bounds(values);
        let rows = stray_rows(values);
        hear()?;
        let repeats = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let saturation = saturation(column, values, other);
        let step = rounding_step_heard(values, hear)?;
        Ok(Self {
            not_finite,
            strays: Strays {
                count: rows.len(),
                zeros: rows.iter().filter(|row| values[**row] == 0.0).count(),
                rows: rows.into_iter().take(LISTED).collect(),
            },
            saturation,
            step,
            repeating: repeats as f64 / values.len().saturating_sub(1).max(1) as f64,
            range: if high >= low { high - low } else { 0.0 },
        })
    }
}

/// Rows that stray alone: over 5 % of the range away from both neighbours, which differ from each other by less than a
/// tenth of that; and beyond what noise does, where there are rows enough to know it.
pub(crate) fn stray_rows(values: &[f64]) -> Vec<usize> {
    const ENOUGH: usize = 50;
    let (low, high) = bounds(values);
    let noise = if values.len() < ENOUGH { 0.0 } else { noise(values) };
    let least = (0.05 * (high - low)).max(8.0 * noise);
    let mut rows: Vec<usize> = Vec::new();
    let mut before = values.first().copied().unwrap_or_default();
    for i in 1..values.len().saturating_sub(1) {
        let (here, after) = (values[i], values[i + 1]);
        let stray = (here - before).abs().min((here - after).abs());
        let alone = stray > least && (after - before).abs() < 0.1 * stray && !is_tip(values, i, 0.5 * stray);
        if alone {
            rows.push(i);
        }
        before = if alone { 0.5 * (before + after) } else { here };
    }
    rows
}

/// Up to five successive rows that stray from all about them, as those of [`stray_rows`] do alone, by a tenth of the range or more.
pub(crate) fn stray_runs(values: &[f64]) -> Vec<Range<usize>> {
    const LONGEST: usize = 5;
    const ENOUGH: usize = 50;
    if values.len() < ENOUGH {
        return Vec::new();
    }
    // Of most rows: those that stray are not to decide how far that is.
    let mut sorted = values.to_vec();
    let reach = quantile(&mut sorted, 0.98) - quantile(&mut sorted, 0.02);
    let least = (0.1 * reach).max(20.0 * noise(values));
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut row = 1;
    while row + 1 < values.len() {
        let before = values[row - 1];
        let strays = |length: &usize| {
            let Some(after) = values.get(row + length) else {
                return false;
            };
            let off = |value: &f64| (value - before).abs().min((value - after).abs());
            let run = &values[row..row + length];
            let (nearest, farthest) =
                run.iter().map(off).fold((f64::MAX, 0.0f64), |(least, most), off| (least.min(off), most.max(off)));
            let one_side = run.iter().all(|value| (*value > before) == (run[0] > before));
            // What comes and goes within more samples than these is a wave.
            let is_calm = |outside: Option<usize>, beside: f64| {
                let farther = outside.and_then(|outside| values.get(outside));
                farther.is_none_or(|value| (value - beside).abs() < 0.25 * nearest)
            };
            let is_abrupt = is_calm(row.checked_sub(2), before) && is_calm(Some(row + length + 1), *after);
            // What grows row by row is a peak.
            let at_once = nearest > 0.5 * farthest;
            nearest > least && at_once && one_side && (after - before).abs() < 0.1 * nearest && is_abrupt
        };
        match (1..=LONGEST).find(strays) {
            Some(length) => {
                runs.push(row..row + length);
                row += length + 1;
            }
            None => row += 1,
        }
    }
    runs
}

/// Successive rows, few of all, that stand tens of times farther off than nearly all others reach and begin and end at once: what a load
/// cell shows beyond its range, or a logger for a value that it did not get.
pub(crate) fn absurd_rows(values: &[f64]) -> Vec<usize> {
    /// Most of them, as a share of all, and the share of rows on either side that are no measure of the others.
    const MOST: f64 = 0.02;
    const FAR: f64 = 20.0;
    let mut sorted = values.to_vec();
    let (low, high) = (quantile(&mut sorted, MOST), quantile(&mut sorted, 1.0 - MOST));
    let off = |value: f64| (value - high).max(low - value);
    let is_far = |value: f64| high > low && off(value) > FAR * (high - low);
    let mut rows = Vec::new();
    let mut begun = 0;
    for run in values.chunk_by(|a, b| is_far(*a) == is_far(*b)) {
        let rest = begun + run.len();
        let jumps = |inside: usize, outside: Option<usize>| {
            outside
                .and_then(|row| values.get(row))
                .is_none_or(|next| (values[inside] - next).abs() > 0.9 * off(values[inside]))
        };
        if is_far(run[0]) && jumps(begun, begun.checked_sub(1)) && jumps(rest - 1, Some(rest)) {
            rows.extend(begun..rest);
        }
        begun = rest;
    }
    if rows.len() as f64 > MOST * values.len() as f64 { Vec::new() } else { rows }
}

/// Whether the lines through the two rows before and the two after both lead to within `least` of row `i`: the corner of a triangle of
/// few samples.
fn is_tip(values: &[f64], i: usize, least: f64) -> bool {
    let leads = |next: usize, far: Option<usize>| {
        let far = far.and_then(|far| values.get(far));
        far.is_some_and(|far| (2.0 * values[next] - far - values[i]).abs() < least)
    };
    leads(i - 1, i.checked_sub(2)) && leads(i + 1, Some(i + 2))
}

/// Those of the rows that stray alone which no test can have measured: zero exactly, or many times farther off than all other rows
/// reach: loggers' words for a value that they did not get.
pub(in crate::record) fn lost_rows(values: &[f64]) -> Vec<usize> {
    let mut rows = stray_rows(values);
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for (row, value) in values.iter().enumerate() {
        if rows.binary_search(&row).is_err() {
            (low, high) = (low.min(*value), high.max(*value));
        }
    }
    let is_absurd = |value: f64| (value - high).max(low - value) > FAR * (high - low);
    let absurd: Vec<usize> = rows.iter().copied().filter(|row| is_absurd(values[*row])).collect();
    if !absurd.is_empty() {
        // Beside a row that is out of this world no other strays: they are looked for without it.
        let mut rest = values.to_vec();
        for row in &absurd {
            rest[*row] = 0.5 * (rest[row - 1] + rest[row + 1]);
        }
        rows = stray_rows(&rest);
    }
    rows.retain(|row| values[*row] == 0.0);
    rows.extend(absurd);
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// How many times the range of all other rows away a row that strays is no measurement.
const FAR: f64 = 10.0;

/// Runs at the end of the range that is farther from where the column begins.
fn saturation(column: Column, values: &[f64], other: Option<&[f64]>) -> Option<Saturation> {
    let (low, high) = bounds(values);
    if values.len() < 2 * RUN || high <= low {
        return None;
    }
    let level = if high - values[0] >= values[0] - low { high } else { low };
    let runs: Vec<(usize, usize)> =
        runs(values).filter(|(start, length)| values[*start] == level && *length >= RUN).collect();
    let (first_row, longest) = *runs.iter().max_by_key(|(start, length)| (*length, usize::MAX - start))?;
    // A jaw that is held may stand without noise, a force that is measured does not.
    let without_noise = column == Column::Force && noise_vanishes(values, level, longest);
    let clipped = without_noise || runs.iter().any(|run| goes_on(column, values, other, *run));
    Some(Saturation {
        level,
        rows: runs.iter().map(|(_, length)| length).sum(),
        longest,
        first_row,
        clipped,
    })
}

/// First row and length of every run of equal values.
fn runs(values: &[f64]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let mut next = 0;
    std::iter::from_fn(move || {
        let start = next;
        let value = values.get(start)?;
        next += values[start..].iter().take_while(|other| *other == value).count().max(1);
        Some((start, next - start))
    })
}

/// Whether the other column goes on as before where this one begins to stand still: it then stopped measuring.
///
/// A jaw that stops, or a force that is held, stops the other column too, or turns it; a force that only goes on to relax has
/// not been loaded further by a jaw whose encoder ended. Where values are rounded, one that
/// rises slowly repeats itself as well: the run must be five times as long as the three before it.
fn goes_on(column: Column, values: &[f64], other: Option<&[f64]>, (start, length): (usize, usize)) -> bool {
    let Some(other) = other else { return false };
    let mut longest = 1;
    let mut at = start;
    for _ in 0..3 {
        let Some(value) = at.checked_sub(1).map(|row| values[row]) else {
            break;
        };
        let run = values[..at].iter().rev().take_while(|v| **v == value).count();
        longest = longest.max(run);
        at -= run;
    }
    let window = RUN * longest;
    if length < window || start < window || start + window >= other.len() {
        return false;
    }
    let (low, high) = bounds(other);
    let before = other[start] - other[start - window];
    let after = other[start + window] - other[start];
    let arrives = values[start] - values[start - window];
    if column == Column::Displacement && before * arrives <= 0.0 {
        return false;
    }
    before.abs() > (0.01 * (high - low)).max(5.0 * noise(other)) && after / before > 0.5
}

/// Whether so long a run cannot come from a column that repeats itself as seldom as this one does elsewhere.
fn noise_vanishes(values: &[f64], level: f64, longest: usize) -> bool {
    let (low, high) = bounds(values);
    let rest: Vec<f64> = values.iter().copied().filter(|value| *value != level).collect();
    if rest.len() < values.len() / 4 || noise(&rest) < 1e-4 * (high - low) {
        return false;
    }
    let repeats = rest.windows(2).filter(|pair| pair[0] == pair[1]).count() as f64;
    let share = (repeats + 1.0) / rest.len() as f64;
    // Values at the very end of a range of noise are rarer still than others.
    share.powf((longest - 1) as f64) * (values.len() as f64) < 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn of(column: Column, values: &[f64], other: Option<&[f64]>) -> Values {
        let Ok(found) = Values::heard(column, values, other, &mut || Ok::<(), Infallible>(()));
        found
    }

    use crate::random::Rng;

    /// A ramp and a relaxing hold.
    fn squeeze() -> (Vec<f64>, Vec<f64>) {
        let displacement = |i: u32| f64::from(i.min(100)) * 1e-4;
        let relaxation = |i: u32| 0.7 + 0.3 * (-0.02 * (f64::from(i) - 100.0).max(0.0)).exp();
        let force = |i: u32| 1000.0 * displacement(i) * relaxation(i);
        ((0..400).map(displacement).collect(), (0..400).map(force).collect())
    }

    /// Five rows of 99,999 N at the beginning of a hold went into its fit without a word.
    #[test]
    fn a_few_rows_beyond_the_range_of_the_load_cell_are_absurd() {
        let (_, force) = squeeze();
        let with = |rows: std::ops::Range<usize>, value: f64| {
            let mut force = force.clone();
            force[rows].fill(value);
            absurd_rows(&force)
        };
        assert_eq!(with(100..105, 99_999.0), [100, 101, 102, 103, 104]);
        assert_eq!(with(397..400, -32_768.0), [397, 398, 399]);
        assert!(with(100..105, 30.0).is_empty() && with(100..150, 99_999.0).is_empty());
        // A force that falls to a hundredth at once, but not in one row.
        let falling: Vec<f64> = (0..400).map(|i| (-0.5 * f64::from(i)).exp() + 1e-5 * f64::from(i % 7)).collect();
        assert!(absurd_rows(&falling).is_empty());
    }

    #[test]
    fn a_clipped_force_is_reported_from_a_held_displacement() {
        let (displacement, force) = squeeze();
        let clipped: Vec<f64> = force.iter().map(|f| f.min(8.0)).collect();
        let found = of(Column::Force, &clipped, Some(&displacement)).saturation.unwrap();
        assert!(found.clipped && found.level == 8.0 && found.first_row == 80, "{found:?}");
        let held = of(Column::Displacement, &displacement, Some(&force)).saturation.unwrap();
        assert!(!held.clipped && held.longest == 300, "{held:?}");
        assert_eq!(of(Column::Force, &force, Some(&displacement)).saturation, None);
    }

    #[test]
    fn rounding_of_a_slow_force_is_no_clipping() {
        let (displacement, force) = squeeze();
        let rounded: Vec<f64> = force.iter().map(|f| f.round()).collect();
        let found = of(Column::Force, &rounded, Some(&displacement));
        assert!(found.saturation.is_none_or(|found| !found.clipped), "{found:?}");
        assert!((found.step.unwrap() - 1.0).abs() < 1e-12 && found.repeating > 0.8);
    }

    #[test]
    fn without_a_displacement_vanished_noise_tells() {
        let (_, force) = squeeze();
        let mut random = Rng::new(5);
        let noisy: Vec<f64> = force.iter().map(|f| f + 0.05 * random.normal()).collect();
        assert_eq!(of(Column::Force, &noisy, None).saturation, None);
        let clipped: Vec<f64> = noisy.iter().map(|f| f.min(8.0)).collect();
        assert!(of(Column::Force, &clipped, None).saturation.unwrap().clipped);
    }

    #[test]
    fn a_jaw_that_stands_without_noise_is_held_and_not_clipped() {
        let mut random = Rng::new(5);
        let noisy = |level: f64, random: &mut Rng| level + 1e-5 * random.normal();
        let mut jaw: Vec<f64> = (0..300).map(|i| noisy(1e-5 * f64::from(i), &mut random)).collect();
        jaw.extend([0.004; 300]);
        jaw.extend((0..300).map(|_| noisy(0.002, &mut random)));
        assert!(!of(Column::Displacement, &jaw, None).saturation.unwrap().clipped);
        assert!(of(Column::Force, &jaw, None).saturation.unwrap().clipped);
    }

    #[test]
    fn strays_are_found_beyond_noise_alone() {
        let (displacement, _) = squeeze();
        assert_eq!(of(Column::Displacement, &displacement, None).strays.count, 0);
        let mut broken = displacement;
        broken[150] = 0.0;
        broken[200] = 0.03;
        let strays = of(Column::Force, &broken, None).strays;
        assert_eq!((strays.count, strays.zeros, strays.rows), (2, 1, vec![150, 200]));
        let mut random = Rng::new(7);
        let noise: Vec<f64> = (0..3000).map(|_| random.normal()).collect();
        assert_eq!(of(Column::Force, &noise, None).strays.count, 0);
    }

    #[test]
    fn corners_of_triangles_of_few_samples_are_no_strays() {
        let corner = |i: usize| [0.0, 1.0, 2.0, 3.0, 2.0, 1.0][i % 6];
        let mut triangle: Vec<f64> = (0..60).map(corner).chain((0..400).map(|i| 0.005 * f64::from(i))).collect();
        assert_eq!(stray_rows(&triangle), [] as [usize; 0]);
        triangle[300] = 0.0;
        assert_eq!(stray_rows(&triangle), [300]);
    }

    #[test]
    fn columns_that_hold_nothing_do_no_harm() {
        for values in [&[][..], &[1.0], &[f64::NAN, f64::INFINITY], &[2.0; 40]] {
            let found = of(Column::Force, values, Some(values));
            assert!(found.range == 0.0 && found.saturation.is_none() && found.step.is_none());
        }
    }
}
