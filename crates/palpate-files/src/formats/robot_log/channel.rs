//! The channels of a log: whose messages can be read, and how.

use std::sync::Arc;

use super::{cdr, fields::Fields, json, schema::Schema};

/// How the messages of a channel are read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Decoder {
    /// CDR of ROS 2, with the layout of its messages.
    Cdr(Arc<Schema>),
    /// JSON.
    Json,
}

/// The definition of a type of message, as it stands in the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) encoding: String,
    pub(super) text: Vec<u8>,
}

impl Definition {
    /// How messages are laid out by it, or in words what is wrong with it.
    pub(super) fn layout(&self) -> Result<Schema, String> {
        let text = std::str::from_utf8(&self.text).map_err(|_| "its definition is no text".to_owned())?;
        Schema::parse(&self.name, text)
    }
}

impl Decoder {
    /// A decoder for messages of this encoding and definition, or in words why there is none; `layout` gives that of the definition.
    pub(super) fn of(
        encoding: &str,
        definition: Option<&Definition>,
        layout: impl FnOnce(&Definition) -> Result<Arc<Schema>, String>,
    ) -> Result<Self, String> {
        match (encoding, definition) {
            ("json", _) => Ok(Self::Json),
            ("cdr", Some(definition)) if definition.encoding == "ros2msg" => layout(definition).map(Self::Cdr),
            ("cdr", Some(definition)) => Err(format!(
                "the definition of its messages is written as \"{}\"; \"ros2msg\" is read",
                definition.encoding
            )),
            ("cdr", None) => Err("its messages have no definition".to_owned()),
            (other, _) => Err(format!("its messages are encoded as \"{other}\"; \"cdr\" and \"json\" are read")),
        }
    }

    /// The numbers of a message, named or not. Those of JSON are always named.
    pub(super) fn read(&self, message: &[u8], named: bool) -> Result<Fields, String> {
        match self {
            Self::Cdr(schema) => cdr::read(schema, message, named),
            Self::Json => json::read(message),
        }
    }
}
