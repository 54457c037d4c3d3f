//! Reading a record.

use std::path::{Path, PathBuf};

use palpate::{
    number::significant,
    record::{Correction, LabelledSegment, RawColumns, Record, RecordError, SignalReport},
    units,
};

use super::{
    choose,
    column_use::{ColumnUse, Role},
    error::{ColumnError, Counted, ReadError, UnitProblem},
    flow,
    named::NamedColumn,
    parts, snippet,
};
use crate::{
    FileError,
    description::TestDescription,
    input::Packing,
    naming::{Quantity, unit_factor},
    open::{Contents, Format},
    table::{Columns, Heard, IgnoredLines, Part, epoch, recognise},
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
    pub format: Format,
    /// How the file is packed.
    pub packing: Packing,
    /// The part of the file that is this test.
    pub part: Part,
    /// When the time of the record is zero, in s since 1970, or since midnight of a time of day, where the file counts from there.
    pub start: Option<f64>,
    /// The file has no time: so many rows a second, Hz.
    pub rate: Option<f64>,
    /// Rows of the test. Where displacement and force have clocks of their own, the record can have fewer.
    pub rows: usize,
    /// How many successive rows each sample of the record is the mean of; 1 unless the file is very long.
    pub averaged: usize,
    /// Skipped lines of the file.
    pub ignored: IgnoredLines,
    /// The file holds stress and no section is known: the force of the record is that on 1 m².
    pub per_unit_area: bool,
    /// Size of the file in bytes.
    pub bytes: u64,
}

/// Reads the record in the file at `path`, of any format.
///
/// The columns and units are those of `description`; omitted ones follow from the header, which
/// is understood in English, German, French, Spanish, Italian, Russian, Chinese, Japanese and Korean. Anything still missing is an error that
/// names it; a unit is never guessed. Commands and limits (`GoalForce`, `Force max`) are not measurements, and
/// stress is used only where there is no force or the description requests it.
///
/// `progress` receives the bytes read and the total, and ends the reading where it returns an error.
///
/// ```
/// use palpate_files::record::read_record;
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("press.csv");
/// std::fs::write(&path, "Time (s),Weg (mm),Kraft (N)\n0,0,0\n1,5,12\n2,5,9\n")?;
/// let file = read_record(&path, None, &mut |_done, _total| Ok(()))?;
/// assert_eq!(file.record.displacement(), Some([0.0, 0.005, 0.005].as_slice()));
/// assert_eq!(file.columns[1].name.as_deref(), Some("Weg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReadError`] where the file cannot be read or holds several tests of which none is chosen, where it is not clear
/// which column holds what, or where the numbers make no record, with the line.
pub fn read_record(
    path: &Path,
    description: Option<&TestDescription>,
    progress: &mut Heard<'_>,
) -> Result<RecordFile, ReadError> {
    let usual = TestDescription::default();
    let test = description.unwrap_or(&usual);
    let contents = Contents::open(path, &test.reading)?;
    let tests = parts::tests(&contents, test)?;
    match tests.parts[..] {
        [only] => read_part(&contents, only, description, progress),
        ref several => Err(ReadError::SeveralParts {
            path: path.to_owned(),
            parts: several.iter().map(|part| contents.parts[*part].title().to_owned()).collect(),
        }),
    }
}

impl RecordFile {
    /// The option that gives the column of a quantity (`force`, `displacement`) the opposite sign: `--columns "force=Kraft:-N"`. None where its
    /// unit cannot stand in an option.
    #[must_use]
    pub fn with_other_sign(&self, quantity: &str) -> Option<String> {
        let is_meant = |used: &&ColumnUse| matches!(used.role, Role::Values(own) if own.to_string() == quantity);
        let used = self.columns.iter().find(is_meant)?;
        let (quantity, info) = (used.role.measured(), self.part.columns.get(used.number - 1)?);
        unit_factor(&used.unit, quantity.dimension())?;
        let sign = if used.sign < 0.0 { "" } else { "-" };
        let has_no_twin = info.name.as_deref().is_some_and(|name| self.part.column_named(name).is_some());
        let unit = format!("{sign}{}", used.unit);
        Some(snippet::option([snippet::entry(quantity, &info.into(), Some(&unit), has_no_twin)]))
    }
}

