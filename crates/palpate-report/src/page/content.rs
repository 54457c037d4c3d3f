//! Blocks as HTML: all text is escaped here.

use super::markup::{each, rich};
use super::{Block, Card, Finding, Severity, claims};
use crate::escape::escape;
use crate::figure::View;
use crate::table::{Cell, Table, mark};
use crate::word::word;

/// Tables of at most this many rows stay on one page of paper.
const SHORT: usize = 25;
/// Tables of more characters across are set closer on paper.
const DENSE: usize = 120;

/// How many figures and tables have been written.
#[derive(Debug, Default)]
pub(super) struct Counts {
    figures: usize,
    tables: usize,
}

/// A block; figures and tables are counted.
pub(super) fn written(block: &Block, counts: &mut Counts) -> String {
    match block {
        Block::Subheading(text) => format!("<h3>{}</h3>\n", rich(text)),
        Block::Paragraph(text) => format!("<p>{}</p>\n", rich(text)),
        Block::List(items) => format!("<ul>\n{}</ul>\n", each(items, |item| format!("<li>{}</li>\n", rich(item)))),
        Block::Lede(text) => format!("<p class=\"lede\">{}</p>\n", rich(text)),
        Block::Formulas(formulas) => {
            let line = |(of, formula): &(String, String)| {
                format!("<dt>{}</dt><dd>{}</dd>\n", rich(of), formula_written(formula))
            };
            format!("<dl class=\"formulas\">\n{}</dl>\n", each(formulas, line))
        }
        Block::Notes(notes) => {
            let line = |(severity, text): &(Severity, String)| {
                let word = word(severity);
                format!("<li class=\"{word}\"><span class=\"word\">{word}</span> {}</li>\n", rich(text))
            };
            format!("<ul class=\"notes\">\n{}</ul>\n", each(notes, line))
        }
        Block::Folded { title, blocks } => {
            let blocks = each(blocks, |block| written(block, counts));
            format!("<details>\n<summary>{}</summary>\n{blocks}</details>\n", rich(title))
        }
        Block::Cards(cards) => format!("<ul class=\"cards\">\n{}</ul>\n", each(cards, card_written)),
        Block::Table(table) => {
            counts.tables += 1;
            table_written(table, counts.tables)
        }
        Block::Figure { view, caption } => {
            counts.figures += 1;
            figure_written(view, caption, counts.figures)
        }
        Block::Findings(findings) if findings.is_empty() => "<p>Nothing to report.</p>\n".to_owned(),
        Block::Findings(findings) => each(findings, finding_written),
        Block::KeyValues(pairs) => key_values(pairs),
        Block::Code(text) => format!("<pre tabindex=\"0\"><code>{}</code></pre>\n", escape(text)),
        Block::Claims(rows) => claims::written(rows),
    }
}

fn figure_written(view: &View, caption: &str, number: usize) -> String {
    let entry = |(label, sample): &(String, String)| {
        format!("<li class=\"entry\" data-series=\"{}\">{sample}{}</li>\n", escape(label), rich(label))
    };
    let legend = match &view.legend[..] {
        [] => String::new(),
        entries => format!("<ul class=\"legend\">\n{}</ul>\n", each(entries, entry)),
    };
    let narrow = view
        .narrow
        .as_ref()
        .map_or_else(String::new, |svg| format!("<div class=\"panels narrow\">\n{svg}</div>\n"));
    let wide = if view.narrow.is_some() { " wide" } else { "" };
    format!(
        "<figure id=\"figure-{number}\" class=\"columns-{}\">\n{legend}<div class=\"panels{wide}\">\n{}</div>\n{narrow}\
         <figcaption>{}</figcaption>\n</figure>\n",
        view.columns.min(3),
        view.panels.concat(),
        numbered("Figure", number, caption)
    )
}

fn card_written(card: &Card) -> String {
    let path: Vec<String> = card.path.iter().map(|part| encoded(part)).collect();
    let picture = card.picture.iter().flat_map(|view| view.panels.iter().map(String::as_str)).collect::<String>();
    let findings = card.findings.map_or_else(String::new, |(severity, count)| {
        let word = word(severity);
        let counted = crate::number::counted(count, "finding");
        format!("<p class=\"{word}\"><span class=\"word\">{word}</span> {counted}</p>\n")
    });
    let lines = each(&card.lines, |line| format!("<p>{}</p>\n", rich(line)));
    format!(
        "<li>\n<h3><a href=\"{}\">{}</a></h3>\n{picture}{lines}{findings}</li>\n",
        escape(&path.join("/")),
        rich(&card.title)
    )
}

