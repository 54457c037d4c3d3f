//! What is drawn of holds, simulated or measured: figures 4, 6 and 8 of the paper.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::fit::LatencyFit;
use palpate::segment::After;

use super::numbering::caption;
use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};
use crate::study::grid::displacement_panel;

/// The paper's exponent.
pub(super) const ORDER: f64 = 5.0;
/// A fit of a hold, if it has that.
type FitOf = fn(&HoldAnalysis) -> Option<&LatencyFit>;
/// Points of a fitted curve.
const CURVE: usize = 120;

/// Force above, displacement below: the layout of figure 4.
pub(super) fn protocol(
    name: &str,
    text: &str,
    time: &[f64],
    force: &[f64],
    displacement: Option<&[f64]>,
    role: Role,
) -> Figure {
    let below = displacement.map(|displacement| displacement_panel(time, displacement, role));
    let force = Layer::line(time.to_vec(), force.to_vec(), role);
    Figure::new(name, caption(name, text))
        .panel(Panel::over_time("Force", "N").share(1.7).zero_line().layer(force))
        .panels(below)
        .without_letters()
}

/// Strain rate over strain of some holds with the fits of (10), compression negative: the layout of figure 6. `None` without rates.
pub(super) fn rates(name: &str, text: &str, holds: &[&HoldAnalysis]) -> Option<Figure> {
    let shown: Vec<&&HoldAnalysis> = holds.iter().filter(|hold| !hold.rates.rate.is_empty()).collect();
    let first = shown.first()?;
    let (x, y) = match first.signal {
        Signal::Strain => (Axis::linear("Strain", ""), Axis::linear("Strain rate", "s⁻¹")),
        Signal::Force => (Axis::linear("Force", "N"), Axis::linear("Force rate", "N/s")),
    };
    // The paper counts compressive strain as negative.
    let sign = if first.signal == Signal::Strain { -1.0 } else { 1.0 };
    let signed = |values: &[f64]| values.iter().map(|value| sign * value).collect::<Vec<f64>>();
    let mut panel = Panel::new(x, y).zero_line();
    for hold in &shown {
        let points = Layer::points(signed(&hold.rates.strain), signed(&hold.rates.rate), Role::Series(0));
        panel = panel.layer(points.label("derivative (9)"));
    }
    let fits: [(Role, &str, FitOf); 2] = [
        (Role::Fitted, "(10) fitted to these points", |hold| hold.rate_fit_with(ORDER)),
        (Role::Alternative(0), "(5), (4) fitted over time", |hold| hold.fit_with(ORDER)),
    ];
    for (role, label, fit) in fits {
        for hold in &shown {
            let Some(fit) = fit(hold) else { continue };
            let (low, high) = hold.rates.strain.iter().fold((f64::MAX, f64::MIN), |(l, h), e| (l.min(*e), h.max(*e)));
            let strains: Vec<f64> = (0..CURVE).map(|i| low + (high - low) * i as f64 / (CURVE - 1) as f64).collect();
            let rate = |strain: &f64| {
                let x = strain - fit.equilibrium().value;
                -fit.rate_coefficient().value * x.signum() * x.abs().powf(ORDER)
            };
            let rates: Vec<f64> = strains.iter().map(rate).collect();
            panel = panel.layer(Layer::line(signed(&strains), signed(&rates), role).label(label));
        }
    }
    Some(Figure::new(name, caption(name, text)).panel(panel).width_mm(150.0).height_mm(90.0))
}

