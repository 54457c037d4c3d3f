//! What a quantity off its estimate changes of the parameters of a hold and of the modulus.

use std::borrow::Cow;

use super::drifting::drifting;
use super::holds::{HoldAnalysis, Signal, fit_options};
use super::options::{AnalysisOptions, Geometry};
use super::together::{EstimatedModulus, ImpliedModulus};
use crate::budget::InputQuantity;
use crate::contact::Specimen;
use crate::fit::{
    Domain, ErrorParts, Estimate, Fit, LatencyFit, LawOptions, Parameter, ParameterKind, ParameterRole, ParameterUnit,
    Samples,
};
use crate::instrument::{Deviation, InstrumentQuantity};
use crate::segment::ContactPoint;
use crate::watch::{Cancelled, Watch};

/// The quantities off their estimates, and what they have an effect on.
pub(in crate::analysis) struct Causes<'a> {
    options: &'a AnalysisOptions,
    geometry: Option<&'a Geometry>,
    specimen: Option<&'a Specimen>,
    /// The modulus, where the equilibrium forces imply it.
    implied: Option<&'a ImpliedModulus>,
    /// Inputs in the order of all effects.
    pub(in crate::analysis) inputs: Vec<InputQuantity>,
    quantities: Vec<Cause>,
}

#[derive(Debug, Clone, Copy)]
enum Cause {
    Stated(InstrumentQuantity),
    /// The scatter of the equilibrium forces that imply the modulus.
    EstimatedModulus,
}

/// How the signal of a hold changes: scale · (signal + drift · t) + offset, t since the start of the fit, rates times `rate`.
///
/// The jaw stands, or goes on as the force relaxes, so that strain is a line over the force, and every law is one of its signal in any unit. With a
/// drift it is another curve, which is fitted anew.
#[derive(Debug, Clone, Copy)]
struct Changed {
    scale: f64,
    offset: f64,
    /// In the unit of the signal per second.
    drift: f64,
    rate: f64,
}

/// A signal one standard uncertainty of a quantity below and above, with the fit to it, if there is one.
type Sides<'a> = [(Changed, Option<Cow<'a, Fit>>); 2];

impl<'a> Causes<'a> {
    /// The stated quantities, the errors of first touch and of the zero of the force where the record shows them, that of a baseline that was
    /// subtracted, and that of an estimated modulus; `None` where nothing is stated or subtracted and the modulus is given.
    pub(in crate::analysis) fn new(
        options: &'a AnalysisOptions,
        contact: &ContactPoint,
        specimen: Option<&'a Specimen>,
        implied: Option<&'a ImpliedModulus>,
    ) -> Option<Self> {
        let mut stated = options.instrument.with_found(contact).inputs;
        stated.retain(|input| specimen.is_some() || input.quantity != InstrumentQuantity::Touch);
        let mut quantities: Vec<Cause> = stated.iter().map(|input| Cause::Stated(input.quantity)).collect();
        let mut inputs: Vec<InputQuantity> = stated.into_iter().map(|input| input.uncertainty).collect();
        let error = implied.and_then(|implied| implied.standard_error);
        let error = error.and_then(|error| InputQuantity::standard("modulus, as estimated", "Pa", 0.0, error).ok());
        if options.instrument.is_empty() && options.corrections.baseline.is_none() && error.is_none() {
            return None;
        }
        if let Some(modulus) = error {
            inputs.push(modulus.type_a());
            quantities.push(Cause::EstimatedModulus);
        }
        Some(Self {
            geometry: options.geometry.as_ref(),
            options,
            specimen,
            implied,
            inputs,
            quantities,
        })
    }

    /// Adds the effects to all parameters of all laws of a hold.
    pub(in crate::analysis) fn add_to(&self, hold: &mut HoldAnalysis, watch: &mut dyn Watch) -> Result<(), Cancelled> {
        let changed: Vec<Option<[Changed; 2]>> = self
            .quantities
            .iter()
            .zip(&self.inputs)
            .map(|(cause, input)| sides(input, |by| self.changed(hold, *cause, by)))
            .collect();
        let samples = Samples::new(&hold.times[..hold.fitted], &hold.values[..hold.fitted]);
        for fit in hold.fits.iter_mut().chain(hold.rate_fits.iter_mut().flatten()) {
            let options = self.options.fit.of_latency(fit.choice());
            if let Some(with) = LatencyFit::new(self.with_effects(fit, (&samples, &options), &changed, watch)?) {
                *fit = with;
            }
        }
        let (Some(comparison), Some(compare)) = (&mut hold.comparison, &self.options.compare) else {
            return Ok(());
        };
        for fit in comparison.rows.iter_mut().filter_map(|row| row.fit.as_mut().ok()) {
            let options = fit_options(compare, fit.loading.as_ref());
            *fit = self.with_effects(fit, (&samples, &options), &changed, watch)?;
        }
        Ok(())
    }

