//! Noise of many kinds, most of which no fit was made for, and laws to add it to.

use palpate::laws::{BasisFunction, ExponentChoice, Law, LawCurve, Response, Term};
use palpate::test_problems::Rng;

/// A kind of noise.
#[derive(Clone, Copy)]
pub(crate) enum Noise {
    /// e_i = Σ_k a_k e_{i−k} + c Σ_k b_k w_{i−k} of white noise w: poles a, zeros b, and c.
    Filtered(&'static [f64], &'static [f64], f64),
    /// A line with a random phase, three times as large as white noise beside it.
    Hum,
    /// 1/f^a by fractional integration of white noise (Hosking 1981), and white noise of this size.
    PowerLaw(f64, f64),
    /// A random walk with steps of this size, and white noise of this size.
    Walk(f64, f64),
    /// AR(1) of this correlation in proportion to the signal above 0.9.
    Proportional(f64),
    /// White noise, and all rounded to so many times its size, on a grid of any phase.
    Rounded(f64),
    /// White noise of a sensor so many times as slow, with straight lines between its readings.
    Interpolated(usize),
    /// White noise in proportion to the signal above 0.9, at times evenly spaced in ln t.
    ProportionalAtLogarithmicTimes,
    /// Noise that fades within 0.1 s, and white noise of this size, at times evenly spaced in ln t.
    LogarithmicTimes(f64),
}

/// All kinds by their names.
pub(crate) const KINDS: [(&str, Noise); 27] = [
    ("white", Noise::Filtered(&[], &[1.0], 1.0)),
    ("AR(1) 0.7", Noise::Filtered(&[0.7], &[1.0], 0.714)),
    ("AR(1) 0.9", Noise::Filtered(&[0.9], &[1.0], 0.436)),
    ("AR(1) 0.99", Noise::Filtered(&[0.99], &[1.0], 0.141)),
    ("AR(1) -0.5", Noise::Filtered(&[-0.5], &[1.0], 0.866)),
    ("AR(1) -0.8", Noise::Filtered(&[-0.8], &[1.0], 0.6)),
    ("ARMA(2, 1)", Noise::Filtered(&[1.2, -0.5], &[1.0, 0.5], 0.5)),
    // Poles at 0.9 exp(±0.1 i): white noise behind a filter of the second order.
    ("low-pass filter", Noise::Filtered(&[1.791, -0.81], &[1.0], 0.0848)),
    ("MA(5)", Noise::Filtered(&[], &[1.0; 6], 0.408)),
    ("hum", Noise::Hum),
    ("1/f^0.7", Noise::PowerLaw(0.7, 0.0)),
    ("1/f", Noise::PowerLaw(1.0, 0.0)),
    ("1/f and white", Noise::PowerLaw(1.0, 1.0)),
    ("random walk", Noise::Walk(0.3, 0.0)),
    ("walk 1 and white", Noise::Walk(1.0, 1.0)),
    ("walk 0.3 and white", Noise::Walk(0.3, 1.0)),
    ("walk 0.1 and white", Noise::Walk(0.1, 1.0)),
    ("walk 0.03 and white", Noise::Walk(0.03, 1.0)),
    ("proportional", Noise::Proportional(0.0)),
    ("proportional AR(1) 0.9", Noise::Proportional(0.9)),
    ("proportional, logarithmic times", Noise::ProportionalAtLogarithmicTimes),
    ("rounded to 5 sd", Noise::Rounded(5.0)),
    ("rounded to 8 sd", Noise::Rounded(8.0)),
    ("interpolated, 4 to 1", Noise::Interpolated(4)),
    ("interpolated, 10 to 1", Noise::Interpolated(10)),
    ("logarithmic times", Noise::LogarithmicTimes(0.0)),
    ("logarithmic times, and white", Noise::LogarithmicTimes(1.0)),
];

