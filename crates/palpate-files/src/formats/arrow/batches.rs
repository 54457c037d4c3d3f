//! Batches of rows: who looks at them.

use std::ops::ControlFlow;

use arrow_array::RecordBatch;

use crate::{error::FileError, input::Input};

/// What is given of every batch: its first row, the batch, bytes or rows done, and how many there are.
pub(super) type Visitor<'a> = dyn FnMut(u64, &RecordBatch, (u64, u64)) -> Result<ControlFlow<()>, FileError> + 'a;

pub(super) fn damaged(input: &Input, place: &str, found: &str) -> FileError {
    input.damaged(place, "what the format has there", found)
}
