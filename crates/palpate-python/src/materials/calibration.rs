//! One set of parameters for a whole record.

use palpate_jobs::input::Measurement;
use palpate_jobs::{Calibrate, Results};
use palpate_report::document::{CalibratedLawDocument, CalibrationDocument};
use palpate_report::result::ParameterRow;
use palpate_report::study::calibration_page;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::{PalpateError, in_keywords, refused_plainly, warn_of};
use crate::finding::Finding;
use crate::html::framed;
use crate::materials::material::{Material, as_toml};
use crate::shown::shown;
use crate::table::{Column, Table, budget_columns, columns, parameter_columns};
use crate::work::{job, plain, printed};

/// One set of parameters for a whole record, ramps and holds alike: a material, the residuals of its law, and its alternatives.
///
/// Made by `Record.calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does; series are tables for polars, pandas and
/// pyarrow, and a notebook shows tables and figure.
#[pyclass(name = "Calibration", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
pub(crate) struct Calibration {
    document: CalibrationDocument,
    text: String,
    page: String,
    sentence: Option<String>,
    samples: Vec<Sample>,
    #[serde(with = "as_toml")]
    material: Material,
}

/// Measured and simulated force; the first samples were fitted, the rest was held out.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Sample {
    time: f64,
    displacement: f64,
    force: f64,
    simulated: f64,
}

impl Calibration {
    /// Calibrates laws on a record, and warns where the one that is requested leaves a parameter open.
    pub(crate) fn of(py: Python<'_>, measured: Measurement, options: Calibrate) -> PyResult<Self> {
        let done = job(py, move |watch| options.run(measured, watch))?.result;
        let (record, file) = (&done.record, done.material());
        let Some((chosen, file)) = record.chosen().zip(file) else {
            return Err(refused_plainly::<PalpateError>("no law was calibrated"));
        };
        let (times, data) = (record.data.times(), &record.data);
        warn_of(py, data.findings())?;
        let sample = |(index, time): (usize, &f64)| Sample {
            time: *time,
            displacement: data.motion().displacement_at(*time),
            force: data.forces()[index],
            simulated: chosen.simulated[index],
        };
        Ok(Self {
            document: done.document(),
            text: done.text(),
            page: calibration_page(record).map_err(refused_plainly::<PalpateError>)?.to_html(),
            sentence: record.sentence(),
            samples: times.iter().enumerate().map(sample).collect(),
            material: Material::of(py, file)?,
        })
    }

    /// The law that was requested.
    fn requested(&self) -> &CalibratedLawDocument {
        // There is one: without it there is no calibration.
        &self.document.laws[0]
    }

    fn series(&self, of: impl Fn(&Sample) -> f64) -> Vec<f64> {
        self.samples.iter().map(of).collect()
    }
}

shown! {
    Calibration: self
    arrays {
        /// Time of every sample, s, on the clock of the record.
        time_s: self.series(|sample| sample.time),
        /// Displacement of the jaw since first touch, m, as it was simulated.
        displacement_m: self.series(|sample| sample.displacement),
        /// Measured force, N.
        force_n: self.series(|sample| sample.force),
        /// Force by the law, N.
        simulated_n: self.series(|sample| sample.simulated),
        /// Measured less simulated force, N.
        residual_n: self.series(|sample| sample.force - sample.simulated),
    }
    values {
        /// The body with the parameters of the law that was requested.
        material: Material = self.material.clone(),
        /// Which law predicts best, or has the lowest BIC, in a sentence; None without alternatives.
        sentence: Option<&str> = self.sentence.as_deref(),
        /// What the parameters alone do not tell, in sentences.
        remarks: Vec<String> = self.document.remarks.iter().map(|text| in_keywords(text)).collect(),
        /// What to know of the record besides the parameters.
        findings: Vec<Finding> = self.document.findings.iter().map(|found| Finding::of(found, None)).collect(),
        /// Why the search ended: "converged", or what kept it from that.
        termination: &str = self.requested().termination.as_deref().unwrap_or_default(),
        /// Whether it ended at an optimum inside the range that was searched.
        is_good: bool = self.termination() == "converged",
        /// Root mean square residual over the fitted samples, N.
        rmse_n: f64 = self.requested().rmse_n.unwrap_or(f64::NAN),
        /// How many samples, from the first on, were fitted; the rest was held out.
        fitted: usize = self.document.fitted,
        /// The laws, a row each, the one that was requested first: ``free_parameters``, root mean square residual ``rmse_n``, the same as a
        /// share of the largest force (``relative``), BIC less the lowest (``delta_bic``), with ``fit_until_s`` the errors of what was
        /// predicted, ``termination``, and why there is no calibration (``error``).
        laws: PyResult<Table> = {
            let laws = &self.document.laws;
            let mut columns = columns!(laws, law => law, free_parameters, rmse_n, relative, delta_bic);
            if laws.iter().any(|law| law.holdout.is_some()) {
                columns.extend(columns!(laws, law =>
                    holdout_rmse_n = law.holdout.as_ref().map(|holdout| holdout.rmse_n),
                    holdout_relative = law.holdout.as_ref().map(|holdout| holdout.relative),
                    holdout_samples = law.holdout.as_ref().map(|holdout| holdout.samples)
                ));
            }
            columns.extend(columns!(laws, law => termination, error));
            Table::of(columns)
        },
        /// The parameters of the law that was requested, with the columns of `Analysis.parameter_table` and, where profiles were requested,
        /// ``profile_low`` and ``profile_high``, 0 and inf where the record leaves
        /// them open: no parameter is below 0.
        parameter_table: PyResult<Table> = {
            let parameters = &self.requested().parameters;
            let rows: Vec<ParameterRow> =
                self.document.parameter_rows().into_iter().filter(|row| row.is_recommended).collect();
            let mut columns = parameter_columns(&rows);
            if parameters.iter().any(|parameter| parameter.profile.is_some()) {
                columns.extend(columns!(parameters, parameter =>
                    profile_low = parameter.profile.as_ref().map(|profile| profile.low.unwrap_or(0.0)),
                    profile_high = parameter.profile.as_ref().map(|profile| profile.high.unwrap_or(f64::INFINITY))
                ));
            }
            Table::of(columns)
        },
        /// Uncertainty budgets (JCGM 100) of the parameters of the law that was requested, with the columns of `Analysis.budgets`.
        budgets: PyResult<Table> = Table::of(budget_columns(&self.requested().budgets)),
    }

    fn __len__(&self) -> usize {
        self.samples.len()
    }

    /// Columns ``time_s``, ``displacement_m``, ``force_n``, ``simulated_n``, ``residual_n`` and ``is_fitted`` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let mut columns = self.columns();
        columns.push(("is_fitted", Column::column((0..self.samples.len()).map(|index| index < self.fitted()))));
        Table::of(columns)
    }

    /// The document that ``palpate calibrate --format json`` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.document)
    }

    /// Tables of the laws and of the parameters, and remarks, as text.
    fn report(&self) -> &str {
        &self.text
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        let (title, law) = (&self.document.input.title, self.material.law());
        format!("<palpate.Calibration of {title:?}: {law}; {}>", self.termination())
    }

    /// Tables and figure, for notebooks.
    fn _repr_html_(&self) -> String {
        framed(&self.page)
    }
}
