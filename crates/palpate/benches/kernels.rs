//! Speed of what users wait for: `cargo bench -p palpate`. Ratios against SciPy: `validation/peers.py`.

use divan::{Bencher, black_box};
use palpate::fit::{ExponentChoice, FitOptions, fit_hold};
use palpate::latency::decay_many;
use palpate::simulate::{Sampling, Separation, simulate, simulate_force, strain_wave};
use palpate::test_problems::{noisy_hold, paper_ball, paper_test_a};

fn main() {
    divan::main();
}

/// Test (a) of the paper, 66 s at 100 Hz, contact force only.
#[divan::bench]
fn force_of_test_a(bencher: Bencher<'_, '_>) {
    let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
    let times: Vec<f64> = (0..=6600).map(|i| f64::from(i) / 100.0).collect();
    bencher.bench(|| simulate_force(black_box(&motion), &model, &times));
}

/// The same with all columns.
#[divan::bench(args = [Separation::Bonded, Separation::Unilateral])]
fn trajectory_of_test_a(bencher: Bencher<'_, '_>, separation: Separation) {
    let (motion, model) = (paper_test_a(), paper_ball(separation));
    bencher.bench(|| simulate(black_box(&motion), &model, &Sampling::Rate(100.0)));
}

/// All eight layers of test (a) at 10 Hz.
#[divan::bench]
fn strain_wave_of_test_a(bencher: Bencher<'_, '_>) {
    let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
    bencher.bench(|| strain_wave(black_box(&motion), &model, &Sampling::Rate(10.0)));
}

/// One hold with n = 5 given, with covariance.
#[divan::bench(args = [100, 1000, 10_000])]
fn fit_with_exponent_5(bencher: Bencher<'_, '_>, samples: usize) {
    let (times, values) = noisy_hold(samples, 5.0, 1e-3);
    let options = FitOptions::default();
    bencher.bench(|| fit_hold(black_box(&times), &values, ExponentChoice::Fixed(5.0), &options));
}

/// One hold with n found.
#[divan::bench(args = [100, 1000, 10_000])]
fn fit_with_free_exponent(bencher: Bencher<'_, '_>, samples: usize) {
    let (times, values) = noisy_hold(samples, 5.0, 1e-3);
    let options = FitOptions::default();
    bencher.bench(|| fit_hold(black_box(&times), &values, ExponentChoice::Free, &options));
}

/// The closed form for 1000 times, by exponent: whole ones by roots, others by exp and ln.
#[divan::bench(args = [1.0, 2.0, 3.0, 5.0, 4.33])]
fn closed_form_1000(bencher: Bencher<'_, '_>, exponent: f64) {
    let times: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
    let mut out = vec![0.0; 1000];
    bencher.bench_local(|| decay_many(black_box(&times), 0.7, exponent, &mut out));
}
