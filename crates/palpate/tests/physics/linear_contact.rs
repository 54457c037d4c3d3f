//! Linear laws: against SciPy and mpmath (`linear_contacts.json`, `linear_forces.json`), and against the latency law with n = 1.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

use crate::common::reference;
use palpate::contact::{Equilibrium, Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::simulate::{
    ContactEventKind, ContactModel, ForceHistory, LinearContact, LinearLaw, LinearTerm, Memory, Motion, ProgramStep,
    Sampling, Separation, SimulateError, energy, simulate, step_ends,
};
use serde::Deserialize;

#[derive(Deserialize)]
struct Tolerance {
    force_relative_to_largest: f64,
    fractional_relative_to_largest: f64,
    displacement_over_depth: f64,
    event_time: f64,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    shape: String,
    /// Radius of a ball; section and length of a block.
    size: Vec<f64>,
    modulus: f64,
    sides: u32,
    #[serde(default)]
    terms: Vec<(f64, f64)>,
    overshoot: Option<f64>,
    time: Option<f64>,
    order: Option<f64>,
    bonded: bool,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
    force: Vec<f64>,
    contact_displacement: Option<Vec<f64>>,
    #[serde(default)]
    events: Vec<(String, f64)>,
}

impl Case {
    fn contact(&self) -> LinearContact {
        let terms: Vec<LinearTerm> =
            self.terms.iter().map(|&(overshoot, rate)| LinearTerm { overshoot, rate }).collect();
        let law = match (self.overshoot, self.time, self.order) {
            (Some(overshoot), Some(time), Some(order)) => {
                LinearLaw::fractional(overshoot, time, order, (1e-4, 1e3)).unwrap()
            }
            _ => LinearLaw::new(&terms).unwrap(),
        };
        LinearContact {
            specimen: Specimen::new(shape(&self.shape, &self.size), self.modulus, sides(self.sides)).unwrap(),
            law,
            memory: Memory::Strain,
            separation: if self.bonded { Separation::Bonded } else { Separation::Unilateral },
        }
    }
}

fn shape(name: &str, size: &[f64]) -> Shape {
    match name {
        "ball" => Shape::Ball { radius: size[0] },
        _ => Shape::Prism {
            area: size[0],
            length: size[1],
        },
    }
}

fn sides(count: u32) -> Sides {
    if count == 2 { Sides::Two } else { Sides::One }
}

fn name(kind: ContactEventKind) -> &'static str {
    if kind == ContactEventKind::Lost { "lost" } else { "regained" }
}

