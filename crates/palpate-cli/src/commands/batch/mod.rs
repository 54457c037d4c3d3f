//! `palpate batch`: many records to one table.
//!
//! | file | what |
//! |---|---|
//! | `rows.rs` | an analysed record as rows |
//! | `compute.rs` | records over threads |
//! | `journal.rs` | what is done, kept for a restart |
//! | `table.rs` | the rows as a file |

mod compute;
mod journal;
mod rows;
mod table;

use std::path::Path;
use std::thread;
use std::time::Instant;

use palpate::analysis::AnalysisOptions;
use palpate::forecast::CompareOptions;
use palpate::number::counted;
use palpate_files::description::TestDescription;
use palpate_report::document::Software;
use sha2::{Digest, Sha256};

use super::inputs::records_of;
use super::record::description;
use crate::apart::{is_same, refused};
use crate::arguments::BatchArguments;
use crate::failure::{Failure, Outcome};
use crate::terminal::note;
use compute::{Asked, compute};
use journal::{Journal, Refused, folder_of};
use table::Format;

pub(crate) fn run(arguments: &BatchArguments) -> Result<Outcome, Failure> {
    let started = Instant::now();
    let format = Format::of(&arguments.out)?;
    let test = description(arguments.test.as_deref(), None)?;
    let options = options(arguments, test.as_ref());
    let mut paths = records_of(&arguments.records)?;
    if !is_written_by_batch(&arguments.out) && paths.iter().any(|path| is_same(path, &arguments.out)) {
        return Err(refused(&arguments.out));
    }
    paths.retain(|path| !is_ours(path, &arguments.out));
    let settings = settings(&options, arguments.test.as_deref(), test.as_ref())?;
    let digest = digest(&settings);
    let mut journal = Journal::open(&arguments.out, &digest, arguments.restart)?;
    let threads = arguments
        .threads
        .map_or_else(|| thread::available_parallelism().map_or(1, usize::from), usize::from);
    let asked = Asked {
        test: test.as_ref(),
        described_by: arguments.test.as_deref(),
        options: &options,
        threads,
    };
    let (places, before) = compute(&paths, &asked, &mut journal)?;
    let written = table::write(&arguments.out, format, &mut journal, &places, &settings)?;
    tell(arguments, &written, paths.len(), before, started);
    Ok(if written.failures.is_empty() { Outcome::Done } else { Outcome::Negative })
}

fn options(arguments: &BatchArguments, test: Option<&TestDescription>) -> AnalysisOptions {
    let mut options = test.map_or_else(AnalysisOptions::default, TestDescription::analysis_options);
    options.fit_until = arguments.fit_until.or(options.fit_until);
    options.segment.hold_start = arguments.hold_start.unwrap_or(options.segment.hold_start);
    options.compare = arguments.laws.as_ref().map(|laws| {
        let mut compare = CompareOptions::default();
        compare.laws.clone_from(laws);
        compare
    });
    options
}

/// Everything that the results depend on besides the records, as text.
fn settings(
    options: &AnalysisOptions,
    described_by: Option<&Path>,
    test: Option<&TestDescription>,
) -> Result<String, Failure> {
    let said = described_by.map(std::fs::read_to_string).transpose();
    let said = said.map_err(|error| Failure::new(error, None))?;
    let software = Software::this();
    let value = serde_json::json!({
        "software": format!("{} {}", software.name, software.version),
        "test": described_by.map(|path| path.display().to_string()),
        "test_toml": said,
        "options": serde_json::to_value(options).map_err(|error| Failure::new(error, None))?,
        "reading": format!("{:?}", test.map(|test| &test.reading)),
    });
    Ok(value.to_string())
}

fn digest(settings: &str) -> String {
    let digest = Sha256::digest(settings.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Whether a path is a table of a batch, or the folder of its journal.
pub(super) fn is_written_by_batch(path: &Path) -> bool {
    if path.is_dir() { journal::is_journal(path) } else { table::is_table(path) }
}

/// Whether a file is the table or part of its journal: in the folder of the records they are no records.
fn is_ours(path: &Path, out: &Path) -> bool {
    is_same(path, out) || path.parent().is_some_and(|folder| is_same(folder, &folder_of(out)))
}

/// Says what was done, and what could not be.
fn tell(arguments: &BatchArguments, written: &table::Written, files: usize, before: usize, started: Instant) {
    const MOST: usize = 1000;
    for Refused { message, .. } in written.failures.iter().take(MOST) {
        note(&format!("failed: {message}"));
    }
    if written.failures.len() > MOST {
        note(&format!("failed: … and {} more", written.failures.len() - MOST));
    }
    let mut hints: Vec<&str> = written.failures.iter().filter_map(|failed| failed.hint.as_deref()).collect();
    hints.sort_unstable();
    hints.dedup();
    if let [hint] = hints[..] {
        note(&format!("hint: {hint}"));
    }
    let kept = if before > 0 { format!(" ({before} were done before)") } else { String::new() };
    let failed = match written.failures.len() {
        0 => String::new(),
        count => format!(", {count} of {} tests failed", written.tests),
    };
    note(&format!(
        "{} of {} in {}{kept}{failed}, {:.1} s: {}",
        counted(written.rows, "row"),
        counted(written.tests - written.failures.len(), "test"),
        counted(files, "file"),
        started.elapsed().as_secs_f64(),
        arguments.out.display()
    ));
}
