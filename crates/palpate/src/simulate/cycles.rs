//! Work step by step and cycle by cycle.

use serde::{Deserialize, Serialize};

use super::energy::surface_at;
use super::{
    ContactRef, Course, Drive, Layer, Sampling, SimulateError, by_law, energy_watched, simulate_watched, walk,
};
use crate::watch::{Stages, Unwatched, Watch};

/// What the jaw did between two knots of a drive, J; both contacts of a body that is squeezed from two sides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StepWork {
    /// When the step began, s.
    pub from: f64,
    /// When it ended, s.
    pub until: f64,
    /// Displacement of the jaw at its start, m.
    pub displacement_from: f64,
    /// Displacement of the jaw at its end, m.
    pub displacement_until: f64,
    /// Work done on the body, less what it gave back.
    pub work: f64,
    /// Work that the body gave back.
    pub given_back: f64,
    /// What it lost to heat; `None` of a body whose stiffness grows with the squeeze.
    pub lost: Option<f64>,
    /// What the state of the body at its start stands for: of a body of constant section what it stores. Of one that grows, what it would store
    /// in this state with the widest section that the drive reaches.
    pub held_from: f64,
    /// The same at its end.
    pub held_until: f64,
}

/// What a cycle of squeeze and release cost, J.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Cycle {
    /// When the squeeze began, s.
    pub from: f64,
    /// When the next one began, or the drive ended, s.
    pub until: f64,
    /// Work done on the body.
    pub done: f64,
    /// Work that it gave back.
    pub given_back: f64,
    /// What was lost to heat where the steps say so; else the area of a closed loop of force against displacement, `done` − `given_back`; `None`
    /// of an open one.
    pub lost: Option<f64>,
    /// `lost`/`done` of a closed loop; 0 where no work was done.
    pub share_lost: Option<f64>,
    /// Whether the jaw ended where it began, to a hundredth of its travel, and the body, to a hundredth of `done`: what it holds in the layers and
    /// in a dent is no more and no less than at the start.
    pub is_closed: bool,
}

/// Work between the knots of a drive: the steps of a program, the corners of a motion or of a force.
///
/// ```
/// use palpate::contact::{Layers, Shape, Sides, Specimen};
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ContactModel, Motion, Separation, cycles, work_by_step};
///
/// let block = Shape::Prism { area: 1e-3, length: 0.04 };
/// let model = ContactModel {
///     specimen: Specimen::new(block, 1e5, Sides::One)?,
///     law: LatencyLaw::new(3.0, 100.0)?,
///     layers: Layers::new(8.0)?,
///     separation: Separation::Bonded,
/// };
/// // Squeezed and let go twice; the body comes to rest behind the first squeeze only.
/// let motion = Motion::new(vec![0.0, 1.0, 2.0, 1e6, 1e6 + 1.0, 1e6 + 2.0], vec![0.0, 4e-3, 0.0, 0.0, 4e-3, 0.0])?;
/// let steps = work_by_step(&motion, &model)?;
/// assert_eq!(steps[2].work, 0.0); // the jaw stands still
/// let cycles = cycles(&steps);
/// assert_eq!(cycles.len(), 2);
/// assert!(cycles[0].is_closed && !cycles[1].is_closed);
/// // What the second still holds it has not lost yet.
/// assert!((cycles[0].done / cycles[1].done - 1.0).abs() < 1e-3 && cycles[0].lost > cycles[1].lost);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As for [`simulate`](super::simulate()).
pub fn work_by_step<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
) -> Result<Vec<StepWork>, SimulateError> {
    work_by_step_watched(drive, contact, &mut Unwatched)
}

/// As [`work_by_step`], heard by `watch` at every straight piece of the drive.
///
/// # Errors
/// As for [`simulate`](super::simulate()), and [`SimulateError::Cancelled`].
pub fn work_by_step_watched<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    watch: &mut dyn Watch,
) -> Result<Vec<StepWork>, SimulateError> {
    steps_of(drive.into(), contact.into(), watch)
}

/// Without generics, so that it is compiled here, once, and not wherever it is called.
fn steps_of(drive: Drive<'_>, contact: ContactRef<'_>, watch: &mut dyn Watch) -> Result<Vec<StepWork>, SimulateError> {
    let mut stages = Stages::new("integrating work".to_owned(), watch);
    let mut knots = by_law!(contact, contact => Course::new(drive, contact, &mut stages)?.times().to_vec());
    knots.dedup();
    let sampling = Sampling::Times(knots);
    stages.enter(0.4);
    let energy = energy_watched(drive, contact, &sampling, &mut stages)?;
    stages.enter(0.3);
    let at = simulate_watched(drive, contact, &sampling, &mut stages)?.displacement;
    stages.enter(0.3);
    let held = by_law!(contact, contact => held(drive, contact, &energy.time, &mut stages))?;
    stages.finish()?;
    let lost = energy.split.map(|split| split.lost);
    let step = |i: usize| StepWork {
        from: energy.time[i],
        until: energy.time[i + 1],
        displacement_from: at[i],
        displacement_until: at[i + 1],
        work: energy.work[i + 1] - energy.work[i],
        given_back: energy.given_back[i + 1] - energy.given_back[i],
        lost: lost.as_ref().map(|lost| lost[i + 1] - lost[i]),
        held_from: held[i],
        held_until: held[i + 1],
    };
    Ok((0..energy.time.len() - 1).map(step).collect())
}

