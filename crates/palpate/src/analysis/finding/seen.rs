//! What was seen, in numbers.

use super::Finding;
use crate::number::{counted, significant, with_error};
use crate::record::Column;

impl Finding {
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
                format!("the estimates of exponent and equilibrium correlate by {}", significant(*correlation, 3))
            }
            Self::TermsIndistinguishable { laws } => {
                format!("in {} terms merge or vanish", listed(laws))
            }
            Self::LawsIndistinguishable { laws } => format!("{} do equally well", listed(laws)),
            Self::DriftInsteadOfRelaxation { rise, fall } if *fall > 0.0 => {
                format!(
                    "after falling by {} N the force rises by {} N at constant displacement",
                    significant(*fall, 3),
                    significant(*rise, 3)
                )
            }
            Self::DriftInsteadOfRelaxation { rise, .. } => {
                format!("the force rises by {} N in a hold after loading", significant(*rise, 3))
            }
            Self::FeedbackControlled { travel, change } => format!(
                "the jaw moves by {} mm in the hold while the force changes by {} N only",
                significant(1e3 * travel, 3),
                significant(*change, 3)
            ),
            Self::NothingHeld { travel, change } => {
                format!(
                    "the jaw moves by {} mm in the hold and the force changes by {} N",
                    significant(1e3 * travel, 3),
                    significant(*change, 3)
                )
            }
            Self::Ruptured { time, before, after } => format!(
                "at {time:.3} s the body broke: the force had reached {} N, and is {} N where the jaw then stands",
                significant(*before, 4),
                significant(*after, 3)
            ),
            Self::ResidualsCorrelated {
                correlation,
                independent,
            } => format!(
                "neighbouring residuals correlate by {}; the samples count as {independent:.0} independent ones",
                significant(*correlation, 2)
            ),
            Self::NoRelaxation { change, standard_error } => {
                format!(
                    "the force changes by {} N with a standard error of {} N",
                    significant(*change, 3),
                    significant(*standard_error, 2)
                )
            }
            Self::TooFewSamples { found, needed } => {
                format!("the hold has {}, a fit needs {needed}", counted(*found, "sample"))
            }
            Self::SampledTooSlowly { share } => {
                format!("{:.0} % of the relaxation happens within the first sample interval", 100.0 * share)
            }
            Self::ContactOpen { until } => format!("there is no force until {until:.2} s"),
            Self::NoContactArea => "the contact has no area at this displacement".to_owned(),
            Self::Thinned { every } => format!("one sample in {every} is fitted"),
            Self::DropoutsRepaired { column, count: 1 } => format!("one row of the {} strays alone", column.name()),
            Self::DropoutsRepaired { column, count } => format!("{count} rows of the {} stray alone", column.name()),
            Self::RowsStray { count: 1, time, force } => {
                format!(
                    "one row of the force strays alone: {} N at {} s",
                    significant(*force, 4),
                    significant(*time, 5)
                )
            }
            Self::RowsStray { count, time, force } => format!(
                "{count} rows of the force stray alone, the first at {} s with {} N",
                significant(*time, 5),
                significant(*force, 4)
            ),
            Self::RowsAveraged { rows, averaged } => format!(
                "the file has {rows} rows, more than are kept; every {averaged} successive ones became their mean ({} samples)",
                rows.div_ceil(*averaged)
            ),
            Self::StressAsForce => {
                "the file gives stress, and the description no section: every number in N stands for as many Pa"
                    .to_owned()
            }
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
            Self::Saturated {
                column,
                level,
                rows,
                holds,
            } => {
                let among = match holds[..] {
                    [] => String::new(),
                    [hold] => format!(", some of them of hold {hold}"),
                    _ => format!(", some of them of holds {}", listed(holds)),
                };
                let level = measured(*column, *level);
                format!("the {} stands at its extreme, {level}, in {rows} rows{among}", column.name())
            }
            Self::Quantised { column, step } => {
                format!("the {} moves in steps of {}", column.name(), measured(*column, *step))
            }
            Self::PhasesFromForce => "the record has no displacement".to_owned(),
            Self::AirTravel { travel } => {
                format!("the jaw travels {} mm before the force rises", significant(1e3 * travel, 3))
            }
            Self::ModulusEstimated {
                modulus,
                standard_error,
            } => format!(
                "no modulus was given; the relaxed forces imply {} kPa",
                with_error(modulus / 1e3, standard_error.map_or(f64::NAN, |error| error / 1e3))
            ),
            Self::ModulusMismatch { given, implied } => format!(
                "the given modulus is {} kPa, the relaxed forces imply {} kPa (force over area and relative squeeze)",
                significant(given / 1e3, 4),
                significant(implied / 1e3, 4)
            ),
            Self::TouchUncertain {
                error,
                hold,
                shift,
                interval,
            } => format!(
                "first touch is known to {} mm, which moves the equilibrium strain of hold {hold} by {:.2} %; its interval is only ± {:.2} %",
                significant(1e3 * error, 2),
                100.0 * shift,
                100.0 * interval
            ),
            Self::TouchSpread { spread, squeeze } => format!(
                "rules for first touch scatter by {} mm (robust standard deviation), the largest squeeze is {} mm",
                significant(1e3 * spread, 2),
                significant(1e3 * squeeze, 4)
            ),
            Self::TouchNotFound { method } => format!("the rule \"{}\" finds no first touch", method.name()),
            Self::ClocksSkewed { skew, standard_error } => format!(
                "where ramps start and end the force bends {} ms {} than the displacement",
                with_error(1e3 * skew.abs(), 1e3 * standard_error),
                if *skew > 0.0 { "later" } else { "earlier" }
            ),
            Self::ClocksOpen {
                skew: Some((skew, error)),
            } => format!(
                "the skew of the clocks was to be found; the starts and ends of ramps say {} ms",
                with_error(1e3 * skew, 1e3 * error)
            ),
            Self::ClocksOpen { skew: None } => {
                "the skew of the clocks was to be found; fewer than three starts and ends of ramps show in both columns"
                    .to_owned()
            }
            Self::JawHunts { height, period } => format!(
                "the jaw swings by {} mm from peak to peak every {} s about the places it holds",
                significant(1e3 * height, 2),
                significant(*period, 2)
            ),
            Self::TouchApart { apart, squeeze } => format!(
                "the loading curve puts first touch {} mm {} the middle of the other rules, the largest squeeze is {} mm",
                significant(1e3 * apart.abs(), 2),
                if *apart > 0.0 { "behind" } else { "before" },
                significant(1e3 * squeeze, 4)
            ),
            Self::SignSuspicious { column, fall } if column == "force" => {
                format!("the force first falls, to {} N below its start", significant(*fall, 3))
            }
            Self::SignSuspicious { column, fall } => {
                format!("the {column} first falls, to {} mm below its start", significant(1e3 * fall, 3))
            }
            Self::RateCoefficientTrend {
                holds,
                slope,
                interval: (low, high),
                ..
            } => format!(
                "over {holds} holds after loading d ln v/dεₑ = {} (interval {} to {})",
                significant(*slope, 3),
                significant(*low, 3),
                significant(*high, 3)
            ),
            Self::OverlayPoor { relative } => format!(
                "measured and simulated force differ by {:.0} % of the largest force (root mean square)",
                100.0 * relative
            ),
            Self::NoOverlay { reason } => format!("the record could not be simulated: {reason}"),
        }
    }
}

/// A value with its unit: mm or N.
fn measured(column: Column, value: f64) -> String {
    match column {
        Column::Displacement => format!("{} mm", significant(1e3 * value, 4)),
        Column::Force => format!("{} N", significant(value, 4)),
    }
}

/// "a, b and c".
fn listed<T: ToString>(things: &[T]) -> String {
    let names: Vec<String> = things.iter().map(ToString::to_string).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
