//! Reading a record.

use std::path::{Path, PathBuf};

use palpate::{
    record::{RawColumns, Record, SignalReport},
    units,
};

use super::{ColumnUse, Quantity, ReadError, Role, choose};
use crate::{
    description::TestDescription,
    text::{self, IgnoredLines, Layout},
};

/// A record and where it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFile {
    /// The file.
    pub path: PathBuf,
    /// The record, in SI, loading positive.
    pub record: Record,
    /// What its columns were like before anything was done to them; [`Record::corrections`] says what was.
    pub signals: SignalReport,
    /// Which columns it was made of.
    pub columns: Vec<ColumnUse>,
    /// How the file is written.
    pub layout: Layout,
    /// Rows of the file. Where displacement and force have clocks of their own, the record can have fewer.
    pub rows: usize,
    /// Lines of the file that were passed over.
    pub ignored: IgnoredLines,
    /// The file holds stress and no section is known: the force of the record is that on 1 m².
    pub per_unit_area: bool,
    /// Size of the file in bytes.
    pub bytes: u64,
}

/// Reads the record in the file of delimited text at `path`.
///
/// The columns and units are those that `description` says; what it leaves open is told by the header, which
/// is understood in English, German, French, Spanish, Chinese and Japanese. What neither tells is an error that
/// asks; a unit is never guessed. Commands and limits (`GoalForce`, `Force max`) are no measurements, and
/// stress is used only where there is no force or the description asks for it.
///
/// `progress` is told the bytes done and the bytes there are.
///
/// ```
/// use palpate_files::record_file::read_record;
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("press.csv");
/// std::fs::write(&path, "Time (s),Weg (mm),Kraft (N)\n0,0,0\n1,5,12\n2,5,9\n")?;
/// let file = read_record(&path, None, &mut |_done, _total| {})?;
/// assert_eq!(file.record.displacement(), Some([0.0, 0.005, 0.005].as_slice()));
/// assert_eq!(file.columns[1].name.as_deref(), Some("Weg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReadError`] where the file cannot be read, where it is not clear which column holds what, or where the
/// numbers make no record, with the line.
pub fn read_record(
    path: &Path,
    description: Option<&TestDescription>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<RecordFile, ReadError> {
    let usual = TestDescription::default();
    let test = description.unwrap_or(&usual);
    let layout = text::detect(path, &test.layout)?;
    let plan = choose::choose(path, &layout, test)?;
    let numbers: Vec<usize> = plan.columns.iter().map(|column| column.number).collect();
    let mut read = text::read_columns(path, &layout, &numbers, progress)?;
    let values = std::mem::take(&mut read.values);
    let series = plan.columns.iter().zip(values).map(|(column, mut values)| {
        let section = if column.role.measured() == Quantity::Stress { plan.section } else { 1.0 };
        to_si(&mut values, column, section);
        (column.role, values)
    });
    let raw = assemble(series.collect());
    let signals = raw.report();
    let record = raw.into_record().map_err(|source| ReadError::Record {
        path: path.to_owned(),
        line: source.row().and_then(|row| read.line_of(row)),
        source,
    })?;
    Ok(RecordFile {
        path: path.to_owned(),
        record,
        signals,
        columns: plan.columns,
        layout,
        rows: read.rows(),
        ignored: read.ignored,
        per_unit_area: plan.per_unit_area,
        bytes: read.bytes,
    })
}

fn to_si(values: &mut [f64], column: &ColumnUse, section: f64) {
    for value in values {
        *value = units::scale(*value, column.factor);
        // Not always: 0 + -0 is 0.
        if column.offset != 0.0 {
            *value += column.offset;
        }
        *value *= section;
        // Not by a product with the sign, which makes -0 of 0.
        if column.sign < 0.0 && *value != 0.0 {
            *value = -*value;
        }
    }
}

/// Tells columns in SI by their roles.
fn assemble(mut series: Vec<(Role, Vec<f64>)>) -> RawColumns {
    let mut take = |wanted: &dyn Fn(Role) -> bool| {
        let index = series.iter().position(|(role, _)| wanted(*role))?;
        Some(series.swap_remove(index).1)
    };
    let is_load = |quantity| matches!(quantity, Quantity::Force | Quantity::Stress);
    let time = take(&|role| role == Role::Values(Quantity::Time));
    let displacement = take(&|role| role == Role::Values(Quantity::Displacement));
    let load = take(&|role| matches!(role, Role::Values(quantity) if is_load(quantity)));
    let displacement_clock = take(&|role| role == Role::ClockOf(Quantity::Displacement));
    let load_clock = take(&|role| matches!(role, Role::ClockOf(quantity) if is_load(quantity)));
    let (time, force_time) = match (displacement_clock, load_clock, time) {
        (_, load_clock, time) if displacement.is_none() => (load_clock.or(time), None),
        (Some(own), Some(other), _) | (Some(own), None, Some(other)) | (None, Some(other), Some(own)) => {
            let differs = own != other;
            (Some(own), differs.then_some(other))
        }
        (own, other, time) => (own.or(other).or(time), None),
    };
    RawColumns {
        time: time.unwrap_or_default(),
        displacement,
        force: load.unwrap_or_default(),
        force_time,
    }
}
