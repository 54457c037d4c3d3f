//! The formats, told by content and never by the name of the file.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::{Found, ReadOptions};
use crate::{error::FileError, input::Input, robot_log, text};

/// How a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Delimited text.
    Text,
    /// A log of a robot: MCAP, as ROS 2 writes it.
    RobotLog,
}

impl Format {
    /// The format of a file; what is no other is text, which says itself if it is not.
    pub(super) fn of(input: &Input) -> Self {
        if robot_log::recognise(input.beginning()) {
            return Self::RobotLog;
        }
        Self::Text
    }

    /// Looks into a file of this format.
    pub(super) fn look_into(self, input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
        match self {
            Self::Text => text::look_into(input, options),
            Self::RobotLog => robot_log::look_into(input, options),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Text => "delimited text",
            Self::RobotLog => "robot log (MCAP)",
        })
    }
}
