//! What the user should know: what was seen, what it may mean, what helps.

use serde::{Deserialize, Serialize};

use crate::identify::TrendVerdict;
use crate::laws::Law;
use crate::record::Column;
use crate::segment::TouchMethod;

/// How much a finding matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Good to know.
    Info,
    /// Read the numbers with care.
    Caution,
    /// A number is missing or must not be used.
    Warning,
}

/// Something suspicious but usable. Each has a stable code; the words may change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "snake_case")]
pub enum Finding {
    /// The fitted equilibrium lies well beyond what the hold reached.
    EquilibriumExtrapolated {
        /// Share of the fitted relaxation that lies beyond the end of the hold.
        beyond: f64,
    },
    /// The data do not determine the exponent.
    ExponentUndetermined {
        /// What the free fit says, if it ended well.
        interval: Option<(f64, f64)>,
    },
    /// Several listed exponents fit equally well.
    ExponentsAlike {
        /// Those exponents.
        exponents: Vec<f64>,
    },
    /// The fit ended at the edge of its range.
    RateAtBound {
        /// The exponent of that fit.
        exponent: f64,
    },
    /// Laws of the comparison ended at the edge of their range.
    ParametersAtBound {
        /// Those laws.
        laws: Vec<Law>,
    },
    /// Exponent and equilibrium go together.
    ExponentConfounded {
        /// Correlation of their estimates.
        correlation: f64,
    },
    /// Terms of a series are none.
    TermsIndistinguishable {
        /// Those laws.
        laws: Vec<Law>,
    },
    /// Several laws do equally well.
    LawsIndistinguishable {
        /// Those laws, the one with the fewest numbers first.
        laws: Vec<Law>,
    },
    /// The force rises again in a hold after loading.
    DriftInsteadOfRelaxation {
        /// How far it rises, N.
        rise: f64,
        /// How far it fell before, N.
        fall: f64,
    },
    /// The jaw moves in the hold while the force stands still.
    FeedbackControlled {
        /// How far it moves, m.
        travel: f64,
        /// How much the force changes, N.
        change: f64,
    },
    /// Jaw and force both move in the hold.
    NothingHeld {
        /// How far the jaw moves, m.
        travel: f64,
        /// How much the force changes, N.
        change: f64,
    },
    /// Residuals of neighbouring samples go together.
    ResidualsCorrelated {
        /// Their correlation.
        correlation: f64,
        /// Samples that count as independent.
        independent: f64,
    },
    /// The signal does not change in the hold as far as its noise lets one see.
    NoRelaxation {
        /// Change, in the unit of the force.
        change: f64,
        /// Its standard error.
        standard_error: f64,
    },
    /// Too few samples to fit.
    TooFewSamples {
        /// Samples in the hold.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Much of the relaxation happens between the first two samples.
    SampledTooSlowly {
        /// Share of the relaxation in the first sample interval.
        share: f64,
    },
    /// The jaw had left the body when the hold began.
    ContactOpen {
        /// Time at which they met again, s.
        until: f64,
    },
    /// No contact area at this displacement, hence no strain.
    NoContactArea,
    /// More samples than are fitted.
    Thinned {
        /// One in this many is fitted.
        every: usize,
    },
    /// Dropouts of a single row.
    DropoutsRepaired {
        /// Of which column.
        column: Column,
        /// How many.
        count: usize,
    },
    /// The file is so long that successive rows became their mean.
    RowsAveraged {
        /// Rows of the file.
        rows: usize,
        /// Of how many rows a sample is the mean.
        averaged: usize,
    },
    /// Rows with one time stamp.
    StampsMerged {
        /// Rows before.
        rows: usize,
        /// Rows that went.
        merged: usize,
    },
    /// Rows that were written too late.
    StampsSorted {
        /// How many.
        rows: usize,
        /// Largest step back of the time, s.
        largest: f64,
    },
    /// Stretches without samples.
    Gaps {
        /// How many.
        count: usize,
        /// The longest, s.
        longest: f64,
        /// When it begins, s.
        from: f64,
    },
    /// A column stands at its extreme value while the other goes on, or loses its noise there.
    Saturated {
        /// Which.
        column: Column,
        /// The value, m or N.
        level: f64,
        /// Rows at it.
        rows: usize,
    },
    /// A column has few levels, and its noise does not smooth them.
    Quantised {
        /// Which.
        column: Column,
        /// Step between the levels, m or N.
        step: f64,
    },
    /// No displacement column: phases come from the force.
    PhasesFromForce,
    /// The jaw travelled through air first.
    AirTravel {
        /// How far, m.
        travel: f64,
    },
    /// The modulus was not given.
    ModulusEstimated {
        /// What the relaxed forces say, Pa.
        modulus: f64,
        /// Its standard error, Pa.
        standard_error: Option<f64>,
    },
    /// The given modulus and the relaxed forces disagree.
    ModulusMismatch {
        /// Given, Pa.
        given: f64,
        /// Implied by the relaxed forces, Pa.
        implied: f64,
    },
    /// First touch is known less well than the fits.
    TouchUncertain {
        /// Standard error of first touch, m of jaw travel.
        error: f64,
        /// The hold whose equilibrium strain suffers most.
        hold: usize,
        /// By how much that error moves its equilibrium strain, as a share of it.
        shift: f64,
        /// Half the interval of that equilibrium strain, as a share of it.
        interval: f64,
    },
    /// The rules for first touch disagree.
    TouchSpread {
        /// Robust standard deviation of what they say, m.
        spread: f64,
        /// Largest displacement since first touch, m.
        squeeze: f64,
    },
    /// The rule that was asked for finds no first touch.
    TouchNotFound {
        /// The rule.
        method: TouchMethod,
    },
    /// The force is stamped later than the displacement, or earlier.
    ClocksSkewed {
        /// How much later, s.
        skew: f64,
        /// Its standard error, s.
        standard_error: f64,
    },
    /// A column seems to count the other way round.
    SignSuspicious {
        /// `displacement` or `force`.
        column: String,
        /// How far it goes below its start in the first ramp, m or N.
        fall: f64,
    },
    /// v is not known to be one number for all holds after loading.
    RateCoefficientTrend {
        /// Whether it falls, rises, or neither can be told.
        verdict: TrendVerdict,
        /// Holds.
        holds: usize,
        /// d ln v/dε_e.
        slope: f64,
        /// Its confidence interval.
        interval: (f64, f64),
    },
    /// The simulated record is not the measured one.
    OverlayPoor {
        /// Root mean square of the difference as a share of the largest force.
        relative: f64,
    },
    /// The overlay could not be simulated.
    NoOverlay {
        /// Why.
        reason: String,
    },
}

impl Finding {
    /// The stable code.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::EquilibriumExtrapolated { .. } => "equilibrium_extrapolated",
            Self::ExponentUndetermined { .. } => "exponent_undetermined",
            Self::ExponentsAlike { .. } => "exponents_alike",
            Self::RateAtBound { .. } => "rate_at_bound",
            Self::ParametersAtBound { .. } => "parameters_at_bound",
            Self::ExponentConfounded { .. } => "exponent_confounded",
            Self::TermsIndistinguishable { .. } => "terms_indistinguishable",
            Self::LawsIndistinguishable { .. } => "laws_indistinguishable",
            Self::DriftInsteadOfRelaxation { .. } => "drift_instead_of_relaxation",
            Self::FeedbackControlled { .. } => "feedback_controlled",
            Self::NothingHeld { .. } => "nothing_held",
            Self::ResidualsCorrelated { .. } => "residuals_correlated",
            Self::NoRelaxation { .. } => "no_relaxation",
            Self::TooFewSamples { .. } => "too_few_samples",
            Self::SampledTooSlowly { .. } => "sampled_too_slowly",
            Self::ContactOpen { .. } => "contact_open",
            Self::NoContactArea => "no_contact_area",
            Self::Thinned { .. } => "thinned",
            Self::DropoutsRepaired { .. } => "dropouts_repaired",
            Self::RowsAveraged { .. } => "rows_averaged",
            Self::StampsMerged { .. } => "stamps_merged",
            Self::StampsSorted { .. } => "stamps_sorted",
            Self::Gaps { .. } => "gaps",
            Self::Saturated { .. } => "saturated",
            Self::Quantised { .. } => "quantised",
            Self::PhasesFromForce => "phases_from_force",
            Self::AirTravel { .. } => "air_travel",
            Self::ModulusEstimated { .. } => "modulus_estimated",
            Self::ModulusMismatch { .. } => "modulus_mismatch",
            Self::TouchUncertain { .. } => "touch_uncertain",
            Self::TouchSpread { .. } => "touch_spread",
            Self::TouchNotFound { .. } => "touch_not_found",
            Self::ClocksSkewed { .. } => "clocks_skewed",
            Self::SignSuspicious { .. } => "sign_suspicious",
            Self::RateCoefficientTrend { .. } => "rate_coefficient_trend",
            Self::OverlayPoor { .. } => "overlay_poor",
            Self::NoOverlay { .. } => "no_overlay",
        }
    }

    /// How much it matters.
    #[must_use]
    pub fn severity(&self) -> Severity {
        match self {
            // Where most rows went the column of the time is likely not that of the samples.
            Self::StampsMerged { rows, merged } if 2 * merged > *rows => Severity::Warning,
            Self::RateCoefficientTrend {
                verdict: TrendVerdict::Undecided,
                ..
            }
            | Self::ExponentsAlike { .. }
            | Self::ParametersAtBound { .. }
            | Self::TermsIndistinguishable { .. }
            | Self::LawsIndistinguishable { .. }
            | Self::Thinned { .. }
            | Self::PhasesFromForce
            | Self::AirTravel { .. }
            | Self::NoRelaxation { .. }
            | Self::ModulusEstimated { .. } => Severity::Info,
            Self::EquilibriumExtrapolated { .. }
            | Self::ExponentUndetermined { .. }
            | Self::ExponentConfounded { .. }
            | Self::DriftInsteadOfRelaxation { .. }
            | Self::FeedbackControlled { .. }
            | Self::NothingHeld { .. }
            | Self::ResidualsCorrelated { .. }
            | Self::SampledTooSlowly { .. }
            | Self::ContactOpen { .. }
            | Self::DropoutsRepaired { .. }
            | Self::RowsAveraged { .. }
            | Self::StampsMerged { .. }
            | Self::StampsSorted { .. }
            | Self::Gaps { .. }
            | Self::Quantised { .. }
            | Self::ModulusMismatch { .. }
            | Self::TouchUncertain { .. }
            | Self::TouchSpread { .. }
            | Self::TouchNotFound { .. }
            | Self::ClocksSkewed { .. }
            | Self::SignSuspicious { .. }
            | Self::RateCoefficientTrend { .. }
            | Self::OverlayPoor { .. } => Severity::Caution,
            Self::RateAtBound { .. }
            | Self::TooFewSamples { .. }
            | Self::NoContactArea
            | Self::Saturated { .. }
            | Self::NoOverlay { .. } => Severity::Warning,
        }
    }

    /// What was seen.
    #[must_use]
    pub fn seen(&self) -> String {
        match self {
            Self::EquilibriumExtrapolated { beyond } => {
                format!(
                    "the hold shows {:.0} % of the fitted relaxation; {:.0} % lies beyond its end",
                    100.0 * (1.0 - beyond),
                    100.0 * beyond
                )
            }
            Self::ExponentUndetermined {
                interval: Some((low, high)),
            } => {
                format!("the interval of the free exponent runs from {low:.1} to {high:.1}")
            }
            Self::ExponentUndetermined { interval: None } => {
                "the free exponent ended at the edge of its range".to_owned()
            }
            Self::ExponentsAlike { exponents } => {
                let list: Vec<String> = exponents.iter().map(|n| format!("{n}")).collect();
                format!("the exponents {} fit equally well", list.join(", "))
            }
            Self::RateAtBound { exponent } => {
                format!("the fit with n = {exponent:.3} ended at the edge of the range of its rate")
            }
            Self::ParametersAtBound { laws } => {
                format!("the fits of {} ended at the edge of their range", listed(laws))
            }
            Self::ExponentConfounded { correlation } => {
                format!("the estimates of exponent and equilibrium correlate by {correlation:.3}")
            }
            Self::TermsIndistinguishable { laws } => {
                format!("in {} terms merge or vanish", listed(laws))
            }
            Self::LawsIndistinguishable { laws } => format!("{} do equally well", listed(laws)),
            Self::DriftInsteadOfRelaxation { rise, fall } if *fall > 0.0 => {
                format!("after falling by {fall:.3} N the force rises by {rise:.3} N at constant displacement")
            }
            Self::DriftInsteadOfRelaxation { rise, .. } => {
                format!("the force rises by {rise:.3} N in a hold after loading")
            }
            Self::FeedbackControlled { travel, change } => format!(
                "the jaw moves by {:.3} mm in the hold while the force changes by {change:.3} N only",
                1e3 * travel
            ),
            Self::NothingHeld { travel, change } => {
                format!("the jaw moves by {:.3} mm in the hold and the force changes by {change:.3} N", 1e3 * travel)
            }
            Self::ResidualsCorrelated {
                correlation,
                independent,
            } => format!(
                "neighbouring residuals correlate by {correlation:.2}; the samples count as {independent:.0} independent ones"
            ),
            Self::NoRelaxation { change, standard_error } => {
                format!("the force changes by {change:.2e} N with a standard error of {standard_error:.1e} N")
            }
            Self::TooFewSamples { found, needed } => format!("the hold has {found} samples, a fit needs {needed}"),
            Self::SampledTooSlowly { share } => {
                format!("{:.0} % of the relaxation happens within the first sample interval", 100.0 * share)
            }
            Self::ContactOpen { until } => format!("there is no force until {until:.2} s"),
            Self::NoContactArea => "the contact has no area at this displacement".to_owned(),
            Self::Thinned { every } => format!("one sample in {every} is fitted"),
            Self::DropoutsRepaired { column, count: 1 } => format!("one row of the {} strays alone", column.name()),
            Self::DropoutsRepaired { column, count } => format!("{count} rows of the {} stray alone", column.name()),
            Self::RowsAveraged { rows, averaged } => format!(
                "the file has {rows} rows, more than are kept; every {averaged} successive ones became their mean ({} samples)",
                rows.div_ceil(*averaged)
            ),
            Self::StampsMerged { rows, merged } => {
                format!("{merged} of {rows} rows have the time stamp of the row before")
            }
            Self::StampsSorted { rows, largest } => {
                format!("{rows} rows are stamped earlier than rows before them, by up to {largest:.4} s")
            }
            Self::Gaps {
                count: 1,
                longest,
                from,
            } => {
                format!("there is no sample for {longest:.3} s from {from:.3} s on")
            }
            Self::Gaps { count, longest, from } => {
                format!(
                    "in {count} places samples are missing, the longest time for {longest:.3} s from {from:.3} s on"
                )
            }
            Self::Saturated { column, level, rows } => {
                format!("the {} stands at its extreme, {}, in {rows} rows", column.name(), measured(*column, *level))
            }
            Self::Quantised { column, step } => {
                format!("the {} moves in steps of {}", column.name(), measured(*column, *step))
            }
            Self::PhasesFromForce => "the record has no displacement".to_owned(),
            Self::AirTravel { travel } => format!("the jaw travels {:.3} mm before the force rises", 1e3 * travel),
            Self::ModulusEstimated {
                modulus,
                standard_error,
            } => format!(
                "no modulus was given; the relaxed forces imply {} kPa",
                with_error(modulus / 1e3, standard_error.map(|error| error / 1e3))
            ),
            Self::ModulusMismatch { given, implied } => format!(
                "the given modulus is {:.4} kPa, the relaxed forces imply {:.4} kPa (force over area and relative squeeze)",
                given / 1e3,
                implied / 1e3
            ),
            Self::TouchUncertain {
                error,
                hold,
                shift,
                interval,
            } => format!(
                "first touch is known to {:.3} mm, which moves the equilibrium strain of hold {hold} by {:.2} %; its interval is only ± {:.2} %",
                1e3 * error,
                100.0 * shift,
                100.0 * interval
            ),
            Self::TouchSpread { spread, squeeze } => format!(
                "rules for first touch differ by {:.3} mm (robust standard deviation), the largest squeeze is {:.3} mm",
                1e3 * spread,
                1e3 * squeeze
            ),
            Self::TouchNotFound { method } => format!("the rule \"{}\" finds no first touch", method.name()),
            Self::ClocksSkewed { skew, standard_error } => format!(
                "where ramps start and end the force bends {} ms {} than the displacement",
                with_error(1e3 * skew.abs(), Some(1e3 * standard_error)),
                if *skew > 0.0 { "later" } else { "earlier" }
            ),
            Self::SignSuspicious { column, fall } if column == "force" => {
                format!("the force falls by {fall:.3} N in the first ramp")
            }
            Self::SignSuspicious { column, fall } => {
                format!("the {column} falls by {:.3} mm in the first ramp", 1e3 * fall)
            }
            Self::RateCoefficientTrend {
                holds,
                slope,
                interval: (low, high),
                ..
            } => format!("over {holds} holds after loading d ln v/dεₑ = {slope:.2} (interval {low:.2} to {high:.2})"),
            Self::OverlayPoor { relative } => format!(
                "measured and simulated force differ by {:.0} % of the largest force (root mean square)",
                100.0 * relative
            ),
            Self::NoOverlay { reason } => format!("the record could not be simulated: {reason}"),
        }
    }

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
            Self::RowsAveraged { .. } => {
                "what is shorter than that many rows is smoothed away: peaks are lower, and the first moments of a hold are coarser"
            }
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
            Self::NoRelaxation { .. } => "nothing, if the contact was meant to be open or at rest",
            Self::TooFewSamples { .. } => "sample faster or hold longer",
            Self::SampledTooSlowly { .. } => "sample faster at the start of holds",
            Self::ContactOpen { .. } => "unload more slowly, or in smaller steps",
            Self::NoContactArea => "check first touch (touch = \"...\" in the test description)",
            Self::Thinned { .. } => "nothing",
            Self::DropoutsRepaired { .. } | Self::StampsSorted { .. } | Self::Gaps { .. } => "check the logger",
            Self::RowsAveraged { .. } => {
                "nothing, if the test is long against that; else cut the file, or keep fewer rows a second"
            }
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

/// A value with its unit: mm or N.
fn measured(column: Column, value: f64) -> String {
    match column {
        Column::Displacement => format!("{:.4} mm", 1e3 * value),
        Column::Force => format!("{value:.4} N"),
    }
}

/// "a, b and c".
fn listed(laws: &[Law]) -> String {
    let names: Vec<String> = laws.iter().map(ToString::to_string).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// "28.0 ± 0.3": the value to the place of the second digit of its error, or to four digits where it has none.
fn with_error(value: f64, error: Option<f64>) -> String {
    match error.filter(|error| *error > 1e-4 * value.abs()) {
        Some(error) => {
            let places = (1.0 - error.log10().floor()).clamp(0.0, 9.0) as usize;
            format!("{value:.places$} ± {error:.places$}")
        }
        None => format!("{value:.4}"),
    }
}
