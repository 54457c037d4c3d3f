//! `palpate.analysis/1`: one analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, JointAnalysis, Signal};
use palpate::fit::{Estimate, ExponentChoice};
use palpate::segment::After;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::comparison::HoldComparisonDocument;
use super::fit::FitDocument;
use super::settings::SettingsDocument;
use super::signals::{CorrectionDocument, SignalsDocument, TouchDocument};
use super::software::Software;
use crate::page::Finding;
use crate::result::{Input, mode_word, word};

/// A stretch of the record in one phase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SegmentDocument {
    /// `rest`, `loading`, `hold` or `unloading`.
    pub phase: String,
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Time of the last sample, s.
    pub end_s: f64,
    /// First sample, from 0.
    pub first_row: usize,
    /// Last sample, from 0.
    pub last_row: usize,
}

/// One hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HoldDocument {
    /// Number of the hold, from 1.
    pub index: usize,
    /// Time of its first sample, s.
    pub start_s: f64,
    /// Time of its last sample, s.
    pub end_s: f64,
    /// Time from which the laws are fitted, s.
    pub fit_start_s: f64,
    /// Displacement of the jaw (median) since first touch, m.
    pub displacement_m: Option<f64>,
    /// `loading` or `unloading`.
    pub after: Option<String>,
    /// What the machine held: `displacement`, `force` or `neither`.
    pub mode: Option<String>,
    /// `type_1` (the force falls), `type_2` (it rises) or `none`.
    pub relaxation: String,
    /// Change of the force over the hold, N.
    pub force_change_n: f64,
    /// Its standard error, N.
    pub force_change_standard_error_n: f64,
    /// Probability that noise alone makes such a change.
    pub p_value: f64,
    /// Force where the fit starts, N.
    pub force_start_n: f64,
    /// Force at the end, N.
    pub force_end_n: f64,
    /// What was fitted: `strain` or `force`.
    pub signal: String,
    /// Fits, time domain first.
    pub fits: Vec<FitDocument>,
    /// How far noise takes the rate domain from the truth.
    pub rate_bias: Option<RateBiasDocument>,
    /// Index into `fits` of the preferred one (lowest information criterion).
    pub preferred: Option<usize>,
    /// Index into `fits` of the lowest listed exponent that fits as well as the best one.
    pub lowest_order: Option<usize>,
    /// Laws compared on this hold; `null` where that was left out or could not be done.
    pub comparison: Option<HoldComparisonDocument>,
    /// What to know about this hold.
    pub findings: Vec<Finding>,
}

/// What the rate domain makes of simulated holds whose truth is the preferred fit in time, with the noise of the measured one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RateBiasDocument {
    /// The exponent, given in all fits.
    pub exponent: f64,
    /// Simulated holds.
    pub repetitions: usize,
    /// v of the rate domain over the true one, median.
    pub rate_coefficient_ratio: f64,
    /// Lowest and highest of them.
    pub rate_coefficient_ratio_range: [f64; 2],
    /// Equilibrium of the rate domain less the true one over the amplitude, median.
    pub equilibrium_shift_ratio: f64,
}

/// A row of Table I or Table II: the paper's layout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TableRow {
    /// Number of the hold.
    pub hold: usize,
    /// Displacement, m.
    pub displacement_m: Option<f64>,
    /// ε_e.
    pub equilibrium_strain: f64,
    /// Its standard error.
    pub equilibrium_strain_standard_error: Option<f64>,
    /// v, 1/s.
    pub rate_coefficient_per_s: f64,
    /// Its standard error, 1/s.
    pub rate_coefficient_standard_error_per_s: Option<f64>,
}

/// Tables I and II of the paper for this record, at the common exponent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TablesDocument {
    /// The lowest listed exponent that fits all holds best.
    pub common_exponent: Option<f64>,
    /// Holds after loading.
    pub loading: Vec<TableRow>,
    /// Holds after unloading.
    pub unloading: Vec<TableRow>,
    /// d ln v/dε_e over the holds after loading.
    pub trend_of_log_rate_coefficient: Option<f64>,
    /// Its confidence interval.
    pub trend_interval: Option<[f64; 2]>,
}

