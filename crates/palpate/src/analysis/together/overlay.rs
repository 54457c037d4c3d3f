//! The same displacement simulated with the fitted parameters.

use crate::analysis::{AnalysisOptions, HoldAnalysis, measured_motion};
use crate::contact::{Layers, Specimen};
use crate::fit::LatencyFit;
use crate::latency::LatencyLaw;
use crate::record::Record;
use crate::segment::{After, ContactPoint, Segmentation};
use crate::simulate::{ContactModel, simulate_force};
use crate::statistics::{median, rms};

/// Samples of the record that are compared, at most.
const MOST_SAMPLES: usize = 20_000;

/// A simulation laid over the record.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Overlay {
    /// The model that was simulated.
    pub model: ContactModel,
    /// Whether the number of layers was fitted to the record.
    pub layers_fitted: bool,
    /// Times, s.
    pub time: Vec<f64>,
    /// Simulated force, N.
    pub force: Vec<f64>,
    /// Root mean square of measured less simulated force, N.
    pub rmse: f64,
    /// The same as a share of the largest measured force.
    pub relative: f64,
}

/// Simulates the record's own displacement with the law that its holds have in common.
///
/// v is the median over the holds after loading, at the common exponent. Where the number of layers is not given it is
/// fitted: only the overshoot in the ramps depends on it.
pub(in crate::analysis) fn overlay(
    (record, segmentation, contact): (&Record, &Segmentation, &ContactPoint),
    specimen: &Specimen,
    holds: &[HoldAnalysis],
    exponent: Option<f64>,
    options: &AnalysisOptions,
) -> Result<Overlay, String> {
    let n = exponent.ok_or("no exponent fits all holds")?;
    let usable = |after: Option<After>| -> Vec<f64> {
        let fits = holds.iter().filter(|hold| hold.after == after).filter_map(|hold| hold.fit_with(n));
        fits.filter(|fit| fit.termination.is_good())
            .map(|fit: &LatencyFit| fit.rate_coefficient().value)
            .collect()
    };
    let mut coefficients = usable(Some(After::Loading));
    if coefficients.is_empty() {
        coefficients = usable(Some(After::Unloading));
    }
    if coefficients.is_empty() {
        return Err("no hold gave a rate coefficient".to_owned());
    }
    let law = LatencyLaw::new(n, median(&mut coefficients)).map_err(|error| error.to_string())?;
    let motion = measured_motion(record, segmentation, contact, specimen, options.separation)
        .ok_or("the record has no displacement")?
        .map_err(|error| error.to_string())?
        .motion;
    let samples: Vec<usize> = (0..record.len()).step_by(record.len().div_ceil(MOST_SAMPLES)).collect();
    let time: Vec<f64> = samples.iter().map(|i| record.time()[*i]).collect();
    let measured: Vec<f64> = samples.iter().map(|i| record.force()[*i]).collect();
    let simulated = |layers: Layers| {
        let model = ContactModel {
            specimen: specimen.clone(),
            law,
            layers,
            separation: options.separation,
        };
        simulate_force(&motion, &model, &time)
            .map(|force| (model, force))
            .map_err(|error| error.to_string())
    };
    let (layers, layers_fitted) = match options.layers {
        Some(choice) => (choice.layers(specimen.depth()).map_err(|error| error.to_string())?, false),
        None => {
            let error = |layers: Layers| simulated(layers).map_or(f64::INFINITY, |(_, force)| rms(&measured, &force));
            (fitted_layers(error).ok_or("the simulation fails for every number of layers")?, true)
        }
    };
    let (model, force) = simulated(layers)?;
    let rmse = rms(&measured, &force);
    let largest = measured.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    Ok(Overlay {
        model,
        layers_fitted,
        time,
        force,
        rmse,
        relative: rmse / largest,
    })
}

/// The number of layers with the smallest error: a grid over ln (m − 1), then golden-section search.
fn fitted_layers(error: impl Fn(Layers) -> f64) -> Option<Layers> {
    let layers = |log: f64| Layers::new(1.0 + log.exp());
    let at = |log: f64| layers(log).map_or(f64::INFINITY, &error);
    const STEP: f64 = 0.5;
    let best = (-6..=18).map(|i| f64::from(i) * STEP).min_by(|a, b| at(*a).total_cmp(&at(*b)))?;
    let (mut low, mut high) = (best - STEP, best + STEP);
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut at_a, mut at_b) = (at(a), at(b));
    for _ in 0..20 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - ratio * (high - low);
            at_a = at(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + ratio * (high - low);
            at_b = at(b);
        }
    }
    let log = 0.5 * (low + high);
    at(log).is_finite().then(|| layers(log).ok()).flatten()
}
