//! The formats, told by content and never by the name of the file.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::{Found, ReadOptions};
use crate::{
    afm::{jpk_force, jpk_text, tab},
    error::FileError,
    input::Input,
    text,
};

/// How a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Force curves of an atomic force microscope, as JPK's programs store them.
    JpkForce,
    /// A force curve as JPK's programs export it to text.
    JpkText,
    /// A force curve in the text format of afmformats.
    AfmTab,
    /// Delimited text.
    Text,
}

impl Format {
    /// The format of a file; what is no other is text, which says itself if it is not.
    pub(super) fn of(input: &Input) -> Self {
        if jpk_force::recognise(input) {
            return Self::JpkForce;
        }
        if jpk_text::recognise(input) {
            return Self::JpkText;
        }
        if tab::recognise(input) {
            return Self::AfmTab;
        }
        Self::Text
    }

    /// Looks into a file of this format.
    pub(super) fn look_into(self, input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
        match self {
            Self::JpkForce => jpk_force::look_into(input, options),
            Self::JpkText => jpk_text::look_into(input, options),
            Self::AfmTab => tab::look_into(input, options),
            Self::Text => text::look_into(input, options),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::JpkForce => "JPK force curves",
            Self::JpkText => "JPK text export",
            Self::AfmTab => "text of afmformats",
            Self::Text => "delimited text",
        })
    }
}
