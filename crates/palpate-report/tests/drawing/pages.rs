//! Pages observed from outside: complete, escaped, and without anything fetched.

use palpate::paper::Verdict;
use palpate_report::figure::{Axis, Figure, Layer, Panel, Role};
use palpate_report::page::{Block, ClaimLine, ClaimRow, Finding, Page, Section, Severity};
use palpate_report::table::{Cell, Table};

const HOSTILE: &str = "<script>alert('&')</script>";

fn page() -> String {
    let panel = Panel::new(Axis::linear(HOSTILE, HOSTILE), Axis::linear("y", "N"))
        .layer(Layer::line(vec![0.0, 1.0], vec![0.0, 1.0], Role::Measured).label(HOSTILE));
    let figure = Figure::new("f", HOSTILE).panel(panel);
    let table = Table::new("t", HOSTILE)
        .column(HOSTILE, "a", HOSTILE)
        .column("Rate", "rate_per_s", "1/s")
        .row(vec![Cell::text(HOSTILE), Cell::Number(-1.5e-7, 2)])
        .row(vec![Cell::text("b"), Cell::missing(HOSTILE)])
        .note(HOSTILE);
    let text = || HOSTILE.to_owned();
    let finding = Finding {
        severity: Severity::Caution,
        code: text(),
        observation: text(),
        meaning: text(),
        remedy: text(),
    };
    let line = ClaimLine {
        quantity: text(),
        paper: text(),
        ours: text(),
        tolerance: text(),
    };
    let claim = |lines| ClaimRow {
        place: text(),
        statement: text(),
        lines,
        remark: text(),
        verdict: Verdict::NotReproduced,
        shown_in: Some((text(), text())),
    };
    Page::new(HOSTILE, HOSTILE)
        .section(
            Section::new("Results")
                .block(Block::Subheading(text()))
                .block(Block::paragraph(HOSTILE))
                .block(Block::List(vec![text()]))
                .block(Block::figure(&figure).expect("a drawing"))
                .block(Block::figure(&figure).expect("a drawing"))
                .block(Block::Table(table)),
        )
        .first([
            Block::Lede(text()),
            Block::Formulas(vec![(text(), text())]),
            Block::Notes(vec![(Severity::Warning, text())]),
            Block::Folded {
                title: text(),
                blocks: vec![Block::paragraph(HOSTILE)],
            },
        ])
        .section(
            Section::new("Results")
                .block(Block::Findings(vec![finding]))
                .block(Block::Findings(vec![]))
                .block(Block::KeyValues(vec![(text(), text())]))
                .block(Block::Claims(vec![claim(vec![line.clone(), line]), claim(Vec::new())]))
                .block(Block::Code(text())),
        )
        .provenance(HOSTILE, HOSTILE)
        .to_html()
}

#[test]
fn no_text_reaches_the_page_as_markup() {
    let html = page();
    // The one script is ours.
    assert_eq!((html.matches("<script").count(), html.matches("</script").count()), (1, 1));
    assert!(html.contains("&lt;script&gt;"));
    assert_eq!(html, page());
}

#[test]
fn nothing_is_fetched_from_elsewhere() {
    let html = page().replace("http://www.w3.org/2000/svg", "");
    for word in ["http:", "https:", "@import", "url(", "<link"] {
        assert!(!html.contains(word), "{word}");
    }
}

#[test]
fn anchors_are_unique_and_numbers_run_on() {
    let html = page();
    let ids: Vec<&str> = html.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(ids, ["results", "figure-1", "figure-2", "table-1", "caption-1", "results-2"]);
    assert!(html.contains("<b>Figure 2.</b>") && html.contains("href=\"#results-2\""));
}

#[test]
fn a_caption_keeps_a_number_of_its_own() {
    let panel = || Panel::new(Axis::linear("x", ""), Axis::linear("y", ""));
    let figure = |caption: &str| Block::figure(&Figure::new("f", caption).panel(panel())).expect("a drawing");
    let section = Section::new("A").block(figure("Figure 4(a). As printed.")).block(figure("Figured out. Not so."));
    let html = Page::new("A", "")
        .section(section.block(Block::Table(Table::new("t", "Table II. More."))))
        .to_html();
    assert!(html.contains("<b>Figure 4(a).</b> As printed.") && html.contains("id=\"figure-1\""), "{html}");
    assert!(html.contains("<b>Figure 2.</b> Figured out. Not so.") && html.contains("<b>Table II.</b> More."));
}

#[test]
fn tables_are_accessible_and_typeset() {
    let html = page();
    assert!(html.contains("<th scope=\"col\" class=\"n\">Rate <span class=\"unit\">(1/s)</span>"));
    assert!(html.contains("<td class=\"n\">−1.5×10<sup>−7</sup></td>"));
    assert!(html.contains("<td class=\"n\">–<sup>a</sup></td>"));
    assert!(html.contains("role=\"img\""));
}