/// A name of a file or folder as a part of an address.
fn encoded(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte);
    each(name.bytes(), |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
}

/// A formula as it is set: symbols in italics, powers raised.
fn formula_written(formula: &str) -> String {
    raised(formula, symbols)
}

/// Text with its powers raised: those in brackets, and whole numbers.
fn raised(text: &str, set: fn(&str) -> String) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, power)) = rest.split_once('^') {
        let (power, after) = match power.strip_prefix('(').and_then(|inside| inside.split_once(')')) {
            Some(parts) => parts,
            None => power.split_at(power.find(|c: char| !c.is_ascii_digit() && c != '-').unwrap_or(power.len())),
        };
        out.push_str(&format!("{}<sup>{}</sup>", set(before), set(&power.replace('-', "−"))));
        rest = after;
    }
    out + &set(rest)
}

/// Letters that are symbols where they stand alone; others are those of units.
const SYMBOLS: [&str; 6] = ["t", "F", "u", "ε", "E", "τ"];

/// Text with its symbols in italics.
fn symbols(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let of_word = |c: char| c.is_alphabetic() == first.is_alphabetic();
        let (part, after) = rest.split_at(rest.find(|c| !of_word(c)).unwrap_or(rest.len()));
        out.push_str(&if SYMBOLS.contains(&part) { format!("<i>{part}</i>") } else { rich(part) });
        rest = after;
    }
    out
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
            format!(" <span class=\"unit\">({})</span>", raised(unit, rich))
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
        "<div class=\"table{}\" id=\"table-{number}\">\n<p class=\"caption\" id=\"caption-{number}\">{}</p>\n\
         <div class=\"scroll\">\n<table aria-labelledby=\"caption-{number}\">\n<thead>\n<tr>{heads}</tr>\n</thead>\n<tbody>\n{rows}\
         </tbody>\n</table>\n</div>\n{marked}{notes}</div>\n",
        [(table.rows.len() <= SHORT, " short"), (extent(table) > DENSE, " dense")]
            .into_iter()
            .filter_map(|(is, class)| is.then_some(class))
            .collect::<String>(),
        numbered("Table", number, &table.caption)
    )
}

/// Characters of the widest cells of all columns together.
fn extent(table: &Table) -> usize {
    let widest = |column: usize| {
        let of_row = |row| table.cell(row, column).shown(1.0).chars().count();
        (0..table.rows.len()).map(of_row).max().unwrap_or(0) + 2
    };
    (0..table.columns.len()).map(widest).sum()
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

/// A caption behind its number on the page; one that begins with a number of its own, such as `Figure 4(a). `, keeps that.
fn numbered(what: &str, number: usize, caption: &str) -> String {
    let own = caption
        .strip_prefix(what)
        .and_then(|rest| rest.strip_prefix(' '))
        .and_then(|rest| rest.split_once(". "));
    match own {
        Some((own, rest)) => format!("<b>{what} {}.</b> {}", rich(own), rich(rest)),
        None => format!("<b>{what} {number}.</b> {}", rich(caption)),
    }
}

pub(super) fn key_values(pairs: &[(String, String)]) -> String {
    let items = each(pairs, |(key, value)| format!("<dt>{}</dt><dd>{}</dd>\n", rich(key), rich(value)));
    format!("<dl>\n{items}</dl>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_have_symbols_in_italics_and_powers_raised() {
        let set = formula_written("F(t) = 2.5 N · (1 + t/3 s)^(−1/4) + exp(−t)");
        assert_eq!(set, "<i>F</i>(<i>t</i>) = 2.5 N · (1 + <i>t</i>/3 s)<sup>−1/4</sup> + exp(−<i>t</i>)");
        assert_eq!(formula_written("6.5 s⁻¹ · E₁(t)"), "6.5 s<sup>−1</sup> · <i>E</i><sub>1</sub>(<i>t</i>)");
        assert_eq!(raised("N^-4/s", rich), "N<sup>−4</sup>/s");
        assert_eq!(raised("N^(1-n)/s <b>^", rich), "N<sup>1−n</sup>/s &lt;b&gt;<sup></sup>");
    }

    #[test]
    fn names_of_folders_are_parts_of_an_address() {
        assert_eq!(encoded("a b/\"ä"), "a%20b%2F%22%C3%A4");
    }
}
