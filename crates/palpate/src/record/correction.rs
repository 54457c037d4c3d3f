//! What was done to a record, as a list that goes with it.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::number::{counted, shortest, significant};

/// Which time stamps are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clock {
    /// Those of all columns.
    Common,
    /// Those of the displacement alone.
    Displacement,
    /// Those of the force alone.
    Force,
}

/// A measured column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// Displacement.
    Displacement,
    /// Force.
    Force,
}

impl Column {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Force => "force",
        }
    }
}

/// What the force without contact is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// A constant compliance.
    Constant,
    /// A straight line in time: the load cell drifts. It is drawn on through the whole record, so that a line from a short
    /// stretch before a long test means little; samples after the jaw has left hold it at the other end.
    Sloped,
}

/// What was subtracted from a record.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Tare {
    /// Force without contact, N.
    pub force: f64,
    /// Displacement at first touch, m.
    pub displacement: f64,
    /// Growth of the force without contact with the travel from there, N/m.
    #[serde(default, skip_serializing_if = "is_none")]
    pub tilt: f64,
}

/// Whether there is no tilt.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands it a reference")]
fn is_none(tilt: &f64) -> bool {
    *tilt == 0.0
}

/// A quantity that a file gives in place of force or displacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourceQuantity {
    /// Strain: times the length of the body it is the displacement.
    Strain,
    /// Strain of a creep whose constant stress the file does not give: likewise, under a force that only stands for it.
    CreepStrain,
    /// Relaxation modulus E(t) or G(t): times the section it is the force at a strain of 1.
    Modulus,
    /// Creep compliance J(t) or D(t): times the length it is the displacement at a stress of 1 Pa.
    Compliance,
    /// Torque of a rheometer.
    Torque,
    /// Angle of a rheometer.
    Angle,
}

