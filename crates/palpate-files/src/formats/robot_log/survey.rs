//! Looking through a log: its topics, their fields, and how many messages there are.
//!
//! The messages of one topic may differ in their fields: two drivers may write the joints of an arm and those of a
//! gripper to one topic. Messages with the same fields form a series; each series is a clock of its own.

use std::{
    collections::{BTreeSet, HashMap, HashSet},
    sync::Arc,
};

use super::{
    channel::{Decoder, Definition},
    container,
    fields::Fields,
    record::Entry,
    schema::Schema,
};
use crate::{error::FileError, faults::admits, input::Input, table::SkippedPart};

/// Most different sets of fields, and orders of them, that the messages of a topic may have.
const MOST_SERIES: usize = 16;

/// Most bytes of the names of all columns (16 MiB): a topic and a definition are written once, and their names stand in every column.
const MOST_OF_NAMES: usize = 16 << 20;
/// What a column takes beside its name, in these bytes.
const A_COLUMN: usize = 32;

/// A field of a series.
#[derive(Debug, Clone)]
pub(super) struct FieldObserved {
    /// Its name in the message.
    pub(super) name: String,
    /// Its first value that is a finite number.
    pub(super) sample: Option<f64>,
}

/// Messages of one topic with the same fields.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) topic: String,
    /// Type of the messages.
    pub(super) kind: String,
    pub(super) fields: Vec<FieldObserved>,
    pub(super) messages: u64,
    /// Every message has a time stamp of its own.
    pub(super) stamped: bool,
}

/// The series a message belongs to, and for each of its numbers the place among the fields of the series.
#[derive(Debug, Clone)]
pub(super) struct Belongs {
    pub(super) series: usize,
    pub(super) places: Vec<usize>,
}

/// A channel that can be read.
#[derive(Debug, Clone)]
pub(super) struct Channel {
    topic: String,
    kind: String,
    pub(super) decoder: Decoder,
    pub(super) known: HashMap<Vec<u8>, Belongs>,
}

/// What is in a log.
#[derive(Debug, Clone, Default)]
pub(super) struct Survey {
    pub(super) profile: String,
    /// When the first message was written down, ns.
    pub(super) start: Option<u64>,
    pub(super) messages: u64,
    pub(super) series: Vec<Series>,
    pub(super) channels: HashMap<u16, Channel>,
    pub(super) skipped: Vec<SkippedPart>,
}

/// Looks through all of a log.
pub(super) fn survey(input: &Input) -> Result<Survey, FileError> {
    let mut surveyor = Surveyor {
        input,
        survey: Survey::default(),
        definitions: HashMap::new(),
        schemas: HashMap::new(),
        known: Known::default(),
        refused: HashMap::new(),
    };
    container::walk(input, &mut |_, _| Ok(()), &mut |entry| surveyor.entry(entry))?;
    Ok(surveyor.finish())
}

/// What is known of the series of all topics.
#[derive(Default)]
struct Known {
    /// The series of every topic.
    of_topic: HashMap<String, Vec<usize>>,
    /// Bytes of the names of all columns.
    names: usize,
}

struct Surveyor<'a> {
    input: &'a Input,
    survey: Survey,
    definitions: HashMap<u16, Definition>,
    /// The layouts of the definitions, each read once for all channels that have it.
    schemas: HashMap<u16, Result<Arc<Schema>, String>>,
    known: Known,
    /// Topics of channels that cannot be read.
    refused: HashMap<u16, String>,
}

