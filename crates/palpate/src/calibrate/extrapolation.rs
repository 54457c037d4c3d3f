//! What lies beyond the test, and what it adds to the errors of a prediction.

use serde::{Deserialize, Serialize};

use super::range::{Held, HeldSpans, Way};
use super::{CalibrationRange, Material};
use crate::number::significant;
use crate::simulate::{Drive, Sampling, SimulateError, Trajectory, simulate_watched};
use crate::watch::Stages;

/// A question beyond what the test has tested.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Extrapolation {
    /// A longer hold of the displacement than any of the test.
    LongerHold {
        /// What was requested, s.
        requested: f64,
        /// What was tested, s; 0 where it held none.
        tested: f64,
    },
    /// A longer hold of the force than any of the test, or a force that is prescribed where the test held none.
    LongerForceHold {
        /// What was requested, s.
        requested: f64,
        /// What was tested, s; 0 where it held none.
        tested: f64,
    },
    /// A deeper squeeze.
    DeeperSqueeze {
        /// What was requested, m.
        requested: f64,
        /// What was tested, m.
        tested: f64,
    },
    /// A faster ramp.
    FasterRamp {
        /// What was requested, m/s.
        requested: f64,
        /// What was tested, m/s.
        tested: f64,
    },
    /// A larger force.
    LargerForce {
        /// What was requested, N.
        requested: f64,
        /// What was tested, N.
        tested: f64,
    },
    /// A farther retreat.
    FartherRetreat {
        /// What was requested, m.
        requested: f64,
        /// What was tested, m.
        tested: f64,
    },
    /// Loaded more often.
    MoreLoadings {
        /// What was requested.
        requested: u32,
        /// What was tested.
        tested: u32,
    },
}

impl std::fmt::Display for Extrapolation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = |value: f64| significant(value, 3);
        match *self {
            Self::LongerHold { tested: 0.0, .. } => {
                write!(
                    f,
                    "the displacement is held, while the test held none: the law predicts relaxation that was not observed"
                )
            }
            Self::LongerForceHold { tested: 0.0, .. } => {
                write!(f, "the force is held, while the test held none: the law predicts creep that was not observed")
            }
            Self::LongerForceHold { requested, tested } => write!(
                f,
                "the longest hold of the force lasts {} s, that of the test {} s: later displacements are extrapolated by the law",
                digits(requested),
                digits(tested)
            ),
            Self::LongerHold { requested, tested } => write!(
                f,
                "the longest hold lasts {} s, that of the test {} s: later forces are extrapolated by the law",
                digits(requested),
                digits(tested)
            ),
            Self::DeeperSqueeze { requested, tested } => write!(
                f,
                "the largest displacement is {} mm, that of the test {} mm: the equilibrium force beyond it is extrapolated",
                digits(1e3 * requested),
                digits(1e3 * tested)
            ),
            Self::FasterRamp { requested, tested } => write!(
                f,
                "the fastest ramp is {} mm/s, that of the test {} mm/s: the peak force may differ",
                digits(1e3 * requested),
                digits(1e3 * tested)
            ),
            Self::LargerForce { requested, tested } => {
                write!(
                    f,
                    "the largest force is {} N, that of the test {} N: the equilibrium force beyond it is extrapolated",
                    digits(requested),
                    digits(tested)
                )
            }
            Self::FartherRetreat { requested, tested: 0.0 } => write!(
                f,
                "the jaw retreats by {} mm, the test has loading alone: a body that softens by its first loading has less force",
                digits(1e3 * requested)
            ),
            Self::FartherRetreat { requested, tested } => write!(
                f,
                "the jaw retreats by {} mm, that of the test by {} mm: a body that softens by its first loading has less force",
                digits(1e3 * requested),
                digits(1e3 * tested)
            ),
            Self::MoreLoadings { requested, tested } => write!(
                f,
                "the body is loaded {requested} times, in the test {tested}: one that softens from cycle to cycle has less force"
            ),
        }
    }
}

/// By how much more than was tested a question may ask.
const MORE: f64 = 1.05;

/// Standard error of what a law predicts beyond the test, as a share of how much it predicts to change there: an interval of 95 % takes in that
/// nothing more changes, and that twice as much does.
const BY_LAW: f64 = 0.5;

/// Standard error of the force after a retreat that the test has not shown, as a share of it: an interval of 95 % takes in a half, about what
/// filled rubbers lose by their first loading (the Mullins effect).
const BY_DAMAGE: f64 = 0.25;

/// What lies beyond the test.
pub(super) struct Beyond {
    pub(super) extrapolations: Vec<Extrapolation>,
    /// What it adds to the variance of the force (N²) and of the displacement (m²) at each sample.
    pub(super) force: Vec<f64>,
    pub(super) displacement: Vec<f64>,
}

