//! Messages to an MCAP file.

use std::collections::BTreeMap;
use std::io::{BufWriter, Write};

use mcap::{
    WriteOptions, Writer,
    records::{MessageHeader, Metadata},
    write::NoSeek,
};

use super::{
    cdr,
    error::LogError,
    message::{Message, MessageType},
    stamp::Stamp,
};

/// Bytes of messages in a chunk.
const CHUNK: u64 = 1 << 20;

/// Name of the metadata of a log.
const ABOUT: &str = "palpate";

/// The topics of a log with the messages of one type each.
struct Channel {
    topic: String,
    kind: MessageType,
    id: u16,
    /// Messages written.
    count: u32,
}

/// A log that is being written; only [`finish`](Self::finish) completes it.
pub struct LogWriter<W: Write> {
    container: Writer<NoSeek<BufWriter<W>>>,
    channels: Vec<Channel>,
    message: Vec<u8>,
}

impl<W: Write> LogWriter<W> {
    /// Begins a log with facts about it, by name.
    ///
    /// # Errors
    /// [`LogError`] where the operating system takes no bytes.
    pub fn new(out: W, about: &[(&str, &str)]) -> Result<Self, LogError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(concat!("palpate ", env!("CARGO_PKG_VERSION")))
            .compression(None)
            .chunk_size(Some(CHUNK))
            .disable_seeking(true);
        let mut container = options.create(NoSeek::new(BufWriter::new(out)))?;
        if !about.is_empty() {
            let facts = about.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
            container.write_metadata(&Metadata {
                name: ABOUT.to_owned(),
                metadata: facts.collect(),
            })?;
        }
        Ok(Self {
            container,
            channels: Vec::new(),
            message: Vec::new(),
        })
    }

    /// Declares a topic, so that it is in the log without a message too.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn declare(&mut self, topic: &str, kind: MessageType) -> Result<(), LogError> {
        self.channel(topic, kind).map(drop)
    }

    /// Writes a message; the first one of a topic and type declares it.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn write(&mut self, topic: &str, stamp: Stamp, message: &Message<'_>) -> Result<(), LogError> {
        cdr::encode(message, stamp, &mut self.message)?;
        let index = self.channel(topic, message.kind())?;
        let channel = &mut self.channels[index];
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: channel.count,
            log_time: stamp.nanoseconds(),
            publish_time: stamp.nanoseconds(),
        };
        channel.count = channel.count.wrapping_add(1);
        Ok(self.container.write_to_known_channel(&header, &self.message)?)
    }

    /// Completes the log and returns what it was written to.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn finish(mut self) -> Result<W, LogError> {
        self.container.finish()?;
        let buffered = self.container.into_inner().into_inner();
        Ok(buffered.into_inner().map_err(std::io::IntoInnerError::into_error)?)
    }

    /// The channel of a topic and type.
    fn channel(&mut self, topic: &str, kind: MessageType) -> Result<usize, LogError> {
        let known = self.channels.iter().position(|channel| channel.kind == kind && channel.topic == topic);
        if let Some(index) = known {
            return Ok(index);
        }
        let schema = self.container.add_schema(kind.name(), "ros2msg", kind.definition().as_bytes())?;
        // The profile requires the key; empty stands for the usual quality of service.
        let metadata = BTreeMap::from([("offered_qos_profiles".to_owned(), String::new())]);
        let id = self.container.add_channel(schema, topic, "cdr", &metadata)?;
        self.channels.push(Channel {
            topic: topic.to_owned(),
            kind,
            id,
            count: 0,
        });
        Ok(self.channels.len() - 1)
    }
}
