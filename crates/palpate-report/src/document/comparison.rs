//! `palpate.comparison/1`: laws compared on the holds of records.

use std::collections::BTreeMap;

use palpate::fit::{Forecast, SampleChoice, SpectrumFit, SpectrumPeak};
use palpate::forecast::{CompareOptions, Comparison, ForecastMember, Forecasted, HoldForecast, Row, Verdict};
use palpate::segment::HoldStart;

use super::settings::unusual;
use super::software::Software;
use crate::page::Finding;
use crate::result::{
    Answer, ComparedHold, ComparedRecord, Input, LeftOut, ParameterDocument, ParameterRow, Parameters, Quantity,
    formula, hold_start_word, parameters_of, word,
};

documents! {
    /// Prediction of the rest of the hold by a law fitted to its first part.
    ForecastDocument(forecast: &Forecast, change: f64) {
        /// End of the fitted part, s after the start of the fit.
        cut_s: f64 = forecast.cut,
        /// Samples fitted.
        fitted: usize = forecast.fitted,
        /// Samples held out of the fit.
        held_out: usize = forecast.held_out,
        /// Root mean square error over the held-out samples as a share of the change of the signal.
        error: f64 = forecast.rmse / change,
        /// Mean error as the same share; positive where the law exceeds the data.
        bias: f64 = forecast.bias / change,
        /// Root mean square error in each eighth of the time from the cut to the end, as the same share; `null` where there are no samples.
        error_by_eighth: Vec<Option<f64>> =
            forecast.square_by_eighth.iter().map(|square| square.map(|square| square.sqrt() / change)).collect(),
    }

    /// A peak of the spectrum.
    PeakDocument(peak: &SpectrumPeak, sign: f64) {
        /// Time, s.
        time_s: f64 = peak.time,
        /// Amplitude in the unit of the signal.
        amplitude: f64 = sign * peak.amplitude,
    }

    /// The dense spectrum.
    SpectrumDocument(fit: &SpectrumFit) {
        /// The constant, in the unit of the signal.
        equilibrium: f64 = fit.equilibrium,
        /// Whether the slowest time carries weight, so that the equilibrium is a convention of the grid.
        open_ended: bool = fit.is_open_ended(),
        /// Times of the grid, s.
        times_s: Vec<f64> = fit.times.clone(),
        /// Amplitude of each, in the unit of the signal.
        amplitudes: Vec<f64> = fit.amplitudes.iter().map(|height| fit.sign * height).collect(),
        /// Peaks, fastest first.
        peaks: Vec<PeakDocument> = fit.peaks().iter().map(|peak| PeakDocument::new(peak, fit.sign)).collect(),
        /// Strength of smoothing.
        smoothing: f64 = fit.strength,
    }

    /// One law on one hold.
    LawDocument(row: &Row, change: f64, lowest_aicc: f64, quantity: Quantity) with {
        let fit = row.fit.as_ref().ok();
        let without = row.spectrum.is_none().then(|| row.fit.as_ref().err()).flatten();
        let forecast = |found: &Option<Forecast>| found.as_ref().map(|found| ForecastDocument::new(found, change));
    } {
        /// Name of the law, as `--laws` takes it.
        law: String = row.law.to_string(),
        /// Effective number of parameters; not an integer for a smoothed spectrum.
        effective_parameters: f64 = row.effective_parameters,
        /// The law with its parameter values, t from the start of the fit; `null` where there is none.
        formula: Option<String> = fit.map(|fit| formula(fit, quantity)),
        /// Parameters of the law by name.
        parameters: Parameters = fit.map(|fit| parameters_of(fit, quantity)).unwrap_or_default(),
        /// Method of the intervals, as in `palpate.analysis/1`; `null` where there is no fit.
        interval_method: Option<String> = fit.map(|fit| fit.interval_method.name().to_owned()),
        /// The spectrum, if that is the law.
        spectrum: Option<SpectrumDocument> = row.spectrum.as_ref().map(SpectrumDocument::new),
        /// Root mean square residual over the whole hold as a share of the change of the signal; `null` where there is no fit.
        rmse: Option<f64> = finite(row.rmse / change),
        /// AICc at the number of samples, less the lowest.
        delta_aicc: Option<f64> = row.criteria.and_then(|criteria| finite(criteria.aicc - lowest_aicc)),
        /// BIC at the effective number of samples, less the lowest.
        delta_bic: Option<f64> = row.delta_bic.and_then(finite),
        /// One forecast a cut point; `null` where the first part could not be fitted.
        forecasts: Vec<Option<ForecastDocument>> = row.forward.forecasts.iter().map(forecast).collect(),
        /// Root mean square of their errors.
        forward_score: Option<f64> = row.forward.score,
        /// Why the fit ended, as in `palpate.analysis/1`; `null` where there is none.
        termination: Option<String> = fit.map(|fit| word(fit.termination)),
        /// Why there is no fit.
        error: Option<String> = without.map(ToString::to_string),
    }

    /// A law, or a straight course, that is combined with others.
    MemberDocument(member: &ForecastMember, weight: f64) {
        /// Name of the law, or the course.
        member: String = member.to_string(),
        /// Its weight; those of all members add up to 1.
        weight: f64 = weight,
    }

    /// The forecast at a time.
    ForecastedDocument(elapsed: f64, found: Forecasted) {
        /// Time since the start of the fit, s.
        elapsed_s: f64 = elapsed,
        /// The forecast, in the unit of the signal.
        value: f64 = found.value,
        /// Lower end of the band that covers a sample.
        low: f64 = found.low,
        /// Upper end.
        high: f64 = found.high,
    }

    /// What the hold will show next, from all laws together.
    HoldForecastDocument(comparison: &Comparison, forecast: &HoldForecast) with {
        let at = |share: &f64| {
            let elapsed = share * forecast.duration;
            ForecastedDocument::new(elapsed, forecast.at(elapsed, FORECAST_CONFIDENCE))
        };
    } {
        /// Duration of the hold so far, s.
        duration_s: f64 = forecast.duration,
        /// Confidence of the bands.
        confidence: f64 = FORECAST_CONFIDENCE,
        /// The forecast at times beyond the hold.
        at: Vec<ForecastedDocument> = FORECAST_AT.iter().map(at).collect(),
        /// What is combined.
        members: Vec<MemberDocument> =
            forecast.combined.members.iter().map(|(member, weight)| MemberDocument::new(member, *weight)).collect(),
        /// Time since the start of the fit up to which other holds are known, s, where their courses are among the members; from there on the
        /// forecast goes on as laws without them do.
        known_until_s: Option<f64> = forecast.beyond.as_ref().map(|(until, _)| *until),
        /// Number of cut points at which the combination was tried.
        cuts: usize = forecast.cuts,
        /// Number of other holds of the record that it was tried on.
        other_holds: usize = forecast.other_holds,
        /// Root mean square error there, over the change until then and ln(t/T) + 0.1.
        error: f64 = forecast.combined.error,
        /// The forecast in one sentence.
        sentence: String = comparison.forecast_sentence().unwrap_or_default(),
    }

    /// Which law to use.
    VerdictDocument(comparison: &Comparison, verdict: &Verdict) {
        /// The law with the lowest BIC among those that are not distinguishable from the best.
        law: String = verdict.law.to_string(),
        /// Probability that no law that was compared predicts what follows better by more than a fifth.
        probability: f64 = verdict.probability,
        /// Range of that probability: what measured holds alone and what simulated ones alone say.
        probability_range: [f64; 2] = verdict.probability_range.into(),
        /// `clear` from a probability of 0.9 on, `likely` from 0.75 on, or `open`.
        certainty: String = word(verdict.certainty),
        /// `refuted` or `unpredictive` where every law is; this one is then the best approximation and no recommendation.
        reservation: Option<String> = verdict.reservation.map(word),
        /// All laws that are not distinguishable from the best, this one included.
        indistinguishable: Vec<String> = verdict.indistinguishable.iter().map(ToString::to_string).collect(),
        /// Number of cut points at which its error is within a fifth of the smallest.
        cuts_near_best: usize = verdict.cuts_near_best,
        /// Cost of each other law: the ratio of its error to that of the chosen one (`forward`), or its excess of BIC (`information`).
        costs: BTreeMap<String, Option<f64>> =
            verdict.costs.iter().map(|(law, cost)| (law.to_string(), finite(*cost))).collect(),
        /// The verdict in one sentence.
        sentence: String = comparison.sentence().unwrap_or_default(),
    }

    /// Laws compared on one hold.
    HoldComparisonDocument(comparison: &Comparison, quantity: Quantity) with {
        let (rows, change) = (&comparison.rows, comparison.change);
        let lowest = rows.iter().filter_map(|row| row.criteria).map(|c| c.aicc).fold(f64::INFINITY, f64::min);
    } {
        /// The fitted quantity: `strain`, `force` or `displacement`.
        signal: String = word(quantity),
        /// Its unit: `1`, `N` or `m`.
        signal_unit: String = quantity.unit().to_owned(),
        /// Laws are ranked by `forward` (score) or `information` (BIC).
        ranking: String = word(comparison.ranking),
        /// Cut points with held-out samples, s after the start of the fit.
        cuts_s: Vec<f64> = comparison.cuts.clone(),
        /// Change of the signal over the hold, in its unit.
        change: f64 = comparison.change,
        /// Standard deviation of its noise, in its unit.
        noise: f64 = comparison.noise,
        /// Samples.
        samples: usize = comparison.samples,
        /// Equivalent number of independent samples.
        effective_samples: f64 = comparison.effective_samples,
        /// The laws, best first.
        laws: Vec<LawDocument> = rows.iter().map(|row| LawDocument::new(row, change, lowest, quantity)).collect(),
        /// What the hold will show next; `null` where it is too short for that.
        forecast: Option<HoldForecastDocument> =
            comparison.forecast.as_ref().map(|forecast| HoldForecastDocument::new(comparison, forecast)),
        /// The law to use; `null` if none could be fitted.
        verdict: Option<VerdictDocument> =
            comparison.verdict.as_ref().map(|verdict| VerdictDocument::new(comparison, verdict)),
    }

    /// One hold of a compared record.
    ComparedHoldDocument(hold: &ComparedHold) with {
        let is_creep = hold.quantity == Quantity::Displacement;
    } {
        /// Number of the hold, from 1.
        index: usize = hold.number,
        /// `loading` or `unloading`; for creep, that of the force.
        after: Option<String> = hold.after.map(word),
        /// Time of its first sample, s.
        start_s: f64 = hold.start,
        /// Time of its last sample, s.
        end_s: f64 = hold.end,
        /// Time from which the laws are fitted, s.
        fit_start_s: f64 = hold.fit_start,
        /// Held displacement, m; `null` for creep.
        displacement_m: Option<f64> = hold.level.filter(|_| !is_creep),
        /// Held force, N; `null` for relaxation.
        force_n: Option<f64> = hold.level.filter(|_| is_creep),
        /// The comparison; `null` where nothing could be fitted.
        comparison: Option<HoldComparisonDocument> =
            hold.comparison.as_ref().map(|found| HoldComparisonDocument::new(found, hold.quantity)),
        /// Findings about this hold.
        findings: Vec<Finding> = hold.findings.iter().map(Finding::from).collect(),
    }

    /// One compared record.
    ComparedRecordDocument(record: &ComparedRecord) {
        /// Which law to use, with its formula and its parameters.
        answer: Answer = Answer::new(record),
        /// The record.
        input: Input = record.input.clone(),
        /// Its holds.
        holds: Vec<ComparedHoldDocument> = record.holds.iter().map(ComparedHoldDocument::new).collect(),
        /// Findings about the record.
        findings: Vec<Finding> = record.findings.iter().map(Finding::from).collect(),
    }

    /// Settings of a comparison.
    ComparisonSettingsDocument(options: &CompareOptions, hold_start: HoldStart, fit_until: Option<f64>) {
        /// `relaxation` or `creep`.
        response: String = word(options.fit.response),
        /// The laws, all defaults written out.
        laws: Vec<String> = options.laws().iter().map(ToString::to_string).collect(),
        /// Cut points as shares of the duration of a hold.
        cuts: Vec<f64> = options.cuts.clone(),
        /// Loading history before a hold, as linear laws take it: `step` or `measured`.
        ramps: String = word(options.ramps),
        /// `squares`, `huber` or `tukey`.
        loss: String = word(options.fit.loss),
        /// `all` or `log:N`.
        samples: String = match options.fit.samples {
            SampleChoice::All => "all".to_owned(),
            SampleChoice::LogSpaced(count) => format!("log:{count}"),
        },
        /// Coverage of the intervals.
        confidence: f64 = options.fit.confidence,
        /// Method of the intervals, if not automatic: `curvature`, `profile` or `bootstrap`.
        intervals?: Option<String> = unusual(options.fit.intervals),
        /// Duration of the fitted part from the start of the fit, s.
        fit_until_s: Option<f64> = fit_until,
        /// `peak`, `settled` or `peak + … s`.
        hold_start: String = hold_start_word(hold_start),
    }

    /// Laws compared on the holds of records.
    #[schemars(title = "palpate.comparison/1")]
    ComparisonDocument(records: &[ComparedRecord], left_out: &[LeftOut], settings: ComparisonSettingsDocument) {
        /// `palpate.comparison/1`.
        schema: String = "palpate.comparison/1".to_owned(),
        /// Settings of the comparison.
        settings: ComparisonSettingsDocument = settings,
        /// The records.
        records: Vec<ComparedRecordDocument> = records.iter().map(ComparedRecordDocument::new).collect(),
        /// Files without a comparison.
        left_out: Vec<LeftOut> = left_out.to_vec(),
        /// The software that wrote this.
        software: Software = Software::this(),
    }
}

