//! What a comparison of laws gives cause to say.

use crate::analysis::finding::Finding;
use crate::fit::{Fit, FitError, Termination};
use crate::forecast::Comparison;
use crate::laws::Law;
use crate::watch::Cancelled;

/// A comparison; none where nothing could be fitted.
pub(super) fn compared(made: Result<Comparison, FitError>) -> Result<Option<Comparison>, Cancelled> {
    match made {
        Err(FitError::Cancelled(cancelled)) => Err(cancelled),
        made => Ok(made.ok()),
    }
}

/// What a comparison gives cause to say.
pub(super) fn comparison_findings(comparison: &Comparison) -> Vec<Finding> {
    let ended = |termination: &[Termination]| -> Vec<Law> {
        let fits = comparison.rows.iter().filter_map(|row| row.fit.as_ref().ok());
        fits.filter(|fit| termination.contains(&fit.termination)).map(|fit| fit.law).collect()
    };
    let at_bound = ended(&[Termination::RateAtBound, Termination::ExponentAtBound]);
    let fits = comparison.rows.iter().filter_map(|row| row.fit.as_ref().ok());
    let none = |fit: &&Fit| {
        matches!(fit.termination, Termination::Singular | Termination::TermsMerged) || !fit.ghosts.is_empty()
    };
    let merged: Vec<Law> = fits.filter(none).map(|fit| fit.law).collect();
    // A law that contains the chosen one must do as well.
    let alike = comparison.verdict.as_ref().map_or_else(Vec::new, |verdict| {
        let rivals = verdict.alike.iter().filter(|law| !law.contains(verdict.law));
        [verdict.law].iter().chain(rivals).copied().collect()
    });
    let mut findings = Vec::new();
    if !at_bound.is_empty() {
        findings.push(Finding::ParametersAtBound { laws: at_bound });
    }
    if !merged.is_empty() {
        findings.push(Finding::TermsIndistinguishable { laws: merged });
    }
    if alike.len() > 1 {
        findings.push(Finding::LawsIndistinguishable { laws: alike });
    }
    findings
}
