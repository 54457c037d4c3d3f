//! Page and files of the study.

use palpate::analysis::HoldAnalysis;
use palpate::paper::{ReproducedTest, Reproduction};
use palpate::segment::After;
use palpate::watch::Watch;

use super::numbering::{Placed, caption};
use super::{claims, hold_figures, hold_tables, law_figures, study_figures, study_tables};
use crate::document::{ReproductionDocument, Software};
use crate::figure::{Figure, Role};
use crate::page::{Block, Page, Section};
use crate::study::bundle::{Bundle, FileOptions, StudyError};
use crate::study::simulate::{wave_figure, write_trajectory};
use crate::table::Table;

/// Title of the paper.
const PAPER: &str = "Study of the Relationship Between the Strain and Strain Rate for Viscoelastic Contact Interface in Robotic Grasping";

/// Holds of a test after loading or after unloading.
fn holds(test: &ReproducedTest, after: After) -> Vec<&HoldAnalysis> {
    test.loaded().filter(|hold| hold.after == Some(after)).collect()
}

fn figures(study: &Reproduction) -> Vec<Figure> {
    let law = study.model.law;
    let protocol = |name: &str, test: &ReproducedTest, text: &str| {
        let series = &test.bonded;
        hold_figures::protocol(name, text, &series.time, &series.force, Some(&series.displacement), Role::Series(0))
    };
    let wave = "Strain of all layers in test (a), from the contact (layer 1) to the plane of symmetry. A new displacement strains the contact layer first and then the layers behind it. Compression is positive here.";
    let mut figures = vec![
        law_figures::types(law, 0.133, 0.3),
        law_figures::law(law, 0.15),
        law_figures::closed_form(),
        protocol(
            "figure_4a",
            &study.test_a,
            "Test (a): 5, 10, 15, 20 and 25 mm at 500 mm/min, each held for 10 s. Simulated; the measured force is in the paper's picture alone.",
        ),
        protocol(
            "figure_4b",
            &study.test_b,
            "Test (b): 25 mm, then back by 20, 15, 10 and 5 mm at 500 mm/min, each held for 10 s. Simulated; the measured force is in the paper's picture alone.",
        ),
        wave_figure("figure_7", &study.test_a.wave, &caption("figure_7", wave)),
        study_figures::last_unloading(study),
        study_figures::equilibria(study),
        study_figures::sensitivities(study),
        study_figures::rate_coefficients(study),
    ];
    let all_b: Vec<&HoldAnalysis> = study.test_b.loaded().collect();
    let text = "Strain rate over strain in the holds of the simulated test, compression negative as in the paper: the derivative of the strain (points), the law with n = 5 fitted to them as in the paper, and the closed form fitted over time.";
    figures.extend(hold_figures::rates("figure_6a", text, &holds(&study.test_a, After::Loading)));
    figures.extend(hold_figures::rates("figure_6b", text, &all_b));
    figures.extend(study_figures::forces_by_step(study));
    figures
}

fn tables(study: &Reproduction) -> Vec<Table> {
    let note = "Compression is negative, as in the paper. The simulation has one v for all holds and εₑ = −u₁/r; the fits find both again, which shows that the fits are right, not that the paper is.";
    let mut tables = study_tables::all(study);
    let first = "The law with n = 5 fitted to the simulated test (a), beside the numbers of the paper's Table I.";
    let second = "The law with n = 5 fitted to the simulated test (b) after unloading. No number of the paper's Table II is legible.";
    tables.push(
        hold_tables::law("table_1", first, &holds(&study.test_a, After::Loading), Some(&study.published)).note(note),
    );
    tables.push(hold_tables::illegible("table_2", second, &holds(&study.test_b, After::Unloading)).note(note));
    tables
}

fn section(heading: &str, blocks: impl IntoIterator<Item = Block>) -> Section {
    Section::new(heading).blocks(blocks)
}

