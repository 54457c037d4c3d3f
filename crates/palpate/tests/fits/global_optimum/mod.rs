//! No search finds a better fit: every law against brute force on random problems drawn from the law itself.
//!
//! 40 problems a law by default; `PALPATE_PROBLEMS=10000 cargo test --release --test fits global_optimum` for more, from parameter
//! `PALPATE_FROM` on.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

mod brute;
mod double_double;

use brute::{Subject, free_parameters, has_reference};
use palpate::fit::{Fit, LawOptions, Samples, Termination, fit_law};
use palpate::laws::{BasisFunction, Law, LawCurve, Response, Term};
use palpate::test_problems::Rng;

/// Shapes, whether there is a constant, and the range of the dimensionless parameter, of a law in a response.
fn parts(law: Law, response: Response) -> (Vec<BasisFunction>, bool, Option<(f64, f64)>) {
    let creep = response == Response::Creep;
    let exponential = |count: usize| vec![BasisFunction::Exponential; count];
    match law
        .to_string()
        .split_once(':')
        .map_or_else(|| (law.to_string(), 0.0), |(name, parameter)| (name.to_owned(), parameter.parse().unwrap()))
    {
        (name, 0.0) => match name.as_str() {
            "latency" => (vec![BasisFunction::Latency], true, Some((0.2, 30.0))),
            "maxwell" if creep => (vec![BasisFunction::Straight], true, None),
            "maxwell" => (exponential(1), false, None),
            "kelvin-voigt" => (exponential(1), false, None),
            "standard-linear-solid" => (exponential(1), true, None),
            "burgers" if creep => (vec![BasisFunction::Exponential, BasisFunction::Straight], true, None),
            "burgers" => (exponential(2), false, None),
            "fung-continuous" => (vec![BasisFunction::FungContinuous], true, Some((0.05, 25.0))),
            "stretched" => (vec![BasisFunction::Stretched], true, Some((0.05, 2.0))),
            "power" if creep => (vec![BasisFunction::PowerGrowth], true, Some((0.01, 2.0))),
            "power" => (vec![BasisFunction::PowerDecay], false, Some((0.005, 5.0))),
            "logarithmic" => (vec![BasisFunction::Logarithm], true, None),
            "fractional-zener" => (vec![BasisFunction::MittagLeffler], true, Some((0.05, 1.0))),
            "diffusion" => (vec![BasisFunction::Diffusion], true, None),
            other => panic!("{other}"),
        },
        (name, n) if name == "latency" => (vec![BasisFunction::LatencyWith(n)], true, None),
        (_, k) => (exponential(k as usize), true, None),
    }
}

struct Problem {
    text: String,
    /// Times over the duration.
    times: Vec<f64>,
    values: Vec<f64>,
    /// True nonlinear parameters, ln of rates per duration.
    truth: Vec<f64>,
}

fn between(random: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * random.uniform()
}

fn times(random: &mut Rng) -> (Vec<f64>, &'static str) {
    let count = 30.0 * 100f64.powf(random.uniform());
    let samples = count as usize;
    match (random.uniform() * 3.0) as u32 {
        0 => ((0..samples).map(|i| i as f64 / (samples - 1) as f64).collect(), "uniform"),
        1 => {
            let first = 10f64.powf(between(random, -5.0, -1.5));
            let spaced = (0..samples - 1).map(|i| first.powf(1.0 - i as f64 / (samples - 2) as f64));
            ([0.0].into_iter().chain(spaced).collect(), "log-spaced")
        }
        _ => {
            let mut times: Vec<f64> = (0..samples - 2).map(|_| random.uniform()).collect();
            times.extend([0.0, 1.0]);
            times.sort_by(f64::total_cmp);
            times.dedup();
            (times, "irregular")
        }
    }
}

