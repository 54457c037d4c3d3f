//! What the uncertainty of the instrument and of the body adds to the errors of the parameters.

use crate::calibrate::prepared::Prepared;
use crate::calibrate::problem::{Found, Problem, Response, dot};
use crate::calibrate::{CalibrationData, MaterialUnit, SystematicEffect};
use crate::instrument::{Deviation, InstrumentInput, InstrumentQuantity};
use crate::parallel::for_each;
use crate::simulate::Motion;
use crate::watch::{Cancelled, Stages};

/// The effects of all input quantities, for the searched parameters `open` with their columns of the Jacobian and `gradients` of the logarithms
/// of all parameters by them; beside each its change of the residuals at parameters that stay.
///
/// With r the residuals, the least-squares parameters move by (JᵀJ)⁻¹ Jᵀ δr, where δr is what a quantity one standard uncertainty off changes
/// of measured and simulated forces: half the difference of both sides.
pub(super) fn systematic_effects(
    problem: &Problem<'_>,
    data: &CalibrationData,
    found: &Found,
    (open, gradients): (&[Vec<f64>], &[Vec<f64>]),
    stages: &mut Stages<'_>,
) -> Result<(Vec<SystematicEffect>, Vec<Vec<f64>>), Cancelled> {
    let Some(response) = Response::new(open) else {
        return Ok((Vec::new(), Vec::new()));
    };
    stages.hear()?;
    let inputs = &data.instrument().inputs;
    let still = Side::new(problem, data, found, &Deviation::default());
    let effect = |index: usize| {
        let InstrumentInput { quantity, uncertainty } = &inputs[index];
        let side = |by: f64| Side::new(problem, data, found, &Deviation::of(*quantity, by));
        let (low, high) = (side(-uncertainty.standard_uncertainty), side(uncertainty.standard_uncertainty));
        // Where a quantity leaves no body on one side the other stands for it.
        let share = if low.is_some() && high.is_some() { 0.5 } else { 1.0 };
        let (low, high) = (low.as_ref().or(still.as_ref())?, high.as_ref().or(still.as_ref())?);
        let change: Vec<f64> = low.residuals.iter().zip(&high.residuals).map(|(l, h)| share * (h - l)).collect();
        let moved = response.to(&change);
        let direct = low.logs.iter().zip(&high.logs).map(|(low, high)| share * (high - low));
        let through = |index: usize| gradients.get(index).map_or(0.0, |gradient| dot(gradient, &moved));
        let logs: Vec<f64> = direct.enumerate().map(|(index, direct)| direct + through(index)).collect();
        // A modulus that was given is none of what is estimated here.
        let has_effect = *quantity != InstrumentQuantity::Modulus && logs.iter().all(|log| log.is_finite());
        let effect = SystematicEffect {
            input: uncertainty.clone(),
            logs,
        };
        has_effect.then_some((effect, change))
    };
    Ok(for_each(inputs.len(), effect).into_iter().flatten().unzip())
}

/// What the same searched parameters make of a record with a quantity off its estimate.
struct Side {
    residuals: Vec<f64>,
    /// Logarithms of the parameters, then of the dimensions of the body.
    logs: Vec<f64>,
}

impl Side {
    fn new(problem: &Problem<'_>, data: &CalibrationData, found: &Found, deviation: &Deviation) -> Option<Self> {
        let prepared = problem.prepared.with_shape(deviation.shape(&problem.prepared.body.shape))?;
        let motion = moved(data, deviation)?;
        let forces: Vec<f64> = problem
            .forces
            .iter()
            .zip(problem.times)
            .map(|(force, time)| deviation.force_at(*force, *time))
            .collect();
        let times: Vec<f64> = problem.times.iter().map(|time| deviation.time(*time)).collect();
        let residuals = Problem {
            prepared: &prepared,
            motion: &motion,
            times: &times,
            forces: &forces,
            ..*problem
        }
        .residuals(&found.theta)?;
        Some(Self {
            residuals,
            logs: logs(&prepared, &found.theta, deviation),
        })
    }
}

/// Logarithms of the parameters, at the temperature that is stated, and of the dimensions of the body.
fn logs(prepared: &Prepared, theta: &[f64], deviation: &Deviation) -> Vec<f64> {
    let (stiffer, faster) = (deviation.modulus_at_temperature.ln_1p(), deviation.rate_at_temperature.ln_1p());
    let at_stated = |(value, unit): (f64, MaterialUnit)| {
        value.ln()
            - match unit {
                MaterialUnit::Pascal | MaterialUnit::Newton => stiffer,
                MaterialUnit::PerSecond => faster,
                MaterialUnit::Second => -faster,
                MaterialUnit::One | MaterialUnit::Metre => 0.0,
            }
    };
    let shape = &prepared.body.shape;
    let dimensions = shape.dimensions().iter().filter_map(|dimension| shape.dimension(*dimension)).map(f64::ln);
    prepared.values(theta).into_iter().zip(prepared.units()).map(at_stated).chain(dimensions).collect()
}

/// The motion of the jaw with a quantity off its estimate. A touch that was earlier prolongs the first ramp back to it.
fn moved(data: &CalibrationData, deviation: &Deviation) -> Option<Motion> {
    let motion = data.motion();
    let displaced = |(time, place): (&f64, &f64)| deviation.displacement(*place, data.force_at(*time));
    let mut places: Vec<f64> = motion.times().iter().zip(motion.displacements()).map(displaced).collect();
    let mut times: Vec<f64> = motion.times().iter().map(|time| deviation.time(*time)).collect();
    let (start, speed) = (motion.displacements()[0], (places[1] - places[0]) / (times[1] - times[0]));
    if places[0] > start && speed > 0.0 {
        times.insert(0, times[0] - (places[0] - start) / speed);
        places.insert(0, start);
    }
    Motion::new(times, places).ok()
}
