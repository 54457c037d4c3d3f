//! One JSON object a line.

use std::io::{self, Write};

use palpate::observe::{Observation, Slip, TimeToSlip, Uncertain};
use serde_json::{Map, Value, json};

use super::Shown;
use super::events::{Event, HoldSeen};
use super::words::{held, phase, slip_word};

pub(super) struct Jsonl;

impl Shown for Jsonl {
    fn tick(&mut self, out: &mut dyn Write, seen: &Observation, asked: bool) -> io::Result<()> {
        if asked { line(out, observation("tick", seen)) } else { Ok(()) }
    }

    fn event(&mut self, out: &mut dyn Write, event: &Event) -> io::Result<()> {
        match event {
            Event::Began(seen) => line(out, observation("hold_begins", seen)),
            Event::Changed(seen) => line(out, observation("hold_changes", seen)),
            Event::Ended(time, found) => {
                let mut fields = hold(found);
                fields.insert("event".to_owned(), json!("hold_ends"));
                fields.insert("time_s".to_owned(), json!(time));
                line(out, fields)
            }
            Event::Warned(seen) => line(out, observation("warning", seen)),
        }
    }

    fn end(&mut self, out: &mut dyn Write, holds: &[HoldSeen]) -> io::Result<()> {
        let holds: Vec<Value> = holds.iter().map(|found| Value::Object(hold(found))).collect();
        let mut fields = Map::new();
        fields.insert("event".to_owned(), json!("summary"));
        fields.insert("holds".to_owned(), json!(holds));
        line(out, fields)
    }
}

fn line(out: &mut dyn Write, fields: Map<String, Value>) -> io::Result<()> {
    writeln!(out, "{}", Value::Object(fields))
}

fn put(fields: &mut Map<String, Value>, key: &str, value: impl Into<Value>) {
    fields.insert(key.to_owned(), value.into());
}

/// A number and its deviation, left out where it is not known.
fn put_uncertain(fields: &mut Map<String, Value>, name: &str, unit: &str, number: Option<Uncertain>) {
    if let Some(number) = number {
        put(fields, &format!("{name}{unit}"), number.value);
        put(fields, &format!("{name}_deviation{unit}"), number.deviation);
    }
}

fn observation(event: &str, seen: &Observation) -> Map<String, Value> {
    let mut fields = Map::new();
    put(&mut fields, "event", event);
    put(&mut fields, "time_s", seen.time);
    put(&mut fields, "phase", phase(seen.phase));
    put(&mut fields, "force_n", seen.force);
    if let (Some(what), Some(since)) = (seen.held, seen.held_since) {
        put(&mut fields, "held", held(what));
        put(&mut fields, "held_since_s", since);
    }
    put_uncertain(&mut fields, "equilibrium_force", "_n", seen.equilibrium_force);
    put_uncertain(&mut fields, "excess_force", "_n", seen.excess_force);
    put_uncertain(&mut fields, "excess_strain", "", seen.excess_strain);
    if let Some(rate) = seen.relative_rate {
        put(&mut fields, "relative_rate_per_s", rate);
    }
    put_uncertain(&mut fields, "creep_rate", "_m_per_s", seen.creep_rate);
    match seen.time_to_slip {
        None => {}
        Some(TimeToSlip::Unknown) => put(&mut fields, "slips", "not_known_yet"),
        Some(TimeToSlip::Never) => put(&mut fields, "slips", "never"),
        Some(TimeToSlip::After { value, low, high }) => {
            put(&mut fields, "slips", if value.is_some() { "after" } else { "perhaps_never" });
            put(&mut fields, "time_to_slip_s", value);
            put(&mut fields, "time_to_slip_low_s", low);
            put(&mut fields, "time_to_slip_high_s", high);
        }
    }
    if seen.time_to_slip.is_some() || seen.slip != Slip::None {
        put(&mut fields, "warning", slip_word(seen.slip));
    }
    fields
}

fn hold(found: &HoldSeen) -> Map<String, Value> {
    let mut fields = Map::new();
    put(&mut fields, "held", held(found.held));
    put(&mut fields, "start_s", found.since);
    put(&mut fields, "end_s", found.until);
    put(&mut fields, "force_start_n", found.forces.0);
    put(&mut fields, "force_end_n", found.forces.1);
    put_uncertain(&mut fields, "equilibrium_force", "_n", found.equilibrium);
    put_uncertain(&mut fields, "creep_rate", "_m_per_s", found.creep);
    for (key, time) in [("warned_s", found.warned), ("slipped_s", found.slipped)] {
        if let Some(time) = time {
            put(&mut fields, key, time);
        }
    }
    fields
}