/// Something that was done to a record; SI units. A record carries all of them in the order in which they were done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "correction", rename_all = "snake_case")]
pub enum Correction {
    /// Rows with earlier stamps than a preceding row were sorted by time.
    StampsSorted {
        /// Whose stamps.
        clock: Clock,
        /// Rows that were moved.
        rows: usize,
        /// Largest step back, s.
        largest: f64,
    },
    /// Rows with equal stamps were merged into one with the means of their values.
    StampsMerged {
        /// Whose stamps.
        clock: Clock,
        /// Rows before.
        rows: usize,
        /// Rows that went.
        merged: usize,
        /// Those among them that repeated a row in all their values.
        identical: usize,
    },
    /// Rows of a clock that is coarser than the sampling were spread over its stamps at a constant rate, which changes where their numbers do.
    StampsSpread {
        /// Whose stamps.
        clock: Clock,
        /// Rows.
        rows: usize,
        /// Stamps among them.
        stamps: usize,
        /// From one to the next, s, without pauses.
        step: f64,
    },
    /// Rows of the file in which a cell holds no number were left out.
    RowsLeftOut {
        /// Rows of the file.
        rows: usize,
        /// Rows that were left out.
        left_out: usize,
        /// The first of their lines in the file, from 1.
        lines: Vec<usize>,
    },
    /// The file exceeds the row limit: successive rows were averaged while reading.
    RowsAveraged {
        /// Rows of the file.
        rows: usize,
        /// Of how many rows a sample is the mean.
        averaged: usize,
    },
    /// The file gives stress, and nothing the section: the force is that on 1 m².
    StressAsForce,
    /// The file gives another quantity than force or displacement, which was multiplied by a length, an area or both.
    ReadAs {
        /// The quantity.
        quantity: SourceQuantity,
        /// What it was multiplied by, SI.
        factor: f64,
    },
    /// The file has no time: the rows were counted at the rate that it states.
    RowsCounted {
        /// Rows a second, Hz.
        rate: f64,
    },
    /// The displacement is that of one column, and the file has an extensometer as well.
    ExtensometerUnused {
        /// What the column is called.
        column: String,
        /// What that of the extensometer is called.
        extensometer: String,
    },
    /// Displacement and force with clocks of their own were brought onto the times of the force.
    ClocksJoined {
        /// Samples of the force outside the times of the displacement, left out.
        left_out: usize,
    },
    /// Single rows that had strayed were replaced by the mean of their neighbours.
    DropoutsReplaced {
        /// Of which column.
        column: Column,
        /// How many.
        count: usize,
    },
    /// Force and displacement are counted from first touch.
    Tared(Tare),
    /// The force of the same motion without a body was subtracted.
    AirRunSubtracted,
    /// The force was stamped later than the displacement; its values were moved to where they belong.
    SkewRemoved {
        /// How much later, s.
        skew: f64,
        /// Standard error, s, where it was estimated.
        standard_error: Option<f64>,
        /// Rows at the ends for which no force is left.
        left_out: usize,
    },
    /// What a filter of first order in the channel of the force took away was restored.
    FilterRemoved {
        /// Its time constant, s.
        time_constant: f64,
    },
    /// A second record of the same test was put behind the first.
    Continued {
        /// When the second begins, s, as the record counts time.
        from: f64,
        /// How long after the last sample of the first, s.
        gap: f64,
        /// What was added to the times of the second, s; 0 where both have one clock.
        shift: f64,
    },
    /// Sample times were made even.
    Resampled {
        /// Samples a second, Hz.
        rate: f64,
        /// Median time between samples before, s.
        interval: f64,
        /// Whether values were averaged (else interpolated).
        averaged: bool,
    },
    /// What the machine gave way was taken off the displacement.
    ComplianceRemoved {
        /// The largest deflection, m.
        largest: f64,
    },
    /// The recorded deflection of the sensor was taken off the displacement.
    DeflectionRemoved {
        /// The largest deflection, m.
        largest: f64,
    },
    /// The force without contact was taken off.
    BaselineRemoved {
        /// Of which kind.
        baseline: Baseline,
        /// Force at the first sample, N.
        level: f64,
        /// Its slope, N/s.
        slope: f64,
        /// Samples that it rests on.
        samples: usize,
    },
}

impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Common => "time stamps",
            Self::Displacement => "time stamps of the displacement",
            Self::Force => "time stamps of the force",
        })
    }
}

