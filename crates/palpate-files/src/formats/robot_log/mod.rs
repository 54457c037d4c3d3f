//! Logs of robots: MCAP files, as ROS 2 and Foxglove write them.
//!
//! The numbers in the messages of every topic become columns called `topic.field`; the elements of an array are named by
//! the names beside them (`/joint_states.position[finger_joint]`). Topics come at rates of their own, so that each brings
//! the column of its clock, `topic time`: the stamps in the headers of its messages where all have one, else the
//! times of the log; in seconds from the first message of the log.
//!
//! Messages in CDR with a definition in `ros2msg`, and in JSON, are read; other topics are listed as skipped, with why.
//!
//! Without the feature `robot-log` logs are recognised by their content and refused.
//!
//! | file | what |
//! |---|---|
//! | `container.rs` | the records of an MCAP file in order, chunks unpacked |
//! | `record.rs` | what a record says |
//! | `schema.rs` | how the messages of a topic are laid out |
//! | `channel.rs` | whose messages can be read, and how |
//! | `cdr.rs`, `json.rs`, `fields.rs` | the numbers in one message |
//! | `units.rs` | units that the definitions of common messages fix |
//! | `survey.rs` | looking through a log: topics, fields, counts |
//! | `part.rs` | a log as a file that holds one test |

#[cfg(feature = "robot-log")]
mod cdr;
#[cfg(feature = "robot-log")]
mod channel;
#[cfg(feature = "robot-log")]
mod container;
#[cfg(feature = "robot-log")]
mod fields;
#[cfg(feature = "robot-log")]
mod json;
#[cfg(feature = "robot-log")]
mod part;
#[cfg(feature = "robot-log")]
mod record;
#[cfg(feature = "robot-log")]
mod schema;
#[cfg(feature = "robot-log")]
mod survey;
#[cfg(feature = "robot-log")]
mod units;

use crate::{
    error::FileError,
    input::Input,
    table::{Found, ReadOptions},
};

/// Whether a file begins as a log does.
pub(crate) fn recognise(input: &Input) -> bool {
    input.beginning.starts_with(b"\x89MCAP")
}

/// Looks through a log.
#[cfg(feature = "robot-log")]
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let survey = survey::survey(input)?;
    let skipped = survey.skipped.clone();
    let (part, log) = part::Log::of(input, survey);
    Ok(Found {
        parts: if part.columns.is_empty() { Vec::new() } else { vec![part] },
        skipped,
        reader: Box::new(log),
    })
}

/// Says which build would read it.
#[cfg(not(feature = "robot-log"))]
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    Err(input.not_in_this_build(
        "a build that reads logs of robots",
        "build palpate with the feature `robot-log`, which is enabled by default",
    ))
}
