//! Records whose law is known exactly: what is stated against a law, and what a table of equilibrium forces finds.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use palpate::analysis::{AnalysisOptions, Geometry};
use palpate::calibrate::{Calibration, CalibrationData, Candidate, EquilibriumLaw, ResidualCourse, calibrate};
use palpate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::record::Record;
use palpate::simulate::{ContactModel, ProtocolStep, Separation, protocol, simulate_force};
use palpate::test_problems::Rng;
use palpate::watch::Unwatched;

/// Section, m², and length, m, of a strip in grips.
const SECTION: f64 = 4e-6;
const LENGTH: f64 = 0.03;

/// Overshoots of its force with their times, s.
const TERMS: [(f64, f64); 2] = [(0.25 / 0.6, 2.0), (0.15 / 0.6, 40.0)];

/// Equilibrium force, N, of a strip of 90 MPa whose stiffness rises by this exponent over the strain; 0 for none.
fn relaxed(strain: f64, stiffening: f64) -> f64 {
    let force = SECTION * 90e6 * 0.04;
    let share = |strain: f64| if stiffening == 0.0 { strain } else { (stiffening * strain).exp_m1() / stiffening };
    force * share(strain) / share(0.04)
}

/// A strip with Fung's memory, pulled to these strains at 1 %/s and held for so long (s), with noise of force (N) and displacement (m), at 10 Hz.
fn strip(stiffening: f64, (strains, hold): (&[f64], f64), noise: (f64, f64), seed: u64) -> Record {
    const REST: f64 = 3.0;
    const FINE: usize = 20;
    let mut knots = vec![(0.0, 0.0), (REST, 0.0)];
    for strain in strains {
        let (time, before) = knots[knots.len() - 1];
        let there = time + (strain - before) / 0.01;
        knots.extend([(there, *strain), (there + hold, *strain)]);
    }
    let strain = |time: f64| {
        let after = knots.partition_point(|knot| knot.0 <= time).clamp(1, knots.len() - 1);
        let ((t, from), (until, to)) = (knots[after - 1], knots[after]);
        from + (to - from) * ((time - t) / (until - t)).min(1.0)
    };
    let mut random = Rng::new(seed);
    let (mut times, mut forces, mut places) = (Vec::new(), Vec::new(), Vec::new());
    let mut memory = [0.0; TERMS.len()];
    let step = 0.1 / FINE as f64;
    for index in 0..(10.0 * knots[knots.len() - 1].0) as usize * FINE {
        let time = step * index as f64;
        let force = relaxed(strain(time), stiffening);
        if index > 0 {
            let rise = force - relaxed(strain(time - step), stiffening);
            for (memory, (overshoot, tau)) in memory.iter_mut().zip(TERMS) {
                let kept = (-step / tau).exp();
                *memory = *memory * kept + overshoot * rise * tau / step * (1.0 - kept);
            }
        }
        if index % FINE == 0 {
            times.push(time);
            forces.push(force + memory.iter().sum::<f64>() + noise.0 * random.normal());
            places.push(LENGTH * strain(time) + noise.1 * random.normal());
        }
    }
    Record::new(times, Some(places), forces).unwrap()
}

fn calibrated(record: &Record, shape: Shape, law: &str, equilibrium: EquilibriumLaw) -> Calibration {
    let options = AnalysisOptions {
        geometry: Some(Geometry {
            shape,
            sides: Sides::One,
            modulus: None,
            equilibrium: Equilibrium::UniformStrain,
        }),
        separation: Separation::Bonded,
        ..AnalysisOptions::default()
    };
    let data = CalibrationData::of_record(record, &options).unwrap();
    calibrate(&data, Candidate::new(law.parse().unwrap(), equilibrium), 0.95, &mut Unwatched).unwrap()
}

fn of_strip(record: &Record, law: &str, equilibrium: EquilibriumLaw) -> Calibration {
    let shape = Shape::Prism {
        area: SECTION,
        length: LENGTH,
    };
    calibrated(record, shape, law, equilibrium)
}

