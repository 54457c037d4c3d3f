//! Pages as HTML.

use std::collections::HashSet;

use super::content::{Counts, key_values, written};
use super::markup::{each, rich};
use super::policy::{POLICY, SCRIPT, STYLE};
use super::{Block, Page, Section};
use crate::escape::escape;

/// The whole document.
pub(crate) fn document(page: &Page) -> String {
    let ids = section_ids(page);
    let title = escape(&page.title);
    let mut counts = Counts::default();
    let subtitle = if page.subtitle.is_empty() {
        String::new()
    } else {
        format!("<p class=\"subtitle\">{}</p>\n", rich(&page.subtitle))
    };
    let first = each(&page.first, |block| written(block, &mut counts));
    let contents = contents(page, &ids);
    let open = if page.first.is_empty() { " open" } else { "" };
    let sections = each(page.sections.iter().zip(&ids), |(section, id)| {
        let blocks = each(&section.blocks, |block| written(block, &mut counts));
        let (heading, holds) = (rich(&section.heading), holds(section));
        // A link leads into the section, which opens it.
        format!(
            "<details class=\"section\"{open}>\n<summary><h2>{heading}</h2>{holds}</summary>\n\
             <section id=\"{id}\" aria-label=\"{}\">\n{blocks}</section>\n</details>\n",
            escape(&section.heading)
        )
    });
    let footer = if page.provenance.is_empty() {
        String::new()
    } else {
        format!("<footer>\n<h2>Provenance</h2>\n{}</footer>\n", key_values(&page.provenance))
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<div class=\"{}\">\n<header>\n\
         <h1>{title}</h1>\n{subtitle}</header>\n{first}{contents}</div>\n<main>\n{sections}</main>\n{footer}\
         <script>{SCRIPT}</script>\n</body>\n</html>\n",
        *POLICY,
        if page.first.is_empty() { "head" } else { "first" },
    )
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
    format!("<nav aria-label=\"Contents\">\n<ul>\n{items}</ul>\n</nav>\n")
}

/// What a section holds, for those who have not opened it.
fn holds(section: &Section) -> String {
    let (mut figures, mut tables) = (0, 0);
    let mut blocks: Vec<&Block> = section.blocks.iter().collect();
    while let Some(block) = blocks.pop() {
        match block {
            Block::Figure { .. } => figures += 1,
            Block::Table(_) | Block::Claims(_) => tables += 1,
            Block::Folded { blocks: inner, .. } => blocks.extend(inner),
            _ => {}
        }
    }
    let counted = [(figures, "figure"), (tables, "table")].into_iter().filter(|(count, _)| *count > 0);
    let counted: Vec<String> = counted.map(|(count, what)| crate::number::counted(count, what)).collect();
    if counted.is_empty() {
        String::new()
    } else {
        format!(" <span class=\"holds\">{}</span>", counted.join(", "))
    }
}
