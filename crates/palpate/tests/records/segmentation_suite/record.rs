//! What a machine makes of a motion: a labelled record.

use palpate::random::Rng;
use palpate::record::Record;
use palpate::segment::After;

/// A true hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueHold {
    /// First moment at the level, s.
    pub start: f64,
    /// Last moment at the level, s.
    pub end: f64,
    /// What came before.
    pub after: After,
    /// Whether the machine held the force (else the displacement).
    pub force_held: bool,
    /// How well the noise lets start and end be reported, samples: the limit of Cramér and Rao.
    pub limits: [f64; 2],
}

/// How a machine measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Machine {
    /// Noise of both columns, as a share of the range of each.
    pub noise: f64,
    /// Steps of encoder and load cell, as shares of the range of each.
    pub quanta: [f64; 2],
    /// Drift of displacement and force over the record, as shares of the range of each.
    pub drifts: [f64; 2],
    /// Rows that are zero, alone, as a share.
    pub dropouts: f64,
    /// By how many samples the force is late.
    pub skew: f64,
    /// By which share the time between samples wanders.
    pub jitter: f64,
}

impl Machine {
    /// A machine with this much noise, drawn by lot.
    pub fn drawn(noise: f64, random: &mut Rng) -> Self {
        let mut quantum = || if random.uniform() < 0.4 { 10f64.powf(-4.0 + 1.7 * random.uniform()) } else { 0.0 };
        let quanta = [quantum(), quantum()];
        let mut drift = |most: f64| if random.uniform() < 0.4 { most * (2.0 * random.uniform() - 1.0) } else { 0.0 };
        let drifts = [drift(0.004), drift(0.02)];
        Self {
            noise,
            quanta,
            drifts,
            dropouts: if random.uniform() < 0.2 { 0.003 } else { 0.0 },
            skew: if random.uniform() < 0.3 { 3.0 * random.uniform() } else { 0.0 },
            jitter: if random.uniform() < 0.3 { 0.45 } else { 0.0 },
        }
    }

    /// A machine without fault.
    pub fn perfect() -> Self {
        Self {
            noise: 0.0,
            quanta: [0.0; 2],
            drifts: [0.0; 2],
            dropouts: 0.0,
            skew: 0.0,
            jitter: 0.0,
        }
    }

    /// What noise and rounding leave unsure of the displacement, as a share of its range.
    pub fn unsure(&self) -> f64 {
        self.noise.hypot(self.quanta[0] / 12f64.sqrt())
    }

    /// The times of its samples, from 0 to `duration`.
    pub fn times(&self, interval: f64, duration: f64, random: &mut Rng) -> Vec<f64> {
        let count = (duration / interval) as usize + 1;
        let off = |i: usize, random: &mut Rng| if i == 0 { 0.0 } else { self.jitter * (random.uniform() - 0.5) };
        (0..count).map(|i| (i as f64 + off(i, random)) * interval).filter(|t| *t <= duration).collect()
    }

    /// The columns as they are written, from the true ones at the same times.
    pub fn measured(&self, time: Vec<f64>, columns: [Vec<f64>; 2], random: &mut Rng) -> Record {
        let last = time[time.len() - 1];
        let mut columns = columns;
        for (index, column) in columns.iter_mut().enumerate() {
            let (low, high) = column.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
            let range = if high > low { high - low } else { high.abs().max(1e-6) };
            let quantum = self.quanta[index] * range;
            for (value, t) in column.iter_mut().zip(&time) {
                *value += range * (self.drifts[index] * t / last + self.noise * random.normal());
                if quantum > 0.0 {
                    *value = (*value / quantum).round() * quantum;
                }
            }
        }
        let mut row = 1;
        let mut next = || 3 + (-random.uniform().ln() / self.dropouts) as usize;
        if self.dropouts > 0.0 {
            row += next();
            while row + 2 < time.len() {
                for column in &mut columns {
                    column[row] = 0.0;
                }
                row += next();
            }
        }
        let [displacement, force] = columns;
        Record::new(time, Some(displacement), force).expect("a record of finite numbers")
    }
}

/// A number between two others, drawn evenly on a logarithmic scale.
pub fn log_uniform(low: f64, high: f64, random: &mut Rng) -> f64 {
    (low.ln() + (high / low).ln() * random.uniform()).exp()
}

/// The limit of Cramér and Rao for where a ramp meets a level, samples: both are lines with noise `unsure`, the ramp takes
/// `ramp` samples for `travel`, the level has `hold` samples. No sample in the ramp: no doubt.
pub fn kink_limit(travel: f64, ramp: f64, hold: f64, unsure: f64) -> f64 {
    if ramp < 2.0 { 0.0 } else { unsure * ramp / travel.abs() * (4.0 / ramp + 4.0 / hold).sqrt() }
}