/// Reads the record in the part of a file with index `part`, as [`read_record`] does.
///
/// # Errors
/// As for [`read_record`].
pub fn read_part(
    contents: &Contents,
    part: usize,
    description: Option<&TestDescription>,
    progress: &mut Heard<'_>,
) -> Result<RecordFile, ReadError> {
    let usual = TestDescription::default();
    let test = description.unwrap_or(&usual);
    let path = &contents.input.name;
    let about = &contents.parts[part];
    let unclear = |source| ReadError::Column {
        path: path.to_owned(),
        source,
    };
    let mut plan = choose::choose(about, test).map_err(unclear)?;
    let numbers: Vec<usize> = plan.columns.iter().map(|column| column.number).collect();
    let mut read = contents.read(part, &numbers, progress)?;
    let mut values = std::mem::take(&mut read.values);
    for (column, values) in plan.columns.iter_mut().zip(&values) {
        if column.role.measured() != Quantity::Time {
            continue;
        }
        // The dates of a workbook are observed only now.
        column.epoch |= values.first().is_some_and(|first| epoch::since_1970(*first, column.factor).is_some());
        let is_stated = test.columns.time.as_ref().is_some_and(|time| time.unit.is_some());
        if !column.epoch && !is_stated && epoch::are_serials(values) {
            let problem = UnitProblem::Serials(column.unit.clone(), values[0].to_string());
            let info = &about.columns[column.number - 1];
            return Err(unclear(ColumnError::unit(info, "columns.time.unit".to_owned(), problem)));
        }
    }
    let dated = |column: &ColumnUse| !epoch::counts(&about.columns[column.number - 1], column.factor);
    let start = count_from_start(&plan.columns, &mut values, &dated);
    let conversion = plan.conversion;
    let series = plan.columns.iter().zip(values).map(|(column, mut values)| {
        let factor = match column.role.measured() {
            load if load.is_load() => conversion.load,
            travel if travel.is_travel() => conversion.travel,
            _ => 1.0,
        };
        to_si(&mut values, column, factor);
        (column.role, values)
    });
    let mut series: Vec<(Role, Vec<f64>)> = series.collect();
    let samples = series.first().map_or(0, |(_, values)| values.len());
    let time = plan
        .rate
        .map(|rate| (Role::Values(Quantity::Time), (0..samples).map(|row| time_of(&read, row, rate)).collect()));
    let force = conversion.constant_force.map(|force| (Role::Values(Quantity::Force), vec![force; samples]));
    series.extend(time.into_iter().chain(force));
    let (raw, bent) = assemble(series);
    let signals = raw.report_heard(&mut || progress(read.bytes, read.bytes)).map_err(FileError::from)?;
    refuse_flow((contents, part), plan.shear_rate.as_ref(), &raw.force, progress)?;
    let has_displacement = raw.displacement.is_some();
    let averaged = (read.averaged > 1).then(|| Correction::RowsAveraged {
        rows: read.rows(),
        averaged: read.averaged,
    });
    let lacking = std::mem::take(&mut read.ignored.lacking);
    let left_out = (lacking.rows > 0).then(|| Correction::RowsLeftOut {
        rows: read.rows() + lacking.rows,
        left_out: lacking.rows,
        lines: lacking.lines,
    });
    let counted = plan.rate.map(|rate| Correction::RowsCounted { rate });
    let bent = bent.map(|largest| Correction::DeflectionRemoved { largest });
    let unused = extensometer_unused(about, &plan.columns, test);
    let done = left_out.into_iter().chain(counted).chain(conversion.done).chain(unused).chain(averaged).chain(bent);
    progress(read.bytes, read.bytes).map_err(FileError::from)?;
    let labels = if lacking.rows > 0 { Vec::new() } else { labelled(about, &raw.time, read.averaged) };
    let record = raw.into_record().map(|record| record.corrected_before(done).labelled(labels));
    let record = record.map_err(|source| refused(contents, about, &read, (has_displacement, source)))?;
    Ok(RecordFile {
        path: path.to_owned(),
        record,
        signals,
        columns: plan.columns,
        start,
        format: contents.format,
        packing: contents.input.packing.clone(),
        part: about.clone(),
        rows: read.rows(),
        averaged: read.averaged,
        ignored: read.ignored,
        per_unit_area: conversion.per_unit_area,
        rate: plan.rate,
        bytes: read.bytes,
    })
}

