//! `palpate inspect`: what is in a record, and which machines are known.
//!
//! | file | what |
//! |---|---|
//! | `facts.rs` | how a test is written, its columns, its sampling |
//! | `cut.rs` | the cut into phases: as a table, a sparkline and a figure |

mod cut;
mod facts;

use std::fmt::Write as _;
use std::path::Path;

use palpate_files::description::{TestDescription, machines};
use palpate_files::input::Packing;
use palpate_files::open::Contents;
use palpate_files::record::describe;
use palpate_report::table::{Cell, Table, TableColumn};

use super::picture::{check_picture, picture};
use super::record::{Opened, description, one_part};
use crate::arguments::InspectArguments;
use crate::failure::{Failure, Outcome};
use crate::files::write_file;
use crate::terminal::{note, print};
use cut::Cut;
use facts::{columns_table, part_facts, signal_facts};

pub(crate) fn run(arguments: &InspectArguments) -> Result<Outcome, Failure> {
    // Without a list of machines there is a record: the command line asks for one.
    let Some(record) = arguments.record.as_deref().filter(|_| !arguments.machines) else {
        print(&machines_table().to_plain_text())?;
        return Ok(Outcome::Done);
    };
    if let Some(figure) = &arguments.figure {
        check_picture(figure)?;
    }
    if let Some(path) = &arguments.write_test {
        check_new(path)?;
    }
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let opened = Opened::open(record, test.as_ref())?;
    let mut out = file_facts(opened.contents());
    let wants_one = arguments.figure.is_some() || arguments.write_test.is_some();
    let told = match opened.parts() {
        [only] => one_test(&opened, *only, arguments, &mut out),
        _ if wants_one => one_part(&opened).map(drop),
        several => {
            out.push_str(&many_tests(&opened, several, test.as_ref()));
            Ok(())
        }
    };
    for part in opened.skipped() {
        let _ = writeln!(out, "skipped {}: {}", part.name, part.reason);
    }
    print(&out)?;
    told.map(|()| Outcome::Done)
}

/// Machines that a description can name, with what each is.
fn machines_table() -> Table {
    let table = Table::new("machines", "Machines")
        .column(TableColumn::new("Name", "name", ""))
        .column(TableColumn::new("What", "about", ""))
        .note("in a test description: [machine] preset = \"NAME\"; what the description says itself goes before");
    machines().iter().fold(table, |table, machine| {
        table.row(vec![Cell::text(machine.name), Cell::text(machine.about().trim_end_matches('.'))])
    })
}

/// A description that a person has worked on is not written over.
fn check_new(path: &Path) -> Result<(), Failure> {
    if path.exists() {
        return Err(Failure::of_file(
            path,
            "expected the name of a new file, found one that is there",
            Some("choose another name with --write-test, or remove the file first".to_owned()),
        ));
    }
    Ok(())
}

/// Format, packing and number of tests.
fn file_facts(contents: &Contents) -> String {
    let packing = match contents.packing() {
        Packing::None => String::new(),
        packed => format!(", {packed}"),
    };
    format!("{}\n{}{packing}\n", contents.path().display(), contents.format())
}

/// Everything about one test; where it gives no record, as much as is known.
fn one_test(opened: &Opened<'_>, part: usize, arguments: &InspectArguments, out: &mut String) -> Result<(), Failure> {
    let test = opened.test();
    let about = &opened.contents().parts()[part];
    out.push_str(&part_facts(about, opened.contents().format()));
    let file = match opened.read(part) {
        Ok(file) => file,
        Err(failure) => {
            // The columns help to mend what is wrong.
            out.push_str(&columns_table(about, None).to_plain_text());
            if let Some(path) = &arguments.write_test {
                write_test(path, &describe(opened.contents(), part, None, None))?;
            }
            return Err(failure);
        }
    };
    out.push_str(&columns_table(about, Some(&file)).to_plain_text());
    out.push('\n');
    let cut = Cut::of(&file.record, test);
    out.push_str(&signal_facts(&file, cut.as_ref().ok().and_then(Cut::signals)));
    let cut = cut.map_err(|error| Failure::of_file(&file.path, &error, Some(error.hint())))?;
    out.push_str(&cut.told(test));
    if let Some(error) = cut.refused() {
        return Err(Failure::of_file(&file.path, error, Some(error.hint().to_owned())));
    }
    if let Some(path) = &arguments.write_test {
        let found = cut.found().map(|segmentation| (&file, segmentation));
        write_test(path, &describe(opened.contents(), part, Some(&file), found))?;
    }
    if let Some(path) = &arguments.figure {
        write_file(path, &picture(path, &cut.figure())?)?;
        note(&format!("figure written: {}", path.display()));
    }
    Ok(())
}

fn write_test(path: &Path, text: &str) -> Result<(), Failure> {
    write_file(path, text.as_bytes())?;
    note(&format!("test description written: {}", path.display()));
    Ok(())
}

/// One row a test.
fn many_tests(opened: &Opened<'_>, parts: &[usize], test: Option<&TestDescription>) -> String {
    let mut table = Table::new("tests", "Tests")
        .column(TableColumn::new("Test", "part", ""))
        .column(TableColumn::new("Rows", "rows", ""))
        .column(TableColumn::new("Duration", "duration_s", "s"))
        .column(TableColumn::new("Largest force", "force_max_n", "N"))
        .column(TableColumn::new("Holds", "holds", ""))
        .note("palpate inspect FILE --part NAME shows one of them");
    for part in parts {
        let name = opened.contents().parts()[*part].title();
        table = table.row(match opened.read(*part) {
            Ok(file) => {
                let record = &file.record;
                let time = record.time();
                let cut = Cut::of(record, test).ok();
                let holds = cut.as_ref().and_then(Cut::found).map(|found| found.holds().count());
                vec![
                    Cell::text(name),
                    Cell::Integer(file.rows as i64),
                    Cell::number(time[time.len() - 1] - time[0], 5),
                    Cell::number(record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs())), 4),
                    holds.map_or_else(|| Cell::text("none"), |count| Cell::Integer(count as i64)),
                ]
            }
            Err(failure) => {
                let mut row = vec![Cell::text(name)];
                row.extend((0..3).map(|_| Cell::missing("not read")));
                row.push(Cell::text(failure.into_parts().0));
                row
            }
        });
    }
    format!("\n{}\n", table.to_plain_text())
}
