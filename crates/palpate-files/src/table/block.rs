//! Finding the block of data in the lines of a file, and the delimiter that makes it one.

use super::part::ColumnKind;
use crate::cell::{Cell, Delimiter, Fields, number};

/// Rows that share a number of cells and hold numbers in the same columns.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) delimiter: Delimiter,
    /// Index of its first line.
    pub(crate) first: usize,
    /// What each column holds.
    pub(crate) kinds: Vec<ColumnKind>,
    /// Cells of every line of the sample, split by the delimiter; none in a blank line.
    pub(crate) cells: Vec<Vec<Cell>>,
}

impl Block {
    /// The cells of every row that belongs to the block, with the index of its line.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (usize, &[Cell])> {
        let width = self.kinds.len();
        self.cells
            .iter()
            .enumerate()
            .skip(self.first)
            .filter(move |(_, cells)| cells.len() == width)
            .map(|(index, cells)| (index, cells.as_slice()))
    }
}

/// Index of the first column of numbers.
pub(crate) fn first_number(kinds: &[ColumnKind]) -> Option<usize> {
    kinds.iter().position(|&kind| kind == ColumnKind::Number)
}

/// The block of data under whichever of `delimiters` makes most of the lines from `skip` on.
pub(crate) fn find(lines: &[&str], skip: usize, delimiters: &[Delimiter]) -> Option<Block> {
    let runs = delimiters.iter().filter_map(|&delimiter| {
        let cells = classify(lines, skip, delimiter);
        Some((longest_run(&cells)?, cells, delimiter))
    });
    let runs: Vec<(Run, Vec<Vec<Cell>>, Delimiter)> = runs.collect();
    // The first of several with one score.
    let best =
        (0..runs.len()).reduce(|best, next| if runs[next].0.score > runs[best].0.score { next } else { best })?;
    let cuts_thousands = |(run, cells, delimiter): &(Run, Vec<Vec<Cell>>, Delimiter)| {
        let is_mark = matches!(delimiter, Delimiter::Tab | Delimiter::Semicolon);
        is_mark && run.last - run.first >= runs[best].0.last - runs[best].0.first && is_all_numbers(run, cells)
    };
    // Blanks set off thousands where another mark cuts the same lines into numbers alone.
    let marked = (0..runs.len()).find(|other| runs[best].2 == Delimiter::Blanks && cuts_thousands(&runs[*other]));
    runs.into_iter()
        .nth(marked.unwrap_or(best))
        .map(|(run, cells, delimiter)| of_run(run, cells, delimiter))
}

/// Whether the lines of a run have two cells or more, each a number.
fn is_all_numbers(run: &Run, cells: &[Vec<Cell>]) -> bool {
    run.width > 1 && cells[run.first..=run.last].iter().flatten().all(|cell| cell.is_numeric())
}

/// The block of data in rows of cells that are split already, as those of a sheet are.
pub(crate) fn of_rows(cells: Vec<Vec<Cell>>) -> Option<Block> {
    let run = longest_run(&cells)?;
    Some(of_run(run, cells, Delimiter::Tab))
}

fn of_run(run: Run, cells: Vec<Vec<Cell>>, delimiter: Delimiter) -> Block {
    let kinds = kinds(&cells[run.first..=run.last], run.width);
    let first = start(&cells, run.first, &kinds);
    Block {
        delimiter,
        first,
        kinds,
        cells,
    }
}

fn classify(lines: &[&str], skip: usize, delimiter: Delimiter) -> Vec<Vec<Cell>> {
    let cells = |(index, line): (usize, &&str)| {
        if index < skip || line.trim().is_empty() {
            return Vec::new();
        }
        Fields::of(line.as_bytes(), delimiter).map(number::classify).collect()
    };
    lines.iter().enumerate().map(cells).collect()
}

/// Lines in a row, blank ones aside, that could be rows of one table.
#[derive(Debug, Clone, Copy)]
struct Run {
    first: usize,
    last: usize,
    width: usize,
    /// Per line, the number of numbers times their share of the cells that hold anything. The share keeps a delimiter that
    /// occurs inside numbers ("0,1;0,2" split at commas) from winning by the number of pieces; empty cells, which blanks pass
    /// over, keep none from it.
    score: f64,
}

