//! The order in which findings are stated.

use super::Finding;

impl Finding {
    /// The order in which findings are stated: the severest first. Of equal severity those come first by which no law of relaxation applies, then
    /// those about where the law to use ends, then all others, and last those about parameters that the data leave open, often of a law that is
    /// not to be used.
    #[must_use]
    pub fn rank(&self) -> impl Ord + use<> {
        let place = match self {
            Self::DriftInsteadOfRelaxation { .. }
            | Self::NothingHeld { .. }
            | Self::FeedbackControlled { .. }
            | Self::ForceStep { .. }
            | Self::DriveChanges { .. } => 0,
            Self::EquilibriumExtrapolated { .. }
            | Self::EquilibriumByLaw { .. }
            | Self::EquilibriumBeyondZero { .. }
            | Self::RecoveryBeyondOriginal { .. }
            | Self::TimeBeyondHold { .. } => 1,
            Self::ExponentUndetermined { .. }
            | Self::ExponentsIndistinguishable { .. }
            | Self::ExponentListExtended { .. }
            | Self::ExponentNotListed { .. }
            | Self::ExponentConfounded { .. }
            | Self::RateAtBound { .. }
            | Self::ParametersAtBound { .. }
            | Self::TermsIndistinguishable { .. } => 3,
            _ => 2,
        };
        (std::cmp::Reverse(self.severity()), place)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::finding::{Finding, Severity};
    use crate::laws::{Law, Response};

    /// The two cautions of a seal that a terminal shows were of exponents of a law that was not to be used; that 5 % of the relaxation lay beyond
    /// the end of the hold stood below.
    #[test]
    fn where_the_law_ends_is_stated_before_exponents_that_are_open() {
        let mut findings = [
            Finding::ExponentConfounded { correlation: 0.999 },
            Finding::ExponentUndetermined { interval: None },
            Finding::Gaps {
                count: 1,
                longest: 2.0,
                from: 3.0,
            },
            Finding::EquilibriumExtrapolated {
                law: Law::StandardLinearSolid,
                beyond: 0.05,
                response: Response::Relaxation,
            },
        ];
        assert!(findings.iter().all(|finding| finding.severity() == Severity::Caution));
        findings.sort_by_key(Finding::rank);
        let codes = findings.map(|finding| finding.code());
        assert_eq!(codes, ["equilibrium_extrapolated", "gaps", "exponent_confounded", "exponent_undetermined"]);
    }

    #[test]
    fn a_drift_is_stated_before_what_fits_to_it_show() {
        // A force that rose after loading was stated after two cautions about fits of laws that relax.
        let mut findings = [
            Finding::EquilibriumExtrapolated {
                law: Law::StandardLinearSolid,
                beyond: 1.0,
                response: Response::Relaxation,
            },
            Finding::OneHold,
            Finding::DriftInsteadOfRelaxation { rise: 0.5, fall: 0.0 },
            Finding::NoContactArea,
            Finding::ForceStep {
                time: 30.0,
                step: -2.0,
                gap: 0.0,
            },
        ];
        findings.sort_by_key(Finding::rank);
        let codes = findings.map(|finding| finding.code());
        let first = ["no_contact_area", "drift_instead_of_relaxation", "force_step"];
        assert_eq!(codes, [first[0], first[1], first[2], "equilibrium_extrapolated", "one_hold"]);
    }
}
