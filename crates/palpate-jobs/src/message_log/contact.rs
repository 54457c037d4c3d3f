//! The log of a contact, sample by sample.

use std::io::Write;

use palpate_files::message_log::{
    Diagnostic, JointState, Level, LogClock, LogError, LogWriter, Message, MessageType, Stamp, Wrench,
};
use palpate_files::naming::own_topics::{DIAGNOSTICS, FINGER, FRAME, JOINT_STATES, PREFIX, WRENCH};
use palpate_files::open::{Contents, Format};

/// When the time of the record in a part of a file is zero, ns since 1970; known of robot logs alone, whose stamps are whole nanoseconds.
///
/// A log that is written of such a record has the stamps of the original, so that both can be shown together.
#[must_use]
pub fn zero_ns(contents: &Contents, part: usize) -> Option<u64> {
    if contents.format != Format::RobotLog {
        return None;
    }
    let start = contents.parts.get(part)?.metadata.iter().find(|entry| entry.name == "start")?;
    let (seconds, rest) = start.value.split_once('.').filter(|(_, rest)| rest.len() == 9)?;
    seconds.parse::<u64>().ok()?.checked_mul(1_000_000_000)?.checked_add(rest.parse().ok()?)
}

/// What is read of a contact at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reading {
    /// When, s.
    pub(crate) time: f64,
    /// Displacement of the jaw, m.
    pub(crate) displacement: Option<f64>,
    /// Its velocity, m/s.
    pub(crate) velocity: Option<f64>,
    /// Contact force, N, positive in compression.
    pub(crate) force: f64,
}

/// A log that is being written; only [`finish`](Self::finish) completes it.
pub(crate) struct ContactLog<W: Write> {
    writer: LogWriter<W>,
    clock: LogClock,
    /// The last reading: its time and stamp.
    last: Option<(f64, Stamp)>,
}

impl<W: Write> ContactLog<W> {
    /// Begins the log of a series, whose first sample has the time `first` (s); `zero` is the date of its time 0 (ns since 1970), where that
    /// is known. `content` names what wrote it. The topic of a result is in the log once it has a message.
    ///
    /// # Errors
    /// [`LogError`] where the operating system takes no bytes.
    pub(crate) fn new(out: W, content: &str, (first, zero): (f64, Option<u64>)) -> Result<Self, LogError> {
        let clock = zero.map_or(LogClock::beginning_at(first), LogClock::since_1970);
        let zero = clock.zero_ns().to_string();
        let mut writer = LogWriter::new(out, &[("content", content), ("time_zero_ns", &zero)])?;
        writer.declare(JOINT_STATES, MessageType::JointState)?;
        writer.declare(WRENCH, MessageType::WrenchStamped)?;
        let last = None;
        Ok(Self { writer, clock, last })
    }

    /// Writes what is read at a sample, and returns its stamp for the results of it.
    ///
    /// # Errors
    /// [`LogError`] where the time has no stamp, or that of the sample before, or the operating system takes no bytes.
    pub(crate) fn reading(&mut self, reading: &Reading) -> Result<Stamp, LogError> {
        let stamp = self.clock.stamp(reading.time)?;
        if let Some((first_s, before)) = self.last
            && stamp <= before
        {
            let second_s = reading.time;
            return Err(LogError::Together { first_s, second_s });
        }
        self.last = Some((reading.time, stamp));
        let state = JointState {
            name: FINGER,
            position: reading.displacement,
            velocity: reading.velocity,
            effort: Some(reading.force),
        };
        self.writer.write(JOINT_STATES, stamp, &Message::JointState(state))?;
        let wrench = Wrench {
            frame: FRAME,
            force: [0.0, 0.0, reading.force],
        };
        self.writer.write(WRENCH, stamp, &Message::Wrench(wrench))?;
        Ok(stamp)
    }

    /// Writes a result; a number that is not known has no message.
    ///
    /// # Errors
    /// [`LogError`] where the operating system takes no bytes.
    pub(crate) fn number(&mut self, name: &str, stamp: Stamp, value: Option<f64>) -> Result<(), LogError> {
        let known = value.filter(|value| !value.is_nan());
        known.map_or(Ok(()), |value| self.writer.write(&topic(name), stamp, &Message::Float64(value)))
    }

    /// Writes a result that is a yes or a no.
    ///
    /// # Errors
    /// As for [`number`](Self::number).
    pub(crate) fn flag(&mut self, name: &str, stamp: Stamp, value: bool) -> Result<(), LogError> {
        self.writer.write(&topic(name), stamp, &Message::Bool(value))
    }

    /// Writes that something happened at a time (s), in words, with values beside them.
    ///
    /// # Errors
    /// [`LogError`] where the time has no stamp, or the operating system takes no bytes.
    pub(crate) fn event(
        &mut self,
        time: f64,
        level: Level,
        message: &str,
        values: &[(String, String)],
    ) -> Result<(), LogError> {
        let diagnostic = Diagnostic {
            level,
            name: "palpate: contact",
            message,
            values,
        };
        self.writer.write(DIAGNOSTICS, self.clock.stamp(time)?, &Message::Diagnostic(diagnostic))
    }

    /// Completes the log and returns what it was written to.
    ///
    /// # Errors
    /// [`LogError`] where the operating system takes no bytes.
    pub(crate) fn finish(self) -> Result<W, LogError> {
        self.writer.finish()
    }
}

/// The topic of a result.
fn topic(name: &str) -> String {
    format!("{PREFIX}{name}")
}
