//! A contact watched tick by tick.

use palpate::observe::{ObserveError, Observer as Watcher, ObserverOptions};
use palpate::watch::{Cancelled, Progress, Watch};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyType};

use crate::arrays::doubles;
use crate::errors::{ModelError, OptionError, PalpateError, RecordError, refused, refused_plainly};
use crate::mappings::quantity;
use crate::materials::material::Material;
use crate::observers::observation::{Observation, columns};
use crate::pickles::{Made, damaged};
use crate::shown::shown;
use crate::table::Table;
use crate::work::at_length;

/// Ticks between two looks at whether Ctrl-C was pressed.
const TICKS: usize = 4096;

/// Watches a contact tick by tick, as a controller would: when a hold begins, where its force tends, how long until it slips.
///
/// It knows nothing but what came before, keeps a hold of any length as 64 means, and fits it anew each time it has become 4 % longer.
/// ``palpate watch`` replays a log through the same observer.
///
/// Parameters
/// ----------
/// material : Material, optional
///     The calibrated body, of the latency law: its excess strain is then known from first touch on. Displacements count from there.
/// exponent : float, optional
///     Exponent of the law where no material says it, from 1 to 30; 5 if left out.
/// exponent_standard_error : float, optional
///     Standard deviation to which that exponent is known, from 0 to 10; 0 if left out.
/// slip_force_n : float, optional
///     Normal force at and below which what is held slips, N; without it nobody asks for slip.
/// warn_before_s : float
///     How long before slip to warn, s.
/// confidence : float
///     Coverage of the intervals, between 0 and 1.
/// displacement_noise_m, force_noise_n : float, optional
///     Standard deviation of one reading, m and N, both or none; found out from the readings if left out.
/// stiffness_standard_error : float
///     With a material: by how much the stiffness of this body may differ, as a standard deviation of its logarithm, from 0 to 1.
/// touch_standard_error_m : float
///     With a material: standard deviation to which first touch is known, m; intervals hold up to some 6 % of the squeeze.
///
/// Raises
/// ------
/// OptionError
///     A number out of its range, or one that a material says itself.
/// ModelError
///     A material of another law than latency.
///
/// Examples
/// --------
/// 5 mm within 0.5 s, then a hold whose force tends to 1.2 N; it is 2 N 0.81 s later.
///
/// >>> import numpy as np, palpate
/// >>> t = np.arange(60_001) * 1e-3
/// >>> hold = palpate.laws.latency(np.maximum(t - 0.5, 0.0), 1.2, 1.7, 6.0, 5.0)
/// >>> force, displacement = np.where(t < 0.5, 5.8 * t, hold), np.minimum(0.01 * t, 0.005)
/// >>> observer = palpate.Observer(slip_force_n=2.0, warn_before_s=0.5)
/// >>> observed = observer.feed_many(t[:1000], force[:1000], displacement[:1000])
/// >>> round(float(observed["time_to_slip_s"][-1]), 2), round(float(hold[1310]), 2)
/// (0.31, 2.0)
/// >>> for i in range(1000, len(t)):
/// ...     now = observer.feed(t[i], force[i], displacement[i])
/// >>> now.phase, now.held, now.warning, round(now.equilibrium_force_n, 3)
/// ('holding', 'displacement', 'slipping', 1.2)
#[pyclass(name = "Observer", module = "palpate")]
#[derive(Clone)]
pub(crate) struct Observer {
    watcher: Watcher,
    /// The material as it was given, so that the observer can be sent elsewhere.
    material: Option<Material>,
}

/// Why there is no observer, or no observation; `at` is what stands before the message.
fn refused_at(at: &str, error: &ObserveError) -> PyErr {
    let message = format!("{at}{error}");
    let hint = Some(error.hint()).filter(|hint| !hint.is_empty());
    match error {
        ObserveError::Option { .. } => refused::<OptionError>(message, hint),
        ObserveError::LinearMaterial => {
            refused::<ModelError>(message, Some("calibrate with law=\"latency\", or observe without a material"))
        }
        ObserveError::NotFinite { .. } | ObserveError::TimeNotRising { .. } => refused::<RecordError>(message, hint),
        ObserveError::Displacement { .. } => refused::<ModelError>(message, hint),
        _ => refused::<PalpateError>(message, hint),
    }
}

