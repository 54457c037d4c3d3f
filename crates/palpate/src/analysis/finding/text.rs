//! The text of each finding: its code, severity, observation, possible meaning and remedy.

use super::Finding;
use super::Severity::{self, Caution, Info, Warning};
use crate::fit::TrendVerdict;
use crate::forecast::listed;
use crate::laws::{Law, Response};
use crate::number::{counted, exact, significant, with_interval};
use crate::record::Column;
use crate::segment::HoldMode;
use crate::statistics::coverage_factor;

/// Code, severity, observation, meaning and remedy.
type Text = (&'static str, Severity, String, &'static str, &'static str);

fn info(code: &'static str, observed: String, meaning: &'static str, remedy: &'static str) -> Text {
    (code, Info, observed, meaning, remedy)
}

fn caution(code: &'static str, observed: String, meaning: &'static str, remedy: &'static str) -> Text {
    (code, Caution, observed, meaning, remedy)
}

fn warning(code: &'static str, observed: String, meaning: &'static str, remedy: &'static str) -> Text {
    (code, Warning, observed, meaning, remedy)
}

impl Finding {
    /// The text of the finding.
    pub(super) fn text(&self) -> Text {
        match self {
            Self::EquilibriumExtrapolated { law, beyond, response } => caution(
                "equilibrium_extrapolated",
                format!(
                    "by the law {law}, the hold covers {:.0} % of the {}; {:.0} % lies beyond its end",
                    100.0 * (1.0 - beyond),
                    match response {
                        Response::Relaxation => "relaxation",
                        Response::Creep => "creep",
                    },
                    100.0 * beyond
                ),
                match (response, law.is_series()) {
                    (Response::Relaxation, true) => {
                        "a series of exponentials knows nothing slower than its slowest term, and neither does the interval of its equilibrium: a body that has a slower one ends elsewhere"
                    }
                    (Response::Relaxation, false) => {
                        "the estimated equilibrium depends on the law and, by the latency law, on the exponent: another one gives another equilibrium"
                    }
                    (Response::Creep, true) => {
                        "a series of exponentials knows nothing slower than its slowest term, and neither does the interval of its final displacement: a body that has a slower one goes on, or flows"
                    }
                    (Response::Creep, false) => {
                        "the final displacement depends on the law and, by the latency law, on the exponent: another one gives another displacement, or a flow without end"
                    }
                },
                "hold longer, or compare holds at one law and one fixed exponent",
            ),
            Self::EquilibriumByLaw {
                law,
                outside,
                without,
                response,
            } => caution(
                "equilibrium_by_law",
                {
                    let have = |laws: &[Law], what: &str| {
                        let verb = if laws.len() == 1 { "has" } else { "have" };
                        (!laws.is_empty()).then(|| format!("{} {verb} {what}", listed(laws)))
                    };
                    let outside = have(
                        outside,
                        match response {
                            Response::Relaxation => "another equilibrium, outside its interval",
                            Response::Creep => "another final displacement, outside its interval",
                        },
                    );
                    let others: Vec<String> = outside.into_iter().chain(have(without, "none")).collect();
                    format!("of the laws that are not distinguishable from {law}, {}", others.join(", and "))
                },
                match response {
                    Response::Relaxation => {
                        "the interval of the equilibrium counts the law as exact; the hold does not show which law goes on, and the equilibrium is known no better"
                    }
                    Response::Creep => {
                        "the interval of the final displacement counts the law as exact; the hold does not show which law goes on, and the final displacement is known no better"
                    }
                },
                match response {
                    Response::Relaxation => "hold longer, or state what each of these laws makes of the equilibrium",
                    Response::Creep => "hold longer, or state what each of these laws makes of the final displacement",
                },
            ),
            Self::RecoveryBeyondOriginal {
                law,
                distance,
                interval,
            } => warning(
                "recovery_beyond_original",
                format!(
                    "by the law {law}, the recovery ends {} µm beyond the displacement before the load",
                    with_interval(1e6 * distance, (1e6 * interval.0, 1e6 * interval.1))
                ),
                "an unloaded body does not pass the height that it had: the law goes too far beyond the end of the hold, or the zero of the displacement has shifted",
                "do not use this final displacement; record the recovery for longer, and check the displacement for drift",
            ),
            Self::ForceStep { time, step, gap } => caution(
                "force_step",
                format!(
                    "the force {} by {} N {}",
                    if *step < 0.0 { "falls" } else { "rises" },
                    significant(step.abs(), 3),
                    match *gap {
                        0.0 => format!("at once at {} s", significant(*time, 5)),
                        gap => format!("in the {} s without samples before {} s", significant(gap, 3), significant(*time, 5)),
                    }
                ),
                "the body slipped or cracked, the grip gave way or something struck the machine: no law of relaxation describes the hold across it",
                "repeat the test, or fit the part before with ⟨fit_until⟩",
            ),
            Self::TimeBeyondHold { law, time_constant, duration } => caution(
                "time_beyond_hold",
                format!(
                    "the longest time constant of {law} is {} s, the hold lasts {} s",
                    significant(*time_constant, 3),
                    significant(*duration, 3)
                ),
                "a hold does not show how a process ends that outlasts it: this time constant, its amplitude and the equilibrium are extrapolated, and a drift looks like one",
                "hold longer, or report the parameters of shorter times alone",
            ),
            Self::FirstSamplesAlone { law, time_constant, interval } => caution(
                "first_samples_alone",
                format!(
                    "the shortest time constant of {law}, {} s, is that of the first samples, which are {} s apart",
                    significant(*time_constant, 2),
                    significant(*interval, 3)
                ),
                "this term rests on the first samples alone: a spike of the load cell or a jaw that swings looks like it, and its amplitude and time are not those of the body",
                "begin the fit later (hold_start), or sample faster at the start of holds",
            ),
            Self::EquilibriumBeyondZero { law, share, interval } => warning(
                "equilibrium_beyond_zero",
                format!(
                    "by the law {law}, the equilibrium is {} of the force at the end of the hold, below zero",
                    with_interval(*share, *interval)
                ),
                "a body that is only pressed does not pull at rest: the law falls too far beyond the end of the hold, or the zero of the force has shifted",
                "do not use this equilibrium; hold longer, and check the tare of the load cell",
            ),
            Self::ExponentUndetermined { interval } => caution(
                "exponent_undetermined",
                match interval {
                    Some((low, high)) if high.is_infinite() => {
                        format!("the interval of the free exponent has no upper end; its lower one is {low:.1}")
                    }
                    Some((low, high)) => format!("the interval of the free exponent is {low:.1} to {high:.1}"),
                    None => "the free exponent is at the bound of its range".to_owned(),
                },
                SHORT_OR_NOISY,
                LONGER_OR_FASTER,
            ),
            Self::ExponentsIndistinguishable { exponents } => {
                let observed = format!("the exponents {} are not distinguishable", series(exponents));
                info("exponents_indistinguishable", observed, SHORT_OR_NOISY, LONGER_OR_FASTER)
            }
            Self::ExponentListExtended {
                listed,
                added,
                holds,
                open,
            } => {
                let observed = format!(
                    "the information criterion of {} was lowest at an end of the listed exponents {}; {} added",
                    listed_holds(holds),
                    series(listed),
                    if added.len() == 1 { format!("{} was", series(added)) } else { format!("{} were", series(added)) },
                );
                if *open {
                    caution(
                        "exponent_list_extended",
                        format!("{observed}, and it is still lowest at the largest"),
                        "the data give no upper limit of the exponent; the relaxation is close to logarithmic in time",
                        LONGER_OR_FASTER,
                    )
                } else {
                    info(
                        "exponent_list_extended",
                        observed,
                        "an exponent at the end of a list is limited by the list, not by the data",
                        "list the added exponents too, or use the free exponent",
                    )
                }
            }
            Self::OneHold => info(
                "one_hold",
                "the record has no ramp; it was taken as one hold from its first sample to its last".to_owned(),
                "first touch and the loading are unknown; the laws describe the force from the first sample on",
                "give the limits of the hold with [[phases.hold]] in the test description if they differ",
            ),
            Self::NoHold { reason } => warning(
                "no_hold",
                reason.clone(),
                "nothing relaxes or creeps in the record that a law could be fitted to; the modulus of the first loading ramp needs no hold",
                "hold the displacement or the force after the ramp, or give the limits of a hold with [[phases.hold]] in the test description",
            ),
            Self::RateAtBound { exponent } => warning(
                "rate_at_bound",
                format!("in the fit with n = {exponent:.3} the relative rate is at its bound"),
                "over this hold the law reduces to a line, a pure power or a step; the data do not separate its rate and amplitude",
                "hold longer or sample faster; do not use the parameters of this fit",
            ),
            Self::ParametersAtBound { laws } => info(
                "parameters_at_bound",
                format!("in the fits of {} a parameter is at its bound", listed(laws)),
                "over this hold such a law reduces to a line, a step or a pure power; its parameters have no meaning",
                "use a law with fewer parameters",
            ),
            Self::ExponentConfounded { correlation } => caution(
                "exponent_confounded",
                format!("the estimates of exponent and equilibrium correlate by {}", significant(*correlation, 3)),
                "a higher exponent with a lower equilibrium fits nearly as closely; an error in one shifts the other",
                "hold longer, or fix the exponent from longer holds of the same material",
            ),
            Self::TermsIndistinguishable { laws } => info(
                "terms_indistinguishable",
                format!("terms of {} merge or vanish", listed(laws)),
                "the data support fewer terms than the series has",
                "use a law with fewer parameters",
            ),
            Self::LawsIndistinguishable { laws } => info(
                "laws_indistinguishable",
                format!("{} are not distinguishable", listed(laws)),
                "these data do not determine which of the laws applies; their predictions beyond the hold differ. Laws of which the first is a special case are left out",
                "use the first of them, which has the lowest BIC, or hold longer",
            ),
            Self::DriftInsteadOfRelaxation { rise, fall } => caution(
                "drift_instead_of_relaxation",
                if *fall > 0.0 {
                    format!(
                        "the force falls by {} N, then rises by {} N at constant displacement",
                        significant(*fall, 3),
                        significant(*rise, 3)
                    )
                } else {
                    format!("the force rises by {} N in a hold after loading", significant(*rise, 3))
                },
                "load cell, temperature or frame drifts, or the jaw still moves; no law of relaxation describes such a rise",
                "warm up the load cell, check the tare, or end the fit before the rise (until)",
            ),
            Self::BaselineDrifts { rate, half, lasts, hold, change, share } => caution(
                "baseline_drifts",
                format!(
                    "before first touch the force drifts by {}, over {} s: if that goes on, {} N in hold {hold}, {} % of its relaxation",
                    with_interval(*rate, (rate - half, rate + half)) + " N/s",
                    significant(*lasts, 3),
                    significant(*change, 2),
                    significant(100.0 * share, 2)
                ),
                "the load cell or its temperature drifts, or a preload relaxes; equilibrium forces and long time constants contain it",
                "warm up the load cell; baseline = \"sloped\" in [force] of the test description subtracts the line",
            ),
            Self::FeedbackControlled { travel, change } => caution(
                "feedback_controlled",
                format!(
                    "the jaw moves by {} mm in the hold while the force changes by only {} N",
                    significant(1e3 * travel, 3),
                    significant(*change, 3)
                ),
                "the machine controlled the force, not the displacement: the body creeps, and no law of relaxation applies",
                "fit the displacement as creep (⟨compare/creep⟩), or hold the displacement",
            ),
            Self::NothingHeld { travel, change } => caution(
                "nothing_held",
                format!(
                    "the jaw moves by {} mm in the hold and the force changes by {} N",
                    significant(1e3 * travel, 3),
                    significant(*change, 3)
                ),
                "the machine held neither; part of the force change is due to the motion, which the laws of relaxation omit",
                "begin the fit after the jaw has settled (hold_start), end it earlier (until), or hold the jaw more steadily",
            ),
            Self::DriveChanges { mode, from, to, share } => {
                let creeps = *mode != HoldMode::DisplacementHeld;
                let (drive, unit, answer, scale) =
                    if creeps { ("force", "N", "creep", 1.0) } else { ("jaw", "mm", "relaxation", 1e3) };
                caution(
                    "drive_changes",
                    format!(
                        "the {drive} goes from {} to {} {unit} in the hold, which by itself makes about {} % of the {answer}",
                        significant(scale * from, 4),
                        significant(scale * to, 4),
                        significant(100.0 * share, 2)
                    ),
                    "a time that a law has there may be that of the machine and not of the body",
                    "begin the fit after the machine has settled (hold_start), or calibrate, which takes what was imposed as it was measured",
                )
            }
            Self::Ruptured(rupture) => warning(
                "ruptured",
                format!(
                    "the body ruptured at {:.3} s: the force fell from {} N to {} N while the jaw moved on",
                    rupture.time,
                    significant(rupture.before, 4),
                    significant(rupture.after, 3)
                ),
                "data after the rupture are not fitted: a broken body is a different specimen",
                "squeeze less; if nothing broke, give the limits of the hold ([[phases.hold]] in the test description)",
            ),
            Self::ResidualsCorrelated {
                law,
                correlation,
                independent,
            } => caution(
                "residuals_correlated",
                format!(
                    "neighbouring residuals of the law {law} have a correlation of {}; the samples are equivalent to {independent:.0} independent ones",
                    significant(*correlation, 2)
                ),
                "the law misses part of the shape, or the noise is slow (drift, quantisation); the intervals account for the correlation",
                "inspect the residuals in the report; try another law, a free exponent or a later start of the hold",
            ),
            Self::NoiseUnexplained { law, noise, p_value } => caution(
                "noise_unexplained",
                no_noise_model(&law.to_string(), noise, *p_value),
                NOISE_UNEXPLAINED,
                "inspect the residuals in the report; compare the intervals with those by bootstrap",
            ),
            Self::NoRelaxation { change, standard_error } => info(
                "no_relaxation",
                format!(
                    "the force changes by {} N, with a standard error of {} N",
                    significant(*change, 3),
                    significant(*standard_error, 2)
                ),
                "the contact is open or in equilibrium, or its relaxation is below the noise",
                "none, if the contact was meant to be open or in equilibrium",
            ),
            Self::TooFewSamples { found, needed } => warning(
                "too_few_samples",
                format!("the hold has {}; a fit needs {needed}", counted(*found, "sample")),
                "nothing was fitted to this hold",
                "sample faster or hold longer",
            ),
            Self::SampledTooSlowly { share } => caution(
                "sampled_too_slowly",
                format!("{:.0} % of the relaxation happens within the first sample interval", 100.0 * share),
                "the estimates of rate and amplitude depend on a few samples at the start of the hold",
                "sample faster at the start of holds",
            ),
            Self::ContactOpen { until } => caution(
                "contact_open",
                format!("the force is zero until {until:.2} s"),
                "the jaw retreated faster than the body recovered, and contact was lost; the fit begins where contact returns",
                "unload more slowly or in smaller steps",
            ),
            Self::RampBetweenSamples { holds, interval } => caution(
                "ramp_between_samples",
                format!(
                    "fewer than two samples, {} s apart, show the jaw on its way to {}: when it started and stopped is unknown by as much",
                    significant(*interval, 3),
                    listed_holds(holds)
                ),
                "the ramp is drawn straight between the samples; rate coefficient, exponent and layer thickness depend on it, beyond their intervals",
                "sample faster, or press more slowly; laws of the holds do not depend on the ramps",
            ),
            Self::ForceLags {
                rise,
                time_constant,
                from,
            } => caution(
                "force_lags",
                format!(
                    "the force goes on for {} s after the jaw has stopped, as behind a filter with a time constant of {} s or more; laws are \
                     fitted to what comes {} s and more after the stop",
                    significant(*rise, 2),
                    significant(*time_constant, 2),
                    significant(*from, 2)
                ),
                "a body relaxes as soon as the jaw stops: forces of the ramp and up to there are those of an amplifier or a filter, and first touch, \
                 modulus and layer thickness are not to be relied on",
                "give the time constant of the amplifier as filter in [force] of the test description, so that this finding is gone; or record with a faster filter",
            ),
            Self::NoContactArea => warning(
                "no_contact_area",
                "the contact has no area at this displacement".to_owned(),
                "the jaw is at or before first touch, so that the strain is undefined; the hold is not fitted",
                "check first touch (touch = \"...\" in the test description)",
            ),
            Self::Thinned { every } => {
                let observed = format!("the fit uses one sample in {every}");
                info("thinned", observed, "the remaining samples carry the same information; the fit is faster", "none")
            }
            Self::DropoutsRepaired { column, count } => caution(
                "dropouts_repaired",
                match count {
                    1 => format!("one row of the {} is an outlier", column.name()),
                    _ => format!("{count} rows of the {} are outliers", column.name()),
                },
                "the encoder or the logger lost a value; the line between the rows beside replaces it",
                "check the logger",
            ),
            Self::RowsStray { count, time, force } => {
                let (time, force) = (significant(*time, 5), significant(*force, 4));
                caution(
                    "rows_stray",
                    match count {
                        1 => format!("one row of the force is an outlier: {force} N at {time} s"),
                        _ => format!("{count} rows of the force are outliers, the first at {time} s with {force} N"),
                    },
                    "a spike of the load cell or the logger biases the fit; a real peak does not belong to a hold",
                    "remove the rows if they are not forces; `⟨compare/loss=huber⟩` reduces their weight",
                )
            }
            Self::RowsAveraged { rows, averaged } => caution(
                "rows_averaged",
                format!(
                    "the file has {rows} rows, more than the limit; each {averaged} successive rows are averaged ({} samples)",
                    rows.div_ceil(*averaged)
                ),
                "events shorter than that many rows are smoothed: peaks are lower, and the start of a hold is coarser",
                "none, if the events of interest last longer; otherwise cut the file, or record fewer rows per second",
            ),
            Self::ContinuedApart { time, before, after } => {
                let [before, after] = [before, after].map(|place| measured(Column::Displacement, *place));
                warning(
                    "continued_apart",
                    format!(
                        "the displacement goes from {before} to {after} at once where the second file begins, at {} s, and the force goes on",
                        significant(*time, 4)
                    ),
                    "the displacement of the second file counts from a zero of its own: strains, phases and moduli from there on are wrong",
                    "add the difference to the displacements of one of the files, or export both from one zero, and join them again",
                )
            }
            Self::StressAsForce => caution(
                "stress_as_force",
                "the file gives stress, and the description no section: each value in N stands for the same value in Pa"
                    .to_owned(),
                "the forces are those on 1 m²; rates and exponents are unaffected",
                "describe the body with its section (strip, cylinder or block), or read N as Pa",
            ),
            Self::StampsSpread { rows, stamps, step } => caution(
                "stamps_spread",
                format!("{rows} rows have {stamps} time stamps, {} s apart", significant(*step, 4)),
                "the clock is coarser than the sampling; the rows were spread over the stamps as if sampled at a constant rate, which changes only where stamps have more or fewer rows",
                "write the time with more digits",
            ),
            Self::StampsMerged { rows, merged } => (
                "stamps_merged",
                // Where most rows went the column of the time is likely not that of the samples.
                if 2 * merged > *rows { Warning } else { Caution },
                format!("{merged} of {rows} rows have the time stamp of the preceding row"),
                "the clock is coarser than the sampling, or rows were written twice; the mean of such rows replaces them",
                "write the time with more digits; if most rows share stamps, check that this is the time column",
            ),
            Self::StampsSorted { rows, largest } => caution(
                "stamps_sorted",
                format!("{rows} rows have earlier time stamps than preceding rows, by up to {largest:.4} s"),
                "the logger wrote a buffer late; the rows were sorted by their time stamps",
                "check the logger",
            ),
            Self::Gaps { count, longest, from } => caution(
                "gaps",
                match count {
                    1 => format!("samples are missing for {longest:.3} s from {from:.3} s"),
                    _ => format!(
                        "samples are missing in {count} gaps, the longest of {longest:.3} s from {from:.3} s"
                    ),
                },
                "the logger paused; a ramp within a gap becomes a straight line, and a peak within it is lost",
                "check the logger",
            ),
            Self::Saturated { column, level, rows, holds } => {
                let among = match holds[..] {
                    [] => String::new(),
                    [hold] => format!(", some of them in hold {hold}"),
                    _ => format!(", some of them in holds {}", listed(holds)),
                };
                let (name, level) = (column.name(), measured(*column, *level));
                warning(
                    "saturated",
                    format!("the {name} stands at its extreme, {level}, in {rows} rows{among}"),
                    "the sensor was at the end of its range while the other column went on; peaks, fits and moduli that depend on these rows are wrong",
                    "repeat the test with a larger range; do not use holds at that value",
                )
            }
            Self::Quantised { column, step } => caution(
                "quantised",
                format!("the {} moves in steps of {}", column.name(), measured(*column, *step)),
                "changes below one step are not resolved; late in a hold the relaxation is a staircase, whose errors are not random noise",
                "use a sensor with a smaller range, or write more digits",
            ),
            Self::PhasesFromForce => info(
                "phases_from_force",
                "the record has no displacement".to_owned(),
                "phases are derived from the force; the limits of holds are less certain, and strains are unavailable",
                "record the displacement, or give the limits of the hold",
            ),
            Self::AirTravel { travel } => info(
                "air_travel",
                format!("the jaw travels {} mm before the force rises", significant(1e3 * travel, 3)),
                "displacement and force are measured from first touch",
                "set touch in the test description if first touch is elsewhere",
            ),
            Self::ModulusEstimated {
                modulus,
                standard_error: None,
                without_equilibrium: true,
            } => caution(
                "modulus_estimated",
                format!(
                    "no modulus was given, and its error is not known: the law that describes these holds best has no equilibrium; strains count on {} kPa",
                    significant(modulus / 1e3, 2)
                ),
                "strains, v and all that rests on the modulus are known up to a factor, which their intervals leave out; n and the relative rate do not depend on it",
                "give the modulus in the test description, or hold until the force is level",
            ),
            Self::ModulusEstimated {
                modulus,
                standard_error,
                ..
            } => info(
                "modulus_estimated",
                format!(
                    "no modulus was given; the equilibrium forces imply {} kPa",
                    standard_error.map_or_else(
                        || significant(modulus / 1e3, 4),
                        |error| with_standard_error(modulus / 1e3, error / 1e3)
                    )
                ),
                "strains and v depend on this estimate; n and the relative rate do not",
                "give the modulus in the test description if it is known",
            ),
            Self::ModulusMismatch { given, implied } => caution(
                "modulus_mismatch",
                format!(
                    "the given modulus is {} kPa, the equilibrium forces imply {} kPa (force over area and relative squeeze)",
                    significant(given / 1e3, 4),
                    significant(implied / 1e3, 4)
                ),
                "modulus or first touch is wrong, or the body is bonded or locked by friction; strains scale with the modulus",
                "omit the modulus to have it estimated, or check geometry and first touch",
            ),
            Self::TouchUncertain { error, hold, shift, interval } => caution(
                "touch_uncertain",
                format!(
                    "an error of {} mm in first touch shifts the equilibrium strain of hold {hold} by {:.2} %, more than the {:.2} % from the estimate to the ends of its interval",
                    significant(1e3 * error, 2),
                    100.0 * shift,
                    100.0 * interval
                ),
                "intervals of strains take first touch as exact; strains of different records differ by more than these intervals",
                "sample the first ramp faster, or measure first touch and set touch in the test description",
            ),
            Self::TouchSpread { spread, squeeze } => caution(
                "touch_spread",
                format!(
                    "the rules for first touch scatter by {} mm (robust standard deviation); the largest squeeze is {} mm",
                    significant(1e3 * spread, 2),
                    significant(1e3 * squeeze, 4)
                ),
                "first touch depends on the rule; strains, areas and a modulus from this record share that error",
                "sample the approach faster and start it in air, or set touch in the test description to a rule or displacement",
            ),
            Self::TouchBetweenSamples { between: (without, with), squeeze } => caution(
                "touch_between_samples",
                format!(
                    "of the samples around first touch the last without a force is at {} mm, and the first that carries one at {} mm; the largest \
                     squeeze is {} mm",
                    significant(1e3 * without, 2),
                    significant(1e3 * with, 2),
                    significant(1e3 * squeeze, 4)
                ),
                "the ramp has too few samples for a curve: first touch lies anywhere between, and strains, areas and a modulus share that error",
                "sample the approach faster or approach more slowly, or set touch in the test description to a displacement",
            ),
            Self::TouchNotFound { method } => caution(
                "touch_not_found",
                format!("the rule \"{}\" finds no first touch", method.name()),
                "the rule \"auto\" determined first touch instead",
                "choose another rule, or give the displacement of first touch",
            ),
            Self::ClocksSkewed { skew, standard_error } => caution(
                "clocks_skewed",
                format!(
                    "at the starts and ends of ramps the force bends {} ms {} than the displacement",
                    with_standard_error(1e3 * skew.abs(), 1e3 * standard_error),
                    if *skew > 0.0 { "later" } else { "earlier" }
                ),
                "two clocks stamp the columns; fits of holds are unaffected, but forces in ramps have the wrong displacement",
                "set skew = \"auto\" in [clock] of the test description to correct it",
            ),
            Self::ColumnsLag { lag, correlation, as_recorded } => caution(
                "columns_lag",
                format!(
                    "in the ramps the {} lags behind the {} by {} s: with that taken out their rates correlate by {}, as recorded by {}",
                    if *lag > 0.0 { "force" } else { "displacement" },
                    if *lag > 0.0 { "displacement" } else { "force" },
                    significant(lag.abs(), 3),
                    significant(*correlation, 2),
                    significant(*as_recorded, 2)
                ),
                "two loggers, a filter or a buffer delay a column: phases come from the displacement, so that holds, their fits and first touch are off by that time",
                "give the delay of the force as skew in [clock] of the test description (negative where the displacement lags), and analyse again",
            ),
            Self::ClocksOpen { one_clock: true, .. } => info(
                "clocks_open",
                "the record has one clock, which stamps displacement and force".to_owned(),
                "one clock has no skew: nothing was moved",
                "none; where a filter delays the force, give its delay as a time in [clock] of the test description",
            ),
            Self::ClocksOpen { skew, .. } => caution(
                "clocks_open",
                match skew {
                    Some((skew, error)) => format!(
                        "the skew of the clocks is not determined; the starts and ends of ramps give {} ms",
                        with_standard_error(1e3 * skew, 1e3 * error)
                    ),
                    None => {
                        "the skew of the clocks is not determined; fewer than three starts and ends of ramps appear in both columns"
                            .to_owned()
                    }
                },
                "no correction was made; forces in ramps may have the wrong displacement",
                "sample ramps faster, or give the skew as a time in [clock] of the test description",
            ),
            Self::HoldsDoubtful { holds, of } => caution(
                "holds_doubtful",
                format!("{} of {} may be none: {}", counted(holds.len(), "hold"), of, listed(holds)),
                "the record has no displacement, and these parts of the force may as well be ramps, or a drift that was rounded",
                "inspect the phases; give the limits of the holds by hand ([[phases.hold]] in the test description)",
            ),
            Self::LabelsDisagree(check) => caution(
                "labels_disagree",
                format!(
                    "the file labels {}; a search of the columns misses {} of them and finds {} more",
                    counted(check.labelled, "hold"), check.missed, check.extra
                ),
                "the labels of the file apply; a hold that is not found drifts, is short, or is mislabelled",
                "inspect the phases; give the limits of holds by hand ([[phases.hold]] in the test description) if the labels are wrong",
            ),
            Self::RecordApart { share, others } => warning(
                "record_apart",
                format!(
                    "the law leaves {} % of the peak force of this record, and {} % of that of the others",
                    significant(100.0 * share, 2),
                    significant(100.0 * others, 2)
                ),
                "the record is broken, or of another body: it shifts the means of the batch and widens the spread",
                "look at the record; leave it out",
            ),
            Self::JawHunts(ripple) => caution(
                "jaw_hunts",
                format!(
                    "the jaw oscillates by {} mm peak to peak every {} s about the positions it holds",
                    significant(1e3 * ripple.height, 2),
                    significant(ripple.period, 2)
                ),
                "the controller hunts, or cycles are intended; the holds are those of the mean position",
                "tune the controller; for intended cycles set tolerance in [phases] below their height",
            ),
            Self::TouchApart { apart, squeeze } => caution(
                "touch_apart",
                format!(
                    "the loading curve gives first touch {} mm {} the median of the other rules; the largest squeeze is {} mm",
                    significant(1e3 * apart.abs(), 2),
                    if *apart > 0.0 { "behind" } else { "before" },
                    significant(1e3 * squeeze, 4)
                ),
                "the body does not load by the law of this rule, or the force drifts in air; strains and modulus share the difference",
                "set touch in the test description to another rule or a displacement",
            ),
            Self::BaselineTilts(tilt) => caution(
                "baseline_tilts",
                format!(
                    "in air the force grows by {} N/m of travel, standard error {} N/m, over {} mm; {}",
                    significant(tilt.slope, 3),
                    significant(tilt.standard_error, 2),
                    significant(1e3 * tilt.observed, 3),
                    if tilt.in_time { "after the jaw has left it has gone on in time" } else { "the line is subtracted" }
                ),
                if tilt.in_time {
                    "the force drifts in time: forces of the hold contain the drift, and first touch was found without it"
                } else {
                    "virtual deflection of a cantilever, a spring beside the body or a drift; under the hold the line is drawn on"
                },
                "level the baseline of the instrument; where the force drifts in time, baseline = \"sloped\" in [force] of the test \
                 description subtracts the drift",
            ),
            Self::TouchOpen { behind, squeeze } => caution(
                "touch_open",
                format!(
                    "first touch is taken where the first ramp begins, but the rules find it {} mm behind; the largest squeeze is {} mm",
                    significant(1e3 * behind, 2),
                    significant(1e3 * squeeze, 4)
                ),
                "the force before is not that of air beyond doubt, nor that of a body; the distance is the error of first touch, which \
                 strains and modulus share",
                "set touch in the test description to a rule or a displacement, or correct the force without contact (baseline in [force])",
            ),
            Self::DisplacementNotZero { start } => caution(
                "displacement_not_zero",
                format!("the record begins at a displacement of {} mm without a force that goes with it", significant(1e3 * start, 4)),
                "displacements count from first touch here, and this one does not: strains and modulus are those of a body that is pressed that far already",
                "set touch = \"auto\" in [contact] of the test description, or the displacement at which the jaw meets the body",
            ),
            Self::AirAsTravel { air, squeeze } => caution(
                "air_as_travel",
                format!(
                    "the force begins {} mm behind the stated first touch; the largest squeeze is {} mm",
                    significant(1e3 * air, 2),
                    significant(1e3 * squeeze, 4)
                ),
                "the jaw went through air, or the body is soft at first: strains and modulus are those of a body that is pressed that much farther",
                "set touch = \"auto\" in [contact] of the test description, or the displacement at which the jaw meets the body",
            ),
            Self::ForceNotZero { start } => caution(
                "force_not_zero",
                format!("the record begins with a force of {} N at a displacement of zero", significant(*start, 3)),
                "the load cell was not tared, or the displacement counts from a preload: strains, modulus and equilibrium forces contain the difference",
                "set the force's offset in the test description where the load cell was not tared; where it was, touch = \"auto\" in [contact], or the displacement at first touch",
            ),
            Self::SignSuspicious { column, fall } => {
                let (fall, unit) = if column == "force" { (*fall, "N") } else { (1e3 * fall, "mm") };
                caution(
                    "sign_suspicious",
                    format!("the sign of the {column} may be reversed: it falls first, to {} {unit} below its start", significant(fall, 3)),
                    "compression, or stretch of a strip, must be positive; with the other sign loading reads as unloading",
                    "if the file has the opposite sign, give the unit of that column a minus sign among the columns (⟨columns⟩), or set sign = -1 in its table of the test description",
                )
            }
            Self::RateCoefficientTrend { verdict, holds, slope, interval: (low, high) } => {
                const NEAREST: &str = "use v of the hold whose strain is nearest to the one of interest";
                let slope = with_interval(*slope, (*low, *high));
                let observed = format!("over {holds} holds after loading d ln v/dεₑ is {slope}");
                let (severity, meaning, remedy) = match verdict {
                    TrendVerdict::FallsWithStrain => (
                        Caution,
                        "v falls with the equilibrium strain, as the paper reports: no single v describes this body",
                        NEAREST,
                    ),
                    TrendVerdict::RisesWithStrain => {
                        (Caution, "v rises with the equilibrium strain: no single v describes this body", NEAREST)
                    }
                    TrendVerdict::Undecided | TrendVerdict::Constant => (
                        Info,
                        "these holds do not determine whether they share one v or v changes with strain by a factor of 2",
                        "hold longer or at more strains",
                    ),
                };
                ("rate_coefficient_trend", severity, observed, meaning, remedy)
            }
            Self::ExponentNotListed {
                best,
                free,
                delta_bic,
            } => {
                let exponents = free.iter().map(|(hold, n)| format!("{} in hold {hold}", significant(*n, 3)));
                caution(
                    "exponent_not_listed",
                    format!(
                        "n = {best} is the best of the listed exponents, but a free exponent has a lower information criterion, by {}: n = {}",
                        significant(*delta_bic, 3),
                        listed(&exponents.collect::<Vec<_>>()),
                    ),
                    "the data contradict every listed exponent; parameters at one of them describe the holds only roughly",
                    "use the fits with a free exponent, or list an exponent in between",
                )
            }
            Self::RampRelaxes {
                hold,
                ramp,
                time_constant,
                share,
            } => (
                "ramp_relaxes",
                Info,
                format!(
                    "the ramp before hold {hold} took {} s, and the shortest time constant is {} s: after a ramp of even speed its amplitude is {} % of \
                     that of a step",
                    significant(*ramp, 3),
                    significant(*time_constant, 3),
                    significant(100.0 * share, 2),
                ),
                "the amplitudes and the start of the hold are those after this ramp, and no instantaneous ones",
                "⟨compare/ramps=measured⟩ gives the amplitudes of a step, if the force grows in proportion to the displacement",
            ),
            Self::UntilBeyondHolds { until, longest } => caution(
                "until_beyond_holds",
                format!(
                    "the fits were to end {} s after their start, and the longest hold ends {} s after it",
                    exact(*until),
                    significant(*longest, 4)
                ),
                "all samples of every hold are fitted, and no stretch is left to predict",
                "set until to less than the duration of the hold (⟨fit_until⟩)",
            ),
            Self::OverlayPoor { relative } => caution(
                "overlay_poor",
                format!(
                    "the simulated force differs from the measured force by {:.0} % of the largest force (root mean square)",
                    100.0 * relative
                ),
                "one law with these layers does not reproduce the whole record, even where it fits each hold closely",
                "check modulus, first touch and layers; compare v of the holds before using one for all of them",
            ),
            Self::NoOverlay { reason } => warning(
                "no_overlay",
                format!("the record could not be simulated: {reason}"),
                "the report has no simulated curve",
                "check geometry, first touch and units",
            ),
        }
    }
}

/// A value with its 95 % interval.
fn with_standard_error(value: f64, error: f64) -> String {
    let half = coverage_factor(0.95, f64::INFINITY) * error;
    with_interval(value, (value - half, value + half))
}

/// What residuals mean that no noise model describes.
pub(super) const NOISE_UNEXPLAINED: &str = "the law misses part of the shape, or a vibration, \
    steps or a controller act on the force; the intervals may be too narrow";

/// That no noise model describes the residuals of a law.
pub(super) fn no_noise_model(law: &str, noise: &str, p_value: f64) -> String {
    format!("no noise model describes the residuals of {law}: the closest is {noise}, {}", probability(p_value))
}

/// A small probability of a test.
fn probability(p_value: f64) -> String {
    if p_value < 1e-6 { "p < 10⁻⁶".to_owned() } else { format!("p = {}", significant(p_value, 1)) }
}

/// Numbers as people write a list.
fn series(numbers: &[f64]) -> String {
    numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

fn listed_holds(holds: &[usize]) -> String {
    let numbers: Vec<String> = holds.iter().map(usize::to_string).collect();
    format!("{} {}", if holds.len() == 1 { "hold" } else { "holds" }, numbers.join(", "))
}

const SHORT_OR_NOISY: &str = "the hold is too short or too noisy to determine the exponent";
const LONGER_OR_FASTER: &str = "hold longer, sample the first second faster, or fix the exponent from longer holds";

/// A value with its unit: mm or N.
fn measured(column: Column, value: f64) -> String {
    match column {
        Column::Displacement => format!("{} mm", significant(1e3 * value, 4)),
        Column::Force => format!("{} N", significant(value, 4)),
    }
}
