//! The series of a simulation at the requested times.

use serde::{Deserialize, Serialize};

use super::{
    ContactEvent, ContactRef, Course, Drive, InMotion, Layer, Motion, SimulateError, SimulationWork, Stretch,
    StretchState, by_law, walk,
};
use crate::contact::UnderForce;
use crate::vector::{all_finite, rises_or_stays};
use crate::watch::{Stages, Unwatched, Watch};

/// When to report.
#[derive(Debug, Clone, PartialEq)]
pub enum Sampling {
    /// At this rate in Hz from the start of the motion, and at every knot of it.
    Rate(f64),
    /// At these times in s, rising and inside the motion, and nowhere else.
    Times(Vec<f64>),
}

/// Most samples a trajectory is made of.
const MOST_SAMPLES: f64 = 1e7;

/// A simulated contact over time; all series have the same length, SI units, compression positive.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Trajectory {
    /// Time, s.
    pub time: Vec<f64>,
    /// Displacement of the jaw, m.
    pub displacement: Vec<f64>,
    /// Displacement of the surface of the body at one contact, m; the jaw's share while they touch.
    pub contact_displacement: Vec<f64>,
    /// Contact force, N.
    pub force: Vec<f64>,
    /// Strain ε of the contact layer.
    pub strain: Vec<f64>,
    /// Equilibrium strain ε_e of the contact layer.
    pub equilibrium_strain: Vec<f64>,
    /// Excess strain x = ε − ε_e.
    pub excess_strain: Vec<f64>,
    /// Strain rate of the contact layer, 1/s; at a knot, that of the piece that begins there.
    pub strain_rate: Vec<f64>,
    /// Whether the jaw touches the body; at the moment of a loss or a return, what it is from there on.
    pub in_contact: Vec<bool>,
    /// Contacts lost and regained, in order.
    pub events: Vec<ContactEvent>,
    /// What it cost.
    pub work: SimulationWork,
}

checked_when_read!(Trajectory, "series of one length", |found: &Trajectory| {
    let series = [
        &found.displacement,
        &found.contact_displacement,
        &found.force,
        &found.strain,
        &found.equilibrium_strain,
        &found.excess_strain,
        &found.strain_rate,
    ];
    found.in_contact.len() == found.time.len() && series.iter().all(|values| values.len() == found.time.len())
});

impl Trajectory {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    pub(super) fn with_times(time: Vec<f64>) -> Self {
        let room = || Vec::with_capacity(time.len());
        Self {
            displacement: room(),
            contact_displacement: room(),
            force: room(),
            strain: room(),
            equilibrium_strain: room(),
            excess_strain: room(),
            strain_rate: room(),
            in_contact: Vec::with_capacity(time.len()),
            time,
            ..Self::default()
        }
    }

    /// Appends the samples up to index `until`, whose times lie in `stretch`, column by column.
    pub(super) fn append<L: Layer>(&mut self, stretch: &Stretch<L>, model: &L, until: usize) {
        let (specimen, depth) = (model.specimen(), model.specimen().depth());
        let from = self.force.len();
        let times = &self.time[from..until];
        let per_side = 1.0 / specimen.contact_displacement(1.0);
        let jaw = times.iter().map(|&time| stretch.jaw_at(time));
        if !matches!(stretch.state, StretchState::Forced(_)) {
            self.displacement.extend(jaw.clone().map(|u| u * per_side));
        }
        self.in_contact.resize(until, !matches!(stretch.state, StretchState::Free { .. }));
        match &stretch.state {
            StretchState::Touching(piece) => {
                self.contact_displacement.extend(jaw);
                let line = (stretch.start, stretch.contact_speed);
                let contact = &self.contact_displacement[from..];
                model.extend(piece, line, (times, contact), &mut self.excess_strain, &mut self.strain_rate);
                self.equilibrium_strain.extend(contact.iter().map(|u| specimen.equilibrium_strain(*u)));
                let parts = self.equilibrium_strain[from..].iter().zip(&self.excess_strain[from..]);
                self.strain.extend(parts.map(|(equilibrium, excess)| equilibrium + excess));
                let state = self.strain[from..].iter().zip(contact);
                self.force.extend(state.map(|(strain, u)| specimen.force(*strain, *u)));
            }
            StretchState::Forced(forced) => {
                for time in times {
                    let elapsed = time - stretch.start;
                    let state = forced.at(elapsed);
                    let equilibrium = specimen.equilibrium_strain(state.displacement);
                    self.displacement.push(state.displacement * per_side);
                    self.contact_displacement.push(state.displacement);
                    self.force.push(forced.force_at(elapsed));
                    self.equilibrium_strain.push(equilibrium);
                    self.excess_strain.push(state.excess);
                    self.strain.push(equilibrium + state.excess);
                    self.strain_rate.push(state.excess_rate + state.speed / depth);
                }
            }
            StretchState::Free { surface, since } => {
                let surface = times.iter().map(|time| model.surface(surface, time - since));
                self.contact_displacement.extend(surface);
                let contact = &self.contact_displacement[from..];
                self.equilibrium_strain.extend(contact.iter().map(|u| specimen.equilibrium_strain(*u)));
                self.excess_strain.extend(self.equilibrium_strain[from..].iter().map(|equilibrium| -equilibrium));
                for unloaded in [&mut self.strain, &mut self.strain_rate, &mut self.force] {
                    unloaded.resize(until, 0.0);
                }
            }
        }
    }
}

