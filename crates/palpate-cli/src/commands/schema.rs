//! `palpate schema`: JSON Schemas.

use palpate_jobs::{JobError, Verdict};

use crate::arguments::SchemaArguments;
use crate::terminal::print;

pub(crate) fn run(arguments: &SchemaArguments) -> Result<Verdict, JobError> {
    print(&format!("{}\n", serde_json::to_string_pretty(&(arguments.name)())?))?;
    Ok(Verdict::Positive)
}
