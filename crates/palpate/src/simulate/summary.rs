//! What a whole simulation comes to, without its series: for sweeps over many of them.

use serde::{Deserialize, Serialize};

use super::energy::{Account, stored_at};
use super::trajectory::{Trajectory, check_times, extend_forces, sample_times};
use super::{ContactEvent, ContactRef, Course, Drive, Layer, Sampling, SimulateError, StepEnd, by_law, walk};
use crate::vector::all_finite;
use crate::watch::{Stages, Unwatched};

/// Summary of a simulation, in SI units, compression positive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Summary {
    /// When it ended, s.
    pub end_time: f64,
    /// The largest force among the samples and the knots, N.
    pub peak_force: f64,
    /// When it stood first, s.
    pub peak_time: f64,
    /// Force at the end, N.
    pub force: f64,
    /// Displacement of the jaw at the end, m.
    pub displacement: f64,
    /// Strain of the contact layer at the end.
    pub strain: f64,
    /// Its excess over the equilibrium strain at the end.
    pub excess_strain: f64,
    /// Work that the jaw has done on the body, less what it got back, J.
    pub work: f64,
    /// What it got back, J.
    pub given_back: f64,
    /// What is stored at the end, J; `None` of a body whose area grows with the squeeze (see [`Energy`](super::Energy)).
    pub stored: Option<f64>,
    /// What was lost to heat, J; `None` as for `stored`.
    pub lost: Option<f64>,
    /// Contacts lost and regained, in order.
    pub events: Vec<ContactEvent>,
}

/// Summary of a simulation, with the ends of its steps.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RunSummary {
    /// What the whole comes to.
    pub summary: Summary,
    /// The ends of the steps of a program, or of the straight pieces of a motion; nothing of a force history.
    pub ends: Vec<StepEnd>,
    /// Forces (N) at the requested times; `None` if these do not rise or lie outside the drive.
    pub forces: Option<Vec<f64>>,
}

/// Simulates as [`simulate`](super::simulate()) does and keeps what the series comes to.
///
/// The numbers are those of `simulate` and [`energy`](super::energy()) at the same samples; only forces are computed between the knots.
///
/// ```
/// use palpate::contact::{Layers, Shape, Sides, Specimen};
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ContactModel, ProtocolStep, Sampling, Separation, protocol, summary};
///
/// let model = ContactModel {
///     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
///     law: LatencyLaw::new(5.0, 2e4)?,
///     layers: Layers::new(8.0)?,
///     separation: Separation::Unilateral,
/// };
/// let motion = protocol(&[ProtocolStep { to: 0.005, rate: 0.5 / 60.0, hold: 10.0 }])?;
/// let result = summary(&motion, &model, &Sampling::Rate(100.0))?;
/// assert!((result.peak_force - 3.035_025_007_5).abs() < 1e-9); // N, the peak of the paper's first step
/// assert!((result.force - 1.556_133_431_7).abs() < 1e-9); // N, after 10 s of relaxation
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As for `simulate`.
pub fn summary<'a, 'b>(
    drive: impl Into<Drive<'a>>,
    contact: impl Into<ContactRef<'b>>,
    sampling: &Sampling,
) -> Result<Summary, SimulateError> {
    run_summary(drive.into(), contact.into(), sampling, &[]).map(|run| run.summary)
}

/// The same with where its steps end, and with the forces at more `times` (s), by one walk through the drive.
pub(crate) fn run_summary(
    drive: Drive<'_>,
    contact: ContactRef<'_>,
    sampling: &Sampling,
    times: &[f64],
) -> Result<RunSummary, SimulateError> {
    let mut unwatched = Unwatched;
    let mut stages = Stages::new(String::new(), &mut unwatched);
    by_law!(contact, contact => summed_up(drive, contact, sampling, times, &mut stages))
}

