//! The members of the archive, within limits.

use std::{
    collections::{BTreeMap, BTreeSet},
    io::Read,
    str::FromStr,
};

use zip::{ZipArchive, result::ZipError};

use super::properties::{self, List};
use crate::{
    error::FileError,
    input::{Input, Seekable},
};

/// Most bytes of a list of properties, unpacked.
const MOST_PROPERTIES: u64 = 4 << 20;

/// Most bytes of one channel of one segment, unpacked.
pub(super) const MOST_CHANNEL: u64 = 64 << 20;

/// Most members of an archive: a map of a quarter of a million curves.
const MOST_MEMBERS: usize = 1 << 22;

/// Most segments of a curve.
const MOST_SEGMENTS: usize = 4096;

/// The name by which the archive of a curve, or of a map of curves, is known.
pub(super) const HEADER: &str = "header.properties";

/// An archive whose members are known by name.
pub(super) struct Archive {
    input: Input,
    zip: ZipArchive<Box<dyn Seekable>>,
    members: BTreeMap<String, usize>,
}

/// A curve of an archive.
pub(super) struct Place {
    /// What its members begin with: nothing, or `index/7/`.
    pub(super) folder: String,
    /// Its segments are numbered from 0 to one less than this.
    pub(super) segments: usize,
}

impl Archive {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let broken = |error: &ZipError| input.damaged("zip archive", "a whole archive", error.to_string());
        let zip = ZipArchive::new(input.seekable()?).map_err(|error| broken(&error))?;
        if zip.len() > MOST_MEMBERS {
            return Err(input.damaged("zip archive", format!("at most {MOST_MEMBERS} members"), zip.len().to_string()));
        }
        let member = |index| Some((zip.name_for_index(index)?.ok()?.into_owned(), index));
        let members = (0..zip.len()).filter_map(member).collect();
        Ok(Self {
            input: input.clone(),
            zip,
            members,
        })
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.members.contains_key(name)
    }

    /// The first bytes of a member, no more than `most` of them.
    pub(super) fn beginning(&mut self, name: &str, most: u64) -> Result<Vec<u8>, FileError> {
        let input = &self.input;
        let Some(&index) = self.members.get(name) else {
            return Err(input.damaged(name, "a member of the archive", "none of that name"));
        };
        let broken = |error: String| input.damaged(name, "a member that can be unpacked", error);
        let member = self.zip.by_index(index).map_err(|error| broken(error.to_string()))?;
        let mut bytes = Vec::new();
        member.take(most).read_to_end(&mut bytes).map_err(|error| broken(error.to_string()))?;
        Ok(bytes)
    }

    /// A member that is a list of properties.
    pub(super) fn list(&mut self, name: &str) -> Result<List, FileError> {
        let bytes = self.beginning(name, MOST_PROPERTIES + 1)?;
        if bytes.len() as u64 > MOST_PROPERTIES {
            return Err(self.input.too_large("a list of properties", MOST_PROPERTIES));
        }
        Ok(properties::read(&bytes))
    }

    /// The curves, in the order of their numbers.
    pub(super) fn curves(&self) -> Result<Vec<Place>, FileError> {
        let mut found: BTreeMap<Option<u64>, BTreeSet<usize>> = BTreeMap::new();
        for name in self.members.keys() {
            if let Some((index, segment)) = numbered(name) {
                found.entry(index).or_default().insert(segment);
            }
        }
        found.into_iter().map(|(index, segments)| self.place(index, &segments)).collect()
    }

    fn place(&self, index: Option<u64>, segments: &BTreeSet<usize>) -> Result<Place, FileError> {
        let folder = index.map_or_else(String::new, |index| format!("index/{index}/"));
        let place = || format!("{folder}segments");
        if segments.len() > MOST_SEGMENTS {
            let found = segments.len().to_string();
            return Err(self.input.damaged(place(), format!("at most {MOST_SEGMENTS} segments"), found));
        }
        if let Some(gap) = segments.iter().enumerate().find_map(|(at, number)| (at != *number).then_some(at)) {
            let found = format!("no segment {gap} but later ones");
            return Err(self.input.damaged(place(), "segments numbered from 0 without a gap", found));
        }
        Ok(Place {
            folder,
            segments: segments.len(),
        })
    }
}

/// The numbers of curve and segment that the header of a segment has in its name.
fn numbered(name: &str) -> Option<(Option<u64>, usize)> {
    let inner = name.strip_suffix("/segment-header.properties")?;
    match inner.split('/').collect::<Vec<_>>()[..] {
        ["segments", segment] => Some((None, plain(segment)?)),
        ["index", index, "segments", segment] => Some((Some(plain(index)?), plain(segment)?)),
        _ => None,
    }
}

/// A number that is written in one way only.
fn plain<N: FromStr + ToString>(text: &str) -> Option<N> {
    text.parse().ok().filter(|number: &N| number.to_string() == text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_segments() {
        assert_eq!(numbered("segments/3/segment-header.properties"), Some((None, 3)));
        assert_eq!(numbered("index/12/segments/0/segment-header.properties"), Some((Some(12), 0)));
        for name in ["header.properties", "index/1/header.properties", "segments/03/segment-header.properties"] {
            assert_eq!(numbered(name), None, "{name}");
        }
    }
}
