//! What can be wrong between a file and a record.

use std::{fmt, path::PathBuf};

use palpate::{record::RecordError, units::Dimension};

use super::{lever, named::NamedColumn, snippet};
use crate::{
    cell::DecimalMark,
    description::machines_of,
    error::{FileError, few, shown},
    naming::{Quantity, UNCALIBRATED, is_share, unit_behind_number, unit_factor},
    table::{ColumnInfo, ColumnRef, Part},
};

/// Why it is not clear which column holds what.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnError {
    /// No column was found for a quantity that a record needs among all columns of the file.
    #[error("expected a column of {}, found {}", .0, snippet::described(.1))]
    Missing(Quantity, Vec<ColumnInfo>),
    /// A column is named as the time, but holds texts such as this.
    #[error("{0}: expected a time, found texts such as \"{1}\"")]
    TimeAsText(NamedColumn, String),
    /// A column is named after a quantity, but some of its cells are no numbers: this is the first of them, as far as known.
    #[error("{0}: expected numbers in every row, found `{1}`")]
    NotNumbers(NamedColumn, String),
    /// A column is stated to be that of a quantity, and not to be used.
    #[error("{1}: expected a column that is used, found the {0} in columns.unused")]
    StatedAsUnused(Quantity, NamedColumn),
    /// Several columns could hold a quantity.
    #[error("expected one column of {}, found {}", .0, listed(.1, " and "))]
    Ambiguous(Quantity, Vec<NamedColumn>),
    /// No column is named as the displacement, but some could hold it.
    #[error(
        "expected a name that indicates whether {} {}, found no known name",
        listed(candidates, " and "),
        is_displacement(candidates)
    )]
    Unclear {
        /// The columns that could hold the displacement.
        candidates: Vec<NamedColumn>,
        /// All columns of the file.
        columns: Vec<ColumnInfo>,
    },
    /// The units of some columns are written nowhere.
    #[error("expected a unit for {}, found {}", listed(without.iter().map(|(_, _, column)| column), ", "), none(without))]
    NoUnit {
        /// Keys of the description that would say each, a usual unit, and the column.
        without: Vec<(String, &'static str, NamedColumn)>,
        /// A column without a unit whose name is not known, which may be the displacement where no other is.
        travel: Option<NamedColumn>,
    },
    /// Something is wrong with the unit of a column.
    #[error("{column}: {problem}")]
    Unit {
        /// The column.
        column: NamedColumn,
        /// Key of the description that would say the unit.
        key: String,
        /// What is wrong with it.
        problem: Box<UnitProblem>,
    },
    /// The description names a column that the file does not have, or has more than once.
    #[error("{key}: expected {}, found {found}", snippet::choices(columns))]
    NoSuchColumn {
        /// Key of the description.
        key: String,
        /// What it says.
        found: ColumnRef,
        /// All columns of the file.
        columns: Vec<ColumnInfo>,
    },
    /// One column is stated to hold two quantities.
    #[error("{0}: expected one quantity in a column, found {1} and {2}")]
    Twice(NamedColumn, Quantity, Quantity),
    /// A column is to be added to one that was stamped by another clock.
    #[error("expected two columns of one clock to add, found {0} and {1}")]
    ClocksDiffer(NamedColumn, NamedColumn),
    /// The description says that a time counts from 1970, but in no unit does its first value, this one, lie in our days.
    #[error("{0}: expected a time since 1970 (of 2000 to 2100, in s, ms, us or ns), found {1}")]
    NoEpoch(NamedColumn, String),
    /// A deflection is to be taken off a column of which it is off already.
    #[error(
        "{0}: expected the height of the cantilever's base, found a column whose name indicates that the deflection is already subtracted"
    )]
    NoHeight(NamedColumn),
    /// Stress or strain of a body without one section and one length, which would turn them into force and displacement.
    #[error(
        "{0}: expected force and displacement for a body whose contact area changes, found stress, strain, a modulus or a compliance"
    )]
    NoSection(NamedColumn),
    /// Stress or strain of the section and the length as they are, which those of the body as described make no force and displacement of.
    #[error(
        "{}: expected engineering stress and strain, found true {}",
        listed(.0.iter().map(|(_, column)| column), ", "),
        few(.0.iter().map(|(quantity, _)| quantity.to_string()), 2, " and ")
    )]
    TrueMeasures(Vec<(Quantity, NamedColumn)>),
    /// A test of a rheometer in oscillation, by its storage modulus.
    #[error("{0}: expected a test with a hold, found amplitudes of an oscillation")]
    Oscillation(NamedColumn),
    /// A test of a rheometer in rotation, by its shear rate, which goes from one value to another.
    #[error("{rate}: expected a test with a hold, found a flow curve from {from} to {to} 1/s")]
    FlowCurve {
        /// The column of the shear rate.
        rate: NamedColumn,
        /// Its first value, 1/s.
        from: String,
        /// Its last value, 1/s.
        to: String,
    },
    /// Torque or angle, and no sizes of the sample that would turn them into force and displacement.
    #[error(
        "{0}: expected the sizes of the sample, which turn torque and angle into force and displacement, found none"
    )]
    NoTorsion(NamedColumn),
}

