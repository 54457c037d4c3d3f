//! Gross outliers: what Tukey's and Huber's estimates make of them, and whether their errors are true.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{
    BootstrapOptions, Fit, IntervalMethod, LawOptions, Loss, NoiseChoice, Samples, Termination, fit_law,
};
use palpate::laws::Law;
use palpate::test_problems::Rng;

use crate::repeats::repeats;

const NOISE: f64 = 0.01;
const TRUTH: [f64; 3] = [2.0, 1.0, -0.916_290_731_874_155]; // ln 0.4

/// 2 + exp(−0.4 t) over 10 s with normal noise; every `tenth` sample, if any, is off by 8 to 40 noise standard deviations, mostly upwards.
fn hold(seed: u64, tenth: bool) -> (Vec<f64>, Vec<f64>) {
    let mut random = Rng::new(seed);
    let times: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.05).collect();
    let value = |(i, t): (usize, &f64)| {
        let clean = TRUTH[0] + TRUTH[1] * (-0.4 * t).exp() + NOISE * random.normal();
        let (size, side) = (NOISE * (8.0 + 32.0 * random.uniform()), if random.uniform() < 0.75 { 1.0 } else { -1.0 });
        // Each ten samples have one, at a place of its own.
        if tenth && (i * 7 + i / 10) % 10 == 3 { clean + side * size } else { clean }
    };
    let values = times.iter().enumerate().map(value).collect();
    (times, values)
}

fn fit(seed: u64, spoilt: bool, loss: Loss) -> Fit {
    let (times, values) = hold(seed, spoilt);
    let options = LawOptions {
        loss,
        ..LawOptions::default()
    };
    let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
    assert_eq!(fit.termination, Termination::Converged);
    fit
}

/// Mean and root mean square of (estimate − truth)/standard error for each parameter over many holds.
fn pulls(spoilt: bool, loss: Loss) -> [(f64, f64); 3] {
    const HOLDS: u64 = 400;
    let mut sums = [(0.0, 0.0); 3];
    for seed in 0..HOLDS {
        let fit = fit(1000 + seed, spoilt, loss);
        let covariance = fit.white_covariance.as_ref().unwrap();
        for (i, sum) in sums.iter_mut().enumerate() {
            let pull = (fit.values[i] - TRUTH[i]) / covariance[i][i].sqrt();
            *sum = (sum.0 + pull, sum.1 + pull * pull);
        }
    }
    let count = HOLDS as f64;
    sums.map(|(sum, square)| (sum / count, (square / count).sqrt()))
}

#[test]
fn errors_of_robust_estimates_are_true_without_outliers() {
    for loss in [Loss::Squares, Loss::Huber, Loss::Tukey] {
        for (mean, spread) in pulls(false, loss) {
            println!("{loss:?}: mean {mean:.3}, spread {spread:.3}");
            // 400 holds: a mean of 0 ± 0.05, a spread of 1 ± 0.035.
            assert!(mean.abs() < 0.2 && (spread - 1.0).abs() < 0.12, "{loss:?} {mean} {spread}");
        }
    }
}

#[test]
fn tukey_ignores_a_tenth_of_gross_outliers() {
    let squares = pulls(true, Loss::Squares);
    let huber = pulls(true, Loss::Huber);
    let tukey = pulls(true, Loss::Tukey);
    println!("squares {squares:.3?}\nhuber {huber:.3?}\ntukey {tukey:.3?}");
    for (mean, spread) in tukey {
        assert!(mean.abs() < 0.2 && (spread - 1.0).abs() < 0.15, "{tukey:?}");
    }
    // The constant is drawn up by outliers that are mostly above: Huber's by less, and Tukey's not.
    let off = |loss: Loss| {
        (0..50).map(|seed| fit(seed, true, loss).value("equilibrium").unwrap() - TRUTH[0]).sum::<f64>() / 50.0
    };
    let (squares, huber, tukey) = (off(Loss::Squares), off(Loss::Huber), off(Loss::Tukey));
    println!("constant off by {squares:.5}, {huber:.5}, {tukey:.5}");
    assert!(squares > 5e-3 && huber < 0.5 * squares && tukey.abs() < 1e-3, "{squares} {huber} {tukey}");
}

