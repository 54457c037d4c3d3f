//! Pages as HTML.

use std::collections::HashSet;

use super::{Block, Check, Finding, Page};
use crate::escape::escape;
use crate::script::{Level, runs};
use crate::table::{Cell, Table, mark};
use crate::word::word;

/// Tables of at most this many rows stay on one page of paper.
const SHORT: usize = 25;
const STYLE: &str = include_str!("style.css");

/// The whole document.
pub(crate) fn document(page: &Page) -> String {
    let ids = section_ids(page);
    let title = escape(&page.title);
    let subtitle = format!("<p class=\"subtitle\">{}</p>\n", rich(&page.subtitle));
    let footer = format!("<footer>\n<h2>Provenance</h2>\n{}</footer>\n", key_values(&page.provenance));
    let (mut figures, mut tables) = (0, 0);
    let sections = each(page.sections.iter().zip(&ids), |(section, id)| {
        let blocks = each(&section.blocks, |block| written(block, &mut figures, &mut tables));
        let heading = rich(&section.heading);
        format!("<section aria-labelledby=\"{id}\">\n<h2 id=\"{id}\">{heading}</h2>\n{blocks}</section>\n")
    });
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n\
         <h1>{title}</h1>\n{}</header>\n{}<main>\n{sections}</main>\n{}</body>\n</html>\n",
        if page.subtitle.is_empty() { "" } else { &subtitle },
        contents(page, &ids),
        if page.provenance.is_empty() { "" } else { &footer }
    )
}

/// What is written of each of several things, one after the other.
fn each<T>(things: impl IntoIterator<Item = T>, written: impl FnMut(T) -> String) -> String {
    things.into_iter().map(written).collect()
}