/// What the state of the body stands for at times, J.
fn held<L: Layer>(
    drive: Drive<'_>,
    model: &L,
    times: &[f64],
    stages: &mut Stages<'_>,
) -> Result<Vec<f64>, SimulateError> {
    let course = Course::new(drive, model, stages)?;
    let contacts = 1.0 / model.specimen().contact_displacement(1.0);
    let (mut states, mut widest) = (Vec::with_capacity(times.len()), 0.0f64);
    walk(course.drive, model, &mut |stretch| {
        for time in [stretch.start, stretch.end] {
            let (u, _) = surface_at(stretch, model, time);
            widest = widest.max(model.specimen().stiffness(u).0);
        }
        let inside = |time: f64| time < stretch.end || stretch.end == course.end();
        while let Some(&time) = times.get(states.len()).filter(|time| inside(**time)) {
            states.push(surface_at(stretch, model, time));
        }
        Ok(stages.reach(course.share(stretch.end))?)
    })?;
    Ok(states.iter().map(|(u, excess)| model.stored(excess, *u, widest) * contacts).collect())
}

/// Share of the whole travel below which a turn of the jaw is none: noise of a measured displacement.
const TURN: f64 = 0.01;

/// Share of the work done in a cycle that the body may hold more or less at its end.
const HELD: f64 = 0.01;

/// The cycles of consecutive steps: from where the jaw begins to squeeze, after having stood or gone back, to where it does so again, or to
/// the end. Turns of less than a hundredth of the whole travel count as none.
///
/// A jaw that is back closes no cycle of a body that is not: of a dent that it still has, of a force with which it pulls at a bonded jaw. Such a
/// cycle has `lost` only where heat is known.
#[must_use]
pub fn cycles(steps: &[StepWork]) -> Vec<Cycle> {
    let Some(last) = steps.last() else {
        return Vec::new();
    };
    let at: Vec<f64> = steps.iter().map(|step| step.displacement_from).chain([last.displacement_until]).collect();
    let starts = squeezes(&at);
    let ends = starts.iter().skip(1).copied().chain([steps.len()]);
    let cycle = |(from, until): (usize, usize)| {
        let inside = &steps[from..until];
        let given_back: f64 = inside.iter().map(|step| step.given_back).sum();
        let area: f64 = inside.iter().map(|step| step.work).sum();
        let done = area + given_back;
        let (low, high) = range(&at[from..=until]);
        let jaw_is_back = (at[until] - at[from]).abs() <= TURN * (high - low);
        let left = inside[inside.len() - 1].held_until - inside[0].held_from;
        let is_closed = jaw_is_back && left.abs() <= HELD * done;
        let to_heat: Option<f64> = inside.iter().map(|step| step.lost).sum();
        let lost = to_heat.or(is_closed.then_some(area));
        Cycle {
            from: steps[from].from,
            until: steps[until - 1].until,
            done,
            given_back,
            lost,
            share_lost: lost.filter(|_| is_closed).map(|lost| if done > 0.0 { lost / done } else { 0.0 }),
            is_closed,
        }
    };
    starts.iter().copied().zip(ends).map(cycle).collect()
}

/// Where a displacement begins to rise from a low: the last place of each low.
fn squeezes(at: &[f64]) -> Vec<usize> {
    let (least, greatest) = range(at);
    let turn = TURN * (greatest - least);
    let (mut starts, mut low, mut high) = (Vec::new(), 0, 0);
    let mut is_rising = false;
    if turn == 0.0 {
        return starts;
    }
    for i in 0..at.len() {
        if at[i] <= at[low] {
            low = i;
        }
        if at[i] >= at[high] {
            high = i;
        }
        if !is_rising && at[i] - at[low] > turn {
            starts.push(low);
            (is_rising, high) = (true, i);
        } else if is_rising && at[high] - at[i] > turn {
            (is_rising, low) = (false, i);
        }
    }
    starts
}

fn range(at: &[f64]) -> (f64, f64) {
    at.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| (low.min(*d), high.max(*d)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_squeeze_begins_where_the_jaw_last_stood_low() {
        assert_eq!(squeezes(&[0.0, 5.0, 5.0, 0.0, 0.0, 7.0, 1.0]), [0, 4]);
        assert_eq!(squeezes(&[3.0, 0.0, 2.0, 2.001, 2.0, 4.0, 0.0]), [1]);
        assert_eq!(squeezes(&[0.0, 0.0, 0.0]), [0usize; 0]);
        assert_eq!(squeezes(&[5.0, 3.0, 1.0]), [0usize; 0]);
        assert_eq!(squeezes(&[0.0, 1.0]), [0]);
    }
}
