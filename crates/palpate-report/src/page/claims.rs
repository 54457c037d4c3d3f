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
    let heads = ["In the paper", "Verdict", "Compared", "Paper, or limit", "Here", "Tolerance and its reason"];
    let heads = each(heads, |head| format!("<th scope=\"col\">{head}</th>"));
    format!(
        "<div class=\"table\">\n<div class=\"scroll\">\n<table class=\"claims\">\n<thead>\n<tr>{heads}</tr>\n</thead>\n\
         {rows}</table>\n</div>\n</div>\n"
    )
}

/// The rows of one statement as a body of the table, which paper does not break.
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
        .map_or(String::new(), |(text, target)| format!("<br><a href=\"{}\">{}</a>", escape(target), rich(text)));
    let (remark, alone) = if row.lines.is_empty() { ("", row.remark.as_str()) } else { (row.remark.as_str(), "") };
    let remark = if remark.is_empty() { String::new() } else { format!("<p class=\"note\">{}</p>", rich(remark)) };
    let line = |line: &ClaimLine| {
        let [quantity, paper, ours, tolerance] =
            [&line.quantity, &line.paper, &line.ours, &line.tolerance].map(|text| rich(text));
        format!(
            "<td>{quantity}</td><td class=\"value\">{paper}</td><td class=\"value\">{ours}</td><td>{tolerance}</td>"
        )
    };
    let first = row.lines.first().map_or_else(|| format!("<td colspan=\"4\">{}</td>", rich(alone)), line);
    let others = each(row.lines.iter().skip(1), |other| format!("<tr>{}</tr>\n", line(other)));
    format!(
        "<tbody>\n<tr><th scope=\"rowgroup\" rowspan=\"{span}\"><b>{}</b> {}{remark}</th>\
         <td rowspan=\"{span}\"><span class=\"{class}\"><span aria-hidden=\"true\">{sign}</span> {}</span>{link}</td>{first}</tr>\n{others}</tbody>\n",
        rich(&row.place),
        rich(&row.statement),
        row.verdict.words()
    )
}
