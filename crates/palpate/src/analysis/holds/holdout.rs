//! How well a fit to the first part of a record predicts the rest.

use serde::{Deserialize, Serialize};

/// Error of a fit over samples that it was not fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HoldoutError {
    /// Root mean square of measured less predicted, in the unit of the signal.
    pub rmse: f64,
    /// The same as a share of the drop of the signal over the whole hold, or of the largest force of the whole record.
    pub relative: f64,
    /// Samples that were held out.
    pub samples: usize,
}
