//! All files of the reproduced study.

use super::page;
use crate::document::ReproductionDocument;
use crate::result::Reproduction;
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
    bundle.json("summary.json", &ReproductionDocument::new(study))?;
    Ok(bundle)
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
