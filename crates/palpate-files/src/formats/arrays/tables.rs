//! Arrays side by side as tests, and reading their columns.

use crate::{
    cell::unit,
    error::FileError,
    input::Input,
    table::{ColumnInfo, ColumnKind, Columns, Found, Heard, Metadata, Part, ReadPart, SkippedPart, not_finite, share},
};

/// Most columns of a matrix, and of a table.
pub(super) const MOST_COLUMNS: usize = 4096;

/// Most arrays of a file, and most named values.
pub(super) const MOST_ARRAYS: usize = 1 << 16;

/// Rows between two reports of progress.
const ROWS_A_REPORT: usize = 1 << 16;

/// Where something stands in a file: in a structure or group, under a name. The top has no name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) parent: String,
    pub(super) name: String,
    /// What stands between the two.
    pub(super) mark: char,
}

impl Place {
    /// The name behind those of the structures around it.
    pub(super) fn full(&self) -> String {
        match self.parent.as_str() {
            "" => self.name.clone(),
            parent => format!("{parent}{}{}", self.mark, self.name),
        }
    }
}

/// An array of real numbers.
pub(super) struct Array {
    pub(super) place: Place,
    pub(super) unit: Option<String>,
    pub(super) rows: usize,
    pub(super) columns: usize,
    /// Its first row, as far as that is known.
    pub(super) first: Vec<f64>,
}

/// What a file holds.
#[derive(Default)]
pub(super) struct Held {
    pub(super) arrays: Vec<Array>,
    /// Single numbers and texts.
    pub(super) values: Vec<(Place, String)>,
    pub(super) skipped: Vec<SkippedPart>,
}

impl Held {
    /// Adds an array: a single number is a named value, and what is no table is passed over.
    pub(super) fn add(&mut self, array: Array) {
        let full = array.place.full();
        match (array.rows, array.columns) {
            (1, 1) => {
                let value = array.first.first().map_or_else(String::new, |value| format!("{value:?}"));
                self.values.push((array.place, value));
            }
            (0 | 1, _) | (_, 0) => self.skipped.push(SkippedPart::new(full, "it has no rows")),
            (_, columns) if columns > MOST_COLUMNS => {
                self.skipped.push(SkippedPart::new(full, format!("more than {MOST_COLUMNS} columns")));
            }
            _ => self.arrays.push(array),
        }
    }
}

/// Where the numbers of arrays come from.
pub(super) trait Source: Send + Sync + 'static {
    /// Columns (from 0) of the array with this number among those that were found.
    fn columns(&self, array: usize, columns: &[usize]) -> Result<Vec<Vec<f64>>, FileError>;
}

struct Tables<S> {
    input: Input,
    /// Of each column of each part its array, and which column it is there.
    places: Vec<Vec<(usize, usize)>>,
    rows: Vec<usize>,
    source: S,
}

