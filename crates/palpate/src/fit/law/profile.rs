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

use crate::fit::noise::uncertainty::variance_of;
use crate::fit::{Estimate, Fit, FitError, Fitted, Interval, LawOptions, Model, Samples, condense};
use crate::laws::{Law, ShapeParameterKind};
use crate::optimise::{Effort, Ending, Shapes, Target, refine};
use crate::watch::{Cancelled, Progress};

/// Standard errors from the best value beyond which an end counts as open.
const FARTHEST: f64 = 2000.0;

/// Distance of an end, in standard errors, at which its search stops.
const CLOSE: f64 = 1e-9;

/// The same on condensed samples, which only show where to look.
const ROUGH: f64 = 1e-3;

/// The profile-likelihood interval of a parameter of a law, by its name as in the result of [`fit_law`](crate::fit::fit_law).
///
/// Parameters that follow from others (`start`, `rate_coefficient`) have none. An end is open (`None`) if the profile stays below
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
    let fitted = Fitted::new(samples, law, options, &mut Effort::default())?;
    let parameter = Searched::named(&fitted.model, name)?;
    let fit = fitted.report(law, options, &Effort::default())?;
    fitted.profile_of(parameter, &fit, options, &mut Effort::default())
}

impl Fitted {
    /// Intervals of all searched parameters of this fit by their profiles, whose ends may be open; where the whole profile is, there is
    /// no standard error.
    pub(crate) fn profile(&self, fit: &mut Fit, options: &LawOptions, effort: &mut Effort<'_>) -> Result<(), FitError> {
        let known = fit.clone();
        for parameter in &mut fit.parameters {
            let Ok(searched) = Searched::named(&self.model, &parameter.name.to_string()) else {
                continue;
            };
            let interval = self.profile_of(searched, &known, options, effort)?;
            let lowest = if searched.is_above_zero() { 0.0 } else { f64::NEG_INFINITY };
            let ends = (interval.low.unwrap_or(lowest), interval.high.unwrap_or(f64::INFINITY));
            parameter.estimate = match known.termination.is_good() {
                true => Estimate {
                    interval: Some(ends),
                    ..parameter.estimate
                },
                false => parameter.estimate,
            };
        }
        Ok(())
    }

    fn profile_of(
        &self,
        parameter: Searched,
        fit: &Fit,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<Interval, FitError> {
        effort.reach(Progress::open("following a profile", 0))?;
        let (Some(uncertainty), Some(inverse)) = (&fit.uncertainty, &self.solution.inverse_normal) else {
            return Ok(Interval::OPEN);
        };
        let (size, place) = (fit.values.len(), parameter.place(&self.model));
        let gradient: Vec<f64> = (0..size).map(|i| if i == place { 1.0 } else { 0.0 }).collect();
        let white = fit.white_covariance.as_ref().map_or(f64::NAN, |covariance| covariance[place][place]);
        let widening = (variance_of(&gradient, &uncertainty.covariance) / white).sqrt();
        let profile = Profile {
            fitted: self,
            parameter,
            error: (inverse[place * size + place] * self.solution.residual_square / uncertainty.freedom).sqrt(),
            target: uncertainty.factor(&gradient, 0.0) * widening,
            freedom: uncertainty.freedom,
            most_iterations: options.most_iterations,
        };
        if !(fit.termination.is_good() && profile.error > 0.0 && profile.target.is_finite()) {
            return Ok(Interval::OPEN);
        }
        Ok(parameter.in_natural_units(self, profile.end(-1.0, effort)?, profile.end(1.0, effort)?))
    }
}

/// Which of the searched parameters.
#[derive(Clone, Copy)]
enum Searched {
    /// Place among the linear ones.
    Linear(usize),
    /// Place among all nonlinear ones, and among those that are free.
    Nonlinear(usize, usize),
}

impl Searched {
    fn named(model: &Model, name: &str) -> Result<Self, FitError> {
        let names = model.names(|parameter| parameter.name.clone());
        match names.iter().position(|known| known == name) {
            Some(place) if place < model.linear() => Ok(Self::Linear(place)),
            Some(place) => Ok(Self::Nonlinear(model.free[place - model.linear()], place - model.linear())),
            None => Err(FitError::UnknownParameter {
                name: name.to_owned(),
                known: names.join(", "),
            }),
        }
    }

