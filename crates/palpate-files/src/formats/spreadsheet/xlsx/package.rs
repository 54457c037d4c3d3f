//! The parts of the archive, and reading their XML.

use std::{
    cell::RefCell,
    collections::BTreeMap,
    io::{self, BufReader, Read},
};

use quick_xml::{Reader, events::Event};
use zip::ZipArchive;

use crate::{
    error::{FileError, shown},
    input::{Input, MOST_IN_MEMORY, Seekable},
};

/// Most bytes that a part which is kept in memory may unpack to (256 MiB): texts, styles, names of sheets.
pub(super) const MOST_KEPT: u64 = 256 << 20;
/// Most bytes that a sheet may unpack to: they are streamed.
pub(super) const MOST_OF_SHEET: u64 = MOST_IN_MEMORY;
/// Most bytes of XML between two tags, of a tag, and of a cell with all that is inside (16 MiB): such a piece is held in memory. Excel writes
/// at most 32,767 characters into a cell.
pub(super) const MOST_OF_CELL: u64 = 16 << 20;
/// Most members of an archive: each is looked for by its name.
const MOST_MEMBERS: usize = 1 << 16;

/// What goes beyond [`MOST_OF_CELL`].
pub(super) const WHAT_OF_CELL: &str = "a cell, a shared string or a tag of the workbook";

/// Bytes taken from an archive at once.
const PIECE: usize = 1 << 16;

/// A zip archive of parts that are known by their paths.
pub(super) struct Package {
    pub(super) input: Input,
    /// Names in the archive by their paths in lower case and with `/` between folders.
    names: BTreeMap<String, String>,
    /// Open for all parts: its list of members is as long as the workbook has sheets.
    archive: RefCell<ZipArchive<BufReader<Box<dyn Seekable>>>>,
}

/// A reader, and how many bytes it may give before it is granted more.
struct Piecewise<R> {
    inner: R,
    left: u64,
}

impl<R: Read> Read for Piecewise<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.left == 0 {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let got = self.inner.read(into)?;
        self.left = self.left.saturating_sub(got as u64);
        Ok(got)
    }
}

/// Whether the archive has a part of this path.
pub(crate) fn has_part(input: &Input, path: &str) -> bool {
    let archive = input.seekable().ok().and_then(|bytes| ZipArchive::new(bytes).ok());
    archive.is_some_and(|archive| archive.file_names().flatten().any(|name| same_path(&name) == path))
}

fn same_path(name: &str) -> String {
    name.replace('\\', "/").trim_start_matches('/').to_lowercase()
}

impl Package {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let stored = BufReader::with_capacity(PIECE, input.seekable()?);
        let archive = ZipArchive::new(stored).map_err(|error| broken(input, "zip archive", &error))?;
        if archive.len() > MOST_MEMBERS {
            let expected = format!("at most {MOST_MEMBERS} members");
            return Err(input.damaged("zip archive", expected, archive.len().to_string()));
        }
        let mut names = BTreeMap::new();
        for name in archive.file_names().flatten() {
            if let Some(twin) = names.insert(same_path(&name), name.into_owned()) {
                return Err(input.damaged("zip archive", "parts of different names", shown(&twin)));
            }
        }
        Ok(Self {
            input: input.clone(),
            names,
            archive: RefCell::new(archive),
        })
    }

    /// Paths of the parts that hold XML: first the texts that all sheets share, then what says which part is which.
    pub(super) fn parts(&self) -> Vec<&str> {
        let xml = |path: &&str| path.ends_with(".xml") || path.ends_with(".rels");
        let mut paths: Vec<&str> = self.names.keys().map(String::as_str).filter(xml).collect();
        paths.sort_by_key(|path| (!path.ends_with("sharedstrings.xml"), *path != "_rels/.rels"));
        paths
    }

    /// Goes through the XML of a part of at most `most` bytes. `step` is given what comes, with the bytes done.
    pub(super) fn read(
        &self,
        path: &str,
        most: u64,
        step: &mut dyn FnMut(&Event<'_>, u64) -> Result<(), FileError>,
    ) -> Result<(), FileError> {
        let name = self.names.get(path).map_or(path, String::as_str);
        let mut archive = self.archive.borrow_mut();
        let member = archive.by_name(name).map_err(|error| broken(&self.input, path, &error))?;
        let member = Piecewise {
            // One byte more tells whether there is more.
            inner: member.take(most + 1),
            left: 0,
        };
        let mut xml = Reader::from_reader(BufReader::with_capacity(PIECE, member));
        xml.config_mut().check_end_names = false;
        xml.config_mut().expand_empty_elements = true;
        let mut buffer = Vec::new();
        loop {
            buffer.clear();
            xml.get_mut().get_mut().left = MOST_OF_CELL;
            let event = xml.read_event_into(&mut buffer);
            let done = xml.buffer_position();
            let Piecewise { inner, left } = xml.get_ref().get_ref();
            if inner.limit() == 0 {
                return Err(self.input.too_large("a part of the workbook", most));
            }
            if *left == 0 && event.is_err() {
                return Err(self.input.too_large(WHAT_OF_CELL, MOST_OF_CELL));
            }
            let event = event.map_err(|error| self.damaged(path, "XML", &error.to_string()))?;
            step(&event, done)?;
            if matches!(event, Event::Eof) {
                return Ok(());
            }
        }
    }

    pub(super) fn damaged(&self, place: &str, expected: &str, found: &str) -> FileError {
        self.input.damaged(place, expected, shown(found))
    }
}

fn broken(input: &Input, place: &str, error: &zip::result::ZipError) -> FileError {
    input.damaged(place, "a part that can be unpacked", shown(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use super::*;

    #[test]
    fn a_part_that_unpacks_to_more_than_its_limit_is_refused_whatever_it_says() {
        let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for path in ["[Content_Types].xml", "a.xml"] {
            zip.start_file(path, zip::write::SimpleFileOptions::default()).expect("a member");
            zip.write_all(b"<a>").expect("bytes");
            zip.write_all(&b"<b>text</b>".repeat(100_000)).expect("bytes");
            zip.write_all(b"</a>").expect("bytes");
        }
        let bytes = zip.finish().expect("an archive").into_inner();
        assert!(bytes.len() < 20_000);
        let package = Package::open(&Input::from_bytes("book", bytes).expect("bytes")).expect("a package");
        let mut texts = 0;
        let mut count = |event: &Event<'_>, _| {
            texts += usize::from(matches!(event, Event::Text(_)));
            Ok(())
        };
        let most = package.read("a.xml", 1_100_000, &mut count);
        assert_eq!(
            most.map_err(|error| error.to_string()),
            Err("book: a part of the workbook exceeds the limit of 1 MiB".to_owned())
        );
        assert!((90_000..100_001).contains(&texts), "{texts}");
        assert!(package.read("a.xml", 1_100_007, &mut |_, _| Ok(())).is_ok());
    }
}
