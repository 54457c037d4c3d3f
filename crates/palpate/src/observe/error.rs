//! Why an observer cannot be made, and why it refuses a tick.

/// Why an observer cannot be made, or a tick not be taken; a tick that is refused leaves the observer as it was.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObserveError {
    /// An option out of its range.
    #[error("{option} must be {expected}, found {found}")]
    Option {
        /// Which option.
        option: &'static str,
        /// Its range.
        expected: &'static str,
        /// What was given.
        found: f64,
    },
    /// A material whose law has no closed form of a hold here.
    #[error("the observer knows a hold of the latency law alone, the material obeys a linear law")]
    LinearMaterial,
    /// A reading that is NaN or infinite, or larger than any sensor shows.
    #[error("the {what} at {time} s must be a finite number, found {found}{}", beyond(*.found))]
    NotFinite {
        /// Which reading.
        what: &'static str,
        /// When, s; the last good tick where the time itself is at fault.
        time: f64,
        /// What was given.
        found: f64,
    },
    /// A clock that stands or goes back.
    #[error("time must rise from tick to tick, found {found} s after {last} s")]
    TimeNotRising {
        /// The last tick, s.
        last: f64,
        /// This one, s.
        found: f64,
    },
    /// A displacement that the body of the material cannot take.
    #[error("at {time} s the body of the material cannot take a displacement of {displacement} m")]
    Displacement {
        /// When, s.
        time: f64,
        /// What was given, m.
        displacement: f64,
    },
    /// Bytes that hold no observer, or one with other options.
    #[error("expected the bytes of an observer with these options, found others")]
    Bytes,
}

/// What a finite reading that counts as none has against it.
fn beyond(found: f64) -> &'static str {
    if found.is_finite() { ", which no sensor shows" } else { "" }
}

impl ObserveError {
    /// A remedy; empty where the message suffices.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::LinearMaterial => "calibrate with the latency law, or observe without a material",
            Self::NotFinite { .. } => "leave the tick out: the observer bridges a gap",
            Self::TimeNotRising { .. } => "after a clock was set, begin with a new observer",
            Self::Displacement { .. } => "count displacement from first touch, growing as the jaw closes, in m",
            Self::Bytes => "give the options that it had, and bytes of the same version",
            Self::Option { .. } => "",
        }
    }
}
