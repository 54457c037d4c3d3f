//! Tables of an analysed record.

use std::ops::RangeInclusive;

use palpate::analysis::{Analysis, HoldAnalysis, HoldoutError, JointAnalysis, JointHolds, Signal};
use palpate::fit::{Domain, ExponentChoice, LatencyFit, ParameterKind, SharedTrend};
use palpate::record::Correction;
use palpate::segment::{After, FitStartRule, RelaxationType};

use crate::number::significant;
use crate::result::{ComparedRecord, Input, budgets_of_analysis, displacement_held, mode_word, percent, travel, word};
use crate::study::comparison::tables as comparison_tables;
use crate::study::findings::Gathered;
use crate::study::{answer, budget, findings};
use crate::table::{Cell, Table};
use crate::wrap::wrapped;

/// An exponent as people write it: 5, not 5.000.
fn order(n: f64) -> Cell {
    if n.fract() == 0.0 && n.abs() < 1e6 { Cell::Integer(n as i64) } else { Cell::Number(n, 4) }
}

/// A parameter of a fit with its interval, unless the fit ended at a bound or short of an optimum: its value is then none to copy.
fn parameter(fit: &LatencyFit, kind: ParameterKind) -> Cell {
    let found = fit.parameter(kind).and_then(|parameter| parameter.determined(fit.termination));
    found.map_or_else(
        || Cell::missing("a parameter is at its bound, or the fit did not converge"),
        |found| Cell::Estimate(*found),
    )
}

/// A correction in words, if neither a finding nor first touch tells of it.
fn untold(done: &Correction) -> Option<String> {
    let reported = matches!(
        done,
        Correction::Tared(_)
            | Correction::StampsSorted { .. }
            | Correction::StampsMerged { .. }
            | Correction::StampsSpread { .. }
            | Correction::RowsAveraged { .. }
            | Correction::StressAsForce
            | Correction::DropoutsReplaced { .. }
    );
    (!reported).then(|| done.to_string())
}

/// No record says more of its noise than that a change is as improbable as this.
const LEAST_P: f64 = 1e-6;

/// One row a hold: where it lies, what the force does.
pub(super) fn holds(analysis: &Analysis) -> Table {
    let travel = travel(analysis);
    Table::of("holds", "Holds of the record.", &analysis.holds)
        .column("Hold", "hold", "", |hold| Cell::Integer(hold.number as i64))
        .column("After", "after", "", |hold| Cell::text(hold.after.map(word).unwrap_or_default()))
        .column("Held", "mode", "", |hold| {
            let mode = hold.segment.mode.map(mode_word).unwrap_or_default();
            Cell::text(if hold.segment.doubtful { format!("{mode}, doubtful") } else { mode })
        })
        .column("From", "start_s", "s", |hold| Cell::Number(hold.start, 5))
        .column("To", "end_s", "s", |hold| Cell::Number(hold.end, 5))
        .column("Fit from", "fit_start_s", "s", |hold| Cell::Number(hold.fit_start, 5))
        .column("Chosen by", "fit_start_rule", "", |hold| {
            Cell::text(hold.segment.fit_start_rule.map(FitStartRule::words).unwrap_or_default())
        })
        .column("Displacement", "displacement_mm", "mm", |hold| displacement(hold, travel))
        .column("Force at start", "force_start_n", "N", |hold| Cell::Number(hold.force_start, 4))
        .column("Force at end", "force_end_n", "N", |hold| Cell::Number(hold.force_end, 4))
        .column("Type", "relaxation", "", |hold| {
            Cell::text(match hold.relaxation.kind {
                RelaxationType::TypeI => "I",
                RelaxationType::TypeII => "II",
                RelaxationType::None => "none",
            })
        })
        .column("p", "p_value", "", |hold| Cell::AtLeast(hold.relaxation.p_value, LEAST_P))
        .table()
        .note("Held: the displacement (the force relaxes), the force (the displacement creeps) or neither.")
        .note("Type I: the force falls; Type II: it rises. The laws are fitted from the time “Fit from” on, which may lie after the start of the hold.")
        .note("p: probability of such a change of the force, from the first twentieth of the hold to its last fifth, by noise that correlates as that fifth shows; people read no less than 10⁻⁶, files have the number of the test. A drift or a random walk exceeds it more often.")
}

