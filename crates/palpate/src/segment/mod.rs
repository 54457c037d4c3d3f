//! Phases of a test found without labels: loading, hold, unloading; first touch; Type I and Type II.
//!
//! | file | what |
//! |---|---|
//! | `options.rs` | every threshold as an option, and the value it took |
//! | `from_both.rs` | phases where displacement and force were recorded |
//! | `levels.rs` | where a column stands still |
//! | `pieces.rs`, `line.rs` | a column as a polygon of straight lines |
//! | `moves.rs` | the polygon as what the column does |
//! | `standstill.rs` | which parts of the polygon are standstills |
//! | `evidence.rs` | what speaks for a standstill |
//! | `smooth.rs` | a standstill has corners, a turning point has none |
//! | `mode.rs` | what is held: the displacement, the force, or neither |
//! | `ripple.rs` | the ripple of a controller that hunts |
//! | `turning.rs` | turning points |
//! | `from_force.rs` | phases where only the force was |
//! | `after_peaks.rs` | holds of a force that relaxes slowly all along |
//! | `given.rs` | holds whose limits someone gives |
//! | `edges.rs` | where exactly a hold begins and ends |
//! | `ramps.rs` | what lies between the holds: loading and unloading |
//! | `rupture.rs` | where the body broke |
//! | `relaxation.rs` | Type I or Type II, and how sure |
//! | `contact_point.rs` | first touch and the zero of the force |
//! | `contact_point/estimators.rs` | first touch by rules that know no law |
//! | `loading_curve.rs` | the force of a first ramp under the law, and where it begins |

mod after_peaks;
mod contact_point;
mod edges;
mod evidence;
mod from_both;
mod from_force;
mod given;
mod levels;
mod line;
mod loading_curve;
mod mode;
mod moves;
mod options;
mod pieces;
mod ramps;
mod relaxation;
mod ripple;
mod rupture;
mod smooth;
mod standstill;
mod turning;

pub use contact_point::{
    ContactChoice, ContactPoint, TouchEstimate, TouchMethod, find_contact, find_contact_of, free_samples,
};
pub use given::{GivenHold, phases_with};
pub use mode::HoldMode;
pub(crate) use mode::{change, mode as held_in};
pub use options::{HoldStart, SegmentOptions, SegmentSettings};
pub use relaxation::{Relaxation, RelaxationType, classify_relaxation};
pub use ripple::Ripple;
pub use rupture::Rupture;

use serde::{Deserialize, Serialize};

use crate::number::significant;
use crate::record::Record;

/// What the jaw does in a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Standing still with nothing held: before anything moved, or after the body broke.
    Rest,
    /// The displacement grows.
    Loading,
    /// The displacement stays, or the force.
    Hold,
    /// The displacement falls.
    Unloading,
}

/// What came before a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum After {
    /// The displacement had grown.
    Loading,
    /// The displacement had fallen.
    Unloading,
}

/// A stretch of the record in one phase.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// What the jaw does.
    pub phase: Phase,
    /// First sample.
    pub start: usize,
    /// Sample after the last.
    pub end: usize,
    /// For a hold: what came before it.
    pub after: Option<After>,
    /// For a hold: what is held in it.
    pub mode: Option<HoldMode>,
    /// For a hold: the sample from which laws are fitted, see [`HoldStart`]. It lies before `start` where the force peaked
    /// while the jaw was still settling.
    pub fit_start: usize,
}

impl Segment {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.end - self.start
    }

    /// Never true.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.end == self.start
    }
}

/// All segments of a record in order, and the thresholds that found them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Segmentation {
    /// Segments; together they cover the record without gaps.
    pub segments: Vec<Segment>,
    /// Where the body broke.
    pub ruptures: Vec<Rupture>,
    /// The ripple of a jaw that hunts about the places it holds, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ripple: Option<Ripple>,
    /// The thresholds used.
    pub settings: SegmentSettings,
}

impl Segmentation {
    /// The holds, in order.
    pub fn holds(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|segment| segment.phase == Phase::Hold)
    }
}

