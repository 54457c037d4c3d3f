//! Reading the chosen cells of one row, and saying what is wrong where that fails.

use std::path::Path;

use crate::{
    cell::{Cell, Fields, date, number},
    error::{CellPosition, FileError, FileProblem, shorten},
    naming::{names_statistic, words},
    table::{ColumnKind, LackingRows, Layout, block, metadata::is_comment},
};

/// How to read the rows of one file.
pub(crate) struct RowPlan<'a> {
    path: &'a Path,
    layout: &'a Layout,
    /// What to do with the cell of each column.
    tasks: Vec<Task>,
    /// Fewest cells a row must have.
    fewest: usize,
    /// Index of the first column of numbers, which tells rows of data from other lines.
    leading: usize,
    /// The delimiter, where rows can be read in one pass.
    plain: Option<u8>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    /// Pass over it.
    Pass,
    /// See that it could be a number: a line with a word in the leading column is no row of data.
    Check,
    /// Read it into this place of the output.
    Read(usize),
    /// Read a date with its time of day, or a time of day alone, into this place.
    ReadDate(usize),
    /// Add a date to the time of day in this place.
    AddDay(usize),
}

/// What is wrong with a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// A cell, by index, holds no number.
    Cell(usize),
    /// There are too few cells; so many were found.
    TooFew(usize),
    /// There are cells beyond the last column.
    TooMany,
}

impl<'a> RowPlan<'a> {
    /// Plans to read `columns` (numbers from 1, each once) of every row.
    pub(crate) fn new(path: &'a Path, layout: &'a Layout, columns: &[usize]) -> Result<Self, FileError> {
        let kinds: Vec<ColumnKind> = layout.columns.iter().map(|column| column.kind).collect();
        let mut tasks = vec![Task::Pass; kinds.len()];
        let leading = block::first_number(&kinds).unwrap_or(0);
        if let Some(task) = tasks.get_mut(leading) {
            *task = Task::Check;
        }
        for (place, &column) in columns.iter().enumerate() {
            let task = column.checked_sub(1).and_then(|index| tasks.get_mut(index));
            let Some(task) = task else {
                let columns = kinds.len();
                return Err(FileError::of(path, FileProblem::NoSuchColumn { column, columns }));
            };
            let is_date = kinds.get(column - 1) == Some(&ColumnKind::DateTime);
            *task = if is_date { Task::ReadDate(place) } else { Task::Read(place) };
        }
        let dated = layout.day.and_then(|day| Some((day, columns.iter().position(|column| *column == day.time)?)));
        if let Some((day, place)) = dated
            && let Some(task) = tasks.get_mut(day.date - 1)
        {
            *task = Task::AddDay(place);
        }
        // Remarks at the end of a row may be left out; numbers may not.
        let last_number = kinds.iter().rposition(|&kind| kind == ColumnKind::Number);
        let last_read = columns.iter().copied().chain(dated.map(|(day, _)| day.date)).max().unwrap_or(0);
        Ok(Self {
            path,
            layout,
            tasks,
            fewest: last_read.max(last_number.map_or(0, |index| index + 1)),
            leading,
            plain: layout.delimiter.byte().filter(|delimiter| *delimiter != layout.decimal.byte()),
        })
    }

    /// Whether rows can be rows of plain numbers.
    pub(super) fn may_be_plain(&self) -> bool {
        self.plain.is_some() && !self.tasks.iter().any(|task| matches!(task, Task::ReadDate(_) | Task::AddDay(_)))
    }

