//! Logs of messages as ROS 2 records them: MCAP files of the profile `ros2`, written.
//!
//! Messages are of well-known types, in CDR (little endian), and the log contains the definition of each type (`ros2msg`), so that
//! `rosbags`, `ros2 bag`, PlotJuggler and Foxglove read it without further files. Chunks of 1 MiB are not compressed. Nothing depends on the
//! clock of this machine: the same messages give the same bytes.
//!
//! Without the feature `robot-log` no log is ever opened.
//!
//! | file | what |
//! |---|---|
//! | `stamp.rs` | times of a record as stamps ([`LogClock`]) |
//! | `message.rs` | the messages ([`Message`]), and the definitions of their types |
//! | `cdr.rs` | a message as bytes |
//! | `write.rs` | messages to a file ([`LogWriter`]) |
//! | `absent.rs` | the same where the feature `robot-log` is missing |
//! | `error.rs` | what can go wrong ([`LogError`]) |
//!
//! ```
//! use palpate_files::message_log::{LogClock, LogWriter, Message};
//!
//! let clock = LogClock::beginning_at(0.0);
//! let mut log = LogWriter::new(Vec::<u8>::new(), &[("content", "an example")])?;
//! log.write("/force_n", clock.stamp(0.25)?, &Message::Float64(2.5))?;
//! let bytes = log.finish()?;
//! assert!(bytes.starts_with(b"\x89MCAP0\r\n") && bytes.ends_with(b"\x89MCAP0\r\n"));
//! # Ok::<(), palpate_files::message_log::LogError>(())
//! ```

#[cfg(not(feature = "robot-log"))]
mod absent;
#[cfg(feature = "robot-log")]
mod cdr;
mod error;
mod message;
mod stamp;
#[cfg(feature = "robot-log")]
mod write;

#[cfg(not(feature = "robot-log"))]
pub use absent::LogWriter;
pub use error::LogError;
pub use message::{Diagnostic, JointState, Level, Message, MessageType, Wrench};
pub use stamp::{LogClock, Stamp};
#[cfg(feature = "robot-log")]
pub use write::LogWriter;
