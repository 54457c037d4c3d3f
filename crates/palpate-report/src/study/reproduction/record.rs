//! Page and files of a record of one's own, in the layout of the study.

use palpate::analysis::{Analysis, HoldAnalysis};
use palpate::paper::Claim;
use palpate::segment::After;
use palpate::watch::Watch;

use super::numbering::Placed;
use super::{claims, hold_figures, hold_tables};
use crate::document::{ReproducedRecordDocument, Software};
use crate::figure::{Figure, Role};
use crate::page::{Block, Page, Section};
use crate::result::Input;
use crate::study::bundle::{Bundle, FileOptions, StudyError};
use crate::table::Table;

/// The holds after loading or after unloading.
fn holds(analysis: &Analysis, after: After) -> Vec<&HoldAnalysis> {
    analysis.holds.iter().filter(|hold| hold.after == Some(after)).collect()
}

fn figures(analysis: &Analysis) -> Vec<Figure> {
    let record = &analysis.record;
    let all: Vec<&HoldAnalysis> = analysis.holds.iter().collect();
    let (loading, unloading) = (holds(analysis, After::Loading), holds(analysis, After::Unloading));
    let uniform = |d: f64| {
        let specimen = analysis.specimen.as_ref();
        specimen.map_or(f64::NAN, |specimen| specimen.equilibrium_strain(specimen.contact_displacement(d)))
    };
    let rates = |after: &str| {
        format!(
            "Rate over strain in the holds after {after}: the derivative (points), the law with n = 5 fitted to them as in the paper, and the closed form fitted over time. Compressive strain is negative, as in the paper."
        )
    };
    let displacement = record.displacement();
    let mut figures = vec![hold_figures::protocol(
        "figure_4",
        "Measured force, and displacement where it was recorded.",
        record.time(),
        record.force(),
        displacement,
        Role::Measured,
    )];
    figures.extend(hold_figures::rates("figure_6a", &rates("loading"), &loading));
    figures.extend(hold_figures::rates("figure_6b", &rates("unloading"), &unloading));
    figures.extend(hold_figures::beside("figure_8", analysis));
    let text = "Rate coefficient v with n = 5 over the equilibrium of each hold; bars: standard errors.";
    figures.extend(hold_figures::rate_coefficients("rate_coefficients", text, &all));
    let text = "Equilibrium strain with n = 5 over the displacement, after loading and after unloading, with that of uniform strain; bars: standard errors.";
    figures.extend(hold_figures::equilibria("equilibria", text, &all, uniform));
    figures
}

fn tables(analysis: &Analysis) -> Vec<Table> {
    let law = |name: &str, after: After, word: &str| {
        let text = format!("The law with n = 5 fitted to the holds after {word}.");
        hold_tables::law(name, &text, &holds(analysis, after), None)
            .note("Compressive strain is negative, as in the paper.")
    };
    let tables = [law("table_1", After::Loading, "loading"), law("table_2", After::Unloading, "unloading")];
    let tables = tables.into_iter().filter(|table| !table.rows.is_empty());
    tables.chain(hold_tables::orders(analysis, "orders")).collect()
}

fn page(judged: &[Claim], input: &Input, placed: &mut Placed<'_>) -> (Page, Table) {
    let mut of = |figures: &[&str], tables: &[&str]| -> Vec<Block> {
        let figures: Vec<Block> = figures.iter().flat_map(|name| placed.figures(name)).collect();
        figures.into_iter().chain(tables.iter().filter_map(|name| placed.table(name))).collect()
    };
    let record = of(&["figure_4", "figure_8"], &[]);
    let rates = of(&["figure_6a", "figure_6b"], &["table_1", "table_2", "orders"]);
    let trends = of(&["rate_coefficients", "equilibria"], &[]);
    let link = |evidence| placed.link(evidence);
    let mismatches = claims::mismatches(judged);
    let mut first =
        Section::new("What the paper concludes, on this record").block(Block::paragraph(claims::counted(judged)));
    if !mismatches.is_empty() {
        first = first.block(Block::List(mismatches));
    }
    let first = first.block(Block::Claims(claims::rows(judged, link)));
    let table = claims::table(judged, link);
    let page = Page::new(&input.title, "In the layout of the paper on the nonlinear latency law")
        .section(first)
        .section(Section::new("The record").blocks(record))
        .section(Section::new("Strain rate against strain").blocks(rates))
        .section(Section::new("Rate coefficient and equilibrium").blocks(trends))
        .provenance("Record", input.called())
        .provenance("SHA-256", &input.sha256);
    let page = match &input.test {
        Some(test) => page.provenance("Test description", test),
        None => page,
    };
    (page.provenance("Software", Software::this().to_string()), table)
}

/// All files of a record in the layout of the paper.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
pub fn record_reproduction_bundle(
    analysis: &Analysis,
    judged: &[Claim],
    input: &Input,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::new(options.csv_locale);
    let drawings = bundle.figures(&figures(analysis), options, watch)?;
    let tables = tables(analysis);
    tables.iter().for_each(|table| bundle.table(table));
    let (page, table) = page(judged, input, &mut Placed::new(&drawings, &tables));
    bundle.table(&table);
    bundle.report(page);
    bundle.json("summary.json", &ReproducedRecordDocument::new(analysis, judged, input))?;
    bundle.with_workbook()
}
