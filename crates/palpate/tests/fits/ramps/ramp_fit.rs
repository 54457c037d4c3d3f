//! The latency law found from holds that were reached in different times.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use palpate::fit::{
    EquilibriumChoice, ExponentChoice, FitError, FitOptions, RampFit, RampHold, Samples, Termination, fit_ramps,
};
use palpate::laws::Loading;
use palpate::test_problems::Noise;

const TIMES: usize = 300;

fn times() -> Vec<f64> {
    (0..TIMES).map(|i| 0.1 * i as f64).collect()
}

/// Excess in the hold after a loading, by Runge and Kutta's classical method in small steps: knows nothing of the library's own.
fn excess(loading: &Loading, amplitude: f64, coefficient: f64, exponent: f64) -> Vec<f64> {
    let mut x = 0.0;
    let slope = |x: f64, drive: f64| drive - coefficient * x.signum() * x.abs().powf(exponent);
    let mut advance = |from: f64, to: f64, drive: f64| {
        let h = (to - from) / 400.0;
        for _ in 0..400 {
            let a = slope(x, drive);
            let b = slope(x + 0.5 * h * a, drive);
            let c = slope(x + 0.5 * h * b, drive);
            let d = slope(x + h * c, drive);
            x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        x
    };
    // Quarters of the loading: those of the tests have their corners there.
    for i in 0..4 {
        let (from, to) =
            (loading.duration() * (f64::from(i) / 4.0 - 1.0), loading.duration() * (f64::from(i) - 3.0) / 4.0);
        let change = loading.at(to) - loading.at(from);
        advance(from, to, amplitude * change / (to - from));
    }
    let mut all = vec![advance(0.0, 1e-9, 0.0)];
    all.extend(times().windows(2).map(|pair| advance(pair[0], pair[1], 0.0)));
    all
}

/// Goes up, rests, overshoots and comes back.
fn irregular(duration: f64) -> Loading {
    let times = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| share * duration);
    Loading::new(&times, &[1e-3, 2e-3, 2e-3, 6.3e-3, 6e-3]).unwrap()
}

fn fit(loadings: &[Loading], values: &[Vec<f64>], choice: ExponentChoice, equilibria: EquilibriumChoice) -> RampFit {
    let times = times();
    let holds: Vec<RampHold<'_>> = loadings
        .iter()
        .zip(values)
        .map(|(loading, values)| RampHold {
            loading,
            samples: Samples::new(&times, values),
        })
        .collect();
    fit_ramps(&holds, choice, equilibria, &FitOptions::default()).unwrap()
}

fn shifted(excess: &[f64], by: f64) -> Vec<f64> {
    excess.iter().map(|x| by + x).collect()
}

/// n = 3, v = 0.4, Δ = 2 (κ = 1.6/s); ramps, and a loading that overshoots, equilibria 1, 2, 3.
#[test]
fn shared_numbers_come_back_without_noise() {
    let loadings = [Loading::ramp(0.5).unwrap(), irregular(4.0), Loading::ramp(20.0).unwrap()];
    for sign in [1.0, -1.0] {
        let values: Vec<Vec<f64>> = loadings
            .iter()
            .zip([1.0, 2.0, 3.0])
            .map(|(loading, level)| shifted(&excess(loading, 2.0 * sign, 0.4, 3.0), level))
            .collect();
        let fit = fit(&loadings, &values, ExponentChoice::Free, EquilibriumChoice::Each);
        assert_eq!(fit.termination, Termination::Converged);
        assert!((fit.exponent.value - 3.0).abs() < 1e-5, "{:?}", fit.exponent);
        assert!((fit.step_amplitude.value - 2.0 * sign).abs() < 1e-5, "{:?}", fit.step_amplitude);
        assert!((fit.rate_coefficient.value - 0.4).abs() < 1e-5, "{:?}", fit.rate_coefficient);
        assert!((fit.step_rate.value - 1.6).abs() < 1e-4);
        for ((hold, values), (level, loading)) in
            fit.holds.iter().zip(&values).zip([1.0, 2.0, 3.0].iter().zip(&loadings))
        {
            assert!((hold.equilibrium.value - level).abs() < 1e-5);
            assert!((hold.amplitude.value - (values[0] - level)).abs() < 1e-5);
            assert!((hold.step_start.value - (level + 2.0 * sign)).abs() < 1e-5);
            assert!((fit.excess_after(loading, 3.0) - (values[30] - level)).abs() < 1e-5);
        }
    }
}

/// With noise the truth lies within its errors; what a slow ramp leaves at the start of its hold is far from Δ.
#[test]
fn shared_numbers_come_back_with_noise() {
    let loadings = [0.2, 2.0, 20.0].map(|duration| Loading::ramp(duration).unwrap());
    let mut noise = Noise::new(11);
    let values: Vec<Vec<f64>> = loadings
        .iter()
        .map(|loading| excess(loading, 2.0, 0.4, 3.0).iter().map(|x| 1.0 + x + 0.005 * noise.normal()).collect())
        .collect();
    for equilibria in [EquilibriumChoice::Each, EquilibriumChoice::Shared] {
        let fit = fit(&loadings, &values, ExponentChoice::Free, equilibria);
        for (estimate, truth) in [
            (fit.exponent, 3.0),
            (fit.step_amplitude, 2.0),
            (fit.step_rate, 1.6),
            (fit.holds[2].equilibrium, 1.0),
        ] {
            let off = (estimate.value - truth).abs() / estimate.standard_error.unwrap();
            assert!(off < 3.5, "{estimate:?}, in truth {truth}");
        }
        assert!(fit.holds[2].amplitude.value < 0.4 * fit.step_amplitude.value);
    }
}

