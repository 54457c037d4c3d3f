//! Force against displacement: the loop whose area is what a cycle costs.

use palpate::simulate::{Cycle, StepWork, Trajectory};

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::table::{Cell, Table, TableColumn};

/// Cycles that get a curve of their own.
const CURVES: usize = 6;

/// The force against the displacement of the jaw, a curve for each of the first cycles with what it lost.
///
/// `cycles` as of the same drive; without any the whole course is one curve.
#[must_use]
pub fn hysteresis_figure(trajectory: &Trajectory, cycles: &[Cycle], name: &str, caption: &str) -> Figure {
    let curve = |from: f64, until: f64, role: u8| {
        let start = trajectory.time.partition_point(|time| *time < from);
        let end = trajectory.time.partition_point(|time| *time <= until);
        let travel = trajectory.displacement[start..end].iter().map(|d| 1e3 * d).collect();
        Layer::line(travel, trajectory.force[start..end].to_vec(), Role::Series(role))
    };
    let mut panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("Force", "N"));
    match cycles {
        [] => panel = panel.layer(curve(f64::NEG_INFINITY, f64::INFINITY, 0)),
        _ => {
            for (i, cycle) in cycles.iter().enumerate().take(CURVES) {
                let label = format!("cycle {}: {}", i + 1, cost(cycle));
                panel = panel.layer(curve(cycle.from, cycle.until, i as u8).label(label));
            }
        }
    }
    Figure::new(name, caption).panel(panel)
}

/// What a cycle cost, in words.
fn cost(cycle: &Cycle) -> String {
    let size = cycle.done.abs().max(cycle.lost.abs());
    let (factor, unit) = match size {
        _ if size >= 1.0 => (1.0, "J"),
        _ if size >= 1e-3 => (1e3, "mJ"),
        _ if size >= 1e-6 => (1e6, "µJ"),
        _ => (1e9, "nJ"),
    };
    let energy = |joule: f64| format!("{} {unit}", significant(factor * joule, 3));
    if cycle.is_closed {
        format!("{} of {} lost", energy(cycle.lost), energy(cycle.done))
    } else {
        format!("{} done, not closed", energy(cycle.done))
    }
}

/// Work between the knots of a drive, one row a step.
#[must_use]
pub fn step_work_table(steps: &[StepWork]) -> Table {
    let mut table = Table::new("steps", "Work of the jaw in every step.")
        .column(TableColumn::new("Step", "step", ""))
        .column(TableColumn::new("From", "from_s", "s"))
        .column(TableColumn::new("Until", "until_s", "s"))
        .column(TableColumn::new("Displacement from", "displacement_from_m", "m"))
        .column(TableColumn::new("Displacement until", "displacement_until_m", "m"))
        .column(TableColumn::new("Work", "work_j", "J"))
        .column(TableColumn::new("Given back", "given_back_j", "J"));
    let splits = steps.iter().any(|step| step.lost.is_some());
    if splits {
        table = table.column(TableColumn::new("Lost", "lost_j", "J"));
    }
    let row = |(i, step): (usize, &StepWork)| {
        let numbers =
            [step.from, step.until, step.displacement_from, step.displacement_until, step.work, step.given_back];
        let lost = step.lost.filter(|_| splits);
        std::iter::once(Cell::Integer(i as i64 + 1))
            .chain(numbers.into_iter().chain(lost).map(|number| Cell::number(number, 9)))
            .collect()
    };
    table.rows = steps.iter().enumerate().map(row).collect();
    table
}

/// What every cycle cost, one row a cycle.
#[must_use]
pub fn cycle_table(cycles: &[Cycle]) -> Table {
    let mut table = Table::new("cycles", "What every cycle of squeeze and release cost.")
        .column(TableColumn::new("Cycle", "cycle", ""))
        .column(TableColumn::new("From", "from_s", "s"))
        .column(TableColumn::new("Until", "until_s", "s"))
        .column(TableColumn::new("Done", "done_j", "J"))
        .column(TableColumn::new("Given back", "given_back_j", "J"))
        .column(TableColumn::new("Lost", "lost_j", "J"))
        .column(TableColumn::new("Share lost", "share_lost", ""))
        .column(TableColumn::new("Closed", "closed", ""));
    let row = |(i, cycle): (usize, &Cycle)| {
        let numbers = [cycle.from, cycle.until, cycle.done, cycle.given_back, cycle.lost, cycle.share_lost];
        std::iter::once(Cell::Integer(i as i64 + 1))
            .chain(numbers.map(|number| Cell::number(number, 6)))
            .chain([Cell::text(if cycle.is_closed { "yes" } else { "no" })])
            .collect()
    };
    table.rows = cycles.iter().enumerate().map(row).collect();
    table
}
