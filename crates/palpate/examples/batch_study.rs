//! How often the intervals of a calibration of five specimens contain the truth of their batch; prints a table in Markdown
//! (`validation/batches.sh` keeps it).
//!
//! Specimens of the paper's ball (35 mm; 28 kPa, n = 5, v = 2·10⁴ 1/s, ℓ = 4.375 mm) whose modulus, layer thickness and, in the last case, rate
//! coefficient differ, each through the paper's test (a) at 20 Hz with noise of 0.2 N and 1 µm. Of a sixth specimen the force in another squeeze is
//! predicted: at its peak, and 10 s and 60 s later. Run it with `cargo run --release -p palpate --example batch_study [batches] [case, from 1]`.

#[path = "calibration_study/instrument.rs"]
mod instrument;

use instrument::{Force, Instrument};
use palpate::calibrate::{
    BatchRecord, Between, Candidate, EquilibriumLaw, SeveralCalibration, Sharing, calibrate_several,
};
use palpate::contact::{Layers, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Sampling, Separation, protocol, simulate_force};
use palpate::test_problems::{Rng, paper_ball, paper_test_a};
use palpate::watch::Unwatched;

/// Specimens of a batch.
const SPECIMENS: usize = 5;

/// Means of the batch.
const TRUTH: [(&str, f64); 4] = [
    ("modulus_pa", 28e3),
    ("exponent", 5.0),
    ("rate_coefficient_per_s", 2e4),
    ("layer_thickness_m", 0.035 / 8.0),
];

/// How logarithms of parameters are distributed between specimens, with variance 1.
#[derive(Clone, Copy)]
enum Distribution {
    Normal,
    Uniform,
    Student5,
}

struct Case {
    name: &'static str,
    distribution: Distribution,
    force: Force,
    sharing: &'static str,
    /// τ of the parameters, in the order of `TRUTH`.
    spread: [f64; 4],
}

const CASES: [Case; 5] = [
    Case {
        name: "normal",
        distribution: Distribution::Normal,
        force: Force::White,
        sharing: "exponent,rate_coefficient",
        spread: [0.15, 0.0, 0.0, 0.1],
    },
    Case {
        name: "uniform",
        distribution: Distribution::Uniform,
        force: Force::White,
        sharing: "exponent,rate_coefficient",
        spread: [0.15, 0.0, 0.0, 0.1],
    },
    Case {
        name: "t of 5 degrees",
        distribution: Distribution::Student5,
        force: Force::White,
        sharing: "exponent,rate_coefficient",
        spread: [0.15, 0.0, 0.0, 0.1],
    },
    Case {
        name: "normal, AR(1) noise of 0.9",
        distribution: Distribution::Normal,
        force: Force::Autoregressive(0.9),
        sharing: "exponent,rate_coefficient",
        spread: [0.15, 0.0, 0.0, 0.1],
    },
    Case {
        name: "normal, v differs",
        distribution: Distribution::Normal,
        force: Force::White,
        sharing: "exponent",
        spread: [0.15, 0.0, 0.5, 0.1],
    },
];

impl Distribution {
    fn draw(self, random: &mut Rng) -> f64 {
        match self {
            Self::Normal => random.normal(),
            Self::Uniform => 12f64.sqrt() * (random.uniform() - 0.5),
            Self::Student5 => {
                let square: f64 = (0..5).map(|_| random.normal().powi(2)).sum();
                random.normal() / (square / 5.0).sqrt() * 0.6f64.sqrt()
            }
        }
    }
}

impl Case {
    /// A specimen of the batch.
    fn specimen(&self, random: &mut Rng) -> ContactModel {
        let [modulus, exponent, rate, thickness]: [f64; 4] =
            std::array::from_fn(|i| TRUTH[i].1 * (self.spread[i] * self.distribution.draw(random)).exp());
        let ball = paper_ball(Separation::Unilateral);
        let (shape, sides) = (ball.specimen.shape().clone(), ball.specimen.sides());
        ContactModel {
            layers: Layers::of_thickness(thickness, ball.specimen.depth()).expect("layers"),
            specimen: Specimen::new(shape, modulus, sides).expect("a body"),
            law: LatencyLaw::new(exponent, rate).expect("a law"),
            separation: ball.separation,
        }
    }

