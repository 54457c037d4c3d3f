//! Streaming chosen columns out of a file.

use super::{
    row::RowPlan,
    rows_ahead::{RowsAhead, Stop},
};
use crate::{
    cell::{DecimalMark, Delimiter},
    error::{DecimalDoubt, FileError, FileProblem},
    input::{Idle, Input, LineReader},
    table::{Columns, Heard, Lacking, Layout, Suspect, decimal},
};

/// How many blocks may hold something else than rows of plain numbers before blocks are no longer tried.
const TRIES: usize = 3;

/// Reads the chosen columns (numbers from 1, in any order) of a file laid out as `layout` says.
///
/// The file is streamed: memory is 8 bytes for each cell of the chosen columns and a few megabytes besides, and
/// no more than [`MOST_ROWS`](crate::table::MOST_ROWS) rows are kept: of a longer file successive rows are averaged. `progress` is given the bytes done and the bytes there are,
/// once for every quarter of a mebibyte or so for each processor and once at the end.
///
/// Blank lines and comments (`#`, `%`, `//`) are passed over and counted. Lines at the very end that do not start like data are
/// passed over as a footer, up to 50 of them. Rows in which a cell is empty or says that there is no number (`n/a`, `NaN`, `-`)
/// are left out and counted where they are at most 3 % of all, and so are rows that hold nothing in any chosen column, however many. Every other line must be a full row. Of a packed file, blank lines, comments and those that
/// are left out have a limit ([`FileProblem::Idle`]).
///
/// # Errors
///
/// Where the file cannot be read, a column does not exist, or a row is faulty: the first fault is reported with
/// its line and column. A file without any row gives [`FileProblem::NoDataRows`].
pub fn read_columns(
    input: &Input,
    layout: &Layout,
    columns: &[usize],
    progress: &mut Heard<'_>,
) -> Result<Columns, FileError> {
    let path = &input.name;
    let mut distinct = columns.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    let plan = RowPlan::new(path, layout, &distinct)?;
    let mut reader = LineReader::open(input, layout.encoding)?;
    let mut read = Columns::of(distinct.len());
    let mut row = vec![0.0; distinct.len()];
    let mut suspect: Option<Suspect> = None;
    let mut lacking = Lacking::default();
    let mut idle = Idle::of(input);
    let (mut reported, mut reserved) = (0, false);
    let mut blocks = RowsAhead::new(distinct.len());
    let mut tries = if plan.may_be_plain() && !distinct.is_empty() { TRIES } else { 0 };
    let mut by_lines_until = layout.first_data_line;
    loop {
        let (done, total) = reader.progress();
        let number = reader.line() + 1;
        if done != reported && number > 1 {
            progress(done, total)?;
            if reported > 0 && !reserved {
                // The rows so far came from the pieces before this one.
                read.reserve(reported, total);
                reserved = true;
            }
            reported = done;
        }
        if tries > 0 && number >= by_lines_until && suspect.is_none() {
            match blocks.read(&mut reader, &plan, &mut read, progress)? {
                Stop::End => tries = 0,
                Stop::Odd(lines) => (tries, by_lines_until) = (tries - 1, reader.line() + 1 + lines),
            }
            reserved |= read.rows() > 0;
            continue;
        }
        let Some(line) = reader.next_line()? else {
            break;
        };
        if number < layout.first_data_line {
            continue;
        }
        match plan.read(line, &mut row) {
            Ok(()) => {
                if let Some(suspect) = suspect {
                    return Err(suspect.interrupted(path, number));
                }
                read.push(&row, number);
            }
            Err(_) if is_blank(line, layout.delimiter) => {
                read.ignored.blank += 1;
                idle.pass(line.len(), number, read.rows())?;
            }
            Err(fault) if suspect.is_none() && plan.lacks_numbers(line) => {
                lacking.leave_out(number, plan.without_number(line), || plan.error(fault, line, number));
                idle.pass(line.len(), number, read.rows())?;
            }
            Err(_) if suspect.is_none() && plan.holds_nothing(line) => {
                lacking.leave_out_bare(number);
                idle.pass(line.len(), number, read.rows())?;
            }
            Err(_) if suspect.is_none() && plan.is_comment(line) => {
                read.ignored.comments += 1;
                idle.pass(line.len(), number, read.rows())?;
            }
            Err(fault) if plan.is_data(line) => return Err(plan.error(fault, line, number)),
            Err(fault) => {
                let fault = || (plan.text(line), plan.error(fault, line, number));
                suspect = Some(Suspect::with(suspect, number, fault)?);
            }
        }
    }
    let (done, total) = reader.progress();
    progress(done, total)?;
    read.bytes = total;
    let lines = reader.line();
    let read = read.ended(suspect, || {
        input.wrong(FileProblem::NoDataRows {
            lines,
            header_line: None,
        })
    });
    let mut read = lacking.noted(read?, |column, lacking, rows| plan.many_lacking(column, lacking, rows))?;
    if layout.undecided && layout.decimal == DecimalMark::Point && read.averaged == 1 {
        refuse_thousands(input, &read)?;
    }
    if distinct != columns {
        read.values = arranged(read.values, &distinct, columns);
    }
    Ok(read)
}

/// Whether a line holds nothing but blanks and marks between cells: what spreadsheets leave below a table.
fn is_blank(line: &[u8], delimiter: Delimiter) -> bool {
    line.iter().all(|byte| byte.is_ascii_whitespace() || Some(*byte) == delimiter.byte())
}

/// An error where points that come late set off thousands.
fn refuse_thousands(input: &Input, read: &Columns) -> Result<(), FileError> {
    let late = read.values.iter().find_map(|values| Some((values, decimal::falls_to_a_thousandth(values)?)));
    match late {
        Some((values, row)) => Err(input.wrong(FileProblem::AmbiguousDecimal {
            line: read.line_of(row).unwrap_or(row + 1),
            found: format!("{:.3}` after `{}", values[row], values[row - 1]),
            doubt: DecimalDoubt::PointThousands,
        })),
        None => Ok(()),
    }
}

/// Puts the columns read into the order they were chosen in, and copies those chosen more than once.
fn arranged(values: Vec<Vec<f64>>, read: &[usize], chosen: &[usize]) -> Vec<Vec<f64>> {
    let mut left: Vec<Option<Vec<f64>>> = values.into_iter().map(Some).collect();
    let mut arranged: Vec<Vec<f64>> = Vec::with_capacity(chosen.len());
    for (place, column) in chosen.iter().enumerate() {
        let taken = read.binary_search(column).ok().and_then(|index| left[index].take());
        let values = taken.unwrap_or_else(|| {
            let before = chosen[..place].iter().position(|other| other == column);
            before.map_or_else(Vec::new, |index| arranged[index].clone())
        });
        arranged.push(values);
    }
    arranged
}
