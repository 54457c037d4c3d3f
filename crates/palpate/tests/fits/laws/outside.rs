//! A law that this crate does not know, taken through the five steps of CONTRIBUTING.md from outside: the log-logistic relaxation
//! y(t) = y_e + Δ/(1 + (t/τ)^α).

use palpate::fit::{FitError, LawOptions, NoiseChoice, ParameterRole, Samples, fit_law};
use palpate::forecast::{CompareOptions, compare_laws};
use palpate::laws::{
    BasisFunction, Composition, CustomKernel, Description, Kernel, Law, LawDefinition, Response, ShapeParameter,
    ShapeParameterKind,
};
use palpate::test_problems::Rng;

// Step 1, the function: 1/(1 + (λt)^α) with its derivatives by ln λ and α.
struct LogLogistic;

impl Kernel for LogLogistic {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 8] = [0.1, 0.2, 0.35, 0.5, 0.8, 1.0, 1.4, 2.0];
        const {
            &[
                ShapeParameter::new("time_constant_s", ShapeParameterKind::Time),
                ShapeParameter::pure("sharpness", 0.05, 3.0, &COARSE),
            ]
        }
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        let rate = theta[0].exp();
        for (value, t) in value.iter_mut().zip(times) {
            *value = 1.0 / (1.0 + (rate * t).powf(theta[1]));
        }
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        self.value(times, theta, value);
        let rate = theta[0].exp();
        for (index, t) in times.iter().enumerate() {
            let z = (rate * t).powf(theta[1]);
            let slope = -z * value[index] * value[index];
            derivatives[0][index] = theta[1] * slope;
            derivatives[1][index] = if *t > 0.0 { slope * (rate * t).ln() } else { 0.0 };
        }
    }

    fn formula(&self, theta: &[f64]) -> Option<String> {
        Some(format!("1/[1 + (t/{:.3} s)^{:.3}]", (-theta[0]).exp(), theta[1]))
    }
}

// Steps 2 and 3, the law: its name, its words, its forms. A fit takes it as it is.
static LOG_LOGISTIC: LawDefinition = LawDefinition {
    name: "log-logistic",
    description: Description {
        title: "log-logistic",
        equation: "y_e + Δ/(1 + (t/τ)^α)",
        source: "Verhulst 1838, in ln t",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: false,
};
const FORM: Composition = Composition::with_constant(&[BasisFunction::Custom(CustomKernel {
    name: "log-logistic",
    kernel: &LogLogistic,
})]);
const LAW: Law = Law::Custom(&LOG_LOGISTIC);

fn hold(sharpness: f64, noise: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(seed);
    let times: Vec<f64> = (0..600).map(|i| 0.05 * f64::from(i)).collect();
    let value = |t: &f64| 2.0 + 3.0 / (1.0 + (t / 1.5).powf(sharpness)) + noise * random.normal();
    let values = times.iter().map(value).collect();
    (times, values)
}

// Step 4, tests: derivatives, a limit, recovery, agreement with a law that exists.

#[test]
fn its_derivatives_are_those_of_its_values() {
    let times: Vec<f64> = (0..50).map(|i| 0.2 * f64::from(i)).collect();
    let (mut value, mut derivatives) = (vec![0.0; 50], vec![vec![0.0; 50]; 2]);
    let theta = [-0.4, 0.7];
    LogLogistic.gradient(&times, &theta, &mut value, &mut derivatives);
    for (parameter, derivative) in derivatives.iter().enumerate() {
        let at = |by: f64| {
            let mut moved = theta;
            moved[parameter] += by;
            let mut value = vec![0.0; 50];
            LogLogistic.value(&times, &moved, &mut value);
            value
        };
        for ((high, low), slope) in at(1e-6).iter().zip(at(-1e-6)).zip(derivative) {
            assert!(((high - low) / 2e-6 - slope).abs() < 1e-9);
        }
    }
}

#[test]
fn its_known_parameters_are_recovered_with_and_without_noise() {
    let (times, values) = hold(0.7, 0.0, 1);
    let exact = fit_law(&Samples::new(&times, &values), LAW, &LawOptions::default()).unwrap();
    for (name, truth) in [("equilibrium", 2.0), ("amplitude", 3.0), ("time_constant_s", 1.5), ("sharpness", 0.7)] {
        assert!((exact.value(name).unwrap() / truth - 1.0).abs() < 1e-6, "{name}: {:?}", exact.value(name));
    }
    assert_eq!(exact.curve.formula("F", "N"), "F(t) = 2.000 N + 3.000 N · 1/[1 + (t/1.500 s)^0.700]");
    let mut covered = 0;
    for seed in 0..100 {
        let (times, values) = hold(0.7, 0.02, seed);
        let options = LawOptions {
            noise: NoiseChoice::White,
            ..LawOptions::default()
        };
        let fit = fit_law(&Samples::new(&times, &values), LAW, &options).unwrap();
        let sharpness = fit.parameters.iter().find(|parameter| parameter.name == *"sharpness").unwrap();
        assert_eq!(sharpness.role, ParameterRole::Estimated);
        let (low, high) = sharpness.estimate.interval.unwrap();
        covered += usize::from((low..=high).contains(&0.7));
    }
    assert!((88..=100).contains(&covered), "{covered} of 100 intervals cover");
}

#[test]
fn it_reduces_to_the_latency_law_of_order_two() {
    // 1/(1 + t/τ) is [1 + (n−1) λt]^(−1/(n−1)) with n = 2 and λ = 1/τ.
    let (times, values) = hold(1.0, 0.01, 3);
    let samples = Samples::new(&times, &values);
    let options = LawOptions {
        fixed: vec![("sharpness".to_owned(), 1.0)],
        ..LawOptions::default()
    };
    let own = fit_law(&samples, LAW, &options).unwrap();
    let latency = fit_law(&samples, "latency:2".parse().unwrap(), &LawOptions::default()).unwrap();
    assert!((own.residual_square / latency.residual_square - 1.0).abs() < 1e-9);
    let rate = latency.value("relative_rate_per_s").unwrap();
    assert!((own.value("time_constant_s").unwrap() * rate - 1.0).abs() < 1e-6);
}

#[test]
fn it_is_compared_with_the_laws_of_the_crate() {
    let (times, values) = hold(0.6, 0.003, 5);
    let mut options = CompareOptions::default();
    options.laws.push(LAW);
    let comparison = compare_laws(&Samples::new(&times, &values), &options).unwrap();
    let row = comparison.rows.iter().find(|row| row.law == LAW).unwrap();
    assert!(row.fit.is_ok());
    let verdict = comparison.verdict.unwrap();
    assert!(verdict.indistinguishable.contains(&LAW), "{verdict:?}");
}

#[test]
fn what_it_lacks_is_refused_by_name() {
    let (times, values) = hold(0.7, 0.0, 1);
    let options = LawOptions {
        fixed: vec![("stretching".to_owned(), 1.0)],
        ..LawOptions::default()
    };
    let error = fit_law(&Samples::new(&times, &values), LAW, &options).unwrap_err();
    assert!(
        matches!(&error, FitError::UnknownParameter { .. }) && error.to_string().contains("sharpness"),
        "{error}"
    );
    // It has a name to be written by, which no text is read as.
    assert_eq!((LAW.to_string(), LAW.describes(Response::Creep)), ("log-logistic".to_owned(), true));
    assert!("log-logistic".parse::<Law>().is_err());
}
