//! What a calibrated body does, with intervals: series, table and figure.

use std::io::{self, Write};

use palpate::calibrate::Prediction;

use crate::figure::{Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::result::percent;
use crate::study::grid::displacement_panel;
use crate::study::simulate::write_series;
use crate::table::{Cell, Table};

/// Writes the course as CSV, one row a sample: force and displacement with the intervals of their means and of one reading, in SI.
///
/// # Errors
/// Whatever the writer says.
pub fn write_prediction(out: &mut dyn Write, prediction: &Prediction) -> io::Result<()> {
    let course = &prediction.trajectory;
    let columns: [(&str, &dyn Fn(usize) -> f64); 11] = [
        ("time_s", &|i| course.time[i]),
        ("displacement_m", &|i| course.displacement[i]),
        ("displacement_low_m", &|i| prediction.displacement_interval(i).0),
        ("displacement_high_m", &|i| prediction.displacement_interval(i).1),
        ("force_n", &|i| course.force[i]),
        ("force_low_n", &|i| prediction.force_interval(i).0),
        ("force_high_n", &|i| prediction.force_interval(i).1),
        ("reading_low_n", &|i| prediction.reading_interval(i).0),
        ("reading_high_n", &|i| prediction.reading_interval(i).1),
        ("force_standard_error_n", &|i| prediction.force_standard_error[i]),
        ("noise_n", &|_| prediction.noise),
    ];
    write_series(out, course.len(), &columns)
}

/// The forces at each sample: a row each, for people.
#[must_use]
pub fn prediction_table(prediction: &Prediction) -> Table {
    let share = percent(prediction.confidence);
    let course = &prediction.trajectory;
    let caption = format!(
        "Force by the calibrated law: {share} intervals of its mean (uncertainty of the calibration) and of a single reading (with {} N of noise).",
        significant(prediction.noise, 2)
    );
    let samples: Vec<usize> = (0..course.len()).collect();
    let number = |value: f64| Cell::Number(value, 4);
    Table::of("prediction", caption, &samples)
        .column("Time", "time_s", "s", |i| number(course.time[*i]))
        .column("Displacement", "displacement_mm", "mm", |i| number(1e3 * course.displacement[*i]))
        .column("Force", "force_n", "N", |i| number(course.force[*i]))
        .column("mean from", "force_low_n", "N", |i| number(prediction.force_interval(*i).0))
        .column("to", "force_high_n", "N", |i| number(prediction.force_interval(*i).1))
        .column("reading from", "reading_low_n", "N", |i| number(prediction.reading_interval(*i).0))
        .column("to", "reading_high_n", "N", |i| number(prediction.reading_interval(*i).1))
        .table()
}

/// Force with its bands, and the displacement of the jaw, over time.
#[must_use]
pub fn prediction_figure(prediction: &Prediction, name: &str, caption: &str) -> Figure {
    let course = &prediction.trajectory;
    let time = || course.time.clone();
    let ends =
        |interval: &dyn Fn(usize) -> (f64, f64)| -> (Vec<f64>, Vec<f64>) { (0..course.len()).map(interval).unzip() };
    let (low, high) = ends(&|i| prediction.force_interval(i));
    let (reading_low, reading_high) = ends(&|i| prediction.reading_interval(i));
    let share = percent(prediction.confidence);
    let force = Panel::over_time("Force", "N")
        .share(1.6)
        .layer(
            Layer::band(time(), reading_low, reading_high, Role::Alternative(0))
                .label(format!("single reading, {share}")),
        )
        .layer(Layer::band(time(), low, high, Role::Fitted).label(format!("mean, {share}")))
        .layer(Layer::line(time(), course.force.clone(), Role::Fitted).label("predicted"));
    let (near, far) = ends(&|i| {
        let (near, far) = prediction.displacement_interval(i);
        (1e3 * near, 1e3 * far)
    });
    let mut jaw = displacement_panel(&course.time, &course.displacement, Role::Fitted);
    if prediction.displacement_standard_error.iter().any(|deviation| *deviation > 0.0) {
        jaw = jaw.layer(Layer::band(time(), near, far, Role::Fitted));
    }
    Figure::new(name, caption).panel(force).panel(jaw).height_mm(120.0)
}
