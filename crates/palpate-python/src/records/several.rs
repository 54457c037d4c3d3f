//! One calibration of several records.

use palpate::calibrate::Sharing;
use palpate_files::description::MaterialFile;
use palpate_jobs::input::Measurement;
use palpate_jobs::{CalibrateSeveral, Results};
use palpate_report::document::{SeveralCalibrationsDocument, SpecimenDocument};
use palpate_report::study::batch_page;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::{OptionError, PalpateError, choice, refused_plainly, warn};
use crate::files::law;
use crate::html::framed;
use crate::listed::Listed;
use crate::materials::material::Material;
use crate::records::record::Record;
use crate::shown::shown;
use crate::table::{Table, columns, end};
use crate::work::{job, plain, printed};

/// Several records of one body or one batch in one calibration: shared and own parameters, and the spread between specimens.
///
/// Made by `calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does of several records.
#[pyclass(name = "SeveralCalibrations", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
pub(crate) struct SeveralCalibrations {
    document: SeveralCalibrationsDocument,
    text: String,
    page: String,
    /// Materials as their files.
    specimen: Option<String>,
    materials: Vec<String>,
}

/// Calibrate several records of one body or of one batch together.
///
/// Parameters
/// ----------
/// records : sequence of Record
///     Two or more, each with time, displacement and force.
/// shared
///     "none", "all", or the names of the parameters that have one value for all records, with their unit or without, such as
///     ``["exponent", "rate_coefficient"]``. The others are each record's own.
/// law, equilibrium, poisson_ratio, rate, confidence
///     As for `Record.calibrate`; a table of equilibrium forces is for a single record.
/// test
///     Description of all records; if left out, each is described as it was read.
///
/// Returns
/// -------
/// SeveralCalibrations
///     Parameters, spreads, the material of each record, and that of another specimen of the batch.
///
/// Raises
/// ------
/// OptionError
///     Fewer than two records, a law or a shared name that is none.
/// RecordError
///     One record twice, or one without displacement.
/// FitError
///     Records that do not determine the parameters; the message names record and parameters.
#[pyfunction]
#[pyo3(signature = (records, *, shared=None, law="latency", test=None, equilibrium=None, poisson_ratio=None, rate="constant", confidence=None))]
#[expect(
    clippy::needless_pass_by_value,
    clippy::too_many_arguments,
    reason = "arguments of Python"
)]
pub(crate) fn calibrate(
    py: Python<'_>,
    records: Listed<PyRef<'_, Record>>,
    shared: Option<&Bound<'_, PyAny>>,
    law: &str,
    test: Option<&Bound<'_, PyAny>>,
    equilibrium: Option<&str>,
    poisson_ratio: Option<f64>,
    rate: &str,
    confidence: Option<f64>,
) -> PyResult<SeveralCalibrations> {
    let options = CalibrateSeveral {
        law: self::law(law)?,
        shared: sharing(shared)?,
        equilibrium: equilibrium
            .map(|name| choice("equilibrium", &["uniform-strain", "hertz", "table"], name))
            .transpose()?,
        poisson_ratio,
        rate: choice("rate", &["constant", "by-strain", "by-direction"], rate)?,
        confidence,
    };
    let measured = records.iter().map(|record| record.measured(test)).collect::<PyResult<Vec<Measurement>>>()?;
    let done = job(py, move |watch| options.run(measured, watch))?.result;
    done.batch.warnings().iter().try_for_each(|text| warn(py, text))?;
    Ok(SeveralCalibrations {
        document: done.document(),
        text: done.text(),
        page: batch_page(&done.batch).map_err(refused_plainly::<PalpateError>)?.to_html(),
        specimen: done.material().map(|file| file.to_toml()),
        materials: done.materials().iter().map(MaterialFile::to_toml).collect(),
    })
}

/// Which parameters are shared: a word or a list of names.
fn sharing(shared: Option<&Bound<'_, PyAny>>) -> PyResult<Sharing> {
    let Some(shared) = shared else {
        return Ok(Sharing::None);
    };
    if let Ok(text) = shared.extract::<String>() {
        return Ok(text.into());
    }
    let names = shared.extract::<Vec<String>>().map_err(|_| {
        refused_plainly::<OptionError>(format!(
            "shared: expected \"none\", \"all\" or a list of parameters, found {shared:?}"
        ))
    })?;
    Ok(if names.is_empty() { Sharing::None } else { Sharing::Named(names) })
}

/// The own or shared value of a parameter in a record.
fn value_of(specimen: &SpecimenDocument, name: &str) -> Option<f64> {
    specimen.parameters.iter().find(|parameter| parameter.name == name)?.parameter.value
}

shown! {
    SeveralCalibrations: self
    values {
        /// A specimen of the batch that was not tested, whose intervals contain the spread between specimens; the body itself where all
        /// parameters are shared. None for own parameters of two records.
        specimen: PyResult<Option<Material>> = self.specimen.as_deref().map(Material::parsed).transpose(),
        /// The material of each record.
        materials: PyResult<Vec<Material>> = self.materials.iter().map(|text| Material::parsed(text)).collect(),
        /// The parameters of the batch, a row each: ``parameter``, ``unit``, ``between`` ("shared", "own" or "given"), ``value`` (of own ones the
        /// geometric mean), ``standard_error``, ``low``, ``high``, infinite where an end is open; of own ones the standard
        /// deviation of the logarithm between specimens, ``spread``, ``spread_low``, ``spread_high``; of shared ones ``one_value_p``, the
        /// probability that records of one value differ as much as these do when calibrated alone.
        parameter_table: PyResult<Table> = {
            Table::of(columns!(self.document.parameters, parameter =>
                parameter = parameter.name.clone(), unit = parameter.parameter.unit.clone(),
                between = parameter.between.clone(), value = parameter.parameter.value,
                standard_error = parameter.parameter.standard_error,
                low = end(parameter.parameter.interval, 0), high = end(parameter.parameter.interval, 1),
                spread = parameter.spread.as_ref().map(|spread| spread.deviation),
                spread_low = parameter.spread.as_ref().map(|spread| spread.low),
                spread_high = parameter.spread.as_ref().map(|spread| spread.high),
                one_value_p = parameter.one_value_p
            ))
        },
        /// The records, a row each: ``record``, ``rmse_n``, ``rmse_alone_n``, ``relative``, and a column for each parameter.
        record_table: PyResult<Table> = {
            let specimens = &self.document.specimens;
            let mut columns = columns!(specimens, specimen =>
                record = specimen.input.called(), rmse_n = specimen.rmse_n, rmse_alone_n = specimen.rmse_alone_n,
                relative = specimen.relative
            );
            for parameter in &self.document.parameters {
                let values = specimens.iter().map(|specimen| value_of(specimen, &parameter.name));
                columns.push((parameter.name.as_str(), crate::table::Column::column(values)));
            }
            Table::of(columns)
        },
        /// What the parameters alone do not tell, in sentences.
        remarks: Vec<String> = self.document.remarks.clone(),
    }

    fn __len__(&self) -> usize {
        self.document.specimens.len()
    }

    /// The document that ``palpate calibrate --format json`` prints of several records, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.document)
    }

    /// Tables of parameters and records, and remarks, as text.
    fn report(&self) -> &str {
        &self.text
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        let (count, law) = (self.document.specimens.len(), &self.document.law);
        format!("<palpate.SeveralCalibrations of {count} records: {law}; shared: {}>", self.document.shared)
    }

    /// Tables and figure, for notebooks.
    fn _repr_html_(&self) -> String {
        framed(&self.page)
    }
}
