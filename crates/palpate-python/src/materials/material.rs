//! A calibrated body.

use std::path::{Path, PathBuf};

use numpy::PyArray2;
use palpate::calibrate::{EquilibriumLaw, Material as Body, MaterialParameter};
use palpate_files::description::{MaterialFile, parse_material, parse_protocol_of, read_protocol_of};
use palpate_jobs::output::write_file;
use palpate_jobs::{MaterialSource, PlanGrip, Predict};
use palpate_report::result::{sentence_of_misfit, si_unit};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyType};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

use crate::arrays::doubles;
use crate::errors::{
    ModelError, OptionError, choice, failed, of_mapping, refused, refused_plainly, undescribed, unwritten, warn,
};
use crate::files::stated;
use crate::fits::estimate::{PyEstimate, reported};
use crate::fits::fit::square;
use crate::mappings::quantity;
use crate::materials::grip::Grip;
use crate::materials::prediction::Prediction;
use crate::pickles::Made;
use crate::shown::shown;
use crate::table::{Table, columns};
use crate::work::job;

/// Reported where intervals know nothing of the parameters.
const OPEN: &str = "the calibration left a parameter open: the intervals are not known";

/// A calibrated body: shape, law and parameters with their covariance, the range of its test, and where they come from.
///
/// Made by `Record.calibrate` or `Material.read`. Wherever a protocol, a model or a test description is taken, its ``material`` may be
/// one, and a description may be one: ``palpate.simulate({"material": material, "step": [...]})``, ``palpate.ContactState(material)``,
/// ``record.analyze(test=material)``.
#[pyclass(name = "Material", module = "palpate", frozen, eq)]
#[derive(Clone)]
pub(crate) struct Material {
    source: MaterialSource,
}

impl PartialEq for Material {
    fn eq(&self, other: &Self) -> bool {
        self.source.file == other.source.file
    }
}

impl Material {
    /// Of a calibration; warns where it leaves a parameter open.
    pub(crate) fn of(py: Python<'_>, file: MaterialFile) -> PyResult<Self> {
        let material = Self {
            source: MaterialSource::of(file),
        };
        material.warn_of_open(py)?;
        Ok(material)
    }

    pub(crate) fn parsed(text: &str) -> PyResult<Self> {
        let file = parse_material(text, Path::new("material")).map_err(undescribed)?;
        Ok(Self {
            source: MaterialSource::of(file),
        })
    }

    /// What the observer is given of it.
    pub(crate) fn body(&self) -> Body {
        self.source.file.material.clone()
    }

    /// The file that it is from, or as it would be.
    pub(crate) fn source(&self) -> &MaterialSource {
        &self.source
    }

    fn warn_of_open(&self, py: Python<'_>) -> PyResult<()> {
        if self.source.file.material.uncertainty().is_none() { warn(py, OPEN) } else { Ok(()) }
    }

    fn estimated(&self) -> &[MaterialParameter] {
        self.source.file.material.parameters()
    }
}

