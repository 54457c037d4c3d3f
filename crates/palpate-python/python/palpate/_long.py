"""Long tables: a row a sample, and columns that say to which curve it belongs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

import numpy as np

from palpate._palpate import OptionError
from palpate._units import in_si

#: The labels of all curves under the name of their column.
Labels = dict[str, list[Any]]


def column(table: Any, name: str) -> Any:
    """A column of a table of pandas, polars, pyarrow, or of a mapping, by its name."""
    try:
        found = table[name]
    except Exception as error:
        # polars has an exception of its own for it.
        if not isinstance(error, (KeyError, TypeError, IndexError, AttributeError, ValueError)) and type(error).__name__ != "ColumnNotFoundError":
            raise
        raise OptionError(_without(table, name, error)) from None
    return found


def _without(table: Any, name: str, error: Exception) -> str:
    """What is wrong with a table that has no such column, and what would help."""
    message = f"expected a table with a column {name!r}, found "
    if hasattr(table, "collect"):
        return f"{message}{type(table).__name__}\nhint: table.collect()"
    names = getattr(table, "column_names", None) or getattr(table, "columns", None)
    names = [str(other) for other in (table if names is None and isinstance(table, Mapping) else names if names is not None else [])]
    if not names:
        return f"{message}none: {error}"
    message += ", ".join(names)
    if name in getattr(getattr(table, "index", None), "names", ()):
        return f"{message}\nhint: it is in the index: table.reset_index()"
    close = get_close_matches(name, names, 1)
    return f"{message}\nhint: did you mean {close[0]!r}?" if close else message


def check_ungrouped(values: Any, name: str) -> None:
    """Refuses what ``groupby`` of pandas, polars, pyarrow and xarray makes: it is no table and no column."""
    if type(values).__name__.endswith("GroupBy"):
        message = f"{name}: expected a table or columns, found groups, a {type(values).__name__}"
        raise OptionError(f'{message}\nhint: pass the table itself: fit_many(table, by="specimen", time="t", signal="force")')


def curves(table: Any, by: str | Sequence[str], columns: Mapping[str, str]) -> tuple[Labels, list[list[Any]]]:
    """The curves of a long table, in the order in which they first appear.

    `columns` has the name of each column with that of the argument which it is for. Returns the labels of every curve under each column of
    `by`, and for each of `columns` the samples of every curve in the order of the rows.
    """
    by = [by] if isinstance(by, str) else list(by)
    if not by:
        raise OptionError("by: expected the name of a column, or several, found none")
    labels = [_plain(column(table, name)) for name in by]
    keys = list(zip(*labels, strict=True))
    for row, key in enumerate(keys):
        # A label that is missing is no curve; NaN equals nothing, itself included.
        if any(label is None or label != label for label in key):
            raise OptionError(f"by: expected a label in every row, found none in row {row}")
    numbers = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    of_row = np.fromiter((numbers[key] for key in keys), dtype=np.int64, count=len(keys))
    order = np.argsort(of_row, kind="stable")
    ends = np.cumsum(np.bincount(of_row, minlength=len(numbers)))[:-1]

    def split(name: str, argument: str) -> list[Any]:
        array = np.asarray(in_si(column(table, name), argument))
        if array.shape != of_row.shape:
            raise OptionError(f"{name}: expected {len(keys)} rows, found an array of shape {array.shape}")
        return np.split(array[order], ends) if numbers else []

    return {name: [key[place] for key in numbers] for place, name in enumerate(by)}, [split(name, argument) for argument, name in columns.items()]


def _plain(values: Any) -> list[Any]:
    """Labels as plain objects; those of other kinds as texts, and all of them where some are."""
    if hasattr(values, "to_pylist"):
        listed = values.to_pylist()
    else:
        array = np.asarray(values)
        # NumPy lists dates in nanoseconds as whole numbers.
        listed = (array.astype("datetime64[us]") if array.dtype.kind == "M" else array).tolist()
    plain = [label if label is None or isinstance(label, (int, float, str)) else str(label) for label in listed]
    if not any(isinstance(label, str) for label in plain):
        return plain
    return [label if label is None or label != label else str(label) for label in plain]


def of_dimensions(signal: Any, along: str) -> tuple[Labels, Any]:
    """The curves of an array of xarray along one of its dimensions, a row each, and what tells them apart.

    These are the coordinates of the other dimensions, and where there are several dimensions the index along those that have none.
    """
    others = [name for name in signal.dims if name != along]
    signal = signal.transpose(*others, along)
    labels: Labels = {}
    for place, name in enumerate(others):
        if name in signal.coords or len(others) > 1:
            along_one = np.asarray(signal.coords[name]) if name in signal.coords else np.arange(signal.shape[place])
            shape = [1] * place + [signal.shape[place]] + [1] * (len(others) - place - 1)
            labels[str(name)] = _plain(np.broadcast_to(along_one.reshape(shape), signal.shape[:-1]).reshape(-1))
    return labels, np.asarray(signal).reshape(-1, signal.shape[-1]) if others else signal
