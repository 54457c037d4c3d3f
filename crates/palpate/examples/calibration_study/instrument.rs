//! A machine that records the paper's ball.

use palpate::analysis::{AnalysisOptions, Geometry};
use palpate::calibrate::CalibrationData;
use palpate::record::Record;
use palpate::simulate::{ContactModel, Motion, Separation, simulate_force};
use palpate::test_problems::{Rng, paper_ball};

/// Noise of the force.
#[derive(Clone, Copy)]
pub(crate) enum Force {
    White,
    /// AR(1) of this correlation.
    #[allow(dead_code, reason = "of one study alone")]
    Autoregressive(f64),
}

/// What it measures with.
#[derive(Clone, Copy)]
pub(crate) struct Instrument {
    pub(crate) rate_hz: f64,
    /// Standard deviations of the noise, N and m.
    pub(crate) force_noise: f64,
    pub(crate) displacement_noise: f64,
    pub(crate) force: Force,
}

impl Default for Instrument {
    /// The paper's, at 20 Hz.
    fn default() -> Self {
        Self {
            rate_hz: 20.0,
            force_noise: 0.2,
            displacement_noise: 1e-6,
            force: Force::White,
        }
    }
}

impl Instrument {
    /// A record of the paper's ball under the motion, cut and prepared as that of a machine is.
    #[allow(dead_code, reason = "of some studies alone")]
    pub(crate) fn record(&self, motion: &Motion, seed: u64) -> CalibrationData {
        self.record_of(&paper_ball(Separation::Unilateral), motion, seed)
    }

    /// The same of another body.
    pub(crate) fn record_of(&self, model: &ContactModel, motion: &Motion, seed: u64) -> CalibrationData {
        let mut random = Rng::new(seed + 1);
        let count = (motion.end() * self.rate_hz) as u32;
        let time: Vec<f64> = (0..=count).map(|i| f64::from(i) / self.rate_hz).collect();
        let force = simulate_force(motion, model, &time).expect("a simulation");
        let mut state = random.normal();
        let mut noise = || match self.force {
            Force::White => random.normal(),
            Force::Autoregressive(rho) => {
                state = rho * state + (1.0 - rho * rho).sqrt() * random.normal();
                state
            }
        };
        let force = force.iter().map(|force| force + self.force_noise * noise()).collect();
        let place = |t: &f64| motion.displacement_at(*t) + self.displacement_noise * random.normal();
        let displacement = time.iter().map(place).collect();
        let record = Record::new(time, Some(displacement), force).expect("a record");
        let options = AnalysisOptions {
            geometry: Some(Geometry {
                shape: model.specimen.shape().clone(),
                sides: model.specimen.sides(),
                modulus: None,
                equilibrium: model.specimen.equilibrium().clone(),
            }),
            ..AnalysisOptions::default()
        };
        CalibrationData::of_record(&record, &options).expect("data")
    }
}