/// The displacement that was held.
fn displacement(hold: &HoldAnalysis, travel: f64) -> Cell {
    Cell::number_or(displacement_held(hold.displacement, travel).map(|d| 1e3 * d), 4, "not recorded")
}

/// Every fit of every hold, both domains.
pub(super) fn fits(analysis: &Analysis) -> Table {
    let (key, unit) = match analysis.holds.first().map(|hold| hold.signal) {
        Some(Signal::Strain) => ("equilibrium_strain", ""),
        _ => ("equilibrium_force_n", "N"),
    };
    let mut rows: Vec<(&HoldAnalysis, usize, &LatencyFit)> = Vec::new();
    for hold in &analysis.holds {
        let fits = hold.fits.iter().chain(hold.rate_fits.iter().flatten());
        rows.extend(fits.enumerate().map(|(i, fit)| (hold, i, fit)));
    }
    let amplitude = if unit == "N" { "excess_force_n" } else { "excess_strain" };
    let in_time = |fit: &LatencyFit| fit.domain == Domain::Time;
    let table = Table::of("fits", "Every law fitted to every hold.", &rows)
        .column("Hold", "hold", "", |(hold, ..)| Cell::Integer(hold.number as i64))
        .column("Domain", "domain", "", |(.., fit)| Cell::text(word(fit.domain)))
        .estimates("n", "exponent", "", |(.., fit)| match fit.choice() {
            ExponentChoice::Fixed(n) => order(n),
            ExponentChoice::Free => parameter(fit, ParameterKind::Exponent),
        })
        .estimates("Equilibrium", key, unit, |(.., fit)| parameter(fit, ParameterKind::Equilibrium))
        .estimates("Excess at the start", amplitude, unit, |(.., fit)| parameter(fit, ParameterKind::Amplitude))
        .estimates("λ", "relative_rate_per_s", "s⁻¹", |(.., fit)| parameter(fit, ParameterKind::RelativeRate))
        .estimates("v", "rate_coefficient_per_s", "s⁻¹", |(hold, _, fit)| match hold.signal {
            Signal::Strain => parameter(fit, ParameterKind::RateCoefficient),
            Signal::Force => Cell::missing("no strain"),
        })
        .column("RMSE", "rmse", "", |(.., fit)| Cell::Number(fit.rmse, 3))
        .column("ΔBIC", "delta_bic", "", |(hold, i, fit)| {
            let order = hold.order.as_ref().filter(|_| in_time(fit));
            Cell::number_or(order.map(|order| order.candidates[*i].delta_bic), 3, "time domain only")
        })
        .column("Held-out error", "holdout_error", "", |(hold, i, fit)| {
            let beyond = hold.predictions.get(*i).copied().flatten().filter(|_| in_time(fit));
            let why = if in_time(fit) { "whole hold fitted" } else { "time domain only" };
            Cell::number_or(beyond.map(|prediction| prediction.relative), 3, why)
        })
        .column("Ended", "termination", "", |(.., fit)| Cell::text(word(fit.termination)))
        .table();
    analysis.holds.iter().filter_map(rate_bias_note).fold(table, Table::note)
        .note(format!("Value [low, high]: {} confidence interval, including the correlation of the residuals. The CSV file also has the standard errors.", percent(analysis.options.fit.confidence)))
        .note("v is in 1/s where the signal is strain. ΔBIC: information criterion less the lowest of the hold. Held-out error: error of the prediction beyond the fitted part, as a share of the change over the hold.")
}

