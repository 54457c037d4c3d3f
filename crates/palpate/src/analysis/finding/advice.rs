//! What a finding may mean, and what helps.

use super::Finding;
use crate::fit::TrendVerdict;

impl Finding {
    /// What it may mean.
    #[must_use]
    pub fn meaning(&self) -> &'static str {
        match self {
            Self::EquilibriumExtrapolated { .. } => {
                "the equilibrium and the exponent lean on each other; another exponent would put the equilibrium elsewhere"
            }
            Self::ExponentUndetermined { .. } | Self::ExponentsAlike { .. } => {
                "the hold is too short or too noisy to tell these laws apart"
            }
            Self::ParametersAtBound { .. } => {
                "over this hold such a law is a simpler one in disguise (a straight line, a step, a pure power); its numbers mean nothing"
            }
            Self::ExponentConfounded { .. } => {
                "a higher exponent with a lower equilibrium fits nearly as well; each is only as good as the other"
            }
            Self::TermsIndistinguishable { .. } => "the data carry fewer terms than the series has",
            Self::LawsIndistinguishable { .. } => {
                "these data do not tell which of these laws holds; beyond the hold they will part"
            }
            Self::DriftInsteadOfRelaxation { .. } => {
                "load cell, temperature or frame drift, or the jaw still moves: no law of relaxation does this"
            }
            Self::FeedbackControlled { .. } => {
                "the machine held the force, not the displacement: the body creeps, and a law of relaxation does not apply"
            }
            Self::NothingHeld { .. } => {
                "the machine held neither: part of what the force does is due to the motion, which the laws leave out"
            }
            Self::RateAtBound { .. } => {
                "over this hold the law is a straight line, a pure power or a step: its rate and amplitude cannot be told apart"
            }
            Self::ResidualsCorrelated { .. } => {
                "either the law misses part of the shape, or the noise is slow (drift, quantisation, filtering); plain standard errors are too small, the intervals given are widened for it"
            }
            Self::Ruptured { .. } => {
                "what stands after a rupture is no hold: nothing was fitted to it, and what comes later is another body"
            }
            Self::NoRelaxation { .. } => "the contact is relaxed, or open, or its relaxation is below the noise",
            Self::TooFewSamples { .. } => "nothing was fitted to this hold",
            Self::SampledTooSlowly { .. } => {
                "the rate and the amplitude at the start of the hold rest on a few samples"
            }
            Self::ContactOpen { .. } => {
                "the jaw retreated faster than the body recovered and left it; the hold is fitted from where they met again"
            }
            Self::NoContactArea => {
                "the jaw is at or before first touch, so that no strain can be told from the force; the hold is not fitted"
            }
            Self::Thinned { .. } => "the fit loses nothing but time",
            Self::DropoutsRepaired { .. } => {
                "the encoder or the logger lost a value; the mean of the neighbours stands in its place"
            }
            Self::RowsStray { .. } => {
                "a spike of the load cell or the logger pulls fits its way, a real peak does not belong to a hold"
            }
            Self::RowsAveraged { .. } => {
                "what is shorter than that many rows is smoothed away: peaks are lower, and the first moments of a hold are coarser"
            }
            Self::StressAsForce => "the forces are those on 1 m²; rates and exponents stay what they are",
            Self::StampsMerged { .. } => {
                "the clock is coarser than the sampling, or rows were written twice; the mean of such rows stands in their place"
            }
            Self::StampsSorted { .. } => "a buffer of the logger came late; rows stand where their stamps say",
            Self::Gaps { .. } => "the logger paused: a ramp inside a gap is a straight line, and a peak in it is lost",
            Self::Saturated { .. } => {
                "the sensor was at the end of its range: the true value went on, and peaks, fits and moduli that rest on it are wrong"
            }
            Self::Quantised { .. } => {
                "changes of less than a step are not seen; late in a hold the relaxation is a staircase, whose errors are not those of noise"
            }
            Self::PhasesFromForce => {
                "phases come from the force; the edges of holds are less sure, and there are no strains"
            }
            Self::AirTravel { .. } => "displacement and force are counted from first touch",
            Self::ModulusEstimated { .. } => "strains and v rest on this estimate; n and the relative rate do not",
            Self::ModulusMismatch { .. } => {
                "the body is stiffer or softer than described, bonded or friction-locked, or its first touch is elsewhere; strains scale with the modulus"
            }
            Self::TouchUncertain { .. } => {
                "intervals of strains take first touch as exact; between records these strains differ by more than they say"
            }
            Self::TouchSpread { .. } => {
                "where the body begins hangs on the rule; strains, areas and a modulus from this record share that error"
            }
            Self::TouchNotFound { .. } => "first touch was found as with \"auto\" instead",
            Self::ClocksSkewed { .. } => {
                "two clocks or a filter: fits of holds do not mind, but forces in ramps stand at the wrong displacement"
            }
            Self::ClocksOpen { .. } => "nothing was moved: forces in ramps may stand at the wrong displacement",
            Self::JawHunts { .. } => {
                "a controller hunts, or cycles are meant: holds are those of the mean place, and forces in them follow the swing"
            }
            Self::TouchApart { .. } => {
                "the body does not load as the law of this rule does, or drifts in air; strains, areas and a modulus share the difference"
            }
            Self::SignSuspicious { .. } => {
                "palpate counts compression, or stretch of a strip, as positive in displacement and force; loading is taken for unloading otherwise"
            }
            Self::RateCoefficientTrend {
                verdict: TrendVerdict::FallsWithStrain,
                ..
            } => {
                "v falls as the equilibrium strain grows, as the authors of the paper saw: no single v describes this body"
            }
            Self::RateCoefficientTrend {
                verdict: TrendVerdict::RisesWithStrain,
                ..
            } => "v rises with the equilibrium strain: no single v describes this body",
            Self::RateCoefficientTrend { .. } => {
                "the holds may share one v, or v may change with strain by a factor of 2; these holds do not tell"
            }
            Self::OverlayPoor { .. } => {
                "each hold may be fitted well, but one law with these layers does not join them through the ramps"
            }
            Self::NoOverlay { .. } => "the report has no simulated curve",
        }
    }

    /// What helps.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::EquilibriumExtrapolated { .. } => "hold longer, or compare holds with one fixed exponent",
            Self::ExponentUndetermined { .. } | Self::ExponentsAlike { .. } => {
                "hold longer, sample the first second faster, or fix the exponent from longer holds"
            }
            Self::RateAtBound { .. } => "hold longer or sample faster; do not use the numbers of this fit",
            Self::ParametersAtBound { .. } | Self::TermsIndistinguishable { .. } => "use a law with fewer numbers",
            Self::ExponentConfounded { .. } => {
                "hold longer, or fix the exponent from longer holds of the same material"
            }
            Self::LawsIndistinguishable { .. } => "use the one with the fewest numbers, or hold longer",
            Self::DriftInsteadOfRelaxation { .. } => {
                "warm up the load cell, check the tare, end the fit before the rise (until)"
            }
            Self::FeedbackControlled { .. } => {
                "fit the displacement as creep (palpate compare --creep), or hold the displacement"
            }
            Self::NothingHeld { .. } => {
                "let the fit begin when the jaw has settled (hold_start), end it earlier (until), or hold the jaw better"
            }
            Self::ResidualsCorrelated { .. } => {
                "look at the residuals in the report; try a free exponent or a later start of the hold"
            }
            Self::Ruptured { .. } => {
                "squeeze less; if nothing broke, give the hold by hand ([[phases.hold]] in the test description)"
            }
            Self::NoRelaxation { .. } => "nothing, if the contact was meant to be open or at rest",
            Self::TooFewSamples { .. } => "sample faster or hold longer",
            Self::SampledTooSlowly { .. } => "sample faster at the start of holds",
            Self::ContactOpen { .. } => "unload more slowly, or in smaller steps",
            Self::NoContactArea => "check first touch (touch = \"...\" in the test description)",
            Self::Thinned { .. } => "nothing",
            Self::DropoutsRepaired { .. } | Self::StampsSorted { .. } | Self::Gaps { .. } => "check the logger",
            Self::RowsStray { .. } => {
                "remove the rows if they are no forces; `palpate compare --loss huber` makes them count less"
            }
            Self::RowsAveraged { .. } => {
                "nothing, if the test is long against that; else cut the file, or keep fewer rows a second"
            }
            Self::StressAsForce => "describe the body with its section, as a strip, cylinder or block, or read N as Pa",
            Self::StampsMerged { .. } => {
                "write the time with more digits; if most rows share stamps, check that this is the column of the time"
            }
            Self::Saturated { .. } => "repeat the test with a larger range, and do not use holds at that value",
            Self::Quantised { .. } => "use a sensor with a smaller range, or write more digits",
            Self::PhasesFromForce => "record the displacement, or give the hold's limits",
            Self::AirTravel { .. } => "set touch in the test description if this is not where they met",
            Self::ModulusEstimated { .. } => "give the modulus in the test description if it is known",
            Self::ModulusMismatch { .. } => {
                "leave the modulus out to have it estimated, or check geometry and first touch"
            }
            Self::TouchUncertain { .. } => {
                "sample the first ramp faster, or measure first touch and set touch in the test description"
            }
            Self::TouchSpread { .. } => {
                "sample the approach faster and start it in air, or set touch in the test description to a rule or a displacement"
            }
            Self::TouchNotFound { .. } => "choose another rule, or give the displacement of first touch",
            Self::ClocksSkewed { .. } => "set skew = \"auto\" in [clock] of the test description to take it away",
            Self::ClocksOpen { .. } => {
                "sample ramps faster, or give the skew in [clock] of the test description as a time"
            }
            Self::JawHunts { .. } => {
                "tune the controller; for cycles that are meant set tolerance in [phases] below their height"
            }
            Self::TouchApart { .. } => "set touch in the test description to another rule, or to a displacement",
            Self::SignSuspicious { .. } => {
                "if the file counts the other way round, set sign = -1 for that column in the test description"
            }
            Self::RateCoefficientTrend {
                verdict: TrendVerdict::Undecided,
                ..
            } => "hold at more strains, or longer",
            Self::RateCoefficientTrend { .. } => "use v of the hold whose strain is nearest to the one of interest",
            Self::OverlayPoor { .. } => {
                "check modulus, first touch and layers; compare v of the holds before using one for all of them"
            }
            Self::NoOverlay { .. } => "check geometry, first touch and units",
        }
    }
}