/// Why no phases were found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SegmentError {
    /// Too few samples to see phases.
    #[error("phases need {needed} samples or more, found {found}")]
    TooShort {
        /// Least number.
        needed: usize,
        /// Samples found.
        found: usize,
    },
    /// The displacement (or force) never leaves its noise.
    #[error(
        "nothing moves: the {column} stays within {}, its noise is {}",
        told(*range, unit),
        told(*noise, unit)
    )]
    NoMotion {
        /// Which column.
        column: &'static str,
        /// Its range.
        range: f64,
        /// Its noise.
        noise: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// It moves all the time.
    #[error("no hold found: {}", no_hold((*longest, *samples), (*minimum_hold, *minimum_samples)))]
    NoHold {
        /// Longest stretch after a ramp in which it moves slowest, s; 0 if there is none.
        longest: f64,
        /// Its samples.
        samples: usize,
        /// Least duration of a hold, s.
        minimum_hold: f64,
        /// Least number of samples of a hold.
        minimum_samples: usize,
    },
    /// The jaw stands still only after the body broke.
    #[error(
        "no hold found: at {} the body broke under {}, and {} are left where the jaw then stands",
        told(*time, "s"),
        told(*before, "N"),
        told(*after, "N")
    )]
    Ruptured {
        /// When the force had fallen by half, s.
        time: f64,
        /// Largest force before, N.
        before: f64,
        /// Force where the jaw came to stand, N.
        after: f64,
    },
    /// A given hold that the record does not contain.
    #[error(
        "given hold {number} lasts from {from} s to {to} s, the record from {} s to {} s",
        significant(*begin, 6),
        significant(*last, 6)
    )]
    GivenOutside {
        /// Which, from 1.
        number: usize,
        /// Its start, s.
        from: f64,
        /// Its end, s.
        to: f64,
        /// First time of the record, s.
        begin: f64,
        /// Last time of the record, s.
        last: f64,
    },
    /// A given hold with hardly a sample.
    #[error("given hold {number}, from {from} s to {to} s, has {samples} samples, a hold needs {needed}")]
    GivenShort {
        /// Which, from 1.
        number: usize,
        /// Its start, s.
        from: f64,
        /// Its end, s.
        to: f64,
        /// Its samples.
        samples: usize,
        /// Fewest samples.
        needed: usize,
    },
    /// Two given holds that share samples.
    #[error("given holds {first} and {second} overlap")]
    GivenOverlap {
        /// One, from 1.
        first: usize,
        /// The other.
        second: usize,
    },
}

impl SegmentError {
    /// What would help.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::GivenOutside { .. } => {
                "times count as in the record, which need not begin at 0; `palpate inspect` shows them"
            }
            Self::GivenShort { .. } => "give an end that is later than the start by some samples",
            Self::GivenOverlap { .. } => "end the earlier hold before the later one begins",
            Self::TooShort { .. } => "check that the whole test was exported",
            Self::NoMotion { .. } => {
                "check the displacement column and its unit; a record without motion has no relaxation to fit"
            }
            Self::Ruptured { .. } => {
                "what stands after a rupture does not relax; if nothing broke, give the hold by hand ([[phases.hold]] in the test description)"
            }
            Self::NoHold {
                samples,
                minimum_samples,
                longest,
                minimum_hold,
            } if samples < minimum_samples && longest >= minimum_hold => {
                "the hold has too few samples: record faster, or set a shortest hold (--minimum-hold), for which 3 samples do"
            }
            Self::NoHold { longest: 0.0, .. } => {
                "a cyclic test has no hold; a tolerance (--tolerance) beyond the range of the test hides every ramp: lower it"
            }
            Self::NoHold { .. } => {
                "a cyclic test has no hold; for a short one lower the shortest hold (--minimum-hold), for a drifting one raise the tolerance (--tolerance)"
            }
        }
    }
}

/// What is missing for a hold: time or samples, or else that the column stands still.
fn no_hold((longest, samples): (f64, usize), (minimum, minimum_samples): (f64, usize)) -> String {
    let slowest = format!("{} ({samples} samples)", told(longest, "s"));
    if longest == 0.0 {
        "it moves all the time, or stands from the start".to_owned()
    } else if longest >= minimum && samples >= minimum_samples {
        format!("where it moves slowest, for {slowest}, it drifts or turns without a stop")
    } else {
        let needed = told(minimum, "s");
        format!(
            "the longest standstill after a ramp lasts {slowest}, a hold needs {needed} and {minimum_samples} samples"
        )
    }
}

/// A quantity for people: three digits, lengths in mm.
fn told(value: f64, unit: &str) -> String {
    let (value, unit) = if unit == "m" { (1e3 * value, "mm") } else { (value, unit) };
    format!("{} {unit}", significant(value, 3))
}

/// Fewest samples in which phases can be seen.
const NEEDED: usize = 8;

/// Finds the phases of a record: from its displacement and its force, or from its force alone where the displacement is missing.
///
/// Every hold says what is held in it ([`HoldMode`]). Where the machine holds the force, the hold lasts as long as the force
/// stays, however far the jaw creeps.
///
/// # Errors
/// [`SegmentError`] when nothing moves, or when no standstill after a ramp is long enough to be a hold.
pub fn find_phases(record: &Record, options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    if record.len() < NEEDED {
        return Err(SegmentError::TooShort {
            needed: NEEDED,
            found: record.len(),
        });
    }
    let mut segmentation = match record.displacement() {
        Some(displacement) => from_both::phases(record, displacement, options)?,
        None => from_force::phases(record.time(), record.force(), options)?,
    };
    place_fits(record, options, &mut segmentation.segments);
    Ok(segmentation)
}

/// Sets from where laws are fitted to each hold.
fn place_fits(record: &Record, options: &SegmentOptions, segments: &mut [Segment]) {
    // A hold of constant force is fitted from where the displacement peaks.
    let exchanged = record.displacement().and_then(|displacement| {
        let columns = (record.time().to_vec(), record.force().to_vec(), displacement.to_vec());
        Record::new(columns.0, Some(columns.1), columns.2).ok()
    });
    for index in 0..segments.len() {
        let answers = match (&exchanged, segments[index].mode) {
            (Some(exchanged), Some(HoldMode::ForceHeld)) => exchanged,
            _ => record,
        };
        segments[index].fit_start = options.hold_start.sample(answers, segments, index);
    }
}
