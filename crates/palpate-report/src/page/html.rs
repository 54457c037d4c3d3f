//! Pages as HTML.

use std::collections::HashSet;

use super::{Block, Check, Finding, Outcome, Page, Picture};
use crate::escape::escape;
use crate::script::{Level, runs};
use crate::table::{Cell, Table, mark};

/// Tables of at most this many rows stay on one page of paper.
const SHORT: usize = 25;
const STYLE: &str = include_str!("style.css");

/// The whole document.
pub(crate) fn document(page: &Page) -> String {
    let ids = section_ids(page);
    let title = escape(&page.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>{title}</h1>\n"
    );
    if !page.subtitle.is_empty() {
        out.push_str(&format!("<p class=\"subtitle\">{}</p>\n", rich(&page.subtitle)));
    }
    out.push_str("</header>\n");
    contents(&mut out, page, &ids);
    out.push_str("<main>\n");
    let mut counts = Counts::default();
    for (section, id) in page.sections.iter().zip(&ids) {
        let heading = rich(&section.heading);
        out.push_str(&format!("<section aria-labelledby=\"{id}\">\n<h2 id=\"{id}\">{heading}</h2>\n"));
        for block in &section.blocks {
            write_block(&mut out, block, &mut counts);
        }
        out.push_str("</section>\n");
    }
    out.push_str("</main>\n");
    if !page.provenance.is_empty() {
        out.push_str("<footer>\n<h2>Provenance</h2>\n");
        key_values(&mut out, &page.provenance);
        out.push_str("</footer>\n");
    }
    out.push_str("</body>\n</html>\n");
    out
}

#[derive(Default)]
struct Counts {
    figures: usize,
    tables: usize,
}

/// One anchor for each section: letters, digits and hyphens, no two alike.
fn section_ids(page: &Page) -> Vec<String> {
    let mut taken = HashSet::new();
    page.sections
        .iter()
        .map(|section| {
            let source = if section.id.is_empty() { &section.heading } else { &section.id };
            let words: String =
                source.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' }).collect();
            let stem = words.split_whitespace().collect::<Vec<_>>().join("-");
            let stem = if stem.is_empty() { "section".to_owned() } else { stem };
            let mut id = stem.clone();
            let mut number = 2;
            while !taken.insert(id.clone()) {
                id = format!("{stem}-{number}");
                number += 1;
            }
            id
        })
        .collect()
}

fn contents(out: &mut String, page: &Page, ids: &[String]) {
    if page.sections.len() < 2 {
        return;
    }
    out.push_str("<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n");
    for (section, id) in page.sections.iter().zip(ids) {
        out.push_str(&format!("<li><a href=\"#{id}\">{}</a></li>\n", rich(&section.heading)));
    }
    out.push_str("</ol>\n</nav>\n");
}

fn write_block(out: &mut String, block: &Block, counts: &mut Counts) {
    match block {
        Block::Subheading(text) => out.push_str(&format!("<h3>{}</h3>\n", rich(text))),
        Block::Paragraph(text) => out.push_str(&format!("<p>{}</p>\n", rich(text))),
        Block::List(items) => {
            out.push_str("<ul>\n");
            for item in items {
                out.push_str(&format!("<li>{}</li>\n", rich(item)));
            }
            out.push_str("</ul>\n");
        }
        Block::Table(table) => {
            counts.tables += 1;
            write_table(out, table, counts.tables);
        }
        Block::Figure(picture) => {
            counts.figures += 1;
            write_figure(out, picture, counts.figures);
        }
        Block::Findings(findings) => write_findings(out, findings),
        Block::KeyValues(pairs) => key_values(out, pairs),
        Block::Code(text) => {
            out.push_str(&format!("<pre tabindex=\"0\"><code>{}</code></pre>\n", escape(text)));
        }
        Block::Checks(checks) => write_checks(out, checks),
    }
}

fn write_figure(out: &mut String, picture: &Picture, number: usize) {
    out.push_str(&format!(
        "<figure id=\"figure-{number}\">\n{}<figcaption><b>Figure {number}.</b> {}</figcaption>\n\
         </figure>\n",
        picture.svg,
        rich(&picture.caption)
    ));
}