fn longest_run(cells: &[Vec<Cell>]) -> Option<Run> {
    let mut best: Option<Run> = None;
    let mut current: Option<Run> = None;
    for (index, row) in cells.iter().enumerate() {
        if row.is_empty() {
            continue;
        }
        let numbers = row.iter().filter(|cell| cell.is_numeric()).count();
        let filled = row.iter().filter(|cell| **cell != Cell::Empty).count();
        let points = (numbers * numbers) as f64 / filled.max(1) as f64;
        let shares_columns = |run: &Run| {
            let before = &cells[run.last];
            let mut pairs = before.iter().zip(row);
            pairs.any(|(above, here)| above.is_numeric() && here.is_numeric())
        };
        current = match current {
            _ if numbers == 0 => None,
            Some(run) if run.width == row.len() && shares_columns(&run) => Some(Run {
                last: index,
                score: run.score + points,
                ..run
            }),
            _ => Some(Run {
                first: index,
                last: index,
                width: row.len(),
                score: points,
            }),
        };
        if let Some(run) = current
            && best.is_none_or(|best| run.score > best.score)
        {
            best = Some(run);
        }
    }
    best
}

fn kinds(rows: &[Vec<Cell>], width: usize) -> Vec<ColumnKind> {
    let kind = |column: usize| {
        let cells = || rows.iter().filter_map(|row| row.get(column));
        let numbers = cells().filter(|cell| cell.is_numeric()).count();
        match (numbers, cells().filter(|cell| **cell == Cell::Text).count()) {
            (0, 0) => ColumnKind::Empty,
            (numbers, texts) if numbers > texts => ColumnKind::Number,
            _ => ColumnKind::Text,
        }
    };
    (0..width).map(kind).collect()
}

/// Index of the line the data starts on.
///
/// The run found may start too late, where a faulty row cut it in two, or too early, where lines of named
/// values go over into data. The data starts with the earliest line that has numbers in most of the columns of
/// numbers, or earlier if the lines right above have one in the first of these columns: such a line is
/// a faulty row, which must not pass for a header.
fn start(cells: &[Vec<Cell>], found: usize, kinds: &[ColumnKind]) -> usize {
    let fits = |row: &[Cell]| {
        let numbers = || kinds.iter().zip(row).filter(|(kind, _)| **kind == ColumnKind::Number);
        let held = numbers().filter(|(_, cell)| cell.is_numeric()).count();
        row.len() == kinds.len() && 2 * held > numbers().count()
    };
    let Some(leading) = first_number(kinds) else {
        return cells.iter().position(|row| fits(row)).unwrap_or(found);
    };
    // A line before the run that begins with a word names values: "Samples 3700 3700".
    let begins = |(index, row): (usize, &Vec<Cell>)| fits(row) && (index >= found || row[leading].is_numeric());
    let mut first = cells.iter().enumerate().position(begins).unwrap_or(found);
    for (index, row) in cells.iter().enumerate().take(first).rev() {
        if row.is_empty() {
            continue;
        }
        if row.len() != kinds.len() || !row[leading].is_numeric() {
            break;
        }
        first = index;
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &[&str]) -> Option<(Delimiter, usize, usize)> {
        find(text, 0, &Delimiter::ALL).map(|block| (block.delimiter, block.first, block.kinds.len()))
    }

    #[test]
    fn delimiters() {
        assert_eq!(found(&["1.5,2", "2.5,3"]), Some((Delimiter::Comma, 0, 2)));
        assert_eq!(found(&["1,5;2", "2,5;3"]), Some((Delimiter::Semicolon, 0, 2)));
        assert_eq!(found(&["1,5\t2", "2,5\t3"]), Some((Delimiter::Tab, 0, 2)));
        assert_eq!(found(&[" 1,5  2", " 2,5  3"]), Some((Delimiter::Blanks, 0, 2)));
        assert_eq!(found(&["1.5, 2", "2.5, 3"]), Some((Delimiter::Comma, 0, 2)));
        assert_eq!(found(&["time,force"]), None);
        // Thousands were cut at their blanks: forces of 1 N and "000".
        assert_eq!(found(&["0\t1 000\t0.1", "1\t1 280\t0.2"]), Some((Delimiter::Tab, 0, 3)));
        assert_eq!(found(&["0,5\t1 030", "1,5\t1 040"]), Some((Delimiter::Tab, 0, 2)));
        assert_eq!(found(&["0 \t100 20", "1 \t110 30"]), Some((Delimiter::Blanks, 0, 3)));
    }

    #[test]
    fn where_the_data_starts() {
        let named = ["Diameter,0.4", "Length,14", "0,1", "0.1,2", "0.2,3"];
        assert_eq!(found(&named), Some((Delimiter::Comma, 2, 2)));
        let labview = ["X\t1\t2", "Samples\t370\t370", "X0\tTime\tTime", "x\tu\tF", "0\t1\t2", "1\t2\t3", "2\t2\t2"];
        assert_eq!(found(&labview), Some((Delimiter::Tab, 4, 3)));
        let faulty = ["t,F", "0,x", "1,2", "junk", "2,3", "3,4", "4,5"];
        assert_eq!(found(&faulty), Some((Delimiter::Comma, 1, 2)));
    }
}
