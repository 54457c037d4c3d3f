"""Laws fitted to one hold, and to many."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import timedelta
from typing import Any, Union, overload

import numpy as np

from palpate import _arrays, _long, _palpate, _units
from palpate._options import Intervals, LawName, Loss, Missing, Noise, Response
from palpate._palpate import Fit, OptionError, Table
from palpate._progress import bar

#: Lower and upper end of what a number may be; None leaves an end open. Quantities of pint are of any type to a checker of types.
Bound = Union[tuple[Union[float, None], Union[float, None]], Sequence[Union[float, None]], Any]
#: Parameters without a dimension.
_PURE = "exponent", "stretching", "order", "log_ratio"


def number(value: Any, name: str) -> float:
    """A number of Python, or of anything that becomes one."""
    if isinstance(value, (bool, str, np.timedelta64)) or not hasattr(value, "__float__"):
        raise OptionError(f"{name}: expected a number, found {value!r}")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise OptionError(f"{name}: expected a number, found {value!r}") from None


def _named(values: Any, name: str, example: str) -> list[tuple[str, Any]]:
    if not isinstance(values, Mapping):
        raise OptionError(f"{name}: expected numbers by name, such as {example}, found {values!r}")
    return [(str(key), value) for key, value in values.items()]


def parameter(name: str, value: Any, place: str, signal: Any) -> float:
    """A parameter in the unit of a fit; quantities of pint are converted to it, which for some parameters is that of the signal."""
    end = _units.ending(name)
    if isinstance(value, (timedelta, np.timedelta64)) and end == "_s":
        return float(_units.seconds(value, place) or 0.0)
    if not _units.is_quantity(value):
        return number(value, place)
    try:
        if end or name in _PURE:
            return _units.number(value, _units.ENDINGS.get(end, ""))
        return _units.number_like(value, signal)
    except OptionError as error:
        raise OptionError(f"{place}: {error}") from None


def _ends(name: str, pair: Any, place: str, signal: Any) -> tuple[float, float]:
    """Both ends of a bound; one that is None is left open."""
    if isinstance(pair, str) or not hasattr(pair, "__len__") or len(pair) != 2:
        raise OptionError(f"{place}: expected a lower and an upper end, found {pair!r}")
    low, high = pair
    return (
        float("-inf") if low is None else parameter(name, low, place, signal),
        float("inf") if high is None else parameter(name, high, place, signal),
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
    signal: Any = None,
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
        "fixed": held and [(name, parameter(name, value, f'fixed["{name}"]', signal)) for name, value in held],
        "bounds": bounded and [(name, _ends(name, pair, f'bounds["{name}"]', signal)) for name, pair in bounded],
        "confidence": number(confidence, "confidence"),
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
        Times in s, rising; the first is the start of the hold. Durations are times too, and so are dates: seconds since the first. Times of
        xarray are in the unit that their attribute ``units`` states.
    signal : array_like, shape (N,)
        Force, stress or strain (displacement or strain for creep), in any unit; quantities of pint are converted to SI.
    law
        A name of ``palpate.laws.names()`` but "spectrum": "latency" (n found), "latency:5", "standard-linear-solid", "prony:2", ...
    weights : array_like, shape (N,), optional
        1/sigma of every sample, as in lmfit; 0 leaves one out. The start of the hold, from which the law counts its time, stays the
        first of `time_s`, even where the weight of that sample is 0.
    response
        "relaxation" or "creep".
    fixed
        Numbers held at a value, by name: ``{"exponent": 5, "equilibrium": 0}``; all but amplitudes. Quantities of pint are converted.
    bounds
        Bounds of numbers, by name: ``{"exponent": (1, 10)}``; None leaves an end open. Intervals, and the sets of `Fit.sample`, end there.
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
        Samples without a time, a value or a weight (NaN, None, masked) "raise" an error, or "omit" leaves them out; the first that is
        left is then the start of the hold.

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
    keywords = _keywords(law, response, fixed, bounds, loss, noise, confidence, log_spaced, intervals, nan, signal)
    first_date = _arrays.first_date(time_s)
    if nan == "omit":
        time_s, signal = _arrays.as_doubles(time_s, "time_s", True), _arrays.as_doubles(signal, "signal", True)
        weights = None if weights is None else _arrays.as_doubles(weights, "weights", True)
    return _palpate.fit_hold(time_s, signal, weights, keywords, first_date)


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
        A list of arrays of any lengths, an array of shape (curves, samples), or a column of lists in Arrow (pyarrow, polars). An array of
        xarray may have any number of dimensions beside that of the times; their coordinates are columns of the result, and the attribute
        ``units`` of times is heeded. One column of times, or of weights, stands for all curves. With `by`, `time_s` is a long table of pandas,
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
        that no law can be fitted to, or that is no column of numbers, says why in ``error``, and its numbers are missing. A fit that
        ended at a bound, as ``termination`` says, has NaN for its parameters, of which `fit_hold` shows where they ended. The curves
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
    keywords = _keywords(law, response, fixed, bounds, loss, noise, confidence, log_spaced, intervals, nan, signal)
    labels: _long.Labels = {}
    for name, found in {"time_s": time_s, "signal": signal, "weights": weights}.items():
        _long.check_ungrouped(found, name)
    if by is not None:
        names = {"time": time, "signal": signal, "weights": weights}
        for name, found in names.items():
            if not isinstance(found, str) and not (name == "weights" and found is None):
                raise OptionError(f"{name}: expected the name of a column beside by, found {type(found).__name__}")
        arguments = {"time_s": time, "signal": signal, "weights": weights}
        labels, columns = _long.curves(time_s, by, {name: column for name, column in arguments.items() if column is not None})
        time_s, signal, weights = (*columns, None)[:3]
    elif time is not None:
        raise OptionError("time: expected by beside it, the column that tells curves apart\nhint: by=\"...\"")
    given = {"time_s": time_s, "signal": signal, "weights": weights}
    for name, found in given.items():
        if isinstance(found, Mapping):
            raise OptionError(f"{name}: expected a list of curves, found a mapping\nhint: pass list(curves.values()), or a long table with by=")
        if found is None and name != "weights":
            raise OptionError(f"{name}: expected a list of curves, found None")
    if hasattr(signal, "dims") and hasattr(signal, "coords") and not hasattr(signal, "data_vars"):
        # Dimensions of xarray have names: a curve goes along that of the times.
        named = len(getattr(time_s, "dims", ())) == 1 and time_s.dims[0] in signal.dims
        along = time_s.dims[0] if named else signal.dims[-1]
        if set(getattr(weights, "dims", ())) == set(signal.dims):
            _, weights = _long.of_dimensions(weights.transpose(*signal.dims), along)
        labels, signal = _long.of_dimensions(signal, along)
    if getattr(signal, "ndim", 0) == 2 and getattr(time_s, "ndim", 0) == 1 and not hasattr(signal, "columns"):
        rows, samples = signal.shape
        if len(time_s) == rows != samples:
            message = f"signal: expected a curve of {rows} samples in each row, found {rows} rows of {samples}"
            raise OptionError(f"{message}\nhint: transpose it, signal.T")
    curves = len(signal) if hasattr(signal, "__len__") else 0
    with bar(progress, curves, "fit") as tell:
        table = _palpate.fit_many(time_s, signal, weights, keywords, tell)
    for name, values in reversed(labels.items()):
        if name in table.column_names:
            other = ", ".join(f"{name}_label" if column == name else column for column in labels)
            raise OptionError(f"by: {name!r} is the name of a column of the result\nhint: rename that of the table, such as to {other}")
        table = table._labelled(name, values)
    return table