fn distance(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn linear_contacts_agree_with_scipy_and_mpmath() {
    let (tolerance, cases) = reference::<Tolerance, Case>("linear_contacts");
    for case in &cases {
        let contact = case.contact();
        let (times, displacements) = case.knots.iter().copied().unzip();
        let motion = Motion::new(times, displacements).unwrap();
        let result = simulate(&motion, &contact, &Sampling::Times(case.times.clone())).unwrap();
        let most = case.force.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let off = distance(&result.force, &case.force) / most;
        println!("{}: force off by {off:.1e}, {} terms", case.name, contact.law.terms().len());
        let limit = match case.order {
            Some(_) => tolerance.fractional_relative_to_largest,
            None => tolerance.force_relative_to_largest,
        };
        assert!(off < limit, "{}: {off:e}", case.name);
        if let Some(expected) = &case.contact_displacement {
            let off = distance(&result.contact_displacement, expected) / contact.specimen.depth();
            assert!(off < tolerance.displacement_over_depth, "{}: {off:e}", case.name);
        }
        assert_eq!(result.events.len(), case.events.len(), "{}: {:?}", case.name, result.events);
        for (found, (kind, time)) in result.events.iter().zip(&case.events) {
            assert_eq!(name(found.kind), kind);
            assert!((found.time - time).abs() < tolerance.event_time, "{}: {} {time}", case.name, found.time);
        }
    }
}

#[test]
fn one_term_is_the_latency_law_with_exponent_one() {
    let knots = [0.0, 1.0, 5.0, 5.5, 30.0, 31.0, 40.0, 40.5, 60.0];
    let motion = Motion::new(knots.to_vec(), vec![0.0, 0.02, 0.02, 0.0, 0.0, 0.015, 0.015, 0.002, 0.002]).unwrap();
    let sampling = Sampling::Rate(20.0);
    let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
    for separation in [Separation::Bonded, Separation::Unilateral] {
        let latency = ContactModel {
            specimen: ball.clone(),
            law: LatencyLaw::new(1.0, 0.7).unwrap(),
            layers: Layers::new(8.0).unwrap(),
            separation,
        };
        let linear = LinearContact {
            specimen: ball.clone(),
            law: LinearLaw::standard(7.0, 1.0 / 0.7).unwrap(),
            memory: Memory::Strain,
            separation,
        };
        let expected = simulate(&motion, &latency, &sampling).unwrap();
        let found = simulate(&motion, &linear, &sampling).unwrap();
        assert_eq!(found.time, expected.time);
        let most = expected.force.iter().fold(0.0, |most: f64, force| most.max(*force));
        for (what, found, expected, size) in [
            ("force", &found.force, &expected.force, most),
            ("strain", &found.strain, &expected.strain, 1.0),
            ("excess", &found.excess_strain, &expected.excess_strain, 1.0),
            ("displacement", &found.displacement, &expected.displacement, 0.02),
            ("surface", &found.contact_displacement, &expected.contact_displacement, 0.01),
            ("rate", &found.strain_rate, &expected.strain_rate, 1.0),
        ] {
            let off = distance(found, expected) / size;
            assert!(off < 1e-10, "{separation:?}, {what}: {off:e}");
        }
        assert_eq!(found.events.len(), expected.events.len());
        assert_eq!(expected.events.is_empty(), separation == Separation::Bonded);
        for (found, expected) in found.events.iter().zip(&expected.events) {
            assert!(found.kind == expected.kind && (found.time - expected.time).abs() < 1e-9);
        }
    }
}

#[test]
fn a_linear_contact_obeys_superposition_and_refuses_what_the_body_cannot_take() {
    let block = Shape::Prism {
        area: 1e-3,
        length: 0.04,
    };
    let contact = LinearContact {
        specimen: Specimen::new(block, 1e5, Sides::One).unwrap(),
        law: LinearLaw::fractional(4.0, 3.0, 0.3, (1e-3, 1e3)).unwrap(),
        memory: Memory::Strain,
        separation: Separation::Bonded,
    };
    let times = vec![0.0, 1.0, 3.0, 4.0, 50.0];
    let (a, b) = ([0.0, 0.004, 0.004, 0.001, 0.001], [0.0, 0.0, 0.006, 0.006, -0.01]);
    let force = |displacements: Vec<f64>| {
        let motion = Motion::new(times.clone(), displacements).unwrap();
        simulate(&motion, &contact, &Sampling::Rate(10.0)).unwrap().force
    };
    let both = force(a.iter().zip(b).map(|(a, b)| 2.0 * a - 0.5 * b).collect());
    let (alone, other) = (force(a.to_vec()), force(b.to_vec()));
    let sum: Vec<f64> = alone.iter().zip(&other).map(|(a, b)| 2.0 * a - 0.5 * b).collect();
    assert!(distance(&both, &sum) < 1e-10);

    let ball = LinearContact {
        specimen: Specimen::new(Shape::Ball { radius: 0.01 }, 1e5, Sides::One).unwrap(),
        ..contact
    };
    let deep = Motion::new(vec![0.0, 1.0], vec![0.0, 0.01]).unwrap();
    let refused = simulate(&deep, &ball, &Sampling::Rate(1.0));
    assert!(matches!(refused, Err(SimulateError::Displacement { .. })));
    let motion = Motion::new(vec![0.0, 1.0], vec![0.0, 0.001]).unwrap();
    assert!(simulate(&motion, &ball, &Sampling::Times(vec![2.0])).is_err());
    assert!(simulate(&motion, &ball, &Sampling::Rate(f64::NAN)).is_err());
}

#[derive(Deserialize)]
struct ForcesTolerance {
    force_relative_to_largest: f64,
    displacement_relative_to_largest: f64,
    event_time: f64,
}

#[derive(Deserialize)]
struct ForcesCase {
    name: String,
    shape: String,
    size: Vec<f64>,
    modulus: f64,
    sides: u32,
    poisson_ratio: Option<f64>,
    terms: Vec<(f64, f64)>,
    memory: Memory,
    bonded: bool,
    motion: bool,
    knots: Vec<(f64, f64)>,
    times: Vec<f64>,
    #[serde(default)]
    force: Vec<f64>,
    displacement: Vec<f64>,
    #[serde(default)]
    events: Vec<(String, f64)>,
}

#[test]
fn creep_and_memory_of_force_agree_with_scipy() {
    let (tolerance, cases) = reference::<ForcesTolerance, ForcesCase>("linear_forces");
    let largest = |series: &[f64]| series.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    for case in &cases {
        let specimen = Specimen::new(shape(&case.shape, &case.size), case.modulus, sides(case.sides)).unwrap();
        let specimen = match case.poisson_ratio {
            Some(poisson_ratio) => specimen.with_equilibrium(Equilibrium::Hertz { poisson_ratio }).unwrap(),
            None => specimen,
        };
        let terms: Vec<LinearTerm> =
            case.terms.iter().map(|&(overshoot, rate)| LinearTerm { overshoot, rate }).collect();
        let contact = LinearContact {
            specimen,
            law: LinearLaw::new(&terms).unwrap(),
            memory: case.memory,
            separation: if case.bonded { Separation::Bonded } else { Separation::Unilateral },
        };
        let (times, values) = case.knots.iter().copied().unzip();
        let sampling = Sampling::Times(case.times.clone());
        let result = match case.motion {
            true => simulate(&Motion::new(times, values).unwrap(), &contact, &sampling).unwrap(),
            false => simulate(&ForceHistory::new(times, values).unwrap(), &contact, &sampling).unwrap(),
        };
        let off = distance(&result.contact_displacement, &case.displacement) / largest(&case.displacement);
        println!("{}: displacement off by {off:.1e}, {:?}", case.name, result.work);
        assert!(off < tolerance.displacement_relative_to_largest, "{}: {off:e}", case.name);
        if case.motion {
            let off = distance(&result.force, &case.force) / largest(&case.force);
            println!("    force off by {off:.1e}");
            assert!(off < tolerance.force_relative_to_largest, "{}: {off:e}", case.name);
        }
        assert_eq!(result.events.len(), case.events.len(), "{}: {:?}", case.name, result.events);
        for (found, (kind, time)) in result.events.iter().zip(&case.events) {
            assert_eq!(name(found.kind), kind);
            assert!((found.time - time).abs() < tolerance.event_time, "{}: {} {time}", case.name, found.time);
        }
        for i in 0..result.len() {
            // What is reported hangs together: the force by the strain, strain by its parts.
            let force = contact.specimen.force(result.strain[i], result.contact_displacement[i]);
            let strain = result.equilibrium_strain[i] + result.excess_strain[i];
            assert!((force - result.force[i]).abs() < 1e-10 * largest(&result.force), "{} {i}", case.name);
            let touches = result.strain[i] != 0.0;
            assert!(!touches || (strain - result.strain[i]).abs() < 1e-12, "{} {i}", case.name);
        }
    }
}

/// A gripper opens before it closes: with a memory of force, too, the body stays where it is, and work is a number.
#[test]
fn a_jaw_that_goes_away_first_leaves_the_body_at_rest() {
    let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
    let hertz = ball.clone().with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 }).unwrap();
    let motion = Motion::new(vec![0.0, 1.0, 3.0, 5.0, 6.0], vec![0.0, -0.01, 0.01, 0.01, -0.01]).unwrap();
    let late = Motion::new(vec![0.0, 1.0, 3.0, 4.0], vec![0.0, 0.01, 0.01, -0.01]).unwrap();
    for (specimen, memory) in
        [(&ball, Memory::Strain), (&ball, Memory::Force), (&hertz, Memory::Strain), (&hertz, Memory::Force)]
    {
        let contact = LinearContact {
            specimen: specimen.clone(),
            law: LinearLaw::standard(2.0, 1.0).unwrap(),
            memory,
            separation: Separation::Unilateral,
        };
        let sampling = Sampling::Rate(100.0);
        let result = simulate(&motion, &contact, &sampling).unwrap();
        let kinds: Vec<_> = result.events.iter().map(|event| event.kind).collect();
        let (lost, regained) = (ContactEventKind::Lost, ContactEventKind::Regained);
        assert_eq!(kinds, [lost, regained, lost], "{memory:?}");
        assert!(result.events[0].time < 1e-9 && (result.events[1].time - 2.0).abs() < 1e-9, "{:?}", result.events);
        assert!(result.contact_displacement.iter().all(|u| *u > -1e-12));
        // From touch on as if it had begun there.
        let touched = simulate(&late, &contact, &sampling).unwrap();
        for i in 0..=300 {
            assert!((result.force[200 + i] - touched.force[i]).abs() < 1e-9 * touched.force[100], "{memory:?} {i}");
        }
        let work = energy(&motion, &contact, &sampling).unwrap().work;
        let expected = energy(&late, &contact, &sampling).unwrap().work;
        assert!((work[600] / expected[400] - 1.0).abs() < 1e-9, "{memory:?}: {} {}", work[600], expected[400]);
    }
}

