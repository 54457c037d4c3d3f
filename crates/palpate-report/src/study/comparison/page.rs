//! The page of compared laws.

use super::{figures, tables};
use palpate::watch::Watch;

use crate::document::{ComparisonDocument, ComparisonSettingsDocument, Software};
use crate::page::{Block, Page, Section};
use crate::result::{Answer, ComparedRecord, LeftOut, parameters_table};
use crate::study::bundle::{Bundle, Drawing, FileOptions, StudyError, named};
use crate::study::{answer, findings, first_page};

/// All files of compared records: `report.html`, `comparison.json`, `comparison.md`, `tables/*.csv`, `tables.xlsx`, `figures/*.svg`.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
pub fn comparison_bundle(
    records: &[ComparedRecord],
    left_out: &[LeftOut],
    settings: ComparisonSettingsDocument,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::new(options.csv_locale);
    let laws: Vec<_> = settings.laws.iter().filter_map(|law| law.parse().ok()).collect();
    let mut page = Page::new("Laws compared", "Law of relaxation or creep to use, and its certainty");
    if records.len() > 1 {
        page = page.section(Section::new("All records").block(Block::Table(tables::of_all_records(records, &laws))));
    }
    for (index, record) in records.iter().enumerate() {
        let suffix = if records.len() == 1 { String::new() } else { format!("_{}", index + 1) };
        let summary = bundle.figures(
            first_page::figure_of_hold(record, &format!("summary{suffix}")).as_slice(),
            options,
            watch,
        )?;
        let drawings = bundle.figures(&figures::all(record, &suffix), options, watch)?;
        let found = findings::gathered_of(record, findings::MOST_LINES);
        let answer = Answer::new(record);
        let first = first_page::of_comparison(record, &answer, summary.iter().map(Drawing::block), &found);
        let mut section = Section::new(&record.input.title);
        // Of several records each has its own first page in its section.
        if records.len() == 1 {
            page = page.first(first);
            page.subtitle = record.input.title.clone();
        } else {
            section = section.blocks(first);
        }
        section = section.blocks(answer::answer_blocks(record, &answer)).blocks(blocks(record, &drawings));
        if !found.is_empty() {
            section = section
                .block(Block::Subheading("Findings".to_owned()))
                .block(Block::Findings(found.iter().map(findings::Gathered::reported).collect()));
        }
        page = page
            .section(section)
            .provenance("Record", record.input.called())
            .provenance("SHA-256", &record.input.sha256);
    }
    if !left_out.is_empty() {
        let files = left_out.iter().map(tables::left_out_line).collect();
        page = page.section(Section::new("Left out").block(Block::List(files)));
    }
    page = page.provenance("Software", Software::this().to_string());
    bundle.table(&tables::laws(records, &settings.cuts));
    bundle.text("comparison.md", tables::comparison_markdown(records, left_out, &laws));
    bundle.report(page);
    let document = ComparisonDocument::new(records, left_out, settings);
    bundle.table(&parameters_table(&document.parameter_rows()));
    bundle.json("comparison.json", &document)?;
    bundle.with_workbook()
}

/// Which law to use on the holds of a record: sentences, tables, figures.
pub(in crate::study) fn blocks(record: &ComparedRecord, drawings: &[Drawing]) -> Vec<Block> {
    let mut blocks = Vec::new();
    let judged: Vec<_> = record.verdicts().collect();
    match judged.as_slice() {
        [] => return vec![Block::paragraph("No hold has enough samples and change to compare laws on it.")],
        [(_, comparison)] => blocks.extend(tables::sentences(comparison).map(Block::Paragraph)),
        _ => {}
    }
    blocks.extend(named(drawings, ""));
    for (hold, comparison) in &judged {
        let table = tables::laws_of_hold(record, hold).map(Block::Table);
        if judged.len() > 1 {
            let sentences = tables::sentences(comparison).map(Block::Paragraph);
            blocks.push(Block::Folded {
                title: hold.title(),
                blocks: sentences.chain(table).collect(),
            });
        } else {
            blocks.extend(table);
        }
    }
    blocks.push(Block::List(tables::NOTES.map(str::to_owned).into()));
    blocks
}
