//! Why no phases were found.

use super::segmentation::Rupture;
use crate::number::significant;
use crate::watch::Cancelled;

/// Why no phases were found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SegmentError {
    /// The watch ended the work.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
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
        "there is no motion: the {column} stays within {}, its noise is {}",
        reported(*range, unit),
        reported(*noise, unit)
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
    #[error("no hold found: {}", no_hold(*rest, (*longest, *samples), (*minimum_hold, *minimum_samples)))]
    NoHold {
        /// How long the record stands still before anything moves, s; 0 if it begins with a motion.
        rest: f64,
        /// Longest stretch after a ramp in which it moves slowest, s; 0 if there is none.
        longest: f64,
        /// Its samples.
        samples: usize,
        /// Least duration of a hold, s.
        minimum_hold: f64,
        /// Least number of samples of a hold.
        minimum_samples: usize,
    },
    /// Of a force alone.
    #[error(
        "no hold found: the force, without a displacement, shows no stretch in which it relaxes or creeps to a level"
    )]
    NoHoldInForce,
    /// The file labels its phases, and none is a hold after a ramp.
    #[error("no hold found: the file labels its segments {}; none of them holds a body", names.join(", "))]
    NoneLabelled {
        /// The labels.
        names: Vec<String>,
    },
    /// The jaw stands still only after the body broke.
    #[error(
        "no hold found: at {} the body ruptured under {}, and {} remain where the jaw then stops",
        reported(.0.time, "s"),
        reported(.0.before, "N"),
        reported(.0.after, "N")
    )]
    Ruptured(Rupture),
    /// A given hold that the record does not contain.
    #[error(
        "given hold {number} is from {from} s to {to} s, the record from {} s to {} s",
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
    #[error("given hold {number}, from {from} s to {to} s, has {samples} samples; a hold needs {needed}")]
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
    /// What a search that nobody ended found, or why it found nothing.
    pub(crate) fn unless_cancelled<T>(found: Result<T, Self>) -> Result<Result<T, Self>, Cancelled> {
        match found {
            Err(Self::Cancelled(cancelled)) => Err(cancelled),
            found => Ok(found),
        }
    }

    /// A remedy; options stand between `⟨` and `⟩`, for each interface to spell.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Cancelled(_) => "",
            Self::GivenOutside { .. } => {
                "give times on the clock of the record, which need not begin at 0; `palpate inspect` shows them"
            }
            Self::GivenShort { .. } => "give an end several samples after the start",
            Self::GivenOverlap { .. } => "end the earlier hold before the later one starts",
            Self::NoneLabelled { .. } => {
                "the labels of a file take precedence; give the limits of a hold by hand ([[phases.hold]] in the test description) if there is one"
            }
            Self::TooShort { .. } => "check that the whole test was exported",
            Self::NoMotion { .. } => {
                "check the displacement column and its unit; if the record is one hold, give it by hand ([[phases.hold]] with from and to in the test description)"
            }
            Self::Ruptured(_) => {
                "data after the rupture are not fitted; if nothing broke, give the limits of the hold ([[phases.hold]] in the \
                 test description)"
            }
            Self::NoHold {
                samples,
                minimum_samples,
                longest,
                minimum_hold,
                ..
            } if samples < minimum_samples && longest >= minimum_hold => {
                "the hold has too few samples: sample faster, or set the shortest hold (⟨minimum_hold⟩), which then needs 3 samples"
            }
            Self::NoHoldInForce => {
                "ramps alone have no hold; if the file has a displacement, name its column; where the hold is known, give \
                 its limits by hand ([[phases.hold]] in the test description)"
            }
            Self::NoHold { rest, longest: 0.0, .. } if *rest > 0.0 => {
                "if the standstill before the ramp is the hold, give its limits by hand ([[phases.hold]] in the test description)"
            }
            Self::NoHold { longest: 0.0, .. } => {
                "a cyclic test has no hold; a tolerance (⟨tolerance⟩) above the range of the test hides every ramp: reduce it"
            }
            Self::NoHold { .. } => {
                "a cyclic test has no hold; for short holds reduce the shortest hold (⟨minimum_hold⟩), for drifting \
                 holds increase the tolerance (⟨tolerance⟩)"
            }
        }
    }
}

/// What is missing for a hold: time or samples, or else that the column stands still.
fn no_hold(rest: f64, (longest, samples): (f64, usize), (minimum, minimum_samples): (f64, usize)) -> String {
    let slowest = format!("{} ({samples} samples)", reported(longest, "s"));
    let is_slow_motion = longest >= minimum && samples >= minimum_samples;
    if rest > 0.0 && (longest == 0.0 || is_slow_motion) {
        format!("{} of standstill, then motion to the end", reported(rest, "s"))
    } else if longest == 0.0 {
        "the jaw moves from the first sample to the last".to_owned()
    } else if is_slow_motion {
        format!("at its slowest, for {slowest}, the jaw drifts or reverses without a stop")
    } else {
        let needed = reported(minimum, "s");
        format!(
            "the longest standstill after a ramp lasts {slowest}; a hold needs {needed} and {minimum_samples} samples"
        )
    }
}

/// A quantity for people: three digits, lengths in mm.
fn reported(value: f64, unit: &str) -> String {
    let (value, unit) = if unit == "m" { (1e3 * value, "mm") } else { (value, unit) };
    format!("{} {unit}", significant(value, 3))
}
