//! The formats, told by content and never by the name of the file.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::{Found, ReadOptions};
use crate::{
    afm::{jpk_force, jpk_text, tab},
    arrow_file::{self, Kind},
    error::FileError,
    input::Input,
    robot_log,
    spreadsheet::{self, Make},
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
    /// A workbook of Office Open XML (`.xlsx`).
    Xlsx,
    /// A workbook of Excel 97 to 2003 (`.xls`).
    Xls,
    /// Parquet.
    Parquet,
    /// Arrow IPC: a file (Feather version 2) or a stream.
    ArrowIpc,
    /// A log of a robot: MCAP, as ROS 2 writes it.
    RobotLog,
}

impl Format {
    /// The format of a file; what is no other is text, which says itself if it is not.
    pub(super) fn of(input: &Input) -> Self {
        if robot_log::recognise(input.beginning()) {
            return Self::RobotLog;
        }
        if jpk_force::recognise(input) {
            return Self::JpkForce;
        }
        match spreadsheet::recognise(input) {
            Some(Make::Xlsx) => return Self::Xlsx,
            Some(Make::Xls) => return Self::Xls,
            None => {}
        }
        match arrow_file::recognise(input) {
            Some(Kind::Parquet) => return Self::Parquet,
            Some(Kind::File | Kind::Stream) => return Self::ArrowIpc,
            None => {}
        }
        if jpk_text::recognise(input) {
            Self::JpkText
        } else if tab::recognise(input) {
            Self::AfmTab
        } else {
            Self::Text
        }
    }

    /// Looks into a file of this format.
    pub(super) fn look_into(self, input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
        match self {
            Self::JpkForce => jpk_force::look_into(input, options),
            Self::JpkText => jpk_text::look_into(input, options),
            Self::AfmTab => tab::look_into(input, options),
            Self::Text => text::look_into(input, options),
            Self::Xlsx => spreadsheet::look_into(input, Make::Xlsx, options),
            Self::Xls => spreadsheet::look_into(input, Make::Xls, options),
            Self::Parquet => arrow_file::look_into(input, Kind::Parquet, options),
            Self::ArrowIpc => {
                let kind = arrow_file::recognise(input).unwrap_or(Kind::Stream);
                arrow_file::look_into(input, kind, options)
            }
            Self::RobotLog => robot_log::look_into(input, options),
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
            Self::Xlsx => "Excel workbook (.xlsx)",
            Self::Parquet => "Parquet",
            Self::ArrowIpc => "Arrow IPC",
            Self::Xls => "Excel 97 workbook (.xls)",
            Self::RobotLog => "robot log (MCAP)",
        })
    }
}
