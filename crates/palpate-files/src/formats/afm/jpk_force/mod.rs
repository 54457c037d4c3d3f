//! JPK's binary force curves (`.jpk-force`) and maps of them (`.jpk-force-map`, `.jpk-qi-data`).
//!
//! They are zip archives of lists of properties and of channels, one folder a segment: `segments/0/…`, in maps
//! `index/7/segments/0/…`. A channel is a row of big-endian numbers; the properties say how these become volts, metres
//! and newtons, often by reference to `shared-data/header.properties`.
//!
//! | file | what |
//! |---|---|
//! | `archive.rs` | the members, within limits; which curves there are |
//! | `properties.rs` | lists of properties, and what they share |
//! | `segment.rs` | what the header of a segment says |
//! | `stored.rs` | kinds of stored numbers |
//! | `scaling.rs` | from stored numbers to quantities |

mod archive;
mod properties;
mod scaling;
mod segment;
mod stored;

use std::sync::{Mutex, PoisonError};

use crate::{
    error::{FileError, FileProblem},
    faults::admits,
    formats::afm::{
        assemble::assemble,
        curve::{Curve, Segment},
        metadata,
    },
    input::{Input, MOST_IN_MEMORY, is_zip},
    table::{Columns, Found, Heard, Metadata, Part, ReadOptions, ReadPart, SkippedPart},
};
use archive::{Archive, HEADER, MOST_CHANNEL, Place};
use properties::List;
use segment::{StoredChannel, StoredSegment};
use stored::Stored;

/// The list that the segments refer to.
const SHARED: &str = "shared-data/header.properties";

/// Of a map of more curves than this the first values are not looked at.
const MOST_SAMPLED: usize = 256;

/// Whether a file is an archive of force curves.
pub(crate) fn recognise(input: &Input) -> bool {
    let beginning = &input.beginning;
    is_zip(beginning)
        && Archive::open(input)
            .is_ok_and(|archive| archive.has(HEADER) && !archive.curves().is_ok_and(|all| all.is_empty()))
}

/// An archive of force curves.
struct JpkForce {
    input: Input,
    /// Open from one curve to the next: its list of members is as long as the map.
    archive: Mutex<Archive>,
    shared: List,
    /// One a part.
    places: Vec<Place>,
}

/// Looks into an archive: into the headers of all segments, and the first value of each channel.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let mut archive = Archive::open(input)?;
    let shared = match archive.has(SHARED) {
        true => archive.list(SHARED)?,
        false => List::new(),
    };
    let curves = archive.curves()?;
    let several = curves.len() > 1;
    let sampled = curves.len() <= MOST_SAMPLED;
    let (mut parts, mut places, mut skipped): (Vec<Part>, Vec<Place>, Vec<SkippedPart>) = Default::default();
    for place in curves {
        let name = place.folder.trim_end_matches('/').to_owned();
        match curve(input, &mut archive, &shared, &place, sampled) {
            Ok((found, without)) => {
                for part in without {
                    let name = if several { format!("{name}, {}", part.name) } else { part.name };
                    skipped.push(SkippedPart::new(name, part.reason));
                }
                if let Some((curve, _)) = found {
                    parts.push(curve.part);
                    places.push(place);
                }
            }
            Err(error) if several => skipped.push(SkippedPart::new(name, error.without_path())),
            Err(error) => return Err(error),
        }
    }
    Ok(Found {
        parts,
        skipped,
        reader: Box::new(JpkForce {
            input: input.clone(),
            archive: Mutex::new(archive),
            shared,
            places,
        }),
    })
}

/// Where the channels of each segment are stored.
type Members = Vec<Vec<StoredChannel>>;

/// A curve, where its channels are stored, and what was left out of it.
type Understood = (Option<(Curve, Members)>, Vec<SkippedPart>);

/// Understands the headers of one curve.
fn curve(
    input: &Input,
    archive: &mut Archive,
    shared: &List,
    place: &Place,
    sampled: bool,
) -> Result<Understood, FileError> {
    let read = |number| segment::read(input, archive, shared, place, number);
    let mut segments = (0..place.segments).map(read).collect::<Result<Vec<_>, _>>()?;
    let clock = segment::set_clocks(&mut segments);
    if sampled {
        for segment in &mut segments {
            segment.draft.first = first_row(archive, segment)?;
        }
    }
    let mut about = Part {
        name: (!place.folder.is_empty()).then(|| place.folder.trim_end_matches('/').to_owned()),
        written: format!("JPK force curve, {} segments", place.segments),
        metadata: of_header(archive, place)?,
        ..Part::default()
    };
    about.metadata.extend(segments.iter().flat_map(|segment| segment.metadata.clone()));
    about.metadata.push(metadata("time", clock));
    let (members, drafts): (Members, Vec<_>) =
        segments.into_iter().map(|segment| (segment.channels, segment.draft)).unzip();
    let (curve, skipped) = assemble(drafts, about);
    Ok((curve.map(|curve| (curve, members)), skipped))
}

