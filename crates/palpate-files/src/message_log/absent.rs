//! A build without robot logs: none is ever opened, so that nothing can be done with one.

use std::{convert::Infallible, io::Write, marker::PhantomData};

use super::{
    error::LogError,
    message::{Message, MessageType},
    stamp::Stamp,
};

/// Not in this build.
pub struct LogWriter<W: Write>(Infallible, PhantomData<W>);

#[expect(missing_docs, clippy::missing_errors_doc, reason = "as where the feature is there")]
impl<W: Write> LogWriter<W> {
    pub fn new(_: W, _: &[(&str, &str)]) -> Result<Self, LogError> {
        Err(LogError::NotInThisBuild)
    }

    pub fn declare(&mut self, _: &str, _: MessageType) -> Result<(), LogError> {
        match self.0 {}
    }

    pub fn write(&mut self, _: &str, _: Stamp, _: &Message<'_>) -> Result<(), LogError> {
        match self.0 {}
    }

    pub fn finish(self) -> Result<W, LogError> {
        match self.0 {}
    }
}
