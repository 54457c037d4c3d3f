//! Force, margin and displacement of planned grips over time.

use palpate::calibrate::Prediction;

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::result::{GrippedBody, TriedSqueeze, percent};

/// The grips over time: force with the limit at which it slips, margin over that limit, displacement of the jaws; the one that is in question
/// with its band.
#[must_use]
pub fn grip_figure(body: &GrippedBody<'_>, name: &str) -> Figure {
    let answer = &body.answer;
    let named = [
        ("displacement held", Role::Fitted),
        ("overshoot and back off", Role::Alternative(0)),
        ("force held", Role::Alternative(1)),
        ("squeezed again", Role::Alternative(2)),
    ];
    let all = named.into_iter().zip(body.grips());
    let shown: Vec<(&str, Role, &Prediction)> =
        all.filter_map(|((name, role), course)| Some((name, role, course?.ok()?))).collect();
    let closing = answer.squeeze.as_ref().map_or(body.grip.limits().closing.unwrap_or(2.0), |made| made.found.closing);
    // A hold that is long beside the squeeze is recognised by its logarithm.
    let axis = || {
        if answer.shown > 30.0 * closing {
            Axis::log("Time", "s").range(0.1 * closing, closing + answer.shown)
        } else {
            Axis::linear("Time", "s")
        }
    };
    let mut force = Panel::new(axis(), Axis::linear("Force", "N")).share(1.6);
    let mut margin = Panel::new(axis(), Axis::linear("Force / needed", ""));
    let mut jaw = Panel::new(axis(), Axis::linear("Displacement", "mm"));
    let needed = |course: &Prediction, i: usize| body.grip.needed_force(course.trajectory.displacement[i]);
    if let Some(course) = answer.course() {
        let role = shown.iter().find(|(.., one)| std::ptr::eq(*one, course)).map_or(Role::Fitted, |(_, role, _)| *role);
        let time = || course.trajectory.time.clone();
        let ends: Option<Vec<(f64, f64)>> = (0..course.trajectory.len()).map(|i| course.force_interval(i)).collect();
        if let Some((low, high)) = ends.map(|ends| ends.into_iter().unzip::<_, _, Vec<f64>, Vec<f64>>()) {
            let of_needed = |ends: &[f64]| ends.iter().enumerate().map(|(i, end)| end / needed(course, i)).collect();
            // Before the jaws touch there is nothing to need.
            margin = margin.layer(Layer::band(time(), of_needed(&low), of_needed(&high), role));
            force = force.layer(Layer::band(time(), low, high, role).label(percent(course.confidence)));
        }
        let limit = (0..course.trajectory.len()).map(|i| needed(course, i)).collect();
        force = force.layer(Layer::line(time(), limit, Role::Reference).label("slips below"));
    }
    for (name, role, prediction) in shown {
        let course = &prediction.trajectory;
        let time = || course.time.clone();
        force = force.layer(Layer::line(time(), course.force.clone(), role).label(name));
        let ratio = (0..course.len()).map(|i| course.force[i] / needed(prediction, i)).collect();
        margin = margin.layer(Layer::line(time(), ratio, role));
        let place = course.displacement.iter().map(|place| 1e3 * place).collect();
        jaw = jaw.layer(Layer::line(time(), place, role));
    }
    margin = margin.layer(Layer::horizontal(1.0, Role::Reference));
    Figure::new(
        name,
        "Planned grips: force of the jaws with the slip limit, their ratio, and the displacement of the jaws.",
    )
    .panel(force)
    .panel(margin)
    .panel(jaw)
    .height_mm(150.0)
}

/// A squeeze that is tried: its force with the band, and the force below which it slips.
#[must_use]
pub fn tried_figure(tried: &TriedSqueeze) -> Figure {
    let end = tried.closing_s + tried.hold_s;
    let axis = if tried.hold_s > 30.0 * tried.closing_s {
        Axis::log("Time", "s").range(0.1 * tried.closing_s, end)
    } else {
        Axis::linear("Time", "s")
    };
    let time = || tried.time_s.clone();
    let mut force = Panel::new(axis, Axis::linear("Force", "N"));
    if !tried.force_low_n.is_empty() {
        let band = Layer::band(time(), tried.force_low_n.clone(), tried.force_high_n.clone(), Role::Fitted);
        force = force.layer(band.label(percent(tried.confidence)));
    }
    let slips = vec![tried.needed_force_n; tried.time_s.len()];
    force = force
        .layer(Layer::line(time(), slips, Role::Reference).label("slips below"))
        .layer(Layer::line(time(), tried.force_n.clone(), Role::Fitted).label("force"));
    Figure::new("tried", "Force of the squeeze over time, and the force below which the body slips.")
        .panel(force)
        .height_mm(62.0)
}
