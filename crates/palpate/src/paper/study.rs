//! One test of the paper: simulated, and analysed as if it had been measured.

use crate::analysis::{Analysis, AnalysisOptions, Geometry, HoldAnalysis, LayersChoice, analyze_watched};
use crate::record::Record;
use crate::segment::ContactChoice;
use crate::simulate::{
    ContactModel, Motion, Sampling, Separation, StrainWave, Trajectory, WAVE_TOLERANCE, simulate_watched,
    strain_wave_within,
};
use crate::watch::Watch;

use super::PaperError;

/// Samples a second of the simulated records.
const SAMPLE_RATE: f64 = 100.0;
/// Samples a second of the strain wave.
const WAVE_RATE: f64 = 10.0;

/// One test of the paper, simulated and analysed.
#[derive(Debug, Clone)]
pub struct ReproducedTest {
    /// Bonded contact, as in the paper.
    pub bonded: Trajectory,
    /// The jaw can leave the ball.
    pub unilateral: Trajectory,
    /// All layers (bonded).
    pub wave: StrainWave,
    /// The bonded record analysed as if it had been measured.
    pub analysis: Analysis,
}

impl ReproducedTest {
    pub(super) fn new(motion: &Motion, model: &ContactModel, watch: &mut dyn Watch) -> Result<Self, PaperError> {
        let sampling = Sampling::Rate(SAMPLE_RATE);
        let free = ContactModel {
            separation: Separation::Unilateral,
            ..model.clone()
        };
        let bonded = simulate_watched(motion, model, &sampling, watch)?;
        let record = Record::new(bonded.time.clone(), Some(bonded.displacement.clone()), bonded.force.clone())?;
        let options = AnalysisOptions {
            geometry: Some(Geometry {
                shape: model.specimen.shape().clone(),
                sides: model.specimen.sides(),
                modulus: Some(model.specimen.modulus()),
                equilibrium: model.specimen.equilibrium().clone(),
            }),
            touch: ContactChoice::AsRecorded,
            separation: Separation::Bonded,
            layers: Some(LayersChoice::Count(model.layers.count())),
            exponents: vec![1.0, 3.0, 5.0, 7.0],
            compare: None,
            ..AnalysisOptions::default()
        };
        Ok(Self {
            analysis: analyze_watched(&record, &options, watch)?,
            unilateral: simulate_watched(motion, &free, &sampling, watch)?,
            wave: strain_wave_within(motion, model, &Sampling::Rate(WAVE_RATE), WAVE_TOLERANCE, watch)?,
            bonded,
        })
    }

    /// Holds with a contact: the last one, at first touch, has none.
    pub fn loaded(&self) -> impl Iterator<Item = &HoldAnalysis> {
        loaded(&self.analysis)
    }
}

/// Displacement above which a hold has a contact, m.
const TOUCH: f64 = 1e-4;

/// The holds of a record with a contact.
pub(super) fn loaded(analysis: &Analysis) -> impl Iterator<Item = &HoldAnalysis> {
    analysis.holds.iter().filter(|hold| hold.displacement.is_none_or(|d| d > TOUCH))
}
