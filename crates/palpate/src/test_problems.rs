//! Known problems with known answers: one list for tests, benches and examples.
//!
//! The numbers were computed by two independent programs (SciPy's `DOP853` at 1e-13 and a 30-digit series solution),
//! see `validation/` in the repository; they are not read off this library.

use crate::contact::{Layers, Shape, Sides, Specimen};
pub use crate::random::Rng;

use crate::latency::{LatencyLaw, decay};
use crate::simulate::{ContactModel, Motion, ProtocolStep, Separation, protocol};

/// The rubber ball of the paper: radius 35 mm, modulus 28 kPa, n = 5, v = 2·10⁴ 1/s, 8 layers, both jaws.
///
/// # Panics
/// Never: the parameters are valid.
#[must_use]
#[expect(clippy::unwrap_used, reason = "constants of the paper")]
pub fn paper_ball(separation: Separation) -> ContactModel {
    ContactModel {
        specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap(),
        law: LatencyLaw::new(5.0, 2e4).unwrap(),
        layers: Layers::new(8.0).unwrap(),
        separation,
    }
}

/// Speed of the jaw in both tests of the paper, m/s: 500 mm/min.
pub const PAPER_RATE: f64 = 0.5 / 60.0;

/// Test (a) of the paper: 5, 10, 15, 20, 25 mm at 500 mm/min with holds of 10 s, then back to 0 mm (66 s in all).
#[must_use]
pub fn paper_test_a() -> Motion {
    squeeze(&[5.0, 10.0, 15.0, 20.0, 25.0])
}

/// Test (b) of the paper: 25, 20, 15, 10, 5 mm at 500 mm/min with holds of 10 s, then back to 0 mm.
#[must_use]
pub fn paper_test_b() -> Motion {
    squeeze(&[25.0, 20.0, 15.0, 10.0, 5.0])
}

#[expect(clippy::unwrap_used, reason = "constants of the paper")]
fn squeeze(levels_mm: &[f64]) -> Motion {
    let step = |to: f64, hold: f64| ProtocolStep {
        to: to / 1000.0,
        rate: PAPER_RATE,
        hold,
    };
    let mut steps: Vec<_> = levels_mm.iter().map(|&level| step(level, 10.0)).collect();
    steps.push(step(0.0, 10.0));
    protocol(&steps).unwrap()
}

/// One golden value of a simulation of the paper's ball, bonded.
#[derive(Debug, Clone, Copy)]
pub struct Golden {
    /// Time, s.
    pub time: f64,
    /// Excess strain of the contact layer.
    pub excess_strain: f64,
    /// Contact force, N.
    pub force: f64,
}

/// Golden values of test (a).
pub const PAPER_TEST_A: &[Golden] = &[
    golden(0.6, 0.133_032_479_302, 3.035_025_007_5),
    golden(10.6, 0.033_403_736_623, 1.556_133_431_7),
    golden(21.2, 0.033_403_736_638, 5.039_032_945_6),
    golden(43.0, 0.133_032_493_898, 30.991_117_046_3),
    golden(53.0, 0.033_403_736_638, 24.692_133_486_8),
];

/// Golden values of test (b).
pub const PAPER_TEST_B: &[Golden] = &[
    golden(3.0, 0.133_032_499_713, 30.991_117_413_9),
    golden(13.6, -0.133_032_428_095, 8.058_358_597_5),
    golden(55.4, -0.033_403_736_638, 0.564_441_609_2),
];

const fn golden(time: f64, excess_strain: f64, force: f64) -> Golden {
    Golden {
        time,
        excess_strain,
        force,
    }
}

/// A hold with the paper's parameters and noise: strain 0.2 + 0.13 φ(t; λ, n) over 10 s, λ = 2·10⁴ · 0.13⁴ 1/s.
///
/// `noise` is the standard deviation of the noise relative to the drop 0.13; the noise comes from a fixed sequence, so
/// that the same arguments always give the same hold. Returns times (s) and strains.
#[must_use]
pub fn noisy_hold(samples: usize, exponent: f64, noise: f64) -> (Vec<f64>, Vec<f64>) {
    let rate = 2e4 * 0.13f64.powi(4);
    let mut random = Rng::new(1);
    let times: Vec<f64> = (0..samples).map(|i| 10.0 * i as f64 / (samples - 1) as f64).collect();
    let value = |t: &f64| 0.2 + 0.13 * (decay(rate * t, exponent) + noise * random.normal());
    let values = times.iter().map(value).collect();
    (times, values)
}