    /// Whether it is a rate, a time or an exponent.
    fn is_above_zero(self) -> bool {
        matches!(self, Self::Nonlinear(..))
    }

    /// Place in the covariance.
    fn place(self, model: &Model) -> usize {
        match self {
            Self::Linear(place) => place,
            Self::Nonlinear(_, free) => model.linear() + free,
        }
    }

    /// Ends in the units of the fit brought to those of the caller.
    fn in_natural_units(self, fitted: &Fitted, low: Option<f64>, high: Option<f64>) -> Interval {
        let (model, scaled) = (&fitted.model, &fitted.scaled);
        let natural = |value: f64| match self {
            Self::Linear(0) if model.constant => value * scaled.range + scaled.center,
            Self::Linear(_) => value * scaled.range,
            Self::Nonlinear(place, _) => match model.parameters[place].kind {
                ShapeParameterKind::Pure { .. } => value,
                ShapeParameterKind::Time => scaled.duration * (-value).exp(),
                ShapeParameterKind::Rate | ShapeParameterKind::Reference => value.exp() / scaled.duration,
            },
        };
        let (low, high) = (low.map(natural), high.map(natural));
        match self {
            Self::Nonlinear(place, _) if model.parameters[place].kind == ShapeParameterKind::Time => {
                Interval { low: high, high: low }
            }
            _ => Interval { low, high },
        }
    }
}

/// The profile of one parameter.
struct Profile<'a> {
    fitted: &'a Fitted,
    parameter: Searched,
    /// Standard error for white noise, in the units of the fit.
    error: f64,
    /// z at the ends.
    target: f64,
    freedom: f64,
    most_iterations: usize,
}

/// A point of a profile: z, and the free nonlinear parameters there.
#[derive(Clone)]
struct Reached {
    distance: f64,
    z: f64,
    theta: Vec<f64>,
    /// A free parameter lies at the edge of its range.
    at_edge: bool,
}

/// Samples or the nodes that stand for them.
struct Field<'a> {
    times: &'a [f64],
    target: Target<'a>,
    inside: f64,
}

