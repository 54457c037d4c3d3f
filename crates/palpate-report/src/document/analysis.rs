//! `palpate.analysis/1`: one analysed record.

use palpate::analysis::{Analysis, HoldAnalysis, JointAnalysis, LoadingModulus, Overlay, RateBias, Signal};
use palpate::fit::{Estimate, ExponentChoice, LatencyFit, OrderSelection};
use palpate::segment::{After, Segment};

use super::budget::BudgetDocument;
use super::comparison::HoldComparisonDocument;
use super::conditions::{ConditionsDocument, HoldReportDocument};
use super::fit::FitDocument;
use super::settings::SettingsDocument;
use super::signals::{CorrectionDocument, SignalsDocument, TouchDocument};
use super::software::Software;
use crate::page::Finding;
use crate::result::{
    Answer, ComparedRecord, Input, ParameterDocument, ParameterRow, budgets_of_analysis, mode_word, word,
};

documents! {
    /// A phase of the record.
    SegmentDocument(segment: &Segment, time: &[f64]) {
        /// `rest`, `loading`, `hold` or `unloading`.
        phase: String = word(segment.phase),
        /// Time of the first sample, s.
        start_s: f64 = time[segment.start],
        /// Time of the last sample, s.
        end_s: f64 = time[segment.end - 1],
        /// First sample, from 0.
        first_row: usize = segment.start,
        /// Last sample, from 0.
        last_row: usize = segment.end - 1,
    }

    /// One hold.
    HoldDocument(analysis: &Analysis, hold: &HoldAnalysis) with {
        let delta = |i: usize| hold.order.as_ref().map(|order| order.candidates[i].delta_bic);
        let fits = hold.fits.iter().enumerate();
        let time = fits.map(|(i, fit)| FitDocument::new(fit, hold, delta(i), hold.predictions[i]));
        let rate = hold.rate_fits.iter().flatten().map(|fit| FitDocument::new(fit, hold, None, None));
        let comparison = hold.comparison.as_ref();
        let candidates = hold.order.iter().flat_map(|order| &order.candidates).zip(&hold.fits);
        let alike = candidates.filter(|(candidate, _)| !candidate.free && candidate.indistinguishable);
        let indistinguishable = alike.map(|(_, fit)| fit.law.to_string()).collect();
    } {
        /// Number of the hold, from 1.
        index: usize = hold.number,
        /// Time of its first sample, s.
        start_s: f64 = hold.start,
        /// Time of its last sample, s.
        end_s: f64 = hold.end,
        /// Time from which the laws are fitted, s.
        fit_start_s: f64 = hold.fit_start,
        /// How that time was chosen: `hold_start`, `drive_settled`, `extreme`, `after_extreme`, `contact_closed`, `behind_strays` or `delay_faded`.
        fit_start_rule: Option<String> = hold.segment.fit_start_rule.map(word),
        /// Displacement of the jaw (median) since first touch, m.
        displacement_m: Option<f64> = hold.displacement,
        /// `loading` or `unloading`.
        after: Option<String> = hold.after.map(word),
        /// What the machine held: `displacement`, `force` or `neither`.
        mode: Option<String> = hold.segment.mode.map(mode_word),
        /// Found in a force alone, which ramps explain nearly as well.
        doubtful: bool = hold.segment.doubtful,
        /// `type_1` (the force falls), `type_2` (it rises) or `none`.
        relaxation: String = word(hold.relaxation.kind),
        /// Change of the force from the mean of the first twentieth of the hold to that of the last fifth, N: what `relaxation` is judged by.
        force_change_n: f64 = hold.relaxation.change,
        /// Its standard error, N.
        force_change_standard_error_n: f64 = hold.relaxation.standard_error,
        /// Probability of such a change by noise that correlates as the last fifth of the hold shows; a drift or a random walk exceeds it more often. 2.2e-308, the smallest number, stands for anything below.
        p_value: f64 = hold.relaxation.p_value,
        /// Force where the fit starts, N.
        force_start_n: f64 = hold.force_start,
        /// Force at the end, N.
        force_end_n: f64 = hold.force_end,
        /// Application and variation of the displacement, and R(t) at stated times.
        report: HoldReportDocument = HoldReportDocument::new(&analysis.hold_report(hold)),
        /// The fitted quantity: `strain` or `force`.
        signal: String = word(hold.signal),
        /// Fits, time domain first.
        fits: Vec<FitDocument> = time.chain(rate).collect(),
        /// Bias of the rate domain by noise.
        rate_bias: Option<RateBiasDocument> = hold.rate_bias.map(RateBiasDocument::new),
        /// Index into `fits` of the preferred one (lowest information criterion).
        preferred: Option<usize> = hold.order.as_ref().and_then(|order| order.preferred),
        /// Index into `fits` of the lowest listed exponent that is not distinguishable from the best one.
        lowest_order: Option<usize> = hold.order.as_ref().and_then(|order| order.lowest_order),
        /// Index into `fits` of the one to use where no other laws are compared: `lowest_order`, unless `preferred` is distinguishable from it.
        recommended: Option<usize> = hold.order.as_ref().and_then(OrderSelection::recommended),
        /// Laws of the listed exponents that are not distinguishable from the best of them.
        indistinguishable: Vec<String> = indistinguishable,
        /// Laws compared on this hold; `null` where the comparison was omitted or failed.
        comparison: Option<HoldComparisonDocument> =
            comparison.map(|found| HoldComparisonDocument::new(found, hold.signal.into())),
        /// Findings about this hold.
        findings: Vec<Finding> = hold.findings.iter().map(Finding::from).collect(),
    }

    /// Estimates of the rate domain from simulated holds with the parameters of the preferred time-domain fit and the measured noise.
    RateBiasDocument(bias: RateBias) {
        /// The exponent, given in all fits.
        exponent: f64 = bias.exponent,
        /// Simulated holds.
        repetitions: usize = bias.repetitions,
        /// v of the rate domain over the true one, median.
        rate_coefficient_ratio: f64 = bias.coefficient,
        /// Lowest and highest of them.
        rate_coefficient_ratio_range: [f64; 2] = bias.coefficient_range.into(),
        /// Equilibrium of the rate domain less the true one over the amplitude, median.
        equilibrium_shift_ratio: f64 = bias.equilibrium,
    }

    /// A row of Table I or Table II: the paper's layout.
    TableRow(hold: &HoldAnalysis, fit: &LatencyFit) {
        /// Number of the hold.
        hold: usize = hold.number,
        /// Displacement, m.
        displacement_m: Option<f64> = hold.displacement,
        /// ε_e.
        equilibrium_strain: f64 = fit.equilibrium().value,
        /// Its standard error.
        equilibrium_strain_standard_error: Option<f64> = fit.equilibrium().standard_error,
        /// v, 1/s.
        rate_coefficient_per_s: f64 = fit.rate_coefficient().value,
        /// Its standard error, 1/s.
        rate_coefficient_standard_error_per_s: Option<f64> = fit.rate_coefficient().standard_error,
    }

    /// Tables I and II of the paper for this record, at the common exponent.
    TablesDocument(analysis: &Analysis, n: f64) with {
        let trend = analysis.across.trend;
        let rows = |after: After| -> Vec<TableRow> {
            let holds = analysis.holds.iter().filter(|hold| hold.after == Some(after) && hold.signal == Signal::Strain);
            holds.filter_map(|hold| Some(TableRow::new(hold, hold.fit_with(n)?))).collect()
        };
    } {
        /// The lowest listed exponent that is not distinguishable from the best fit to all holds.
        common_exponent: Option<f64> = Some(n),
        /// Holds after loading.
        loading: Vec<TableRow> = rows(After::Loading),
        /// Holds after unloading.
        unloading: Vec<TableRow> = rows(After::Unloading),
        /// d ln v/dε_e over the holds after loading.
        trend_of_log_rate_coefficient: Option<f64> = trend.map(|trend| trend.slope),
        /// Its confidence interval.
        trend_interval: Option<[f64; 2]> = trend.and_then(|trend| trend.interval).map(Into::into),
    }

    /// The latency law with one v and n for several holds, compared with a law for each hold.
    JointDocument(joint: &JointAnalysis) with {
        let fixed = if let ExponentChoice::Fixed(n) = joint.choice { n } else { f64::NAN };
        let estimate = |name: &str, otherwise: f64| {
            joint.fit.shared(name).map_or(Estimate::fixed(otherwise), |number| number.estimate)
        };
        let (rate, exponent) = (estimate("rate_coefficient_per_s", f64::NAN), estimate("exponent", fixed));
        let trend = joint.comparison.trend.as_ref();
    } {
        /// Holds after `loading`, or `all`.
        which: String = word(joint.which),
        /// Numbers of the holds.
        holds: Vec<usize> = joint.holds.clone(),
        /// n.
        exponent: f64 = exponent.value,
        /// Its standard error; `null` if it was given.
        exponent_standard_error: Option<f64> = exponent.standard_error,
        /// v, 1/s.
        rate_coefficient_per_s: f64 = rate.value,
        /// Its standard error, 1/s.
        rate_coefficient_standard_error_per_s: Option<f64> = rate.standard_error,
        /// Its confidence interval, 1/s.
        rate_coefficient_interval_per_s: Option<[f64; 2]> = rate.interval.map(Into::into),
        /// Probability of so large a difference from a law for each hold if they share one.
        p_value: Option<f64> = joint.comparison.p,
        /// Bayesian information criterion less that of a law for each hold.
        delta_bic: f64 = joint.comparison.delta_bic,
        /// d ln v/dε_e, weighted by the errors of the holds.
        trend_of_log_rate_coefficient: Option<f64> = trend.map(|trend| trend.slope),
        /// Its confidence interval.
        trend_interval: Option<[f64; 2]> = trend.map(|trend| trend.interval.into()),
        /// `constant`, `falls_with_strain`, `rises_with_strain` or `undecided`.
        verdict: String = word(joint.comparison.verdict),
    }

    /// Young's modulus of the first loading ramp: an apparent one of a body that relaxes.
    LoadingModulusDocument(found: LoadingModulus) {
        /// E, Pa.
        modulus_pa: f64 = found.value,
        /// Its standard error, Pa: of the residuals, and of first touch where that has one.
        standard_error_pa: f64 = found.standard_error,
        /// Root mean square residual as a share of the largest force of the ramp.
        relative_rmse: f64 = found.relative_rmse,
    }

    /// Simulation of the measured displacement with the fitted parameters.
    OverlayDocument(overlay: &Overlay) {
        /// n.
        exponent: f64 = overlay.model.law.exponent(),
        /// v, 1/s.
        rate_coefficient_per_s: f64 = overlay.model.law.rate_coefficient(),
        /// m.
        layers: f64 = overlay.model.layers.count(),
        /// Whether m was fitted to the record.
        layers_fitted: bool = overlay.layers_fitted,
        /// Root mean square of measured less simulated force, N.
        rmse_n: f64 = overlay.rmse,
        /// The same as a share of the largest force.
        relative_rmse: f64 = overlay.relative,
    }

    /// One analysed record.
    #[schemars(title = "palpate.analysis/1")]
    AnalysisDocument(analysis: &Analysis, input: Input) with {
        let time = analysis.record.time();
        let compared = ComparedRecord::of_analysis(analysis, input.clone());
        let confidence = analysis.options.fit.confidence;
    } {
        /// `palpate.analysis/1`.
        schema: String = "palpate.analysis/1".to_owned(),
        /// Which law to use for the record and for each hold, with its formula and its parameters.
        answer: Answer = Answer::new(&compared),
        /// The record.
        input: Input = input,
        /// Conditions of the test.
        conditions: ConditionsDocument = ConditionsDocument::new(&analysis.options.conditions),
        /// Settings of the analysis.
        settings: SettingsDocument = SettingsDocument::new(analysis),
        /// Properties of the columns.
        signals: SignalsDocument = SignalsDocument::new(analysis),
        /// Corrections of the measured columns, in order.
        corrections: Vec<CorrectionDocument> =
            analysis.record.corrections().iter().map(CorrectionDocument::new).collect(),
        /// First touch.
        first_touch: TouchDocument = TouchDocument::new(analysis),
        /// Modulus of the first loading ramp, where the geometry is known.
        loading_modulus?: Option<LoadingModulusDocument> = analysis.loading_modulus.map(LoadingModulusDocument::new),
        /// All phases.
        segments: Vec<SegmentDocument> =
            analysis.segmentation.segments.iter().map(|segment| SegmentDocument::new(segment, time)).collect(),
        /// All holds.
        holds: Vec<HoldDocument> = analysis.holds.iter().map(|hold| HoldDocument::new(analysis, hold)).collect(),
        /// The paper's tables; `null` where the signal is not strain.
        tables: Option<TablesDocument> = tables(analysis),
        /// One law for several holds; empty where fewer than two holds gave strains.
        joint: Vec<JointDocument> = analysis.across.joint.iter().map(JointDocument::new).collect(),
        /// Uncertainty budgets of the parameters of the law of the record on every hold, and of an estimated modulus; empty where the test
        /// description has no `[instrument]`.
        budgets: Vec<BudgetDocument> = budgets_of_analysis(analysis, &compared)
            .iter()
            .map(|result| BudgetDocument::new(result, confidence))
            .collect(),
        /// The simulated record.
        overlay: Option<OverlayDocument> = analysis.overlay.as_ref().map(OverlayDocument::new),
        /// Findings about the record.
        findings: Vec<Finding> = analysis.findings.iter().map(Finding::from).collect(),
        /// The software that wrote this.
        software: Software = Software::this(),
    }
}