/// How far noise takes the rate domain from the truth in one hold.
fn rate_bias_note(hold: &HoldAnalysis) -> Option<String> {
    /// Shares of the true value beyond which an estimate is none.
    const FAR: RangeInclusive<f64> = 1e-3..=1e3;
    let bias = hold.rate_bias.filter(|_| hold.rate_fits.iter().any(Option::is_some))?;
    let (low, high) = bias.coefficient_range;
    let of_v = match FAR.contains(&low) && FAR.contains(&high) {
        true => format!(
            "estimates v at {:.2} of the true value ({low:.2} to {high:.2} in {} of them)",
            bias.coefficient, bias.repetitions
        ),
        false => "does not determine v, not even to a factor of a thousand,".to_owned(),
    };
    Some(format!(
        "Rate domain, hold {}: on simulated holds with the parameters of the fit in the time domain (n = {:.3}) and this noise it {of_v} and estimates the equilibrium with an error of {} % of the relaxation.",
        hold.number,
        bias.exponent,
        // No negative zero.
        format!("{:.1}", (1e3 * bias.equilibrium).round() / 10.0 + 0.0).replace('-', "−")
    ))
}

/// Tables I and II of the paper for this record, so far as it has such holds.
pub(super) fn paper_tables(analysis: &Analysis) -> impl Iterator<Item = Table> {
    [After::Loading, After::Unloading].into_iter().filter_map(|after| paper_table(analysis, after))
}

/// Table I (after loading) or II (after unloading) of the paper for this record.
fn paper_table(analysis: &Analysis, after: After) -> Option<Table> {
    let n = analysis.across.common_exponent?;
    let (name, number) = match after {
        After::Loading => ("table_1_loading", "I"),
        After::Unloading => ("table_2_unloading", "II"),
    };
    let caption = format!(
        "Holds after {}: the law with n = {n}, in the layout of the paper's Table {number}. Time domain: the closed form fitted to the strain; rate domain: the paper's fit of strain rate against strain.",
        word(after)
    );
    let travel = travel(analysis);
    let holds = analysis.holds.iter().filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain);
    let rows: Vec<(&HoldAnalysis, &LatencyFit)> = holds.filter_map(|hold| Some((hold, hold.fit_with(n)?))).collect();
    let by_rate = |hold: &HoldAnalysis, cell: &dyn Fn(&LatencyFit) -> Cell| {
        hold.rate_fit_with(n).map_or(Cell::missing("no fit"), cell)
    };
    let equilibrium = |fit: &LatencyFit| parameter(fit, ParameterKind::Equilibrium);
    let coefficient = |fit: &LatencyFit| parameter(fit, ParameterKind::RateCoefficient);
    Table::of(name, caption, &rows)
        .column("Hold", "hold", "", |(hold, _)| Cell::Integer(hold.number as i64))
        .column("Displacement", "displacement_mm", "mm", |(hold, _)| displacement(hold, travel))
        .estimates("εₑ (time)", "equilibrium_strain", "", |(_, fit)| equilibrium(fit))
        .estimates("v (time)", "rate_coefficient_per_s", "s⁻¹", |(_, fit)| coefficient(fit))
        .estimates("εₑ (rate)", "equilibrium_strain_rate_domain", "", |(hold, _)| by_rate(hold, &equilibrium))
        .estimates("v (rate)", "rate_coefficient_rate_domain_per_s", "s⁻¹", |(hold, _)| by_rate(hold, &coefficient))
        .estimates("n (free)", "exponent_free", "", |(hold, _)| {
            let free = hold.fits.iter().find(|fit| fit.choice() == ExponentChoice::Free);
            free.map_or(Cell::missing("not requested"), |fit| parameter(fit, ParameterKind::Exponent))
        })
        .unless_empty()
}

/// Evidence for the exponent over all holds: the paper's "lowest order which fits the best".
pub(super) fn exponents(analysis: &Analysis) -> Table {
    let caption =
        "Common exponent of all holds: sum of the information criteria of the listed exponents less the lowest sum.";
    Table::of("exponents", caption, &analysis.across.evidence)
        .column("n", "exponent", "", |(n, _)| order(*n))
        .column("ΔBIC, all holds", "delta_bic", "", |(_, delta)| Cell::Number(*delta, 4))
        .column("Holds where it is not distinguishable from the best", "holds_indistinguishable", "", |(n, _)| {
            let orders = analysis.holds.iter().filter_map(|hold| hold.order.as_ref());
            let candidates = orders.flat_map(|order| &order.candidates);
            Cell::Integer(candidates.filter(|c| !c.free && c.exponent == *n && c.indistinguishable).count() as i64)
        })
        .column("Verdict", "verdict", "", |(n, delta)| {
            Cell::text(match delta {
                _ if analysis.across.common_exponent == Some(*n) => {
                    "lowest order not distinguishable from the best listed"
                }
                delta if *delta <= 2.0 => "not distinguishable from the best listed",
                _ => "",
            })
        })
        .table()
}

