//! How often the 95 % intervals of calibrations contain the truth; prints a table in Markdown (`validation/calibration.sh` keeps it).
//!
//! The paper's ball through the paper's tests (a) and (b), as its machine would have recorded them: 20 Hz, the force within 0.2 N, the
//! displacement within 1 µm (standard deviations), or noise and rate as given. Run it with
//! `cargo run --release -p palpate --example calibration_study [records] [displacement noise, µm] [Hz]`.

mod instrument;

use std::collections::BTreeMap;

use instrument::Instrument;
use palpate::calibrate::{Candidate, EquilibriumLaw, calibrate};
use palpate::simulate::Motion;
use palpate::test_problems::{paper_test_a, paper_test_b};
use palpate::watch::Unwatched;

const TRUTH: [(&str, &str, f64); 4] = [
    ("modulus_pa", "E", 28e3),
    ("exponent", "n", 5.0),
    ("rate_coefficient_per_s", "v", 2e4),
    ("layer_thickness_m", "ℓ", 0.035 / 8.0),
];

/// What was counted of one parameter.
#[derive(Default, Clone, Copy)]
struct Count {
    covered: u32,
    below: u32,
    above: u32,
    /// Sum of half widths of the intervals over the truth.
    width: f64,
    /// Sum of relative errors.
    error: f64,
}

fn main() {
    let argument = |place| std::env::args().nth(place);
    let records: u64 = argument(1).and_then(|text| text.parse().ok()).unwrap_or(1000);
    let micrometres: f64 = argument(2).and_then(|text| text.parse().ok()).unwrap_or(1.0);
    let rate_hz: f64 = argument(3).and_then(|text| text.parse().ok()).unwrap_or(20.0);
    let instrument = Instrument {
        rate_hz,
        displacement_noise: 1e-6 * micrometres,
        ..Instrument::default()
    };
    println!("| test | fitted | parameter | covered | truth below | truth above | mean half width | mean error |");
    println!("|---|---|---|---:|---:|---:|---:|---:|");
    for (name, motion) in [("(a)", paper_test_a()), ("(b)", paper_test_b())] {
        for (law, fitted) in [("latency", "n found"), ("latency:5", "n = 5")] {
            let halves = std::thread::scope(|scope| {
                let halves = [0..records / 2, records / 2..records];
                let work = halves.map(|seeds| scope.spawn(|| counts(&motion, instrument, law, seeds)));
                work.map(|half| half.join().expect("a half"))
            });
            report((name, fitted), &halves, records);
        }
    }
}

fn report((test, fitted): (&str, &str), halves: &[BTreeMap<&str, Count>; 2], records: u64) {
    for (name, sign, _) in TRUTH {
        let Some((a, b)) = halves[0].get(name).zip(halves[1].get(name)) else {
            continue;
        };
        let share = |part: fn(&Count) -> u32| 100.0 * f64::from(part(a) + part(b)) / records as f64;
        println!(
            "| {test} | {fitted} | {sign} | {:.1} % | {:.1} % | {:.1} % | {:.2} % | {:+.3} % |",
            share(|count| count.covered),
            share(|count| count.below),
            share(|count| count.above),
            100.0 * (a.width + b.width) / records as f64,
            100.0 * (a.error + b.error) / records as f64,
        );
    }
}

fn counts(
    motion: &Motion,
    instrument: Instrument,
    law: &str,
    seeds: std::ops::Range<u64>,
) -> BTreeMap<&'static str, Count> {
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    let candidate = Candidate::new(law.parse().expect("a law"), EquilibriumLaw::UniformStrain);
    for seed in seeds {
        let found =
            calibrate(&instrument.record(motion, seed), candidate, 0.95, &mut Unwatched).expect("a calibration");
        for (name, _, truth) in TRUTH {
            let estimate = found.material.estimate(name).expect("a parameter");
            if estimate.standard_error.is_none() && law != "latency" && name == "exponent" {
                continue;
            }
            let (low, high) = estimate.interval.unwrap_or((f64::NAN, f64::NAN));
            let count = counts.entry(name).or_default();
            count.covered += u32::from(low <= truth && truth <= high);
            count.below += u32::from(truth < low);
            count.above += u32::from(truth > high);
            count.width += 0.5 * (high - low) / truth;
            count.error += estimate.value / truth - 1.0;
        }
    }
    counts
}
