"""Arrays as the compiled part takes them: contiguous aligned doubles, or an error that says what was found."""

from __future__ import annotations

from datetime import timedelta, timezone
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate import _units
from palpate._palpate import OptionError


def as_doubles(values: Any, name: str, omit_nan: bool = False) -> NDArray[np.float64]:
    """One column of numbers as contiguous doubles.

    Takes arrays of any real type, order and stride, lists, and columns of pandas, polars and pyarrow. Quantities of pint are
    converted to the unit in which the name ends, or to SI. Durations are seconds where the name ends in ``_s``; ``time_s`` also
    takes dates, as seconds since the first. Text, complex numbers and more than one dimension are refused, and so is what is
    missing, unless `omit_nan`: then it is NaN.
    """
    values = _units.in_si(values, name)
    _check_not_lazy(values, name, "a column of numbers")
    if not omit_nan:
        _check_numbers(values, name)
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        if omit_nan:
            return as_doubles(np.ma.filled(values.astype(np.float64), np.nan), name)
        at = int(np.flatnonzero(np.ma.getmaskarray(values))[0])
        raise OptionError(f"{name}: expected a number everywhere, found a masked one at index {at}")
    try:
        array = np.asarray(values)
    except ValueError:
        raise OptionError(f"{name}: expected one column of numbers, found lists of different lengths") from None
    if array.ndim == 0:
        raise OptionError(f"{name}: expected a column of numbers, found {_reported(values)}")
    if array.ndim > 1:
        raise OptionError(f"{name}: expected one column of numbers, found an array of shape {array.shape}")
    if array.size == 0:
        return np.empty(0)
    if array.dtype.kind == "O" and not omit_nan:
        missing = [index for index, value in enumerate(array) if value is None]
        if missing:
            raise OptionError(f"{name}: expected a number everywhere, found None at index {missing[0]}")
    array = _seconds(array, name)
    if array.dtype.kind not in "biufO":
        raise OptionError(f"{name}: expected numbers, found {array.dtype}")
    if array.dtype.kind == "O" and omit_nan:
        array = np.array([np.nan if type(value).__name__ in ("NoneType", "NAType", "NaTType") else value for value in array])
    try:
        return np.require(array, dtype=np.float64, requirements=("C", "A"))
    except (TypeError, ValueError):
        raise OptionError(f"{name}: expected numbers, found {_reported(array[0])}") from None


def _check_not_lazy(values: Any, name: str, expected: str) -> None:
    """Refuses a table or column that is yet to be computed, of polars and dask."""
    if hasattr(values, "collect") and not hasattr(values, "__array__"):
        raise OptionError(f"{name}: expected {expected}, found {type(values).__name__}\nhint: compute it, .collect(), and pass a column of it")


def _check_numbers(values: Any, name: str) -> None:
    """Refuses a column of polars without any value, which as an array of NumPy is one of NaN."""
    if str(getattr(values, "dtype", "")) == "Null" and len(values):
        raise OptionError(f"{name}: expected a number everywhere, found none at index 0")


def _dates(array: NDArray[Any], name: str) -> NDArray[np.datetime64] | None:
    """Dates as those of NumPy; None of another column. All of them have a time zone, or none has."""
    if array.dtype.kind == "O" and array.size and not isinstance(array[0], timedelta) and hasattr(array[0], "timestamp"):
        found = np.array([_moment_ns(moment, index) for index, moment in enumerate(array)], dtype="datetime64[ns]")
        zones = {moment.tzinfo is not None: index for index, moment in reversed([*enumerate(array)]) if not _is_missing(moment)}
        if len(zones) > 1:
            first, other = (("with", "without") if zones[True] < zones[False] else ("without", "with"))
            message = f"{name}: expected dates {first} a time zone everywhere, as the first has, found one {other} at index {max(zones.values())}"
            raise OptionError(f"{message}\n{_ZONE_HINT}")
        return found
    return array if array.dtype.kind == "M" else None


#: What helps where dates with a time zone meet dates without one.
_ZONE_HINT = (
    "hint: give all of them their zone: column.dt.tz_localize(zone) of pandas, column.dt.replace_time_zone(zone) of polars, "
    "date.replace(tzinfo=zone) of datetime"
)


def _is_missing(moment: Any) -> bool:
    """Whether a date is the missing one, which has no time zone."""
    return bool(moment != moment)


