//! Strain rate fitted against strain, equation (10): the paper's way.

use super::{
    Assessed, Domain, Estimate, Fit, FitError, FitOptions, IntervalMethod, LatencyFit, NoiseChoice, Parameter,
    ParameterKind, ParameterRole, ParameterUnit, Scale, Trust, check_finite,
};
use crate::laws::{ExponentChoice, Law, LawCurve, Response, Term};
use crate::optimise::{Effort, Ending, Refined, Shapes, Solution, Target, Termination, polished, refine};
use crate::watch::{Cancelled, Unwatched, Watch};

/// Fits ε̇ = −v sgn(x) |x|ⁿ, x = ε − ε_e, to strain rates (1/s) over strains: equations (9) and (10).
///
/// Least squares in ε̇, as in the paper; the order of the samples does not matter. For given (ε_e, n) the law is linear
/// in v, so ε_e, or (ε_e, n), is sought from a coarse grid up to ten ranges of strain away.
///
/// **Noise biases this fit**: it enters both axes, and the rates come from a derivative. Prefer [`fit_hold`](crate::fit::fit_hold)
/// and read this one as the paper's view of the data. The excess at the first sample is reported as the amplitude.
///
/// ```
/// use palpate::fit::{ExponentChoice, FitOptions, fit_rates};
/// let strains: Vec<f64> = (0..60).map(|i| 0.25 + 0.002 * f64::from(i)).collect();
/// let rates: Vec<f64> = strains.iter().map(|e| -2e4 * (e - 0.2f64).powi(5)).collect();
/// let fit = fit_rates(&strains, &rates, ExponentChoice::Fixed(5.0), &FitOptions::default())?;
/// assert!((fit.equilibrium().value - 0.2).abs() < 1e-9);
/// assert!((fit.rate_coefficient().value / 2e4 - 1.0).abs() < 1e-6);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for unequal lengths, too few samples, values that are not finite, strains or rates that are all the same,
/// or rates that point away from every equilibrium.
pub fn fit_rates(
    strains: &[f64],
    rates: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
) -> Result<LatencyFit, FitError> {
    fit_rates_watched(strains, rates, choice, options, &mut Unwatched)
}

/// [`fit_rates`] with a watch, which hears of every point of the grid and of every evaluation of the law over the samples.
///
/// # Errors
/// As [`fit_rates`], and [`FitError::Cancelled`].
pub fn fit_rates_watched(
    strains: &[f64],
    rates: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
    watch: &mut dyn Watch,
) -> Result<LatencyFit, FitError> {
    Effort::watched(watch, |effort| found(strains, rates, choice, options, effort))
}

fn found(
    strains: &[f64],
    rates: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
    effort: &mut Effort<'_>,
) -> Result<LatencyFit, FitError> {
    options.check(choice)?;
    FitError::check_lengths(strains.len(), rates.len())?;
    FitError::check_samples(if choice == ExponentChoice::Free { 3 } else { 2 }, strains.len())?;
    check_finite([("strain", strains), ("strain rate", rates)])?;
    let scaled = Scaled::new(strains, rates)?;
    let shapes = RateShapes {
        strains: &scaled.strains,
        choice,
        exponents: options.exponent_range,
    };
    let target = Target::new(&scaled.rates, None);
    let mut best: Option<Refined> = None;
    for start in shapes.starts(&scaled.rates, effort)? {
        let refined = refine(&shapes, target, &start, Ending::tight(options.most_iterations), effort)?;
        let better = best.as_ref().is_none_or(|best| refined.point.square < best.point.square);
        // A negative coefficient would run away from equilibrium.
        if refined.point.linear[0] > 0.0 && better {
            best = Some(refined);
        }
    }
    let solution = polished(&shapes, target, best.ok_or(FitError::NoDecay)?, effort)?;
    let fit = LatencyFit::new(scaled.fit(strains, &solution, choice, options, effort)?).ok_or(FitError::NoDecay)?;
    if fit.rmse.is_finite() { Ok(fit) } else { Err(FitError::OutOfRange) }
}

/// Strains in units of their range about their middle, rates in units of the largest.
struct Scaled {
    strains: Vec<f64>,
    rates: Vec<f64>,
    center: f64,
    range: f64,
    fastest: f64,
}