/// The page, and the claims as a table with what shows them.
fn page(study: &Reproduction, placed: &mut Placed<'_>) -> (Page, Table) {
    let model = &study.model;
    let mut text_of = |parts: &[&str]| -> Vec<Block> {
        let of = |part: &&str| match part.strip_prefix("table ") {
            Some(name) => placed.table(name).into_iter().collect::<Vec<Block>>(),
            None => placed.figures(part),
        };
        parts.iter().flat_map(of).collect()
    };
    let gap = section("Where the simulation and Table I part", [Block::paragraph(
        "The simulation lets every layer tend to uniform strain, so that εₑ is proportional to the displacement. The strains of Table I are not: they are larger at small displacements, and smaller at the largest. Used as a law that varies from step to step, they give the forces below.",
    )])
    .blocks(text_of(&["forces_by_step", "table forces_by_step", "equilibria", "table explanations"]));
    let labs = section("What laboratories would have concluded", [Block::paragraph(
        "Laboratories with the paper's load cell and displacement sensor repeat both tests on a ball that obeys one law, on balls that obey Table I, and on a linear viscoelastic ball for which the law is not made. Each draws the paper's conclusions, or does not.",
    )])
    .blocks(text_of(&["table laboratories", "table orders", "rate_coefficients"]));
    let law = section("The law", text_of(&["figure_1", "figure_2", "closed_form"]));
    let tests = section("The two tests", text_of(&["figure_4a", "figure_4b", "figure_8", "table last_unloading"]));
    let rates =
        section("Strain rate against strain", text_of(&["figure_6a", "figure_6b", "table table_1", "table table_2"]));
    let wave = section("The strain wave", text_of(&["figure_7"]));
    let sensitivity = section("Sensitivity", text_of(&["sensitivities", "table sensitivities"]));
    let link = |evidence| placed.link(evidence);
    let table = claims::table(&study.claims, link);
    let first = Section::new("What does not match")
        .block(Block::paragraph(claims::counted(&study.claims)))
        .block(Block::List(claims::mismatches(&study.claims)));
    let all = Section::new("Claim by claim")
        .block(Block::paragraph(
            "Equations, figures, tables and sections have the paper's numbers, and compressive strain is negative as in its tables. A statement is reproduced where every comparison holds within its tolerance.",
        ))
        .block(Block::Claims(claims::rows(&study.claims, link)))
        .block(Block::KeyValues(vec![
            ("Ball".to_owned(), format!("radius {:.0} mm, modulus {:.0} kPa", 1e3 * model.specimen.depth(), model.specimen.modulus() / 1e3)),
            ("Law".to_owned(), format!("n = {}, v = {:.0} s⁻¹ (step 3 of Table I; the paper states none for its simulation)", model.law.exponent(), model.law.rate_coefficient())),
            ("Layers".to_owned(), format!("{}", model.layers.count())),
            ("Jaw".to_owned(), "500 mm/min, holds of 10 s; each contact takes half of the travel".to_owned()),
        ]));
    let page = Page::new(PAPER, "Claim by claim: the study of Tsai, Kao and others, simulated, analysed and repeated")
        .section(first)
        .section(all)
        .section(gap)
        .section(labs)
        .section(sensitivity)
        .section(law)
        .section(tests)
        .section(rates)
        .section(wave)
        .provenance("Source", PAPER)
        .provenance("Software", Software::this().to_string());
    (page, table)
}

/// All files of the study.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made, or the watch ends it.
pub fn reproduction_bundle(
    study: &Reproduction,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::new(options.csv_locale);
    let drawings = bundle.figures(&figures(study), options, watch)?;
    let tables = tables(study);
    tables.iter().for_each(|table| bundle.table(table));
    for (name, test) in [("a", &study.test_a), ("b", &study.test_b)] {
        bundle.series(&format!("test_{name}_bonded"), write_trajectory, &test.bonded)?;
        bundle.series(&format!("test_{name}_unilateral"), write_trajectory, &test.unilateral)?;
    }
    let (page, claims) = page(study, &mut Placed::new(&drawings, &tables));
    bundle.table(&claims);
    bundle.report(page);
    bundle.json("summary.json", &ReproductionDocument::new(study))?;
    bundle.with_workbook()
}

/// Every claim, and what laboratories conclude.
#[must_use]
pub fn reproduction_text(study: &Reproduction) -> String {
    claims::claims_text(&study.claims)
}
