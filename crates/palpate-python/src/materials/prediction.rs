//! What a calibrated body does, with intervals.

use palpate::calibrate::Prediction as Predicted;
use palpate_report::study::{prediction_figure, write_prediction};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::contacts::simulate::Trajectory;
use crate::errors::{PalpateError, refused_plainly, warn};
use crate::html::framed;
use crate::report_files::csv_locale as readers;
use crate::shown::shown;
use crate::table::Table;
use crate::work::{Long, at_length};

/// What a calibrated body does over time, with two intervals of the force: of its mean (what the calibration leaves open), and of one
/// reading (noise besides). Arrays of one length, and a table for polars, pandas and pyarrow; a figure in a notebook.
///
/// Made by `Material.predict`.
#[pyclass(name = "Prediction", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Prediction {
    predicted: Predicted,
}

impl Prediction {
    /// Warns of every question beyond the test.
    pub(crate) fn of(py: Python<'_>, predicted: Predicted) -> PyResult<Self> {
        for beyond in &predicted.extrapolations {
            warn(py, &format!("beyond the test: {beyond}"))?;
        }
        Ok(Self { predicted })
    }

    /// One that has been warned of.
    pub(crate) fn kept(predicted: Predicted) -> Self {
        Self { predicted }
    }

    /// Lower and upper ends of an interval at every sample; NaN where it is not known.
    fn ends(&self, of: fn(&Predicted, usize) -> Option<(f64, f64)>) -> (Vec<f64>, Vec<f64>) {
        let ends = |index| of(&self.predicted, index).unwrap_or((f64::NAN, f64::NAN));
        (0..self.predicted.trajectory.len()).map(ends).unzip()
    }
}

shown! {
    Prediction: self
    arrays {
        /// Time, s.
        time_s: self.predicted.trajectory.time.clone(),
        /// Displacement of the jaw, m.
        displacement_m: self.predicted.trajectory.displacement.clone(),
        /// Lower end of the interval of the displacement, m: the displacement itself where that is requested.
        displacement_low_m: self.ends(Predicted::displacement_interval).0,
        /// Its upper end, m.
        displacement_high_m: self.ends(Predicted::displacement_interval).1,
        /// Contact force with the best parameters, N.
        force_n: self.predicted.trajectory.force.clone(),
        /// Lower end of the interval of the mean force, N: what the parameters leave open, and what lies beyond the test; NaN where the
        /// calibration left a parameter open.
        force_low_n: self.ends(Predicted::force_interval).0,
        /// Its upper end, N.
        force_high_n: self.ends(Predicted::force_interval).1,
        /// Lower end of the interval of one reading of the force, N: parameters and noise.
        reading_low_n: self.ends(Predicted::reading_interval).0,
        /// Its upper end, N.
        reading_high_n: self.ends(Predicted::reading_interval).1,
        /// Standard error of the mean force by what the calibration leaves open and by what lies beyond the test, N; NaN where it is not known.
        force_standard_error_n: {
            let errors = self.predicted.force_standard_error.clone();
            errors.unwrap_or_else(|| vec![f64::NAN; self.predicted.trajectory.len()])
        },
    }
    values {
        /// Standard deviation of the noise of one reading, N.
        noise_n: f64 = self.predicted.noise,
        /// Coverage of the intervals.
        confidence: f64 = self.predicted.confidence,
        /// What was requested beyond the test, a sentence each.
        extrapolations: Vec<String> = self.predicted.extrapolations.iter().map(ToString::to_string).collect(),
        /// The course with the best parameters, with strains and contacts lost and regained.
        trajectory: Trajectory = Trajectory { series: self.predicted.trajectory.clone() },
    }

    fn __len__(&self) -> usize {
        self.predicted.trajectory.len()
    }

    /// All series as the CSV that ``palpate predict`` prints, for readers of this language as in `Analysis.report`.
    #[pyo3(signature = (*, csv_locale=None))]
    fn to_csv(&self, py: Python<'_>, csv_locale: Option<&str>) -> PyResult<String> {
        let locale = readers(csv_locale)?;
        Long::text(py, |out| write_prediction(out, &self.predicted, locale))
    }

    /// All series as a table.
    pub(crate) fn to_arrow(&self) -> PyResult<Table> {
        Table::of(self.columns())
    }

    fn __repr__(&self) -> String {
        let (samples, beyond) = (self.predicted.trajectory.len(), self.predicted.extrapolations.len());
        format!("<palpate.Prediction of {samples} samples, {beyond} extrapolations>")
    }

    /// Force with its bands over time, for notebooks.
    fn _repr_html_(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        let drawn = at_length(py, move |_| {
            let caption = "What the body does, by its calibrated law.";
            prediction_figure(&slf.get().predicted, "prediction", caption).to_svg()
        })?;
        Ok(framed(&drawn.map_err(refused_plainly::<PalpateError>)?))
    }
}
