//! A law fitted to the first part of a hold, held against the rest.

use serde::{Deserialize, Serialize};

use super::{
    Condensed, FitError, Fitted, LawOptions, Samples, Scaled, SpectrumOptions, build, condense, finalists,
    fit_spectrum, local, until,
};
use crate::laws::{BasisFunction, Law, LawCurve, Term};
use crate::optimise::{Effort, Ending, Termination, polished, refine, standing};

/// How well the first part of a hold predicts the rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Forecast {
    /// Time since the first sample up to which was fitted, s.
    pub cut: f64,
    /// Samples fitted.
    pub fitted: usize,
    /// Samples held out of the fit.
    pub held_out: usize,
    /// Root mean square error over those, in the unit of the signal; it contains their noise.
    pub rmse: f64,
    /// Mean error over those: above zero where the law runs above the data.
    pub bias: f64,
    /// Mean square error within each eighth of the time from the cut to the end; `None` where there are no samples.
    pub square_by_eighth: [Option<f64>; 8],
}

/// Fits `law` to the samples up to `cut` seconds after the first, and compares with those after it.
///
/// Both parts are condensed to nodes, which costs next to nothing: the fit moves by some hundredths of its standard errors, and
/// the error of a given curve by 10⁻⁴ of itself.
///
/// # Errors
/// [`FitError`] as for [`fit_law`](crate::fit::fit_law) on the first part; [`FitError::TooFewSamples`] if no sample is held out.
pub fn forecast(samples: &Samples<'_>, law: Law, options: &LawOptions, cut: f64) -> Result<Forecast, FitError> {
    options.check()?;
    samples.check(1)?;
    let start = samples.times[0];
    let fitted = until(samples.times, cut);
    if fitted == samples.times.len() {
        return Err(FitError::TooFewSamples {
            parameters: 1,
            needed: fitted + 1,
            found: fitted,
        });
    }
    let first = Samples {
        times: &samples.times[..fitted],
        values: &samples.values[..fitted],
        standard_deviations: samples.standard_deviations.map(|standard_deviations| &standard_deviations[..fitted]),
    };
    let curve = condensed_curve(&first, law, options)?;
    let times: Vec<f64> = samples.times[fitted..].iter().map(|t| t - start).collect();
    let rest = Condensed::finer(&times, &samples.values[fitted..]);
    let (mut squares, mut off, mut weights) = ([0.0; 8], 0.0, [0.0; 8]);
    let predicted = extrapolated(&curve, law, options, &rest.times);
    let last = times[times.len() - 1];
    for (((time, value), root), predicted) in rest.times.iter().zip(&rest.values).zip(&rest.roots).zip(predicted) {
        let error = root * predicted - value;
        let eighth = ((8.0 * (time - cut) / (last - cut)) as usize).min(7);
        squares[eighth] += error * error;
        weights[eighth] += root * root;
        off += root * error;
    }
    let weight: f64 = weights.iter().sum();
    // What nodes do not know of their samples is noise, everywhere alike.
    let inside = rest.inside / weight;
    let mean = |(square, weight): (f64, f64)| (weight > 0.0).then(|| square / weight + inside);
    Ok(Forecast {
        cut,
        fitted,
        held_out: times.len(),
        rmse: ((rest.inside + squares.iter().sum::<f64>()) / weight).sqrt(),
        bias: off / weight,
        square_by_eighth: std::array::from_fn(|eighth| mean((squares[eighth], weights[eighth]))),
    })
}

/// A law, or the spectrum, fitted to condensed samples.
pub(crate) fn condensed_curve(samples: &Samples<'_>, law: Law, options: &LawOptions) -> Result<LawCurve, FitError> {
    match law {
        Law::Spectrum => spectrum_curve(samples, options),
        _ => law_curve(samples, law, options),
    }
}

/// What such a curve is at times since the first sample, after the loading if there is one.
pub(crate) fn extrapolated(curve: &LawCurve, law: Law, options: &LawOptions, times: &[f64]) -> Vec<f64> {
    let remembers = !matches!(law, Law::Latency { .. } | Law::Spectrum);
    match &options.loading {
        Some(loading) if remembers => curve.after(loading, times),
        _ => curve.values(times),
    }
}

/// The law fitted to condensed samples.
fn law_curve(samples: &Samples<'_>, law: Law, options: &LawOptions) -> Result<LawCurve, FitError> {
    let (model, scaled) = build(options.form(law)?, samples, options)?;
    let nodes = condense(&scaled);
    let mut effort = Effort::default();
    let theta = finalists(&model, &nodes, options.most_iterations, &mut effort)?
        .into_iter()
        .next()
        .ok_or(FitError::NoDecay)?;
    let shapes = model.at(&nodes.times);
    let refined = refine(&shapes, nodes.target(), &theta, Ending::tight(1), &mut effort)?;
    let solution = if refined.point.square.is_finite() {
        polished(&shapes, nodes.target(), refined, &mut effort)?
    } else {
        // Merged terms: normal equations are singular there, and have left no amplitudes.
        let valley = local(&shapes, nodes.target(), &theta, f64::EPSILON, &mut effort)?;
        standing(&shapes, nodes.target(), &valley.theta, &valley.linear, Termination::Singular)
    };
    let fitted = Fitted {
        model,
        scaled,
        solution,
        counted: None,
    };
    Ok(fitted.curve())
}

/// The spectrum fitted to condensed samples.
fn spectrum_curve(samples: &Samples<'_>, options: &LawOptions) -> Result<LawCurve, FitError> {
    samples.check(3)?;
    let scaled = Scaled::new(samples, None)?;
    let nodes = condense(&scaled);
    let times: Vec<f64> = nodes.times.iter().map(|t| t * scaled.duration).collect();
    let value = |(value, root): (&f64, &f64)| value / root * scaled.range + scaled.center;
    let values: Vec<f64> = nodes.values.iter().zip(&nodes.roots).map(value).collect();
    let fit = fit_spectrum(&times, &values, Some(&nodes.roots), &SpectrumOptions::default())?;
    let term = |(time, height): (&f64, &f64)| Term {
        amplitude: fit.sign * height,
        shape: BasisFunction::Exponential,
        parameters: vec![-time.ln()],
    };
    let terms: Vec<Term> =
        fit.times.iter().zip(&fit.amplitudes).filter(|(_, height)| **height > 0.0).map(term).collect();
    Ok(LawCurve::relaxing(options.response, fit.equilibrium, terms))
}
