//! `palpate.comparison/1`: laws compared on the holds of records.

use std::collections::BTreeMap;

use palpate::fit::{Estimate, Fit, Forecast, SampleChoice, SpectrumFit};
use palpate::forecast::{CompareOptions, Comparison, Row, Verdict};
use palpate::segment::HoldStart;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::software::Software;
use crate::page::Finding;
use crate::result::{ComparedHold, ComparedRecord, Input, LeftOut, Quantity, hold_start_word, word};

/// A number of a law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NumberDocument {
    /// The best value.
    pub value: f64,
    /// Standard error for white noise; `null` where the data do not determine the number.
    pub standard_error: Option<f64>,
    /// Confidence interval, widened for correlated residuals.
    pub interval: Option<[f64; 2]>,
}

/// What a law fitted to the first part of the hold says of the rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForecastDocument {
    /// Time up to which was fitted, s after the start of the fit.
    pub cut_s: f64,
    /// Samples fitted.
    pub fitted: usize,
    /// Samples foretold.
    pub foretold: usize,
    /// Root mean square error over those as a share of the change of the signal.
    pub error: f64,
    /// Mean error as such a share; above zero where the law runs above the data.
    pub bias: f64,
}

/// A peak of the spectrum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PeakDocument {
    /// Time, s.
    pub time_s: f64,
    /// Amplitude in the unit of the signal.
    pub amplitude: f64,
}

/// The dense spectrum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SpectrumDocument {
    /// The constant, in the unit of the signal.
    pub equilibrium: f64,
    /// Whether the slowest time carries weight, so that the equilibrium is a convention of the grid.
    pub open_ended: bool,
    /// Times of the grid, s.
    pub times_s: Vec<f64>,
    /// Amplitude of each, in the unit of the signal.
    pub amplitudes: Vec<f64>,
    /// Peaks, fastest first.
    pub peaks: Vec<PeakDocument>,
    /// Strength of smoothing.
    pub smoothing: f64,
}

/// One law on one hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LawDocument {
    /// Name of the law, as `--laws` takes it.
    pub law: String,
    /// Numbers that the data determine; not a whole one for a smoothed spectrum.
    pub parameters: f64,
    /// Numbers of the law by name, with the unit at the end of the name.
    pub numbers: BTreeMap<String, NumberDocument>,
    /// The spectrum, if that is the law.
    pub spectrum: Option<SpectrumDocument>,
    /// Root mean square residual over the whole hold as a share of the change of the signal; `null` where there is no fit.
    pub rmse: Option<f64>,
    /// AICc at the number of samples, less the lowest.
    pub delta_aicc: Option<f64>,
    /// BIC at the effective number of samples, less the lowest.
    pub delta_bic: Option<f64>,
    /// One forecast a cut point; `null` where the first part could not be fitted.
    pub forecasts: Vec<Option<ForecastDocument>>,
    /// Root mean square of their errors.
    pub forward_score: Option<f64>,
    /// Why the fit ended, as in `palpate.analysis/1`; `null` where there is none.
    pub termination: Option<String>,
    /// Why there is no fit.
    pub error: Option<String>,
}

/// Which law to use.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerdictDocument {
    /// The law with the fewest numbers among those that do best.
    pub law: String,
    /// `clear`, `likely` or `open`.
    pub certainty: String,
    /// All laws that do as well, this one included.
    pub alike: Vec<String>,
    /// Cut points at which it is best or as good.
    pub cuts_won: usize,
    /// What each other law costs: its error over that of the chosen one (`forward`), or its excess of BIC (`information`).
    pub costs: BTreeMap<String, Option<f64>>,
    /// All that in one sentence.
    pub sentence: String,
}

/// Laws compared on one hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HoldComparisonDocument {
    /// What the laws were fitted to: `strain`, `force` or `displacement`.
    pub signal: String,
    /// Its unit: `1`, `N` or `m`.
    pub signal_unit: String,
    /// Laws are ranked by `forward` (score) or `information` (BIC).
    pub ranking: String,
    /// Cut points at which something is left to foretell, s after the start of the fit.
    pub cuts_s: Vec<f64>,
    /// Change of the signal over the hold, in its unit.
    pub change: f64,
    /// Standard deviation of its noise, in its unit.
    pub noise: f64,
    /// Samples.
    pub samples: usize,
    /// Samples that count as independent.
    pub effective_samples: f64,
    /// The laws, best first.
    pub laws: Vec<LawDocument>,
    /// Which to use; `null` if none could be fitted.
    pub verdict: Option<VerdictDocument>,
}

