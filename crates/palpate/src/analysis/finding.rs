//! Findings of an analysis; `text.rs` has their texts, one row each, `rank.rs` the order in which they are stated.

mod rank;
mod text;

use serde::{Deserialize, Serialize};

use crate::fit::{Fit, TrendVerdict, UNEXPLAINED};
use crate::laws::{Law, Response};
use crate::record::Column;
use crate::segment::{BaselineTilt, ForceDelay, HoldMode, LabelCheck, Ripple, Rupture, TouchMethod};

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Information; no action is needed.
    Info,
    /// The results need care.
    Caution,
    /// A result is missing or must not be used.
    Warning,
}

/// An observation that affects the use of the results. Each has a stable code; the text may change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Finding {
    /// The fitted equilibrium, or the displacement that a creep ends at, lies well beyond the end of the hold.
    EquilibriumExtrapolated {
        /// Law that is to be used.
        law: Law,
        /// Share of the fitted relaxation or creep that lies beyond the end of the hold.
        beyond: f64,
        /// Which of both.
        #[serde(default)]
        response: Response,
    },
    /// Laws that are not distinguishable from the one to use have another equilibrium, or end of a creep, or none.
    EquilibriumByLaw {
        /// Law that is to be used.
        law: Law,
        /// Laws whose equilibrium its interval leaves out.
        outside: Vec<Law>,
        /// Laws without an equilibrium.
        without: Vec<Law>,
        /// Whether it is that of a relaxation or of a creep.
        #[serde(default)]
        response: Response,
    },
    /// The fitted equilibrium and its interval lie beyond zero, where the body would pull.
    EquilibriumBeyondZero {
        /// Law that is to be used.
        law: Law,
        /// Equilibrium over the value at the end of the hold.
        share: f64,
        /// Its interval.
        interval: (f64, f64),
    },
    /// The fitted end of a recovery and its interval lie beyond the displacement before the load.
    RecoveryBeyondOriginal {
        /// Law that is to be used.
        law: Law,
        /// How far beyond, m.
        distance: f64,
        /// Its interval, m.
        interval: (f64, f64),
    },
    /// The data do not determine the exponent.
    ExponentUndetermined {
        /// Interval of the free exponent, if the fit converged.
        interval: Option<(f64, f64)>,
    },
    /// Several listed exponents are not distinguishable.
    ExponentsIndistinguishable {
        /// Those exponents.
        exponents: Vec<f64>,
    },
    /// The criterion was lowest at an end of the list of exponents, and the list was extended.
    ExponentListExtended {
        /// The requested exponents.
        listed: Vec<f64>,
        /// The exponents that were added.
        added: Vec<f64>,
        /// Numbers of the holds whose criterion was lowest at an end of the list.
        holds: Vec<usize>,
        /// Whether the criterion is still lowest at the largest exponent that a fit allows.
        open: bool,
    },
    /// The record has no ramp; it is one hold from its first sample to its last.
    OneHold,
    /// The record has no hold: nothing relaxes or creeps in it that a law could be fitted to.
    NoHold {
        /// What was found in place of one.
        reason: String,
    },
    /// The relative rate of a fit is at its bound.
    RateAtBound {
        /// The exponent of that fit.
        exponent: f64,
    },
    /// Laws of the comparison have a parameter at its bound.
    ParametersAtBound {
        /// Those laws.
        laws: Vec<Law>,
    },
    /// The estimates of exponent and equilibrium are strongly correlated.
    ExponentConfounded {
        /// Correlation of their estimates.
        correlation: f64,
    },
    /// The force changes at once within a hold.
    ForceStep {
        /// When, s.
        time: f64,
        /// By how much, N.
        step: f64,
        /// How long samples are missing before it, s; 0 where none are.
        gap: f64,
    },
    /// The recommended law has a time constant longer than the hold.
    TimeBeyondHold {
        /// That law.
        law: Law,
        /// Its longest time constant, s.
        time_constant: f64,
        /// The hold, s.
        duration: f64,
    },
    /// The recommended law has a time constant of no more than two sample intervals where it begins.
    FirstSamplesAlone {
        /// That law.
        law: Law,
        /// Its shortest time constant, s.
        time_constant: f64,
        /// The first sample interval, s.
        interval: f64,
    },
    /// Terms of a series are redundant.
    TermsIndistinguishable {
        /// Those laws.
        laws: Vec<Law>,
    },
    /// Several laws are not distinguishable.
    LawsIndistinguishable {
        /// Those laws, the one with the lowest BIC first.
        laws: Vec<Law>,
    },
    /// The force rises again in a hold after loading.
    DriftInsteadOfRelaxation {
        /// How far it rises, N.
        rise: f64,
        /// How far it fell before, N.
        fall: f64,
    },
    /// The force drifts before first touch.
    BaselineDrifts {
        /// N/s.
        rate: f64,
        /// Half of its interval of 99.9 %, N/s.
        half: f64,
        /// How long that was observed, s.
        lasts: f64,
        /// The hold in which it matters most, from 1.
        hold: usize,
        /// By how much the force of that hold changes if the drift goes on, N.
        change: f64,
        /// The same as a share of its relaxation.
        share: f64,
    },
    /// The jaw moves in the hold while the force is constant.
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
    /// What the machine holds goes on in the hold.
    DriveChanges {
        /// What is held.
        mode: HoldMode,
        /// At the start of the fit, N or m.
        from: f64,
        /// At its end, N or m.
        to: f64,
        /// Share of the creep or of the relaxation that this change makes, about.
        share: f64,
    },
    /// The body ruptured during loading.
    Ruptured(Rupture),
    /// Residuals of neighbouring samples are correlated.
    ResidualsCorrelated {
        /// Law that is to be used.
        law: Law,
        /// Their correlation.
        correlation: f64,
        /// Equivalent number of independent samples.
        independent: f64,
    },
    /// The residuals are of no kind of noise that is known.
    NoiseUnexplained {
        /// Law that is to be used.
        law: Law,
        /// The closest kind.
        noise: String,
        /// Probability that it leaves such residuals.
        p_value: f64,
    },
    /// The change of the signal in the hold does not exceed its noise.
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
        /// Time at which contact returns, s.
        until: f64,
    },
    /// The ramp before a hold has fewer samples than say when it began and ended.
    RampBetweenSamples {
        /// The holds behind such ramps.
        holds: Vec<usize>,
        /// Interval of the samples, s.
        interval: f64,
    },
    /// The force goes on after the jaw has stopped, as behind a filter.
    ForceLags {
        /// Time from the stop to its extreme, s.
        rise: f64,
        /// Least time constant of a filter of first order that explains it, s.
        time_constant: f64,
        /// Time from the stop of the jaw to the start of the fit, s.
        from: f64,
    },
    /// No contact area at this displacement, hence no strain.
    NoContactArea,
    /// The hold has more samples than the fit uses.
    Thinned {
        /// One in this many is fitted.
        every: usize,
    },
    /// Single rows were outliers and were replaced.
    DropoutsRepaired {
        /// Of which column.
        column: Column,
        /// How many.
        count: usize,
    },
    /// Single rows of the force are outliers; they were kept.
    RowsStray {
        /// How many.
        count: usize,
        /// Time of the first, s.
        time: f64,
        /// Force there, N.
        force: f64,
    },
    /// The file exceeds the row limit: successive rows were averaged.
    RowsAveraged {
        /// Rows of the file.
        rows: usize,
        /// Of how many rows a sample is the mean.
        averaged: usize,
    },
    /// The record goes on in a second one, whose displacement counts from another zero.
    ContinuedApart {
        /// When the second begins, s.
        time: f64,
        /// Displacement before, m.
        before: f64,
        /// Displacement behind, m.
        after: f64,
    },
    /// The record is one of stress, and no section was given.
    StressAsForce,
    /// Rows of a clock that is coarser than the sampling were spread between its stamps.
    StampsSpread {
        /// Rows.
        rows: usize,
        /// Stamps among them.
        stamps: usize,
        /// From one to the next, s.
        step: f64,
    },
    /// Rows with the same time stamp were merged.
    StampsMerged {
        /// Rows before.
        rows: usize,
        /// Rows removed.
        merged: usize,
    },
    /// Rows were out of order and were sorted by time.
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
    /// A column is at its extreme value while the other continues, or loses its noise there.
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
    /// A column moves in steps that its noise does not smooth.
    Quantised {
        /// Which.
        column: Column,
        /// Step between the levels, m or N.
        step: f64,
    },
    /// No displacement column: phases are derived from the force.
    PhasesFromForce,
    /// The jaw travelled through air first.
    AirTravel {
        /// How far, m.
        travel: f64,
    },
    /// The modulus was not given.
    ModulusEstimated {
        /// Modulus implied by the equilibrium forces, Pa.
        modulus: f64,
        /// Its standard error, Pa.
        standard_error: Option<f64>,
        /// Whether its error is not known since the likeliest law of the holds has no equilibrium.
        without_equilibrium: bool,
    },
    /// The given modulus and the equilibrium forces disagree.
    ModulusMismatch {
        /// Given, Pa.
        given: f64,
        /// Implied by the equilibrium forces, Pa.
        implied: f64,
    },
    /// First touch is less certain than the fits.
    TouchUncertain {
        /// Standard error of first touch, m of jaw travel.
        error: f64,
        /// The hold whose equilibrium strain is affected most.
        hold: usize,
        /// By how much that error moves its equilibrium strain, as a share of it.
        shift: f64,
        /// Half the interval of that equilibrium strain, as a share of it.
        interval: f64,
    },
    /// The rules for first touch disagree.
    TouchSpread {
        /// Robust standard deviation of their displacements, m.
        spread: f64,
        /// Largest displacement since first touch, m.
        squeeze: f64,
    },
    /// The first ramp has too few samples for a curve: first touch lies between two of them.
    TouchBetweenSamples {
        /// Displacements of the last sample without a force and of the first that carries one, m since first touch as it was taken.
        between: (f64, f64),
        /// Largest displacement since first touch, m.
        squeeze: f64,
    },
    /// The requested rule finds no first touch.
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
    /// One clock stamps both columns, and the force answers the displacement late or early.
    ColumnsLag {
        /// Time by which the force follows the displacement, s; negative where it precedes it.
        lag: f64,
        /// Correlation of their rates over the ramps with the lag taken out.
        correlation: f64,
        /// The same as they were recorded.
        as_recorded: f64,
    },
    /// The skew of the clocks was requested and is not determined.
    ClocksOpen {
        /// Skew from the edges of ramps with its standard error, s; `None` where too few appear in both columns.
        skew: Option<(f64, f64)>,
        /// One clock stamps both columns: there is no skew.
        one_clock: bool,
    },
    /// Holds of a force alone whose force may as well be that of ramps, or of a drift that was rounded.
    HoldsDoubtful {
        /// Their numbers, from 1.
        holds: Vec<usize>,
        /// All holds that were found.
        of: usize,
    },
    /// The labels of the file and a search of its columns disagree on the holds.
    LabelsDisagree(LabelCheck),
    /// The jaw oscillates about the positions it holds.
    JawHunts(Ripple),
    /// The force grows along the way through air.
    BaselineTilts(BaselineTilt),
    /// The foot of the first ramp stands for first touch, but the rules find it behind that.
    TouchOpen {
        /// How far behind, m.
        behind: f64,
        /// The largest squeeze, m.
        squeeze: f64,
    },
    /// First touch of the loading curve is far from that of all other rules.
    TouchApart {
        /// Distance behind (positive) or before the median of the others, m.
        apart: f64,
        /// The largest squeeze, m.
        squeeze: f64,
    },
    /// The displacement counts from first touch, as was stated, but is above zero where nothing is pressed yet.
    DisplacementNotZero {
        /// Displacement where the record begins, m.
        start: f64,
    },
    /// The jaw goes on through air from a first touch that was stated.
    AirAsTravel {
        /// How far, m.
        air: f64,
        /// The largest squeeze, m.
        squeeze: f64,
    },
    /// Force and displacement count from first touch, as was stated, but there is a force where the displacement is zero.
    ForceNotZero {
        /// Force where the record begins, N.
        start: f64,
    },
    /// A column seems to have the opposite sign.
    SignSuspicious {
        /// `displacement` or `force`.
        column: String,
        /// How far it goes below its start, m or N.
        fall: f64,
    },
    /// The holds after loading do not establish one common v.
    RateCoefficientTrend {
        /// Whether v falls, rises, or is undecided.
        verdict: TrendVerdict,
        /// Holds.
        holds: usize,
        /// d ln v/dε_e.
        slope: f64,
        /// Its confidence interval.
        interval: (f64, f64),
    },
    /// A free exponent fits holds better than the best of the listed ones.
    ExponentNotListed {
        /// The best of the listed exponents for all holds.
        best: f64,
        /// Holds that a free exponent fits better, each with that exponent.
        free: Vec<(usize, f64)>,
        /// By how much their information criteria are lower together.
        delta_bic: f64,
    },
    /// The ramp before a hold lasted longer than the fastest term of its law takes to relax.
    RampRelaxes {
        /// The hold.
        hold: usize,
        /// How long the ramp took, s.
        ramp: f64,
        /// The shortest time constant, s.
        time_constant: f64,
        /// Its amplitude over that of a step.
        share: f64,
    },
    /// The fit was to end later than every hold does: all samples are fitted.
    UntilBeyondHolds {
        /// When it was to end, s after its start.
        until: f64,
        /// How long the longest hold is fitted, s.
        longest: f64,
    },
    /// The simulated record differs from the measured one.
    OverlayPoor {
        /// Root mean square of the difference as a share of the largest force.
        relative: f64,
    },
    /// A record of several that are calibrated together, of which the law leaves far more than of the others.
    RecordApart {
        /// Root mean square residual of the record, calibrated alone, as a share of its largest force.
        share: f64,
        /// The median of that of the other records.
        others: f64,
    },
    /// The overlay could not be simulated.
    NoOverlay {
        /// Why.
        reason: String,
    },
}

