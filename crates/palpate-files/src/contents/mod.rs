//! What is in a file: which format it has, which tests it holds, their columns; and reading these.
//!
//! Every format answers in the same terms. [`Contents::open`] looks into a file and says what it found: its
//! [`Format`], its tests ([`Part`]s) with their columns, and what was passed over and why. [`Contents::read`] then
//! reads chosen columns of one test as `f64`, as they are written; units and signs are matters of
//! [`record_file`](crate::record_file).
//!
//! | file | what |
//! |---|---|
//! | `format.rs` | the formats, told by content and never by the name of the file |
//! | `part.rs` | one test in a file: columns, named values, labels |
//! | `columns.rs` | columns of numbers as they were read |
//! | `averaging.rs` | very long columns in bounded memory |

mod averaging;
mod columns;
mod format;
mod part;

use std::{fmt, path::Path};

pub use averaging::MOST_ROWS;
pub use columns::{Columns, Footer, IgnoredLines};
pub use format::Format;
pub(crate) use part::topic_and_field;
pub use part::{Clock, ColumnInfo, ColumnKind, Label, Metadata, Part, SkippedPart};

use crate::{
    error::FileError,
    input::{Input, Packing},
    text::{Layout, LayoutOptions},
};

/// What a caller knows about a file better than its bytes do. Everything left out is found out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// How delimited text is written.
    pub layout: LayoutOptions,
    /// The one part wanted: its name, or its number from 1.
    pub part: Option<String>,
}

/// What a format can do once it has looked into a file.
pub(crate) trait ReadPart: fmt::Debug + Send + Sync {
    /// Reads the columns with these numbers (from 1, in any order, perhaps one twice) of the part with this index.
    ///
    /// Both the index and the numbers are those of [`Contents::parts`]. Columns of one clock have the same length.
    fn read(&self, part: usize, columns: &[usize], progress: &mut dyn FnMut(u64, u64)) -> Result<Columns, FileError>;

    /// How delimited text is written; `None` in other formats.
    fn layout(&self) -> Option<&Layout> {
        None
    }
}

/// A file that was looked into.
#[derive(Debug)]
pub struct Contents {
    input: Input,
    format: Format,
    parts: Vec<Part>,
    skipped: Vec<SkippedPart>,
    reader: Box<dyn ReadPart>,
}

impl Contents {
    /// Looks into the file at `path`.
    ///
    /// ```
    /// use palpate_files::contents::{Contents, Format, ReadOptions};
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
        Ok(Self {
            input,
            format,
            parts: found.parts,
            skipped: found.skipped,
            reader: found.reader,
        })
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
        &self.parts
    }

    /// How delimited text is written; `None` in other formats.
    #[must_use]
    pub fn layout(&self) -> Option<&Layout> {
        self.reader.layout()
    }

    /// What was passed over, in the order of the file.
    #[must_use]
    pub fn skipped(&self) -> &[SkippedPart] {
        &self.skipped
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
        let count = self.parts.get(part).map_or(0, |part| part.columns.len());
        let beyond = columns.iter().find(|column| !(1..=count).contains(*column));
        if let Some(&column) = beyond {
            return Err(FileError::NoSuchColumn {
                path: self.path().to_owned(),
                column,
                columns: count,
            });
        }
        let mut read = self.reader.read(part, columns, progress)?;
        read.bytes = self.bytes();
        Ok(read)
    }
}

/// What a format found in a file.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) parts: Vec<Part>,
    pub(crate) skipped: Vec<SkippedPart>,
    pub(crate) reader: Box<dyn ReadPart>,
}
