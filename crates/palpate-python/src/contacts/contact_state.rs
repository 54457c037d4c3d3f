//! Contacts that a controller moves one step at a time: one, or many side by side.

use std::io::Write;

use numpy::{Element, PyArray1};
use palpate::simulate::{ContactModel, ContactState as State, ContactStates as Contacts, NextStates, OneStepError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple, PyType};

use super::described::{all_described, described, model_of};
use crate::arrays::{AT_ONCE, array, doubles};
use crate::errors::{ModelError, OptionError, refused_plainly};
use crate::pickles::{Made, PICKLE, Piece, Pieces, check_pickle, in_pieces};
use crate::shown::shown;
use crate::work::briefly;

/// A state out of a pickle, of a contact of this model: one that has a force.
fn state_of(model: &ContactModel, bytes: [u8; State::BYTES]) -> PyResult<State> {
    let state = State::from_bytes(bytes).map_err(refused_plainly::<ModelError>)?;
    match state.force(model).is_finite() {
        true => Ok(state),
        false => {
            Err(refused_plainly::<ModelError>("expected a state within the range of the body, found one beyond it"))
        }
    }
}

/// A contact that a controller moves one step at a time, in closed form and in constant time.
///
/// Motion and drift follow each other within a step (Strang's splitting): the error falls with the square of ``dt_s``. A ball of 35 mm
/// that is squeezed by 5 mm at 50 mm/s ends with a force that is 1.2 % too large in steps of 10 ms, 0.013 % in steps of 1 ms, and 63 %
/// in one step of 100 ms; `simulate` integrates such motions to a tolerance.
///
/// Parameters
/// ----------
/// model : path or mapping
///     A protocol's tables ``specimen``, ``law`` and ``contact``; steps are left aside.
///
/// Examples
/// --------
/// >>> import palpate
/// >>> state = palpate.ContactState({
/// ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
/// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
/// ... })
/// >>> forces = [state.step(1e-3, 5e-5 * (k + 1)) for k in range(100)]
/// >>> round(forces[-1], 3)
/// 3.886
#[pyclass(name = "ContactState", module = "palpate")]
#[derive(Clone)]
pub(crate) struct ContactState {
    model: ContactModel,
    state: State,
    /// The description, so that the state can be sent elsewhere.
    text: String,
}