/// Simulates the contact of `model` under a motion of the jaw, a force, or a program of both: section IV of the paper, equations (10) and
/// (11).
///
/// The body starts relaxed at the first knot. Holds and recoveries are closed forms; ramps are integrated to a
/// relative error near 1e-12 of the strain. The cost does not depend on the number of layers.
///
/// ```
/// use palpate::contact::{Layers, Shape, Sides, Specimen};
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ContactModel, ProtocolStep, Sampling, Separation, protocol, simulate};
///
/// let model = ContactModel {
///     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
///     law: LatencyLaw::new(5.0, 2e4)?,
///     layers: Layers::new(8.0)?,
///     separation: Separation::Unilateral,
/// };
/// let motion = protocol(&[ProtocolStep { to: 0.005, rate: 0.5 / 60.0, hold: 10.0 }])?;
/// let result = simulate(&motion, &model, &Sampling::Times(vec![0.6, 10.6]))?;
/// assert!((result.force[0] - 3.035_025_007_5).abs() < 1e-9); // N, the peak of the paper's first step
/// assert!((result.force[1] - 1.556_133_431_7).abs() < 1e-9); // N, after 10 s of relaxation
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// **Under a force** the contact layer takes it at once and the layers behind follow by the law: E ε A(u₁) = F with ε = (u₁ − u₂)/ℓ gives
/// u₁, and u̇₂ = ℓ v sgn(x)|x|ⁿ. A held force (creep, or recovery once it is gone) has the closed form of the law in a time of its own; a
/// changing one is integrated. The jaw is never lost: at no force it follows the surface. Right at first touch of a ball the
/// displacement begins like √t: `strain_rate` is infinite at that one sample.
///
/// ```
/// # use palpate::contact::{Layers, Shape, Sides, Specimen};
/// # use palpate::latency::LatencyLaw;
/// # use palpate::simulate::{ContactModel, Separation};
/// use palpate::simulate::{ForceHistory, ProgramStep, Sampling, simulate, step_ends};
/// # let model = ContactModel {
/// #     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
/// #     law: LatencyLaw::new(5.0, 2e4)?,
/// #     layers: Layers::new(8.0)?,
/// #     separation: Separation::Unilateral,
/// # };
/// let squeeze = ForceHistory::new(vec![0.0, 1.0, 61.0], vec![0.0, 10.0, 10.0])?;
/// let result = simulate(&squeeze, &model, &Sampling::Times(vec![1.0, 61.0]))?;
/// assert!((result.contact_displacement[0] - 5.882_987_117_3e-3).abs() < 1e-12); // m, when 10 N are reached
/// assert!((result.contact_displacement[1] - 7.453_005_345_3e-3).abs() < 1e-12); // m, after a minute of creep
///
/// // Squeeze to 10 N at 50 mm/min, hold the position for 30 s, hold the force for 30 s, release.
/// let program = [
///     ProgramStep::MoveToForce { force: 10.0, rate: 0.05 / 60.0 },
///     ProgramStep::HoldPosition { duration: 30.0 },
///     ProgramStep::HoldForce { duration: 30.0 },
///     ProgramStep::Move { to: 0.0, rate: 0.05 / 60.0 },
/// ];
/// let result = simulate(&program, &model, &Sampling::Rate(10.0))?;
/// assert_eq!(*result.force.last().unwrap(), 0.0);
/// let ends = step_ends(&program, &model)?;
/// assert!((ends[0].force - 10.0).abs() < 1e-12);
/// assert!(ends[1].force < ends[0].force && ends[1].displacement == ends[0].displacement);
/// assert!(ends[2].displacement > ends[1].displacement);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SimulateError`] if the motion goes where the specimen cannot, or the sampling does not fit the drive; under a force
/// [`SimulateError::Force`] where no displacement of the body carries it and [`SimulateError::Tension`] where it would need glue; in a program
/// for a step with wrong numbers, a force that the jaw never meets, and force control while the jaw is off the body.
pub fn simulate<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    sampling: &Sampling,
) -> Result<Trajectory, SimulateError> {
    simulate_watched(drive, contact, sampling, &mut Unwatched)
}

