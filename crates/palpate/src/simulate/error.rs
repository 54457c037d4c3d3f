//! Why a simulation could not run.

use crate::contact::SpecimenError;
use crate::watch::Cancelled;

/// Most events of the contact in one straight piece of motion. A body with a few times has a few; a thousand are a jaw and a surface that
/// go back together, which neither ends nor changes any force.
pub(crate) const MOST_EVENTS: usize = 1000;

/// Why a simulation could not run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// A contact that is lost and regained without end while the jaw moves straight: its relaxation is too fast for the motion.
    #[error(
        "from t = {time} s on the contact is lost and regained more than {MOST_EVENTS} times while the jaw moves straight"
    )]
    Chatter {
        /// Start of the piece of motion, s.
        time: f64,
    },
    /// The motion exceeds the displacement range of the specimen.
    #[error("at t = {time} s the jaw is at {displacement} m: {source}")]
    Displacement {
        /// Time of the knot, s.
        time: f64,
        /// Displacement of the jaw there, m.
        displacement: f64,
        /// What the specimen says.
        source: SpecimenError,
    },
    /// A force that no displacement of the body carries.
    #[error("at t = {time} s no single displacement within the range of the body carries {force} N")]
    Force {
        /// Time, s.
        time: f64,
        /// Force there, N.
        force: f64,
    },
    /// A force that pulls where nothing can be pulled.
    #[error(
        "at t = {time} s the force is {force} N: {}",
        if *bonded { "a ball bonded to the jaw loses its contact area before it carries tension" } else { "a jaw that is not bonded to the body cannot pull" }
    )]
    Tension {
        /// Time of the knot, s.
        time: f64,
        /// Force there, N.
        force: f64,
        /// Whether body and jaw are bonded.
        bonded: bool,
    },
    /// A force that changes so slowly, or a law so fast, that too many steps would be needed.
    #[error(
        "the law relaxes too fast for the change of force at t = {time} s: increase force_rate, or hold the force, whose simulation \
         takes any law"
    )]
    TooStiff {
        /// How far it came, s.
        time: f64,
    },
    /// Layers that relax too fast for all of them to be followed.
    #[error(
        "the layers relax too fast to integrate from t = {time} s: simulate the contact alone, which takes any law, or use \
         fewer layers"
    )]
    StiffLayers {
        /// How far it came, s.
        time: f64,
    },
    /// A body whose contact grows, bonded to a jaw that goes back to first touch, under a law that remembers force.
    #[error(
        "at t = {time} s the jaw is back at first touch, where a law with memory of force has a force but no contact area: stay \
         above 0 m, allow separation, or use a law with memory of strain"
    )]
    NoArea {
        /// When, s.
        time: f64,
    },
    /// A program without a step that takes time.
    #[error("a program needs a step of positive duration, found none")]
    EmptyProgram,
    /// An invalid step.
    #[error("step {step}: {name} must be finite and, but for a target, above 0 {unit}, found {found} {unit}")]
    StepNumber {
        /// Number of the step, from 1.
        step: usize,
        /// Which number.
        name: &'static str,
        /// Its unit.
        unit: &'static str,
        /// What was given.
        found: f64,
    },
    /// A force that a moving jaw never meets.
    #[error("step {step}: the jaw never reaches a force of {target} N: it ends at {most} N")]
    Unreachable {
        /// Number of the step, from 1.
        step: usize,
        /// The force requested, N.
        target: f64,
        /// The force where the body ends, N.
        most: f64,
    },
    /// A prescribed force while the jaw is off the body.
    #[error("step {step}: at t = {time} s the jaw is off the body and cannot hold a force: move it to a force first")]
    NoContact {
        /// Number of the step, from 1.
        step: usize,
        /// Time, s.
        time: f64,
    },
    /// A sample time outside the motion, or before the one before it.
    #[error("sample times must rise from {from} s to {until} s at most, found {found} s at index {index}")]
    SampleTime {
        /// Start of the motion, s.
        from: f64,
        /// End of the motion, s.
        until: f64,
        /// The time that is out of place, s.
        found: f64,
        /// Its index.
        index: usize,
    },
    /// More samples than a trajectory holds.
    #[error(
        "{found:.3e} samples exceed the limit of {limit:.0e}: state a lower sample_rate, or the times, under [output] of the protocol"
    )]
    TooManySamples {
        /// How many are requested.
        found: f64,
        /// The limit.
        limit: f64,
    },
    /// A sample rate that is not a finite number above zero.
    #[error("sample rate must be above 0 Hz, found {found} Hz")]
    SampleRate {
        /// What was given, Hz.
        found: f64,
    },
    /// A number of layers that is not whole has a force but no layers to show.
    #[error(
        "the strain wave needs a whole number of layers, found {found}; the contact force is defined for any real number"
    )]
    FractionalLayers {
        /// m.
        found: f64,
    },
    /// The values exceed the range of double precision.
    #[error("the simulation exceeds the range of double precision at t = {time} s")]
    OutOfRange {
        /// Time, s.
        time: f64,
    },
    /// Its watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SimulateError {
    /// The same with the number of the step of a program turned into another: that of what the step was written in.
    #[must_use]
    pub fn in_step(mut self, number: impl Fn(usize) -> usize) -> Self {
        if let Self::StepNumber { step, .. } | Self::Unreachable { step, .. } | Self::NoContact { step, .. } = &mut self
        {
            *step = number(*step);
        }
        self
    }
}
