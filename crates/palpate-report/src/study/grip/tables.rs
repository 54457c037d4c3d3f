//! A planned grip: tables and text.

use palpate::grip::{Move, PositionHold, TimeToSlip};

use crate::number::significant;
use crate::result::{GrippedBody, lasted, parameter_title, percent};
use crate::table::{Cell, Table};
use crate::wrap::wrapped;

const NO_INTERVAL: &str = "no estimate from the calibration";

/// The grips beside one another.
#[must_use]
pub fn grip_table(body: &GrippedBody<'_>) -> Table {
    let answer = &body.answer;
    let share = percent(body.grip.confidence());
    let caption = format!("Grips by the calibrated law; the end is {} after closing.", lasted(answer.shown));
    let mut table = Table::new("grips", caption)
        .column("Grip", "grip", "")
        .column("Closed", "closing_s", "s")
        .column("Squeeze", "displacement_mm", "mm")
        .column("at end", "end_displacement_mm", "mm")
        .column("Force", "start_force_n", "N")
        .column("peak", "peak_force_n", "N")
        .column("at end", "end_force_n", "N")
        .column("needed", "needed_force_n", "N")
        .column("Time to slip", "time_to_slip_s", "s")
        .column(format!("{share} from"), "time_to_slip_low_s", "s")
        .column("to", "time_to_slip_high_s", "s")
        .column("Work", "work_mj", "mJ");
    let end = |course: &palpate::calibrate::Prediction| course.trajectory.force.last().copied().unwrap_or(0.0);
    let holding = |name: &str, found: &PositionHold, end: f64| {
        let interval = |pick: fn((TimeToSlip, TimeToSlip)) -> TimeToSlip| {
            found.interval.map_or_else(|| Cell::missing(NO_INTERVAL), |interval| time_to_slip(pick(interval)))
        };
        vec![
            Cell::text(name),
            Cell::Number(found.closing, 3),
            Cell::Number(1e3 * found.displacement, 4),
            Cell::Number(1e3 * found.displacement, 4),
            Cell::Number(found.start_force, 4),
            Cell::Number(found.peak_force, 4),
            Cell::Number(end, 4),
            Cell::Number(found.needed_force, 4),
            if found.may_slip_at_once() { Cell::text("uncertain") } else { time_to_slip(found.time_to_slip) },
            interval(|(low, _)| low),
            interval(|(_, high)| high),
            Cell::Number(1e3 * found.work, 3),
        ]
    };
    if let Ok(squeeze) = &answer.squeeze {
        table = table.row(holding("squeeze", &squeeze.found, end(&squeeze.course)));
    }
    if let Ok(back_off) = &answer.back_off {
        table = table.row(holding("overshoot and back off", &back_off.found.backed, end(&back_off.course)));
    }
    if let Ok(pressed) = &answer.force_hold {
        let found = &pressed.found;
        let until = if found.holds {
            found.stroke_ends.map_or(TimeToSlip::Never, TimeToSlip::After)
        } else {
            TimeToSlip::After(0.0)
        };
        table = table.row(vec![
            Cell::text("force held"),
            Cell::Number(found.closing, 3),
            Cell::Number(1e3 * found.displacement_start, 4),
            Cell::Number(1e3 * found.displacement_end, 4),
            Cell::Number(found.force, 4),
            Cell::Number(found.force, 4),
            match found.stroke_ends {
                None => Cell::Number(found.force, 4),
                Some(_) => Cell::missing("the stroke ends before"),
            },
            Cell::Number(found.needed_force, 4),
            time_to_slip(until),
            Cell::missing("a held force does not fall"),
            Cell::missing("a held force does not fall"),
            Cell::Number(1e3 * found.work, 3),
        ]);
    }
    table
}

