"""Quantities with a unit, of pint or of a library with the same two methods, as numbers in SI."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate._palpate import _SI_ENDINGS, OptionError, _unit_factor

#: What a key or an argument may end in where it is a number in SI, or several, with the unit: ``radius_m`` is ``radius`` in m.
ENDINGS = _SI_ENDINGS


def ending(name: str) -> str:
    """The ending of a name that states a unit; empty where there is none."""
    return next((end for end in ENDINGS if name.endswith(end) and len(name) > len(end)), "")


def is_quantity(value: Any) -> bool:
    """Whether a value is a number, or an array of them, with a unit."""
    return hasattr(value, "magnitude") and hasattr(value, "to_base_units")


def in_si(values: Any, name: str) -> Any:
    """The numbers of quantities: in the unit in which the name ends, or in the base units of SI; other values as they are.

    Arrays of xarray are quantities too where their attribute ``units`` states one and the name ends in a unit: a signal may be in any.
    """
    if hasattr(values, "dims") and hasattr(values, "attrs"):
        return _of_named_dimensions(values, name)
    if isinstance(values, (list, tuple)) and values and is_quantity(values[0]):
        bare = next((index for index, value in enumerate(values) if not is_quantity(value)), None)
        if bare is not None:
            raise OptionError(f"{name}: expected quantities with a unit everywhere, found one without at index {bare}")
        other = next((index for index, value in enumerate(values) if not value.is_compatible_with(values[0].units)), None)
        if other is not None:
            message = f"{name}: expected quantities of one dimension, found {values[0].units} and, at index {other}, {values[other].units}"
            raise OptionError(message)
        return [in_si(value, name) for value in values]
    if isinstance(values, (list, tuple)) or not is_quantity(values):
        return values
    unit = ENDINGS.get(ending(name.rstrip(")")), "")
    if not unit:
        return values.to_base_units().magnitude
    try:
        return values.to(_of_pint(unit)).magnitude
    except Exception as error:
        if type(error).__name__ != "DimensionalityError":
            raise
        raise OptionError(f"{name}: expected a quantity in {unit}, found one in {values.units}") from None


def _of_named_dimensions(values: Any, name: str) -> Any:
    """The numbers of an array of xarray in the unit in which the name ends; dates and durations, and those of no such name, as they are."""
    if is_quantity(getattr(values, "data", None)):
        return in_si(values.data, name)
    unit, stated = ENDINGS.get(ending(name.rstrip(")")), ""), str(values.attrs.get("units", "")).strip()
    if not unit or not stated or getattr(values.dtype, "kind", "") not in "biuf":
        return values
    # Times of the conventions for climate and forecast count from a date: "seconds since 2000-01-01".
    factor, accepted = _unit_factor(stated.partition(" since ")[0] if unit == "s" else stated, unit)
    if factor is None:
        message = f'{name}: expected a unit such as {accepted} in the attribute "units" of the array, found {stated!r}'
        raise OptionError(f"{message}\nhint: convert it, or state the unit of SI: array.assign_attrs(units={unit!r})")
    if factor == 1.0:
        return values
    # 35 mm are exactly the double 0.035, which 35 times 0.001 is not.
    inverse = round(1.0 / factor)
    is_inverse = inverse > 0 and abs(inverse * factor - 1.0) < 1e-12
    numbers = np.asarray(values, dtype=np.float64)
    return numbers / inverse if is_inverse else numbers * factor


def number(quantity: Any, unit: str) -> float:
    """One quantity in a unit."""
    if not quantity.is_compatible_with(_of_pint(unit)):
        raise OptionError(f"expected a quantity in {unit}, found one in {f'{quantity.units:~P}' or 'no unit'}")
    return float(quantity.to(_of_pint(unit)).magnitude)


def number_like(quantity: Any, column: Any) -> float:
    """One quantity in the base units of SI, where a column has the same dimension; without a column none has."""
    if column is None:
        message = f"expected a number in the unit of the signal, which a fit does not state, found a quantity in {quantity.units}"
        raise OptionError(f"{message}\nhint: give the number alone")
    first: Any = column[0] if isinstance(column, (list, tuple)) and column else column
    if not is_quantity(first):
        message = f"expected a number in the unit of the signal, which states none, found a quantity in {quantity.units}"
        raise OptionError(f"{message}\nhint: give the signal as a quantity too, or the number alone")
    if not quantity.is_compatible_with(first.units):
        raise OptionError(f"expected a quantity in {first.units}, the unit of the signal, found one in {quantity.units}")
    return float(quantity.to_base_units().magnitude)


def seconds(value: Any, name: str = "") -> float | None:
    """A duration of `datetime`, pandas or NumPy in s; None of anything else. The name is that of its place, for messages."""
    if isinstance(value, timedelta):
        return value.total_seconds()
    if not isinstance(value, np.timedelta64):
        return None
    check_duration(value, name)
    return float(value / np.timedelta64(1, "s"))


def check_duration(value: np.timedelta64 | NDArray[Any], name: str = "") -> None:
    """Refuses durations of NumPy that are no certain time: months and years differ in length, and some state no unit."""
    unit = np.datetime_data(value.dtype)[0]
    if unit in ("M", "Y", "generic"):
        found = {"M": "months, timedelta64[M]", "Y": "years, timedelta64[Y]", "generic": "timedelta64 without a unit"}[unit]
        message = f"expected durations in a unit of fixed length, found {found}"
        raise OptionError(f'{name + ": " if name else ""}{message}\nhint: state one, such as np.timedelta64(30, "D")')


def stated(quantity: Any, key: str) -> str | float:
    """One quantity as a description states it: a text with a unit of SI; a plain number where it has no dimension."""
    if quantity.dimensionless:
        return float(quantity.to_base_units().magnitude)
    units = *dict.fromkeys(ENDINGS.values()), "K"
    for unit in units:
        if quantity.is_compatible_with(_of_pint(unit)):
            return f"{float(quantity.to(_of_pint(unit)).magnitude)!r} {unit}"
    raise OptionError(f"{key}: expected a quantity in one of {', '.join(units)}, found one in {quantity.units}")


def _of_pint(unit: str) -> str:
    return f"1{unit}" if unit.startswith("/") else unit
