//! From a law, samples and options to a model in the units of the fit.

use std::iter;

use crate::fit::{ConstantChoice, FitError, LawOptions, Model, ModelParameter, Samples, Scaled};
use crate::laws::{Form, Law, ShapeParameterKind};

impl LawOptions {
    /// Refuses options that no fit of a law can follow, whatever the samples: what [`fit_law`](crate::fit::fit_law) looks at first.
    ///
    /// ```
    /// use palpate::fit::{FitError, LawOptions};
    /// use palpate::laws::Law;
    /// let held = |name: &str| LawOptions { fixed: vec![(name.to_owned(), 2.0)], ..LawOptions::default() };
    /// assert_eq!(held("equilibrium").suit(Law::StandardLinearSolid), Ok(()));
    /// assert!(matches!(held("exponent").suit(Law::StandardLinearSolid), Err(FitError::UnknownParameter { .. })));
    /// ```
    ///
    /// # Errors
    /// [`FitError`] for a law without a form for the response, for parameters that the law does not have or that cannot be held,
    /// values that they cannot have, bounds that do not rise, and a confidence that is none.
    pub fn suit(&self, law: Law) -> Result<(), FitError> {
        suits(&self.form(law)?, self)
    }
}

/// Bounds that bind nothing.
const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// Checks samples and options against a form, and brings both to the units of the fit.
pub(crate) fn build(form: Form, samples: &Samples<'_>, options: &LawOptions) -> Result<(Model, Scaled), FitError> {
    suits(&form, options)?;
    let constant = match (options.held(form.constant_name()), options.constant) {
        (Some(value), _) | (None, ConstantChoice::Fixed(value)) => Some(value),
        (None, ConstantChoice::Free) => None,
        (None, ConstantChoice::AsLaw) => (!form.constant).then_some(0.0),
    };
    let named = form.parameters();
    let free = named.iter().filter(|(_, name, kind)| is_free(name, *kind, options)).count();
    samples.check(free + form.shapes.len() + usize::from(constant.is_none()))?;
    let scaled = Scaled::new(samples, constant)?;
    let parameters = parameters(named, &scaled, options)?;
    let linear = linear_bounds(&form, constant.is_none(), samples, &scaled, options);
    let model = Model::new(form, constant.is_none(), parameters, linear);
    let model = match &options.loading {
        None => model,
        Some(loading) => model.after(&loading.in_units_of(scaled.duration)),
    };
    Ok((model, scaled))
}

fn is_free(name: &str, kind: ShapeParameterKind, options: &LawOptions) -> bool {
    kind != ShapeParameterKind::Reference && options.held(name).is_none()
}

/// Refuses options that no fit of this form can follow, whatever the samples.
pub(crate) fn suits(form: &Form, options: &LawOptions) -> Result<(), FitError> {
    options.check()?;
    if options.bounds.is_empty() && options.fixed.is_empty() {
        return Ok(());
    }
    let constant = form.constant_name();
    let parameters = form.parameters().into_iter().filter(|(_, _, kind)| *kind != ShapeParameterKind::Reference);
    let parameters: Vec<String> = parameters.map(|(_, name, _)| name).collect();
    let amplitudes = form.amplitude_names();
    let all = || iter::once(constant).chain(amplitudes.iter().chain(&parameters).map(String::as_str));
    let named = options.bounds.iter().map(|(name, _)| name).chain(options.fixed.iter().map(|(name, _)| name));
    for name in named {
        if !all().any(|known| known == name) {
            return Err(FitError::UnknownParameter {
                name: name.clone(),
                known: all().collect::<Vec<_>>().join(", "),
            });
        }
    }
    for (name, value) in &options.fixed {
        if amplitudes.contains(name) {
            return Err(FitError::HeldAmplitude {
                name: name.clone(),
                held: iter::once(constant).chain(parameters.iter().map(String::as_str)).collect::<Vec<_>>().join(", "),
            });
        }
        if !(value.is_finite() && (*value > 0.0 || name == constant)) {
            return Err(FitError::FixedParameter {
                name: name.clone(),
                found: *value,
            });
        }
        within(name, *value, options)?;
    }
    match options.constant {
        ConstantChoice::Fixed(value) if options.held(constant).is_none() => within(constant, value, options),
        ConstantChoice::AsLaw | ConstantChoice::Free | ConstantChoice::Fixed(_) => Ok(()),
    }
}

