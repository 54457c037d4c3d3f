//! What machines do besides: crossheads whose encoders are noisy, jaws that swing, ramps that ripple, force curves of an AFM.

use std::f64::consts::TAU;

use palpate::random::{Rng, seed_of};
use palpate::record::Record;
use palpate::segment::After;

use super::record::{TrueHold, log_uniform};
use super::suite::{Kind, Labelled, NOISES};

/// Kinds in the order in which records take turns.
const TURNS: [Kind; 4] = [Kind::NoisyCrosshead, Kind::Chatter, Kind::Ripple, Kind::AfmCurve];

/// Record `number` of those; every one is its own source of chance.
pub fn quirky(number: u64) -> Labelled {
    let mut random = Rng::new(seed_of(20_261, number));
    let kind = TURNS[(number % 4) as usize];
    let noise = NOISES[(number / 4) as usize % NOISES.len()];
    let ([time, displacement, force], holds) = match kind {
        Kind::NoisyCrosshead => crosshead(&mut random),
        Kind::Chatter => chatter(&mut random),
        Kind::Ripple => ripple(&mut random),
        _ => (afm(&mut random), Vec::new()),
    };
    let noisy = |values: Vec<f64>, share: f64, random: &mut Rng| {
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        values.iter().map(|value| value + share * (high - low) * random.normal()).collect::<Vec<f64>>()
    };
    // The encoder of the crosshead has noise of its own; a ripple stands far above that of its sensor.
    let of_jaw = match kind {
        Kind::NoisyCrosshead => 0.0,
        Kind::Ripple => noise.min(2e-5),
        _ => noise.min(1e-3),
    };
    let displacement = noisy(displacement, of_jaw, &mut random);
    let force = noisy(force, noise, &mut random);
    Labelled {
        kind,
        noise,
        record: Record::new(time, Some(displacement), force).expect("a record of finite numbers"),
        holds,
    }
}

type Columns = [Vec<f64>; 3];

/// A relaxation from 1 to between 0.2 and 0.7, as a power of time.
fn relaxation(duration: f64, random: &mut Rng) -> impl Fn(f64) -> f64 + use<> {
    let (left, pace, power) = (
        0.2 + 0.5 * random.uniform(),
        log_uniform(10.0, 300.0, random) / duration,
        0.25 + 0.5 * random.uniform(),
    );
    move |t: f64| left + (1.0 - left) * (1.0 + pace * t).powf(-power)
}

/// One hold from the first sample on: the encoder of a crosshead that stands shows one of three neighbouring steps, and creeps to its
/// place at first.
fn crosshead(random: &mut Rng) -> (Columns, Vec<TrueHold>) {
    let count = log_uniform(400.0, 20_000.0, random) as usize;
    let interval = log_uniform(0.01, 1.0, random);
    let step = 6e-8;
    let (settles, restless) = (0.05 * random.uniform() * count as f64, 0.05 + 0.3 * random.uniform());
    let relaxed = relaxation(interval * count as f64, random);
    let time: Vec<f64> = (0..count).map(|i| interval * i as f64).collect();
    let jaw = (0..count)
        .map(|i| {
            let creep = 2.0 * (-(i as f64) / settles.max(1.0)).exp();
            let shown = if random.uniform() < restless { (2.0 * random.uniform() - 1.0).round() } else { 0.0 };
            -1.7e-3 + step * ((shown - creep).max(-2.0)).round()
        })
        .collect();
    let force = time.iter().map(|t| 0.04 * relaxed(*t)).collect();
    let hold = TrueHold {
        start: 0.0,
        end: time[count - 1],
        after: After::Loading,
        force_held: false,
        limits: [1.0, 1.0],
    };
    ([time, jaw, force], vec![hold])
}

