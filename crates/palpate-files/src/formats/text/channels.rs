//! Channels in volts below a table of their scales: the data files of Aurora Scientific's program DMC (`.ddf`).
//!
//! Above the rows stand `Channel`, `Units`, `Scale (units/V)` and `Offset (volts)`, each with a value a channel; a value is
//! (volts − offset) × scale. The rows are named by the channels, and the file gives the rate of its samples in place of a time.

use palpate::units::Dimension;

use crate::{
    cell::{DecimalMark, Delimiter, cells, number},
    error::{CellPosition, FileProblem},
    naming::unit_factor,
    table::{ColumnInfo, Columns, Layout},
};

/// What makes a value of the volts of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// Units a volt.
    slope: f64,
    /// Volts at zero.
    offset: f64,
}

/// The lines of the table, by how they begin.
const ROWS: [&str; 4] = ["Channel", "Units", "Scale (units/V)", "Offset (volts)"];

/// The scale of each column that is a measured channel of length or force, whose name and unit it then has; none in any other text.
pub(super) fn scaled(lines: &[&str], layout: &mut Layout) -> Vec<Option<Scale>> {
    let above = &lines[..layout.first_data_line.saturating_sub(1).min(lines.len())];
    let row = |begins: &str| -> Option<Vec<&str>> {
        let line = above.iter().find(|line| line.starts_with(begins))?;
        Some(cells(line, Delimiter::Tab))
    };
    let [Some(channels), Some(units), Some(slopes), Some(offsets)] = ROWS.map(row) else {
        return Vec::new();
    };
    let scale = |column: &mut ColumnInfo| {
        let place = channels.iter().skip(1).position(|channel| column.name.as_deref() == Some(channel))? + 1;
        let value = |row: &[&str]| number::parse(row.get(place)?.as_bytes(), DecimalMark::Point);
        let unit = *units.get(place)?;
        let scale = Scale {
            slope: value(&slopes).filter(|slope| *slope != 0.0)?,
            offset: value(&offsets)?,
        };
        let measures = |dimension| unit_factor(unit, dimension).is_some();
        // AO channels are what was commanded.
        let quantity = match channels[place].starts_with("AI") {
            true if measures(Dimension::Length) => "displacement",
            true if measures(Dimension::Force) => "force",
            _ => return None,
        };
        column.name = Some(format!("{quantity} {}", channels[place]));
        column.unit = Some(unit.to_owned());
        Some(scale)
    };
    layout.columns.iter_mut().map(scale).collect()
}

/// Makes values of the volts of chosen columns (numbers from 1).
///
/// # Errors
/// Where a value is infinite once it is scaled.
pub(super) fn apply(scales: &[Option<Scale>], columns: &[usize], read: &mut Columns) -> Result<(), FileProblem> {
    for (column, values) in columns.iter().zip(&mut read.values) {
        if let Some(Some(Scale { slope, offset })) = scales.get(column - 1) {
            values.iter_mut().for_each(|value| *value = (*value - offset) * slope);
        }
    }
    let infinite = |values: &Vec<f64>| values.iter().position(|value| !value.is_finite());
    let found = columns.iter().zip(&read.values).find_map(|(column, values)| Some((*column, infinite(values)?)));
    match found {
        None => Ok(()),
        Some((column, row)) => Err(FileProblem::NotFinite {
            place: CellPosition {
                line: read.line_of(row).unwrap_or(row + 1),
                column,
                name: None,
            },
            found: "an infinite value".to_owned(),
        }),
    }
}
