"""Types of the compiled part. Checked against it by mypy's stubtest."""

import datetime
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final, Literal, Protocol, Self, TypeAlias, final, overload

import numpy as np
import pandas  # type: ignore[import-untyped, unused-ignore]
import polars
import xarray
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from palpate._options import Control, Intervals, LawName, Loss, Quantity

__all__ = [
    "__version__",
    "_BUILD",
    "_SI_ENDINGS",
    "_card",
    "_checked",
    "_checked_sweep",
    "_contact_numbers",
    "_forget",
    "_found",
    "_run_slice",
    "_sliced",
    "_unit_factor",
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
    "PositionHold",
    "Material",
    "ModelError",
    "Observation",
    "Observer",
    "OptionError",
    "PalpateError",
    "PalpateWarning",
    "Prediction",
    "Record",
    "RecordComparison",
    "RecordError",
    "Schedule",
    "SeveralCalibrations",
    "Table",
    "Trajectory",
    "_Piece",
    "batch",
    "calibrate",
    "command",
    "compare",
    "convert",
    "energy",
    "fit_hold",
    "fit_many",
    "forecast",
    "inspect",
    "merge",
    "latency",
    "law_names",
    "mapping_text",
    "read",
    "read_all",
    "report_all",
    "reproduce",
    "simulate",
    "simulate_many",
    "sweep",
    "watch",
]

__version__: Final[str]
_BUILD: Final[str]
_SI_ENDINGS: Final[dict[str, str]]

_Doubles: TypeAlias = NDArray[np.float64]
_Path: TypeAlias = str | os.PathLike[str]

class _Readable(Protocol):
    def read(self) -> bytes | str: ...

_File: TypeAlias = _Path | bytes | bytearray | memoryview | _Readable | AbstractContextManager[_Readable]
_Described: TypeAlias = _Path | Mapping[str, Any] | Material
_Columns: TypeAlias = str | Mapping[str, str]
# One time: in s, a duration, or a date.
_Parameter: TypeAlias = float | datetime.timedelta | np.timedelta64
_Time: TypeAlias = float | datetime.datetime | datetime.timedelta | np.datetime64 | np.timedelta64
# Numbers are arrays, texts and truths are lists; which of them only the name of the column tells.
_Cells: TypeAlias = Any

class PalpateError(ValueError):
    """Anything that palpate refuses; the message ends in what would help."""
    ...
class RecordError(PalpateError):
    """A record that cannot be read, or has nothing to analyse."""
    ...
class OptionError(PalpateError):
    """An argument that no computation can follow."""
    ...
class ModelError(PalpateError):
    """Numbers that make no body, no law or no motion."""
    ...
class FitError(PalpateError):
    """Samples that no law can be fitted to."""
    ...
class PalpateWarning(UserWarning):
    """Something about a record, or about a question beyond it, that numbers alone do not tell."""
    ...

class _Value:
    # Compared and pickled by what it says.
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]

class _Tabular(_Value):
    # A table for each library.
    def to_pandas(self) -> pandas.DataFrame:
        """The table of this result as a ``pandas.DataFrame``; without pandas an ImportError."""
        ...
    def to_polars(self) -> polars.DataFrame:
        """The table of this result as a ``polars.DataFrame``, without a copy; without polars an ImportError."""
        ...
    def to_xarray(self) -> xarray.Dataset:
        """The table of this result as an ``xarray.Dataset``; without xarray an ImportError.

        The first column is the dimension if no value occurs in it twice, and numbers of rows are otherwise. Variables state their
        units.
        """
        ...

class _Summed(_Tabular):
    # What it comes to, as a table and as text.
    def to_arrow(self) -> Table: ...
    def summary(self) -> str:
        """What this result comes to, as text."""
        ...

class _Series(_Summed):
    # Arrays of one length, and a table of rows.
    def __iter__(self) -> Iterator[dict[str, Any]]: ...
    def __len__(self) -> int: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

class _Reported(_Value):
    # What a command prints.
    def to_dict(self) -> dict[str, Any]: ...
    def to_json(self) -> str:
        """The same as text, as the command prints it."""
        ...

class _Moved(_Value):
    # Changed in place.
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: dict[int, Any], /) -> Self: ...

@final
class _Piece:
    # A part of the bytes of a pickle.
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

@final
class Table(_Tabular):
    """Columns of results, each named with its unit.

    ``table["force_n"]`` is an array where the column holds numbers (NaN where one is missing) and a list with None where it holds
    texts or truths. ``polars.DataFrame(table)``, ``pandas.DataFrame.from_arrow(table)`` and ``pyarrow.table(table)`` take it without
    a copy; ``pandas.DataFrame(table)`` copies it, row by row; without rows it has no columns, which ``to_pandas()`` keeps. ``for row in table`` goes
    through the rows, a dict each; ``table[0]`` and ``table[-1]`` are one.

    Examples
    --------
    >>> import palpate
    >>> table = palpate.fit_many([[0, 1, 2, 3, 4, 5, 6, 7]], [[9, 7, 6, 5.5, 5.2, 5.1, 5.05, 5.02]], law="standard-linear-solid")
    >>> len(table), round(float(table["time_constant_s"][0]), 2)
    (1, 1.46)
    """
    def to_dict(self) -> dict[str, Any]:
        """The columns of this result as lists of plain objects, by name."""
        ...
    column_names: Final[list[str]]
    """Names of the columns."""
    def keys(self) -> list[str]:
        """Names of the columns, as a mapping has them: ``dict(table)`` is one of columns."""
        ...
    def __len__(self) -> int: ...
    # The rows; keys() has the names of the columns.
    def __iter__(self) -> Iterator[dict[str, Any]]: ...
    def __contains__(self, name: object, /) -> bool: ...
    def _repr_html_(self) -> str: ...
    @overload
    def __getitem__(self, name: str, /) -> _Cells: ...
    @overload
    def __getitem__(self, name: int, /) -> dict[str, Any]: ...
    def _labelled(self, name: str, labels: Sequence[Any]) -> Self: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class Record(_Series):
    """A record of time, force and, if there is one, displacement, in SI, checked; loading is positive.

    Made by `palpate.read`, `Record.from_arrays` or `Record.from_arrow`. It never changes, can be compared, copied and pickled,
    and is a table for polars, pandas and pyarrow.

    Examples
    --------
    >>> import palpate
    >>> record = palpate.Record.from_arrays(time_s=[0, 1, 2, 3], force_n=[0.0, 3.0, 2.0, 1.5], displacement_m=[0, 1e-3, 1e-3, 1e-3])
    >>> len(record), float(record.force_n.max())
    (4, 3.0)
    """
    @overload
    @classmethod
    def from_arrays(
        cls,
        *,
        time_s: ArrayLike,
        force_n: ArrayLike,
        displacement_m: ArrayLike | None = None,
        title: str = "record",
    ) -> Self:
        """A record of arrays in SI, loading positive; those of xarray are in the unit that their attribute ``units`` states.

        Parameters
        ----------
        table : optional
            A table in place of arrays, as for `from_arrow`; the others are then names of its columns.
        time_s : array_like, shape (N,)
            Times in s, rising; at least two.
        force_n : array_like, shape (N,)
            Force in N.
        displacement_m : array_like, shape (N,), optional
            Displacement of the jaw in m.
        title : str
            For reports.

        Raises
        ------
        RecordError
            Columns of different lengths, values that are not finite, times that do not rise, a force that never changes.
        OptionError
            Columns that are no numbers.
        """
        ...
    @overload
    @classmethod
    def from_arrays(
        cls,
        table: Any,
        /,
        *,
        time_s: str | None = None,
        force_n: str | None = None,
        displacement_m: str | None = None,
        title: str = "record",
    ) -> Self: ...
    @classmethod
    def from_arrow(
        cls,
        table: Any,
        *,
        time_s: str = "time_s",
        force_n: str = "force_n",
        displacement_m: str | None = None,
        title: str = "record",
    ) -> Self:
        """A record of columns of a table in SI, loading positive.

        Parameters
        ----------
        table
            Of polars, pandas, pyarrow, or anything else with ``__arrow_c_stream__``; a mapping or a Dataset of xarray, by the names of its
            columns, and in the units that these state.
        time_s, force_n, displacement_m : str
            Names of the columns. Times may be durations, or dates, which are seconds since the first. A displacement is looked for under its
            own name if none is given, and may be missing.
        title : str
            For reports.

        Raises
        ------
        RecordError
            No such column, one that is no numbers or lacks some, or as for `from_arrays`.
        """
        ...
    title: Final[str]
    """Title of the record, for reports."""
    x_m: Final[float | None]
    """Where the curve was measured, m; None where its file states no position in a map."""
    y_m: Final[float | None]
    """Second coordinate of that position, m."""
    map_index: Final[int | None]
    """Number of the curve in its map; None where its file does not number it."""
    time_s: Final[_Doubles]
    """Time, s."""
    displacement_m: Final[_Doubles | None]
    """Displacement of the jaw, m; None where it was not recorded."""
    force_n: Final[_Doubles]
    """Force, N."""
    def to_dict(self) -> dict[str, Any]:
        """The columns of this result as lists of plain objects, by name."""
        ...
    def plot(self, ax: Axes | None = None, *, x: str = "time_s", y: str = "force_n", **line: Any) -> Axes:
        """Draw one series against another.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        x, y : str
            Names of the series: ``x="displacement_m"`` draws the hysteresis loop of a cycle.
        line
            Options of ``Axes.plot``.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        OptionError
            A series that there is not.
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...
    corrections: Final[list[str]]
    """What was done to the record, in words and in order."""
    def segments(self) -> Table:
        """The phases, found without labels: loading, hold, unloading, rest.

        Returns
        -------
        Table
            A row a phase: ``phase``, ``start_s``, ``end_s``, ``first_row``, ``last_row`` (both inside), what is held (``mode``),
            what came before (``after``), displacement in m and force in N at both ends.

        Raises
        ------
        RecordError
            Nothing moves, or nothing stands still.
        """
        ...
    def analyze(
        self,
        *,
        test: _Described | None = None,
        exponents: Sequence[float] | None = None,
        free_exponent: bool | None = None,
        confidence: float | None = None,
        intervals: Intervals | None = None,
        fit_until_s: float | None = None,
        hold_start: str | None = None,
        touch: str | float | None = None,
        tolerance_m: float | None = None,
        minimum_hold_s: float | None = None,
        compare: bool = True,
    ) -> Analysis:
        """Phases, strains, laws for every hold, findings: the study of ``palpate analyze``.

        Parameters
        ----------
        test : path, mapping or Material, optional
            A test description in place of that of the record, or a material, which knows the body.
        exponents : sequence of float, optional
            Exponents n to fit with each; those of the description, or 1, 2, 3, 5 and 7, if left out. A list of two or more goes on beyond
            an end that has the lowest criterion, with the finding ``exponent_list_extended``.
        free_exponent : bool, optional
            Whether n is found as well.
        confidence : float, optional
            Coverage of the intervals, between 0 and 1.
        intervals : str, optional
            Method of the intervals of fits: "automatic" (if left out), "curvature", "profile", or "bootstrap", which takes long.
        fit_until_s : float, optional
            Longest stretch of a hold to fit, s.
        hold_start : str, optional
            Where the fit of a hold starts: "peak", "settled" or "peak + 0.5 s"; that of the description, or "peak", if left out.
        touch : str or float, optional
            First touch: "auto", "as recorded", a rule, or a displacement (m); that of the description, or "auto", if left out.
        tolerance_m : float, optional
            Largest deviation of the displacement within a hold, m.
        minimum_hold_s : float, optional
            Shortest hold, s.
        compare : bool
            Whether laws are compared, which takes most of the time.

        Returns
        -------
        Analysis

        Raises
        ------
        RecordError
            No hold, or none that can be fitted.
        OptionError
            An exponent, a confidence or a description that is wrong.

        Warns
        -----
        PalpateWarning
            Findings that forbid the use of a number.
        """
        ...
    def compare(
        self,
        *,
        test: _Described | None = None,
        laws: Sequence[LawName] | None = None,
        cuts: Sequence[float] | None = None,
        creep: bool = False,
        intervals: Intervals | None = None,
        fit_until_s: float | None = None,
        loss: Loss = "squares",
        samples: str = "all",
        ramps: Literal["step", "measured"] = "step",
    ) -> RecordComparison:
        """Which law predicts the holds of the record, how sure that is, and what another would cost: what ``palpate compare`` finds.

        Parameters
        ----------
        test : path, mapping or Material, optional
            A test description in place of that of the record.
        laws : sequence of str, optional
            Laws to compare; all that suit if left out.
        cuts : sequence of float, optional
            Parts of a hold that are fitted to predict the rest, as shares of its duration.
        creep : bool
            Whether laws of creep are compared: displacement in holds of constant force.
        intervals : str, optional
            Method of the intervals of fits: "automatic" (if left out), "curvature", "profile", or "bootstrap", which takes long.
        fit_until_s : float, optional
            Compare only over this long from the start of each hold, s.
        loss : str
            Loss function of the residuals: "squares", or "huber" or "tukey" where single samples stray.
        samples : str
            Samples to fit: "all", or "log:400" for about 400, evenly spaced in ln t.
        ramps : str
            Loading before a hold, as linear laws take it: "step", or "measured".

        Returns
        -------
        RecordComparison

        Raises
        ------
        RecordError
            No hold to compare on.
        OptionError
            A law that is none, or has no such form.
        """
        ...
    def calibrate(
        self,
        *,
        law: LawName = "latency",
        test: _Described | None = None,
        alternatives: Sequence[LawName] | None = None,
        equilibrium: str | None = None,
        poisson_ratio: float | None = None,
        rate: str = "constant",
        fit_until_s: float | None = None,
        confidence: float | None = None,
        profile: bool = False,
    ) -> Calibration:
        """One set of numbers for the whole record, ramps and holds alike: what ``palpate calibrate`` finds.

        The latency law, strain rate = -v (e - e_e)^n of equation (10) of Tsai, Kao et al., in layers of a thickness that is found as well: holds
        carry n and v, ramps the layer thickness, relaxed levels the modulus. No starting values: a grid is searched first.

        Parameters
        ----------
        law : str
            "latency" (n found), "latency:5" (n given), "standard-linear-solid", "prony:K" or "fung:K".
        test : path, mapping or Material, optional
            A test description in place of that of the record; one of them has to know the body: ``{"specimen": {"shape": "ball", "radius":
            "35 mm"}}``.
        alternatives : sequence of str, optional
            Laws to hold against it on the same record; "latency", "standard-linear-solid", "prony:2", "prony:3" and "fung:2" if left out, none for
            an empty list.
        equilibrium : str, optional
            Law of the force once relaxation is over: "uniform-strain" (modulus x displacement/depth x contact area, equation (11)), "hertz", or
            "table", a monotone one with a row where the jaw was held; that of the description if left out.
        poisson_ratio : float, optional
            For Hertz's law, from 0 to 0.5; that of the description, or 0.5, if left out.
        rate : str
            What the rate coefficient v of the latency law depends on, by one more number: "constant"; "by-strain", v f^(ε_e/0.1) with
            f = ``strain_factor``; or "by-direction", v after loading and f v after unloading with f = ``unloading_factor``. The other
            two are alternatives then.
        fit_until_s : float, optional
            Fit only up to this time of the record, s, and predict the rest.
        confidence : float, optional
            Coverage of the intervals, between 0 and 1; that of the description, or 0.95, if left out.
        profile : bool
            Add profile intervals, which are asymmetric, and open where the record leaves a number open.

        Returns
        -------
        Calibration
            The material, the residuals of the record, and the alternatives.

        Raises
        ------
        RecordError
            No displacement, no phases.
        OptionError
            No body described, a law of single holds alone, a time outside the record, or any other option that is wrong.
        ModelError
            A body that the jaw goes through, a law of the equilibrium force that does not go with it.
        FitError
            Too few samples, or a force that does not rise with the squeeze.

        Warns
        -----
        PalpateWarning
            The record leaves a number open.

        Examples
        --------
        >>> import palpate
        >>> ball = {"shape": "ball", "radius": "35 mm"}
        >>> squeezed = palpate.simulate({
        ...     "specimen": {**ball, "modulus": "28 kPa"},
        ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
        ...     "step": [{"to": to, "rate": "500 mm/min", "hold": "20 s"} for to in ("5 mm", "10 mm")],
        ...     "output": {"sample_rate": "10 Hz"},
        ... })
        >>> record = palpate.Record.from_arrays(
        ...     time_s=squeezed.time_s, displacement_m=squeezed.displacement_m, force_n=squeezed.force_n
        ... )
        >>> calibration = record.calibrate(test={"specimen": ball}, alternatives=[])
        >>> round(calibration.material.parameters["exponent"], 2)
        5.0
        >>> prediction = calibration.material.predict([{"to": "8 mm", "rate": "500 mm/min", "hold": "20 s"}], at_s=[10.0])
        >>> round(float(prediction.force_n[0]), 2)
        3.45
        """
        ...

@final
class BatchResult(_Value):
    """What a batch found over all holds; ``print(result)`` shows what ``palpate batch`` prints."""
    law: Final[str | None]
    """The law that is recommended on the most holds; None where none was fitted."""
    laws: Final[dict[str, int]]
    """Every recommended law with the number of holds that it is recommended for, the most first."""
    parameters: Final[Table]
    """The parameters of that law over those holds, a row each: ``parameter``, ``unit``, ``median``, ``lower_quartile``,
    ``upper_quartile``, ``holds``.
    """
    findings: Final[dict[str, int]]
    """The most frequent findings by code, with the number of holds that have them."""
    holds: Final[int]
    """Holds in all."""
    unfitted: Final[int]
    """Holds without a fitted law."""
    without_hold: Final[int]
    """Tests without a hold; each has one row, whose ``termination`` says why."""
    loading_modulus_pa: Final[float | None]
    """Median of Young's modulus of the first loading ramp over the tests that have one, Pa."""
    table: Final[str]
    """Path of the table, as given: ``pandas.read_parquet(result.table)``."""
    rows: Final[int]
    """Rows of the table."""
    failures: Final[list[str]]
    """Why tests gave no rows, a sentence each."""
    def summary(self) -> str:
        """What this result comes to, as text."""
        ...
    def map(self, quantity: str) -> str:
        """A map of a quantity over the positions of the curves, as SVG.

        Parameters
        ----------
        quantity : str
            A parameter of the law recommended for the first hold of each curve, or a column of the table, by its name; "v", "n" and "E"
            stand for ``rate_coefficient_per_s``, ``exponent`` and ``loading_modulus_pa``.

        Returns
        -------
        str
            Cells where the positions form a grid, otherwise points, with a bar of colours.

        Raises
        ------
        OptionError
            No curve has a position, or none a value of that name.
        """
        ...

