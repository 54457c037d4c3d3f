//! A mapping of Python as the text of a description: numbers in SI under a key that says the unit become texts with it.

pub(crate) mod quantity;

use std::fmt;

use numpy::PyUntypedArray;
use palpate::units::{Dimension, factor};
use palpate_files::naming::unit_factor;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyRange, PyString, PyTuple};

use crate::errors::{OptionError, refused, refused_plainly};

/// What a key of a mapping, or an argument, may end in where it is a number in SI, or several: `radius_m` is `radius` in m.
pub(crate) const UNITS: [(&str, &str); 8] = [
    ("_m_per_s", "m/s"),
    ("_n_per_s", "N/s"),
    ("_per_s", "/s"),
    ("_pa", "Pa"),
    ("_m2", "m^2"),
    ("_n", "N"),
    ("_s", "s"),
    ("_m", "m"),
];

/// The dimensions of these units.
const DIMENSIONS: [Dimension; 8] = [
    Dimension::Speed,
    Dimension::ForceRate,
    Dimension::Rate,
    Dimension::Pressure,
    Dimension::Area,
    Dimension::Force,
    Dimension::Time,
    Dimension::Length,
];

/// The factor from a unit, as people write it, to one of SI; None where it is none of its dimension. And the units that are.
#[pyfunction]
pub(crate) fn _unit_factor(unit: &str, si: &str) -> (Option<f64>, String) {
    let dimension = DIMENSIONS.iter().find(|dimension| factor(si, **dimension) == Some(1.0));
    dimension.map_or((None, si.to_owned()), |dimension| (unit_factor(unit, *dimension), dimension.accepted()))
}

/// Tables and lists inside each other.
const DEEPEST: usize = 64;

/// A mapping with the tables of a description as its text in TOML.
#[pyfunction]
pub(crate) fn mapping_text(table: &Bound<'_, PyAny>) -> PyResult<String> {
    let mut text = String::with_capacity(256);
    for (key, value) in entries(table, None)? {
        write_string(&mut text, &key.bare);
        text.push_str(" = ");
        key.write(&mut text, &value, None)?;
        text.push('\n');
    }
    Ok(text)
}

/// A key of a table, less its unit.
struct Key {
    name: String,
    bare: String,
    unit: Option<&'static str>,
}

impl Key {
    fn new(name: String) -> Self {
        let ending = UNITS.iter().find(|(end, _)| name.len() > end.len() && name.ends_with(end));
        let bare = ending.map_or(name.as_str(), |(end, _)| &name[..name.len() - end.len()]).to_owned();
        Self {
            unit: ending.map(|(_, unit)| *unit),
            name,
            bare,
        }
    }

    fn write(&self, text: &mut String, value: &Bound<'_, PyAny>, above: Option<&Place<'_>>) -> PyResult<()> {
        let place = Place::new(above, Part::Key(&self.name));
        match self.unit {
            Some(unit) => write_quantity(text, value, unit, (&self.bare, &place)),
            None => write_value(text, value, &place),
        }
    }
}

/// Where something stands in a mapping, for messages: `step[1].hold` of the second step, as Python counts.
struct Place<'a> {
    above: Option<&'a Place<'a>>,
    part: Part<'a>,
    depth: usize,
}

enum Part<'a> {
    Key(&'a str),
    Entry(usize),
}

impl<'a> Place<'a> {
    fn new(above: Option<&'a Place<'a>>, part: Part<'a>) -> Self {
        let depth = above.map_or(1, |above| above.depth + 1);
        Self { above, part, depth }
    }
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(above) = self.above {
            above.fmt(f)?;
        }
        match self.part {
            Part::Key(name) if self.above.is_some() => write!(f, ".{name}"),
            Part::Key(name) => f.write_str(name),
            Part::Entry(number) => write!(f, "[{number}]"),
        }
    }
}