/// Times of which each gets a row, in their order; none if they are left out.
pub(crate) fn rising_times(at_s: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<f64>> {
    let at_s = at_s.map(|times| doubles(times, "at_s")).transpose()?.unwrap_or_default();
    match (1..at_s.len()).find(|index| at_s[*index] <= at_s[index - 1]) {
        Some(index) => {
            let message = format!("at_s: expected times that rise, found {} s at index {index}", at_s[index]);
            Err(refused_plainly::<ModelError>(message))
        }
        None => Ok(at_s),
    }
}

/// A material inside of a pickle, as its file.
pub(crate) mod as_toml {
    use super::{Deserialize, Deserializer, Error, Material, Serializer};

    pub(crate) fn serialize<S: Serializer>(material: &Material, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&material.to_toml())
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Material, D::Error> {
        Material::parsed(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

shown! {
    Material: self
    getters {
        /// Name of the law as it was fitted, such as "latency", "latency:5" or "prony:2".
        law: String = self.source.file.material.candidate().to_string(),
        /// Law of the force once relaxation is over: "uniform-strain", "hertz" or "table".
        equilibrium: &'static str = match self.source.file.material.candidate().equilibrium {
            EquilibriumLaw::UniformStrain => "uniform-strain",
            EquilibriumLaw::Hertz { .. } => "hertz",
            EquilibriumLaw::Table => "table",
        },
        /// The parameters, a row each: ``parameter``, ``unit``, ``value``, ``standard_error``, ``low`` and ``high``, in SI; the latter three are missing
        /// for a parameter that was given, or that the record leaves open.
        parameter_table: PyResult<Table> = Table::of(columns!(self.estimated(), parameter =>
            parameter = parameter.name.clone(), unit = si_unit(parameter.unit), value = parameter.estimate.value,
            standard_error = parameter.estimate.standard_error,
            low = parameter.estimate.interval.map(|interval| interval.0),
            high = parameter.estimate.interval.map(|interval| interval.1)
        )),
        /// Every parameter by its name: "modulus_pa" (or "equilibrium_force_1_n", ...), and "exponent", "rate_coefficient_per_s" and "layer_thickness" of the
        /// latency law, "overshoot_1", "time_constant_1_s", ... of a linear one.
        estimates<'py>(py): PyResult<Bound<'py, PyDict>> = {
            let estimate = |parameter: &MaterialParameter| PyEstimate::of(parameter.estimate, si_unit(parameter.unit));
            self.estimated().iter().map(|parameter| (&parameter.name, estimate(parameter))).into_py_dict(py)
        },
        /// Values of all parameters by name, in SI.
        parameters<'py>(py): PyResult<Bound<'py, PyDict>> =
            self.estimated().iter().map(|parameter| (&parameter.name, parameter.estimate.value)).into_py_dict(py),
        /// Covariance of the natural logarithms of the parameters, in their order; None where the record leaves one open.
        log_covariance<'py>(py): PyResult<Option<Bound<'py, PyArray2<f64>>>> = {
            let uncertainty = self.source.file.material.uncertainty();
            uncertainty.map(|found| square(py, &found.covariance)).transpose()
        },
        /// Coverage of the intervals of the parameters; None where they have none.
        confidence: Option<f64> =
            self.source.file.material.uncertainty().map(|uncertainty| uncertainty.confidence),
        /// What the record shows against the law, and what helps, in a sentence; None where nothing. Grips state it first.
        misfit: Option<String> = {
            let MaterialFile { material, origin } = &self.source.file;
            origin.misfit.map(|misfit| sentence_of_misfit(&misfit, &material.candidate().to_string()))
        },
        /// Standard deviation of what the law left of the measured force, N: noise of one reading.
        noise_n: f64 = self.source.file.material.noise(),
        /// The range of the test, beyond which predictions are extrapolations: ``longest_hold_s`` of the displacement,
        /// ``longest_force_hold_s``, ``deepest_m``, ``fastest_m_per_s``, ``slowest_m_per_s``, ``largest_force_n``,
        /// ``farthest_retreat_m``, ``loadings``.
        calibration_range<'py>(py): PyResult<Bound<'py, PyDict>> = {
            let range = self.source.file.material.range();
            let named = [
                ("longest_hold_s", range.longest_hold),
                ("longest_force_hold_s", range.longest_force_hold),
                ("deepest_m", range.deepest),
                ("fastest_m_per_s", range.fastest),
                ("slowest_m_per_s", range.slowest),
                ("largest_force_n", range.largest_force),
                ("farthest_retreat_m", range.farthest_retreat),
                ("loadings", f64::from(range.loadings)),
            ];
            named.into_py_dict(py)
        },
        /// Where the parameters come from: ``record``, ``sha256`` of its file, number of ``specimens`` of a batch another of which it is, ``test`` description, version of ``palpate``, ``samples`` fitted.
        origin<'py>(py): PyResult<Bound<'py, PyDict>> = {
            let origin = &self.source.file.origin;
            let dict = PyDict::new(py);
            dict.set_item("record", &origin.record)?;
            dict.set_item("sha256", &origin.sha256)?;
            dict.set_item("specimens", origin.specimens)?;
            dict.set_item("test", &origin.test)?;
            dict.set_item("palpate", &origin.palpate)?;
            dict.set_item("samples", origin.samples)?;
            Ok(dict)
        },
    }

    /// The material in a file of ``palpate calibrate`` or of `write`, checked.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     A material file (TOML); ``palpate schema material`` prints its schema.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     No material, one of another version, or one whose parameters were changed by hand; the message names line and key.
    /// OSError
    ///     The operating system does not hand the file out.
    #[classmethod]
    #[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
    fn read(_class: &Bound<'_, PyType>, path: PathBuf) -> PyResult<Self> {
        let source = MaterialSource::read(&path).map_err(failed)?;
        Ok(Self { source })
    }

    /// Writes the file that ``palpate calibrate --out`` writes, whole or not at all.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     The file; its folder is made if it is not there.
    ///
    /// Raises
    /// ------
    /// PalpateError
    ///     The file cannot be written.
    #[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
    fn write(&self, path: PathBuf) -> PyResult<()> {
        write_file(&path, self.to_toml().as_bytes()).map_err(unwritten)
    }

    /// The same as text.
    pub(crate) fn to_toml(&self) -> String {
        self.source.file.to_toml()
    }

    /// What the body does under a protocol, or along the measured displacement of a record, with intervals: what ``palpate predict`` says.
    ///
    /// The variance of the force is the sum over the columns of a root of the covariance, C = L L^T, of ((f(+L_k) - f(-L_k))/2)^2.
    ///
    /// Parameters
    /// ----------
    /// protocol : path, mapping, sequence of mappings, or Record
    ///     A protocol whose body, if it has one, is left aside; or its steps alone: ``[{"to": "12 mm", "rate": "500 mm/min", "hold": "60 s"}]``.
    ///     Of a record the displacement is taken, from first touch on, corrected as its description says; the times are on its clock, and
    ///     its force serves to find first touch alone.
    /// at_s : array_like, shape (N,), optional
    ///     Times at which the force is wanted, s, rising and inside the motion; if left out those of the protocol's output, or the samples of
    ///     the record.
    /// confidence : float
    ///     Coverage of the intervals, between 0 and 1.
    ///
    /// Returns
    /// -------
    /// Prediction
    ///     Force and displacement with the intervals of their means and of one reading.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A protocol that says what no contact can do; a coverage that is no share.
    /// ModelError
    ///     A motion that the body cannot take, a time outside it.
    /// RecordError
    ///     A record without a displacement, or without phases.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     A longer hold, a deeper squeeze, a faster ramp, a larger force than the test has shown, or a force that is held: answered all
    ///     the same. A material of which a parameter was left open.
    #[pyo3(signature = (protocol, *, at_s=None, confidence=0.95))]
    fn predict(
        &self,
        py: Python<'_>,
        protocol: &Bound<'_, PyAny>,
        at_s: Option<&Bound<'_, PyAny>>,
        confidence: f64,
    ) -> PyResult<Prediction> {
        // A record knows how its own motion is found; what it needs is what is known of the body.
        if let Ok(by_record) = protocol.getattr("_predicted_by") {
            let predicted = by_record.call1((self.clone(), at_s, confidence))?;
            self.warn_of_open(py)?;
            return Ok(predicted.cast::<Prediction>()?.get().clone());
        }
        let (path, text) = stated("driven", protocol)?;
        let place = path.clone().unwrap_or_else(|| PathBuf::from("protocol"));
        let protocol = match path {
            Some(path) => read_protocol_of(&path, &self.source.file),
            None => parse_protocol_of(&text.unwrap_or_default(), &place, &self.source.file).map_err(of_mapping),
        };
        let protocol = protocol.map_err(undescribed)?;
        let at_s = rising_times(at_s)?;
        let question = Predict {
            at_s,
            confidence,
            ..Predict::default()
        };
        let source = self.source.clone();
        let done = job(py, move |watch| {
            let place = place.display().to_string();
            question.run((&source.file, &source.name), (&protocol, &place), false, watch)
        })?;
        self.warn_of_open(py)?;
        Prediction::of(py, done.result.prediction)
    }

    /// How to squeeze the body between two jaws, and how long that holds: what ``palpate grip`` says.
    ///
    /// Each jaw carries half of the weight and of the torsion about the closing axis. With T the tangential force at a jaw, M its torsion,
    /// a the radius of the contact and S the safety factor F = S sqrt(T^2 + (M/(c a))^2)/mu + m |a_closing|/2 is needed.
    ///
    /// Parameters
    /// ----------
    /// mass_kg : float
    ///     Mass of the body, kg.
    /// friction : float
    ///     Coefficient of friction between jaw and body.
    /// safety : float
    ///     Safety factor on friction, 1 or more.
    /// acceleration_up_m_per_s2, acceleration_across_m_per_s2, acceleration_closing_m_per_s2 : float
    ///     Acceleration of the hand upwards, across gravity in the plane of the jaws, and along the closing axis, m/s^2.
    /// torque_n_m : float
    ///     Torque about the closing axis, N m.
    /// off_centre_m : float
    ///     Distance of the centre of mass from the closing axis, m.
    /// gravity_m_per_s2 : float
    ///     Gravity, m/s^2.
    /// speed_m_per_s : float, optional
    ///     The fastest that the jaws go, m/s; the fastest ramp of the test if left out.
    /// stroke_m, most_force_n : float, optional
    ///     How far the jaws may squeeze, m, and the largest force that gripper and body bear, N.
    /// close_within_s : float, optional
    ///     How long closing may take, s; any time if left out.
    /// control : str
    ///     What the gripper holds once it has closed: "position" (the force relaxes) or "force" (the body creeps).
    /// squeeze_m : float, optional
    ///     Squeeze that is in question, m; the least that holds is sought if left out.
    /// force_n : float, optional
    ///     Force that is in question with ``control="force"``, N; the least that is enough if left out.
    /// hold_s : float, optional
    ///     How long it is to hold, s; ``math.inf`` for always. 60 s if neither this nor a squeeze is given.
    /// objective : str, optional
    ///     What the squeeze that is sought should have least of: "squeeze" (if left out), "peak-force" or "work".
    /// band_n : tuple of float, optional
    ///     Two forces, N, between which squeezes again and again keep the force.
    /// regrip : str, optional
    ///     What that schedule should have least of: "moves" (if left out) or "work".
    /// shortest_pause_s : float, optional
    ///     The shortest pause between two squeezes of that schedule, s; if left out, 1 with least work, and any with fewest moves.
    /// confidence : float
    ///     Probability with which the verdict has to hold, between 0 and 1; 0.5 for the best estimate. Intervals are of 95 %.
    ///
    /// Returns
    /// -------
    /// Grip
    ///     The squeeze that is in question, overshoot and back off, the force held and the schedule, beside one another. That none holds is an
    ///     answer: ``holds`` is false, ``refused`` says why.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     Parameters that describe no load, no gripper or no question; options that exclude each other.
    /// ModelError
    ///     A body that was tested bonded to its grips.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     A longer hold, a deeper squeeze, a faster ramp, a larger force than the test has shown, or a force that is held: answered all
    ///     the same. A material of which a parameter was left open.
    ///
    /// Examples
    /// --------
    /// 0.25 kg between jaws with a friction of 0.6 need 0.25 * 9.80665/(2 * 0.6) N.
    ///
    /// >>> import palpate
    /// >>> made = palpate.simulate({
    /// ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    /// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    /// ...     "step": [
    /// ...         {"to": "5 mm", "rate": "500 mm/min", "hold": "20 s"},
    /// ...         {"to": "9 mm", "rate": "500 mm/min", "hold": "20 s"},
    /// ...     ],
    /// ... })
    /// >>> record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
    /// >>> material = record.calibrate(test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[]).material
    /// >>> grip = material.grip(mass_kg=0.25, friction=0.6, squeeze_m=0.005)
    /// >>> round(grip.squeeze.needed_force_n, 3), round(grip.time_to_slip_s, 2)
    /// (2.043, 0.61)
    #[pyo3(signature = (
        *, mass_kg, friction, safety=1.0, acceleration_up_m_per_s2=0.0, acceleration_across_m_per_s2=0.0,
        acceleration_closing_m_per_s2=0.0, torque_n_m=0.0, off_centre_m=0.0, gravity_m_per_s2=9.80665, speed_m_per_s=None,
        stroke_m=None, most_force_n=None, close_within_s=None, control="position", squeeze_m=None, force_n=None, hold_s=None,
        objective=None, band_n=None, regrip=None, shortest_pause_s=None, confidence=0.95,
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn grip(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = quantity::kilograms)] mass_kg: f64,
        friction: f64,
        safety: f64,
        #[pyo3(from_py_with = quantity::metres_per_second_squared)] acceleration_up_m_per_s2: f64,
        #[pyo3(from_py_with = quantity::metres_per_second_squared)] acceleration_across_m_per_s2: f64,
        #[pyo3(from_py_with = quantity::metres_per_second_squared)] acceleration_closing_m_per_s2: f64,
        #[pyo3(from_py_with = quantity::newton_metres)] torque_n_m: f64,
        #[pyo3(from_py_with = quantity::metres)] off_centre_m: f64,
        #[pyo3(from_py_with = quantity::metres_per_second_squared)] gravity_m_per_s2: f64,
        #[pyo3(from_py_with = quantity::metres_per_second)] speed_m_per_s: Option<f64>,
        #[pyo3(from_py_with = quantity::metres)] stroke_m: Option<f64>,
        #[pyo3(from_py_with = quantity::newtons)] most_force_n: Option<f64>,
        #[pyo3(from_py_with = quantity::seconds)] close_within_s: Option<f64>,
        control: &str,
        #[pyo3(from_py_with = quantity::metres)] squeeze_m: Option<f64>,
        #[pyo3(from_py_with = quantity::newtons)] force_n: Option<f64>,
        #[pyo3(from_py_with = quantity::seconds)] hold_s: Option<f64>,
        objective: Option<&str>,
        #[pyo3(from_py_with = quantity::newtons)] band_n: Option<(f64, f64)>,
        regrip: Option<&str>,
        #[pyo3(from_py_with = quantity::seconds)] shortest_pause_s: Option<f64>,
        confidence: f64,
    ) -> PyResult<Grip> {
        if objective.is_some() && squeeze_m.is_some() {
            let message = "objective: expected either this or squeeze_m, found both";
            return Err(refused::<OptionError>(message, Some("leave squeeze_m out, and the squeeze is sought")));
        }
        for (option, given) in [("regrip", regrip.is_some()), ("shortest_pause_s", shortest_pause_s.is_some())] {
            if given && band_n.is_none() {
                let message = format!("{option} is for squeezes that keep the force in a band, and there is none");
                return Err(refused::<OptionError>(message, Some("add band_n, such as band_n=(2.1, 3.0)")));
            }
        }
        let question = PlanGrip {
            mass_kg,
            friction,
            safety,
            acceleration_up_m_per_s2,
            acceleration_across_m_per_s2,
            acceleration_closing_m_per_s2,
            torque_n_m,
            off_centre_m,
            gravity_m_per_s2: Some(gravity_m_per_s2),
            speed_m_per_s,
            stroke_m,
            most_force_n,
            close_within_s,
            control: choice("control", &["position", "force"], control)?,
            squeeze_m,
            force_n,
            hold_s: hold_s.filter(|time| *time != f64::INFINITY),
            hold_always: hold_s == Some(f64::INFINITY),
            objective: choice("objective", &["squeeze", "peak-force", "work"], objective.unwrap_or("squeeze"))?,
            band_n,
            regrip: choice("regrip", &["moves", "work"], regrip.unwrap_or("moves"))?,
            shortest_pause_s,
            confidence,
        };
        self.warn_of_open(py)?;
        Grip::of(py, self.source.clone(), question)
    }

    #[classmethod]
    fn _from_toml(_class: &Bound<'_, PyType>, text: &str) -> PyResult<Self> {
        Self::parsed(text)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        Ok((py.get_type::<Self>().getattr("_from_toml")?, (self.to_toml(),)))
    }

    fn __repr__(&self) -> String {
        let parameter = |parameter: &MaterialParameter| {
            let (value, unit) = (reported(&parameter.estimate, 4), si_unit(parameter.unit));
            let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
            format!("{}={value}{unit}", parameter.name)
        };
        let parameters: Vec<String> = self.estimated().iter().map(parameter).collect();
        format!("<palpate.Material {}: {}>", self.law(), parameters.join(", "))
    }

    /// The parameters with their intervals, for notebooks.
    fn _repr_html_(&self) -> PyResult<String> {
        Ok(format!("<p>Parameters of the law {}.</p>{}", self.law(), self.parameter_table()?._repr_html_()))
    }
}
