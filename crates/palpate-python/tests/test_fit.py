"""One law fitted to one hold."""

from __future__ import annotations

import copy
import json
import multiprocessing
import pickle
from typing import Any

import lmfit
import numpy as np
import palpate
import pytest
from conftest import relaxation
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import curve_fit


def test_known_numbers_are_found() -> None:
    t, y = relaxation()
    fit = palpate.fit_hold(t, y)
    assert fit.law == "latency" and fit.is_good and fit.termination == "converged"
    assert fit.parameters["exponent"] == pytest.approx(5.0, rel=1e-6)
    assert fit.parameters["relative_rate_per_s"] == pytest.approx(0.5, rel=1e-6)
    assert fit.estimates["rate_coefficient_per_s"].value == pytest.approx(0.5 / 0.1**4, rel=1e-4)
    assert fit.samples == 400 and fit.duration_s == 40.0


def test_scipy_finds_the_same_numbers_and_errors() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t, y, noise="white")
    start = [0.15, 0.12, 1.0, 4.0]
    best, covariance = curve_fit(palpate.laws.latency, t, y, p0=start, bounds=([-1, 0, 1e-3, 1.01], [1, 1, 1e3, 20]))
    for place, name in enumerate(["equilibrium", "amplitude", "relative_rate_per_s", "exponent"]):
        estimate = fit.estimates[name]
        assert estimate.value == pytest.approx(best[place], rel=1e-4)
        assert estimate.standard_error == pytest.approx(np.sqrt(covariance[place, place]), rel=1e-2)


def test_lmfit_takes_the_law_as_a_model() -> None:
    t, y = relaxation(noise=1e-4)
    model = lmfit.Model(palpate.laws.latency)
    assert model.independent_vars == ["elapsed_s"]
    parameters = model.make_params(equilibrium=0.2, amplitude=0.1, relative_rate_per_s=0.5, exponent=5)
    parameters["exponent"].set(vary=False)
    result = model.fit(y, parameters, elapsed_s=t)
    fit = palpate.fit_hold(t, y, law="latency:5")
    assert fit.residual_square == pytest.approx(result.chisqr, rel=1e-6)
    assert fit.parameters["equilibrium"] == pytest.approx(result.params["equilibrium"].value, rel=1e-5)


def test_a_first_sample_that_is_left_out_starts_the_hold_by_weight_and_not_by_nan() -> None:
    t = np.linspace(3.0, 43.0, 401)
    y, first = 1.0 + 2.0 * np.exp(-(t - 3.0) / 8.0), np.arange(401) < 50
    weighted = palpate.fit_hold(t, y, law="standard-linear-solid", weights=np.where(first, 0.0, 1.0))
    omitted = palpate.fit_hold(t, np.where(first, np.nan, y), law="standard-linear-solid", nan="omit")
    assert (weighted.start_s, weighted.samples) == (3.0, 351) and weighted.estimates["start"].value == pytest.approx(3.0, rel=1e-9)
    assert omitted.start_s == t[50] and omitted.estimates["start"].value == pytest.approx(y[50], rel=1e-9)


def test_weights_are_those_of_lmfit() -> None:
    t, y = relaxation(noise=1e-3)
    weights = np.linspace(1.0, 3.0, t.size)
    model = lmfit.Model(lambda x, a, b, c: a + b * np.exp(-x / c))
    result = model.fit(y, x=t, a=0.2, b=0.1, c=5.0, weights=weights)
    fit = palpate.fit_hold(t, y, law="standard-linear-solid", weights=weights)
    assert fit.parameters["time_constant_s"] == pytest.approx(result.params["c"].value, rel=1e-4)
    assert fit.residual_square == pytest.approx(result.chisqr, rel=1e-6)
    spoiled = y.copy()
    spoiled[7] = 50.0
    left_out = np.where(np.arange(t.size) == 7, 0.0, 1.0)
    kept = left_out > 0
    without = palpate.fit_hold(t[kept], y[kept], law="standard-linear-solid")
    assert palpate.fit_hold(t, spoiled, law="standard-linear-solid", weights=left_out).parameters["time_constant_s"] == pytest.approx(
        without.parameters["time_constant_s"], rel=1e-9
    )


