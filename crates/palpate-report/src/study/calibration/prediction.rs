//! What a calibrated body does, with intervals: series, table and figure.

use std::io::{self, Write};

use palpate::calibrate::Prediction;

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};
use crate::number::{exact, significant};
use crate::result::percent;
use crate::table::{Cell, Table, TableColumn};

/// Writes the course as CSV, one row a sample: force and displacement with the intervals of their means and of one reading, in SI.
///
/// # Errors
/// Whatever the writer says.
pub fn write_prediction(out: &mut dyn Write, prediction: &Prediction) -> io::Result<()> {
    write!(
        out,
        "time_s,displacement_m,displacement_low_m,displacement_high_m,force_n,force_low_n,force_high_n,reading_low_n,reading_high_n,force_error_n,noise_n\r\n"
    )?;
    let course = &prediction.trajectory;
    for i in 0..course.len() {
        let (low, high) = prediction.force_interval(i);
        let (reading_low, reading_high) = prediction.reading_interval(i);
        let (near, far) = prediction.displacement_interval(i);
        let numbers = [
            course.time[i],
            course.displacement[i],
            near,
            far,
            course.force[i],
            low,
            high,
            reading_low,
            reading_high,
            prediction.force_deviation[i],
            prediction.noise,
        ];
        let cells: Vec<String> = numbers.iter().map(|number| exact(number + 0.0)).collect();
        write!(out, "{}\r\n", cells.join(","))?;
    }
    Ok(())
}

/// The forces at each sample: a row each, for people.
#[must_use]
pub fn prediction_table(prediction: &Prediction) -> Table {
    let share = percent(prediction.confidence);
    let course = &prediction.trajectory;
    let caption = format!(
        "Force by the calibrated law: {share} intervals of its mean (what the calibration leaves open) and of one reading ({} N of noise besides).",
        significant(prediction.noise, 2)
    );
    let mut table = Table::new("prediction", caption)
        .column(TableColumn::new("Time", "time_s", "s"))
        .column(TableColumn::new("Displacement", "displacement_mm", "mm"))
        .column(TableColumn::new("Force", "force_n", "N"))
        .column(TableColumn::new("mean from", "force_low_n", "N"))
        .column(TableColumn::new("to", "force_high_n", "N"))
        .column(TableColumn::new("reading from", "reading_low_n", "N"))
        .column(TableColumn::new("to", "reading_high_n", "N"));
    for i in 0..course.len() {
        let ((low, high), (reading_low, reading_high)) = (prediction.force_interval(i), prediction.reading_interval(i));
        table = table.row(vec![
            Cell::number(course.time[i], 4),
            Cell::number(1e3 * course.displacement[i], 4),
            Cell::number(course.force[i], 4),
            Cell::number(low, 4),
            Cell::number(high, 4),
            Cell::number(reading_low, 4),
            Cell::number(reading_high, 4),
        ]);
    }
    table
}

/// Force with its bands, and the displacement of the jaw, over time.
#[must_use]
pub fn prediction_figure(prediction: &Prediction, name: &str, caption: &str) -> Figure {
    let course = &prediction.trajectory;
    let (time, axis) = (|| course.time.clone(), || Axis::linear("Time", "s"));
    let ends =
        |interval: &dyn Fn(usize) -> (f64, f64)| -> (Vec<f64>, Vec<f64>) { (0..course.len()).map(interval).unzip() };
    let (low, high) = ends(&|i| prediction.force_interval(i));
    let (reading_low, reading_high) = ends(&|i| prediction.reading_interval(i));
    let share = percent(prediction.confidence);
    let force = Panel::new(axis(), Axis::linear("Force", "N"))
        .share(1.6)
        .layer(
            Layer::band(time(), reading_low, reading_high, Role::Alternative(0)).label(format!("one reading, {share}")),
        )
        .layer(Layer::band(time(), low, high, Role::Fitted).label(format!("mean, {share}")))
        .layer(Layer::line(time(), course.force.clone(), Role::Fitted).label("predicted"));
    let (near, far) = ends(&|i| {
        let (near, far) = prediction.displacement_interval(i);
        (1e3 * near, 1e3 * far)
    });
    let mut jaw = Panel::new(axis(), Axis::linear("Displacement", "mm"));
    if prediction.displacement_deviation.iter().any(|deviation| *deviation > 0.0) {
        jaw = jaw.layer(Layer::band(time(), near, far, Role::Fitted));
    }
    jaw = jaw.layer(Layer::line(time(), course.displacement.iter().map(|place| 1e3 * place).collect(), Role::Fitted));
    Figure::new(name, caption)
        .panel(force)
        .panel(jaw)
        .arrangement(Arrangement::Stacked)
        .height_mm(120.0)
}
