//! The page of a planned grip.

use super::figure::grip_figure;
use super::tables::{grip_table, neighbour_table, schedule_table, sensitivity_table};
use palpate::analysis::Severity;
use palpate::watch::Unwatched;

use crate::document::{GripDocument, Software};
use crate::page::{Block, Page, Section};
use crate::result::GrippedBody;
use crate::study::bundle::{Bundle, Drawing, FileOptions, StudyError};
use crate::study::calibration::{material_table, write_prediction};

/// All files of a planned grip: `report.html`, `grip.json`, `tables/*.csv`, `tables.xlsx`, `figures/grip.svg`, `series/*.csv`.
///
/// # Errors
/// [`StudyError`] when the figure or document cannot be made.
pub fn grip_bundle(body: &GrippedBody<'_>, options: &FileOptions) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::new(options.csv_locale);
    let mut verdict = Section::new("Will it hold?")
        .block(Block::Paragraph(body.question()))
        .blocks(body.misfit_sentence().map(|misfit| Block::Notes(vec![(Severity::Warning, misfit)])))
        .block(Block::Paragraph(body.verdict()));
    let grips = grip_table(body);
    if !grips.rows.is_empty() {
        let drawings = bundle.figures(&[grip_figure(body, "grip")], options, &mut Unwatched)?;
        bundle.table(&grips);
        verdict = verdict.blocks(drawings.iter().map(Drawing::block)).block(Block::Table(grips));
    }
    verdict = verdict.block(Block::List(body.notes()));
    let mut page = Page::new("Grip", "Time to slip and closing motion").section(verdict);
    let sections = [
        ("Alternative squeezes", neighbour_table(body)),
        ("Overshoot and back off", sensitivity_table(body)),
        ("Squeeze again", schedule_table(body)),
        ("Material", Some(material_table(body.grip.material()))),
    ];
    for (heading, table) in sections {
        let Some(table) = table else { continue };
        bundle.table(&table);
        page = page.section(Section::new(heading).block(Block::Table(table)));
    }
    for (name, course) in ["squeeze", "back_off", "force_held", "schedule"].into_iter().zip(body.grips()) {
        let Some(Ok(course)) = course else { continue };
        bundle.series(name, write_prediction, course)?;
    }
    page = page
        .provenance("Material", &body.path)
        .provenance("SHA-256", &body.sha256)
        .provenance("Software", Software::this().to_string());
    bundle.report(page);
    bundle.json("grip.json", &GripDocument::new(body))?;
    bundle.with_workbook()
}
