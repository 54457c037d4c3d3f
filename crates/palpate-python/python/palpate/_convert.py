"""Results as tables of other libraries, which are imported where they are requested."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from palpate import _units
from palpate._palpate import Table


def needed(library: str, method: str) -> Any:
    """A library, or an error that says what it is needed for."""
    try:
        return import_module(library)
    except ImportError as error:
        raise ImportError(f"{method} needs {library}, which is not installed: {error}\nhint: pip install {library.replace('_', '-')}") from None


def table_of(result: Any) -> Table:
    """The table of a result."""
    table: Table = result if isinstance(result, Table) else result.to_arrow()
    return table


def to_pandas(self: Any) -> Any:
    """The table of this result as a ``pandas.DataFrame``; without pandas an ImportError."""
    table = table_of(self)
    columns = {name: table[name] for name in table.column_names}
    # A column of several numbers a row is one of arrays.
    flat = {name: list(values) if getattr(values, "ndim", 1) == 2 else values for name, values in columns.items()}
    return needed("pandas", "to_pandas").DataFrame(flat)


def to_polars(self: Any) -> Any:
    """The table of this result as a ``polars.DataFrame``, without a copy; without polars an ImportError."""
    return needed("polars", "to_polars").DataFrame(table_of(self))


def to_xarray(self: Any) -> Any:
    """The table of this result as an ``xarray.Dataset``; without xarray an ImportError.

    The first column is the dimension if no value occurs in it twice, and numbers of rows are otherwise. Variables state their
    units.
    """
    xarray = needed("xarray", "to_xarray")
    table = table_of(self)
    names = table.column_names
    dimension = names[0] if len(set(map(str, table[names[0]]))) == len(table) else "row"

    def variable(name: str) -> Any:
        values = table[name]
        array = values if isinstance(values, np.ndarray) else np.array(values, dtype=object)
        unit = _units.ENDINGS.get(_units.ending(name))
        return (dimension, f"{name}_sample")[: array.ndim], array, {"units": unit} if unit else {}

    coordinates = {dimension: variable(dimension)} if dimension in names else {}
    return xarray.Dataset({name: variable(name) for name in names if name != dimension}, coordinates)


def to_dict(self: Any) -> dict[str, Any]:
    """The columns of this result as lists of plain objects, by name."""
    table = table_of(self)
    return {name: np.asarray(table[name]).tolist() for name in table.column_names}