/// One anchor for each section: letters, digits and hyphens, no two alike.
fn section_ids(page: &Page) -> Vec<String> {
    let mut taken = HashSet::new();
    page.sections
        .iter()
        .map(|section| {
            let heading = section.heading.to_lowercase();
            let words: String = heading.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' }).collect();
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

fn contents(page: &Page, ids: &[String]) -> String {
    if page.sections.len() < 2 {
        return String::new();
    }
    let items = each(page.sections.iter().zip(ids), |(section, id)| {
        format!("<li><a href=\"#{id}\">{}</a></li>\n", rich(&section.heading))
    });
    format!("<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n{items}</ol>\n</nav>\n")
}

/// A block; figures and tables are counted.
fn written(block: &Block, figures: &mut usize, tables: &mut usize) -> String {
    match block {
        Block::Subheading(text) => format!("<h3>{}</h3>\n", rich(text)),
        Block::Paragraph(text) => format!("<p>{}</p>\n", rich(text)),
        Block::List(items) => format!("<ul>\n{}</ul>\n", each(items, |item| format!("<li>{}</li>\n", rich(item)))),
        Block::Table(table) => {
            *tables += 1;
            table_written(table, *tables)
        }
        Block::Figure { svg, caption } => {
            *figures += 1;
            let (number, caption) = (figures, rich(caption));
            format!(
                "<figure id=\"figure-{number}\">\n{svg}<figcaption><b>Figure {number}.</b> {caption}</figcaption>\n</figure>\n"
            )
        }
        Block::Findings(findings) if findings.is_empty() => "<p>Nothing to report.</p>\n".to_owned(),
        Block::Findings(findings) => each(findings, finding_written),
        Block::KeyValues(pairs) => key_values(pairs),
        Block::Code(text) => format!("<pre tabindex=\"0\"><code>{}</code></pre>\n", escape(text)),
        Block::Checks(checks) => checks_written(checks),
    }
}

fn table_written(table: &Table, number: usize) -> String {
    let reasons = table.reasons();
    let class = |column: usize| if table.is_numeric(column) { " class=\"n\"" } else { "" };
    let classes: Vec<&str> = (0..table.columns.len()).map(class).collect();
    let units = table.units();
    let heads = each(table.columns.iter().zip(&classes).zip(&units), |((column, class), (unit, _))| {
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" <span class=\"unit\">({})</span>", rich(unit))
        };
        format!("<th scope=\"col\"{class}>{}{unit}</th>", rich(&column.heading))
    });
    let rows = each(0..table.rows.len(), |row| {
        let cells = each(classes.iter().enumerate(), |(column, class)| {
            format!("<td{class}>{}</td>", cell(table.cell(row, column), units[column].1, &reasons))
        });
        format!("<tr>{cells}</tr>\n")
    });
    let marked = each(reasons.iter().enumerate(), |(i, reason)| {
        format!("<p class=\"note\"><sup>{}</sup> {}</p>\n", mark(i), rich(reason))
    });
    let notes = each(&table.notes, |note| format!("<p class=\"note\">{}</p>\n", rich(note)));
    format!(
        "<div class=\"table{}\" id=\"table-{number}\">\n<table>\n\
         <caption><b>Table {number}.</b> {}</caption>\n<thead>\n<tr>{heads}</tr>\n</thead>\n<tbody>\n{rows}\
         </tbody>\n</table>\n{marked}{notes}</div>\n",
        if table.rows.len() <= SHORT { " short" } else { "" },
        rich(&table.caption)
    )
}

fn cell(cell: &Cell, factor: f64, reasons: &[&str]) -> String {
    let text = rich(&cell.shown(factor));
    match cell.reason_in(reasons) {
        Some(i) => format!("{text}<sup>{}</sup>", mark(i)),
        None => text,
    }
}

fn finding_written(finding: &Finding) -> String {
    let word = word(finding.severity);
    let advice = [("May mean", &finding.meaning), ("What helps", &finding.remedy)];
    let advice = each(advice.into_iter().filter(|(_, text)| !text.is_empty()), |(name, text)| {
        format!("<p><i>{name}:</i> {}</p>\n", rich(text))
    });
    format!(
        "<div class=\"finding {word}\">\n<p class=\"head\"><span class=\"word\">{word}</span> \
         <code>{}</code></p>\n<p>{}</p>\n{advice}</div>\n",
        escape(&finding.code),
        finding.observation.lines().map(rich).collect::<Vec<_>>().join("<br>\n")
    )
}

fn checks_written(checks: &[Check]) -> String {
    let rows = each(checks, |check| {
        let (outcome, sign) = if check.passed { ("pass", "✓") } else { ("fail", "✗") };
        let [name, criterion, found] = [&check.name, &check.criterion, &check.found].map(|text| rich(text));
        format!(
            "<tr><th scope=\"row\">{name}</th><td>{criterion}</td><td>{found}</td>\
             <td class=\"{outcome}\"><span aria-hidden=\"true\">{sign}</span> {outcome}</td></tr>\n"
        )
    });
    format!(
        "<div class=\"table short\">\n<table class=\"checks\">\n<thead>\n<tr><th scope=\"col\">Check</th>\
         <th scope=\"col\">Criterion</th><th scope=\"col\">Found</th>\
         <th scope=\"col\">Outcome</th></tr>\n</thead>\n<tbody>\n{rows}</tbody>\n</table>\n</div>\n"
    )
}

fn key_values(pairs: &[(String, String)]) -> String {
    let items = each(pairs, |(key, value)| format!("<dt>{}</dt><dd>{}</dd>\n", rich(key), rich(value)));
    format!("<dl>\n{items}</dl>\n")
}

/// Escaped text with superscripts and subscripts as elements.
fn rich(text: &str) -> String {
    let element = |(level, run): &(Level, String)| match level {
        Level::Base => escape(run),
        Level::Raised => format!("<sup>{}</sup>", escape(run)),
        Level::Lowered => format!("<sub>{}</sub>", escape(run)),
        Level::Dot => "\u{307}".to_owned(),
    };
    each(&runs(text), element)
}