fn summed_up<L: Layer>(
    drive: Drive<'_>,
    model: &L,
    sampling: &Sampling,
    wanted: &[f64],
    stages: &mut Stages<'_>,
) -> Result<RunSummary, SimulateError> {
    let course = Course::new(drive, model, stages)?;
    let times = times_and_knots(&course, sampling)?;
    let share = model.specimen().contact_displacement(1.0);
    let (last, contacts) = (course.end(), 1.0 / share);
    let mut peak = Peak {
        force: f64::NEG_INFINITY,
        time: 0.0,
        forces: Vec::new(),
    };
    let mut next = 0;
    let (mut account, mut stored) = (Account::default(), 0.0);
    let mut end = Trajectory::default();
    let mut ends = course.ends.clone();
    let mut forces = check_times((course.start(), last), wanted).is_ok().then(Vec::new);
    let (events, _) = walk(course.drive, model, &mut |stretch| {
        let inside = |time: &f64| *time < stretch.end || stretch.end == last;
        let until = next + times[next..].partition_point(inside);
        for times in times[next..until].chunks(CHUNK) {
            peak.forces.clear();
            extend_forces(stretch, model, times, &mut peak.forces);
            peak.take(times)?;
        }
        next = until;
        if let Some(forces) = &mut forces {
            let rest = &wanted[forces.len()..];
            extend_forces(stretch, model, &rest[..rest.partition_point(inside)], forces);
        }
        if let Drive::Motion(motion) = course.drive
            && motion.times().get(ends.len() + 1) == Some(&stretch.end)
        {
            let displacement = motion.displacements()[ends.len() + 1];
            ends.push(StepEnd {
                time: stretch.end,
                displacement,
                force: stretch.end_force(model, displacement * share),
            });
        }
        account.add(stretch, model, (stretch.start, stretch.end));
        if stretch.end == last {
            end = Trajectory::with_times(vec![last]);
            end.append(stretch, model, 1);
            stored = stored_at(stretch, model, last);
        }
        Ok(())
    })?;
    let (work, stored) = (account.work * contacts, stored * contacts);
    let divided = model.specimen().has_constant_section();
    let at_end = |series: &[f64]| series.first().copied().filter(|value| value.is_finite());
    let sound = [&end.force, &end.displacement, &end.strain, &end.excess_strain].map(|series| at_end(series));
    let ([Some(force), Some(displacement), Some(strain), Some(excess_strain)], true) = (sound, work.is_finite()) else {
        return Err(SimulateError::OutOfRange { time: last });
    };
    let summary = Summary {
        end_time: last,
        peak_force: peak.force,
        peak_time: peak.time,
        force,
        displacement,
        strain,
        excess_strain,
        work,
        given_back: account.given_back * contacts,
        stored: divided.then_some(stored),
        lost: divided.then_some(work - stored),
        events,
    };
    Ok(RunSummary {
        summary,
        ends,
        forces: forces.filter(|forces| all_finite(forces)),
    })
}

/// Samples whose forces are computed at a time.
const CHUNK: usize = 4096;

/// The sample times, and the knots where they are not among them.
fn times_and_knots(course: &Course<'_>, sampling: &Sampling) -> Result<Vec<f64>, SimulateError> {
    let mut times = sample_times(course, sampling)?;
    if matches!(sampling, Sampling::Times(_)) {
        times.extend_from_slice(course.times());
        times.sort_by(f64::total_cmp);
        times.dedup();
    }
    Ok(times)
}

/// The largest force so far, and room for the next ones.
struct Peak {
    force: f64,
    time: f64,
    forces: Vec<f64>,
}

impl Peak {
    fn take(&mut self, times: &[f64]) -> Result<(), SimulateError> {
        for (&force, &time) in self.forces.iter().zip(times) {
            if !force.is_finite() {
                return Err(SimulateError::OutOfRange { time });
            }
            if force > self.force {
                (self.force, self.time) = (force, time);
            }
        }
        Ok(())
    }
}