def _has_zone(values: Any, array: NDArray[Any]) -> bool | None:
    """Whether the dates of a column have a time zone; None where none of them is known.

    Those of polars and Arrow are dates of NumPy as an array, which have none.
    """
    kind = getattr(values, "dtype", getattr(values, "type", None))
    if getattr(kind, "time_zone", None) is not None or getattr(kind, "tz", None) is not None:
        return True
    if array.dtype.kind == "M":
        return None if np.isnat(array).all() else False
    known = next((moment for moment in array if not _is_missing(moment)), None)
    return None if known is None else known.tzinfo is not None


def _moment_ns(moment: Any, index: int) -> int:
    """A date in ns since 1970; dates with a time zone are objects, of which those of pandas keep nanoseconds in `value`."""
    if not hasattr(moment, "timestamp"):
        raise OptionError(f"expected dates alone, found {_reported(moment)} at index {index}")
    try:
        found = moment.value if hasattr(moment, "value") else round(1e6 * _with_zone(moment).timestamp()) * 1000
    except OverflowError:
        found = 1 << 63
    if not -(1 << 63) <= found < 1 << 63:
        raise OptionError(f"expected dates within 292 years of 1970, found {moment} at index {index}")
    return int(found)


def _with_zone(moment: Any) -> Any:
    """A date of `datetime` with a zone; one without counts as in UTC, as those of NumPy and pandas do: all of them then have none."""
    return moment if moment.tzinfo is not None else moment.replace(tzinfo=timezone.utc)


def _first(dates: NDArray[np.datetime64]) -> np.datetime64:
    """The first of some dates that is known."""
    known = dates[~np.isnat(dates)]
    first: np.datetime64 = known[0] if known.size else dates[0]
    return first


def _since(dates: NDArray[np.datetime64], first_ns: int) -> NDArray[np.float64]:
    """Time in s since a date in ns since 1970; coarse dates may lie further from it than nanoseconds count."""
    whole, rest = divmod(first_ns, 1000)
    if _is_fine(dates):
        passed, rest = dates - np.datetime64(first_ns, "ns"), 0
    else:
        passed = dates.astype("datetime64[us]") - np.datetime64(whole, "us")
    return np.where(np.isnat(passed), np.nan, passed / np.timedelta64(1, "s") - 1e-9 * rest)


def _is_fine(dates: NDArray[np.datetime64] | np.datetime64) -> bool:
    """Whether the unit of dates is a nanosecond or less."""
    return np.datetime_data(dates.dtype)[0] in ("ns", "ps", "fs", "as")


def first_date(times: Any) -> tuple[int, bool] | None:
    """The first date of a column of times in ns since 1970, and whether it has a time zone; None of a column of others."""
    if isinstance(times, np.ndarray) and times.dtype.kind == "f":
        return None
    values = _units.in_si(times, "time_s")
    try:
        column = np.asarray(values)
    except ValueError:
        # What reads the column says what is wrong with it.
        return None
    dates = _dates(column, "time_s") if column.ndim == 1 and column.size else None
    return None if dates is None else (_ns(_first(dates)), bool(_has_zone(values, column)))


def _ns(date: np.datetime64) -> int:
    """A date in ns since 1970, of any unit."""
    if _is_fine(date):
        return int(date.astype("datetime64[ns]").astype(np.int64))
    return 1000 * int(date.astype("datetime64[us]").astype(np.int64))


def at_times(values: Any, name: str, first: tuple[int, bool] | None) -> tuple[NDArray[np.float64], bool]:
    """Times to evaluate at in s, and whether it is a single one.

    They are on the clock of samples whose `first` date is this (ns since 1970, and whether it has a time zone); without it dates are refused.
    """
    values = _units.in_si(values, name)
    try:
        column = np.asarray(values)
    except ValueError:
        # What reads the column says what is wrong with it.
        return as_doubles(values, name), False
    is_single = column.ndim == 0 and column.dtype.kind not in "USV"
    if is_single:
        values = column = column.reshape(1)
    dates = _dates(column, name) if column.ndim == 1 else None
    if dates is None:
        return as_doubles(values, name), is_single
    if first is None:
        message = f"{name}: expected numbers in s or durations, as the samples have, found dates"
        raise OptionError(f"{message}\nhint: subtract the date at which their clock is 0")
    first_ns, has_zone = first
    if (found := _has_zone(values, column)) is not None and found != has_zone:
        expected, other = ("with", "without") if has_zone else ("without", "with")
        message = f"{name}: expected dates {expected} a time zone, as the samples have, found dates {other} one"
        raise OptionError(f"{message}\n{_ZONE_HINT}")
    return as_doubles(_since(dates, first_ns), name), is_single


