//! The material of a specimen of the batch that was not tested.

use super::covariance::Covariance;
use super::joint::{Joint, Optimum};
use crate::calibrate::CalibrationRange;
use crate::optimise::Cholesky;

/// The logarithms of the parameters of another specimen.
pub(super) struct Another {
    /// Shared ones, then means of the own ones.
    pub(super) logs: Vec<f64>,
    /// Their covariance, of the specimen.
    pub(super) covariance: Vec<Vec<f64>>,
    /// That of the means of the batch: without what differs between specimens.
    pub(super) of_means: Vec<Vec<f64>>,
    /// Degrees of freedom of both; `None` where nothing is a record's own.
    pub(super) freedom: Option<f64>,
}

impl Another {
    /// With S the sample covariance of the estimates of the own parameters, (1 + 1/k) S is the covariance of those of another specimen about
    /// their mean, S/k that of the mean. An error δ of the shared parameters moves the own ones of record r by −(J_oᵀJ_o)⁻¹ J_oᵀJ_s δ, which
    /// S does not contain as far as it is the same in all of them; its mean B over the records is added: C_s for the shared, B C_s across, B C_s Bᵀ for the own.
    ///
    /// `None` where N is singular, which [`Covariance`] has excluded.
    pub(super) fn of(joint: &Joint<'_>, optimum: &Optimum, covariance: &Covariance) -> Option<Self> {
        let layout = &joint.layout;
        let (count, shared, size) = (layout.records as f64, layout.shared.len(), layout.size());
        let own = layout.own.len();
        let rows = |record: usize| &optimum.logs[layout.own_places(record)];
        let mean: Vec<f64> =
            (0..own).map(|j| (0..layout.records).map(|record| rows(record)[j]).sum::<f64>() / count).collect();
        let sample = |i: usize, j: usize| {
            let product = |record: usize| (rows(record)[i] - mean[i]) * (rows(record)[j] - mean[j]);
            (0..layout.records).map(product).sum::<f64>() / (count - 1.0)
        };
        // Columns of the shared parameters: how these move themselves, and then how the own ones do.
        let mut response: Vec<Vec<f64>> =
            (0..shared).map(|i| (0..shared + own).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        for record in 0..layout.records {
            let factor = Cholesky::new(&optimum.own_block(layout, record), own)?;
            for (s, column) in response.iter_mut().enumerate() {
                let mut moves: Vec<f64> =
                    layout.own_places(record).map(|i| -optimum.linear.normal[i * size + s] / count).collect();
                factor.solve(&mut moves);
                column[shared..].iter_mut().zip(moves).for_each(|(entry, by)| *entry += by);
            }
        }
        let common = |i: usize, j: usize| -> f64 {
            let row = |a: usize| {
                let entry = |b: usize| covariance.entries[a * size + b] * response[b][j];
                response[a][i] * (0..shared).map(entry).sum::<f64>()
            };
            (0..shared).map(row).sum()
        };
        // Symmetric to the last digit.
        let matrix = |share: f64| -> Vec<Vec<f64>> {
            let entry = |i: usize, j: usize| {
                let (i, j) = (i.min(j), i.max(j));
                common(i, j) + if i >= shared { share * sample(i - shared, j - shared) } else { 0.0 }
            };
            (0..shared + own).map(|i| (0..shared + own).map(|j| entry(i, j)).collect()).collect()
        };
        Some(Self {
            logs: optimum.logs[..shared].iter().copied().chain(mean.iter().copied()).collect(),
            covariance: matrix(1.0 + 1.0 / count),
            of_means: matrix(1.0 / count),
            freedom: (own > 0).then_some(count - 1.0),
        })
    }
}

/// What any of the records has shown.
pub(super) fn range_of(ranges: impl Iterator<Item = CalibrationRange>) -> Option<CalibrationRange> {
    ranges.reduce(|a, b| CalibrationRange {
        longest_hold: a.longest_hold.max(b.longest_hold),
        longest_force_hold: a.longest_force_hold.max(b.longest_force_hold),
        deepest: a.deepest.max(b.deepest),
        fastest: a.fastest.max(b.fastest),
        slowest: a.slowest.min(b.slowest),
        largest_force: a.largest_force.max(b.largest_force),
        farthest_retreat: a.farthest_retreat.max(b.farthest_retreat),
        loadings: a.loadings.max(b.loadings),
    })
}
