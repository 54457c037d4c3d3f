"""Arrays as the compiled part takes them: contiguous doubles, or an error that says what was found."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate._palpate import OptionError


def as_doubles(values: Any, name: str) -> NDArray[np.float64]:
    """One column of numbers as contiguous doubles.

    Takes arrays of any real type, order and stride, lists, and columns of pandas, polars and pyarrow.
    Text, complex numbers, masked values and more than one dimension are refused.
    """
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
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
    if array.dtype.kind == "O":
        missing = [index for index, value in enumerate(array) if value is None]
        if missing:
            raise OptionError(f"{name}: expected a number everywhere, found None at index {missing[0]}")
    if array.dtype.kind not in "biufO":
        raise OptionError(f"{name}: expected numbers, found {array.dtype}")
    try:
        return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError):
        raise OptionError(f"{name}: expected numbers, found {_reported(array[0])}") from None


def as_ragged(curves: Any, name: str) -> tuple[NDArray[np.float64], NDArray[np.int64], dict[int, str]]:
    """Curves of any lengths one behind the other, where each begins and the last ends, and what is wrong with which.

    A column of numbers is one curve; the rows of an array of two dimensions are one each.
    """
    if isinstance(curves, np.ndarray) and curves.ndim == 2:
        flat = as_doubles(curves.reshape(-1), name)
        return flat, np.arange(curves.shape[0] + 1, dtype=np.int64) * curves.shape[1], {}
    if isinstance(curves, np.ndarray) and curves.dtype.kind != "O":
        flat = as_doubles(curves, name)
        return flat, np.array([0, flat.size], dtype=np.int64), {}
    try:
        rows = list(curves)
    except TypeError:
        raise OptionError(f"{name}: expected a list of curves, found {_reported(curves)}") from None
    if rows and all(row is None or np.ndim(row) == 0 for row in rows) and any(row is not None for row in rows):
        flat = as_doubles(rows, name)
        return flat, np.array([0, flat.size], dtype=np.int64), {}
    columns, wrong = [], {}
    for index, row in enumerate(rows):
        try:
            columns.append(as_doubles(row, name))
        except OptionError as error:
            columns.append(np.empty(0))
            wrong[index] = str(error)
    offsets = np.zeros(len(columns) + 1, dtype=np.int64)
    np.cumsum([column.size for column in columns], out=offsets[1:])
    return (np.concatenate(columns) if columns else np.empty(0)), offsets, wrong


def _reported(value: Any) -> str:
    text = repr(value)
    return f"{type(value).__name__} {text if len(text) <= 40 else text[:37] + '...'}"
