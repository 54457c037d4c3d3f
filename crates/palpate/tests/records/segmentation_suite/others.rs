//! Records in which the machine holds the force, and records without any hold.

use std::f64::consts::TAU;

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::random::Rng;
use palpate::segment::After;
use palpate::simulate::{ContactModel, ForceHistory, Sampling, Separation, simulate};

use super::record::{Machine, TrueHold, kink_limit, log_uniform};
use super::suite::{Kind, Labelled};

/// How a controller hunts about the set force, step by step, as a share of the largest.
const HUNTED: f64 = 0.002;
/// What that leaves unsure: ten samples go together.
const HUNTING: f64 = 0.02;

/// Force ramped and held by a controller that falls short at first and hunts; the displacement creeps.
pub fn press(noise: f64, random: &mut Rng) -> Labelled {
    let machine = Machine {
        dropouts: 0.0,
        skew: 0.0,
        ..Machine::drawn(noise, random)
    };
    let interval = log_uniform(1e-3, 0.2, random);
    let count = log_uniform(2.0, 12.9, random) as usize;
    let hold = log_uniform(60.0, 1500.0, random);
    let (mut knots, mut holds) = (vec![(0.0, 0.0)], Vec::new());
    let (mut now, mut at) = (0.0, 0.0);
    for index in 0..count {
        let to = if index % 2 == 0 { 0.5 + 0.5 * random.uniform() } else { 0.05 + 0.25 * random.uniform() };
        let length = hold * (0.5 + random.uniform());
        let ramp = log_uniform(2.0, 0.3 * length, random);
        // Who falls farther short than that has not arrived: that part counts as ramp.
        let short = 0.025 * (to - at) * random.uniform();
        now += ramp;
        knots.push((now, to - short));
        let lag = (0.03 * length * random.uniform()).max(1.0);
        for k in 1..=16 {
            let z = 0.4 * f64::from(k);
            knots.push((now + lag * z, to - short * (-z).exp()));
        }
        let limit = kink_limit(to - at, ramp, length, machine.noise.hypot(HUNTING));
        holds.push(TrueHold {
            start: now * interval,
            end: (now + length) * interval,
            after: if to > at { After::Loading } else { After::Unloading },
            force_held: true,
            limits: [limit, limit],
        });
        now += length;
        knots.push((now, to));
        at = to;
    }
    let exponent = [1.0, 2.0, 3.0, 5.0][(4.0 * random.uniform()) as usize];
    let relative_rate = log_uniform(0.5, 20.0, random) / (hold * interval);
    let (area, modulus) = (1e-4, 1e5);
    let model = ContactModel {
        specimen: Specimen::new(Shape::Prism { area, length: 0.05 }, modulus, Sides::One).expect("a body"),
        law: LatencyLaw::new(exponent, relative_rate / 0.1f64.powf(exponent - 1.0)).expect("a law"),
        layers: Layers::new(8.0).expect("layers"),
        separation: Separation::Bonded,
    };
    let largest = 0.3 * area * modulus;
    let (times, shares): (Vec<f64>, Vec<f64>) = knots.into_iter().unzip();
    let history = ForceHistory::new(
        times.iter().map(|t| t * interval).collect(),
        shares.iter().map(|share| share * largest).collect(),
    );
    let time = machine.times(interval, now * interval, random);
    let moved = simulate(&history.expect("knots in order"), &model, &Sampling::Times(time.clone()))
        .expect("a body that bears it");
    // What a controller leaves: slow hunting about the set force.
    let mut hunting = 0.0;
    let mut hunt = |force: &f64| {
        hunting = 0.9 * hunting + HUNTED * largest * random.normal();
        force + hunting
    };
    let force = moved.force.iter().map(&mut hunt).collect();
    Labelled {
        kind: Kind::ForceHeld,
        noise,
        record: machine.measured(time, [moved.displacement, force], random),
        holds,
    }
}

/// A record without a hold.
pub fn none(kind: Kind, noise: f64, random: &mut Rng) -> Labelled {
    let machine = Machine::drawn(noise, random);
    let samples = log_uniform(300.0, 20_000.0, random);
    let cycles = log_uniform(1.0, 12.0, random).min(samples / 40.0);
    let power = 0.4 + 0.4 * random.uniform();
    let mut knots = vec![(0.0, 0.0)];
    while knots.last().is_some_and(|(t, _)| *t < samples) {
        let (t, at) = knots[knots.len() - 1];
        let to: f64 = if at > 0.5 { 0.4 * random.uniform() } else { 0.6 + 0.4 * random.uniform() };
        knots.push((t + samples / cycles * (0.3 + random.uniform()), to));
    }
    let path = |i: f64| match kind {
        Kind::Triangle => 1.0 - (2.0 * (i / samples * cycles).fract() - 1.0).abs(),
        Kind::Sine => 0.5 - 0.5 * (TAU * i / samples * cycles).cos(),
        Kind::Ramps => {
            let next = knots.partition_point(|(t, _)| *t <= i).clamp(1, knots.len() - 1);
            let ((a, from), (b, to)) = (knots[next - 1], knots[next]);
            from + (to - from) * (i - a) / (b - a)
        }
        Kind::Still => 1.0,
        _ => (i / samples).powf(power),
    };
    let interval = log_uniform(1e-3, 0.2, random);
    let time = machine.times(interval, samples * interval, random);
    let displacement: Vec<f64> = time.iter().map(|t| 0.01 * path(t / interval)).collect();
    let force = displacement.iter().map(|d| 1e3 * d * (1.0 + 20.0 * d)).collect();
    Labelled {
        kind,
        noise,
        record: if kind == Kind::Still && noise == 0.0 {
            Machine {
                noise: 1e-3,
                ..Machine::perfect()
            }
            .measured(time, [displacement, force], random)
        } else {
            machine.measured(time, [displacement, force], random)
        },
        holds: Vec::new(),
    }
}
