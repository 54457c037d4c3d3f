//! Finding the tables in the beginning of a sheet, as a person would.

use std::{collections::HashMap, ops::Range};

use super::{
    cell::{Value, letters},
    sample::{Row, Sample},
};
use crate::{
    cell::{Cell, DecimalMark},
    error::shorten,
    table::{
        ColumnInfo, ColumnKind, Doubt, MOST_RESULTS, Metadata, ReadOptions, RowKind, block, decimal, header, metadata,
        names_time,
    },
};

/// Most named values of all tables of a sheet together.
const MOST_NAMED: usize = 1 << 16;

/// A table in a sheet.
#[derive(Clone)]
pub(super) struct Table {
    /// How many named values above it go beyond the limit of all.
    pub(super) left_out: usize,
    /// Columns of the sheet, from 0, in their order.
    pub(super) places: Vec<u32>,
    pub(super) columns: Vec<ColumnInfo>,
    /// First row of data, from 0.
    pub(super) first_row: u32,
    /// Last row of data in the sample, from 0.
    pub(super) last_row: u32,
    /// Its rows from the first on, from 0, which may have those of other tables between them and end where the next table below begins.
    pub(super) rows: Vec<Range<u32>>,
    /// Index in `columns` of the first one of numbers, which tells rows of data from other rows.
    pub(super) leading: usize,
    /// Columns of moments: dates, times of day or durations.
    pub(super) moments: Vec<bool>,
    /// Columns of dates, whose days count from the epoch.
    pub(super) dated: Vec<bool>,
    /// Decimal mark of the numbers that are texts; an error where it is not clear.
    pub(super) decimal: Result<DecimalMark, Doubt>,
    pub(super) metadata: Vec<Metadata>,
}

impl Table {
    /// Its columns as people name them: `columns A–D` or `columns A–C, E`.
    pub(super) fn range(&self) -> String {
        let range = |range: &[u32]| match *range {
            [first, .., last] => format!("{}–{}", letters(first), letters(last)),
            _ => range.iter().copied().map(letters).collect(),
        };
        let ranges: Vec<String> = groups(&self.places).map(range).collect();
        format!("columns {}", ranges.join(", "))
    }

    /// Index of the stretch of its rows that a row belongs to or lies above.
    pub(super) fn stretch(&self, row: u32) -> usize {
        self.rows.partition_point(|rows| rows.end <= row)
    }

    pub(super) fn names_time(&self) -> bool {
        names_time(&self.columns)
    }

    pub(super) fn has_names(&self) -> bool {
        self.columns.iter().any(|column| column.name.is_some())
    }
}

/// What was found in a sheet.
pub(super) struct FoundTables {
    pub(super) tables: Vec<Table>,
    /// How many cells stand beside the tables.
    pub(super) beside: usize,
}

/// The tables in a sample: one, or several side by side where each has a time of its own.
pub(super) fn find(sample: &Sample, options: &ReadOptions) -> FoundTables {
    let columns = columns_of_data(sample);
    let mut named = Named::default();
    let mut found: Vec<Table> =
        groups(&columns).filter_map(|group| table(sample, group, &mut named, options)).collect();
    let timed = found.iter().filter(|table| table.names_time()).count();
    if timed >= 2 {
        found.retain(Table::names_time);
    } else if let Some(joined) = joined(&found) {
        // Empty columns between those of one table.
        found = match table(sample, &joined, &mut Named::default(), options) {
            Some(table) => vec![table],
            None => found.into_iter().take(1).collect(),
        };
    }
    let first = found.iter().map(|table| table.first_row).min().unwrap_or(0);
    let mut places: Vec<u32> = found.iter().flat_map(|table| table.places.iter().copied()).collect();
    places.sort_unstable();
    let below = sample.rows.iter().filter(|row| row.number >= first);
    let beside = below.flat_map(|row| &row.cells).filter(|(column, _)| places.binary_search(column).is_err()).count();
    FoundTables {
        beside: if found.is_empty() { 0 } else { beside },
        tables: found,
    }
}

/// The columns that hold anything from the first row of numbers on. What stands further to the right above the numbers,
/// such as the unit of a named value, does not join two tables.
fn columns_of_data(sample: &Sample) -> Vec<u32> {
    let all = sample.columns(0);
    let class = |row: &Row| -> Vec<Cell> {
        all.iter().map(|&place| row.value(place).map_or(Cell::Empty, Value::class)).collect()
    };
    let block = block::of_rows(sample.rows.iter().map(class).collect());
    block.map_or_else(Vec::new, |block| sample.columns(block.first))
}

/// Columns without an empty one between them.
fn groups(columns: &[u32]) -> impl Iterator<Item = &[u32]> {
    columns.chunk_by(|one, next| one + 1 == *next)
}

/// The columns of the longest table and of those that begin beside it and are at least half as long.
fn joined(tables: &[Table]) -> Option<Vec<u32>> {
    let length = |table: &Table| table.last_row - table.first_row;
    // The first of several of one length.
    let longest = tables.iter().rev().max_by_key(|table| length(table))?;
    let belongs = |table: &&Table| table.first_row == longest.first_row && 2 * length(table) >= length(longest);
    Some(tables.iter().filter(belongs).flat_map(|table| table.places.iter().copied()).collect())
}