    /// Reads the row of plain numbers that some bytes begin with in one pass over it, up to its LF or to their end. How many
    /// bytes it has, its end included; `None` is no verdict.
    #[inline]
    pub(super) fn read_plain(&self, bytes: &[u8], row: &mut [f64]) -> Option<usize> {
        let delimiter = self.plain?;
        let mut at = 0;
        for (count, task) in self.tasks.iter().enumerate() {
            while bytes.get(at) == Some(&b' ') {
                at += 1;
            }
            let rest = &bytes[at..];
            at += match task {
                Task::Read(place) => {
                    let (value, end) = number::leading(rest, self.layout.decimal)?;
                    row[*place] = value;
                    end
                }
                Task::Pass if rest.first() != Some(&b'"') => cell_end(rest, delimiter),
                Task::Check if rest.first().is_some_and(u8::is_ascii_digit) => cell_end(rest, delimiter),
                _ => return None,
            };
            let is_last = count + 1 == self.tasks.len();
            match bytes.get(at..).unwrap_or_default() {
                [byte, ..] if *byte == delimiter && !is_last => at += 1,
                [] if is_last => return Some(at),
                [b'\n', ..] if is_last => return Some(at + 1),
                [b'\r', b'\n', ..] if is_last => return Some(at + 2),
                _ => return None,
            }
        }
        None
    }

    /// Reads the chosen cells of a line into `row`, which has one place for each.
    #[inline]
    pub(crate) fn read(&self, line: &[u8], row: &mut [f64]) -> Result<(), Fault> {
        match self.read_plain(line, row) {
            Some(_) => Ok(()),
            None => self.read_any(line, row),
        }
    }

    fn read_any(&self, line: &[u8], row: &mut [f64]) -> Result<(), Fault> {
        let (mut count, mut day) = (0, None);
        for cell in Fields::of(line, self.layout.delimiter) {
            match self.tasks.get(count) {
                Some(&Task::AddDay(place)) => match date::day(cell) {
                    Some(seconds) => day = Some((place, seconds)),
                    None => return Err(Fault::Cell(count)),
                },
                Some(&Task::Read(place)) => match self.number(cell, count) {
                    Some(value) => row[place] = value,
                    None => return Err(Fault::Cell(count)),
                },
                Some(&Task::ReadDate(place)) => match date::parse(cell) {
                    Some(value) => row[place] = value,
                    None => return Err(Fault::Cell(count)),
                },
                Some(Task::Pass) => {}
                Some(Task::Check) => {
                    let digit = cell.first().is_some_and(u8::is_ascii_digit);
                    if !digit && number::classify(cell) == Cell::Text {
                        return Err(Fault::Cell(count));
                    }
                }
                None if cell.is_empty() => {}
                None => return Err(Fault::TooMany),
            }
            count += 1;
        }
        if count < self.fewest {
            return Err(Fault::TooFew(count));
        }
        if let Some((place, seconds)) = day {
            row[place] += seconds;
        }
        Ok(())
    }

    /// The number in a cell of the column with an index.
    fn number(&self, cell: &[u8], column: usize) -> Option<f64> {
        let decimal = self.layout.decimal;
        let has_thousands = self.layout.thousands.get(column) == Some(&true);
        number::parse(cell, decimal).or_else(|| has_thousands.then(|| number::grouped(cell, decimal, true))?)
    }

    /// Whether a faulty line is a row of data all the same: by its cell in the leading column of numbers, or where most of its cells are
    /// numbers and none is missing. Statistics of the columns (`Max,12.3,4.5`) are none.
    pub(crate) fn is_data(&self, line: &[u8]) -> bool {
        let label = Fields::of(line, self.layout.delimiter).find(|cell| !cell.is_empty());
        if label.is_some_and(|cell| names_statistic(&words(&self.text(cell)))) {
            return false;
        }
        let (mut cells, mut numbers, mut leads) = (0, 0, false);
        for cell in Fields::of(line, self.layout.delimiter) {
            let is_number = number::classify(cell).is_numeric();
            leads |= is_number && cells == self.leading;
            numbers += usize::from(is_number);
            cells += 1;
        }
        leads || (cells >= self.fewest && 2 * numbers > cells)
    }

    /// Whether a faulty line is a full row but for cells that are empty or say that there is no number.
    pub(crate) fn lacks_numbers(&self, line: &[u8]) -> bool {
        let (mut count, mut held) = (0, 0);
        for cell in Fields::of(line, self.layout.delimiter) {
            let holds = match self.tasks.get(count) {
                Some(Task::Check) => number::classify(cell).is_numeric(),
                Some(Task::Pass) => {
                    count += 1;
                    continue;
                }
                Some(_) => self.holds_number(cell, count),
                None => return false,
            };
            if !holds && !number::is_absent(cell) {
                return false;
            }
            held += usize::from(holds);
            count += 1;
        }
        held > 0 && count >= self.fewest
    }

