//! What the machine itself gives way under the force.

use serde::{Deserialize, Serialize};

use crate::record::{Correction, Record, RecordError};

/// Compliance of the machine (frame, load cell, grips, cantilever).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compliance {
    /// In proportion to the force, m/N. The deflection of an AFM cantilever of spring constant k is of this kind: 1/k.
    Constant(f64),
    /// By a table.
    Table(ComplianceTable),
}

/// Force (N) and deflection of the machine (m), straight between its rows. Beyond its ends nothing is known, but for a
/// hundredth of its span, where the outer lines go on: the noise of a force of zero lies outside a table that begins there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<(f64, f64)>")]
pub struct ComplianceTable(Vec<(f64, f64)>);

/// How far the outer lines of a table go on, as a share of its span.
const BEYOND: f64 = 0.01;

/// An invalid compliance of a machine. Rows count from 1.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ComplianceError {
    /// The compliance must not be negative.
    #[error("expected a compliance of 0 m/N or more, found {0} m/N")]
    Negative(f64),
    /// One row is no table.
    #[error("expected two rows or more of force and deflection, found {0}")]
    TooShort(usize),
    /// NaN or infinity.
    #[error("expected finite numbers, found {force} N and {deflection} m in row {row}")]
    NotFinite {
        /// The row.
        row: usize,
        /// Force, N.
        force: f64,
        /// Deflection, m.
        deflection: f64,
    },
    /// Forces must rise, and deflections must not fall.
    #[error(
        "expected forces that rise and deflections that do not fall from row to row, found {force} N and {deflection} m after {force_before} N and {deflection_before} m in row {row}"
    )]
    NotMonotone {
        /// The row.
        row: usize,
        /// Force before, N.
        force_before: f64,
        /// Deflection before, m.
        deflection_before: f64,
        /// Force, N.
        force: f64,
        /// Deflection, m.
        deflection: f64,
    },
}

impl Compliance {
    /// A deflection in proportion to the force.
    ///
    /// # Errors
    /// [`ComplianceError::Negative`] for a negative number, NaN or infinity.
    pub fn constant(compliance: f64) -> Result<Self, ComplianceError> {
        if compliance >= 0.0 && compliance.is_finite() {
            Ok(Self::Constant(compliance))
        } else {
            Err(ComplianceError::Negative(compliance))
        }
    }

    /// Deflection (m) under `force` (N); `None` well outside a table.
    #[must_use]
    pub fn deflection(&self, force: f64) -> Option<f64> {
        match self {
            Self::Constant(compliance) => Some(compliance * force),
            Self::Table(table) => table.deflection(force),
        }
    }
}

impl ComplianceTable {
    /// A table of (force, deflection) in N and m.
    ///
    /// # Errors
    /// [`ComplianceError`] for fewer than two rows, numbers that are not finite, forces that do not rise, and deflections
    /// that fall.
    pub fn new(rows: Vec<(f64, f64)>) -> Result<Self, ComplianceError> {
        if rows.len() < 2 {
            return Err(ComplianceError::TooShort(rows.len()));
        }
        for (row, &(force, deflection)) in (1..).zip(&rows) {
            if !(force.is_finite() && deflection.is_finite()) {
                return Err(ComplianceError::NotFinite { row, force, deflection });
            }
        }
        for (row, pair) in (2..).zip(rows.windows(2)) {
            let [(force_before, deflection_before), (force, deflection)] = [pair[0], pair[1]];
            if force <= force_before || deflection < deflection_before {
                return Err(ComplianceError::NotMonotone {
                    row,
                    force_before,
                    deflection_before,
                    force,
                    deflection,
                });
            }
        }
        Ok(Self(rows))
    }

    /// Smallest and largest force, N.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        (self.0[0].0, self.0[self.0.len() - 1].0)
    }

    /// Deflection (m) under `force` (N); `None` more than a hundredth of its span outside the table.
    #[must_use]
    pub fn deflection(&self, force: f64) -> Option<f64> {
        let (low, high) = self.range();
        let beyond = BEYOND * (high - low);
        if !(low - beyond..=high + beyond).contains(&force) {
            return None;
        }
        let after = self.0.partition_point(|row| row.0 < force).clamp(1, self.0.len() - 1);
        let [(f0, d0), (f1, d1)] = [self.0[after - 1], self.0[after]];
        Some(d0 + (d1 - d0) * (force - f0) / (f1 - f0))
    }
}

impl TryFrom<Vec<(f64, f64)>> for ComplianceTable {
    type Error = ComplianceError;

    fn try_from(rows: Vec<(f64, f64)>) -> Result<Self, ComplianceError> {
        Self::new(rows)
    }
}

