//! Contact force, strain wave, separation and creep against mpmath and SciPy (`contact_force.json`, `cascade.json`,
//! `cascade_grid.json`, `separation.json`, `creep.json`, `bodies.json`, `varying_rates.json`).

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::contact::{Curve, Equilibrium, Layers, RateDependence, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    Contact as Simulated, ContactEventKind, ContactModel, ForceHistory, Motion, Sampling, Separation, SimulateError,
    simulate, simulate_force, strain_wave,
};
use palpate::test_problems::paper_ball;
use serde::Deserialize;

/// What all cases of a contact share.
#[derive(Deserialize)]
struct Contact {
    name: String,
    radius: f64,
    modulus: f64,
    exponent: f64,
    rate_coefficient: f64,
    layers: f64,
    sides: u32,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
}

impl Contact {
    fn model(&self, separation: Separation) -> ContactModel {
        let sides = if self.sides == 2 { Sides::Two } else { Sides::One };
        ContactModel {
            specimen: Specimen::new(Shape::Ball { radius: self.radius }, self.modulus, sides).unwrap(),
            law: LatencyLaw::new(self.exponent, self.rate_coefficient).unwrap(),
            layers: Layers::new(self.layers).unwrap(),
            separation,
        }
    }

    fn motion(&self) -> Motion {
        let (times, displacements) = self.knots.iter().copied().unzip();
        Motion::new(times, displacements).unwrap()
    }
}