/// The table in some columns of a sample, if there are two rows of numbers or more; or one below it, if that names a time and the first does
/// not: results, such as a hardness, stand above the values that were measured.
fn table(sample: &Sample, places: &[u32], named: &mut Named, options: &ReadOptions) -> Option<Table> {
    let held = |row: &Row| places.iter().any(|&place| row.value(place).is_some());
    let rows: Vec<&Row> = sample.rows.iter().filter(|row| held(row)).collect();
    let class = |row: &&Row| -> Vec<Cell> {
        places.iter().map(|&place| row.value(place).map_or(Cell::Empty, Value::class)).collect()
    };
    let classes: Vec<Vec<Cell>> = rows.iter().map(class).collect();
    let block = block::of_rows(classes.clone())?;
    let numbers = block.first;
    let first = table_below(&rows, (0, block), places, named, options);
    if options.header.is_some() || first.as_ref().is_some_and(Table::names_time) {
        return first;
    }
    let headings = (numbers..classes.len()).filter(|index| RowKind::is_heading(&classes[*index])).take(MOST_RESULTS);
    let mut below = headings.filter_map(|from| {
        table_below(&rows, (from, block::of_rows(classes[from..].to_vec())?), places, named, options)
    });
    below.find(Table::names_time).or(first)
}

/// The table of this block, which begins with one of the rows.
fn table_below(
    rows: &[&Row],
    (from, mut block): (usize, block::Block),
    places: &[u32],
    named: &mut Named,
    options: &ReadOptions,
) -> Option<Table> {
    let texts = |index: usize, _: &block::Block| -> Vec<String> {
        places
            .iter()
            .map(|&place| rows[from + index].value(place).map_or_else(String::new, Value::text))
            .collect()
    };
    let header = header::find_in_rows(&texts, 0, &mut block, options.header);
    let data: Vec<&Row> = rows.iter().skip(from + block.first).copied().collect();
    let leading = block::first_number(&block.kinds)?;
    let leads = |row: &&&Row| row.value(places[leading]).is_some_and(|value| value.class().is_numeric());
    let last_row = data.iter().rfind(leads)?.number;
    let first_row = data.first()?.number;
    if data.iter().filter(leads).count() < 2 {
        return None;
    }
    let firsts: Vec<_> = places.iter().map(|&place| data.iter().find_map(|row| row.value(place))).collect();
    let labelled = firsts.iter().zip(&header.labels).zip(&block.kinds).enumerate();
    let columns = labelled.map(|(index, ((first, label), &kind))| column(index + 1, kind, label, *first)).collect();
    let above = rows.iter().take(from + block.first).enumerate();
    let above = above.filter(|(index, _)| index.checked_sub(from).is_none_or(|index| !header.holds(index)));
    let (mut metadata, mut left_out) = (Vec::new(), 0);
    for (_, row) in above {
        left_out += named.add(row, &mut metadata);
    }
    Some(Table {
        columns,
        first_row,
        last_row,
        rows: std::iter::once(first_row..u32::MAX).collect(),
        leading,
        moments: firsts.iter().map(|first| is_moment(*first)).collect(),
        dated: firsts.iter().map(|first| matches!(first, Some(Value::Moment(days)) if *days >= 1.0)).collect(),
        decimal: decimal(&data, places, &block.kinds, options.decimal),
        metadata,
        left_out,
        places: places.to_vec(),
    })
}

/// Whether the values of a column are dates, times of day or durations, going by the first.
fn is_moment(first: Option<&Value>) -> bool {
    matches!(first, Some(Value::Moment(_) | Value::Duration(_)))
}

/// A column by its number, its name and unit in the header, and its first value.
fn column(
    number: usize,
    kind: ColumnKind,
    label: &(Option<String>, Option<String>),
    first: Option<&Value>,
) -> ColumnInfo {
    let (name, unit) = label;
    ColumnInfo {
        number,
        name: name.clone(),
        unit: if is_moment(first) { Some("s".to_owned()) } else { unit.clone() },
        kind,
        sample: first.map_or_else(String::new, |value| shorten(&value.text())),
    }
}

/// Named values above tables: all that a row names belongs to every table below it.
#[derive(Default)]
struct Named {
    /// By the number of the row.
    rows: HashMap<u32, Vec<Metadata>>,
    /// How many all tables have been given.
    given: usize,
}

impl Named {
    /// Adds those of a row as far as there is room, and says how many are left out.
    fn add(&mut self, row: &Row, to: &mut Vec<Metadata>) -> usize {
        let named = self.rows.entry(row.number).or_insert_with(|| {
            let texts: Vec<String> = row.cells.iter().map(|(_, value)| value.text()).collect();
            let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
            metadata::in_cells(&texts)
        });
        let room = named.len().min(MOST_NAMED - self.given);
        to.extend_from_slice(&named[..room]);
        self.given += room;
        named.len() - room
    }
}

/// The decimal mark of the numbers that are kept as texts.
fn decimal(
    data: &[&Row],
    places: &[u32],
    kinds: &[ColumnKind],
    fixed: Option<DecimalMark>,
) -> Result<DecimalMark, Doubt> {
    if let Some(fixed) = fixed {
        return Ok(fixed);
    }
    let texts = |wanted: Cell| {
        let mut found: Vec<(usize, &str)> = Vec::new();
        for row in data {
            for (&place, _) in places.iter().zip(kinds).filter(|(_, kind)| **kind == ColumnKind::Number) {
                match row.value(place) {
                    Some(value @ Value::Text(text)) if value.class() == wanted => {
                        found.push((row.number as usize, text.trim()));
                    }
                    _ => {}
                }
            }
        }
        found
    };
    decimal::weigh_texts(&texts(Cell::Point), &texts(Cell::Comma))
}
