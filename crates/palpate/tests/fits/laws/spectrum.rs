//! The dense spectrum: recovery, conditions of an optimum, foresight, independence of units, and bad input.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{FitError, Smoothing, SpectrumFit, SpectrumOptions, fit_spectrum};
use palpate::latency::decay;
use palpate::test_problems::Rng;

fn times(count: u32, duration: f64) -> Vec<f64> {
    (0..count).map(|i| duration * f64::from(i) / f64::from(count - 1)).collect()
}

/// `signal` at `times` with noise of this standard deviation.
fn noisy(times: &[f64], noise: f64, seed: u64, signal: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut random = Rng::new(seed);
    times.iter().map(|t| signal(*t) + noise * random.normal()).collect()
}

fn fit(times: &[f64], values: &[f64]) -> SpectrumFit {
    fit_spectrum(times, values, None, &SpectrumOptions::default()).unwrap()
}

fn sum_of_exponentials(terms: &[(f64, f64)], equilibrium: f64) -> impl Fn(f64) -> f64 {
    move |t| equilibrium + terms.iter().map(|(amplitude, time)| amplitude * (-t / time).exp()).sum::<f64>()
}

#[test]
fn two_and_three_terms_are_found_where_they_are() {
    let t = times(1500, 100.0);
    let problems: [&[(f64, f64)]; 3] =
        [&[(1.0, 1.0), (0.5, 12.0)], &[(0.3, 0.5), (1.0, 9.0)], &[(1.0, 0.4), (0.8, 3.0), (0.6, 20.0)]];
    for terms in problems {
        for seed in 0..5 {
            let found = fit(&t, &noisy(&t, 3e-4, seed, sum_of_exponentials(terms, 2.0)));
            let peaks = found.peaks();
            assert_eq!(peaks.len(), terms.len(), "{peaks:?}");
            for (peak, (amplitude, time)) in peaks.iter().zip(terms) {
                // Half a step of the grid, 10^(1/8).
                assert!((peak.time / time).log10().abs() < 0.0625, "{peak:?} for {time}");
                assert!((peak.amplitude / amplitude - 1.0).abs() < 0.05, "{peak:?} for {amplitude}");
            }
            assert!((found.equilibrium - 2.0).abs() < 5e-3, "{}", found.equilibrium);
            assert_eq!(found.peaks().iter().map(|peak| peak.terms).sum::<usize>(), found.terms());
        }
    }
}

/// With residual r, weights of one and z = h/range: Σ c_j r/(N range) = μ (LᵀL z)_j inside, ≤ at zero; Σ r = 0.
#[test]
fn conditions_of_an_optimum_hold() {
    let t = times(700, 30.0);
    for (sign, smoothing) in [(1.0, Smoothing::Automatic), (-1.0, Smoothing::Automatic), (1.0, Smoothing::Given(1e-3))]
    {
        let y = noisy(&t, 2e-3, 4, |t| 1.0 + sign * decay(3.0 * t, 4.0));
        let options = SpectrumOptions {
            smoothing,
            ..SpectrumOptions::default()
        };
        let found = fit_spectrum(&t, &y, None, &options).unwrap();
        assert_eq!(found.sign, sign);
        let range = y.iter().copied().fold(f64::MIN, f64::max) - y.iter().copied().fold(f64::MAX, f64::min);
        let residual: Vec<f64> = t.iter().zip(&y).map(|(t, y)| (y - found.predict(*t)) / range).collect();
        let mean = |f: &dyn Fn(f64) -> f64| t.iter().zip(&residual).map(|(t, r)| f(*t) * r).sum::<f64>() / 700.0;
        assert!(mean(&|_| 1.0).abs() < 1e-13);
        let height = |j: usize| found.amplitudes.get(j).map(|h| h / range);
        for (j, time) in found.times.iter().enumerate() {
            let here = found.amplitudes[j] / range;
            assert!(here >= 0.0);
            let before = j.checked_sub(1).and_then(height).map_or(0.0, |other| here - other);
            let after = height(j + 1).map_or(0.0, |other| here - other);
            let slope = sign * mean(&|t| (-t / time).exp()) - found.strength * (before + after);
            assert!(if here > 0.0 { slope.abs() < 1e-13 } else { slope < 1e-13 }, "{j}: {slope:e}");
        }
        let square: f64 = residual.iter().map(|r| r * r).sum::<f64>() * range * range;
        assert!((found.residual_square / square - 1.0).abs() < 1e-9);
    }
}

