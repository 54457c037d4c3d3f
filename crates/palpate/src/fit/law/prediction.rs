//! What a fit says about a time, with an interval.

use crate::fit::{Estimate, Fit, ProfileCurves, Scale, Uncertainty, searched_name};
use crate::laws::{Column, Kernel, LawCurve};
use crate::statistics::coverage_factor;
use crate::vector::add_multiple;

impl Fit {
    /// The curve a time `elapsed` (s) after the first sample, also beyond the last, with its confidence interval.
    ///
    /// The interval is that of the curve, not of a sample: g ± t √(gᵀ C g) with g the derivatives of the curve by the searched parameters and C
    /// their covariance for noise that correlates as the residuals do; after an infinite time it is that of the limit. It knows of no other law: far beyond the
    /// hold it is as good as the law is. Where the intervals of the parameters are those of profiles, the band also contains the curves at their
    /// ends ([`profile`](Self::profile)), scaled to its coverage. Of an end that the data leave open the band is open from when more than half of the
    /// way from the last sample to the limit of such a curve lies behind.
    ///
    /// ```
    /// use palpate::fit::{LawOptions, Samples, fit_law};
    /// use palpate::laws::Law;
    /// use palpate::test_problems::noisy_hold;
    /// let (times, values) = noisy_hold(200, 1.0, 1e-2);
    /// let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &LawOptions::default())?;
    /// let end = fit.predict_interval(60.0);
    /// let equilibrium = fit.estimate("equilibrium").unwrap();
    /// assert!((end.value - equilibrium.value).abs() < 1e-6);
    /// assert!((end.standard_error.unwrap() / equilibrium.standard_error.unwrap() - 1.0).abs() < 1e-6);
    /// # Ok::<(), palpate::fit::FitError>(())
    /// ```
    #[must_use]
    pub fn predict_interval(&self, elapsed: f64) -> Estimate {
        self.predict_intervals(&[elapsed]).swap_remove(0)
    }

    /// The curve at many times, as [`predict_interval`](Self::predict_interval).
    #[must_use]
    pub fn predict_intervals(&self, elapsed: &[f64]) -> Vec<Estimate> {
        self.predictions(elapsed, |_, _| 0.0)
    }

    /// What one more sample would show there: the curve with its interval, and noise on top. Under a robust loss too it is a sample as those measured,
    /// outliers included.
    #[must_use]
    pub fn predict_sample(&self, elapsed: f64) -> Estimate {
        self.predict_samples(&[elapsed]).swap_remove(0)
    }

    /// Further samples at many times, as [`predict_sample`](Self::predict_sample), each with the noise of a sample of the root mean square weight, of
    /// the size that noise has there ([`NoiseCourse`](crate::fit::NoiseCourse)).
    #[must_use]
    pub fn predict_samples(&self, elapsed: &[f64]) -> Vec<Estimate> {
        let deviation = self.uncertainty.as_ref().map_or(0.0, |uncertainty| uncertainty.deviation);
        self.predictions(elapsed, |index, value| deviation * self.noise_size(elapsed[index], value))
    }

    /// Further samples at many times whose noise would have these standard deviations, in the unit of the signal, if its size did not change along
    /// the hold.
    ///
    /// # Panics
    /// If there are fewer deviations than times.
    #[must_use]
    pub fn predict_samples_with(&self, elapsed: &[f64], deviations: &[f64]) -> Vec<Estimate> {
        self.predictions(elapsed, |index, value| deviations[index] * self.noise_size(elapsed[index], value))
    }

    /// Standard deviation of the noise at a time where the curve has this value, over that of the whole hold.
    fn noise_size(&self, elapsed: f64, value: f64) -> f64 {
        self.noise_course.map_or(1.0, |course| course.size(elapsed, value))
    }

    /// `deviation` is that of the noise of a sample, by its number and the curve there.
    fn predictions(&self, elapsed: &[f64], deviation: impl Fn(usize, f64) -> f64) -> Vec<Estimate> {
        let values = self.predict_many(elapsed);
        let deviation = |index: usize| deviation(index, values[index]);
        let (Some(uncertainty), Some(white)) = (&self.uncertainty, &self.white_covariance) else {
            return values.iter().copied().map(Estimate::fixed).collect();
        };
        let mut gradients = self.gradients(elapsed);
        // At its limit a curve moves with the constant alone: 0 · ∞ is 0 there.
        for at in (0..elapsed.len()).filter(|at| elapsed[*at] == f64::INFINITY && values[*at].is_finite()) {
            gradients.iter_mut().filter(|column| !column[at].is_finite()).for_each(|column| column[at] = 0.0);
        }
        let mut found =
            uncertainty.estimates(&values, &gradients, white, |index| deviation(index).powi(2), |_| Scale::Linear);
        if let Some(profile) = &self.profile {
            self.widen(&mut found, profile, uncertainty, elapsed, deviation);
        }
        for (estimate, _) in found.iter_mut().zip(elapsed).filter(|(_, time)| time.is_nan()) {
            *estimate = Estimate::fixed(f64::NAN);
        }
        found
    }