    /// One batch: what is counted, and whether the interval contains the truth.
    fn counted(&self, seed: u64) -> Vec<(String, bool)> {
        let mut random = Rng::new(seed);
        let instrument = Instrument {
            force: self.force,
            ..Instrument::default()
        };
        let records: Vec<BatchRecord> = (0..SPECIMENS)
            .map(|index| BatchRecord {
                name: format!("{index}"),
                data: instrument.record_of(
                    &self.specimen(&mut random),
                    &paper_test_a(),
                    seed + 1_000_000 * (index as u64 + 1),
                ),
            })
            .collect();
        let candidate = Candidate::new("latency".parse().expect("a law"), EquilibriumLaw::UniformStrain);
        let sharing: Sharing = self.sharing.parse().expect("names");
        let found = calibrate_several(&records, candidate, &sharing, 0.95, &mut Unwatched).expect("a calibration");
        let mut counted = self.parameters(&found);
        let another = self.specimen(&mut random);
        let (motion, times) = squeeze();
        let truth = simulate_force(&motion, &another, &times).expect("forces");
        let material = found.specimen.expect("a material");
        let predicted = material.predict(&motion, &Sampling::Times(times), 0.95).expect("a prediction");
        for (index, what) in ["peak force of a sixth", "force after 10 s", "force after 60 s"].into_iter().enumerate() {
            let Some((low, high)) = predicted.force_interval(index) else {
                continue;
            };
            counted.push((what.to_owned(), low <= truth[index] && truth[index] <= high));
        }
        counted
    }

    fn parameters(&self, found: &SeveralCalibration) -> Vec<(String, bool)> {
        let within = |interval: Option<(f64, f64)>, truth: f64| {
            interval.is_some_and(|(low, high)| low <= truth && truth <= high)
        };
        let mut counted = Vec::new();
        for ((name, truth), tau) in TRUTH.into_iter().zip(self.spread) {
            match found.parameter(name) {
                Some(Between::Shared { estimate, .. }) => {
                    counted.push((format!("{name}, shared"), within(estimate.interval, truth)));
                }
                Some(Between::Own { mean, spread }) => {
                    counted.push((format!("{name}, mean"), within(mean.interval, truth)));
                    counted.push((format!("{name}, spread"), within(Some(spread.interval), tau)));
                }
                _ => {}
            }
        }
        counted
    }
}

/// The squeeze that is predicted, and the times that are: the end of the ramp, 10 s and 60 s later.
fn squeeze() -> (Motion, Vec<f64>) {
    let rate = 0.5 / 60.0;
    let motion = protocol(&[ProtocolStep {
        to: 0.008,
        rate,
        hold: 60.0,
    }])
    .expect("a motion");
    let peak = 0.008 / rate;
    (motion, vec![peak, peak + 10.0, peak + 60.0])
}

fn main() {
    let argument = |place| std::env::args().nth(place).and_then(|text| text.parse::<u64>().ok());
    let batches = argument(1).unwrap_or(200);
    let is_wanted = |number: usize| argument(2).is_none_or(|wanted| wanted == number as u64 + 1);
    println!("| spread between specimens | quantity | covered |");
    println!("|---|---|---:|");
    for (number, case) in CASES.iter().enumerate().filter(|(number, _)| is_wanted(*number)) {
        let halves = std::thread::scope(|scope| {
            let halves = [0..batches / 2, batches / 2..batches];
            let work = halves.map(|seeds| {
                scope.spawn(move || seeds.map(|seed| case.counted(seed + 10_000 * number as u64)).collect::<Vec<_>>())
            });
            work.map(|half| half.join().expect("a half"))
        });
        let counted = halves.concat();
        for (index, (what, _)) in counted[0].iter().enumerate() {
            let covered = counted.iter().filter(|batch| batch[index].1).count();
            println!("| {} | {what} | {:.1} % |", case.name, 100.0 * covered as f64 / counted.len() as f64);
        }
    }
}