@final
class Finding(_Value):
    """Something about a record, or a hold, that its numbers alone do not tell."""
    code: Final[str]
    """Stable code, such as "saturated"."""
    severity: Final[str]
    """"info", "caution" or "warning"."""
    observation: Final[str]
    """What was observed."""
    meaning: Final[str]
    """What it may mean."""
    remedy: Final[str]
    """What helps."""
    hold: Final[int | None]
    """Number of the hold, from 1; None for the record as a whole."""

@final
class Analysis(_Summed, _Reported):
    """Phases, laws of every hold and findings of one record; a page with figures in a notebook.

    ``print(analysis)`` shows what ``palpate analyze`` does.

    What its document says is kept as that; the study behind it is made anew, from the same record and the same options, where a
    report is requested of an analysis that came from elsewhere.
    """
    segments: Final[Table]
    """The phases, a row each."""
    holds: Final[Table]
    """The holds, a row each; ``preferred_exponent`` is that of the lowest information criterion, ``lowest_exponent`` the lowest listed
    one that is not distinguishable from the best listed one.
    """
    fits: Final[Table]
    """The latency law fitted to every hold, a row each: ``hold``, ``law``, ``domain``, ``exponent``, ``equilibrium``, ...,
    each parameter with its standard error and interval.
    """
    parameter_table: Final[Table]
    """Every parameter of every law on every hold, a row each: ``record``, ``part``, ``hold``, ``law``, ``parameter``, ``unit``, ``value``,
    ``standard_error``, ``low``, ``high``, ``termination``, ``white_standard_error``, ``role``, ``domain``, ``recommended``. An
    end of an interval that is open is infinite, or 0 below a parameter that is never negative, as in `Fit.estimates`; without an
    interval both are missing.
    """
    budgets: Final[Table]
    """Uncertainty budgets (JCGM 100) of the parameters of the law of the record, a row for each input quantity of each: ``hold``, ``law``,
    ``parameter``, ``unit``, ``value``, ``combined_standard_uncertainty``, ``expanded_uncertainty``, ``input``, ``input_unit``, ``evaluation``,
    ``distribution``, ``standard_uncertainty``, ``sensitivity``, ``contribution``, ``share``; empty where the test description has no
    ``[instrument]``.
    """
    conditions: Final[dict[str, Any]]
    """Conditions of the test as its description states them in ``[conditions]``: ``temperature_k``, ``relative_humidity``, ``medium``,
    ``conditioning``, ``specimen_form``, ``lubricant``, ``initial_force_after_s``; None is not stated.
    """
    constraint: Final[Table]
    """How the displacement of each hold was applied and held, a row each: ``hold``, ``applied_in_s``, ``constraint_variation_m``,
    ``relative_constraint_variation``, ``initial_force_n``, ``initial_force_standard_error_n``.
    """
    relaxation_at: Final[Table]
    """Force and R(t) = (F₀ − F(t))/F₀ of holds of the displacement at the stated times that were measured, a row each: ``hold``,
    ``time_s``, ``force_n``, ``force_standard_error_n``, ``relaxation``, ``relaxation_standard_error``, ``low``, ``high``.
    """
    loading_modulus_pa: Final[float | None]
    """Young's modulus of the first loading ramp, Pa: an apparent one of a body that relaxes; None where the geometry is not known."""
    loading_modulus_standard_error_pa: Final[float | None]
    """Its standard error, Pa: of the residuals, and of first touch where that has one."""
    law: Final[str | None]
    """The law to use for the record as a whole, as ``law=`` takes it; None where none can be recommended."""
    sentence: Final[str]
    """Which law to use, in a sentence."""
    findings: Final[list[Finding]]
    """What to know besides the estimates."""
    def fit(self, hold: int = 1, *, law: LawName | None = None) -> Fit:
        """The fit of a law to one hold, with its samples: strain where the body is known, and else force (N), on the clock of the record.

        Parameters
        ----------
        hold : int
            Number of the hold, from 1: ``index`` in `holds`.
        law : str, optional
            One of the laws that were fitted to it, such as "latency:5"; if left out the recommended one, or without a comparison the latency
            law with the preferred exponent.

        Returns
        -------
        Fit

        Raises
        ------
        OptionError
            A hold that there is not, a law that was not fitted.
        FitError
            A hold without a force that relaxes.

        Examples
        --------
        >>> import numpy as np, palpate
        >>> t = np.linspace(0.0, 60.0, 1200)
        >>> force = np.where(t < 10.0, 0.3 * t, 1 + 2 * np.exp(-(t - 10.0) / 8))
        >>> record = palpate.Record.from_arrays(time_s=t, force_n=force, displacement_m=np.minimum(t, 10.0) * 1e-3)
        >>> fit = record.analyze().fit(1, law="standard-linear-solid")
        >>> round(fit.parameters["time_constant_s"], 3)
        8.0
        """
        ...
    def _course(self) -> tuple[_Doubles, _Doubles, list[tuple[int, str, list[float], list[float]]]]: ...
    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draw the force over time, and in each hold the law that `Analysis.fit` gives.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        line
            Options of ``Axes.plot`` for the laws.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def report(
        self,
        folder: _Path,
        *,
        figures: Sequence[str] | None = None,
        column: str | None = None,
        holds: Sequence[int] | None = None,
        csv_locale: str | None = None,
    ) -> os.PathLike[str]:
        """Writes report.html, analysis.json, tables and figures into a folder, all or none.

        Parameters
        ----------
        folder : path
            Made if it is not there.
        figures : sequence of str
            Formats of the figure files: "svg" (if left out), "png", "pdf" (with the typeface embedded).
        column : str, optional
            "single" (85 mm) or "double" (174 mm): the figure files are as wide as a column of a journal; each has its own width if left out.
        holds : sequence of int, optional
            Numbers of the holds that the figure files show, from 1; all if left out.
        csv_locale : str
            Language of the readers of CSV files: "en" (if left out) has decimal points and commas between cells, "de", "es", "fr", "it", "nl",
            "pl" and "pt" have decimal commas and semicolons.

        Returns
        -------
        Path
            The report.

        Raises
        ------
        PalpateError
            The folder cannot be written to.
        OptionError
            A format, a width or a language that there is not.
        """
        ...
    def _repr_html_(self) -> str | None: ...

