//! The rate domain is biased by noise, the time domain is not; the analysis says by how much.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::analysis::{AnalysisOptions, analyze};
use palpate::fit::{ExponentChoice, FitOptions, fit_hold, fit_rates};
use palpate::record::Record;
use palpate::strain::{RateWindow, strain_rates};
use palpate::test_problems::Rng;

const TRUTH: f64 = 2e4;

/// 10 s at `rate` Hz: ε_e = 0.357, Δ = 0.133, n = 5, v = 2·10⁴ 1/s, noise as a share of Δ.
fn hold(rate: f64, noise: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(seed);
    let lambda = TRUTH * 0.133f64.powi(4);
    let times: Vec<f64> = (0..(10.0 * rate) as u32).map(|i| f64::from(i) / rate).collect();
    let strain = |t: &f64| 0.357 + 0.133 * ((1.0 + 4.0 * lambda * t).powf(-0.25) + noise * random.normal());
    let strains = times.iter().map(strain).collect();
    (times, strains)
}

/// Mean v over the truth in both domains.
fn bias(rate: f64, noise: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for seed in 0..100 {
        let (times, strains) = hold(rate, noise, seed);
        let options = FitOptions::default();
        let in_time = fit_hold(&times, &strains, ExponentChoice::Fixed(5.0), &options).unwrap();
        let rates = strain_rates(&times, &strains, &RateWindow::default());
        let by_rate = fit_rates(&rates.strain, &rates.rate, ExponentChoice::Fixed(5.0), &options).unwrap();
        sums[0] += in_time.rate_coefficient().value / TRUTH;
        sums[1] += by_rate.rate_coefficient().value / TRUTH;
    }
    sums.map(|sum| sum / 100.0)
}

#[test]
fn smoothing_and_noise_bias_the_rate_domain_and_not_the_time_domain() {
    for (rate, noise, low, high) in [(100.0, 1e-3, 0.85, 0.97), (20.0, 1e-3, 0.2, 0.6)] {
        let [time, by_rate] = bias(rate, noise);
        println!("{rate} Hz, noise {noise}: v in time {time:.4}, in the rate domain {by_rate:.3} of the truth");
        assert!((time - 1.0).abs() < 0.005, "{time}");
        assert!(low < by_rate && by_rate < high, "{by_rate}");
    }
}

#[test]
fn an_analysis_says_how_far_its_rate_domain_is_off() {
    // A strip stretched in 0.1 s and held: force is strain here, so that the parameters are those of the hold above.
    let (times, strains) = hold(100.0, 1e-3, 5);
    let ramp = 10_usize;
    let time: Vec<f64> = (0..ramp + times.len()).map(|i| 0.01 * i as f64).collect();
    let displacement: Vec<f64> = (0..time.len()).map(|i| 1e-3 * (i as f64 / ramp as f64).min(1.0)).collect();
    let rising = (0..ramp).map(|i| strains[0] * i as f64 / ramp as f64);
    let force: Vec<f64> = rising.chain(strains.iter().copied()).collect();
    let record = Record::new(time, Some(displacement), force).unwrap();
    let analysis = analyze(&record, &AnalysisOptions::default()).unwrap();
    let stated = analysis.holds[0].rate_bias.unwrap();
    let by_rate = analysis.holds[0].rate_fit_with(5.0).unwrap().rate_coefficient().value;
    println!("stated {stated:?}, found {:.3}", by_rate / TRUTH);
    assert!((0.8..0.99).contains(&stated.coefficient), "{stated:?}");
}
