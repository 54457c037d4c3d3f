//! A whole record calibrated: tables, text and figure.

use palpate::analysis::HoldoutError;
use palpate::calibrate::{CalibrateError, Calibration, Candidate, Material, ParameterProfile};
use palpate::units::suited;

use crate::document::Software;
use crate::figure::{Figure, Layer, Panel, Role};
use crate::number::{counted, significant, with_interval};
use crate::page::{Block, Page, Section};
use crate::result::{
    CalibratedRecord, ParameterDocument, budgets_of_material, parameter_title, parameters_of_material, percent, word,
};
use crate::study::budget;
use crate::study::bundle::StudyError;
use crate::study::findings::{Gathered, gathered_at, plain};
use crate::study::grid::displacement_panel;
use crate::table::{Cell, Table};
use crate::wrap::wrapped;

/// The laws on the record, in the order in which they were requested.
fn laws(record: &CalibratedRecord) -> Table {
    let (fitted, all) = (record.data.fitted(), record.data.times().len());
    let until = record.data.times()[fitted - 1] - record.data.times()[0];
    let rest = if fitted < all { format!("; {} held out", counted(all - fitted, "sample")) } else { String::new() };
    let caption = format!("Calibrated on {} over {} s{rest}.", counted(fitted, "sample"), significant(until, 4));
    let mut table = Table::of("laws", caption, &record.rows)
        .column("Law", "law", "", |(candidate, _)| Cell::text(candidate.to_string()))
        .column("p", "parameters", "", of_made(|made| Cell::Integer(made.free_parameters as i64)))
        .column("RMSE", "rmse_n", "N", of_made(|made| Cell::Number(made.rmse, 3)))
        .column("of peak", "rmse_percent", "%", of_made(|made| Cell::Number(100.0 * made.relative, 3)))
        .column(
            "ΔBIC",
            "delta_bic",
            "",
            of_made(|made| Cell::number_or(record.delta_bic(made), 3, "the search did not end at an optimum")),
        );
    if fitted < all {
        let holdout = |figure: fn(&HoldoutError) -> f64| {
            of_made(move |made| made.holdout.as_ref().map_or(Cell::text(""), |found| Cell::Number(figure(found), 3)))
        };
        let relative = holdout(|found| 100.0 * found.relative);
        table = table.column("Held-out error", "holdout_rmse_n", "N", holdout(|found| found.rmse));
        table = table.column("of peak", "holdout_percent", "%", relative);
    }
    let ended = |made: &Calibration| Cell::text(word(made.termination).replace('_', " "));
    table.column("Ended", "termination", "", of_made(ended)).table()
}

/// A cell of a calibration, or why there is none.
fn of_made(cell: impl Fn(&Calibration) -> Cell) -> impl Fn(&(Candidate, Result<Calibration, CalibrateError>)) -> Cell {
    move |(_, made)| made.as_ref().map_or_else(|error| Cell::missing(error.to_string()), &cell)
}

/// The parameters of a material with their intervals.
#[must_use]
pub fn material_table(material: &Material) -> Table {
    law_table(material, &[])
}

/// The same with profile intervals, where there are any.
fn law_table(material: &Material, profiles: &[ParameterProfile]) -> Table {
    const LEFT_OPEN: &str = "not determined by the record";
    let share = material.uncertainty().map_or(0.95, |uncertainty| uncertainty.confidence);
    let parameters = parameters_of_material(material, true);
    let estimate = |parameter: &ParameterDocument| match (parameter.role.as_str(), parameter.interval) {
        ("estimated", None) => Cell::missing(LEFT_OPEN),
        _ => Cell::text(parameter.shown().0),
    };
    let caption = format!("Parameters of the law {} with {} intervals.", material.candidate(), percent(share));
    let mut table = Table::of("law", caption, &parameters)
        .column("Parameter", "parameter", "", |(name, _)| Cell::text(parameter_title(name)))
        .column("Value", "value", "", |(_, parameter)| estimate(parameter))
        .column("Unit", "unit", "", |(_, parameter)| Cell::text(parameter.shown().1));
    if !profiles.is_empty() {
        let profile = |name: &str, parameter: &ParameterDocument| {
            let found = profiles.iter().find(|profile| profile.name == name);
            let (_, factor) = suited(&parameter.unit, parameter.value?);
            let (low, high) = found.map(|found| (found.interval.low, found.interval.high))?;
            let ends = (low.map_or(0.0, |low| low * factor), high.map_or(f64::INFINITY, |high| high * factor));
            Some(with_interval(parameter.value? * factor, ends))
        };
        table = table.column("Profile interval", "profile", "", |(name, parameter)| {
            profile(name, parameter).map_or(Cell::missing(LEFT_OPEN), Cell::text)
        });
    }
    table.table()
}