#[test]
fn smoothing_uses_what_the_residual_allows() {
    let t = times(800, 10.0);
    let y = noisy(&t, 5e-3, 2, |t| (-(2.0 * t).powf(0.5)).exp());
    let found = fit(&t, &y);
    assert!(found.residual_square <= found.residual_limit * (1.0 + 1e-9));
    assert!(found.least_residual_square < found.residual_square);
    // The next strength, an eighth of a decade up, would exceed the limit.
    let smoothing = Smoothing::Given(found.strength * 10f64.powf(0.125));
    let next = fit_spectrum(
        &t,
        &y,
        None,
        &SpectrumOptions {
            smoothing,
            ..SpectrumOptions::default()
        },
    )
    .unwrap();
    assert!(next.residual_square > found.residual_limit, "{} {}", next.residual_square, found.residual_limit);
    assert!(next.effective_parameters < found.effective_parameters);
    assert!(found.effective_parameters > 3.0 && found.effective_parameters < 10.0);
}

type Law<'a> = &'a dyn Fn(f64) -> f64;

#[test]
fn first_third_predicts_the_rest() {
    let t = times(1200, 300.0);
    let laws: [(&str, f64, Law<'_>); 4] = [
        ("latency", 0.01, &|t| 0.5 + decay(0.5 * t, 5.0)),
        ("stretched", 0.01, &|t| 0.5 + (-(0.05 * t).powf(0.6)).exp()),
        ("power", 0.01, &|t| (1.0 + t / 2.0).powf(-0.2)),
        ("logarithm", 0.015, &|t| 1.0 - 0.05 * (1.0 + t / 2.0).ln()),
    ];
    for (name, allowed, law) in laws {
        let drop = law(0.0) - law(300.0);
        for seed in 0..6 {
            let y = noisy(&t, 1e-3 * drop, seed, law);
            let known = t.partition_point(|t| *t <= 100.0);
            let found = fit(&t[..known], &y[..known]);
            let square: f64 = t[known..].iter().map(|t| (found.predict(*t) - law(*t)).powi(2)).sum();
            let error = (square / (t.len() - known) as f64).sqrt() / drop;
            assert!(error < allowed, "{name}, seed {seed}: {error}");
        }
    }
}

/// Share of the whole relaxation that the fit puts after the end of the hold.
fn share_after_hold(fit: &SpectrumFit) -> f64 {
    fit.remaining(fit.duration) / fit.remaining(0.0)
}

#[test]
fn an_open_end_is_reported_from_a_plateau() {
    let t = times(1000, 100.0);
    let level = fit(&t, &noisy(&t, 1e-3, 1, sum_of_exponentials(&[(1.0, 3.0), (0.5, 12.0)], 1.0)));
    assert!(!level.is_open_ended() && share_after_hold(&level) < 1e-3);
    assert!((level.equilibrium - 1.0).abs() < 3e-3, "{}", level.equilibrium);
    let slow = fit(&t, &noisy(&t, 1e-3, 1, |t| (1.0 + t).powf(-0.1)));
    assert!(slow.is_open_ended() && share_after_hold(&slow) > 0.1, "{}", share_after_hold(&slow));
    // A known equilibrium leaves the grid to say when it is reached.
    let options = SpectrumOptions {
        equilibrium: Some(1.0),
        ..SpectrumOptions::default()
    };
    let y = noisy(&t, 1e-3, 1, sum_of_exponentials(&[(1.0, 3.0), (0.5, 30.0)], 1.0));
    let known = fit_spectrum(&t, &y, None, &options).unwrap();
    assert!((known.equilibrium - 1.0).abs() < 1e-15);
    assert!((known.remaining(0.0) / 1.5 - 1.0).abs() < 0.01, "{known:?}");
}

#[test]
fn units_change_nothing_but_units() {
    let t = times(900, 40.0);
    let y = noisy(&t, 3e-3, 8, |t| 0.7 + decay(2.0 * t, 3.0));
    let found = fit(&t, &y);
    for (time_unit, unit) in [(1e9, 1.0), (1e-9, 1.0), (1.0, 1e12), (1.0, 1e-12), (1e9, -1e-12)] {
        let scaled_t: Vec<f64> = t.iter().map(|t| t * time_unit).collect();
        let scaled_y: Vec<f64> = y.iter().map(|y| y * unit).collect();
        let scaled = fit(&scaled_t, &scaled_y);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(scaled.equilibrium / unit, found.equilibrium));
        assert!(near(scaled.strength / found.strength, 1.0));
        assert!(near(scaled.effective_parameters, found.effective_parameters));
        assert_eq!((scaled.sign, scaled.times.len()), (found.sign * f64::signum(unit), found.times.len()));
        for (a, b) in scaled.amplitudes.iter().zip(&found.amplitudes) {
            assert!(near(a / unit.abs(), *b), "{a} {b}");
        }
        for elapsed in [0.0, 1.0, 40.0, 400.0] {
            assert!(near(scaled.predict(elapsed * time_unit) / unit, found.predict(elapsed)));
        }
    }
}

