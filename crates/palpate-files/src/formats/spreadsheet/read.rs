//! Reading chosen columns of a table.

use std::ops::ControlFlow;

use super::{
    book::Visitor,
    cell::{Value, letters},
    table::Table,
};
use crate::{
    cell::{DecimalMark, number},
    error::{FileError, FileProblem, shorten},
    input::Input,
    table::{Columns, Doubt, Heard, Suspect},
};

/// How many rows go by between two reports of progress.
const ROWS_A_REPORT: usize = 4096;

/// How many rows without any number are named.
const NAMED: usize = 3;

/// What visits the cells of a table, perhaps with others around it.
type Visit<'a> = dyn Fn(&mut Visitor<'_>) -> Result<(), FileError> + 'a;

/// Reads columns (numbers from 1) of a table in a sheet of this name, in a workbook that counts day 0 so many days before 1970.
pub(super) fn read(
    input: &Input,
    (name, table, days_to_epoch): (&str, &Table, f64),
    visit: &Visit<'_>,
    columns: &[usize],
    progress: &mut Heard<'_>,
) -> Result<Columns, FileError> {
    let mut reading = Reading {
        input,
        name,
        table,
        chosen: columns.iter().map(|column| column - 1).collect(),
        days_to_epoch,
        row: vec![None; table.places.len()],
        number: None,
        out: vec![0.0; columns.len()],
        read: Columns::of(columns.len()),
        last: None,
        suspect: None,
    };
    let (mut ends, mut stretch) = ((0, 0), 0);
    visit(&mut |cell, done, total| {
        while table.rows.get(stretch).is_some_and(|rows| rows.end <= cell.row) {
            stretch += 1;
        }
        let Some(rows) = table.rows.get(stretch) else {
            return Ok(ControlFlow::Break(()));
        };
        if cell.row < rows.start {
            return Ok(ControlFlow::Continue(()));
        }
        if let Ok(place) = table.places.binary_search(&cell.column) {
            if reading.number.is_some_and(|number| number != cell.row) {
                reading.end_row()?;
                if reading.read.rows().is_multiple_of(ROWS_A_REPORT) {
                    progress(done.min(total), total)?;
                }
            }
            reading.number = Some(cell.row);
            reading.row[place] = Some(cell.value);
        }
        ends = (total, total);
        Ok(ControlFlow::Continue(()))
    })?;
    reading.end_row()?;
    progress(ends.0, ends.1)?;
    let Reading { read, suspect, .. } = reading;
    read.ended(suspect, || input.wrong(FileProblem::NoParts(vec![(name.to_owned(), "no rows".to_owned())])))
}

/// What has been read, and the row that is being read.
struct Reading<'a> {
    input: &'a Input,
    name: &'a str,
    table: &'a Table,
    /// Indices of the chosen columns in the table.
    chosen: Vec<usize>,
    days_to_epoch: f64,
    row: Vec<Option<Value>>,
    number: Option<u32>,
    out: Vec<f64>,
    read: Columns,
    /// The last row of data.
    last: Option<u32>,
    /// Rows that may turn out to be remarks below the table.
    suspect: Option<Suspect>,
}

impl Reading<'_> {
    fn end_row(&mut self) -> Result<(), FileError> {
        let Some(number) = self.number.take() else {
            return Ok(());
        };
        if self.chosen.iter().all(|column| self.row[*column].is_none()) && self.suspect.is_none() {
            // A point without a measurement, of which no number is lost.
            let lacking = &mut self.read.ignored.lacking;
            lacking.rows += 1;
            if lacking.lines.len() < NAMED {
                lacking.lines.push(number as usize + 1);
            }
            self.last = self.last.map(|_| number);
            self.row.fill(None);
            return Ok(());
        }
        let mut fault = None;
        for (place, &column) in self.chosen.iter().enumerate() {
            match self.value(column, number) {
                Ok(value) => self.out[place] = value,
                Err(error) => {
                    fault = Some(error);
                    break;
                }
            }
        }
        let leading = self.row[self.table.leading].as_ref();
        let is_data = leading.is_some_and(|value| value.class().is_numeric());
        let sample = self.row.iter().flatten().next().map_or_else(String::new, |value| shorten(&value.text()));
        self.row.fill(None);
        match fault {
            None => self.push(number),
            Some(error) if is_data => Err(error),
            Some(error) => {
                let before = self.suspect.take();
                self.suspect = Some(Suspect::with(before, number as usize + 1, || (sample, error))?);
                Ok(())
            }
        }
    }

    fn push(&mut self, number: u32) -> Result<(), FileError> {
        if let Some(suspect) = self.suspect.take() {
            return Err(suspect.interrupted(&self.input.name, number as usize + 1));
        }
        let follows = |last: &u32| self.table.stretch(*last) == self.table.stretch(number);
        let gap = self.last.filter(follows).map_or(0, |last| number - last - 1);
        self.read.ignored.blank += gap as usize;
        self.last = Some(number);
        self.read.push(&self.out, number as usize + 1);
        Ok(())
    }

    /// The number in a column of the row.
    fn value(&self, column: usize, row: u32) -> Result<f64, FileError> {
        let place = self.table.places[column];
        let wrong = |expected: &str, found: &str, hint: &'static str| {
            let cell = format!("sheet {}, cell {}{}", self.name, letters(place), u64::from(row) + 1);
            self.input.wrong(FileProblem::bad_cell(&cell, expected, found, hint))
        };
        const MEND: &str = "repair or clear the row, or choose another column";
        let quoted = |text: &str| format!("`{}`", shorten(text));
        match &self.row[column] {
            // A number that a spreadsheet took for a date, 12.3 for the 12th of March, is lost.
            Some(Value::Moment(_) | Value::Duration(_)) if !self.table.moments[column] => Err(wrong(
                "a number",
                "a date or a time of day",
                "write the number again, in a cell formatted as a number",
            )),
            Some(Value::Number(number)) => Ok(*number),
            Some(Value::Duration(days)) => Ok(days * 86_400.0),
            Some(Value::Moment(days)) if self.table.dated[column] => Ok((days - self.days_to_epoch) * 86_400.0),
            Some(Value::Moment(days)) => Ok(days * 86_400.0),
            Some(Value::Text(text)) => {
                match (&self.table.decimal, number::parse(text.trim().as_bytes(), DecimalMark::Point)) {
                    // Whole numbers are the same under both marks.
                    (Err(_), Some(number)) if !text.contains('.') => Ok(number),
                    (Err(Doubt { doubt, .. }), _) => Err(wrong(
                        "a number with one clear decimal mark",
                        &format!("{} ({doubt})", quoted(text)),
                        "fix the decimal mark in a test description, or make the texts numbers",
                    )),
                    (Ok(mark), _) => number::parse(text.trim().as_bytes(), *mark)
                        .ok_or_else(|| wrong(&format!("a number with a decimal {mark}"), &quoted(text), MEND)),
                }
            }
            Some(Value::Fault(fault)) => Err(wrong("a number", fault, MEND)),
            Some(Value::Truth(truth)) => Err(wrong("a number", if *truth { "TRUE" } else { "FALSE" }, MEND)),
            None => Err(wrong("a number", "an empty cell", MEND)),
        }
    }
}