/// How long squeezes a little less and more deep hold.
#[must_use]
pub fn neighbour_table(body: &GrippedBody<'_>) -> Option<Table> {
    let answer = &body.answer;
    let squeeze = answer.squeeze.as_ref().ok().filter(|_| answer.neighbours.len() > 1)?;
    let speed = significant(1e3 * squeeze.found.plan.speed(), 3);
    let table = Table::of("neighbours", format!("Alternative squeezes, at {speed} mm/s."), &answer.neighbours)
        .column("Squeeze", "displacement_mm", "mm", |(place, _)| Cell::Number(1e3 * place, 4))
        .column("beside it", "change_percent", "%", |(place, _)| {
            Cell::Number((100.0 * (place / squeeze.found.displacement - 1.0)).round(), 2)
        })
        // No interval stands beside it, so that no more digits are meaningful.
        .column("Time to slip", "time_to_slip_s", "s", |(_, time)| time_to_slip_rounded(*time, 2));
    Some(table.table())
}

/// How long something holds.
fn time_to_slip(time: TimeToSlip) -> Cell {
    time_to_slip_rounded(time, 4)
}

/// Likewise, with so many significant digits.
fn time_to_slip_rounded(time: TimeToSlip, digits: usize) -> Cell {
    time.seconds().map_or_else(|| Cell::text("never"), |seconds| Cell::Number(seconds, digits))
}

/// What the parameters of the material do to overshoot and back off.
#[must_use]
pub fn sensitivity_table(body: &GrippedBody<'_>) -> Option<Table> {
    let found = &body.answer.back_off.as_ref().ok()?.found.sensitivities;
    let caption =
        "Overshoot and back off: sensitivity to a parameter of the material that is 1 % larger than its estimate.";
    Table::of("sensitivities", caption, found)
        .column("Parameter", "parameter", "", |one| Cell::text(parameter_title(&one.name)))
        .column("known to", "standard_error_percent", "%", |one| {
            Cell::number_or(one.error.map(|error| 100.0 * error), 2, "no standard error")
        })
        // Rounding alone is nothing.
        .column("Force missed", "missed_mn", "mN", |one| {
            Cell::Number(if one.missed.abs() < 1e-9 { 0.0 } else { 1e3 * one.missed }, 3)
        })
        .column("Additional overshoot", "over_um", "µm", |one| Cell::Number(1e6 * one.over, 3))
        .unless_empty()
}

/// The squeezes of a schedule.
#[must_use]
pub fn schedule_table(body: &GrippedBody<'_>) -> Option<Table> {
    let found = &body.answer.schedule.as_ref()?.as_ref().ok()?.found;
    let moves: Vec<(i64, &Move)> = (1..).zip(&found.moves).collect();
    let table = Table::of("schedule", "Schedule of regrips; times since first touch.", &moves)
        .column("Move", "move", "", |(number, _)| Cell::Integer(*number))
        .column("at", "time_s", "s", |(_, step)| Cell::Number(step.time, 5))
        .column("Jaw from", "from_mm", "mm", |(_, step)| Cell::Number(1e3 * step.from, 5))
        .column("to", "to_mm", "mm", |(_, step)| Cell::Number(1e3 * step.to, 5))
        .column("Force from", "force_from_n", "N", |(_, step)| Cell::Number(step.force_from, 4))
        .column("to", "force_to_n", "N", |(_, step)| Cell::Number(step.force_to, 4));
    Some(table.table())
}

/// A planned grip as text for a terminal.
#[must_use]
pub fn grip_text(body: &GrippedBody<'_>) -> String {
    let mut text = format!("{}\n", body.path);
    text.push_str(&wrapped(&body.question()));
    text.push('\n');
    if let Some(misfit) = body.misfit_sentence() {
        text.push_str(&format!("{}\n", wrapped(&misfit)));
    }
    text.push_str(&wrapped(&body.verdict()));
    let grips = grip_table(body);
    let tables = [
        (!grips.rows.is_empty()).then_some(grips),
        neighbour_table(body),
        sensitivity_table(body),
        schedule_table(body),
    ];
    for table in tables.into_iter().flatten() {
        text.push_str(&format!("\n{}", table.to_plain_text()));
    }
    text.push('\n');
    body.notes().iter().for_each(|remark| text.push_str(&wrapped(remark)));
    text
}