@final
class Calibration(_Series, _Reported):
    """One set of parameters for a whole record, ramps and holds alike: a material, the residuals of its law, and its alternatives.

    Made by `Record.calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does; series are tables for polars, pandas and
    pyarrow, and a notebook shows tables and figure.
    """
    material: Final[Material]
    """The body with the parameters of the law that was requested."""
    laws: Final[Table]
    """The laws, a row each, the one that was requested first: ``free_parameters``, root mean square residual ``rmse_n``, the same as a
    share of the largest force (``relative``), BIC less the lowest (``delta_bic``), with ``fit_until_s`` the errors of what was
    predicted, ``termination``, and why there is no calibration (``error``).
    """
    parameter_table: Final[Table]
    """The parameters of the law that was requested, with the columns of `Analysis.parameter_table` and, where profiles were requested,
    ``profile_low`` and ``profile_high``, 0 and inf where the record leaves
    them open: no parameter is below 0.
    """
    budgets: Final[Table]
    """Uncertainty budgets (JCGM 100) of the parameters of the law that was requested, with the columns of `Analysis.budgets`."""
    sentence: Final[str | None]
    """Which law predicts best, or has the lowest BIC, in a sentence; None without alternatives."""
    remarks: Final[list[str]]
    """What the parameters alone do not tell, in sentences."""
    findings: Final[list[Finding]]
    """What to know of the record besides the parameters."""
    termination: Final[str]
    """Why the search ended: "converged", or what kept it from that."""
    is_good: Final[bool]
    """Whether it ended at an optimum inside the range that was searched."""
    rmse_n: Final[float]
    """Root mean square residual over the fitted samples, N."""
    fitted: Final[int]
    """How many samples, from the first on, were fitted; the rest was held out."""
    time_s: Final[_Doubles]
    """Time of every sample, s, on the clock of the record."""
    displacement_m: Final[_Doubles]
    """Displacement of the jaw since first touch, m, as it was simulated."""
    force_n: Final[_Doubles]
    """Measured force, N."""
    simulated_n: Final[_Doubles]
    """Force by the law, N."""
    residual_n: Final[_Doubles]
    """Measured less simulated force, N."""
    def report(self) -> str:
        """Tables of the laws and of the parameters, and remarks, as text."""
        ...
    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draw measured and simulated force over time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        line
            Options of ``Axes.plot`` for the simulated force.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...

@final
class SeveralCalibrations(_Reported):
    """Several records of one body or one batch in one calibration: shared and own parameters, and the spread between specimens.

    Made by `calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does of several records.
    """
    specimen: Final[Material | None]
    """A specimen of the batch that was not tested, whose intervals contain the spread between specimens; the body itself where all
    parameters are shared. None for own parameters of two records.
    """
    materials: Final[list[Material]]
    """The material of each record."""
    parameter_table: Final[Table]
    """The parameters of the batch, a row each: ``parameter``, ``unit``, ``between`` ("shared", "own" or "given"), ``value`` (of own ones the
    geometric mean), ``standard_error``, ``low``, ``high``, infinite where an end is open; of own ones the standard
    deviation of the logarithm between specimens, ``spread``, ``spread_low``, ``spread_high``; of shared ones ``one_value_p``, the
    probability that records of one value differ as much as these do when calibrated alone.
    """
    record_table: Final[Table]
    """The records, a row each: ``record``, ``rmse_n``, ``rmse_alone_n``, ``relative``, and a column for each parameter."""
    remarks: Final[list[str]]
    """What the parameters alone do not tell, in sentences."""
    def __len__(self) -> int: ...
    def report(self) -> str:
        """Tables of parameters and records, and remarks, as text."""
        ...
    def _repr_html_(self) -> str: ...

@final
class Material(_Value):
    """A calibrated body: shape, law and parameters with their covariance, the range of its test, and where they come from.

    Made by `Record.calibrate` or `Material.read`. Wherever a protocol, a model or a test description is taken, its ``material`` may be
    one, and a description may be one: ``palpate.simulate({"material": material, "step": [...]})``, ``palpate.ContactState(material)``,
    ``record.analyze(test=material)``.
    """
    @classmethod
    def read(cls, path: _Path) -> Self:
        """The material in a file of ``palpate calibrate`` or of `write`, checked.

        Parameters
        ----------
        path : path
            A material file (TOML); ``palpate schema material`` prints its schema.

        Raises
        ------
        OptionError
            No material, one of another version, or one whose parameters were changed by hand; the message names line and key.
        OSError
            The operating system does not hand the file out.
        """
        ...
    def write(self, path: _Path) -> None:
        """Writes the file that ``palpate calibrate --out`` writes, whole or not at all.

        Parameters
        ----------
        path : path
            The file; its folder is made if it is not there.

        Raises
        ------
        PalpateError
            The file cannot be written.
        """
        ...
    def to_toml(self) -> str:
        """The same as text."""
        ...
    law: Final[str]
    """Name of the law as it was fitted, such as "latency", "latency:5" or "prony:2"."""
    equilibrium: Final[str]
    """Law of the force once relaxation is over: "uniform-strain", "hertz" or "table"."""
    parameter_table: Final[Table]
    """The parameters, a row each: ``parameter``, ``unit``, ``value``, ``standard_error``, ``low`` and ``high``, in SI; the latter three are missing
    for a parameter that was given, or that the record leaves open.
    """
    estimates: Final[dict[str, Estimate]]
    """Every parameter by its name: "modulus_pa" (or "equilibrium_force_1_n", ...), and "exponent", "rate_coefficient_per_s" and "layer_thickness" of the
    latency law, "overshoot_1", "time_constant_1_s", ... of a linear one.
    """
    parameters: Final[dict[str, float]]
    """Values of all parameters by name, in SI."""
    log_covariance: Final[_Doubles | None]
    """Covariance of the natural logarithms of the parameters, in their order; None where the record leaves one open."""
    confidence: Final[float | None]
    """Coverage of the intervals of the parameters; None where they have none."""
    misfit: Final[str | None]
    """What the record shows against the law, and what helps, in a sentence; None where nothing. Grips state it first."""
    noise_n: Final[float]
    """Standard deviation of what the law left of the measured force, N: noise of one reading."""
    calibration_range: Final[dict[str, float]]
    """The range of the test, beyond which predictions are extrapolations: ``longest_hold_s`` of the displacement,
    ``longest_force_hold_s``, ``deepest_m``, ``fastest_m_per_s``, ``slowest_m_per_s``, ``largest_force_n``,
    ``farthest_retreat_m``, ``loadings``.
    """
    origin: Final[dict[str, Any]]
    """Where the parameters come from: ``record``, ``sha256`` of its file, number of ``specimens`` of a batch another of which it is, ``test`` description, version of ``palpate``, ``samples`` fitted."""
    def predict(
        self,
        protocol: _Path | Mapping[str, Any] | Sequence[Mapping[str, Any]] | Record,
        *,
        at_s: ArrayLike | None = None,
        confidence: float = 0.95,
    ) -> Prediction:
        """What the body does under a protocol, or along the measured displacement of a record, with intervals: what ``palpate predict`` says.

        The variance of the force is the sum over the columns of a root of the covariance, C = L L^T, of ((f(+L_k) - f(-L_k))/2)^2.

        Parameters
        ----------
        protocol : path, mapping, sequence of mappings, or Record
            A protocol whose body, if it has one, is left aside; or its steps alone: ``[{"to": "12 mm", "rate": "500 mm/min", "hold": "60 s"}]``.
            Of a record the displacement is taken, from first touch on, corrected as its description says; the times are on its clock, and
            its force serves to find first touch alone.
        at_s : array_like, shape (N,), optional
            Times at which the force is wanted, s, rising and inside the motion; if left out those of the protocol's output, or the samples of
            the record.
        confidence : float
            Coverage of the intervals, between 0 and 1.

        Returns
        -------
        Prediction
            Force and displacement with the intervals of their means and of one reading.

        Raises
        ------
        OptionError
            A protocol that says what no contact can do; a coverage that is no share.
        ModelError
            A motion that the body cannot take, a time outside it.
        RecordError
            A record without a displacement, or without phases.

        Warns
        -----
        PalpateWarning
            A longer hold, a deeper squeeze, a faster ramp, a larger force than the test has shown, or a force that is held: answered all
            the same. A material of which a parameter was left open.
        """
        ...
    def grip(
        self,
        *,
        mass_kg: float,
        friction: float,
        safety: float = 1.0,
        acceleration_up_m_per_s2: float = 0.0,
        acceleration_across_m_per_s2: float = 0.0,
        acceleration_closing_m_per_s2: float = 0.0,
        torque_n_m: float = 0.0,
        off_centre_m: float = 0.0,
        gravity_m_per_s2: float = 9.80665,
        speed_m_per_s: float | None = None,
        stroke_m: float | None = None,
        most_force_n: float | None = None,
        close_within_s: float | None = None,
        control: Control = "position",
        squeeze_m: float | None = None,
        force_n: float | None = None,
        hold_s: float | None = None,
        objective: Literal["squeeze", "peak-force", "work"] | None = None,
        band_n: tuple[float, float] | None = None,
        regrip: Literal["moves", "work"] | None = None,
        shortest_pause_s: float | None = None,
        confidence: float = 0.95,
    ) -> Grip:
        """How to squeeze the body between two jaws, and how long that holds: what ``palpate grip`` says.

        Each jaw carries half of the weight and of the torsion about the closing axis. With T the tangential force at a jaw, M its torsion,
        a the radius of the contact and S the safety factor F = S sqrt(T^2 + (M/(c a))^2)/mu + m |a_closing|/2 is needed.

        Parameters
        ----------
        mass_kg : float
            Mass of the body, kg.
        friction : float
            Coefficient of friction between jaw and body.
        safety : float
            Safety factor on friction, 1 or more.
        acceleration_up_m_per_s2, acceleration_across_m_per_s2, acceleration_closing_m_per_s2 : float
            Acceleration of the hand upwards, across gravity in the plane of the jaws, and along the closing axis, m/s^2.
        torque_n_m : float
            Torque about the closing axis, N m.
        off_centre_m : float
            Distance of the centre of mass from the closing axis, m.
        gravity_m_per_s2 : float
            Gravity, m/s^2.
        speed_m_per_s : float, optional
            The fastest that the jaws go, m/s; the fastest ramp of the test if left out.
        stroke_m, most_force_n : float, optional
            How far the jaws may squeeze, m, and the largest force that gripper and body bear, N.
        close_within_s : float, optional
            How long closing may take, s; any time if left out.
        control : str
            What the gripper holds once it has closed: "position" (the force relaxes) or "force" (the body creeps).
        squeeze_m : float, optional
            Squeeze that is in question, m; the least that holds is sought if left out.
        force_n : float, optional
            Force that is in question with ``control="force"``, N; the least that is enough if left out.
        hold_s : float, optional
            How long it is to hold, s; ``math.inf`` for always. 60 s if neither this nor a squeeze is given.
        objective : str, optional
            What the squeeze that is sought should have least of: "squeeze" (if left out), "peak-force" or "work".
        band_n : tuple of float, optional
            Two forces, N, between which squeezes again and again keep the force.
        regrip : str, optional
            What that schedule should have least of: "moves" (if left out) or "work".
        shortest_pause_s : float, optional
            The shortest pause between two squeezes of that schedule, s; if left out, 1 with least work, and any with fewest moves.
        confidence : float
            Probability with which the verdict has to hold, between 0 and 1; 0.5 for the best estimate. Intervals are of 95 %.

        Returns
        -------
        Grip
            The squeeze that is in question, overshoot and back off, the force held and the schedule, beside one another. That none holds is an
            answer: ``holds`` is false, ``refused`` says why.

        Raises
        ------
        OptionError
            Parameters that describe no load, no gripper or no question; options that exclude each other.
        ModelError
            A body that was tested bonded to its grips.

        Warns
        -----
        PalpateWarning
            A longer hold, a deeper squeeze, a faster ramp, a larger force than the test has shown, or a force that is held: answered all
            the same. A material of which a parameter was left open.

        Examples
        --------
        0.25 kg between jaws with a friction of 0.6 need 0.25 * 9.80665/(2 * 0.6) N.

        >>> import palpate
        >>> made = palpate.simulate({
        ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
        ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
        ...     "step": [
        ...         {"to": "5 mm", "rate": "500 mm/min", "hold": "20 s"},
        ...         {"to": "9 mm", "rate": "500 mm/min", "hold": "20 s"},
        ...     ],
        ... })
        >>> record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
        >>> material = record.calibrate(test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[]).material
        >>> grip = material.grip(mass_kg=0.25, friction=0.6, squeeze_m=0.005)
        >>> round(grip.squeeze.needed_force_n, 3), round(grip.time_to_slip_s, 2)
        (2.043, 0.61)
        """
        ...
    def _repr_html_(self) -> str: ...

