"""What results have besides their numbers: tables of other libraries, figures, text, samples of parameters."""

from __future__ import annotations

import copy
import pickle
import re
import subprocess
import sys
import warnings
from typing import Any

import arviz_base
import matplotlib
import numpy as np
import palpate
import pandas
import polars
import pytest
import xarray
from conftest import ROOT, relaxation

matplotlib.use("Agg")
from matplotlib import pyplot

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")

T, Y = relaxation(noise=1e-3)
BALL = ROOT / "examples/records/ball.csv", ROOT / "examples/records/ball.toml"
STEPS = [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}]


def results() -> dict[str, Any]:
    record = palpate.read(BALL[0], test=BALL[1])
    material = palpate.Material.read(ROOT / "examples/records/ball-material.toml")
    return {
        "Record": record,
        "Fit": palpate.fit_hold(T, Y),
        "Comparison": palpate.compare(T, Y, laws=["latency", "maxwell", "standard-linear-solid"]),
        "RecordComparison": record.compare(laws=["latency", "maxwell"]),
        "Analysis": record.analyze(compare=False),
        "Calibration": record.calibrate(alternatives=[]),
        "Prediction": material.predict(STEPS),
        "Trajectory": material.predict(STEPS).trajectory,
        "Grip": material.grip(mass_kg=0.25, friction=0.6),
        "Table": palpate.fit_many([T, T[:3]], [Y, Y[:3]]),
    }


with warnings.catch_warnings():
    # The example goes beyond its test.
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    RESULTS = results()
DRAWN = [name for name in RESULTS if name != "Table"]


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_a_table_for_every_library(name: str) -> None:
    result = RESULTS[name]
    table = result if name == "Table" else result.to_arrow()
    assert len(table) > 0
    frame, polar, dataset = result.to_pandas(), result.to_polars(), result.to_xarray()
    assert isinstance(frame, pandas.DataFrame) and isinstance(polar, polars.DataFrame) and isinstance(dataset, xarray.Dataset)
    assert list(frame.columns) == polar.columns == table.column_names and len(frame) == len(polar) == len(table)
    assert set(dataset.variables) >= set(table.column_names)
    for column in table.column_names:
        if isinstance(table[column], np.ndarray):
            np.testing.assert_array_equal(frame[column].to_numpy(float), table[column])
            np.testing.assert_array_equal(dataset[column].to_numpy().astype(float), table[column])
        else:
            # What is missing among texts is NaN in xarray.
            missing = [None if value != value else value for value in dataset[column].to_numpy().tolist()]
            assert polar[column].to_list() == table[column] == missing


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_goes_into_plain_objects_and_back_from_a_pickle(name: str) -> None:
    result = RESULTS[name]
    assert isinstance(result.to_dict(), dict) and result.to_dict()
    for twin in (pickle.loads(pickle.dumps(result)), copy.copy(result), copy.deepcopy(result)):
        assert twin == result


def test_an_empty_table_keeps_its_columns_in_pandas() -> None:
    none = palpate.fit_many([], [])
    assert list(none.to_pandas().columns) == none.column_names and len(none.to_pandas()) == 0