impl Scaled {
    fn new(strains: &[f64], rates: &[f64]) -> Result<Self, FitError> {
        let (low, high) = strains.iter().fold((f64::MAX, f64::MIN), |(low, high), e| (low.min(*e), high.max(*e)));
        let fastest = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        FitError::check_change(low, if fastest == 0.0 { low } else { high }, strains.len())?;
        let (center, range) = (0.5 * (low + high), high - low);
        // The equilibrium is sought up to ten ranges away.
        if !((100.0 * range).is_finite() && center.is_finite()) {
            return Err(FitError::OutOfRange);
        }
        Ok(Self {
            strains: strains.iter().map(|e| (e - center) / range).collect(),
            rates: rates.iter().map(|rate| rate / fastest).collect(),
            center,
            range,
            fastest,
        })
    }

    fn fit(
        &self,
        strains: &[f64],
        solution: &Solution,
        choice: ExponentChoice,
        options: &FitOptions,
        effort: &Effort<'_>,
    ) -> Result<Fit, Cancelled> {
        let scaled_v = solution.linear[0];
        let n = choice.given().unwrap_or_else(|| solution.nonlinear[1]);
        let size = 1 + solution.nonlinear.len();
        let known = solution.termination == Termination::Converged;
        let (ones, amplitudes) = ([1.0; 3], [scaled_v; 2]);
        let trust = Trust {
            confidence: options.confidence,
            noise: NoiseChoice::FromResiduals,
            known,
            may_vary: false,
            counted: None,
            roots: None,
            curve: None,
            times: None,
            step: 0.0,
        };
        let assessed = Assessed::new(solution, &amplitudes[..size - 1], &ones[..size], self.fastest, &trust, effort)?;
        let estimate = |value: f64, weights: &[f64], scale: Scale, unit: f64| {
            let gradient: Vec<f64> = weights[..size].iter().map(|weight| weight * unit).collect();
            assessed.estimate(value, &gradient, scale)
        };
        let equilibrium = self.center + solution.nonlinear[0] * self.range;
        let amplitude = strains[0] - equilibrium;
        // ε̇/fastest = −v' |x/range|ⁿ, so ln v = ln v' + ln fastest − n ln range.
        let coefficient = (scaled_v.ln() + self.fastest.ln() - n * self.range.ln()).exp();
        let log_v = [1.0 / scaled_v, 0.0, -self.range.ln()];
        let log_amplitude = amplitude.abs().ln();
        // ln λ = ln v + (n − 1) ln |Δ|, with ∂Δ/∂ε_e = −1.
        let log_rate = [1.0 / scaled_v, -(n - 1.0) * self.range / amplitude, log_amplitude - self.range.ln()];
        let covariance = assessed.white.as_ref().map(|white| {
            // Rows of the map from (v', ε_e', n) to (ε_e, ln v, n).
            let rows = [[0.0, self.range, 0.0], log_v, [0.0, 0.0, 1.0]];
            let entry = |a: &[f64; 3], b: &[f64; 3]| {
                let pairs = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
                pairs.map(|(i, j)| a[i] * white[i][j] * b[j]).sum::<f64>()
            };
            rows[..size].iter().map(|a| rows[..size].iter().map(|b| entry(a, b)).collect()).collect()
        });
        let covariance = covariance.filter(|rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|entry| entry.is_finite()));
        let residual_square = solution.residual_square * self.fastest * self.fastest;
        let log_rate_value = coefficient.ln() + (n - 1.0) * log_amplitude;
        let parameter = |kind: ParameterKind, unit: ParameterUnit, estimate: Estimate| Parameter {
            name: kind.into(),
            unit,
            estimate,
            parts: None,
            role: match kind {
                ParameterKind::Exponent if choice != ExponentChoice::Free => ParameterRole::Given,
                ParameterKind::Amplitude | ParameterKind::RelativeRate => ParameterRole::Derived,
                _ => ParameterRole::Estimated,
            },
        };
        let level = |value: f64| estimate(value, &[0.0, 1.0, 0.0], Scale::Linear, self.range);
        let log = |value: f64, weights: &[f64]| estimate(value, weights, Scale::Log, 1.0);
        let mut parameters = vec![
            parameter(ParameterKind::Equilibrium, ParameterUnit::Signal, level(equilibrium)),
            parameter(ParameterKind::Amplitude, ParameterUnit::Signal, level(amplitude)),
            parameter(ParameterKind::RelativeRate, ParameterUnit::PerSecond, log(log_rate_value.exp(), &log_rate)),
            parameter(ParameterKind::RateCoefficient, ParameterUnit::RateCoefficient, log(coefficient, &log_v)),
        ];
        let exponent = match choice {
            ExponentChoice::Free => log(n, &[0.0, 0.0, 1.0 / n]),
            ExponentChoice::Fixed(n) => Estimate::fixed(n),
        };
        parameters.insert(3, parameter(ParameterKind::Exponent, ParameterUnit::One, exponent));
        let terms = vec![Term {
            amplitude,
            shape: choice.shape(),
            parameters: [log_rate_value].into_iter().chain(choice.given().is_none().then_some(n)).collect(),
        }];
        Ok(Fit {
            law: Law::Latency { exponent: choice },
            domain: Domain::Rate,
            response: Response::Relaxation,
            curve: LawCurve::relaxing(Response::Relaxation, equilibrium, terms),
            loading: None,
            parameters,
            searched: ["equilibrium", "ln rate_coefficient_per_s", "exponent"][..size]
                .iter()
                .map(ToString::to_string)
                .collect(),
            values: [equilibrium, coefficient.ln(), n][..size].to_vec(),
            white_covariance: covariance,
            residual_square,
            rmse: (residual_square / strains.len() as f64).sqrt(),
            residual_correlation: assessed.correlation,
            uneven_noise: assessed.uneven,
            noise_course: None,
            noise: assessed.noise,
            noise_p_value: assessed.noise_p_value,
            interval_method: IntervalMethod::Curvature,
            uncertainty: None,
            samples: strains.len(),
            start: 0.0,
            duration: 0.0,
            termination: solution.termination,
            redundant_terms: Vec::new(),
            profile: None,
            work: effort.work,
        })
    }
}