/// A hold drawn from the law: rates over six decades, both signs, 30 to 3000 samples, signal-to-noise from 10 to 10⁵.
fn problem(law: Law, response: Response, random: &mut Rng) -> Problem {
    let (shapes, constant, pure) = parts(law, response);
    let (times, spacing) = times(random);
    let mut truth = Vec::new();
    let mut terms = Vec::new();
    let mut log_rate = between(random, 1e-2f64.ln(), 1e4f64.ln());
    let side = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
    for &shape in &shapes {
        let mut parameters = vec![if has_reference(shape) { 0.0 } else { log_rate }];
        if let Some((low, high)) = pure {
            parameters.push(low * (high / low).powf(random.uniform()));
        }
        truth.extend_from_slice(&parameters[usize::from(has_reference(shape))..]);
        terms.push(Term {
            amplitude: side * 10f64.powf(between(random, -0.7, 0.7)),
            shape,
            parameters,
        });
        // The next time is from 1.05 to 1000 times as long.
        log_rate -= between(random, 0.05, 7.0);
    }
    let constant = if constant { between(random, -3.0, 3.0) } else { 0.0 };
    let curve = LawCurve {
        response,
        constant,
        terms,
    };
    let mut values = curve.values(&times);
    let range = values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min);
    let noise = range / 10f64.powf(between(random, 1.0, 5.0));
    values.iter_mut().for_each(|value| *value += noise * random.normal());
    Problem {
        text: format!("{} {spacing} samples, S/N {:.1e}, truth {truth:.3?}", times.len(), range / noise),
        times,
        values,
        truth,
    }
}

fn bounds(law: Law, response: Response, times: &[f64]) -> Vec<(f64, f64)> {
    let (shapes, _, pure) = parts(law, response);
    let rate = (1e-3f64.ln(), (1e3 / times[1]).ln());
    let of = |shape: &BasisFunction| {
        let rate = (!has_reference(*shape)).then_some(rate);
        let parameters: Vec<(f64, f64)> = rate.into_iter().chain(pure).collect();
        assert_eq!(parameters.len(), free_parameters(*shape));
        parameters
    };
    shapes.iter().flat_map(of).collect()
}

/// Residual square of the curve that a fit returns.
fn honest(fit: &Fit, problem: &Problem) -> f64 {
    let curve = fit.curve.values(&problem.times);
    curve.iter().zip(&problem.values).map(|(f, y)| (y - f).powi(2)).sum()
}

/// Relative difference of residual squares that counts.
const BEATEN: f64 = 1e-6;

/// Fits random problems of a law; none may be beaten by brute force, whatever reason the fit gives for its end.
fn challenge(name: &str, response: Response) {
    let requested = |name: &str, usual: u64| std::env::var(name).map_or(usual, |count| count.parse().unwrap());
    let (problems, from) = (requested("PALPATE_PROBLEMS", 40), requested("PALPATE_FROM", 0));
    challenge_with(name, response, from..from + problems);
}

/// The same of the problems of these parameters.
fn challenge_with(name: &str, response: Response, indices: impl IntoIterator<Item = u64>) {
    let law: Law = name.parse().unwrap();
    let (shapes, constant, _) = parts(law, response);
    let options = LawOptions {
        response,
        ..LawOptions::default()
    };
    let (mut problems, mut beaten, mut worst, mut converged) = (0, Vec::new(), f64::NEG_INFINITY, 0);
    let mut spent = std::time::Duration::ZERO;
    for index in indices {
        problems += 1;
        let mut random = Rng::new(index * 7919 + name.len() as u64 * 104_729 + response as u64);
        let problem = problem(law, response, &mut random);
        let begun = std::time::Instant::now();
        let fit = fit_law(&Samples::new(&problem.times, &problem.values), law, &options).unwrap();
        spent += begun.elapsed();
        let honest = honest(&fit, &problem);
        assert!(
            (honest / fit.residual_square - 1.0).abs() < 1e-5,
            "{name} {index}: {honest:e} {:e} {:?}",
            fit.residual_square,
            fit.termination
        );
        let subject = Subject {
            response,
            shapes: shapes.clone(),
            constant,
            bounds: bounds(law, response, &problem.times),
        };
        let ends = subject.search(&problem.times, &problem.values, &problem.truth);
        let (mut least, mut at) = ends[0].clone();
        if fit.residual_square / least - 1.0 > BEATEN {
            (least, at) = subject.checked(&problem.times, &problem.values, ends);
        }
        let excess = fit.residual_square / least - 1.0;
        worst = f64::max(worst, excess);
        converged += u32::from(fit.termination == Termination::Converged);
        if excess > BEATEN {
            let parameters = &fit.values[fit.values.len() - problem.truth.len()..];
            beaten.push(format!(
                "{index}: by {excess:.1e}, {}: ended at {parameters:.3?} ({:?}), better at {at:.3?}",
                problem.text, fit.termination
            ));
        }
    }
    println!(
        "{name} {response:?}: {problems} problems in {spent:.2?}, {converged} converged, {} beaten, worst {worst:.1e}",
        beaten.len()
    );
    assert!(beaten.is_empty(), "{name}: {} of {problems} beaten\n{}", beaten.len(), beaten.join("\n"));
}

