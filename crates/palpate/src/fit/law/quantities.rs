//! What a fit reports at a point, with gradients: the parameters that were searched, those held, and those that follow from them.

use super::derived::derived;
use super::fitted::Point;
use super::quantity::Quantity;
use crate::fit::{Fitted, ParameterKind, ParameterName, ParameterRole, ParameterUnit, Scale};
use crate::laws::{ExponentChoice, Law, ShapeParameterKind};
use crate::optimise::Few;

impl Fitted {
    /// Everything that is reported of a law, at a point.
    pub(crate) fn quantities(&self, law: Law, point: Point<'_>) -> Vec<Quantity> {
        let values = self.values_at(point);
        let natural = self.natural_parameters(point);
        let mut all = self.direct(&values, &natural);
        all.extend(given_exponent(law));
        all.extend(derived(law, self, &values, &natural));
        all
    }

    /// The parameters that were searched, and those held, as they are reported: times for ln of rates.
    fn direct(&self, values: &[f64], natural: &[f64]) -> Vec<Quantity> {
        let model = &self.model;
        let row =
            |i: usize, entry: f64| -> Few { (0..values.len()).map(|j| if i == j { entry } else { 0.0 }).collect() };
        let named = |name: &str| ParameterName::of_form(&model.form, name);
        let level = |name: &str, at: usize| {
            Some(Quantity {
                name: named(name)?,
                unit: ParameterUnit::Signal,
                role: ParameterRole::Estimated,
                value: values[at],
                gradient: row(at, 1.0),
                scale: Scale::Linear,
            })
        };
        let mut all = Vec::with_capacity(1 + model.form.shapes.len() + model.parameters.len());
        let (constants, constant) = (usize::from(model.constant), model.form.constant_name());
        if model.constant {
            all.extend(level(constant, 0));
        } else if model.form.constant || self.scaled.center != 0.0 {
            all.extend(named(constant).map(|name| Quantity::given(name, ParameterUnit::Signal, self.scaled.center)));
        }
        let amplitudes = model.form.amplitude_names();
        all.extend(amplitudes.iter().enumerate().filter_map(|(i, name)| level(name, i + constants)));
        let mut at = model.linear();
        for (parameter, value) in model.parameters.iter().zip(natural) {
            let (unit, value, slope) = match parameter.kind {
                ShapeParameterKind::Pure { .. } => (ParameterUnit::One, *value, 1.0 / value),
                ShapeParameterKind::Time => (ParameterUnit::Second, (-value).exp(), -1.0),
                ShapeParameterKind::Rate => (ParameterUnit::PerSecond, value.exp(), 1.0),
                ShapeParameterKind::Reference => continue,
            };
            let is_searched = parameter.fixed.is_none();
            all.extend(named(&parameter.name).map(|name| match is_searched {
                false => Quantity::given(name, unit, value),
                true => Quantity {
                    name,
                    unit,
                    role: ParameterRole::Estimated,
                    value,
                    gradient: row(at, slope),
                    scale: Scale::Log,
                },
            }));
            at += usize::from(is_searched);
        }
        all
    }
}

/// The exponent of a latency law that has it in its name.
fn given_exponent(law: Law) -> Option<Quantity> {
    match law {
        Law::Latency {
            exponent: ExponentChoice::Fixed(n),
        } => Some(Quantity::given(ParameterKind::Exponent.into(), ParameterUnit::One, n)),
        _ => None,
    }
}