/// The latency law with one v, and one n, for several holds, against a law for each hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct JointDocument {
    /// Holds after `loading`, or `all`.
    pub which: String,
    /// Numbers of the holds.
    pub holds: Vec<usize>,
    /// n.
    pub exponent: f64,
    /// Its standard error; `null` if it was given.
    pub exponent_standard_error: Option<f64>,
    /// v, 1/s.
    pub rate_coefficient_per_s: f64,
    /// Its standard error, 1/s.
    pub rate_coefficient_standard_error_per_s: Option<f64>,
    /// Its confidence interval, 1/s.
    pub rate_coefficient_interval_per_s: Option<[f64; 2]>,
    /// Probability of so large a difference to a law for each hold if they share one.
    pub p_value: Option<f64>,
    /// Bayesian information criterion less that of a law for each hold.
    pub delta_bic: f64,
    /// d ln v/dε_e, weighted by the errors of the holds.
    pub trend_of_log_rate_coefficient: Option<f64>,
    /// Its confidence interval.
    pub trend_interval: Option<[f64; 2]>,
    /// `constant`, `falls_with_strain`, `rises_with_strain` or `undecided`.
    pub verdict: String,
}

/// The record's own displacement simulated with the fitted numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OverlayDocument {
    /// n.
    pub exponent: f64,
    /// v, 1/s.
    pub rate_coefficient_per_s: f64,
    /// m.
    pub layers: f64,
    /// Whether m was fitted to the record.
    pub layers_fitted: bool,
    /// Root mean square of measured less simulated force, N.
    pub rmse_n: f64,
    /// The same as a share of the largest force.
    pub relative_rmse: f64,
}

/// One analysed record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "palpate.analysis/1")]
pub struct AnalysisDocument {
    /// `palpate.analysis/1`.
    pub schema: String,
    /// The record.
    pub input: Input,
    /// What the analysis ran with.
    pub settings: SettingsDocument,
    /// What the columns are like.
    pub signals: SignalsDocument,
    /// What was done to the measured columns, in order.
    pub corrections: Vec<CorrectionDocument>,
    /// First touch.
    pub first_touch: TouchDocument,
    /// All phases.
    pub segments: Vec<SegmentDocument>,
    /// All holds.
    pub holds: Vec<HoldDocument>,
    /// The paper's tables; `null` where the signal is not strain.
    pub tables: Option<TablesDocument>,
    /// One law for several holds; empty where fewer than two holds gave strains.
    pub joint: Vec<JointDocument>,
    /// The simulated record.
    pub overlay: Option<OverlayDocument>,
    /// What to know about the record as a whole.
    pub findings: Vec<Finding>,
    /// What wrote this.
    pub software: Software,
}

impl AnalysisDocument {
    /// The document of an analysis.
    #[must_use]
    pub fn new(analysis: &Analysis, input: Input) -> Self {
        Self {
            schema: "palpate.analysis/1".to_owned(),
            input,
            settings: SettingsDocument::new(analysis),
            signals: SignalsDocument::new(analysis),
            corrections: analysis.record.corrections().iter().map(CorrectionDocument::from).collect(),
            first_touch: TouchDocument::new(analysis),
            segments: segments(analysis),
            holds: analysis.holds.iter().map(hold).collect(),
            tables: tables(analysis),
            joint: analysis.across.joint.iter().map(joint).collect(),
            overlay: analysis.overlay.as_ref().map(|overlay| OverlayDocument {
                exponent: overlay.model.law.exponent(),
                rate_coefficient_per_s: overlay.model.law.rate_coefficient(),
                layers: overlay.model.layers.count(),
                layers_fitted: overlay.layers_fitted,
                rmse_n: overlay.rmse,
                relative_rmse: overlay.relative,
            }),
            findings: analysis.findings.iter().map(Finding::from).collect(),
            software: Software::this(),
        }
    }
}