impl Beyond {
    /// Of the course of a drive with the best parameters; in a motion that was measured this was held.
    pub(super) fn of(
        material: &Material,
        (drive, held): (Drive<'_>, &HeldSpans),
        course: &Trajectory,
        stages: &mut Stages<'_>,
    ) -> Result<Self, SimulateError> {
        let (tested, contact) = (material.range(), material.contact());
        let way = Way::of(drive, contact, held)?;
        let extrapolations = extrapolations(tested, &way, course);
        let body = contact.specimen();
        let relaxed_at = |displacement: f64| body.equilibrium_force(body.contact_displacement(displacement));
        let mut beyond = Self {
            extrapolations,
            force: vec![0.0; course.len()],
            displacement: vec![0.0; course.len()],
        };
        if beyond.extrapolations.is_empty() {
            return Ok(beyond);
        }
        // Samples in a hold that lasts longer than any of the test, and when it had lasted as long.
        let mut longer: Vec<(usize, f64)> = Vec::new();
        let mut jaw = way.follow();
        for (index, time) in course.time.iter().enumerate() {
            let (force, displacement) = (course.force[index], course.displacement[index]);
            let done = jaw.until(*time);
            let relaxed = relaxed_at(displacement);
            let mut add = |error: f64| beyond.force[index] += error * error;
            if displacement > MORE * tested.deepest && relaxed > 0.0 {
                add(BY_LAW * force * (1.0 - relaxed_at(tested.deepest) / relaxed));
            }
            if done.fastest > MORE * tested.fastest {
                add(BY_LAW * (force - relaxed) * (1.0 - tested.fastest / done.fastest));
            }
            if done.retreat > MORE * tested.farthest_retreat {
                add(BY_DAMAGE * force * (1.0 - tested.farthest_retreat / done.retreat));
            }
            if done.loadings > tested.loadings {
                add(BY_DAMAGE * force * (1.0 - f64::from(tested.loadings) / f64::from(done.loadings)));
            }
            let longest = match done.held {
                Held::Displacement => tested.longest_hold,
                Held::Force => tested.longest_force_hold,
                Held::Nothing | Held::Pressed => continue,
            };
            if time - done.since > longest {
                longer.push((index, done.since + longest));
            }
        }
        let mut tested_for: Vec<f64> = longer.iter().map(|(_, time)| *time).collect();
        tested_for.dedup();
        if !tested_for.is_empty() {
            let there = simulate_watched(drive, contact, &Sampling::Times(tested_for.clone()), stages)?;
            for (index, time) in longer {
                let at = tested_for.partition_point(|tested| *tested < time);
                beyond.force[index] += (BY_LAW * (course.force[index] - there.force[at])).powi(2);
                if !matches!(drive, Drive::Motion(_)) {
                    let creep = course.displacement[index] - there.displacement[at];
                    beyond.displacement[index] += (BY_LAW * creep).powi(2);
                }
            }
        }
        Ok(beyond)
    }
}

fn extrapolations(tested: &CalibrationRange, way: &Way, course: &Trajectory) -> Vec<Extrapolation> {
    let done = way.follow().until(f64::INFINITY);
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    // A force that changes all the time is foreign to a test in displacement, too.
    let least = if way.holds_force() { f64::MIN_POSITIVE } else { 0.0 };
    type Requested = (f64, f64, fn(f64, f64) -> Extrapolation);
    let kinds: [Requested; 6] = [
        (done.longest_hold, tested.longest_hold, |requested, tested| Extrapolation::LongerHold {
            requested,
            tested,
        }),
        (done.longest_force_hold.max(least), tested.longest_force_hold, |requested, tested| {
            Extrapolation::LongerForceHold { requested, tested }
        }),
        (most(&course.displacement).max(done.deepest), tested.deepest, |requested, tested| {
            Extrapolation::DeeperSqueeze { requested, tested }
        }),
        (done.fastest, tested.fastest, |requested, tested| Extrapolation::FasterRamp { requested, tested }),
        (most(&course.force), tested.largest_force, |requested, tested| Extrapolation::LargerForce {
            requested,
            tested,
        }),
        (done.retreat, tested.farthest_retreat, |requested, tested| Extrapolation::FartherRetreat {
            requested,
            tested,
        }),
    ];
    let beyond = kinds.into_iter().filter(|(requested, tested, _)| *requested > MORE * tested);
    let mut found: Vec<Extrapolation> = beyond.map(|(requested, tested, kind)| kind(requested, tested)).collect();
    if done.loadings > tested.loadings {
        found.push(Extrapolation::MoreLoadings {
            requested: done.loadings,
            tested: tested.loadings,
        });
    }
    found
}
