//! Contacts that are moved side by side.

use std::io::Write;

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use palpate::simulate::{ContactModels, ContactParameter, ContactQuantity, ContactsStep, Imposed, Refusal};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use super::columns::{Values, marks, results};
use super::states_made::{MOST, models_given, models_kept, numbers, rows_of};
use super::states_memory::{Lined, Memory};
use crate::arrays::AT_ONCE;
use crate::errors::{ModelError, OptionError, PalpateError, one_of, refused_plainly};
use crate::pickles::{Made, PICKLE, Piece, Pieces, check_pickle, in_pieces};
use crate::shown::shown;
use crate::work::{briefly, in_parallel, shortly};

/// Contacts that are moved side by side, such as those of many grippers, or of one with many values of its parameters.
///
/// Thousands of contacts are stepped on all cores, to the same bits on any number of them. Two threads cannot use one object at once,
/// neither where both step nor where one reads a property meanwhile: the second gets a ``RuntimeError``. One that shows forces takes them from ``out``.
///
/// Parameters
/// ----------
/// model : path or mapping, or a list of them
///     One model for ``count`` contacts, or one each, as for `ContactState`; all by the latency law with one rate coefficient, or all by
///     linear laws.
///     A jaw that is bonded to its body (``separation = false``, as a calibrated block has it unless its test states otherwise) pulls below 0 m from
///     any distance: jaws that only press need ``separation = true``.
/// count : int, optional
///     How many, of one model; none beside a list, or where the arrays below say it.
/// modulus_pa, radius_m, exponent, rate_coefficient_per_s, layer_thickness_m : float or array_like, shape (N,), optional
///     Values for each contact in place of those of the one model: Young's modulus, Pa; radius of a ball or a pad, m, with the number
///     of layers as it was; exponent, rate coefficient (1/s) and thickness of a layer (m) of the latency law.
///
/// Raises
/// ------
/// OptionError
///     Descriptions that are none; another number of values than contacts; values beside a list.
/// ModelError
///     Laws of both kinds, a rate coefficient that varies, a parameter that the body or its law does not have, a value out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, palpate
/// >>> model = {
/// ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
/// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
/// ... }
/// >>> contacts = palpate.ContactStates(model, 3)
/// >>> for k in range(100):
/// ...     forces = contacts.step(1e-3, (k + 1) * np.array([3e-5, 4e-5, 5e-5]))
/// >>> forces.round(2)
/// array([1.94, 2.86, 3.89])
///
/// Twice the modulus is twice the force; a step of NaN is masked, and a reset makes a contact untouched.
///
/// >>> contacts = palpate.ContactStates(model, modulus_pa=[28e3, 56e3, 28e3])
/// >>> forces = np.empty(3)
/// >>> contacts.step(0.1, [5e-3, 5e-3, np.nan], out=forces, substeps=100, errors="mask").round(2)
/// array([3.89, 7.77, 0.  ])
/// >>> contacts.failed
/// array([False, False,  True])
/// >>> contacts.reset(forces > 5)
/// >>> contacts.state[:, 0]
/// array([0.0025, 0.    , 0.    ])
#[pyclass(name = "ContactStates", module = "palpate")]
pub(crate) struct ContactStates {
    models: ContactModels,
    count: usize,
    states: Memory,
    failed: Vec<bool>,
    /// The description of all, or one each, so that they can be sent elsewhere.
    texts: Vec<String>,
}

/// Steps of contacts in a row that are taken before Ctrl-C is looked for.
const BRIEF: usize = 1 << 22;

/// Steps of contacts that take less time than to hand over the GIL.
const TINY: usize = 64;

/// Steps by displacement that take the time of one by force.
const FORCE: usize = 64;

/// What a step imposes: time steps, targets with their name, and how it is taken.
struct Request<'a, 'py> {
    imposed: Imposed,
    dt_s: &'a Bound<'py, PyAny>,
    to: (&'a Bound<'py, PyAny>, &'static str),
    out: Option<&'a Bound<'py, PyAny>>,
    substeps: u32,
    errors: &'a str,
}

impl ContactStates {
    fn new_of(models: ContactModels, count: usize, texts: Vec<String>, states: &[f64]) -> Self {
        Self {
            states: Memory::Own(Lined::new(states)),
            failed: vec![false; count],
            models,
            count,
            texts,
        }
    }