/// Largest distance between two series; NaN counts as infinitely far.
fn distance(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let far = |(a, b): (&f64, &f64)| if (a - b).is_nan() { f64::INFINITY } else { (a - b).abs() };
    found.iter().zip(expected).map(far).fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Prints one line a case and fails at the end, so that a failure shows all cases.
struct Verdict {
    beyond: Vec<String>,
}

impl Verdict {
    fn new() -> Self {
        Self { beyond: Vec::new() }
    }

    fn add(&mut self, case: &str, what: &str, error: f64, tolerance: f64) {
        let line = format!("{case}: {what} off by {error:.1e}, tolerance {tolerance:.0e}");
        println!("{line}");
        if error.is_nan() || error > tolerance {
            self.beyond.push(line);
        }
    }

    fn finish(self) {
        assert!(self.beyond.is_empty(), "\n{}", self.beyond.join("\n"));
    }
}

#[derive(Deserialize)]
struct ForceTolerance {
    excess_strain: f64,
    force_relative_to_largest: f64,
}

#[derive(Deserialize)]
struct ForceCase {
    #[serde(flatten)]
    contact: Contact,
    excess_strain: Vec<f64>,
    force: Vec<f64>,
}

#[test]
fn bonded_force() {
    let (tolerance, cases) = reference::<ForceTolerance, ForceCase>("contact_force");
    let mut verdict = Verdict::new();
    for case in &cases {
        let (motion, model) = (case.contact.motion(), case.contact.model(Separation::Bonded));
        let result = simulate(&motion, &model, &Sampling::Times(case.contact.times.clone())).unwrap();
        let name = &case.contact.name;
        verdict.add(
            name,
            "excess strain",
            distance(&result.excess_strain, &case.excess_strain),
            tolerance.excess_strain,
        );
        let force = distance(&result.force, &case.force) / largest(&case.force);
        verdict.add(name, "force", force, tolerance.force_relative_to_largest);
        assert!(result.events.is_empty());
    }
    verdict.finish();
}

#[derive(Deserialize)]
struct WaveTolerance {
    displacement: f64,
    excess_strain: f64,
}

#[derive(Deserialize)]
struct WaveCase {
    #[serde(flatten)]
    contact: Contact,
    /// One row a time, one column a layer.
    displacement: Vec<Vec<f64>>,
    excess_strain: Vec<Vec<f64>>,
}

#[test]
fn every_layer() {
    let (tolerance, cases) = reference::<WaveTolerance, WaveCase>("cascade");
    let mut verdict = Verdict::new();
    for case in &cases {
        let (motion, model) = (case.contact.motion(), case.contact.model(Separation::Bonded));
        let wave = strain_wave(&motion, &model, &Sampling::Times(case.contact.times.clone())).unwrap();
        let layers = wave.strain.len();
        assert_eq!(layers as f64, case.contact.layers);
        let thickness = case.contact.radius / layers as f64;
        let (mut displacement, mut excess) = (0.0f64, 0.0f64);
        for k in 0..wave.time.len() {
            let nodes: Vec<f64> = (0..layers).map(|i| wave.displacement[i][k]).collect();
            let below = |i: usize| case.contact.radius - thickness * i as f64;
            let excesses: Vec<f64> = (0..layers).map(|i| wave.strain[i][k] - nodes[i] / below(i)).collect();
            displacement = displacement.max(distance(&nodes, &case.displacement[k]));
            excess = excess.max(distance(&excesses, &case.excess_strain[k]));
        }
        verdict.add(&case.contact.name, "displacement", displacement, tolerance.displacement);
        verdict.add(&case.contact.name, "excess strain", excess, tolerance.excess_strain);
    }
    verdict.finish();
}

#[derive(Deserialize)]
struct GridTolerance {
    displacement_over_radius: f64,
    strain: f64,
}

#[derive(Deserialize)]
struct GridCase {
    #[serde(flatten)]
    contact: Contact,
    displacement: Vec<Vec<f64>>,
}

#[test]
fn every_layer_from_slow_to_fast_laws_and_from_1_to_512_layers() {
    let (tolerance, cases) = reference::<GridTolerance, GridCase>("cascade_grid");
    let mut verdict = Verdict::new();
    for case in &cases {
        let (motion, model) = (case.contact.motion(), case.contact.model(Separation::Bonded));
        let wave = strain_wave(&motion, &model, &Sampling::Times(case.contact.times.clone())).unwrap();
        let (layers, radius) = (wave.strain.len(), case.contact.radius);
        assert_eq!(layers as f64, case.contact.layers);
        let (mut displacement, mut strain) = (0.0f64, 0.0f64);
        for (k, expected) in case.displacement.iter().enumerate() {
            let found: Vec<f64> = (0..layers).map(|i| wave.displacement[i][k]).collect();
            displacement = displacement.max(distance(&found, expected) / radius);
            let inner = expected.iter().skip(1).copied().chain([0.0]);
            let expected: Vec<f64> =
                expected.iter().zip(inner).map(|(a, b)| (a - b) / radius * layers as f64).collect();
            let found: Vec<f64> = (0..layers).map(|i| wave.strain[i][k]).collect();
            strain = strain.max(distance(&found, &expected));
        }
        verdict.add(&case.contact.name, "displacement", displacement, tolerance.displacement_over_radius);
        verdict.add(&case.contact.name, "strain", strain, tolerance.strain);
    }
    verdict.finish();
}

#[derive(Deserialize)]
struct SeparationTolerance {
    event_time: f64,
    displacement: f64,
    force: f64,
}

#[derive(Deserialize)]
struct Event {
    kind: String,
    time: f64,
}

#[derive(Deserialize)]
struct SeparationCase {
    #[serde(flatten)]
    contact: Contact,
    events: Vec<Event>,
    in_contact: Vec<bool>,
    surface_displacement: Vec<f64>,
    jaw_share: Vec<f64>,
    force: Vec<f64>,
}

#[test]
fn a_jaw_that_cannot_pull() {
    let (tolerance, cases) = reference::<SeparationTolerance, SeparationCase>("separation");
    let mut verdict = Verdict::new();
    for case in &cases {
        let (motion, model) = (case.contact.motion(), case.contact.model(Separation::Unilateral));
        let times = &case.contact.times;
        let result = simulate(&motion, &model, &Sampling::Times(times.clone())).unwrap();
        let name = &case.contact.name;
        let kinds: Vec<&str> = result
            .events
            .iter()
            .map(|event| match event.kind {
                ContactEventKind::Lost => "loss",
                ContactEventKind::Regained => "contact",
            })
            .collect();
        let expected: Vec<&str> = case.events.iter().map(|event| event.kind.as_str()).collect();
        assert_eq!(kinds, expected, "{name}");
        let found_times: Vec<f64> = result.events.iter().map(|event| event.time).collect();
        let event_times: Vec<f64> = case.events.iter().map(|event| event.time).collect();
        verdict.add(name, "event time", distance(&found_times, &event_times), tolerance.event_time);
        let surface = distance(&result.contact_displacement, &case.surface_displacement);
        verdict.add(name, "surface", surface, tolerance.displacement);
        let jaw: Vec<f64> = result.displacement.iter().map(|d| d / f64::from(case.contact.sides)).collect();
        verdict.add(name, "jaw", distance(&jaw, &case.jaw_share), tolerance.displacement);
        verdict.add(name, "force", distance(&result.force, &case.force), tolerance.force);
        for (k, &touching) in case.in_contact.iter().enumerate() {
            assert_eq!(result.in_contact[k], touching, "{name} at {} s", times[k]);
            let meets = (result.contact_displacement[k] - jaw[k]).abs() <= tolerance.displacement;
            assert_eq!(meets, touching, "{name} at {} s", times[k]);
            if !touching {
                assert_eq!((result.force[k], result.strain[k]), (0.0, 0.0), "{name} at {} s", times[k]);
            }
        }
        for event in &result.events {
            let share = model.specimen.contact_displacement(motion.displacement_at(event.time));
            assert!((event.contact_displacement - share).abs() <= tolerance.displacement, "{name}: {event:?}");
        }
    }
    verdict.finish();
}

#[test]
fn force_alone_equals_the_whole_trajectory() {
    let (_, forces) = reference::<ForceTolerance, ForceCase>("contact_force");
    let (_, separations) = reference::<SeparationTolerance, SeparationCase>("separation");
    let bonded = forces.into_iter().map(|case| (case.contact, Separation::Bonded));
    let unilateral = separations.into_iter().map(|case| (case.contact, Separation::Unilateral));
    for (contact, separation) in bonded.chain(unilateral) {
        let (motion, model) = (contact.motion(), contact.model(separation));
        let step = (motion.end() - motion.start()) / 997.0;
        let mut times: Vec<f64> = (0..997).map(|i| motion.start() + step * f64::from(i)).collect();
        times.extend(motion.times());
        times.sort_by(f64::total_cmp);
        let force = simulate_force(&motion, &model, &times).unwrap();
        let result = simulate(&motion, &model, &Sampling::Times(times)).unwrap();
        let apart = distance(&force, &result.force) / largest(&force);
        println!("{}: {apart:.1e}", contact.name);
        assert!(apart <= 4e-16, "{}: {apart:e}", contact.name);
    }
}

#[derive(Deserialize)]
struct CreepTolerance {
    displacement_over_depth: f64,
    excess_strain: f64,
}

#[derive(Deserialize)]
struct CreepCase {
    name: String,
    shape: String,
    /// Radius of a ball; section and length of a block.
    size: Vec<f64>,
    modulus: f64,
    exponent: f64,
    rate_coefficient: f64,
    layers: f64,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
    contact_displacement: Vec<f64>,
    excess_strain: Vec<f64>,
}

impl CreepCase {
    fn model(&self) -> ContactModel {
        let shape = match self.shape.as_str() {
            "ball" => Shape::Ball { radius: self.size[0] },
            _ => Shape::Prism {
                area: self.size[0],
                length: self.size[1],
            },
        };
        ContactModel {
            specimen: Specimen::new(shape, self.modulus, Sides::Two).unwrap(),
            law: LatencyLaw::new(self.exponent, self.rate_coefficient).unwrap(),
            layers: Layers::new(self.layers).unwrap(),
            separation: Separation::Bonded,
        }
    }
}

#[test]
fn under_a_force() {
    let (tolerance, cases) = reference::<CreepTolerance, CreepCase>("creep");
    let mut verdict = Verdict::new();
    for case in &cases {
        let model = case.model();
        let (times, forces) = case.knots.iter().copied().unzip();
        let history = ForceHistory::new(times, forces).unwrap();
        let result = simulate(&history, &model, &Sampling::Times(case.times.clone())).unwrap();
        let off = distance(&result.contact_displacement, &case.contact_displacement) / model.specimen.depth();
        verdict.add(&case.name, "displacement", off, tolerance.displacement_over_depth);
        verdict.add(
            &case.name,
            "excess strain",
            distance(&result.excess_strain, &case.excess_strain),
            tolerance.excess_strain,
        );
    }
    verdict.finish();
}

#[derive(Deserialize)]
struct BodyTolerance {
    force_relative_to_largest: f64,
    displacement_over_depth: f64,
}

#[derive(Deserialize)]
struct BodyCase {
    name: String,
    body: String,
    depth: f64,
    modulus: f64,
    poisson_ratio: Option<f64>,
    #[serde(default)]
    rows: Vec<(f64, f64)>,
    exponent: f64,
    rate_coefficient: f64,
    layers: f64,
    sides: u32,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
    /// Of a motion.
    force: Option<Vec<f64>>,
    /// Of a force.
    contact_displacement: Option<Vec<f64>>,
}

impl BodyCase {
    fn specimen(&self) -> Specimen {
        let sides = if self.sides == 2 { Sides::Two } else { Sides::One };
        let ball = Shape::Ball { radius: self.depth };
        let (shape, equilibrium) = match (self.body.as_str(), self.poisson_ratio) {
            ("hertz", Some(poisson_ratio)) => (ball, Equilibrium::Hertz { poisson_ratio }),
            ("measured", _) => (ball, Equilibrium::measured(&self.rows).unwrap()),
            _ => {
                let area = Curve::new(&self.rows).unwrap();
                let depth = self.depth;
                (Shape::Profile { depth, area }, Equilibrium::UniformStrain)
            }
        };
        Specimen::new(shape, self.modulus, sides).unwrap().with_equilibrium(equilibrium).unwrap()
    }
}

#[test]
fn bodies_by_tables_and_hertz() {
    let (tolerance, cases) = reference::<BodyTolerance, BodyCase>("bodies");
    let mut verdict = Verdict::new();
    for case in &cases {
        let model = ContactModel {
            specimen: case.specimen(),
            law: LatencyLaw::new(case.exponent, case.rate_coefficient).unwrap(),
            layers: Layers::new(case.layers).unwrap(),
            separation: Separation::Bonded,
        };
        let (times, values) = case.knots.iter().copied().unzip();
        let sampling = Sampling::Times(case.times.clone());
        if let Some(expected) = &case.force {
            let result = simulate(&Motion::new(times, values).unwrap(), &model, &sampling).unwrap();
            let off = distance(&result.force, expected) / largest(expected);
            verdict.add(&case.name, "force", off, tolerance.force_relative_to_largest);
        } else if let Some(expected) = &case.contact_displacement {
            let result = simulate(&ForceHistory::new(times, values).unwrap(), &model, &sampling).unwrap();
            let off = distance(&result.contact_displacement, expected) / case.depth;
            verdict.add(&case.name, "displacement", off, tolerance.displacement_over_depth);
        } else {
            panic!("{}: neither force nor displacement", case.name);
        }
    }
    verdict.finish();
}

#[test]
fn a_wave_that_starts_from_a_squeezed_body_starts_relaxed() {
    let model = palpate::test_problems::paper_ball(Separation::Bonded);
    let still = Motion::new(vec![0.0, 5.0, 5.6, 10.0], vec![0.01, 0.01, 0.015, 0.015]).unwrap();
    let sampling = Sampling::Times(vec![0.0, 2.0, 5.6, 10.0]);
    let (wave, contact) =
        (strain_wave(&still, &model, &sampling).unwrap(), simulate(&still, &model, &sampling).unwrap());
    assert!(distance(&wave.strain[0], &contact.strain) < 1e-11);
    for strain in &wave.strain {
        // 5 mm a contact over 35 mm, the same in every layer while nothing moves.
        assert!((strain[0] - 5.0 / 35.0).abs() < 1e-15 && (strain[1] - 5.0 / 35.0).abs() < 1e-13);
    }
}

#[test]
fn layers_that_relax_too_fast_are_refused_and_do_not_run_on() {
    let mut model = palpate::test_problems::paper_ball(Separation::Bonded);
    model.law = LatencyLaw::new(1.0, 1e8).unwrap();
    let motion = Motion::new(vec![0.0, 1.0, 100.0], vec![0.0, 0.01, 0.01]).unwrap();
    let sampling = Sampling::Times(vec![100.0]);
    let refused = strain_wave(&motion, &model, &sampling);
    assert!(matches!(refused, Err(SimulateError::StiffLayers { .. })), "{refused:?}");
    assert!(simulate(&motion, &model, &sampling).is_ok());
}

#[derive(Deserialize)]
struct VaryingTolerance {
    strain: f64,
    direction: f64,
}

#[derive(Deserialize)]
struct VaryingCase {
    drive: String,
    rate: String,
    factor: f64,
    #[serde(flatten)]
    contact: CreepCase,
}

#[test]
fn with_a_rate_that_depends_on_strain_or_direction() {
    let (tolerance, cases) = reference::<VaryingTolerance, VaryingCase>("varying_rates");
    let mut verdict = Verdict::new();
    for VaryingCase {
        drive,
        rate,
        factor,
        contact: case,
    } in &cases
    {
        let (rate, allowed) = match rate.as_str() {
            "strain" => (RateDependence::Strain { factor: *factor }, tolerance.strain),
            _ => (RateDependence::Direction { factor: *factor }, tolerance.direction),
        };
        let contact = Simulated::Latency {
            model: case.model(),
            rate,
        };
        let (times, values) = case.knots.iter().copied().unzip();
        let sampling = Sampling::Times(case.times.clone());
        let result = match drive.as_str() {
            "motion" => simulate(&Motion::new(times, values).unwrap(), &contact, &sampling),
            _ => simulate(&ForceHistory::new(times, values).unwrap(), &contact, &sampling),
        }
        .unwrap();
        let depth = contact.specimen().depth();
        let off = distance(&result.contact_displacement, &case.contact_displacement) / depth;
        verdict.add(&case.name, "displacement", off, allowed);
        verdict.add(&case.name, "excess strain", distance(&result.excess_strain, &case.excess_strain), allowed);
    }
    verdict.finish();
}

/// The recovery ẏ = −(v(y)/m) yⁿ of a surface, against Runge and Kutta's method.
#[test]
fn a_surface_left_alone_recovers_by_its_own_rate() {
    for rate in [RateDependence::Strain { factor: 0.2 }, RateDependence::Direction { factor: 0.3 }] {
        let model = paper_ball(Separation::Unilateral);
        let contact = Simulated::Latency {
            model: model.clone(),
            rate,
        };
        let squeeze = Motion::new(vec![0.0, 1.0, 11.0, 11.01, 80.0], vec![0.0, 0.015, 0.015, -0.01, -0.01]).unwrap();
        let times: Vec<f64> = (0..60).map(|i| 11.02 + f64::from(i)).collect();
        let off = simulate(&squeeze, &contact, &Sampling::Times(times.clone())).unwrap();
        assert!(off.force.iter().all(|force| *force == 0.0) && off.contact_displacement[0] > 1e-3);
        let since = times[0];
        let again = |elapsed: f64, dent: f64| {
            let (depth, layers) = (model.specimen.depth(), model.layers.count());
            let law = |y: f64| rate.times(-1.0, y) * model.law.rate_coefficient() / layers * y.powi(5);
            // Runge and Kutta's method of fourth order.
            let (mut y, steps) = (dent / depth, 4000);
            let h = elapsed / f64::from(steps);
            for _ in 0..steps {
                let a = law(y);
                let b = law(y - 0.5 * h * a);
                let c = law(y - 0.5 * h * b);
                y -= h / 6.0 * (a + 2.0 * b + 2.0 * c + law(y - h * c));
            }
            y * depth
        };
        for (time, u) in times.iter().zip(&off.contact_displacement) {
            let exact = again(time - since, off.contact_displacement[0]);
            assert!((u - exact).abs() < 1e-6 * 0.035, "{rate:?} at {time} s: {u} {exact}");
        }
        let plain = simulate(&squeeze, &Simulated::from(model.clone()), &Sampling::Times(times.clone())).unwrap();
        let model = simulate(&squeeze, &model, &Sampling::Times(times)).unwrap();
        assert_eq!(plain.contact_displacement, model.contact_displacement);
    }
}
