//! From a path or bytes to the format that it is, and to the tests in it.
//!
//! Every format answers in the same terms. [`Contents::open`] looks into a file and says what it found: its
//! [`Format`], its tests ([`Part`]s) with their columns, and what was passed over and why. [`Contents::read`] then
//! reads chosen columns of one test as `f64`, as they are written; units and signs are matters of
//! [`record`](super::record). A format is recognised by content and never by the name of the file. The files of a zip archive
//! are opened one by one, and their tests are those of the archive (`archive.rs`).

mod archive;

use std::{fmt, path::Path};

use schemars::JsonSchema;
use serde::Serialize;

use crate::{
    error::{FileError, FileProblem},
    formats::{
        afm::{igor, jpk_force, jpk_text, tab},
        arrays::{hdf5, matlab},
        arrow::{self, Kind},
        robot_log,
        spreadsheet::{self, Make},
        text,
    },
    input::Input,
    table::{Columns, Found, Heard, Layout, Part, ReadOptions, ReadPart, SkippedPart},
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
    /// An Igor binary wave: a force curve of Asylum Research, or a table.
    Igor,
    /// A force curve, or several, in the HDF5 format of afmformats.
    AfmHdf5,
    /// HDF5.
    Hdf5,
    /// A MATLAB file of level 5.
    Matlab,
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
    /// A zip archive of several files, each of any other format.
    Archive,
}

/// A format, how a file of it is recognised, and what looks into one.
type Known = (Format, fn(&Input) -> bool, LookInto);
type LookInto = fn(&Input, &ReadOptions) -> Result<Found, FileError>;

/// The formats in the order in which they are tried. What is none of them is text, which says itself if it is not.
const KNOWN: &[Known] = &[
    (Format::Archive, archive::recognise, archive::look_into),
    (Format::RobotLog, robot_log::recognise, robot_log::look_into),
    (Format::JpkForce, jpk_force::recognise, jpk_force::look_into),
    (Format::Xlsx, |input| spreadsheet::recognise(input) == Some(Make::Xlsx), spreadsheet::look_into),
    (Format::Xls, |input| spreadsheet::recognise(input) == Some(Make::Xls), spreadsheet::look_into),
    (Format::Parquet, |input| arrow::recognise(input) == Some(Kind::Parquet), arrow::look_into),
    (Format::ArrowIpc, |input| arrow::recognise(input).is_some(), arrow::look_into),
    (Format::Matlab, matlab::recognise, matlab::look_into),
    #[cfg(feature = "hdf5")]
    (Format::AfmHdf5, crate::formats::afm::h5::recognise, crate::formats::afm::h5::look_into),
    (Format::Hdf5, hdf5::recognise, hdf5::look_into),
    (Format::JpkText, jpk_text::recognise, jpk_text::look_into),
    (Format::AfmTab, tab::recognise, tab::look_into),
    (Format::Igor, igor::recognise, igor::look_into),
];

/// The format of a file, and what it finds there.
fn look_into(input: &Input, options: &ReadOptions) -> Result<(Format, Found), FileError> {
    let known = KNOWN.iter().find(|(_, is_so, _)| is_so(input));
    let (format, look_into) = known.map_or((Format::Text, text::look_into as LookInto), |known| (known.0, known.2));
    Ok((format, look_into(input, options)?))
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::JpkForce => "JPK force curves",
            Self::JpkText => "JPK text export",
            Self::AfmTab => "text of afmformats",
            Self::AfmHdf5 => "HDF5 of afmformats",
            Self::Hdf5 => "HDF5",
            Self::Matlab => "MATLAB file (.mat)",
            Self::Igor => "Igor binary wave",
            Self::Text => "delimited text",
            Self::Xlsx => "Excel workbook (.xlsx)",
            Self::Parquet => "Parquet",
            Self::ArrowIpc => "Arrow IPC",
            Self::Xls => "Excel 97 workbook (.xls)",
            Self::RobotLog => "robot log (MCAP)",
            Self::Archive => "zip archive",
        })
    }
}

/// A file that was looked into.
#[derive(Debug)]
pub struct Contents {
    /// The file, or the bytes in its place.
    pub input: Input,
    /// How the file is written.
    pub format: Format,
    /// The tests in the file, in its order; at least one.
    pub parts: Vec<Part>,
    /// What was passed over, in the order of the file.
    pub skipped: Vec<SkippedPart>,
    reader: Box<dyn ReadPart>,
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
    /// assert_eq!(contents.format, Format::Text);
    /// assert_eq!(contents.parts[0].columns[1].unit.as_deref(), Some("N"));
    /// let read = contents.read(0, &[2], &mut |_done, _total| Ok(()))?;
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
        let (format, found) = look_into(&input, options)?;
        let Found {
            mut parts,
            mut skipped,
            reader,
        } = found;
        for part in &mut parts {
            part.make_plain();
            part.take_stated_units();
        }
        skipped.iter_mut().for_each(SkippedPart::make_plain);
        if parts.is_empty() {
            let parts = skipped.into_iter().map(|part| (part.name, part.reason)).collect();
            return Err(input.wrong(FileProblem::NoParts(parts)));
        }
        Ok(Self {
            input,
            format,
            parts,
            skipped,
            reader,
        })
    }

    /// How delimited text is written; `None` in other formats.
    #[must_use]
    pub fn layout(&self) -> Option<&Layout> {
        self.reader.layout()
    }

    /// Reads columns (numbers from 1, in any order) of the part with index `part`, as they are written.
    ///
    /// Where the part has several [clocks](Part::clocks), only columns of the same clock have the same length.
    /// `progress` is given the bytes done and the bytes there are, and ends the reading where it returns an error.
    ///
    /// # Errors
    /// [`FileError`] where the part or a column does not exist, or a cell holds no finite number.
    pub fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let count = self.parts.get(part).map_or(0, |part| part.columns.len());
        let beyond = columns.iter().find(|column| !(1..=count).contains(*column));
        if let Some(&column) = beyond {
            return Err(self.input.wrong(FileProblem::NoSuchColumn { column, columns: count }));
        }
        let mut read = self.reader.read(part, columns, progress)?;
        read.bytes = self.input.size;
        Ok(read)
    }
}
