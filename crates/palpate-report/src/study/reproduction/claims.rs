//! Claims as rows of the page, as a table and as text.

use palpate::number::significant;
use palpate::paper::{Claim, Comparison, Evidence, Relation, Value, Verdict};

use crate::page::{ClaimLine, ClaimRow};
use crate::table::{Cell, Table};
use crate::word::capitalised;
use crate::wrap::{indented, width};

/// A number with its interval: ± if it is symmetric, its ends otherwise.
fn value_words(value: Value, unit: &str) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let plain = |number: f64, decimals: usize| {
        let shortest = format!("{number}");
        let digits = shortest.split_once('.').map_or(0, |(_, digits)| digits.len());
        if digits <= decimals { shortest } else { format!("{number:.decimals$}") }
    };
    let words = match value.interval {
        Some((low, high)) if high > low => {
            let half = 0.5 * (high - low);
            let decimals = (-half.log10().floor()).clamp(0.0, 12.0) as usize;
            let number = plain(value.value, decimals);
            if (0.5 * (high + low) - value.value).abs() < 1e-6 * half {
                format!("{number} ± {half:.decimals$}")
            } else {
                format!("{number} [{low:.decimals$}, {high:.decimals$}]")
            }
        }
        _ if value.value.fract() == 0.0 && value.value.abs() < 1e6 => format!("{}", value.value),
        _ => significant(value.value, 3),
    };
    format!("{words}{unit}").replace('-', "−")
}

fn paper_words(comparison: &Comparison) -> String {
    let sign = match comparison.relation {
        Relation::Equal => "",
        Relation::AtMost => "≤ ",
        Relation::AtLeast => "≥ ",
    };
    format!("{sign}{}", value_words(comparison.paper, &comparison.unit))
}

fn tolerance_words(comparison: &Comparison) -> String {
    let tolerance = value_words(comparison.tolerance.into(), &comparison.unit);
    format!("{tolerance}: {}", comparison.reason)
}

/// Our number and what it is held against.
fn numbers(comparison: &Comparison) -> String {
    let ours = value_words(comparison.ours, &comparison.unit);
    let paper = paper_words(comparison);
    match comparison.relation {
        Relation::Equal => {
            let tolerance = value_words(comparison.tolerance.into(), &comparison.unit);
            format!("{ours} (paper {paper}, tolerance {tolerance})")
        }
        Relation::AtMost | Relation::AtLeast if comparison.tolerance > 0.0 => {
            let tolerance = value_words(comparison.tolerance.into(), &comparison.unit);
            format!("{ours} (to be {paper}, tolerance {tolerance})")
        }
        Relation::AtMost | Relation::AtLeast => format!("{ours} (to be {paper})"),
    }
}

/// The claims as a page shows them, with links to what shows them.
pub(super) fn rows(claims: &[Claim], link: impl Fn(Evidence) -> Option<(String, String)>) -> Vec<ClaimRow> {
    let line = |comparison: &Comparison| ClaimLine {
        quantity: comparison.quantity.clone(),
        paper: paper_words(comparison),
        ours: value_words(comparison.ours, &comparison.unit),
        tolerance: tolerance_words(comparison),
    };
    let row = |claim: &Claim| ClaimRow {
        place: claim.place.to_string(),
        statement: claim.statement.clone(),
        lines: claim.comparisons.iter().map(line).collect(),
        remark: claim.remark.clone(),
        verdict: claim.verdict(),
        shown_in: claim.evidence.and_then(&link),
    };
    claims.iter().map(row).collect()
}

