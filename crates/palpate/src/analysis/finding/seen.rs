//! What was seen, in numbers.

use super::Finding;
use crate::laws::Law;
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
            Self::Ruptured { time, before, after } => format!(
                "at {time:.3} s the body broke: the force had reached {before:.3} N, and is {after:.3} N where the jaw then stands"
            ),
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
