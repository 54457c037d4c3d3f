//! Tables of an analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, JointHolds, Signal};
use palpate::fit::{Domain, Estimate, ExponentChoice, LatencyFit, Termination, TrendVerdict};
use palpate::record::Correction;
use palpate::segment::{After, RelaxationType};

use crate::number::significant;
use crate::result::{ComparedRecord, Input, after_word, mode_word, termination_word};
use crate::study::comparison::tables as comparison_tables;
use crate::study::findings;
use crate::table::{Cell, Table, TableColumn};

fn column(heading: &str, key: &str, unit: &str) -> TableColumn {
    TableColumn::new(heading, key, unit)
}

/// An exponent as people write it: 5, not 5.000.
fn order(n: f64) -> Cell {
    if n.fract() == 0.0 && n.abs() < 1e6 { Cell::Integer(n as i64) } else { Cell::number(n, 4) }
}

/// Why a cell has no number though there is a fit.
const AT_EDGE: &str = "ended at the edge of its range";
const UNDETERMINED: &str = "undetermined: its standard error is far larger than itself";

fn estimate(estimate: Estimate) -> Cell {
    estimate_within(estimate, 0.0)
}

/// An estimate, unless its error is far beyond both itself and `size`, the size of what it could be.
fn estimate_within(estimate: Estimate, size: f64) -> Cell {
    match estimate.standard_error {
        Some(error) if error > (2.0 * estimate.value.abs()).max(size) => Cell::missing(UNDETERMINED),
        Some(error) if error > 1e-12 * estimate.value.abs() => Cell::uncertain(estimate.value, error),
        _ => Cell::number(estimate.value, 5),
    }
}

/// The equilibrium: its error may exceed it where it is near zero, but not what was measured.
fn equilibrium(hold: &HoldAnalysis, fit: &LatencyFit) -> Cell {
    let largest = hold.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    match fit.termination {
        Termination::EquilibriumAtBound => Cell::missing(AT_EDGE),
        _ => estimate_within(fit.equilibrium(), largest),
    }
}

/// A rate, absolute or relative.
fn rate(fit: &LatencyFit, of: Estimate) -> Cell {
    match fit.termination {
        Termination::RateAtBound => Cell::missing(AT_EDGE),
        _ => estimate(of),
    }
}

/// The exponent of a free fit.
fn free_exponent(fit: &LatencyFit) -> Cell {
    match fit.termination {
        Termination::ExponentAtBound => Cell::missing(AT_EDGE),
        _ => estimate(fit.exponent()),
    }
}

/// A correction in words, if neither a finding nor first touch tells of it.
fn untold(done: &Correction) -> Option<String> {
    let told = matches!(
        done,
        Correction::Tared(_)
            | Correction::StampsSorted { .. }
            | Correction::StampsMerged { .. }
            | Correction::RowsAveraged { .. }
            | Correction::StressAsForce
            | Correction::DropoutsReplaced { .. }
    );
    (!told).then(|| done.to_string())
}

/// One row a hold: where it lies, what the force does.
pub(super) fn holds(analysis: &Analysis) -> Table {
    let mut table = Table::new("holds", "The holds that were found.")
        .column(column("Hold", "hold", ""))
        .column(column("After", "after", ""))
        .column(column("Held", "mode", ""))
        .column(column("From", "start_s", "s"))
        .column(column("To", "end_s", "s"))
        .column(column("Fit from", "fit_start_s", "s"))
        .column(column("Displacement", "displacement_mm", "mm"))
        .column(column("Force at fit start", "force_start_n", "N"))
        .column(column("Force at end", "force_end_n", "N"))
        .column(column("Relaxation", "relaxation", ""))
        .column(column("Significance", "p_value", ""));
    for hold in &analysis.holds {
        table = table.row(vec![
            Cell::Integer(hold.number as i64),
            Cell::text(hold.after.map_or("", after_word)),
            Cell::text(hold.segment.mode.map_or("", mode_word)),
            Cell::number(hold.start, 6),
            Cell::number(hold.end, 6),
            Cell::number(hold.fit_start, 6),
            Cell::number_or(hold.displacement.map(|d| 1e3 * d), 4, "not recorded"),
            Cell::number(hold.force_start, 4),
            Cell::number(hold.force_end, 4),
            Cell::text(match hold.relaxation.kind {
                RelaxationType::TypeI => "Type I",
                RelaxationType::TypeII => "Type II",
                RelaxationType::None => "none",
            }),
            if hold.relaxation.p_value < 1e-4 {
                Cell::text("< 0.0001")
            } else {
                Cell::number(hold.relaxation.p_value, 2)
            },
        ]);
    }
    table
        .note("Held: what the machine kept, the displacement (the force relaxes), the force (the displacement creeps) or neither.")
        .note("Type I: the force falls; Type II: it rises. The laws are fitted from the time “Fit from” on, which may lie after the start of the hold.")
        .note("Significance: probability that noise alone makes a change of the force of this size.")
}

