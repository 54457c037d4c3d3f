//! Any law fitted to a hold.

use serde::{Deserialize, Serialize};

use super::build::build;
use super::derived::derived;
use super::estimates::Estimate;
use super::ghosts::{Ghost, ghosts};
use super::linear_algebra::Few;
use super::model::Model;
use super::prediction::searched_name;
use super::samples::{Samples, Scaled};
use super::search::search;
use super::separable::{Shapes, Solution, Termination, Work};
use super::uncertainty::{Assessed, Scale, Uncertainty};
use super::{FitError, LawOptions, Loss, NoiseModel, SampleChoice};
use crate::laws::{Law, LawCurve, Loading, NumberKind, Response, Term};

/// Unit of a number of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NumberUnit {
    /// That of the signal.
    Signal,
    /// s.
    Second,
    /// 1/s.
    PerSecond,
    /// Unit of the signal per s.
    SignalPerSecond,
    /// A pure number.
    One,
    /// (Unit of the signal)^(1 − n)/s, of the rate coefficient v; 1/s if the signal is strain.
    RateCoefficient,
    /// Unit of the signal per s^α.
    SignalPerPower,
}

/// One number of a law with its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawNumber {
    /// Name without unit, such as `equilibrium`, `time_1`, `exponent`.
    pub name: String,
    /// Its unit.
    pub unit: NumberUnit,
    /// Value, standard error, interval.
    pub estimate: Estimate,
}

/// A law fitted to a hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawFit {
    /// The law.
    pub law: Law,
    /// Relaxation or creep.
    pub response: Response,
    /// The law with the numbers found: a function of the time since the first sample, in s, or since the step that would have stood
    /// for the loading.
    pub curve: LawCurve,
    /// The loading that led to the hold; none if it counted as a step, as it must for the latency law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loading: Option<Loading>,
    /// Its numbers: constant, amplitudes, times or rates, pure numbers; then those that follow from them.
    pub numbers: Vec<LawNumber>,
    /// Names of the numbers that were searched, in the order of `values` and `covariance`: constant, amplitudes, ln of rates
    /// (1/s), pure numbers.
    pub parameters: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// Their covariance s² (JᵀJ)⁻¹ with s² = RSS/(N − p), for white noise; `None` where the data leave a number open.
    pub covariance: Option<Vec<Vec<f64>>>,
    /// χ² = Σ (r/σ)² over the samples fitted, σ = 1 for samples without deviations; under a robust loss too.
    pub residual_square: f64,
    /// Root mean square residual √(Σ r²/N) in the unit of the signal, all samples alike.
    pub rmse: f64,
    /// Correlation of neighbouring residuals.
    pub residual_correlation: f64,
    /// How residuals correlate; intervals rest on it.
    pub noise: NoiseModel,
    /// What intervals are made of; `None` where the data leave a number open.
    pub uncertainty: Option<Uncertainty>,
    /// Samples fitted.
    pub samples: usize,
    /// Time from the first to the last sample, s.
    pub duration: f64,
    /// Why it ended.
    pub termination: Termination,
    /// Terms that are none: merged or vanishing ones.
    pub ghosts: Vec<Ghost>,
    /// What it cost.
    pub work: Work,
}

impl LawFit {
    /// Value of a number by its name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.estimate(name).map(|estimate| estimate.value)
    }

    /// A number by its name.
    #[must_use]
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.numbers.iter().find(|number| number.name == name).map(|number| &number.estimate)
    }

    /// Numbers found from the data.
    #[must_use]
    pub fn free_numbers(&self) -> usize {
        self.parameters.len()
    }

    /// The signal a time `elapsed` (s) after the first sample, after the loading if there was one.
    #[must_use]
    pub fn predict(&self, elapsed: f64) -> f64 {
        self.predict_many(&[elapsed])[0]
    }

    /// The signal at many times, as [`predict`](Self::predict).
    #[must_use]
    pub fn predict_many(&self, elapsed: &[f64]) -> Vec<f64> {
        match &self.loading {
            None => self.curve.values(elapsed),
            Some(loading) => self.curve.after(loading, elapsed),
        }
    }

    /// Correlations of the numbers in the order of `parameters`.
    #[must_use]
    pub fn correlation(&self) -> Option<Vec<Vec<f64>>> {
        let covariance = self.covariance.as_ref()?;
        let deviation = |i: usize| covariance[i][i].sqrt();
        let entry = |i: usize, j: usize| match deviation(i) * deviation(j) {
            0.0 => 0.0,
            product => covariance[i][j] / product,
        };
        let size = covariance.len();
        Some((0..size).map(|i| (0..size).map(|j| if i == j { 1.0 } else { entry(i, j) }).collect()).collect())
    }

    /// Samples that count as independent, given how residuals correlate.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        self.noise.effective_samples(self.samples)
    }
}