/// One law for several holds against one for each.
pub(super) fn joint(analysis: &Analysis) -> Option<Table> {
    let joint = &analysis.across.joint;
    let caption = "One law for several holds, each with its own εₑ, compared with a law for each hold: p of the F-test, ΔBIC (negative for one law), and the trend of v at one n.";
    let shared = |one: &JointAnalysis, name: &str| {
        Cell::number_or(one.fit.shared(name).map(|number| number.estimate.value), 4, "not found")
    };
    let trend = |one: &JointAnalysis, of: fn(&SharedTrend) -> f64| {
        Cell::number_or(one.comparison.trend.as_ref().map(of), 3, "one strain")
    };
    Table::of("joint", caption, joint)
        .column("Holds after", "holds", "", |one| {
            Cell::text(match one.which {
                JointHolds::Loading => "loading",
                JointHolds::All => "both",
            })
        })
        .column("Holds", "count", "", |one| Cell::Integer(one.holds.len() as i64))
        .column("n", "exponent", "", |one| match one.choice {
            ExponentChoice::Fixed(n) => order(n),
            ExponentChoice::Free => shared(one, "exponent"),
        })
        .column("v", "rate_coefficient_per_s", "s⁻¹", |one| shared(one, "rate_coefficient_per_s"))
        .column("p", "p_value", "", |one| Cell::number_or(one.comparison.p, 2, "too few independent samples"))
        .column("ΔBIC", "delta_bic", "", |one| Cell::Number(one.comparison.delta_bic, 4))
        .column("d ln v/dεₑ", "trend", "", |one| trend(one, |trend| trend.slope))
        .column("from", "trend_low", "", |one| trend(one, |trend| trend.interval.0))
        .column("to", "trend_high", "", |one| trend(one, |trend| trend.interval.1))
        .column("v is", "verdict", "", |one| Cell::text(word(one.comparison.verdict).replace('_', " ")))
        .unless_empty()
}

/// How well each law, fitted to the first part of the holds, predicts the rest.
pub(super) fn predictions(analysis: &Analysis) -> Option<Table> {
    let until = analysis.options.fit_until?;
    let caption = format!("Laws fitted to the first {until} s of each hold: root mean square held-out error.");
    let mut rows: Vec<(&HoldAnalysis, &LatencyFit, HoldoutError)> = Vec::new();
    for hold in &analysis.holds {
        let fits = hold.fits.iter().zip(&hold.predictions);
        rows.extend(fits.filter_map(|(fit, prediction)| Some((hold, fit, (*prediction)?))));
    }
    Table::of("predictions", caption, &rows)
        .column("Hold", "hold", "", |(hold, ..)| Cell::Integer(hold.number as i64))
        .column("n", "exponent", "", |(_, fit, _)| {
            Cell::text(match fit.choice() {
                ExponentChoice::Fixed(n) => format!("{n}"),
                ExponentChoice::Free => format!("{:.3} (free)", fit.exponent().value),
            })
        })
        .column("Parameters", "parameters", "", |(_, fit, _)| Cell::Integer(fit.free_parameters() as i64))
        .column("Inside, over the drop", "relative_rmse_inside", "%", |(_, fit, beyond)| {
            Cell::Number(100.0 * fit.rmse * beyond.relative / beyond.rmse, 3)
        })
        .column("Beyond, over the drop", "relative_rmse_beyond", "%", |(.., beyond)| {
            Cell::Number(100.0 * beyond.relative, 3)
        })
        .column("Samples beyond", "samples_beyond", "", |(.., beyond)| Cell::Integer(beyond.samples as i64))
        .unless_empty()
}

