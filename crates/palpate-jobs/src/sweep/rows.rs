//! Results of a run, as a row of the table.

use std::path::Path;

use palpate::batch::Run;
use palpate::simulate::{ContactEventKind, ProgramStep, StepEnd, Summary};
use palpate::watch::{Cancelled, Progress, Watch};
use palpate_files::description::{Protocol, Sweep};
use palpate_files::parquet_table::{Field, Kind, Rows, Values};

use crate::error::without;

/// A column with a result.
#[derive(Debug, Clone)]
pub(super) struct ResultColumn {
    /// Its name, which ends in its unit.
    pub(super) name: String,
    /// What a figure calls it.
    pub(super) label: String,
    /// Symbol of its unit.
    pub(super) unit: &'static str,
}

/// What a whole run comes to: name, label and unit, and where it stands.
type OfRun = (&'static str, &'static str, &'static str, fn(&Summary) -> Option<f64>);

const WHOLE_RUN: [OfRun; 12] = [
    ("peak_force_n", "Peak force", "N", |run| Some(run.peak_force)),
    ("peak_time_s", "Time of the peak", "s", |run| Some(run.peak_time)),
    ("end_time_s", "End", "s", |run| Some(run.end_time)),
    ("force_end_n", "Force at the end", "N", |run| Some(run.force)),
    ("displacement_end_m", "Displacement at the end", "m", |run| Some(run.displacement)),
    ("strain_end", "Strain at the end", "", |run| Some(run.strain)),
    ("excess_strain_end", "Excess strain at the end", "", |run| Some(run.excess_strain)),
    ("work_j", "Work of the jaw", "J", |run| Some(run.work)),
    ("given_back_j", "Recovered work", "J", |run| Some(run.given_back)),
    ("stored_j", "Energy stored", "J", |run| run.stored),
    ("lost_j", "Energy lost", "J", |run| run.lost),
    ("contact_lost_s", "Contact lost", "s", contact_lost),
];

fn contact_lost(run: &Summary) -> Option<f64> {
    run.events.iter().find(|event| event.kind == ContactEventKind::Lost).map(|event| event.time)
}

/// Names, labels and units of what a step comes to, in the order of [`of_steps`].
const STEP: [(&str, &str, &str); 3] = [
    ("ramp_force_n", "force after the ramp", "N"),
    ("end_force_n", "force at the end", "N"),
    ("relaxed_share", "share relaxed in the hold", ""),
];

/// Name of the column that says why a run has no results.
const REFUSED: &str = "refused";

/// The result columns of a sweep.
pub(super) fn results(sweep: &Sweep) -> Vec<ResultColumn> {
    let of = |name: String, label: String, unit| ResultColumn { name, label, unit };
    let whole = WHOLE_RUN.iter().map(|(name, label, unit, _)| of((*name).to_owned(), (*label).to_owned(), *unit));
    let steps = (1..=sweep.steps()).flat_map(|step| {
        STEP.iter()
            .map(move |(name, label, unit)| of(format!("step_{step}_{name}"), format!("Step {step}: {label}"), *unit))
    });
    whole.chain(steps).collect()
}

/// All columns of the table: the number of the run, the swept numbers, the results, and why there are none.
#[must_use]
pub fn fields(sweep: &Sweep) -> Vec<Field> {
    let swept = sweep.parameters.iter().map(|number| Field::new(&number.column, Kind::Number));
    let results = results(sweep).into_iter().map(|column| Field::new(column.name, Kind::Number));
    [Field::new("run", Kind::Count)]
        .into_iter()
        .chain(swept)
        .chain(results)
        .chain([Field::new(REFUSED, Kind::Text)])
        .collect()
}

/// Forces of a run at some times, N; none where the run was refused.
type Forces = Option<Vec<f64>>;

/// Simulates the runs of a sweep with these indices, from 0, as rows of that table; the watch hears of each once it is done, and `path` of
/// the protocol stands in messages. Beside the rows stand the forces (N) of every run at `times` (s), if it has any then.
///
/// # Errors
/// [`Cancelled`] where the watch ends it.
pub fn simulated(
    sweep: &Sweep,
    path: &Path,
    runs: std::ops::Range<u64>,
    times: &[f64],
    watch: &mut dyn Watch,
) -> Result<(Rows, Vec<Forces>), Cancelled> {
    let (first, total) = (runs.start, runs.end - runs.start);
    let results = results(sweep).len();
    let mut numbers: Vec<Vec<Option<f64>>> = vec![Vec::new(); sweep.parameters.len() + results];
    let (mut counts, mut reasons, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for run in runs {
        let (values, protocol) = sweep.run(run);
        let outcome = protocol
            .map_err(|error| without(path, &error.to_string()))
            .and_then(|protocol| outcome(&protocol, sweep.steps(), times));
        let (row, force, reason) = match outcome {
            Ok((row, force)) => (row, force, None),
            Err(reason) => (vec![None; results], None, Some(reason)),
        };
        forces.push(force);
        counts.push(i64::try_from(run + 1).unwrap_or(i64::MAX));
        for (column, value) in numbers.iter_mut().zip(values.into_iter().map(Some).chain(row)) {
            // + 0.0 turns −0 into 0.
            column.push(value.map(|value| value + 0.0));
        }
        reasons.push(reason);
        let (done, total) = (run + 1 - first, Some(total));
        let task = "simulating";
        watch.report(Progress { task, done, total })?;
    }
    let numbers = numbers.into_iter().map(Values::Number);
    let columns = [Values::Count(counts)].into_iter().chain(numbers).chain([Values::Text(reasons)]);
    let rows = Rows {
        columns: columns.collect(),
    };
    Ok((rows, forces))
}

/// From the first and the last column: how many rows were refused, and the number and reason of the first that was.
pub(super) fn refusals(runs: &Values, reasons: &Values) -> (u64, Option<(i64, String)>) {
    let (Values::Count(runs), Values::Text(reasons)) = (runs, reasons) else {
        return (0, None);
    };
    let mut refused = runs.iter().zip(reasons).filter_map(|(run, reason)| Some((*run, reason.clone()?)));
    let first = refused.next();
    (first.iter().count() as u64 + refused.count() as u64, first)
}

/// Numbers of a row, and the forces at some times.
type RowAndForces = (Vec<Option<f64>>, Forces);

fn outcome(protocol: &Protocol, steps: usize, times: &[f64]) -> Result<RowAndForces, String> {
    let run = Run {
        drive: protocol.drive(),
        contact: (&protocol.contact).into(),
        sampling: &protocol.sampling,
        times,
    };
    let run = run.summarize().map_err(|error| error.to_string())?;
    let ends = end_forces(protocol, &run.ends);
    let whole = WHOLE_RUN.iter().map(|(.., of)| of(&run.summary));
    Ok((whole.chain(of_steps(protocol, &ends, steps)).collect(), run.forces))
}

/// Force at the end of every step. Those of a motion are the ends of its straight pieces, of which a step that goes nowhere has none.
fn end_forces(protocol: &Protocol, ends: &[StepEnd]) -> Vec<f64> {
    let is_motion = protocol.motion.is_some();
    let mut ends = ends.iter().map(|end| end.force);
    let (mut jaw, mut force) = (0.0, 0.0);
    let end = |step: &ProgramStep| {
        let stands = matches!(step, ProgramStep::Move { to, .. } if is_motion && *to == jaw);
        if let ProgramStep::Move { to, .. } = step {
            jaw = *to;
        }
        if !stands {
            force = ends.next().unwrap_or(force);
        }
        force
    };
    protocol.steps.iter().map(end).collect()
}

/// Three numbers for every `[[step]]` table: force after its ramp, force at its end, and which share its hold relaxed.
fn of_steps(protocol: &Protocol, ends: &[f64], steps: usize) -> Vec<Option<f64>> {
    let mut row = Vec::with_capacity(steps * STEP.len());
    let mut before = 0.0;
    for table in 1..=steps {
        let (mut ramp, mut end, mut relaxed) = (None, None, None);
        let parts = protocol.steps.iter().zip(&protocol.written).zip(ends);
        for ((step, _), &force) in parts.filter(|((_, written), _)| **written == table) {
            match step {
                ProgramStep::HoldPosition { .. } => relaxed = (before > 0.0).then(|| 1.0 - force / before),
                ProgramStep::HoldForce { .. } => {}
                ProgramStep::Move { .. } | ProgramStep::MoveToForce { .. } | ProgramStep::Press { .. } => {
                    ramp = Some(force);
                }
            }
            (before, end) = (force, Some(force));
        }
        row.extend([ramp, end, relaxed]);
    }
    row
}
