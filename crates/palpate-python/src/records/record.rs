//! A measured record.

use numpy::PyArray1;
use palpate::analysis::corrected_watched;
use palpate::record::Record as Measured;
use palpate_jobs::input::{Described, Measurement};
use palpate_jobs::{Analyze, Calibrate, Compare, typed};
use palpate_report::result::{Input, word};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::arrays::{array, doubles};
use crate::errors::{OptionError, RecordError, choice, refused, refused_plainly};
use crate::files::{self, Given, all_laws, described, read_or_parsed, start_of_holds};
use crate::fits::fit_hold;
use crate::listed::Listed;
use crate::mappings::quantity;
use crate::materials::calibration::Calibration;
use crate::materials::material::{Material, rising_times};
use crate::materials::prediction::Prediction;
use crate::pickles::{Made, Piece, Pieces, made_again, unpickled};
use crate::records::analysis::Analysis;
use crate::records::columns::{Columns, column_name, of_table};
use crate::records::compare::RecordComparison;
use crate::records::kept::Kept;
use crate::records::keywords::{first_touch, not_so, other_laws, unpredicted};
use crate::records::record_of::record_of;
use crate::shown::shown;
use crate::table::{Column, Table, columns};
use crate::work::{at_length, job};

/// A record of time, force and, if there is one, displacement, in SI, checked; loading is positive.
///
/// Made by `palpate.read`, `Record.from_arrays` or `Record.from_arrow`. It never changes, can be compared, copied and pickled,
/// and is a table for polars, pandas and pyarrow.
///
/// Examples
/// --------
/// >>> import palpate
/// >>> record = palpate.Record.from_arrays(time_s=[0, 1, 2, 3], force_n=[0.0, 3.0, 2.0, 1.5], displacement_m=[0, 1e-3, 1e-3, 1e-3])
/// >>> len(record), float(record.force_n.max())
/// (4, 3.0)
#[pyclass(name = "Record", module = "palpate", frozen, eq)]
#[derive(Clone)]
pub(crate) struct Record {
    record: Measured,
    input: Input,
    described: Described,
}

/// What a record is made of again.
#[derive(Serialize, Deserialize)]
struct Parts<'a> {
    measured: Kept<'a>,
    input: Input,
    test: Option<String>,
    part: Option<String>,
}

impl PartialEq for Record {
    fn eq(&self, other: &Self) -> bool {
        self.record == other.record
    }
}

impl Record {
    /// A record that was read, as it is described.
    pub(super) fn new(record: Measured, input: Input, described: Described) -> Self {
        Self {
            record,
            input,
            described,
        }
    }

    /// A record of columns of Python.
    fn checked(py: Python<'_>, columns: Columns, title: &str) -> PyResult<Self> {
        let (record, input) = record_of(py, columns, title)?;
        Ok(Self::new(record, input, Described::default()))
    }

    /// What jobs take of it, described as it is or by `test`.
    pub(crate) fn measured(&self, test: Given<'_, '_>) -> PyResult<Measurement> {
        let mut input = self.input.clone();
        let options = match test {
            None => self.described.options(),
            test => {
                let (stated, path) = described(test, None)?;
                input.test = path.map(|path| path.display().to_string());
                input.test_sha256 = stated.sha256();
                stated.options()
            }
        };
        Ok(Measurement {
            record: self.record.clone(),
            input,
            options,
            notes: Vec::new(),
            turned: Vec::new(),
        })
    }
}

