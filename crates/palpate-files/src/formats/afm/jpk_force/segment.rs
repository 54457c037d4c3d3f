//! What the header of a segment says.

use super::{
    archive::{Archive, MOST_CHANNEL, Place},
    properties::{List, Properties},
    stored::{Stored, kind},
};
use crate::{
    error::FileError,
    formats::afm::{
        assemble::{BENDING, Channel, Draft, Load, set_series_clock},
        curve::Formula,
        metadata,
    },
    input::Input,
    table::Metadata,
};

/// Most channels of a segment.
const MOST_CHANNELS: usize = 256;

/// Most rows of a segment: those that a channel of the narrowest numbers may have.
const MOST_ROWS: usize = (MOST_CHANNEL / 2) as usize;

/// A segment and where its channels are stored.
pub(super) struct StoredSegment {
    pub(super) draft: Draft,
    pub(super) channels: Vec<StoredChannel>,
    /// Duration in s, where the header has it.
    pub(super) duration: Option<f64>,
    pub(super) metadata: Vec<Metadata>,
}

/// Where a channel is stored.
pub(super) struct StoredChannel {
    /// Its member of the archive; for rules, what messages call it.
    pub(super) member: String,
    pub(super) stored: Stored,
}

/// A header that is being understood.
pub(super) struct Header<'a> {
    input: &'a Input,
    /// Its member of the archive.
    member: String,
    pub(super) properties: &'a Properties<'a>,
}

/// Reads the header of segment `number` of the curve at `place`.
pub(super) fn read(
    input: &Input,
    archive: &mut Archive,
    shared: &List,
    place: &Place,
    number: usize,
) -> Result<StoredSegment, FileError> {
    let folder = format!("{}segments/{number}/", place.folder);
    let member = format!("{folder}segment-header.properties");
    let properties = Properties::of(archive.list(&member)?, shared);
    let header = Header {
        input,
        member,
        properties: &properties,
    };
    let mut names: Vec<&str> = properties
        .value("channels.list")
        .unwrap_or_default()
        .split_whitespace()
        .take(MOST_CHANNELS + 1)
        .collect();
    if names.len() > MOST_CHANNELS {
        let found = "more".to_owned();
        return Err(header.bad("channels.list", &format!("at most {MOST_CHANNELS} channels"), found));
    }
    let rows = header.rows(&names)?;
    if rows == 0 {
        names.clear();
    }
    let channels = names.iter().map(|name| header.channel(archive, &folder, name)).collect::<Result<_, _>>()?;
    let text = |key: &str| properties.value(&format!("force-segment-header.{key}"));
    let style = text("settings.style").or_else(|| text("settings.segment-settings.style"));
    let draft = Draft {
        number,
        style: style.or_else(|| text("name.name")).unwrap_or("segment").to_owned(),
        rows,
        channels: names.iter().enumerate().map(|named| header.shown(named)).collect::<Result<_, _>>()?,
        load: header.load(&names)?,
        clock: None,
        first: None,
    };
    Ok(StoredSegment {
        channels,
        duration: header.duration()?,
        metadata: header.about(number),
        draft,
    })
}

