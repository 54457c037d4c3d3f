//! What the user should know; `told.rs` has the words, a row for each finding.

mod told;

use serde::{Deserialize, Serialize};

use crate::fit::TrendVerdict;
use crate::laws::Law;
use crate::record::Column;
use crate::segment::{Ripple, Rupture, TouchMethod};

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
    /// The body broke while it was loaded.
    Ruptured(Rupture),
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
    /// Single rows of the force that leave their neighbours and come back, and were left as they are.
    RowsStray {
        /// How many.
        count: usize,
        /// Time of the first, s.
        time: f64,
        /// Force there, N.
        force: f64,
    },
    /// The file is so long that successive rows became their mean.
    RowsAveraged {
        /// Rows of the file.
        rows: usize,
        /// Of how many rows a sample is the mean.
        averaged: usize,
    },
    /// The record is one of stress, and no section was given.
    StressAsForce,
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
        /// Numbers of the holds with such rows, from 1.
        holds: Vec<usize>,
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
        /// What the equilibrium forces say, Pa.
        modulus: f64,
        /// Its standard error, Pa.
        standard_error: Option<f64>,
    },
    /// The given modulus and the equilibrium forces disagree.
    ModulusMismatch {
        /// Given, Pa.
        given: f64,
        /// Implied by the equilibrium forces, Pa.
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
    /// A skew was to be found, and could not be told.
    ClocksOpen {
        /// What the edges say with its standard error, s; `None` where too few show in both columns.
        skew: Option<(f64, f64)>,
        /// One clock stamps both columns, and they seem to differ by more than any delay in front of it.
        one_clock: bool,
    },
    /// The jaw swings about the places that it holds.
    JawHunts(Ripple),
    /// The loading curve puts first touch far from where all other rules do.
    TouchApart {
        /// How far behind (above 0) or before the middle of the others, m.
        apart: f64,
        /// The largest squeeze, m.
        squeeze: f64,
    },
    /// A column seems to count the other way round.
    SignSuspicious {
        /// `displacement` or `force`.
        column: String,
        /// How far it goes below its start, m or N.
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
        self.told().0
    }

    /// How much it matters.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.told().1
    }

    /// What was seen.
    #[must_use]
    pub fn seen(&self) -> String {
        self.told().2
    }

    /// What it may mean.
    #[must_use]
    pub fn meaning(&self) -> &'static str {
        self.told().3
    }

    /// What helps; options stand between `⟨` and `⟩`, to be written as users of a program write them.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        self.told().4
    }
}