/// Means over bins with the parameters of their samples for weights give what all samples give.
#[test]
fn weights_are_multiplicities() {
    let t = times(4000, 50.0);
    let y = noisy(&t, 1e-3, 3, |t| 1.0 + decay(4.0 * t, 3.0));
    let whole = fit(&t, &y);
    let (mut nodes, mut means, mut roots) = (vec![], vec![], vec![]);
    let mut from = 0usize;
    while from < t.len() {
        let until = (from + 1 + from / 40).min(t.len());
        let count = (until - from) as f64;
        nodes.push(t[from..until].iter().sum::<f64>() / count);
        means.push(y[from..until].iter().sum::<f64>() / count);
        roots.push(count.sqrt());
        from = until;
    }
    assert!(nodes.len() < 300);
    let condensed = fit_spectrum(&nodes, &means, Some(&roots), &SpectrumOptions::default()).unwrap();
    assert!((condensed.weight - 4000.0).abs() < 1e-9);
    for t in [0.0, 0.1, 1.0, 10.0, 50.0] {
        assert!(
            (condensed.predict(t) - whole.predict(t)).abs() < 1e-3,
            "{t}: {} {}",
            condensed.predict(t),
            whole.predict(t)
        );
    }
    // A sample of no weight may have any value.
    let mut spoilt = y.clone();
    let mut roots = vec![1.0; y.len()];
    (spoilt[100], roots[100]) = (1e6, 0.0);
    let without = fit_spectrum(&t, &spoilt, Some(&roots), &SpectrumOptions::default()).unwrap();
    assert_eq!(without.samples, 3999);
    assert!((without.predict(5.0) - whole.predict(5.0)).abs() < 1e-5);
}

#[test]
fn noise_alone_gives_no_nonsense() {
    for seed in 0..20 {
        let count = 5 + 7 * seed as u32;
        let t = times(count, 1.0);
        let found = fit(&t, &noisy(&t, 1.0, seed, |_| 5.0));
        let parameters = [found.equilibrium, found.predict(0.0), found.predict(1e9), found.rmse(), found.strength];
        assert!(parameters.iter().all(|parameter| parameter.is_finite()), "{found:?}");
        assert!(found.effective_parameters <= f64::from(count) + 1e-6);
        assert!(found.peaks().iter().all(|peak| peak.time.is_finite() && peak.amplitude > 0.0));
    }
}

#[test]
fn bad_input_has_a_name() {
    let (t, y) = (times(20, 1.0), noisy(&times(20, 1.0), 0.1, 1, |t| (-t).exp()));
    let fails = |t: &[f64], y: &[f64], roots: Option<&[f64]>| {
        fit_spectrum(t, y, roots, &SpectrumOptions::default()).unwrap_err()
    };
    assert_eq!(
        fails(&t, &y[1..], None),
        FitError::Lengths {
            abscissas: 20,
            values: 19
        }
    );
    assert_eq!(
        fails(&t, &y, Some(&[1.0])),
        FitError::Lengths {
            abscissas: 20,
            values: 1
        }
    );
    assert_eq!(
        fails(&t, &[2.0; 20], None),
        FitError::Constant {
            value: 2.0,
            samples: 20
        }
    );
    assert!(matches!(fails(&t[..4], &y[..4], None), FitError::TooFewSamples { found: 4, .. }));
    assert!(matches!(fails(&t, &y, Some(&[0.0; 20])), FitError::TooFewSamples { found: 0, .. }));
    let with = |values: &[f64], index: usize, value: f64| {
        let mut values = values.to_vec();
        values[index] = value;
        values
    };
    assert!(matches!(fails(&t, &with(&y, 3, f64::NAN), None), FitError::NotFinite { index: 3, .. }));
    assert_eq!(fails(&with(&t, 7, 0.0), &y, None), FitError::TimeNotRising { index: 7 });
    assert_eq!(fails(&t, &y, Some(&with(&[1.0; 20], 2, -1.0))), FitError::Weight { index: 2 });
    assert_eq!(fails(&t, &with(&y, 0, 1e200), None), FitError::OutOfRange);
    let options = [
        SpectrumOptions {
            points_per_decade: 0,
            ..SpectrumOptions::default()
        },
        SpectrumOptions {
            slowest: f64::NAN,
            ..SpectrumOptions::default()
        },
        SpectrumOptions {
            smoothing: Smoothing::Given(-1.0),
            ..SpectrumOptions::default()
        },
        SpectrumOptions {
            equilibrium: Some(f64::INFINITY),
            ..SpectrumOptions::default()
        },
    ];
    for options in options {
        let error = fit_spectrum(&t, &y, None, &options).unwrap_err();
        assert!(matches!(error, FitError::SpectrumSetting { .. }), "{error}");
    }
}