    /// Whether a faulty line is a comment: no row of this file begins with a text.
    pub(crate) fn is_comment(&self, line: &[u8]) -> bool {
        let first = self.layout.columns.first().map(|column| column.kind);
        first != Some(ColumnKind::Text) && is_comment(line)
    }

    /// Indices of the cells of a line that are to be read and hold no number.
    pub(crate) fn without_number<'l>(&'l self, line: &'l [u8]) -> impl Iterator<Item = usize> + 'l {
        Fields::of(line, self.layout.delimiter)
            .enumerate()
            .filter(|(index, cell)| !self.holds_number(cell, *index))
            .map(|(index, _)| index)
    }

    /// Whether a cell of the column with an index holds a number, if it is to be read as one.
    fn holds_number(&self, cell: &[u8], column: usize) -> bool {
        match self.tasks.get(column) {
            Some(Task::Read(_)) => self.number(cell, column).is_some(),
            Some(Task::ReadDate(_)) => date::parse(cell).is_some(),
            Some(Task::AddDay(_)) => date::day(cell).is_some(),
            _ => true,
        }
    }

    /// The error for many cells of a column, by its index, without a number, of so many rows.
    #[cold]
    pub(crate) fn many_lacking(&self, column: usize, lacking: LackingRows, rows: usize) -> FileError {
        let place = self.place(column, lacking.lines.first().copied().unwrap_or_default());
        let (lacking, lines) = (lacking.rows, lacking.lines);
        FileError::of(
            self.path,
            FileProblem::ManyLacking {
                place,
                lacking,
                rows,
                lines,
            },
        )
    }

    fn place(&self, index: usize, line: usize) -> CellPosition {
        CellPosition {
            line,
            column: index + 1,
            name: self.layout.columns.get(index).and_then(|column| column.name.clone()),
        }
    }

    /// Whether a faulty line is a full row whose chosen cells are all empty.
    pub(crate) fn holds_nothing(&self, line: &[u8]) -> bool {
        let mut count = 0;
        for cell in Fields::of(line, self.layout.delimiter) {
            let is_chosen = matches!(self.tasks.get(count), Some(Task::Read(_) | Task::ReadDate(_)));
            if is_chosen && !cell.is_empty() {
                return false;
            }
            count += 1;
        }
        count >= self.fewest && self.layout.delimiter.byte().is_some()
    }

    /// The error for a fault of `line`, which is line `number` of the file.
    #[cold]
    pub(crate) fn error(&self, fault: Fault, line: &[u8], number: usize) -> FileError {
        let problem = match fault {
            Fault::TooFew(found) => FileProblem::CellCount {
                line: number,
                expected: self.fewest,
                found,
            },
            Fault::TooMany => FileProblem::CellCount {
                line: number,
                expected: self.tasks.len(),
                found: Fields::of(line, self.layout.delimiter).count(),
            },
            Fault::Cell(index) => self.bad_cell(index, line, number),
        };
        FileError::of(self.path, problem)
    }

    fn bad_cell(&self, index: usize, line: &[u8], number: usize) -> FileProblem {
        let place = self.place(index, number);
        let cell = Fields::of(line, self.layout.delimiter).nth(index);
        let cell = cell.unwrap_or_default();
        let found = self.text(cell);
        let kind = self.layout.columns.get(index).map(|column| column.kind);
        let is_day = matches!(self.tasks.get(index), Some(Task::AddDay(_)));
        if (is_day || kind == Some(ColumnKind::DateTime)) && !cell.is_empty() {
            let place = format!("line {number}, column {}", index + 1);
            let expected =
                if is_day { "a date such as 2024-08-24" } else { "a date and time such as 2024-08-24T21:09:40.123" };
            return FileProblem::damaged(place, expected, format!("`{found}`"));
        }
        match number::classify(cell) {
            Cell::Empty => FileProblem::EmptyCell(place),
            Cell::NotFinite => FileProblem::NotFinite { place, found },
            _ => FileProblem::TextInNumbers {
                place,
                found,
                decimal: self.layout.decimal,
            },
        }
    }

