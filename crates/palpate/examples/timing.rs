//! Times the two kernels that users wait for; prints one JSON object a line (read by `validation/peers.py`).
//!
//! Run it with `cargo run --release -p palpate --example timing`.

use std::hint::black_box;
use std::time::Instant;

use palpate::identify::{ExponentChoice, FitOptions, fit_hold};
use palpate::simulate::{Sampling, Separation, simulate, simulate_force};
use palpate::test_problems::{noisy_hold, paper_ball, paper_test_a};

fn main() {
    let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
    let sampling = Sampling::Rate(100.0);
    let times: Vec<f64> = (0..=6600).map(|i| f64::from(i) / 100.0).collect();
    report("simulate_protocol_a_force", 400, || {
        black_box(simulate_force(black_box(&motion), &model, &times)).is_ok()
    });
    report("simulate_protocol_a", 400, || black_box(simulate(black_box(&motion), &model, &sampling)).is_ok());
    let (times, values) = noisy_hold(1000, 5.0, 1e-3);
    let options = FitOptions::default();
    report("fit_hold_1000", 400, || {
        let choice = ExponentChoice::Fixed(5.0);
        black_box(fit_hold(black_box(&times), &values, choice, &options)).is_ok()
    });
    report("fit_hold_1000_free_exponent", 100, || {
        black_box(fit_hold(black_box(&times), &values, ExponentChoice::Free, &options)).is_ok()
    });
}

/// Median time of one run.
fn report(name: &str, runs: usize, mut run: impl FnMut() -> bool) {
    let mut seconds: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            assert!(run(), "{name} failed");
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    println!("{{\"name\":\"{name}\",\"seconds\":{:e}}}", seconds[runs / 2]);
}
