//! A hold with a law and its forecast, as a panel.

use palpate::forecast::{Comparison, Forecasted, Row};
use palpate::laws::Law;

use crate::figure::{Axis, Layer, Panel, Role};
use crate::result::{ComparedHold, word};
use crate::word::capitalised;

/// How far forecasts are drawn, as a multiple of the duration of a hold.
pub(super) const FARTHEST: f64 = 3.0;

/// A hold with a law under a label and, from its end on, the forecast of all laws together, where there is one.
pub(super) fn forecast_panel(
    hold: &ComparedHold,
    comparison: &Comparison,
    law: Option<(Law, String)>,
    measured: Layer,
) -> Panel {
    const POINTS: usize = 161;
    const CONFIDENCE: f64 = 0.95;
    let first = hold.times.iter().copied().find(|t| *t > 0.0).unwrap_or(1.0);
    let last = hold.times.last().copied().unwrap_or(1.0);
    let spaced = |from: f64, to: f64| -> Vec<f64> {
        (0..POINTS).map(|i| from * (to / from).powf(i as f64 / (POINTS - 1) as f64)).collect()
    };
    let mut panel = Panel::new(Axis::log("Time", "s"), value_axis(hold)).layer(measured);
    let mut end = last;
    if let Some(forecast) = &comparison.forecast {
        end = FARTHEST * forecast.duration;
        let times = spaced(forecast.duration, end);
        let next = forecast.at_times(&times, CONFIDENCE);
        let column = |pick: fn(&Forecasted) -> f64| next.iter().map(pick).collect();
        let (low, high, value) = (column(|at| at.low), column(|at| at.high), column(|at| at.value));
        panel = panel
            .layer(Layer::vertical(forecast.duration, Role::Reference))
            .layer(Layer::band(times.clone(), low, high, Role::Simulated).label("95 % of samples"))
            .layer(Layer::line(times, value, Role::Simulated).label("forecast"));
    }
    panel.layers(law.and_then(|(law, label)| {
        let row = comparison.rows.iter().find(|row| row.law == law)?;
        let curve = spaced(first, end);
        let values = curve.iter().map(|t| predicted(row, *t)).collect();
        Some(Layer::line(curve, values, Role::Fitted).label(label))
    }))
}

/// The axis of what the laws were fitted to.
fn value_axis(hold: &ComparedHold) -> Axis {
    Axis::linear(capitalised(&word(hold.quantity)), hold.quantity.axis_unit())
}

/// What a law fitted to the whole hold is at a time.
pub(super) fn predicted(row: &Row, t: f64) -> f64 {
    match (&row.spectrum, &row.fit) {
        (Some(spectrum), _) => spectrum.predict(t),
        (None, Ok(fit)) => fit.predict(t),
        (None, Err(_)) => f64::NAN,
    }
}