@final
class Grip(_Summed, _Reported):
    """How a calibrated body is to be gripped, and how long that holds: what ``palpate grip`` says.

    Made by `Material.grip`. ``print(grip)`` shows the text of ``palpate grip``; a notebook shows its report.
    """
    holds: Final[bool]
    """Whether the grip that is in question holds as long as was requested; without a time whether it does at all."""
    misfit: Final[str | None]
    """What the record of the material shows against its law, and what helps, in a sentence; None where nothing. It is the first remark too."""
    verdict: Final[str]
    """The answer in a sentence."""
    question: Final[str]
    """The question in a sentence."""
    remarks: Final[list[str]]
    """What the parameters mean, a sentence each."""
    extrapolations: Final[list[str]]
    """How the question goes beyond what the test has shown, a sentence each."""
    confidence: Final[float]
    """Coverage of the intervals."""
    probability: Final[float | None]
    """Probability that the grip that is in question holds as long as was requested; None if the calibration has no intervals."""
    assured_squeeze_m: Final[float | None]
    """The least squeeze that reaches the probability required, m, if the one in question does not; None without one."""
    assured_time_s: Final[float | None]
    """Time that the squeeze holds with the probability required, s; infinite for always, None if the calibration has no intervals."""
    squeeze: Final[PositionHold | None]
    """The squeeze with the displacement held: the one that is in question, or the least; None if there is none."""
    squeeze_m: Final[float | None]
    """Displacement of that squeeze, m."""
    time_to_slip_s: Final[float | None]
    """From the start of its hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once."""
    time_to_slip_interval_s: Final[tuple[float, float] | None]
    """Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing."""
    neighbours: Final[Table]
    """How long squeezes a little less and more deep hold: ``displacement_m`` and ``time_to_slip_s``."""
    back_off: Final[BackOff | None]
    """Overshoot and back off (a preconditioning squeeze), so that the hold begins relaxed; None if there is none."""
    force_held: Final[ForceHold | None]
    """The force held; None if there is none."""
    schedule: Final[Schedule | None]
    """Squeezes that keep the force in a band; None if none was requested, or none does."""
    refused: Final[dict[str, str]]
    """Grips that there are not, by name, each with the reason and what would help."""
    def to_svg(self) -> str:
        """Force, margin and displacement of the grips over time, as SVG."""
        ...
    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draw the force of each grip over time, and the force that the squeeze needs.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        line
            Options of ``Axes.plot`` for the forces.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def report(self, folder: _Path) -> os.PathLike[str]:
        """Writes what ``palpate grip --out`` writes into a folder, all or none: report.html, grip.json, tables, figure and series.

        Parameters
        ----------
        folder : path
            Made if it is not there.

        Returns
        -------
        Path
            The report.

        Raises
        ------
        PalpateError
            The folder cannot be written to.
        """
        ...
    def _repr_html_(self) -> str | None: ...

@final
class PositionHold(_Value):
    """A grip with the displacement held; SI units."""
    kind: Final[Literal["squeeze", "settle", "back_off"]]
    """How the jaws close: "squeeze", "settle" (a force is kept before they are locked) or "back_off"."""
    over_m: Final[float | None]
    """Where the jaws turn, m; None but for a retreat."""
    settling_force_n: Final[float | None]
    """Force that is kept before the jaws are locked, N; None but for a grip that settles."""
    settling_s: Final[float | None]
    """How long it is kept, s."""
    speed_m_per_s: Final[float]
    """Speed of the jaws, m/s."""
    closing_s: Final[float]
    """How long closing takes, s."""
    displacement_m: Final[float]
    """Displacement in the hold, m."""
    needed_force_n: Final[float]
    """Force that is needed there, N."""
    start_force_n: Final[float]
    """Force at the start of the hold, N."""
    peak_force_n: Final[float]
    """The largest force, N."""
    equilibrium_force_n: Final[float]
    """The force that the hold tends to, N."""
    work_j: Final[float]
    """Work of the jaws while they close, J."""
    sharpness_per_m: Final[float | None]
    """How sharply the time depends on the squeeze, d ln(time)/d(displacement), 1/m; None where it slips at once or never."""
    time_to_slip_s: Final[float]
    """From the start of the hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once."""
    time_to_slip_interval_s: Final[tuple[float, float] | None]
    """Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing."""
    assured_time_s: Final[float | None]
    """Time that it holds with the probability required, s; infinite for always, None if the calibration has no intervals."""
    course: Final[Prediction | None]
    """Force and displacement over time, with intervals; None for the plain squeeze beside a retreat."""

@final
class BackOff(_Value):
    """Overshoot and back off (a preconditioning squeeze), beside the plain squeeze to the same position; SI units."""
    backed: Final[PositionHold]
    """The retreat: its hold begins relaxed."""
    plain: Final[PositionHold]
    """The plain squeeze."""
    duration_s: Final[float]
    """Time over which drifts are given, s."""
    drift_n: Final[float]
    """Change of the force over that time after the retreat, N."""
    plain_drift_n: Final[float]
    """The same after the plain squeeze, N."""
    sensitivities: Final[Table]
    """What 1 % more of a parameter of the material does to it: ``parameter``, its ``relative_error``, by how much the force at the start of the
    hold misses the relaxed one (``missed_n``), by how much farther the jaws would have to go (``over_m``).
    """

@final
class ForceHold(_Value):
    """The force held: it does not relax, the body creeps; SI units."""
    force_n: Final[float]
    """The force, N."""
    duration_s: Final[float]
    """How long it is held, s."""
    needed_force_n: Final[float]
    """Force that is needed, N."""
    closing_s: Final[float]
    """How long closing takes, s."""
    displacement_start_m: Final[float]
    """Displacement when the hold begins, m."""
    displacement_end_m: Final[float]
    """Displacement when it ends, m."""
    displacement_relaxed_m: Final[float | None]
    """Displacement that it tends to, m; None if none of the body carries the force relaxed."""
    holds: Final[bool]
    """Whether the force is enough."""
    stroke_ends_s: Final[float | None]
    """When the jaws come to the end of their stroke, s since the hold began; None if they do not."""
    work_j: Final[float]
    """Work of the jaws, J."""
    course: Final[Prediction]
    """Force and displacement over time, with intervals."""

@final
class Schedule(_Value):
    """Squeezes that keep the force in a band; SI units."""
    objective: Final[Literal["moves", "work"]]
    """What it has least of: "moves" or "work"."""
    band_n: Final[tuple[float, float]]
    """Edges of the band, N."""
    duration_s: Final[float]
    """How long it lasts behind the first squeeze, s."""
    moves: Final[Table]
    """The squeezes, the first among them: ``time_s`` since first touch, ``from_m``, ``to_m``, ``force_from_n``, ``force_to_n``."""
    end_force_n: Final[float]
    """Force at its end, N."""
    end_displacement_m: Final[float]
    """Displacement at its end, m."""
    work_j: Final[float]
    """Work of the jaws, J."""
    course: Final[Prediction]
    """Force and displacement over time, with intervals."""

@final
class Observation(_Value):
    """What an observer says after a tick; None where something is not known.

    Made by `Observer.feed`.
    """
    time_s: Final[float]
    """When, s."""
    phase: Final[Literal["free", "loading", "holding", "unloading"]]
    """What happens: "free", "loading", "holding" or "unloading"."""
    held: Final[Literal["displacement", "force"] | None]
    """What is held, "displacement" or "force"; None outside a hold."""
    held_since_s: Final[float | None]
    """When the hold began, s."""
    began: Final[bool]
    """True on the one tick that says that a hold began."""
    force_n: Final[float]
    """The force without its noise, N: the fitted curve inside a hold, a filter's elsewhere."""
    equilibrium_force_n: Final[float | None]
    """The force that a hold of the displacement tends to, N; None until its interval is narrower than the force itself."""
    equilibrium_force_standard_error_n: Final[float | None]
    """Its standard deviation, N."""
    excess_force_n: Final[float | None]
    """Force in excess of equilibrium, N."""
    excess_force_standard_error_n: Final[float | None]
    """Its standard deviation, N."""
    excess_strain: Final[float | None]
    """Strain in excess of equilibrium; only a material tells it."""
    excess_strain_standard_error: Final[float | None]
    """Its standard deviation."""
    relative_rate_per_s: Final[float | None]
    """Rate at which the excess falls now, in shares of itself, 1/s."""
    creep_rate_m_per_s: Final[float | None]
    """Speed of the creep while the force is held, m/s."""
    creep_rate_standard_error_m_per_s: Final[float | None]
    """Its standard deviation, m/s."""
    slips: Final[Literal["not_known_yet", "never", "perhaps_never", "after"] | None]
    """Whether it slips: "not_known_yet", "never" (by relaxation), "perhaps_never" or "after"; None where no force of slip was given."""
    time_to_slip_s: Final[float | None]
    """How long until the force has fallen to that of slip, s; infinite for never, None where that is not known."""
    time_to_slip_low_s: Final[float | None]
    """Lower end of its interval, s."""
    time_to_slip_high_s: Final[float | None]
    """Upper end of its interval, s; infinite where never lies inside."""
    warning: Final[Literal["none", "soon", "slipping"]]
    """"none", "soon" (slip within the time to warn cannot be excluded) or "slipping"."""

