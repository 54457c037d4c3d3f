//! What is in a record, and which machines are known.
//!
//! | file | what |
//! |---|---|
//! | `facts.rs` | how a test is written, its columns, its sampling |
//! | `document.rs` | all of it for programs |
//! | `cut.rs` | the cut into phases: as a table, a sparkline and a figure |

mod cut;
mod document;
mod facts;

use std::fmt::Write as _;

use palpate::analysis::AnalysisError;
use palpate::watch::Watch;
use palpate_files::description::machines;
use palpate_files::input::Packing;
use palpate_files::open::Contents;
use palpate_files::record::{describe, describe_all};
use palpate_report::figure::Figure;
use palpate_report::table::{Cell, Table};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::input::{OpenedFile, averaged};
use crate::{ErrorKind, JobError, Outcome, Results};
use cut::Cut;
pub use document::{
    ColumnRole, InspectedColumn, InspectedRecord, InspectedTest, InspectionDocument, PhaseDocument, RefusalDocument,
    SkippedDocument,
};
use facts::{columns_table, part_facts, short, signal_facts};

/// Say what is in a file, and which phases a test in it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Inspect {
    /// The file has to hold one test: its figure is wanted.
    pub only: bool,
}

/// What is in a file: as much as is known, even where that gives no record.
#[derive(Debug)]
pub struct Inspected {
    text: String,
    document: InspectionDocument,
    /// Why the one test of the file gives no record, or no phases.
    pub refused: Option<JobError>,
    /// A first description of the one test, or of all tests alike, with every guess commented.
    pub description: Option<String>,
    cut: Option<Cut>,
}

impl Inspect {
    /// Looks into a file.
    ///
    /// # Errors
    /// [`JobError`] where the watch ends it; whatever else is wrong stands in the result.
    pub fn run(self, opened: &OpenedFile<'_>, watch: &mut dyn Watch) -> Result<Outcome<Inspected>, JobError> {
        let mut found = Inspected {
            text: file_facts(&opened.contents),
            document: InspectionDocument::new(&opened.contents, &opened.tests.skipped),
            refused: None,
            description: None,
            cut: None,
        };
        let mut notes = Vec::new();
        let reported = match &opened.tests.parts[..] {
            [only] => found.one_test(opened, *only, &mut notes, watch),
            _ if self.only => opened.only().map(drop),
            several => {
                let about = several.iter().map(|part| InspectedTest::of_part(&opened.contents.parts[*part]));
                found.document.tests = about.collect();
                // What is stated for all, by the first that can be read.
                let file = several.iter().find_map(|part| Some((*part, opened.read(*part, watch).ok()?)));
                let mut parts = several.to_vec();
                if let Some((first, file)) = &file {
                    parts.sort_by_key(|part| part != first);
                    let place = several.iter().position(|part| part == first);
                    let document = place.and_then(|place| found.document.tests.get_mut(place));
                    document.into_iter().for_each(|test| test.read(file, opened.described.test.as_ref()));
                }
                found.description = Some(describe_all(&opened.contents, &parts, file.as_ref().map(|(_, file)| file)));
                many_tests(opened, several, &mut notes, watch).map(|tests| found.text.push_str(&tests))
            }
        };
        for part in &opened.tests.skipped {
            let _ = writeln!(found.text, "skipped {}: {}", part.name, part.reason);
        }
        found.refused = reported.err();
        if let (Some(error), [test]) = (&found.refused, &mut found.document.tests[..]) {
            test.refused = Some(error.into());
        }
        match found.refused {
            Some(error) if error.kind == ErrorKind::Cancelled => Err(error),
            _ => Ok(Outcome::of(found).noted(notes)),
        }
    }
}

impl Inspected {
    /// The cut into phases; none where there is no record.
    #[must_use]
    pub fn figure(&self) -> Option<Figure> {
        self.cut.as_ref().map(Cut::figure)
    }