fn same_lengths(time: &[f64], force: &[f64], displacement: Option<&[f64]>) -> PyResult<()> {
    let found = displacement.map_or(time.len(), <[f64]>::len);
    if force.len() == time.len() && found == time.len() {
        return Ok(());
    }
    let message = format!(
        "expected columns of one length, found {} times, {} forces{}",
        time.len(),
        force.len(),
        displacement.map_or_else(String::new, |column| format!(", {} displacements", column.len()))
    );
    Err(refused_plainly::<RecordError>(message))
}

shown! {
    Observer: self
    copied getters {
        /// The calibrated body, if one was given.
        material: Option<Material> = self.material.clone(),
        /// Force at and below which what is held slips, N, if one was given.
        slip_force_n: Option<f64> = self.watcher.options().slip_force,
        /// How long before slip to warn, s.
        warn_before_s: f64 = self.watcher.options().warn_before,
        /// Coverage of the intervals.
        confidence: f64 = self.watcher.options().confidence,
    }

    #[new]
    #[pyo3(signature = (
        material=None, *, exponent=None, exponent_standard_error=None, slip_force_n=None, warn_before_s=1.0, confidence=0.95,
        displacement_noise_m=None, force_noise_n=None, stiffness_standard_error=0.05, touch_standard_error_m=1e-4,
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        material: Option<PyRef<'_, Material>>,
        exponent: Option<f64>,
        exponent_standard_error: Option<f64>,
        #[pyo3(from_py_with = quantity::newtons)] slip_force_n: Option<f64>,
        #[pyo3(from_py_with = quantity::seconds)] warn_before_s: f64,
        confidence: f64,
        #[pyo3(from_py_with = quantity::metres)] displacement_noise_m: Option<f64>,
        #[pyo3(from_py_with = quantity::newtons)] force_noise_n: Option<f64>,
        stiffness_standard_error: f64,
        #[pyo3(from_py_with = quantity::metres)] touch_standard_error_m: f64,
    ) -> PyResult<Self> {
        let material = material.map(|material| material.clone());
        for (name, given) in [("exponent", exponent), ("exponent_standard_error", exponent_standard_error)] {
            if material.is_some() && given.is_some() {
                let message = format!("{name}: expected either this or material, found both");
                return Err(refused::<OptionError>(
                    message,
                    Some(format!("leave {name} out: a material says it itself")),
                ));
            }
        }
        if displacement_noise_m.is_some() != force_noise_n.is_some() {
            let (given, missing) = match force_noise_n {
                Some(_) => ("force_noise_n", "displacement_noise_m"),
                None => ("displacement_noise_m", "force_noise_n"),
            };
            let message = format!("{missing}: expected the noise of both readings or of none, found {given} alone");
            return Err(refused::<OptionError>(
                message,
                Some("leave both out: the noise is found out from the readings"),
            ));
        }
        let options = ObserverOptions {
            material: material.as_ref().map(Material::body),
            exponent: exponent.unwrap_or(5.0),
            exponent_standard_error: exponent_standard_error.unwrap_or(0.0),
            slip_force: slip_force_n,
            warn_before: warn_before_s,
            confidence,
            noise: displacement_noise_m.zip(force_noise_n),
            stiffness_standard_error,
            touch_standard_error: touch_standard_error_m,
        };
        let watcher = Watcher::new(options).map_err(|error| refused_at("", &error))?;
        Ok(Self { watcher, material })
    }

    /// Takes the readings of a tick and says what they mean, in microseconds.
    ///
    /// Parameters
    /// ----------
    /// time_s : float
    ///     When, s, on any clock that rises.
    /// force_n : float
    ///     Force, N; above 0 as the jaw presses.
    /// displacement_m : float, optional
    ///     Displacement of the jaw, m, growing as it closes; None where there is no reading.
    ///
    /// Returns
    /// -------
    /// Observation
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     A reading that is not finite, a clock that stands or goes back; the observer stays as it was.
    /// ModelError
    ///     A displacement that the body of the material cannot take; the observer stays as it was.
    #[pyo3(signature = (time_s, force_n, displacement_m=None))]
    fn feed(
        &mut self,
        #[pyo3(from_py_with = quantity::seconds)] time_s: f64,
        #[pyo3(from_py_with = quantity::newtons)] force_n: f64,
        #[pyo3(from_py_with = quantity::metres)] displacement_m: Option<f64>,
    ) -> PyResult<Observation> {
        let observed = self.watcher.feed(time_s, displacement_m, force_n);
        observed.map(|observed| Observation { observed }).map_err(|error| refused_at("", &error))
    }

    /// Takes the readings of many ticks, one after the other; all of them, or none if one cannot be taken.
    ///
    /// Parameters
    /// ----------
    /// time_s, force_n : array_like, shape (N,)
    ///     As for `feed`.
    /// displacement_m : array_like, shape (N,), optional
    ///     As for `feed`.
    ///
    /// Returns
    /// -------
    /// Table
    ///     A row a tick, a column for each attribute of `Observation`: arrays of numbers, NaN where one is not known, and lists of words.
    ///
    /// Raises
    /// ------
    /// RecordError, ModelError
    ///     As for `feed`, with the index of the tick; columns of different lengths. The observer stays as it was.
    #[pyo3(signature = (time_s, force_n, displacement_m=None))]
    fn feed_many(
        &mut self,
        py: Python<'_>,
        time_s: &Bound<'_, PyAny>,
        force_n: &Bound<'_, PyAny>,
        displacement_m: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Table> {
        let (time, force) = (doubles(time_s, "time_s")?, doubles(force_n, "force_n")?);
        let displacement = displacement_m.map(|column| doubles(column, "displacement_m")).transpose()?;
        same_lengths(&time, &force, displacement.as_deref())?;
        let mut watcher = self.watcher.clone();
        let watched = at_length(py, move |mut heard| {
            let count = time.len();
            let mut all = Vec::with_capacity(count);
            for (index, (time, force)) in time.iter().zip(&force).enumerate() {
                if index % TICKS == 0 {
                    heard.report(Progress::counted("watching", index, count)).map_err(|_| None)?;
                }
                let place = displacement.as_ref().map(|column| column[index]);
                all.push(watcher.feed(*time, place, *force).map_err(|error| Some((index, error)))?);
            }
            let columns = columns(&all, || heard.look()).map_err(|_| None)?;
            Ok((watcher, columns))
        })?;
        let (watcher, columns) = watched.map_err(|refused: Option<(usize, ObserveError)>| match refused {
            Some((index, error)) => refused_at(&format!("tick {index}: "), &error),
            None => refused_plainly::<PalpateError>(Cancelled),
        })?;
        self.watcher = watcher;
        Table::of(columns)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.watcher.options() == other.watcher.options() && self.watcher.to_bytes() == other.watcher.to_bytes()
    }

    #[classmethod]
    fn _from_parts(
        _class: &Bound<'_, PyType>,
        options: &str,
        material: Option<&str>,
        state: &[u8],
    ) -> PyResult<Self> {
        let material = material.map(Material::parsed).transpose()?;
        let options = ObserverOptions {
            material: material.as_ref().map(Material::body),
            ..serde_json::from_str(options).map_err(damaged)?
        };
        let watcher = Watcher::from_bytes(options, state).map_err(|error| refused_at("", &error))?;
        Ok(Self { watcher, material })
    }

    #[expect(clippy::type_complexity, reason = "what pickle asks for")]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String, Option<String>, Bound<'py, PyBytes>)>> {
        let options = serde_json::to_string(self.watcher.options());
        let options = options.map_err(refused_plainly::<PalpateError>)?;
        let (material, state) = (self.material.as_ref().map(Material::to_toml), self.watcher.to_bytes());
        let make = py.get_type::<Self>().getattr("_from_parts")?;
        Ok((make, (options, material, PyBytes::new(py, &state))))
    }

    fn __repr__(&self) -> String {
        let law = self.material.as_ref().map_or_else(
            || format!("exponent {}", self.watcher.options().exponent),
            |material| format!("material of law {}", material.law()),
        );
        format!("<palpate.Observer: {law}>")
    }
}
