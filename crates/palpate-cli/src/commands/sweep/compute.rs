//! The runs that are missing, over threads, a part at a time.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::thread;

use palpate_files::description::Sweep;

use super::parts::Parts;
use super::rows::simulated;
use crate::failure::Failure;
use crate::progress::Counting;

/// Runs between two reports of a thread.
const REPORT: u64 = 16;

enum Message {
    Runs(u64),
    Written(u64, PathBuf),
    Failed(Failure),
}

/// Computes the missing parts. Each is the work of one thread, so that its bytes do not depend on how many there are.
pub(super) fn compute(sweep: &Sweep, path: &Path, parts: &mut Parts, threads: usize) -> Result<(), Failure> {
    let missing = parts.missing();
    let mut done = parts.runs_done();
    let progress = Counting::new("simulating", done, sweep.runs());
    let (mut written, mut failed) = (Vec::new(), None);
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (sender, messages) = channel();
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, missing.len().max(1)) {
            let sender = sender.clone();
            let (missing, parts, next, stop) = (&missing, &*parts, &next, &stop);
            scope.spawn(move || {
                while let Some(&part) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if stop.load(Ordering::Relaxed) {
                        break;
                    }
                    one(sweep, path, parts, part, &sender);
                }
            });
        }
        drop(sender);
        for message in &messages {
            match message {
                Message::Runs(count) => {
                    done += count;
                    progress.update(done);
                }
                Message::Written(part, path) => written.push((part, path)),
                Message::Failed(failure) => {
                    stop.store(true, Ordering::Relaxed);
                    failed.get_or_insert(failure);
                }
            }
        }
    });
    parts.add(written);
    failed.map_or(Ok(()), Err)
}

fn one(sweep: &Sweep, path: &Path, parts: &Parts, part: u64, sender: &Sender<Message>) {
    // The receiver lives as long as the threads do.
    let tell = |message| {
        let _ = sender.send(message);
    };
    let mut since = 0;
    let rows = simulated(sweep, path, parts.runs_of(part), || {
        since += 1;
        if since == REPORT {
            tell(Message::Runs(since));
            since = 0;
        }
    });
    tell(Message::Runs(since));
    tell(match parts.write(part, rows) {
        Ok(path) => Message::Written(part, path),
        Err(failure) => Message::Failed(failure),
    });
}