/// Refuses a value to hold a parameter at that its bounds exclude.
fn within(name: &str, value: f64, options: &LawOptions) -> Result<(), FitError> {
    match options.bounds.iter().find(|(bounded, _)| bounded == name) {
        Some((_, (low, high))) if value < *low || value > *high => Err(FitError::FixedOutsideBounds {
            name: name.to_owned(),
            found: value,
            low: *low,
            high: *high,
        }),
        _ => Ok(()),
    }
}

fn parameters(
    named: Vec<(usize, String, ShapeParameterKind)>,
    scaled: &Scaled,
    options: &LawOptions,
) -> Result<Vec<ModelParameter>, FitError> {
    let log_duration = scaled.duration.ln();
    // A value as the caller writes it, in the units of the fit.
    let inner = |kind: ShapeParameterKind, value: f64| match kind {
        ShapeParameterKind::Pure { .. } => value,
        ShapeParameterKind::Time => log_duration - value.ln(),
        ShapeParameterKind::Rate | ShapeParameterKind::Reference => value.ln() + log_duration,
    };
    let mut parameters = Vec::with_capacity(named.len());
    for (shape, name, kind) in named {
        let widest = match kind {
            ShapeParameterKind::Pure { low, high, .. } => (low, high),
            _ => scaled.log_rates(),
        };
        let mut bounds = widest;
        if let Some((_, (low, high))) = options.bounds.iter().find(|(bounded, _)| *bounded == name) {
            let ends = [inner(kind, low.max(0.0)), inner(kind, high.max(0.0))];
            let pure = matches!(kind, ShapeParameterKind::Pure { .. });
            bounds = (ends[0].min(ends[1]).max(widest.0), ends[0].max(ends[1]).min(widest.1));
            // An exponent may be sought wherever the caller wants it; an end left open is that of the law.
            if pure {
                let end = |requested: f64, widest: f64| if requested.is_finite() { requested } else { widest };
                bounds = (end(*low, widest.0).max(f64::MIN_POSITIVE), end(*high, widest.1));
            }
            if !(bounds.0 <= bounds.1 && bounds.1.is_finite()) {
                return Err(FitError::Bounds {
                    name,
                    low: *low,
                    high: *high,
                });
            }
        }
        let mut fixed = (kind == ShapeParameterKind::Reference).then_some(0.0);
        if let Some(value) = options.held(&name) {
            fixed = Some(inner(kind, value));
        }
        parameters.push(ModelParameter {
            shape,
            name,
            kind,
            bounds,
            room: (widest.1 - widest.0).max(bounds.1 - bounds.0),
            fixed,
        });
    }
    Ok(parameters)
}

/// Bounds of constant and amplitudes; empty if nothing binds.
fn linear_bounds(
    form: &Form,
    constant: bool,
    samples: &Samples<'_>,
    scaled: &Scaled,
    options: &LawOptions,
) -> Vec<(f64, f64)> {
    let bound = |name: &String, offset: f64| {
        let requested = options.bounds.iter().find(|(bounded, _)| bounded == name);
        requested.map_or(FREE, |(_, (low, high))| ((low - offset) / scaled.range, (high - offset) / scaled.range))
    };
    if options.bounds.is_empty() && !options.one_sign {
        return Vec::new();
    }
    let mut bounds = Vec::new();
    if constant {
        bounds.push(bound(&form.constant_name().to_owned(), scaled.center));
    }
    let sign = options.one_sign.then(|| {
        let falls = change(samples) < 0.0;
        falls == (form.response == crate::laws::Response::Relaxation)
    });
    for name in form.amplitude_names() {
        let (low, high) = bound(&name, 0.0);
        bounds.push(match sign {
            None => (low, high),
            Some(true) => (low.max(0.0), high),
            Some(false) => (low, high.min(0.0)),
        });
    }
    if bounds.iter().all(|bound| *bound == FREE) { Vec::new() } else { bounds }
}

/// Whether the signal falls or rises: its late half against its early half.
pub(crate) fn change(samples: &Samples<'_>) -> f64 {
    let (early, late) = samples.values.split_at(samples.values.len() / 2);
    crate::statistics::mean(late) - crate::statistics::mean(early)
}
