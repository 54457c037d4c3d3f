//! What a comparison of laws gives cause to say.

use crate::analysis::finding::Finding;
use crate::fit::{Fit, FitError, Termination};
use crate::forecast::Comparison;
use crate::laws::Law;
use crate::watch::Cancelled;

/// A comparison or fit; none where nothing could be fitted.
pub(in crate::analysis) fn fitted<T>(made: Result<T, FitError>) -> Result<Option<T>, Cancelled> {
    match made {
        Err(FitError::Cancelled(cancelled)) => Err(cancelled),
        made => Ok(made.ok()),
    }
}

/// What a comparison gives cause to say.
pub(super) fn comparison_findings(comparison: &Comparison) -> Vec<Finding> {
    let laws = |which: &dyn Fn(&Fit) -> bool| -> Vec<Law> {
        let fits = comparison.rows.iter().filter_map(|row| row.fit.as_ref().ok());
        fits.filter(|fit| which(fit)).map(|fit| fit.law).collect()
    };
    let at_bound = laws(&|fit| matches!(fit.termination, Termination::RateAtBound | Termination::ExponentAtBound));
    let merged = laws(&|fit| {
        matches!(fit.termination, Termination::Singular | Termination::TermsMerged) || !fit.ghosts.is_empty()
    });
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