def test_a_sample_has_the_noise_of_its_weight() -> None:
    rng = np.random.default_rng(3)
    time = np.linspace(0, 40, 401)
    deviation = np.linspace(0.002, 0.05, 401)
    truth = 1 + 2 * (1 + time) ** -0.5
    fits = [palpate.fit_hold(time, truth + rng.normal(0, deviation), law="latency:3", weights=1 / deviation) for _ in range(20)]
    inside = []
    for fit in fits:
        value, low, high = fit.predict(time, interval=0.95, of="sample")
        again = truth + rng.normal(0, deviation)
        inside.append(np.mean((low <= again) & (again <= high)))
        half = 0.5 * (high - low) / (1.966 * deviation)
        # The curve is least certain at its ends.
        assert np.all(np.abs(half - 1) < 0.35) and np.all((low < value) & (value < high))
    assert 0.93 < np.mean(inside) < 0.97
    # Between two samples, and beyond the last.
    ends = fits[0].predict(elapsed_s=[20.05, 60.0], interval=0.95, of="sample")
    assert np.allclose(0.5 * (ends[2] - ends[1]) / 1.966, [0.026, 0.05], rtol=0.15)


def test_a_prediction_is_the_law_with_the_numbers_found() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t, y)
    at = np.array([0.0, 3.0, 400.0])
    law = palpate.laws.latency(at, **fit.parameters)
    np.testing.assert_allclose(fit.predict(at), law, rtol=1e-14)
    value, low, high = fit.predict(at, interval=0.95)
    _, lower, higher = fit.predict(at, interval=0.99)
    _, sample_low, sample_high = fit.predict(at, interval=0.95, of="sample")
    assert np.array_equal(value, fit.predict(at))
    assert np.all((lower < low) & (low < value) & (value < high) & (high < higher))
    assert np.all((sample_low < low) & (high < sample_high))


def test_the_band_of_many_times_is_that_of_each() -> None:
    t, y = relaxation(noise=1e-3)
    fit = palpate.fit_hold(t, y)
    at = np.array([np.nan, 0.0, 0.3, *np.linspace(1.0, 90.0, 40)])
    many = fit.predict(at, interval=0.9)
    for index, time in enumerate(at):
        one = fit.predict([time], interval=0.9)
        np.testing.assert_allclose([column[index] for column in many], [column[0] for column in one], rtol=1e-11)
    assert np.isnan(many[0][0]) and np.all(many[2][1:] > many[1][1:])


def test_a_prediction_is_on_the_clock_of_the_record() -> None:
    t, y = relaxation(noise=1e-4)
    fit, late = palpate.fit_hold(t, y), palpate.fit_hold(t + 100.0, y)
    assert (fit.start_s, late.start_s) == (0.0, 100.0)
    np.testing.assert_allclose(late.predict(t + 100.0), fit.predict(t), rtol=1e-9)
    np.testing.assert_allclose(late.predict(elapsed_s=t), fit.predict(t), rtol=1e-9)
    np.testing.assert_allclose(late.predict(time_s=[160.0], interval=0.9), fit.predict([60.0], interval=0.9), rtol=1e-6)
    with pytest.raises(palpate.OptionError, match="either time_s"):
        late.predict(t, elapsed_s=t)


def test_a_fit_keeps_its_samples() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t + 3.0, y)
    assert np.array_equal(fit.time_s, t + 3.0) and np.array_equal(fit.signal, y) and fit.weights is None
    assert np.array_equal(fit.best_fit, fit.predict()) and np.array_equal(fit.predict(), fit.predict(t + 3.0))
    np.testing.assert_array_equal(fit.residual, y - fit.best_fit)
    assert np.sum(fit.residual**2) == pytest.approx(fit.residual_square, rel=1e-12)
    weights = np.linspace(1.0, 3.0, t.size)
    weighted = palpate.fit_hold(t, y, weights=weights)
    assert weighted.weights is not None
    np.testing.assert_allclose(weighted.weights, weights, rtol=1e-15)
    table = fit.to_arrow()
    assert table.keys() == ["time_s", "signal", "best_fit", "residual"] and len(table) == len(fit) == 400
    assert fit != palpate.fit_hold(t + 3.0, np.where(t == 0, y + 1e-16, y))


