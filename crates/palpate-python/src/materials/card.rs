//! A material as a card of another simulator.

use palpate_jobs::{Engine, Export, MaterialSource, Results};
use pyo3::prelude::*;

use crate::errors::{one_of, warn};
use crate::mappings::quantity;
use crate::materials::material::Material;
use crate::work::job;

/// The document of ``palpate export --format json`` as text; its notes are warnings.
#[pyfunction]
#[pyo3(name = "_card", signature = (
    material, engine, *, depth_m, speed_m_per_s, slowest_m_per_s, hold_s, mass_kg, friction, poisson_ratio, terms_per_decade,
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn card(
    py: Python<'_>,
    material: &Material,
    engine: &str,
    #[pyo3(from_py_with = quantity::metres)] depth_m: Option<f64>,
    #[pyo3(from_py_with = quantity::metres_per_second)] speed_m_per_s: Option<f64>,
    #[pyo3(from_py_with = quantity::metres_per_second)] slowest_m_per_s: Option<f64>,
    #[pyo3(from_py_with = quantity::seconds)] hold_s: f64,
    #[pyo3(from_py_with = quantity::kilograms)] mass_kg: Option<f64>,
    friction: Option<f64>,
    poisson_ratio: Option<f64>,
    terms_per_decade: f64,
) -> PyResult<String> {
    let options = Export {
        engine: one_of("engine", &Engine::ALL.map(|engine| (engine.name(), engine)), engine)?,
        depth_m,
        speed_m_per_s,
        slowest_m_per_s,
        hold_s,
        mass_kg,
        friction,
        poisson_ratio,
        terms_per_decade,
    };
    let source: MaterialSource = material.source().clone();
    let (json, notes) = job(py, move |watch| {
        let outcome = options.run(&source, watch)?;
        Ok((outcome.result.json()?, outcome.notes))
    })?;
    notes.iter().try_for_each(|note| warn(py, note))?;
    Ok(json)
}