/// The overshoot was 0.258 [0.224, 0.297] for 0.417, without a word: of 2070 samples the 40 of the ramp show it.
#[test]
fn a_law_that_misses_the_only_ramp_is_a_misfit() {
    for seed in 1..=3 {
        let found = |stiffening: f64, place: f64| {
            let record = strip(stiffening, (&[0.04], 200.0), (0.01, place), seed);
            of_strip(&record, "fung:2", EquilibriumLaw::UniformStrain).course
        };
        assert!(matches!(found(10.0, 0.0), Some(ResidualCourse::Ramps { relative }) if relative > 5e-3), "{seed}");
        assert!(found(10.0, 1e-6).is_some(), "{seed}");
        assert_eq!((found(0.0, 0.0), found(0.0, 1e-6)), (None, None), "{seed}");
    }
}

/// A cylinder of a plastic in steps up and down, of which force and displacement are read like this.
struct Plastic {
    times: Vec<f64>,
    places: Vec<f64>,
    /// Over the largest one.
    forces: Vec<f64>,
    peak: f64,
}

impl Plastic {
    const SHAPE: Shape = Shape::Prism {
        area: 1.267e-4,
        length: 0.0254,
    };

    fn new() -> Self {
        let steps = [0.25, 0.5, 0.75, 0.5, 0.25].map(|to| ProtocolStep {
            to: 1e-3 * to,
            rate: 5e-4,
            hold: 20.0,
        });
        let motion = protocol(&steps).unwrap();
        let model = ContactModel {
            specimen: Specimen::new(Self::SHAPE, 300e6, Sides::One).unwrap(),
            law: LatencyLaw::new(5.0, 2e7).unwrap(),
            layers: Layers::of_thickness(0.0254 / 6.0, 0.0254).unwrap(),
            separation: Separation::Bonded,
        };
        let times: Vec<f64> = (0..).map(|i| 0.05 * f64::from(i)).take_while(|time| *time <= motion.end()).collect();
        let forces = simulate_force(&motion, &model, &times).unwrap();
        let peak = forces.iter().copied().fold(0.0, f64::max);
        Self {
            places: times.iter().map(|time| motion.displacement_at(*time)).collect(),
            forces: forces.iter().map(|force| force / peak).collect(),
            times,
            peak,
        }
    }

    /// Read with this noise (of the largest force, m), and rounded to these steps.
    fn read(&self, (force, place): (f64, f64), (force_step, place_step): (f64, f64), seed: u64) -> Record {
        let mut random = Rng::new(seed);
        let mut read = |values: &[f64], noise: f64, step: f64| -> Vec<f64> {
            let noisy = values.iter().map(|value| value + noise * random.normal());
            noisy.map(|value| if step > 0.0 { (value / step).round() * step } else { value }).collect()
        };
        let forces = read(&self.forces, force, force_step).iter().map(|force| self.peak * force).collect();
        let places = read(&self.places, place, place_step);
        Record::new(self.times.clone(), Some(places), forces).unwrap()
    }
}

/// A plastic whose only error is noise of the displacement "missed part of the record": the noise comes back through the memory of the body.
#[test]
fn noise_of_the_displacement_is_no_misfit() {
    let plastic = Plastic::new();
    let (mut stated, mut slow) = (0, 0);
    for seed in 1..=4 {
        let record = plastic.read((2e-4, 2e-6), (0.0, 0.0), seed);
        let found = calibrated(&record, Plastic::SHAPE, "latency:5", EquilibriumLaw::UniformStrain);
        stated += u32::from(found.course.is_some());
        let samples = found.simulated.len();
        slow += u32::from(found.noise.effective_samples(samples) < 0.02 * samples as f64);
        let other = calibrated(&record, Plastic::SHAPE, "standard-linear-solid", EquilibriumLaw::UniformStrain);
        assert!(other.course.is_some(), "{seed}");
    }
    assert!(stated == 0 && slow > 0, "{stated} {slow}");
}

/// 10 µm were followed step by step, and a converter of 12 bits would be by its errors.
#[test]
fn rounding_of_either_column_is_no_misfit() {
    let plastic = Plastic::new();
    for (noise, step) in [((1e-3, 0.0), (0.0, 1e-5)), ((2e-4, 1e-7), (1.2 / 2048.0, 0.0))] {
        for seed in 1..=3 {
            let record = plastic.read(noise, step, seed);
            let found = calibrated(&record, Plastic::SHAPE, "latency:5", EquilibriumLaw::UniformStrain);
            assert_eq!(found.course, None, "{step:?} {seed}");
        }
    }
}