/// A ramp that ends in a swing of some waves, and the hold that it belongs to.
fn chatter(random: &mut Rng) -> (Columns, Vec<TrueHold>) {
    let (ramp, hold) = (200.0 + 300.0 * random.uniform(), log_uniform(400.0, 4000.0, random));
    let interval = log_uniform(1e-3, 0.05, random);
    let (height, period) = (0.005 + 0.03 * random.uniform(), 8.0 + 16.0 * random.uniform());
    let dies = 0.015 * hold;
    let relaxed = relaxation(interval * hold, random);
    let count = (ramp + hold) as usize;
    let place = |i: f64| match i - ramp {
        since if since < 0.0 => i / ramp,
        since => 1.0 + height * (-since / dies).exp() * (TAU * since / period).sin(),
    };
    let time: Vec<f64> = (0..count).map(|i| interval * i as f64).collect();
    let jaw: Vec<f64> = (0..count).map(|i| 0.01 * place(i as f64)).collect();
    let force = (0..count).map(|i| 500.0 * jaw[i] * relaxed(interval * (i as f64 - ramp).max(0.0))).collect();
    let held = TrueHold {
        start: ramp * interval,
        end: time[count - 1],
        after: After::Loading,
        force_held: false,
        // The swing is of the hold, or of what comes before it.
        limits: [dies, 1.0],
    };
    ([time, jaw, force], vec![held])
}

/// Up and down in ramps that vibrate so that the jaw stops in some waves, with a hold on top.
fn ripple(random: &mut Rng) -> (Columns, Vec<TrueHold>) {
    let (ramp, hold) = (600.0 + 2000.0 * random.uniform(), 300.0 + 1500.0 * random.uniform());
    let interval = log_uniform(1e-4, 1e-2, random);
    let period = 12.0 + 12.0 * random.uniform();
    // The speed of the wave comes near that of the ramp, and in bursts exceeds it.
    let (height, bursts) = ((0.6 + 0.2 * random.uniform()) * period / TAU / ramp, 150.0 + 150.0 * random.uniform());
    let relaxed = relaxation(interval * hold, random);
    let count = (2.0 * ramp + hold) as usize;
    let place = |i: f64| {
        let wave = height * (1.0 + 0.4 * (TAU * i / bursts).sin()) * (TAU * i / period).sin();
        if i < ramp {
            i / ramp + wave
        } else if i < ramp + hold {
            1.0
        } else {
            1.0 - (i - ramp - hold) / ramp + wave
        }
    };
    let time: Vec<f64> = (0..count).map(|i| interval * i as f64).collect();
    let jaw: Vec<f64> = (0..count).map(|i| 0.01 * place(i as f64)).collect();
    let force = (0..count)
        .map(|i| 500.0 * jaw[i] * relaxed(interval * (i as f64 - ramp).clamp(0.0, hold)))
        .collect();
    let held = TrueHold {
        start: ramp * interval,
        end: (ramp + hold) * interval,
        after: After::Loading,
        force_held: false,
        limits: [period, period],
    };
    ([time, jaw, force], vec![held])
}

/// Approach through air, contact and retraction of a cantilever on a hard sample: in contact the tip stands while the force goes up and
/// down. Air has a force of its own, and the tip sticks on the way back.
fn afm(random: &mut Rng) -> Columns {
    let count = log_uniform(200.0, 4000.0, random) as usize;
    let interval = log_uniform(1e-4, 1e-2, random);
    let (touch, adhesion) = (0.6 + 0.3 * random.uniform(), 0.1 + 0.2 * random.uniform());
    let (offset, hard) = (2.0 * random.uniform() - 1.0, 0.01 * random.uniform());
    let time: Vec<f64> = (0..2 * count).map(|i| interval * i as f64).collect();
    let (mut tip, mut force) = (Vec::new(), Vec::new());
    for i in 0..2 * count {
        let piezo = 1.0 - (i as f64 / count as f64 - 1.0).abs();
        let sticks = if i > count { adhesion * (1.0 - touch) } else { 0.0 };
        let pressed = if piezo > touch - sticks { piezo - touch } else { 0.0 };
        tip.push(1e-6 * (piezo - (1.0 - hard) * pressed));
        force.push(1e-9 * (offset + 10.0 * pressed));
    }
    [time, tip, force]
}