/// Equilibria after loading and after unloading at one displacement.
pub(super) fn agreements(analysis: &Analysis) -> Option<Table> {
    let levels = &analysis.across.agreements;
    Table::of("agreement", "Equilibrium after loading and after unloading at one displacement.", levels)
        .column("Displacement", "displacement_mm", "mm", |level| Cell::Number(1e3 * level.displacement, 4))
        .column("Hold after loading", "hold_loading", "", |level| Cell::Integer(level.loading as i64))
        .column("Hold after unloading", "hold_unloading", "", |level| Cell::Integer(level.unloading as i64))
        .column("After loading", "equilibrium_loading", "", |level| Cell::Number(level.loading_equilibrium, 5))
        .column("After unloading", "equilibrium_unloading", "", |level| Cell::Number(level.unloading_equilibrium, 5))
        .column("Difference", "difference", "", |level| {
            Cell::Number(level.loading_equilibrium - level.unloading_equilibrium, 2)
        })
        .column("Difference over its error", "z", "", |level| Cell::number_or(level.z, 3, "no errors"))
        .unless_empty()
}

/// All tables that a record gives rise to.
pub(super) fn all(analysis: &Analysis) -> Vec<Table> {
    let mut tables = vec![holds(analysis)];
    tables.extend(paper_tables(analysis));
    tables.push(exponents(analysis));
    tables.extend(joint(analysis));
    tables.extend(predictions(analysis));
    tables.extend(agreements(analysis));
    tables.push(fits(analysis));
    tables
}

/// The tables and findings as text for a terminal; of many holds a row each, unless all is wanted `in_full`, and whether that would be more.
#[must_use]
pub fn analysis_text(analysis: &Analysis, input: &Input, in_full: bool) -> (String, bool) {
    let in_brief = !in_full && analysis.holds.len() > answer::FEW;
    (text_of(analysis, input, in_brief), in_brief)
}

fn text_of(analysis: &Analysis, input: &Input, in_brief: bool) -> String {
    let compared = ComparedRecord::of_analysis(analysis, input.clone());
    let gathered = findings::gathered(analysis, findings::MOST_PLAIN);
    if analysis.holds.is_empty() {
        return without_hold(analysis, &gathered);
    }
    let mut text = String::new();
    if analysis.options.compare.is_some() {
        text.push_str(&answer::answer_text(&compared, &gathered, in_brief));
        text.push('\n');
    }
    let mut tables = vec![holds(analysis)];
    if !in_brief {
        tables.extend(budget::tables(&budgets_of_analysis(analysis, &compared), analysis.options.fit.confidence));
    }
    tables.extend(paper_tables(analysis));
    if analysis.specimen.is_none() && !in_brief {
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
        text.push_str(&comparison_tables::verdict_text(&compared));
    }
    text.push_str(&what_was_done(analysis, &gathered));
    text
}

/// The text of a record without a hold: there are no laws to list.
fn without_hold(analysis: &Analysis, gathered: &[Gathered]) -> String {
    let modulus = modulus_sentence(analysis).map(|sentence| wrapped(&sentence) + "\n");
    modulus.unwrap_or_default() + &what_was_done(analysis, gathered)
}

/// The modulus of the first loading ramp in a sentence, where there is one.
pub(super) fn modulus_sentence(analysis: &Analysis) -> Option<String> {
    let found = analysis.loading_modulus?;
    Some(format!(
        "Apparent modulus of the first loading ramp: {} Pa, standard error {} Pa. The residual is {} % of the largest force of the ramp \
         (rms).",
        significant(found.value, 4),
        significant(found.standard_error, 2),
        significant(100.0 * found.relative_rmse, 2)
    ))
}

/// Corrections and findings.
fn what_was_done(analysis: &Analysis, gathered: &[Gathered]) -> String {
    let mut text = String::new();
    let requested: Vec<String> = analysis.record.corrections().iter().filter_map(untold).collect();
    if !requested.is_empty() {
        text.push_str(&format!("Corrections\n  {}\n\n", requested.join("\n  ")));
    }
    let findings = findings::plain(gathered);
    if !findings.is_empty() {
        text.push_str(&format!("Findings\n{findings}\n"));
    }
    text
}
