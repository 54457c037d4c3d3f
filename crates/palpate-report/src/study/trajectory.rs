//! A simulated series as table and figure.

use palpate::simulate::{ContactEventKind, Trajectory};

use crate::figure::{Arrangement, Axis, Figure, Layer, Panel, Role};
use crate::table::{Cell, Table, TableColumn};

/// The series with one row a sample: time, displacements, force, strains, rate, all in SI.
#[must_use]
pub fn trajectory_table(trajectory: &Trajectory) -> Table {
    let columns: [(&str, &str, &str, &[f64]); 8] = [
        ("Time", "time_s", "s", &trajectory.time),
        ("Displacement", "displacement_m", "m", &trajectory.displacement),
        ("Contact displacement", "contact_displacement_m", "m", &trajectory.contact_displacement),
        ("Force", "force_n", "N", &trajectory.force),
        ("Strain", "strain", "", &trajectory.strain),
        ("Equilibrium strain", "equilibrium_strain", "", &trajectory.equilibrium_strain),
        ("Excess strain", "excess_strain", "", &trajectory.excess_strain),
        ("Strain rate", "strain_rate_per_s", "s⁻¹", &trajectory.strain_rate),
    ];
    let mut table = Table::new("trajectory", "Simulated contact.");
    for (heading, key, unit, _) in columns {
        table = table.column(TableColumn::new(heading, key, unit));
    }
    table.rows = (0..trajectory.len())
        .map(|row| columns.iter().map(|(.., values)| Cell::number(values[row], 6)).collect())
        .collect();
    table
}

/// Force over displacement over time, with lost and regained contacts marked.
#[must_use]
pub fn trajectory_figure(trajectory: &Trajectory, name: &str, caption: &str) -> Figure {
    let time = || trajectory.time.clone();
    let millimetres = trajectory.displacement.iter().map(|d| d * 1e3).collect();
    let mut force = Panel::new(Axis::linear("Time", "s"), Axis::linear("Force", "N")).share(1.6);
    force = force.layer(Layer::line(time(), trajectory.force.clone(), Role::Series(0)));
    for event in trajectory.events.iter().take(8) {
        let label = match event.kind {
            ContactEventKind::Lost => "contact lost",
            ContactEventKind::Regained => "contact regained",
        };
        force = force.layer(Layer::vertical(event.time, Role::Reference).label(label));
    }
    let displacement = Panel::new(Axis::linear("Time", "s"), Axis::linear("Displacement", "mm"));
    let strain = Panel::new(Axis::linear("Time", "s"), Axis::linear("Strain", ""))
        .layer(Layer::line(time(), trajectory.strain.clone(), Role::Series(0)).label("contact layer"))
        .layer(Layer::line(time(), trajectory.equilibrium_strain.clone(), Role::Series(1)).label("equilibrium"));
    Figure::new(name, caption)
        .panel(force)
        .panel(strain)
        .panel(displacement.layer(Layer::line(time(), millimetres, Role::Series(0))))
        .arrangement(Arrangement::Stacked)
        .height_mm(150.0)
}
