"""Laws of relaxation as functions of arrays, fit for ``scipy.optimize.curve_fit`` and for lmfit.

>>> import numpy as np
>>> from palpate import laws
>>> laws.latency(np.array([0.0, 2.0]), 0.2, 0.1, 0.5, 2.0)
array([0.3 , 0.25])
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate._palpate import latency as _latency
from palpate._palpate import law_names as _law_names

__all__ = ["latency", "names"]


def latency(
    elapsed_s: Any, equilibrium: float, amplitude: float, relative_rate_per_s: float, exponent: float
) -> NDArray[np.float64]:
    """The nonlinear latency law in a hold, y_e + D (1 + (n - 1) l t)^(-1/(n - 1)), through n = 1.

    Equations (4) and (5) of Tsai, Kao et al., with l = v D^(n - 1).

    Parameters
    ----------
    elapsed_s : array_like, shape (N,)
        Time since the start of the hold, s; before it the value is that at the start.
    equilibrium, amplitude
        y_e and D = y(0) - y_e, in the unit of the signal.
    relative_rate_per_s
        l, the rate at the start over the excess, 1/s; 0 or more.
    exponent
        n > 0; for n < 1 the excess ends after a finite time.

    Returns
    -------
    ndarray, shape (N,)
        The signal.

    Raises
    ------
    ModelError
        An exponent that is not above 0, a rate below 0.
    """
    return _latency(elapsed_s, equilibrium, amplitude, relative_rate_per_s, exponent)


def names() -> list[str]:
    """Names of laws as ``law=`` takes them; N and K stand for numbers."""
    return _law_names()
