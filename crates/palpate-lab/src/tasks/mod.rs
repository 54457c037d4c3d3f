//! Tasks: each runs one job on a thread of its own, says how far it is, can be cancelled, and keeps what it made.
//!
//! The same task is never run twice at once: two pages that want it share it, and what it made serves until the record or its description
//! change. Tasks that a person waits for (columns, phases) have a thread that others do not take.
//!
//! | file | what |
//! |---|---|
//! | `request.rs` | what can be requested ([`Request`]) |
//! | `made.rs` | what a task made ([`Made`]): an answer for the page, and files |
//! | `run.rs` | from the one to the other: one job each |
//! | `queue.rs` | tasks that wait, threads that run them |

mod made;
mod queue;
mod request;
mod run;

pub(crate) use made::{Files, Made, PictureChoice};
pub(crate) use queue::{Brief, Tasks};
pub(crate) use request::Request;
pub(crate) use run::{grip_range, material_of};
