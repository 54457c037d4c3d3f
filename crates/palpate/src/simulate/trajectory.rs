//! The series of a simulation at the asked times.

use serde::{Deserialize, Serialize};

use super::walk::{Stretch, StretchState, walk};
use super::{ContactEvent, ContactModel, Motion, SimulateError, Work};

/// When to report.
#[derive(Debug, Clone, PartialEq)]
pub enum Sampling {
    /// At this rate in Hz from the start of the motion, and at every knot of it.
    Rate(f64),
    /// At these times in s, rising and inside the motion, and nowhere else.
    Times(Vec<f64>),
}

/// Most samples a trajectory is made of.
const MOST_SAMPLES: f64 = 1e8;

/// A simulated contact over time; all series have the same length, SI units, compression positive.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
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
    /// Contacts lost and regained, in order.
    pub events: Vec<ContactEvent>,
    /// What it cost.
    pub work: Work,
}

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

    fn with_times(time: Vec<f64>) -> Self {
        let room = || Vec::with_capacity(time.len());
        Self {
            displacement: room(),
            contact_displacement: room(),
            force: room(),
            strain: room(),
            equilibrium_strain: room(),
            excess_strain: room(),
            strain_rate: room(),
            time,
            ..Self::default()
        }
    }
}

/// Simulates the contact force of `model` under `motion`: section IV of the paper, equations (10) and (11).
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
/// # Errors
/// [`SimulateError`] if the motion goes where the specimen cannot, or the sampling does not fit the motion.
pub fn simulate(motion: &Motion, model: &ContactModel, sampling: &Sampling) -> Result<Trajectory, SimulateError> {
    let mut result = Trajectory::with_times(sample_times(motion, sampling)?);
    let last = motion.end();
    let (events, work) = walk(motion, model, |stretch| {
        while let Some(&time) = result.time.get(result.force.len()) {
            if time >= stretch.end && stretch.end < last {
                break;
            }
            sample(stretch, model, time, &mut result);
        }
        Ok(())
    })?;
    // A contact lost or met exactly at the end leaves its last sample to the stretch before it.
    result.events = events;
    result.work = work;
    match result.force.iter().position(|force| !force.is_finite()) {
        Some(index) => Err(SimulateError::OutOfRange {
            time: result.time[index],
        }),
        None => Ok(result),
    }
}

/// Appends the state at `time`, which lies in `stretch`.
fn sample(stretch: &Stretch, model: &ContactModel, time: f64, out: &mut Trajectory) {
    let jaw = stretch.jaw_at(time);
    let depth = model.specimen.depth();
    let (surface, strain, rate) = match &stretch.state {
        StretchState::Touching(element) => {
            let excess = element.excess_at(time - stretch.start);
            let strain = excess + model.specimen.equilibrium_strain(jaw);
            let drive = model.layers.drive(stretch.contact_speed, depth);
            let rate = drive + model.law.rate(excess) + stretch.contact_speed / depth;
            (jaw, strain, rate)
        }
        StretchState::Free { surface, since } => (surface.displacement_at(time - since), 0.0, 0.0),
    };
    let equilibrium = model.specimen.equilibrium_strain(surface);
    let sides = model.specimen.contact_displacement(1.0);
    out.displacement.push(jaw / sides);
    out.contact_displacement.push(surface);
    out.force.push(model.specimen.force(strain, surface));
    out.strain.push(strain);
    out.equilibrium_strain.push(equilibrium);
    out.excess_strain.push(strain - equilibrium);
    out.strain_rate.push(rate);
}

/// The sample times of a motion: the grid of a rate together with the knots, or the given times once checked.
pub(super) fn sample_times(motion: &Motion, sampling: &Sampling) -> Result<Vec<f64>, SimulateError> {
    let (from, until) = (motion.start(), motion.end());
    let times = match sampling {
        Sampling::Rate(rate) => {
            if !(rate.is_finite() && *rate > 0.0) {
                return Err(SimulateError::SampleRate { found: *rate });
            }
            let count = (until - from) * rate;
            if count > MOST_SAMPLES {
                return Err(SimulateError::TooManySamples {
                    found: count,
                    limit: MOST_SAMPLES,
                });
            }
            grid_with_knots(motion, *rate, count as usize)
        }
        Sampling::Times(times) => times.clone(),
    };
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
        None => Ok(times),
    }
}

fn grid_with_knots(motion: &Motion, rate: f64, count: usize) -> Vec<f64> {
    let (from, until) = (motion.start(), motion.end());
    let grid = (0..=count).map(|i| from + i as f64 / rate).filter(|&time| time <= until);
    let mut times: Vec<f64> = grid.chain(motion.times().iter().copied()).collect();
    times.sort_by(f64::total_cmp);
    // A grid point a rounding error away from a knot is that knot.
    let close = 1e-9 / rate;
    let mut merged: Vec<f64> = Vec::with_capacity(times.len());
    let mut knots = motion.times().iter().copied().peekable();
    for time in times {
        while knots.next_if(|&knot| knot < time - close).is_some() {}
        let time = knots.peek().copied().filter(|knot| (knot - time).abs() <= close).unwrap_or(time);
        if merged.last() != Some(&time) {
            merged.push(time);
        }
    }
    merged
}
