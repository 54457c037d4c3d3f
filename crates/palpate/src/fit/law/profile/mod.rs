//! Intervals from the profile of the residual square: asymmetric, and open where the data do not close them.
//!
//! One parameter is held at v and the others are fitted again, which leaves χ²(v). The interval is where
//!
//! ```text
//! z(v) = √((χ²(v)/χ²_min − 1)(N − p)) ≤ t √w
//! ```
//!
//! with t the quantile of Student's distribution at N − p degrees of freedom: for white noise (w = 1) the F-test of
//! `lmfit.conf_interval`. Where residuals correlate, w is the variance of the parameter for noise of their kind over that for
//! white noise, and t has the degrees of freedom of that variance ([`Uncertainty`](super::Uncertainty)).
//!
//! Under a robust loss χ² is that of samples as the loss counts them (`law/robust.rs`), and w is times s² of the loss over that of such residuals.
//!
//! A parameter that follows from those (v from λ, Δ and n) has the ends of the one that it correlates with most, ϱ: its value at an end,
//! its distance from the best value divided by |ϱ|. Where the data leave one direction nearly open, that direction is what all parameters
//! share, and |ϱ| is near 1; below 0.7 the interval of the curvature stays.

mod path;

use super::quantity::Quantity;
use crate::fit::noise::variance_of;
use crate::fit::{
    Condensed, Fit, FitError, Fitted, Interval, IntervalMethod, LawOptions, Parameter, ParameterKind, ParameterRole,
    ParameterUnit, ProfileCurves, RedundantTerm, Samples, Scale, Uncertainty, condense,
};
use crate::laws::{Law, ShapeParameterKind};
use crate::optimise::{Effort, Few};
use crate::watch::{Cancelled, Progress};
use path::{Closeness, End, Ends, Profile, Searched};

/// Half an interval over the parameter beyond which its curvature is not to be trusted.
const WIDE: f64 = 1.0 / 3.0;

/// The same where a time constant is longer than the hold.
const WIDE_IF_LONG: f64 = 0.1;

/// Standard errors of an amplitude below which noise alone may have left the term: the largest of some ten places is twice as far out as one.
const DOUBTFUL: f64 = 4.0;

/// Correlation below which a profile says too little of another parameter.
const FOLLOWED: f64 = 0.7;

/// The profile-likelihood interval of a parameter of a law, by its name as in the result of [`fit_law`](crate::fit::fit_law).
///
/// Parameters that follow from others (`start`, `rate_coefficient`) have none of their own. An end is open (`None`) if the profile stays below
/// its bound up to the edge of the range in which parameters are sought, or 2000 standard errors away. Both are where the
/// fit did not converge.
///
/// ```
/// use palpate::fit::{LawOptions, Samples, profile_interval};
/// use palpate::laws::Law;
/// use palpate::test_problems::noisy_hold;
/// let (times, values) = noisy_hold(200, 1.0, 2e-2);
/// let samples = Samples::new(&times, &values);
/// let interval = profile_interval(&samples, Law::StandardLinearSolid, &LawOptions::default(), "time_constant_s")?;
/// // 1/(2·10⁴ · 0.13⁴ 1/s) = 0.17506 s
/// assert!(interval.low.unwrap() < 0.17506 && 0.17506 < interval.high.unwrap());
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// As [`fit_law`](crate::fit::fit_law), and [`FitError::UnknownParameter`] for a parameter that the law does not have, or that is held.
pub fn profile_interval(
    samples: &Samples<'_>,
    law: Law,
    options: &LawOptions,
    name: &str,
) -> Result<Interval, FitError> {
    let mut fitted = Fitted::new(samples, law, options, &mut Effort::default())?;
    let names = fitted.model.names(|parameter| parameter.name.clone());
    let place = names.iter().position(|known| known == name).ok_or_else(|| FitError::UnknownParameter {
        name: name.to_owned(),
        known: names.join(", "),
    })?;
    let fit = fitted.report(law, options, &Effort::default())?;
    let quantities = fitted.quantities(law, fitted.solution.at());
    let quantity = quantities.iter().position(|quantity| quantity.name == *name);
    let (Some(uncertainty), Some(quantity), true) = (&fit.uncertainty, quantity, fit.termination.is_good()) else {
        return Ok(Interval::OPEN);
    };
    let inefficiency = fitted.take_as_counted();
    let about = About::new(&fitted, &fit, options, inefficiency, Closeness::EXACT);
    let ends = fitted.ends(place, &fit, uncertainty, &about, &mut Effort::default())?;
    let value = |end: &Option<End>| {
        let reached = end.as_ref().and_then(End::bound)?;
        Some(fitted.quantities(law, reached.at())[quantity].value)
    };
    let [low, high] = [&ends.low, &ends.high].map(value);
    Ok(match quantities[quantity].gradient[place] < 0.0 {
        true => Interval { low: high, high: low },
        false => Interval { low, high },
    })
}

