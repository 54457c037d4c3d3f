//! What every record must be.

use crate::number::significant;

/// Columns that make no record. Rows count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// Columns of different lengths.
    #[error("columns must be of equal length, found {time} times, {other} values of {column}")]
    Lengths {
        /// Number of times.
        time: usize,
        /// The other column.
        column: &'static str,
        /// Its number of values.
        other: usize,
    },
    /// Too few rows.
    #[error("a record needs {needed} rows or more, found {found}")]
    TooShort {
        /// Least number of rows.
        needed: usize,
        /// Rows found.
        found: usize,
    },
    /// NaN or infinity.
    #[error("{column} must be a finite number, found {found} in row {row}")]
    NotFinite {
        /// Which column.
        column: &'static str,
        /// Which row.
        row: usize,
        /// The value.
        found: f64,
    },
    /// A number that no sensor measures.
    #[error(
        "{column} must be a measured value, found {found:e} in row {row}, which instruments write for a missing value"
    )]
    NoMeasurement {
        /// Which column.
        column: &'static str,
        /// Which row.
        row: usize,
        /// The value.
        found: f64,
    },
    /// A clock that never moves.
    #[error("time must rise from row to row, found {found} s in all {rows} rows")]
    ClockStands {
        /// The one time, s.
        found: f64,
        /// Number of rows.
        rows: usize,
    },
    /// Time does not rise.
    #[error("time must rise from row to row, found {found} s after {before} s in row {row}")]
    TimeNotRising {
        /// Which row.
        row: usize,
        /// Time of the row before, s.
        before: f64,
        /// Time found, s.
        found: f64,
    },
    /// Rows in no order of time, as no clock writes them.
    #[error(
        "time must rise from row to row, found {steps} of {rows} rows that are earlier than the row before, first {found} s after \
         {before} s in row {row}"
    )]
    NotInOrder {
        /// First row that is stamped earlier than the one before it.
        row: usize,
        /// Time of the row before, s.
        before: f64,
        /// Time found, s.
        found: f64,
        /// Rows that are stamped earlier than the one before them.
        steps: usize,
        /// All rows.
        rows: usize,
    },
    /// More than a slip of a buffer: nothing says which stamps are right.
    #[error(
        "time must rise from row to row, found a clock that steps back by up to {largest} s ({late} of {rows} rows are earlier \
         than a preceding row), first to {found} s after {before} s in row {row}"
    )]
    ClockGoesBack {
        /// First row that is stamped earlier than one before it.
        row: usize,
        /// Time of the row before, s.
        before: f64,
        /// Time found, s.
        found: f64,
        /// Rows that are stamped earlier than a row before them.
        late: usize,
        /// All rows.
        rows: usize,
        /// The longest way back, s.
        largest: f64,
    },
    /// A rate that makes too few rows, or too many.
    #[error("{rate} samples per second over {duration} s give no valid record: expected 2 to 100000000 rows")]
    Rate {
        /// Samples a second, Hz.
        rate: f64,
        /// Length of the record, s.
        duration: f64,
    },
    /// A filter that no record of this length shows.
    #[error(
        "the time constant of the filter of the force must be above 0 and below the {lasts} s of the record, found {found} s"
    )]
    TimeConstant {
        /// The time constant, s.
        found: f64,
        /// Length of the record, s.
        lasts: f64,
    },
    /// A force that the table of a machine's compliance does not reach.
    #[error("the force must lie within the table of compliance, {low} to {high} N, found {found} N in row {row}")]
    OutsideTable {
        /// Which row.
        row: usize,
        /// The force, N.
        found: f64,
        /// Least force of the table, N.
        low: f64,
        /// Largest force of the table, N.
        high: f64,
    },
    /// An air run that is not the same motion.
    #[error(
        "the air run must repeat the motion: at {time} s the jaw has moved {} mm, in the air run {} mm",
        significant(1e3 * expected, 4),
        significant(1e3 * found, 4)
    )]
    AirRunDiffers {
        /// When they are farthest apart, s.
        time: f64,
        /// Way of the jaw of the record, m.
        expected: f64,
        /// Way of the jaw of the air run, m.
        found: f64,
    },
    /// Of two records of one test, one has a displacement.
    #[error("the {without} of the two records has no displacement, the other has one")]
    ContinuedWithout {
        /// `first` or `second`.
        without: &'static str,
    },
    /// An air run that ends too early.
    #[error("the air run lasts {found} s, the motion of the record {needed} s")]
    AirRunShort {
        /// Length of the air run, s.
        found: f64,
        /// Length of the motion, s.
        needed: f64,
    },
    /// Nothing shows the force without contact.
    #[error("a baseline needs {needed} or more samples without contact, found {found}")]
    NoBaseline {
        /// Least number.
        needed: usize,
        /// Samples found.
        found: usize,
    },
    /// A constant force, which contains no relaxation.
    #[error("the force is {found} N in all {rows} rows: there is no relaxation")]
    ConstantForce {
        /// The one value, N.
        found: f64,
        /// Number of rows.
        rows: usize,
    },
    /// Two clocks that share no time.
    #[error(
        "displacement ({displacement_from} to {displacement_until} s) and force ({force_from} to {force_until} s) do not overlap in time"
    )]
    ClocksApart {
        /// First time stamp of the displacement, s.
        displacement_from: f64,
        /// Last time stamp of the displacement, s.
        displacement_until: f64,
        /// First time stamp of the force, s.
        force_from: f64,
        /// Last time stamp of the force, s.
        force_until: f64,
    },
}

