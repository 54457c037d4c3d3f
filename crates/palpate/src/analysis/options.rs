//! Options of an analysis.

use serde::{Deserialize, Serialize};

use super::Conditions;
use crate::contact::{Equilibrium, Layers, LayersError, Shape, Sides, Specimen, SpecimenError};
use crate::fit::{ExponentChoice, FitOptions};
use crate::forecast::CompareOptions;
use crate::instrument::Instrument;
use crate::record::CorrectionOptions;
use crate::segment::{ContactChoice, GivenHold, SegmentOptions};
use crate::simulate::Separation;
use crate::strain::RateWindow;

/// The body as far as it is known; SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// Shape.
    pub shape: Shape,
    /// From how many sides it is squeezed.
    pub sides: Sides,
    /// Young's modulus, Pa; estimated from the equilibrium forces if it is not known.
    pub modulus: Option<f64>,
    /// Law of the equilibrium force, by which force and displacement give modulus and strain.
    #[serde(default)]
    pub equilibrium: Equilibrium,
}

impl Geometry {
    /// The body with this Young's modulus (Pa).
    ///
    /// # Errors
    /// [`SpecimenError`] for a shape that is none, or a law of the equilibrium force that does not go with it.
    pub fn specimen(&self, modulus: f64) -> Result<Specimen, SpecimenError> {
        let body = Specimen::new(self.shape.clone(), modulus, self.sides)?;
        Ok(body.with_equilibrium(self.equilibrium.clone())?)
    }

    /// The same with another shape.
    pub(crate) fn with_shape(&self, shape: Shape) -> Self {
        Self { shape, ..self.clone() }
    }
}

/// Layers of the simulation that is laid over the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayersChoice {
    /// m.
    Count(f64),
    /// ℓ in m.
    Thickness(f64),
}

impl LayersChoice {
    /// The layers of a body of this depth (m).
    ///
    /// # Errors
    /// [`LayersError`] for fewer than one layer, or a thickness that does not fit into the body.
    pub fn layers(self, depth: f64) -> Result<Layers, LayersError> {
        match self {
            Self::Count(count) => Layers::new(count),
            Self::Thickness(thickness) => Layers::of_thickness(thickness, depth),
        }
    }
}

/// Options of [`analyze`](super::analyze).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AnalysisOptions {
    /// The body; without it the force is fitted as it is.
    pub geometry: Option<Geometry>,
    /// How phases are found.
    pub segment: SegmentOptions,
    /// Uncertainty of the instrument and of the body; what is not among it counts as exact.
    pub instrument: Instrument,
    /// Corrections of the record that are made only on request.
    pub corrections: CorrectionOptions,
    /// Holds with given limits; where there are any, no others are sought.
    pub given_holds: Vec<GivenHold>,
    /// The conditions of the test, and the times at which its relaxation is stated.
    pub conditions: Conditions,
    /// Method for first touch; as recorded by default, since a strip in grips has no first touch.
    pub touch: ContactChoice,
    /// Whether the jaw can pull (for the overlay).
    pub separation: Separation,
    /// Whether a body of constant section is squeezed even where the jaw can pull: it cannot go further than the body is long.
    pub squeezed: bool,
    /// Layers of the overlay; fitted to the ramps if not given.
    pub layers: Option<LayersChoice>,
    /// Exponents that are fitted as given; a list of two or more is extended while its last or first has the lowest criterion.
    pub exponents: Vec<f64>,
    /// Whether n is also estimated.
    pub free_exponent: bool,
    /// Options of every fit.
    pub fit: FitOptions,
    /// Fit only this long from the start of the fit, s, and predict the rest of the hold.
    pub fit_until: Option<f64>,
    /// Laws to compare on every hold; `None` omits the comparison.
    pub compare: Option<CompareOptions>,
    /// Window of the strain rates.
    pub rate_window: RateWindow,
    /// Largest number of fitted samples of a hold; more are thinned evenly, and a finding reports it.
    pub most_samples: usize,
}

impl AnalysisOptions {
    /// The listed exponents, then the free one.
    pub(super) fn choices(&self) -> impl Iterator<Item = ExponentChoice> {
        let listed = self.exponents.iter().map(|n| ExponentChoice::Fixed(*n));
        listed.chain(self.free_exponent.then_some(ExponentChoice::Free))
    }

    /// How many samples of a hold are fitted, of which these are the times since its start, s.
    pub(super) fn fitted(&self, times: &[f64]) -> usize {
        self.fit_until.map_or(times.len(), |until| times.partition_point(|t| *t <= until))
    }
}

impl Default for AnalysisOptions {
    fn default() -> Self {
        Self {
            geometry: None,
            segment: SegmentOptions::default(),
            instrument: Instrument::default(),
            corrections: CorrectionOptions::default(),
            given_holds: Vec::new(),
            conditions: Conditions::default(),
            touch: ContactChoice::AsRecorded,
            separation: Separation::default(),
            squeezed: false,
            layers: None,
            exponents: vec![1.0, 2.0, 3.0, 5.0, 7.0],
            free_exponent: true,
            fit: FitOptions::default(),
            fit_until: None,
            compare: Some(CompareOptions::default()),
            rate_window: RateWindow::default(),
            most_samples: 1_000_000,
        }
    }
}