impl Fitted {
    /// Whether the intervals of curvature are not to be trusted: a parameter beside the constant whose interval is wide, a time constant
    /// longer than the hold, terms that merge or vanish. The curve then bends within an interval.
    pub(crate) fn bends(&self, fit: &Fit) -> bool {
        if !fit.termination.is_good() || fit.uncertainty.is_none() {
            return false;
        }
        let lasts = |(kind, theta): (ShapeParameterKind, &f64)| match kind {
            ShapeParameterKind::Time | ShapeParameterKind::Rate => *theta < 0.0,
            ShapeParameterKind::Pure { .. } | ShapeParameterKind::Reference => false,
        };
        let kinds = self.model.free().map(|parameter| parameter.kind);
        let wide = if kinds.zip(&self.solution.nonlinear).any(lasts) { WIDE_IF_LONG } else { WIDE };
        let half = |parameter: &Parameter| {
            let (value, high) =
                (parameter.estimate.value, parameter.estimate.interval.map_or(f64::INFINITY, |(_, high)| high));
            // Amplitudes have intervals on a linear scale, rates and exponents on a logarithmic one.
            match parameter.unit {
                ParameterUnit::Signal => (high - value) / value.abs(),
                _ => (high / value).ln(),
            }
        };
        let estimated = fit.parameters.iter().filter(|parameter| parameter.role == ParameterRole::Estimated);
        // The constant is the first of them.
        let mut shapes = estimated.skip(usize::from(self.model.constant));
        !fit.redundant_terms.is_empty() || shapes.any(|parameter| half(parameter) > wide)
    }