fn joint(joint: &JointAnalysis) -> JointDocument {
    let fixed = match joint.choice {
        ExponentChoice::Fixed(n) => n,
        ExponentChoice::Free => f64::NAN,
    };
    let estimate = |name: &str| joint.fit.shared(name).map(|number| number.estimate);
    let rate = estimate("rate_coefficient").unwrap_or(Estimate::fixed(f64::NAN));
    let exponent = estimate("exponent").unwrap_or(Estimate::fixed(fixed));
    let trend = joint.comparison.trend.as_ref();
    JointDocument {
        which: word(joint.which),
        holds: joint.holds.clone(),
        exponent: exponent.value,
        exponent_standard_error: exponent.standard_error,
        rate_coefficient_per_s: rate.value,
        rate_coefficient_standard_error_per_s: rate.standard_error,
        rate_coefficient_interval_per_s: rate.interval.map(Into::into),
        p_value: joint.comparison.p,
        delta_bic: joint.comparison.delta_bic,
        trend_of_log_rate_coefficient: trend.map(|trend| trend.slope),
        trend_interval: trend.map(|trend| trend.interval.into()),
        verdict: word(joint.comparison.verdict),
    }
}

fn segments(analysis: &Analysis) -> Vec<SegmentDocument> {
    let time = analysis.record.time();
    let document = |segment: &palpate::segment::Segment| SegmentDocument {
        phase: word(segment.phase),
        start_s: time[segment.start],
        end_s: time[segment.end - 1],
        first_row: segment.start,
        last_row: segment.end - 1,
    };
    analysis.segmentation.segments.iter().map(document).collect()
}

fn hold(hold: &HoldAnalysis) -> HoldDocument {
    let delta = |i: usize| hold.order.as_ref().map(|order| order.candidates[i].delta_bic);
    let time = hold
        .fits
        .iter()
        .enumerate()
        .map(|(i, fit)| FitDocument::new(fit, hold, delta(i), hold.predictions[i]));
    let rate = hold.rate_fits.iter().flatten().map(|fit| FitDocument::new(fit, hold, None, None));
    HoldDocument {
        index: hold.number,
        start_s: hold.start,
        end_s: hold.end,
        fit_start_s: hold.fit_start,
        displacement_m: hold.displacement,
        after: hold.after.map(word),
        mode: hold.segment.mode.map(mode_word),
        relaxation: word(hold.relaxation.kind),
        force_change_n: hold.relaxation.change,
        force_change_standard_error_n: hold.relaxation.standard_error,
        p_value: hold.relaxation.p_value,
        force_start_n: hold.force_start,
        force_end_n: hold.force_end,
        signal: word(hold.signal),
        fits: time.chain(rate).collect(),
        rate_bias: hold.rate_bias.map(|bias| RateBiasDocument {
            exponent: bias.exponent,
            repetitions: bias.repetitions,
            rate_coefficient_ratio: bias.coefficient,
            rate_coefficient_ratio_range: [bias.coefficient_range.0, bias.coefficient_range.1],
            equilibrium_shift_ratio: bias.equilibrium,
        }),
        preferred: hold.order.as_ref().and_then(|order| order.preferred),
        lowest_order: hold.order.as_ref().and_then(|order| order.lowest_order),
        comparison: hold.comparison.as_ref().map(|found| HoldComparisonDocument::new(found, hold.signal.into())),
        findings: hold.findings.iter().map(Finding::from).collect(),
    }
}

fn tables(analysis: &Analysis) -> Option<TablesDocument> {
    let n = analysis.across.common_exponent?;
    let rows = |after: After| -> Vec<TableRow> {
        let holds = analysis.holds.iter().filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain);
        let row = |hold: &HoldAnalysis| {
            let fit = hold.fits.iter().find(|fit| fit.choice() == ExponentChoice::Fixed(n))?;
            Some(TableRow {
                hold: hold.number,
                displacement_m: hold.displacement,
                equilibrium_strain: fit.equilibrium().value,
                equilibrium_strain_standard_error: fit.equilibrium().standard_error,
                rate_coefficient_per_s: fit.rate_coefficient().value,
                rate_coefficient_standard_error_per_s: fit.rate_coefficient().standard_error,
            })
        };
        holds.filter_map(row).collect()
    };
    analysis.specimen.as_ref()?;
    Some(TablesDocument {
        common_exponent: Some(n),
        loading: rows(After::Loading),
        unloading: rows(After::Unloading),
        trend_of_log_rate_coefficient: analysis.across.trend.map(|trend| trend.slope),
        trend_interval: analysis.across.trend.and_then(|trend| trend.interval).map(|(low, high)| [low, high]),
    })
}
