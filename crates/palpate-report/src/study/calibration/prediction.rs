//! What a calibrated body does, with intervals: series, table and figure.

use std::io::{self, Write};

use palpate::calibrate::Prediction;

use crate::figure::{Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::result::percent;
use crate::study::grid::displacement_panel;
use crate::study::simulate::write_series;
use crate::table::{Cell, CsvLocale, Table};

/// Writes the course as CSV, one row a sample: force and displacement with the intervals of their means and of one reading, in SI; an interval
/// that is not known is empty.
///
/// # Errors
/// Whatever the writer says.
pub fn write_prediction(out: &mut dyn Write, prediction: &Prediction, locale: CsvLocale) -> io::Result<()> {
    let course = &prediction.trajectory;
    let (low, high) = (
        |ends: Option<(f64, f64)>| ends.map_or(f64::NAN, |ends| ends.0),
        |ends: Option<(f64, f64)>| ends.map_or(f64::NAN, |ends| ends.1),
    );
    let columns: [(&str, &dyn Fn(usize) -> f64); 11] = [
        ("time_s", &|i| course.time[i]),
        ("displacement_m", &|i| course.displacement[i]),
        ("displacement_low_m", &|i| low(prediction.displacement_interval(i))),
        ("displacement_high_m", &|i| high(prediction.displacement_interval(i))),
        ("force_n", &|i| course.force[i]),
        ("force_low_n", &|i| low(prediction.force_interval(i))),
        ("force_high_n", &|i| high(prediction.force_interval(i))),
        ("reading_low_n", &|i| low(prediction.reading_interval(i))),
        ("reading_high_n", &|i| high(prediction.reading_interval(i))),
        ("force_standard_error_n", &|i| {
            prediction.force_standard_error.as_ref().map_or(f64::NAN, |errors| errors[i])
        }),
        ("noise_n", &|_| prediction.noise),
    ];
    write_series(out, course.len(), &columns, locale)
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
    let end = |value: Option<f64>| Cell::number_or(value, 4, "the test leaves a parameter open");
    Table::of("prediction", caption, &samples)
        .column("Time", "time_s", "s", |i| number(course.time[*i]))
        .column("Displacement", "displacement_mm", "mm", |i| number(1e3 * course.displacement[*i]))
        .column("Force", "force_n", "N", |i| number(course.force[*i]))
        .column("mean from", "force_low_n", "N", |i| end(prediction.force_interval(*i).map(|ends| ends.0)))
        .column("to", "force_high_n", "N", |i| end(prediction.force_interval(*i).map(|ends| ends.1)))
        .column("reading from", "reading_low_n", "N", |i| end(prediction.reading_interval(*i).map(|ends| ends.0)))
        .column("to", "reading_high_n", "N", |i| end(prediction.reading_interval(*i).map(|ends| ends.1)))
        .table()
}

/// Force with its bands, and the displacement of the jaw, over time.
#[must_use]
pub fn prediction_figure(prediction: &Prediction, name: &str, caption: &str) -> Figure {
    let course = &prediction.trajectory;
    let time = || course.time.clone();
    let ends = |interval: &dyn Fn(usize) -> Option<(f64, f64)>| -> Option<(Vec<f64>, Vec<f64>)> {
        (0..course.len()).map(interval).collect::<Option<Vec<_>>>().map(|ends| ends.into_iter().unzip())
    };
    let share = percent(prediction.confidence);
    let mut force = Panel::over_time("Force", "N").share(1.6);
    if let Some((low, high)) = ends(&|i| prediction.reading_interval(i)) {
        let band = Layer::band(time(), low, high, Role::Alternative(0));
        force = force.layer(band.label(format!("single reading, {share}")));
    }
    if let Some((low, high)) = ends(&|i| prediction.force_interval(i)) {
        force = force.layer(Layer::band(time(), low, high, Role::Fitted).label(format!("mean, {share}")));
    }
    let force = force.layer(Layer::line(time(), course.force.clone(), Role::Fitted).label("predicted"));
    let mut jaw = displacement_panel(&course.time, &course.displacement, Role::Fitted);
    let millimetres = |i| prediction.displacement_interval(i).map(|(near, far)| (1e3 * near, 1e3 * far));
    if let Some((near, far)) = ends(&millimetres)
        && near != far
    {
        jaw = jaw.layer(Layer::band(time(), near, far, Role::Fitted));
    }
    Figure::new(name, caption).panel(force).panel(jaw).height_mm(120.0)
}
