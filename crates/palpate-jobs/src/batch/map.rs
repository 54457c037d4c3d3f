//! The curves of a batch that have a position, and what was found of each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use palpate_files::parquet_table::Kind;
use palpate_report::figure::Figure;
use palpate_report::result::parameter_title;
use palpate_report::study::{MapPoint, map_figure};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::table::columns_of;
use super::{Entry, parameters, rows};
use crate::JobError;
use crate::output::{check_figure, file_name};

/// Short names of quantities, as the theory writes them.
const SYMBOLS: [(&str, &str); 3] = [("v", "rate_coefficient_per_s"), ("n", "exponent"), ("E", "loading_modulus_pa")];

/// The curves of a batch that have a position, with the quantities of each: those of its first hold, and the parameters of the law
/// recommended there.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CurveMap {
    /// Where each curve was measured, m.
    positions: Vec<[f64; 2]>,
    /// What was found, by its name.
    quantities: BTreeMap<String, Mapped>,
}

/// A quantity of some curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Mapped {
    unit: String,
    /// By the number of the curve.
    values: BTreeMap<usize, f64>,
}

impl CurveMap {
    /// Whether no curve has a position.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Names of the quantities that some curve has a value of.
    pub fn quantities(&self) -> impl Iterator<Item = &str> {
        self.quantities.keys().map(String::as_str)
    }

    /// Takes the curves of a file.
    pub(super) fn add(&mut self, entry: &Entry) {
        let fields = rows::fields();
        let [record, part, hold, x, y, recommended] =
            columns_of(&fields, ["record", "part", "hold", "x_m", "y_m", "recommended"]);
        let of = columns_of(&parameters::fields(), ["record", "part"]);
        let mut lines = &entry.parameters[..];
        // Of each test the first row: that of the law recommended for its first hold, if there is one.
        let tests = entry.rows.chunk_by(|a, b| (&a[record], &a[part]) == (&b[record], &b[part]));
        for row in tests.filter_map(<[_]>::first) {
            let test = [&row[record], &row[part]];
            // The parameters stand in the order of the tests.
            let count = lines.iter().take_while(|line| of.map(|column| &line[column]) == test).count();
            let own;
            (own, lines) = lines.split_at(count);
            let (Some(x), Some(y)) = (row[x].as_f64(), row[y].as_f64()) else {
                continue;
            };
            let curve = self.positions.len();
            self.positions.push([x, y]);
            let is_recommended = row[recommended].as_i64() == Some(1);
            for (field, value) in fields.iter().zip(row) {
                let is_place = matches!(field.name.as_str(), "x_m" | "y_m" | "hold" | "map_index");
                if matches!(field.kind, Kind::Number | Kind::OptionalCount)
                    && !is_place
                    && (is_recommended || rows::is_of_hold(&field.name))
                {
                    self.insert(curve, &field.name, unit_of(&field.name), value.as_f64());
                }
            }
            if is_recommended {
                self.add_parameters(curve, own, &row[hold]);
            }
        }
    }

    fn add_parameters(&mut self, curve: usize, lines: &[Vec<Value>], hold: &Value) {
        let [held, name, unit, value, recommended] =
            columns_of(&parameters::fields(), ["hold", "parameter", "unit", "value", "recommended"]);
        let text = |line: &[Value], column: usize| line[column].as_str().unwrap_or_default().to_owned();
        let wanted = |line: &&Vec<Value>| line[held] == *hold && line[recommended].as_i64() == Some(1);
        for line in lines.iter().filter(wanted) {
            self.insert(curve, &text(line, name), &text(line, unit), line[value].as_f64());
        }
    }

    fn insert(&mut self, curve: usize, name: &str, unit: &str, value: Option<f64>) {
        let Some(value) = value.filter(|value| value.is_finite()) else {
            return;
        };
        let mapped = self.quantities.entry(name.to_owned()).or_insert_with(|| Mapped {
            unit: unit.to_owned(),
            values: BTreeMap::new(),
        });
        // Curves with a law in another unit have no value beside the others.
        if mapped.unit == unit {
            mapped.values.insert(curve, value);
        }
    }

    /// A map of a quantity, under this name.
    ///
    /// # Errors
    /// [`JobError`] where no curve has a position, or none a value of that name.
    pub fn figure(&self, quantity: &str, name: &str) -> Result<Figure, JobError> {
        if self.is_empty() {
            let hint = "a map needs files that state where each curve was measured: JPK maps and exports, afmformats, Optics11";
            return Err(JobError::option("expected curves with a position, found none", hint));
        }
        let symbol = SYMBOLS.iter().find(|(symbol, _)| *symbol == quantity);
        let requested = quantity;
        let quantity = symbol.map_or(quantity, |(_, name)| name);
        let Some(mapped) = self.quantities.get(quantity) else {
            let message = format!("expected a quantity of the curves for the map, found {requested:?}");
            let known: Vec<&str> = self.quantities.keys().map(String::as_str).collect();
            let hint = match &known[..] {
                [] => "no curve has a value; describe the body with [specimen] in a test description for a modulus"
                    .to_owned(),
                known => format!("these curves have {}", known.join(", ")),
            };
            return Err(JobError::option(message, &hint));
        };
        let title = parameter_title(quantity);
        let mut letters = title.chars();
        let label: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
        let of = match quantity {
            ramp if ramp.starts_with("loading_") => "first loading ramp",
            held if rows::is_of_hold(held) => "first hold",
            _ => "law recommended for the first hold",
        };
        let caption = format!("{label} of each curve ({of}) over its position.");
        let point = |(curve, position): (usize, &[f64; 2])| MapPoint {
            position: *position,
            value: mapped.values.get(&curve).copied(),
        };
        let points: Vec<MapPoint> = self.positions.iter().enumerate().map(point).collect();
        Ok(map_figure(name, &caption, (&label, &mapped.unit), &points))
    }
}

/// The unit that the name of a column ends in.
fn unit_of(name: &str) -> &'static str {
    let ends = [("_per_s", "1/s"), ("_pa", "Pa"), ("_n", "N"), ("_m", "m"), ("_s", "s")];
    ends.into_iter().find(|(end, _)| name.ends_with(end)).map_or("1", |(_, unit)| unit)
}

/// The quantity and the file of a map: that behind `=`, or `holds_map_exponent.svg` beside `holds.csv`.
pub(super) fn named<'a>(table: &Path, map: &'a str) -> Result<(&'a str, PathBuf), JobError> {
    let (quantity, path) = match map.split_once('=') {
        Some((quantity, path)) => (quantity, PathBuf::from(path)),
        None => {
            let stem = table.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (map, table.with_file_name(file_name(&format!("{stem}_map_{map}.svg"))))
        }
    };
    check_figure(&path)?;
    Ok((quantity, path))
}