/// The claims for machines: a row for each comparison, and one for each claim without any.
pub(super) fn table(claims: &[Claim], link: impl Fn(Evidence) -> Option<(String, String)>) -> Table {
    let all: Vec<(&Claim, Option<&Comparison>)> = claims
        .iter()
        .flat_map(|claim| {
            let compared = claim.comparisons.iter().map(move |comparison| (claim, Some(comparison)));
            compared.chain(claim.comparisons.is_empty().then_some((claim, None)))
        })
        .collect();
    type Row<'a> = (&'a Claim, Option<&'a Comparison>);
    let number = |value: fn(&Comparison) -> Option<f64>| {
        move |(_, comparison): &Row<'_>| Cell::number_or(comparison.and_then(value), 4, "none")
    };
    let text = |value: fn(&Comparison) -> String| {
        move |(_, comparison): &Row<'_>| Cell::text(comparison.map(value).unwrap_or_default())
    };
    Table::of("claims", "Every equation, figure, table and statement of the paper.", &all)
        .column("In the paper", "place", "", |(claim, _)| Cell::text(claim.place.to_string()))
        .column("Statement", "statement", "", |(claim, _)| Cell::text(&claim.statement))
        .column("Verdict", "verdict", "", |(claim, _)| Cell::text(claim.verdict().words()))
        .column("Compared", "quantity", "", text(|comparison| comparison.quantity.clone()))
        .column("Unit", "unit", "", text(|comparison| comparison.unit.clone()))
        .column("Paper", "paper", "", number(|comparison| Some(comparison.paper.value)))
        .column("From", "paper_low", "", number(|comparison| comparison.paper.interval.map(|(low, _)| low)))
        .column("To", "paper_high", "", number(|comparison| comparison.paper.interval.map(|(_, high)| high)))
        .column("Relation", "relation", "", text(|comparison| crate::word::word(comparison.relation)))
        .column("Here", "here", "", number(|comparison| Some(comparison.ours.value)))
        .column("From", "here_low", "", number(|comparison| comparison.ours.interval.map(|(low, _)| low)))
        .column("To", "here_high", "", number(|comparison| comparison.ours.interval.map(|(_, high)| high)))
        .column("Tolerance", "tolerance", "", number(|comparison| Some(comparison.tolerance)))
        .column("Reason", "reason", "", text(|comparison| comparison.reason.clone()))
        .column("Remark", "remark", "", |(claim, _)| Cell::text(&claim.remark))
        .column("Shown in", "shown_in", "", |(claim, _)| {
            Cell::text(claim.evidence.and_then(&link).map(|(text, _)| text).unwrap_or_default())
        })
        .table()
}

/// Number of claims by verdict, in one sentence.
pub(super) fn counted(claims: &[Claim]) -> String {
    let count = |verdict: Verdict| claims.iter().filter(|claim| claim.verdict() == verdict).count();
    format!(
        "{} statements: {} not reproduced, {} reproduced, {} that cannot be checked.",
        claims.len(),
        count(Verdict::NotReproduced),
        count(Verdict::Reproduced),
        count(Verdict::CannotBeChecked)
    )
}

/// The claims that are not reproduced, a sentence each with the first comparison that fails.
pub(super) fn mismatches(claims: &[Claim]) -> Vec<String> {
    let failed = claims.iter().filter(|claim| claim.verdict() == Verdict::NotReproduced);
    let sentence = |claim: &Claim| {
        let mut failing = claim.comparisons.iter().filter(|comparison| comparison.fails());
        let first = failing.next().map_or(String::new(), |comparison| {
            format!("{}: {}", capitalised(&comparison.quantity), numbers(comparison))
        });
        let more = match failing.count() {
            0 => String::new(),
            count => format!(", and {count} more"),
        };
        format!("{}: {} {first}{more}.", claim.place, claim.statement)
    };
    failed.map(sentence).collect()
}

/// Every claim in a line or a few: what is not reproduced first, with its numbers.
#[must_use]
pub fn claims_text(claims: &[Claim]) -> String {
    let mut text = format!("{}\n", counted(claims));
    for verdict in [Verdict::NotReproduced, Verdict::Reproduced, Verdict::CannotBeChecked] {
        let of = || claims.iter().filter(|claim| claim.verdict() == verdict);
        if of().next().is_none() {
            continue;
        }
        text.push_str(&format!("\n{}\n", capitalised(verdict.words())));
        for claim in of() {
            let head = format!("  {:<11} ", claim.place.to_string());
            text.push_str(&indented(&head, 14, width(), &claim.statement));
            // What fails, or what does not decide.
            let is_shown = |comparison: &&Comparison| comparison.fails() || verdict == Verdict::CannotBeChecked;
            for comparison in claim.comparisons.iter().filter(is_shown) {
                let line = format!("{}: {}", comparison.quantity, numbers(comparison));
                text.push_str(&indented("              ", 16, width(), &line));
            }
            if verdict == Verdict::CannotBeChecked && !claim.remark.is_empty() {
                text.push_str(&indented("              ", 14, width(), &claim.remark));
            }
        }
    }
    text
}
