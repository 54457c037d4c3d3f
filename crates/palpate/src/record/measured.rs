//! The record itself.

use super::checks::{self, RecordError};
use super::{Correction, LabelledSegment, SignalReport};
use crate::statistics::median;

/// A force record of a squeeze-and-hold test; SI units, the direction of loading is positive.
///
/// The direction of loading is compression for a squeezed body and stretch for a strip in grips; displacement and
/// force share it. A record may lack the displacement (phases are then found from the force).
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub(super) time: Vec<f64>,
    pub(super) displacement: Option<Vec<f64>>,
    pub(super) force: Vec<f64>,
    pub(super) corrections: Vec<Correction>,
    pub(super) labels: Vec<LabelledSegment>,
}

impl Record {
    /// A record from columns of equal length: time in s, displacement in m, force in N.
    ///
    /// # Errors
    /// [`RecordError`] for unequal lengths, fewer than two rows, values that are not finite, time that does not rise,
    /// or a force that never changes while nothing moves.
    ///
    /// ```
    /// use palpate::record::Record;
    /// let record = Record::new(vec![0.0, 0.1, 0.2], Some(vec![0.0, 1e-3, 1e-3]), vec![0.0, 2.0, 1.9])?;
    /// assert_eq!(record.len(), 3);
    /// assert!(Record::new(vec![0.0, 0.1, 0.1], None, vec![0.0, 2.0, 1.9]).is_err());
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    pub fn new(time: Vec<f64>, displacement: Option<Vec<f64>>, force: Vec<f64>) -> Result<Self, RecordError> {
        checks::lengths(&time, displacement.as_deref(), &force)?;
        checks::finite("time", &time)?;
        if let Some(displacement) = &displacement {
            checks::finite("displacement", displacement)?;
        }
        checks::finite("force", &force)?;
        checks::rising(&time)?;
        checks::changing(displacement.as_deref(), &force)?;
        Ok(Self {
            time,
            displacement,
            force,
            corrections: Vec::new(),
            labels: Vec::new(),
        })
    }

    /// What was done to the measured columns, in order. Empty for a record that is as it was measured.
    #[must_use]
    pub fn corrections(&self) -> &[Correction] {
        &self.corrections
    }

    /// Properties of the columns now; [`RawColumns::report`](crate::record::RawColumns::report) gives those before any correction.
    #[must_use]
    pub fn signals(&self) -> SignalReport {
        SignalReport::of(&self.time, self.displacement(), &self.force, None)
    }

    /// The record with corrections that were made to its columns before they became one: by the program that read them.
    #[must_use]
    pub fn corrected_before(mut self, earlier: impl IntoIterator<Item = Correction>) -> Self {
        self.corrections.splice(0..0, earlier);
        self
    }

    /// The record after one more correction.
    pub(super) fn followed_by(mut self, done: Correction) -> Self {
        self.corrections.push(done);
        self
    }

    /// Phases that the file itself names, in order; they take precedence over any that are found. Empty where it names none.
    #[must_use]
    pub fn labels(&self) -> &[LabelledSegment] {
        &self.labels
    }

    /// The record with phases that its file names.
    #[must_use]
    pub fn labelled(mut self, labels: Vec<LabelledSegment>) -> Self {
        self.labels = labels;
        self
    }

    /// How many clocks stamped its columns: two where displacement and force had time stamps of their own, else one.
    #[must_use]
    pub fn clocks(&self) -> usize {
        let joined = |done: &Correction| matches!(done, Correction::ClocksJoined { .. });
        if self.corrections.iter().any(joined) { 2 } else { 1 }
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Never true: a record has two samples at least.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Time, s.
    #[must_use]
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Displacement, m, if it was recorded.
    #[must_use]
    pub fn displacement(&self) -> Option<&[f64]> {
        self.displacement.as_deref()
    }

    /// Force, N.
    #[must_use]
    pub fn force(&self) -> &[f64] {
        &self.force
    }

    /// Median time between samples, s.
    #[must_use]
    pub fn sample_interval(&self) -> f64 {
        let mut steps: Vec<f64> = self.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        median(&mut steps)
    }

    /// Force and displacement exchanged; `None` without displacement.
    pub(crate) fn exchanged(&self) -> Option<Result<Self, RecordError>> {
        let moved = self.displacement.clone()?;
        Some(Self::new(self.time.clone(), Some(self.force.clone()), moved))
    }

    /// The record with other columns and the correction that made them.
    pub(super) fn with(
        &self,
        time: Vec<f64>,
        displacement: Option<Vec<f64>>,
        force: Vec<f64>,
        done: Correction,
    ) -> Result<Self, RecordError> {
        let record = Self::new(time, displacement, force)?;
        let record = record.labelled(self.labels.clone());
        Ok(record.corrected_before(self.corrections.iter().cloned()).followed_by(done))
    }

    /// The record with another force and the correction that made it.
    pub(super) fn with_force(&self, force: Vec<f64>, done: Correction) -> Result<Self, RecordError> {
        self.with(self.time.clone(), self.displacement.clone(), force, done)
    }
}