/// That the displacement, which nobody chose, is not that of the extensometer beside it.
fn extensometer_unused(part: &Part, columns: &[ColumnUse], test: &TestDescription) -> Option<Correction> {
    let used = columns.iter().find(|column| column.role == Role::Values(Quantity::Displacement))?;
    let extensometer = recognise::extensometer(&part.columns).filter(|column| column.number != used.number)?;
    test.columns.stated(Quantity::is_travel).is_none().then(|| Correction::ExtensometerUnused {
        column: used.name.clone().unwrap_or_default(),
        extensometer: extensometer.name.clone().unwrap_or_default(),
    })
}

/// Refuses a test of a rheometer whose shear rate is swept: a strain that comes to rest at the lowest rates is no hold.
fn refuse_flow(
    (contents, part): (&Contents, usize),
    rate: Option<&(NamedColumn, f64)>,
    stress: &[f64],
    progress: &mut Heard<'_>,
) -> Result<(), ReadError> {
    let Some((column, factor)) = rate else {
        return Ok(());
    };
    // A column with cells that are no numbers is not needed.
    let Ok(read) = contents.read(part, &[column.number], progress) else {
        return Ok(());
    };
    let swept = read.values.first().and_then(|rates| flow::swept(rates, stress));
    swept.map_or(Ok(()), |(from, to)| {
        let shown = |rate: f64| significant(rate * factor, 3);
        let source = ColumnError::FlowCurve {
            rate: column.clone(),
            from: shown(from),
            to: shown(to),
        };
        let path = contents.input.name.clone();
        Err(ReadError::Column { path, source })
    })
}

/// When the row with an index was recorded, s from the first on, at so many rows a second.
fn time_of(read: &Columns, row: usize, rate: f64) -> f64 {
    let rows = match (read.line_of(0), read.line_of(row)) {
        // Rows that were left out were recorded all the same.
        (Some(first), Some(line)) if read.ignored.lacking.rows > 0 => (line - first) as f64,
        _ => (row * read.averaged) as f64,
    };
    rows / rate
}

/// The phases that a part labels, on the clock of the record; none unless all of its labels name one.
fn labelled(part: &Part, time: &[f64], averaged: usize) -> Vec<LabelledSegment> {
    let labels = part.labels.iter().map(|label| {
        let last = label.end.div_ceil(averaged).min(time.len()).checked_sub(1)?;
        LabelledSegment::new(&label.name, *time.get(label.start / averaged)?, time[last])
    });
    labels.collect::<Option<_>>().unwrap_or_default()
}

/// Why numbers make no record, with the line, or with the strain that would be a displacement.
fn refused(
    contents: &Contents,
    about: &Part,
    read: &Columns,
    (has_displacement, source): (bool, RecordError),
) -> ReadError {
    let path = contents.input.name.clone();
    match recognise::strain(&about.columns) {
        Some(strain) if !has_displacement && matches!(source, RecordError::ConstantForce { .. }) => {
            let column = strain.number;
            ReadError::Strain { path, column, source }
        }
        _ => ReadError::Record {
            path,
            part: about.name.clone(),
            line: source.row().and_then(|row| read.line_of(row)).map(|line| counted(contents.format, line)),
            source,
        },
    }
}