    /// Everything about one test; where it gives no record, as much as is known.
    fn one_test(
        &mut self,
        opened: &OpenedFile<'_>,
        part: usize,
        notes: &mut Vec<String>,
        watch: &mut dyn Watch,
    ) -> Result<(), JobError> {
        let (test, out) = (opened.described.test.as_ref(), &mut self.text);
        let about = &opened.contents.parts[part];
        self.document.tests.push(InspectedTest::of_part(about));
        let document = &mut self.document.tests[0];
        out.push_str(&part_facts(about, opened.contents.format));
        let file = opened.read(part, watch).inspect_err(|_| {
            // The columns help to repair what is wrong.
            out.push_str(&columns_table(about, None).to_plain_text());
            self.description = Some(describe(&opened.contents, part, None, None));
        })?;
        notes.extend(averaged(&file));
        document.read(&file, test);
        out.push_str(&columns_table(about, Some(&file)).to_plain_text());
        out.push('\n');
        let cut = Cut::of(&file.record, test, watch);
        out.push_str(&signal_facts(&file, cut.as_ref().ok().and_then(|cut| cut.signals.as_ref())));
        let place = file.path.display().to_string();
        let cut = cut.map_err(|error| JobError::analysis(&error, &place))?;
        document.cut(&file, &cut);
        out.push_str(&cut.reported(test, &file));
        if let Some(error) = cut.refused() {
            return Err(JobError::new(ErrorKind::Record, error, error.hint().to_owned()).of(place));
        }
        let found = cut.found().map(|segmentation| (&file, segmentation));
        self.description = Some(describe(&opened.contents, part, Some(&file), found));
        self.cut = Some(cut);
        Ok(())
    }
}

impl Results for Inspected {
    type Document = InspectionDocument;

    fn document(&self) -> InspectionDocument {
        self.document.clone()
    }

    fn text(&self) -> String {
        self.text.clone()
    }
}

/// Machines that a description can name, with what each is, for people.
#[must_use]
pub fn machines_text() -> String {
    Table::of("machines", "Machines", machines())
        .column("Name", "name", "", |machine| Cell::text(machine.name))
        .column("What", "about", "", |machine| Cell::text(machine.about().trim_end_matches('.')))
        .table()
        .note("in a test description: [machine] preset = \"NAME\"; fields of the description take precedence")
        .to_plain_text()
}

/// Format, packing and number of tests.
fn file_facts(contents: &Contents) -> String {
    let packing = match &contents.input.packing {
        Packing::None => String::new(),
        packed => format!(", {packed}"),
    };
    format!("{}\n{}{packing}\n", contents.input.name.display(), contents.format)
}

/// One row a test.
fn many_tests(
    opened: &OpenedFile<'_>,
    parts: &[usize],
    notes: &mut Vec<String>,
    watch: &mut dyn Watch,
) -> Result<String, JobError> {
    let mut table = Table::new("tests", "Tests")
        .column("Test", "part", "")
        .column("Rows", "rows", "")
        .column("Duration", "duration_s", "s")
        .column("Largest force", "force_max_n", "N")
        .column("Holds", "holds", "")
        .note("palpate inspect FILE --part NAME shows one of them");
    for part in parts {
        let name = short(Some(opened.contents.parts[*part].title()));
        table = table.row(match opened.read(*part, watch) {
            Ok(file) => {
                notes.extend(averaged(&file));
                let record = &file.record;
                let time = record.time();
                let cut = match Cut::of(record, opened.described.test.as_ref(), watch) {
                    Err(AnalysisError::Cancelled(cancelled)) => return Err(cancelled.into()),
                    cut => cut.ok(),
                };
                let holds = cut.as_ref().and_then(Cut::found).map(|found| found.holds().count());
                vec![
                    Cell::text(name),
                    Cell::Integer(file.rows as i64),
                    Cell::Number(time[time.len() - 1] - time[0], 5),
                    Cell::Number(record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs())), 4),
                    holds.map_or_else(|| Cell::text("none"), |count| Cell::Integer(count as i64)),
                ]
            }
            Err(error) if error.kind == ErrorKind::Cancelled => return Err(error),
            Err(error) => {
                let mut row = vec![Cell::text(name)];
                row.extend((0..3).map(|_| Cell::missing("not read")));
                row.push(Cell::text(error.to_string()));
                row
            }
        });
    }
    Ok(format!("\n{}\n", table.to_plain_text()))
}