/// A law with its true parameters.
pub(crate) struct Known {
    pub(crate) name: &'static str,
    pub(crate) law: Law,
    terms: Vec<Term>,
    pub(crate) truth: Vec<(&'static str, f64)>,
}

/// Laws with times of 0.3 to 3 s.
pub(crate) fn laws() -> [Known; 4] {
    let term = |amplitude: f64, shape: BasisFunction, parameters: &[f64]| Term {
        amplitude,
        shape,
        parameters: parameters.to_vec(),
    };
    let with = |name, law, terms, more: &[(&'static str, f64)]| Known {
        name,
        law,
        terms,
        truth: [&[("equilibrium", 1.0)], more].concat(),
    };
    let power = |n: f64| vec![term(1.0, BasisFunction::Latency, &[2f64.ln(), n])];
    let latency = |exponent| Law::Latency { exponent };
    let exponential = |amplitude: f64, time: f64| term(amplitude, BasisFunction::Exponential, &[-time.ln()]);
    let (amplitude, rate) = (("amplitude", 1.0), ("relative_rate_per_s", 2.0));
    [
        with("latency, n = 5", latency(ExponentChoice::Fixed(5.0)), power(5.0), &[amplitude, rate]),
        with("latency, n free", latency(ExponentChoice::Free), power(3.0), &[amplitude, rate, ("exponent", 3.0)]),
        with(
            "standard linear solid",
            Law::StandardLinearSolid,
            vec![exponential(1.0, 2.0)],
            &[amplitude, ("time_constant_s", 2.0)],
        ),
        with(
            "Prony, two times",
            Law::Prony { terms: 2 },
            vec![exponential(0.5, 0.3), exponential(0.5, 3.0)],
            &[("amplitude_1", 0.5), ("amplitude_2", 0.5), ("time_constant_1_s", 0.3), ("time_constant_2_s", 3.0)],
        ),
    ]
}

/// Times of a hold of this many seconds, and its signal there without noise.
pub(crate) fn truth_over(duration: f64, known: &Known, noise: Noise, samples: usize) -> (Vec<f64>, Vec<f64>) {
    let share = |i: usize| i as f64 / (samples - 1) as f64;
    let time = |i: usize| match noise {
        // Amplitudes are those at the first sample, the true ones at 0.
        Noise::LogarithmicTimes(_) | Noise::ProportionalAtLogarithmicTimes => {
            1.001 * duration * (1.001e3_f64.powf(share(i)) - 1.0) / 1e3
        }
        _ => duration * share(i),
    };
    let times: Vec<f64> = (0..samples).map(time).collect();
    let curve = LawCurve {
        response: Response::Relaxation,
        constant: 1.0,
        terms: known.terms.clone(),
    };
    let values = curve.values(&times);
    (times, values)
}

fn filtered(random: &mut Rng, poles: &[f64], zeros: &[f64], count: usize) -> Vec<f64> {
    /// Samples until the beginning is forgotten.
    const BEFORE: usize = 1000;
    let fresh: Vec<f64> = (0..count + BEFORE).map(|_| random.normal()).collect();
    let mut made: Vec<f64> = Vec::with_capacity(fresh.len());
    for i in 0..fresh.len() {
        let moved: f64 = zeros.iter().zip(fresh[..=i].iter().rev()).map(|(zero, before)| zero * before).sum();
        let kept: f64 = poles.iter().zip(made.iter().rev()).map(|(pole, before)| pole * before).sum();
        made.push(moved + kept);
    }
    made.split_off(BEFORE)
}

fn power_law(random: &mut Rng, exponent: f64, count: usize) -> Vec<f64> {
    let memory = 16 * count;
    let mut weights = vec![1.0];
    for k in 1..memory {
        weights.push(weights[k - 1] * (k as f64 - 1.0 + 0.5 * exponent) / k as f64);
    }
    let fresh: Vec<f64> = (0..count + memory).map(|_| random.normal()).collect();
    (0..count)
        .map(|i| weights.iter().zip(fresh[..=i + memory].iter().rev()).map(|(weight, before)| weight * before).sum())
        .collect()
}

impl Noise {
    /// The signal with noise of this size.
    pub(crate) fn added(self, times: &[f64], clean: &[f64], size: f64, random: &mut Rng) -> Vec<f64> {
        let count = times.len();
        let white = |random: &mut Rng| -> Vec<f64> { (0..count).map(|_| random.normal()).collect() };
        let plus = |made: Vec<f64>, more: Vec<f64>, factor: f64| -> Vec<f64> {
            made.iter().zip(more).map(|(one, more)| one + factor * more).collect()
        };
        let noise = match self {
            Self::Filtered(poles, zeros, factor) => {
                filtered(random, poles, zeros, count).iter().map(|made| factor * made).collect()
            }
            Self::Hum => {
                let phase = std::f64::consts::TAU * random.uniform();
                let line = (0..count).map(|i| 3.0 * (0.817 * i as f64 + phase).sin()).collect();
                plus(white(random), line, 1.0)
            }
            Self::PowerLaw(exponent, beside) => {
                let made = power_law(random, exponent, count);
                plus(made, white(random), beside)
            }
            Self::Walk(step, beside) => {
                let steps = white(random);
                let walk = steps.iter().scan(0.0, |at, by| {
                    *at += step * by;
                    Some(*at)
                });
                plus(walk.collect(), white(random), beside)
            }
            Self::Proportional(correlation) => {
                let factor = 5.0 * (1.0 - correlation * correlation).sqrt();
                let made = filtered(random, &[correlation], &[1.0], count);
                made.iter().zip(clean).map(|(made, y)| factor * made * (y - 0.9)).collect()
            }
            Self::Interpolated(times) => {
                let read: Vec<f64> = (0..count / times + 2).map(|_| random.normal()).collect();
                let between = |i: usize| (i / times, (i % times) as f64 / times as f64);
                (0..count).map(between).map(|(i, share)| read[i] + share * (read[i + 1] - read[i])).collect()
            }
            Self::ProportionalAtLogarithmicTimes => {
                white(random).iter().zip(clean).map(|(made, y)| 5.0 * made * (y - 0.9)).collect()
            }
            Self::Rounded(_) => white(random),
            Self::LogarithmicTimes(beside) => {
                let mut last = random.normal();
                let mut next = |i: usize| {
                    let kept = if i == 0 { 1.0 } else { (-(times[i] - times[i - 1]) / 0.1).exp() };
                    last = kept * last + (1.0 - kept * kept).sqrt() * random.normal();
                    last
                };
                let made = (0..count).map(&mut next).collect();
                plus(made, white(random), beside)
            }
        };
        let values = clean.iter().zip(noise).map(|(y, noise): (&f64, f64)| y + size * noise);
        match self {
            Self::Rounded(ratio) => {
                let (step, phase) = (ratio * size, random.uniform());
                values.map(|value| ((value / step + phase).round() - phase) * step).collect()
            }
            _ => values.collect(),
        }
    }
}
