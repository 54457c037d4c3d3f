//! Tables one below the other: where each begins.

use crate::cell::Cell;

/// Most rows of two cells or more from the names of columns to the first row of numbers.
const HEADER: usize = 2;
/// Fewest rows of numbers of a table.
const FEWEST: usize = 2;

/// What a row is to somebody who looks for tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RowKind {
    /// Numbers.
    Data,
    /// Words that may name columns.
    Names,
    /// Words and numbers.
    Mixed,
    /// One cell or none: a title, a remark, the number of a point that was not valid.
    Few,
}

/// Most tables that results may stand in above a test.
pub(crate) const MOST_RESULTS: usize = 16;

impl RowKind {
    /// Whether the cells of a row are names of columns.
    pub(crate) fn is_heading(row: &[Cell]) -> bool {
        Self::of(row.iter().copied(), false) == Self::Names
    }

    /// Of the cells of a row that are not empty, in their order; `labelled`: the first is a word before a colon.
    pub(crate) fn of(cells: impl Iterator<Item = Cell>, labelled: bool) -> Self {
        let (mut numbers, mut texts) = (0, 0);
        for cell in cells {
            numbers += usize::from(cell.is_numeric());
            texts += usize::from(cell == Cell::Text);
        }
        match (numbers, texts) {
            (2.., _) if !labelled => Self::Data,
            (0, 2..) => Self::Names,
            (numbers, texts) if numbers + texts < 2 => Self::Few,
            _ => Self::Mixed,
        }
    }
}

/// Goes through the rows of a file or sheet for the places where a second table begins, and any further one: behind the last row
/// of numbers before names of columns.
#[derive(Debug, Default)]
pub(crate) struct Starts {
    row: usize,
    /// Rows of numbers since the last start.
    data: usize,
    /// Index of the row behind the last of them.
    behind: usize,
    /// Names of columns below which no numbers have been found yet.
    names: Option<Pending>,
}

#[derive(Debug, Default)]
struct Pending {
    /// Rows below the names.
    header: usize,
    /// Rows of numbers below these.
    data: usize,
}

impl Starts {
    /// Index of the row behind the last row of numbers above any names whose table has not begun: what is before it belongs to the table
    /// that began last.
    pub(crate) fn behind(&self) -> usize {
        self.behind
    }

    /// Takes the next row; if it shows that a table begins, the index of the row at which.
    pub(crate) fn next(&mut self, kind: RowKind) -> Option<usize> {
        let index = self.row;
        self.row += 1;
        if let Some(names) = &mut self.names {
            match kind {
                RowKind::Few => return None,
                RowKind::Data => {
                    names.data += 1;
                    if names.data < FEWEST {
                        return None;
                    }
                    self.names = None;
                    self.data = FEWEST;
                    return Some(std::mem::replace(&mut self.behind, index + 1));
                }
                _ if names.data == 0 && names.header < HEADER => {
                    names.header += 1;
                    return None;
                }
                _ => self.names = None,
            }
        }
        match kind {
            RowKind::Data => {
                self.data += 1;
                self.behind = index + 1;
            }
            RowKind::Names if self.data >= FEWEST => self.names = Some(Pending::default()),
            _ => {}
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{
        RowKind::{Data, Few, Mixed, Names},
        *,
    };

    fn starts(rows: &[RowKind]) -> Vec<usize> {
        let mut starts = Starts::default();
        rows.iter().filter_map(|kind| starts.next(*kind)).collect()
    }

    #[test]
    fn a_table_begins_behind_the_numbers_before_its_names() {
        assert_eq!(starts(&[Names, Data, Data, Few, Few, Names, Names, Data, Data]), [3]);
        assert_eq!(starts(&[Data, Data, Names, Data, Data, Data, Names, Names, Names, Data, Data]), [2, 6]);
        // A label and a number above the names, and points that were not valid below them.
        assert_eq!(starts(&[Names, Data, Data, Mixed, Names, Names, Few, Few, Few, Data, Data]), [3]);
    }

    #[test]
    fn remarks_and_single_rows_begin_none() {
        assert!(starts(&[Names, Data, Data, Few, Names, Data, Few]).is_empty());
        assert!(starts(&[Names, Data, Names, Data, Data]).is_empty());
        assert!(starts(&[Data, Data, Names, Mixed, Mixed, Mixed, Data, Data]).is_empty());
    }

    #[test]
    fn kinds_of_rows() {
        let of = |cells: &[Cell], labelled| RowKind::of(cells.iter().copied(), labelled);
        assert_eq!(of(&[Cell::Whole, Cell::Comma, Cell::Text], false), Data);
        assert_eq!(of(&[Cell::Text, Cell::Whole, Cell::Whole], true), Mixed);
        assert_eq!(of(&[Cell::Text, Cell::Text], true), Names);
        assert_eq!(of(&[Cell::Text], false), Few);
    }
}