/// However much is requested, it is followed until the body gives way, and laws that relax nearly all of their force are followed as well.
#[test]
fn a_body_pressed_beyond_what_it_carries_says_when_it_gave_way() {
    let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
    for memory in [Memory::Strain, Memory::Force] {
        let contact = |overshoot: f64| LinearContact {
            specimen: ball.clone(),
            law: LinearLaw::standard(overshoot, 1.0).unwrap(),
            memory,
            separation: Separation::Unilateral,
        };
        // 107.8 N relaxed, 323.3 N at once.
        let mut before = 0.0;
        for most in [200.0, 330.0, 1e3, 1e6] {
            let press = [ProgramStep::Press { to: most, rate: 1.0 }];
            let Err(SimulateError::Force { time, force }) = step_ends(&press, &contact(2.0)) else {
                panic!("{most} N carried");
            };
            assert!(
                time > 100.0 && time < 323.0 && (force - time).abs() < 1e-9,
                "{memory:?} {most}: {time} s {force} N"
            );
            assert!(before == 0.0 || (time - before).abs() < 1e-3, "{time} {before}");
            before = time;
        }
        for overshoot in [1e3, 1e5, 1e7, 1e9] {
            let press = [ProgramStep::Press { to: 5.0, rate: 1.0 }, ProgramStep::HoldForce { duration: 10.0 }];
            let found = step_ends(&press, &contact(overshoot)).unwrap_or_else(|error| panic!("{overshoot:e}: {error}"));
            // So long before it comes to rest it is a dashpot with F + ∫F dt = 5 + 62.5 N after 15 s.
            let u = found[1].displacement / 2.0;
            let push = match memory {
                Memory::Force => ball.force(u / 0.035, u) * overshoot,
                Memory::Strain => continue,
            };
            assert!((push / 67.5 - 1.0).abs() < 20.0 / overshoot + 1e-6, "{overshoot:e}: {push}");
        }
    }
}

