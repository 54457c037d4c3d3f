//! The table of a sweep as a figure.

use std::fs::File;
use std::path::{Path, PathBuf};

use palpate_files::description::{Plan, Spacing, Sweep, SweptParameter};
use palpate_files::parquet_table::{TableError, TableReader, Values};
use palpate_report::figure::{Axis, MOST_PANELS};
use palpate_report::study::{Swept, sweep_grid_figure, sweep_points_figure};

use super::rows::{ResultColumn, results};
use crate::output::{check_figure, picture, stem, unwritten_table};
use crate::{ErrorKind, JobError};

/// Most points that are drawn; more would hide each other.
const MOST_POINTS: u64 = 5000;
/// Most cells of heat maps, which are held in memory.
const MOST_CELLS: u64 = 4_000_000;

/// A figure that can be drawn once the table is there.
pub(super) struct Chart {
    pub(super) path: PathBuf,
    result: ResultColumn,
}

impl Chart {
    /// Checks that there is such a figure of the sweep.
    pub(super) fn new(sweep: &Sweep, path: &Path, column: &str) -> Result<Self, JobError> {
        check_figure(path)?;
        let results = results(sweep);
        let Some(result) = results.iter().find(|result| result.name == column) else {
            let names: Vec<&str> = results.iter().map(|result| result.name.as_str()).collect();
            let hint = format!("show one of {}", names.join(", "));
            return Err(JobError::option(format!("⟨show={column}⟩: unknown result"), &hint));
        };
        if let Plan::Grid { counts } = &sweep.plan {
            let hint = "draw the columns of the table with another program, or sweep fewer parameters";
            let refused = |message: String| Err(JobError::option(message, hint).of(path.display()));
            match counts.as_slice() {
                [_] | [_, _] => {}
                [_, _, panels] if *panels <= MOST_PANELS => {}
                [_, _, panels] => {
                    let third = &sweep.parameters[2].path;
                    return refused(format!(
                        "expected at most {MOST_PANELS} values of {third}, with one panel each, found {panels}"
                    ));
                }
                more => {
                    return refused(format!("expected a grid of one to three swept parameters, found {}", more.len()));
                }
            }
            if sweep.runs > MOST_CELLS {
                return refused(format!("expected at most {MOST_CELLS} runs to draw, found {}", sweep.runs));
            }
        }
        Ok(Self {
            path: path.to_owned(),
            result: result.clone(),
        })
    }

    /// Draws it from the table at `table`.
    pub(super) fn draw(&self, sweep: &Sweep, table: &Path) -> Result<Vec<u8>, JobError> {
        let is_grid = matches!(sweep.plan, Plan::Grid { .. });
        let stride = if is_grid { 1 } else { sweep.runs.div_ceil(MOST_POINTS).max(1) };
        let read =
            |column: &str| read_column(table, column, stride as usize).map_err(|error| unwritten_table(table, &error));
        let result = Swept {
            axis: Axis::linear(&self.result.label, self.result.unit),
            values: read(&self.result.name)?,
        };
        let name = stem(&self.path);
        let caption = caption(sweep, &self.result, stride);
        let axes = sweep.parameters.iter().map(|number| {
            let values = match number.grid() {
                Some(values) if is_grid => values,
                _ => read(&number.column)?,
            };
            Ok(axis(number, values))
        });
        let axes = axes.collect::<Result<Vec<_>, JobError>>()?;
        let figure = if is_grid {
            sweep_grid_figure(&name, &caption, &axes, &result)
        } else {
            Some(sweep_points_figure(&name, &caption, &axes, &result))
        };
        let figure = figure.ok_or_else(|| {
            JobError::new(ErrorKind::Report, "expected one row per run, found others", None).of(table.display())
        })?;
        picture(&self.path, &figure)
    }
}

fn axis(number: &SweptParameter, values: Vec<f64>) -> Swept {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    let logarithmic = match number.spacing {
        Spacing::Logarithmic => true,
        Spacing::Linear => false,
        // A list over decades is meant by its ratios.
        Spacing::Listed => low > 0.0 && high / low > 50.0,
    };
    let unit = if number.unit == "/s" { "1/s" } else { number.unit };
    let axis = if logarithmic { Axis::log(&number.path, unit) } else { Axis::linear(&number.path, unit) };
    Swept { axis, values }
}

fn caption(sweep: &Sweep, result: &ResultColumn, stride: u64) -> String {
    let title = sweep.base.title.as_ref().map_or(String::new(), |title| format!("{title}. "));
    let over: Vec<&str> = sweep.parameters.iter().map(|number| number.path.as_str()).collect();
    let drawn = if stride == 1 { String::new() } else { format!(", one in {stride} drawn") };
    let is_map = matches!(&sweep.plan, Plan::Grid { counts } if counts.len() > 1);
    let grey = if is_map { " Grey: refused." } else { "" };
    format!("{title}{} over {}; {} runs{drawn}.{grey}", result.label, over.join(", "), sweep.runs)
}

/// Every `stride`-th value of a column, NaN where it is missing.
fn read_column(table: &Path, name: &str, stride: usize) -> Result<Vec<f64>, TableError> {
    let table = TableReader::new(File::open(table)?)?;
    let column = table.fields().iter().position(|field| field.name == name);
    let column = column.ok_or_else(|| TableError::Parquet(format!("no column {name}")))?;
    let (mut values, mut row) = (Vec::new(), 0usize);
    for group in 0..table.groups() {
        let Values::Number(numbers) = table.values(group, column)? else {
            continue;
        };
        for number in numbers {
            if row % stride == 0 {
                values.push(number.unwrap_or(f64::NAN));
            }
            row += 1;
        }
    }
    Ok(values)
}
