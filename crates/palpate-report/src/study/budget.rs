//! Uncertainty budgets as tables: the input quantities, and what each contributes to every result.

use palpate::budget::{Contribution, InputQuantity};
use palpate::units::suited;

use crate::number::significant;
use crate::result::{BudgetedResult, parameter_title, percent, word};
use crate::table::{Cell, Table};
use crate::word::capitalised;

/// Both tables; none without results.
pub(super) fn tables(results: &[BudgetedResult], confidence: f64) -> Vec<Table> {
    if results.is_empty() {
        Vec::new()
    } else {
        vec![inputs(results), contributions(results, confidence)]
    }
}

/// Input quantities other than the scatter of the samples, in order, each once.
fn quantities(results: &[BudgetedResult]) -> Vec<&InputQuantity> {
    let mut found: Vec<&InputQuantity> = Vec::new();
    for Contribution { input, .. } in results.iter().flat_map(|result| &result.budget.contributions[1..]) {
        if !found.contains(&input) {
            found.push(input);
        }
    }
    found
}

fn inputs(results: &[BudgetedResult]) -> Table {
    const CAPTION: &str = "Input quantities of the uncertainty budget. Type A: by the statistics of observations; Type B: by other means.";
    let uncertainty = |input: &&InputQuantity| {
        let (unit, factor) = suited(&input.unit, input.standard_uncertainty);
        let unit = if unit == "1" { "" } else { unit };
        Cell::text(format!("{} {unit}", significant(input.standard_uncertainty * factor, 3)).trim_end())
    };
    Table::of("budget_inputs", CAPTION, &quantities(results))
        .column("Input quantity", "input", "", |input| Cell::text(title(&input.name)))
        .column("Type", "type", "", |input| Cell::text(word(input.evaluation).to_uppercase()))
        .column("Distribution", "distribution", "", |input| Cell::text(word(input.distribution)))
        .column("Standard uncertainty", "standard_uncertainty", "", uncertainty)
        .table()
}

fn contributions(results: &[BudgetedResult], confidence: f64) -> Table {
    let caption = format!(
        "Uncertainty budget (JCGM 100): the combined standard uncertainty, the expanded one at {}, and what one standard uncertainty of each input contributes, in per cent of the value.",
        percent(confidence)
    );
    let share = |result: &BudgetedResult, part: f64| Cell::Number(100.0 * part.abs() / result.budget.value.abs(), 2);
    let mut table = Table::of("budget", caption, results);
    if results.iter().any(|result| result.hold.is_some()) {
        table = table.column("Hold", "hold", "", |result| {
            result.hold.map_or(Cell::text("all"), |number| Cell::Integer(number as i64))
        });
    }
    table = table
        .column("Result", "result", "", |result| Cell::text(parameter_title(&result.name)))
        .column("Combined", "combined_percent", "%", |result| share(result, result.budget.combined()))
        .column("Expanded", "expanded_percent", "%", |result| share(result, result.budget.expanded(confidence)))
        .column("Scatter", "scatter_percent", "%", |result| share(result, result.budget.contributions[0].effect));
    for input in quantities(results) {
        let key = format!("{}_percent", input.name.replace([' ', ','], "_"));
        table = table.column(title(&input.name), key, "%", |result| {
            let found = result.budget.contributions.iter().find(|contribution| contribution.input == *input);
            found.map_or(Cell::text(""), |found| share(result, found.effect))
        });
    }
    table.table()
}

/// A name as a heading.
fn title(name: &str) -> String {
    capitalised(&name.replace('_', " "))
}