/// What a format tells a row by.
fn counted(format: Format, line: usize) -> Counted {
    match format {
        Format::Text | Format::JpkText | Format::AfmTab => Counted::Line(line),
        _ => Counted::Row(line),
    }
}

/// Makes times counted from 1970 relative to the first of them, which comes back in s.
///
/// Of numbers nothing is lost that was written; differences of dates are those of what was written.
fn count_from_start(columns: &[ColumnUse], values: &mut [Vec<f64>], dated: &dyn Fn(&ColumnUse) -> bool) -> Option<f64> {
    let firsts = columns.iter().zip(&*values).filter(|(column, _)| column.epoch);
    let firsts = firsts.filter_map(|(column, values)| Some((*values.first()?, column.factor)));
    let (first, factor) = firsts.min_by(|one, other| (one.0 * one.1).total_cmp(&(other.0 * other.1)))?;
    for (column, values) in columns.iter().zip(values).filter(|(column, _)| column.epoch) {
        let origin = if column.factor == factor { first } else { first * factor / column.factor };
        let dated = column.factor == 1.0 && dated(column);
        values.iter_mut().for_each(|value| {
            *value = if dated { epoch::since(*value, origin) } else { *value - origin };
        });
    }
    Some(epoch::since_1970(first, factor).unwrap_or(first * factor))
}

fn to_si(values: &mut [f64], column: &ColumnUse, factor: f64) {
    for value in values {
        *value = units::scale(*value, column.factor);
        // Not always: 0 + -0 is 0.
        if column.offset != 0.0 {
            *value += column.offset;
        }
        *value *= factor;
        // Not by a product with the sign, which makes -0 of 0.
        if column.sign < 0.0 && *value != 0.0 {
            *value = -*value;
        }
    }
}

/// Tells columns in SI by their roles; the second is the largest deflection that was taken off the displacement.
fn assemble(mut series: Vec<(Role, Vec<f64>)>) -> (RawColumns, Option<f64>) {
    let mut take = |wanted: &dyn Fn(Role) -> bool| {
        let index = series.iter().position(|(role, _)| wanted(*role))?;
        Some(series.swap_remove(index).1)
    };
    let time = take(&|role| role == Role::Values(Quantity::Time));
    let mut displacement = take(&|role| matches!(role, Role::Values(quantity) if quantity.is_travel()));
    let added = take(&|role| role == Role::Added(Quantity::Displacement));
    for (value, more) in displacement.iter_mut().flatten().zip(added.iter().flatten()) {
        *value += more;
    }
    let deflection = take(&|role| role == Role::Deflection);
    for (value, deflection) in displacement.iter_mut().flatten().zip(deflection.iter().flatten()) {
        *value -= deflection;
    }
    let larger = |most: f64, next: &f64| if next.abs() > most.abs() { *next } else { most };
    let bent = deflection.map(|deflection| deflection.iter().fold(0.0, larger));
    let load = take(&|role| matches!(role, Role::Values(quantity) if quantity.is_load()));
    let displacement_clock = take(&|role| matches!(role, Role::ClockOf(quantity) if quantity.is_travel()));
    let load_clock = take(&|role| matches!(role, Role::ClockOf(quantity) if quantity.is_load()));
    let (time, force_time) = match (displacement_clock, load_clock, time) {
        (_, load_clock, time) if displacement.is_none() => (load_clock.or(time), None),
        (Some(own), Some(other), _) | (Some(own), None, Some(other)) | (None, Some(other), Some(own)) => {
            let differs = own != other;
            (Some(own), differs.then_some(other))
        }
        (own, other, time) => (own.or(other).or(time), None),
    };
    let raw = RawColumns {
        time: time.unwrap_or_default(),
        displacement,
        force: load.unwrap_or_default(),
        force_time,
    };
    (raw, bent)
}
