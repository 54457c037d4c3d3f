//! The covariance of shared and own parameters.
//!
//! The estimates are those of weighted least squares whatever the noise, so that their covariance is the sandwich
//!
//! ```text
//! C = N⁻¹ (Σ_r J_rᵀV_rJ_r/σ_r⁴) N⁻¹,   N = Σ_r J_rᵀJ_r/σ_r²
//! ```
//!
//! with V_r the covariance of the force residuals of record r, which is found from them as for one record, and of the effects of the noise of
//! its displacement. With J = Q R and orthonormal Q, QᵀV Q is the covariance that a fit with the Jacobian Q would have, and
//! JᵀV J = Rᵀ(QᵀV Q)R.

use super::SeveralError;
use super::joint::{Joint, Optimum};
use crate::calibrate::CalibrationData;
use crate::calibrate::problem::{Found, dot, sum_of_squares};
use crate::calibrate::uncertainty::from_displacement;
use crate::fit::{Assessed, NoiseModel, Termination};
use crate::optimise::Cholesky;
use crate::watch::Stages;

/// What the noise of all records leaves open.
pub(super) struct Covariance {
    /// C of the logarithms of all parameters, row by row.
    pub(super) entries: Vec<f64>,
    /// The same if force residuals were white noise.
    pub(super) white: Vec<f64>,
    /// Noise of each record.
    pub(super) noises: Vec<NoiseModel>,
}

impl Covariance {
    /// # Errors
    /// [`SeveralError::Undetermined`] and [`SeveralError::SharedUndetermined`] where N is singular.
    pub(super) fn of(
        joint: &Joint<'_>,
        optimum: &Optimum,
        data: &[&CalibrationData],
        names: &dyn Fn(&[usize]) -> Vec<String>,
        stages: &mut Stages<'_>,
    ) -> Result<Self, SeveralError> {
        let layout = &joint.layout;
        let size = layout.size();
        let Some(factor) = Cholesky::new(&optimum.linear.normal, size) else {
            return Err(undetermined(joint, optimum, names));
        };
        let (mut filling, mut white) = (vec![0.0; size * size], vec![0.0; size * size]);
        let mut noises = Vec::with_capacity(data.len());
        for (record, member) in joint.members.iter().enumerate() {
            let state = &optimum.states[record];
            let (orthonormal, triangle) = orthogonalised(&optimum.linear.jacobians[record]);
            let found = Found {
                theta: state.theta.clone(),
                residuals: state.residuals.clone(),
                square: sum_of_squares(&state.residuals),
                termination: Termination::Converged,
                simulations: 0,
            };
            let of_displacement = from_displacement(&member.problem, data[record], &found, &orthonormal, stages)?;
            let mut assessed = Assessed::of_columns(orthonormal, (data[record].forces(), found.residuals), 0.95)?;
            of_displacement.iter().for_each(|covariance| assessed.add(covariance));
            let (Some(uncertainty), Some(as_white)) = (&assessed.uncertainty, &assessed.white) else {
                return Err(undetermined(joint, optimum, names));
            };
            let weight = member.deviation.powi(-4);
            let places = layout.places(record);
            for (sum, inner) in [(&mut filling, &uncertainty.covariance), (&mut white, as_white)] {
                for (i, a) in places.iter().zip(&triangle) {
                    for (j, b) in places.iter().zip(&triangle) {
                        let row = |(row, a): (&Vec<f64>, &f64)| a * dot(row, b);
                        sum[i * size + j] += weight * inner.iter().zip(a).map(row).sum::<f64>();
                    }
                }
            }
            noises.push(assessed.noise);
        }
        let sandwiched = |filling: Vec<f64>| {
            let half = columns_solved(&factor, &filling, size);
            columns_solved(&factor, &half, size)
        };
        Ok(Self {
            entries: sandwiched(filling),
            white: sandwiched(white),
            noises,
        })
    }
}

/// (N⁻¹ M)ᵀ: twice, of a symmetric M, that is N⁻¹ M N⁻¹.
fn columns_solved(factor: &Cholesky, matrix: &[f64], size: usize) -> Vec<f64> {
    let column = |j: usize| {
        let mut column: Vec<f64> = (0..size).map(|i| matrix[i * size + j]).collect();
        factor.solve(&mut column);
        column
    };
    (0..size).flat_map(column).collect()
}

/// Orthonormal columns Q of the span of `columns`, and for each of these its coefficients in Q; what lies in the span of those before has no
/// column of its own (Gram and Schmidt, twice).
fn orthogonalised(columns: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    /// Share of its length that a column keeps at least to count as independent.
    const INDEPENDENT: f64 = 1e-8;
    let mut orthonormal: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
    let mut triangle = Vec::with_capacity(columns.len());
    for column in columns {
        let length = sum_of_squares(column).sqrt();
        let mut rest = column.clone();
        let mut row = vec![0.0; orthonormal.len()];
        for _ in 0..2 {
            for (unit, entry) in orthonormal.iter().zip(&mut row) {
                let along = dot(unit, &rest);
                *entry += along;
                rest.iter_mut().zip(unit).for_each(|(rest, unit)| *rest -= along * unit);
            }
        }
        let left = sum_of_squares(&rest).sqrt();
        if left > INDEPENDENT * length {
            rest.iter_mut().for_each(|entry| *entry /= left);
            orthonormal.push(rest);
            row.push(left);
        }
        triangle.push(row);
    }
    for row in &mut triangle {
        row.resize(orthonormal.len(), 0.0);
    }
    (orthonormal, triangle)
}

/// Which parameters make N singular: the own ones of the first record whose block is, or else the shared ones.
pub(super) fn undetermined(
    joint: &Joint<'_>,
    optimum: &Optimum,
    names: &dyn Fn(&[usize]) -> Vec<String>,
) -> SeveralError {
    let layout = &joint.layout;
    let is_singular = |record: &usize| Cholesky::new(&optimum.own_block(layout, *record), layout.own.len()).is_none();
    match (0..layout.records).find(is_singular) {
        Some(record) => SeveralError::Undetermined {
            record: joint.members[record].name.to_owned(),
            names: names(&layout.own),
        },
        None => SeveralError::SharedUndetermined {
            names: names(&layout.shared),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_their_coefficients_in_the_orthonormal_ones() {
        let columns = [vec![3.0, 4.0, 0.0], vec![6.0, 8.0, 0.0], vec![1.0, 0.0, 2.0]];
        let (orthonormal, triangle) = orthogonalised(&columns);
        assert_eq!(orthonormal.len(), 2);
        for (column, row) in columns.iter().zip(&triangle) {
            for sample in 0..3 {
                let sum: f64 = orthonormal.iter().zip(row).map(|(unit, by)| by * unit[sample]).sum();
                assert!((sum - column[sample]).abs() < 1e-14);
            }
        }
    }
}
