//! A contact that a controller moves one step at a time.

use palpate::simulate::{ContactModel, ContactState as State};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyType};

use super::described::{described, model_of};
use crate::errors::{ModelError, refused_plainly};
use crate::mappings::quantity;
use crate::pickles::{Made, PICKLE, check_pickle};
use crate::shown::shown;

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
        /// Tangent stiffness dF/dd against the displacement of the jaw now, N/m.
        stiffness_n_per_m: f64 = self.state.stiffness(&self.model),
        /// Excess strain of the contact layer, which drives the law.
        excess_strain: f64 = self.state.excess_strain(&self.model),
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
    fn step(
        &mut self,
        #[pyo3(from_py_with = quantity::seconds)] dt_s: f64,
        #[pyo3(from_py_with = quantity::metres)] displacement_m: f64,
    ) -> PyResult<f64> {
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
    fn step_force(
        &mut self,
        #[pyo3(from_py_with = quantity::seconds)] dt_s: f64,
        #[pyo3(from_py_with = quantity::newtons)] force_n: f64,
    ) -> PyResult<f64> {
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
