//! The law and its closed form: figures 1 and 2 of the paper.

use palpate::latency::{LatencyLaw, decay};

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};

const POINTS: usize = 241;

/// Strain rate against excess strain for several exponents, at one relative rate for x = `reach` (figures 1b and 2).
pub(super) fn law(name: &str, law: LatencyLaw, reach: f64) -> Figure {
    let excess: Vec<f64> = (0..POINTS).map(|i| reach * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0)).collect();
    let fastest = law.rate(reach).abs();
    let mut panel =
        Panel::new(Axis::linear("Excess strain ε − εₑ", ""), Axis::linear("Strain rate", "s⁻¹")).zero_line();
    for (series, n) in [1.0, 2.0, 3.0, law.exponent()].into_iter().enumerate() {
        let role = if n == law.exponent() { Role::Fitted } else { Role::Series(series as u8) };
        let rates = excess.iter().map(|x| -fastest * x.signum() * (x / reach).abs().powf(n)).collect();
        panel = panel.layer(Layer::line(excess.clone(), rates, role).label(format!("n = {n}")));
    }
    Figure::new(
        name,
        format!(
            "The nonlinear latency law, equations (1) to (3): strain rate against excess strain for several exponents that agree at an excess of {reach}. With a higher exponent the flow nearly stops farther from equilibrium. n = 1 is the linear law."
        ),
    )
    .panel(panel)
    .width_mm(120.0)
    .height_mm(80.0)
}

/// The closed form, equations (4) and (5): Type I and Type II over time, and the normalised excess over log time.
pub(super) fn closed_form(name: &str, law: LatencyLaw, start: f64, equilibrium: f64) -> Figure {
    let times: Vec<f64> = (0..POINTS).map(|i| 10.0 * (i as f64 / (POINTS - 1) as f64).powi(2)).collect();
    let strain = |from: f64| times.iter().map(|t| equilibrium + law.excess_after(from, *t)).collect::<Vec<f64>>();
    let over_time = Panel::over_time("Strain", "")
        .title("Type I and Type II")
        .layer(Layer::line(times.clone(), strain(start), Role::Series(0)).label("Type I, equation (5)"))
        .layer(Layer::line(times.clone(), strain(-start), Role::Series(1)).label("Type II, equation (4)"))
        .layer(Layer::horizontal(equilibrium, Role::Reference).label("equilibrium"));
    let scaled: Vec<f64> = (0..POINTS).map(|i| 10f64.powf(-2.0 + 6.0 * i as f64 / (POINTS - 1) as f64)).collect();
    let mut normalised = Panel::new(Axis::log("λt", ""), Axis::linear("x/x₀", "")).title("One real exponent");
    for (series, n) in [0.5, 1.0, 2.0, 3.0, 5.0, 9.0].into_iter().enumerate() {
        let phi = scaled.iter().map(|s| decay(*s, n)).collect();
        normalised =
            normalised.layer(Layer::line(scaled.clone(), phi, Role::Series(series as u8)).label(format!("n = {n}")));
    }
    Figure::new(
        name,
        format!(
            "The closed form, equations (4) and (5). (a) Strain that starts {start} above and below its equilibrium, n = {}, v = {:.0} s⁻¹. (b) Normalised excess strain over scaled time: n = 1 is the exponential, n = 2 the hyperbola known as Peleg's, n below 1 ends in finite time.",
            law.exponent(),
            law.rate_coefficient()
        ),
    )
    .panel(over_time)
    .panel(normalised)
    .arrangement(Arrangement::SideBySide)
}
