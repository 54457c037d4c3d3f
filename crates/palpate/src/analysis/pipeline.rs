//! The order of the steps.

use super::across::{Across, across};
use super::hold::{HoldAnalysis, analyze_hold};
use super::modulus::{ModulusSource, implied_modulus};
use super::overlay::{Overlay, overlay};
use super::{AnalysisOptions, Finding};
use crate::contact::{Specimen, SpecimenError};
use crate::record::Record;
use crate::segment::{ContactPoint, SegmentError, Segmentation, find_contact, find_phases};

/// The study of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// The record after repair and tare.
    pub record: Record,
    /// What was asked.
    pub options: AnalysisOptions,
    /// Phases and the thresholds that found them.
    pub segmentation: Segmentation,
    /// First touch and what was subtracted.
    pub contact: ContactPoint,
    /// The body with its modulus, where the geometry is known.
    pub specimen: Option<Specimen>,
    /// Where the modulus comes from.
    pub modulus_source: Option<ModulusSource>,
    /// Every hold.
    pub holds: Vec<HoldAnalysis>,
    /// What the holds say together.
    pub across: Across,
    /// The record simulated with the fitted numbers.
    pub overlay: Option<Overlay>,
    /// What to know about the record as a whole.
    pub findings: Vec<Finding>,
}

/// Why a record could not be analysed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// No phases.
    #[error(transparent)]
    Segment(#[from] SegmentError),
    /// Numbers that make no specimen.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// Holds were found, but none can be fitted.
    #[error("none of the {holds} holds can be fitted: {reason}")]
    NothingToFit {
        /// Holds found.
        holds: usize,
        /// What the first of them lacks.
        reason: String,
    },
}

impl AnalysisError {
    /// What would help.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Segment(error) => error.hint().to_owned(),
            Self::Specimen(_) => "check the geometry in the test description and its units".to_owned(),
            Self::NothingToFit { .. } => {
                "hold longer or sample faster; `palpate inspect` shows the phases that were found".to_owned()
            }
        }
    }
}

/// Analyses a record: phases, first touch, strains, laws per hold and over holds, overlay.
///
/// # Errors
/// [`AnalysisError`] when the record has no hold, the geometry makes no specimen, or no hold has anything to fit.
pub fn analyze(record: &Record, options: &AnalysisOptions) -> Result<Analysis, AnalysisError> {
    let mut findings = Vec::new();
    let (record, dropouts) = record.repaired();
    if dropouts > 0 {
        findings.push(Finding::DropoutsRepaired { count: dropouts });
    }
    let segmentation = find_phases(&record, &options.segment)?;
    if !segmentation.settings.from_displacement {
        findings.push(Finding::PhasesFromForce);
    }
    let shape = options.geometry.map(|geometry| geometry.shape);
    let contact = find_contact(&record, &segmentation, shape, options.touch);
    if contact.air_travel > 0.0 {
        findings.push(Finding::AirTravel {
            travel: contact.air_travel,
        });
    }
    let record = record.tared(contact.tare);
    let (specimen, modulus_source) = specimen(&record, &segmentation, options, &mut findings)?;
    let holds: Vec<HoldAnalysis> = segmentation
        .holds()
        .enumerate()
        .map(|(index, segment)| analyze_hold(&record, segment, index + 1, specimen.as_ref(), options))
        .collect();
    nothing_to_fit(&holds)?;
    let across = across(&holds, &options.exponents, 4.0 * segmentation.settings.tolerance);
    let overlay = specimen.and_then(|specimen| {
        let result = overlay(&record, &segmentation, &specimen, &holds, across.common_exponent, options);
        result.map_err(|reason| findings.push(Finding::NoOverlay { reason })).ok()
    });
    Ok(Analysis {
        record,
        options: options.clone(),
        segmentation,
        contact,
        specimen,
        modulus_source,
        holds,
        across,
        overlay,
        findings,
    })
}

/// The specimen with its given modulus, or with the one that the relaxed forces imply.
fn specimen(
    record: &Record,
    segmentation: &Segmentation,
    options: &AnalysisOptions,
    findings: &mut Vec<Finding>,
) -> Result<(Option<Specimen>, Option<ModulusSource>), SpecimenError> {
    let Some(geometry) = options.geometry.filter(|_| record.displacement().is_some()) else {
        return Ok((None, None));
    };
    let implied = implied_modulus(record, segmentation, &geometry, options);
    match (geometry.modulus, implied) {
        (Some(given), implied) => {
            let specimen = Specimen::new(geometry.shape, given, geometry.sides)?;
            if let Some(implied) = implied.filter(|implied| !(0.8..=1.25).contains(&(implied / given))) {
                findings.push(Finding::ModulusMismatch { given, implied });
            }
            Ok((Some(specimen), Some(ModulusSource::Given)))
        }
        (None, Some(modulus)) => {
            findings.push(Finding::ModulusEstimated { modulus });
            let specimen = Specimen::new(geometry.shape, modulus, geometry.sides)?;
            Ok((Some(specimen), Some(ModulusSource::Estimated)))
        }
        // Validates the geometry even where no modulus can be told.
        (None, None) => Specimen::new(geometry.shape, 1.0, geometry.sides).map(|_| (None, None)),
    }
}

/// An error unless some hold was fitted or is honestly at rest.
fn nothing_to_fit(holds: &[HoldAnalysis]) -> Result<(), AnalysisError> {
    let fitted = holds.iter().any(|hold| !hold.fits.is_empty());
    let reason = holds.iter().flat_map(|hold| hold.findings.last()).next();
    match reason {
        Some(reason) if !fitted => Err(AnalysisError::NothingToFit {
            holds: holds.len(),
            reason: reason.seen(),
        }),
        _ => Ok(()),
    }
}
