//! From a path or bytes to the format that it is, and to the tests in it.
//!
//! Every format answers in the same terms. [`Contents::open`] looks into a file and says what it found: its
//! [`Format`], its tests ([`Part`]s) with their columns, and what was passed over and why. [`Contents::read`] then
//! reads chosen columns of one test as `f64`, as they are written; units and signs are matters of
//! [`record`](super::record). A format is told by content and never by the name of the file.

use std::{fmt, path::Path};

use schemars::JsonSchema;
use serde::Serialize;

use crate::{
    error::FileError,
    formats::{
        afm::{jpk_force, jpk_text, tab},
        arrow::{self, Kind},
        robot_log,
        spreadsheet::{self, Make},
        text,
    },
    input::{Input, Packing},
    table::{Columns, Found, Layout, Part, ReadOptions, SkippedPart},
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
    fn of(input: &Input) -> Self {
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
        match arrow::recognise(input) {
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
    fn look_into(self, input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
        match self {
            Self::JpkForce => jpk_force::look_into(input, options),
            Self::JpkText => jpk_text::look_into(input, options),
            Self::AfmTab => tab::look_into(input, options),
            Self::Text => text::look_into(input, options),
            Self::Xlsx => spreadsheet::look_into(input, Make::Xlsx, options),
            Self::Xls => spreadsheet::look_into(input, Make::Xls, options),
            Self::Parquet => arrow::look_into(input, Kind::Parquet, options),
            Self::ArrowIpc => {
                let kind = arrow::recognise(input).unwrap_or(Kind::Stream);
                arrow::look_into(input, kind, options)
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

/// A file that was looked into.
#[derive(Debug)]
pub struct Contents {
    input: Input,
    format: Format,
    found: Found,
}

impl Contents {
    /// Looks into the file at `path`.
    ///
    /// ```
    /// use palpate_files::open::{Contents, Format};
    /// use palpate_files::table::ReadOptions;
    ///
    /// # let folder = tempfile::tempdir()?;
    /// # let path = folder.path().join("press.csv");
    /// std::fs::write(&path, "Time (s);Force (N)\n0,00;0,01\n0,10;0,52\n")?;
    /// let contents = Contents::open(&path, &ReadOptions::default())?;
    /// assert_eq!(contents.format(), Format::Text);
    /// assert_eq!(contents.parts()[0].columns[1].unit.as_deref(), Some("N"));
    /// let read = contents.read(0, &[2], &mut |_done, _total| {})?;
    /// assert_eq!(read.values, [vec![0.01, 0.52]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`FileError`] where the file cannot be read, has no format known here, is damaged, or holds no test.
    pub fn open(path: &Path, options: &ReadOptions) -> Result<Self, FileError> {
        Self::of(Input::open(path)?, options)
    }

    /// Looks into `input`.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    pub fn of(input: Input, options: &ReadOptions) -> Result<Self, FileError> {
        let format = Format::of(&input);
        let mut found = format.look_into(&input, options)?;
        found.parts.iter_mut().for_each(Part::make_plain);
        found.skipped.iter_mut().for_each(SkippedPart::make_plain);
        if found.parts.is_empty() {
            let parts = found.skipped.into_iter().map(|part| (part.name, part.reason)).collect();
            return Err(FileError::NoParts {
                path: input.name().to_owned(),
                parts,
            });
        }
        Ok(Self { input, format, found })
    }

    /// The file, or what messages call it.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.input.name()
    }

    /// Size of the file in bytes, packed as it is.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.input.size()
    }

    /// How the file is written.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// How the file is packed.
    #[must_use]
    pub fn packing(&self) -> &Packing {
        self.input.packing()
    }

    /// The tests in the file, in its order; at least one.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.found.parts
    }

    /// How delimited text is written; `None` in other formats.
    #[must_use]
    pub fn layout(&self) -> Option<&Layout> {
        self.found.reader.layout()
    }

    /// What was passed over, in the order of the file.
    #[must_use]
    pub fn skipped(&self) -> &[SkippedPart] {
        &self.found.skipped
    }

    /// Reads columns (numbers from 1, in any order) of the part with index `part`, as they are written.
    ///
    /// Where the part has several [clocks](Part::clocks), only columns of the same clock have the same length.
    /// `progress` is told the bytes done and the bytes there are.
    ///
    /// # Errors
    /// [`FileError`] where the part or a column does not exist, or a cell holds no finite number.
    pub fn read(
        &self,
        part: usize,
        columns: &[usize],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Columns, FileError> {
        let count = self.found.parts.get(part).map_or(0, |part| part.columns.len());
        let beyond = columns.iter().find(|column| !(1..=count).contains(*column));
        if let Some(&column) = beyond {
            return Err(FileError::NoSuchColumn {
                path: self.path().to_owned(),
                column,
                columns: count,
            });
        }
        let mut read = self.found.reader.read(part, columns, progress)?;
        read.bytes = self.bytes();
        Ok(read)
    }
}
