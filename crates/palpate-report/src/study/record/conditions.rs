//! The conditions of a test and R(t) at stated times, as reports of stress-relaxation tests give them.

use palpate::analysis::{Analysis, Conditions, HoldReport, StatedRelaxation};
use palpate::fit::Estimate;
use palpate::units::quantity;

use crate::number::significant;
use crate::page::{Block, Section};
use crate::table::{Cell, Table};

/// What is not stated.
const MISSING: &str = "not stated";
/// Why there is no force at a stated time.
const NOT_MEASURED: &str = "beyond the hold, or fewer than five samples about this time";
/// What the section is for.
const ABOUT: &str = "Reports of stress-relaxation tests (ISO 3384, ASTM E328) give these beside body and forces. The description of the test states them in [conditions]. They are listed here without a claim of conformity to either standard.";

/// The conditions, how the displacement was applied and held, and R(t).
pub(super) fn section(analysis: &Analysis) -> Section {
    Section::new("Test conditions")
        .block(Block::paragraph(ABOUT))
        .block(Block::KeyValues(pairs(&analysis.options.conditions)))
        .blocks(tables(analysis).into_iter().map(Block::Table))
}

fn pairs(conditions: &Conditions) -> Vec<(String, String)> {
    let text = |text: &Option<String>| text.clone();
    let pairs = [
        (
            "Temperature",
            conditions.temperature.map(|kelvin| format!("{} °C", significant(kelvin - 273.15, 4))),
        ),
        (
            "Relative humidity",
            conditions.relative_humidity.map(|share| format!("{} %", significant(100.0 * share, 3))),
        ),
        ("Medium", text(&conditions.medium)),
        ("Conditioning", text(&conditions.conditioning)),
        ("Form of the specimen", text(&conditions.specimen_form)),
        ("Lubricant", text(&conditions.lubricant)),
        (
            "Initial force F₀",
            Some(match conditions.initial_force_after {
                after if after > 0.0 => format!("{} after the start of the fit of a hold", quantity(after, "s", 3)),
                _ => "at the start of the fit of a hold".to_owned(),
            }),
        ),
    ];
    pairs
        .into_iter()
        .map(|(name, value)| (name.to_owned(), value.unwrap_or_else(|| MISSING.to_owned())))
        .collect()
}

/// How each displacement was applied and held, and R(t) at the stated times that were measured.
pub(super) fn tables(analysis: &Analysis) -> Vec<Table> {
    let reports: Vec<(usize, HoldReport)> =
        analysis.holds.iter().map(|hold| (hold.number, analysis.hold_report(hold))).collect();
    // Hold, time, and what was measured there.
    let stated: Vec<(usize, f64, Option<StatedRelaxation>)> = reports
        .iter()
        .flat_map(|(hold, report)| {
            let measured = report.relaxation.iter().map(|stated| (*hold, stated.time, Some(*stated)));
            measured.chain(report.not_measured.iter().map(|time| (*hold, *time, None)))
        })
        .collect();
    let measured = |of: fn(&StatedRelaxation) -> Estimate| {
        move |(_, _, stated): &(usize, f64, Option<StatedRelaxation>)| {
            stated.as_ref().map_or_else(|| Cell::missing(NOT_MEASURED), |stated| Cell::Estimate(of(stated)))
        }
    };
    let number = |value: Option<f64>, why: &str| Cell::number_or(value, 3, why);
    const NO_RAMP: &str = "no loading ramp stands right before the hold";
    const NO_DISPLACEMENT: &str = "no displacement was recorded";
    const NO_FORCE: &str = "the hold is not one of the displacement after loading, or its force lies within the noise, or fewer than five readings are near the time of F₀";
    let constraint = Table::of("constraint", "How the displacement of each hold was applied and held.", &reports)
        .column("Hold", "hold", "", |(hold, _)| Cell::Integer(*hold as i64))
        .column("Applied in", "applied_in_s", "s", |(_, report)| number(report.applied_in, NO_RAMP))
        .column("Variation of the displacement", "constraint_variation_m", "m", |(_, report)| {
            number(report.constraint_variation, NO_DISPLACEMENT)
        })
        .column("Relative variation", "relative_constraint_variation", "", |(_, report)| {
            number(report.relative_constraint_variation, NO_DISPLACEMENT)
        })
        .estimates("Initial force F₀", "initial_force_n", "N", |(_, report)| {
            report.initial_force.map_or_else(|| Cell::missing(NO_FORCE), Cell::Estimate)
        })
        .table()
        .note("The variation is the largest less the smallest displacement over the hold, with the noise of its measurement.");
    let relaxation = Table::of("relaxation_at", "Force and relaxation R(t) = (F₀ − F(t))/F₀ at stated times after that of F₀.", &stated)
        .column("Hold", "hold", "", |(hold, ..)| Cell::Integer(*hold as i64))
        .column("Time", "time_s", "s", |(_, time, _)| Cell::Number(*time, 3))
        .estimates("Force", "force_n", "N", measured(|stated| stated.force))
        .estimates("R(t)", "relaxation", "", measured(|stated| stated.relaxation))
        .unless_empty()
        .map(|table| {
            table.note("Times count from that of F₀. The intervals contain the noise of the force, no error that all forces share.")
        });
    std::iter::once(constraint).chain(relaxation).collect()
}
