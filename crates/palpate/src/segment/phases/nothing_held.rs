//! Standstills of the displacement in which no body is held in place.

use crate::record::Record;
use crate::segment::{Level, RelaxationType, SERVO, classify_relaxation};
use crate::statistics::{bounds, mean, median, noise, noise_in_time, range};

/// What a record shows of its contact, to judge standstills by.
pub(super) struct Contact<'a> {
    displacement: &'a [f64],
    force: &'a [f64],
    force_range: f64,
    /// Whether the displacement is cut off at zero.
    cut_off: bool,
    /// The force in air before first touch, and how far the jaw is from the body at the start.
    air: Option<(f64, f64)>,
}

/// Fewest rows at zero of a displacement that is cut off there.
const CUT_OFF: usize = 8;
/// Noise of a displacement, in its rounding steps, from which on it meets zero exactly by a rule of a program alone.
const NEVER_EXACT: f64 = 20.0;
/// Fewest samples in air that show its force.
const FEWEST: usize = 16;
/// Share of its range by which the force leaves that of air at first touch.
const TOUCHED: f64 = 0.02;
/// Share of its range by which the force in air may drift.
const DRIFTED: f64 = 0.005;
/// Share of its range by which a force goes on in a standstill of a jaw that does not stand.
const GOES_ON: f64 = 0.1;
/// The same of what it does as long before or after: a drift is slower.
const AS_BESIDE: f64 = 0.5;
/// Share of that in the first half of what relaxes; a straight line has done a half.
const RELAXES: f64 = 0.58;
/// Share of what it does on that line by which it may have gone the other way before.
const BACK: f64 = 0.25;
/// Share of its range by which a force turns in no hold.
const TURNS: f64 = 0.5;

impl<'a> Contact<'a> {
    pub(super) fn of(record: &'a Record, displacement: &'a [f64]) -> Self {
        let force = record.force();
        let zeros = displacement.iter().filter(|value| **value == 0.0).count();
        let cut_off = zeros >= CUT_OFF && {
            let (time, rest): (Vec<f64>, Vec<f64>) =
                record.time().iter().zip(displacement).filter(|(_, value)| **value != 0.0).unzip();
            let steps = rest.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
            rest.len() >= FEWEST && noise_in_time(&time, &rest) > NEVER_EXACT * steps.fold(f64::MAX, f64::min)
        };
        Self {
            displacement,
            force,
            force_range: range(force),
            cut_off,
            air: air(displacement, force),
        }
    }

    /// Whether nothing is held in a standstill of the displacement.
    pub(super) fn is_none(&self, level: &Level) -> bool {
        self.is_cut_off(level) || self.is_in_air(level) || self.goes_on(level) || self.turns(level)
    }

    /// The force in air before first touch, N; `None` where none was recorded.
    pub(super) fn air_force(&self) -> Option<f64> {
        self.air.map(|(force, _)| force)
    }

    /// Exactly zero where the measured values are anything but exact: a program shows no indentation before contact.
    fn is_cut_off(&self, level: &Level) -> bool {
        let values = &self.displacement[level.start..level.end];
        self.cut_off && 2 * values.iter().filter(|value| **value == 0.0).count() > values.len()
    }

    /// The jaw is back where it started, clear of the body, and the force is that of air.
    fn is_in_air(&self, level: &Level) -> bool {
        let Some((air, open)) = self.air.filter(|_| level.start > 0) else {
            return false;
        };
        let force = &self.force[level.start..level.end];
        let error = noise(force) / (force.len() as f64).sqrt();
        level.value <= open
            && (mean(force) - air).abs() <= DRIFTED * self.force_range + 3.0 * error
            && classify_relaxation(force).kind == RelaxationType::None
    }

    /// The force goes up and down again, or down and up, by more than half of all that it does, and turns well inside: the machine
    /// moves. Where a ramp ends in a hold it turns at the edge.
    fn turns(&self, level: &Level) -> bool {
        let force = &self.force[level.start..level.end];
        let (first, last) = (force[0], force[force.len() - 1]);
        let edge = force.len() / 4;
        let (low, high) = bounds(&force[edge..force.len() - edge]);
        let (up, down) = (high - first.max(last), first.min(last) - low);
        up.max(down) > TURNS * self.force_range
    }

    /// The force runs on as before along a line, which no hold lets it: the machine moves, though not where the displacement is
    /// measured. What relaxes turns back.
    fn goes_on(&self, level: &Level) -> bool {
        let force = &self.force[level.start..level.end];
        // The edge of the standstill may lie behind the turn of the force.
        let way = |i: &usize| (force[*i] - force[0]).abs();
        let turn = (force.len() - force.len() / 4..force.len()).max_by(|a, b| way(a).total_cmp(&way(b)));
        let force = &force[..turn.map_or(force.len(), |turn| turn + 1)];
        let few = (force.len() / 20).max(1);
        let half = force.len() / 2;
        let at = |from: usize| median(&mut force[from..(from + few).min(force.len())].to_vec());
        let (first, middle, last) = (at(0), at(half - few / 2), at(force.len() - few));
        let length = level.end - level.start;
        let before = &self.force[level.start.saturating_sub(length)..level.start];
        let after = &self.force[level.end..(level.end + length).min(self.force.len())];
        let beside = AS_BESIDE * range(before).max(range(after));
        let least = beside.max(GOES_ON * self.force_range).max(10.0 * noise(force));
        let error = noise(force) / (few as f64).sqrt() / (last - first).abs();
        let runs_on = before.first().is_some_and(|from| (first - from) / (last - first) > -BACK);
        runs_on && (last - first).abs() > least && (middle - first) / (last - first) + 3.0 * error < RELAXES
    }
}

/// The median force before first touch, and up to where the jaw stands as at the start; `None` where the record begins in contact.
fn air(displacement: &[f64], force: &[f64]) -> Option<(f64, f64)> {
    let start = median(&mut force[..force.len().min(FEWEST)].to_vec());
    let leaves = TOUCHED * range(force) + 5.0 * noise(force);
    let touch = force.iter().position(|value| (value - start).abs() > leaves)?;
    let before = touch / 2;
    // The jaw may move from the first row on.
    let (open, _) = bounds(&displacement[..displacement.len().min(FEWEST)]);
    let open = open + (SERVO * range(displacement)).max(3.0 * noise(displacement));
    (before >= FEWEST).then(|| (median(&mut force[..before].to_vec()), open))
}
