"""Soft contact that remembers: squeeze-and-hold tests turned into laws, and laws into forces.

In a hold the strain of a soft body drifts to equilibrium at a rate set by how far it has to go: strain rate = -v (e - e_e)^n,
the *nonlinear latency law* of Tsai, Kao et al. This package finds the law in a measured record and says how sure it is.

>>> import numpy as np, palpate
>>> t = np.linspace(0.0, 20.0, 200)
>>> fit = palpate.fit_hold(t, 0.2 + 0.1 * (1 + 2 * t) ** -0.25)
>>> round(fit.parameters["exponent"], 4)
5.0
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from inspect import iscoroutinefunction
from pathlib import PurePath
from typing import Any, Union, overload

import numpy as np

from palpate import _arrays, _long, _results, laws, protocols
from palpate._options import DriveBy, EnergyBy, Intervals, LawName, Loss, Missing, Noise, Response
from palpate._palpate import (
    Analysis,
    BackOff,
    BatchResult,
    Calibration,
    Comparison,
    ContactState,
    ContactStates,
    Estimate,
    Finding,
    Fit,
    FitError,
    ForceHold,
    Grip,
    PositionHold,
    Material,
    ModelError,
    Observation,
    Observer,
    OptionError,
    PalpateError,
    PalpateWarning,
    Prediction,
    Record,
    RecordComparison,
    RecordError,
    Schedule,
    SeveralCalibrations,
    Table,
    Trajectory,
    batch,
    calibrate,
    compare,
    convert,
    forecast,
    inspect,
    read,
    read_all,
    report_all,
    reproduce,
    sweep,
    watch,
)
from palpate._palpate import __version__ as __version__
from palpate._palpate import energy as _energy
from palpate._palpate import fit_hold as _fit_hold
from palpate._palpate import fit_many as _fit_many
from palpate._palpate import mapping_text as _mapping_text
from palpate._palpate import simulate as _simulate
from palpate._palpate import simulate_many as _simulate_many
from palpate.protocols import Law, Protocol, Specimen, Step

__all__ = [
    "Analysis",
    "BackOff",
    "BatchResult",
    "Calibration",
    "Comparison",
    "ContactState",
    "ContactStates",
    "Estimate",
    "Finding",
    "Fit",
    "FitError",
    "ForceHold",
    "Grip",
    "Law",
    "PositionHold",
    "Material",
    "ModelError",
    "Observation",
    "Observer",
    "OptionError",
    "PalpateError",
    "PalpateWarning",
    "Prediction",
    "Protocol",
    "Record",
    "RecordComparison",
    "RecordError",
    "Schedule",
    "SeveralCalibrations",
    "Specimen",
    "Step",
    "Table",
    "Trajectory",
    "batch",
    "calibrate",
    "compare",
    "convert",
    "energy",
    "fit_hold",
    "fit_many",
    "forecast",
    "inspect",
    "laws",
    "protocols",
    "read",
    "read_all",
    "report_all",
    "reproduce",
    "simulate",
    "simulate_many",
    "sweep",
    "watch",
]
_results.attach()


def __dir__() -> list[str]:
    # What is offered, without what this file imports for itself.
    return sorted([*__all__, "__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"])


#: Lower and upper end of what a number may be; None leaves an end open.
Bound = Union[tuple[Union[float, None], Union[float, None]], Sequence[Union[float, None]]]
Description = Union[str, os.PathLike[str], Mapping[str, Any], Material, None]


def _described(test: Description) -> tuple[str | os.PathLike[str] | None, str | None]:
    """A description as a path or as the text of one; a mapping has the tables of the file, and JSON is nearly TOML."""
    if isinstance(test, Mapping):
        return None, _toml(test)
    if isinstance(test, Material):
        return None, test.to_toml()
    return test, None


def _driven(protocol: Any) -> tuple[str | os.PathLike[str] | None, str | None]:
    """A protocol of a body that is known, which may be its steps alone."""
    return _described({"step": protocol} if isinstance(protocol, (list, tuple)) else protocol)


def _with_body(table: Mapping[str, Any]) -> Mapping[str, Any]:
    """A protocol whose ``material`` is one in memory, with the tables of that body."""
    material = table.get("material")
    if not isinstance(material, Material):
        return table
    import tomllib

    tables = ("specimen", "law", "contact")
    for name in tables:
        if name in table:
            raise OptionError(f"{name}: expected either this or material, found both\nhint: remove {name} or material")
    body = tomllib.loads(material.to_toml())
    return {**{name: table[name] for name in table if name != "material"}, **{name: body[name] for name in tables}}


def _toml(table: Mapping[str, Any]) -> str:
    return _mapping_text(_with_body(table))


def _record_file(given: Any, name: str | None = None) -> tuple[str | os.PathLike[str], bytes | None]:
    """A file of records as a path, or as a name and bytes: those of an object that is read, from where it stands."""
    if isinstance(given, (bytes, bytearray, memoryview)):
        return name or "bytes", bytes(given)
    # Some files that are read have a path too, and up to Python 3.12 a path can be entered.
    if isinstance(given, (str, PurePath)) or not (hasattr(given, "read") or hasattr(given, "__enter__")):
        if not isinstance(given, (str, os.PathLike)):
            found = type(given).__name__
            raise OptionError(f"expected a path, bytes or an object with read(), found {found}\nhint: give the bytes of the file, and name=")
        if name is not None:
            raise OptionError("name: expected bytes or an object with read() beside it, found a path\nhint: remove name")
        return given, None
    # An asynchronous upload has the file that it spools to.
    file = getattr(given, "file", given) if iscoroutinefunction(getattr(given, "read", None)) else given
    if hasattr(file, "read"):
        content = file.read()
    else:
        with file as opened:
            content = opened.read()
    if isinstance(content, str):
        content = content.encode()
    if not isinstance(content, (bytes, bytearray, memoryview)):
        raise OptionError(f"expected read() to give bytes, found {type(content).__name__}\nhint: open the file with mode \"rb\"")
    # The name of a form's field is no name of a file: that one is called filename.
    names = (getattr(given, attribute, None) for attribute in ("filename", "name", "full_name", "path"))
    own = next((str(own) for own in names if isinstance(own, (str, os.PathLike)) and str(own)), type(given).__name__)
    return name or own, bytes(content)


def _record_files(given: Any) -> list[tuple[str | os.PathLike[str], bytes | None]]:
    """Several files of records: paths, bytes and objects, or a mapping from their names."""
    if isinstance(given, Mapping):
        return [_record_file(one, str(name)) for name, one in given.items()]
    if isinstance(given, (str, bytes, bytearray, memoryview)) or not hasattr(given, "__iter__") or hasattr(given, "read"):
        raise OptionError("paths: expected a list of files, found one\nhint: put it into a list")
    return [_record_file(one) for one in given]


@contextmanager
def _bar(progress: bool | None, total: int, unit: str) -> Generator[Callable[[int], None] | None]:
    """Something to call with how much is done: a bar of tqdm where that is there, and where somebody looks or has requested it."""
    if progress is False or (progress is None and not sys.stderr.isatty()):
        yield None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        if progress:
            raise OptionError("progress: expected tqdm, found none; install it, or leave progress out") from None
        yield None
        return
    with tqdm(total=total, unit=unit, delay=0 if progress else 1.0) as bar:

        def tell(done: int) -> None:
            bar.update(done - bar.n)

        yield tell


def _number(value: Any, name: str) -> float:
    if isinstance(value, (bool, str)) or not hasattr(value, "__float__"):
        raise OptionError(f"{name}: expected a number, found {value!r}")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise OptionError(f"{name}: expected a number, found {value!r}") from None


def _named(values: Any, name: str, example: str) -> list[tuple[str, Any]]:
    if not isinstance(values, Mapping):
        raise OptionError(f"{name}: expected numbers by name, such as {example}, found {values!r}")
    return [(str(key), value) for key, value in values.items()]


def _ends(pair: Any, name: str) -> tuple[float, float]:
    """Both ends of a bound; one that is None is left open."""
    if isinstance(pair, str) or not hasattr(pair, "__len__") or len(pair) != 2:
        raise OptionError(f"{name}: expected a lower and an upper end, found {pair!r}")
    low, high = pair
    return (
        float("-inf") if low is None else _number(low, name),
        float("inf") if high is None else _number(high, name),
    )


def _keywords(
    law: str,
    response: str,
    fixed: Mapping[str, float] | None,
    bounds: Mapping[str, Bound] | None,
    loss: str,
    noise: str,
    confidence: float,
    log_spaced: int | None,
    intervals: str,
    nan: str,
) -> dict[str, Any]:
    words = {"law": law, "response": response, "loss": loss, "noise": noise, "intervals": intervals, "nan": nan}
    for name, word in words.items():
        if not isinstance(word, str):
            raise OptionError(f"{name}: expected a word, found {word!r}")
    held = _named(fixed, "fixed", '{"exponent": 5}') if fixed is not None else None
    bounded = _named(bounds, "bounds", '{"exponent": (1, 10)}') if bounds is not None else None
    if log_spaced is not None and (isinstance(log_spaced, bool) or not hasattr(log_spaced, "__index__") or log_spaced < 1):
        raise OptionError(f"log_spaced: expected a number of samples, found {log_spaced!r}")
    return {
        **words,
        "fixed": held and [(name, _number(value, f'fixed["{name}"]')) for name, value in held],
        "bounds": bounded and [(name, _ends(pair, f'bounds["{name}"]')) for name, pair in bounded],
        "confidence": _number(confidence, "confidence"),
        "log_spaced": log_spaced,
    }


def fit_hold(
    time_s: Any,
    signal: Any,
    *,
    law: LawName = "latency",
    weights: Any = None,
    response: Response = "relaxation",
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    loss: Loss = "squares",
    noise: Noise = "residuals",
    confidence: float = 0.95,
    log_spaced: int | None = None,
    intervals: Intervals = "automatic",
    nan: Missing = "raise",
) -> Fit:
    """Fit a law to one hold; no starting values.

    The latency law is y(t) = y_e + D (1 + (n - 1) l t)^(-1/(n - 1)), equations (4) and (5) of Tsai, Kao et al.; for given
    (l, n) it is linear in (y_e, D), which are solved for, and (ln l, n) are searched.

    Parameters
    ----------
    time_s : array_like, shape (N,)
        Times in s, rising; the first is the start of the hold. Durations are times too, and so are dates: seconds since the first.
    signal : array_like, shape (N,)
        Force, stress or strain (displacement or strain for creep), in any unit; quantities of pint are converted to SI.
    law
        A name of ``palpate.laws.names()``: "latency" (n found), "latency:5", "standard-linear-solid", "prony:2", ...
    weights : array_like, shape (N,), optional
        1/sigma of every sample, as in lmfit; 0 leaves one out.
    response
        "relaxation" or "creep".
    fixed
        Numbers held at a value, by name: ``{"exponent": 5, "equilibrium": 0}``; all but amplitudes.
    bounds
        Bounds of numbers, by name: ``{"exponent": (1, 10)}``; None leaves an end open.
    loss
        "squares", or "huber" or "tukey" where single samples stray.
    noise
        What intervals take the noise for: what the "residuals" show, or "white".
    confidence
        Coverage of the intervals, between 0 and 1.
    log_spaced
        Fit about this many samples, equally spaced in ln t.
    intervals
        Method of the intervals: "curvature" at the optimum, "profile" of the residual square, asymmetric and open where the
        data do not close it, "bootstrap", residuals resampled in blocks, or "automatic": the profile where
        an interval of curvature is wider than a third of its parameter to a side (a tenth, if a time constant is longer than
        the hold), and where terms merge or vanish.
    nan
        Samples without a time, a value or a weight (NaN, None, masked) "raise" an error, or "omit" leaves them out.

    Returns
    -------
    Fit
        Estimates with errors and intervals, covariance, why it ended, and the samples.

    Raises
    ------
    FitError
        Too few samples, times that do not rise, values that are not finite or all the same.
    OptionError
        A law, a number or an option that is not known; a number held or bounded where it cannot be.

    Examples
    --------
    >>> import numpy as np, palpate
    >>> t = np.linspace(0.0, 40.0, 400)
    >>> fit = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8), law="standard-linear-solid")
    >>> round(fit.parameters["time_constant_s"], 6)
    8.0
    """
    keywords = _keywords(law, response, fixed, bounds, loss, noise, confidence, log_spaced, intervals, nan)
    if nan == "omit":
        time_s, signal = _arrays.as_doubles(time_s, "time_s", True), _arrays.as_doubles(signal, "signal", True)
        weights = None if weights is None else _arrays.as_doubles(weights, "weights", True)
    return _fit_hold(time_s, signal, weights, keywords)


@overload
def fit_many(
    time_s: Any,
    signal: Any,
    *,
    law: LawName = "latency",
    weights: Any = None,
    response: Response = "relaxation",
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    loss: Loss = "squares",
    noise: Noise = "residuals",
    confidence: float = 0.95,
    log_spaced: int | None = None,
    intervals: Intervals = "automatic",
    nan: Missing = "raise",
    progress: bool | None = None,
) -> Table: ...
@overload
def fit_many(
    table: Any,
    /,
    *,
    by: str | Sequence[str],
    time: str,
    signal: str,
    law: LawName = "latency",
    weights: str | None = None,
    response: Response = "relaxation",
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    loss: Loss = "squares",
    noise: Noise = "residuals",
    confidence: float = 0.95,
    log_spaced: int | None = None,
    intervals: Intervals = "automatic",
    nan: Missing = "raise",
    progress: bool | None = None,
) -> Table: ...
def fit_many(
    time_s: Any,
    signal: Any = None,
    *,
    by: str | Sequence[str] | None = None,
    time: str | None = None,
    law: LawName = "latency",
    weights: Any = None,
    response: Response = "relaxation",
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, Bound] | None = None,
    loss: Loss = "squares",
    noise: Noise = "residuals",
    confidence: float = 0.95,
    log_spaced: int | None = None,
    intervals: Intervals = "automatic",
    nan: Missing = "raise",
    progress: bool | None = None,
) -> Table:
    """Fit a law to many holds, on all processors and without the GIL.

    Parameters
    ----------
    time_s, signal, weights
        A list of arrays of any lengths, an array of shape (curves, samples), of NumPy or xarray, or a column of lists in Arrow
        (pyarrow, polars). One column of times, or of weights, stands for all curves. With `by`, `time_s` is a long table of pandas,
        polars or pyarrow, a row a sample, and `time`, `signal` and `weights` are names of its columns.
    by
        Name of the column that tells the curves of a long table apart, or several names.
    time
        Name of its column of times, in s, dates or durations.
    law, response, fixed, bounds, loss, noise, confidence, log_spaced, intervals, nan
        As for `fit_hold`; ``nan="omit"`` takes rows that are padded with NaN to one length.
    progress
        Whether to show a bar of tqdm; if left out, where tqdm is there, standard error is a terminal and it takes a while.

    Returns
    -------
    Table
        A row a curve, in order: every number with its standard error and interval, root mean square residual, ending. A curve
        that no law can be fitted to, or that is no column of numbers, says why in ``error``, and its numbers are missing. The curves
        of a long table stand in the order in which they first appear, with the columns of `by`.

    Raises
    ------
    OptionError
        As for `fit_hold`; no list of curves; times or weights that are meant for all curves and are none; a column that there is
        not, or a row without a label.

    Examples
    --------
    >>> import numpy as np, palpate
    >>> t = np.linspace(0.0, 40.0, 100)
    >>> samples = {
    ...     "specimen": ["a"] * 100 + ["b"] * 100,
    ...     "t": np.concatenate([t, t]),
    ...     "force": np.concatenate([1 + 2 * np.exp(-t / 8), 1 + np.exp(-t / 5)]),
    ... }
    >>> fits = palpate.fit_many(samples, by="specimen", time="t", signal="force", law="standard-linear-solid")
    >>> fits["specimen"], fits["time_constant_s"].round(3).tolist()
    (['a', 'b'], [8.0, 5.0])
    """
    keywords = _keywords(law, response, fixed, bounds, loss, noise, confidence, log_spaced, intervals, nan)
    labels: _long.Labels = {}
    if by is not None:
        names = {"time": time, "signal": signal, "weights": weights}
        for name, found in names.items():
            if not isinstance(found, str) and not (name == "weights" and found is None):
                raise OptionError(f"{name}: expected the name of a column beside by, found {type(found).__name__}")
        labels, columns = _long.curves(time_s, by, [name for name in names.values() if name is not None])
        time_s, signal, weights = (*columns, None)[:3]
    elif time is not None:
        raise OptionError("time: expected by beside it, the column that tells curves apart\nhint: by=\"...\"")
    given = {"time_s": time_s, "signal": signal, "weights": weights}
    for name, found in given.items():
        if isinstance(found, Mapping):
            raise OptionError(f"{name}: expected a list of curves, found a mapping\nhint: pass list(curves.values()), or a long table with by=")
        if found is None and name != "weights":
            raise OptionError(f"{name}: expected a list of curves, found None")
    if hasattr(signal, "dims") and len(getattr(time_s, "dims", ())) == 1 and time_s.dims[0] in signal.dims:
        # Dimensions of xarray have names: a curve goes along that of the times.
        signal = signal.transpose(..., time_s.dims[0])
    curves = len(signal) if hasattr(signal, "__len__") else 0
    with _bar(progress, curves, "fit") as tell:
        table = _fit_many(time_s, signal, weights, keywords, tell)
    for name, values in reversed(labels.items()):
        table = table._labelled(name, values)
    return table


def simulate(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    *,
    specimen: Mapping[str, Any] | None = None,
    law: Mapping[str, Any] | None = None,
    contact: Mapping[str, Any] | None = None,
    output: Mapping[str, Any] | None = None,
    drive: Record | None = None,
    drive_by: DriveBy = "displacement",
) -> Trajectory:
    """Simulate squeeze, hold, creep and release by a protocol.

    Parameters
    ----------
    protocol
        Path of a protocol (TOML), a `Protocol`, or a mapping with its tables: ``{"specimen": {...}, "law": {...}, "step": [{...}, ...]}``.
        Quantities are texts with a unit, such as ``"radius": "35 mm"``, quantities of pint, or numbers in SI under a key that says the
        unit, such as ``"radius_m": 0.035``; ``_m``, ``_s``, ``_n``, ``_pa``, ``_m2``, ``_per_s``, ``_m_per_s`` and ``_n_per_s`` do.
        ``"material"``, a `Material` or the path of its file, stands for specimen, law and contact.
    specimen, law, contact, output
        Tables that stand in place of those of a mapping.
    drive
        A measured record whose displacement, or force, the body follows in place of the steps.
    drive_by
        Which of both: "displacement" or "force".

    Returns
    -------
    Trajectory
        Time, displacement, force and strains in SI, with contacts lost and regained.

    Raises
    ------
    OptionError
        A protocol that says what no contact can do; the message names the key.
    RecordError
        A record without a displacement that is to drive by it.
    ModelError
        A motion that the body cannot take.

    Examples
    --------
    >>> import palpate
    >>> trajectory = palpate.simulate({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    ... })
    >>> round(float(trajectory.force_n[-1]), 2)
    1.56
    """
    replaced = {"specimen": specimen, "law": law, "contact": contact, "output": output}
    replaced = {name: table for name, table in replaced.items() if table is not None}
    driver = _driver(drive, drive_by)
    if isinstance(protocol, Mapping):
        return _simulate(None, _toml({**protocol, **replaced}), *driver)
    if replaced:
        raise OptionError(f"{', '.join(replaced)}: tables replace those of a mapping, found the path of a protocol")
    return _simulate(protocol, None, *driver)


def _driver(drive: Any, drive_by: str) -> tuple[Any, str]:
    """The columns of the record that drives, and which of them does."""
    if drive is None:
        return None, drive_by
    if not isinstance(drive, Record):
        raise OptionError(f"drive: expected a Record, found {type(drive).__name__}\nhint: read it with palpate.read(...)")
    return (drive.time_s, drive.displacement_m, drive.force_n), drive_by


def energy(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    *,
    by: EnergyBy = "time",
    drive: Record | None = None,
    drive_by: DriveBy = "displacement",
) -> Table:
    """Work of the jaw in a protocol: what the body gives back, stores and loses.

    Work is integrated along with the contact, not from samples. ``simulate(protocol).plot(x="displacement_m")`` draws the loops of
    force against displacement whose areas the cycles have.

    Parameters
    ----------
    protocol, drive, drive_by
        As for `simulate`.
    by
        Rows by "time", by "step" of the drive, or by "cycle" of squeeze and release.

    Returns
    -------
    Table
        Energies in J, of both contacts of a body that is squeezed from two sides. By time: ``time_s``, ``work_j``, ``given_back_j``,
        ``stored_j``, ``lost_j``. By step: ``step``, ``from_s``, ``until_s``, displacements, ``work_j``, ``given_back_j``, ``lost_j``. By
        cycle: ``cycle``, ``from_s``, ``until_s``, ``done_j``, ``given_back_j``, ``lost_j``, ``share_lost``, and whether the loop is
        ``closed``. What the law does not say of a body whose contact grows is missing.

    Raises
    ------
    OptionError, RecordError, ModelError
        As for `simulate`.

    Examples
    --------
    >>> import palpate
    >>> cycle = palpate.energy({
    ...     "specimen": {"shape": "block", "area": "10 cm^2", "length": "40 mm", "modulus": "100 kPa"},
    ...     "law": {"name": "latency", "exponent": 3, "rate_coefficient": "100 /s"},
    ...     "step": [{"to": "4 mm", "rate": "4 mm/s"}, {"to": "0 mm", "rate": "4 mm/s"}],
    ... }, by="cycle")
    >>> round(float(cycle["share_lost"][0]), 3)
    0.793
    """
    path, text = _described(protocol)
    return _energy(path, text, *_driver(drive, drive_by), by)


def simulate_many(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    numbers: Mapping[str, Any],
    *,
    times_s: Any = None,
    progress: bool | None = None,
) -> Table:
    """Simulate one protocol with many numbers, on all processors and without the GIL.

    Parameters
    ----------
    protocol
        Path of a protocol (TOML), or a mapping with its tables, as for `simulate`.
    numbers
        Arrays of one length by the path of the number they replace, in SI:
        ``{"law.rate_coefficient": [1e3, 1e4], "specimen.radius": [0.035, 0.03], "step[1].hold": [10, 60]}``. Run i takes the
        value i of each. A number has to stand in the protocol to be replaced.
    times_s : array_like, shape (T,), optional
        Times at which the force is wanted, rising and inside the motion.
    progress
        As for `fit_many`.

    Returns
    -------
    Table
        A row a run, with the columns of ``palpate sweep``: the numbers, peak force and its time, force, displacement and
        strains at the end, work and losses, what each step ends with, and why a run was refused. With ``times_s`` also
        ``force_n``, an array of shape (runs, T).

    Raises
    ------
    OptionError
        A protocol that is wrong, a number that does not stand in it, arrays of different lengths.
    ModelError
        Times outside the motion.

    Examples
    --------
    >>> import palpate
    >>> protocol = {
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    ... }
    >>> runs = palpate.simulate_many(protocol, {"specimen.radius": [0.03, 0.035]}, times_s=[0.6, 10.6])
    >>> [round(force, 2) for force in runs["force_end_n"].tolist()]
    [1.48, 1.56]
    >>> runs["force_n"].shape
    (2, 2)
    """
    path, text = _described(protocol)
    columns = list(numbers.items())
    runs = len(columns[0][1]) if columns else 0
    with _bar(progress, runs, "run") as tell:
        return _simulate_many(path, text, columns, times_s, tell)