impl Surveyor<'_> {
    fn entry(&mut self, entry: Entry<'_>) -> Result<(), FileError> {
        match entry {
            Entry::Header { profile } => profile.clone_into(&mut self.survey.profile),
            Entry::Schema(id, definition) => {
                let known = self.definitions.entry(id).or_insert_with(|| definition.clone());
                if *known != definition {
                    return Err(self.input.damaged(format!("schema {id}"), "one definition", "two that differ"));
                }
            }
            Entry::Channel {
                id,
                schema,
                topic,
                encoding,
            } => self.channel(id, schema, topic, encoding)?,
            Entry::Message {
                channel,
                log_time,
                data,
            } => self.message(channel, log_time, data)?,
        }
        Ok(())
    }

    fn channel(&mut self, id: u16, schema: u16, topic: &str, encoding: &str) -> Result<(), FileError> {
        let before = self.survey.channels.get(&id).map(|channel| &channel.topic).or_else(|| self.refused.get(&id));
        if let Some(before) = before {
            if before == topic {
                return Ok(());
            }
            let (expected, found) = (format!("topic {before}"), format!("topic {topic}"));
            return Err(self.input.damaged(format!("channel {id}"), expected, found));
        }
        let definition = self.definitions.get(&schema);
        if schema != 0 && definition.is_none() {
            return Err(self.input.damaged(format!("channel {topic}"), format!("schema {schema} before it"), "none"));
        }
        let layout = |definition: &Definition| {
            let known = self.schemas.entry(schema);
            known.or_insert_with(|| definition.layout().map(Arc::new)).clone()
        };
        match Decoder::of(encoding, definition, layout) {
            Ok(decoder) => {
                let channel = Channel {
                    topic: topic.to_owned(),
                    kind: definition.map(|definition| definition.name.clone()).unwrap_or_default(),
                    decoder,
                    known: HashMap::new(),
                };
                self.survey.channels.insert(id, channel);
            }
            Err(reason) => self.refuse(id, topic.to_owned(), reason),
        }
        Ok(())
    }

    fn refuse(&mut self, id: u16, topic: String, reason: String) {
        self.survey.skipped.push(SkippedPart::new(&topic, reason));
        self.refused.insert(id, topic);
    }

    fn message(&mut self, id: u16, log_time: u64, data: &[u8]) -> Result<(), FileError> {
        let survey = &mut self.survey;
        survey.messages += 1;
        survey.start = Some(survey.start.map_or(log_time, |start| start.min(log_time)));
        let Some(channel) = survey.channels.get_mut(&id) else {
            if self.refused.contains_key(&id) {
                return Ok(());
            }
            let place = format!("message {}", survey.messages);
            return Err(self.input.damaged(place, format!("a channel {id} before it"), "none"));
        };
        let reason = match channel.belongs(&mut survey.series, &mut self.known, data) {
            Ok((fields, belongs)) => {
                survey.series[belongs.series].add(&fields, &belongs.places);
                return Ok(());
            }
            Err(Unfit::Message(fault)) => format!("message {} of the log{fault}", survey.messages),
            Err(Unfit::Topic(reason)) => reason,
        };
        if let Some(channel) = self.survey.channels.remove(&id) {
            self.refuse(id, channel.topic, reason);
        }
        Ok(())
    }

    /// Drops what cannot be read: series of topics that were refused, and those without fields.
    fn finish(self) -> Survey {
        let mut survey = self.survey;
        let refused: HashSet<&String> = self.refused.values().collect();
        for series in &mut survey.series {
            if refused.contains(&series.topic) {
                series.fields.clear();
                series.messages = 0;
            }
        }
        survey.channels.retain(|_, channel| !refused.contains(&channel.topic));
        let hold: HashSet<&String> =
            survey.series.iter().filter(|own| !own.fields.is_empty()).map(|own| &own.topic).collect();
        let topics = survey.channels.values().map(|channel| &channel.topic).filter(|topic| !hold.contains(topic));
        let bare: BTreeSet<String> = topics.cloned().collect();
        let skipped = |topic| SkippedPart::new(topic, "no message of it holds a number");
        survey.skipped.extend(bare.into_iter().map(skipped));
        survey
    }
}

/// Why a message cannot be read.
enum Unfit {
    /// A fault of it.
    Message(String),
    /// A limit that its topic goes beyond with it.
    Topic(String),
}

impl Channel {
    /// The numbers of a message and the series that it belongs to.
    fn belongs(&mut self, all: &mut Vec<Series>, known: &mut Known, data: &[u8]) -> Result<(Fields, &Belongs), Unfit> {
        let mut fields = self.decoder.read(data, false).map_err(Unfit::Message)?;
        if !self.known.contains_key(&fields.signature) {
            fields = self.decoder.read(data, true).map_err(Unfit::Message)?;
            let belongs = match self.known.len() {
                MOST_SERIES => None,
                _ => self.place(all, known, fields.names.as_deref().unwrap_or_default())?,
            };
            let many = || Unfit::Topic(format!("its messages have more than {MOST_SERIES} different sets of fields"));
            self.known.insert(fields.signature.clone(), belongs.ok_or_else(many)?);
        }
        let lost = || Unfit::Message(": expected a known set of fields, found another".to_owned());
        self.known.get(&fields.signature).map(|belongs| (fields, belongs)).ok_or_else(lost)
    }

    /// The series for a message whose fields were not observed in this order before: one with the same, or a new one; `None` where it would
    /// be one too many.
    fn place(&self, all: &mut Vec<Series>, known: &mut Known, names: &[String]) -> Result<Option<Belongs>, Unfit> {
        let places_in = |series: &Series| -> Option<Vec<usize>> {
            if series.kind != self.kind || series.fields.len() != names.len() {
                return None;
            }
            let places: HashMap<&str, usize> =
                series.fields.iter().enumerate().rev().map(|(place, field)| (field.name.as_str(), place)).collect();
            names.iter().map(|name| places.get(name.as_str()).copied()).collect()
        };
        let of_topic = known.of_topic.entry(self.topic.clone()).or_default();
        let found = of_topic.iter().find_map(|series| Some((*series, places_in(&all[*series])?)));
        if let Some((series, places)) = found {
            return Ok(Some(Belongs { series, places }));
        }
        if of_topic.len() == MOST_SERIES {
            return Ok(None);
        }
        known.names += names.iter().map(|name| A_COLUMN + self.topic.len() + name.len()).sum::<usize>();
        if !admits(known.names as u64, MOST_OF_NAMES as u64) {
            return Err(Unfit::Topic("the names of all columns exceed the limit of 16 MiB".to_owned()));
        }
        of_topic.push(all.len());
        let unseen = |name: &String| FieldObserved {
            name: name.clone(),
            sample: None,
        };
        all.push(Series {
            topic: self.topic.clone(),
            kind: self.kind.clone(),
            fields: names.iter().map(unseen).collect(),
            messages: 0,
            stamped: true,
        });
        Ok(Some(Belongs {
            series: all.len() - 1,
            places: (0..names.len()).collect(),
        }))
    }
}

impl Series {
    fn add(&mut self, fields: &Fields, places: &[usize]) {
        self.messages += 1;
        self.stamped &= fields.stamp.is_some();
        for (place, value) in places.iter().zip(&fields.values) {
            let field = &mut self.fields[*place];
            if field.sample.is_none() && value.is_finite() {
                field.sample = Some(*value);
            }
        }
    }
}