impl Record {
    /// The record with the deflection of the machine subtracted from the displacement, which is then that of the body.
    ///
    /// d − C F, or d − δ(F) by a table. The force must count from zero, which matters for a table only: a constant shift
    /// of the force shifts the displacement by a constant. A record without displacement stays as it is.
    ///
    /// ```
    /// use palpate::record::{Compliance, Record};
    /// let record = Record::new(vec![0.0, 1.0], Some(vec![0.0, 1e-3]), vec![0.0, 20.0])?;
    /// // a cantilever or frame of 2 N/mm gives way by 1/k
    /// let net = record.without_compliance(&Compliance::Constant(1.0 / 40e3))?;
    /// assert_eq!(net.displacement(), Some([0.0, 0.5e-3].as_slice()));
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError::OutsideTable`] for a force outside the table.
    pub fn without_compliance(&self, compliance: &Compliance) -> Result<Self, RecordError> {
        let Some(displacement) = self.displacement() else {
            return Ok(self.clone());
        };
        let mut net = Vec::with_capacity(self.len());
        let mut most = 0.0f64;
        for (row, (travel, force)) in displacement.iter().zip(&self.force).enumerate() {
            let deflection = compliance.deflection(*force).ok_or_else(|| self.outside(compliance, row))?;
            most = if deflection.abs() > most.abs() { deflection } else { most };
            net.push(travel - deflection);
        }
        let done = Correction::ComplianceRemoved { largest: most };
        self.with(self.time.clone(), Some(net), self.force.clone(), done)
    }

    fn outside(&self, compliance: &Compliance, row: usize) -> RecordError {
        let (low, high) = match compliance {
            Compliance::Table(table) => table.range(),
            Compliance::Constant(_) => (f64::NEG_INFINITY, f64::INFINITY),
        };
        RecordError::OutsideTable {
            row,
            found: self.force[row],
            low,
            high,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Record {
        Record::new(vec![0.0, 1.0, 2.0], Some(vec![0.0, 2e-3, 2e-3]), vec![0.0, 8.0, 6.0]).unwrap()
    }

    #[test]
    fn a_table_is_straight_between_its_rows_and_nothing_outside() {
        let table = ComplianceTable::new(vec![(0.0, 0.0), (4.0, 2e-4), (10.0, 3e-4)]).unwrap();
        assert_eq!(table.deflection(2.0), Some(1e-4));
        assert!((table.deflection(7.0).unwrap() - 2.5e-4).abs() < 1e-18);
        assert_eq!((table.deflection(10.0), table.deflection(10.2), table.deflection(-0.2)), (Some(3e-4), None, None));
        let net = record().without_compliance(&Compliance::Table(table)).unwrap();
        assert!((net.displacement().unwrap()[2] - (2e-3 - 2e-4 - 1e-4 / 3.0)).abs() < 1e-15);
        assert!(matches!(net.corrections(), [Correction::ComplianceRemoved { .. }]));
        let short = Compliance::Table(ComplianceTable::new(vec![(0.0, 0.0), (7.0, 1e-4)]).unwrap());
        let error = record().without_compliance(&short).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the force must lie within the table of compliance, 0 to 7 N, found 8 N in row 1"
        );
    }

    /// A table that begins at 0 N refused every record whose zero has noise.
    #[test]
    fn noise_about_zero_lies_on_the_first_line_of_a_table() {
        let table = ComplianceTable::new(vec![(0.0, 0.0), (4.0, 2e-4), (10.0, 3e-4)]).unwrap();
        assert!((table.deflection(-0.05).unwrap() + 2.5e-6).abs() < 1e-18);
        assert!((table.deflection(10.09).unwrap() - 3.015e-4).abs() < 1e-18);
    }

    #[test]
    fn wrong_tables_are_refused() {
        let refused = |rows: &[(f64, f64)]| ComplianceTable::new(rows.to_vec()).unwrap_err();
        assert_eq!(refused(&[(0.0, 0.0)]), ComplianceError::TooShort(1));
        assert!(matches!(refused(&[(0.0, 0.0), (0.0, 1.0)]), ComplianceError::NotMonotone { row: 2, .. }));
        assert!(matches!(refused(&[(0.0, 1.0), (1.0, 0.0)]), ComplianceError::NotMonotone { row: 2, .. }));
        assert!(matches!(refused(&[(0.0, 0.0), (f64::NAN, 0.0)]), ComplianceError::NotFinite { row: 2, .. }));
        assert!(Compliance::constant(-1e-6).is_err() && Compliance::constant(f64::NAN).is_err());
    }
}