/// v over the equilibrium strain, after loading and after unloading; `None` for fewer than two fits.
pub(super) fn rate_coefficients(name: &str, text: &str, holds: &[&HoldAnalysis]) -> Option<Figure> {
    let fitted = fitted(holds);
    let is_strain = holds.iter().all(|hold| hold.signal == Signal::Strain);
    let x = if is_strain {
        Axis::linear("Equilibrium strain εₑ", "")
    } else {
        Axis::linear("Equilibrium force", "N")
    };
    let sign = if is_strain { -1.0 } else { 1.0 };
    let mut panel = Panel::new(x, Axis::log("Rate coefficient v", if is_strain { "s⁻¹" } else { "N⁻⁴ s⁻¹" }));
    for (after, role, label) in [
        (After::Loading, Role::Series(0), "after loading"),
        (After::Unloading, Role::Series(1), "after unloading"),
    ] {
        let of: Vec<&LatencyFit> =
            fitted.iter().filter(|(hold, _)| hold.after == Some(after)).map(|(_, fit)| *fit).collect();
        let x = of.iter().map(|fit| sign * fit.equilibrium().value).collect();
        let y = of.iter().map(|fit| fit.rate_coefficient().value).collect();
        let errors: Vec<f64> = of.iter().map(|fit| fit.rate_coefficient().standard_error.unwrap_or(0.0)).collect();
        panel = panel.layer(Layer::points(x, y, role).error_bars(&errors).label(label));
    }
    let figure = Figure::new(name, caption(name, text)).panel(panel).width_mm(120.0).height_mm(80.0);
    (fitted.len() >= 2).then_some(figure)
}

/// ε_e over the displacement, after loading and after unloading, with that of uniform strain; `None` without a strain.
pub(super) fn equilibria(
    name: &str,
    text: &str,
    holds: &[&HoldAnalysis],
    uniform: impl Fn(f64) -> f64,
) -> Option<Figure> {
    let fitted = fitted(holds);
    let points = |after: After| {
        let of = fitted.iter().filter(move |(hold, _)| hold.after == Some(after) && hold.signal == Signal::Strain);
        of.filter_map(|(hold, fit)| Some((1e3 * hold.displacement?, fit.equilibrium())))
    };
    let most = points(After::Loading).chain(points(After::Unloading)).map(|(d, _)| d).fold(0.0, f64::max);
    let mut panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("Equilibrium strain εₑ", ""));
    for (after, role, label) in [
        (After::Loading, Role::Series(0), "after loading"),
        (After::Unloading, Role::Series(1), "after unloading"),
    ] {
        let (x, found): (Vec<f64>, Vec<_>) = points(after).unzip();
        let errors: Vec<f64> = found.iter().map(|estimate| estimate.standard_error.unwrap_or(0.0)).collect();
        let y = found.iter().map(|estimate| -estimate.value).collect();
        panel = panel.layer(Layer::points(x, y, role).error_bars(&errors).label(label));
    }
    let line = vec![-uniform(0.0), -uniform(1e-3 * most)];
    panel = panel.layer(Layer::line(vec![0.0, most], line, Role::Reference).label("uniform strain"));
    let figure = Figure::new(name, caption(name, text)).panel(panel).width_mm(120.0).height_mm(80.0);
    (most > 0.0).then_some(figure)
}

/// Holds with their fits by n = 5 that ended well.
pub(super) fn fitted<'a>(holds: &[&'a HoldAnalysis]) -> Vec<(&'a HoldAnalysis, &'a LatencyFit)> {
    let fits = holds.iter().filter_map(|hold| Some((*hold, hold.fit_with(ORDER)?)));
    fits.filter(|(_, fit)| fit.termination.is_good()).collect()
}

/// Simulation beside measurement: the layout of figure 8. `None` where the record could not be simulated.
pub(super) fn beside(name: &str, analysis: &Analysis) -> Option<Figure> {
    let overlay = analysis.overlay.as_ref()?;
    let (time, force) = (analysis.record.time(), analysis.record.force());
    let text = format!(
        "Simulation beside measurement: the measured displacement simulated with n = {}, v = {} s⁻¹ and m = {}.",
        overlay.model.law.exponent(),
        crate::number::significant(overlay.model.law.rate_coefficient(), 3),
        crate::number::significant(overlay.model.layers.count(), 3)
    );
    let measured = Layer::line(time.to_vec(), force.to_vec(), Role::Measured).label("measured");
    let simulated = Layer::line(overlay.time.clone(), overlay.force.clone(), Role::Simulated).label("simulated");
    let panels = [Panel::over_time("Force", "N").layer(measured), Panel::over_time("Force", "N").layer(simulated)];
    Some(
        Figure::new(name, caption(name, text))
            .panels(panels)
            .arrangement(Arrangement::SideBySide)
            .without_letters(),
    )
}
