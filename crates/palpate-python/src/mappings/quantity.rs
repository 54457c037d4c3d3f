//! Single numbers in SI among the arguments of a call: plain ones, quantities with a unit, of pint, and durations.

use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyInt};

use super::{is_with_unit, units};

/// One number, none, or the two ends of a range.
pub(crate) trait Quantity: Sized {
    /// From a value of Python, whose numbers are in `unit` where they state none.
    fn in_unit(value: &Bound<'_, PyAny>, unit: &str) -> PyResult<Self>;
}

impl Quantity for f64 {
    fn in_unit(value: &Bound<'_, PyAny>, unit: &str) -> PyResult<Self> {
        if value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>() {
            return value.extract();
        }
        if unit == "s"
            && let Some(seconds) = units(value)?.call_method1("seconds", (value,))?.extract()?
        {
            return Ok(seconds);
        }
        match is_with_unit(value)? {
            // PyO3 adds the name of the argument to what is refused.
            true => units(value)?.call_method1("number", (value, unit))?.extract(),
            false => value.extract(),
        }
    }
}

impl<T: Quantity> Quantity for Option<T> {
    fn in_unit(value: &Bound<'_, PyAny>, unit: &str) -> PyResult<Self> {
        if value.is_none() { Ok(None) } else { T::in_unit(value, unit).map(Some) }
    }
}

impl Quantity for (f64, f64) {
    fn in_unit(value: &Bound<'_, PyAny>, unit: &str) -> PyResult<Self> {
        let (low, high): (Bound<'_, PyAny>, Bound<'_, PyAny>) = match is_with_unit(value)? {
            true => (value.get_item(0)?, value.get_item(1)?),
            false => value.extract()?,
        };
        Ok((f64::in_unit(&low, unit)?, f64::in_unit(&high, unit)?))
    }
}

/// Extractors of arguments, named after the unit of SI that a plain number is in.
macro_rules! in_units {
    ($($name:ident: $unit:literal,)*) => {
        $(
            pub(crate) fn $name<T: Quantity>(value: &Bound<'_, PyAny>) -> PyResult<T> {
                T::in_unit(value, $unit)
            }
        )*
    };
}

in_units! {
    seconds: "s",
    per_second: "/s",
    hertz: "Hz",
    metres: "m",
    metres_per_second: "m/s",
    metres_per_second_squared: "m/s^2",
    newtons: "N",
    newton_metres: "N m",
    kilograms: "kg",
}
