"""What all results have besides their numbers: methods in Python, which the classes of the compiled part are given here, once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from palpate import _convert, _palpate, _plot, _posterior, _show

_TABLES = (
    *(_palpate.Table, _palpate.Record, _palpate.Fit, _palpate.Comparison, _palpate.RecordComparison, _palpate.Analysis),
    *(_palpate.Calibration, _palpate.Prediction, _palpate.Trajectory, _palpate.Grip),
)
_SHOWN = _palpate.Record, _palpate.Fit, _palpate.Comparison, _palpate.RecordComparison, _palpate.Trajectory
_METHODS: list[tuple[str, Callable[..., Any], tuple[type, ...]]] = [
    ("to_pandas", _convert.to_pandas, _TABLES),
    ("to_polars", _convert.to_polars, _TABLES),
    ("to_xarray", _convert.to_xarray, _TABLES),
    ("to_dict", _convert.to_dict, (_palpate.Table, _palpate.Record, _palpate.Prediction, _palpate.Trajectory)),
    ("summary", _show.summary, (*_TABLES[1:], _palpate.BatchResult)),
    ("_repr_html_", _show._repr_html_, _SHOWN),
    ("plot", _plot.series, (_palpate.Record, _palpate.Trajectory)),
    ("plot", _plot.fit, (_palpate.Fit,)),
    ("plot", _plot.comparison, (_palpate.Comparison,)),
    ("plot", _plot.record_comparison, (_palpate.RecordComparison,)),
    ("plot", _plot.analysis, (_palpate.Analysis,)),
    ("plot", _plot.calibration, (_palpate.Calibration,)),
    ("plot", _plot.prediction, (_palpate.Prediction,)),
    ("plot", _plot.grip, (_palpate.Grip,)),
    ("sample", _posterior.sample, (_palpate.Fit,)),
    ("to_arviz", _posterior.to_arviz, (_palpate.Fit,)),
    ("eval", _posterior.evaluate, (_palpate.Fit,)),
]


def attach() -> None:
    """Gives the classes their methods."""
    for name, method, classes in _METHODS:
        for kind in classes:
            setattr(kind, name, method)
