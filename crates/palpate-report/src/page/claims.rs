//! Statements with what became of them, as rows of one table.

use palpate::paper::Verdict;

use super::markup::{each, rich};
use crate::escape::escape;

/// A statement with its comparisons, in words.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimRow {
    /// Where it stands.
    pub place: String,
    /// What is stated.
    pub statement: String,
    /// The comparisons; none where nothing can be compared.
    pub lines: Vec<ClaimLine>,
    /// Why it cannot be checked, or what the comparison does not show; may be empty.
    pub remark: String,
    /// What became of it.
    pub verdict: Verdict,
    /// What shows it, and the link to it.
    pub shown_in: Option<(String, String)>,
}

/// A comparison, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClaimLine {
    /// What is compared.
    pub quantity: String,
    /// The number of the statement.
    pub paper: String,
    /// Our number.
    pub ours: String,
    /// The tolerance with its reason.
    pub tolerance: String,
}

/// All rows as one table.
pub(super) fn written(rows: &[ClaimRow]) -> String {
    let rows = each(rows, row_written);
    let heads = [
        "In the paper",
        "Statement",
        "Compared",
        "Paper, or limit",
        "Here",
        "Tolerance and its reason",
        "Verdict",
        "Shown in",
    ];
    let heads = each(heads, |head| format!("<th scope=\"col\">{head}</th>"));
    format!(
        "<div class=\"table\">\n<div class=\"scroll\">\n<table class=\"checks\">\n<thead>\n<tr>{heads}</tr>\n</thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n</div>\n</div>\n"
    )
}

fn row_written(row: &ClaimRow) -> String {
    let (class, sign) = match row.verdict {
        Verdict::Reproduced => ("pass", "✓"),
        Verdict::NotReproduced => ("fail", "✗"),
        Verdict::CannotBeChecked => ("not-run", "–"),
    };
    let span = row.lines.len().max(1);
    let link = row
        .shown_in
        .as_ref()
        .map_or(String::new(), |(text, target)| format!("<a href=\"{}\">{}</a>", escape(target), rich(text)));
    let remark = match (row.remark.as_str(), row.lines.is_empty()) {
        ("", _) | (_, true) => String::new(),
        (remark, false) => format!("<br><span class=\"note\">{}</span>", rich(remark)),
    };
    let line = |line: &ClaimLine| {
        let cells = [&line.quantity, &line.paper, &line.ours, &line.tolerance];
        each(cells, |text| format!("<td>{}</td>", rich(text)))
    };
    let first = match row.lines.first() {
        Some(first) => line(first),
        None => format!("<td colspan=\"4\">{}</td>", rich(&row.remark)),
    };
    let others = each(row.lines.iter().skip(1), |other| format!("<tr>{}</tr>\n", line(other)));
    format!(
        "<tr><td rowspan=\"{span}\">{}</td><th scope=\"row\" rowspan=\"{span}\">{}{remark}</th>{first}\
         <td class=\"{class}\" rowspan=\"{span}\"><span aria-hidden=\"true\">{sign}</span> {}</td>\
         <td rowspan=\"{span}\">{link}</td></tr>\n{others}",
        rich(&row.place),
        rich(&row.statement),
        row.verdict.words()
    )
}