shown! {
    Record: self
    getters {
        /// Title of the record, for reports.
        title: &str = &self.input.title,
        /// Where the curve was measured, m; None where its file states no position in a map.
        x_m: Option<f64> = self.input.x_m,
        /// Second coordinate of that position, m.
        y_m: Option<f64> = self.input.y_m,
        /// Number of the curve in its map; None where its file does not number it.
        map_index: Option<u64> = self.input.map_index,
        /// Time, s.
        time_s<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = array(py, self.record.time().iter().copied()),
        /// Displacement of the jaw, m; None where it was not recorded.
        displacement_m<'py>(py): PyResult<Option<Bound<'py, PyArray1<f64>>>> =
            self.record.displacement().map(|values| array(py, values.iter().copied())).transpose(),
        /// Force, N.
        force_n<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = array(py, self.record.force().iter().copied()),
        /// What was done to the record, in words and in order.
        corrections: Vec<String> = self.record.corrections().iter().map(ToString::to_string).collect(),
    }

    /// A record of arrays in SI, loading positive; those of xarray are in the unit that their attribute ``units`` states.
    ///
    /// Parameters
    /// ----------
    /// table : optional
    ///     A table in place of arrays, as for `from_arrow`; the others are then names of its columns.
    /// time_s : array_like, shape (N,)
    ///     Times in s, rising; at least two.
    /// force_n : array_like, shape (N,)
    ///     Force in N.
    /// displacement_m : array_like, shape (N,), optional
    ///     Displacement of the jaw in m.
    /// title : str
    ///     For reports.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     Columns of different lengths, values that are not finite, times that do not rise, a force that never changes.
    /// OptionError
    ///     Columns that are no numbers.
    #[classmethod]
    #[pyo3(signature = (table=None, /, *, time_s=None, force_n=None, displacement_m=None, title="record"))]
    fn from_arrays(
        class: &Bound<'_, PyType>,
        table: Option<&Bound<'_, PyAny>>,
        time_s: Option<&Bound<'_, PyAny>>,
        force_n: Option<&Bound<'_, PyAny>>,
        displacement_m: Option<&Bound<'_, PyAny>>,
        title: &str,
    ) -> PyResult<Self> {
        if let Some(table) = table {
            let (time, force) = (column_name("time_s", time_s)?, column_name("force_n", force_n)?);
            let displacement = column_name("displacement_m", displacement_m)?;
            let (time, force) = (time.as_deref().unwrap_or("time_s"), force.as_deref().unwrap_or("force_n"));
            return Self::from_arrow(class, table, time, force, displacement.as_deref(), title);
        }
        let (Some(time_s), Some(force_n)) = (time_s, force_n) else {
            let message = "Record.from_arrays() needs the arguments time_s and force_n, or a table";
            return Err(PyTypeError::new_err(message));
        };
        let displacement = displacement_m.map(|values| doubles(values, "displacement_m")).transpose()?;
        Self::checked(class.py(), (doubles(time_s, "time_s")?, displacement, doubles(force_n, "force_n")?), title)
    }

    /// A record of columns of a table in SI, loading positive.
    ///
    /// Parameters
    /// ----------
    /// table
    ///     Of polars, pandas, pyarrow, or anything else with ``__arrow_c_stream__``; a mapping or a Dataset of xarray, by the names of its
    ///     columns, and in the units that these state.
    /// time_s, force_n, displacement_m : str
    ///     Names of the columns. Times may be durations, or dates, which are seconds since the first. A displacement is looked for under its
    ///     own name if none is given, and may be missing.
    /// title : str
    ///     For reports.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No such column, one that is no numbers or lacks some, or as for `from_arrays`.
    #[classmethod]
    #[pyo3(signature = (table, *, time_s="time_s", force_n="force_n", displacement_m=None, title="record"))]
    fn from_arrow(
        class: &Bound<'_, PyType>,
        table: &Bound<'_, PyAny>,
        time_s: &str,
        force_n: &str,
        displacement_m: Option<&str>,
        title: &str,
    ) -> PyResult<Self> {
        Self::checked(class.py(), of_table(table, time_s, force_n, displacement_m)?, title)
    }

    #[classmethod]
    #[pyo3(signature = (json, format=0))]
    fn _from_json(class: &Bound<'_, PyType>, json: Pieces, format: u32) -> PyResult<Self> {
        let parts: Parts<'_> = unpickled(class.py(), json, format)?;
        Ok(Self {
            record: parts.measured.record()?,
            input: parts.input,
            described: read_or_parsed(None, parts.test, parts.part.as_deref())?,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (Vec<Piece>, u32)>> {
        let parts = Parts {
            measured: Kept::of(&self.record),
            input: self.input.clone(),
            test: self.described.text.clone(),
            part: self.described.test.as_ref().and_then(|stated| stated.reading.part.clone()),
        };
        made_again::<Self>(py, &parts)
    }

    fn __len__(&self) -> usize {
        self.record.len()
    }

    /// The phases, found without labels: loading, hold, unloading, rest.
    ///
    /// Returns
    /// -------
    /// Table
    ///     A row a phase: ``phase``, ``start_s``, ``end_s``, ``first_row``, ``last_row`` (both inside), what is held (``mode``),
    ///     what came before (``after``), displacement in m and force in N at both ends.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     Nothing moves, or nothing stands still.
    fn segments(&self, py: Python<'_>) -> PyResult<Table> {
        let (record, options) = (self.record.clone(), self.described.options());
        let cut = at_length(py, move |mut heard| corrected_watched(&record, &options, &mut heard))?;
        let cut = cut.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        let found = cut.segmentation.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        let (time, displacement, force) = (cut.record.time(), cut.record.displacement(), cut.record.force());
        let at = |index: usize| displacement.map(|values| values[index]);
        Table::of(columns!(found.segments, segment =>
            phase = word(segment.phase), start_s = time[segment.start], end_s = time[segment.end - 1],
            first_row = segment.start, last_row = segment.end - 1, mode = segment.mode.map(word),
            after = segment.after.map(word), displacement_start_m = at(segment.start),
            displacement_end_m = at(segment.end - 1), force_start_n = force[segment.start],
            force_end_n = force[segment.end - 1]
        ))
    }

    /// Phases, strains, laws for every hold, findings: the study of ``palpate analyze``.
    ///
    /// Parameters
    /// ----------
    /// test : path, mapping or Material, optional
    ///     A test description in place of that of the record, or a material, which knows the body.
    /// exponents : sequence of float, optional
    ///     Exponents n to fit with each; those of the description, or 1, 2, 3, 5 and 7, if left out. A list of two or more goes on beyond
    ///     an end that has the lowest criterion, with the finding ``exponent_list_extended``.
    /// free_exponent : bool, optional
    ///     Whether n is found as well.
    /// confidence : float, optional
    ///     Coverage of the intervals, between 0 and 1.
    /// intervals : str, optional
    ///     Method of the intervals of fits: "automatic" (if left out), "curvature", "profile", or "bootstrap", which takes long.
    /// fit_until_s : float, optional
    ///     Longest stretch of a hold to fit, s.
    /// hold_start : str, optional
    ///     Where the fit of a hold starts: "peak", "settled" or "peak + 0.5 s"; that of the description, or "peak", if left out.
    /// touch : str or float, optional
    ///     First touch: "auto", "as recorded", a rule, or a displacement (m); that of the description, or "auto", if left out.
    /// tolerance_m : float, optional
    ///     Largest deviation of the displacement within a hold, m.
    /// minimum_hold_s : float, optional
    ///     Shortest hold, s.
    /// compare : bool
    ///     Whether laws are compared, which takes most of the time.
    ///
    /// Returns
    /// -------
    /// Analysis
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No hold, or none that can be fitted.
    /// OptionError
    ///     An exponent, a confidence or a description that is wrong.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     Findings that forbid the use of a number.
    #[pyo3(signature = (*, test=None, exponents=None, free_exponent=None, confidence=None, intervals=None, fit_until_s=None, hold_start=None, touch=None, tolerance_m=None, minimum_hold_s=None, compare=true))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn analyze(
        &self,
        py: Python<'_>,
        test: Option<&Bound<'_, PyAny>>,
        exponents: Option<Listed<f64>>,
        free_exponent: Option<bool>,
        confidence: Option<f64>,
        intervals: Option<&str>,
        #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
        hold_start: Option<&str>,
        touch: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = quantity::metres)] tolerance_m: Option<f64>,
        #[pyo3(from_py_with = quantity::seconds)] minimum_hold_s: Option<f64>,
        compare: bool,
    ) -> PyResult<Analysis> {
        let job = Analyze {
            exponents: exponents.map(|listed| listed.0),
            free_exponent,
            confidence,
            intervals: intervals.map(fit_hold::intervals).transpose()?,
            fit_until_s,
            hold_start: hold_start.map(start_of_holds).transpose()?,
            touch: touch.map(first_touch).transpose()?,
            tolerance_m,
            minimum_hold_s,
            compare,
        };
        Analysis::of(py, self.measured(test)?, job)
    }

    /// One set of numbers for the whole record, ramps and holds alike: what ``palpate calibrate`` finds.
    ///
    /// The latency law, strain rate = -v (e - e_e)^n of equation (10) of Tsai, Kao et al., in layers of a thickness that is found as well: holds
    /// carry n and v, ramps the layer thickness, relaxed levels the modulus. No starting values: a grid is searched first.
    ///
    /// Parameters
    /// ----------
    /// law : str
    ///     "latency" (n found), "latency:5" (n given), "standard-linear-solid", "prony:K" or "fung:K".
    /// test : path, mapping or Material, optional
    ///     A test description in place of that of the record; one of them has to know the body: ``{"specimen": {"shape": "ball", "radius":
    ///     "35 mm"}}``.
    /// alternatives : sequence of str, optional
    ///     Laws to hold against it on the same record; "latency", "standard-linear-solid", "prony:2", "prony:3" and "fung:2" if left out, none for
    ///     an empty list.
    /// equilibrium : str, optional
    ///     Law of the force once relaxation is over: "uniform-strain" (modulus x displacement/depth x contact area, equation (11)), "hertz", or
    ///     "table", a monotone one with a row where the jaw was held; that of the description if left out.
    /// poisson_ratio : float, optional
    ///     For Hertz's law, from 0 to 0.5; that of the description, or 0.5, if left out.
    /// rate : str
    ///     What the rate coefficient v of the latency law depends on, by one more number: "constant"; "by-strain", v f^(ε_e/0.1) with
    ///     f = ``strain_factor``; or "by-direction", v after loading and f v after unloading with f = ``unloading_factor``. The other
    ///     two are alternatives then.
    /// fit_until_s : float, optional
    ///     Fit only up to this time of the record, s, and predict the rest.
    /// confidence : float, optional
    ///     Coverage of the intervals, between 0 and 1; that of the description, or 0.95, if left out.
    /// profile : bool
    ///     Add profile intervals, which are asymmetric, and open where the record leaves a number open.
    ///
    /// Returns
    /// -------
    /// Calibration
    ///     The material, the residuals of the record, and the alternatives.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No displacement, no phases.
    /// OptionError
    ///     No body described, a law of single holds alone, a time outside the record, or any other option that is wrong.
    /// ModelError
    ///     A body that the jaw goes through, a law of the equilibrium force that does not go with it.
    /// FitError
    ///     Too few samples, or a force that does not rise with the squeeze.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     The record leaves a number open.
    ///
    /// Examples
    /// --------
    /// >>> import palpate
    /// >>> ball = {"shape": "ball", "radius": "35 mm"}
    /// >>> squeezed = palpate.simulate({
    /// ...     "specimen": {**ball, "modulus": "28 kPa"},
    /// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    /// ...     "step": [{"to": to, "rate": "500 mm/min", "hold": "20 s"} for to in ("5 mm", "10 mm")],
    /// ...     "output": {"sample_rate": "10 Hz"},
    /// ... })
    /// >>> record = palpate.Record.from_arrays(
    /// ...     time_s=squeezed.time_s, displacement_m=squeezed.displacement_m, force_n=squeezed.force_n
    /// ... )
    /// >>> calibration = record.calibrate(test={"specimen": ball}, alternatives=[])
    /// >>> round(calibration.material.parameters["exponent"], 2)
    /// 5.0
    /// >>> prediction = calibration.material.predict([{"to": "8 mm", "rate": "500 mm/min", "hold": "20 s"}], at_s=[10.0])
    /// >>> round(float(prediction.force_n[0]), 2)
    /// 3.45
    #[pyo3(signature = (*, law="latency", test=None, alternatives=None, equilibrium=None, poisson_ratio=None, rate="constant", fit_until_s=None, confidence=None, profile=false))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn calibrate(
        &self,
        py: Python<'_>,
        law: &str,
        test: Option<&Bound<'_, PyAny>>,
        alternatives: Option<&Bound<'_, PyAny>>,
        equilibrium: Option<&str>,
        poisson_ratio: Option<f64>,
        rate: &str,
        #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
        confidence: Option<f64>,
        profile: bool,
    ) -> PyResult<Calibration> {
        let usual = Calibrate::default();
        let law = files::law(law)?;
        let alternatives = alternatives.map_or(Ok(usual.alternatives), other_laws)?;
        let job = Calibrate {
            law,
            alternatives,
            equilibrium: equilibrium
                .map(|name| choice("equilibrium", &["uniform-strain", "hertz", "table"], name))
                .transpose()?,
            poisson_ratio,
            rate: choice("rate", &["constant", "by-strain", "by-direction"], rate)?,
            fit_until_s,
            profile,
            confidence,
        };
        Calibration::of(py, self.measured(test)?, job)
    }

    /// The prediction of `Material.predict` along the displacement of this record.
    #[pyo3(signature = (material, at_s, confidence))]
    fn _predicted_by(
        &self,
        py: Python<'_>,
        material: &Material,
        at_s: Option<&Bound<'_, PyAny>>,
        confidence: f64,
    ) -> PyResult<Prediction> {
        let (at, body) = (rising_times(at_s)?, material.body());
        let Measurement { record, options, .. } = self.measured(None)?;
        if !(confidence > 0.0 && confidence < 1.0) {
            let message = format!("confidence is a share between 0 and 1, found {confidence}");
            return Err(refused_plainly::<OptionError>(message));
        }
        let predicted = job(py, move |watch| {
            body.predict_record(&record, &options, &at, confidence, watch).map_err(|error| unpredicted(&error))
        })?;
        Prediction::of(py, predicted)
    }

    /// Which law predicts the holds of the record, how sure that is, and what another would cost: what ``palpate compare`` finds.
    ///
    /// Parameters
    /// ----------
    /// test : path, mapping or Material, optional
    ///     A test description in place of that of the record.
    /// laws : sequence of str, optional
    ///     Laws to compare; all that suit if left out.
    /// cuts : sequence of float, optional
    ///     Parts of a hold that are fitted to predict the rest, as shares of its duration.
    /// creep : bool
    ///     Whether laws of creep are compared: displacement in holds of constant force.
    /// intervals : str, optional
    ///     Method of the intervals of fits: "automatic" (if left out), "curvature", "profile", or "bootstrap", which takes long.
    /// fit_until_s : float, optional
    ///     Compare only over this long from the start of each hold, s.
    /// loss : str
    ///     Loss function of the residuals: "squares", or "huber" or "tukey" where single samples stray.
    /// samples : str
    ///     Samples to fit: "all", or "log:400" for about 400, evenly spaced in ln t.
    /// ramps : str
    ///     Loading before a hold, as linear laws take it: "step", or "measured".
    ///
    /// Returns
    /// -------
    /// RecordComparison
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No hold to compare on.
    /// OptionError
    ///     A law that is none, or has no such form.
    #[pyo3(signature = (*, test=None, laws=None, cuts=None, creep=false, intervals=None, fit_until_s=None, loss="squares", samples="all", ramps="step"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn compare(
        &self,
        py: Python<'_>,
        test: Option<&Bound<'_, PyAny>>,
        laws: Option<Listed<String>>,
        cuts: Option<Listed<f64>>,
        creep: bool,
        intervals: Option<&str>,
        #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
        loss: &str,
        samples: &str,
        ramps: &str,
    ) -> PyResult<RecordComparison> {
        let question = Compare {
            laws: laws.map(|laws| all_laws(&laws)).transpose()?,
            cuts: cuts.map(|listed| listed.0),
            creep,
            intervals: intervals.map(fit_hold::intervals).transpose()?,
            fit_until_s,
            loss: fit_hold::loss(loss)?,
            samples: typed::samples(samples).map_err(|message| not_so("samples", &message, samples))?,
            ramps: choice("ramps", &["step", "measured"], ramps)?,
        };
        RecordComparison::of(py, self.measured(test)?, question)
    }

    /// Columns `time_s`, `displacement_m` and `force_n` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let column = |values: &[f64]| Column::column(values.iter().copied());
        let mut columns = vec![("time_s", column(self.record.time()))];
        columns.extend(self.record.displacement().map(|values| ("displacement_m", column(values))));
        columns.push(("force_n", column(self.record.force())));
        Table::of(columns)
    }

    /// The rows of the table, a dict each: ``pandas.DataFrame`` takes them.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.to_arrow()?.__iter__(py)
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__(&self, py: Python<'_>, requested_schema: Option<Py<PyAny>>) -> PyResult<Py<PyAny>> {
        self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
    }

    fn __repr__(&self) -> String {
        let time = self.record.time();
        let duration = palpate::number::significant(time[time.len() - 1] - time[0], 4);
        let displacement = if self.record.displacement().is_some() { "" } else { ", no displacement" };
        format!(
            "<palpate.Record {:?}: {} rows over {duration} s{displacement}>",
            self.input.title,
            self.record.len()
        )
    }
}