def test_dimensions_and_units_of_a_dataset() -> None:
    record = RESULTS["Record"].to_xarray()
    assert dict(record.sizes) == {"time_s": len(RESULTS["Record"])} and record["force_n"].attrs == {"units": "N"}
    assert dict(RESULTS["Comparison"].to_xarray().sizes) == {"law": 3}
    assert list(RESULTS["Grip"].to_xarray().sizes) == ["row"]
    protocol = {"specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}, "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"}, "step": STEPS}
    runs = palpate.simulate_many(protocol, {"specimen.radius": [0.03, 0.035]}, times_s=[0.6, 10.6]).to_xarray()
    assert runs["force_n"].shape == (2, 2)
    assert np.stack(list(palpate.simulate_many(protocol, {"specimen.radius": [0.03, 0.035]}, times_s=[0.6, 10.6]).to_pandas()["force_n"])).shape == (2, 2)


def test_the_table_of_a_grip_has_all_courses() -> None:
    grip = RESULTS["Grip"]
    table = grip.to_arrow()
    assert grip.squeeze is not None and grip.squeeze.course is not None
    rows = np.array(table["grip"]) == "squeeze"
    np.testing.assert_array_equal(table["force_n"][rows], grip.squeeze.course.force_n)
    assert list(dict.fromkeys(table["grip"])) == ["squeeze", "back_off", "force_held"]


@pytest.mark.parametrize("name", DRAWN)
def test_a_result_draws_itself(name: str) -> None:
    result = RESULTS[name]
    own = result.plot()
    figure, given = pyplot.subplots()
    assert result.plot(given) is given and own is not given
    assert own.get_xlabel() and (own.lines or own.patches)
    figure.canvas.draw()
    own.figure.canvas.draw()
    pyplot.close("all")


def test_no_grip_is_an_empty_table_and_figure() -> None:
    material = palpate.Material.read(ROOT / "examples/records/ball-material.toml")
    refused = material.grip(mass_kg=50.0, friction=0.1)
    assert set(refused.refused) >= {"squeeze"} and refused.squeeze is None
    assert len(refused.to_arrow()) == len(refused.to_pandas()) == 0 and len(refused.plot().lines) == 0
    assert "2451.6625 N are needed" in " ".join(refused.summary().split())
    pyplot.close("all")


def test_a_comparison_keeps_its_samples() -> None:
    comparison = RESULTS["Comparison"]
    assert np.array_equal(comparison.time_s, T) and np.array_equal(comparison.signal, Y)
    assert comparison != palpate.compare(T, Y + 1.0, laws=["latency", "maxwell", "standard-linear-solid"])


def test_a_comparison_of_a_record_states_its_law() -> None:
    """Its law and its sentence stood in its document alone."""
    comparison = RESULTS["RecordComparison"]
    [record] = comparison.to_dict()["records"]
    assert comparison.law == record["answer"]["law"] == "latency" and comparison.sentence == record["answer"]["sentence"]
    assert comparison.sentence in repr(comparison)
    holds = comparison.holds
    assert holds["hold"].tolist() == [hold["index"] for hold in record["holds"]] == [1, 2, 3, 4, 5] and set(holds["law"]) <= {"latency", "maxwell"}
    assert holds["certainty"] == [hold["comparison"]["verdict"]["certainty"] for hold in record["holds"]]
    ax = comparison.plot()
    scores = {law: [row["forward_score"] for row in comparison.laws if row["law"] == law] for law in ("latency", "maxwell")}
    assert [bar.get_width() for bar in ax.patches] == sorted(np.median(found) for found in scores.values())
    assert sorted(ax.lines[0].get_xdata()) == sorted(sum(scores.values(), []))
    pyplot.close("all")


def test_open_ends_of_intervals_are_infinite_in_a_table_of_parameters() -> None:
    """They were NaN, as where there is no interval."""
    t = np.linspace(0.0, 60.0, 600)
    force = np.where(t < 10.0, 0.3 * t, 1 + 2 * np.exp(-(t - 10.0) / 40)) + np.random.default_rng(0).normal(0.0, 0.1, 600)
    record = palpate.Record.from_arrays(time_s=t, force_n=force, displacement_m=np.minimum(t, 10.0) * 1e-3)
    analysis = record.analyze(intervals="profile", exponents=[1.0, 2.0], compare=False)
    rows = [row for row in analysis.parameter_table if row["role"] == "estimated" and row["domain"] == "time"]
    rows = [row for row in rows if np.isfinite(row["value"] or np.nan)]
    assert any(row["high"] == np.inf for row in rows)
    for row in rows:
        estimate = analysis.fit(1, law=row["law"]).estimates[row["parameter"]]
        assert estimate.interval is None or (row["low"], row["high"]) == pytest.approx(estimate.interval)
    for frame in (analysis.parameter_table.to_pandas(), analysis.parameter_table.to_polars().to_pandas()):
        given = frame[frame["role"] == "given"]
        assert np.isinf(frame["high"].to_numpy(dtype=float)).any()
        assert len(given) > 0
        assert np.isnan(given["high"].to_numpy(dtype=float)).all()
    # Documents and files have no word for infinity.
    assert "Infinity" not in analysis.to_json()


def test_a_hold_of_an_analysis_is_a_fit() -> None:
    """From the holds of an analysis no way led to a Fit with its samples."""
    analysis = RESULTS["Analysis"]
    for index, hold in enumerate(analysis.holds):
        fit = analysis.fit(hold["index"])
        assert fit.law == f"latency:{hold['preferred_exponent']:g}" and fit.start_s == hold["fit_start_s"] == fit.time_s[0]
        [row] = [row for row in analysis.fits if (row["hold"], row["law"], row["domain"]) == (index + 1, fit.law, "time")]
        assert fit.parameters["equilibrium"] == row["equilibrium"] and fit.rmse == row["rmse"]
        np.testing.assert_allclose(fit.residual, fit.signal - fit.predict(fit.time_s))
        again = palpate.fit_hold(fit.time_s, fit.signal, law=fit.law)
        assert again.parameters["equilibrium"] == pytest.approx(fit.parameters["equilibrium"], rel=1e-6)
    assert analysis.fit(law="latency:2").law == "latency:2" and pickle.loads(pickle.dumps(analysis)).fit() == analysis.fit()
    wrong: Any
    for wrong in (0, -1, 6, 1.5, 1.0, "1", True, None, [1]):
        message = re.escape(f"hold: expected a whole number from 1 to 5, found {wrong!r}\nhint:")
        with pytest.raises(palpate.OptionError, match=message):
            analysis.fit(wrong)
    assert analysis.fit(np.int64(2)) == analysis.fit(2)
    with pytest.raises(palpate.OptionError, match=r'law: expected one that was fitted to hold 1 \(latency, .*\), found "maxwell"\nhint:'):
        analysis.fit(law="maxwell")
    ax = analysis.plot(color="red")
    laws = [analysis.fit(hold).law for hold in range(1, 6)]
    # An entry of the legend for each law, however many holds have it.
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["measured", *dict.fromkeys(laws)]
    assert [line.get_label().lstrip("_") for line in ax.lines] == ["measured", *laws]
    measured, first = ax.lines[:2]
    at = np.searchsorted(measured.get_xdata(), first.get_xdata())
    np.testing.assert_allclose(first.get_ydata(), measured.get_ydata()[at], atol=0.05 * measured.get_ydata().max())
    pyplot.close("all")


def test_figures_show_the_numbers() -> None:
    fit, trajectory = RESULTS["Fit"], RESULTS["Trajectory"]
    ax = fit.plot(interval=0.9, color="red")
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), Y)
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), fit.best_fit)
    assert ax.lines[1].get_color() == "red" and len(ax.collections) == 1
    loop = trajectory.plot(x="displacement_m", y="force_n")
    np.testing.assert_array_equal(loop.lines[0].get_xdata(), trajectory.displacement_m)
    assert (loop.get_xlabel(), loop.get_ylabel()) == ("Displacement (m)", "Force (N)")
    with pytest.raises(palpate.OptionError, match="expected one of the series time_s, .*, found 'nothing'"):
        trajectory.plot(y="nothing")
    pyplot.close("all")