/// As [`simulate`], heard by `watch` at every straight piece of the drive and every 65,536 samples.
///
/// # Errors
/// As for [`simulate`], and [`SimulateError::Cancelled`].
pub fn simulate_watched<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    sampling: &Sampling,
    watch: &mut dyn Watch,
) -> Result<Trajectory, SimulateError> {
    simulated(drive.into(), contact.into(), sampling, watch)
}

/// Without generics, so that it is compiled here, once, and not wherever it is called.
fn simulated(
    drive: Drive<'_>,
    contact: ContactRef<'_>,
    sampling: &Sampling,
    watch: &mut dyn Watch,
) -> Result<Trajectory, SimulateError> {
    let mut stages = Stages::new("simulating".to_owned(), watch);
    let result = by_law!(contact, contact => trajectory(drive, contact, sampling, &mut stages))?;
    stages.finish()?;
    Ok(result)
}

/// Samples that are computed between two reports.
const AT_ONCE: usize = 65_536;

fn trajectory<L: Layer>(
    drive: Drive<'_>,
    model: &L,
    sampling: &Sampling,
    stages: &mut Stages<'_>,
) -> Result<Trajectory, SimulateError> {
    let course = Course::new(drive, model, stages)?;
    let mut result = Trajectory::with_times(sample_times(&course, sampling)?);
    let (last, mut next) = (course.end(), 0);
    stages.enter(1.0);
    let (events, work) = walk(course.drive, model, &mut |stretch| {
        let inside = |time: &f64| *time < stretch.end || stretch.end == last;
        let until = next + result.time[next..].partition_point(inside);
        while next < until {
            let end = until.min(next + AT_ONCE);
            result.append(stretch, model, end);
            stages.reach(course.share(result.time[end - 1]))?;
            next = end;
        }
        Ok(stages.reach(course.share(stretch.end))?)
    })?;
    result.events = events;
    result.work = work;
    let sound = |index: usize| result.force[index].is_finite() && result.contact_displacement[index].is_finite();
    match (0..result.len()).find(|index| !sound(*index)) {
        Some(index) => Err(SimulateError::OutOfRange {
            time: result.time[index],
        }),
        None => Ok(result),
    }
}

/// The contact force (N) at rising `times` (s) inside the motion, and nothing else: for fits that simulate many times.
///
/// Equal to [`simulate`] with [`Sampling::Times`], at a fraction of its cost.
///
/// # Errors
/// As for [`simulate`].
pub fn simulate_force<'a>(
    motion: &Motion,
    contact: impl Into<ContactRef<'a>>,
    times: &[f64],
) -> Result<Vec<f64>, SimulateError> {
    forces(motion, contact.into(), times)
}

fn forces(motion: &Motion, contact: ContactRef<'_>, times: &[f64]) -> Result<Vec<f64>, SimulateError> {
    by_law!(contact, contact => forces_of(motion, contact, times))
}

