//! What each finding says: its code, how much it matters, what was seen, what it may mean, what helps.

use super::Finding;
use super::Severity::{self, Caution, Info, Warning};
use crate::fit::TrendVerdict;
use crate::forecast::listed;
use crate::number::{counted, significant, with_error};
use crate::record::Column;

/// Code, severity, what was seen, what it may mean, and what helps.
type Told = (&'static str, Severity, String, &'static str, &'static str);

fn info(code: &'static str, seen: String, meaning: &'static str, remedy: &'static str) -> Told {
    (code, Info, seen, meaning, remedy)
}

fn caution(code: &'static str, seen: String, meaning: &'static str, remedy: &'static str) -> Told {
    (code, Caution, seen, meaning, remedy)
}

fn warning(code: &'static str, seen: String, meaning: &'static str, remedy: &'static str) -> Told {
    (code, Warning, seen, meaning, remedy)
}

impl Finding {
    /// All that is said of it.
    pub(super) fn told(&self) -> Told {
        match self {
            Self::EquilibriumExtrapolated { beyond } => caution(
                "equilibrium_extrapolated",
                format!(
                    "the hold shows {:.0} % of the fitted relaxation; {:.0} % lies beyond its end",
                    100.0 * (1.0 - beyond),
                    100.0 * beyond
                ),
                "the equilibrium and the exponent lean on each other; another exponent would put the equilibrium elsewhere",
                "hold longer, or compare holds with one fixed exponent",
            ),
            Self::ExponentUndetermined { interval } => caution(
                "exponent_undetermined",
                match interval {
                    Some((low, high)) => {
                        format!("the interval of the free exponent runs from {low:.1} to {high:.1}")
                    }
                    None => "the free exponent ended at the edge of its range".to_owned(),
                },
                SHORT_OR_NOISY,
                LONGER_OR_FASTER,
            ),
            Self::ExponentsAlike { exponents } => {
                let list: Vec<String> = exponents.iter().map(|n| format!("{n}")).collect();
                let seen = format!("the exponents {} fit equally well", list.join(", "));
                info("exponents_alike", seen, SHORT_OR_NOISY, LONGER_OR_FASTER)
            }
            Self::RateAtBound { exponent } => warning(
                "rate_at_bound",
                format!("the fit with n = {exponent:.3} ended at the edge of the range of its rate"),
                "over this hold the law is a straight line, a pure power or a step: its rate and amplitude cannot be told apart",
                "hold longer or sample faster; do not use the numbers of this fit",
            ),
            Self::ParametersAtBound { laws } => info(
                "parameters_at_bound",
                format!("the fits of {} ended at the edge of their range", listed(laws)),
                "over this hold such a law is a simpler one in disguise (a straight line, a step, a pure power); its numbers mean nothing",
                "use a law with fewer numbers",
            ),
            Self::ExponentConfounded { correlation } => caution(
                "exponent_confounded",
                format!("the estimates of exponent and equilibrium correlate by {}", significant(*correlation, 3)),
                "a higher exponent with a lower equilibrium fits nearly as well; each is only as good as the other",
                "hold longer, or fix the exponent from longer holds of the same material",
            ),
            Self::TermsIndistinguishable { laws } => info(
                "terms_indistinguishable",
                format!("in {} terms merge or vanish", listed(laws)),
                "the data carry fewer terms than the series has",
                "use a law with fewer numbers",
            ),
            Self::LawsIndistinguishable { laws } => info(
                "laws_indistinguishable",
                format!("{} do equally well", listed(laws)),
                "these data do not tell which of these laws holds; beyond the hold they will part",
                "use the one with the fewest numbers, or hold longer",
            ),
            Self::DriftInsteadOfRelaxation { rise, fall } => caution(
                "drift_instead_of_relaxation",
                if *fall > 0.0 {
                    format!(
                        "after falling by {} N the force rises by {} N at constant displacement",
                        significant(*fall, 3),
                        significant(*rise, 3)
                    )
                } else {
                    format!("the force rises by {} N in a hold after loading", significant(*rise, 3))
                },
                "load cell, temperature or frame drift, or the jaw still moves: no law of relaxation does this",
                "warm up the load cell, check the tare, end the fit before the rise (until)",
            ),
            Self::FeedbackControlled { travel, change } => caution(
                "feedback_controlled",
                format!(
                    "the jaw moves by {} mm in the hold while the force changes by {} N only",
                    significant(1e3 * travel, 3),
                    significant(*change, 3)
                ),
                "the machine held the force, not the displacement: the body creeps, and a law of relaxation does not apply",
                "fit the displacement as creep (⟨compare/creep⟩), or hold the displacement",
            ),
            Self::NothingHeld { travel, change } => caution(
                "nothing_held",
                format!(
                    "the jaw moves by {} mm in the hold and the force changes by {} N",
                    significant(1e3 * travel, 3),
                    significant(*change, 3)
                ),
                "the machine held neither: part of what the force does is due to the motion, which the laws leave out",
                "let the fit begin when the jaw has settled (hold_start), end it earlier (until), or hold the jaw better",
            ),
            Self::Ruptured(rupture) => warning(
                "ruptured",
                format!(
                    "at {:.3} s the body broke: the force had reached {} N, and is {} N where the jaw then stands",
                    rupture.time,
                    significant(rupture.before, 4),
                    significant(rupture.after, 3)
                ),
                "what stands after a rupture is no hold: nothing was fitted to it, and what comes later is another body",
                "squeeze less; if nothing broke, give the hold by hand ([[phases.hold]] in the test description)",
            ),
            Self::ResidualsCorrelated { correlation, independent } => caution(
                "residuals_correlated",
                format!(
                    "neighbouring residuals correlate by {}; the samples count as {independent:.0} independent ones",
                    significant(*correlation, 2)
                ),
                "either the law misses part of the shape, or the noise is slow (drift, quantisation, filtering); plain standard errors are too small, the intervals given are widened for it",
                "look at the residuals in the report; try a free exponent or a later start of the hold",
            ),
            Self::NoRelaxation { change, standard_error } => info(
                "no_relaxation",
                format!(
                    "the force changes by {} N with a standard error of {} N",
                    significant(*change, 3),
                    significant(*standard_error, 2)
                ),
                "the contact is relaxed, or open, or its relaxation is below the noise",
                "nothing, if the contact was meant to be open or at rest",
            ),
            Self::TooFewSamples { found, needed } => warning(
                "too_few_samples",
                format!("the hold has {}, a fit needs {needed}", counted(*found, "sample")),
                "nothing was fitted to this hold",
                "sample faster or hold longer",
            ),
            Self::SampledTooSlowly { share } => caution(
                "sampled_too_slowly",
                format!("{:.0} % of the relaxation happens within the first sample interval", 100.0 * share),
                "the rate and the amplitude at the start of the hold rest on a few samples",
                "sample faster at the start of holds",
            ),
            Self::ContactOpen { until } => caution(
                "contact_open",
                format!("there is no force until {until:.2} s"),
                "the jaw retreated faster than the body recovered and left it; the hold is fitted from where they met again",
                "unload more slowly, or in smaller steps",
            ),
            Self::NoContactArea => warning(
                "no_contact_area",
                "the contact has no area at this displacement".to_owned(),
                "the jaw is at or before first touch, so that no strain can be told from the force; the hold is not fitted",
                "check first touch (touch = \"...\" in the test description)",
            ),
            Self::Thinned { every } => {
                let seen = format!("one sample in {every} is fitted");
                info("thinned", seen, "the fit loses nothing but time", "nothing")
            }
            Self::DropoutsRepaired { column, count } => caution(
                "dropouts_repaired",
                match count {
                    1 => format!("one row of the {} strays alone", column.name()),
                    _ => format!("{count} rows of the {} stray alone", column.name()),
                },
                "the encoder or the logger lost a value; the mean of the neighbours stands in its place",
                "check the logger",
            ),
            Self::RowsStray { count, time, force } => {
                let (time, force) = (significant(*time, 5), significant(*force, 4));
                caution(
                    "rows_stray",
                    match count {
                        1 => format!("one row of the force strays alone: {force} N at {time} s"),
                        _ => format!("{count} rows of the force stray alone, the first at {time} s with {force} N"),
                    },
                    "a spike of the load cell or the logger pulls fits its way, a real peak does not belong to a hold",
                    "remove the rows if they are no forces; `⟨compare/loss=huber⟩` makes them count less",
                )
            }
            Self::RowsAveraged { rows, averaged } => caution(
                "rows_averaged",
                format!(
                    "the file has {rows} rows, more than are kept; every {averaged} successive ones became their mean ({} samples)",
                    rows.div_ceil(*averaged)
                ),
                "what is shorter than that many rows is smoothed away: peaks are lower, and the first moments of a hold are coarser",
                "nothing, if the test is long against that; else cut the file, or keep fewer rows a second",
            ),
            Self::StressAsForce => caution(
                "stress_as_force",
                "the file gives stress, and the description no section: every number in N stands for as many Pa"
                    .to_owned(),
                "the forces are those on 1 m²; rates and exponents stay what they are",
                "describe the body with its section, as a strip, cylinder or block, or read N as Pa",
            ),
            Self::StampsMerged { rows, merged } => (
                "stamps_merged",
                // Where most rows went the column of the time is likely not that of the samples.
                if 2 * merged > *rows { Warning } else { Caution },
                format!("{merged} of {rows} rows have the time stamp of the row before"),
                "the clock is coarser than the sampling, or rows were written twice; the mean of such rows stands in their place",
                "write the time with more digits; if most rows share stamps, check that this is the column of the time",
            ),
            Self::StampsSorted { rows, largest } => caution(
                "stamps_sorted",
                format!("{rows} rows are stamped earlier than rows before them, by up to {largest:.4} s"),
                "a buffer of the logger came late; rows stand where their stamps say",
                "check the logger",
            ),
            Self::Gaps { count, longest, from } => caution(
                "gaps",
                match count {
                    1 => format!("there is no sample for {longest:.3} s from {from:.3} s on"),
                    _ => format!(
                        "in {count} places samples are missing, the longest time for {longest:.3} s from {from:.3} s on"
                    ),
                },
                "the logger paused: a ramp inside a gap is a straight line, and a peak in it is lost",
                "check the logger",
            ),
            Self::Saturated { column, level, rows, holds } => {
                let among = match holds[..] {
                    [] => String::new(),
                    [hold] => format!(", some of them of hold {hold}"),
                    _ => format!(", some of them of holds {}", listed(holds)),
                };
                let (name, level) = (column.name(), measured(*column, *level));
                warning(
                    "saturated",
                    format!("the {name} stands at its extreme, {level}, in {rows} rows{among}"),
                    "the sensor was at the end of its range: the true value went on, and peaks, fits and moduli that rest on it are wrong",
                    "repeat the test with a larger range, and do not use holds at that value",
                )
            }
            Self::Quantised { column, step } => caution(
                "quantised",
                format!("the {} moves in steps of {}", column.name(), measured(*column, *step)),
                "changes of less than a step are not seen; late in a hold the relaxation is a staircase, whose errors are not those of noise",
                "use a sensor with a smaller range, or write more digits",
            ),
            Self::PhasesFromForce => info(
                "phases_from_force",
                "the record has no displacement".to_owned(),
                "phases come from the force; the edges of holds are less sure, and there are no strains",
                "record the displacement, or give the hold's limits",
            ),
            Self::AirTravel { travel } => info(
                "air_travel",
                format!("the jaw travels {} mm before the force rises", significant(1e3 * travel, 3)),
                "displacement and force are counted from first touch",
                "set touch in the test description if this is not where they met",
            ),
            Self::ModulusEstimated { modulus, standard_error } => info(
                "modulus_estimated",
                format!(
                    "no modulus was given; the equilibrium forces imply {} kPa",
                    with_error(modulus / 1e3, standard_error.map_or(f64::NAN, |error| error / 1e3))
                ),
                "strains and v rest on this estimate; n and the relative rate do not",
                "give the modulus in the test description if it is known",
            ),
            Self::ModulusMismatch { given, implied } => caution(
                "modulus_mismatch",
                format!(
                    "the given modulus is {} kPa, the equilibrium forces imply {} kPa (force over area and relative squeeze)",
                    significant(given / 1e3, 4),
                    significant(implied / 1e3, 4)
                ),
                "the body is stiffer or softer than described, bonded or friction-locked, or its first touch is elsewhere; strains scale with the modulus",
                "leave the modulus out to have it estimated, or check geometry and first touch",
            ),
            Self::TouchUncertain { error, hold, shift, interval } => caution(
                "touch_uncertain",
                format!(
                    "first touch is known to {} mm, which moves the equilibrium strain of hold {hold} by {:.2} %; its interval is only ± {:.2} %",
                    significant(1e3 * error, 2),
                    100.0 * shift,
                    100.0 * interval
                ),
                "intervals of strains take first touch as exact; between records these strains differ by more than they say",
                "sample the first ramp faster, or measure first touch and set touch in the test description",
            ),
            Self::TouchSpread { spread, squeeze } => caution(
                "touch_spread",
                format!(
                    "rules for first touch scatter by {} mm (robust standard deviation), the largest squeeze is {} mm",
                    significant(1e3 * spread, 2),
                    significant(1e3 * squeeze, 4)
                ),
                "where the body begins hangs on the rule; strains, areas and a modulus from this record share that error",
                "sample the approach faster and start it in air, or set touch in the test description to a rule or a displacement",
            ),
            Self::TouchNotFound { method } => caution(
                "touch_not_found",
                format!("the rule \"{}\" finds no first touch", method.name()),
                "first touch was found as with \"auto\" instead",
                "choose another rule, or give the displacement of first touch",
            ),
            Self::ClocksSkewed { skew, standard_error } => caution(
                "clocks_skewed",
                format!(
                    "where ramps start and end the force bends {} ms {} than the displacement",
                    with_error(1e3 * skew.abs(), 1e3 * standard_error),
                    if *skew > 0.0 { "later" } else { "earlier" }
                ),
                "two clocks or a filter: fits of holds do not mind, but forces in ramps stand at the wrong displacement",
                "set skew = \"auto\" in [clock] of the test description to take it away",
            ),
            Self::ClocksOpen {
                skew: Some((skew, error)),
                one_clock: true,
            } => caution(
                "clocks_open",
                format!(
                    "one clock stamps force and displacement, though the starts and ends of ramps seem {} ms apart",
                    with_error(1e3 * skew, 1e3 * error)
                ),
                "one clock needs no skew taken away: nothing was moved",
                "nothing, unless the force did come late by that much: then give the skew in [clock] of the test description as a time",
            ),
            Self::ClocksOpen { skew, .. } => caution(
                "clocks_open",
                match skew {
                    Some((skew, error)) => format!(
                        "the skew of the clocks was to be found; the starts and ends of ramps say {} ms",
                        with_error(1e3 * skew, 1e3 * error)
                    ),
                    None => {
                        "the skew of the clocks was to be found; fewer than three starts and ends of ramps show in both columns"
                            .to_owned()
                    }
                },
                "nothing was moved: forces in ramps may stand at the wrong displacement",
                "sample ramps faster, or give the skew in [clock] of the test description as a time",
            ),
            Self::JawHunts(ripple) => caution(
                "jaw_hunts",
                format!(
                    "the jaw swings by {} mm from peak to peak every {} s about the places it holds",
                    significant(1e3 * ripple.height, 2),
                    significant(ripple.period, 2)
                ),
                "a controller hunts, or cycles are meant: holds are those of the mean place, and forces in them follow the swing",
                "tune the controller; for cycles that are meant set tolerance in [phases] below their height",
            ),
            Self::TouchApart { apart, squeeze } => caution(
                "touch_apart",
                format!(
                    "the loading curve puts first touch {} mm {} the middle of the other rules, the largest squeeze is {} mm",
                    significant(1e3 * apart.abs(), 2),
                    if *apart > 0.0 { "behind" } else { "before" },
                    significant(1e3 * squeeze, 4)
                ),
                "the body does not load as the law of this rule does, or drifts in air; strains, areas and a modulus share the difference",
                "set touch in the test description to another rule, or to a displacement",
            ),
            Self::SignSuspicious { column, fall } => {
                let (fall, unit) = if column == "force" { (*fall, "N") } else { (1e3 * fall, "mm") };
                caution(
                    "sign_suspicious",
                    format!("the {column} first falls, to {} {unit} below its start", significant(fall, 3)),
                    "palpate counts compression, or stretch of a strip, as positive in displacement and force; loading is taken for unloading otherwise",
                    "if the file counts the other way round, set sign = -1 for that column in the test description",
                )
            }
            Self::RateCoefficientTrend { verdict, holds, slope, interval: (low, high) } => {
                const NEAREST: &str = "use v of the hold whose strain is nearest to the one of interest";
                let [slope, low, high] = [slope, low, high].map(|value| significant(*value, 3));
                let seen = format!("over {holds} holds after loading d ln v/dεₑ = {slope} (interval {low} to {high})");
                let (severity, meaning, remedy) = match verdict {
                    TrendVerdict::FallsWithStrain => (
                        Caution,
                        "v falls as the equilibrium strain grows, as the authors of the paper saw: no single v describes this body",
                        NEAREST,
                    ),
                    TrendVerdict::RisesWithStrain => {
                        (Caution, "v rises with the equilibrium strain: no single v describes this body", NEAREST)
                    }
                    TrendVerdict::Undecided | TrendVerdict::Constant => (
                        Info,
                        "the holds may share one v, or v may change with strain by a factor of 2; these holds do not tell",
                        "hold at more strains, or longer",
                    ),
                };
                ("rate_coefficient_trend", severity, seen, meaning, remedy)
            }
            Self::OverlayPoor { relative } => caution(
                "overlay_poor",
                format!(
                    "measured and simulated force differ by {:.0} % of the largest force (root mean square)",
                    100.0 * relative
                ),
                "each hold may be fitted well, but one law with these layers does not join them through the ramps",
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

const SHORT_OR_NOISY: &str = "the hold is too short or too noisy to tell these laws apart";
const LONGER_OR_FASTER: &str = "hold longer, sample the first second faster, or fix the exponent from longer holds";

/// A value with its unit: mm or N.
fn measured(column: Column, value: f64) -> String {
    match column {
        Column::Displacement => format!("{} mm", significant(1e3 * value, 4)),
        Column::Force => format!("{} N", significant(value, 4)),
    }
}