/// Every block was refused: forces in proportion to the displacement fell by a digit of rounding, and noise pulled what is bonded.
#[test]
fn a_table_finds_the_forces_of_a_strip() {
    for (stiffening, law) in [(0.0, "prony:2"), (0.0, "fung:2"), (10.0, "fung:2")] {
        let record = strip(stiffening, (&[0.01, 0.02, 0.03, 0.04], 60.0), (0.01, 5e-7), 2);
        let found = of_strip(&record, law, EquilibriumLaw::Table);
        assert_eq!(found.course, None, "{stiffening} {law}");
        for (term, (overshoot, time)) in (1..).zip(TERMS) {
            for (name, truth) in [(format!("overshoot_{term}"), overshoot), (format!("time_constant_{term}_s"), time)] {
                let value = found.material.estimate(&name).unwrap().value;
                assert!((value / truth - 1.0).abs() < 0.02, "{stiffening} {law} {name}: {value}");
            }
        }
        for (row, place) in (1..).zip(&found.material.body().levels) {
            let (name, truth) = (format!("equilibrium_force_{row}_n"), relaxed(place / LENGTH, stiffening));
            let value = found.material.estimate(&name).unwrap().value;
            assert!((value / truth - 1.0).abs() < 2e-3, "{stiffening} {law} {name}: {value} {truth}");
        }
    }
}

/// Section, m², and length, m, of a cylinder, and its modulus, 4 MPa, over the section, N.
const CYLINDER_SECTION: f64 = 6.6e-4;
const CYLINDER_LENGTH: f64 = 0.0125;
const STIFFNESS: f64 = 4e6 * CYLINDER_SECTION;

/// A cylinder of 6 layers with n = 3 and v = 50/s under ramps of 2 s to 600, 900 and 300 N, each held for 60 s, at 20 Hz: times, displacements, forces.
fn under_steps_of_force() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    const LAYERS: f64 = 6.0;
    /// Steps of the integration in one sample.
    const FINE: u32 = 10;
    let step = 0.05 / f64::from(FINE);
    let knots = [
        (0.0, 0.0),
        (2.0, 0.0),
        (4.0, 600.0),
        (64.0, 600.0),
        (66.0, 900.0),
        (126.0, 900.0),
        (128.0, 300.0),
        (188.0, 300.0),
    ];
    let force = |time: f64| {
        let after = knots.partition_point(|knot| knot.0 <= time).clamp(1, knots.len() - 1);
        let ((t, from), (until, to)) = (knots[after - 1], knots[after]);
        from + (to - from) * (time - t) / (until - t)
    };
    let (mut overstrain, mut found) = (0.0, (Vec::new(), Vec::new(), Vec::new()));
    for index in 0..20 * 188 * FINE {
        let time = step * f64::from(index);
        if index % FINE == 0 {
            found.0.push(time);
            found.1.push((force(time) / STIFFNESS - overstrain) * CYLINDER_LENGTH);
            found.2.push(force(time));
        }
        let rise = (force(time + step) - force(time)) * (LAYERS - 1.0) / (STIFFNESS * step);
        let rate = |x: f64| (rise - 50.0 * x * x * x) / LAYERS;
        let middle = overstrain + 0.5 * step * rate(overstrain);
        overstrain += step * rate(middle);
    }
    found
}

/// The law "missed part of the record" in 18 of 20 such records, with intervals 100 times too wide: a creep was straightened by micrometres.
#[test]
fn a_jaw_that_creeps_under_a_held_force_is_followed() {
    let (times, places, forces) = under_steps_of_force();
    let shape = Shape::Prism {
        area: CYLINDER_SECTION,
        length: CYLINDER_LENGTH,
    };
    for (noise, seed) in [(0.0, 1), (3e-7, 1), (3e-7, 2)] {
        let mut random = Rng::new(seed);
        let read = |values: &[f64], noise: f64, random: &mut Rng| -> Vec<f64> {
            values.iter().map(|value| value + noise * random.normal()).collect()
        };
        let (places, forces) = (read(&places, noise, &mut random), read(&forces, 0.5, &mut random));
        let record = Record::new(times.clone(), Some(places), forces).unwrap();
        let found = calibrated(&record, shape.clone(), "latency", EquilibriumLaw::UniformStrain);
        let exponent = found.material.estimate("exponent").unwrap();
        let (low, high) = exponent.interval.unwrap();
        assert_eq!(found.course, None, "{noise} {seed}");
        assert!(high - low < 0.02 && (exponent.value - 3.0).abs() < high - low, "{noise} {seed}: {exponent:?}");
    }
}
