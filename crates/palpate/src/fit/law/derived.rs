//! Parameters that follow from those that were searched, with their gradients.

use super::quantity::Quantity;
use crate::fit::{Fitted, ParameterKind, ParameterName, ParameterRole, ParameterUnit, Scale};
use crate::laws::{BasisFunction, Kernel, Law, Response};
use crate::optimise::Few;

/// The derived parameters of a law where the searched ones have these values, and all nonlinear ones those in natural units.
pub(crate) fn derived(law: Law, fitted: &Fitted, values: &[f64], natural: &[f64]) -> Vec<Quantity> {
    let view = View::new(fitted, values, natural);
    match law {
        Law::Latency { .. } => vec![view.start(), view.rate_coefficient()],
        Law::Fung { .. } => view.fung(),
        Law::FungContinuous => view.fung_continuous(),
        Law::Power | Law::Burgers | Law::Maxwell if fitted.model.form.response == Response::Creep => view.growth(),
        _ if fitted.model.form.shapes.iter().all(Kernel::decays) => vec![view.start()],
        _ => Vec::new(),
    }
}

/// The searched parameters by what they are.
struct View<'a> {
    fitted: &'a Fitted,
    values: &'a [f64],
    constant: f64,
    /// Place of the first amplitude.
    first: usize,
    parameters: &'a [f64],
}

impl<'a> View<'a> {
    fn new(fitted: &'a Fitted, values: &'a [f64], parameters: &'a [f64]) -> Self {
        Self {
            fitted,
            values,
            constant: if fitted.model.constant { values[0] } else { fitted.scaled.center },
            first: usize::from(fitted.model.constant),
            parameters,
        }
    }

    fn amplitudes(&self) -> &[f64] {
        &self.values[self.first..self.fitted.model.linear()]
    }

    /// Place of nonlinear parameter `index` among the searched ones, if it was not held.
    fn place(&self, index: usize) -> Option<usize> {
        let parameters = &self.fitted.model.parameters;
        let before = parameters[..index].iter().filter(|parameter| parameter.fixed.is_none()).count();
        parameters[index].fixed.is_none().then(|| self.fitted.model.linear() + before)
    }

    fn gradient(&self, entries: &[(Option<usize>, f64)]) -> Few {
        let mut gradient = Few::from_elem(0.0, self.values.len());
        for (place, entry) in entries {
            if let Some(place) = place {
                gradient[*place] += entry;
            }
        }
        gradient
    }

    /// ∂/∂ of constant + Σ amplitudes.
    fn sum_gradient(&self) -> Few {
        (0..self.values.len()).map(|i| if i < self.fitted.model.linear() { 1.0 } else { 0.0 }).collect()
    }

    fn sum(&self) -> f64 {
        self.constant + self.amplitudes().iter().sum::<f64>()
    }

    fn total(&self, name: ParameterKind) -> Quantity {
        linear(name, ParameterUnit::Signal, self.sum(), self.sum_gradient())
    }

    /// Signal at the start of relaxation; signal at the end of creep.
    fn start(&self) -> Quantity {
        let creep = self.fitted.model.form.response == Response::Creep;
        self.total(if creep { ParameterKind::Final } else { ParameterKind::Start })
    }

    /// v = λ |Δ|^(1 − n).
    fn rate_coefficient(&self) -> Quantity {
        let amplitude = self.amplitudes()[0];
        let log_amplitude = amplitude.abs().ln();
        let (n, exponent) = match self.fitted.model.form.shapes[0] {
            BasisFunction::LatencyWith(n) => (n, None),
            _ => (self.parameters[1], self.place(1)),
        };
        let entries = [(Some(self.first), -(n - 1.0) / amplitude), (self.place(0), 1.0), (exponent, -log_amplitude)];
        let value = (self.parameters[0] - (n - 1.0) * log_amplitude).exp();
        log(ParameterKind::RateCoefficient, ParameterUnit::RateCoefficient, value, self.gradient(&entries))
    }

