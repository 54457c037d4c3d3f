//! A force whose amplifier is at the end of its range and still has its noise.
//!
//! Nothing lies above such a plateau; the force comes to it without slowing down, does not rise in it while the jaw goes on as before, and stays
//! when the jaw stops or turns. A force that the machine holds slows the jaw, one of a body that flows leaves its plateau as the jaw stops, and one that
//! comes to rest, as in a fluid or at the end of a slow ramp, slows down first.

use std::ops::Range;

use crate::statistics::{bounds, median, noise};

/// A plateau: its mean, how far its rows lie from it, and which rows these are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plateau {
    pub(super) level: f64,
    pub(super) spread: f64,
    pub(super) rows: Range<usize>,
}

/// Fewest rows of a plateau.
const FEWEST: usize = 20;
/// Width of the band of a plateau, in standard deviations of the noise: of thousands of rows all are in it.
const BAND: f64 = 9.0;
/// Standard deviations of the noise by which the means of its thirds differ at most.
const FLAT: f64 = 0.7;
/// The last part of the way to a plateau, as a share of the range and in standard deviations of the noise.
const APPROACH: (f64, f64) = (0.1, 60.0);
/// How many times as many rows the second half of this part takes as the first, at most.
const SHARP: f64 = 1.5;
/// By how much the force would have risen on the plateau, as a share of the range and in standard deviations of the noise, at least.
const MISSED: (f64, f64) = (0.03, 20.0);
/// How far the jaw goes on meanwhile, as a share of as many rows before, at least and at most.
const GOES_ON: (f64, f64) = (0.8, 1.3);
/// The same for a jaw that stops or turns, at most.
const STOPS: f64 = 0.5;
/// Largest noise, as a share of the range.
const LARGEST_NOISE: f64 = 0.01;

/// The longest plateau of the largest forces at which the load cell stopped measuring while the jaw went on; rows of both columns are the same.
pub(super) fn noisy_plateau(force: &[f64], displacement: &[f64]) -> Option<Plateau> {
    let (low, high) = bounds(force);
    let (noise, range) = (noise(force), high - low);
    if force.len() < 2 * FEWEST || noise <= 0.0 || noise > LARGEST_NOISE * range {
        return None;
    }
    let sign = if high - force[0] >= force[0] - low { 1.0 } else { -1.0 };
    let pressed: Vec<f64> = force.iter().map(|force| sign * force).collect();
    let bottom = bounds(&pressed).1 - BAND * noise;
    let runs = pressed.chunk_by(|a, b| (*a >= bottom) == (*b >= bottom)).scan(0, |start, run| {
        let rows = *start..*start + run.len();
        *start = rows.end;
        Some(rows)
    });
    let at_top = runs.filter(|rows| rows.len() >= FEWEST && pressed[rows.start] >= bottom);
    let plateaus = at_top.filter_map(|rows| flat(&pressed, rows, noise));
    let clipped = plateaus.filter(|plateau| is_clipped(&pressed, displacement, plateau, (noise, range)));
    let longest = clipped.max_by_key(|plateau| plateau.rows.len())?;
    Some(Plateau {
        level: sign * longest.level,
        ..longest
    })
}

/// The rows between the first and the last above the median of a run, if the force neither rises, falls nor bends in them.
fn flat(pressed: &[f64], run: Range<usize>, noise: f64) -> Option<Plateau> {
    let middle = median(&mut pressed[run.clone()].to_vec());
    let above = |row: &usize| pressed[*row] >= middle;
    let rows = run.clone().find(above)?..run.clone().rfind(above)? + 1;
    if rows.len() < FEWEST {
        return None;
    }
    let mean = |rows: &[f64]| rows.iter().sum::<f64>() / rows.len() as f64;
    let thirds: Vec<f64> = pressed[rows.clone()].chunks(rows.len().div_ceil(3)).map(mean).collect();
    let (lowest, highest) = bounds(&thirds);
    let level = mean(&pressed[rows.clone()]);
    let off = pressed[rows.clone()].iter().map(|force| (force - level).abs());
    (highest - lowest <= FLAT * noise).then(|| Plateau {
        level,
        spread: off.fold(0.0, f64::max),
        rows,
    })
}