/// A measured force is many short pieces: each of them costs a few steps.
#[test]
fn a_measured_force_costs_few_steps_a_sample() {
    let terms: Vec<LinearTerm> = (-3..=3)
        .map(|k| LinearTerm {
            overshoot: 0.5,
            rate: 10f64.powi(k),
        })
        .collect();
    for memory in [Memory::Strain, Memory::Force] {
        let contact = LinearContact {
            specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
            law: LinearLaw::new(&terms).unwrap(),
            memory,
            separation: Separation::Unilateral,
        };
        let times: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
        let forces = times.iter().map(|t| 5.0 * t.sin().abs()).collect();
        let history = ForceHistory::new(times, forces).unwrap();
        let start = std::time::Instant::now();
        let work = simulate(&history, &contact, &Sampling::Rate(1.0)).unwrap().work;
        println!("{memory:?}: {work:?}, {:?}", start.elapsed());
        assert!(work.steps < 5 * 2000, "{work:?}");
    }
}

/// Of a body whose stiffness goes to nothing at first touch, what rounding leaves of a force near its end stands for far more displacement
/// than steps are good to: they once shrank for ever.
#[test]
fn a_force_let_down_on_a_body_soft_at_first_touch_comes_to_an_end() {
    let rows = [(0.0, 0.0), (0.2, 0.06), (0.32, 0.34), (0.53, 1.0)];
    let body = Specimen::new(Shape::Ball { radius: 1.0 }, 1e3, Sides::One).unwrap();
    let body = body.with_equilibrium(Equilibrium::measured(&rows).unwrap()).unwrap();
    for overshoot in [1e-6, 1e-3, 0.0147, 0.3] {
        let contact = LinearContact {
            specimen: body.clone(),
            law: LinearLaw::standard(overshoot, 2.8).unwrap(),
            memory: Memory::Strain,
            separation: Separation::Unilateral,
        };
        let history = ForceHistory::new(vec![0.0, 1.0, 2.0, 2.3, 9.0], vec![0.0, 0.3, 0.3, 0.0, 0.0]).unwrap();
        let result = simulate(&history, &contact, &Sampling::Rate(100.0)).unwrap();
        assert!(result.work.steps < 2000, "{:?}", result.work);
        assert!(result.contact_displacement.iter().all(|u| (-1e-12..0.4).contains(u)));
    }
}

