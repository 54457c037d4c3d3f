//! Jaw protocols by lot: what the jaw does, and where it stands still.
//!
//! # What can be determined
//!
//! A hold is demanded where the data can show it, by one rule on every ramp beside it. With σ what noise and rounding leave
//! unsure of the displacement, a ramp travels 6 σ or more (and 1 % of the range), and at its speed the jaw would have gone on by
//! 12 σ or more (and 1 % of the range) had it not stopped: about three σ off the straight line through ramp, hold and ramp. A hold
//! has ten samples or more; in fewer than 24 noise hides more, and 12 σ grow as one over the root of their number.

use palpate::contact::{Layers, Shape, Sides, Specimen};
use palpate::latency::LatencyLaw;
use palpate::random::Rng;
use palpate::segment::After;
use palpate::simulate::{ContactModel, Motion, Separation, simulate_force};

use super::record::{Machine, TrueHold, kink_limit, log_uniform};
use super::suite::{Kind, Labelled};

/// Fewest samples of a hold.
pub const FEWEST: f64 = 10.0;
/// Least travel of a ramp, in σ.
pub const TRAVEL: f64 = 6.0;
/// Least way the jaw would have gone on in a hold, in σ.
pub const STANDS: f64 = 12.0;
/// Samples in which that is observed; of fewer it must be farther, as the root of their number.
pub const ENOUGH: f64 = 24.0;
/// The same as a share of the range: less is not observed by eye.
pub const STANDS_SHARE: f64 = 0.01;

/// One ramp and the hold after it: in samples, and levels as shares of the deepest.
#[derive(Debug, Clone, Copy)]
struct Step {
    to: f64,
    ramp: f64,
    hold: f64,
}

/// A record of holds of constant displacement.
pub fn squeeze(kind: Kind, noise: f64, random: &mut Rng) -> Labelled {
    let machine = Machine::drawn(noise, random);
    let levels = levels(kind, machine.unsure(), random);
    let steps = steps(kind, &levels, machine.unsure(), random);
    let ends_moving = random.uniform() < 0.5 && steps.last().is_some_and(|step| step.to > 0.3);
    let rest = if random.uniform() < 0.5 { (5.0 + 60.0 * random.uniform()).round() } else { 0.0 };
    let interval = 10f64.powf(-3.0 + 2.5 * random.uniform());
    let model = body(&steps, interval, random);
    let depth = 0.45 * model.specimen.depth() * if model.specimen.sides() == Sides::Two { 2.0 } else { 1.0 };

    let (mut knots, mut holds) = (vec![(0.0, 0.0)], Vec::new());
    let (mut at, mut now) = (0.0, rest);
    if rest > 0.0 {
        knots.push((now, 0.0));
    }
    for (index, step) in steps.iter().enumerate() {
        now += step.ramp;
        let rise = step.to - at;
        knots.push((now, step.to));
        if kind == Kind::Servo {
            settle(&mut knots, now, rise, step, machine.unsure(), random);
        }
        let next = steps.get(index + 1).map(|next| (next.to - step.to, next.ramp));
        holds.push(TrueHold {
            start: now * interval,
            end: (now + step.hold) * interval,
            after: if rise > 0.0 { After::Loading } else { After::Unloading },
            force_held: false,
            limits: [
                kink_limit(rise, step.ramp, step.hold, machine.unsure()),
                next.map_or(0.0, |(rise, ramp)| kink_limit(rise, ramp, step.hold, machine.unsure())),
            ],
        });
        now += step.hold;
        knots.push((now, step.to));
        at = step.to;
    }
    if ends_moving {
        now += steps[steps.len() - 1].ramp.max(6.0);
        knots.push((now, 0.05));
    }
    let (times, shares): (Vec<f64>, Vec<f64>) = knots.into_iter().unzip();
    let motion =
        Motion::new(times.iter().map(|t| t * interval).collect(), shares.iter().map(|share| share * depth).collect());
    let motion = motion.expect("knots in order");
    let time = machine.times(interval, motion.end(), random);
    let displacement = time.iter().map(|t| motion.displacement_at(*t)).collect();
    let late: Vec<f64> = time.iter().map(|t| (t - machine.skew * interval).max(0.0)).collect();
    let force = forces(&motion, &model, &late);
    Labelled {
        kind,
        noise,
        record: machine.measured(time, [displacement, force], random),
        holds,
    }
}

/// Forces at times that may repeat at the start.
fn forces(motion: &Motion, model: &ContactModel, times: &[f64]) -> Vec<f64> {
    let first = times.partition_point(|t| *t <= 0.0);
    let mut force = vec![0.0; first];
    force.extend(simulate_force(motion, model, &times[first..]).expect("a motion inside the body"));
    force
}