/// Whether the force comes to a plateau at its full rate, the jaw goes on as before and has stopped or turned where the force leaves.
fn is_clipped(pressed: &[f64], displacement: &[f64], plateau: &Plateau, (noise, range): (f64, f64)) -> bool {
    let Range { start, end } = plateau.rows;
    let way = (APPROACH.0 * range).max(APPROACH.1 * noise);
    let below = |part: f64| (0..start).rfind(|row| pressed[*row] < plateau.level - part * way);
    let (Some(from), Some(half)) = (below(1.0), below(0.5)) else {
        return false;
    };
    let (first, second) = ((half - from) as f64, (start - half) as f64);
    if second > SHARP * first + 2.0 {
        return false;
    }
    let missed = (MISSED.0 * range).max(MISSED.1 * noise);
    let rows = (missed / way * (start - from) as f64).ceil().max(4.0) as usize;
    if start < rows || start + 2 * rows > end {
        return false;
    }
    let moved = |from: usize, to: usize| displacement[to] - displacement[from];
    let before = moved(start - rows, start);
    let jaw_noise = crate::statistics::noise(displacement);
    let ratio = moved(start, start + rows) / before;
    let at_end = moved(end - 1 - rows, end - 1) / before;
    before.abs() > 5.0 * jaw_noise && (GOES_ON.0..=GOES_ON.1).contains(&ratio) && at_end <= STOPS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    /// Displacement and force of a ramp of 100 rows to a hold of 600, by the force that is held from a row on, with noise.
    fn squeeze(force: impl Fn(usize, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Rng::new(11);
        let displacement: Vec<f64> = (0..800).map(|i: usize| 4e-5 * i.saturating_sub(100).min(100) as f64).collect();
        let relaxing = |i: usize| 0.5 + 0.5 * (-(i.saturating_sub(200) as f64) / 150.0).exp();
        let loaded = displacement.iter().enumerate();
        let force = loaded.map(|(i, d)| force(i, 1e4 * d * relaxing(i)) + 0.02 * random.normal()).collect();
        (displacement, force)
    }

    /// A load cell at the end of its range with the noise of its amplifier was taken for the peak of the body.
    #[test]
    fn a_load_cell_that_is_clipped_under_noise_is_found() {
        let (displacement, force) = squeeze(|_, force| force.min(30.0));
        let found = noisy_plateau(&force, &displacement).unwrap();
        assert!((found.level - 30.0).abs() < 0.01 && found.spread < 0.1, "{found:?}");
        assert!((173..178).contains(&found.rows.start) && (298..308).contains(&found.rows.end), "{found:?}");
        let pulled: Vec<f64> = force.iter().map(|force| -force).collect();
        assert!((noisy_plateau(&pulled, &displacement).unwrap().level + 30.0).abs() < 0.01);
    }

    #[test]
    fn forces_that_are_measured_are_not_clipped() {
        // As it was measured, and one that relaxes a little from a plateau as the jaw stops.
        let (displacement, force) = squeeze(|_, force| force);
        assert_eq!(noisy_plateau(&force, &displacement), None);
        let (displacement, force) = squeeze(|i, force| if i < 200 { force.min(30.0) } else { 0.75 * force });
        assert_eq!(noisy_plateau(&force, &displacement), None);
        // A body that flows: the force approaches its plateau.
        let flows = |i: usize| 30.0 * (1.0 - (-(i.saturating_sub(100) as f64) / 15.0).exp());
        let (displacement, force) = squeeze(|i, _| flows(i));
        assert_eq!(noisy_plateau(&force, &displacement), None);
        // A force that the machine holds: the jaw creeps on, at once ten times slower.
        let (mut displacement, force) = squeeze(|_, force| force.min(30.0));
        for row in 176..800 {
            displacement[row] = displacement[176] + 4e-6 * (row - 176).min(300) as f64;
        }
        let held: Vec<f64> =
            force.iter().take(176).copied().chain(force[176..280].iter().cycle().take(624).copied()).collect();
        assert_eq!(noisy_plateau(&held, &displacement), None);
    }
}