/// Every fit of every hold, both domains.
pub(super) fn fits(analysis: &Analysis) -> Table {
    let signal = analysis.holds.iter().map(|hold| hold.signal).next();
    let (equilibrium, unit) = match signal {
        Some(Signal::Strain) => ("equilibrium_strain", ""),
        _ => ("equilibrium_force_n", "N"),
    };
    let mut table = Table::new("fits", "Every law fitted to every hold.")
        .column(column("Hold", "hold", ""))
        .column(column("Domain", "domain", ""))
        .column(column("n", "exponent", ""))
        .column(column("Equilibrium", equilibrium, unit))
        .column(column("λ", "relative_rate_per_s", "s⁻¹"))
        .column(column("v", "rate_coefficient_per_s", "s⁻¹"))
        .column(column("RMSE", "rmse", ""))
        .column(column("ΔBIC", "delta_bic", ""))
        .column(column("Beyond window", "prediction_error", ""))
        .column(column("Ended", "termination", ""));
    for note in analysis.holds.iter().filter_map(rate_bias_note) {
        table = table.note(note);
    }
    for hold in &analysis.holds {
        let rates = hold.rate_fits.iter().flatten();
        for (i, fit) in hold.fits.iter().chain(rates).enumerate() {
            table = table.row(fit_row(hold, fit, i));
        }
    }
    table
        .note("± is one standard error for white noise; intervals widened for correlated residuals are in analysis.json.")
        .note("v is in 1/s where the signal is strain. ΔBIC: information criterion less the lowest of the hold. Beyond window: prediction error over the drop of the hold.")
}

/// How far noise takes the rate domain from the truth in one hold.
fn rate_bias_note(hold: &HoldAnalysis) -> Option<String> {
    let bias = hold.rate_bias.filter(|_| hold.rate_fits.iter().any(Option::is_some))?;
    Some(format!(
        "Rate domain, hold {}: on simulated holds with the numbers of the fit in time (n = {:.3}) and this noise it finds v at {:.2} of the truth ({:.2} to {:.2} in {} of them) and the equilibrium off by {:.1} % of the relaxation.",
        hold.number,
        bias.exponent,
        bias.coefficient,
        bias.coefficient_range.0,
        bias.coefficient_range.1,
        bias.repetitions,
        100.0 * bias.equilibrium
    ))
}

fn fit_row(hold: &HoldAnalysis, fit: &LatencyFit, index: usize) -> Vec<Cell> {
    let in_time = fit.domain == Domain::Time;
    let delta = hold.order.as_ref().filter(|_| in_time).map(|order| order.candidates[index].delta_bic);
    let beyond = hold.predictions.get(index).copied().flatten().filter(|_| in_time);
    vec![
        Cell::Integer(hold.number as i64),
        Cell::text(if in_time { "time" } else { "rate" }),
        match fit.choice() {
            ExponentChoice::Fixed(n) => order(n),
            ExponentChoice::Free => free_exponent(fit),
        },
        equilibrium(hold, fit),
        rate(fit, fit.relative_rate()),
        if hold.signal == Signal::Strain {
            rate(fit, fit.rate_coefficient())
        } else {
            Cell::missing("no strain")
        },
        Cell::number(fit.rmse, 3),
        Cell::number_or(delta, 3, "time domain only"),
        Cell::number_or(
            beyond.map(|prediction| prediction.relative),
            3,
            if in_time { "whole hold fitted" } else { "time domain only" },
        ),
        Cell::text(termination_word(fit.termination)),
    ]
}

