"""Laws as functions: the same curves that fits have, for SciPy and for lmfit."""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import palpate
import pint
import pytest
from conftest import relaxation
from palpate import laws
from scipy.optimize import curve_fit


@pytest.mark.parametrize(
    "law",
    ["latency", "latency:5", "maxwell", "standard-linear-solid", "burgers", "prony:1", "prony:2", "stretched", "power", "logarithmic"],
)
def test_a_function_is_the_curve_of_the_fit(law: str) -> None:
    t, y = relaxation(300, 1e-4)
    fit = palpate.fit_hold(t, y, law=law)
    function = laws.function(law)
    assert function(t, **fit.parameters) == pytest.approx(fit.predict(t), rel=1e-12)
    assert list(inspect.signature(function).parameters)[1:] == list(fit.parameters)
    # Before the hold nothing relaxes.
    assert function(np.array([-1.0, 0.0]), **fit.parameters)[0] == function(np.array([0.0]), **fit.parameters)[0]


def test_the_exponent_of_a_law_is_no_variable_of_its_model() -> None:
    t, y = relaxation(300, 1e-4)
    fit = palpate.fit_hold(t, y, law="latency:5")
    assert laws.latency(t, **fit.parameters) == pytest.approx(fit.predict(t), rel=1e-12)
    result = laws.model("latency:5").fit(y, elapsed_s=t, equilibrium=0.2, amplitude=0.1, relative_rate_per_s=1.0)
    assert result.nvarys == 3 and result.params["equilibrium"].value == pytest.approx(fit.parameters["equilibrium"], rel=1e-3)


def test_scipy_takes_them() -> None:
    t, y = relaxation(300, 1e-4)
    fit = palpate.fit_hold(t, y, law="prony:2")
    order = ["equilibrium", "amplitude_1", "amplitude_2", "time_constant_1_s", "time_constant_2_s"]
    start = [0.2, 0.05, 0.05, 1.0, 8.0]
    found, _ = curve_fit(laws.function("prony:2"), t, y, p0=start)
    assert found == pytest.approx([fit.parameters[name] for name in order], rel=1e-3)


def test_lmfit_takes_them() -> None:
    t, y = relaxation(300, 1e-4)
    fit = palpate.fit_hold(t, y)
    model = laws.model("latency")
    assert model.param_names == ["equilibrium", "amplitude", "relative_rate_per_s", "exponent"]
    result = model.fit(y, elapsed_s=t, equilibrium=0.2, amplitude=0.1, relative_rate_per_s=1.0, exponent=4.0)
    assert result.params["exponent"].value == pytest.approx(fit.parameters["exponent"], rel=1e-3)
    assert result.params["relative_rate_per_s"].min == 0.0


@pytest.mark.parametrize("law", ["fractional-zener", "prony", "prony:x", "prony:0", "latency:x", "Maxwell"])
def test_a_law_that_is_no_function_is_refused(law: str) -> None:
    with pytest.raises(palpate.OptionError):
        laws.function(law)
    with pytest.raises(palpate.OptionError):
        palpate.fit_hold(*relaxation(100), law="spectrum")


def test_arguments_of_a_series_are_those_of_a_function() -> None:
    series = laws.prony(2)
    assert series(0.0, 1.0, 2.0, time_constant_2_s=2.0, amplitude_2=3.0, time_constant_1_s=1.0) == 6.0
    for given, named, reported in [
        ((0.0, 1.0, 2.0), {}, "missing a required argument: 'amplitude_2'"),
        ((0.0, 1.0, 2.0, 3.0, 1.0, 2.0, 9.0), {}, "too many positional arguments"),
        ((0.0, 1.0, 2.0, 3.0, 1.0, 2.0), {"amplitude_1": 2.0}, "multiple values for argument 'amplitude_1'"),
        ((0.0, 1.0, 2.0, 3.0, 1.0, 2.0), {"amplitude_3": 2.0}, "unexpected keyword argument 'amplitude_3'"),
    ]:
        with pytest.raises(TypeError, match=reported):
            series(*given, **named)


@pytest.mark.parametrize("law", ["latency", "latency:5", "maxwell", "prony:1", "logarithmic"])
def test_times_have_any_shape(law: str) -> None:
    function = laws.function(law)
    count = len(inspect.signature(function).parameters) - (2 if law == "latency:5" else 1)
    numbers = [0.5 * k for k in range(1, count + 1)]
    times = np.arange(6.0)
    column = function(times, *numbers)
    assert np.shape(function(1.0, *numbers)) == () and function(1.0, *numbers) == column[1]
    assert np.array_equal(function(times.reshape(2, 3), *numbers), column.reshape(2, 3))
    assert np.array_equal(function(list(range(6)), *numbers), column)
    quantities: Any = pint.UnitRegistry().Quantity(1e3 * times, "ms")
    assert np.array_equal(function(quantities, *numbers), column) and function(quantities[1], *numbers) == column[1]