/// The tests of a file: arrays of one structure with equally many rows, where these are two columns or more.
pub(super) fn found(input: &Input, written: &str, held: Held, source: impl Source) -> Found {
    let Held {
        arrays,
        values,
        mut skipped,
    } = held;
    let mut groups: Vec<(&str, usize, Vec<usize>)> = Vec::new();
    let mut known = std::collections::HashMap::new();
    for (index, array) in arrays.iter().enumerate() {
        let key = (array.place.parent.as_str(), array.rows);
        let group = *known.entry(key).or_insert_with(|| {
            groups.push((key.0, key.1, Vec::new()));
            groups.len() - 1
        });
        groups[group].2.push(index);
    }
    let width = |members: &[usize]| members.iter().map(|index| arrays[*index].columns).sum::<usize>();
    let (whole, alone): (Vec<_>, Vec<_>) =
        groups.into_iter().partition(|(.., members)| (2..=MOST_COLUMNS).contains(&width(members)));
    for (_, rows, members) in alone {
        let reason = match width(&members) {
            1 => format!("no other array of {rows} rows stands beside it"),
            _ => format!("more than {MOST_COLUMNS} columns"),
        };
        skipped.extend(members.iter().map(|index| SkippedPart::new(arrays[*index].place.full(), reason.clone())));
    }
    let several = whole.len() > 1;
    let (mut parts, mut places, mut all_rows) = (Vec::new(), Vec::new(), Vec::new());
    for (parent, rows, members) in &whole {
        let twice = whole.iter().filter(|(other, ..)| other == parent).count() > 1;
        let name = match (*parent, twice) {
            ("", _) => several.then(|| format!("{rows} rows")),
            (parent, true) => Some(format!("{parent}, {rows} rows")),
            (parent, false) => Some(parent.to_owned()),
        };
        let own: Vec<(usize, usize)> = members
            .iter()
            .flat_map(|index| (0..arrays[*index].columns).map(|column| (*index, column)))
            .collect();
        let columns = own.iter().enumerate().map(|(place, (index, column))| info(place + 1, &arrays[*index], *column));
        // What stands beside it, and beside the structures around it.
        let around = |place: &Place| {
            let inner = parent.strip_prefix(place.parent.as_str());
            place.parent.is_empty()
                || inner.is_some_and(|inner| inner.is_empty() || inner.starts_with([place.mark, '(']))
        };
        let values = values.iter().filter(|(place, _)| around(place));
        parts.push(Part {
            name,
            written: written.to_owned(),
            rows: Some(*rows as u64),
            columns: columns.collect(),
            metadata: values.map(|(place, value)| named_value(place, value, parent)).collect(),
            ..Part::default()
        });
        places.push(own);
        all_rows.push(*rows);
    }
    let reader = Box::new(Tables {
        input: input.clone(),
        places,
        rows: all_rows,
        source,
    });
    Found { parts, skipped, reader }
}

fn info(number: usize, array: &Array, column: usize) -> ColumnInfo {
    let (name, behind) = unit::split(&array.place.name);
    let name = name.unwrap_or_else(|| array.place.name.clone());
    ColumnInfo {
        number,
        name: Some(if array.columns > 1 { format!("{name} {}", column + 1) } else { name }),
        unit: array.unit.clone().or(behind),
        kind: ColumnKind::Number,
        sample: array.first.get(column).map_or_else(|| "…".to_owned(), |value| format!("{value:?}")),
    }
}

/// A named value of a part, with the structure around it where that is not the part's own.
fn named_value(place: &Place, value: &str, parent: &str) -> Metadata {
    let (name, unit) = unit::split(&place.name);
    let name = name.unwrap_or_else(|| place.name.clone());
    let own = place.parent == parent;
    Metadata {
        name: if own { name } else { Place { name, ..place.clone() }.full() },
        value: value.to_owned(),
        unit,
    }
}

impl<S: Source> ReadPart for Tables<S> {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let (places, rows, size) = (&self.places[part], self.rows[part], self.input.size);
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        // Each array is read once, for all columns that are wanted of it.
        let mut arrays: Vec<usize> = columns.iter().map(|column| places[column - 1].0).collect();
        arrays.sort_unstable();
        arrays.dedup();
        for (done, array) in arrays.iter().enumerate() {
            progress(share(done as u64, arrays.len() as u64, size), size)?;
            let wanted: Vec<usize> =
                (0..columns.len()).filter(|place| places[columns[*place] - 1].0 == *array).collect();
            let inside: Vec<usize> = wanted.iter().map(|place| places[columns[*place] - 1].1).collect();
            for (place, numbers) in wanted.into_iter().zip(self.source.columns(*array, &inside)?) {
                if numbers.len() != rows {
                    let expected = format!("{rows} numbers in column {}", columns[place]);
                    return Err(self.input.damaged("the arrays", expected, numbers.len().to_string()));
                }
                values[place] = numbers;
            }
        }
        let mut read = Columns::of(columns.len());
        let mut line = vec![0.0; columns.len()];
        for row in 0..rows {
            if row % ROWS_A_REPORT == 0 {
                progress(size, size)?;
            }
            for (place, (cell, numbers)) in line.iter_mut().zip(&values).enumerate() {
                *cell = numbers[row];
                if !cell.is_finite() {
                    return Err(not_finite(&self.input, row, columns[place]));
                }
            }
            read.push_values(&line);
        }
        progress(size, size)?;
        read.finish();
        Ok(read)
    }
}
