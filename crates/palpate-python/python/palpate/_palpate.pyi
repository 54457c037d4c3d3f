"""Types of the compiled part. Checked against it by mypy's stubtest."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Final, Literal, Protocol, Self, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
    "fit_hold",
    "fit_many",
    "forecast",
    "inspect",
    "latency",
    "law_names",
    "read",
    "read_all",
    "report_all",
    "reproduce",
    "simulate",
    "simulate_many",
    "sweep",
    "watch",
]

_Doubles: TypeAlias = NDArray[np.float64]
_Path: TypeAlias = str | os.PathLike[str]

class _Readable(Protocol):
    def read(self) -> bytes | str: ...

_File: TypeAlias = _Path | bytes | bytearray | memoryview | _Readable | AbstractContextManager[_Readable]
_Described: TypeAlias = _Path | Mapping[str, Any] | Material
_Columns: TypeAlias = str | Mapping[str, str]
# Numbers are arrays, texts and truths are lists; which of them only the name of the column tells.
_Cells: TypeAlias = Any

class PalpateError(ValueError): ...
class RecordError(PalpateError): ...
class OptionError(PalpateError): ...
class ModelError(PalpateError): ...
class FitError(PalpateError): ...
class PalpateWarning(UserWarning): ...

class _Value:
    # Compared and pickled by what it says.
    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]

class _Series(_Value):
    # Arrays of one length, and a table of rows.
    def to_arrow(self) -> Table: ...
    def __iter__(self) -> Iterator[dict[str, Any]]: ...
    def __len__(self) -> int: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

class _Reported(_Value):
    # What a command prints.
    def to_dict(self) -> dict[str, Any]: ...
    def to_json(self) -> str: ...

class _Moved(_Value):
    # Changed in place.
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: dict[int, Any], /) -> Self: ...

@final
class _Piece:
    # A part of the bytes of a pickle.
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

@final
class Table(_Value):
    column_names: Final[list[str]]
    def keys(self) -> list[str]: ...
    def __len__(self) -> int: ...
    # The rows; keys() has the names of the columns.
    def __iter__(self) -> Iterator[dict[str, Any]]: ...
    def __contains__(self, name: object, /) -> bool: ...
    def _repr_html_(self) -> str: ...
    def __getitem__(self, name: str, /) -> _Cells: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class Record(_Series):
    @classmethod
    def from_arrays(
        cls,
        *,
        time_s: ArrayLike,
        force_n: ArrayLike,
        displacement_m: ArrayLike | None = None,
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
    ) -> Self: ...
    title: Final[str]
    x_m: Final[float | None]
    y_m: Final[float | None]
    map_index: Final[int | None]
    time_s: Final[_Doubles]
    displacement_m: Final[_Doubles | None]
    force_n: Final[_Doubles]
    corrections: Final[list[str]]
    def segments(self) -> Table: ...
    def analyze(
        self,
        *,
        test: _Described | None = None,
        exponents: Sequence[float] | None = None,
        free_exponent: bool | None = None,
        confidence: float | None = None,
        intervals: str | None = None,
        fit_until_s: float | None = None,
        compare: bool = True,
    ) -> Analysis: ...
    def compare(
        self,
        *,
        test: _Described | None = None,
        laws: Sequence[str] | None = None,
        cuts: Sequence[float] | None = None,
        creep: bool = False,
        intervals: str | None = None,
        fit_until_s: float | None = None,
    ) -> RecordComparison: ...
    def calibrate(
        self,
        *,
        law: str = "latency",
        test: _Described | None = None,
        alternatives: Sequence[str] | None = None,
        equilibrium: str | None = None,
        poisson_ratio: float | None = None,
        rate: str = "constant",
        fit_until_s: float | None = None,
        confidence: float | None = None,
        profile: bool = False,
    ) -> Calibration: ...

@final
class BatchResult(_Value):
    law: Final[str | None]
    laws: Final[dict[str, int]]
    parameters: Final[Table]
    findings: Final[dict[str, int]]
    holds: Final[int]
    unfitted: Final[int]
    without_hold: Final[int]
    loading_modulus_pa: Final[float | None]
    rows: Final[int]
    failures: Final[list[str]]
    def map(self, quantity: str) -> str: ...

@final
class Finding(_Value):
    code: Final[str]
    severity: Final[str]
    observation: Final[str]
    meaning: Final[str]
    remedy: Final[str]
    hold: Final[int | None]

@final
class Analysis(_Reported):
    segments: Final[Table]
    holds: Final[Table]
    fits: Final[Table]
    parameter_table: Final[Table]
    budgets: Final[Table]
    conditions: Final[dict[str, Any]]
    constraint: Final[Table]
    relaxation_at: Final[Table]
    loading_modulus_pa: Final[float | None]
    loading_modulus_standard_error_pa: Final[float | None]
    law: Final[str | None]
    sentence: Final[str]
    findings: Final[list[Finding]]
    def to_arrow(self) -> Table: ...
    def report(
        self,
        folder: _Path,
        *,
        figures: Sequence[str] | None = None,
        column: str | None = None,
        holds: Sequence[int] | None = None,
        csv_locale: str | None = None,
    ) -> os.PathLike[str]: ...
    def _repr_html_(self) -> str | None: ...

@final
class Calibration(_Series, _Reported):
    material: Final[Material]
    laws: Final[Table]
    parameter_table: Final[Table]
    budgets: Final[Table]
    sentence: Final[str | None]
    remarks: Final[list[str]]
    termination: Final[str]
    is_good: Final[bool]
    rmse_n: Final[float]
    fitted: Final[int]
    time_s: Final[_Doubles]
    displacement_m: Final[_Doubles]
    force_n: Final[_Doubles]
    simulated_n: Final[_Doubles]
    residual_n: Final[_Doubles]
    def report(self) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class SeveralCalibrations(_Reported):
    specimen: Final[Material | None]
    materials: Final[list[Material]]
    parameter_table: Final[Table]
    record_table: Final[Table]
    remarks: Final[list[str]]
    def __len__(self) -> int: ...
    def report(self) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class Material(_Value):
    @classmethod
    def read(cls, path: _Path) -> Self: ...
    def write(self, path: _Path) -> None: ...
    def to_toml(self) -> str: ...
    law: Final[str]
    equilibrium: Final[str]
    parameter_table: Final[Table]
    estimates: Final[dict[str, Estimate]]
    parameters: Final[dict[str, float]]
    log_covariance: Final[_Doubles | None]
    confidence: Final[float | None]
    noise_n: Final[float]
    calibration_range: Final[dict[str, float]]
    origin: Final[dict[str, Any]]
    def predict(
        self,
        protocol: _Path | Mapping[str, Any] | Sequence[Mapping[str, Any]] | Record,
        *,
        at_s: ArrayLike | None = None,
        confidence: float = 0.95,
    ) -> Prediction: ...
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
        control: Literal["position", "force"] = "position",
        squeeze_m: float | None = None,
        force_n: float | None = None,
        hold_s: float | None = None,
        objective: Literal["squeeze", "peak-force", "work"] | None = None,
        band_n: tuple[float, float] | None = None,
        regrip: Literal["moves", "work"] | None = None,
        shortest_pause_s: float | None = None,
        confidence: float = 0.95,
    ) -> Grip: ...
    def _repr_html_(self) -> str: ...

@final
class Grip(_Reported):
    holds: Final[bool]
    verdict: Final[str]
    question: Final[str]
    remarks: Final[list[str]]
    extrapolations: Final[list[str]]
    confidence: Final[float]
    probability: Final[float | None]
    assured_squeeze_m: Final[float | None]
    assured_time_s: Final[float | None]
    squeeze: Final[PositionHold | None]
    squeeze_m: Final[float | None]
    time_to_slip_s: Final[float | None]
    time_to_slip_interval_s: Final[tuple[float, float] | None]
    neighbours: Final[Table]
    back_off: Final[BackOff | None]
    force_held: Final[ForceHold | None]
    schedule: Final[Schedule | None]
    refused: Final[dict[str, str]]
    def to_svg(self) -> str: ...
    def report(self, folder: _Path) -> os.PathLike[str]: ...
    def _repr_html_(self) -> str | None: ...

@final
class PositionHold(_Value):
    kind: Final[Literal["squeeze", "settle", "back_off"]]
    over_m: Final[float | None]
    settling_force_n: Final[float | None]
    settling_s: Final[float | None]
    speed_m_per_s: Final[float]
    closing_s: Final[float]
    displacement_m: Final[float]
    needed_force_n: Final[float]
    start_force_n: Final[float]
    peak_force_n: Final[float]
    equilibrium_force_n: Final[float]
    work_j: Final[float]
    sharpness_per_m: Final[float | None]
    time_to_slip_s: Final[float]
    time_to_slip_interval_s: Final[tuple[float, float] | None]
    assured_time_s: Final[float | None]
    course: Final[Prediction | None]

@final
class BackOff(_Value):
    backed: Final[PositionHold]
    plain: Final[PositionHold]
    duration_s: Final[float]
    drift_n: Final[float]
    plain_drift_n: Final[float]
    sensitivities: Final[Table]

@final
class ForceHold(_Value):
    force_n: Final[float]
    duration_s: Final[float]
    needed_force_n: Final[float]
    closing_s: Final[float]
    displacement_start_m: Final[float]
    displacement_end_m: Final[float]
    displacement_relaxed_m: Final[float | None]
    holds: Final[bool]
    stroke_ends_s: Final[float | None]
    work_j: Final[float]
    course: Final[Prediction]

@final
class Schedule(_Value):
    objective: Final[Literal["moves", "work"]]
    band_n: Final[tuple[float, float]]
    duration_s: Final[float]
    moves: Final[Table]
    end_force_n: Final[float]
    end_displacement_m: Final[float]
    work_j: Final[float]
    course: Final[Prediction]

@final
class Observation(_Value):
    time_s: Final[float]
    phase: Final[Literal["free", "loading", "holding", "unloading"]]
    held: Final[Literal["displacement", "force"] | None]
    held_since_s: Final[float | None]
    began: Final[bool]
    force_n: Final[float]
    equilibrium_force_n: Final[float | None]
    equilibrium_force_standard_error_n: Final[float | None]
    excess_force_n: Final[float | None]
    excess_force_standard_error_n: Final[float | None]
    excess_strain: Final[float | None]
    excess_strain_standard_error: Final[float | None]
    relative_rate_per_s: Final[float | None]
    creep_rate_m_per_s: Final[float | None]
    creep_rate_standard_error_m_per_s: Final[float | None]
    slips: Final[Literal["not_known_yet", "never", "perhaps_never", "after"] | None]
    time_to_slip_s: Final[float | None]
    time_to_slip_low_s: Final[float | None]
    time_to_slip_high_s: Final[float | None]
    warning: Final[Literal["none", "soon", "slipping"]]

@final
class Observer(_Moved):
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
    def feed(self, time_s: float, force_n: float, displacement_m: float | None = None) -> Observation: ...
    def feed_many(self, time_s: ArrayLike, force_n: ArrayLike, displacement_m: ArrayLike | None = None) -> Table: ...
    material: Final[Material | None]
    slip_force_n: Final[float | None]
    warn_before_s: Final[float]
    confidence: Final[float]

@final
class Prediction(_Series):
    time_s: Final[_Doubles]
    displacement_m: Final[_Doubles]
    displacement_low_m: Final[_Doubles]
    displacement_high_m: Final[_Doubles]
    force_n: Final[_Doubles]
    force_low_n: Final[_Doubles]
    force_high_n: Final[_Doubles]
    reading_low_n: Final[_Doubles]
    reading_high_n: Final[_Doubles]
    force_standard_error_n: Final[_Doubles]
    noise_n: Final[float]
    confidence: Final[float]
    extrapolations: Final[list[str]]
    trajectory: Final[Trajectory]
    def to_csv(self, *, csv_locale: str | None = None) -> str: ...
    def _repr_html_(self) -> str: ...

@final
class Estimate(_Value):
    value: Final[float]
    standard_error: Final[float | None]
    white_standard_error: Final[float | None]
    interval: Final[tuple[float, float] | None]
    unit: Final[str]
    def __float__(self) -> float: ...

@final
class Fit(_Value):
    law: Final[str]
    estimates: Final[dict[str, Estimate]]
    parameters: Final[dict[str, float]]
    searched: Final[list[str]]
    covariance: Final[_Doubles | None]
    white_covariance: Final[_Doubles | None]
    correlation: Final[_Doubles | None]
    residual_square: Final[float]
    rmse: Final[float]
    residual_correlation: Final[float]
    noise: Final[str]
    effective_samples: Final[float]
    noise_p_value: Final[float | None]
    interval_method: Final[str]
    samples: Final[int]
    start_s: Final[float]
    duration_s: Final[float]
    termination: Final[str]
    is_good: Final[bool]
    @overload
    def predict(
        self,
        time_s: ArrayLike | None = None,
        *,
        elapsed_s: ArrayLike | None = None,
        interval: None = None,
        of: Literal["curve", "sample"] = "curve",
    ) -> _Doubles: ...
    @overload
    def predict(
        self,
        time_s: ArrayLike | None = None,
        *,
        elapsed_s: ArrayLike | None = None,
        interval: float,
        of: Literal["curve", "sample"] = "curve",
    ) -> tuple[_Doubles, _Doubles, _Doubles]: ...
    def report(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...

@final
class Comparison(_Value):
    law: Final[str | None]
    certainty: Final[str | None]
    probability: Final[float | None]
    sentence: Final[str | None]
    reservation: Final[str | None]
    forecast: Final[Table | None]
    laws: Final[Table]
    def to_dict(self) -> dict[str, Any]: ...

@final
class RecordComparison(_Reported):
    laws: Final[Table]

@final
class Trajectory(_Series):
    time_s: Final[_Doubles]
    displacement_m: Final[_Doubles]
    contact_displacement_m: Final[_Doubles]
    force_n: Final[_Doubles]
    strain: Final[_Doubles]
    equilibrium_strain: Final[_Doubles]
    excess_strain: Final[_Doubles]
    strain_rate_per_s: Final[_Doubles]
    in_contact: Final[NDArray[np.bool_]]
    events: Final[list[tuple[str, float, float]]]
    def to_csv(self, *, csv_locale: str | None = None) -> str: ...

@final
class ContactState(_Moved):
    def __new__(cls, model: _Described) -> Self: ...
    def step(self, dt_s: float, displacement_m: float) -> float: ...
    def step_force(self, dt_s: float, force_n: float) -> float: ...
    force_n: Final[float]
    surface_m: Final[float]
    is_touching: Final[bool]

@final
class ContactStates(_Moved):
    def __new__(
        cls, model: _Described | Sequence[_Described], count: int | None = None
    ) -> Self: ...
    def step(self, dt_s: float | ArrayLike, displacement_m: float | ArrayLike) -> _Doubles: ...
    def step_force(self, dt_s: float | ArrayLike, force_n: float | ArrayLike) -> _Doubles: ...
    force_n: Final[_Doubles]
    surface_m: Final[_Doubles]
    is_touching: Final[NDArray[np.bool_]]
    def __len__(self) -> int: ...

def read(
    path: _File,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
    then: _Path | None = None,
) -> Record: ...
def read_all(
    path: _File, *, name: str | None = None, test: _Described | None = None, columns: _Columns | None = None
) -> list[Record]: ...
def fit_hold(
    time_s: ArrayLike, signal: ArrayLike, weights: ArrayLike | None, keywords: Mapping[str, Any]
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
) -> _Doubles: ...
def law_names() -> list[str]: ...
def command(arguments: Sequence[str]) -> int: ...
def calibrate(
    records: Sequence[Record],
    *,
    shared: str | Sequence[str] | None = None,
    law: str = "latency",
    test: _Described | None = None,
    equilibrium: str | None = None,
    poisson_ratio: float | None = None,
    rate: str = "constant",
    confidence: float | None = None,
) -> SeveralCalibrations: ...
def compare(
    time_s: ArrayLike,
    signal: ArrayLike,
    *,
    laws: Sequence[str] | None = None,
    weights: ArrayLike | None = None,
    quantity: str = "force",
    cuts: Sequence[float] | None = None,
) -> Comparison: ...
def forecast(
    time_s: ArrayLike,
    signal: ArrayLike,
    at_s: ArrayLike,
    *,
    laws: Sequence[str] | None = None,
    weights: ArrayLike | None = None,
    quantity: str = "force",
    confidence: float = 0.95,
) -> Table: ...
def mapping_text(table: Mapping[str, Any]) -> str: ...
def simulate(path: _Path | None, text: str | None) -> Trajectory: ...
def simulate_many(
    path: _Path | None,
    text: str | None,
    numbers: Sequence[tuple[str, ArrayLike]],
    times_s: ArrayLike | None,
    progress: Callable[[int], None] | None,
) -> Table: ...
def inspect(
    path: _File,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
) -> str: ...
def convert(
    path: _File,
    out: _Path,
    *,
    name: str | None = None,
    test: _Described | None = None,
    part: str | int | None = None,
    columns: _Columns | None = None,
    csv_locale: str | None = None,
) -> Path: ...
def batch(
    paths: Iterable[_File] | Mapping[str, _File],
    out: _Path,
    *,
    test: _Described | None = None,
    columns: _Columns | None = None,
    laws: Sequence[str] | None = None,
    intervals: str | None = None,
    fit_until_s: float | None = None,
    map: Sequence[str] | None = None,
    csv_locale: str | None = None,
    restart: bool = False,
) -> BatchResult: ...
def sweep(
    protocol: _Path, out: _Path, *, figure: _Path | None = None, show: str | None = None, restart: bool = False
) -> tuple[int, int]: ...
def report_all(
    analyses: Sequence[Analysis],
    folder: _Path,
    *,
    figures: Sequence[str] | None = None,
    column: str | None = None,
    csv_locale: str | None = None,
) -> os.PathLike[str]: ...
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
) -> dict[str, Any]: ...
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
) -> list[dict[str, Any]]: ...