    /// Intervals of the parameters of this fit by their profiles, whose ends may be open; standard errors are those of curvature.
    pub(crate) fn profile(
        &mut self,
        fit: &mut Fit,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<(), FitError> {
        fit.interval_method = IntervalMethod::Profile;
        let (Some(uncertainty), true) = (fit.uncertainty.clone(), fit.termination.is_good()) else {
            return Ok(());
        };
        let inefficiency = self.take_as_counted();
        let about = About::new(self, fit, options, inefficiency, Closeness::USUAL);
        let all = (0..fit.values.len()).map(|place| self.ends(place, fit, &uncertainty, &about, effort));
        let all = all.collect::<Result<Vec<Ends>, Cancelled>>()?;
        let values_at = |end: &Option<End>| -> Option<Vec<f64>> {
            let quantities = self.quantities(fit.law, end.as_ref().and_then(End::bound)?.at());
            Some(quantities.iter().map(|quantity| quantity.value).collect())
        };
        let last = || all.iter().flat_map(|ends| [&ends.low, &ends.high]).flatten();
        fit.profile = Some(ProfileCurves {
            confidence: options.confidence,
            curves: last().map(|end| self.curve_at(end.last.at())).collect(),
            open: last().map(|end| end.bound().is_none()).collect(),
        });
        let reached: Vec<[Option<Vec<f64>>; 2]> =
            all.iter().map(|ends| [&ends.low, &ends.high].map(values_at)).collect();
        let best = self.quantities(fit.law, self.solution.at());
        let mut starts = Vec::new();
        for (i, (quantity, parameter)) in best.iter().zip(&mut fit.parameters).enumerate() {
            let Some((place, correlation)) = followed(&quantity.gradient, &uncertainty.covariance) else {
                continue;
            };
            let [low, high] = &reached[place];
            let [low, high] = if correlation < 0.0 { [high, low] } else { [low, high] };
            let end = |values: &Option<Vec<f64>>, open: f64| {
                values.as_ref().and_then(|values| quantity.beyond(values[i], correlation.abs())).unwrap_or(open)
            };
            let lowest = if quantity.scale == Scale::Log { 0.0 } else { f64::NEG_INFINITY };
            let (low, high) = (end(low, lowest), end(high, f64::INFINITY));
            // Where terms have changed places on the way, their ends are not those of the same.
            let low = if low <= quantity.value { low } else { lowest };
            let high = if high >= quantity.value { high } else { f64::INFINITY };
            parameter.estimate.interval = Some((low, high));
            // The curve at the first sample is between those that the data allow, whatever it correlates with.
            if quantity.name.kind == ParameterKind::Start && !(low.is_finite() && high.is_finite()) {
                starts.push(i);
            }
        }
        for i in starts {
            fit.parameters[i].estimate.interval = fit.predict_interval(0.0).interval;
        }
        Ok(())
    }

    /// Terms of a series of exponentials that noise alone may have left.
    fn doubtful(&self, fit: &Fit) -> Doubtful {
        let mut doubtful = Doubtful::default();
        let (true, Some(white)) = (self.model.is_series(), &fit.white_covariance) else {
            return doubtful;
        };
        for (term, &shape) in self.model.moving().0.iter().enumerate() {
            let place = usize::from(self.model.constant) + shape;
            let z = fit.values[place].abs() / white[place][place].sqrt();
            let is_merged = fit.redundant_terms.iter().any(|redundant| match *redundant {
                RedundantTerm::Merged { a, b } => a == term + 1 || b == term + 1,
                RedundantTerm::Vanishing { .. } => false,
            });
            if z < DOUBTFUL {
                doubtful.z = z.max(doubtful.z);
            }
            if z < DOUBTFUL || is_merged {
                doubtful.terms.push(term);
            }
        }
        doubtful
    }

    /// Both ends of the profile of a searched parameter.
    fn ends(
        &self,
        place: usize,
        fit: &Fit,
        uncertainty: &Uncertainty,
        about: &About,
        effort: &mut Effort<'_>,
    ) -> Result<Ends, Cancelled> {
        effort.reach(Progress::open("following a profile", 0))?;
        let (size, linear) = (fit.values.len(), self.model.linear());
        let parameter = match place < linear {
            true => Searched::Linear(place),
            false => Searched::Nonlinear(self.model.free[place - linear], place - linear),
        };
        let gradient: Few = (0..size).map(|i| if i == place { 1.0 } else { 0.0 }).collect();
        let white = fit.white_covariance.as_ref().map_or(f64::NAN, |covariance| covariance[place][place]);
        let widening = (variance_of(&gradient, &uncertainty.covariance) / white).sqrt();
        let variance = self.solution.inverse_normal.as_ref().map_or(f64::NAN, |inverse| inverse[place * size + place]);
        let profile = Profile {
            fitted: self,
            nodes: &about.nodes,
            doubtful: &about.doubtful.terms,
            parameter,
            error: (variance * self.solution.residual_square / uncertainty.freedom).sqrt(),
            target: (uncertainty.factor(&gradient) * widening).hypot(about.doubtful.z) * about.inefficiency.sqrt(),
            freedom: uncertainty.freedom,
            most_iterations: about.most_iterations,
            closeness: about.closeness,
        };
        if !(profile.error > 0.0 && profile.target.is_finite()) {
            return Ok(Ends::default());
        }
        profile.ends(effort)
    }
}

/// Which searched parameter a quantity with this gradient correlates with most, and how much; none if it does so with none.
fn followed(gradient: &[f64], covariance: &[Vec<f64>]) -> Option<(usize, f64)> {
    let own = variance_of(gradient, covariance);
    let correlation = |row: &Vec<f64>, i: usize| {
        let along: f64 = row.iter().zip(gradient).map(|(entry, g)| entry * g).sum();
        along / (own * row[i]).sqrt()
    };
    let all = covariance.iter().enumerate().map(|(i, row)| (i, correlation(row, i)));
    all.filter(|(_, correlation)| correlation.abs() >= FOLLOWED)
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

impl Quantity {
    /// Where the quantity ends if it has this value at the end of a parameter that it correlates with. Where that parameter has no end, the
    /// value may be undetermined: of v = λ |Δ|^(1 − n) the logarithm is 0 · ∞ for n = 1.
    fn beyond(&self, end: f64, correlation: f64) -> Option<f64> {
        let end = match self.scale {
            _ if correlation > 1.0 - 1e-9 => end,
            Scale::Linear => self.value + (end - self.value) / correlation,
            Scale::Log => self.value * (end / self.value).powf(1.0 / correlation),
        };
        (!end.is_nan()).then_some(end)
    }
}

/// What the profiles of all parameters of a fit share.
struct About {
    nodes: Condensed,
    doubtful: Doubtful,
    /// s² of the loss over that of least squares.
    inefficiency: f64,
    most_iterations: usize,
    closeness: Closeness,
}

impl About {
    fn new(fitted: &Fitted, fit: &Fit, options: &LawOptions, inefficiency: f64, closeness: Closeness) -> Self {
        Self {
            nodes: condense(&fitted.scaled),
            doubtful: fitted.doubtful(fit),
            inefficiency,
            most_iterations: options.most_iterations,
            closeness,
        }
    }
}

/// Terms of a series that noise alone may have left, in one of the many places where it could have. They took out of the residuals what a
/// fit without them leaves there: z², by which the bound of a profile is raised.
#[derive(Default)]
struct Doubtful {
    /// Places of their times among the free nonlinear parameters, of which a series has one a term.
    terms: Vec<usize>,
    /// The largest amplitude over its standard error.
    z: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::ParameterKind;
    use crate::fit::law::fit_law::fit_law;
    use crate::fit::options::{ConstantChoice, NoiseChoice};
    use crate::laws::ExponentChoice;
    use crate::statistics::coverage_factor;
    use crate::test_problems::noisy_hold;

    const FREE: Law = Law::Latency {
        exponent: ExponentChoice::Free,
    };

    /// The rate coefficient of a creep with n = 1 had the interval (0, NaN): its amplitude had no end.
    #[test]
    fn an_end_that_is_undetermined_is_open() {
        let rate = Quantity {
            scale: Scale::Log,
            ..Quantity::given(ParameterKind::RateCoefficient.into(), ParameterUnit::RateCoefficient, 1.5)
        };
        let at_infinity = 0.0 * f64::INFINITY;
        for correlation in [1.0, 0.8] {
            assert_eq!(rate.beyond(at_infinity, correlation), None);
            assert_eq!(rate.beyond(f64::INFINITY, correlation), Some(f64::INFINITY));
        }
        assert_eq!(rate.beyond(3.0, 0.5), Some(6.0));
    }

    #[test]
    fn a_fit_with_the_number_held_at_an_end_is_worse_by_the_bound() {
        // Enough samples that the search begins on condensed ones.
        let (times, values) = noisy_hold(1500, 4.0, 2e-2);
        let samples = Samples::new(&times, &values);
        let options = LawOptions {
            noise: NoiseChoice::White,
            ..LawOptions::default()
        };
        let best = fit_law(&samples, FREE, &options).unwrap();
        let freedom = 1500.0 - 4.0;
        let bound = 1.0 + coverage_factor(0.95, freedom).powi(2) / freedom;
        for name in ["equilibrium", "relative_rate_per_s", "exponent"] {
            let interval = profile_interval(&samples, FREE, &options, name).unwrap();
            for end in [interval.low.unwrap(), interval.high.unwrap()] {
                let mut held = options.clone();
                match name {
                    "equilibrium" => held.constant = ConstantChoice::Fixed(end),
                    _ => held.fixed.push((name.to_owned(), end)),
                }
                let worse = fit_law(&samples, FREE, &held).unwrap().residual_square / best.residual_square;
                assert!((worse - bound).abs() < 1e-8 * (bound - 1.0), "{name} at {end}: {worse} {bound}");
            }
        }
    }

    /// 1 + 0.8 exp(−t/0.9) + 1.2 exp(−t/6) over 6 s with noise of 1 % of the drop: how far it goes on is open in most of these.
    fn unfinished(seed: u64) -> Fit {
        let mut random = crate::random::Rng::new(seed);
        let times: Vec<f64> = (0..400).map(|i| 6.0 * f64::from(i) / 399.0).collect();
        let value = |t: &f64| 1.0 + 0.8 * (-t / 0.9).exp() + 1.2 * (-t / 6.0).exp() + 0.02 * random.normal();
        let values: Vec<f64> = times.iter().map(value).collect();
        fit_law(&Samples::new(&times, &values), Law::Prony { terms: 2 }, &LawOptions::default()).unwrap()
    }

    /// One end of a profile lay at the best value where the search had gone through another valley; ends excluded the value itself.
    #[test]
    fn a_profile_does_not_collapse_onto_the_best_value() {
        let (mut count, mut inside) = (0, 0);
        for fit in (0..60).map(unfinished).filter(|fit| fit.termination.is_good()) {
            for parameter in &fit.parameters {
                let Some((low, high)) = parameter.estimate.interval else {
                    continue;
                };
                let value = parameter.estimate.value;
                let least = 1e-6 * value.abs();
                assert!(value - low > least && high - value > least, "{}: {low} {value} {high}", parameter.name);
            }
            let (low, high) = fit.estimate("equilibrium").unwrap().interval.unwrap();
            count += 1;
            inside += u32::from(low <= 1.0 && 1.0 <= high);
        }
        assert!(count >= 50 && f64::from(inside) >= 0.88 * f64::from(count), "{inside} of {count}");
    }

    /// Bands were those of curvature where the parameters had open intervals: the end of time was certain, the equilibrium was not.
    #[test]
    fn a_prediction_is_as_open_as_its_parameters() {
        let (mut count, mut inside) = (0, [0, 0]);
        for fit in (0..60).map(unfinished).filter(|fit| fit.termination.is_good() && fit.profile.is_some()) {
            let far = fit.predict_interval(1e6).interval.unwrap();
            let own = fit.estimate("equilibrium").unwrap().interval.unwrap();
            for (end, own) in [(-far.0, -own.0), (far.1, own.1)] {
                assert!(end == own || end >= own - 1e-9 * own.abs(), "{far:?} {own:?}");
            }
            let start = fit.estimate("start").unwrap().interval.unwrap();
            assert!(start.0 > 2.8 && start.1 < 3.2, "{start:?}");
            count += 1;
            for (inside, time) in inside.iter_mut().zip([9.0f64, 30.0]) {
                let truth = 1.0 + 0.8 * (-time / 0.9).exp() + 1.2 * (-time / 6.0).exp();
                let (low, high) = fit.predict_interval(time).interval.unwrap();
                *inside += u32::from(low <= truth && truth <= high);
            }
        }
        assert!(
            count >= 40 && inside.iter().all(|inside| f64::from(*inside) >= 0.88 * f64::from(count)),
            "{inside:?} of {count}"
        );
        // Less is less sure.
        let fit = unfinished(1);
        let mut half = fit.clone();
        half.uncertainty.as_mut().unwrap().confidence = 0.5;
        let width = |fit: &Fit| fit.predict_interval(9.0).interval.map(|(low, high)| high - low).unwrap();
        assert!(width(&half) < 0.5 * width(&fit));
    }

    #[test]
    fn correlated_residuals_widen_profiles_as_they_widen_intervals() {
        let (times, mut values) = noisy_hold(1000, 1.0, 1e-3);
        let mut drift = 0.0;
        let mut random = crate::test_problems::Rng::new(5);
        for value in &mut values {
            drift = 0.9 * drift + 1e-4 * random.normal();
            *value += drift;
        }
        let samples = Samples::new(&times, &values);
        let options = LawOptions::default();
        let fit = fit_law(&samples, Law::StandardLinearSolid, &options).unwrap();
        assert!(fit.effective_samples() < 200.0, "{:?}", fit.noise);
        for name in ["equilibrium", "time_constant_s"] {
            let (low, high) = fit.estimate(name).unwrap().interval.unwrap();
            let interval = profile_interval(&samples, Law::StandardLinearSolid, &options, name).unwrap();
            // So many samples make the profile a parabola, nearly.
            assert!(((interval.high.unwrap() - interval.low.unwrap()) / (high - low) - 1.0).abs() < 1e-2, "{name}");
        }
    }

    #[test]
    fn numbers_that_are_not_searched_have_no_profile() {
        let (times, values) = noisy_hold(100, 4.0, 1e-2);
        let samples = Samples::new(&times, &values);
        let known = match profile_interval(&samples, FREE, &LawOptions::default(), "rate_coefficient_per_s") {
            Err(FitError::UnknownParameter { known, .. }) => known,
            other => panic!("{other:?}"),
        };
        assert_eq!(known, "equilibrium, amplitude, relative_rate_per_s, exponent");
    }
}
