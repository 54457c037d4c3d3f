//! The study of one record.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use arrow_array::ArrayRef;
use numpy::PyArray1;
use palpate::analysis::AnalysisOptions;
use palpate::watch::{Progress, Watch};
use palpate_jobs::input::Measurement;
use palpate_jobs::output::write_bundle;
use palpate_jobs::{Analyze, Analyzed, Outcome, Results, write_reports};
use palpate_report::document::{AnalysisDocument, FitDocument, HoldDocument, StatedRelaxationDocument};
use palpate_report::result::Input;
use palpate_report::result::ParameterDocument;
use palpate_report::study::FileOptions;
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::arrays::array;
use crate::errors::{OptionError, PalpateError, refused_plainly, unwritten, warn_of};
use crate::finding::Finding;
use crate::fits::fit::PyFit;
use crate::html::framed;
use crate::listed::Listed;
use crate::pickles::{Made, Piece, Pieces, made_again, unpickled};
use crate::records::hold_fit::{Curve, HoldNumber, curves, fit_of};
use crate::records::kept::Kept;
use crate::report_files::file_options;
use crate::shown::shown;
use crate::table::{Column, Table, budget_columns, columns, parameter_columns};
use crate::work::{at_length, job, plain, printed, writing, writing_job};

/// Phases, laws of every hold and findings of one record; a page with figures in a notebook.
///
/// ``print(analysis)`` shows what ``palpate analyze`` does.
///
/// What its document says is kept as that; the study behind it is made anew, from the same record and the same options, where a
/// report is requested of an analysis that came from elsewhere.
#[pyclass(name = "Analysis", module = "palpate", frozen, eq)]
pub(crate) struct Analysis {
    requested: Arc<Requested>,
    done: OnceLock<Arc<Outcome<Analyzed>>>,
    document: AnalysisDocument,
}

impl PartialEq for Analysis {
    fn eq(&self, other: &Self) -> bool {
        self.document == other.document
    }
}

/// Times (s) and force (N) of a record, and its laws.
type Course<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Vec<Curve>);

/// A record, and what was required of it.
struct Requested {
    measured: Measurement,
    job: Analyze,
}

/// What an analysis is made of again.
#[derive(Serialize, Deserialize)]
struct Parts<'a> {
    measured: Kept<'a>,
    options: AnalysisOptions,
    input: Input,
    job: Analyze,
    document: serde_json::Value,
}

impl Analysis {
    /// Analyses a record, and warns of what its numbers must not be used for.
    pub(crate) fn of(py: Python<'_>, measured: Measurement, job: Analyze) -> PyResult<Self> {
        let requested = Arc::new(Requested { measured, job });
        let done = run(py, &requested)?;
        let analysis = &done.result.analysis;
        let of_holds = analysis.holds.iter().flat_map(|hold| &hold.findings);
        let all = analysis.findings.iter().chain(of_holds);
        warn_of(py, all)?;
        Ok(Self {
            requested,
            document: done.result.document(),
            done: OnceLock::from(Arc::new(done)),
        })
    }

    /// The study behind the document, made anew for an analysis that came from elsewhere.
    fn done(&self, py: Python<'_>) -> PyResult<Arc<Outcome<Analyzed>>> {
        if let Some(done) = self.done.get() {
            return Ok(Arc::clone(done));
        }
        let done = Arc::new(run(py, &self.requested)?);
        Ok(Arc::clone(self.done.get_or_init(|| done)))
    }
}

fn run(py: Python<'_>, requested: &Arc<Requested>) -> PyResult<Outcome<Analyzed>> {
    let requested = Arc::clone(requested);
    job(py, move |watch| requested.job.run(requested.measured.clone(), None, watch))
}

/// The exponent of one of the fits of a hold.
fn exponent(hold: &HoldDocument, fit: Option<usize>) -> Option<f64> {
    hold.fits.get(fit?)?.parameters.get("exponent")?.value
}

/// The parameters of fits, a column each with its uncertainty, by the names that any of the fits has.
fn estimated(fits: &[&FitDocument]) -> Vec<(String, ArrayRef)> {
    let names: BTreeSet<&String> = fits.iter().flat_map(|fit| fit.parameters.keys()).collect();
    let column = |name: &String, end: &str, of: fn(&ParameterDocument) -> Option<f64>| {
        let values = fits.iter().map(|fit| fit.parameters.get(name).and_then(of));
        (format!("{name}{end}"), Column::column(values))
    };
    let columns = |name: &&String| {
        [
            column(name, "", |parameter| parameter.value),
            column(name, "_standard_error", |parameter| parameter.standard_error),
            column(name, "_low", |parameter| parameter.interval?[0]),
            column(name, "_high", |parameter| parameter.interval?[1]),
        ]
    };
    names.iter().flat_map(columns).collect()
}