/// The entries of a mapping, none of them twice.
fn entries<'py>(table: &Bound<'py, PyAny>, place: Option<&Place<'_>>) -> PyResult<Vec<(Key, Bound<'py, PyAny>)>> {
    let pairs: Vec<(Bound<'py, PyAny>, Bound<'py, PyAny>)> = match table.cast::<PyDict>() {
        Ok(dict) => dict.iter().collect(),
        Err(_) => table.cast::<PyMapping>()?.items()?.iter().map(|item| item.extract()).collect::<PyResult<_>>()?,
    };
    let mut all: Vec<(Key, Bound<'py, PyAny>)> = Vec::with_capacity(pairs.len());
    for (name, value) in pairs {
        let key = Key::new(name.str()?.to_str()?.to_owned());
        if all.iter().any(|(other, _)| other.bare == key.bare) {
            let above = |name: &str| Place::new(place, Part::Key(name)).to_string();
            // The one with the unit is named first, in whichever order they stand.
            let other = all.iter().find(|(other, _)| other.bare == key.bare && other.unit.is_some());
            let with_unit = other.map_or(key.name.as_str(), |(other, _)| &other.name);
            let message = format!("{}: expected either this or {}, found both", above(with_unit), above(&key.bare));
            return Err(refused::<OptionError>(message, Some("remove one of them")));
        }
        all.push((key, value));
    }
    Ok(all)
}

fn write_value(text: &mut String, value: &Bound<'_, PyAny>, place: &Place<'_>) -> PyResult<()> {
    if place.depth > DEEPEST {
        return Err(refused_plainly::<OptionError>(format!("expected tables at most {DEEPEST} deep, found more")));
    }
    if let Ok(string) = value.cast::<PyString>() {
        write_string(text, string.to_str()?);
    } else if value.is_exact_instance_of::<PyInt>() {
        // What most entries are is looked for first: to ask for a class of Python's takes longer than all the rest.
        text.push_str(value.str()?.to_str()?);
    } else if let Ok(number) = value.cast_exact::<PyFloat>() {
        text.push_str(&format!("{:?}", finite(number.value(), place)?));
    } else if value.cast::<PyMapping>().is_ok() {
        text.push('{');
        for (index, (key, entry)) in entries(value, Some(place))?.iter().enumerate() {
            text.push_str(if index > 0 { ", " } else { "" });
            write_string(text, &key.bare);
            text.push_str(" = ");
            key.write(text, entry, Some(place))?;
        }
        text.push('}');
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        write_list(text, value, place, |text, entry, place| write_value(text, entry, place))?;
    } else if let Some(seconds) = duration(value, place)? {
        write_string(text, &format!("{:?} s", finite(seconds, place)?));
    } else if value.is_instance_of::<PyBool>() || is_of(value, "numpy", "bool_")? {
        text.push_str(if value.is_truthy()? { "true" } else { "false" });
    } else if value.is_instance_of::<PyInt>() || is_of(value, "numbers", "Integral")? {
        text.push_str(value.call_method0("__int__")?.str()?.to_str()?);
    } else if let Some(number) = real(value)? {
        text.push_str(&format!("{:?}", finite(number, place)?));
    } else if is_with_unit(value)? {
        let stated = units(value)?.call_method1("stated", (value, place.to_string()))?;
        write_value(text, &stated, place)?;
    } else if let Some(list) = listed(value)? {
        write_list(text, &list, place, |text, entry, place| write_value(text, entry, place))?;
    } else {
        let found = value.get_type().name()?;
        let message = format!("{place}: expected a text, a number, a list or a table, found {found}");
        return Err(refused_plainly::<OptionError>(message));
    }
    Ok(())
}

/// A number in SI, or several, with the unit that its key says.
fn write_quantity(
    text: &mut String,
    value: &Bound<'_, PyAny>,
    unit: &str,
    (bare, place): (&str, &Place<'_>),
) -> PyResult<()> {
    let several = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    if place.depth < DEEPEST && (several || value.is_instance_of::<PyUntypedArray>()) {
        return write_list(text, value, place, |text, entry, place| write_quantity(text, entry, unit, (bare, place)));
    }
    if is_with_unit(value)? {
        let in_si = units(value)?.call_method1("in_si", (value, place.to_string()))?;
        return write_quantity(text, &in_si, unit, (bare, place));
    }
    let number = match unit {
        _ if value.is_instance_of::<PyBool>() => None,
        "s" => duration(value, place)?.map_or_else(|| real(value), |seconds| Ok(Some(seconds)))?,
        _ => real(value)?,
    };
    if number.is_none()
        && place.depth < DEEPEST
        && let Some(list) = listed(value)?
    {
        return write_quantity(text, &list, unit, (bare, place));
    }
    let Some(number) = number else {
        let message = format!("{place}: expected a number in {unit}, found {}", value.repr()?);
        return Err(refused::<OptionError>(
            message,
            Some(format!("write the number alone, or {bare} = \"... {unit}\"")),
        ));
    };
    write_string(text, &format!("{:?} {unit}", finite(number, place)?));
    Ok(())
}

fn write_list<'py>(
    text: &mut String,
    list: &Bound<'py, PyAny>,
    place: &Place<'_>,
    mut write: impl FnMut(&mut String, &Bound<'py, PyAny>, &Place<'_>) -> PyResult<()>,
) -> PyResult<()> {
    text.push('[');
    for (index, entry) in list.try_iter()?.enumerate() {
        text.push_str(if index > 0 { ", " } else { "" });
        write(text, &entry?, &Place::new(Some(place), Part::Entry(index)))?;
    }
    text.push(']');
    Ok(())
}

/// A text in quotes, with what TOML wants escaped.
fn write_string(text: &mut String, string: &str) {
    text.push('"');
    for character in string.chars() {
        match character {
            '"' | '\\' => text.extend(['\\', character]),
            '\0'..='\x1f' | '\x7f' => text.push_str(&format!("\\u{:04x}", u32::from(character))),
            _ => text.push(character),
        }
    }
    text.push('"');
}

/// A column of NumPy, pandas, polars, pyarrow or xarray, or a range, as a list; none of what is not a column.
fn listed<'py>(value: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyAny>>> {
    if !(value.hasattr("__array__")? || value.is_instance_of::<PyRange>()) {
        return Ok(None);
    }
    let array = value.py().import("numpy")?.call_method1("asarray", (value,))?;
    let is_column = array.getattr("ndim")?.eq(1)?;
    // NumPy lists durations in nanoseconds as whole numbers: as a list of its own they keep their unit.
    let of_durations = array.getattr("dtype")?.getattr("kind")?.eq("m")?;
    let list = || {
        if of_durations {
            Ok(PyList::new(value.py(), array.try_iter()?.collect::<PyResult<Vec<_>>>()?)?.into_any())
        } else {
            array.call_method0("tolist")
        }
    };
    is_column.then(list).transpose()
}