/// What can be wrong with the unit of a column.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UnitProblem {
    /// A header gives a unit that is none of the quantity in the column.
    #[error("\"{}\" is not a unit of {} (accepted: {})", shown(.1), .0, .0.dimension().accepted())]
    Unknown(Quantity, String),
    /// A curve of a force microscope has the deflection of its cantilever in this unit, and no spring constant.
    #[error("expected a force, found a deflection in {unit} without the spring constant of the cantilever")]
    NoSpringConstant {
        /// The unit.
        unit: String,
        /// Number of the column of the height of the cantilever's base, if there is one.
        height: Option<usize>,
    },
    /// The conventions of a machine say one unit, the header another.
    #[error("expected {stated}, the unit of machine.preset = \"{machine}\", found {written} in the header")]
    OfMachine {
        /// The machine.
        machine: String,
        /// Its unit.
        stated: String,
        /// The unit in the header.
        written: String,
    },
    /// A scale is given for a column in this unit, which is not volts.
    #[error("expected volts for `scale`, found {0}")]
    NoVolts(String),
    /// The file says two units, each with the place where it stands; the nearer one to the values comes last.
    #[error("expected one unit, found {} {} and {} {}", .0[0].0, .0[0].1, .0[1].0, .0[1].1)]
    Two([(String, String); 2]),
    /// A time in this unit begins with this number, and is like the dates of a spreadsheet.
    #[error("expected a time in {0}, found numbers like the dates of a spreadsheet, which count days: {1}")]
    Serials(String, String),
    /// A time has two fields, and nobody knows which: this is the first.
    #[error("expected hours, minutes and seconds, found two of them: `{0}`")]
    Clock(String),
    /// The name says multiples of a quantity, and nobody knows whether the values are these or have been multiplied.
    #[error("expected a scale beside the unit, such as (x10^-3 {}), found one in the name", .0.usual_unit())]
    Multiples(Quantity),
}

impl ColumnError {
    pub(super) fn unit(column: &ColumnInfo, key: String, problem: UnitProblem) -> Self {
        let (column, problem) = (column.into(), Box::new(problem));
        Self::Unit { column, key, problem }
    }

    /// What would help; where that is a description, lines to paste into it.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Missing(_, columns) => lever::hint_of(columns).unwrap_or_else(|| snippet::of_columns(columns)),
            Self::TimeAsText(..) => {
                "write seconds, or 2024-03-12 10:11:12.5, 12.03.2024 10:11:12.5 or 10:11:12.5 in every row".to_owned()
            }
            Self::NotNumbers(_, found) => crate::error::hint_of_text(found, DecimalMark::Point).to_owned(),
            Self::Ambiguous(quantity, candidates) => {
                let number = candidates.first().map_or(1, |column| column.number);
                let stated = candidates.first().map(|first| {
                    let same = candidates.iter().filter(|other| other.name == first.name).count();
                    snippet::entry(*quantity, first, None, same == 1)
                });
                let stated = snippet::option(stated);
                format!("choose one: {stated}, or in a test description:\n[columns.{quantity}]\ncolumn = {number}")
            }
            Self::Unclear { candidates, columns } => snippet::of_unclear(candidates, columns),
            Self::NoUnit { without, travel } => snippet::of_missing_units(without, travel.as_ref()),
            Self::Unit { column, key, problem } => problem.hint(column, key),
            Self::NoSuchColumn { columns, .. } => {
                let usual = "columns count from 1 at the left; the unit of a name is optional";
                let part = Part {
                    columns: columns.clone(),
                    ..Part::default()
                };
                let presets: Vec<String> =
                    machines_of(&part).iter().map(|machine| format!("machine.preset = \"{}\"", machine.name)).collect();
                match presets.is_empty() {
                    true => usual.to_owned(),
                    false => format!("{usual}; columns of these names go with {}", presets.join(" or ")),
                }
            }
            Self::Twice(_, one, other) => format!("correct columns.{one} or columns.{other}"),
            Self::ClocksDiffer(..) => "name two columns of one topic".to_owned(),
            Self::NoEpoch(..) => "give the unit of the time, such as \"s\"".to_owned(),
            Self::NoHeight(..) => {
                "remove [columns.deflection], or name the column of the height in columns.displacement".to_owned()
            }
            Self::NoSection(..) => {
                "choose a column of force, or describe the body as a strip, cylinder or block".to_owned()
            }
            Self::StatedAsUnused(quantity, _) => {
                format!("take it out of columns.unused, or name another column under columns.{quantity}")
            }
            Self::TrueMeasures(columns) => snippet::of_true_measures(columns),
            Self::Oscillation(..) | Self::FlowCurve { .. } => {
                "choose a test of relaxation or creep; if this is one, name its columns, such as columns.stress and columns.strain"
                    .to_owned()
            }
            Self::NoTorsion(..) => lever::SAMPLE.to_owned(),
        }
    }
}