    /// N, c₀, cᵢ and νᵢ.
    fn fung(&self) -> Vec<Quantity> {
        let total = self.sum();
        let share = |term: usize, part: f64, place: Option<usize>| {
            // ∂(part/total) = ∂part/total − part ∂total/total².
            let mut gradient: Few = self.sum_gradient().iter().map(|one| -part * one / (total * total)).collect();
            if let Some(place) = place {
                gradient[place] += 1.0 / total;
            }
            let name = ParameterName::of_term(ParameterKind::Share, term);
            linear(name, ParameterUnit::One, part / total, gradient)
        };
        let rest = share(0, self.constant, self.fitted.model.constant.then_some(0));
        let mut all = vec![self.total(ParameterKind::ElasticResponse), rest];
        for (i, amplitude) in self.amplitudes().iter().enumerate() {
            all.push(share(i + 1, *amplitude, Some(self.first + i)));
        }
        for (i, parameter) in self.parameters.iter().enumerate() {
            let name = ParameterName::of_term(ParameterKind::TermRate, i + 1);
            all.push(log(name, ParameterUnit::PerSecond, parameter.exp(), self.gradient(&[(self.place(i), 1.0)])));
        }
        all
    }

    /// N, C and τ_short.
    fn fung_continuous(&self) -> Vec<Quantity> {
        let (amplitude, log_ratio) = (self.amplitudes()[0], self.parameters[1]);
        let constant = self.fitted.model.constant.then_some(0);
        let strength = amplitude / (self.constant * log_ratio);
        // C = Δ/(y_e ln ϱ).
        let entries = [
            (constant, -strength / self.constant),
            (Some(self.first), 1.0 / (self.constant * log_ratio)),
            (self.place(1), -strength / log_ratio),
        ];
        let short = self.gradient(&[(self.place(0), -1.0), (self.place(1), -1.0)]);
        vec![
            self.total(ParameterKind::ElasticResponse),
            linear(ParameterKind::Strength, ParameterUnit::One, strength, self.gradient(&entries)),
            log(ParameterKind::TimeShort, ParameterUnit::Second, (-self.parameters[0] - log_ratio).exp(), short),
        ]
    }

    /// Slope of a straight flow per s, coefficient of a power per s^α.
    fn growth(&self) -> Vec<Quantity> {
        let mut all = Vec::new();
        for (i, shape) in self.fitted.model.form.shapes.iter().enumerate() {
            let parameters = self.fitted.model.parameters_of(i);
            let (amplitude, log_rate) = (self.amplitudes()[i], self.parameters[parameters.start]);
            let place = Some(self.first + i);
            if *shape == BasisFunction::Straight {
                let gradient = self.gradient(&[(place, log_rate.exp())]);
                let rate = amplitude * log_rate.exp();
                all.push(linear(ParameterKind::FlowRate, ParameterUnit::SignalPerSecond, rate, gradient));
            } else if *shape == BasisFunction::PowerGrowth {
                let factor = (log_rate * self.parameters[parameters.start + 1]).exp();
                let entries = [(place, factor), (self.place(parameters.start + 1), amplitude * factor * log_rate)];
                let gradient = self.gradient(&entries);
                let coefficient = amplitude * factor;
                all.push(linear(ParameterKind::Coefficient, ParameterUnit::SignalPerPower, coefficient, gradient));
            }
        }
        all
    }
}

/// A parameter that is known on a straight scale: its value and ∂/∂ the searched ones.
fn linear(name: impl Into<ParameterName>, unit: ParameterUnit, value: f64, gradient: Few) -> Quantity {
    Quantity {
        name: name.into(),
        unit,
        role: ParameterRole::Derived,
        value,
        gradient,
        scale: Scale::Linear,
    }
}

/// The same for a number above 0, with ∂/∂ of its logarithm.
fn log(name: impl Into<ParameterName>, unit: ParameterUnit, value: f64, gradient: Few) -> Quantity {
    Quantity {
        scale: Scale::Log,
        ..linear(name, unit, value, gradient)
    }
}