impl Profile<'_> {
    /// Where the profile meets its bound on one side, in the units of the fit.
    fn end(&self, side: f64, effort: &mut Effort<'_>) -> Result<Option<f64>, Cancelled> {
        let nodes = condense(&self.fitted.scaled);
        let all = Field {
            times: &self.fitted.scaled.times,
            target: self.fitted.scaled.target(),
            inside: 0.0,
        };
        let few = Field {
            times: &nodes.times,
            target: nodes.target(),
            inside: nodes.inside,
        };
        let start = self.start();
        let worth = 4 * nodes.times.len() < all.times.len();
        let guess = if worth { self.meet(&few, side, &start, self.target, ROUGH, effort)? } else { None };
        let (theta, first) = guess.map_or((start.theta.clone(), self.target), |guess| (guess.theta, guess.distance));
        let met = self.meet(&all, side, &Reached { theta, ..start }, first, CLOSE, effort)?;
        Ok(met.filter(|met| !met.at_edge).map(|met| self.value(side, met.distance)))
    }

    /// The best value and the other nonlinear parameters there.
    fn start(&self) -> Reached {
        let mut theta = self.fitted.solution.nonlinear.clone();
        if let Searched::Nonlinear(_, free) = self.parameter {
            theta.remove(free);
        }
        Reached {
            distance: 0.0,
            z: 0.0,
            theta,
            at_edge: false,
        }
    }

    fn value(&self, side: f64, distance: f64) -> f64 {
        let best = match self.parameter {
            Searched::Linear(place) => self.fitted.solution.linear[place],
            Searched::Nonlinear(_, free) => self.fitted.solution.nonlinear[free],
        };
        best + side * distance * self.error
    }

    /// The farthest distance to look at, in standard errors.
    fn farthest(&self, side: f64) -> f64 {
        let Searched::Nonlinear(place, _) = self.parameter else {
            return FARTHEST;
        };
        let (low, high) = self.fitted.model.parameters[place].bounds;
        let room = if side < 0.0 { self.value(side, 0.0) - low } else { high - self.value(side, 0.0) };
        (room / self.error).min(FARTHEST)
    }

    /// Widens until z exceeds its bound, then closes in by regula falsi (Illinois): z is nearly straight in the parameter.
    fn meet(
        &self,
        field: &Field<'_>,
        side: f64,
        start: &Reached,
        first: f64,
        close: f64,
        effort: &mut Effort<'_>,
    ) -> Result<Option<Reached>, Cancelled> {
        const ROUNDS: usize = 100;
        let farthest = self.farthest(side);
        let mut near = start.clone();
        let mut far = self.at(field, side, first.min(farthest), &near.theta, effort)?;
        while far.z < self.target {
            if far.distance >= farthest {
                return Ok(None);
            }
            let growth = (1.05 * self.target / far.z).clamp(1.1, 2.0);
            near = far;
            far = self.at(field, side, (near.distance * growth).min(farthest), &near.theta, effort)?;
        }
        // What is missing at the near end, what is over at the far one.
        let (mut missing, mut over) = (self.target - near.z, far.z - self.target);
        for _ in 0..ROUNDS {
            let share = missing / (missing + over);
            let middle = near.distance + share * (far.distance - near.distance);
            let width = far.distance - near.distance;
            let trial = self.at(field, side, middle, &far.theta, effort)?;
            let left = self.target - trial.z;
            if width < close * (1.0 + middle) || left.abs() < close {
                return Ok(Some(trial));
            }
            if left > 0.0 {
                (near, missing, over) = (trial, left, 0.5 * over);
            } else {
                (far, over, missing) = (trial, -left, 0.5 * missing);
            }
        }
        Ok(Some(far))
    }

    /// The profile at a distance in standard errors.
    fn at(
        &self,
        field: &Field<'_>,
        side: f64,
        distance: f64,
        theta: &[f64],
        effort: &mut Effort<'_>,
    ) -> Result<Reached, Cancelled> {
        let model = self.held(self.value(side, distance));
        let shapes = model.at(field.times);
        let ending = Ending::tight(self.most_iterations);
        let refined = refine(&shapes, field.target, theta, ending, effort)?;
        let excess = (refined.point.square + field.inside) / self.fitted.solution.residual_square - 1.0;
        let at_edge = refined.point.theta.iter().enumerate().any(|(i, value)| {
            let (low, high) = shapes.bounds(i);
            let near = 1e-6 * (high - low);
            *value <= low + near || *value >= high - near
        });
        Ok(Reached {
            distance,
            z: (excess.max(0.0) * self.freedom).sqrt(),
            theta: refined.point.theta.to_vec(),
            at_edge,
        })
    }

    /// The model with the parameter held: a nonlinear one fixed, a linear one between equal bounds.
    fn held(&self, value: f64) -> Model {
        let model = &self.fitted.model;
        let (mut parameters, mut bounds) = (model.parameters.clone(), model.linear_bounds.clone());
        match self.parameter {
            Searched::Linear(place) => {
                bounds.resize(model.linear(), (f64::NEG_INFINITY, f64::INFINITY));
                bounds[place] = (value, value);
            }
            Searched::Nonlinear(place, _) => parameters[place].fixed = Some(value),
        }
        Model::new(model.form.clone(), model.constant, parameters, bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::law::fit_law::fit_law;
    use crate::fit::options::{ConstantChoice, NoiseChoice};
    use crate::laws::ExponentChoice;
    use crate::statistics::coverage_factor;
    use crate::test_problems::noisy_hold;

    const FREE: Law = Law::Latency {
        exponent: ExponentChoice::Free,
    };

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