def test_criteria_are_those_of_lmfit() -> None:
    t, y = relaxation(noise=1e-3)
    model = lmfit.Model(lambda x, a, b, c: a + b * np.exp(-x / c))
    result: Any = model.fit(y, x=t, a=0.2, b=0.1, c=5.0)
    fit = palpate.fit_hold(t, y, law="standard-linear-solid")
    assert (fit.aic, fit.bic) == pytest.approx((result.aic, result.bic), rel=1e-9)


def test_a_number_is_predicted_as_a_number() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t + 3.0, y)
    times: list[Any] = [23, 23.0, np.float64(23.0), np.array(23.0)]
    for time in times:
        value: Any = fit.predict(time)
        assert type(value) is float and value == fit.predict([23.0])[0]
    assert fit.predict(elapsed_s=20.0) == fit.predict(23.0)
    band = fit.predict(23.0, interval=0.9)
    assert band == tuple(float(end[0]) for end in fit.predict([23.0], interval=0.9))
    with pytest.raises(palpate.OptionError, match=r"predict\(time_s\): expected a column of numbers, found str '23'"):
        fit.predict("23")


def test_a_fit_can_be_kept_sent_and_compared() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t, y)
    for twin in (pickle.loads(pickle.dumps(fit)), copy.copy(fit), copy.deepcopy(fit)):
        assert twin == fit and twin.to_dict() == fit.to_dict()
    assert fit != palpate.fit_hold(t, y, law="latency:5")
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        [far] = pool.starmap(palpate.fit_hold, [(t, y)])
    assert far == fit


def test_the_report_is_that_of_lmfit() -> None:
    t, y = relaxation(noise=1e-4)
    text = palpate.fit_hold(t, y).report()
    for part in ("[[Model]]\n    latency", "[[Fit Statistics]]", "[[Variables]]", "[[Correlations]]", "+/-"):
        assert part in text
    assert "C(equilibrium, exponent) = -0.99" in text


def test_numbers_can_be_held_and_bounded() -> None:
    t, y = relaxation(noise=1e-4)
    held = palpate.fit_hold(t, y, fixed={"exponent": 3})
    assert held.estimates["exponent"].value == 3.0 and held.estimates["exponent"].standard_error is None
    bounded = palpate.fit_hold(t, y, bounds={"exponent": (1.5, 4.0)})
    assert bounded.parameters["exponent"] <= 4.0 and not bounded.is_good
    assert bounded.covariance is None


def test_what_is_held_is_held_or_refused() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t, y, fixed={"equilibrium": 0.15})
    assert fit.parameters["equilibrium"] == 0.15 and fit.estimates["equilibrium"].standard_error is None
    assert "equilibrium" not in fit.searched
    assert palpate.fit_many(t, [y], fixed={"equilibrium": 0.15})["equilibrium"].tolist() == [0.15]
    for fixed in ({"amplitude": 0.1}, {"equilibrium": np.nan}, {"exponent": np.inf}, {"foo": 1}):
        for fitted in (lambda f: palpate.fit_hold(t, y, fixed=f), lambda f: palpate.fit_many(t, [y], fixed=f)):
            with pytest.raises(palpate.OptionError):
                fitted(fixed)
    with pytest.raises(palpate.OptionError, match="only equilibrium, relative_rate_per_s, exponent; give it bounds"):
        palpate.fit_hold(t, y, fixed={"amplitude": 0.1})


def test_bounds_may_be_lists_and_open() -> None:
    t, y = relaxation(noise=1e-4)
    free = palpate.fit_hold(t, y).parameters["exponent"]
    for pair in ([1, 10], (None, 10), (1, None), (None, None)):
        assert palpate.fit_hold(t, y, bounds={"exponent": pair}).parameters["exponent"] == pytest.approx(free, rel=1e-6)