    /// Widens intervals to the curves at the ends of profiles; those of samples have noise on top.
    fn widen(
        &self,
        found: &mut [Estimate],
        profile: &ProfileCurves,
        uncertainty: &Uncertainty,
        elapsed: &[f64],
        deviation: impl Fn(usize) -> f64,
    ) {
        let factor = coverage_factor(uncertainty.confidence, uncertainty.freedom);
        let scale = factor / coverage_factor(profile.confidence, uncertainty.freedom);
        for (place, curve) in profile.curves.iter().enumerate() {
            let open = profile.open.get(place).filter(|is_open| **is_open).and_then(|_| self.half_way(curve));
            for (index, (estimate, there)) in found.iter_mut().zip(self.values_of(curve, elapsed)).enumerate() {
                let away = scale * (there - estimate.value);
                let is_open = elapsed[index] > self.duration
                    && open.is_some_and(|(half_way, falls)| if falls { there < half_way } else { there > half_way });
                let half = if is_open { f64::INFINITY } else { away.hypot(factor * deviation(index)) };
                if let Some((low, high)) = &mut estimate.interval {
                    let end = estimate.value + half.copysign(away);
                    (*low, *high) = (low.min(end), high.max(end));
                }
            }
        }
    }

    /// The value of a curve half way from the last sample to its limit, and whether it falls from there; `None` of a curve without a limit, and of
    /// one that is there.
    fn half_way(&self, curve: &LawCurve) -> Option<(f64, bool)> {
        /// Durations after which all has relaxed.
        const AT_LAST: f64 = 1e30;
        let [last, limit] = self.values_of(curve, &[self.duration, AT_LAST * self.duration])[..] else {
            return None;
        };
        (limit.is_finite() && limit != last).then_some((0.5 * (last + limit), limit < last))
    }

    /// Derivatives of the curve by the searched parameters, in the order of `searched`: a column each.
    fn gradients(&self, elapsed: &[f64]) -> Vec<Vec<f64>> {
        let mut gradients = vec![vec![0.0; elapsed.len()]; self.searched.len()];
        let Some(form) = self.law.form(self.response) else {
            return gradients;
        };
        let mut add = |name: &str, factor: f64, entries: &[f64]| {
            if let Some(place) = self.searched.iter().position(|parameter| parameter == name) {
                add_multiple(&mut gradients[place], factor, entries);
            }
        };
        let ones = vec![1.0; elapsed.len()];
        add(form.constant_name(), 1.0, &ones);
        let times: Vec<f64> = elapsed.iter().map(|time| time.max(0.0)).collect();
        let parameters = form.parameters();
        for (shape, (term, amplitude)) in self.curve.terms.iter().zip(form.amplitude_names()).enumerate() {
            let column = Column::of(&term.shape, self.response);
            let (mut value, mut slopes) = (ones.clone(), vec![ones.clone(); term.parameters.len()]);
            term.shape.gradient(&times, &term.parameters, &mut value, &mut slopes);
            add(&amplitude, column.offset, &ones);
            add(&amplitude, column.sign, &value);
            let own = parameters.iter().filter(|(of, _, _)| *of == shape);
            for ((_, name, kind), slope) in own.zip(slopes) {
                add(&searched_name(name, *kind), term.amplitude * column.sign, &slope);
            }
        }
        gradients
    }
}

#[cfg(test)]
mod tests {
    use crate::fit::NoiseChoice;
    use crate::fit::law::fit_law::fit_law;
    use crate::fit::options::LawOptions;
    use crate::fit::samples::Samples;
    use crate::laws::{ExponentChoice, Law, Response};
    use crate::test_problems::noisy_hold;