/// Durations of the hold at which its forecast is stated.
const FORECAST_AT: [f64; 5] = [1.0, 1.25, 1.5, 2.0, 3.0];

/// Confidence of the bands of a forecast.
const FORECAST_CONFIDENCE: f64 = 0.95;

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

impl HoldComparisonDocument {
    /// Every parameter of the laws that this holds for, a row each.
    pub(super) fn parameter_rows(&self, input: &Input, hold: usize, of: impl Fn(&str) -> bool) -> Vec<ParameterRow> {
        let chosen = self.verdict.as_ref().map(|verdict| &verdict.law);
        let row = |law: &LawDocument, name: &String, parameter: &ParameterDocument| ParameterRow {
            record: input.path.clone(),
            part: input.part.clone(),
            hold: Some(hold),
            law: law.law.clone(),
            name: name.clone(),
            parameter: parameter.clone(),
            termination: law.termination.clone().unwrap_or_default(),
            domain: "time".to_owned(),
            is_recommended: chosen == Some(&law.law),
        };
        let laws = self.laws.iter().filter(|law| of(&law.law));
        laws.flat_map(|law| {
            law.parameters.iter().map(|(name, parameter)| row(law, name, parameter)).collect::<Vec<_>>()
        })
        .collect()
    }
}

impl ComparisonDocument {
    /// Every parameter of every law on every hold, a row each.
    #[must_use]
    pub fn parameter_rows(&self) -> Vec<ParameterRow> {
        let of_hold = |record: &ComparedRecordDocument, hold: &ComparedHoldDocument| {
            let found = hold.comparison.as_ref();
            found.map(|found| found.parameter_rows(&record.input, hold.index, |_| true)).unwrap_or_default()
        };
        let holds = self.records.iter().flat_map(|record| record.holds.iter().map(move |hold| (record, hold)));
        holds.flat_map(|(record, hold)| of_hold(record, hold)).collect()
    }
}