@final
class Observer(_Moved):
    """Watches a contact tick by tick, as a controller would: when a hold begins, where its force tends, how long until it slips.

    It knows nothing but what came before, keeps a hold of any length as 64 means, and fits it anew each time it has become 4 % longer.
    ``palpate watch`` replays a log through the same observer.

    Parameters
    ----------
    material : Material, optional
        The calibrated body, of the latency law: its excess strain is then known from first touch on. Displacements count from there.
    exponent : float, optional
        Exponent of the law where no material says it, from 1 to 30; 5 if left out.
    exponent_standard_error : float, optional
        Standard deviation to which that exponent is known, from 0 to 10; 0 if left out.
    slip_force_n : float, optional
        Normal force at and below which what is held slips, N; without it nobody asks for slip.
    warn_before_s : float
        How long before slip to warn, s.
    confidence : float
        Coverage of the intervals, between 0 and 1.
    displacement_noise_m, force_noise_n : float, optional
        Standard deviation of one reading, m and N, both or none; found out from the readings if left out.
    stiffness_standard_error : float
        With a material: by how much the stiffness of this body may differ, as a standard deviation of its logarithm, from 0 to 1.
    touch_standard_error_m : float
        With a material: standard deviation to which first touch is known, m; intervals hold up to some 6 % of the squeeze.

    Raises
    ------
    OptionError
        A number out of its range, or one that a material says itself.
    ModelError
        A material of another law than latency.

    Examples
    --------
    5 mm within 0.5 s, then a hold whose force tends to 1.2 N; it is 2 N 0.81 s later.

    >>> import numpy as np, palpate
    >>> t = np.arange(60_001) * 1e-3
    >>> hold = palpate.laws.latency(np.maximum(t - 0.5, 0.0), 1.2, 1.7, 6.0, 5.0)
    >>> force, displacement = np.where(t < 0.5, 5.8 * t, hold), np.minimum(0.01 * t, 0.005)
    >>> observer = palpate.Observer(slip_force_n=2.0, warn_before_s=0.5)
    >>> observed = observer.feed_many(t[:1000], force[:1000], displacement[:1000])
    >>> round(float(observed["time_to_slip_s"][-1]), 2), round(float(hold[1310]), 2)
    (0.31, 2.0)
    >>> for i in range(1000, len(t)):
    ...     now = observer.feed(t[i], force[i], displacement[i])
    >>> now.phase, now.held, now.warning, round(now.equilibrium_force_n, 3)
    ('holding', 'displacement', 'slipping', 1.2)
    """
    def __new__(
        cls,
        material: Material | None = None,
        *,
        exponent: float | None = None,
        exponent_standard_error: float | None = None,
        slip_force_n: float | None = None,
        warn_before_s: float = 1.0,
        confidence: float = 0.95,
        displacement_noise_m: float | None = None,
        force_noise_n: float | None = None,
        stiffness_standard_error: float = 0.05,
        touch_standard_error_m: float = 1e-4,
    ) -> Self: ...
    def feed(self, time_s: float, force_n: float, displacement_m: float | None = None) -> Observation:
        """Takes the readings of a tick and says what they mean, in microseconds.

        Parameters
        ----------
        time_s : float
            When, s, on any clock that rises.
        force_n : float
            Force, N; above 0 as the jaw presses.
        displacement_m : float, optional
            Displacement of the jaw, m, growing as it closes; None where there is no reading.

        Returns
        -------
        Observation

        Raises
        ------
        RecordError
            A reading that is not finite, a clock that stands or goes back; the observer stays as it was.
        ModelError
            A displacement that the body of the material cannot take; the observer stays as it was.
        """
        ...
    def feed_many(self, time_s: ArrayLike, force_n: ArrayLike, displacement_m: ArrayLike | None = None) -> Table:
        """Takes the readings of many ticks, one after the other; all of them, or none if one cannot be taken.

        Parameters
        ----------
        time_s, force_n : array_like, shape (N,)
            As for `feed`.
        displacement_m : array_like, shape (N,), optional
            As for `feed`.

        Returns
        -------
        Table
            A row a tick, a column for each attribute of `Observation`: arrays of numbers, NaN where one is not known, and lists of words.

        Raises
        ------
        RecordError, ModelError
            As for `feed`, with the index of the tick; columns of different lengths. The observer stays as it was.
        """
        ...
    material: Final[Material | None]
    """The calibrated body, if one was given."""
    slip_force_n: Final[float | None]
    """Force at and below which what is held slips, N, if one was given."""
    warn_before_s: Final[float]
    """How long before slip to warn, s."""
    confidence: Final[float]
    """Coverage of the intervals."""

@final
class Prediction(_Series):
    """What a calibrated body does over time, with two intervals of the force: of its mean (what the calibration leaves open), and of one
    reading (noise besides). Arrays of one length, and a table for polars, pandas and pyarrow; a figure in a notebook.

    Made by `Material.predict`.
    """
    time_s: Final[_Doubles]
    """Time, s."""
    displacement_m: Final[_Doubles]
    """Displacement of the jaw, m."""
    displacement_low_m: Final[_Doubles]
    """Lower end of the interval of the displacement, m: the displacement itself where that is requested."""
    displacement_high_m: Final[_Doubles]
    """Its upper end, m."""
    force_n: Final[_Doubles]
    """Contact force with the best parameters, N."""
    force_low_n: Final[_Doubles]
    """Lower end of the interval of the mean force, N: what the parameters leave open, and what lies beyond the test; NaN where the
    calibration left a parameter open.
    """
    force_high_n: Final[_Doubles]
    """Its upper end, N."""
    reading_low_n: Final[_Doubles]
    """Lower end of the interval of one reading of the force, N: parameters and noise."""
    reading_high_n: Final[_Doubles]
    """Its upper end, N."""
    force_standard_error_n: Final[_Doubles]
    """Standard error of the mean force by what the calibration leaves open and by what lies beyond the test, N; NaN where it is not known."""
    noise_n: Final[float]
    """Standard deviation of the noise of one reading, N."""
    confidence: Final[float]
    """Coverage of the intervals."""
    extrapolations: Final[list[str]]
    """What was requested beyond the test, a sentence each."""
    trajectory: Final[Trajectory]
    """The course with the best parameters, with strains and contacts lost and regained."""
    def to_dict(self) -> dict[str, Any]:
        """The columns of this result as lists of plain objects, by name."""
        ...
    def plot(self, ax: Axes | None = None, **line: Any) -> Axes:
        """Draw the force over time with the intervals of its mean and of one reading.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        line
            Options of ``Axes.plot`` for the force.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def to_csv(self, *, csv_locale: str | None = None) -> str:
        """All series as the CSV that ``palpate predict`` prints, for readers of this language as in `Analysis.report`."""
        ...
    def _repr_html_(self) -> str: ...

@final
class Estimate(_Value):
    """A parameter that was found or given."""
    value: Final[float]
    """The best value."""
    standard_error: Final[float | None]
    """Standard error for residuals that correlate as they do; None for a parameter that was given, or that the data leave open."""
    white_standard_error: Final[float | None]
    """Standard error as if the residuals were white noise: what most other software states."""
    interval: Final[tuple[float, float] | None]
    """Confidence interval for residuals that correlate as they do; an end that the data leave open is inf, or 0 of a parameter above 0."""
    unit: Final[str]
    """Unit in words: "signal", "s", "1/s", "signal/s", "1", "signal^(1-n)/s", "signal/s^alpha"; "m", "N" or "Pa" of a material."""
    def __float__(self) -> float: ...
    def __format__(self, format: str, /) -> str: ...

@final
class Fit(_Series):
    """A law fitted to a hold: estimates with errors and intervals, covariance, why it ended.

    Examples
    --------
    >>> import numpy as np, palpate
    >>> t = np.linspace(0.0, 40.0, 400)
    >>> fit = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8), law="standard-linear-solid")
    >>> fit.estimates["time_constant_s"].unit, fit.is_good, round(float(fit.predict([80.0])[0]), 4)
    ('s', True, 1.0001)
    """
    time_s: Final[_Doubles]
    """Times of the samples on their own clock, s."""
    signal: Final[_Doubles]
    """The samples."""
    best_fit: Final[_Doubles]
    """The fitted curve at those times."""
    residual: Final[_Doubles]
    """Signal less fitted curve."""
    weights: Final[_Doubles | None]
    """1/σ of every sample as it was given; None where all count alike."""
    aic: Final[float]
    """Akaike's information criterion, N ln(RSS/N) + 2p; only differences between laws on the same samples mean anything."""
    bic: Final[float]
    """Schwarz's, N ln(RSS/N) + p ln N."""
    law: Final[str]
    """Name of the law, such as "latency" or "prony:2"."""
    estimates: Final[dict[str, Estimate]]
    """Every parameter of the law by its name."""
    parameters: Final[dict[str, float]]
    """The parameters of the law by name, those that were held included: what its function in `palpate.laws` takes."""
    searched: Final[list[str]]
    """What was searched, in the order of `covariance`, with its scale: "equilibrium", "ln relative_rate_per_s", "-ln time_constant_s"."""
    covariance: Final[_Doubles | None]
    """Covariance of `searched` for residuals that correlate as they do; None where the data leave a parameter open."""
    white_covariance: Final[_Doubles | None]
    """The same as if the residuals were white noise: what most other software states."""
    correlation: Final[_Doubles | None]
    """Correlations of the searched parameters."""
    residual_square: Final[float]
    """Sum of squared residuals, weighted as the samples were."""
    rmse: Final[float]
    """Root mean square residual, in the unit of the signal."""
    residual_correlation: Final[float]
    """Correlation of neighbouring residuals."""
    noise: Final[str]
    """The noise that the residuals show: "white", "AR(1)", "white and AR(1)", "1/f^1.0" and so on, with ", uneven" where its size
    follows the signal or time.
    """
    effective_samples: Final[float]
    """Samples that count as independent under that noise."""
    noise_p_value: Final[float | None]
    """Probability that this noise leaves such residuals (Ljung and Box, 20 lags); None for fewer than 100 samples and for uneven times."""
    interval_method: Final[str]
    """Method of the intervals: "curvature", "profile" or "bootstrap"."""
    samples: Final[int]
    """Samples fitted."""
    start_s: Final[float]
    """Time of the first sample on the clock of the samples, s."""
    duration_s: Final[float]
    """Time from the first to the last sample, s."""
    termination: Final[str]
    """Why the fit ended: "converged", or what kept it from that."""
    is_good: Final[bool]
    """Whether it ended at an optimum inside the range that was searched."""
    @overload
    def predict(  # pyright: ignore[reportOverlappingOverload]
        self, time_s: _Time, *, interval: None = None, of: Literal["curve", "sample"] = "curve"
    ) -> float:
        """The signal at times of the record; with `interval`, also its confidence band.

        Parameters
        ----------
        time_s : float or array_like, shape (N,), optional
            Time on the clock of the samples that were fitted, s, or a duration on it; dates where the samples had dates, with a
            time zone where those had one. Before the first sample the signal is that at the start, at inf it is the limit of the law,
            at NaN it is NaN. Without any, the times of the samples.
        elapsed_s : float or array_like, shape (N,), optional
            Instead of `time_s`: time since the first sample, s.
        interval : float, optional
            Coverage of the band, between 0 and 1.
        of : str
            Band of the "curve", or of a "sample" with the noise of the fitted ones: with weights that of those before and after it,
            linear in between.
            Under a robust loss too the noise of a "sample" is that of all measured ones, outliers included.

        Returns
        -------
        float or ndarray, shape (N,), or three of them
            The curve; with `interval` the curve, the lower and the upper end of the band.

        Raises
        ------
        OptionError
            A coverage outside 0 to 1, another word, both of `time_s` and `elapsed_s`; dates where the samples had none, or with a time zone where
            those had none, and the other way; an infinite time of a law without a limit.
        """
        ...
    @overload
    def predict(  # pyright: ignore[reportOverlappingOverload]
        self, *, elapsed_s: float | datetime.timedelta, interval: None = None, of: Literal["curve", "sample"] = "curve"
    ) -> float: ...
    @overload
    def predict(  # pyright: ignore[reportOverlappingOverload]
        self, time_s: _Time, *, interval: float, of: Literal["curve", "sample"] = "curve"
    ) -> tuple[float, float, float]: ...
    @overload
    def predict(  # pyright: ignore[reportOverlappingOverload]
        self, *, elapsed_s: float | datetime.timedelta, interval: float, of: Literal["curve", "sample"] = "curve"
    ) -> tuple[float, float, float]: ...
    @overload
    def predict(
        self,
        time_s: ArrayLike | Sequence[_Time] | None = None,
        *,
        elapsed_s: ArrayLike | None = None,
        interval: None = None,
        of: Literal["curve", "sample"] = "curve",
    ) -> _Doubles: ...
    @overload
    def predict(
        self,
        time_s: ArrayLike | Sequence[_Time] | None = None,
        *,
        elapsed_s: ArrayLike | None = None,
        interval: float,
        of: Literal["curve", "sample"] = "curve",
    ) -> tuple[_Doubles, _Doubles, _Doubles]: ...
    bounds: Final[dict[str, tuple[float | None, float | None]]]
    """Bounds of parameters as they were given, by name: lower and upper end, None where it is open."""
    fixed: Final[dict[str, float]]
    """Values that parameters were held at with `fixed`, by name."""
    _first_date: Final[tuple[int, bool] | None]
    _noise_remark: Final[tuple[str, str] | None]
    def report(self) -> str:
        """The fit as text, in the manner of lmfit."""
        ...
    def to_dict(self) -> dict[str, Any]:
        """Everything about the fit but its samples as plain objects: also ``bounds``, both ends by name, and ``fixed``, values by name."""
        ...
    @overload
    def eval(self, time_s: _Time, **parameters: _Parameter) -> float:  # pyright: ignore[reportOverlappingOverload]
        """The law at times of the record, with some of the parameters replaced, in relaxation or creep as it was fitted.

        Parameters
        ----------
        time_s : float or array_like, shape (N,), optional
            Time on the clock of the samples, s, a duration or, where the samples had dates, a date, as for `predict`; the times of the
            samples if left out.
        parameters
            Values in place of those that were found: ``fit.eval(exponent=3)``. Quantities of pint and durations are converted; parameters in the
            unit of the signal, which a fit does not state, are numbers alone.

        Returns
        -------
        float or ndarray, shape (N,)

        Raises
        ------
        OptionError
            A parameter that the law has not, or a value that is no number; replaced parameters of a law that is no function of
            `palpate.laws`.
        """
        ...
    @overload
    def eval(self, time_s: ArrayLike | Sequence[_Time] | None = None, **parameters: _Parameter) -> _Doubles: ...
    def sample(self, n: int = 1000, *, seed: int | None = None) -> dict[str, _Doubles]:
        """Draw sets of parameters from the distribution that the fit leaves for them.

        The distribution of the intervals of curvature: one of the models of the noise, each by its probability, and from it Student's t of
        N - p degrees of freedom with its covariance, in the scales of `searched`: rates and times, whose logarithms were searched, are
        log-t. The covariance of many sets is the mean over the models times (N - p)/(N - p - 2). Where `interval_method` is
        another one than "curvature", the true distribution has other tails, which are those of the intervals. Where the fit had `bounds`,
        sets outside of them are drawn again.

        Parameters
        ----------
        n : int
            How many sets.
        seed : int, optional
            Of the random generator; the same seed gives the same sets.

        Returns
        -------
        dict of ndarray, shape (n,)
            By the names of `parameters`; one that was held has its value throughout.

        Raises
        ------
        FitError
            The data leave a parameter open: there is no covariance. Bounds so narrow that hardly a set lies inside of them.
        OptionError
            Fewer than one set; a seed that is no whole number, or below 0.

        Examples
        --------
        >>> import numpy as np, palpate
        >>> t = np.linspace(0.0, 40.0, 400)
        >>> noise = np.random.default_rng(1).normal(0.0, 0.01, 400)
        >>> fit = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8) + noise, law="standard-linear-solid")
        >>> draws = fit.sample(20_000, seed=1)
        >>> low, high = fit.estimates["time_constant_s"].interval
        >>> within = (low < draws["time_constant_s"]) & (draws["time_constant_s"] < high)
        >>> round(float(within.mean()), 2)
        0.95
        """
        ...
    def to_arviz(self, draws: int = 1000, *, chains: int = 4, seed: int | None = None) -> xarray.DataTree:
        """Draws of `sample` as an ArviZ ``DataTree``; without arviz_base an ImportError.

        Parameters
        ----------
        draws, chains : int
            How many sets of parameters a chain, and how many chains; all are independent.
        seed : int, optional
            As for `sample`.

        Returns
        -------
        xarray.DataTree
            ``posterior``, with the parameters that were searched, and the samples of the fit as ``observed_data`` and
            ``constant_data``.

        Raises
        ------
        FitError, OptionError
            As for `sample`.
        """
        ...
    def plot(self, ax: Axes | None = None, *, interval: float | None = None, **line: Any) -> Axes:
        """Draw the samples and the fitted curve over time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        interval : float, optional
            Coverage of a band of the curve, between 0 and 1; none if left out.
        line
            Options of ``Axes.plot`` for the curve.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        OptionError
            A coverage outside 0 to 1.
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...

@final
class Comparison(_Summed):
    """Laws compared on one hold: each was fitted to its first part and held against the rest."""
    time_s: Final[_Doubles]
    """Times of the samples on their own clock, s."""
    signal: Final[_Doubles]
    """The samples."""
    def plot(self, ax: Axes | None = None, **bars: Any) -> Axes:
        """Draw how well each law predicts what follows: the root mean square error of its forecasts over the change in the hold.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        bars
            Options of ``Axes.barh``.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...
    law: Final[str | None]
    """The law to use: that with the lowest BIC among those not distinguishable from the best; None if none could be fitted."""
    certainty: Final[str | None]
    """How sure that is: "clear", "likely" or "open"."""
    probability: Final[float | None]
    """Probability that no law that was compared predicts what follows better by more than a fifth."""
    sentence: Final[str | None]
    """All that in one sentence."""
    reservation: Final[str | None]
    """What stands against every law, so that the one named is the best approximation and no recommendation: "refuted" by the hold
    itself, "unpredictive", or "drive_changes" where what is held goes on; None where nothing does.
    """
    forecast: Final[Table | None]
    """What the hold will show next, from all laws together: ``elapsed_s``, ``value`` and the band ``low`` to ``high`` that covers a
    sample in 95 of 100 holds. None where the hold is too short for that.
    """
    laws: Final[Table]
    """The laws, best first, a row each."""
    def to_dict(self) -> dict[str, Any]:
        """Everything but the samples as plain objects."""
        ...