def _seconds(array: NDArray[Any], name: str) -> NDArray[Any]:
    """Durations in s, and dates in s since the first; other columns as they are."""
    dates = _dates(array, name)
    if dates is not None:
        if not name.endswith("time_s"):
            raise OptionError(f"{name}: expected numbers in s, found dates\nhint: subtract the first date of the samples")
        return _since(dates, _ns(_first(dates)))
    elif array.dtype.kind == "O" and isinstance(array[0], timedelta):
        array = array.astype("timedelta64[ns]")
    if array.dtype.kind == "m" and name.rstrip(")").endswith("_s"):
        _units.check_duration(array, name)
        return np.where(np.isnat(array), np.nan, array / np.timedelta64(1, "s"))
    return array


def is_of_numpy(curves: Any) -> bool:
    """Whether this is read as an array of NumPy even where it offers itself to Arrow.

    An array with named dimensions, of xarray, is a table of one column to Arrow, polars before 1.34 exports dates and
    durations as whole numbers of an unknown unit, and pandas exports nothing without pyarrow.
    """
    is_time = str(getattr(curves, "dtype", "")).lower().startswith(("date", "timedelta", "duration"))
    needs_pyarrow = type(curves).__module__.partition(".")[0] == "pandas" and find_spec("pyarrow") is None
    return is_time or needs_pyarrow or hasattr(curves, "dims")


def as_ragged(curves: Any, name: str, omit_nan: bool = False) -> tuple[NDArray[np.float64], NDArray[np.int64], dict[int, str]]:
    """Curves of any lengths one behind the other, where each begins and the last ends, and what is wrong with which.

    A column of numbers is one curve; the rows of an array of two dimensions are one each.
    """
    curves = _units.in_si(curves, name)
    _check_not_lazy(curves, name, "a list of curves")
    if not omit_nan:
        _check_numbers(curves, name)
    if hasattr(curves, "columns"):
        # To go through a table of pandas is to go through the names of its columns.
        hint = 'hint: pass one column, such as table["force_n"], or the rows of table.to_numpy()'
        raise OptionError(f"{name}: expected a list of curves, found a table of {len(curves.columns)} columns\n{hint}")
    # Columns of Arrow come here where they are dates or durations.
    if is_of_numpy(curves) or hasattr(curves, "__arrow_c_stream__") or hasattr(curves, "__arrow_c_array__"):
        curves = np.asarray(curves)
    if isinstance(curves, np.ndarray) and curves.ndim == 2:
        flat = as_doubles(curves.reshape(-1), name, omit_nan)
        return flat, np.arange(curves.shape[0] + 1, dtype=np.int64) * curves.shape[1], {}
    if isinstance(curves, np.ndarray) and curves.dtype.kind != "O":
        flat = as_doubles(curves, name, omit_nan)
        return flat, np.array([0, flat.size], dtype=np.int64), {}
    try:
        rows = list(curves)
    except TypeError:
        raise OptionError(f"{name}: expected a list of curves, found {_reported(curves)}") from None
    if rows and all(row is None or np.ndim(row) == 0 for row in rows) and any(row is not None for row in rows):
        flat = as_doubles(rows, name, omit_nan)
        return flat, np.array([0, flat.size], dtype=np.int64), {}
    columns, wrong = [], {}
    for index, row in enumerate(rows):
        try:
            columns.append(as_doubles(row, name, omit_nan))
        except OptionError as error:
            columns.append(np.empty(0))
            wrong[index] = str(error)
    offsets = np.zeros(len(columns) + 1, dtype=np.int64)
    np.cumsum([column.size for column in columns], out=offsets[1:])
    return (np.concatenate(columns) if columns else np.empty(0)), offsets, wrong


def _reported(value: Any) -> str:
    text = repr(value)
    return f"{type(value).__name__} {text if len(text) <= 40 else text[:37] + '...'}"