macro_rules! challenges {
    ($($test:ident: $law:literal in $response:ident;)*) => {
        $(#[test]
        fn $test() {
            challenge($law, Response::$response);
        })*
    };
}

challenges! {
    latency: "latency" in Relaxation;
    latency_in_creep: "latency" in Creep;
    latency_half: "latency:0.5" in Relaxation;
    latency_one: "latency:1" in Relaxation;
    latency_two: "latency:2" in Relaxation;
    latency_five: "latency:5" in Relaxation;
    maxwell: "maxwell" in Relaxation;
    maxwell_in_creep: "maxwell" in Creep;
    kelvin_voigt: "kelvin-voigt" in Creep;
    standard_linear_solid: "standard-linear-solid" in Relaxation;
    standard_linear_solid_in_creep: "standard-linear-solid" in Creep;
    burgers: "burgers" in Relaxation;
    burgers_in_creep: "burgers" in Creep;
    prony_two: "prony:2" in Relaxation;
    prony_two_in_creep: "prony:2" in Creep;
    prony_three: "prony:3" in Relaxation;
    fung_two: "fung:2" in Relaxation;
    fung_continuous: "fung-continuous" in Relaxation;
    stretched: "stretched" in Relaxation;
    stretched_in_creep: "stretched" in Creep;
    power: "power" in Relaxation;
    power_in_creep: "power" in Creep;
    logarithmic: "logarithmic" in Relaxation;
    logarithmic_in_creep: "logarithmic" in Creep;
    fractional_zener: "fractional-zener" in Relaxation;
    diffusion: "diffusion" in Relaxation;
    diffusion_in_creep: "diffusion" in Creep;
}

/// Optima of three terms that a coarse search misses: slow ones that act as a parabola or a cubic, two or three that come together, and
/// those that the first sample or two feel alone, with amplitudes at the end of what doubles tell apart.
#[test]
fn three_terms_that_nearly_imitate_each_other() {
    let hard = [
        66, 197, 213, 346, 462, 501, 518, 576, 605, 829, 851, 857, 872, 875, 882, 891, 894, 3413, 4561, 5637, 7794,
    ];
    challenge_with("prony:3", Response::Relaxation, hard);
}

/// The optimum is a pair that came together, while the first samples feign a term of their own and the fit seems sound.
#[test]
fn a_term_of_the_first_samples_is_no_optimum() {
    challenge_with("fung:2", Response::Relaxation, [984, 2449]);
    challenge_with("prony:2", Response::Relaxation, [2451, 3157, 5039, 6281, 8534]);
}

/// The second sample feels a hundred thousandth of the relaxation, which is over then: where it ends is a matter of that sample's noise.
#[test]
fn a_law_that_ends_just_after_the_second_sample() {
    challenge_with("latency:0.5", Response::Relaxation, [1583, 5470]);
}