    /// The uncertainty of the modulus that the equilibrium forces imply.
    pub(in crate::analysis) fn of_modulus(&self, implied: &ImpliedModulus) -> EstimatedModulus {
        let effect = |(cause, input): (&Cause, &InputQuantity)| match cause {
            Cause::Stated(quantity) => {
                // At the temperature that is stated.
                let at_stated = |by| 1.0 + Deviation::of(*quantity, by).modulus_at_temperature;
                let sides = sides(input, |by| Some(self.modulus(*cause, by)? / at_stated(by)));
                sides.map_or(0.0, |[low, high]| 0.5 * (high - low))
            }
            // Its own scatter.
            Cause::EstimatedModulus => 0.0,
        };
        let parts = ErrorParts {
            scatter: implied.standard_error,
            effects: self.quantities.iter().zip(&self.inputs).map(effect).collect(),
        };
        EstimatedModulus {
            estimate: self.beside(implied.estimate().estimate, f64::INFINITY, &parts),
            parts: Some(parts),
        }
    }

    /// An estimate of this many degrees of freedom with the effects of all inputs.
    fn beside(&self, estimate: Estimate, freedom: f64, parts: &ErrorParts) -> Estimate {
        let of_inputs = parts.effects.iter().zip(&self.inputs).map(|(effect, input)| (*effect, input.freedom));
        estimate.beside(freedom, of_inputs, self.options.fit.confidence)
    }

    /// The modulus of the body at the test with a cause off its estimate by `by`, Pa.
    fn modulus(&self, cause: Cause, by: f64) -> Option<f64> {
        let geometry = self.geometry?;
        match (cause, self.implied, geometry.modulus) {
            (Cause::EstimatedModulus, Some(implied), _) => Some(implied.value + by),
            (Cause::Stated(quantity), Some(implied), None) => implied.with(geometry, &Deviation::of(quantity, by)),
            (Cause::Stated(quantity), _, Some(given)) => Some(Deviation::of(quantity, by).given_modulus(given)),
            _ => None,
        }
    }

    /// The signal of a hold with a quantity off its estimate by `by`; `None` where the body is none.
    fn changed(&self, hold: &HoldAnalysis, cause: Cause, by: f64) -> Option<Changed> {
        let deviation = match cause {
            Cause::Stated(quantity) => Deviation::of(quantity, by),
            Cause::EstimatedModulus => Deviation::default(),
        };
        // The drift stands in `drift` from the start of the fit on, and counts as a zero before.
        let of_force = |force: f64| deviation.force_at(force, hold.fit_start);
        let (gain, zero) = (of_force(1.0) - of_force(0.0), of_force(0.0));
        let rate = 1.0 / deviation.time(1.0 + deviation.rate_at_temperature);
        if hold.signal == Signal::Force {
            return Some(Changed {
                scale: gain,
                offset: zero,
                drift: deviation.drift() / gain,
                rate,
            });
        }
        let (specimen, level) = (self.specimen?, hold.displacement?);
        let per_strain = |specimen: &Specimen, displacement: f64| {
            Some(specimen.force(1.0, specimen.contact_displacement(displacement))).filter(|force| *force > 0.0)
        };
        let geometry = self.geometry?;
        let body = geometry.with_shape(deviation.shape(&geometry.shape)).specimen(self.modulus(cause, by)?).ok()?;
        let before = per_strain(specimen, level)?;
        let end = per_strain(&body, deviation.displacement(level, hold.force_end))?;
        let strain = |force: f64| Some(of_force(force) / per_strain(&body, deviation.displacement(level, force))?);
        // Through the compliance of a machine the jaw goes on as the force relaxes: the line by least squares over the hold.
        let every = hold.values.len().div_ceil(MOST).max(1);
        let mut points = Vec::with_capacity(MOST);
        for value in hold.values.iter().step_by(every) {
            points.push((*value, strain(value * before)?));
        }
        let (scale, offset) = line(&points).unwrap_or_else(|| (gain * before / end, zero / end));
        Some(Changed {
            scale,
            offset,
            drift: deviation.drift() / (gain * before),
            rate,
        })
    }