fn write_table(out: &mut String, table: &Table, number: usize) {
    let reasons = table.reasons();
    let columns = table.columns.len();
    let class: Vec<&str> = (0..columns).map(|c| if table.is_numeric(c) { " class=\"n\"" } else { "" }).collect();
    out.push_str(&format!(
        "<div class=\"table{}\" id=\"table-{number}\">\n<table>\n\
         <caption><b>Table {number}.</b> {}</caption>\n<thead>\n<tr>",
        if table.rows.len() <= SHORT { " short" } else { "" },
        rich(&table.caption)
    ));
    for (column, class) in table.columns.iter().zip(&class) {
        out.push_str(&format!("<th scope=\"col\"{class}>{}", rich(&column.heading)));
        if !column.unit.is_empty() {
            out.push_str(&format!(" <span class=\"unit\">({})</span>", rich(&column.unit)));
        }
        out.push_str("</th>");
    }
    out.push_str("</tr>\n</thead>\n<tbody>\n");
    for row in 0..table.rows.len() {
        out.push_str("<tr>");
        for (c, class) in class.iter().enumerate() {
            out.push_str(&format!("<td{class}>{}</td>", cell(table.cell(row, c), &reasons)));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table>\n");
    for (i, reason) in reasons.iter().enumerate() {
        out.push_str(&format!("<p class=\"note\"><sup>{}</sup> {}</p>\n", mark(i), rich(reason)));
    }
    for note in &table.notes {
        out.push_str(&format!("<p class=\"note\">{}</p>\n", rich(note)));
    }
    out.push_str("</div>\n");
}

fn cell(cell: &Cell, reasons: &[&str]) -> String {
    let text = rich(&cell.shown());
    match cell {
        Cell::Missing(reason) => match reasons.iter().position(|r| r == reason) {
            Some(i) => format!("{text}<sup>{}</sup>", mark(i)),
            None => text,
        },
        _ => text,
    }
}

fn write_findings(out: &mut String, findings: &[Finding]) {
    if findings.is_empty() {
        out.push_str("<p>Nothing to report.</p>\n");
        return;
    }
    for finding in findings {
        let word = finding.severity.word();
        out.push_str(&format!(
            "<div class=\"finding {word}\">\n<p class=\"head\"><span class=\"word\">{word}</span> \
             <code>{}</code></p>\n<p>{}</p>\n",
            escape(&finding.code),
            finding.seen.lines().map(rich).collect::<Vec<_>>().join("<br>\n")
        ));
        for (name, text) in [("May mean", &finding.meaning), ("What helps", &finding.remedy)] {
            if !text.is_empty() {
                out.push_str(&format!("<p><i>{name}:</i> {}</p>\n", rich(text)));
            }
        }
        out.push_str("</div>\n");
    }
}

fn write_checks(out: &mut String, checks: &[Check]) {
    out.push_str(
        "<div class=\"table short\">\n<table class=\"checks\">\n<thead>\n<tr><th scope=\"col\">Check</th>\
         <th scope=\"col\">Criterion</th><th scope=\"col\">Found</th>\
         <th scope=\"col\">Outcome</th></tr>\n</thead>\n<tbody>\n",
    );
    for check in checks {
        let (class, sign) = match check.outcome {
            Outcome::Pass => ("pass", "✓"),
            Outcome::Fail => ("fail", "✗"),
            Outcome::NotRun => ("not-run", "–"),
        };
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td>\
             <td class=\"{class}\"><span aria-hidden=\"true\">{sign}</span> {}</td></tr>\n",
            rich(&check.name),
            rich(&check.criterion),
            rich(&check.found),
            check.outcome.word()
        ));
    }
    out.push_str("</tbody>\n</table>\n</div>\n");
}

fn key_values(out: &mut String, pairs: &[(String, String)]) {
    out.push_str("<dl>\n");
    for (key, value) in pairs {
        out.push_str(&format!("<dt>{}</dt><dd>{}</dd>\n", rich(key), rich(value)));
    }
    out.push_str("</dl>\n");
}

/// Escaped text with superscripts and subscripts as elements.
fn rich(text: &str) -> String {
    let element = |(level, run): &(Level, String)| match level {
        Level::Base => escape(run),
        Level::Raised => format!("<sup>{}</sup>", escape(run)),
        Level::Lowered => format!("<sub>{}</sub>", escape(run)),
        Level::Dot => "\u{307}".to_owned(),
    };
    runs(text).iter().map(element).collect()
}
