//! Why a record could not be analysed.

use crate::contact::SpecimenError;
use crate::record::RecordError;
use crate::segment::SegmentError;
use crate::watch::Cancelled;

/// Why a record could not be analysed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// The watch ended the work.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No phases.
    #[error(transparent)]
    Segment(#[from] SegmentError),
    /// A correction that cannot be made.
    #[error(transparent)]
    Correction(#[from] RecordError),
    /// An invalid specimen.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// The jaw goes further than the body is deep.
    #[error(
        "sample {sample} (t = {time} s) is {:.4} mm beyond first touch; the limit of the {limit_name} is {:.4} mm", 1e3 * found, 1e3 * limit
    )]
    BeyondBody {
        /// Number of the sample, from 1.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// Travel of the jaw since first touch there, m.
        found: f64,
        /// Travel at which the contact would reach the plane that does not move, m.
        limit: f64,
        /// What limits it.
        limit_name: &'static str,
    },
    /// A first touch that the jaw does not reach.
    #[error("first touch is given at {:.4} mm; the largest displacement of the jaw is {:.4} mm", 1e3 * requested, 1e3 * farthest)]
    TouchBeyond {
        /// What was given, m.
        requested: f64,
        /// The largest displacement of the record, m.
        farthest: f64,
    },
    /// Holds were found, but none can be fitted.
    #[error("{}: {reason}", none_of(*holds))]
    NothingToFit {
        /// Holds found.
        holds: usize,
        /// What they lack.
        reason: String,
        /// What helps against that.
        hint: &'static str,
    },
}

impl AnalysisError {
    /// A remedy; options stand between `⟨` and `⟩`, for each interface to spell.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Cancelled(_) => String::new(),
            Self::Segment(error) => error.hint().to_owned(),
            Self::Correction(error) => error.hint().to_owned(),
            Self::Specimen(_) => "check the geometry in the test description and its units".to_owned(),
            Self::BeyondBody { .. } => {
                "check the unit of the displacement, the size of the body and squeezed_from; first touch may lie behind a way through air (touch in \
                 the test description sets it, baseline corrects a force that drifts in air); a body pulled in grips needs separation = false"
                    .to_owned()
            }
            Self::TouchBeyond { .. } => {
                "compression is positive, measured from the zero of the column; omit touch to have it estimated".to_owned()
            }
            Self::NothingToFit { hint, .. } => (*hint).to_owned(),
        }
    }
}

fn none_of(holds: usize) -> String {
    match holds {
        1 => "the detected hold cannot be fitted".to_owned(),
        _ => format!("none of the {holds} holds can be fitted"),
    }
}
