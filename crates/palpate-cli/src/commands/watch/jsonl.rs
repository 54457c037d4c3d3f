//! One JSON object a line.

use std::io::{self, Write};

use palpate::observe::Observation;
use palpate_jobs::{Event, HoldSeen};
use palpate_report::document::{ObservationDocument, WatchSummaryDocument, WatchedHoldDocument};
use serde::Serialize;

use super::Shown;

pub(super) struct Jsonl;

impl Shown for Jsonl {
    fn tick(&mut self, out: &mut dyn Write, seen: &Observation, asked: bool) -> io::Result<()> {
        if asked { line(out, &ObservationDocument::new("tick", seen)) } else { Ok(()) }
    }

    fn event(&mut self, out: &mut dyn Write, event: &Event) -> io::Result<()> {
        match event {
            Event::Began(seen) => line(out, &ObservationDocument::new("hold_begins", seen)),
            Event::Changed(seen) => line(out, &ObservationDocument::new("hold_changes", seen)),
            Event::Ended(time, found) => line(out, &hold(found).ended(*time)),
            Event::Warned(seen) => line(out, &ObservationDocument::new("warning", seen)),
        }
    }

    fn end(&mut self, out: &mut dyn Write, holds: &[HoldSeen]) -> io::Result<()> {
        line(out, &WatchSummaryDocument::new(holds.iter().map(hold).collect()))
    }
}

fn line(out: &mut dyn Write, document: &impl Serialize) -> io::Result<()> {
    writeln!(out, "{}", serde_json::to_string(document)?)
}

fn hold(found: &HoldSeen) -> WatchedHoldDocument {
    WatchedHoldDocument {
        warned_s: found.warned,
        slipped_s: found.slipped,
        ..WatchedHoldDocument::new(found.held, (found.since, found.until), found.forces)
    }
    .with_last(found.equilibrium, found.creep)
}