    /// Numbers of a state, and contacts.
    fn shape(&self) -> [usize; 2] {
        [self.models.rows(), self.count]
    }

    /// Steps all contacts; with errors="raise" all or none.
    fn stepped<'py>(&mut self, py: Python<'py>, request: &Request<'_, 'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (substeps, refusal) = (request.substeps, refusal_of(request.errors)?);
        let shape = self.shape();
        let mut states = self.states.write(py, shape)?;
        let dt = Values::new(request.dt_s, "dt_s", self.count)?;
        let to = Values::new(request.to.0, request.to.1, self.count)?;
        let (array, mut results) = results(py, request.out, self.count)?;
        let step = ContactsStep {
            imposed: request.imposed,
            dt: dt.slice(),
            to: to.slice(),
            substeps,
            refusal,
        };
        let (states, results) = (states.slice()?, results.as_slice_mut()?);
        let (models, failed) = (&self.models, &mut self.failed[..]);
        let each = if request.imposed == Imposed::Force { FORCE } else { 1 };
        let work = self.count.saturating_mul(substeps as usize).saturating_mul(each);
        if work > BRIEF {
            let at_once = (BRIEF / each / substeps as usize).max(8);
            Self::at_length(py, models, (states, results, failed), &step, at_once)?;
            return Ok(array);
        }
        let stepped = match work > TINY {
            false => models.step(states, &step, results, failed),
            true if ContactModels::is_spread(self.count, request.imposed) => {
                let advance = |pool: &_, are_awake| models.step_on(pool, are_awake, states, &step, results, failed);
                briefly(py, || shortly(advance))?.map_err(refused_plainly::<PalpateError>)?
            }
            true => briefly(py, || models.step(states, &step, results, failed))?,
        };
        stepped.map_err(refused_plainly::<ModelError>)?;
        Ok(array)
    }

    /// Steps so many contacts that Ctrl-C is looked for in between; an exception leaves all states as they were.
    fn at_length(
        py: Python<'_>,
        models: &ContactModels,
        (states, results, failed): (&mut [f64], &mut [f64], &mut [bool]),
        step: &ContactsStep<'_>,
        at_once: usize,
    ) -> PyResult<()> {
        let mut kept = Vec::with_capacity(states.len());
        for some in states.chunks(AT_ONCE) {
            py.check_signals()?;
            kept.extend_from_slice(some);
        }
        let at_once = at_once.next_multiple_of(8);
        for from in (0..results.len()).step_by(at_once) {
            let range = from..results.len().min(from + at_once);
            let (states, results, failed) = (&mut *states, &mut *results, &mut *failed);
            let stepped = py.check_signals().and_then(|()| {
                let advance = || models.step_range(range, states, step, results, failed);
                let stepped = briefly(py, || in_parallel(advance))?.map_err(refused_plainly::<PalpateError>)?;
                stepped.map_err(refused_plainly::<ModelError>)
            });
            if let Err(error) = stepped {
                states.copy_from_slice(&kept);
                return Err(error);
            }
        }
        Ok(())
    }

    /// What all contacts show.
    fn shown<'py>(&self, py: Python<'py>, quantity: ContactQuantity) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let states = self.states.read(py, self.shape())?;
        let states = states.slice()?;
        let mut all = vec![0.0; self.count];
        for (index, some) in all.chunks_mut(AT_ONCE).enumerate() {
            py.check_signals()?;
            let mut show = || self.models.show((states, self.count), quantity, index * AT_ONCE, some);
            if self.count > TINY {
                briefly(py, show)?;
            } else {
                show();
            };
        }
        Ok(PyArray1::from_vec(py, all))
    }

    fn copied(&self, py: Python<'_>) -> PyResult<Self> {
        Ok(Self {
            models: self.models.clone(),
            count: self.count,
            states: Memory::Own(Lined::new(self.states.read(py, self.shape())?.slice()?)),
            failed: self.failed.clone(),
            texts: self.texts.clone(),
        })
    }
}