@final
class RecordComparison(_Summed, _Reported):
    """Laws compared on all holds of a record.

    Made by `Record.compare`. ``print(comparison)`` shows what ``palpate compare`` does.
    """
    law: Final[str | None]
    """The law to use for the record as a whole, as ``law=`` takes it; None where none could be fitted."""
    sentence: Final[str | None]
    """Which law to use, in a sentence; None where none could be fitted."""
    holds: Final[Table]
    """The holds on which laws could be compared, a row each: ``hold``, ``fit_start_s``, the recommended ``law``, ``certainty``, ``probability``,
    ``reservation`` and ``holdout_error``, the error of its forecasts over the change in the hold.
    """
    def plot(self, ax: Axes | None = None, **bars: Any) -> Axes:
        """Draw how well each law predicts what follows: the median over the holds of the error of its forecasts as a bar, that of each as a point.

        Errors are root mean squares over the change in the hold.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        bars
            Options of ``Axes.barh``.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...
    laws: Final[Table]
    """The laws on every hold, best first, a row each: ``hold``, ``law``, ``effective_parameters``, ``rmse``, ``delta_aicc``, ``delta_bic``,
    ``forward_score``, ``termination``, ``error``.
    """

@final
class Trajectory(_Series):
    """A simulated contact over time, in SI, compression positive: arrays of one length, and a table for polars, pandas and pyarrow."""
    time_s: Final[_Doubles]
    """Time, s."""
    displacement_m: Final[_Doubles]
    """Displacement of the jaw, m."""
    contact_displacement_m: Final[_Doubles]
    """Displacement of the surface of the body at one contact, m."""
    force_n: Final[_Doubles]
    """Contact force, N."""
    strain: Final[_Doubles]
    """Strain of the contact layer."""
    equilibrium_strain: Final[_Doubles]
    """Strain that the contact layer tends to."""
    excess_strain: Final[_Doubles]
    """Strain less the equilibrium strain."""
    strain_rate_per_s: Final[_Doubles]
    """Strain rate of the contact layer, 1/s."""
    in_contact: Final[NDArray[np.bool_]]
    """Whether the jaw touches the body."""
    events: Final[list[tuple[str, float, float]]]
    """Contacts lost and regained: ("lost" or "regained", time in s, displacement of the surface in m)."""
    def to_dict(self) -> dict[str, Any]:
        """The columns of this result as lists of plain objects, by name."""
        ...
    def plot(self, ax: Axes | None = None, *, x: str = "time_s", y: str = "force_n", **line: Any) -> Axes:
        """Draw one series against another.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; those of a new figure if left out.
        x, y : str
            Names of the series: ``x="displacement_m"`` draws the hysteresis loop of a cycle.
        line
            Options of ``Axes.plot``.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        OptionError
            A series that there is not.
        ImportError
            Without matplotlib.
        """
        ...
    def _repr_html_(self) -> str: ...
    def to_csv(self, *, csv_locale: str | None = None) -> str:
        """All series as the CSV that ``palpate simulate`` prints, for readers of this language as in `Analysis.report`."""
        ...

@final
class ContactState(_Moved):
    """A contact that a controller moves one step at a time, in closed form and in constant time.

    Motion and drift follow each other within a step (Strang's splitting): the error falls with the square of ``dt_s``. A ball of 35 mm
    that is squeezed by 5 mm at 50 mm/s ends with a force that is 1.2 % too large in steps of 10 ms, 0.013 % in steps of 1 ms, and 63 %
    in one step of 100 ms; `simulate` integrates such motions to a tolerance.

    Parameters
    ----------
    model : path or mapping
        A protocol's tables ``specimen``, ``law`` and ``contact``; steps are left aside.

    Examples
    --------
    >>> import palpate
    >>> state = palpate.ContactState({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ... })
    >>> forces = [state.step(1e-3, 5e-5 * (k + 1)) for k in range(100)]
    >>> round(forces[-1], 3)
    3.886
    """
    def __new__(cls, model: _Described) -> Self: ...
    def step(self, dt_s: float, displacement_m: float) -> float:
        """Moves the jaw to a displacement within a time step.

        Parameters
        ----------
        dt_s : float
            Length of the step, s; 0 or more.
        displacement_m : float
            Where the jaw stands at its end, m; it goes there at constant speed.

        Returns
        -------
        float
            Force at its end, N.

        Raises
        ------
        ModelError
            A step below 0, a displacement beyond the body; the state stays as it was.
        """
        ...
    def step_force(self, dt_s: float, force_n: float) -> float:
        """Applies a force within a time step.

        Parameters
        ----------
        dt_s : float
            Length of the step, s; 0 or more.
        force_n : float
            The force over the step, N.

        Returns
        -------
        float
            Displacement of the jaw at its end, m.

        Raises
        ------
        ModelError
            A step below 0, a force that the body cannot bear; the state stays as it was.
        """
        ...
    force_n: Final[float]
    """Force now, N."""
    stiffness_n_per_m: Final[float]
    """Tangent stiffness dF/dd against the displacement of the jaw now, N/m."""
    excess_strain: Final[float]
    """Excess strain of the contact layer, which drives the law."""
    surface_m: Final[float]
    """Displacement of the surface of the body at one contact, m."""
    is_touching: Final[bool]
    """Whether the jaw touches the body."""

@final
class ContactStates(_Moved):
    """Contacts that are moved side by side, such as those of many grippers, or of one with many values of its parameters.

    Thousands of contacts are stepped on all cores, to the same bits on any number of them. Two threads cannot use one object at once,
    neither where both step nor where one reads a property meanwhile: the second gets a ``RuntimeError``. One that shows forces takes them from ``out``.

    Parameters
    ----------
    model : path or mapping, or a list of them
        One model for ``count`` contacts, or one each, as for `ContactState`; all by the latency law with one rate coefficient, or all by
        linear laws.
        A jaw that is bonded to its body (``separation = false``, as a calibrated block has it unless its test states otherwise) pulls below 0 m from
        any distance: jaws that only press need ``separation = true``.
    count : int, optional
        How many, of one model; none beside a list, or where the arrays below say it.
    modulus_pa, radius_m, exponent, rate_coefficient_per_s, layer_thickness_m : float or array_like, shape (N,), optional
        Values for each contact in place of those of the one model: Young's modulus, Pa; radius of a ball or a pad, m, with the number
        of layers as it was; exponent, rate coefficient (1/s) and thickness of a layer (m) of the latency law.

    Raises
    ------
    OptionError
        Descriptions that are none; another number of values than contacts; values beside a list.
    ModelError
        Laws of both kinds, a rate coefficient that varies, a parameter that the body or its law does not have, a value out of range.

    Examples
    --------
    >>> import numpy as np, palpate
    >>> model = {
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ... }
    >>> contacts = palpate.ContactStates(model, 3)
    >>> for k in range(100):
    ...     forces = contacts.step(1e-3, (k + 1) * np.array([3e-5, 4e-5, 5e-5]))
    >>> forces.round(2)
    array([1.94, 2.86, 3.89])

    Twice the modulus is twice the force; a step of NaN is masked, and a reset makes a contact untouched.

    >>> contacts = palpate.ContactStates(model, modulus_pa=[28e3, 56e3, 28e3])
    >>> forces = np.empty(3)
    >>> contacts.step(0.1, [5e-3, 5e-3, np.nan], out=forces, substeps=100, errors="mask").round(2)
    array([3.89, 7.77, 0.  ])
    >>> contacts.failed
    array([False, False,  True])
    >>> contacts.reset(forces > 5)
    >>> contacts.state[:, 0]
    array([0.0025, 0.    , 0.    ])
    """
    def __new__(
        cls,
        model: _Described | Sequence[_Described],
        count: int | None = None,
        *,
        modulus_pa: float | ArrayLike | None = None,
        radius_m: float | ArrayLike | None = None,
        exponent: float | ArrayLike | None = None,
        rate_coefficient_per_s: float | ArrayLike | None = None,
        layer_thickness_m: float | ArrayLike | None = None,
    ) -> Self: ...
    def step(
        self,
        dt_s: float | ArrayLike,
        displacement_m: float | ArrayLike,
        out: _Doubles | None = None,
        substeps: int = 1,
        errors: Literal["raise", "mask"] = "raise",
    ) -> _Doubles:
        """Moves every jaw to its displacement within a time step.

        With ``errors="raise"`` all contacts are stepped, or none if one cannot be. With ``errors="mask"`` such a contact keeps its state,
        `failed` marks it, and its force is that before the step, 0 where its state is not finite or its jaw beyond the body.

        Parameters
        ----------
        dt_s, displacement_m : float or array_like, shape (N,)
            As for `ContactState.step`; one number stands for all contacts. Arrays of doubles are read in place: another thread that changes
            them meanwhile changes the step.
        out : ndarray, shape (N,), optional
            Doubles one behind the other, where the forces go; a new array if left out, which takes longer of many contacts.
        substeps : int
            Equal parts that the step is taken in, along a straight line.
        errors : str
            "raise" or "mask".

        Returns
        -------
        ndarray, shape (N,)
            Forces, N: ``out`` if it was given.

        Raises
        ------
        ModelError
            A step that one contact cannot make, with ``errors="raise"``; the message says which.
        OptionError
            Arrays of another length, an ``out`` that cannot be written to.
        """
        ...
    def step_force(
        self,
        dt_s: float | ArrayLike,
        force_n: float | ArrayLike,
        out: _Doubles | None = None,
        substeps: int = 1,
        errors: Literal["raise", "mask"] = "raise",
    ) -> _Doubles:
        """Applies a force to every contact within a time step, as `step` does a displacement.

        Parameters
        ----------
        dt_s, force_n : float or array_like, shape (N,)
            As for `ContactState.step_force`; of a linear law the jaw goes at constant speed to where the force is reached.
        out, substeps, errors
            As for `step`.

        Returns
        -------
        ndarray, shape (N,)
            Displacements of the jaws, m; those before the step where it failed.

        Raises
        ------
        ModelError, OptionError
            As for `step`.
        """
        ...
    def reset(
        self,
        mask: ArrayLike | None = None,
        *,
        modulus_pa: float | ArrayLike | None = None,
        radius_m: float | ArrayLike | None = None,
        exponent: float | ArrayLike | None = None,
        rate_coefficient_per_s: float | ArrayLike | None = None,
        layer_thickness_m: float | ArrayLike | None = None,
    ) -> None:
        """Makes contacts untouched, with other values of parameters if those are given.

        Parameters
        ----------
        mask : array_like of bool, shape (N,), optional
            Which ones; all if left out.
        modulus_pa, radius_m, exponent, rate_coefficient_per_s, layer_thickness_m : float or array_like, shape (N,), optional
            New values of these contacts, as for the constructor; those at the places of others are left aside.

        Raises
        ------
        OptionError
            A mask of another length, or of something else; another number of values.
        ModelError
            A parameter that the body or its law does not have, a value out of range; nothing is changed.
        """
        ...
    @property
    def state(self) -> _Doubles:
        """The states, a row each, in place: what is written there is the state. Columns are one contact's share of the displacement of the
        jaw, m, and, of the latency law, the displacement of the node behind the contact layer, m; of a linear law the excess of every
        term, by rising rate, in strain, or in N where its memory is of force. Zeros are an untouched contact.

        Numbers written in place are not checked: until the next step ``force_n`` and ``stiffness_n_per_m`` are NaN where they are not finite or the jaw
        is beyond the body. A step fails for a contact whose numbers are not finite or a million depths
        away, and goes on from any others. An assigned array is checked: finite numbers and forces, no jaw beyond its body.
        """
        ...
    @state.setter
    def state(self, state: ArrayLike, /) -> None: ...
    force_n: Final[_Doubles]
    """Forces now, N; NaN where a state written in place has its jaw beyond the body."""
    stiffness_n_per_m: Final[_Doubles]
    """Tangent stiffnesses dF/dd against the displacements of the jaws, N/m: the slopes of a step within no time. 0 while a jaw is off."""
    surface_m: Final[_Doubles]
    """Displacements of the surfaces at one contact each, m."""
    is_touching: Final[NDArray[np.bool_]]
    """Whether the jaws touch their bodies."""
    failed: Final[NDArray[np.bool_]]
    """Which contacts kept their state in the last step; none in one with ``errors="raise"``."""
    def __len__(self) -> int: ...

def read(
    path: _File,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
    then: _Path | None = None,
) -> Record:
    """Read the record in a file of any format that is known, found out by its content.

    Parameters
    ----------
    path
        Delimited text, workbook, Parquet, Arrow, AFM force curve, robot's log and more; packed by gzip or zip or not. A path; or the bytes
        of a file; or an object with them: an open file, ``io.BytesIO``, a member of a zip archive, an upload, an ``OpenFile`` of fsspec,
        which is read from where it stands and not closed.
    name
        What results and messages call bytes; else the name that the object has.
    test
        Test description that says what the file cannot know: path of a TOML file, or a mapping with its tables.
    part
        The one test of a file that holds several: its name (a sheet, a curve, a ``test_id``), or its number from 1.
    columns
        Columns with their units, before what ``test`` says of them: "force=Kraft:N,displacement=Weg:mm,time=Zeit:s", or a mapping
        ``{"force": "Kraft:N", ...}``. A minus before a unit turns the sign; "deflection=2:nm:0.04 N/m" names the deflection and
        the spring constant of a cantilever, whose product is the force.
    then
        A second file in which the test goes on, such as the hold after a ramp. A clock that restarts there continues one sample
        interval after the first file; times that already follow stay as they are.

    Returns
    -------
    Record
        Time, force and displacement in SI, loading positive.

    Raises
    ------
    RecordError
        The file holds no record, or it is not clear which column holds what: the message ends in the lines of a
        description that would clear it up.
    OptionError
        The description is wrong.
    OSError
        The operating system does not hand the file out.
    """
    ...
def read_all(
    path: _File, *, name: str | None = None, test: _Described | None = None, columns: _Columns | None = None
) -> list[Record]:
    """Read all tests in a file: the sheets of a workbook, the curves of a map, the ``test_id`` of a table, the files of a zip archive.

    Parameters
    ----------
    path, name, test, columns
        As for `read`.

    Returns
    -------
    list of Record
        In the order of the file, each with the name of its test in ``title``.

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`, for the first test that makes no record.
    """
    ...
def _card(
    material: Material,
    engine: str,
    *,
    depth_m: float | None,
    speed_m_per_s: float | None,
    slowest_m_per_s: float | None,
    hold_s: float,
    mass_kg: float | None,
    friction: float | None,
    poisson_ratio: float | None,
    terms_per_decade: float,
) -> str: ...
def fit_hold(
    time_s: ArrayLike, signal: ArrayLike, weights: ArrayLike | None, keywords: Mapping[str, Any], first_date: tuple[int, bool] | None
) -> Fit: ...
def fit_many(
    time_s: Any,
    signal: Any,
    weights: Any,
    keywords: Mapping[str, Any],
    progress: Callable[[int], None] | None,
) -> Table: ...
def latency(
    elapsed_s: ArrayLike, equilibrium: float, amplitude: float, relative_rate_per_s: float, exponent: float
) -> _Doubles:
    """y_e + Δ φ(t; λ, n) with φ = (1 + (n − 1) λ t)^(−1/(n − 1))."""
    ...
def law_names() -> list[str]:
    """Names of laws as `law=` takes them; N and K stand for parameters."""
    ...
def command(arguments: Sequence[str]) -> int:
    """Runs the command with these arguments, the first of them its name, and returns the exit code; signals end the process."""
    ...
def calibrate(
    records: Sequence[Record],
    *,
    shared: str | Sequence[str] | None = None,
    law: LawName = "latency",
    test: _Described | None = None,
    equilibrium: str | None = None,
    poisson_ratio: float | None = None,
    rate: str = "constant",
    confidence: float | None = None,
) -> SeveralCalibrations:
    """Calibrate several records of one body or of one batch together.

    Parameters
    ----------
    records : sequence of Record
        Two or more, each with time, displacement and force.
    shared
        "none", "all", or the names of the parameters that have one value for all records, with their unit or without, such as
        ``["exponent", "rate_coefficient"]``. The others are each record's own.
    law, equilibrium, poisson_ratio, rate, confidence
        As for `Record.calibrate`; a table of equilibrium forces is for a single record.
    test
        Description of all records; if left out, each is described as it was read.

    Returns
    -------
    SeveralCalibrations
        Parameters, spreads, the material of each record, and that of another specimen of the batch.

    Raises
    ------
    OptionError
        Fewer than two records, a law or a shared name that is none.
    RecordError
        One record twice, or one without displacement.
    FitError
        Records that do not determine the parameters; the message names record and parameters.
    """
    ...
def compare(
    time_s: ArrayLike,
    signal: ArrayLike,
    *,
    laws: Sequence[LawName] | None = None,
    weights: ArrayLike | None = None,
    quantity: Quantity = "force",
    cuts: Sequence[float] | None = None,
) -> Comparison:
    """Fit laws to the first part of a hold, hold each against the rest, say which to use, and forecast what follows.

    Parameters
    ----------
    time_s, signal, weights : array_like, shape (N,)
        As for `fit_hold`.
    laws
        Names of laws; if left out, all that suit.
    quantity
        What the signal is: "force" or "strain" in a relaxation, "displacement" in a creep.
    cuts
        Where to cut, as shares of the duration; (1/4, 1/3, 1/2) if left out.

    Returns
    -------
    Comparison
        The law to use, how sure that is, what each other one costs, and a table of all.

    Raises
    ------
    FitError
        A hold that no law can be fitted to.
    OptionError
        A law or a quantity that is not known.
    """
    ...
def forecast(
    time_s: ArrayLike,
    signal: ArrayLike,
    at_s: _Time | ArrayLike | Sequence[_Time],
    *,
    laws: Sequence[LawName] | None = None,
    weights: ArrayLike | None = None,
    quantity: Quantity = "force",
    others: Sequence[tuple[ArrayLike, ArrayLike]] | None = None,
    confidence: float = 0.95,
) -> Table:
    """What a hold will show next, from all laws together: each counts as much as it helps to predict the hold so far.

    Parameters
    ----------
    time_s, signal, weights : array_like, shape (N,)
        As for `fit_hold`.
    at_s : float or array_like
        Times to predict, on the clock of ``time_s``, none before its last: the hold itself is what was fitted. Durations are times on that
        clock too, and so are dates where ``time_s`` has dates, with a time zone where those have one.
    laws
        Names of laws; if left out, all that suit.
    quantity
        As for `compare`.
    others : list of (time_s, signal)
        Other holds of the same body, the nearest first. Laws are weighed by what they have predicted of them too: of each that is longer by
        half, what its first part of the same duration says of the rest counts most. Where two or more are, their courses, scaled to this
        hold, are combined with the laws, as far as half of them reach. On measured records of several holds the median of the error over
        that of the best law was 1.06 with others and 1.9 without.
    confidence
        Of the band. One of 0.95 covered 95 % of what followed in 19 of 20 of the measured holds on which its width was set, up to
        three times their duration.

    Returns
    -------
    Table
        ``at_s``, ``value``, and the band for a sample, ``low`` to ``high``, in the unit of the signal.

    Raises
    ------
    FitError
        A hold that no law can be fitted to, or that is too short to try a forecast on it.
    OptionError
        A law, a quantity, a time or a confidence that makes no sense.

    Examples
    --------
    >>> import numpy as np, palpate
    >>> t = np.linspace(0.0, 10.0, 200)
    >>> force = 1 + 2 / (1 + 0.5 * t)
    >>> table = palpate.forecast(t, force, at_s=[20.0, 30.0])
    >>> [round(float(value), 2) for value in table["value"]]
    [1.18, 1.12]
    >>> before = [(t, 2 + 4 / (1 + 0.5 * t)), (t, 3 + 5 / (1 + 0.5 * t))]
    >>> table = palpate.forecast(t[:20], force[:20], at_s=[10.0], others=before)
    >>> round(float(table["value"][0]), 2), round(float(force[-1]), 2)
    (1.33, 1.33)
    """
    ...
def _unit_factor(unit: str, si: str) -> tuple[float | None, str]: ...
def mapping_text(table: Mapping[str, Any]) -> str:
    """A mapping with the tables of a description as its text in TOML."""
    ...
def energy(
    path: _Path | None,
    text: str | None,
    driver: tuple[_Doubles, _Doubles | None, _Doubles] | None,
    drive_by: str,
    by: str,
) -> Table:
    """Work of the jaw over time, by step or by cycle."""
    ...
def simulate(
    path: _Path | None, text: str | None, driver: tuple[_Doubles, _Doubles | None, _Doubles] | None, drive_by: str
) -> Trajectory: ...
def simulate_many(
    path: _Path | None,
    text: str | None,
    numbers: Sequence[tuple[str, ArrayLike]],
    times_s: ArrayLike | None,
    progress: Callable[[int], None] | None,
) -> Table:
    """Simulates a protocol in a file or in a text for many values of its numbers, in SI; a row a run."""
    ...
def inspect(
    path: _File,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
) -> str:
    """What is in a file of records: columns, sampling, phases; the text of ``palpate inspect``.

    Parameters
    ----------
    path, name, test, part, columns
        As for `read`.

    Returns
    -------
    str

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`.
    """
    ...
def convert(
    path: _File,
    out: _Path,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
    csv_locale: str | None = None,
) -> Path:
    """Write the record in a file of any format as a plain table in SI, with where it comes from: ``palpate convert``.

    Parameters
    ----------
    path, name, test, part, columns
        As for `read`.
    out
        A file ending in .csv, .xlsx, .parquet or .json; it appears whole or not at all.
    csv_locale
        Language of the readers of a CSV, as for `Analysis.report`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`; also a name that says no format.
    """
    ...
def batch(
    paths: Iterable[_File] | Mapping[str, _File],
    out: _Path,
    *,
    test: _Described | None = None,
    columns: _Columns | None = None,
    laws: Sequence[LawName] | None = None,
    intervals: Intervals | None = None,
    fit_until_s: float | None = None,
    hold_start: str | None = None,
    map: Sequence[str] | None = None,
    csv_locale: str | None = None,
    restart: bool = False,
    shard: str | None = None,
    threads: int | None = None,
) -> BatchResult:
    """Analyse many records into one table, a row per hold and law: ``palpate batch``.

    What is done is kept beside the table: a batch that was ended goes on where it stood.

    Parameters
    ----------
    paths
        Files, folders with files, or patterns; also bytes and objects that are read, as for `read`, or a mapping from names to these.
        A zip archive of several files gives the tests in all of them.
    out
        A table ending in .parquet or .csv.
    test
        Test description of all of them.
    columns
        As for `read`.
    laws
        Laws to fit besides the latency law.
    intervals
        Method of the intervals of fits: "automatic" (if left out), "curvature", "profile" or "bootstrap".
    fit_until_s
        Fit only this long from the start of each hold, s.
    hold_start
        Where the fit of a hold starts: "peak", "settled" or "peak + 0.5 s"; that of the description, or "peak", if left out.
    map
        Quantities to draw as maps over the positions of the curves, by the names that `BatchResult.map` takes; each goes into a file
        beside the table, or into FILE (.svg, .png or .pdf) of "NAME=FILE".
    csv_locale
        Language of the readers of a CSV, as for `Analysis.report`.
    restart
        Whether all records are analysed again, whatever was done before.
    shard
        "3/40": analyse only the third of 40 slices of the files, equal in bytes, into the folder `out` that all slices share; `merge` makes
        one table of them.
    threads
        How many records are analysed side by side; as many as there are processors if left out. The table does not depend on it.

    Returns
    -------
    BatchResult
        The law recommended on the most holds, its parameters over them, the most frequent findings, and the tests without rows.

    Raises
    ------
    OptionError, OSError
        A description or a law that is wrong, a table that cannot be written.
    """
    ...
_Slice: TypeAlias = tuple[int, int, str, int, int, int, float, float]
_SlicedFile: TypeAlias = tuple[_Path, bytes | None] | tuple[_Path, int, Callable[[], bytes]]

def _checked(
    *,
    test: _Described | None = None,
    columns: _Columns | None = None,
    laws: Sequence[LawName] | None = None,
    intervals: Intervals | None = None,
    fit_until_s: float | None = None,
) -> None: ...
def _checked_sweep(protocol: _Described) -> None: ...
def _contact_numbers(model: _Described) -> list[float]: ...
def _forget(out: _Path, name: str) -> None: ...
def _found(paths: Sequence[_Path]) -> list[Path]: ...
def _sliced(files: Sequence[_SlicedFile], of: int) -> list[_Slice]: ...
def _run_slice(
    slice: _Slice,
    files: Sequence[_SlicedFile],
    out: _Path,
    *,
    test: _Described | None = None,
    columns: _Columns | None = None,
    laws: Sequence[LawName] | None = None,
    intervals: Intervals | None = None,
    fit_until_s: float | None = None,
    threads: int = 1,
) -> None: ...
def merge(
    folders: Sequence[_Path], out: _Path, *, map: Sequence[str] | None = None, csv_locale: str | None = None
) -> BatchResult | tuple[int, int]:
    """Make one table of the shards of `batch` or `sweep`, byte for byte that of the whole at once: ``palpate merge``.

    Parameters
    ----------
    folders
        The folders that the shards had as their ``out``.
    out
        A table ending in .parquet or .csv; of a sweep in .parquet.
    map
        Maps over the positions of the curves of a batch, as for `batch`.
    csv_locale
        Language of the readers of a CSV, as for `Analysis.report`.

    Returns
    -------
    BatchResult | tuple[int, int]
        What `batch` or `sweep` of the whole returns.

    Raises
    ------
    OptionError, OSError
        A shard that is missing, there twice, of other files, settings or another version, or damaged; a table that cannot be written.
    """
    ...
def sweep(
    protocol: _Path | Mapping[str, Any],
    out: _Path,
    *,
    figure: _Path | None = None,
    show: str | None = None,
    restart: bool = False,
    shard: str | None = None,
    threads: int | None = None,
) -> tuple[int, int]:
    """Simulate the runs of a protocol with a table ``[sweep]`` into one table: ``palpate sweep``.

    Finished parts are kept beside the table: a sweep that was ended goes on where it stood.

    Parameters
    ----------
    protocol
        Path of the protocol (TOML), or a mapping with its tables, as for `simulate`. ``"sweep"`` has values by the path of the parameter
        they replace: ``{"law.exponent": [3, 5], "specimen.radius_m": [0.03, 0.035], "law.rate_coefficient": "log 1e3..1e5 /s, 9"}``.
    out
        A table ending in .parquet.
    figure
        A figure ending in .svg, .png or .pdf.
    show
        Which result the figure shows, by the name of its column; the peak force if left out.
    restart
        Whether all runs are computed again, whatever was computed before.
    shard
        "3/40": compute only the third of 40 slices of the runs, into the folder `out` that all slices share; `merge` makes one table of them.
    threads
        How many runs are simulated side by side; as many as there are processors if left out. The table does not depend on it.

    Returns
    -------
    runs, refused : int
        How many runs the table has, and how many of them were refused.

    Raises
    ------
    OptionError, OSError
        A protocol without a sweep, a table that cannot be written.

    Examples
    --------
    >>> import palpate, tempfile
    >>> from pathlib import Path
    >>> protocol = {
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    ...     "sweep": {"law.exponent": [3, 5], "specimen.radius_m": [0.03, 0.035, 0.04]},
    ... }
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     palpate.sweep(protocol, Path(folder) / "runs.parquet")
    (6, 0)
    """
    ...
def report_all(
    analyses: Sequence[Analysis],
    folder: _Path,
    *,
    figures: Sequence[str] | None = None,
    column: str | None = None,
    csv_locale: str | None = None,
) -> os.PathLike[str]:
    """Writes the reports of several records and an index of them: ``palpate analyze A B --out``, all or none.

    The index links the reports and states mean, standard deviation and interval of each parameter between specimens.

    Parameters
    ----------
    analyses : sequence of Analysis
        One a record; each report lies in a folder named after its record.
    folder : path
        Made if it is not there.
    figures, column, csv_locale
        As for `Analysis.report`.

    Returns
    -------
    Path
        The index.

    Raises
    ------
    OptionError
        There is no analysis.
    PalpateError
        The folder cannot be written to.
    """
    ...
def reproduce(
    folder: _Path,
    *,
    figures: Sequence[str] | None = None,
    column: str | None = None,
    csv_locale: str | None = None,
    seeds: int | None = None,
    sample_rate_hz: float | None = None,
    repeatability_n: float | None = None,
    record: _File | None = None,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
) -> dict[str, Any]:
    """Judge every claim of the paper, or its conclusions on a record, into a folder: ``palpate reproduce``.

    Parameters
    ----------
    folder
        Made if it is not there.
    figures, column, csv_locale
        As for `Analysis.report`.
    seeds
        Laboratories that repeat the tests with each ball, one seed each; 32 if left out. Not with a record.
    sample_rate_hz
        Their sampling rate, Hz; 50 if left out. Not with a record.
    repeatability_n
        Error of a single reading of their force where 0.2 N is that of the zero, N; 0.02 if left out. Not with a record.
    record, name, test, part, columns
        A record of one's own, as ``path`` and the others of `read`; it is shown in the layout of the paper, with its conclusions.

    Returns
    -------
    dict
        What summary.json holds: ``claims`` with their verdicts, and more; ``palpate schema reproduction`` and ``reproduced-record`` print
        the schemas.

    Raises
    ------
    RecordError, OptionError, OSError
        As for `read`; seeds or a sampling rate out of range; a folder that cannot be written to.

    Examples
    --------
    >>> import palpate, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     study = palpate.reproduce(folder, seeds=4, sample_rate_hz=10.0)
    >>> first = study["claims"][0]
    >>> first["place"], first["verdict"], first["comparisons"][0]["paper"]
    ('Abstract', 'not_reproduced', -0.1661)
    """
    ...
def watch(
    path: _File,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
    material: _Path | None = None,
    exponent: float | None = None,
    slip_force_n: float | None = None,
    warn_before_s: float | None = None,
    every_s: float | None = None,
) -> list[dict[str, Any]]:
    """Watch a recorded log as if it came in live: the lines of ``palpate watch --format jsonl``.

    Parameters
    ----------
    path, name, test, part, columns
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
    ...
