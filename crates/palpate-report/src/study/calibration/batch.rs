//! Several records calibrated together: tables, text, figure and page.

use palpate::calibrate::{BatchParameter, Between, CalibratedSpecimen, CalibrationData};

use crate::document::{Software, of_between};
use crate::figure::{Figure, Layer, Panel, Role};
use crate::number::significant;
use crate::page::{Block, Page, Section};
use crate::result::{CalibratedBatch, ParameterDocument, parameter_title, percent, si_unit};
use crate::study::bundle::StudyError;
use crate::study::findings::{Gathered, gathered_at, plain};
use crate::study::grid::{by_hold, columns, grid};
use crate::table::{Cell, Table};
use crate::wrap::wrapped;

/// The parameters of the batch, a row each.
fn batch_table(batch: &CalibratedBatch) -> Table {
    let shown = |parameter: &BatchParameter| {
        let (_, estimate, role) = of_between(&parameter.between);
        ParameterDocument::new(Some(&estimate), si_unit(parameter.unit).to_owned(), role).shown()
    };
    let share = percent(batch.found.confidence);
    let caption = format!("Parameters of the batch with {share} intervals; own parameters by their geometric mean.");
    let figure = |share: f64| significant(100.0 * share, 2);
    let between = |parameter: &BatchParameter| match &parameter.between {
        Between::Own { spread, .. } if spread.is_distinguishable() => {
            let (low, high) = spread.interval;
            Cell::text(format!("{} % ({} to {} %)", figure(spread.deviation), figure(low), figure(high)))
        }
        Between::Own { spread, .. } if spread.interval.1 > 0.0 => {
            Cell::text(format!("< {} %, not distinguishable from 0", figure(spread.interval.1)))
        }
        Between::Own { .. } => Cell::text("not distinguishable from 0"),
        Between::Shared { .. } | Between::Given { .. } => Cell::text(""),
    };
    let one_value = |parameter: &BatchParameter| match parameter.between {
        Between::Shared { one_value_p, .. } => Cell::number_or(one_value_p, 2, "not determined by single records"),
        _ => Cell::text(""),
    };
    Table::of("batch", caption, &batch.found.parameters)
        .column("Parameter", "parameter", "", |parameter| Cell::text(parameter_title(&parameter.name)))
        .column("", "between", "", |parameter| Cell::text(of_between(&parameter.between).0))
        .column("Value", "value", "", |parameter| Cell::text(shown(parameter).0))
        .column("Unit", "unit", "", |parameter| Cell::text(shown(parameter).1))
        .column("Spread between specimens", "spread", "", between)
        .column("p of one value", "one_value_p", "", one_value)
        .table()
}

/// The records with their own parameters.
fn records_table(batch: &CalibratedBatch) -> Table {
    let mut table = Table::of("records", "Own parameters and residual of each record.", &batch.found.specimens).column(
        "Record",
        "record",
        "",
        |specimen| Cell::text(&specimen.name),
    );
    for parameter in batch.found.parameters.iter().filter(|p| matches!(p.between, Between::Own { .. })) {
        let estimate = |specimen: &CalibratedSpecimen| {
            let estimate = specimen.material.estimate(&parameter.name);
            estimate.map_or(Cell::missing(""), |estimate| Cell::Estimate(*estimate))
        };
        let unit = Some(si_unit(parameter.unit)).filter(|unit| *unit != "1").unwrap_or_default();
        table = table.estimates(parameter_title(&parameter.name), &parameter.name, unit, estimate);
    }
    table
        .column("RMSE", "rmse_n", "N", |specimen| Cell::Number(specimen.rmse, 3))
        .column("alone", "rmse_alone_n", "N", |specimen| Cell::Number(specimen.rmse_alone, 3))
        .column("of peak", "rmse_percent", "%", |specimen| Cell::Number(100.0 * specimen.relative, 3))
        .table()
}

/// A calibration of several records as text for a terminal.
#[must_use]
pub fn batch_text(batch: &CalibratedBatch) -> String {
    let mut text: String = batch.answer().iter().map(|line| wrapped(line)).collect();
    text.push_str(&format!("\n{}\n{}\n", batch_table(batch).to_plain_text(), records_table(batch).to_plain_text()));
    text.push_str(&plain(&findings(batch)));
    batch.notes().iter().for_each(|remark| text.push_str(&wrapped(remark)));
    text
}

/// The findings of each record, named by it.
fn findings(batch: &CalibratedBatch) -> Vec<Gathered> {
    let records = batch.found.specimens.iter();
    records.flat_map(|specimen| gathered_at(&specimen.name, &specimen.findings)).collect()
}

/// The same with the figure as a page.
///
/// # Errors
/// [`StudyError`] when the figure cannot be drawn.
pub fn batch_page(batch: &CalibratedBatch) -> Result<Page, StudyError> {
    let mut section = Section::new("Batch")
        .block(Block::List(batch.answer()))
        .block(Block::Table(batch_table(batch)))
        .block(Block::Table(records_table(batch)))
        .block(Block::Findings(findings(batch).iter().map(Gathered::reported).collect()))
        .block(Block::List(batch.notes()));
    let records = panels(batch);
    for figure in by_hold("calibration", CAPTION, (80.0, 54.0), (&records, "records"), Panel::clone) {
        section = section.block(Block::figure(&figure)?);
    }
    let mut page = Page::new("Calibration", "One calibration of several records, ramps and holds").section(section);
    for input in &batch.inputs {
        page = page.provenance("Record", input.called()).provenance("SHA-256", &input.sha256);
    }
    Ok(page.provenance("Software", Software::this().to_string()))
}

const CAPTION: &str = "The records with the law that was calibrated on all of them.";

/// Measured and simulated force over time, a panel for each record.
#[must_use]
pub fn batch_figure(batch: &CalibratedBatch, name: &str) -> Option<Figure> {
    let panels = panels(batch);
    let columns = columns(panels.len());
    grid(name, CAPTION.to_owned(), panels, columns, if columns == 1 { 80.0 } else { 62.0 })
}

fn panels(batch: &CalibratedBatch) -> Vec<Panel> {
    let panel = |(specimen, data): (&CalibratedSpecimen, &CalibrationData)| {
        let times = || data.times().to_vec();
        Panel::over_time("Force", "N")
            .title(&specimen.name)
            .layer(Layer::line(times(), data.forces().to_vec(), Role::Measured).label("measured"))
            .layer(Layer::line(times(), specimen.simulated.clone(), Role::Fitted).label("calibrated"))
    };
    batch.found.specimens.iter().zip(&batch.data).map(panel).collect()
}
