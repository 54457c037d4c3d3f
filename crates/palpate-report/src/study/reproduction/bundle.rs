//! All files of the reproduced study.

use palpate::segment::After;
use palpate::test_problems::PAPER_RATE;

use super::page;
use crate::document::{AnalysisDocument, ReproductionDocument, Software};
use crate::result::{Input, ReproducedTest, Reproduction};
use crate::study::bundle::{Bundle, Pictures, StudyError};

/// All files of the reproduced study.
///
/// # Errors
/// [`StudyError`] when a figure or document cannot be made.
pub fn reproduction_bundle(study: &Reproduction, pictures: Pictures) -> Result<Bundle, StudyError> {
    let mut bundle = Bundle::default();
    let figures = page::figures(study);
    for figure in &figures {
        bundle.figure(figure, pictures)?;
    }
    let tables = page::tables(study);
    for table in &tables {
        bundle.table(table);
    }
    for (name, test) in [("a", &study.test_a), ("b", &study.test_b)] {
        bundle.series(&format!("test_{name}_bonded"), &test.bonded)?;
        bundle.series(&format!("test_{name}_unilateral"), &test.unilateral)?;
    }
    bundle.text("report.html", page::page(study, &figures, &tables)?.to_html());
    bundle.json("summary.json", &reproduction_document(study))?;
    Ok(bundle)
}

/// The summary of the study.
#[must_use]
pub fn reproduction_document(study: &Reproduction) -> ReproductionDocument {
    let rows = |test: &ReproducedTest, after: After| {
        let input = Input {
            path: String::new(),
            sha256: String::new(),
            part: None,
            rows_averaged: 1,
            rows: 0,
            test: None,
            title: String::new(),
        };
        let tables = AnalysisDocument::new(&test.analysis, input).tables;
        tables.map_or(Vec::new(), |tables| if after == After::Loading { tables.loading } else { tables.unloading })
    };
    let depth = study.model.specimen.depth();
    ReproductionDocument {
        schema: "palpate.reproduction/1".to_owned(),
        radius_m: depth,
        modulus_pa: study.model.specimen.modulus(),
        exponent: study.model.law.exponent(),
        rate_coefficient_per_s: study.model.law.rate_coefficient(),
        layers: study.model.layers.count(),
        rate_m_per_s: PAPER_RATE,
        table_1: rows(&study.test_a, After::Loading),
        table_2: rows(&study.test_b, After::Unloading),
        largest_rate_coefficient_error: study.largest_coefficient_error(),
        checks: study.checks.clone(),
        all_passed: study.all_passed(),
        software: Software::this(),
    }
}

/// Every check in two lines.
#[must_use]
pub fn reproduction_text(study: &Reproduction) -> String {
    let mut text = String::from("What the paper reports, checked on its simulated and re-identified tests:\n\n");
    for check in &study.checks {
        let word = if check.passed { "pass" } else { "FAIL" };
        text.push_str(&format!("  {word}  {}\n        {}\n", check.name, check.found));
    }
    text
}
