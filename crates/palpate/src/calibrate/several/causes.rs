//! Errors of the instruments over the records: which of them have one cause, and what it moves.

use super::joint::{Joint, Optimum};
use crate::budget::InputQuantity;
use crate::calibrate::problem::dot;
use crate::calibrate::{Calibration, SystematicEffect};
use crate::optimise::Cholesky;

/// What the instrument adds to a record calibrated alone.
fn effects_of(made: &Calibration) -> &[SystematicEffect] {
    made.material.uncertainty().map_or(&[], |uncertainty| &uncertainty.systematic)
}

/// How many parameters a material has, and how many dimensions its body.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    pub(super) parameters: usize,
    pub(super) dimensions: usize,
}

/// A cause of errors with what one standard uncertainty of it moves.
pub(super) struct CauseOfErrors<'a> {
    input: &'a InputQuantity,
    /// Its effects on each record calibrated alone; `None` where it has none.
    alone: Vec<Option<&'a [f64]>>,
    /// Changes of the logarithms of all parameters of the batch, by [`Layout`](super::sharing::Layout).
    together: Vec<f64>,
}

impl<'a> CauseOfErrors<'a> {
    /// All causes of these records.
    pub(super) fn all(joint: &Joint<'_>, optimum: &Optimum, alone: &'a [Calibration]) -> Vec<Self> {
        let mut found: Vec<Self> = Vec::new();
        let effects =
            |(record, made): (usize, &'a Calibration)| effects_of(made).iter().map(move |effect| (record, effect));
        for (record, effect) in alone.iter().enumerate().flat_map(effects) {
            let is_same = |cause: &&mut Self| cause.alone[record].is_none() && cause.input.has_cause_of(&effect.input);
            match found.iter_mut().find(is_same) {
                Some(known) => known.alone[record] = Some(&effect.logs),
                None => found.push(Self {
                    input: &effect.input,
                    alone: (0..alone.len()).map(|other| (other == record).then_some(&effect.logs[..])).collect(),
                    together: Vec::new(),
                }),
            }
        }
        let size = joint.layout.size();
        if let Some(factor) = Cholesky::new(&optimum.linear.normal, size) {
            found.iter_mut().for_each(|cause| cause.together = cause.moved(joint, optimum, &factor));
        }
        found.retain(|cause| cause.together.iter().all(|log| log.is_finite()) && !cause.together.is_empty());
        found
    }

    /// The parameters of the batch: with δ_r the move of the parameters of record r alone and N_r = J_rᵀJ_r/σ_r², the weighted squares are least
    /// at N⁻¹ Σ_r N_r δ_r.
    fn moved(&self, joint: &Joint<'_>, optimum: &Optimum, factor: &Cholesky) -> Vec<f64> {
        let layout = &joint.layout;
        let parameters = layout.parameters();
        let mut moves = vec![0.0; layout.size()];
        for (record, logs) in self.alone.iter().enumerate() {
            let Some(logs) = logs else { continue };
            let jacobian = &optimum.linear.jacobians[record];
            let mut forces = vec![0.0; jacobian.first().map_or(0, Vec::len)];
            for (column, parameter) in jacobian.iter().zip(&parameters) {
                forces.iter_mut().zip(column).for_each(|(force, slope)| *force += logs[*parameter] * slope);
            }
            let weight = joint.members[record].deviation.powi(-2);
            for (place, column) in layout.places(record).into_iter().zip(jacobian) {
                moves[place] += weight * dot(column, &forces);
            }
        }
        factor.solve(&mut moves);
        moves
    }

    /// Changes of parameter `index` of each of these records calibrated alone.
    pub(super) fn of_records(&self, records: &[usize], index: usize) -> Vec<f64> {
        records.iter().map(|record| self.alone[*record].map_or(0.0, |logs| logs[index])).collect()
    }

    /// Changes of the logarithms at these places.
    pub(super) fn at(&self, places: &[usize]) -> Vec<f64> {
        places.iter().map(|place| self.together[*place]).collect()
    }

    /// The effect on parameters and body of one record, with this many parameters and dimensions; `None` where it has none.
    pub(super) fn on_record(&self, joint: &Joint<'_>, record: usize, sizes: Sizes) -> Option<SystematicEffect> {
        let layout = &joint.layout;
        let mut logs = vec![0.0; sizes.parameters];
        for (parameter, place) in layout.parameters().into_iter().zip(layout.places(record)) {
            logs[parameter] = self.together[place];
        }
        logs.extend(self.dimensions(record, sizes));
        self.effect(logs)
    }

    /// The effect on the shared parameters and on the means of the own ones. What S of these contains already is left out: of effects d
    /// of k records with mean d̄, S/k has Σ (d − d̄)²/(k (k − 1)) of the d̄² of their mean, which is all of it for a cause in one record, and nothing of one that
    /// is the same in all.
    pub(super) fn on_means(&self, joint: &Joint<'_>, sizes: Sizes) -> Option<SystematicEffect> {
        let (layout, k) = (&joint.layout, joint.layout.records as f64);
        let mut logs = vec![0.0; sizes.parameters];
        for (at, parameter) in layout.shared.iter().enumerate() {
            logs[*parameter] = self.together[at];
        }
        for (at, parameter) in layout.own.iter().enumerate() {
            let moves = self.at(&layout.places_of_own(at));
            let mean = moves.iter().sum::<f64>() / k;
            let contained = moves.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (k * (k - 1.0));
            // Of a cause in one record rounding alone would be left.
            let left = mean * mean - contained;
            logs[*parameter] = if left > 1e-12 * mean * mean { left.sqrt().copysign(mean) } else { 0.0 };
        }
        let dimensions: Vec<Vec<f64>> = (0..layout.records).map(|record| self.dimensions(record, sizes)).collect();
        logs.extend((0..sizes.dimensions).map(|index| dimensions.iter().map(|logs| logs[index]).sum::<f64>() / k));
        self.effect(logs)
    }

    /// Changes of the logarithms of the dimensions of the body of a record; 0 of a body of another kind.
    fn dimensions(&self, record: usize, sizes: Sizes) -> Vec<f64> {
        let of_body = self.alone[record].map(|logs| &logs[sizes.parameters..]);
        of_body
            .filter(|logs| logs.len() == sizes.dimensions)
            .map_or_else(|| vec![0.0; sizes.dimensions], <[f64]>::to_vec)
    }

    fn effect(&self, logs: Vec<f64>) -> Option<SystematicEffect> {
        logs.iter().any(|log| *log != 0.0).then(|| SystematicEffect {
            input: self.input.clone(),
            logs,
        })
    }
}
