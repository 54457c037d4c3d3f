//! A law fitted, in the units of the fit and in those of the caller.

use crate::fit::{Model, Scaled, searched_name};
use crate::laws::{LawCurve, ShapeParameterKind, Term};
use crate::optimise::Solution;

/// A model with its samples and its solution, in the units of the fit.
pub(crate) struct Fitted {
    pub(crate) model: Model,
    pub(crate) scaled: Scaled,
    pub(crate) solution: Solution,
    /// Residuals as a robust loss counts them, scale · ψ(r/scale); `None` where all count.
    pub(crate) counted: Option<Vec<f64>>,
}

/// Free parameters in the units of the fit.
#[derive(Clone, Copy)]
pub(crate) struct Point<'a> {
    pub(crate) linear: &'a [f64],
    pub(crate) nonlinear: &'a [f64],
}

impl Solution {
    pub(crate) fn at(&self) -> Point<'_> {
        Point {
            linear: &self.linear,
            nonlinear: &self.nonlinear,
        }
    }
}

impl Fitted {
    /// Values of the free parameters in the caller's units: constant, amplitudes, ln of rates in 1/s, dimensionless parameters.
    pub(crate) fn values(&self) -> Vec<f64> {
        self.values_at(self.solution.at())
    }

    /// The same at another point.
    pub(crate) fn values_at(&self, point: Point<'_>) -> Vec<f64> {
        let (model, scaled) = (&self.model, &self.scaled);
        let linear = point.linear.iter().enumerate().map(|(i, value)| {
            let constant = model.constant && i == 0;
            value * scaled.range + if constant { scaled.center } else { 0.0 }
        });
        let nonlinear = model
            .parameters
            .iter()
            .zip(self.natural_parameters(point))
            .filter(|(parameter, _)| parameter.fixed.is_none());
        linear.chain(nonlinear.map(|(_, value)| value)).collect()
    }

    /// The law with the parameters found.
    pub(crate) fn curve(&self) -> LawCurve {
        self.curve_at(self.solution.at())
    }

    /// The law with the parameters of another point.
    pub(crate) fn curve_at(&self, point: Point<'_>) -> LawCurve {
        let (model, values) = (&self.model, self.values_at(point));
        let parameters = self.natural_parameters(point);
        let constants = usize::from(model.constant);
        let constant = if model.constant { values[0] } else { self.scaled.center };
        let terms = model.form.shapes.iter().enumerate().map(|(shape, kind)| Term {
            amplitude: values[constants + shape],
            shape: *kind,
            parameters: parameters[model.parameters_of(shape)].to_vec(),
        });
        LawCurve {
            response: model.form.response,
            constant,
            terms: terms.collect(),
        }
    }

    /// All nonlinear parameters, fixed ones too, in the caller's units.
    pub(crate) fn natural_parameters(&self, point: Point<'_>) -> Vec<f64> {
        let complete = self.model.complete(point.nonlinear);
        let natural = |(parameter, value): (&crate::fit::problem::model::ModelParameter, f64)| match parameter.kind {
            ShapeParameterKind::Pure { .. } => value,
            _ => value - self.scaled.duration.ln(),
        };
        self.model.parameters.iter().zip(complete).map(natural).collect()
    }

    /// Names of the free parameters.
    pub(crate) fn names(&self) -> Vec<String> {
        self.model.names(|parameter| searched_name(&parameter.name, parameter.kind))
    }

    /// Puts exponentials whose times were searched in the order of their times, fastest first; those with bounds of their own keep their places.
    pub(crate) fn arrange(&mut self) {
        let model = &self.model;
        let (moving, _) = model.moving();
        if moving.len() < 2 || model.free().len() != moving.len() || model.has_own_bounds() {
            return;
        }
        let solution = &mut self.solution;
        let mut order: Vec<usize> = (0..moving.len()).collect();
        order.sort_by(|a, b| solution.nonlinear[*b].total_cmp(&solution.nonlinear[*a]));
        let constants = usize::from(model.constant);
        let linear = model.linear();
        // Only those whose times were searched change places; one that was held keeps its own.
        let place = |i: usize| {
            let slot = moving.iter().position(|shape| constants + shape == i);
            slot.map_or(i, |slot| constants + moving[order[slot]])
        };
        let all: Vec<usize> = (0..linear).map(place).chain(order.iter().map(|i| linear + i)).collect();
        let size = all.len();
        let entry = |inverse: &[f64], i: usize| inverse[all[i / size] * size + all[i % size]];
        solution.inverse_normal = solution
            .inverse_normal
            .as_ref()
            .map(|inverse| (0..size * size).map(|i| entry(inverse, i)).collect());
        solution.linear = (0..linear).map(|i| solution.linear[place(i)]).collect();
        solution.nonlinear = order.iter().map(|i| solution.nonlinear[*i]).collect();
        solution.columns = (0..linear).map(|i| solution.columns[place(i)].clone()).collect();
        solution.column_squares = (0..linear).map(|i| solution.column_squares[place(i)]).collect();
        solution.derivatives = order.iter().map(|i| solution.derivatives[*i].clone()).collect();
    }
}