impl UnitProblem {
    /// What would help against it for a column whose unit a description says under a key.
    fn hint(&self, column: &NamedColumn, key: &str) -> String {
        match self {
            Self::Unknown(quantity, unit) if unit_factor(unit, Dimension::Voltage).is_none() => {
                if let Some(hint) = lever::hint_of_unit(unit, column, *quantity) {
                    return hint;
                }
                let meant = quantity.unit_meant(unit);
                if is_share(unit) {
                    return snippet::of_share(key, *quantity, column);
                }
                if *quantity == Quantity::Displacement && unit_factor(unit, Dimension::Share).is_some() {
                    let strain = snippet::of_unit_stated("columns.strain.unit", unit, column);
                    return format!("if it is a strain, state it{strain}");
                }
                let multiple = unit_behind_number(unit).map(|_| format!("x{unit}"));
                if let Some(multiple) = multiple {
                    let stated = snippet::of_unit_stated(key, &multiple, column);
                    return format!(
                        "if the values are in {meant}, state {meant}; if they count {unit} each, state it{stated}"
                    );
                }
                let stated = snippet::of_unit_stated(key, meant, column);
                let doubt = match meant == quantity.usual_unit() {
                    true => format!("the values are in {meant}"),
                    false => format!("\"{unit}\" stands for {meant}"),
                };
                let preset = match meant {
                    "gf" => " (of a TA.XT instead: machine.preset = \"ta-xtplus-grams\")",
                    _ => "",
                };
                format!("if {doubt}, state it{preset}{stated}")
            }
            Self::Unknown(_, unit) if key == "columns.force.unit" && column.name.as_deref() == Some(UNCALIBRATED) => {
                snippet::of_bending(column, unit)
            }
            Self::Unknown(quantity, unit) => {
                let table = key.rsplit_once('.').map_or("columns", |(table, _)| table);
                format!(
                    "give the scale of a volt in a test description:\n[{table}]\nunit = \"{unit}\"\nscale = \"1 {}/V\"\ncolumn = {}",
                    quantity.usual_unit(),
                    column.number
                )
            }
            Self::NoSpringConstant { height, .. } => snippet::of_deflection(column, *height),
            Self::OfMachine { written, .. } => format!(
                "choose another of `palpate inspect --machines`, or write in the test description:\n{}",
                snippet::of_unit(key, written, column)
            ),
            Self::NoVolts(_) => format!(
                "remove `scale`; if the header is wrong and the column holds volts, write:\n{}",
                snippet::of_unit_and_column(key, "V", column)
            ),
            Self::Two([_, (unit, _)]) => format!("state the right one{}", snippet::of_unit_stated(key, unit, column)),
            Self::Serials(unit, _) => {
                format!(
                    "if they are {unit}, state {unit}; if they are days, state it{}",
                    snippet::of_unit_stated(key, "d", column)
                )
            }
            Self::Clock(_) => format!(
                "state the unit of the last field: s of minutes and seconds, min of hours and minutes{}",
                snippet::of_unit_stated(key, "s", column)
            ),
            Self::Multiples(quantity) => {
                let unit = quantity.usual_unit();
                let stated = snippet::of_unit_stated(key, &format!("x10^-3 {unit}"), column);
                format!(
                    "if the values are in {unit}, state {unit}; if they count so much of it, state such a unit{stated}"
                )
            }
        }
    }
}

/// The first few of some columns.
fn listed<'c>(
    columns: impl IntoIterator<Item = &'c NamedColumn, IntoIter: ExactSizeIterator>,
    between: &str,
) -> String {
    let columns = columns.into_iter();
    let between = if columns.len() > snippet::MOST { ", " } else { between };
    few(columns.map(ToString::to_string), snippet::MOST, between)
}