shown! {
    Analysis: self
    getters {
        /// The phases, a row each.
        segments: PyResult<Table> =
            Table::of(columns!(self.document.segments, row => phase, start_s, end_s, first_row, last_row)),
        /// The holds, a row each; ``preferred_exponent`` is that of the lowest information criterion, ``lowest_exponent`` the lowest listed
        /// one that is not distinguishable from the best listed one.
        holds: PyResult<Table> = Table::of(columns!(self.document.holds, hold =>
            index, start_s, end_s, fit_start_s, fit_start_rule, displacement_m, after, mode, doubtful, relaxation, force_change_n,
            force_change_standard_error_n, p_value, force_start_n, force_end_n, signal,
            preferred_exponent = exponent(hold, hold.preferred), lowest_exponent = exponent(hold, hold.lowest_order)
        )),
        /// The latency law fitted to every hold, a row each: ``hold``, ``law``, ``domain``, ``exponent``, ``equilibrium``, ...,
        /// each parameter with its standard error and interval.
        fits: PyResult<Table> = {
            let holds = self.document.holds.iter();
            let (holds, fits): (Vec<usize>, Vec<&FitDocument>) =
                holds.flat_map(|hold| hold.fits.iter().map(|fit| (hold.index, fit))).unzip();
            let estimated = estimated(&fits);
            let mut columns = columns!(holds, hold => hold = *hold);
            columns.extend(columns!(fits, fit => law, domain));
            columns.extend(estimated.iter().map(|(name, column)| (name.as_str(), Arc::clone(column))));
            columns.extend(columns!(fits, fit =>
                equilibrium_force_n, excess_force_n, equilibrium_modulus_pa, equilibrium_modulus_standard_error_pa, rmse, residual_correlation, samples, delta_bic, holdout_error, termination,
                formula
            ));
            Table::of(columns)
        },
        /// Every parameter of every law on every hold, a row each: ``record``, ``part``, ``hold``, ``law``, ``parameter``, ``unit``, ``value``,
        /// ``standard_error``, ``low``, ``high``, ``termination``, ``white_standard_error``, ``role``, ``domain``, ``recommended``. An
        /// end of an interval that is open is infinite, or 0 below a parameter that is never negative, as in `Fit.estimates`; without an
        /// interval both are missing.
        parameter_table: PyResult<Table> = Table::of(parameter_columns(&self.document.parameter_rows())),
        /// Uncertainty budgets (JCGM 100) of the parameters of the law of the record, a row for each input quantity of each: ``hold``, ``law``,
        /// ``parameter``, ``unit``, ``value``, ``combined_standard_uncertainty``, ``expanded_uncertainty``, ``input``, ``input_unit``, ``evaluation``,
        /// ``distribution``, ``standard_uncertainty``, ``sensitivity``, ``contribution``, ``share``; empty where the test description has no
        /// ``[instrument]``.
        budgets: PyResult<Table> = Table::of(budget_columns(&self.document.budgets)),
        /// Conditions of the test as its description states them in ``[conditions]``: ``temperature_k``, ``relative_humidity``, ``medium``,
        /// ``conditioning``, ``specimen_form``, ``lubricant``, ``initial_force_after_s``; None is not stated.
        conditions<'py>(py): PyResult<Bound<'py, PyAny>> = plain(py, &self.document.conditions),
        /// How the displacement of each hold was applied and held, a row each: ``hold``, ``applied_in_s``, ``constraint_variation_m``,
        /// ``relative_constraint_variation``, ``initial_force_n``, ``initial_force_standard_error_n``.
        constraint: PyResult<Table> = Table::of(columns!(self.document.holds, found =>
            hold = found.index, applied_in_s = found.report.applied_in_s,
            constraint_variation_m = found.report.constraint_variation_m,
            relative_constraint_variation = found.report.relative_constraint_variation,
            initial_force_n = found.report.initial_force_n,
            initial_force_standard_error_n = found.report.initial_force_standard_error_n
        )),
        /// Force and R(t) = (F₀ − F(t))/F₀ of holds of the displacement at the stated times that were measured, a row each: ``hold``,
        /// ``time_s``, ``force_n``, ``force_standard_error_n``, ``relaxation``, ``relaxation_standard_error``, ``low``, ``high``.
        relaxation_at: PyResult<Table> = {
            let of = |hold: &HoldDocument| {
                let index = hold.index;
                hold.report.relaxation.clone().into_iter().map(move |stated| (index, stated))
            };
            let rows: Vec<(usize, StatedRelaxationDocument)> = self.document.holds.iter().flat_map(of).collect();
            Table::of(columns!(rows, row =>
                hold = row.0, time_s = row.1.time_s, force_n = row.1.force_n,
                force_standard_error_n = row.1.force_standard_error_n, relaxation = row.1.relaxation,
                relaxation_standard_error = row.1.relaxation_standard_error,
                low = row.1.relaxation_interval.map(|ends| ends[0]), high = row.1.relaxation_interval.map(|ends| ends[1])
            ))
        },
        /// Young's modulus of the first loading ramp, Pa: an apparent one of a body that relaxes; None where the geometry is not known.
        loading_modulus_pa: Option<f64> = self.document.loading_modulus.as_ref().map(|found| found.modulus_pa),
        /// Its standard error, Pa: of the residuals, and of first touch where that has one.
        loading_modulus_standard_error_pa: Option<f64> =
            self.document.loading_modulus.as_ref().map(|found| found.standard_error_pa),
        /// The law to use for the record as a whole, as ``law=`` takes it; None where none can be recommended.
        law: Option<String> = self.document.answer.law.clone(),
        /// Which law to use, in a sentence.
        sentence: String = self.document.answer.sentence.clone(),
        /// What to know besides the estimates.
        findings: Vec<Finding> = {
            let whole = self.document.findings.iter().map(|found| Finding::of(found, None));
            let of_holds = self
                .document
                .holds
                .iter()
                .flat_map(|hold| hold.findings.iter().map(|found| Finding::of(found, Some(hold.index))));
            whole.chain(of_holds).collect()
        },
    }

    /// The document that `palpate analyze --format json` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.document)
    }

    /// The table of laws, for polars, pandas and pyarrow.
    fn to_arrow(&self) -> PyResult<Table> {
        self.fits()
    }

    /// The fit of a law to one hold, with its samples: strain where the body is known, and else force (N), on the clock of the record.
    ///
    /// Parameters
    /// ----------
    /// hold : int
    ///     Number of the hold, from 1: ``index`` in `holds`.
    /// law : str, optional
    ///     One of the laws that were fitted to it, such as "latency:5"; if left out the recommended one, or without a comparison the latency
    ///     law with the preferred exponent.
    ///
    /// Returns
    /// -------
    /// Fit
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A hold that there is not, a law that was not fitted.
    /// FitError
    ///     A hold without a force that relaxes.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np, palpate
    /// >>> t = np.linspace(0.0, 60.0, 1200)
    /// >>> force = np.where(t < 10.0, 0.3 * t, 1 + 2 * np.exp(-(t - 10.0) / 8))
    /// >>> record = palpate.Record.from_arrays(time_s=t, force_n=force, displacement_m=np.minimum(t, 10.0) * 1e-3)
    /// >>> fit = record.analyze().fit(1, law="standard-linear-solid")
    /// >>> round(fit.parameters["time_constant_s"], 3)
    /// 8.0
    #[pyo3(signature = (hold=HoldNumber::FIRST, *, law=None), text_signature = "($self, hold=1, *, law=None)")]
    fn fit(&self, py: Python<'_>, hold: HoldNumber, law: Option<&str>) -> PyResult<PyFit> {
        fit_of(&self.done(py)?.result.analysis, hold, law)
    }

    /// Times and force of the record as it was analysed, and the law of every hold that has one, for figures.
    fn _course<'py>(&self, py: Python<'py>) -> PyResult<Course<'py>> {
        let done = self.done(py)?;
        let analysis = &done.result.analysis;
        let column = |values: &[f64]| array(py, values.iter().copied());
        Ok((column(analysis.record.time())?, column(analysis.record.force())?, curves(analysis)))
    }

    /// Writes report.html, analysis.json, tables and figures into a folder, all or none.
    ///
    /// Parameters
    /// ----------
    /// folder : path
    ///     Made if it is not there.
    /// figures : sequence of str
    ///     Formats of the figure files: "svg" (if left out), "png", "pdf" (with the typeface embedded).
    /// column : str, optional
    ///     "single" (85 mm) or "double" (174 mm): the figure files are as wide as a column of a journal; each has its own width if left out.
    /// holds : sequence of int, optional
    ///     Numbers of the holds that the figure files show, from 1; all if left out.
    /// csv_locale : str
    ///     Language of the readers of CSV files: "en" (if left out) has decimal points and commas between cells, "de", "es", "fr", "it", "nl",
    ///     "pl" and "pt" have decimal commas and semicolons.
    ///
    /// Returns
    /// -------
    /// Path
    ///     The report.
    ///
    /// Raises
    /// ------
    /// PalpateError
    ///     The folder cannot be written to.
    /// OptionError
    ///     A format, a width or a language that there is not.
    #[pyo3(signature = (folder, *, figures=None, column=None, holds=None, csv_locale=None))]
    fn report(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        figures: Option<Listed<String>>,
        column: Option<&str>,
        holds: Option<Listed<usize>>,
        csv_locale: Option<&str>,
    ) -> PyResult<PathBuf> {
        let options = FileOptions {
            holds: holds.map(|listed| listed.0),
            ..file_options(figures, column, csv_locale)?
        };
        let done = self.done(py)?;
        let report = folder.join("report.html");
        let bundle = at_length(py, move |mut heard| done.result.bundle(&options, &mut heard))?;
        let bundle = bundle.map_err(unwritten)?;
        let written = writing(py, move |mut heard| {
            heard.report(Progress::open("writing", 0))?;
            write_bundle(&folder, &bundle)
        })?;
        written.map_err(unwritten)?;
        Ok(report)
    }

    #[classmethod]
    #[pyo3(signature = (json, format=0))]
    fn _from_json(class: &Bound<'_, PyType>, json: Pieces, format: u32) -> PyResult<Self> {
        let Parts {
            measured,
            options,
            input,
            job,
            document,
        } = unpickled(class.py(), json, format)?;
        let measured = Measurement {
            record: measured.record()?,
            input,
            options,
            notes: Vec::new(),
            turned: Vec::new(),
        };
        let requested = Arc::new(Requested { measured, job });
        // A number that is none has no form in JSON: the document is made anew then.
        let document = match serde_json::from_value(document) {
            Ok(document) => document,
            Err(_) => run(class.py(), &requested)?.result.document(),
        };
        Ok(Self {
            requested,
            done: OnceLock::new(),
            document,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (Vec<Piece>, u32)>> {
        let Requested { measured, job } = &*self.requested;
        let parts = Parts {
            measured: Kept::of(&measured.record),
            options: measured.options.clone(),
            input: measured.input.clone(),
            job: job.clone(),
            document: serde_json::to_value(&self.document).map_err(refused_plainly::<PalpateError>)?,
        };
        made_again::<Self>(py, &parts)
    }

    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.done(py)?.result.text())
    }

    fn __repr__(&self) -> String {
        let (title, holds) = (&self.document.input.title, self.document.holds.len());
        format!("<palpate.Analysis of {title:?}: {holds} holds, {} findings>", self.findings().len())
    }

    /// Tables and figures of the report, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let done = self.done(py)?;
        let bundle = job(py, move |watch| done.result.bundle(&FileOptions::default(), watch))?;
        let report = bundle.files.into_iter().find(|(name, _)| name == "report.html");
        Ok(report.and_then(|(_, page)| String::from_utf8(page).ok()).map(|page| framed(&page)))
    }
}

