//! Tables I and II, and the orders of every hold.

use palpate::analysis::{Analysis, HoldAnalysis, Signal};
use palpate::paper::Published;

use super::hold_figures::{ORDER, fitted};
use super::numbering::caption;
use crate::table::{Cell, Table};

/// Table I or II: the law with n = 5 of some holds, compression negative as in the paper; beside the printed numbers where there are any.
pub(super) fn law(name: &str, text: &str, holds: &[&HoldAnalysis], printed: Option<&Published>) -> Table {
    let rows: Vec<(usize, &HoldAnalysis, _)> =
        fitted(holds).into_iter().enumerate().map(|(index, (hold, fit))| (index, hold, fit)).collect();
    let is_strain = holds.iter().all(|hold| hold.signal == Signal::Strain);
    let (heading, key, unit) = match is_strain {
        true => ("εₑ", "equilibrium_strain", ""),
        false => ("Equilibrium force", "equilibrium_force_n", "N"),
    };
    let sign = if is_strain { -1.0 } else { 1.0 };
    let v_unit = if is_strain { "s⁻¹" } else { "N⁻⁴ s⁻¹" };
    let v_key = if is_strain { "rate_coefficient_per_s" } else { "rate_coefficient_per_n4_s" };
    // A fit to a simulated record has no error worth a column.
    let errors = printed.is_none();
    let mut table = Table::of(name, caption(name, text), &rows)
        .column("Hold", "hold", "", |(_, hold, _)| Cell::Integer(hold.number as i64))
        .column("Displacement", "displacement_mm", "mm", |(_, hold, _)| {
            Cell::number_or(hold.displacement.map(|d| 1e3 * d), 3, "not recorded")
        })
        .column(heading, key, unit, |(.., fit)| Cell::Number(sign * fit.equilibrium().value, 4));
    if errors {
        table = table.column("Its standard error", format!("{key}_standard_error"), unit, |(.., fit)| {
            Cell::number_or(fit.equilibrium().standard_error, 2, "not determined by the data")
        });
    }
    table = table.column("v", v_key, v_unit, |(.., fit)| Cell::Number(fit.rate_coefficient().value, 3));
    if errors {
        table = table.column("Its standard error", format!("{v_key}_standard_error"), v_unit, |(.., fit)| {
            Cell::number_or(fit.rate_coefficient().standard_error, 2, "not determined by the data")
        });
    }
    table = table
        .column("v by rates", "rate_coefficient_by_rates", v_unit, |(_, hold, _)| {
            Cell::number_or(hold.rate_fit_with(ORDER).map(|fit| fit.rate_coefficient().value), 3, "no fit")
        })
        .column("n if estimated", "exponent_estimated", "", |(_, hold, _)| {
            Cell::number_or(hold.fits.last().map(|fit| fit.exponent().value), 4, "no fit")
        });
    if let Some(paper) = printed {
        table = table
            .column("εₑ in the paper", "equilibrium_strain_of_the_paper", "", |(index, ..)| {
                Cell::number_or(paper.equilibria.get(*index).map(|strain| -strain), 4, "illegible in the source")
            })
            .column("v in the paper", "rate_coefficient_of_the_paper_per_s", "s⁻¹", |(index, ..)| {
                Cell::number_or(paper.coefficients.get(*index).copied().flatten(), 2, "illegible in the source")
            });
    }
    table.table()
}

/// The same of a table of which nothing is legible.
pub(super) fn illegible(name: &str, text: &str, holds: &[&HoldAnalysis]) -> Table {
    let none = Published {
        equilibria: [f64::NAN; 5],
        coefficients: [None; 5],
        ..Published::default()
    };
    let mut table = law(name, text, holds, Some(&none));
    for cell in table.rows.iter_mut().flatten() {
        if matches!(cell, Cell::Number(value, _) if value.is_nan()) {
            *cell = Cell::missing("illegible in the source");
        }
    }
    table
}

/// How well every exponent fits every hold.
pub(super) fn orders(analysis: &Analysis, name: &str) -> Option<Table> {
    let rows: Vec<_> = analysis
        .holds
        .iter()
        .filter_map(|hold| hold.order.as_ref().map(|order| (hold.number, order)))
        .flat_map(|(number, order)| order.candidates.iter().map(move |candidate| (number, candidate)))
        .collect();
    Table::of(
        name,
        caption(
            "table_orders",
            "How well each exponent fits each hold; ΔBIC is the information criterion above the lowest of the hold.",
        ),
        &rows,
    )
    .column("Hold", "hold", "", |(number, _)| Cell::Integer(*number as i64))
    .column("n", "exponent", "", |(_, candidate)| Cell::Number(candidate.exponent, 4))
    .column("Estimated", "estimated", "", |(_, candidate)| Cell::text(if candidate.free { "yes" } else { "no" }))
    .column("Root mean square residual", "rmse", "", |(_, candidate)| Cell::Number(candidate.rmse, 3))
    .column("ΔBIC", "delta_bic", "", |(_, candidate)| Cell::Number(candidate.delta_bic, 3))
    .unless_empty()
}