/// Fits a law to a hold: no starting values.
///
/// For given nonlinear numbers the law is linear in the others, which are solved for (variable projection, Golub and Pereyra
/// 1973). The nonlinear ones are searched on a coarse grid and refined by damped Gauss–Newton steps, in units of the
/// hold's own duration and range, so that no choice of units changes the answer. Rates are sought from 10⁻³ per duration to 10³ per first
/// sample step.
///
/// An optimum that lies at the edge of what was searched, or that several numbers reach together, is returned with its
/// [`Termination`] and without errors; nothing that did not converge has any.
///
/// ```
/// use palpate::fit::{LawOptions, Samples, fit_law};
/// use palpate::laws::Law;
/// // 1 + 2 exp(−t/3) + 4 exp(−t/40)
/// let times: Vec<f64> = (0..400).map(|i| 0.5 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 * (-t / 3.0).exp() + 4.0 * (-t / 40.0).exp()).collect();
/// let fit = fit_law(&Samples::new(&times, &values), Law::Prony { terms: 2 }, &LawOptions::default())?;
/// assert!((fit.value("time_1").unwrap() - 3.0).abs() < 1e-8);
/// assert!((fit.value("amplitude_2").unwrap() - 4.0).abs() < 1e-8);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for samples that no law can be fitted to, for a law without a form for the response, and for options that name a number
/// the law does not have.
pub fn fit_law(samples: &Samples<'_>, law: Law, options: &LawOptions) -> Result<LawFit, FitError> {
    let mut work = Work::default();
    Ok(Fitted::new(samples, law, options, &mut work)?.report(law, options, work))
}

/// A model with its samples and its solution, in the units of the fit.
pub(super) struct Fitted {
    pub(super) model: Model,
    pub(super) scaled: Scaled,
    pub(super) solution: Solution,
}

impl Fitted {
    /// Finds the numbers of a law.
    pub(super) fn new(
        samples: &Samples<'_>,
        law: Law,
        options: &LawOptions,
        work: &mut Work,
    ) -> Result<Self, FitError> {
        let form = law.form(options.response).ok_or(FitError::NoForm {
            law,
            response: options.response,
        })?;
        let chosen = chosen(samples, options.samples)?;
        let samples = &chosen.samples(samples);
        let (model, scaled) = build(form, samples, options)?;
        let solution = search(&model, &scaled, options.most_iterations, work).ok_or(FitError::NoDecay)?;
        let mut fitted = Self {
            model,
            scaled,
            solution,
        };
        if options.loss != Loss::Squares {
            fitted.resist(options, work)?;
        }
        fitted.arrange();
        Ok(fitted)
    }

    /// Values of the free numbers in the caller's units: constant, amplitudes, ln of rates in 1/s, pure numbers.
    pub(super) fn values(&self) -> Vec<f64> {
        let (model, scaled) = (&self.model, &self.scaled);
        let linear = self.solution.linear.iter().enumerate().map(|(i, value)| {
            let constant = model.constant && i == 0;
            value * scaled.range + if constant { scaled.center } else { 0.0 }
        });
        let nonlinear = model.free().zip(&self.solution.nonlinear).map(|(number, value)| match number.kind {
            NumberKind::Pure { .. } => *value,
            _ => value - scaled.duration.ln(),
        });
        linear.chain(nonlinear).collect()
    }

    /// The law with the numbers found.
    pub(super) fn curve(&self) -> LawCurve {
        self.curve_of(&self.values())
    }

    fn curve_of(&self, values: &[f64]) -> LawCurve {
        let model = &self.model;
        let numbers = self.natural_numbers();
        let constants = usize::from(model.constant);
        let constant = if model.constant { values[0] } else { self.scaled.center };
        let terms = model.form.shapes.iter().enumerate().map(|(shape, kind)| Term {
            amplitude: values[constants + shape],
            shape: *kind,
            numbers: numbers[model.numbers_of(shape)].to_vec(),
        });
        LawCurve {
            response: model.form.response,
            constant,
            terms: terms.collect(),
        }
    }

    /// All nonlinear numbers, fixed ones too, in the caller's units.
    pub(super) fn natural_numbers(&self) -> Vec<f64> {
        let complete = self.model.complete(&self.solution.nonlinear);
        let natural = |(number, value): (&super::model::Number, f64)| match number.kind {
            NumberKind::Pure { .. } => value,
            _ => value - self.scaled.duration.ln(),
        };
        self.model.numbers.iter().zip(complete).map(natural).collect()
    }

    /// Names of the free numbers.
    pub(super) fn names(&self) -> Vec<String> {
        let constant = self.model.constant.then(|| self.model.form.constant_name().to_owned());
        let nonlinear = self.model.free().map(|number| searched_name(&number.name, number.kind));
        constant.into_iter().chain(self.model.form.amplitude_names()).chain(nonlinear).collect()
    }