/// One hold of a compared record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedHoldDocument {
    /// Number of the hold, from 1.
    pub index: usize,
    /// `loading` or `unloading`; in creep of the force.
    pub after: Option<String>,
    /// Time of its first sample, s.
    pub start_s: f64,
    /// Time of its last sample, s.
    pub end_s: f64,
    /// Time from which the laws are fitted, s.
    pub fit_start_s: f64,
    /// Displacement that was held, m; `null` in creep.
    pub displacement_m: Option<f64>,
    /// Force that was held, N; `null` in relaxation.
    pub force_n: Option<f64>,
    /// The comparison; `null` where nothing could be fitted.
    pub comparison: Option<HoldComparisonDocument>,
    /// What to know about this hold.
    pub findings: Vec<Finding>,
}

/// One compared record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedRecordDocument {
    /// The record.
    pub input: Input,
    /// Its holds.
    pub holds: Vec<ComparedHoldDocument>,
    /// What to know about the record as a whole.
    pub findings: Vec<Finding>,
}

/// What a comparison ran with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparisonSettingsDocument {
    /// `relaxation` or `creep`.
    pub response: String,
    /// The laws, all defaults written out.
    pub laws: Vec<String>,
    /// Cut points as shares of the duration of a hold.
    pub cuts: Vec<f64>,
    /// What linear laws take the loading before a hold for: `step` or `measured`.
    pub ramps: String,
    /// `squares`, `huber` or `tukey`.
    pub loss: String,
    /// `all` or `log:N`.
    pub samples: String,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// Fitted only this long from the start of the fit, s.
    pub fit_until_s: Option<f64>,
    /// `peak`, `settled` or `peak + … s`.
    pub hold_start: String,
}

/// Laws compared on the holds of records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "palpate.comparison/1")]
pub struct ComparisonDocument {
    /// `palpate.comparison/1`.
    pub schema: String,
    /// What the comparison ran with.
    pub settings: ComparisonSettingsDocument,
    /// The records.
    pub records: Vec<ComparedRecordDocument>,
    /// Files on which nothing could be compared.
    pub left_out: Vec<LeftOut>,
    /// What wrote this.
    pub software: Software,
}

impl ComparisonDocument {
    /// The document of compared records.
    #[must_use]
    pub fn new(records: &[ComparedRecord], left_out: &[LeftOut], settings: ComparisonSettingsDocument) -> Self {
        Self {
            schema: "palpate.comparison/1".to_owned(),
            settings,
            records: records.iter().map(ComparedRecordDocument::from).collect(),
            left_out: left_out.to_vec(),
            software: Software::this(),
        }
    }
}

impl ComparisonSettingsDocument {
    /// The settings of a comparison.
    #[must_use]
    pub fn new(options: &CompareOptions, hold_start: HoldStart, fit_until: Option<f64>) -> Self {
        Self {
            response: word(options.fit.response),
            laws: options.laws().iter().map(ToString::to_string).collect(),
            cuts: options.cuts.clone(),
            ramps: word(options.ramps),
            loss: word(options.fit.loss),
            samples: match options.fit.samples {
                SampleChoice::All => "all".to_owned(),
                SampleChoice::LogSpaced(count) => format!("log:{count}"),
            },
            confidence: options.fit.confidence,
            fit_until_s: fit_until,
            hold_start: hold_start_word(hold_start),
        }
    }
}

impl From<&ComparedRecord> for ComparedRecordDocument {
    fn from(record: &ComparedRecord) -> Self {
        Self {
            input: record.input.clone(),
            holds: record.holds.iter().map(ComparedHoldDocument::from).collect(),
            findings: record.findings.iter().map(Finding::from).collect(),
        }
    }
}

impl From<&ComparedHold> for ComparedHoldDocument {
    fn from(hold: &ComparedHold) -> Self {
        let is_creep = hold.quantity == Quantity::Displacement;
        Self {
            index: hold.number,
            after: hold.after.map(word),
            start_s: hold.start,
            end_s: hold.end,
            fit_start_s: hold.fit_start,
            displacement_m: hold.level.filter(|_| !is_creep),
            force_n: hold.level.filter(|_| is_creep),
            comparison: hold.comparison.as_ref().map(|found| HoldComparisonDocument::new(found, hold.quantity)),
            findings: hold.findings.iter().map(Finding::from).collect(),
        }
    }
}

