//! How noisy a signal is, found out as it comes.

use crate::observe::kept::kept;

/// Readings of which one estimate is made.
const ROOM: usize = 32;
/// After how many readings the first estimates come.
const FIRST: [usize; 2] = [8, 16];

/// Standard deviation of one reading: the median distance of four readings from a parabola.
///
/// The third divided difference Σ wᵢ yᵢ has the variance σ² Σ wᵢ², whatever the speed and the acceleration, so that a jaw that slows down is no
/// noise; a median of 32 leaves out corners of the motion. Estimates of successive stretches are averaged, the last eight counting most.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct NoiseMeter {
    known: Option<f64>,
    last: [(f64, f64); 3],
    observed: usize,
    /// Squares of distances.
    room: [f64; ROOM],
    filled: usize,
    found: Option<f64>,
    /// The last step, where the reading before it was that before once more.
    step: Option<f64>,
    quantum: f64,
}
kept!(NoiseMeter: known, last, observed, room, filled, found, step, quantum; |meter| meter.filled < ROOM);

impl NoiseMeter {
    pub(in crate::observe) fn new(known: Option<f64>) -> Self {
        Self {
            known,
            quantum: f64::INFINITY,
            ..Self::default()
        }
    }

    pub(in crate::observe) fn feed(&mut self, time: f64, value: f64) {
        if self.observed >= 2 {
            let [_, (_, y0), (_, y1)] = self.last;
            if let Some(step) = self.step.filter(|_| value == y1) {
                self.quantum = self.quantum.min(step);
            }
            self.step = (y0 == y1 && value != y1).then_some((value - y1).abs());
        }
        if self.known.is_none() && self.observed >= 3 {
            let [a, b, c] = self.last;
            self.room[self.filled] = off_parabola([a, b, c, (time, value)]);
            self.filled += 1;
            if self.filled == ROOM || (self.found_early() && FIRST.contains(&self.filled)) {
                self.estimate();
            }
        }
        self.last = [self.last[1], self.last[2], (time, value)];
        self.observed = self.observed.saturating_add(1);
    }

    /// Standard deviation; `None` before the first estimate.
    pub(in crate::observe) fn deviation(&self) -> Option<f64> {
        self.known.or(self.found)
    }

    /// The smallest step between readings that stay, each for two or more: the step of its digits for a signal that has few; 0 before any.
    pub(in crate::observe) fn quantum(&self) -> f64 {
        if self.quantum.is_finite() { self.quantum } else { 0.0 }
    }

    fn found_early(&self) -> bool {
        self.observed < ROOM + 3
    }

    fn estimate(&mut self) {
        /// Median of |N(0, 1)|.
        const MEDIAN: f64 = 0.674_489_750_196_081_7;
        let mut sorted = self.room;
        let sorted = &mut sorted[..self.filled];
        sorted.sort_unstable_by(f64::total_cmp);
        let now = sorted[self.filled / 2].sqrt() / MEDIAN;
        if self.filled < ROOM {
            self.found = Some(now);
        } else {
            self.found = Some(match self.found {
                Some(before) if !self.found_early() => (0.875 * before * before + 0.125 * now * now).sqrt(),
                _ => now,
            });
            self.filled = 0;
        }
    }
}

/// Square of the distance of four readings from the parabola that fits them best, in units of that of one reading's noise.
fn off_parabola([(t0, y0), (t1, y1), (t2, y2), (t3, y3)]: [(f64, f64); 4]) -> f64 {
    // In spans of the four, so that no product of three is too small for a number.
    let span = 1.0 / (t3 - t0);
    let (b, c) = ((t1 - t0) * span, (t2 - t0) * span);
    // The weights 1/∏(tᵢ − tⱼ) times the product of all six differences; they sum to 0.
    let w = [(c - b) * (1.0 - b) * (1.0 - c), -c * (1.0 - c), b * (1.0 - b), -b * c * (c - b)];
    let off = w[0] * (y0 - y3) + w[1] * (y1 - y3) + w[2] * (y2 - y3);
    off * off / w.iter().map(|w| w * w).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    #[test]
    fn noise_on_a_ramp_with_uneven_clock_is_found() {
        let (mut meter, mut noise, mut time) = (NoiseMeter::new(None), Rng::new(1), 0.0);
        for _ in 0..1000 {
            time += 1e-3 * (0.5 + noise.uniform());
            meter.feed(time, 3.0 * time + 0.05 * noise.normal());
        }
        // the median of 32 scatters by 20 %, the mean of the last ones by a third of that
        assert!((meter.deviation().unwrap() - 0.05).abs() < 0.012, "{:?}", meter.deviation());
    }

    /// The curvature of a jaw that came to its place with a lag was noise: it stood, and was held, while it still crept in.
    #[test]
    fn a_motion_that_slows_down_is_no_noise() {
        let (mut meter, mut noise) = (NoiseMeter::new(None), Rng::new(2));
        for i in 0..50 {
            let time = 0.01 * f64::from(i);
            meter.feed(time, -1e-3 * (-time / 0.1).exp() + 2e-6 * noise.normal());
        }
        assert!((meter.deviation().unwrap() - 2e-6).abs() < 1e-6, "{:?}", meter.deviation());
    }

    #[test]
    fn rounded_readings_show_their_step() {
        let mut meter = NoiseMeter::new(None);
        for i in 0..200 {
            meter.feed(f64::from(i), (0.21 * f64::from(i)).floor() * 0.5);
        }
        assert_eq!(meter.quantum(), 0.5);
    }

    #[test]
    fn a_smooth_motion_between_two_rests_has_no_step() {
        let mut meter = NoiseMeter::new(None);
        for i in 0..300 {
            meter.feed(f64::from(i), f64::from((i - 100).clamp(0, 100)));
        }
        assert_eq!(meter.quantum(), 0.0);
    }
}
