//! The files that are not done, over threads; each is the work of one thread.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread;

use palpate::analysis::{AnalysisOptions, examine};
use palpate_files::description::TestDescription;
use palpate_report::document::AnalysisDocument;

use super::super::record::{Opened, input};
use super::journal::{Entry, Journal, Refused};
use super::rows::rows;
use crate::failure::Failure;
use crate::files::sha256;
use crate::progress::Counting;

/// What is asked of every file.
pub(super) struct Asked<'a> {
    pub(super) test: Option<&'a TestDescription>,
    pub(super) described_by: Option<&'a Path>,
    pub(super) options: &'a AnalysisOptions,
    pub(super) threads: usize,
}

/// What a thread says of a file.
enum Message {
    /// It was done before, and lies there.
    Found(usize, Range<u64>),
    /// It is done now; this is its line.
    Done(usize, Vec<u8>),
}

/// Results of all files in their order, as places in the journal, and how many were done before.
pub(super) fn compute(
    paths: &[PathBuf],
    asked: &Asked<'_>,
    journal: &mut Journal,
) -> Result<(Vec<Range<u64>>, usize), Failure> {
    let mut places: Vec<Option<Range<u64>>> = vec![None; paths.len()];
    let progress = Counting::new("analysing", 0, paths.len() as u64);
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (mut done, mut before, mut failed) = (0, 0, None);
    // A few lines may wait for the disk; more would fill the memory.
    let (sender, messages) = sync_channel(64);
    let known = journal.known();
    thread::scope(|scope| {
        for _ in 0..asked.threads.clamp(1, paths.len().max(1)) {
            let sender = sender.clone();
            let (known, next, stop) = (&known, &next, &stop);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(path) = paths.get(index) else { break };
                    let digest = sha256(path);
                    let found = digest.as_ref().ok().and_then(|digest| known.find(&name_of(path), digest));
                    let message = match found {
                        Some(place) => Message::Found(index, place),
                        None => Message::Done(index, line(path, digest, asked)),
                    };
                    // The receiver lives as long as the threads do.
                    let _ = sender.send(message);
                }
            });
        }
        drop(sender);
        for message in &messages {
            match message {
                Message::Found(index, place) => {
                    before += 1;
                    places[index] = Some(place);
                }
                Message::Done(index, line) => match journal.add(&line) {
                    Ok(place) => places[index] = Some(place),
                    Err(failure) => {
                        stop.store(true, Ordering::Relaxed);
                        failed.get_or_insert(failure);
                    }
                },
            }
            done += 1;
            progress.update(done);
        }
    });
    match failed {
        Some(failure) => Err(failure),
        None => Ok((places.into_iter().flatten().collect(), before)),
    }
}

/// What the journal calls a file.
pub(super) fn name_of(path: &Path) -> String {
    path.display().to_string()
}

/// The line of the journal for a file.
fn line(path: &Path, digest: Result<String, Failure>, asked: &Asked<'_>) -> Vec<u8> {
    let mut entry = Entry {
        path: name_of(path),
        sha256: digest.ok(),
        rows: Vec::new(),
        failures: Vec::new(),
        tests: 1,
    };
    match Opened::open(path, asked.test) {
        Ok(opened) => {
            entry.tests = opened.parts().len();
            for part in opened.parts() {
                match document(&opened, *part, asked) {
                    Ok(document) => entry.rows.extend(rows(&document)),
                    Err(failure) => entry.failures.push(refused(failure)),
                }
            }
        }
        Err(failure) => entry.failures.push(refused(failure)),
    }
    // Texts and numbers always have a form in JSON.
    let mut line = serde_json::to_vec(&entry).unwrap_or_default();
    line.push(b'\n');
    line
}

fn document(opened: &Opened<'_>, part: usize, asked: &Asked<'_>) -> Result<AnalysisDocument, Failure> {
    let file = opened.read_quietly(part)?;
    let input = input(&file, opened.name(part), asked.described_by, asked.test)?;
    let analysis = examine(&file.record, asked.options)
        .map_err(|error| Failure::of_file(&file.path, &error, Some(error.hint())))?;
    Ok(AnalysisDocument::new(&analysis, input))
}

fn refused(failure: Failure) -> Refused {
    let (message, hint) = failure.into_parts();
    Refused { message, hint }
}