    #[test]
    fn gradients_are_those_of_the_curve() {
        let (times, values) = noisy_hold(300, 3.0, 1e-3);
        let creep: Vec<f64> = times.iter().zip(&values).map(|(t, y)| 1.0 - y + 0.01 * t).collect();
        let fixed = LawOptions {
            fixed: vec![("exponent".to_owned(), 3.0)],
            ..LawOptions::default()
        };
        let creeping = LawOptions {
            response: Response::Creep,
            ..LawOptions::default()
        };
        let free = Law::Latency {
            exponent: ExponentChoice::Free,
        };
        for (law, values, options) in [
            (free, &values, LawOptions::default()),
            (free, &values, fixed),
            (Law::Prony { terms: 2 }, &values, LawOptions::default()),
            (Law::Burgers, &creep, creeping),
        ] {
            let fit = fit_law(&Samples::new(&times, values), law, &options).unwrap();
            let elapsed = 17.3;
            let gradient: Vec<f64> = fit.gradients(&[elapsed]).iter().map(|column| column[0]).collect();
            assert_eq!(gradient.len(), fit.values.len());
            for (i, name) in fit.searched.iter().enumerate() {
                let beside = |side: f64| {
                    let mut curve = fit.curve.clone();
                    let by = side * 1e-6;
                    let form = law.form(fit.response).unwrap();
                    if name == form.constant_name() {
                        curve.constant += by;
                    } else if let Some(term) = form.amplitude_names().iter().position(|of| of == name) {
                        curve.terms[term].amplitude += by;
                    } else {
                        let at = form
                            .parameters()
                            .iter()
                            .position(|(_, of, kind)| &crate::fit::problem::model::searched_name(of, *kind) == name);
                        let shape = form.parameters()[at.unwrap()].0;
                        let first = form.parameters().iter().position(|(of, _, _)| *of == shape).unwrap();
                        curve.terms[shape].parameters[at.unwrap() - first] += by;
                    }
                    curve.at(elapsed)
                };
                let slope = (beside(1.0) - beside(-1.0)) / 2e-6;
                assert!(
                    (slope - gradient[i]).abs() < 1e-8 * (1.0 + slope.abs()),
                    "{law:?} {name}: {slope} {}",
                    gradient[i]
                );
            }
        }
    }

    #[test]
    fn a_sample_is_less_sure_than_the_curve() {
        let (times, values) = noisy_hold(400, 1.0, 1e-2);
        let options = LawOptions {
            noise: NoiseChoice::White,
            ..LawOptions::default()
        };
        let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
        let (curve, sample) = (fit.predict_interval(12.0), fit.predict_sample(12.0));
        let noise = (fit.residual_square / 397.0).sqrt();
        let sum = curve.standard_error.unwrap().hypot(noise);
        assert!((sample.standard_error.unwrap() / sum - 1.0).abs() < 1e-12);
        let width = |interval: Option<(f64, f64)>| interval.unwrap().1 - interval.unwrap().0;
        // 2 × 1.966 standard errors: Student's t at 397 degrees of freedom.
        assert!((width(curve.interval) / curve.standard_error.unwrap() - 2.0 * 1.966).abs() < 1e-3);
        assert!((width(sample.interval) / sum - 2.0 * 1.966).abs() < 1e-3);
    }

    /// Derivatives at the limit were 0 · ∞: its interval was NaN.
    #[test]
    fn the_limit_of_a_curve_has_the_interval_of_its_constant() {
        let (times, values) = noisy_hold(400, 1.0, 1e-2);
        for law in ["standard-linear-solid", "latency:3", "fractional-zener"] {
            let fit = fit_law(&Samples::new(&times, &values), law.parse().unwrap(), &LawOptions::default()).unwrap();
            let (limit, constant) = (fit.predict_interval(f64::INFINITY), fit.estimate("equilibrium").unwrap());
            assert_eq!(limit.value, constant.value, "{law}");
            assert!((limit.standard_error.unwrap() / constant.standard_error.unwrap() - 1.0).abs() < 1e-9, "{law}");
        }
    }

    /// Large products of the covariance of an equilibrium far below the hold took each other away to less than nothing: bands were NaN.
    #[test]
    fn bands_of_a_hold_that_is_nearly_straight_are_numbers() {
        let times: Vec<f64> = (0..200).map(|i| f64::from(i) / 199.0).collect();
        let drop = 1.0 - (-0.01_f64).exp();
        for (law, noise) in [("standard-linear-solid", 1e-3), ("latency", 1e-6), ("prony:2", 0.0)] {
            for seed in 0..8 {
                let mut random = crate::random::Rng::new(seed);
                let values: Vec<f64> =
                    times.iter().map(|t| 1.0 + (-t / 100.0).exp() / drop + noise * random.normal()).collect();
                let fit =
                    fit_law(&Samples::new(&times, &values), law.parse().unwrap(), &LawOptions::default()).unwrap();
                if !fit.termination.is_good() || fit.uncertainty.is_none() {
                    continue;
                }
                for estimate in fit.predict_intervals(&times).into_iter().chain(fit.predict_samples(&times)) {
                    let (low, high) = estimate.interval.unwrap_or_else(|| panic!("{law} {seed}: no interval"));
                    assert!(low <= estimate.value && estimate.value <= high, "{law} {seed}: {low} {high}");
                }
            }
        }
    }
}
