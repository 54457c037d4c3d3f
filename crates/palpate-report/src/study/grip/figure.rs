//! Force, margin and displacement of planned grips over time.

use palpate::calibrate::Prediction;

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};
use crate::result::{GrippedBody, percent};

/// One grip of the figure.
struct Shown<'a> {
    name: &'static str,
    role: Role,
    course: &'a Prediction,
}

/// The grips over time: force with the limit at which it slips, margin over that limit, displacement of the jaws; the one that is asked about
/// with its band.
#[must_use]
pub fn grip_figure(body: &GrippedBody<'_>, name: &str) -> Figure {
    let answer = &body.answer;
    let all = [
        ("displacement held", Role::Fitted, answer.squeeze.as_ref().ok().map(|made| &made.course)),
        ("squeeze and back off", Role::Alternative(0), answer.back_off.as_ref().ok().map(|made| &made.course)),
        ("force held", Role::Alternative(1), answer.force_hold.as_ref().ok().map(|made| &made.course)),
        (
            "squeezed again",
            Role::Alternative(2),
            answer.schedule.as_ref().and_then(|made| made.as_ref().ok()).map(|made| &made.course),
        ),
    ];
    let shown: Vec<Shown<'_>> = all
        .into_iter()
        .filter_map(|(name, role, course)| {
            Some(Shown {
                name,
                role,
                course: course?,
            })
        })
        .collect();
    let closing = answer.squeeze.as_ref().map_or(body.grip.limits().closing.unwrap_or(2.0), |made| made.found.closing);
    // A hold that is long beside the squeeze is told by its logarithm.
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
        let role = shown.iter().find(|one| std::ptr::eq(one.course, course)).map_or(Role::Fitted, |one| one.role);
        let time = || course.trajectory.time.clone();
        let ends =
            |f: &dyn Fn(usize) -> (f64, f64)| -> (Vec<f64>, Vec<f64>) { (0..course.trajectory.len()).map(f).unzip() };
        let (low, high) = ends(&|i| course.force_interval(i));
        force = force.layer(Layer::band(time(), low, high, role).label(percent(course.confidence)));
        let (low, high) = ends(&|i| {
            let (low, high) = course.force_interval(i);
            (low / needed(course, i), high / needed(course, i))
        });
        // Before the jaws touch there is nothing to need.
        margin = margin.layer(Layer::band(time(), low, high, role));
        let limit = (0..course.trajectory.len()).map(|i| needed(course, i)).collect();
        force = force.layer(Layer::line(time(), limit, Role::Reference).label("slips below"));
    }
    for one in &shown {
        let course = &one.course.trajectory;
        let time = || course.time.clone();
        force = force.layer(Layer::line(time(), course.force.clone(), one.role).label(one.name));
        let ratio = (0..course.len()).map(|i| course.force[i] / needed(one.course, i)).collect();
        margin = margin.layer(Layer::line(time(), ratio, one.role));
        let place = course.displacement.iter().map(|place| 1e3 * place).collect();
        jaw = jaw.layer(Layer::line(time(), place, one.role));
    }
    margin = margin.layer(Layer::horizontal(1.0, Role::Reference));
    Figure::new(name, "Planned grips: force of the jaws with the one below which the body slips, how many times it is there, and how far the jaws go.")
        .panel(force)
        .panel(margin)
        .panel(jaw)
        .arrangement(Arrangement::Stacked)
        .height_mm(150.0)
}