    /// Puts exponentials whose times were searched in the order of their times, fastest first.
    pub(super) fn arrange(&mut self) {
        let model = &self.model;
        let (moving, _) = model.moving();
        if moving.len() < 2 || model.free().len() != moving.len() {
            return;
        }
        let solution = &mut self.solution;
        let mut order: Vec<usize> = (0..moving.len()).collect();
        order.sort_by(|a, b| solution.nonlinear[*b].total_cmp(&solution.nonlinear[*a]));
        let constants = usize::from(model.constant);
        let linear = model.linear();
        // Only those whose times were searched change places; one that was held keeps its own.
        let place = |i: usize| {
            let slot = moving.iter().position(|shape| constants + shape == i);
            slot.map_or(i, |slot| constants + moving[order[slot]])
        };
        let all: Vec<usize> = (0..linear).map(place).chain(order.iter().map(|i| linear + i)).collect();
        let size = all.len();
        let entry = |inverse: &[f64], i: usize| inverse[all[i / size] * size + all[i % size]];
        solution.inverse_normal = solution
            .inverse_normal
            .as_ref()
            .map(|inverse| (0..size * size).map(|i| entry(inverse, i)).collect());
        solution.linear = (0..linear).map(|i| solution.linear[place(i)]).collect();
        solution.nonlinear = order.iter().map(|i| solution.nonlinear[*i]).collect();
        solution.columns = (0..linear).map(|i| solution.columns[place(i)].clone()).collect();
        solution.column_squares = (0..linear).map(|i| solution.column_squares[place(i)]).collect();
        solution.derivatives = order.iter().map(|i| solution.derivatives[*i].clone()).collect();
    }

    pub(super) fn report(&self, law: Law, options: &LawOptions, work: Work) -> LawFit {
        let solution = &self.solution;
        let known = matches!(solution.termination, Termination::Converged | Termination::AmplitudeAtBound);
        let (linear, scale) = (self.model.linear(), self.scaled.range);
        let searched = linear + solution.nonlinear.len();
        let units: Vec<f64> = (0..searched).map(|i| if i < linear { scale } else { 1.0 }).collect();
        let assessed =
            Assessed::new(solution, &self.amplitudes(), &units, scale, (options.confidence, options.noise), known);
        let loading = if matches!(law, Law::Latency { .. }) { None } else { options.loading.clone() };
        let mut fit = LawFit {
            loading,
            ..self.report_with(law, assessed, work)
        };
        if !fit.termination.is_good() && options.loss == Loss::Squares {
            fit.residual_square = self.left_by(&fit);
        }
        fit
    }

    /// χ² of a curve as it is returned: where large amplitudes cancel, rounding of its own numbers adds to it.
    fn left_by(&self, fit: &LawFit) -> f64 {
        let scaled = &self.scaled;
        let elapsed: Vec<f64> = scaled.times.iter().map(|t| t * scaled.duration).collect();
        let curve = fit.predict_many(&elapsed);
        let root = |i: usize| scaled.roots.as_ref().map_or(1.0, |roots| roots[i]);
        let left = |i: usize| scaled.values[i] - root(i) * (curve[i] - scaled.center) / scaled.range;
        let square: f64 = (0..curve.len()).map(|i| left(i).powi(2)).sum();
        (square.sqrt() * scaled.range * scaled.precision).powi(2)
    }

    /// The result with these errors.
    pub(super) fn report_with(&self, law: Law, assessed: Assessed, work: Work) -> LawFit {
        let (solution, values, scale) = (&self.solution, self.values(), self.scaled.range);
        let estimate = |value: f64, gradient: &[f64], scale: Scale| assessed.estimate(value, gradient, scale);
        let mut numbers = self.direct(&values, &estimate);
        for number in derived(law, self, &values) {
            numbers.push(LawNumber {
                name: number.name,
                unit: number.unit,
                estimate: estimate(number.value, &number.gradient, number.scale),
            });
        }
        let residual_square = (solution.residual_square.sqrt() * scale * self.scaled.precision).powi(2);
        let samples = self.scaled.times.len();
        let mean_square = match &self.scaled.roots {
            None => solution.residual_square,
            Some(roots) => solution.residuals.iter().zip(roots).map(|(r, root)| (r / root).powi(2)).sum(),
        } / samples as f64;
        LawFit {
            law,
            response: self.model.form.response,
            curve: self.curve_of(&values),
            loading: None,
            numbers,
            parameters: self.names(),
            values,
            covariance: assessed.white,
            residual_square,
            rmse: mean_square.sqrt() * scale,
            residual_correlation: assessed.correlation,
            noise: assessed.noise,
            uncertainty: assessed.uncertainty,
            samples,
            duration: self.scaled.duration,
            termination: solution.termination,
            ghosts: ghosts(&self.model, solution),
            work,
        }
    }