    /// A fit whose parameters have these effects besides the scatter of the samples.
    ///
    /// A drift is left out of fits to rates.
    fn with_effects(
        &self,
        fit: &Fit,
        (samples, options): (&Samples<'_>, &LawOptions),
        changed: &[Option<[Changed; 2]>],
        watch: &mut dyn Watch,
    ) -> Result<Fit, Cancelled> {
        let mut with = fit.clone();
        let freedom = fit.uncertainty.as_ref().map_or(f64::INFINITY, |uncertainty| uncertainty.freedom);
        let mut anew = |changed: Changed| match fit.domain {
            Domain::Time if changed.drift != 0.0 => {
                Ok(drifting(fit.law, samples, options, changed.drift, watch)?.map(Cow::Owned))
            }
            _ => Ok(Some(Cow::Borrowed(fit))),
        };
        let mut sides: Vec<Option<Sides<'_>>> = Vec::with_capacity(changed.len());
        for changed in changed {
            sides.push(match changed {
                Some(both) => Some([(both[0], anew(both[0])?), (both[1], anew(both[1])?)]),
                None => None,
            });
        }
        let effect = |parameter: &Parameter, sides: &Option<Sides<'_>>| {
            let at = |(changed, fit): &(Changed, Option<Cow<'_, Fit>>)| changed.parameter(fit.as_deref()?, parameter);
            // Where samples that drift one way have no fit, those that drift the other way stand for both.
            let effect = match sides.as_ref()?.each_ref().map(at) {
                [Some(low), Some(high)] => 0.5 * (high - low),
                [low, high] => low.or(high)? - parameter.estimate.value,
            };
            Some(effect).filter(|effect| effect.is_finite())
        };
        for parameter in with.parameters.iter_mut().filter(|parameter| parameter.role != ParameterRole::Given) {
            let parts = ErrorParts {
                scatter: parameter.estimate.standard_error,
                effects: sides.iter().map(|sides| effect(parameter, sides).unwrap_or(0.0)).collect(),
            };
            parameter.estimate = self.beside(parameter.estimate, freedom, &parts);
            parameter.parts = Some(parts);
        }
        Ok(with)
    }
}

/// Samples of a hold that show how its signal changes.
const MOST: usize = 64;

/// Slope and intercept of the line through points by least squares; `None` where all lie at one place.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let square: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    let slope = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>() / square;
    (square > (1e-6 * x).powi(2) * count && slope.is_finite()).then_some((slope, y - slope * x))
}

/// What comes out one standard uncertainty below and above.
fn sides<T>(input: &InputQuantity, result: impl Fn(f64) -> Option<T>) -> Option<[T; 2]> {
    let by = input.standard_uncertainty;
    Some([result(-by)?, result(by)?])
}

/// Share by which first touch, with its standard error (m), and the stated quantities leave a modulus F/g(u₁) of a hold uncertain; `None`
/// without a body.
pub(in crate::analysis) fn error_of_modulus(
    hold: &HoldAnalysis,
    options: &AnalysisOptions,
    contact: &ContactPoint,
) -> Option<f64> {
    let (geometry, level) = (options.geometry.as_ref()?, hold.displacement?);
    let modulus = |quantity, by| {
        let deviation = Deviation::of(quantity, by);
        let body = geometry.with_shape(deviation.shape(&geometry.shape)).specimen(1.0).ok()?;
        let place = body.contact_displacement(deviation.displacement(level, hold.force_end));
        Some(deviation.force_at(hold.force_end, hold.end) / body.equilibrium_force(place))
            .filter(|modulus| modulus.is_finite())
    };
    let inputs = options.instrument.with_found(contact).inputs;
    let mut stated = inputs.iter().map(|input| (input.quantity, input.uncertainty.standard_uncertainty));
    let square = stated.try_fold(0.0, |sum, (quantity, by)| {
        let half = 0.5 * (modulus(quantity, by)? - modulus(quantity, -by)?);
        Some(sum + half * half)
    })?;
    Some(square.sqrt() / modulus(InstrumentQuantity::Force, 0.0)?.abs())
}

impl Changed {
    /// The value that a parameter of a law takes whose signal, with the drift fitted, changes like this; `None` where that fit has no such one.
    fn parameter(self, fit: &Fit, parameter: &Parameter) -> Option<f64> {
        let Self {
            scale, offset, rate, ..
        } = self;
        let parameter = fit.parameters.iter().find(|found| found.name == parameter.name)?;
        let value = parameter.estimate.value;
        let exponent = fit.value("exponent").unwrap_or(1.0);
        // What the signal tends to, which terms of Fung's laws are shares of.
        let end = fit.predict(1e9 * fit.duration);
        let is_level = matches!(
            parameter.name.kind,
            ParameterKind::Equilibrium
                | ParameterKind::Start
                | ParameterKind::Instantaneous
                | ParameterKind::Final
                | ParameterKind::ElasticResponse
        );
        Some(match parameter.unit {
            ParameterUnit::Signal => value * scale + if is_level { offset } else { 0.0 },
            ParameterUnit::SignalPerSecond => value * scale * rate,
            ParameterUnit::SignalPerPower => value * scale,
            ParameterUnit::PerSecond => value * rate,
            ParameterUnit::Second => value / rate,
            ParameterUnit::RateCoefficient => value * scale.powf(1.0 - exponent) * rate,
            ParameterUnit::One => match parameter.name.kind {
                ParameterKind::Share | ParameterKind::Strength => value * end * scale / (end * scale + offset),
                _ => value,
            },
        })
    }
}