def test_intervals_and_samples_end_at_bounds() -> None:
    """Intervals reached beyond bounds, and so did one of two samples."""
    t = np.linspace(0.0, 40.0, 400)
    signal = 1 + 2 * np.exp(-t / 8) + np.random.default_rng(0).normal(0.0, 0.01, 400)
    free = palpate.fit_hold(t, signal, law="standard-linear-solid")
    estimate = free.estimates["equilibrium"]
    assert estimate.standard_error is not None and estimate.interval is not None
    low, high = estimate.value - 0.5 * estimate.standard_error, estimate.value + estimate.standard_error
    fit = palpate.fit_hold(t, signal, law="standard-linear-solid", bounds={"equilibrium": (low, high), "time_constant_s": (1.0, None)})
    assert fit.bounds == {"equilibrium": (low, high), "time_constant_s": (1.0, None)} and free.bounds == {}
    assert fit.estimates["equilibrium"].interval == (low, high)
    assert fit.estimates["time_constant_s"].interval == pytest.approx(free.estimates["time_constant_s"].interval)
    draws = fit.sample(5000, seed=1)["equilibrium"]
    assert draws.size == 5000 and low <= draws.min() < draws.max() <= high
    assert draws.std() < 0.5 * estimate.standard_error
    assert pickle.loads(pickle.dumps(fit)) == fit and fit != free
    table = palpate.fit_many(t, [signal], law="standard-linear-solid", bounds={"equilibrium": (low, high)})
    assert (table["equilibrium_low"][0], table["equilibrium_high"][0]) == (low, high)
    tight = palpate.fit_hold(t, signal, law="standard-linear-solid", bounds={"equilibrium": (estimate.value - 1e-9, estimate.value + 1e-9)})
    with pytest.raises(palpate.FitError, match="expected bounds that hold more than one in 1000 sets"):
        tight.sample(10)


def test_the_limit_of_a_law_has_the_interval_of_its_equilibrium() -> None:
    """Its interval was NaN."""
    t = np.linspace(0.0, 40.0, 400)
    signal = 1 + 2 * np.exp(-t / 8) + np.random.default_rng(0).normal(0.0, 0.01, 400)
    fractional = palpate.fit_hold(t, signal, law="fractional-zener")
    assert fractional.predict(np.inf) == fractional.parameters["equilibrium"]
    for law in ("standard-linear-solid", "stretched", "diffusion", "latency:3"):
        fit = palpate.fit_hold(t, signal, law=law, intervals="curvature")
        equilibrium = fit.estimates["equilibrium"]
        assert fit.predict(np.inf) == equilibrium.value
        value, low, high = fit.predict(np.inf, interval=0.95)
        assert (value, low, high) == pytest.approx((equilibrium.value, *(equilibrium.interval or ())), rel=1e-9)
    growing = palpate.fit_hold(t, signal, law="logarithmic")
    with pytest.raises(palpate.OptionError, match="predict: expected finite times of logarithmic, which has no limit, found inf"):
        growing.predict([1.0, np.inf])


def test_an_estimate_is_formatted_with_its_error() -> None:
    """A format was a TypeError."""
    estimate = palpate.fit_hold(*relaxation(noise=1e-3), fixed={"exponent": 5}).estimates
    one = estimate["equilibrium"]
    assert f"{one:.3f}" == f"{one.value:.3f} ± {one.standard_error:.3f}" and f"{one}" == str(one) == repr(one)
    assert f"{estimate['exponent']:.2f}" == "5.00"
    # Numbers were padded one by one.
    assert f"{one:>20.2f}" == f"{one:.2f}".rjust(20) and f"{one:<20.2f}" == f"{one:.2f}".ljust(20)
    assert f"{one:+.2f}" == f"+{one:.2f}"
    with pytest.raises(ValueError, match="format"):
        f"{one:x}"


def test_what_is_held_outside_of_its_bounds_is_refused() -> None:
    """It was held there, and ``bounds`` of the fit were a lie."""
    t, y = relaxation(noise=1e-3)
    message = "exponent cannot be fixed at 5, outside of its bounds, 1 to 3; give one of both"
    wrong: Any = {"fixed": {"exponent": 5}, "bounds": {"exponent": (1, 3)}}
    for fit in (lambda: palpate.fit_hold(t, y, **wrong), lambda: palpate.fit_many(t, [y], **wrong)):
        with pytest.raises(palpate.OptionError, match=message):
            fit()


