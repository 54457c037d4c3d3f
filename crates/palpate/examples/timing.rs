//! Times the kernels that users wait for; prints one JSON object a line (read by `validation/peers.py` and
//! `validation/simulation_speed.py`, which asks for `--simulations` alone).
//!
//! Run it with `cargo run --release -p palpate --example timing`.

use std::hint::black_box;
use std::time::Instant;

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::fit::{ExponentChoice, FitOptions, LawOptions, Samples, fit_hold, fit_law};
use palpate::forecast::{CompareOptions, compare_laws};
use palpate::latency::LatencyLaw;
use palpate::laws::Law;
use palpate::simulate::{
    ContactModel, ContactState, Motion, Sampling, Separation, simulate, simulate_force, strain_wave_within,
};
use palpate::test_problems::{Rng, noisy_hold, paper_ball, paper_test_a};
use palpate::watch::Unwatched;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

fn main() {
    let (motion, model) = (paper_test_a(), paper_ball(Separation::Bonded));
    let sampling = Sampling::Rate(100.0);
    let times: Vec<f64> = (0..=6600).map(|i| f64::from(i) / 100.0).collect();
    report("simulate_protocol_a_force", 400, || {
        black_box(simulate_force(black_box(&motion), &model, &times)).is_ok()
    });
    report("simulate_protocol_a", 400, || black_box(simulate(black_box(&motion), &model, &sampling)).is_ok());
    let (mut contact, mut tick) = (ContactState::default(), 0u32);
    report("real_time_step_1000", 400, || {
        (0..1000).all(|_| {
            tick = (tick + 1) % 4000;
            let displacement = 5e-6 * f64::from(tick.min(4000 - tick));
            black_box(contact.step(black_box(&model), 1e-3, displacement)).is_ok()
        })
    });
    cascades();
    batches();
    if std::env::args().any(|argument| argument == "--simulations") {
        return;
    }
    let (times, values) = noisy_hold(1000, 5.0, 1e-3);
    let options = FitOptions::default();
    report("fit_hold_1000", 400, || {
        let choice = ExponentChoice::Fixed(5.0);
        black_box(fit_hold(black_box(&times), &values, choice, &options)).is_ok()
    });
    report("fit_hold_1000_free_exponent", 100, || {
        black_box(fit_hold(black_box(&times), &values, ExponentChoice::Free, &options)).is_ok()
    });
    fit_laws();
    compare();
}

/// All layers of the paper's ball through test (a), each step within 1e-8 of the travel.
fn cascades() {
    for layers in [8.0, 512.0] {
        let model = ContactModel {
            layers: Layers::new(layers).expect("whole and above 0"),
            ..paper_ball(Separation::Bonded)
        };
        let sampling = Sampling::Times(vec![66.0]);
        let runs = if layers < 100.0 { 200 } else { 9 };
        report(&format!("strain_wave_{layers}_layers"), runs, || {
            black_box(strain_wave_within(black_box(&paper_test_a()), &model, &sampling, 1e-8, &mut Unwatched)).is_ok()
        });
    }
}

/// 10,000 balls, each with its own parameters, squeezed by 5 mm within 0.6 s and held for 10 s; prints the forces of the first four.
fn batches() {
    let motion = Motion::new(vec![0.0, 0.6, 10.6], vec![0.0, 0.005, 0.005]).expect("time rises");
    for (name, spread) in [("", 0.0), ("_own_exponents", 2.0)] {
        let models: Vec<ContactModel> = (0..10_000).map(|index| ball(f64::from(index) / 10_000.0, spread)).collect();
        let force = |model: &ContactModel| simulate_force(&motion, model, &[10.6]).expect("the ball takes 5 mm")[0];
        let forces = || models.par_iter().map(force).collect::<Vec<f64>>();
        report(&format!("batch_force{name}"), 7, || !black_box(forces()).is_empty());
        println!("{{\"name\":\"forces{name}\",\"seconds\":0,\"forces\":{:?}}}", &forces()[9_996..]);
    }
}

/// A ball somewhat like the paper's: `part` from 0 to 1 says how much.
fn ball(part: f64, spread: f64) -> ContactModel {
    let shape = Shape::Ball {
        radius: 0.03 + 0.01 * part,
    };
    ContactModel {
        specimen: Specimen::new(shape, 2e4 + 1e4 * part, Sides::Two).expect("above 0"),
        law: LatencyLaw::new(5.0 - spread * part, 1e4 * (1.0 + part)).expect("above 0"),
        ..paper_ball(Separation::Bonded)
    }
}

/// Every law fitted to 200 and to 1000 samples of a hold that is its own or close to it.
fn fit_laws() {
    for samples in [200, 1000] {
        for (law, exponents) in [
            (Law::StandardLinearSolid, vec![(1.0, 0.8)]),
            (Law::Prony { terms: 2 }, vec![(0.5, 4.0), (0.5, 0.4)]),
            (Law::Stretched, vec![(0.5, 2.0), (0.5, 0.4)]),
            (Law::FractionalZener, vec![(0.5, 2.0), (0.5, 0.4)]),
            (Law::FungContinuous, vec![(0.5, 4.0), (0.5, 0.4)]),
        ] {
            let (times, values) = exponentials(samples, &exponents);
            let options = LawOptions::default();
            report(&format!("fit_{law}_{samples}"), 100, || {
                black_box(fit_law(&Samples::new(black_box(&times), &values), law, &options)).is_ok()
            });
        }
    }
}

/// 1 + Σ Δ exp(−λt) over 10 s with noise of 10⁻³; pairs are (Δ, λ).
fn exponentials(samples: usize, terms: &[(f64, f64)]) -> (Vec<f64>, Vec<f64>) {
    let mut noise = Rng::new(7);
    let times: Vec<f64> = (0..samples).map(|i| 10.0 * i as f64 / (samples - 1) as f64).collect();
    let signal = |t: f64| 1.0 + terms.iter().map(|(amplitude, rate)| amplitude * (-rate * t).exp()).sum::<f64>();
    let values = times.iter().map(|t| signal(*t) + 1e-3 * noise.normal()).collect();
    (times, values)
}

/// Twelve laws compared on a hold of 1800 s at 20 Hz.
fn compare() {
    let (mut times, values) = noisy_hold(36_000, 4.3, 1e-3);
    times.iter_mut().for_each(|t| *t *= 180.0);
    let options = CompareOptions::default();
    report("compare_36000", 10, || {
        black_box(compare_laws(&Samples::new(black_box(&times), &values), &options)).is_ok()
    });
}

/// Median time of one run. Before each a contact of another exponent is simulated, so that no run finds the ramp from rest that the
/// run before has integrated.
fn report(name: &str, runs: usize, mut run: impl FnMut() -> bool) {
    let other = ContactModel {
        law: LatencyLaw::new(3.0, 2e4).expect("above 0"),
        ..paper_ball(Separation::Bonded)
    };
    let mut seconds: Vec<f64> = (0..runs)
        .map(|_| {
            assert!(simulate_force(&paper_test_a(), &other, &[66.0]).is_ok());
            let start = Instant::now();
            assert!(run(), "{name} failed");
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    println!("{{\"name\":\"{name}\",\"seconds\":{:e}}}", seconds[runs / 2]);
}