#[test]
fn an_exact_signal_keeps_its_law_under_a_tenth_of_outliers() {
    let times: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i)).collect();
    let value = |(i, t): (usize, &f64)| 2.0 + (-0.4 * t).exp() + if i % 10 == 3 { 1.0 } else { 0.0 };
    let values: Vec<f64> = times.iter().enumerate().map(value).collect();
    let options = LawOptions {
        loss: Loss::Tukey,
        ..LawOptions::default()
    };
    let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
    for (value, truth) in fit.values.iter().zip(TRUTH) {
        assert!((value - truth).abs() < 1e-9, "{:?} {:?}", fit.values, fit.termination);
    }
}

/// Outliers took the correlation off the residuals in which the noise was sought, which was then white: of 1 % outliers 95 % intervals by Huber
/// and Tukey held the truth in 69 to 72 % of holds, of 5 % in 45 to 51 %.
#[test]
fn noise_that_correlates_is_found_among_outliers() {
    let holds = repeats(40, 300);
    for samples in [200, 1000] {
        let times: Vec<f64> = (0..samples).map(|i| 10.0 / f64::from(samples) * f64::from(i)).collect();
        for loss in [Loss::Huber, Loss::Tukey] {
            for (correlation, share) in [(0.0, 0.0), (0.0, 0.05), (0.9, 0.0), (0.9, 0.01), (0.9, 0.05)] {
                let mut covered = 0;
                for seed in 0..holds {
                    let values = spoilt(&times, correlation, share, &mut Rng::new(seed << 20));
                    let options = LawOptions {
                        loss,
                        ..LawOptions::default()
                    };
                    let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
                    for (name, truth) in [("equilibrium", 2.0), ("amplitude", 1.0), ("time_constant_s", 2.5)] {
                        let (low, high) = fit.estimate(name).unwrap().interval.unwrap();
                        covered += u64::from(low <= truth && truth <= high);
                    }
                }
                let found = covered as f64 / (3 * holds) as f64;
                println!("{loss:?}, {samples} samples, AR(1) {correlation}, {share} outliers: {found}");
                assert!(found >= 0.87, "{loss:?}, {samples} samples, AR(1) {correlation}, {share} outliers: {found}");
            }
        }
    }
}

/// The hold with AR(1) noise, and a share of outliers of thirty standard deviations.
fn spoilt(times: &[f64], correlation: f64, share: f64, random: &mut Rng) -> Vec<f64> {
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut last = random.normal();
    let next = |t: &f64| {
        last = correlation * last + fresh * random.normal();
        let side = if random.uniform() < 0.5 { 30.0 } else { -30.0 };
        let outlier = if random.uniform() < share { side } else { 0.0 };
        TRUTH[0] + TRUTH[1] * (-0.4 * t).exp() + NOISE * (last + outlier)
    };
    times.iter().map(next).collect()
}

/// 1 + 2 exp(−t/4) over 20 s with noise of 0.02, and its parameters.
const SINGLE: [(&str, f64); 3] = [("equilibrium", 1.0), ("amplitude", 2.0), ("time_constant_s", 4.0)];

fn single(random: &mut Rng) -> (Vec<f64>, Vec<f64>) {
    let times: Vec<f64> = (0..200).map(|i| 20.0 * f64::from(i) / 199.0).collect();
    let values = times.iter().map(|t| 1.0 + 2.0 * (-t / 4.0).exp() + 0.02 * random.normal()).collect();
    (times, values)
}

fn intervals_of(times: &[f64], values: &[f64], loss: Loss, intervals: IntervalMethod) -> Fit {
    let options = LawOptions {
        loss,
        intervals,
        noise: NoiseChoice::White,
        ..LawOptions::default()
    };
    let fit = fit_law(&Samples::new(times, values), Law::StandardLinearSolid, &options).unwrap();
    assert_eq!(fit.termination, Termination::Converged, "{loss:?}");
    fit
}