def test_a_library_that_is_missing_is_named() -> None:
    script = "import sys\nfor name in ('matplotlib.pyplot', 'pandas'): sys.modules[name] = None\nimport palpate\nrecord = palpate.Record.from_arrays(time_s=[0, 1, 2], force_n=[0, 1, 2])\n"
    for call, library in (("plot", "matplotlib.pyplot"), ("to_pandas", "pandas")):
        ran = subprocess.run([sys.executable, "-c", f"{script}record.{call}()"], capture_output=True, text=True)
        assert f"ImportError: {call} needs {library}, which is not installed" in ran.stderr
    loaded = subprocess.run([sys.executable, "-c", "import palpate, sys\nprint(*sorted(sys.modules))"], capture_output=True, text=True, check=True)
    assert not {"pandas", "polars", "xarray", "matplotlib", "arviz_base", "pint"} & set(loaded.stdout.split())


@pytest.mark.parametrize("name", [name for name in RESULTS if name != "Table"])
def test_a_result_sums_itself_up(name: str) -> None:
    text = RESULTS[name].summary()
    assert text.endswith("\n") and "nan" not in text and len(text.splitlines()) > 1


def test_a_summary_has_the_numbers() -> None:
    fit, record = RESULTS["Fit"], RESULTS["Record"]
    [row] = [line.split() for line in fit.summary().splitlines() if line.startswith("exponent ")]
    assert row[1] == f"{fit.parameters['exponent']:.6g}" and row[-1] == "1"
    [row] = [line.split() for line in record.summary().splitlines() if line.startswith("force_n ")]
    assert row[-1] == f"{record.force_n.max():.6g}"
    assert fit.law in fit.summary() and record.title in record.summary()


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_shows_a_result(name: str) -> None:
    page = RESULTS[name]._repr_html_()
    assert page.startswith("<") and page.endswith(">")
    if name == "RecordComparison":
        assert RESULTS[name].sentence in page and "<td>maxwell</td>" in page
    if name in ("Record", "Fit", "Comparison", "Trajectory"):
        cells = [line.split()[0] for line in RESULTS[name].summary().splitlines()[2:] if line.strip()]
        assert cells and all(f"<td>{cell}</td>" in page for cell in cells)


