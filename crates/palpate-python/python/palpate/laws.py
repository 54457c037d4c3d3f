"""Laws of relaxation as functions of arrays, fit for ``scipy.optimize.curve_fit``, and as models of lmfit.

Their parameters have the names and the meaning that `palpate.fit_hold` gives them: ``laws.latency(t, **fit.parameters)`` is the curve
of a fit whose clock starts at 0.

>>> import numpy as np
>>> from palpate import laws
>>> laws.latency(np.array([0.0, 2.0]), 0.2, 0.1, 0.5, 2.0)
array([0.3 , 0.25])
>>> laws.function("prony:2").__signature__
<Signature (elapsed_s, equilibrium, amplitude_1, amplitude_2, time_constant_1_s, time_constant_2_s)>
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate import _units
from palpate._palpate import OptionError
from palpate._palpate import latency as _latency
from palpate._palpate import law_names as _law_names

__all__ = [
    "burgers",
    "function",
    "latency",
    "logarithmic",
    "maxwell",
    "model",
    "names",
    "power",
    "prony",
    "standard_linear_solid",
    "stretched",
]

Doubles = NDArray[np.float64]
Law = Callable[..., Doubles]


def latency(
    elapsed_s: Any, equilibrium: float, amplitude: float, relative_rate_per_s: float, exponent: float
) -> Doubles:
    """The nonlinear latency law in a hold, y_e + D (1 + (n - 1) l t)^(-1/(n - 1)), through n = 1.

    Equations (4) and (5) of Tsai, Kao et al., with l = v D^(n - 1).

    Parameters
    ----------
    elapsed_s : float or array_like
        Time since the start of the hold, s; before it the value is that at the start.
    equilibrium, amplitude
        y_e and D = y(0) - y_e, in the unit of the signal.
    relative_rate_per_s
        l, the rate at the start over the excess, 1/s; 0 or more.
    exponent
        n > 0; for n < 1 the excess ends after a finite time.

    Returns
    -------
    ndarray
        The signal, in the shape of the times.

    Raises
    ------
    ModelError
        An exponent that is not above 0, a rate below 0.
    """
    if np.ndim(elapsed_s) == 1:
        return _latency(elapsed_s, equilibrium, amplitude, relative_rate_per_s, exponent)
    times = _doubles(elapsed_s)
    return _latency(times.reshape(-1), equilibrium, amplitude, relative_rate_per_s, exponent).reshape(times.shape)


def _doubles(elapsed_s: Any) -> Doubles:
    """Times of any shape; quantities of pint are converted to s."""
    return np.asarray(_units.in_si(elapsed_s, "elapsed_s"), dtype=np.float64)


def _times(elapsed_s: Any) -> Doubles:
    return np.maximum(_doubles(elapsed_s), 0.0)


def maxwell(elapsed_s: Any, amplitude: float, time_constant_s: float) -> Doubles:
    """Spring and dashpot in series, A exp(-t/T); T in s."""
    return np.asarray(amplitude * np.exp(-_times(elapsed_s) / time_constant_s))


def standard_linear_solid(elapsed_s: Any, equilibrium: float, amplitude: float, time_constant_s: float) -> Doubles:
    """One exponential and a constant, y_e + A exp(-t/T); T in s."""
    return np.asarray(equilibrium + amplitude * np.exp(-_times(elapsed_s) / time_constant_s))


def burgers(elapsed_s: Any, amplitude_1: float, amplitude_2: float, time_constant_1_s: float, time_constant_2_s: float) -> Doubles:
    """Maxwell and Kelvin-Voigt in series, A_1 exp(-t/T_1) + A_2 exp(-t/T_2); T in s."""
    t = _times(elapsed_s)
    return np.asarray(amplitude_1 * np.exp(-t / time_constant_1_s) + amplitude_2 * np.exp(-t / time_constant_2_s))


def stretched(elapsed_s: Any, equilibrium: float, amplitude: float, time_constant_s: float, stretching: float) -> Doubles:
    """Stretched exponential (Kohlrausch), y_e + A exp(-(t/T)^b); T in s."""
    return np.asarray(equilibrium + amplitude * np.exp(-((_times(elapsed_s) / time_constant_s) ** stretching)))


def power(elapsed_s: Any, amplitude: float, time_constant_s: float, exponent: float) -> Doubles:
    """Power of time, A (1 + t/T)^(-m); T in s."""
    return np.asarray(amplitude * (1.0 + _times(elapsed_s) / time_constant_s) ** -exponent)


def logarithmic(elapsed_s: Any, start: float, amplitude: float, time_constant_s: float) -> Doubles:
    """Logarithm of time, y_0 - A ln(1 + t/T); T in s."""
    return np.asarray(start - amplitude * np.log1p(_times(elapsed_s) / time_constant_s))


def prony(terms: int) -> Law:
    """A series of exponentials and a constant, y_e + sum A_k exp(-t/T_k), as a function of its 1 + 2 K parameters.

    Parameters
    ----------
    terms
        K, 1 or more.

    Returns
    -------
    callable
        ``f(elapsed_s, equilibrium, amplitude_1, ..., time_constant_1_s, ...)``; T in s. One term has no number:
        ``f(elapsed_s, equilibrium, amplitude, time_constant_s)``.

    Raises
    ------
    OptionError
        Fewer than one term.
    """
    if terms < 1:
        raise OptionError(f"terms: expected 1 or more, found {terms}")
    # Named as in a fit.
    places = [f"_{k}" for k in range(1, terms + 1)] if terms > 1 else [""]
    names = [*(f"amplitude{place}" for place in places), *(f"time_constant{place}_s" for place in places)]
    parameters = [inspect.Parameter(n, inspect.Parameter.POSITIONAL_OR_KEYWORD) for n in ("elapsed_s", "equilibrium", *names)]
    signature = inspect.Signature(parameters)

    def series(*given: Any, **named: Any) -> Doubles:
        # The TypeError of arguments that are missing, unknown or doubled is that of any function.
        elapsed_s, equilibrium, *values = signature.bind(*given, **named).args
        t = _times(elapsed_s)
        parts = (a * np.exp(-t / tau) for a, tau in zip(values[:terms], values[terms:], strict=True))
        return np.asarray(equilibrium + sum(parts))

    series.__name__ = f"prony_{terms}"
    series.__doc__ = f"A series of {terms} exponentials and a constant."
    series.__signature__ = signature  # type: ignore[attr-defined]
    return series


def function(law: str) -> Law:
    """The function of a law by the name that ``law=`` takes, for ``scipy.optimize.curve_fit``.

    Parameters
    ----------
    law
        "latency", "latency:N", "maxwell", "standard-linear-solid", "burgers", "prony:K", "stretched", "power" or
        "logarithmic".

    Returns
    -------
    callable
        ``f(elapsed_s, ...)`` with the parameters of the law by name.

    Raises
    ------
    OptionError
        A law that is not known, or one that is no closed form: ``Fit.predict`` evaluates those.
    """
    name, _, number = law.partition(":")
    if name == "prony" and number.isdecimal():
        return prony(int(number))
    if name == "latency" and number:
        return _latency_of(law, number)
    plain: dict[str, Law] = {
        "latency": latency,
        "maxwell": maxwell,
        "standard-linear-solid": standard_linear_solid,
        "burgers": burgers,
        "stretched": stretched,
        "power": power,
        "logarithmic": logarithmic,
    }
    if law not in plain:
        known = ", ".join([*plain, "latency:N", "prony:K"])
        raise OptionError(f"law: expected one that is a function here ({known}), found {law!r}")
    return plain[law]


def _latency_of(law: str, number: str) -> Law:
    try:
        exponent = float(number)
    except ValueError:
        raise OptionError(f"law: expected a number behind the colon, found {law!r}") from None

    given = exponent

    def fixed(
        elapsed_s: Any, equilibrium: float, amplitude: float, relative_rate_per_s: float, *, exponent: float = given
    ) -> Doubles:
        return latency(elapsed_s, equilibrium, amplitude, relative_rate_per_s, exponent)

    fixed.__name__ = f"latency_{number.replace('.', '_')}"
    fixed.__doc__ = f"The nonlinear latency law with n = {given:g}."
    return fixed


#: Bounds that every law needs to be one.
_BOUNDS: dict[str, tuple[float, float]] = {
    "relative_rate_per_s": (0.0, np.inf),
    "exponent": (1e-3, 100.0),
    "stretching": (1e-3, 10.0),
}


def model(law: str) -> Any:
    """A law as an ``lmfit.Model`` with the bounds that its parameters need; lmfit has to be installed.

    Parameters
    ----------
    law
        As for `function`.

    Returns
    -------
    lmfit.Model
        Of ``elapsed_s``; give starting values with ``make_params``.

    Raises
    ------
    OptionError
        As for `function`.
    ImportError
        Without lmfit.
    """
    import lmfit

    made = lmfit.Model(function(law), independent_vars=["elapsed_s"], name=law)
    if law.startswith("latency:"):
        # The exponent is part of the law and no variable of its model.
        made.set_param_hint("exponent", vary=False)
    for name in made.param_names:
        low, high = _BOUNDS.get(name, (1e-12, np.inf) if name.startswith("time") else (-np.inf, np.inf))
        made.set_param_hint(name, min=low, max=high)
    return made


def names() -> list[str]:
    """Names of laws as ``law=`` and ``laws=`` take them; N and K stand for numbers.

    The "spectrum" has no few parameters: `palpate.compare` fits and judges it, and `palpate.fit_hold` refuses it. "kelvin-voigt"
    is a law of creep, and "fung:K" and "fung-continuous" are laws of relaxation alone.
    """
    return _law_names()