fn width(fit: &Fit, name: &str) -> f64 {
    let (low, high) = fit.estimate(name).unwrap().interval.unwrap();
    high - low
}

/// Draws of outliers were fitted by least squares: of 5 and 10 % one-sided outliers of 25 standard deviations, intervals of 95 % held the
/// equilibrium in 6 to 77 % of holds, were four to seven times as wide as those of curvature, and lay beside their own estimate in 5 to 96 %.
#[test]
fn resampled_outliers_count_as_the_loss_counts_them() {
    let holds = repeats(40, 300);
    let how = BootstrapOptions {
        repetitions: 399,
        ..BootstrapOptions::default()
    };
    for loss in [Loss::Huber, Loss::Tukey] {
        for share in [0.0, 0.05, 0.1] {
            let (mut covered, mut by_curvature, mut ratio) = (0, 0, 0.0);
            for seed in 0..holds {
                let mut random = Rng::new(seed << 20);
                let (times, mut values) = single(&mut random);
                values.iter_mut().filter(|_| random.uniform() < share).for_each(|value| *value += 0.5);
                let curvature = intervals_of(&times, &values, loss, IntervalMethod::Curvature);
                let drawn = intervals_of(&times, &values, loss, IntervalMethod::Bootstrap(how));
                for (name, truth) in SINGLE {
                    let found = drawn.estimate(name).unwrap();
                    let (low, high) = found.interval.unwrap();
                    assert!(low < found.value && found.value < high, "{loss:?} {share} {seed} {name}");
                    covered += u64::from(low <= truth && truth <= high);
                    let (low, high) = curvature.estimate(name).unwrap().interval.unwrap();
                    by_curvature += u64::from(low <= truth && truth <= high);
                    ratio += width(&drawn, name) / (high - low);
                }
            }
            let all = (3 * holds) as f64;
            let [covered, by_curvature] = [covered, by_curvature].map(|count| count as f64 / all);
            ratio /= all;
            println!("{loss:?}, {share} outliers: {covered}, by curvature {by_curvature}, as wide {ratio}");
            assert!(covered >= 0.88 && (ratio - 1.0).abs() < 0.05, "{loss:?}, {share} outliers: {covered}, {ratio}");
        }
    }
}

/// Profiles counted outliers by their squares: one spike of 5 to 50 among 200 samples made them 8 to 24 times as wide, or open.
#[test]
fn a_spike_does_not_widen_a_profile() {
    for loss in [Loss::Huber, Loss::Tukey] {
        for seed in 0..5 {
            let (times, mut values) = single(&mut Rng::new(seed));
            let fits = |values: &[f64]| {
                [IntervalMethod::Curvature, IntervalMethod::Profile].map(|by| intervals_of(&times, values, loss, by))
            };
            let without = fits(&values);
            for spike in [5.0, 20.0, 50.0] {
                values[100] = spike;
                let with = fits(&values);
                for (name, _) in SINGLE {
                    for (with, without) in with.iter().zip(&without) {
                        let ratio = width(with, name) / width(without, name);
                        assert!((0.95..1.1).contains(&ratio), "{loss:?} {seed} {spike} {name}: {ratio}");
                    }
                    let ratio = width(&with[1], name) / width(&with[0], name);
                    assert!((ratio - 1.0).abs() < 0.02, "{loss:?} {seed} {spike} {name}: {ratio}");
                }
            }
        }
    }
}

