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

from palpate import _results, laws, protocols
from palpate._contacts import energy, simulate, simulate_many
from palpate._export import Card, export
from palpate._fits import fit_hold, fit_many
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
    merge,
    read,
    read_all,
    report_all,
    reproduce,
    sweep,
    watch,
)
from palpate._palpate import __version__ as __version__
from palpate.protocols import Law, Protocol, Specimen, Step

__all__ = [
    "Analysis",
    "BackOff",
    "BatchResult",
    "Calibration",
    "Card",
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
    "export",
    "fit_hold",
    "fit_many",
    "forecast",
    "inspect",
    "laws",
    "merge",
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