    /// s² (JᵀJ)⁻¹ in the caller's units for noise of this variance in the units of the fit; `None` where it is not known.
    pub(super) fn white_covariance(&self, variance: f64) -> Option<Vec<Vec<f64>>> {
        let known = matches!(self.solution.termination, Termination::Converged | Termination::AmplitudeAtBound);
        let inverse = self.solution.inverse_normal.as_deref().filter(|_| known)?;
        let size = self.solution.linear.len() + self.solution.nonlinear.len();
        let unit = |i: usize| if i < self.model.linear() { self.scaled.range } else { 1.0 };
        let entry = |i: usize, j: usize| inverse[i * size + j] * variance * unit(i) * unit(j);
        let rows: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
        rows.iter().flatten().all(|entry| entry.is_finite()).then_some(rows)
    }

    /// The amplitude beside each free nonlinear number.
    fn amplitudes(&self) -> Vec<f64> {
        let shapes = self.model.at(&self.scaled.times);
        (0..self.solution.nonlinear.len()).map(|i| self.solution.linear[shapes.column_of(i)]).collect()
    }

    /// The numbers that were searched, and those held, as they are reported: times for ln of rates.
    pub(super) fn direct(&self, values: &[f64], estimate: &impl Fn(f64, &[f64], Scale) -> Estimate) -> Vec<LawNumber> {
        let model = &self.model;
        let row =
            |i: usize, entry: f64| -> Few { (0..values.len()).map(|j| if i == j { entry } else { 0.0 }).collect() };
        let mut numbers = Vec::with_capacity(1 + model.form.shapes.len() + model.numbers.len());
        let constant = model.form.constant_name().to_owned();
        let names = model.form.amplitude_names();
        if model.constant {
            numbers.push((constant, NumberUnit::Signal, estimate(values[0], &row(0, 1.0), Scale::Linear)));
        } else {
            numbers.push((constant, NumberUnit::Signal, Estimate::fixed(self.scaled.center)));
        }
        for (i, name) in names.into_iter().enumerate() {
            let at = i + usize::from(model.constant);
            numbers.push((name, NumberUnit::Signal, estimate(values[at], &row(at, 1.0), Scale::Linear)));
        }
        let mut at = model.linear();
        for (number, value) in model.numbers.iter().zip(self.natural_numbers()) {
            let (unit, shown, slope) = match number.kind {
                NumberKind::Pure { .. } => (NumberUnit::One, value, 1.0 / value),
                NumberKind::Time => (NumberUnit::Second, (-value).exp(), -1.0),
                NumberKind::Rate => (NumberUnit::PerSecond, value.exp(), 1.0),
                NumberKind::Reference => continue,
            };
            let shown = match number.fixed {
                Some(_) => Estimate::fixed(shown),
                None => {
                    at += 1;
                    estimate(shown, &row(at - 1, slope), Scale::Log)
                }
            };
            numbers.push((number.name.clone(), unit, shown));
        }
        let named = |(name, unit, estimate)| LawNumber { name, unit, estimate };
        numbers.into_iter().map(named).collect()
    }
}

/// Samples that were picked, if not all.
struct Chosen(Option<[Vec<f64>; 3]>);

impl Chosen {
    fn samples<'a>(&'a self, all: &Samples<'a>) -> Samples<'a> {
        match &self.0 {
            None => *all,
            Some([times, values, deviations]) => Samples {
                times,
                values,
                deviations: all.deviations.map(|_| deviations.as_slice()),
            },
        }
    }
}

fn chosen(samples: &Samples<'_>, choice: SampleChoice) -> Result<Chosen, FitError> {
    let SampleChoice::LogSpaced(count) = choice else {
        return Ok(Chosen(None));
    };
    samples.check(1)?;
    let times = samples.times;
    let mut kept = vec![0];
    let (first, last) = (times[1] - times[0], times[times.len() - 1] - times[0]);
    for i in 0..count.max(2) {
        let at = first * (last / first).powf(i as f64 / (count.max(2) - 1) as f64);
        let after = times.partition_point(|t| t - times[0] < at).min(times.len() - 1);
        let before =
            after - usize::from(after > 1 && at - (times[after - 1] - times[0]) < times[after] - times[0] - at);
        if kept.last().is_some_and(|last| *last < before) {
            kept.push(before);
        }
    }
    let pick = |column: &[f64]| kept.iter().map(|i| column[*i]).collect::<Vec<f64>>();
    let deviations = samples.deviations.map_or_else(Vec::new, pick);
    Ok(Chosen(Some([pick(times), pick(samples.values), deviations])))
}
