//! The cells of one sheet.

use std::ops::ControlFlow;

use quick_xml::events::BytesStart;

use super::{
    super::{
        book::Visitor,
        cell::{Cell, MOST_COLUMNS, MOST_ROWS, NumberFormat, Value, letters, reference},
        moment,
        strings::Strings,
    },
    package::{MOST_OF_SHEET, Package, Step, attribute},
};
use crate::error::FileError;

/// What the other parts of the workbook say.
#[derive(Debug)]
pub(super) struct Known<'a> {
    pub(super) strings: &'a Strings,
    pub(super) styles: &'a [NumberFormat],
    pub(super) days_to_epoch: f64,
}

/// Where the reader of a sheet is.
#[derive(Debug, Default)]
struct State {
    row: u32,
    column: u32,
    /// Inside of a cell.
    in_cell: bool,
    /// Inside of an element that holds its value.
    in_value: bool,
    phonetic: bool,
    style: NumberFormat,
    kind: String,
    text: String,
    last: Option<(u32, u32)>,
}

/// Visits the cells of the sheet whose part is at `path`.
pub(super) fn visit(
    package: &Package,
    name: &str,
    path: &str,
    known: &Known<'_>,
    each: &mut Visitor<'_>,
) -> Result<(), FileError> {
    let mut state = State::default();
    package.read(path, MOST_OF_SHEET, &mut |step, done, total| {
        match step {
            Step::Begin(element) => state.begin(package, name, element, known.styles)?,
            Step::Text(text) if state.in_value && !state.phonetic => state.text.push_str(text),
            Step::Text(_) => {}
            Step::End("v" | "t") => state.in_value = false,
            Step::End("rPh") => state.phonetic = false,
            Step::End("row") => {
                state.row += 1;
                state.column = 0;
            }
            Step::End("c") if state.in_cell => {
                if let Some(cell) = state.end_cell(package, name, known)?
                    && each(cell, done, total)? == ControlFlow::Break(())
                {
                    return Ok(false);
                }
            }
            Step::End("sheetData" | "worksheet") => return Ok(false),
            Step::End(_) => {}
        }
        Ok(true)
    })
}

impl State {
    fn begin(
        &mut self,
        package: &Package,
        sheet: &str,
        element: &BytesStart<'_>,
        styles: &[NumberFormat],
    ) -> Result<(), FileError> {
        match element.local_name().as_ref() {
            "row" => {
                if let Some(row) = attribute(element, "r") {
                    let number = row.parse::<u32>().ok().filter(|number| (1..=MOST_ROWS).contains(number));
                    let Some(number) = number else {
                        return Err(package.damaged(&format!("sheet {sheet}"), "the number of a row", &row));
                    };
                    self.row = number - 1;
                }
                self.column = 0;
            }
            "c" => {
                let (mut place, mut style) = (None, 0);
                self.kind.clear();
                for attribute in element.attributes().with_checks(false).flatten() {
                    match attribute.key.local_name().as_ref() {
                        "r" => place = Some(attribute.value.into_owned()),
                        "s" => style = attribute.value.parse().unwrap_or(0),
                        "t" => self.kind.push_str(&attribute.value),
                        _ => {}
                    }
                }
                if let Some(text) = place {
                    let Some((row, column)) = reference(&text) else {
                        return Err(package.damaged(&format!("sheet {sheet}"), "the place of a cell", &text));
                    };
                    (self.row, self.column) = (row, column);
                }
                self.style = styles.get(style).copied().unwrap_or_default();
                self.text.clear();
                self.in_cell = true;
            }
            "v" if self.in_cell => self.in_value = self.kind != "inlineStr",
            "t" if self.in_cell => self.in_value = self.kind == "inlineStr",
            "rPh" => self.phonetic = true,
            _ => {}
        }
        Ok(())
    }

    /// The cell that ends, if it holds anything.
    fn end_cell(&mut self, package: &Package, sheet: &str, known: &Known<'_>) -> Result<Option<Cell>, FileError> {
        let (row, column) = (self.row, self.column);
        (self.in_cell, self.in_value) = (false, false);
        self.column += 1;
        let wrong = |expected: &str, found: &str| {
            let place = format!("sheet {sheet}, cell {}{}", letters(column), u64::from(row) + 1);
            package.damaged(&place, expected, found)
        };
        if row >= MOST_ROWS || column >= MOST_COLUMNS || self.last.is_some_and(|last| last >= (row, column)) {
            return Err(wrong("cells row by row inside of a sheet", "a cell out of order"));
        }
        self.last = Some((row, column));
        let text = self.text.as_str();
        if text.is_empty() {
            return Ok(None);
        }
        let value = match self.kind.as_str() {
            "s" => {
                let number = text.trim().parse().ok();
                let shared = number.and_then(|number| known.strings.get(number));
                Value::Text(shared.ok_or_else(|| wrong("the number of a shared text", text))?.to_owned())
            }
            "str" | "inlineStr" => Value::Text(text.to_owned()),
            "b" => Value::Truth(matches!(text.trim(), "1" | "true")),
            "e" => Value::Fault(text.to_owned()),
            "d" => moment::of_iso(text)
                .map_or_else(|| Value::Text(text.to_owned()), |days| Value::Moment(days + known.days_to_epoch)),
            _ => match text.trim().parse::<f64>() {
                Ok(number) if number.is_finite() => Value::formatted(number, self.style),
                _ => return Err(wrong("a number", text)),
            },
        };
        let blank = matches!(&value, Value::Text(text) if text.trim().is_empty());
        Ok((!blank).then_some(Cell { row, column, value }))
    }
}