/// One sample of 1000 among 200 of 1 to 3 was the range of the signal, and its square the noise beside which no parameter counted: fits were singular,
/// and of 1e30 nothing was left of the signal.
#[test]
fn a_sentinel_leaves_the_fit_of_the_others() {
    for loss in [Loss::Huber, Loss::Tukey] {
        for (place, sign) in [(0, 1.0), (100, -1.0), (199, 1.0)] {
            let (times, mut values) = single(&mut Rng::new(7));
            let fits = [50.0, 1e3, 1e30].map(|spike| {
                values[place] = sign * spike;
                intervals_of(&times, &values, loss, IntervalMethod::Automatic)
            });
            for (name, truth) in SINGLE {
                let [near, ..] = &fits;
                let value = near.value(name).unwrap();
                let of_noise = 0.5 * width(near, name);
                assert!((value - truth).abs() < 3.0 * of_noise, "{loss:?} {place} {name}: {value}");
                for fit in &fits {
                    let off = (fit.value(name).unwrap() - value).abs();
                    let wider = (width(fit, name) / (2.0 * of_noise) - 1.0).abs();
                    assert!(off < 1e-6 * of_noise && wider < 1e-6, "{loss:?} {place} {name}: {off} {wider}");
                }
            }
        }
    }
}

/// With ten steps of rounding over the drop and noise of a third of a step, most samples lie on one level and the median residual is 0: fits were
/// singular, or intervals of 95 % held the truth in 31 %.
#[test]
fn coarse_rounding_is_no_scale_of_zero() {
    const STEP: f64 = 0.2;
    let holds = repeats(60, 300);
    let times: Vec<f64> = (0..401).map(|i| 0.1 * f64::from(i)).collect();
    for loss in [Loss::Squares, Loss::Huber, Loss::Tukey] {
        let (mut covered, mut all) = ([0; 3], 0);
        for seed in 0..holds {
            let mut random = Rng::new(seed << 20);
            let offset = STEP * random.uniform();
            let mut value = |t: &f64| 1.0 + offset + 2.0 * (-t / 4.0).exp() + STEP / 3.0 * random.normal();
            let mut values: Vec<f64> = times.iter().map(|t| (value(t) / STEP).round() * STEP).collect();
            // An outlier is on no level.
            if loss != Loss::Squares {
                values[200] = 7.77;
            }
            let fit = intervals_of(&times, &values, loss, IntervalMethod::Curvature);
            for ((name, truth), covered) in SINGLE.iter().zip(&mut covered) {
                let truth = if *name == "equilibrium" { truth + offset } else { *truth };
                let (low, high) = fit.estimate(name).unwrap().interval.unwrap();
                *covered += u64::from(low <= truth && truth <= high);
            }
            all += 1;
        }
        let shares = covered.map(|covered| covered as f64 / all as f64);
        println!("{loss:?}: {shares:?}");
        assert!(shares.iter().all(|share| *share >= 0.8), "{loss:?}: {shares:?}");
    }
}

#[test]
fn several_sentinels_leave_the_fit_of_the_others() {
    for loss in [Loss::Huber, Loss::Tukey] {
        let (times, mut values) = single(&mut Rng::new(9));
        values.iter_mut().skip(5).step_by(20).for_each(|value| *value = 1e6);
        let fit = intervals_of(&times, &values, loss, IntervalMethod::Curvature);
        for (name, truth) in SINGLE {
            let (value, half) = (fit.value(name).unwrap(), 0.5 * width(&fit, name));
            assert!((value - truth).abs() < 2.0 * half, "{loss:?} {name}: {value}");
        }
    }
}

/// A law that is over after a few samples has its first values as far from most as outliers are.
#[test]
fn a_fast_transient_is_no_outlier() {
    let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
    for noise in [0.01, 0.0] {
        let mut random = Rng::new(3);
        let values: Vec<f64> = times.iter().map(|t| 1.0 + 50.0 * (-t / 0.1).exp() + noise * random.normal()).collect();
        for loss in [Loss::Huber, Loss::Tukey] {
            let options = LawOptions {
                loss,
                ..LawOptions::default()
            };
            let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options).unwrap();
            let (time, amplitude) = (fit.value("time_constant_s").unwrap(), fit.value("amplitude").unwrap());
            assert!((time - 0.1).abs() < 2e-4 && (amplitude - 50.0).abs() < 0.05, "{loss:?}: {time} {amplitude}");
        }
    }
}
