//! A simulated series as CSV and figure.

use std::io::{self, Write};

use palpate::simulate::Trajectory;

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::number::exact;
use crate::result::word;
use crate::study::grid::displacement_panel;
use crate::table::CsvLocale;

/// Writes the series as CSV, one row a sample: time, displacements, force, strains, rate, all in SI.
///
/// # Errors
/// Whatever the writer says.
pub fn write_trajectory(out: &mut dyn Write, trajectory: &Trajectory, locale: CsvLocale) -> io::Result<()> {
    let columns: [(&str, &dyn Fn(usize) -> f64); 9] = [
        ("time_s", &|i| trajectory.time[i]),
        ("displacement_m", &|i| trajectory.displacement[i]),
        ("contact_displacement_m", &|i| trajectory.contact_displacement[i]),
        ("force_n", &|i| trajectory.force[i]),
        ("strain", &|i| trajectory.strain[i]),
        ("equilibrium_strain", &|i| trajectory.equilibrium_strain[i]),
        ("excess_strain", &|i| trajectory.excess_strain[i]),
        ("strain_rate_per_s", &|i| trajectory.strain_rate[i]),
        ("in_contact", &|i| f64::from(trajectory.in_contact[i])),
    ];
    write_series(out, trajectory.len(), &columns, locale)
}

/// Writes columns as CSV, row by row, so that ten million samples need no more memory than the series itself.
pub(in crate::study) fn write_series(
    out: &mut dyn Write,
    rows: usize,
    columns: &[(&str, &dyn Fn(usize) -> f64)],
    locale: CsvLocale,
) -> io::Result<()> {
    let between = locale.separator().to_string();
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    write!(out, "{}\r\n", names.join(&between))?;
    for row in 0..rows {
        for (i, (_, value)) in columns.iter().enumerate() {
            let separator = if i > 0 { between.as_str() } else { "" };
            // + 0.0 turns −0 into 0; what is not known is empty.
            let text = Some(value(row) + 0.0).filter(|value| !value.is_nan()).map(|value| locale.number(exact(value)));
            write!(out, "{separator}{}", text.unwrap_or_default())?;
        }
        write!(out, "\r\n")?;
    }
    Ok(())
}

/// The axis of the force, with room for the names of events above the curve.
fn force_axis(trajectory: &Trajectory) -> Axis {
    let axis = Axis::linear("Force", "N");
    if trajectory.events.is_empty() {
        return axis;
    }
    let (low, high) = trajectory
        .force
        .iter()
        .fold((0.0, 0.0), |(low, high): (f64, f64), force| (low.min(*force), high.max(*force)));
    axis.range(low - 0.05 * (high - low), high + 0.18 * (high - low))
}

/// Force, strains and displacement over time, with lost and regained contacts marked.
#[must_use]
pub fn trajectory_figure(trajectory: &Trajectory, name: &str, caption: &str) -> Figure {
    let time = || trajectory.time.clone();
    let mut force = Panel::new(Axis::linear("Time", "s"), force_axis(trajectory)).share(1.6);
    force = force.layer(Layer::line(time(), trajectory.force.clone(), Role::Series(0)));
    for event in trajectory.events.iter().take(8) {
        let label = format!("contact {}", word(event.kind));
        force = force.layer(Layer::vertical(event.time, Role::Reference).label(label));
    }
    let strain = Panel::over_time("Strain", "")
        .layer(Layer::line(time(), trajectory.strain.clone(), Role::Series(0)).label("contact layer"))
        .layer(Layer::line(time(), trajectory.equilibrium_strain.clone(), Role::Series(1)).label("equilibrium"));
    Figure::new(name, caption)
        .panel(force)
        .panel(strain)
        .panel(displacement_panel(&trajectory.time, &trajectory.displacement, Role::Series(0)))
        .height_mm(150.0)
}