fn forces_of<L: Layer>(motion: &Motion, model: &L, times: &[f64]) -> Result<Vec<f64>, SimulateError> {
    check_times((motion.start(), motion.end()), times)?;
    let last = motion.end();
    let mut force: Vec<f64> = Vec::with_capacity(times.len());
    walk(motion.into(), model, &mut |stretch| {
        let next = force.len();
        let inside = |time: &f64| *time < stretch.end || stretch.end == last;
        let times = &times[next..next + times[next..].partition_point(inside)];
        extend_forces(stretch, model, times, &mut force);
        Ok(())
    })?;
    if all_finite(&force) {
        return Ok(force);
    }
    let first = force.iter().position(|force| !force.is_finite());
    Err(SimulateError::OutOfRange {
        time: first.map_or(last, |index| times[index]),
    })
}

/// Appends the contact force at `times` (s) inside a stretch.
pub(super) fn extend_forces<L: Layer>(stretch: &Stretch<L>, model: &L, times: &[f64], force: &mut Vec<f64>) {
    let (next, specimen) = (force.len(), model.specimen());
    match &stretch.state {
        StretchState::Touching(piece) => {
            piece.extend_strains(stretch.start, times, force);
            if stretch.contact_speed == 0.0 {
                // In a hold, where nearly all samples lie, only the excess changes.
                let u = stretch.contact_from;
                let (stiffness, equilibrium) = (specimen.force(1.0, u), specimen.equilibrium_strain(u));
                force[next..].iter_mut().for_each(|slot| *slot = stiffness * (*slot + equilibrium));
            } else {
                for (slot, &time) in force[next..].iter_mut().zip(times) {
                    let u = stretch.jaw_at(time);
                    *slot = specimen.force(*slot + specimen.equilibrium_strain(u), u);
                }
            }
        }
        StretchState::Forced(forced) => {
            force.extend(times.iter().map(|time| forced.force_at(time - stretch.start)));
        }
        StretchState::Free { .. } => force.resize(next + times.len(), 0.0),
    }
}

/// The sample times of a course: the grid of a rate together with the knots, or the given times once checked.
pub(super) fn sample_times(course: &Course<'_>, sampling: &Sampling) -> Result<Vec<f64>, SimulateError> {
    match sampling {
        Sampling::Rate(rate) => {
            if !(rate.is_finite() && *rate > 0.0) {
                return Err(SimulateError::SampleRate { found: *rate });
            }
            let count = (course.end() - course.start()) * rate;
            if count > MOST_SAMPLES {
                return Err(SimulateError::TooManySamples {
                    found: count,
                    limit: MOST_SAMPLES,
                });
            }
            Ok(grid_with_knots(course, *rate, count as usize))
        }
        Sampling::Times(times) => {
            check_times((course.start(), course.end()), times)?;
            Ok(times.clone())
        }
    }
}

/// Checks that times rise and lie inside the course.
pub(super) fn check_times((from, until): (f64, f64), times: &[f64]) -> Result<(), SimulateError> {
    // Nearly always they are good: found out at the speed of vectors.
    if rises_or_stays(times)
        && times.first().is_none_or(|first| *first >= from)
        && times.last().is_none_or(|last| *last <= until)
    {
        return Ok(());
    }
    let misplaced = |(index, &time): (usize, &f64)| {
        let rising = index == 0 || times[index - 1] <= time;
        !(time >= from && time <= until && rising)
    };
    match times.iter().enumerate().position(misplaced) {
        Some(index) => Err(SimulateError::SampleTime {
            from,
            until,
            found: times[index],
            index,
        }),
        None => Ok(()),
    }
}

/// The times i/rate from the start, with every knot in between; a grid time a rounding error away from a knot is that knot.
fn grid_with_knots(course: &Course<'_>, rate: f64, count: usize) -> Vec<f64> {
    let (knots, from, close) = (course.times(), course.start(), 1e-9 / rate);
    let mut times = Vec::with_capacity(count + knots.len() + 1);
    let mut next = 0;
    for &knot in knots {
        let until = (((knot - close - from) * rate).ceil().max(0.0) as usize).max(next);
        times.extend((next..until).map(|i| from + i as f64 / rate));
        // A step of a force has two knots at one time.
        if times.last() != Some(&knot) {
            times.push(knot);
        }
        next = (((knot + close - from) * rate).floor() as usize + 1).max(until);
    }
    times
}
