//! A law fitted to samples beside which the force drifts: what the slope of a baseline does to its parameters.

use crate::fit::{Fit, IntervalMethod, LawOptions, NoiseChoice, Samples, fit_law_watched, fitted};
use crate::laws::Law;
use crate::watch::{Cancelled, Watch};

/// A law fitted to samples that drift by so much a second; `None` where it cannot be fitted.
pub(super) fn drifting(
    law: Law,
    samples: &Samples<'_>,
    options: &LawOptions,
    drift: f64,
    watch: &mut dyn Watch,
) -> Result<Option<Fit>, Cancelled> {
    let values: Vec<f64> = samples.values.iter().zip(samples.times).map(|(value, time)| value + drift * time).collect();
    // Its intervals are not used.
    let options = LawOptions {
        intervals: IntervalMethod::Curvature,
        noise: NoiseChoice::White,
        ..options.clone()
    };
    fitted(fit_law_watched(&Samples::new(samples.times, &values), law, &options, watch))
}