/// Table I (after loading) or II (after unloading) of the paper for this record.
pub(super) fn paper_table(analysis: &Analysis, after: After) -> Option<Table> {
    let n = analysis.across.common_exponent?;
    let (name, number) = match after {
        After::Loading => ("table_1_loading", "I"),
        After::Unloading => ("table_2_unloading", "II"),
    };
    let caption = format!(
        "Holds after {}: the law with n = {n}, in the layout of the paper's Table {number}. Time domain: the closed form fitted to the strain; rate domain: the paper's fit of strain rate against strain.",
        after_word(after)
    );
    let mut table = Table::new(name, caption)
        .column(column("Hold", "hold", ""))
        .column(column("Displacement", "displacement_mm", "mm"))
        .column(column("εₑ (time)", "equilibrium_strain", ""))
        .column(column("v (time)", "rate_coefficient_per_s", "s⁻¹"))
        .column(column("εₑ (rate)", "equilibrium_strain_rate_domain", ""))
        .column(column("v (rate)", "rate_coefficient_rate_domain_per_s", "s⁻¹"))
        .column(column("n (free)", "exponent_free", ""));
    let mut rows = 0;
    for hold in analysis.holds.iter().filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain) {
        let Some(fit) = hold.fit_with(n) else { continue };
        rows += 1;
        let by_rate = hold.rate_fit_with(n);
        let free = hold.fits.iter().find(|fit| fit.choice() == ExponentChoice::Free);
        table = table.row(vec![
            Cell::Integer(hold.number as i64),
            Cell::number_or(hold.displacement.map(|d| 1e3 * d), 4, "not recorded"),
            equilibrium(hold, fit),
            rate(fit, fit.rate_coefficient()),
            by_rate.map_or(Cell::missing("no fit"), |fit| equilibrium(hold, fit)),
            by_rate.map_or(Cell::missing("no fit"), |fit| rate(fit, fit.rate_coefficient())),
            free.map_or(Cell::missing("not asked"), free_exponent),
        ]);
    }
    (rows > 0).then_some(table)
}

/// Evidence for the exponent over all holds: the paper's "lowest order which fits the best".
pub(super) fn exponents(analysis: &Analysis) -> Table {
    let mut table =
        Table::new("exponents", "Which exponent fits all holds: sum of the information criteria less the lowest sum.")
            .column(column("n", "exponent", ""))
            .column(column("ΔBIC, all holds", "delta_bic", ""))
            .column(column("Holds where it is as good as the best", "holds_as_good", ""))
            .column(column("Verdict", "verdict", ""));
    for (n, delta) in &analysis.across.evidence {
        let orders = analysis.holds.iter().filter_map(|hold| hold.order.as_ref());
        let good = orders
            .flat_map(|order| &order.candidates)
            .filter(|c| !c.free && c.exponent == *n && c.as_good_as_best);
        let verdict = if analysis.across.common_exponent == Some(*n) {
            "lowest order that fits best"
        } else if *delta <= 2.0 {
            "as good"
        } else {
            ""
        };
        table = table.row(vec![
            order(*n),
            Cell::number(*delta, 4),
            Cell::Integer(good.count() as i64),
            Cell::text(verdict),
        ]);
    }
    table
}

/// One law for several holds against one for each.
pub(super) fn joint(analysis: &Analysis) -> Option<Table> {
    let joint = &analysis.across.joint;
    let mut table = Table::new(
        "joint",
        "One law for several holds, each with its own εₑ, against a law for each: p of the F-test, ΔBIC (negative for one law), and the trend of v at one n.",
    )
    .column(column("Holds after", "holds", ""))
    .column(column("Holds", "count", ""))
    .column(column("n", "exponent", ""))
    .column(column("v", "rate_coefficient_per_s", "s⁻¹"))
    .column(column("p", "p_value", ""))
    .column(column("ΔBIC", "delta_bic", ""))
    .column(column("d ln v/dεₑ", "trend", ""))
    .column(column("from", "trend_low", ""))
    .column(column("to", "trend_high", ""))
    .column(column("v is", "verdict", ""));
    for one in joint {
        let shared = |name: &str| one.fit.shared(name).map(|number| number.estimate.value);
        let trend = one.comparison.trend.as_ref();
        table = table.row(vec![
            Cell::text(match one.which {
                JointHolds::Loading => "loading",
                JointHolds::All => "both",
            }),
            Cell::Integer(one.holds.len() as i64),
            match one.choice {
                ExponentChoice::Fixed(n) => order(n),
                ExponentChoice::Free => Cell::number_or(shared("exponent"), 4, "not found"),
            },
            Cell::number_or(shared("rate_coefficient"), 4, "not found"),
            Cell::number_or(one.comparison.p, 2, "too few independent samples"),
            Cell::number(one.comparison.delta_bic, 4),
            Cell::number_or(trend.map(|trend| trend.slope), 3, "one strain"),
            Cell::number_or(trend.map(|trend| trend.interval.0), 3, "one strain"),
            Cell::number_or(trend.map(|trend| trend.interval.1), 3, "one strain"),
            Cell::text(match one.comparison.verdict {
                TrendVerdict::Constant => "constant",
                TrendVerdict::FallsWithStrain => "falls with strain",
                TrendVerdict::RisesWithStrain => "rises with strain",
                TrendVerdict::Undecided => "undecided",
            }),
        ]);
    }
    (!joint.is_empty()).then_some(table)
}