/// The uncertainty budget, where the instrument was described.
fn budgets(material: &Material) -> Vec<Table> {
    let share = material.uncertainty().map_or(0.95, |uncertainty| uncertainty.confidence);
    budget::tables(&budgets_of_material(material), share)
}

/// A calibration as text for a terminal: the law with its parameters, then its alternatives.
#[must_use]
pub fn calibration_text(record: &CalibratedRecord) -> String {
    let mut text = format!("{}\n\n", record.input.called());
    text.extend(record.answer().iter().map(|line| wrapped(line)));
    if let Some(chosen) = record.chosen() {
        text.push_str(&format!("\n{}", law_table(&chosen.material, &record.profiles).to_plain_text()));
        for table in budgets(&chosen.material) {
            text.push_str(&format!("\n{}", table.to_plain_text()));
        }
    }
    text.push_str(&format!("\n{}\n", laws(record).to_plain_text()));
    text.push_str(&plain(&gathered_at("", record.data.findings())));
    record.remarks().iter().for_each(|remark| text.push_str(&wrapped(remark)));
    text
}

/// The same with the figure as a page.
///
/// # Errors
/// [`StudyError`] when the figure cannot be drawn.
pub fn calibration_page(record: &CalibratedRecord) -> Result<Page, StudyError> {
    let mut section = Section::new(&record.input.title).block(Block::List(record.answer()));
    if let Some(chosen) = record.chosen() {
        section = section.block(Block::Table(law_table(&chosen.material, &record.profiles)));
        section = section.blocks(budgets(&chosen.material).into_iter().map(Block::Table));
    }
    let findings = gathered_at("", record.data.findings());
    section = section
        .block(Block::Table(laws(record)))
        .block(Block::Findings(findings.iter().map(Gathered::reported).collect()))
        .block(Block::List(record.remarks()))
        .block(Block::figure(&calibration_figure(record, "calibration"))?);
    let page = Page::new("Calibration", "One set of parameters for a whole record, ramps and holds");
    Ok(page
        .section(section)
        .provenance("Record", record.input.called())
        .provenance("SHA-256", &record.input.sha256)
        .provenance("Software", Software::this().to_string()))
}

/// Measured and simulated force over time, and the residual.
#[must_use]
pub fn calibration_figure(record: &CalibratedRecord, name: &str) -> Figure {
    let (times, forces) = (record.data.times(), record.data.forces());
    let motion = record.data.motion();
    let mut force = Panel::over_time("Force", "N").share(1.6);
    force = force.layer(Layer::line(times.to_vec(), forces.to_vec(), Role::Measured).label("measured"));
    let mut left = Panel::over_time("Measured − simulated", "N");
    for (index, made) in record.made().take(MOST).enumerate() {
        let role = if index == 0 { Role::Fitted } else { Role::Alternative(index as u8 - 1) };
        let law = made.material.candidate().to_string();
        force = force.layer(Layer::line(times.to_vec(), made.simulated.clone(), role).label(law));
        let residuals = forces.iter().zip(&made.simulated).map(|(measured, simulated)| measured - simulated).collect();
        left = left.layer(Layer::line(times.to_vec(), residuals, role));
    }
    if record.data.fitted() < times.len() {
        let at = times[record.data.fitted() - 1];
        force = force.layer(Layer::vertical(at, Role::Reference).label("fitted | held out"));
        left = left.layer(Layer::vertical(at, Role::Reference));
    }
    let travel: Vec<f64> = times.iter().map(|time| motion.displacement_at(*time)).collect();
    Figure::new(name, "The whole record with its calibrated laws, and the residuals of each law.")
        .panel(force)
        .panel(left.zero_line())
        .panel(displacement_panel(times, &travel, Role::Measured))
        .height_mm(150.0)
}

/// Laws that a figure shows.
const MOST: usize = 4;
