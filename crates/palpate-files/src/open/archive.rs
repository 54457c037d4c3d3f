//! A zip archive of several files, such as the curves of a map: each is opened as if it lay alone, and what is none is skipped.
//!
//! Nothing of a file is kept but what it says of its tests; to read one opens its file again.

use super::{Format, look_into as look_into_one};
use crate::{
    error::FileError,
    input::{Input, Member, Packing},
    table::{Columns, Found, Heard, Part, ReadOptions, ReadPart, SkippedPart, share},
};

pub(super) fn recognise(input: &Input) -> bool {
    matches!(input.packing, Packing::Archive(_))
}

/// An archive of several files.
struct Archive {
    input: Input,
    members: Vec<Member>,
    options: ReadOptions,
    /// Of each part its member, and its place among the parts of that.
    places: Vec<(usize, usize)>,
}

/// Looks into every file of an archive.
pub(super) fn look_into(input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
    let members = input.members()?;
    let (mut parts, mut skipped, mut places) = (Vec::new(), Vec::new(), Vec::new());
    for (index, member) in members.iter().enumerate() {
        let found = input.member(member).and_then(|file| look_into_one(&file, options));
        let (format, found) = match found {
            Ok(found) => found,
            Err(error) => {
                skipped.push(SkippedPart::new(&member.name, error.without_path()));
                continue;
            }
        };
        let several = found.parts.len() > 1;
        let inside = |name: Option<&str>| match name {
            Some(name) => format!("{}, {name}", member.name),
            None => member.name.clone(),
        };
        skipped.extend(found.skipped.into_iter().map(|part| SkippedPart::new(inside(Some(&part.name)), part.reason)));
        for (place, part) in found.parts.into_iter().enumerate() {
            places.push((index, place));
            parts.push(Part {
                name: Some(inside(part.name.as_deref().filter(|_| several))),
                written: written(format, &part),
                ..part
            });
        }
    }
    let reader = Box::new(Archive {
        input: input.clone(),
        members,
        options: options.clone(),
        places,
    });
    Ok(Found { parts, skipped, reader })
}

/// How a part is written, with the format of its file.
fn written(format: Format, part: &Part) -> String {
    match part.written.as_str() {
        "" => format.to_string(),
        written => written.to_owned(),
    }
}

impl ReadPart for Archive {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let gone = || self.input.damaged("zip archive", "the test that was there before", "none");
        let &(index, place) = self.places.get(part).ok_or_else(gone)?;
        let file = self.input.member(&self.members[index])?;
        let (_, found) = look_into_one(&file, &self.options)?;
        let is_there = |part: &Part| columns.iter().all(|column| (1..=part.columns.len()).contains(column));
        found.parts.get(place).filter(|part| is_there(part)).ok_or_else(gone)?;
        let size = self.input.size;
        found.reader.read(place, columns, &mut |done, total| progress(share(done, total, size), size))
    }
}
