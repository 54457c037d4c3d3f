//! A log as a file that holds one test: the fields of its topics as columns, each topic with clocks of its own.

use std::collections::{BTreeSet, HashMap};

use super::{
    container,
    record::Entry,
    survey::{Series, Survey},
    units,
};
use crate::{
    error::FileError,
    input::Input,
    table::{Clock, ColumnInfo, ColumnKind, Columns, Heard, Metadata, Part, ReadPart},
};

/// What a column of a log holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The time stamps in the headers of the messages.
    Stamps,
    /// When the messages were written down.
    LogTimes,
    /// A field, by its place in the series.
    Field(usize),
}

/// A log that was looked through.
pub(super) struct Log {
    input: Input,
    survey: Survey,
    /// For every column its series and what it holds.
    sources: Vec<(usize, Source)>,
}

impl Log {
    pub(super) fn of(input: &Input, survey: Survey) -> (Part, Self) {
        let mut part = Part {
            written: written(&survey),
            metadata: metadata(&survey),
            ..Part::default()
        };
        let mut sources = Vec::new();
        let mut of_topic: HashMap<&str, usize> = HashMap::new();
        for (index, series) in survey.series.iter().enumerate().filter(|(_, series)| !series.fields.is_empty()) {
            let nth = of_topic.entry(series.topic.as_str()).or_default();
            *nth += 1;
            let suffix = if *nth == 1 { String::new() } else { format!(" ({nth})") };
            let clocks = if series.stamped { &[Source::Stamps, Source::LogTimes][..] } else { &[Source::LogTimes] };
            part.clocks.push(Clock {
                column: part.columns.len() + 1,
                first: part.columns.len() + clocks.len() + 1,
                last: part.columns.len() + clocks.len() + series.fields.len(),
            });
            for (place, source) in clocks.iter().enumerate() {
                let what = if place == 0 { "time" } else { "log time" };
                let name = format!("{} {what}{suffix}", series.topic);
                part.columns.push(column(part.columns.len() + 1, name, Some("s"), Some(0.0)));
                sources.push((index, *source));
            }
            for (place, field) in series.fields.iter().enumerate() {
                let name = format!("{}.{}", series.topic, field.name);
                let unit = units::unit(&series.topic, &series.kind, &field.name);
                part.columns.push(column(part.columns.len() + 1, name, unit, field.sample));
                sources.push((index, Source::Field(place)));
            }
        }
        let log = Self {
            input: input.clone(),
            survey,
            sources,
        };
        (part, log)
    }
}

impl ReadPart for Log {
    fn read(&self, _part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let chosen: Vec<(usize, Source)> = columns.iter().map(|number| self.sources[number - 1]).collect();
        let mut wanted: Vec<Vec<Source>> = vec![Vec::new(); self.survey.series.len()];
        chosen.iter().for_each(|(series, source)| wanted[*series].push(*source));
        let mut read: Vec<Columns> = wanted.iter().map(|wanted| Columns::of(wanted.len())).collect();
        let mut row = Vec::new();
        let start = i128::from(self.survey.start.unwrap_or(0));
        let since_start = |time: i128| (time - start) as f64 / 1e9;
        container::walk(&self.input, progress, &mut |entry| {
            let Entry::Message {
                channel,
                log_time,
                data,
            } = entry
            else {
                return Ok(());
            };
            let Some(channel) = self.survey.channels.get(&channel) else {
                return Ok(());
            };
            if channel.known.values().all(|belongs| wanted[belongs.series].is_empty()) {
                return Ok(());
            }
            let expected = "the messages that were there when it was looked through";
            let changed = || self.input.damaged("the log", expected, "others");
            let fields = channel.decoder.read(data, false).map_err(|_| changed())?;
            let belongs = channel.known.get(&fields.signature).ok_or_else(changed)?;
            let wanted = &wanted[belongs.series];
            if wanted.is_empty() {
                return Ok(());
            }
            row.clear();
            row.extend(wanted.iter().map(|source| match source {
                Source::Stamps => since_start(fields.stamp.unwrap_or(start)),
                Source::LogTimes => since_start(i128::from(log_time)),
                Source::Field(place) => {
                    let own = belongs.places.iter().position(|other| other == place);
                    own.map_or(f64::NAN, |own| fields.values[own])
                }
            }));
            read[belongs.series].push_values(&row);
            Ok(())
        })?;
        let order: Vec<usize> = chosen.iter().map(|(series, _)| *series).collect();
        Ok(Columns::of_clocks(read, &order))
    }
}

fn column(number: usize, name: String, unit: Option<&str>, sample: Option<f64>) -> ColumnInfo {
    ColumnInfo {
        number,
        name: Some(name),
        unit: unit.map(str::to_owned),
        kind: if sample.is_some() { ColumnKind::Number } else { ColumnKind::Empty },
        sample: sample.map_or_else(String::new, |sample| sample.to_string()),
    }
}

/// How the log is written, in one line.
fn written(survey: &Survey) -> String {
    let profile = if survey.profile.is_empty() { String::new() } else { format!(" of {}", survey.profile) };
    let topics: BTreeSet<&str> = survey.series.iter().map(|series| series.topic.as_str()).collect();
    format!("MCAP{profile}, {} messages, {} topics with numbers", survey.messages, topics.len())
}

fn metadata(survey: &Survey) -> Vec<Metadata> {
    let start = survey.start.map(|start| Metadata {
        name: "start".to_owned(),
        value: format!("{}.{:09}", start / 1_000_000_000, start % 1_000_000_000),
        unit: Some("s since 1970".to_owned()),
    });
    let of_series = |series: &Series| {
        let clock = if series.stamped { "times of its headers" } else { "times of the log" };
        let kind = if series.kind.is_empty() { "JSON" } else { &series.kind };
        Metadata {
            name: series.topic.clone(),
            value: format!("{kind}, {} messages, {clock}", series.messages),
            unit: None,
        }
    };
    let series = survey.series.iter().filter(|series| !series.fields.is_empty()).map(of_series);
    start.into_iter().chain(series).collect()
}
