//! What is stated of every bad file.

use std::{collections::BTreeMap, fmt::Write as _, fs};

use serde::Deserialize;

use crate::{any_file::Complaint, corpus};

/// Fewest bad files.
const FEWEST: usize = 150;

#[derive(Debug, Deserialize)]
struct Expected {
    message: String,
    hint: Option<String>,
}

/// What is stated of every file; `None` of those that are read.
fn complaints() -> BTreeMap<String, Option<Complaint>> {
    let (mut stated, mut panicked) = (BTreeMap::new(), Vec::new());
    for example in corpus::all() {
        match std::panic::catch_unwind(|| example.read()) {
            Ok(read) => drop(stated.insert(example.place, read.err())),
            Err(_) => panicked.push(example.place),
        }
    }
    assert!(panicked.is_empty(), "readers panic: {panicked:?}");
    stated
}

fn is_good(place: &str) -> bool {
    place.contains("good")
}

#[test]
fn every_bad_file_has_its_message_and_good_ones_are_read() {
    let found = complaints();
    let mistaken: Vec<_> = found.iter().filter(|(place, complaint)| is_good(place) != complaint.is_none()).collect();
    assert!(mistaken.is_empty(), "good files that are refused, or bad ones that are read: {mistaken:#?}");
    let bad: BTreeMap<String, Complaint> =
        found.into_iter().filter_map(|(place, stated)| Some((place, stated?))).collect();
    assert!(bad.len() >= FEWEST, "{} bad files", bad.len());
    let table = corpus::folder().join("messages.toml");
    if std::env::var_os("PALPATE_WRITE_MESSAGES").is_some() {
        fs::write(&table, written(&bad)).expect("a table of messages");
    }
    let text = fs::read_to_string(&table).expect("a table of messages");
    let expected: BTreeMap<String, Expected> = toml::from_str(&text).expect("a table of messages");
    for (place, complaint) in &bad {
        let expected = expected.get(place).unwrap_or_else(|| panic!("{place}: {complaint:?} is not in the table"));
        let (message, hint) = (expected.message.trim_end(), expected.hint.as_deref().map(str::trim_end));
        assert_eq!((complaint.message.as_str(), complaint.hint.as_deref()), (message, hint), "{place}");
    }
    assert!(expected.keys().eq(bad.keys()), "the table has files that are not there");
}

#[test]
fn nothing_is_refused_without_a_way_on() {
    let without = complaints()
        .into_iter()
        .filter(|(_, stated)| stated.as_ref().is_some_and(|stated| stated.hint.is_none()));
    let without: Vec<_> = without.collect();
    assert!(without.is_empty(), "{without:#?}");
}

/// The table as it is committed.
fn written(found: &BTreeMap<String, Complaint>) -> String {
    let mut text = String::from("# What is stated of every bad file of this folder, and what is stated to help.\n");
    for (place, Complaint { message, hint }) in found {
        write!(text, "\n[\"{place}\"]\nmessage = '''\n{message}\n'''\n").expect("a text in memory");
        if let Some(hint) = hint {
            writeln!(text, "hint = '''\n{hint}\n'''").expect("a text in memory");
        }
    }
    text
}
