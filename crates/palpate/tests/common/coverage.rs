//! How often intervals contain the truth: simulated holds with noise, fitted many times.

use palpate::fit::{BootstrapOptions, IntervalMethod, LawOptions, Samples, fit_law, profile_interval};
use palpate::laws::{BasisFunction, ExponentChoice, Law, LawCurve, Response, Term};
use palpate::test_problems::Rng;

/// A law whose parameters are known, and how noisy its holds are.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) law: Law,
    curve: LawCurve,
    /// Names and true values, in the order of the report.
    pub(crate) truth: Vec<(&'static str, f64)>,
    /// Correlation of neighbouring noise.
    pub(crate) correlation: f64,
    /// Standard deviation of the noise; the drop is 1.
    pub(crate) deviation: f64,
}

/// Samples of a hold, evenly over 10 s.
pub(crate) const SAMPLES: usize = 1000;

fn term(amplitude: f64, shape: BasisFunction, parameters: &[f64]) -> Term {
    Term {
        amplitude,
        shape,
        parameters: parameters.to_vec(),
    }
}

/// The four laws, each with white noise and with AR(1) noise of 0.9.
pub(crate) fn cases() -> Vec<Case> {
    let power = |n: f64| term(1.0, BasisFunction::Latency, &[2f64.ln(), n]);
    let fixed = Law::Latency {
        exponent: ExponentChoice::Fixed(5.0),
    };
    let free = Law::Latency {
        exponent: ExponentChoice::Free,
    };
    let single = term(1.0, BasisFunction::Exponential, &[-(2f64.ln())]);
    let double = vec![
        term(0.5, BasisFunction::Exponential, &[-(0.3f64.ln())]),
        term(0.5, BasisFunction::Exponential, &[-(3f64.ln())]),
    ];
    let common = [("equilibrium", 1.0), ("amplitude", 1.0)];
    let rates = [("relative_rate_per_s", 2.0), ("rate_coefficient_per_s", 2.0)];
    let named = |more: &[(&'static str, f64)]| [&common[..], more].concat();
    let pairs = [
        ("equilibrium", 1.0),
        ("amplitude_1", 0.5),
        ("amplitude_2", 0.5),
        ("time_constant_1_s", 0.3),
        ("time_constant_2_s", 3.0),
    ];
    let laws = [
        ("latency, n = 5", fixed, vec![power(5.0)], named(&rates), 1e-3),
        ("latency, n free", free, vec![power(3.0)], named(&[rates[0], ("exponent", 3.0), rates[1]]), 1e-3),
        (
            "standard linear solid",
            Law::StandardLinearSolid,
            vec![single],
            named(&[("time_constant_s", 2.0)]),
            1e-2,
        ),
        ("Prony, two times", Law::Prony { terms: 2 }, double, pairs.to_vec(), 1e-3),
    ];
    let with = |correlation: f64| {
        laws.clone().map(|(name, law, terms, truth, deviation)| Case {
            name,
            law,
            curve: LawCurve {
                response: Response::Relaxation,
                constant: 1.0,
                terms,
            },
            truth,
            correlation,
            deviation,
        })
    };
    with(0.0).into_iter().chain(with(0.9)).collect()
}

/// Noise that correlates by ρ^k over k samples, with standard deviation 1.
pub(crate) fn autoregressive(random: &mut Rng, correlation: f64, count: usize) -> Vec<f64> {
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut last = random.normal();
    let mut next = || {
        let now = last;
        last = correlation * last + fresh * random.normal();
        now
    };
    (0..count).map(|_| next()).collect()
}

impl Case {
    /// Times and values of hold number `index`.
    pub(crate) fn hold(&self, index: u64) -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (0..SAMPLES).map(|i| 10.0 * i as f64 / (SAMPLES - 1) as f64).collect();
        let mut random = Rng::new(0xC0_FFEE + (index << 20));
        let noise = autoregressive(&mut random, self.correlation, SAMPLES);
        let values = self.curve.values(&times).iter().zip(noise).map(|(y, e)| y + self.deviation * e).collect();
        (times, values)
    }

    /// Intervals of all parameters of a hold, with value and standard error.
    fn intervals(&self, index: u64, method: Method) -> Vec<Found> {
        let (times, values) = self.hold(index);
        let (samples, options) = (Samples::new(&times, &values), LawOptions::default());
        let fit = fit_law(&samples, self.law, &options).expect("a fit");
        let drawn = (method == Method::Bootstrap).then(|| {
            let how = BootstrapOptions {
                seed: index,
                ..BootstrapOptions::default()
            };
            let intervals = IntervalMethod::Bootstrap(how);
            fit_law(
                &samples,
                self.law,
                &LawOptions {
                    intervals,
                    ..options.clone()
                },
            )
            .expect("a bootstrap")
        });
        let found = |(name, _): &(&str, f64)| {
            let estimate = *fit.estimate(name).expect("a parameter");
            let profile = || profile_interval(&samples, self.law, &options, name).ok();
            let interval = match (method, &drawn) {
                (Method::Profile, _) => profile().and_then(|interval| Some((interval.low?, interval.high?))),
                (_, Some(drawn)) => drawn.estimate(name).and_then(|estimate| estimate.interval),
                _ => estimate.interval,
            };
            Found {
                value: estimate.value,
                error: estimate.standard_error.unwrap_or(f64::NAN),
                white_error: estimate.white_standard_error.unwrap_or(f64::NAN),
                interval,
            }
        };
        self.truth.iter().map(found).collect()
    }
}

/// One parameter of one hold.
struct Found {
    value: f64,
    error: f64,
    white_error: f64,
    interval: Option<(f64, f64)>,
}

/// Where intervals come from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(dead_code, reason = "the quick test and the study use different ones")]
pub(crate) enum Method {
    /// Those of the fit itself.
    Curvature,
    Profile,
    Bootstrap,
}

/// What became of one parameter in many holds.
#[derive(Default, Clone, Copy)]
pub(crate) struct Tally {
    /// Holds whose interval contains the truth.
    pub(crate) covered: usize,
    /// Holds whose truth lies below, and above.
    pub(crate) below: usize,
    pub(crate) above: usize,
    /// Holds whose value ± 1.96 standard errors contains it.
    pub(crate) by_error: usize,
    /// The same with the standard error for white noise.
    pub(crate) by_white_error: usize,
    /// Holds without an interval.
    pub(crate) open: usize,
    /// Sum of widths over values.
    pub(crate) width: f64,
}

/// Counts over holds `from..to`, parameter by parameter.
pub(crate) fn tally(case: &Case, method: Method, holds: std::ops::Range<u64>) -> Vec<Tally> {
    let mut tallies = vec![Tally::default(); case.truth.len()];
    for index in holds {
        for (((_, truth), found), tally) in case.truth.iter().zip(case.intervals(index, method)).zip(&mut tallies) {
            let Some((low, high)) = found.interval else {
                tally.open += 1;
                continue;
            };
            tally.covered += usize::from(low <= *truth && *truth <= high);
            tally.below += usize::from(*truth < low);
            tally.above += usize::from(*truth > high);
            tally.by_error += usize::from((found.value - truth).abs() <= 1.96 * found.error);
            tally.by_white_error += usize::from((found.value - truth).abs() <= 1.96 * found.white_error);
            tally.width += (high - low) / found.value;
        }
    }
    tallies
}
