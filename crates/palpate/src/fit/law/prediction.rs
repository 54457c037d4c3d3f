//! What a fit says about a time, with an interval.

use crate::fit::noise::uncertainty::variance_of;
use crate::fit::{Estimate, Fit, Scale, searched_name};
use crate::laws::{Column, Kernel};

impl Fit {
    /// The curve a time `elapsed` (s) after the first sample, also beyond the last, with its confidence interval.
    ///
    /// The interval is that of the curve, not of a sample: g ± t √(gᵀ C g) with g the derivatives of the curve by the searched
    /// parameters and C their covariance for noise that correlates as the residuals do. It knows of no other law: far beyond the
    /// hold it is as good as the law is.
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
        self.prediction(elapsed, 0.0)
    }

    /// What one more sample would show there: the curve with its interval, and noise on top.
    #[must_use]
    pub fn predict_sample(&self, elapsed: f64) -> Estimate {
        self.prediction(elapsed, self.uncertainty.as_ref().map_or(0.0, |uncertainty| uncertainty.deviation))
    }

    fn prediction(&self, elapsed: f64, deviation: f64) -> Estimate {
        let value = self.predict(elapsed);
        let (Some(uncertainty), Some(white), false) = (&self.uncertainty, &self.white_covariance, elapsed.is_nan())
        else {
            return Estimate::fixed(value);
        };
        let gradient = self.gradient(elapsed);
        let white = variance_of(&gradient, white);
        uncertainty.estimate_beside(value, &gradient, white, deviation * deviation, Scale::Linear)
    }

    /// Derivatives of the curve by the searched parameters, in the order of `searched`.
    fn gradient(&self, elapsed: f64) -> Vec<f64> {
        let mut gradient = vec![0.0; self.searched.len()];
        let Some(form) = self.law.form(self.response) else {
            return gradient;
        };
        let mut add = |name: &str, entry: f64| {
            if let Some(place) = self.searched.iter().position(|parameter| parameter == name) {
                gradient[place] += entry;
            }
        };
        add(form.constant_name(), 1.0);
        let parameters = form.parameters();
        for (shape, (term, amplitude)) in self.curve.terms.iter().zip(form.amplitude_names()).enumerate() {
            let column = Column::of(&term.shape, self.response);
            let (mut value, mut slopes) = ([0.0], vec![vec![0.0]; term.parameters.len()]);
            term.shape.gradient(&[elapsed.max(0.0)], &term.parameters, &mut value, &mut slopes);
            add(&amplitude, column.offset + column.sign * value[0]);
            let own = parameters.iter().filter(|(of, _, _)| *of == shape);
            for ((_, name, kind), slope) in own.zip(slopes) {
                add(&searched_name(name, *kind), term.amplitude * column.sign * slope[0]);
            }
        }
        gradient
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
            let gradient = fit.gradient(elapsed);
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
}