def test_a_title_is_no_markup() -> None:
    record = palpate.Record.from_arrays(time_s=[0, 1, 2], force_n=[0, 1, 2], title="<b>")
    assert "<b>" not in record._repr_html_() and "&lt;b&gt;" in record._repr_html_()


def test_samples_have_the_covariance_in_the_scales_searched() -> None:
    fit = RESULTS["Fit"]
    draws = fit.sample(200_000, seed=2)
    assert list(draws) == list(fit.parameters)
    searched = np.array([np.log(draws["relative_rate_per_s"]) if name.startswith("ln") else draws[name] for name in fit.searched])
    centre = [np.log(fit.parameters["relative_rate_per_s"]) if name.startswith("ln") else fit.parameters[name] for name in fit.searched]
    errors = np.sqrt(np.diag(fit.covariance))
    np.testing.assert_allclose((searched.mean(axis=1) - centre) / errors, 0.0, atol=0.01)
    np.testing.assert_allclose(np.corrcoef(searched), fit.correlation, atol=0.01)
    # Draws are of every model of the noise; an improbable wide one widens their variance, and no standard error.
    ratio = searched.std(axis=1) / errors
    assert np.all((ratio > 0.99) & (ratio < 1.05)), ratio
    assert np.array_equal(fit.sample(5, seed=3)["exponent"], fit.sample(5, seed=3)["exponent"])


def test_samples_of_times_are_positive_and_held_parameters_stay() -> None:
    fit = palpate.fit_hold(T, Y, law="prony:2", fixed={"equilibrium": 0.2})
    draws = fit.sample(5000, seed=1)
    assert np.all(draws["time_constant_1_s"] > 0) and np.all(draws["equilibrium"] == 0.2)
    estimate = fit.estimates["time_constant_1_s"]
    assert estimate.standard_error is not None
    spread = np.log(draws["time_constant_1_s"]).std()
    assert spread == pytest.approx(estimate.standard_error / estimate.value, rel=0.1)


@pytest.mark.parametrize("memory", [0.0, 0.6])
def test_draws_have_the_quantiles_of_the_intervals(memory: float) -> None:
    """They were normal with the mean covariance: where one model of little probability has a long memory, wider than the intervals."""
    beyond = []
    for seed in range(12):
        noise = np.random.default_rng(seed).normal(0.0, 0.01, T.size)
        for index in range(1, T.size):
            noise[index] += memory * noise[index - 1]
        signal = 1 + 2 * np.exp(-T / 8) + noise
        fit = palpate.fit_hold(T, signal, law="standard-linear-solid", intervals="curvature")
        draws = fit.sample(20_000, seed=seed)
        intervals = {name: fit.estimates[name].interval for name in draws}
        beyond.append([[np.mean(draws[name] < low), np.mean(draws[name] > high)] for name, (low, high) in intervals.items()])  # type: ignore[misc]
    # The share beyond an end has the error sqrt(0.025 * 0.975/20000) = 0.0011, the mean of 12 a third of it.
    np.testing.assert_allclose(beyond, 0.025, atol=0.005)
    np.testing.assert_allclose(np.mean(beyond, axis=0), 0.025, atol=0.0015)


def test_draws_of_few_samples_are_those_of_student() -> None:
    times = np.linspace(0.0, 40.0, 7)
    fit = palpate.fit_hold(times, 1 + 2 * np.exp(-times / 8) + np.array([1, -2, 2, 0, -1, 1, -1]) * 1e-3, law="standard-linear-solid", noise="white")
    low, high = fit.estimates["equilibrium"].interval or (0.0, 0.0)
    draws = fit.sample(100_000, seed=1)["equilibrium"]
    assert np.mean((draws < low) | (draws > high)) == pytest.approx(0.05, abs=0.003)


