//! What the columns of a record are like before anything is done to them.
//!
//! | file | what |
//! |---|---|
//! | `stamps.rs` | time stamps: interval, gaps, repeated and reversed ones |
//! | `values.rs` | measured columns: rows that stray, saturation, rounding |
//! | `plateau.rs` | plateaus of a force that was clipped before its amplifier |
//! | `astray.rs` | rows that stray |
//! | `rounding.rs` | the step that values were rounded to |

mod astray;
mod plateau;
mod rounding;
mod stamps;
mod values;

pub(crate) use astray::Astray;
pub(super) use astray::{bridge, runs_of};
pub use rounding::rounding_step;
use rounding::rounding_step_heard;
pub(super) use stamps::gap_rows;
pub use stamps::{Gaps, Reversals, SampleInterval, Stamps};
pub use values::{Saturation, Strays, Values};

use std::convert::Infallible;

use serde::{Deserialize, Serialize};

use crate::record::correction::Column;

/// What the columns of a record are like; SI units.
///
/// An examination looks and says; it changes nothing. It takes columns that would make no record, too: values that are
/// not finite are counted and passed over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SignalReport {
    /// Time stamps: of all columns, or of the displacement where the force has its own.
    pub stamps: Stamps,
    /// Time stamps of the force alone, where it has its own.
    pub force_stamps: Option<Stamps>,
    /// The displacement, m.
    pub displacement: Option<Values>,
    /// The force, N.
    pub force: Values,
}

impl SignalReport {
    /// Examines columns: time in s, displacement in m, force in N, which may have a time of its own.
    ///
    /// Costs O(n log n) for n rows.
    ///
    /// ```
    /// use palpate::record::SignalReport;
    /// let time: Vec<f64> = [0, 1, 2, 3, 3, 9, 10, 11].map(f64::from).to_vec();
    /// let report = SignalReport::of(&time, None, &[0.0, 0.0, 2.0, 4.0, 4.0, 3.0, 2.5, 2.0], None);
    /// assert_eq!((report.stamps.repeated, report.stamps.gaps.count), (1, 1));
    /// assert_eq!(report.stamps.gaps.longest, 6.0);
    /// ```
    #[must_use]
    pub fn of(time: &[f64], displacement: Option<&[f64]>, force: &[f64], force_time: Option<&[f64]>) -> Self {
        let Ok(report) = Self::heard(time, displacement, force, force_time, &mut || Ok::<(), Infallible>(()));
        report
    }

    /// The same, where `hear` says in between whether to go on: columns of millions of rows take a second.
    ///
    /// # Errors
    /// What `hear` says.
    pub(super) fn heard<E>(
        time: &[f64],
        displacement: Option<&[f64]>,
        force: &[f64],
        force_time: Option<&[f64]>,
        hear: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        // Columns of different lengths or clocks, or in another order than that of time, cannot judge each other.
        let together = displacement.filter(|values| values.len() == force.len() && force_time.is_none());
        hear()?;
        let (stamps, force_stamps) = (Stamps::of(time), force_time.map(Stamps::of));
        let beside = together.map(|_| force);
        let displacement =
            displacement.map(|values| Values::heard(Column::Displacement, values, beside, hear)).transpose()?;
        Ok(Self {
            stamps,
            force_stamps,
            displacement,
            force: Values::heard(Column::Force, force, together, hear)?,
        })
    }
}