def test_a_fit_as_objects_has_its_bounds_and_what_was_held() -> None:
    t, y = relaxation(noise=1e-3)
    fit = palpate.fit_hold(t, y, fixed={"exponent": 5}, bounds={"equilibrium": (0.0, None), "exponent": (1, 10)})
    found = fit.to_dict()
    assert found["bounds"] == {"equilibrium": [0.0, None], "exponent": [1.0, 10.0]} and found["fixed"] == fit.fixed == {"exponent": 5.0}
    assert json.loads(json.dumps(found)) == found
    again = pickle.loads(pickle.dumps(fit))
    assert again == fit and again.to_dict() == found
    free = palpate.fit_hold(t, y)
    assert free.to_dict()["bounds"] == free.to_dict()["fixed"] == free.fixed == {}


def test_residuals_of_no_noise_are_stated_with_the_fit() -> None:
    """Only an analysis stated it; the intervals of a fit may then be too narrow."""
    t = np.linspace(0.0, 40.0, 400)
    noise = np.random.default_rng(0).normal(0.0, 0.01, 400)
    good = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8) + noise, law="standard-linear-solid")
    poor = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8) + 0.02 * np.sin(3 * t) + 0.1 * noise, law="standard-linear-solid")
    assert good.noise_p_value is not None and good.noise_p_value > 1e-3 and poor.noise_p_value is not None and poor.noise_p_value < 1e-3
    sentence = f"no noise model describes the residuals of standard-linear-solid: the closest is {poor.noise}, p "
    texts = (lambda fit: repr(fit), lambda fit: str(fit), palpate.Fit.summary, palpate.Fit._repr_html_, palpate.Fit.report)
    for text in texts:
        shown = text(poor).replace("&lt;", "<")
        assert sentence in shown and "no noise model" not in text(good)
        assert ("the intervals may be too narrow" in shown) == (text(poor) != repr(poor))


def test_numbered_terms_keep_their_bounds() -> None:
    """``amplitude_1`` between 0 and 0.5 was 0.98 with an interval from 0.95 to 0.5, and the fit was good."""
    t = np.linspace(0.0, 40.0, 400)
    y = 1 + np.exp(-t / 2) + 0.3 * np.exp(-t / 25) + np.random.default_rng(0).normal(0.0, 0.02, t.size)
    fit = palpate.fit_hold(t, y, law="prony:2", bounds={"amplitude_1": (0, 0.5)})
    interval = fit.estimates["amplitude_1"].interval
    assert fit.is_good and interval is not None and 0 < interval[0] < fit.parameters["amplitude_1"] < interval[1] < 0.5
    assert fit.rmse == pytest.approx(palpate.fit_hold(t, y, law="prony:2").rmse, rel=1e-9)
    assert np.all(np.asarray(fit.sample(50)["amplitude_1"]) <= 0.5)


def test_intervals_rest_on_what_was_requested_for() -> None:
    # The law is the one that made the data and the noise is white: all three methods must agree.
    t = np.linspace(0.0, 10.0, 400)
    y = 0.2 + 0.1 * np.exp(-t / 2.0) + np.random.default_rng(3).normal(0.0, 1e-3, t.size)
    plain = palpate.fit_hold(t, y, law="standard-linear-solid")
    usual = plain.estimates["time_constant_s"].interval
    assert usual is not None
    for intervals in ("profile", "bootstrap"):
        fit = palpate.fit_hold(t, y, law="standard-linear-solid", intervals=intervals)
        assert fit.parameters == plain.parameters
        found = fit.estimates["time_constant_s"].interval
        assert found is not None
        assert (found[1] - found[0]) / (usual[1] - usual[0]) == pytest.approx(1.0, rel=0.15)