fn is_displacement(columns: &[NamedColumn]) -> &'static str {
    if columns.len() == 1 { "is the displacement" } else { "is the displacement, if any" }
}

/// What the header says instead of units: nothing, or something in brackets that is none.
fn none(columns: &[(String, &'static str, NamedColumn)]) -> &'static str {
    let bracketed = |name: &str| name.trim_end().ends_with(')');
    if columns.iter().any(|(_, _, column)| column.name.as_deref().is_some_and(bracketed)) {
        "no known unit in the header"
    } else {
        "none in the header"
    }
}

/// Where a row stands in a file, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Counted {
    /// A line of a text.
    Line(usize),
    /// A row of a sheet or a table.
    Row(usize),
}

impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Row(row) => write!(f, "row {row}"),
        }
    }
}

/// Why a file gives no record.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not clear which column holds what.
    #[error("{}: {source}", path.display())]
    Column {
        /// The record.
        path: PathBuf,
        /// What is not clear.
        source: ColumnError,
    },
    /// The numbers make no record.
    #[error("{}{}{}: {}", path.display(), behind_comma(part.as_ref()), behind_comma(line.as_ref()), stated(source, line.is_some()))]
    Record {
        /// The file.
        path: PathBuf,
        /// The part of the file, where it has several.
        part: Option<String>,
        /// Where in the file, where one row is to blame.
        line: Option<Counted>,
        /// What is wrong.
        source: RecordError,
    },
    /// The force never changes and there is no displacement, but a strain without a unit.
    #[error("{}: {source}", path.display())]
    Strain {
        /// The file.
        path: PathBuf,
        /// Number of the column of the strain, from 1.
        column: usize,
        /// What is wrong.
        source: RecordError,
    },
    /// The file holds several tests and none was chosen.
    #[error("{}: expected one test, found {}: {}", path.display(), parts.len(), first(parts))]
    SeveralParts {
        /// The file.
        path: PathBuf,
        /// Their names.
        parts: Vec<String>,
    },
    /// The file holds no test of the name that was given.
    #[error("{}: expected {}, found \"{found}\"", path.display(), one_of_parts(parts))]
    NoSuchPart {
        /// The file.
        path: PathBuf,
        /// What was requested.
        found: String,
        /// The names there are.
        parts: Vec<String>,
    },
}

impl ReadError {
    /// What would help, if that is known.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::File(error) => error.hint(),
            Self::Column { source, .. } => Some(source.hint()),
            Self::Strain { column, .. } => Some(format!(
                "the body creeps: give the strain its unit: --columns \"strain={column}:%\", or in a test description:\n\
                 [columns.strain]\ncolumn = {column}\nunit = \"%\"  # or \"1\""
            )),
            Self::Record { source, .. } => Some(source.hint().to_owned()),
            Self::SeveralParts { parts, .. } => {
                let first = parts.first().map_or("1", String::as_str);
                Some(format!(
                    "choose one by its name or number: --part \"{first}\", or in a test description:\n[file]\npart = \"{first}\""
                ))
            }
            Self::NoSuchPart { parts, .. } if parts.len() == 1 => {
                Some("omit the part: the file holds one test".to_owned())
            }
            Self::NoSuchPart { parts, .. } => {
                Some(format!("give the name of a part as in the file, or its number from 1 to {}", parts.len()))
            }
        }
    }
}

fn behind_comma(what: Option<&impl fmt::Display>) -> String {
    what.map_or_else(String::new, |what| format!(", {what}"))
}

/// What could be stated of a file with these parts.
fn one_of_parts(parts: &[String]) -> String {
    let numbered = parts.iter().enumerate().map(|(index, part)| format!("{} (\"{}\")", index + 1, shown(part)));
    match parts.len() {
        1 => "the one test that the file holds".to_owned(),
        _ => format!("one of {} parts, {}", parts.len(), few(numbered, 12, ", ")),
    }
}

/// The first few names of parts.
fn first(parts: &[String]) -> String {
    few(parts.iter().map(|part| format!("\"{}\"", shown(part))), 5, ", ")
}

/// The message of a record error; less its row where a line of the file is known, which says more. Records count their
/// rows from 0, files from 1.
fn stated(error: &RecordError, placed: bool) -> String {
    let message = error.to_string();
    let row = error.row().and_then(|row| Some((message.strip_suffix(&format!(" in row {row}"))?, row + 1)));
    match (row, placed) {
        (Some((short, _)), true) => short.to_owned(),
        (Some((short, row)), false) => format!("{short} in row {row}"),
        (None, _) => message,
    }
}