/// How deep the jaw goes, step by step, from 0 to 1.
fn levels(kind: Kind, unsure: f64, random: &mut Rng) -> Vec<f64> {
    let least = (TRAVEL * unsure).max(0.01) * 1.05;
    let count = log_uniform(2.0, 60.9, random) as usize;
    match kind {
        Kind::Stairs => {
            let count = count.min((0.9 / least) as usize).max(2);
            let parts: Vec<f64> = (0..count).map(|_| 0.3 + random.uniform()).collect();
            let (total, spare) = (parts.iter().sum::<f64>(), 1.0 - count as f64 * least);
            let mut level = 0.0;
            let mut up: Vec<f64> = parts
                .iter()
                .map(|part| {
                    level += least + spare * part / total;
                    level
                })
                .collect();
            if random.uniform() < 0.4 {
                up.reverse();
            }
            up
        }
        Kind::Cycles => {
            let (low, high) = (0.1 + 0.2 * random.uniform(), 0.7 + 0.3 * random.uniform());
            (0..count).map(|index| if index % 2 == 0 { high } else { low }).collect()
        }
        _ => {
            let mut at = 0.0;
            (0..count)
                .map(|_| {
                    let next = loop {
                        let level = 0.1 + 0.9 * random.uniform();
                        if (level - at).abs() >= least {
                            break level;
                        }
                    };
                    at = next;
                    next
                })
                .collect()
        }
    }
}

/// Ramps and holds in samples, all of which can be determined.
fn steps(kind: Kind, levels: &[f64], unsure: f64, random: &mut Rng) -> Vec<Step> {
    let spread = if kind == Kind::UnevenHolds { 10.0 } else { 2.0 };
    let holds: Vec<f64> = levels.iter().map(|_| log_uniform(1.0 / spread, spread, random)).collect();
    let total = holds.iter().sum::<f64>();
    let samples = log_uniform(200.0, 50_000.0, random) * if kind == Kind::SlowRamps { 0.3 } else { 0.7 };
    let holds: Vec<f64> = holds.iter().map(|hold| (hold / total * samples).max(FEWEST + 1.0)).collect();
    let mut at = 0.0;
    let mut steps = Vec::new();
    for (index, (to, hold)) in levels.iter().zip(&holds).enumerate() {
        let rise = (to - at).abs();
        let ramp = match kind {
            Kind::FastRamps => log_uniform(0.3, 3.0, random),
            Kind::SlowRamps => hold * log_uniform(1.0, 8.0, random),
            _ => log_uniform(1.0, hold.max(4.0), random),
        };
        // Slow enough ramps are no ramps any more, for either hold beside them.
        let shorter = if index > 0 { hold.min(holds[index - 1]) } else { *hold };
        let stands = STANDS * (ENOUGH / shorter).sqrt().max(1.0);
        let longest = rise * shorter / (stands * unsure).max(STANDS_SHARE);
        steps.push(Step {
            to: *to,
            ramp: ramp.min(longest),
            hold: *hold,
        });
        at = *to;
    }
    steps
}

/// A servo that overshoots by up to 2 % of its ramp and comes back.
fn settle(knots: &mut Vec<(f64, f64)>, start: f64, rise: f64, step: &Step, unsure: f64, random: &mut Rng) {
    let high = rise * 10f64.powf(-3.0 + 1.3 * random.uniform());
    // The way beyond the level is slower than the ramp, else the corner is none.
    let lag = (0.05 * step.hold * random.uniform()).max(6.0 * high.abs() * step.ramp / rise.abs()).max(0.5);
    if 12.0 * lag > step.hold || high.abs() < 0.5 * unsure {
        return;
    }
    for k in 1..=40 {
        let z = 0.25 * f64::from(k);
        let end = if k == 40 { 0.0 } else { high * z * (1.0 - z).exp() };
        knots.push((start + lag * z, step.to + end));
    }
}

/// A body whose relaxation can be observed in these holds.
fn body(steps: &[Step], interval: f64, random: &mut Rng) -> ContactModel {
    let is_ball = random.uniform() < 0.5;
    let (shape, sides) = if is_ball {
        (
            Shape::Ball {
                radius: 0.02 + 0.03 * random.uniform(),
            },
            Sides::Two,
        )
    } else {
        (
            Shape::Prism {
                area: 1e-4,
                length: 0.03 + 0.05 * random.uniform(),
            },
            Sides::One,
        )
    };
    let exponent = [1.0, 2.0, 3.0, 5.0][(4.0 * random.uniform()) as usize];
    let hold = steps.iter().map(|step| step.hold).sum::<f64>() / steps.len() as f64 * interval;
    // Excess strains are some hundredths.
    let relative_rate = log_uniform(1.0, 100.0, random) / hold;
    ContactModel {
        specimen: Specimen::new(shape, log_uniform(1e4, 1e6, random), sides).expect("a body"),
        law: LatencyLaw::new(exponent, relative_rate / 0.05f64.powf(exponent - 1.0)).expect("a law"),
        layers: Layers::new(8.0).expect("layers"),
        separation: Separation::Bonded,
    }
}