/// Farthest equilibrium that is looked for, in ranges of strain from the middle of the data.
const FARTHEST: f64 = 10.0;

/// One column, −sgn(x) |x|ⁿ; nonlinear parameters ε_e and, if free, n.
struct RateShapes<'a> {
    strains: &'a [f64],
    choice: ExponentChoice,
    exponents: (f64, f64),
}

impl RateShapes<'_> {
    /// The best points of a grid of ε_e on both sides of the data, for every exponent looked at.
    fn starts(&self, rates: &[f64], effort: &mut Effort<'_>) -> Result<Vec<Vec<f64>>, Cancelled> {
        const EXPONENTS: [f64; 8] = [0.6, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 16.0];
        let (low, high) = self.exponents;
        let exponents: Vec<f64> = match self.choice {
            ExponentChoice::Fixed(n) => vec![n],
            ExponentChoice::Free => EXPONENTS.into_iter().filter(|n| (low..=high).contains(n)).collect(),
        };
        // Dense around the data, sparse far away.
        let levels = (-40..=40).map(|i| 0.6 * (f64::from(i) * 0.0875).sinh() / 0.75);
        let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
        for level in levels.filter(|level| level.abs() < FARTHEST) {
            for &n in &exponents {
                let (mut square, mut shared) = (0.0, 0.0);
                for (e, rate) in self.strains.iter().zip(rates) {
                    let x = e - level;
                    let column = -x.signum() * x.abs().powf(n);
                    square += column * column;
                    shared += column * rate;
                }
                effort.work.grid_points += 1;
                effort.hear()?;
                // Only a positive coefficient counts.
                let gain = shared.max(0.0) * shared / square;
                let start = [level].into_iter().chain(self.choice.given().is_none().then_some(n)).collect();
                found.push((gain, start));
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(found.into_iter().filter(|(gain, _)| *gain > 0.0).take(4).map(|(_, start)| start).collect())
    }
}

impl Shapes for RateShapes<'_> {
    fn columns(&self) -> usize {
        1
    }

    fn column_of(&self, _: usize) -> usize {
        0
    }

    fn bounds(&self, index: usize) -> (f64, f64) {
        [(-FARTHEST, FARTHEST), self.exponents][index]
    }

    fn at_bound(&self, index: usize) -> Termination {
        [Termination::EquilibriumAtBound, Termination::ExponentAtBound][index]
    }

    fn fill(&self, theta: &[f64], columns: &mut [Vec<f64>], derivatives: &mut [Vec<f64>]) {
        let n = self.choice.given().unwrap_or_else(|| theta[1]);
        for (i, e) in self.strains.iter().enumerate() {
            let x = e - theta[0];
            let size = x.abs();
            let power = size.powf(n);
            columns[0][i] = -x.signum() * power;
            // d/dε_e of −sgn(x)|x|ⁿ is n |x|ⁿ⁻¹; for n < 1 it has a pole at x = 0 that no sample may feel.
            derivatives[0][i] = if size > 0.0 { n * power / size } else { 0.0 };
            if let Some(by_exponent) = derivatives.get_mut(1) {
                by_exponent[i] = if size > 0.0 { columns[0][i] * size.ln() } else { 0.0 };
            }
        }
    }
}
