//! Tables one below the other that are one record: the names of the columns repeat, and the clock goes on.

use std::path::Path;

use super::{row::RowPlan, section::Section};
use crate::{
    input::lines,
    naming::{NUMBERS, OF_A_PART, Quantity, WITHIN_A_TEST, is_listed, words},
    table::{ColumnInfo, Layout, candidates, recognise},
};

/// The tables with each that continues the one above it put behind it. Its lines of names are passed over.
pub(super) fn joined(text: &str, path: &Path, sections: Vec<Section>) -> Vec<Section> {
    let mut joined: Vec<(Section, Option<Span>)> = Vec::new();
    for section in sections {
        let span = if section.title.is_none() { span(text, path, &section) } else { None };
        match (joined.last_mut(), span) {
            (Some((above, Some(before))), Some(behind))
                if continues(text, above, &section) && before.goes_on_to(behind.first) =>
            {
                above.repeated += 1;
                above.stretches.extend(section.below_names(text));
                *before = Span {
                    first: before.first,
                    last: behind.last,
                    rows: before.rows + behind.rows,
                };
            }
            _ => joined.push((section, span)),
        }
    }
    joined.into_iter().map(|(section, _)| section).collect()
}

/// The clock of a table.
#[derive(Clone, Copy)]
struct Span {
    first: f64,
    last: f64,
    rows: usize,
}

impl Span {
    /// Whether the clock goes on to a time. One that counts from the beginning of a test shows it after a pause that is no longer than what went
    /// before; one on the wall goes on from test to test, and shows it where the rows follow as they did.
    fn goes_on_to(self, next: f64) -> bool {
        /// How many times the step before.
        const LONGEST: f64 = 3.0;
        let lasted = self.last - self.first;
        let counts_from_start = self.first.abs() <= lasted;
        let longest = if counts_from_start { lasted } else { LONGEST * lasted / self.rows as f64 };
        self.last < next && next - self.last <= longest
    }
}

/// Whether a table has the columns of the one above, and no line above its rows but those that stand above the rows there, with other times and counts.
fn continues(text: &str, above: &Section, section: &Section) -> bool {
    let named = |layout: &Layout| -> Vec<_> {
        let label = |column: &ColumnInfo| (column.name.clone(), column.unit.clone());
        layout.columns.iter().map(label).collect()
    };
    let known: Vec<&str> = above.names(text).into_iter().map(str::trim).collect();
    let is_known = |line: &str| line.trim().is_empty() || known.iter().any(|known| is_as(known, line));
    above.title.is_none()
        && section.title.is_none()
        && section.layout.header_line.is_some()
        && above.layout.decimal == section.layout.decimal
        && named(&above.layout) == named(&section.layout)
        && section.names(text).into_iter().all(is_known)
}

/// Whether two lines say the same, but for times and counts: `Time: 62.600 Sec`, `Cycle 3`. Any other number may be that of another specimen.
fn is_as(known: &str, line: &str) -> bool {
    let (known, line) = (parts(known), parts(line));
    let may_differ = |index: usize| {
        let behind = line[..index].iter().rposition(|part| !is_number(part)).map_or(0, |last| last + 1);
        let name = line[..behind].iter().rposition(|part| is_number(part)).map_or(0, |last| last + 1);
        is_number(known[index]) && is_number(line[index]) && counts_on(&line[name..behind].join(" "))
    };
    known.len() == line.len() && (0..line.len()).all(|index| known[index] == line[index] || may_differ(index))
}

/// The words and numbers of a line.
fn parts(line: &str) -> Vec<&str> {
    let is_gap = |letter: char| letter.is_whitespace() || ",;|:=\"'()[]".contains(letter);
    line.split(is_gap).filter(|part| !part.is_empty()).collect()
}

/// Whether a part of a line is a number or a date, and no name that ends on a number.
fn is_number(part: &str) -> bool {
    part.contains(|letter: char| letter.is_ascii_digit())
        && part.chars().all(|letter| letter.is_ascii_digit() || ".-+/".contains(letter))
}

/// Whether the number behind a name changes in the course of one test.
fn counts_on(name: &str) -> bool {
    let of = words(name);
    let counted = of.iter().rfind(|word| !is_listed(word, NUMBERS));
    recognise::named_plainly(name, Quantity::Time)
        || counted.is_some_and(|word| is_listed(word, WITHIN_A_TEST) || is_listed(word, OF_A_PART))
}

/// The clock of a table of two rows or more.
fn span(text: &str, path: &Path, section: &Section) -> Option<Span> {
    let time = candidates(&section.layout.columns, Quantity::Time).first()?.number;
    let plan = RowPlan::new(path, &section.layout, &[time]).ok()?;
    let mut read = [0.0];
    let own = section.text(text);
    let rows = lines::of_text(&own).into_iter().skip(section.layout.first_data_line - 1);
    let times: Vec<f64> =
        rows.filter_map(|line| plan.read(line.as_bytes(), &mut read).ok().map(|()| read[0])).collect();
    match times[..] {
        [first, .., last] => Some(Span {
            first,
            last,
            rows: times.len(),
        }),
        _ => None,
    }
}