    /// Bytes of the file as shortened text for a message.
    pub(crate) fn text(&self, bytes: &[u8]) -> String {
        let encoding = self.layout.encoding;
        if encoding.splits_like_ascii() {
            let (text, _) = encoding.codec().decode_without_bom_handling(bytes);
            shorten(&text)
        } else {
            // Such a file was decoded as a whole before it was split.
            shorten(&String::from_utf8_lossy(bytes))
        }
    }
}

/// Where a cell ends that is passed over.
fn cell_end(rest: &[u8], delimiter: u8) -> usize {
    rest.iter().position(|byte| *byte == delimiter || *byte == b'\n').unwrap_or(rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::{DecimalMark, Delimiter};
    use crate::input::Encoding;
    use crate::table::ColumnInfo;

    /// Whatever a row is like: what is read in one pass is what the general way reads, to the last bit.
    #[test]
    fn rows_read_in_one_pass_are_the_same() {
        const CELLS: [&str; 24] = [
            "0",
            "1.5",
            "-0.25",
            "+2",
            "1e5",
            ".5",
            "5.",
            ".",
            "-",
            "",
            " 7",
            "7 ",
            "\"8\"",
            "\"9",
            "1,5",
            "-0",
            "1.2.3",
            "123456789012345678",
            "1234567890123456789",
            "9007199254740993",
            "x",
            "NaN",
            "\t3",
            "0.000000000000000001",
        ];
        let kinds = [ColumnKind::Number, ColumnKind::Text, ColumnKind::Number];
        for (delimiter, mark) in [
            (Delimiter::Comma, DecimalMark::Point),
            (Delimiter::Semicolon, DecimalMark::Comma),
            (Delimiter::Tab, DecimalMark::Point),
            (Delimiter::Comma, DecimalMark::Comma),
        ] {
            for columns in [vec![1, 3], vec![3]] {
                let column = |(index, kind): (usize, &ColumnKind)| ColumnInfo {
                    number: index + 1,
                    name: None,
                    unit: None,
                    kind: *kind,
                    sample: String::new(),
                };
                let layout = Layout {
                    undecided: false,
                    thousands: Vec::new(),
                    day: None,
                    encoding: Encoding::Utf8,
                    delimiter,
                    decimal: mark,
                    header_line: None,
                    units_line: None,
                    first_data_line: 1,
                    metadata: Vec::new(),
                    columns: kinds.iter().enumerate().map(column).collect(),
                };
                let plan = RowPlan::new(Path::new("x.csv"), &layout, &columns).expect("a plan");
                let byte = char::from(delimiter.byte().expect("a byte"));
                let mut in_one_pass = 0;
                for (first, second, third) in triples(&CELLS) {
                    for end in ["", &byte.to_string(), " "] {
                        let line = format!("{first}{byte}{second}{byte}{third}{end}");
                        let (mut plain, mut any) = (vec![0.5; columns.len()], vec![0.5; columns.len()]);
                        if plan.read_plain(line.as_bytes(), &mut plain).is_some() {
                            in_one_pass += 1;
                            assert_eq!(plan.read_any(line.as_bytes(), &mut any), Ok(()), "{line:?}");
                            let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                            assert_eq!(bits(&plain), bits(&any), "{line:?}");
                        }
                    }
                }
                assert_eq!(in_one_pass > 300, plan.plain.is_some(), "{delimiter} {mark}: {in_one_pass}");
            }
        }
    }

    fn triples<'a>(cells: &'a [&'a str]) -> impl Iterator<Item = (&'a str, &'a str, &'a str)> {
        let pairs = cells.iter().flat_map(|first| cells.iter().map(move |second| (*first, *second)));
        pairs.flat_map(|(first, second)| cells.iter().map(move |third| (first, second, *third)))
    }
}
