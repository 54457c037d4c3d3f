//! The formats, told by content and never by the name of the file.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::{Found, ReadOptions};
use crate::{error::FileError, input::Input, text};

/// How a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Delimited text.
    Text,
}

impl Format {
    /// The format of a file; what is no other is text, which says itself if it is not.
    pub(super) fn of(_input: &Input) -> Self {
        Self::Text
    }

    /// Looks into a file of this format.
    pub(super) fn look_into(self, input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
        match self {
            Self::Text => text::look_into(input, options),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Text => "delimited text",
        })
    }
}
