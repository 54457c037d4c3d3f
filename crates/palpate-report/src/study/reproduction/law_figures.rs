//! The law and its closed form: figures 1 and 2 of the paper.

use palpate::latency::{LatencyLaw, decay};

use super::numbering::caption;
use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};

const POINTS: usize = 241;

fn over_time(law: LatencyLaw, start: f64, equilibrium: f64) -> Panel {
    let times: Vec<f64> = (0..POINTS).map(|i| 10.0 * (i as f64 / (POINTS - 1) as f64).powi(2)).collect();
    let strain = |from: f64| times.iter().map(|t| equilibrium + law.excess_after(from, *t)).collect::<Vec<f64>>();
    Panel::over_time("Strain", "")
        .layer(Layer::line(times.clone(), strain(start), Role::Series(0)).label("Type I, equation (5)"))
        .layer(Layer::line(times.clone(), strain(-start), Role::Series(1)).label("Type II, equation (4)"))
        .layer(Layer::horizontal(equilibrium, Role::Reference).label("equilibrium"))
}

/// Strain rate over excess strain for some exponents that agree at an excess of `reach`.
fn rates(law: LatencyLaw, reach: f64, exponents: &[f64]) -> Panel {
    let excess: Vec<f64> = (0..POINTS).map(|i| reach * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0)).collect();
    let fastest = law.rate(reach).abs();
    let mut panel =
        Panel::new(Axis::linear("Excess strain ε − εₑ", ""), Axis::linear("Strain rate", "s⁻¹")).zero_line();
    for (series, n) in exponents.iter().enumerate() {
        let role = if *n == law.exponent() { Role::Fitted } else { Role::Series(series as u8) };
        let rates = excess.iter().map(|x| -fastest * x.signum() * (x / reach).abs().powf(*n)).collect();
        panel = panel.layer(Layer::line(excess.clone(), rates, role).label(format!("n = {n}")));
    }
    panel
}

/// Type I and Type II over time, and the linear law.
pub(super) fn types(law: LatencyLaw, start: f64, equilibrium: f64) -> Figure {
    let text = format!(
        "Type I and Type II relaxation from {start} above and below equilibrium by equations (4) and (5) with n = {}, v = {:.0} s⁻¹ (a), and the linear law (1) as a straight line of strain rate over strain (b).",
        law.exponent(),
        law.rate_coefficient()
    );
    Figure::new("figure_1", caption("figure_1", text))
        .panel(over_time(law, start, equilibrium))
        .panel(rates(law, start, &[1.0]))
        .arrangement(Arrangement::SideBySide)
}

/// The nonlinear law for several exponents.
pub(super) fn law(law: LatencyLaw, reach: f64) -> Figure {
    let text = format!(
        "The nonlinear law, equations (2) and (3), for several exponents that agree at an excess of {reach}. With a higher exponent the flow nearly stops farther from equilibrium."
    );
    Figure::new("figure_2", caption("figure_2", text))
        .panel(rates(law, reach, &[1.0, 2.0, 3.0, law.exponent()]))
        .width_mm(120.0)
        .height_mm(80.0)
}

/// The closed form over scaled time.
pub(super) fn closed_form() -> Figure {
    let scaled: Vec<f64> = (0..POINTS).map(|i| 10f64.powf(-2.0 + 6.0 * i as f64 / (POINTS - 1) as f64)).collect();
    let mut normalised = Panel::new(Axis::log("λt", ""), Axis::linear("x/x₀", ""));
    for (series, n) in [0.5, 1.0, 2.0, 3.0, 5.0, 9.0].into_iter().enumerate() {
        let phi = scaled.iter().map(|s| decay(*s, n)).collect();
        let role = Role::Series(series as u8);
        normalised = normalised.layer(Layer::line(scaled.clone(), phi, role).label(format!("n = {n}")));
    }
    let text = "The closed form, equations (4) and (5), over scaled time with λ = v|x₀|ⁿ⁻¹: n = 1 is the exponential, n = 2 the hyperbola known as Peleg's, n below 1 ends in finite time. For n above 1 equilibrium is never reached.";
    Figure::new("closed_form", caption("closed_form", text))
        .panel(normalised)
        .width_mm(120.0)
        .height_mm(80.0)
}