/// A duration of `datetime`, pandas or NumPy in s; none of anything else.
fn duration(value: &Bound<'_, PyAny>, place: &Place<'_>) -> PyResult<Option<f64>> {
    match value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>() {
        true => Ok(None),
        false => units(value)?.call_method1("seconds", (value, place.to_string()))?.extract(),
    }
}

/// A real number that is neither a truth value nor a duration.
fn real(value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if let Ok(number) = value.cast_exact::<PyFloat>() {
        return Ok(Some(number.value()));
    }
    match is_of(value, "numbers", "Real")? && !is_of(value, "numpy", "timedelta64")? {
        true => Ok(Some(value.call_method0("__float__")?.extract()?)),
        false => Ok(None),
    }
}

fn finite(number: f64, place: &Place<'_>) -> PyResult<f64> {
    match number.is_finite() {
        true => Ok(number),
        false => {
            let found = if number.is_nan() {
                "nan"
            } else if number > 0.0 {
                "inf"
            } else {
                "-inf"
            };
            Err(refused_plainly::<OptionError>(format!("{place}: expected a finite number, found {found}")))
        }
    }
}

/// Whether a value is a number with a unit, of pint.
pub(crate) fn is_with_unit(value: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(value.hasattr("magnitude")? && value.hasattr("to_base_units")?)
}

/// The module that converts such values.
pub(crate) fn units<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyModule>> {
    value.py().import("palpate._units")
}

/// Whether a value is of a class of Python's.
fn is_of(value: &Bound<'_, PyAny>, module: &str, class: &str) -> PyResult<bool> {
    value.is_instance(&value.py().import(module)?.getattr(class)?)
}