/// Writes the reports of several records and an index of them: ``palpate analyze A B --out``, all or none.
///
/// The index links the reports and states mean, standard deviation and interval of each parameter between specimens.
///
/// Parameters
/// ----------
/// analyses : sequence of Analysis
///     One a record; each report lies in a folder named after its record.
/// folder : path
///     Made if it is not there.
/// figures, column, csv_locale
///     As for `Analysis.report`.
///
/// Returns
/// -------
/// Path
///     The index.
///
/// Raises
/// ------
/// OptionError
///     There is no analysis.
/// PalpateError
///     The folder cannot be written to.
#[pyfunction]
#[pyo3(signature = (analyses, folder, *, figures=None, column=None, csv_locale=None))]
pub(crate) fn report_all(
    py: Python<'_>,
    analyses: Vec<Py<Analysis>>,
    folder: PathBuf,
    figures: Option<Listed<String>>,
    column: Option<&str>,
    csv_locale: Option<&str>,
) -> PyResult<PathBuf> {
    if analyses.is_empty() {
        return Err(OptionError::new_err("analyses: expected one analysis or more, found none"));
    }
    let options = file_options(figures, column, csv_locale)?;
    let done: Vec<_> = analyses.into_iter().map(|analysis| analysis.get().done(py)).collect::<PyResult<_>>()?;
    writing_job(py, move |watch| write_reports(done.iter().map(|one| &one.result), &folder, &options, watch))
}