/// It was refused as if it had no section.
#[test]
fn a_bonded_strip_with_a_table_goes_back_to_first_touch() {
    let table = Equilibrium::measured(&[(0.0, 0.0), (1e-3, 0.1), (3e-3, 0.4)]).unwrap();
    let shape = Shape::Prism {
        area: 1e-4,
        length: 0.02,
    };
    let strip = LinearContact {
        specimen: Specimen::new(shape, 1e5, Sides::One).unwrap().with_equilibrium(table).unwrap(),
        law: LinearLaw::standard(3.0, 2.0).unwrap(),
        memory: Memory::Force,
        separation: Separation::Bonded,
    };
    let motion = Motion::new(vec![0.0, 1.0, 2.0, 40.0], vec![0.0, 2e-3, 0.0, 0.0]).unwrap();
    let found = simulate(&motion, &strip, &Sampling::Times(vec![0.0, 1.0, 2.0, 40.0])).unwrap();
    // It pulls, and relaxes to nothing.
    assert!(found.force[1] > 0.3 && found.force[2] < -0.1 && found.force[3].abs() < 1e-6, "{:?}", found.force);
}

/// It came out as a number beyond the range of doubles.
#[test]
fn a_bonded_ball_that_remembers_force_cannot_go_back_to_first_touch() {
    let ball = LinearContact {
        specimen: Specimen::new(Shape::Ball { radius: 0.01 }, 1e5, Sides::One).unwrap(),
        law: LinearLaw::standard(3.0, 2.0).unwrap(),
        memory: Memory::Force,
        separation: Separation::Bonded,
    };
    let there_and = |back: f64| Motion::new(vec![0.0, 1.0, 2.0], vec![0.0, 2e-3, back]).unwrap();
    let sampling = Sampling::Times(vec![0.0, 1.0, 2.0]);
    assert_eq!(simulate(&there_and(0.0), &ball, &sampling), Err(SimulateError::NoArea { time: 2.0 }));
    assert!(simulate(&there_and(1e-4), &ball, &sampling).is_ok());
    let unilateral = LinearContact {
        separation: Separation::Unilateral,
        ..ball.clone()
    };
    assert_eq!(simulate(&there_and(0.0), &unilateral, &sampling).unwrap().events.len(), 1);
    let of_strain = LinearContact {
        memory: Memory::Strain,
        ..ball
    };
    assert_eq!(simulate(&there_and(0.0), &of_strain, &sampling).unwrap().force[2], 0.0);
}