impl Header<'_> {
    pub(super) fn bad(&self, key: &str, expected: &str, found: String) -> FileError {
        self.input.damaged(format!("{}, {key}", self.member), expected, found)
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, FileError> {
        match self.properties.value(key).map(|text| (text, text.parse::<f64>())) {
            None => Ok(None),
            Some((_, Ok(value))) if value.is_finite() => Ok(Some(value)),
            Some((text, _)) => Err(self.bad(key, "a finite number", text.to_owned())),
        }
    }

    /// The first of several numbers that is there.
    fn first_number(&self, keys: &[String]) -> Result<Option<f64>, FileError> {
        keys.iter().find_map(|key| self.number(key).transpose()).transpose()
    }

    fn count(&self, key: &str) -> Result<Option<usize>, FileError> {
        match self.properties.value(key).map(|text| (text, text.parse::<usize>())) {
            None => Ok(None),
            Some((_, Ok(count))) if count <= MOST_ROWS => Ok(Some(count)),
            Some((text, _)) => Err(self.bad(key, &format!("a number of points up to {MOST_ROWS}"), text.to_owned())),
        }
    }

    /// The number of rows, which the header and all channels agree on.
    fn rows(&self, names: &[&str]) -> Result<usize, FileError> {
        let mut rows = self.count("force-segment-header.num-points")?;
        for name in names {
            let key = format!("channel.{name}.data.num-points");
            match (rows, self.count(&key)?) {
                (Some(rows), Some(own)) if own != rows => {
                    return Err(self.bad(&key, &format!("{rows} points, as in the segment"), own.to_string()));
                }
                (None, own) => rows = own,
                _ => {}
            }
        }
        rows.ok_or_else(|| self.bad("force-segment-header.num-points", "a number of points", "nothing".to_owned()))
    }

    fn duration(&self) -> Result<Option<f64>, FileError> {
        let keys = ["duration", "settings.segment-settings.duration"];
        let duration = self.first_number(&keys.map(|key| format!("force-segment-header.{key}")))?;
        Ok(duration.filter(|duration| *duration > 0.0))
    }

    /// How a channel is stored.
    fn channel(&self, archive: &Archive, folder: &str, name: &str) -> Result<StoredChannel, FileError> {
        let keys = |end: &str| [format!("channel.{name}.data.{end}"), format!("channel.{name}.{end}")];
        let text = |end: &str| self.properties.first(&keys(end));
        let number = |end: &str| {
            let found = self.first_number(&keys(end))?;
            found.ok_or_else(|| self.bad(&keys(end)[0], "a number", "nothing".to_owned()))
        };
        let data = text("type").unwrap_or("nothing");
        let stored = match data {
            "constant-data" | "constant" => Stored::Rule(number("value")?, 0.0),
            "raster-data" | "raster" => Stored::Rule(number("start")?, number("step")?),
            _ => {
                let encoder = text("encoder.type");
                let known = kind(data, encoder).ok_or_else(|| {
                    let found = format!("{data}, encoder {}", encoder.unwrap_or("none"));
                    self.bad(&format!("channel.{name}.type"), "short, integer, long, float or double data", found)
                })?;
                Stored::Numbers(known)
            }
        };
        let file = text("file.name").map_or_else(|| format!("channels/{name}.dat"), str::to_owned);
        let member = format!("{folder}{file}");
        if matches!(stored, Stored::Numbers(_)) && !archive.has(&member) {
            return Err(self.bad(&format!("channel.{name}"), &format!("a member {member}"), "none".to_owned()));
        }
        Ok(StoredChannel { member, stored })
    }

    /// A channel in the unit that the file shows it in; heights in m if they are calibrated at all.
    fn shown(&self, (index, name): (usize, &&str)) -> Result<Channel, FileError> {
        let usual = self.usual(name, index)?;
        let in_metres = |channel: &Channel| channel.unit.as_deref() == Some("m");
        if in_metres(&usual) || !name.to_lowercase().contains("height") {
            return Ok(usual);
        }
        for better in ["calibrated", "nominal", "absolute"] {
            if let Some(channel) = self.slot(name, index, better)?.filter(in_metres) {
                return Ok(channel);
            }
        }
        Ok(usual)
    }

    /// Force and deflection, as far as the channel of bending is calibrated.
    fn load(&self, names: &[&str]) -> Result<Load, FileError> {
        let Some(index) = names.iter().position(|name| *name == BENDING) else {
            return Ok(Load::default());
        };
        let slot = |name: &str, unit: &str| {
            let channel = self.slot(BENDING, index, name)?;
            Ok::<_, FileError>(channel.filter(|channel| channel.unit.as_deref() == Some(unit)).map(|found| found.line))
        };
        let raw = self.usual(BENDING, index)?;
        Ok(Load {
            force: slot("force", "N")?,
            deflection: slot("distance", "m")?,
            raw: Some(raw.line),
            raw_unit: raw.unit,
        })
    }

    /// Calibration and kind of the segment, for people.
    fn about(&self, number: usize) -> Vec<Metadata> {
        let conversion = |slot: &str| {
            let key = format!("channel.{BENDING}.conversion-set.conversion.{slot}.scaling.multiplier");
            self.properties.value(&key)
        };
        let setting =
            |key: &str| self.properties.value(&format!("force-segment-header.settings.segment-settings.{key}"));
        let mut all = Vec::new();
        let mut add = |name: &str, value: Option<&str>| all.extend(value.map(|value| metadata(name, value)));
        if number == 0 {
            add("spring constant", conversion("force"));
            add("sensitivity", conversion("distance"));
            add("time-stamp", self.properties.value("force-segment-header.time-stamp"));
            add("approach-id", self.properties.value("force-segment-header.approach-id"));
        }
        add(&format!("segment {number}"), setting("type"));
        add(&format!("segment {number} setpoint"), setting("setpoint").filter(|value| *value != "NaN"));
        all
    }
}

/// Puts the segments one behind the other by their durations, and says how.
pub(super) fn set_clocks(segments: &mut [StoredSegment]) -> &'static str {
    if set_series_clock(segments.iter_mut().map(|segment| &mut segment.draft)) {
        return "seriesTime of the file";
    }
    let mut start = 0.0;
    for segment in segments {
        match segment.duration {
            Some(duration) => {
                let step = duration / segment.draft.rows.max(1) as f64;
                segment.draft.clock = Some(Formula::Even { start, step });
                start += duration;
            }
            None if segment.draft.rows == 0 => {}
            None => return "none: a segment lacks its duration",
        }
    }
    "computed from the durations and numbers of points of consecutive segments"
}
