"""Long tables: a row a sample, and columns that say to which curve it belongs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from palpate._palpate import OptionError

#: The labels of all curves under the name of their column.
Labels = dict[str, list[Any]]


def column(table: Any, name: str) -> Any:
    """A column of a table of pandas, polars, pyarrow, or of a mapping, by its name."""
    try:
        found = table[name]
    except (KeyError, TypeError, IndexError, AttributeError, ValueError) as error:
        raise OptionError(f"expected a table with a column {name!r}, found none: {error}") from None
    except Exception as error:
        # polars has an exception of its own for it.
        if type(error).__name__ != "ColumnNotFoundError":
            raise
        raise OptionError(f"expected a table with a column {name!r}, found {', '.join(map(str, table.columns))}") from None
    return found


def curves(table: Any, by: str | Sequence[str], columns: Sequence[str]) -> tuple[Labels, list[list[Any]]]:
    """The curves of a long table, in the order in which they first appear.

    Returns the labels of every curve under each column of `by`, and for each of `columns` the samples of every curve in the
    order of the rows.
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

    def split(name: str) -> list[Any]:
        array = np.asarray(column(table, name))
        if array.shape != of_row.shape:
            raise OptionError(f"{name}: expected {len(keys)} rows, found an array of shape {array.shape}")
        return np.split(array[order], ends) if numbers else []

    return {name: [key[place] for key in numbers] for place, name in enumerate(by)}, [split(name) for name in columns]


def _plain(values: Any) -> list[Any]:
    """Labels as plain objects; those of other kinds as texts, and all of them where some are."""
    listed = values.to_pylist() if hasattr(values, "to_pylist") else np.asarray(values).tolist()
    plain = [label if label is None or isinstance(label, (int, float, str)) else str(label) for label in listed]
    if not any(isinstance(label, str) for label in plain):
        return plain
    return [label if label is None or label != label else str(label) for label in plain]