/// n = 1 is linear: a ramp of T leaves (1 − e^(−κT))/(κT) of Δ.
#[test]
fn the_linear_case_is_the_standard_linear_solid_after_a_ramp() {
    let (durations, rate, amplitude) = ([0.5, 5.0], 0.3, 2.0);
    let loadings = durations.map(|duration| Loading::ramp(duration).unwrap());
    let left = |duration: f64| amplitude * -(-rate * duration).exp_m1() / (rate * duration);
    let values: Vec<Vec<f64>> = durations
        .iter()
        .map(|duration| times().iter().map(|t| 1.0 + left(*duration) * (-rate * t).exp()).collect())
        .collect();
    let fit = fit(&loadings, &values, ExponentChoice::Fixed(1.0), EquilibriumChoice::Shared);
    assert!((fit.step_amplitude.value - amplitude).abs() < 1e-9, "{fit:?}");
    assert!((fit.step_rate.value - rate).abs() < 1e-9);
    assert!((fit.amplitude_after(&loadings[1]) - left(5.0)).abs() < 1e-9);
}

/// One ramp alone does not tell what it took off: the excess at the start of the hold is known well, Δ hardly or not at all.
#[test]
fn one_ramp_alone_leaves_the_step_open() {
    let loading = [Loading::ramp(20.0).unwrap()];
    let mut noise = Noise::new(5);
    let values = vec![excess(&loading[0], 2.0, 0.4, 3.0).iter().map(|x| 1.0 + x + 0.005 * noise.normal()).collect()];
    let alone = fit(&loading, &values, ExponentChoice::Fixed(3.0), EquilibriumChoice::Each);
    let hold =
        palpate::fit::fit_hold(&times(), &values[0], ExponentChoice::Fixed(3.0), &FitOptions::default()).unwrap();
    assert!((alone.holds[0].amplitude.value / hold.amplitude().value - 1.0).abs() < 1e-6);
    assert!((alone.rate_coefficient.value / hold.rate_coefficient().value - 1.0).abs() < 1e-4);
    assert!((alone.rmse / hold.rmse - 1.0).abs() < 1e-9);
}

#[test]
fn units_do_not_matter() {
    let loadings = [Loading::ramp(0.5).unwrap(), Loading::ramp(8.0).unwrap()];
    let values = loadings.each_ref().map(|loading| shifted(&excess(loading, 2.0, 0.4, 3.0), 1.0));
    let slow = [Loading::ramp(30.0).unwrap(), Loading::ramp(480.0).unwrap()];
    let times: Vec<f64> = times().iter().map(|t| 1e4 + 60.0 * t).collect();
    let large = values.each_ref().map(|values| values.iter().map(|y| 1e6 * y).collect::<Vec<f64>>());
    let holds = [0, 1].map(|i| RampHold {
        loading: &slow[i],
        samples: Samples::new(&times, &large[i]),
    });
    let other = fit_ramps(&holds, ExponentChoice::Free, EquilibriumChoice::Each, &FitOptions::default()).unwrap();
    let fit = fit(&loadings, &values, ExponentChoice::Free, EquilibriumChoice::Each);
    assert!((other.exponent.value - fit.exponent.value).abs() < 1e-7);
    assert!((other.step_amplitude.value / fit.step_amplitude.value / 1e6 - 1.0).abs() < 1e-7);
    assert!((other.step_rate.value / fit.step_rate.value * 60.0 - 1.0).abs() < 1e-6);
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let options = FitOptions::default();
    let refused =
        |holds: &[RampHold<'_>], choice| fit_ramps(holds, choice, EquilibriumChoice::Each, &options).unwrap_err();
    assert!(matches!(refused(&[], ExponentChoice::Free), FitError::TooFewSamples { .. }));
    let loading = Loading::ramp(1.0).unwrap();
    let hold = |values: &'static [f64]| RampHold {
        loading: &loading,
        samples: Samples::new(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], values),
    };
    let flat = hold(&[1.0; 6]);
    assert!(matches!(refused(&[flat.clone(), flat], ExponentChoice::Free), FitError::Constant { .. }));
    let good = hold(&[5.0, 4.0, 3.0, 2.5, 2.2, 2.1]);
    assert_eq!(refused(&[good], ExponentChoice::Fixed(-1.0)), FitError::Exponent { found: -1.0 });
    assert!(matches!(refused(&[hold(&[1.0; 5])], ExponentChoice::Free), FitError::Lengths { .. }));
    let holed = hold(&[5.0, 4.0, f64::NAN, 2.5, 2.2, 2.1]);
    assert!(matches!(refused(&[holed], ExponentChoice::Free), FitError::NotFinite { index: 2, .. }));
}
