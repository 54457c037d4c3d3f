//! Properties of the columns of a record, and their corrections.

use palpate::analysis::{Analysis, ClockSkew};
use palpate::record::{Correction, Values};
use palpate::segment::TouchEstimate;
use serde_json::{Map, Value};

use crate::result::word;

documents! {
    /// The columns of a record as they came into the analysis.
    SignalsDocument(analysis: &Analysis) with {
        let (stamps, signals) = (&analysis.signals.stamps, &analysis.signals);
    } {
        /// Median time between samples, s.
        sample_interval_s: Option<f64> = stamps.interval.map(|interval| interval.median),
        /// 5 % and 95 % quantile of it, s.
        sample_interval_range_s: Option<[f64; 2]> = stamps.interval.map(|interval| [interval.p5, interval.p95]),
        /// Whether these differ by more than a tenth of the median.
        irregular: bool = stamps.interval.is_some_and(|interval| interval.irregular),
        /// Stretches without samples.
        gaps: usize = stamps.gaps.count,
        /// The longest, s.
        longest_gap_s: f64 = stamps.gaps.longest,
        /// The displacement, m.
        displacement: Option<ValuesDocument> = signals.displacement.as_ref().map(ValuesDocument::new),
        /// The force, N.
        force: ValuesDocument = ValuesDocument::new(&signals.force),
        /// Clocks that stamped the columns: 2 where displacement and force have stamps of their own.
        clocks: usize = analysis.record.clocks(),
        /// Delay of the force stamps after those of the displacement; `null` where the ramps do not determine it.
        clock_skew: Option<SkewDocument> = analysis.skew.map(SkewDocument::new),
    }

    /// A measured column; values in its SI unit.
    ValuesDocument(values: &Values) {
        /// Rows that are outliers.
        strays: usize = values.strays.count,
        /// Rows at the extreme value in runs of five or more.
        rows_at_extreme: usize = values.saturation.map_or(0, |saturation| saturation.rows),
        /// Whether the column was clipped there (else it was held).
        clipped: bool = values.saturation.is_some_and(|saturation| saturation.clipped),
        /// Rounding step of the values; `null` where there is none.
        rounding_step: Option<f64> = values.step,
    }

    /// Delay of the force stamps.
    SkewDocument(skew: ClockSkew) {
        /// Delay of the force stamps, s.
        skew_s: f64 = skew.skew,
        /// Its standard error, s.
        standard_error_s: f64 = skew.standard_error,
        /// Number of starts and ends of ramps used.
        edges: usize = skew.edges,
    }

    /// First touch, with the estimate of each rule.
    TouchDocument(analysis: &Analysis) with {
        let contact = &analysis.contact;
    } {
        /// Displacement of first touch as measured, m.
        displacement_m: f64 = contact.tare.displacement,
        /// The rule that found it; `null` where it was given or is the foot of the first ramp.
        method: Option<String> = contact.method.map(|method| method.name().to_owned()),
        /// Its standard error, m.
        standard_error_m: Option<f64> = contact.displacement_error,
        /// Robust standard deviation of the estimates of the rules, m.
        spread_m: Option<f64> = contact.spread,
        /// Estimate of each rule.
        estimates: Vec<TouchEstimateDocument> = contact.estimates.iter().map(TouchEstimateDocument::new).collect(),
    }

    /// Estimate of first touch by one rule.
    TouchEstimateDocument(estimate: &TouchEstimate) {
        /// The rule.
        method: String = estimate.method.name().to_owned(),
        /// Displacement of first touch, m.
        displacement_m: f64 = estimate.displacement,
    }

    /// A correction of the record.
    CorrectionDocument(done: &Correction) with {
        let stored = serde_json::to_value(done).unwrap_or_default();
        let code = word(&stored["correction"]);
        let others = stored.as_object().into_iter().flatten().filter(|(name, _)| *name != "correction");
        let numbers = others.map(|(name, value)| (with_unit(&code, name).to_owned(), value.clone())).collect();
    } {
        /// Stable code.
        code: String = code,
        /// In words.
        stated: String = done.to_string(),
        /// Its values, with their units in their names.
        numbers: Map<String, Value> = numbers,
    }
}

/// The name of a number of a correction, with its unit.
fn with_unit<'a>(code: &str, name: &'a str) -> &'a str {
    match name {
        "largest" if code == "stamps_sorted" => "largest_step_back_s",
        "largest" => "largest_m",
        "left_out" => "rows_left_out",
        "count" => "rows",
        "force" => "force_n",
        "displacement" => "displacement_m",
        "skew" => "skew_s",
        "from" => "from_s",
        "gap" => "gap_s",
        "shift" => "shift_s",
        "standard_error" => "standard_error_s",
        "rate" => "rate_hz",
        "interval" => "interval_before_s",
        "time_constant" => "time_constant_s",
        "tilt" => "tilt_n_per_m",
        "level" => "level_n",
        "slope" => "slope_n_per_s",
        without_unit => without_unit,
    }
}
