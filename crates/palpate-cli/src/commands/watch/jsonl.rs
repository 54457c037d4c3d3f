//! One JSON object a line.

use std::io::{self, Write};

use palpate_jobs::{HoldObserved, Observed};
use palpate_report::document::{WatchDocument, WatchSummaryDocument};

use super::Output;

pub(super) struct Jsonl;

impl Output for Jsonl {
    fn see(&mut self, out: &mut dyn Write, observed: &Observed) -> io::Result<()> {
        observed.document().map_or(Ok(()), |document| line(out, &document))
    }

    fn end(&mut self, out: &mut dyn Write, holds: &[HoldObserved]) -> io::Result<()> {
        let holds = holds.iter().map(HoldObserved::document).collect();
        line(out, &WatchDocument::Summary(WatchSummaryDocument::new(holds)))
    }
}

fn line(out: &mut dyn Write, document: &WatchDocument) -> io::Result<()> {
    writeln!(out, "{}", serde_json::to_string(document)?)
}