shown! {
    ContactState: self
    copied getters {
        /// Force now, N.
        force_n: f64 = self.state.force(&self.model),
        /// Displacement of the surface of the body at one contact, m.
        surface_m: f64 = self.state.surface(&self.model),
        /// Whether the jaw touches the body.
        is_touching: bool = self.state.is_touching(&self.model),
    }

    #[new]
    fn new(model: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (model, text) = described(model)?;
        Ok(Self {
            model,
            state: State::default(),
            text,
        })
    }

    /// Moves the jaw to a displacement within a time step.
    ///
    /// Parameters
    /// ----------
    /// dt_s : float
    ///     Length of the step, s; 0 or more.
    /// displacement_m : float
    ///     Where the jaw stands at its end, m; it goes there at constant speed.
    ///
    /// Returns
    /// -------
    /// float
    ///     Force at its end, N.
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     A step below 0, a displacement beyond the body; the state stays as it was.
    fn step(&mut self, dt_s: f64, displacement_m: f64) -> PyResult<f64> {
        self.state.step(&self.model, dt_s, displacement_m).map_err(refused_plainly::<ModelError>)
    }

    /// Applies a force within a time step.
    ///
    /// Parameters
    /// ----------
    /// dt_s : float
    ///     Length of the step, s; 0 or more.
    /// force_n : float
    ///     The force over the step, N.
    ///
    /// Returns
    /// -------
    /// float
    ///     Displacement of the jaw at its end, m.
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     A step below 0, a force that the body cannot bear; the state stays as it was.
    fn step_force(&mut self, dt_s: f64, force_n: f64) -> PyResult<f64> {
        self.state.step_force(&self.model, dt_s, force_n).map_err(refused_plainly::<ModelError>)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.model == other.model && self.state == other.state
    }

    #[classmethod]
    #[pyo3(signature = (text, state, format=0))]
    fn _from_parts(_class: &Bound<'_, PyType>, text: String, state: [u8; State::BYTES], format: u32) -> PyResult<Self> {
        check_pickle(format)?;
        let model = model_of(&text)?;
        Ok(Self {
            state: state_of(&model, state)?,
            model,
            text,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String, Bound<'py, PyBytes>, u32)>> {
        let make = py.get_type::<Self>().getattr("_from_parts")?;
        Ok((make, (self.text.clone(), PyBytes::new(py, &self.state.to_bytes()), PICKLE)))
    }

    fn __repr__(&self) -> String {
        format!("<palpate.ContactState: {} N>", palpate::number::significant(self.force_n(), 4))
    }
}

/// Contacts that are moved side by side, such as those of many grippers, or of one under many guesses.
///
/// Parameters
/// ----------
/// model : path or mapping, or a list of them
///     One model for ``count`` contacts, or one each.
/// count : int, optional
///     How many, of one model; none beside a list.
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
#[pyclass(name = "ContactStates", module = "palpate", eq)]
#[derive(Clone)]
pub(crate) struct ContactStates {
    contacts: Contacts,
    /// The description of all, or one each, so that they can be sent elsewhere.
    texts: Vec<String>,
}

impl PartialEq for ContactStates {
    fn eq(&self, other: &Self) -> bool {
        self.contacts == other.contacts
    }
}

/// Contacts that fit into the memory of a small machine.
const MOST: usize = 100_000_000;

/// An array of a number for every contact, or one for all.
fn for_each(values: &Bound<'_, PyAny>, name: &str, count: usize) -> PyResult<Vec<f64>> {
    if let Ok(one) = values.extract::<f64>() {
        return Ok(vec![one]);
    }
    let found = doubles(values, name)?;
    if found.len() == count {
        return Ok(found);
    }
    let message = format!("{name}: expected one number or {count}, one a contact, found {}", found.len());
    Err(refused_plainly::<OptionError>(message))
}

/// A step of contacts up to one of them.
type StepUntil = fn(&Contacts, usize, &[f64], &[f64], &mut NextStates) -> Result<(), OneStepError>;

impl ContactStates {
    /// Steps all contacts, or none if one cannot.
    fn stepped<'py>(
        &mut self,
        py: Python<'py>,
        dt_s: &Bound<'py, PyAny>,
        (to, name): (&Bound<'py, PyAny>, &str),
        step: StepUntil,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.contacts.count();
        let (dt, to) = (for_each(dt_s, "dt_s", count)?, for_each(to, name, count)?);
        let mut next = NextStates::default();
        while next.count() < count {
            py.check_signals()?;
            let until = next.count() + AT_ONCE;
            briefly(py, || step(&self.contacts, until, &dt, &to, &mut next))?.map_err(refused_plainly::<ModelError>)?;
        }
        Ok(PyArray1::from_vec(py, self.contacts.take(next)))
    }

    fn of_each<'py, T: Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&State, &ContactModel) -> T,
    ) -> PyResult<Bound<'py, PyArray1<T>>> {
        let contacts = &self.contacts;
        array(py, (0..contacts.count()).map(|index| of(&contacts.state(index), contacts.model(index))))
    }
}