def test_no_samples_without_a_covariance() -> None:
    fit = palpate.fit_hold(T, 1 + 2 * np.exp(-T / 8), law="prony:3")
    assert fit.covariance is None
    with pytest.raises(palpate.FitError, match="a fit with a covariance"):
        fit.sample(3)
    for wrong in (0, -1, 2.5, True):
        with pytest.raises(palpate.OptionError, match="n: expected a number of sets, 1 or more"):
            RESULTS["Fit"].sample(wrong)
    for seed in (-1, "x", 1.5):
        with pytest.raises(palpate.OptionError, match=f"seed: expected a whole number, 0 or more, or None, found {seed!r}"):
            RESULTS["Fit"].sample(seed=seed)


def test_arviz_has_a_posterior() -> None:
    fit = palpate.fit_hold(T, Y, law="latency:5")
    tree = fit.to_arviz(500, chains=2, seed=1)
    assert isinstance(tree, xarray.DataTree)
    posterior = tree["posterior"].dataset
    assert dict(posterior.sizes) == {"chain": 2, "draw": 500} and "exponent" not in posterior
    assert float(posterior["equilibrium"].mean()) == pytest.approx(fit.parameters["equilibrium"], abs=fit.estimates["equilibrium"].standard_error)
    np.testing.assert_array_equal(tree["observed_data"]["signal"], Y)
    assert arviz_base.extract(tree).sizes["sample"] == 1000


def test_a_law_is_evaluated_with_other_parameters() -> None:
    fit = palpate.fit_hold(T + 3.0, Y)
    assert np.array_equal(fit.eval(), fit.best_fit) and fit.eval(13.0) == fit.predict(13.0)
    np.testing.assert_allclose(fit.eval(exponent=3.0), palpate.laws.latency(T, **{**fit.parameters, "exponent": 3.0}), rtol=1e-14)
    assert fit.eval(13.0, equilibrium=0.0) == pytest.approx(fit.eval(13.0) - fit.parameters["equilibrium"], rel=1e-12)
    with pytest.raises(palpate.OptionError, match=r"expected parameters of latency \(equilibrium, .*\), found time_constant_s"):
        fit.eval(time_constant_s=3.0)
    with pytest.raises(palpate.OptionError, match="exponent: expected a number, found '3'"):
        fit.eval(exponent="3")  # type: ignore[call-overload] # pyright: ignore


CLOSED = ["latency", "latency:5", "prony:1", "prony:2", "maxwell", "standard-linear-solid", "burgers", "stretched", "power", "logarithmic"]


@pytest.mark.parametrize(
    ("law", "response"), [*((law, word) for law in CLOSED for word in ("relaxation", "creep")), ("kelvin-voigt", "creep")]
)
def test_every_closed_law_is_evaluated_in_both_responses(law: str, response: Any) -> None:
    relaxed = 2.0 / (1.0 + 0.3 * T) ** 0.7
    fit = palpate.fit_hold(T + 3.0, relaxed if response == "relaxation" else 3.0 - relaxed, law=law, response=response)
    times = np.array([1.0, 3.0, 4.0, 13.0, 60.0])
    for name, found in fit.parameters.items():
        np.testing.assert_allclose(fit.eval(times, **{name: found}), fit.predict(times), rtol=1e-10, atol=1e-10)
    # What is linear adds up: half of each is half of the signal.
    halved = {name: found / 2 for name, found in fit.parameters.items() if fit.estimates[name].unit == "signal"}
    np.testing.assert_allclose(fit.eval(times, **halved), fit.predict(times) / 2, rtol=1e-10, atol=1e-10)
    # A time that is longer by a factor is a curve that is slower by it.
    slower = {name: 2 * found for name, found in fit.parameters.items() if fit.estimates[name].unit == "s"}
    if slower and law != "burgers":
        np.testing.assert_allclose(fit.eval(3.0 + 2 * T[:9], **slower), fit.predict(3.0 + T[:9]), rtol=1e-10, atol=1e-10)
