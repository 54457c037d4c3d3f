//! What is read is not written over.

use std::path::{Path, PathBuf};

use crate::arguments::Command;
use crate::failure::Failure;

/// Refuses a command one of whose outputs is one of its inputs: a measured record cannot be had again.
pub(crate) fn keep_apart(command: &Command) -> Result<(), Failure> {
    let (reads, writes) = files_of(command);
    for out in &writes {
        if reads.iter().any(|read| is_same(read, out)) {
            return Err(refused(out));
        }
    }
    Ok(())
}

/// That a file is read and cannot be written.
pub(crate) fn refused(out: &Path) -> Failure {
    Failure::of_file(
        out,
        "expected another file than those that are read, found one of them",
        Some("choose another name for what is written".to_owned()),
    )
}

/// Whether two paths lead to one file, through links too.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// The files that a command names to read, and those to write; folders of studies hold nothing that is read.
fn files_of(command: &Command) -> (Vec<&PathBuf>, Vec<&PathBuf>) {
    let (reads, writes): (Vec<&Option<PathBuf>>, Vec<&Option<PathBuf>>);
    let (mut always, mut out): (Vec<&PathBuf>, Vec<&PathBuf>) = (Vec::new(), Vec::new());
    match command {
        Command::Simulate(a) => {
            always.push(&a.protocol);
            reads = vec![&a.drive, &a.test];
            let [hysteresis, energy] = [&a.hysteresis, &a.energy];
            writes = vec![
                &a.out,
                &a.figure,
                hysteresis,
                &a.wave,
                &a.strain_map,
                energy,
                &a.energy_by_step,
                &a.energy_by_cycle,
            ];
        }
        Command::Sweep(a) => {
            always.push(&a.protocol);
            (reads, writes) = (Vec::new(), vec![&a.out, &a.figure]);
        }
        Command::Inspect(a) => (reads, writes) = (vec![&a.record, &a.test], vec![&a.figure, &a.write_test]),
        Command::Convert(a) => {
            always.push(&a.record);
            out.push(&a.out);
            (reads, writes) = (vec![&a.test], Vec::new());
        }
        Command::Batch(a) => {
            out.push(&a.out);
            (reads, writes) = (vec![&a.test], Vec::new());
        }
        Command::Calibrate(a) => {
            always.push(&a.record);
            (reads, writes) = (vec![&a.test], vec![&a.out, &a.figure]);
        }
        Command::Predict(a) => {
            always.extend([&a.material, &a.protocol]);
            (reads, writes) = (Vec::new(), vec![&a.out, &a.figure]);
        }
        Command::Grip(a) => {
            always.push(&a.material);
            (reads, writes) = (Vec::new(), vec![&a.figure]);
        }
        Command::Reproduce(_)
        | Command::Analyze(_)
        | Command::Compare(_)
        | Command::Watch(_)
        | Command::Schema(_)
        | Command::Completions(_) => (reads, writes) = (Vec::new(), Vec::new()),
    }
    always.extend(reads.into_iter().flatten());
    out.extend(writes.into_iter().flatten());
    (always, out)
}
