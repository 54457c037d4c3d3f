"""Parameters of a fit as samples of their distribution, and its law with other ones."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate import laws
from palpate._convert import needed
from palpate._fits import parameter
from palpate._palpate import FitError, OptionError

#: How a parameter follows from what was searched, by the scale that its name begins with, and back.
_SCALES: dict[str, tuple[Any, Any]] = {
    "-ln ": (lambda x: -np.log(x), lambda z: np.exp(-z)),
    "ln ": (np.log, np.exp),
    "": (lambda x: x, lambda z: z),
}


#: Rounds of draws, each of as many sets as are wanted, before bounds count as too narrow to draw inside of them.
_MOST_ROUNDS = 1000


def _inside(sets: dict[str, NDArray[np.float64]], bounds: dict[str, Any]) -> dict[str, NDArray[np.float64]]:
    """The sets of parameters inside the bounds."""
    ends = {name: (-np.inf if low is None else low, np.inf if high is None else high) for name, (low, high) in bounds.items() if name in sets}
    inside = np.ones(len(next(iter(sets.values()), [])), dtype=bool)
    for name, (low, high) in ends.items():
        # A parameter that ended at a bound varies by rounding alone.
        inside &= (sets[name] >= low - 1e-12 * abs(low)) & (sets[name] <= high + 1e-12 * abs(high))
    return {name: np.clip(values[inside], *ends.get(name, (-np.inf, np.inf))) for name, values in sets.items()}


def _scale(searched: str) -> tuple[str, Any, Any]:
    prefix = next(prefix for prefix in _SCALES if searched.startswith(prefix))
    return searched.removeprefix(prefix), *_SCALES[prefix]


def _deviations(generator: np.random.Generator, uncertainty: dict[str, Any], n: int) -> NDArray[np.float64]:
    """Deviations of sets of the searched parameters from those that were found, a row a set: what the intervals are quantiles of.

    One of the models of the noise, each by its probability, then Student's t with its covariance.
    """
    models = uncertainty["models"] or [{"probability": 1.0, "covariance": uncertainty["covariance"]}]
    probabilities = np.array([model["probability"] for model in models])
    chosen = generator.choice(len(models), size=n, p=probabilities / probabilities.sum())
    found = generator.standard_normal((n, len(uncertainty["covariance"])))
    for number, model in enumerate(models):
        values, vectors = np.linalg.eigh(np.array(model["covariance"]))
        rows = chosen == number
        # A variance below 0 is the rounding of one that is 0.
        found[rows] = found[rows] @ (vectors * np.sqrt(np.maximum(values, 0.0))).T
    freedom = uncertainty["freedom"]
    return np.asarray(found * np.sqrt(freedom / generator.chisquare(freedom, (n, 1))))


def sample(self: Any, n: int = 1000, *, seed: int | None = None) -> dict[str, NDArray[np.float64]]:
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
    if isinstance(n, bool) or not hasattr(n, "__index__") or n < 1:
        raise OptionError(f"n: expected a number of sets, 1 or more, found {n!r}")
    if self.covariance is None:
        raise FitError("expected a fit with a covariance, found one whose data leave a parameter open\nhint: hold a parameter with fixed=, or fit a law with fewer")
    try:
        generator = np.random.default_rng(seed)
    except (TypeError, ValueError):
        raise OptionError(f"seed: expected a whole number, 0 or more, or None, found {seed!r}") from None
    uncertainty = self.to_dict()["uncertainty"]
    scales = [_scale(name) for name in self.searched]
    centre = [forward(self.parameters[name]) for name, forward, _ in scales]
    found = {name: np.empty(0) for name, _, _ in scales}
    for _ in range(_MOST_ROUNDS):
        drawn = centre + _deviations(generator, uncertainty, n)
        sets = _inside({name: back(drawn[:, place]) for place, (name, _, back) in enumerate(scales)}, self.bounds)
        found = {name: np.concatenate([values, sets[name]])[:n] for name, values in found.items()}
        if not scales or len(found[scales[0][0]]) == n:
            break
    else:
        raise FitError(f"expected bounds that hold more than one in {_MOST_ROUNDS} sets of the distribution, found narrower ones\nhint: hold the parameter with fixed=")
    return {name: found.get(name, np.full(n, value)) for name, value in self.parameters.items()}


def to_arviz(self: Any, draws: int = 1000, *, chains: int = 4, seed: int | None = None) -> Any:
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
    arviz = needed("arviz_base", "to_arviz")
    for name, count in (("draws", draws), ("chains", chains)):
        if isinstance(count, bool) or not hasattr(count, "__index__") or count < 1:
            raise OptionError(f"{name}: expected 1 or more, found {count!r}")
    searched = {_scale(name)[0] for name in self.searched}
    drawn = sample(self, draws * chains, seed=seed)
    posterior = {name: values.reshape(chains, draws) for name, values in drawn.items() if name in searched}
    groups = {"posterior": posterior, "observed_data": {"signal": self.signal}, "constant_data": {"time_s": self.time_s}}
    dimensions = {"signal": ["sample"], "time_s": ["sample"]}
    return arviz.from_dict(groups, dims=dimensions, coords={"sample": np.arange(len(self))})


def evaluate(self: Any, time_s: Any = None, **parameters: float) -> Any:
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
    unknown = [name for name in parameters if name not in self.parameters]
    if unknown:
        raise OptionError(f"expected parameters of {self.law} ({', '.join(self.parameters)}), found {', '.join(unknown)}")
    if not parameters:
        return self.predict(time_s)
    from palpate._arrays import at_times

    times, is_single = (self.time_s, False) if time_s is None else at_times(time_s, "eval(time_s)", self._first_date)
    replaced = {name: parameter(name, value, name, None) for name, value in parameters.items()}
    law = _creep if self.to_dict()["response"] == "creep" else _relaxation
    values = law(self, times - self.start_s, {**self.parameters, **replaced})
    return float(values[0]) if is_single else values


def _relaxation(fit: Any, elapsed_s: NDArray[np.float64], parameters: dict[str, float]) -> NDArray[np.float64]:
    return laws.function(fit.law)(elapsed_s, **parameters)


def _creep(fit: Any, elapsed_s: NDArray[np.float64], parameters: dict[str, float]) -> NDArray[np.float64]:
    """y_0 + sum A (1 - phi), by the function of the relaxation y_e + sum A phi; what grows without bound is added.

    The flow and the power of time are scaled by the duration of the fit: their amplitudes are the growth over it.
    """
    # A Kelvin-Voigt body begins at 0.
    start = parameters.get("instantaneous", 0.0)
    shape = {name: value for name, value in parameters.items() if name not in ("instantaneous", "flow")}
    passed = np.maximum(elapsed_s, 0.0) / fit.duration_s
    if fit.law == "logarithmic":
        return laws.logarithmic(elapsed_s, start, -shape["amplitude"], shape["time_constant_s"])
    if fit.law == "power":
        return np.asarray(start + shape["amplitude"] * passed ** shape["exponent"])
    # Without flow an infinite time adds nothing: 0 * inf is NaN.
    flow = parameters["flow"] * passed if parameters.get("flow") else np.zeros_like(passed)
    if fit.law == "maxwell":
        return np.asarray(start + flow)
    amplitudes = {name: -value for name, value in shape.items() if name.startswith("amplitude")}
    end = start - sum(amplitudes.values())
    # What they have beside one time is taken off above.
    is_of_one_time = fit.law in ("burgers", "kelvin-voigt")
    function = laws.function("standard-linear-solid" if is_of_one_time else fit.law)
    return np.asarray(flow + function(elapsed_s, equilibrium=end, **{**shape, **amplitudes}))