impl HoldComparisonDocument {
    /// The document of a comparison of laws on samples of a quantity.
    #[must_use]
    pub fn new(comparison: &Comparison, quantity: Quantity) -> Self {
        let lowest =
            comparison.rows.iter().filter_map(|row| row.criteria).map(|c| c.aicc).fold(f64::INFINITY, f64::min);
        Self {
            signal: quantity.name().to_owned(),
            signal_unit: match quantity {
                Quantity::Strain => "1",
                Quantity::Force => "N",
                Quantity::Displacement => "m",
            }
            .to_owned(),
            ranking: word(comparison.ranking),
            cuts_s: comparison.cuts.clone(),
            change: comparison.change,
            noise: comparison.noise,
            samples: comparison.samples,
            effective_samples: comparison.effective_samples,
            laws: comparison.rows.iter().map(|row| law(row, comparison.change, lowest, quantity)).collect(),
            verdict: comparison.verdict.as_ref().map(|verdict| self::verdict(comparison, verdict)),
        }
    }
}

fn verdict(comparison: &Comparison, verdict: &Verdict) -> VerdictDocument {
    VerdictDocument {
        law: verdict.law.to_string(),
        certainty: word(verdict.certainty),
        alike: verdict.alike.iter().map(ToString::to_string).collect(),
        cuts_won: verdict.cuts_won,
        costs: verdict.costs.iter().map(|(law, cost)| (law.to_string(), finite(*cost))).collect(),
        sentence: comparison.sentence().unwrap_or_default(),
    }
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn law(row: &Row, change: f64, lowest_aicc: f64, quantity: Quantity) -> LawDocument {
    let fit = row.fit.as_ref().ok();
    let without = row.spectrum.is_none().then(|| row.fit.as_ref().err()).flatten();
    LawDocument {
        law: row.law.to_string(),
        parameters: row.numbers,
        numbers: fit.map(|fit| numbers(fit, quantity)).unwrap_or_default(),
        spectrum: row.spectrum.as_ref().map(SpectrumDocument::from),
        rmse: finite(row.rmse / change),
        delta_aicc: row.criteria.and_then(|criteria| finite(criteria.aicc - lowest_aicc)),
        delta_bic: row.delta_bic.and_then(finite),
        forecasts: row.forward.forecasts.iter().map(|found| found.map(|found| forecast(&found, change))).collect(),
        forward_score: row.forward.score,
        termination: fit.map(|fit| word(fit.termination)),
        error: without.map(ToString::to_string),
    }
}

fn numbers(fit: &Fit, quantity: Quantity) -> BTreeMap<String, NumberDocument> {
    let named = |number: &palpate::fit::Parameter| {
        let suffix = quantity.suffix(number.unit)?;
        Some((format!("{}{suffix}", number.name), NumberDocument::from(&number.estimate)))
    };
    fit.parameters.iter().filter_map(named).filter(|(_, number)| number.value.is_finite()).collect()
}

fn forecast(forecast: &Forecast, change: f64) -> ForecastDocument {
    ForecastDocument {
        cut_s: forecast.cut,
        fitted: forecast.fitted,
        foretold: forecast.foretold,
        error: forecast.rmse / change,
        bias: forecast.bias / change,
    }
}

impl From<&Estimate> for NumberDocument {
    fn from(estimate: &Estimate) -> Self {
        Self {
            value: estimate.value,
            standard_error: estimate.standard_error,
            interval: estimate.interval.map(|(low, high)| [low, high]),
        }
    }
}

impl From<&SpectrumFit> for SpectrumDocument {
    fn from(fit: &SpectrumFit) -> Self {
        let peaks = fit.peaks().into_iter().map(|peak| PeakDocument {
            time_s: peak.time,
            amplitude: fit.sign * peak.amplitude,
        });
        Self {
            equilibrium: fit.equilibrium,
            open_ended: fit.is_open_ended(),
            times_s: fit.times.clone(),
            amplitudes: fit.amplitudes.iter().map(|height| fit.sign * height).collect(),
            peaks: peaks.collect(),
            smoothing: fit.strength,
        }
    }
}