/// A number of equal parts.
fn substeps_of(found: &Bound<'_, PyAny>) -> PyResult<u32> {
    match found.extract::<u32>() {
        Ok(number) if (1..=1_000_000).contains(&number) => Ok(number),
        _ => {
            let message = format!("substeps: expected a whole number from 1 to 1000000, found {found}");
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

/// What happens where a contact cannot take a step.
fn refusal_of(errors: &str) -> PyResult<Refusal> {
    one_of("errors", &[("raise", Refusal::All), ("mask", Refusal::Masked)], errors)
}

/// The format of pickles with parameters of each contact and with linear laws.
const STATES_PICKLE: u32 = 5;

shown! {
    ContactStates: self
    getters {
        /// Forces now, N; NaN where a state written in place has its jaw beyond the body.
        force_n<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = self.shown(py, ContactQuantity::Force),
        /// Tangent stiffnesses dF/dd against the displacements of the jaws, N/m: the slopes of a step within no time. 0 while a jaw is off.
        stiffness_n_per_m<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = self.shown(py, ContactQuantity::Stiffness),
        /// Displacements of the surfaces at one contact each, m.
        surface_m<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = self.shown(py, ContactQuantity::Surface),
        /// Whether the jaws touch their bodies.
        is_touching<'py>(py): PyResult<Bound<'py, PyArray1<bool>>> = {
            let shown = self.shown(py, ContactQuantity::Touching)?;
            let touching = shown.try_readonly().map_err(refused_plainly::<OptionError>)?;
            let touching = touching.as_array().iter().map(|touching| *touching > 0.0).collect();
            Ok(PyArray1::from_vec(py, touching))
        },
        /// Which contacts kept their state in the last step; none in one with ``errors="raise"``.
        failed<'py>(py): Bound<'py, PyArray1<bool>> = PyArray1::from_slice(py, &self.failed),
    }

    #[new]
    #[pyo3(signature = (
        model, count=None, *, modulus_pa=None, radius_m=None, exponent=None, rate_coefficient_per_s=None, layer_thickness_m=None
    ))]
    fn new<'py>(
        model: &Bound<'py, PyAny>,
        count: Option<&Bound<'py, PyAny>>,
        modulus_pa: Option<&Bound<'py, PyAny>>,
        radius_m: Option<&Bound<'py, PyAny>>,
        exponent: Option<&Bound<'py, PyAny>>,
        rate_coefficient_per_s: Option<&Bound<'py, PyAny>>,
        layer_thickness_m: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let given = [
            (ContactParameter::Modulus, modulus_pa),
            (ContactParameter::Radius, radius_m),
            (ContactParameter::Exponent, exponent),
            (ContactParameter::RateCoefficient, rate_coefficient_per_s),
            (ContactParameter::LayerThickness, layer_thickness_m),
        ];
        let (models, count, texts) = models_given(model, count, &given)?;
        let states = vec![0.0; models.rows() * count];
        Ok(Self::new_of(models, count, texts, &states))
    }

    /// The states, a row each, in place: what is written there is the state. Columns are one contact's share of the displacement of the
    /// jaw, m, and, of the latency law, the displacement of the node behind the contact layer, m; of a linear law the excess of every
    /// term, by rising rate, in strain, or in N where its memory is of force. Zeros are an untouched contact.
    ///
    /// Numbers written in place are not checked: until the next step ``force_n`` and ``stiffness_n_per_m`` are NaN where they are not finite or the jaw
    /// is beyond the body. A step fails for a contact whose numbers are not finite or a million depths
    /// away, and goes on from any others. An assigned array is checked: finite numbers and forces, no jaw beyond its body.
    #[getter]
    fn state<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let shape = self.shape();
        self.states.array(py, shape)?.call_method0("transpose")
    }

    #[setter]
    fn set_state(&mut self, py: Python<'_>, state: &Bound<'_, PyAny>) -> PyResult<()> {
        let numpy = py.import("numpy")?;
        let shape = [self.count, self.models.rows()];
        let refused = |found: String| {
            let message = format!("state: expected an array of shape {shape:?}, found {found}");
            refused_plainly::<OptionError>(message)
        };
        let given = numpy.call_method1("asarray", (state, "float64")).map_err(|error| refused(error.to_string()))?;
        let found: Vec<usize> = given.getattr("shape")?.extract()?;
        if found != shape {
            return Err(refused(format!("one of {found:?}")));
        }
        // A copy with rows one behind the other, whatever they were before.
        let new = given.call_method0("transpose")?.call_method0("copy")?;
        let new = new.cast_into::<PyArray2<f64>>()?;
        let new = new.try_readonly().map_err(refused_plainly::<OptionError>)?;
        let new = new.as_slice()?;
        self.models.check_states(new, self.count).map_err(refused_plainly::<ModelError>)?;
        let shape = self.shape();
        self.states.write(py, shape)?.slice()?.copy_from_slice(new);
        Ok(())
    }

    /// Moves every jaw to its displacement within a time step.
    ///
    /// With ``errors="raise"`` all contacts are stepped, or none if one cannot be. With ``errors="mask"`` such a contact keeps its state,
    /// `failed` marks it, and its force is that before the step, 0 where its state is not finite or its jaw beyond the body.
    ///
    /// Parameters
    /// ----------
    /// dt_s, displacement_m : float or array_like, shape (N,)
    ///     As for `ContactState.step`; one number stands for all contacts. Arrays of doubles are read in place: another thread that changes
    ///     them meanwhile changes the step.
    /// out : ndarray, shape (N,), optional
    ///     Doubles one behind the other, where the forces go; a new array if left out, which takes longer of many contacts.
    /// substeps : int
    ///     Equal parts that the step is taken in, along a straight line.
    /// errors : str
    ///     "raise" or "mask".
    ///
    /// Returns
    /// -------
    /// ndarray, shape (N,)
    ///     Forces, N: ``out`` if it was given.
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     A step that one contact cannot make, with ``errors="raise"``; the message says which.
    /// OptionError
    ///     Arrays of another length, an ``out`` that cannot be written to.
    #[pyo3(signature = (dt_s, displacement_m, out=None, substeps=1, errors="raise"))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        dt_s: &Bound<'py, PyAny>,
        displacement_m: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = substeps_of)] substeps: u32,
        errors: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let request = Request {
            imposed: Imposed::Displacement,
            dt_s,
            to: (displacement_m, "displacement_m"),
            out,
            substeps,
            errors,
        };
        self.stepped(py, &request)
    }

    /// Applies a force to every contact within a time step, as `step` does a displacement.
    ///
    /// Parameters
    /// ----------
    /// dt_s, force_n : float or array_like, shape (N,)
    ///     As for `ContactState.step_force`; of a linear law the jaw goes at constant speed to where the force is reached.
    /// out, substeps, errors
    ///     As for `step`.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (N,)
    ///     Displacements of the jaws, m; those before the step where it failed.
    ///
    /// Raises
    /// ------
    /// ModelError, OptionError
    ///     As for `step`.
    #[pyo3(signature = (dt_s, force_n, out=None, substeps=1, errors="raise"))]
    fn step_force<'py>(
        &mut self,
        py: Python<'py>,
        dt_s: &Bound<'py, PyAny>,
        force_n: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = substeps_of)] substeps: u32,
        errors: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let request = Request {
            imposed: Imposed::Force,
            dt_s,
            to: (force_n, "force_n"),
            out,
            substeps,
            errors,
        };
        self.stepped(py, &request)
    }

    /// Makes contacts untouched, with other values of parameters if those are given.
    ///
    /// Parameters
    /// ----------
    /// mask : array_like of bool, shape (N,), optional
    ///     Which ones; all if left out.
    /// modulus_pa, radius_m, exponent, rate_coefficient_per_s, layer_thickness_m : float or array_like, shape (N,), optional
    ///     New values of these contacts, as for the constructor; those at the places of others are left aside.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A mask of another length, or of something else; another number of values.
    /// ModelError
    ///     A parameter that the body or its law does not have, a value out of range; nothing is changed.
    #[pyo3(signature = (
        mask=None, *, modulus_pa=None, radius_m=None, exponent=None, rate_coefficient_per_s=None, layer_thickness_m=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "the keywords of Python")]
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        mask: Option<&Bound<'py, PyAny>>,
        modulus_pa: Option<&Bound<'py, PyAny>>,
        radius_m: Option<&Bound<'py, PyAny>>,
        exponent: Option<&Bound<'py, PyAny>>,
        rate_coefficient_per_s: Option<&Bound<'py, PyAny>>,
        layer_thickness_m: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<()> {
        let given = [
            (ContactParameter::Modulus, modulus_pa),
            (ContactParameter::Radius, radius_m),
            (ContactParameter::Exponent, exponent),
            (ContactParameter::RateCoefficient, rate_coefficient_per_s),
            (ContactParameter::LayerThickness, layer_thickness_m),
        ];
        let mask = mask.map(|mask| marks(mask, self.count)).transpose()?;
        let shape = self.shape();
        let mut states = self.states.write(py, shape)?;
        let mut values = Vec::new();
        for (parameter, given) in given {
            if let Some(given) = given {
                values.push((parameter, Values::new(given, parameter.name(), self.count)?));
            }
        }
        if !values.is_empty() {
            let values: Vec<_> = values.iter().map(|(parameter, values)| (*parameter, values.slice())).collect();
            let replaced = match &mask {
                Some(mask) => self.models.replace(&values, mask),
                None => self.models.replace(&values, &vec![true; self.count]),
            };
            replaced.map_err(refused_plainly::<ModelError>)?;
        }
        self.models.reset(states.slice()?, self.count, mask.as_deref());
        Ok(())
    }

    fn __len__(&self) -> usize {
        self.count
    }

    fn __eq__(&self, py: Python<'_>, other: &Bound<'_, Self>) -> PyResult<bool> {
        let other = other.try_borrow()?;
        if self.count != other.count || self.models != other.models {
            return Ok(false);
        }
        if self.states.is(&other.states) {
            return Ok(true);
        }
        let (one, other) = (self.states.read(py, self.shape())?, other.states.read(py, other.shape())?);
        Ok(one.slice()? == other.slice()?)
    }

    fn __copy__(&self, py: Python<'_>) -> PyResult<Self> {
        self.copied(py)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyDict>) -> PyResult<Self> {
        self.copied(py)
    }

    #[classmethod]
    #[pyo3(signature = (texts, states, format=0, values=Vec::new(), failed=Vec::new()))]
    fn _from_parts(
        class: &Bound<'_, PyType>,
        texts: Vec<String>,
        states: Pieces,
        format: u32,
        values: Vec<(String, Pieces)>,
        failed: Vec<usize>,
    ) -> PyResult<Self> {
        if format != STATES_PICKLE {
            check_pickle(format)?;
        }
        let py = class.py();
        let values = values.into_iter().map(|(name, values)| Ok((name, numbers(&values.joined(py)?)?)));
        let models = models_kept(&texts, values.collect::<PyResult<_>>()?)?;
        let states = states.joined(py)?;
        let states = if format == PICKLE { rows_of(&states)? } else { numbers(&states)? };
        let count = states.len() / models.rows();
        if states.len() != models.rows() * count
            || !(1..=MOST).contains(&count)
            || models.count().is_some_and(|models| models != count)
        {
            let message = format!(
                "expected one model, or one for each contact, found {} for states of {} numbers",
                texts.len(),
                states.len()
            );
            return Err(refused_plainly::<ModelError>(message));
        }
        briefly(py, || models.check_states(&states, count))?.map_err(refused_plainly::<ModelError>)?;
        let mut made = Self::new_of(models, count, texts, &states);
        for index in failed {
            *made.failed.get_mut(index).ok_or_else(|| {
                refused_plainly::<ModelError>(format!("expected marks of {count} contacts, found one of contact {index}"))
            })? = true;
        }
        Ok(made)
    }

    #[expect(clippy::type_complexity, reason = "what pickle asks for")]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Made<'py, (Vec<String>, Vec<Piece>, u32, Vec<(String, Vec<Piece>)>, Vec<usize>)>> {
        let written = |numbers: &[f64]| {
            in_pieces(py, |out| numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes())))
        };
        let states = written(self.states.read(py, self.shape())?.slice()?)?;
        let values = self.models.parameters().map(|(parameter, values)| Ok((parameter.name().to_owned(), written(values)?)));
        let values = values.collect::<PyResult<Vec<_>>>()?;
        let make = py.get_type::<Self>().getattr("_from_parts")?;
        let failed = (0..self.count).filter(|index| self.failed[*index]).collect();
        Ok((make, (self.texts.clone(), states, STATES_PICKLE, values, failed)))
    }

    fn __repr__(&self) -> String {
        format!("<palpate.ContactStates: {} contacts>", self.count)
    }
}
