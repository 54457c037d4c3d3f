//! Measured columns: rows that stray, saturation, rounding.

use serde::{Deserialize, Serialize};

use super::{
    Astray, Column, bridge,
    plateau::{Plateau, noisy_plateau},
    rounding_step_heard,
};
use crate::statistics::{bounds, noise};

/// What a measured column is like; its unit is that of the column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Values {
    /// Values that are no finite number.
    pub not_finite: usize,
    /// Rows that stray from those about them.
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

/// Rows that leave their neighbours and come back: alone, a few together, or so far off that no sensor measured them.
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
    /// How far the rows of a column that was clipped before its amplifier lie from the value, which is their mean; else 0.
    #[serde(default)]
    pub spread: f64,
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
        // A jaw may move and come back within a few rows.
        let rows = match column {
            Column::Force => Astray::of_force(values, other).rows(),
            _ => Astray::of(values).those(|run| run.len() == 1),
        };
        hear()?;
        let repeats = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let exact = saturation(column, values, other);
        let noisy = || noisy_plateau(values, other.filter(|_| column == Column::Force)?).map(Saturation::from);
        let saturation = exact.filter(|found| found.clipped).or_else(noisy).or(exact);
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

impl From<Plateau> for Saturation {
    fn from(Plateau { level, spread, rows }: Plateau) -> Self {
        Self {
            level,
            spread,
            rows: rows.len(),
            longest: rows.len(),
            first_row: rows.start,
            clipped: true,
        }
    }
}

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
    let other = other.map(|other| {
        let mut clean = other.to_vec();
        bridge(&mut clean, &Astray::of(other).runs);
        clean
    });
    let without_noise = column == Column::Force && noise_vanishes(values, level, longest);
    let clipped = without_noise || runs.iter().any(|run| goes_on(column, values, other.as_deref(), *run));
    Some(Saturation {
        level,
        spread: 0.0,
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

/// Share of the way to its extreme that tells how long a column must go on without the displacement.
const LAST_PART: f64 = 1.0 / 3.0;

/// Whether the other column goes on as before where this one begins to stand still: it then stopped measuring.
///
/// A jaw that stops, or a force that is held, stops the other column too, or turns it; a force that only goes on to relax has
/// not been loaded further by a jaw whose encoder ended. Where values are rounded, one that
/// rises slowly repeats itself as well: the run must be five times as long as the three before it. Where a displacement leaves its
/// extreme again, the force has turned before if an encoder ended there, and turns with it if a jaw stood.
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
    let mut window = RUN * longest;
    if column == Column::Displacement {
        // A force that swings, or is filtered, goes on for a while when the jaw stops.
        let far = |row: &usize| (values[*row] - values[start]).abs() > LAST_PART * (values[0] - values[start]).abs();
        window = window.max(start - (0..start).rfind(far).unwrap_or(0));
    }
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
    let observed = (0.01 * (high - low)).max(5.0 * noise(other));
    let end = start + length;
    let turned = column == Column::Force || end + window > other.len() || {
        let [inside, outside] = [other[end - 1] - other[end - window], other[end + window - 1] - other[end - 1]];
        inside * before < 0.0 && inside.abs() > 0.5 * outside.abs()
    };
    before.abs() > observed && after / before > 0.5 && turned
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

    /// A force that swings as the jaw stops, or a few rows that stray, made of the jaw an encoder at the end of its range.
    #[test]
    fn a_jaw_that_stops_under_a_force_that_swings_is_not_clipped() {
        let (displacement, force) = squeeze();
        let clipped = |force: &[f64], displacement: &[f64]| {
            of(Column::Displacement, displacement, Some(force)).saturation.is_some_and(|found| found.clipped)
        };
        let swings = |i: usize| 3.0 * (-0.03 * i as f64).exp() * (0.05 * i as f64).sin();
        let ringing: Vec<f64> =
            force.iter().enumerate().map(|(i, force)| force + swings(i.saturating_sub(100))).collect();
        let mut spike = force.clone();
        spike[101..106].iter_mut().for_each(|force| *force *= 1.3);
        assert!(!clipped(&ringing, &displacement) && !clipped(&spike, &displacement));
        let short: Vec<f64> = displacement.iter().map(|d| d.min(6e-3)).collect();
        assert!(clipped(&force, &short));
        // There and back: the force turns before an encoder leaves the end of its range, and as a jaw leaves its hold.
        let there: Vec<f64> =
            (0..800).map(|i: u32| 1e-4 * f64::from(i.min(100).min(700u32.saturating_sub(i)))).collect();
        let late = |by: usize| (0..800).map(|i: usize| 1e3 * there[i.saturating_sub(by)]).collect::<Vec<f64>>();
        let short: Vec<f64> = there.iter().map(|d| d.min(6e-3)).collect();
        assert!(clipped(&late(0), &short) && !clipped(&late(40), &there));
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
    fn columns_that_hold_nothing_do_no_harm() {
        for values in [&[][..], &[1.0], &[f64::NAN, f64::INFINITY], &[2.0; 40]] {
            let found = of(Column::Force, values, Some(values));
            assert!(found.range == 0.0 && found.saturation.is_none() && found.step.is_none());
        }
    }
}