/// How well each law, fitted to the first part of the holds, foretells the rest.
pub(super) fn predictions(analysis: &Analysis) -> Option<Table> {
    let until = analysis.options.fit_until?;
    let mut table = Table::new(
        "predictions",
        format!("Laws fitted to the first {until} s of each hold: root mean square error over the rest."),
    )
    .column(column("Hold", "hold", ""))
    .column(column("n", "exponent", ""))
    .column(column("Numbers", "parameters", ""))
    .column(column("Inside, over the drop", "relative_rmse_inside", "%"))
    .column(column("Beyond, over the drop", "relative_rmse_beyond", "%"))
    .column(column("Samples beyond", "samples_beyond", ""));
    let mut rows = 0;
    for hold in &analysis.holds {
        for (fit, prediction) in hold.fits.iter().zip(&hold.predictions) {
            let Some(prediction) = prediction else { continue };
            rows += 1;
            table = table.row(vec![
                Cell::Integer(hold.number as i64),
                Cell::text(match fit.choice() {
                    ExponentChoice::Fixed(n) => format!("{n}"),
                    ExponentChoice::Free => format!("{:.3} (free)", fit.exponent().value),
                }),
                Cell::Integer(fit.free_numbers() as i64),
                Cell::number(100.0 * fit.rmse * prediction.relative / prediction.rmse, 3),
                Cell::number(100.0 * prediction.relative, 3),
                Cell::Integer(prediction.samples as i64),
            ]);
        }
    }
    (rows > 0).then_some(table)
}

/// Equilibria after loading and after unloading at one displacement.
pub(super) fn agreements(analysis: &Analysis) -> Option<Table> {
    if analysis.across.agreements.is_empty() {
        return None;
    }
    let mut table = Table::new("agreement", "Equilibrium after loading and after unloading at one displacement.")
        .column(column("Displacement", "displacement_mm", "mm"))
        .column(column("Hold after loading", "hold_loading", ""))
        .column(column("Hold after unloading", "hold_unloading", ""))
        .column(column("After loading", "equilibrium_loading", ""))
        .column(column("After unloading", "equilibrium_unloading", ""))
        .column(column("Difference", "difference", ""))
        .column(column("Difference over its error", "z", ""));
    for level in &analysis.across.agreements {
        table = table.row(vec![
            Cell::number(1e3 * level.displacement, 4),
            Cell::Integer(level.loading as i64),
            Cell::Integer(level.unloading as i64),
            Cell::number(level.loading_equilibrium, 5),
            Cell::number(level.unloading_equilibrium, 5),
            Cell::number(level.loading_equilibrium - level.unloading_equilibrium, 2),
            Cell::number_or(level.z, 3, "no errors"),
        ]);
    }
    Some(table)
}

/// All tables that a record gives rise to.
pub(super) fn all(analysis: &Analysis) -> Vec<Table> {
    let mut tables = vec![holds(analysis)];
    tables.extend(paper_table(analysis, After::Loading));
    tables.extend(paper_table(analysis, After::Unloading));
    tables.push(exponents(analysis));
    tables.extend(joint(analysis));
    tables.extend(predictions(analysis));
    tables.extend(agreements(analysis));
    tables.push(fits(analysis));
    tables
}

/// The tables and findings as text for a terminal.
#[must_use]
pub fn analysis_text(analysis: &Analysis, input: &Input) -> String {
    let mut text = String::new();
    let mut tables = vec![holds(analysis)];
    tables.extend(paper_table(analysis, After::Loading));
    tables.extend(paper_table(analysis, After::Unloading));
    if analysis.specimen.is_none() {
        tables.push(fits(analysis));
    }
    tables.push(exponents(analysis));
    tables.extend(predictions(analysis));
    for table in tables {
        text.push_str(&table.to_plain_text());
        text.push('\n');
    }
    if let Some(overlay) = &analysis.overlay {
        let (law, layers) = (overlay.model.law, overlay.model.layers.count());
        text.push_str(&format!(
            "Simulated with n = {}, v = {} 1/s, {} layers{}: within {} % of the largest force (rms).\n\n",
            law.exponent(),
            significant(law.rate_coefficient(), 3),
            significant(layers, 3),
            if overlay.layers_fitted { " (fitted)" } else { "" },
            significant(100.0 * overlay.relative, 2)
        ));
    }
    if analysis.options.compare.is_some() {
        text.push_str(&comparison_tables::verdict_text(&ComparedRecord::of_analysis(analysis, input.clone())));
    }
    let asked: Vec<String> = analysis.record.corrections().iter().filter_map(untold).collect();
    if !asked.is_empty() {
        text.push_str(&format!("Corrections\n  {}\n\n", asked.join("\n  ")));
    }
    let findings = findings::plain(analysis);
    if !findings.is_empty() {
        text.push_str(&format!("Findings\n{findings}\n"));
    }
    text
}
