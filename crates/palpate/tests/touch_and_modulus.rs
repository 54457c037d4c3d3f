//! First touch and modulus against known truth.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::record::Record;
use palpate::segment::{ContactChoice, ContactPoint, SegmentOptions, find_contact_of, find_phases};
use palpate::simulate::{ContactModel, Motion, ProtocolStep, Separation, protocol, simulate_force};
use palpate::test_problems::{Noise, PAPER_RATE, paper_ball};

/// A test bench: what meets the body, how, and how well it is seen.
#[derive(Clone, Copy)]
struct Bench {
    model: ContactModel,
    /// Travel through air before first touch, m.
    air: f64,
    /// Standstill before the first ramp, s.
    rest: f64,
    /// Speed of the jaw, m/s.
    speed: f64,
    /// Samples a second.
    rate: f64,
    /// Standard deviation of the force, N.
    noise: f64,
    /// Step of the encoder, m.
    encoder: f64,
    /// Force without contact, N.
    zero: f64,
}

impl Bench {
    fn paper(air: f64, noise: f64) -> Self {
        Self {
            model: paper_ball(Separation::Unilateral),
            air,
            rest: 0.0,
            speed: PAPER_RATE,
            rate: 100.0,
            noise,
            encoder: 0.0,
            zero: 0.0,
        }
    }

    /// Steps to `levels` (m of travel in contact), each held for `hold` seconds; counted from where the jaw started.
    fn record(&self, levels: &[f64], hold: f64, seed: u64) -> Record {
        let steps: Vec<ProtocolStep> =
            levels.iter().map(|to| ProtocolStep { to: *to, rate: self.speed, hold }).collect();
        let touching = protocol(&steps).unwrap();
        let late = self.rest + self.air / self.speed;
        let end = touching.end() + late;
        let mut random = Noise::new(seed);
        let time: Vec<f64> = (0..=(end * self.rate) as u32).map(|i| f64::from(i) / self.rate).collect();
        let motion = Motion::new(
            std::iter::once(-1.0).chain(touching.times().iter().copied()).collect(),
            std::iter::once(0.0).chain(touching.displacements().iter().copied()).collect(),
        )
        .unwrap();
        let since: Vec<f64> = time.iter().map(|t| (t - late).clamp(-1.0, touching.end())).collect();
        let clean = simulate_force(&motion, &self.model, &since).unwrap();
        let force = clean.iter().map(|f| f + self.zero + self.noise * random.normal()).collect();
        let place = |t: &f64| {
            let d = if *t < late { self.speed * (t - self.rest).max(0.0) } else { self.air + touching.displacement_at(t - late) };
            if self.encoder > 0.0 { (d / self.encoder).round() * self.encoder } else { d }
        };
        Record::new(time.clone(), Some(time.iter().map(place).collect()), force).unwrap()
    }

    fn touch(&self, record: &Record) -> ContactPoint {
        let (record, _) = record.repaired();
        let phases = find_phases(&record, &SegmentOptions::default()).unwrap();
        let body = (self.model.specimen.shape(), self.model.specimen.sides());
        find_contact_of(&record, &phases, Some(body), ContactChoice::Auto)
    }
}

fn strip(air: f64, noise: f64) -> Bench {
    let shape = Shape::Prism { area: 1e-3, length: 0.07 };
    Bench {
        model: ContactModel {
            specimen: Specimen::new(shape, 28e3, Sides::One).unwrap(),
            law: LatencyLaw::new(5.0, 2e4).unwrap(),
            layers: Layers::new(8.0).unwrap(),
            separation: Separation::Unilateral,
        },
        ..Bench::paper(air, noise)
    }
}

#[test]
fn survey() {
    let mut cases: Vec<(String, Bench, Vec<f64>)> = Vec::new();
    for noise in [0.0, 0.005, 0.05] {
        for step in [0.005, 0.01, 0.025] {
            let levels = vec![step, if step < 0.02 { 2.0 * step } else { 0.03 }];
            for air in [0.0, 0.005] {
                cases.push((format!("ball step {step}"), Bench::paper(air, noise), levels.clone()));
            }
            cases.push((format!("strip step {step}"), strip(0.003, noise), levels.clone()));
            cases.push((format!("strip step {step}"), strip(0.0, noise), levels.clone()));
        }
        let slow = Bench { speed: 0.005 / 60.0, rate: 10.0, encoder: 1e-5, rest: 3.0, ..Bench::paper(0.0, noise) };
        cases.push(("slow".into(), slow, vec![0.005, 0.01]));
        cases.push(("slow air".into(), Bench { air: 0.002, ..slow }, vec![0.005, 0.01]));
    }
    for (name, bench, levels) in cases {
        let seeds = if bench.noise > 0.0 || bench.encoder > 0.0 { 12 } else { 1 };
        let (mut sum, mut worst, mut pull, mut fell) = (0.0, 0.0f64, 0.0, 0);
        let mut mean_error = 0.0;
        for seed in 1..=seeds {
            let record = bench.record(&levels, 10.0, seed);
            let touch = bench.touch(&record);
            let error = 1e3 * (touch.tare.displacement - bench.air);
            sum += error;
            worst = worst.max(error.abs());
            match touch.displacement_error {
                Some(e) => { pull += (error / (1e3 * e)).powi(2); mean_error += 1e3 * e; }
                None => fell += 1,
            }
        }
        let est = (seeds - fell) as f64;
        println!(
            "{name} air {} noise {}: bias {:.4} worst {:.4} mm, se {:.4}, pull rms {:.2}, no air said {fell}/{seeds}",
            bench.air, bench.noise, sum / seeds as f64, worst, mean_error / est, (pull / est).sqrt()
        );
    }
}
