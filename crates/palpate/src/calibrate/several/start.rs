//! Where the search starts: from the records calibrated alone.

use super::sharing::Layout;
use crate::calibrate::Calibration;

/// Whether a record determines all parameters when it is calibrated alone. Where noise hides the ramps, a record may fit best where the layer is
/// as thin as is searched and the modulus vanishes, which is no place to start from.
pub(super) fn is_determined(layout: &Layout, made: &Calibration) -> bool {
    made.termination.is_good() && layout.parameters().iter().all(|parameter| log_variance(made, *parameter).is_some())
}

/// Where the search starts: own parameters as calibrated alone, shared ones at their mean weighted by the information of each record. A record
/// that does not determine its parameters alone starts from the mean of the others.
pub(super) fn start(layout: &Layout, alone: &[Calibration]) -> Vec<f64> {
    let mean = |parameter: usize| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for made in alone.iter().filter(|made| is_determined(layout, made)) {
            let weight = log_variance(made, parameter).map_or(0.0, |variance| 1.0 / variance);
            sum += weight * log_of(made, parameter);
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { log_of(&alone[0], parameter) }
    };
    let own = alone.iter().flat_map(|made| {
        let log =
            |parameter: &usize| if is_determined(layout, made) { log_of(made, *parameter) } else { mean(*parameter) };
        layout.own.iter().map(log).collect::<Vec<f64>>()
    });
    layout.shared.iter().map(|parameter| mean(*parameter)).chain(own).collect()
}

/// The logarithm of a parameter of a record calibrated alone.
pub(super) fn log_of(made: &Calibration, parameter: usize) -> f64 {
    made.material.parameters()[parameter].estimate.value.ln()
}

/// Variance of the logarithm of a parameter of a record calibrated alone; `None` where it is not determined.
pub(super) fn log_variance(made: &Calibration, parameter: usize) -> Option<f64> {
    let uncertainty = made.material.uncertainty()?;
    made.material.parameters()[parameter].estimate.standard_error?;
    Some(uncertainty.covariance[parameter][parameter]).filter(|variance| *variance > 0.0)
}