shown! {
    ContactStates: self
    copied getters {
        /// Forces now, N.
        force_n<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = self.of_each(py, State::force),
        /// Displacements of the surfaces at one contact each, m.
        surface_m<'py>(py): PyResult<Bound<'py, PyArray1<f64>>> = self.of_each(py, State::surface),
        /// Whether the jaws touch their bodies.
        is_touching<'py>(py): PyResult<Bound<'py, PyArray1<bool>>> = self.of_each(py, State::is_touching),
    }

    #[new]
    #[pyo3(signature = (model, count=None))]
    fn new(model: &Bound<'_, PyAny>, count: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let several = model.is_instance_of::<PyList>() || model.is_instance_of::<PyTuple>();
        let requested = |found: String| {
            let message = format!(
                "count: expected how many contacts of one model, 1 to {MOST}, or none beside a list of models, found {found}"
            );
            refused_plainly::<OptionError>(message)
        };
        let count = match count {
            None if several => None,
            None => return Err(requested("none".to_owned())),
            Some(count) if several => return Err(requested(format!("a list and {count}"))),
            Some(count) => match count.extract::<usize>() {
                Ok(number) if (1..=MOST).contains(&number) => Some(number),
                _ => return Err(requested(count.to_string())),
            },
        };
        let described: Vec<(ContactModel, String)> = match count {
            Some(_) => vec![described(model)?],
            None => all_described(model)?,
        };
        if described.is_empty() {
            return Err(requested("an empty list".to_owned()));
        }
        let states = vec![State::default(); count.unwrap_or(described.len())];
        let (models, texts) = described.into_iter().unzip();
        let contacts = Contacts::of_states(models, &states);
        Ok(Self { contacts, texts })
    }

    /// Moves every jaw to its displacement within a time step; all contacts, or none if one cannot.
    ///
    /// Parameters
    /// ----------
    /// dt_s, displacement_m : float or array_like, shape (N,)
    ///     As for `ContactState.step`; one number stands for all contacts.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (N,)
    ///     Forces, N.
    ///
    /// Raises
    /// ------
    /// ModelError
    ///     A step that one contact cannot make; the message says which.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        dt_s: &Bound<'py, PyAny>,
        displacement_m: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.stepped(py, dt_s, (displacement_m, "displacement_m"), Contacts::step_until)
    }

    /// Applies a force to every contact within a time step, as `step` does a displacement.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (N,)
    ///     Displacements of the jaws, m.
    fn step_force<'py>(
        &mut self,
        py: Python<'py>,
        dt_s: &Bound<'py, PyAny>,
        force_n: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.stepped(py, dt_s, (force_n, "force_n"), Contacts::step_force_until)
    }

    fn __len__(&self) -> usize {
        self.contacts.count()
    }

    #[classmethod]
    #[pyo3(signature = (texts, states, format=0))]
    fn _from_parts(
        class: &Bound<'_, PyType>,
        texts: Vec<String>,
        states: Pieces,
        format: u32,
    ) -> PyResult<Self> {
        check_pickle(format)?;
        let py = class.py();
        let states = states.joined(py)?;
        let (parts, rest) = states.as_chunks::<{ State::BYTES }>();
        if !rest.is_empty() {
            let message = format!("expected states of {} bytes, found {} more", State::BYTES, rest.len());
            return Err(refused_plainly::<ModelError>(message));
        }
        let (models, count) = (texts.len(), parts.len());
        if models == 0 || !(1..=MOST).contains(&count) || (models > 1 && models != count) {
            let message = format!("expected one model, or one for each contact, found {models} for {count} contacts");
            return Err(refused_plainly::<ModelError>(message));
        }
        let models: Vec<ContactModel> = texts.iter().map(|text| model_of(text)).collect::<PyResult<_>>()?;
        let mut kept = Vec::with_capacity(count);
        for (model, state) in models.iter().cycle().zip(parts) {
            if kept.len().is_multiple_of(AT_ONCE) {
                py.check_signals()?;
            }
            kept.push(state_of(model, *state)?);
        }
        let contacts = Contacts::of_states(models, &kept);
        Ok(Self { contacts, texts })
    }

    #[expect(clippy::type_complexity, reason = "what pickle asks for")]
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (Vec<String>, Vec<Piece>, u32)>> {
        let states = in_pieces(py, |out| {
            let mut states = (0..self.contacts.count()).map(|index| self.contacts.state(index));
            states.try_for_each(|state| out.write_all(&state.to_bytes()))
        })?;
        let make = py.get_type::<Self>().getattr("_from_parts")?;
        Ok((make, (self.texts.clone(), states, PICKLE)))
    }

    fn __repr__(&self) -> String {
        format!("<palpate.ContactStates: {} contacts>", self.contacts.count())
    }
}
