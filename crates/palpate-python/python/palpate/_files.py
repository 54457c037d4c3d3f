"""Jobs from files to files and to text, as the command does them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

from palpate import _palpate
from palpate._palpate import Material

_Path = Union[str, os.PathLike[str]]
_Description = Union[str, os.PathLike[str], Mapping[str, Any], Material, None]


def _said(test: _Description) -> tuple[_Path | None, str | None]:
    from palpate import _described

    return _described(test)


def _part(part: str | int | None) -> str | None:
    return None if part is None else str(part)


def inspect(path: _Path, *, test: _Description = None, part: str | int | None = None) -> str:
    """What is in a file of records: columns, sampling, phases; the text of ``palpate inspect``.

    Parameters
    ----------
    path, test, part
        As for `read`.

    Returns
    -------
    str

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`.
    """
    return _palpate.inspect(path, _said(test), _part(part))


def convert(path: _Path, out: _Path, *, test: _Description = None, part: str | int | None = None) -> Path:
    """Write the record in a file of any format as a plain table in SI, with where it comes from: ``palpate convert``.

    Parameters
    ----------
    path, test, part
        As for `read`.
    out
        A file ending in .csv, .parquet or .json; it appears whole or not at all.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`; also a name that says no format.
    """
    _palpate.convert(path, out, _said(test), _part(part))
    return Path(out)


def batch(
    paths: Sequence[_Path],
    out: _Path,
    *,
    test: _Description = None,
    laws: Sequence[str] | None = None,
    fit_until_s: float | None = None,
    restart: bool = False,
) -> tuple[int, list[str]]:
    """Analyse many records into one table, a row per hold and law: ``palpate batch``.

    What is done is kept beside the table: a batch that was ended goes on where it stood.

    Parameters
    ----------
    paths
        Files, folders with files, or patterns.
    out
        A table ending in .parquet or .csv.
    test
        Test description of all of them.
    laws
        Laws to fit besides the latency law.
    fit_until_s
        Fit only this long from the start of each hold, s.
    restart
        Whether all records are analysed again, whatever was done before.

    Returns
    -------
    rows : int
        How many rows the table has.
    failures : list of str
        Why tests gave no rows, a sentence each.

    Raises
    ------
    OptionError, OSError
        A description or a law that is wrong, a table that cannot be written.
    """
    return _palpate.batch(list(paths), out, _said(test), None if laws is None else list(laws), fit_until_s, restart, None)


def sweep(
    protocol: _Path, out: _Path, *, figure: _Path | None = None, show: str | None = None, restart: bool = False
) -> tuple[int, int]:
    """Simulate the runs of a protocol with a table ``[sweep]`` into one table: ``palpate sweep``.

    Finished parts are kept beside the table: a sweep that was ended goes on where it stood.

    Parameters
    ----------
    protocol
        Path of the protocol (TOML).
    out
        A table ending in .parquet.
    figure
        A figure ending in .svg or .png.
    show
        Which result the figure shows, by the name of its column; the peak force if left out.
    restart
        Whether all runs are computed again, whatever was computed before.

    Returns
    -------
    runs, refused : int
        How many runs the table has, and how many of them were refused.

    Raises
    ------
    OptionError, OSError
        A protocol without a sweep, a table that cannot be written.
    """
    return _palpate.sweep(protocol, out, figure, show, restart, None)


def reproduce(folder: _Path, *, png: bool = False) -> bool:
    """Reproduce the paper's study into a folder: ``palpate reproduce``.

    Parameters
    ----------
    folder
        Made if it is not there.
    png
        Whether figures are written as PNG beside SVG.

    Returns
    -------
    bool
        Whether every check passes.

    Raises
    ------
    OSError
        The folder cannot be written to.
    """
    return _palpate.reproduce(folder, png)


def watch(
    path: _Path,
    *,
    test: _Description = None,
    part: str | int | None = None,
    material: _Path | None = None,
    exponent: float | None = None,
    slip_force_n: float | None = None,
    warn_before_s: float | None = None,
    every_s: float | None = None,
) -> list[dict[str, Any]]:
    """Watch a recorded log as if it came in live: the lines of ``palpate watch --format jsonl``.

    Parameters
    ----------
    path, test, part
        As for `read`.
    material
        Path of a material file; the excess strain is then known from first touch on.
    exponent
        Exponent of the law where no material says it; 5 if left out.
    slip_force_n
        Normal force at which what is held slips, N.
    warn_before_s
        How long before slip to warn, s; 1 if left out.
    every_s
        Time of the log between two ticks that are reported, s; 0.5 if left out.

    Returns
    -------
    list of dict
        Ticks and events in order, the holds last; ``palpate schema watch`` prints the schema of each.

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read` and `Observer`.
    """
    lines: list[dict[str, Any]] = _palpate.watch(
        path, _said(test), _part(part), material, exponent, slip_force_n, warn_before_s, every_s
    )
    return lines
