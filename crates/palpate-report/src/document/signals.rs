//! What the columns of a record are like, and what was done to them.

use palpate::analysis::Analysis;
use palpate::record::{Correction, Stamps, Values};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::word;

/// The columns of a record as they came into the analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SignalsDocument {
    /// Median time between samples, s.
    pub sample_interval_s: Option<f64>,
    /// 5 % and 95 % quantile of it, s.
    pub sample_interval_range_s: Option<[f64; 2]>,
    /// Whether these differ by more than a tenth of the median.
    pub irregular: bool,
    /// Stretches without samples.
    pub gaps: usize,
    /// The longest, s.
    pub longest_gap_s: f64,
    /// The displacement, m.
    pub displacement: Option<ValuesDocument>,
    /// The force, N.
    pub force: ValuesDocument,
    /// How much later the force is stamped than the displacement; `null` where the ramps do not tell.
    pub clock_skew: Option<SkewDocument>,
}

/// A measured column; numbers in its own SI unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ValuesDocument {
    /// Single rows that stray alone.
    pub strays: usize,
    /// Rows that stand at the extreme value in runs of five or more.
    pub rows_at_extreme: usize,
    /// Whether the column was clipped there (else it was held).
    pub clipped: bool,
    /// Step that the values were rounded to; `null` where none shows.
    pub rounding_step: Option<f64>,
}

/// By how much the stamps of the force lag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SkewDocument {
    /// Time that the force is stamped too late, s.
    pub skew_s: f64,
    /// Its standard error, s.
    pub standard_error_s: f64,
    /// Starts and ends of ramps that it rests on.
    pub edges: usize,
}

/// First touch, and what every rule says of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TouchDocument {
    /// Displacement of first touch as measured, m.
    pub displacement_m: f64,
    /// The rule that found it; `null` where it was given or is the foot of the first ramp.
    pub method: Option<String>,
    /// Its standard error, m.
    pub standard_error_m: Option<f64>,
    /// Robust standard deviation of what the rules say, m.
    pub spread_m: Option<f64>,
    /// What each rule says.
    pub estimates: Vec<TouchEstimateDocument>,
}

/// What one rule says of first touch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TouchEstimateDocument {
    /// The rule.
    pub method: String,
    /// Displacement of first touch, m.
    pub displacement_m: f64,
}

/// One thing that was done to the record, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CorrectionDocument {
    /// Stable code.
    pub code: String,
    /// In words.
    pub said: String,
    /// Its numbers, with their units in their names.
    pub numbers: serde_json::Map<String, serde_json::Value>,
}

impl SignalsDocument {
    pub(super) fn new(analysis: &Analysis) -> Self {
        let Stamps { interval, gaps, .. } = analysis.signals.stamps;
        Self {
            sample_interval_s: interval.map(|interval| interval.median),
            sample_interval_range_s: interval.map(|interval| [interval.p5, interval.p95]),
            irregular: interval.is_some_and(|interval| interval.irregular),
            gaps: gaps.count,
            longest_gap_s: gaps.longest,
            displacement: analysis.signals.displacement.as_ref().map(ValuesDocument::from),
            force: ValuesDocument::from(&analysis.signals.force),
            clock_skew: analysis.skew.map(|skew| SkewDocument {
                skew_s: skew.skew,
                standard_error_s: skew.standard_error,
                edges: skew.edges,
            }),
        }
    }
}

impl From<&Values> for ValuesDocument {
    fn from(values: &Values) -> Self {
        Self {
            strays: values.strays.count,
            rows_at_extreme: values.saturation.map_or(0, |saturation| saturation.rows),
            clipped: values.saturation.is_some_and(|saturation| saturation.clipped),
            rounding_step: values.step,
        }
    }
}

impl TouchDocument {
    pub(super) fn new(analysis: &Analysis) -> Self {
        let contact = &analysis.contact;
        Self {
            displacement_m: contact.tare.displacement,
            method: contact.method.map(|method| method.name().to_owned()),
            standard_error_m: contact.displacement_error,
            spread_m: contact.spread,
            estimates: contact
                .estimates
                .iter()
                .map(|estimate| TouchEstimateDocument {
                    method: estimate.method.name().to_owned(),
                    displacement_m: estimate.displacement,
                })
                .collect(),
        }
    }
}

impl From<&Correction> for CorrectionDocument {
    fn from(done: &Correction) -> Self {
        let (code, numbers) = parts(done);
        Self {
            code: code.to_owned(),
            said: done.to_string(),
            numbers: numbers.into_iter().map(|(name, value)| (name.to_owned(), value)).collect(),
        }
    }
}

type Numbers = Vec<(&'static str, serde_json::Value)>;

fn parts(done: &Correction) -> (&'static str, Numbers) {
    match done {
        Correction::StampsSorted {
            clock: of,
            rows,
            largest,
        } => (
            "stamps_sorted",
            vec![("clock", word(of).into()), ("rows", (*rows).into()), ("largest_step_back_s", (*largest).into())],
        ),
        Correction::StampsMerged {
            clock: of,
            rows,
            merged,
            identical,
        } => (
            "stamps_merged",
            vec![
                ("clock", word(of).into()),
                ("rows", (*rows).into()),
                ("merged", (*merged).into()),
                ("identical", (*identical).into()),
            ],
        ),
        Correction::RowsAveraged { rows, averaged } => {
            ("rows_averaged", vec![("rows", (*rows).into()), ("averaged", (*averaged).into())])
        }
        Correction::ClocksJoined { left_out } => ("clocks_joined", vec![("rows_left_out", (*left_out).into())]),
        Correction::DropoutsReplaced { column: of, count } => {
            ("dropouts_replaced", vec![("column", word(of).into()), ("rows", (*count).into())])
        }
        Correction::Tared(tare) => {
            ("tared", vec![("force_n", tare.force.into()), ("displacement_m", tare.displacement.into())])
        }
        Correction::StressAsForce => ("stress_as_force", Vec::new()),
        Correction::AirRunSubtracted => ("air_run_subtracted", Vec::new()),
        Correction::SkewRemoved {
            skew,
            standard_error,
            left_out,
        } => (
            "skew_removed",
            vec![
                ("skew_s", (*skew).into()),
                ("standard_error_s", (*standard_error).into()),
                ("rows_left_out", (*left_out).into()),
            ],
        ),
        Correction::Resampled {
            rate,
            interval,
            averaged,
        } => (
            "resampled",
            vec![
                ("rate_hz", (*rate).into()),
                ("interval_before_s", (*interval).into()),
                ("averaged", (*averaged).into()),
            ],
        ),
        Correction::ComplianceRemoved { largest } => ("compliance_removed", vec![("largest_m", (*largest).into())]),
        Correction::DeflectionRemoved { largest } => ("deflection_removed", vec![("largest_m", (*largest).into())]),
        Correction::BaselineRemoved {
            baseline,
            level,
            slope,
            samples,
        } => (
            "baseline_removed",
            vec![
                ("baseline", word(baseline).into()),
                ("level_n", (*level).into()),
                ("slope_n_per_s", (*slope).into()),
                ("samples", (*samples).into()),
            ],
        ),
    }
}