impl Finding {
    /// [`Self::ForceLags`] where laws are fitted from this time (s) on.
    pub(crate) fn of_delay(delay: &ForceDelay, fit_start_s: f64) -> Self {
        Self::ForceLags {
            rise: delay.rise_s,
            time_constant: delay.time_constant_s,
            from: (fit_start_s - delay.stop_s).max(0.0),
        }
    }

    /// The stable code.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.text().0
    }

    /// Severity.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.text().1
    }

    /// The observation.
    #[must_use]
    pub fn observation(&self) -> String {
        self.text().2
    }

    /// Its possible meaning.
    #[must_use]
    pub fn meaning(&self) -> &'static str {
        self.text().3
    }

    /// The remedy; options stand between `⟨` and `⟩`, for each interface to spell.
    #[must_use]
    pub fn remedy(&self) -> &'static str {
        self.text().4
    }

    /// That no noise model describes the residuals of a fit of the latency law.
    pub(crate) fn of_noise(fit: &Fit) -> Option<Self> {
        let law = fit.law;
        refused(fit).map(|(noise, p_value)| Self::NoiseUnexplained { law, noise, p_value })
    }
}

/// The observation and the meaning of [`Finding::NoiseUnexplained`] for a fit of any law; `None` where the residuals are of a known noise.
///
/// ```
/// use palpate::analysis::unexplained_noise;
/// use palpate::fit::{LawOptions, Samples, fit_law};
/// use palpate::laws::Law;
/// let times: Vec<f64> = (0..400).map(|i| 0.1 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 1.0 + (-t / 8.0).exp() + 0.01 * (2.0 * t).sin()).collect();
/// let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &LawOptions::default())?;
/// assert!(unexplained_noise(&fit).is_some_and(|(observed, _)| observed.contains("standard-linear-solid")));
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[must_use]
pub fn unexplained_noise(fit: &Fit) -> Option<(String, &'static str)> {
    let (noise, p_value) = refused(fit)?;
    let observed = text::no_noise_model(&fit.law.to_string(), &noise, p_value);
    Some((observed, text::NOISE_UNEXPLAINED))
}

/// The closest noise model of a fit with its p-value, where it does not describe the residuals.
fn refused(fit: &Fit) -> Option<(String, f64)> {
    let p_value = fit.noise_p_value.filter(|p_value| *p_value < UNEXPLAINED)?;
    Some((fit.noise_in_words(), p_value))
}
