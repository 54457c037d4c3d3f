//! `palpate inspect`: what is in a record.

use std::fmt::Write as _;

use palpate::record::Record;
use palpate::segment::{SegmentOptions, find_contact_of, find_phases};
use palpate_files::contents::{Contents, Part};
use palpate_files::description::TestDescription;
use palpate_files::input::Packing;
use palpate_files::record_file::{RecordFile, Role};
use palpate_report::number::significant;
use palpate_report::table::{Cell, Table, TableColumn};

use super::record::{Opened, description};
use crate::arguments::InspectArguments;
use crate::failure::{Failure, Outcome};
use crate::terminal::print;

pub(crate) fn run(arguments: &InspectArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let opened = Opened::open(&arguments.record, test.as_ref())?;
    let mut out = file_facts(opened.contents());
    match opened.parts() {
        [only] => {
            if let Err(failure) = one_test(&opened, *only, test.as_ref(), &mut out) {
                print(&out)?;
                return Err(failure);
            }
        }
        several => out.push_str(&many_tests(&opened, several, test.as_ref())),
    }
    for part in opened.skipped() {
        let _ = writeln!(out, "skipped {}: {}", part.name, part.reason);
    }
    print(&out)?;
    Ok(Outcome::Done)
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
fn one_test(
    opened: &Opened<'_>,
    part: usize,
    test: Option<&TestDescription>,
    out: &mut String,
) -> Result<(), Failure> {
    let about = &opened.contents().parts()[part];
    out.push_str(&part_facts(about));
    let file = match opened.read(part) {
        Ok(file) => file,
        Err(failure) => {
            // The columns help to mend what is wrong.
            out.push_str(&columns_table(about, None).to_plain_text());
            return Err(failure);
        }
    };
    out.push_str(&columns_table(about, Some(&file)).to_plain_text());
    out.push('\n');
    out.push_str(&signal_facts(&file));
    let segment = test.map_or_else(SegmentOptions::default, |test| test.segment);
    out.push_str(&phases(&file.record, &segment, test));
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
    let segment = test.map_or_else(SegmentOptions::default, |test| test.segment);
    for part in parts {
        let name = opened.contents().parts()[*part].title();
        table = table.row(match opened.read(*part) {
            Ok(file) => {
                let record = &file.record;
                let time = record.time();
                let holds = find_phases(&record.repaired().0, &segment).map(|found| found.holds().count());
                vec![
                    Cell::text(name),
                    Cell::Integer(file.rows as i64),
                    Cell::number(time[time.len() - 1] - time[0], 5),
                    Cell::number(record.force().iter().fold(0.0, |most: f64, force| most.max(force.abs())), 4),
                    holds.map_or_else(|_| Cell::text("none"), |count| Cell::Integer(count as i64)),
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

/// How one test is written, what stands beside its data, and what the file labels.
fn part_facts(part: &Part) -> String {
    let mut out = String::new();
    if let Some(name) = &part.name {
        let _ = writeln!(out, "{name}");
    }
    if !part.written.is_empty() {
        let _ = writeln!(out, "{}", part.written);
    }
    for entry in &part.metadata {
        let unit = entry.unit.as_deref().unwrap_or("");
        let _ = writeln!(out, "  {} = {} {unit}", entry.name, entry.value);
    }
    for label in &part.labels {
        let _ = writeln!(out, "  rows {} to {}: {}", label.start + 1, label.end, label.name);
    }
    out.push('\n');
    out
}

fn columns_table(part: &Part, file: Option<&RecordFile>) -> Table {
    let mut table = Table::new("columns", "Columns")
        .column(TableColumn::new("Column", "number", ""))
        .column(TableColumn::new("Name", "name", ""))
        .column(TableColumn::new("Unit", "unit", ""))
        .column(TableColumn::new("First value", "sample", ""))
        .column(TableColumn::new("Used as", "used_as", ""));
    for column in &part.columns {
        let used = file.and_then(|file| file.columns.iter().find(|used| used.number == column.number));
        let role = used.map_or(String::new(), |used| {
            let sign = if used.sign < 0.0 { ", sign turned" } else { "" };
            let what = match used.role {
                Role::Values(quantity) => quantity.to_string(),
                Role::Added(quantity) => format!("added to {quantity}"),
                Role::ClockOf(quantity) => format!("time of {quantity}"),
            };
            format!("{what} in {}{sign}", used.unit)
        });
        table = table.row(vec![
            Cell::Integer(column.number as i64),
            Cell::text(column.name.as_deref().unwrap_or("")),
            Cell::text(column.unit.as_deref().unwrap_or("")),
            Cell::text(column.sample.as_str()),
            Cell::text(role),
        ]);
    }
    table
}

fn signal_facts(file: &RecordFile) -> String {
    let record = &file.record;
    let time = record.time();
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    let (low, high) = steps.fold((f64::MAX, 0.0f64), |(low, high), step| (low.min(step), high.max(step)));
    let range = |values: &[f64], factor: f64| {
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        format!("{} to {}", significant(low * factor, 4), significant(high * factor, 4))
    };
    let mut out = format!(
        "{} rows over {} s, every {} s (from {} to {} s)\n",
        file.rows,
        significant(time[time.len() - 1] - time[0], 5),
        significant(record.sample_interval(), 3),
        significant(low, 3),
        significant(high, 3)
    );
    if file.averaged > 1 {
        let _ = writeln!(out, "every sample is the mean of {} successive rows", file.averaged);
    }
    if let Some(displacement) = record.displacement() {
        let _ = writeln!(out, "displacement {} mm", range(displacement, 1e3));
    }
    let _ = writeln!(out, "force {} N", range(record.force(), 1.0));
    if let Some(footer) = &file.ignored.footer {
        let _ =
            writeln!(out, "{} lines after the data were passed over, from line {}", footer.lines, footer.first_line);
    }
    out.push('\n');
    out
}

fn phases(
    record: &Record,
    options: &SegmentOptions,
    test: Option<&TestDescription>,
) -> String {
    let (record, dropouts) = record.repaired();
    let segmentation = match find_phases(&record, options) {
        Ok(segmentation) => segmentation,
        Err(error) => return format!("Phases: {error}\n"),
    };
    let mut table = Table::new("phases", "Phases")
        .column(TableColumn::new("Phase", "phase", ""))
        .column(TableColumn::new("From", "start_s", "s"))
        .column(TableColumn::new("To", "end_s", "s"))
        .column(TableColumn::new("Samples", "samples", ""))
        .column(TableColumn::new("Displacement", "displacement_mm", "mm"))
        .column(TableColumn::new("Force at start", "force_start_n", "N"))
        .column(TableColumn::new("Force at end", "force_end_n", "N"));
    for segment in &segmentation.segments {
        let last = segment.end - 1;
        let end = record.displacement().map(|displacement| 1e3 * displacement[last]);
        table = table.row(vec![
            Cell::text(format!("{:?}", segment.phase).to_lowercase()),
            Cell::number(record.time()[segment.start], 6),
            Cell::number(record.time()[last], 6),
            Cell::Integer(segment.len() as i64),
            Cell::number_or(end, 4, "not recorded"),
            Cell::number(record.force()[segment.start], 4),
            Cell::number(record.force()[last], 4),
        ]);
    }
    let mut out = table.to_plain_text();
    if dropouts > 0 {
        let _ = writeln!(out, "\n{dropouts} rows of the displacement stray alone (dropouts)");
    }
    let body = test.and_then(|test| test.geometry.as_ref()).map(|geometry| (&geometry.shape, geometry.sides));
    let choice = test.map(|test| test.touch).unwrap_or_default();
    let contact = find_contact_of(&record, &segmentation, body, choice);
    if contact.air_travel > 0.0 {
        let _ = writeln!(
            out,
            "\nfirst touch at {} mm, after {} mm through air; force zero {} N",
            significant(1e3 * contact.tare.displacement, 4),
            significant(1e3 * contact.air_travel, 3),
            significant(contact.tare.force, 3)
        );
    }
    out
}