/// The entries of the header of a curve, of one in a map first its number there and where it was measured.
fn of_header(archive: &mut Archive, place: &Place) -> Result<Vec<Metadata>, FileError> {
    let member = format!("{}{HEADER}", place.folder);
    if !archive.has(&member) {
        return Ok(Vec::new());
    }
    let list = archive.list(&member)?;
    let number = place.folder.strip_prefix("index/").map(|number| metadata("index", number.trim_end_matches('/')));
    let at = |(name, end): (&str, &str)| {
        let (_, value) = list.iter().find(|(key, value)| key.ends_with(end) && !value.is_empty())?;
        Some(metadata(name, value))
    };
    let entry = |(key, value): (&String, &String)| metadata(key, value);
    let all = list.iter().filter(|(_, value)| !value.is_empty()).map(entry);
    Ok(number.into_iter().chain(POSITION.into_iter().filter_map(at)).chain(all).collect())
}

/// What the position of a curve in a map is called, and the ends of the keys that have it.
const POSITION: [(&str, &str); 3] = [
    ("position index", ".header.position-index"),
    ("position x", ".header.position.x"),
    ("position y", ".header.position.y"),
];

/// What the channels of a segment hold in the first row; `None` where one holds nothing.
fn first_row(archive: &mut Archive, segment: &StoredSegment) -> Result<Option<Vec<f64>>, FileError> {
    let mut row = Vec::new();
    for channel in &segment.channels {
        let width = channel.stored.width();
        let bytes = if width > 0 { archive.beginning(&channel.member, width as u64)? } else { Vec::new() };
        let Some(first) = channel.stored.number(&bytes, 0) else {
            return Ok(None);
        };
        row.push(first);
    }
    Ok(Some(row))
}

impl ReadPart for JpkForce {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let mut archive = self.archive.lock().unwrap_or_else(PoisonError::into_inner);
        let nothing = || self.input.damaged("segments", "the curve that was there before", "none");
        let place = self.places.get(part).ok_or_else(nothing)?;
        let (found, _) = curve(&self.input, &mut archive, &self.shared, place, false)?;
        let (curve, members) = found.ok_or_else(nothing)?;
        let mut read = Columns::of(columns.len());
        let total = self.input.size;
        for (done, segment) in curve.segments.iter().enumerate() {
            progress(total * done as u64 / curve.segments.len() as u64, total)?;
            self.read_segment(&mut archive, segment, &members[segment.number], columns, &mut read)?;
        }
        progress(total, total)?;
        read.finish();
        Ok(read)
    }
}

impl JpkForce {
    fn read_segment(
        &self,
        archive: &mut Archive,
        segment: &Segment,
        channels: &[StoredChannel],
        columns: &[usize],
        read: &mut Columns,
    ) -> Result<(), FileError> {
        let chosen = segment.choose(columns);
        let mut wanted = chosen.channels();
        let stored = |index: &usize| matches!(channels[*index].stored, Stored::Numbers(_));
        if !wanted.iter().any(stored) {
            // That there are as many rows as the header says is observed from the bytes of a channel only.
            let proof = (0..channels.len()).find(stored).ok_or_else(|| {
                self.input.damaged(format!("segment {}", segment.number), "a channel of numbers", "rules only")
            })?;
            wanted.push(proof);
        }
        let mut taken = Vec::new();
        let mut bytes = 0;
        for index in wanted {
            let taken_in = self.take(archive, &channels[index], segment.rows)?;
            bytes += taken_in.len() as u64;
            self.input.bounded(bytes, "the channels of a segment", MOST_IN_MEMORY)?;
            taken.push((index, taken_in));
        }
        let mut row = vec![0.0; columns.len()];
        let mut numbers = vec![0.0; channels.len()];
        for index in 0..segment.rows {
            for (channel, bytes) in &taken {
                numbers[*channel] = channels[*channel].stored.number(bytes, index).unwrap_or(f64::NAN);
            }
            chosen.fill(index, &numbers, &mut row).map_err(|place| {
                let place = format!("segment {}, row {}, column {}", segment.number, index + 1, columns[place]);
                let hint = "export the curve again, or choose another column";
                let (expected, found) = ("a finite number", "none, or an infinite one");
                self.input.wrong(FileProblem::bad_cell(&place, expected, found, hint))
            })?;
            read.push_values(&row);
        }
        Ok(())
    }

    /// The bytes of a channel; of numbers there must be as many as rows.
    fn take(&self, archive: &mut Archive, channel: &StoredChannel, rows: usize) -> Result<Vec<u8>, FileError> {
        let width = channel.stored.width();
        if width == 0 {
            return Ok(Vec::new());
        }
        let most = (rows as u64).saturating_mul(width as u64);
        if !admits(most, MOST_CHANNEL) {
            return Err(self.input.too_large("a channel of a segment", MOST_CHANNEL));
        }
        let bytes = archive.beginning(&channel.member, most + 1)?;
        let found = match bytes.len() as u64 {
            length if length == most => return Ok(bytes),
            length if length > most => "more".to_owned(),
            length => format!("{length} bytes"),
        };
        let expected = format!("{most} bytes for {rows} numbers of {width} bytes");
        Err(self.input.damaged(channel.member.as_str(), expected, found))
    }
}