@pytest.mark.parametrize(
    ("keyword", "value", "reported"),
    [
        ("law", None, "law: expected a word, found None"),
        ("fixed", {"exponent": "4"}, "fixed\\[\"exponent\"\\]: expected a number, found '4'"),
        ("fixed", [("exponent", 4)], "fixed: expected numbers by name, such as"),
        ("bounds", {"exponent": 4}, "expected a lower and an upper end, found 4"),
        ("bounds", {"exponent": (3, 1)}, "bounds of exponent must rise"),
        ("bounds", {"exponent": (1, "x")}, "expected a number, found 'x'"),
        ("confidence", "x", "confidence: expected a number, found 'x'"),
        ("confidence", 95, "confidence must lie between 0 and 1, found 95"),
        ("log_spaced", -1, "log_spaced: expected a number of samples, found -1"),
        ("log_spaced", 5.5, "log_spaced: expected a number of samples, found 5.5"),
        ("noise", "pink", "noise is one of"),
        ("intervals", "guess", "intervals is one of"),
    ],
)
def test_a_wrong_option_is_an_option_error_that_names_it(keyword: str, value: object, reported: str) -> None:
    t, y = relaxation(noise=1e-4)
    arguments: dict[str, Any] = {keyword: value}
    with pytest.raises(palpate.OptionError, match=reported):
        palpate.fit_hold(t, y, **arguments)
    with pytest.raises(palpate.OptionError, match=reported):
        palpate.fit_many(t, [y], **arguments)


def test_a_sample_that_is_no_number_is_reported_with_its_column() -> None:
    t, y = relaxation()
    spoiled = np.where(np.arange(t.size) == 5, np.nan, y)
    with pytest.raises(palpate.FitError, match="the value of sample 5 must be a finite number, found NaN"):
        palpate.fit_hold(t, spoiled)
    with pytest.raises(palpate.FitError, match="the time of sample 5 must be a finite number, found inf"):
        palpate.fit_hold(np.where(np.arange(t.size) == 5, np.inf, t), y)
    with pytest.raises(palpate.OptionError, match="weights: expected 1/σ, finite and 0 or more, found inf at index 5"):
        palpate.fit_hold(t, y, weights=np.where(np.arange(t.size) == 5, np.inf, 1.0))


def test_there_is_no_signal_at_a_time_that_is_none() -> None:
    t, y = relaxation(noise=1e-4)
    fit = palpate.fit_hold(t, y)
    at = np.array([np.nan, -1.0, 0.0])
    assert np.isnan(fit.predict(at)[0]) and fit.predict(at)[1] == fit.predict(at)[2]
    assert all(np.isnan(column[0]) and np.isfinite(column[1:]).all() for column in fit.predict(at, interval=0.9))
    for name in ("latency", "maxwell", "standard-linear-solid", "prony:2", "stretched", "power", "logarithmic"):
        law = palpate.laws.function(name)
        count = {"latency": 4, "maxwell": 2, "prony:2": 5, "stretched": 4}.get(name, 3)
        numbers = [0.5] * count
        assert np.isnan(law(at, *numbers)[0]) and law(at, *numbers)[1] == law(at, *numbers)[2]


@settings(max_examples=40, deadline=None)
@given(
    exponent=st.floats(1.2, 9.0),
    rate=st.floats(0.05, 5.0),
    equilibrium=st.floats(-2.0, 2.0),
    amplitude=st.floats(0.05, 5.0),
    unit=st.sampled_from([1e-9, 1.0, 1e6]),
)
def test_any_law_is_found_in_any_unit(
    exponent: float, rate: float, equilibrium: float, amplitude: float, unit: float
) -> None:
    t = np.linspace(0.0, 60.0, 300)
    y = unit * palpate.laws.latency(t, equilibrium, amplitude, rate, exponent)
    fit = palpate.fit_hold(t, y)
    assert fit.parameters["exponent"] == pytest.approx(exponent, rel=1e-3)
    assert np.max(np.abs(fit.predict(t) - y)) < 1e-7 * unit * amplitude


@pytest.mark.parametrize("count", [0, 1, 2])
def test_what_is_too_short_to_compare_is_refused(count: int) -> None:
    with pytest.raises(palpate.FitError, match=f"samples or more, found {count}"):
        palpate.compare(np.arange(count, dtype=float), np.arange(count, dtype=float))
