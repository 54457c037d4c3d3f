//! Force against displacement: the loop whose area is what a cycle costs.

use palpate::simulate::{Cycle, StepWork, Trajectory};

use crate::figure::{Axis, Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::table::{Cell, Table};

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
    let whole = cycles.is_empty().then(|| curve(f64::NEG_INFINITY, f64::INFINITY, 0));
    let loops = cycles.iter().zip(0u8..).take(CURVES).map(|(cycle, i)| {
        let label = format!("cycle {}: {}", i + 1, cost(cycle));
        curve(cycle.from, cycle.until, i).label(label)
    });
    let panel = Panel::new(Axis::linear("Displacement", "mm"), Axis::linear("Force", "N"));
    Figure::new(name, caption).panel(panel.layers(whole).layers(loops))
}

/// What a cycle cost, in words.
fn cost(cycle: &Cycle) -> String {
    let size = cycle.done.abs().max(cycle.lost.unwrap_or_default().abs());
    let (factor, unit) = match size {
        _ if size >= 1.0 => (1.0, "J"),
        _ if size >= 1e-3 => (1e3, "mJ"),
        _ if size >= 1e-6 => (1e6, "µJ"),
        _ => (1e9, "nJ"),
    };
    let energy = |joule: f64| format!("{} {unit}", significant(factor * joule, 3));
    match cycle.lost {
        Some(lost) if cycle.is_closed => format!("{} of {} lost", energy(lost), energy(cycle.done)),
        _ => format!("{} done, not closed", energy(cycle.done)),
    }
}

/// Work between the knots of a drive, one row a step.
#[must_use]
pub fn step_work_table(steps: &[StepWork]) -> Table {
    let numbered: Vec<(i64, &StepWork)> = (1..).zip(steps).collect();
    let number = |value: f64| Cell::Number(value, 9);
    let table = Table::of("steps", "Work of the jaw in each step.", &numbered)
        .column("Step", "step", "", |(step, _)| Cell::Integer(*step))
        .column("From", "from_s", "s", |(_, step)| number(step.from))
        .column("Until", "until_s", "s", |(_, step)| number(step.until))
        .column("Displacement from", "displacement_from_m", "m", |(_, step)| number(step.displacement_from))
        .column("Displacement until", "displacement_until_m", "m", |(_, step)| number(step.displacement_until))
        .column("Work", "work_j", "J", |(_, step)| number(step.work))
        .column("Given back", "given_back_j", "J", |(_, step)| number(step.given_back));
    if steps.iter().all(|step| step.lost.is_none()) {
        return table.table();
    }
    table.column("Lost", "lost_j", "J", |(_, step)| step.lost.map_or(Cell::text(""), number)).table()
}

/// What every cycle cost, one row a cycle.
#[must_use]
pub fn cycle_table(cycles: &[Cycle]) -> Table {
    let numbered: Vec<(i64, &Cycle)> = (1..).zip(cycles).collect();
    let number = |value: f64| Cell::Number(value, 6);
    let if_known = |value: Option<f64>| value.map_or(Cell::missing("open loop"), number);
    Table::of("cycles", "Energy loss of each cycle of squeeze and release.", &numbered)
        .column("Cycle", "cycle", "", |(cycle, _)| Cell::Integer(*cycle))
        .column("From", "from_s", "s", |(_, cycle)| number(cycle.from))
        .column("Until", "until_s", "s", |(_, cycle)| number(cycle.until))
        .column("Done", "done_j", "J", |(_, cycle)| number(cycle.done))
        .column("Given back", "given_back_j", "J", |(_, cycle)| number(cycle.given_back))
        .column("Lost", "lost_j", "J", |(_, cycle)| if_known(cycle.lost))
        .column("Share lost", "share_lost", "", |(_, cycle)| if_known(cycle.share_lost))
        .column("Closed", "closed", "", |(_, cycle)| Cell::text(if cycle.is_closed { "yes" } else { "no" }))
        .table()
}