impl fmt::Display for Correction {
    /// In words, with lengths in mm and µm.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StampsSorted { clock, rows, largest } => {
                let late = significant(*largest, 3);
                write!(f, "{clock}: {} up to {late} s late sorted by time", counted(*rows, "row"))
            }
            Self::StampsMerged {
                clock,
                rows,
                merged,
                identical,
            } => write!(
                f,
                "{clock}: {merged} of {rows} rows merged with the row of the same stamp ({identical} identical)"
            ),
            Self::StampsSpread {
                clock,
                rows,
                stamps,
                step,
            } => {
                let step = significant(*step, 4);
                write!(f, "{clock}: {rows} rows with {stamps} stamps {step} s apart spread evenly over them")
            }
            Self::RowsLeftOut { rows, left_out, lines } => {
                let named: Vec<String> = lines.iter().map(ToString::to_string).collect();
                let line = if *left_out == 1 { "line" } else { "lines" };
                let more = if *left_out > lines.len() { ", …" } else { "" };
                let named = named.join(", ");
                write!(f, "{left_out} of {rows} rows left out, in which a cell holds no number ({line} {named}{more})")
            }
            Self::RowsAveraged { rows, averaged } => {
                write!(f, "{rows} rows of the file averaged while reading, {averaged} per sample")
            }
            Self::StressAsForce => f.write_str("stress read as the force on 1 m²: N stands for Pa"),
            Self::ReadAs { quantity, factor } => {
                let factor = significant(*factor, 4);
                match quantity {
                    SourceQuantity::Strain => write!(f, "strain times {factor} m read as the displacement"),
                    SourceQuantity::CreepStrain => write!(
                        f,
                        "strain times {factor} m read as the displacement at a constant stress, which the file does not give"
                    ),
                    SourceQuantity::Modulus => {
                        write!(f, "modulus times {factor} m² read as the force at a strain of 1")
                    }
                    SourceQuantity::Compliance => {
                        write!(f, "compliance times {factor} m Pa read as the displacement at a stress of 1 Pa")
                    }
                    SourceQuantity::Torque => {
                        write!(f, "torque times {factor} 1/m read as the force of the same shear stress at the rim")
                    }
                    SourceQuantity::Angle => {
                        write!(f, "angle times {factor} m read as the displacement of the same shear strain at the rim")
                    }
                }
            }
            Self::ExtensometerUnused { column, extensometer } => {
                write!(f, "displacement read from \"{column}\", not from the extensometer \"{extensometer}\"")
            }
            Self::RowsCounted { rate } => write!(f, "time counted from the rows at {} Hz", shortest(*rate, 6)),
            Self::ClocksJoined { left_out } => {
                let left_out = counted(*left_out, "row");
                write!(f, "displacement interpolated at the times of the force, {left_out} of the force left out")
            }
            Self::DropoutsReplaced { column, count } => {
                let (rows, column) = (counted(*count, "row"), column.name());
                write!(f, "{rows} of the {column} replaced by the line between the rows beside")
            }
            Self::Tared(tare) => {
                let (displacement, force) = (significant(1e3 * tare.displacement, 4), significant(tare.force, 4));
                write!(f, "measured from first touch at {displacement} mm and {force} N")?;
                if tare.tilt == 0.0 {
                    Ok(())
                } else {
                    write!(f, ", less {} N/m of travel", significant(tare.tilt, 3))
                }
            }
            Self::Continued { from, gap, shift } => {
                let (from, gap) = (significant(*from, 6), significant(*gap, 3));
                write!(f, "a second record follows from {from} s, {gap} s after the first ends; ")?;
                if *shift == 0.0 {
                    f.write_str("its times are on the same clock and unchanged")
                } else {
                    write!(f, "{} s were added to its times", significant(*shift, 6))
                }
            }
            Self::AirRunSubtracted => f.write_str("force of the air run subtracted"),
            Self::SkewRemoved { skew, left_out, .. } => {
                let (moved, left_out) = (significant(1e3 * skew, 4), counted(*left_out, "row"));
                write!(f, "force shifted by {moved} ms towards earlier times, {left_out} left out")
            }
            Self::FilterRemoved { time_constant } => {
                let time_constant = significant(*time_constant, 4);
                write!(f, "force restored from behind a filter with a time constant of {time_constant} s")
            }
            Self::Resampled {
                rate,
                interval,
                averaged,
            } => {
                let how = if *averaged { "means" } else { "straight lines" };
                let (rate, interval) = (shortest(*rate, 6), significant(*interval, 3));
                write!(f, "resampled to {rate} Hz by {how}, from a sample every {interval} s")
            }
            Self::ComplianceRemoved { largest } => {
                write!(
                    f,
                    "up to {} µm of machine compliance subtracted from the displacement",
                    significant(1e6 * largest, 4)
                )
            }
            Self::DeflectionRemoved { largest } => {
                write!(f, "up to {} µm of deflection subtracted from the displacement", significant(1e6 * largest, 4))
            }
            Self::BaselineRemoved {
                baseline,
                level,
                slope,
                samples,
            } => {
                let level = significant(*level, 4);
                let slope = match baseline {
                    Baseline::Constant => String::new(),
                    Baseline::Sloped => format!(" and {} N/s", significant(*slope, 3)),
                };
                write!(f, "baseline of {level} N{slope} subtracted from the force ({})", counted(*samples, "sample"))
            }
        }
    }
}
