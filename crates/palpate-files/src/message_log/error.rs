//! What can go wrong with a log that is written.

use std::io;

#[cfg(feature = "robot-log")]
use mcap::McapError;

/// Why a log cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The operating system refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// This build has no logs.
    #[cfg(not(feature = "robot-log"))]
    #[error("expected a build with robot logs, found one without the feature `robot-log`")]
    NotInThisBuild,
    /// A time that has no stamp.
    #[error(
        "expected times that ROS 2 can stamp, above 0 and below 2147483648 s, found {stamp_s} s (time {time_s} s of the series)"
    )]
    Time {
        /// The time in the series, s.
        time_s: f64,
        /// The stamp that it would have, s.
        stamp_s: f64,
    },
    /// Two samples with one stamp, or in reverse order.
    #[error("expected samples at least 1 ns apart, found {first_s} s and {second_s} s")]
    Together {
        /// Time of the first, s.
        first_s: f64,
        /// Time of the second, s.
        second_s: f64,
    },
    /// More than the format can express; what the writer of the container reports.
    #[error("expected messages that fit an MCAP file ({0})")]
    Container(String),
}

impl LogError {
    /// Remedy; empty where there is none.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Time { .. } | Self::Together { .. } => "write FILE.csv, which has times of any size",
            #[cfg(not(feature = "robot-log"))]
            Self::NotInThisBuild => "build palpate with the feature `robot-log`, which is enabled by default",
            Self::Io(_) | Self::Container(_) => "",
        }
    }
}

#[cfg(feature = "robot-log")]
impl From<McapError> for LogError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::Io(error),
            other => Self::Container(other.to_string()),
        }
    }
}