impl RecordError {
    /// The row that is wrong, counted from 0, where there is one.
    #[must_use]
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::NotFinite { row, .. }
            | Self::NoMeasurement { row, .. }
            | Self::TimeNotRising { row, .. }
            | Self::ClockGoesBack { row, .. }
            | Self::NotInOrder { row, .. }
            | Self::OutsideTable { row, .. } => Some(*row),
            _ => None,
        }
    }

    /// What would help.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Lengths { .. } => "give all columns the same number of rows",
            Self::TooShort { .. } => "check that the whole table was exported and that the right table is read",
            Self::NotFinite { .. } | Self::NoMeasurement { .. } => {
                "remove the row, or export the record again without gaps"
            }
            Self::ClockStands { .. } => "choose the time column, or write the time with more digits",
            Self::TimeNotRising { .. } => "sort the rows by time and drop repeated stamps, or check the time column",
            Self::ClockGoesBack { largest, .. } if (80_000.0..86_400.5).contains(largest) => {
                "the test ran past midnight: export dates with the times of day, or seconds"
            }
            Self::ClockGoesBack { late, rows, .. } if late + 1 >= *rows => {
                "the rows are in reverse order: reverse them, or check the time column"
            }
            Self::NotInOrder { .. } => "sort the rows by time, those of each test alone, or check the time column",
            Self::ClockGoesBack { .. } => {
                "if the clock restarts, the file holds several tests: name each in a column test_id, or split it there; otherwise check the time column"
            }
            Self::Rate { .. } => "resample at a rate between about one sample per second and the rate of the record",
            Self::TimeConstant { .. } => "check its unit; a corner frequency f is a time constant of 1/(2π f)",
            Self::OutsideTable { .. } => {
                "measure the compliance over all forces of the test, tare the force, or give a constant compliance"
            }
            Self::AirRunDiffers { .. } | Self::AirRunShort { .. } => {
                "record the air run with the complete program of the test"
            }
            Self::ContinuedWithout { .. } => "name the displacement of both files, which must have the same columns",
            Self::NoBaseline { .. } => "give a time window without contact (baseline_window), or omit the baseline",
            Self::ConstantForce { .. } => {
                "check the force column and that the load cell was connected; creep under constant force needs a \
                 displacement column (for a strain, give travel_per_unit)"
            }
            Self::ClocksApart { .. } => "check units and columns of the two clocks",
        }
    }
}

pub(super) fn lengths(time: &[f64], displacement: Option<&[f64]>, force: &[f64]) -> Result<(), RecordError> {
    same_length(time.len(), "displacement", displacement.map_or(time.len(), <[f64]>::len))?;
    same_length(time.len(), "force", force.len())?;
    long_enough(time.len())
}

pub(super) fn same_length(time: usize, column: &'static str, other: usize) -> Result<(), RecordError> {
    if other == time { Ok(()) } else { Err(RecordError::Lengths { time, column, other }) }
}

pub(super) fn long_enough(rows: usize) -> Result<(), RecordError> {
    if rows < 2 {
        return Err(RecordError::TooShort { needed: 2, found: rows });
    }
    Ok(())
}

pub(super) fn finite(column: &'static str, values: &[f64]) -> Result<(), RecordError> {
    let found = |wrong: fn(&f64) -> bool| values.iter().position(wrong).map(|row| (row, values[row]));
    if let Some((row, found)) = found(|value| !value.is_finite()) {
        return Err(RecordError::NotFinite { column, row, found });
    }
    match found(|value| value.abs() >= NONE) {
        Some((row, found)) => Err(RecordError::NoMeasurement { column, row, found }),
        None => Ok(()),
    }
}

/// What no sensor measures in SI, and instruments write where they have no value: 9.91e37, 3.4e38, 1e308.
const NONE: f64 = 1e30;

pub(super) fn rising(time: &[f64]) -> Result<(), RecordError> {
    match time.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(before) => Err(RecordError::TimeNotRising {
            row: before + 1,
            before: time[before],
            found: time[before + 1],
        }),
        None => Ok(()),
    }
}

/// A force that never changes says nothing, unless it is one and a body creeps under it.
pub(super) fn changing(displacement: Option<&[f64]>, force: &[f64]) -> Result<(), RecordError> {
    let is_constant = |values: &[f64]| values.iter().all(|value| *value == values[0]);
    if is_constant(force) && (force[0] == 0.0 || displacement.is_none_or(is_constant)) {
        return Err(RecordError::ConstantForce {
            found: force[0],
            rows: force.len(),
        });
    }
    Ok(())
}