/// The paper's tables of an analysis, where the signal is strain.
pub(super) fn tables(analysis: &Analysis) -> Option<TablesDocument> {
    let n = analysis.across.common_exponent.filter(|_| analysis.specimen.is_some())?;
    Some(TablesDocument::new(analysis, n))
}

impl HoldDocument {
    /// The law to use: the verdict of the comparison, or the recommended exponent where no other laws were compared.
    #[must_use]
    pub fn recommended_law(&self) -> Option<&str> {
        let verdict = self.comparison.as_ref().and_then(|found| found.verdict.as_ref()).map(|verdict| &verdict.law);
        verdict.or_else(|| self.fits.get(self.recommended?).map(|fit| &fit.law)).map(String::as_str)
    }
}

impl AnalysisDocument {
    /// Every parameter of every law on every hold, a row each: the latency law in both domains, then the laws compared.
    #[must_use]
    pub fn parameter_rows(&self) -> Vec<ParameterRow> {
        self.holds.iter().flat_map(|hold| self.parameters_on(hold)).collect()
    }

    fn parameters_on(&self, hold: &HoldDocument) -> Vec<ParameterRow> {
        let comparison = hold.comparison.as_ref();
        let chosen = hold.recommended_law();
        let row = |fit: &FitDocument, name: &String, parameter: &ParameterDocument| ParameterRow {
            record: self.input.path.clone(),
            part: self.input.part.clone(),
            hold: Some(hold.index),
            law: fit.law.clone(),
            name: name.clone(),
            parameter: parameter.clone(),
            termination: fit.termination.clone(),
            domain: fit.domain.clone(),
            is_recommended: fit.domain == "time" && chosen == Some(fit.law.as_str()),
        };
        let of_fit = |fit: &FitDocument| -> Vec<ParameterRow> {
            fit.parameters.iter().map(|(name, parameter)| row(fit, name, parameter)).collect()
        };
        let mut rows: Vec<ParameterRow> = hold.fits.iter().flat_map(of_fit).collect();
        let known = |law: &str| hold.fits.iter().any(|fit| fit.domain == "time" && fit.law == law);
        rows.extend(
            comparison.iter().flat_map(|found| found.parameter_rows(&self.input, hold.index, |law| !known(law))),
        );
        rows
    }
}
