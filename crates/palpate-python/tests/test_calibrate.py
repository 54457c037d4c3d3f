"""One set of numbers for a whole record, and what it predicts."""

from __future__ import annotations

import copy
import csv
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import polars
import pytest
from conftest import ROOT

RECORD, TEST = ROOT / "examples/records/ball.csv", ROOT / "examples/records/ball.toml"
HOLD = ROOT / "examples/protocols/hold.toml"
SQUEEZE: list[dict[str, Any]] = [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}]


def command(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """The command that came with the package."""
    return subprocess.run([sys.executable, "-m", "palpate", *map(str, arguments)], capture_output=True, text=True, check=False)


def done(*arguments: str | Path) -> str:
    ran = command(*arguments)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


@pytest.fixture(scope="module")
def record() -> palpate.Record:
    return palpate.read(RECORD, test=TEST)


@pytest.fixture(scope="module")
def calibration(record: palpate.Record) -> palpate.Calibration:
    return record.calibrate(alternatives=["standard-linear-solid"])


@pytest.fixture(scope="module")
def material(calibration: palpate.Calibration) -> palpate.Material:
    return calibration.material


@pytest.mark.parametrize(
    ("flags", "keywords"),
    [
        (["--alternatives", "prony:2", "--fit-until", "61 s"], {"alternatives": ["prony:2"], "fit_until_s": 61.0}),
        (["--law", "latency:5", "--equilibrium", "table", "--no-alternatives"], {"law": "latency:5", "equilibrium": "table", "alternatives": []}),
        (
            ["--law", "standard-linear-solid", "--equilibrium", "hertz", "--poisson-ratio", "0.4", "--no-alternatives", "--confidence", "0.9"],
            {"law": "standard-linear-solid", "equilibrium": "hertz", "poisson_ratio": 0.4, "alternatives": [], "confidence": 0.9},
        ),
        (["--rate", "by-strain", "--no-alternatives"], {"rate": "by-strain", "alternatives": []}),
        (["--rate", "by-direction", "--alternatives", "prony:2"], {"rate": "by-direction", "alternatives": ["prony:2"]}),
        (["--profile", "--no-alternatives"], {"profile": True, "alternatives": []}),
    ],
    ids=["predicted", "table", "hertz", "by strain", "by direction", "profile"],
)
def test_a_calibration_is_that_of_the_command_line_to_the_last_bit(
    record: palpate.Record, flags: list[str], keywords: dict[str, Any], tmp_path: Path
) -> None:
    its, own = tmp_path / "its.toml", tmp_path / "own.toml"
    document = json.loads(done("calibrate", RECORD, "--test", TEST, "--out", its, "--format", "json", *flags))
    calibration = record.calibrate(**keywords)
    assert calibration.to_dict() == document == json.loads(calibration.to_json())
    calibration.material.write(own)
    assert own.read_bytes() == its.read_bytes() and own.read_text() == calibration.material.to_toml()
    assert palpate.Material.read(its) == calibration.material
    # What is there once more in an object of its own.
    remarks = [remark.replace("--fit-until", "fit_until_s") for remark in document["remarks"]]
    assert calibration.remarks == remarks and calibration.fitted == document["fitted"]
    laws = polars.DataFrame(calibration.laws)
    assert laws["law"].to_list() == [law["law"] for law in document["laws"]]
    assert laws["rmse_n"].to_list() == [law["rmse_n"] for law in document["laws"]]
    if "fit_until_s" in keywords:
        assert laws["holdout_rmse_n"].to_list() == [law["holdout"]["rmse_n"] for law in document["laws"]]
        assert calibration.sentence == "Of the laws tried, latency predicts the rest of the record best."


def test_its_text_is_that_of_the_command_line(calibration: palpate.Calibration) -> None:
    reported = done("calibrate", RECORD, "--test", TEST, "--alternatives", "standard-linear-solid")
    assert str(calibration) == calibration.report() == reported


def test_numbers_have_intervals_and_units(material: palpate.Material) -> None:
    truth = {"modulus_pa": 28e3, "exponent": 5.0, "rate_coefficient_per_s": 2e4, "layer_thickness_m": 0.035 / 8}
    units = {"modulus_pa": "Pa", "exponent": "1", "rate_coefficient_per_s": "1/s", "layer_thickness_m": "m"}
    estimates, numbers = material.estimates, polars.DataFrame(material.parameter_table)
    assert list(estimates) == list(material.parameters) == numbers["parameter"].to_list() == list(truth)
    assert numbers.columns == ["parameter", "unit", "value", "standard_error", "low", "high"]
    for row, (name, estimate) in zip(numbers.rows(), estimates.items(), strict=True):
        assert estimate.interval is not None and estimate.standard_error is not None
        assert row == (name, units[name], estimate.value, estimate.standard_error, *estimate.interval)
        assert abs(estimate.value - truth[name]) < 4.5 * estimate.standard_error and estimate.unit == units[name]
        assert pickle.loads(pickle.dumps(estimate)) == estimate
    covariance = material.log_covariance
    assert covariance is not None and material.confidence == 0.95
    relative = np.array(material.parameter_table["standard_error"]) / material.parameter_table["value"]
    # Errors are quantiles over the models of the noise: those of a combination follow from its parts to some 1e-4.
    np.testing.assert_allclose(np.sqrt(np.diag(covariance)), relative, rtol=1e-3)
    given = palpate.Material.read(ROOT / "examples/records/ball-material.toml")
    assert given.law == "latency" and given.equilibrium == "uniform-strain"
    assert given.calibration_range["longest_hold_s"] == pytest.approx(20.0) and given.calibration_range["deepest_m"] == pytest.approx(0.015, rel=1e-3)
    assert given.origin["record"] == "examples/records/ball.csv" and len(given.origin["sha256"]) == 64
    assert given.origin["samples"] == 2061 and given.noise_n == pytest.approx(0.05, rel=0.05)


def test_what_is_left_over_is_the_record_less_the_law(record: palpate.Record, calibration: palpate.Calibration) -> None:
    assert len(calibration) == len(record) == calibration.fitted and calibration.is_good
    assert np.array_equal(calibration.time_s, record.time_s)
    assert np.array_equal(calibration.residual_n, calibration.force_n - calibration.simulated_n)
    assert np.sqrt(np.mean(calibration.residual_n**2)) == pytest.approx(calibration.rmse_n, rel=1e-6)
    frame = polars.DataFrame(calibration)
    assert frame.columns == ["time_s", "displacement_m", "force_n", "simulated_n", "residual_n", "is_fitted"]
    assert frame["is_fitted"].all() and frame["residual_n"].to_list() == calibration.residual_n.tolist()
    half = record.calibrate(alternatives=[], fit_until_s=61.0)
    is_fitted = polars.DataFrame(half)["is_fitted"].to_numpy()
    assert np.array_equal(is_fitted, half.time_s <= 61.0) and is_fitted.sum() == half.fitted
    # The simulation of the calibration is one that anybody can make, but for the corners of the measured motion.
    state = palpate.ContactState(half.material)
    forces = [state.step(float(dt), float(to)) for dt, to in zip(np.diff(half.time_s), half.displacement_m[1:], strict=True)]
    assert np.max(np.abs(forces - half.simulated_n[1:])) < 0.02 * half.simulated_n.max()


def test_a_prediction_is_that_of_the_command_line_to_the_last_bit(material: palpate.Material, tmp_path: Path) -> None:
    path, out = tmp_path / "ball.toml", tmp_path / "force.csv"
    material.write(path)
    requested: list[tuple[list[str], dict[str, Any]]] = [
        (["--at", "60 s", "--at", "10 s"], {"at_s": [10.0, 60.0]}),
        (["--confidence", "0.8"], {"confidence": 0.8}),
    ]
    for flags, keywords in requested:
        done("predict", path, "--protocol", HOLD, "--out", out, *flags)
        with out.open() as file:
            rows = list(csv.DictReader(file))
        with pytest.warns(palpate.PalpateWarning, match="beyond the test: the longest hold lasts 60.0 s"):
            prediction = material.predict(HOLD, **keywords)
        frame = polars.DataFrame(prediction)
        assert [*frame.columns, "noise_n"] == list(rows[0]) and len(frame) == len(prediction) == len(rows)
        for name in frame.columns:
            assert [float(row[name]) for row in rows] == frame[name].to_list() == getattr(prediction, name).tolist()
        assert float(rows[0]["noise_n"]) == prediction.noise_n == material.noise_n
        assert prediction.confidence == keywords.get("confidence", 0.95)


def test_steps_of_a_prediction_are_a_list(material: palpate.Material) -> None:
    steps: list[Any] = [palpate.Step(to=0.005, rate=0.005), {"to": "5 mm", "rate": "5 mm/s"}, {"to_m": 0.005, "rate_m_per_s": 0.005}]
    for step in steps:
        with pytest.raises(palpate.OptionError, match="expected a protocol or a list of steps, found one step\nhint: put it into a list"):
            material.predict(step)
        assert len(material.predict([step])) > 1


def test_a_record_is_predicted_along_its_own_displacement(
    record: palpate.Record, calibration: palpate.Calibration, material: palpate.Material
) -> None:
    prediction = material.predict(record)
    assert prediction.extrapolations == []
    # The record it was calibrated on: the same motion, and the same force.
    assert np.array_equal(prediction.time_s, calibration.time_s)
    np.testing.assert_allclose(prediction.force_n, calibration.simulated_n, rtol=1e-9, atol=1e-9)
    within = (prediction.reading_low_n < calibration.force_n) & (calibration.force_n < prediction.reading_high_n)
    assert np.mean(within) == pytest.approx(0.95, abs=0.02)
    at = material.predict(record, at_s=[10.0, 20.0], confidence=0.5)
    assert at.time_s.tolist() == [10.0, 20.0] and at.confidence == 0.5
    # Its body is the material's: a description that says none serves as well.
    assert np.array_equal(material.predict(palpate.Record.from_arrays(
        time_s=record.time_s, force_n=record.force_n, displacement_m=record.displacement_m
    ), at_s=[10.0, 20.0]).time_s, at.time_s)
    with pytest.raises(palpate.RecordError, match="needs the displacement of the jaw"):
        material.predict(palpate.Record.from_arrays(time_s=record.time_s, force_n=record.force_n))
    with pytest.raises(palpate.ModelError, match="sample times must rise"):
        material.predict(record, at_s=[1e4])
    with pytest.raises(palpate.OptionError, match="confidence is a share between 0 and 1, found 1"):
        material.predict(record, confidence=1)


def test_intervals_lie_in_each_other(material: palpate.Material) -> None:
    prediction = material.predict(SQUEEZE, at_s=[0.6, 5.0])
    assert prediction.extrapolations == []
    columns = ["reading_low_n", "force_low_n", "force_n", "force_high_n", "reading_high_n"]
    assert np.all(np.diff([getattr(prediction, name) for name in columns], axis=0) > 0)
    assert np.array_equal(prediction.displacement_low_m, prediction.displacement_m)
    narrow = material.predict(SQUEEZE, at_s=[0.6, 5.0], confidence=0.5)
    assert np.all(narrow.force_high_n < prediction.force_high_n)
    half = (narrow.force_high_n - narrow.force_low_n) / 2
    # Neither side is nearer than the linear part, and a little curvature is left on one of them.
    over = half / 0.6745 / prediction.force_standard_error_n
    assert np.all((over > 0.9995) & (over < 1.003)), over
    # A force is a product of powers of its parameters, or nearly: more is left open above than below.
    above, below = prediction.force_high_n - prediction.force_n, prediction.force_n - prediction.force_low_n
    assert np.all((below < above) & (above < 1.1 * below))
    # Under a force it is the displacement that is open.
    with pytest.warns(palpate.PalpateWarning, match="the force is held, while the test held none"):
        pressed = material.predict([{"to_force": "2 N", "force_rate": "1 N/s", "hold_force": "5 s"}], at_s=[7.0])
    assert pressed.displacement_low_m < pressed.displacement_m < pressed.displacement_high_m
    assert pressed.force_n == pytest.approx(2.0) and len(pressed.extrapolations) == 1


def test_a_material_is_the_body_wherever_one_is_taken(material: palpate.Material, tmp_path: Path) -> None:
    path = tmp_path / "ball.toml"
    material.write(path)
    inside = material.predict({"step": SQUEEZE, "output": {"times": ["0.6 s", "5 s"]}})
    # A body in the protocol is left aside.
    other = {"specimen": {"shape": "ball", "radius": "1 m", "modulus": "1 Pa"}, "law": {"name": "latency", "exponent": 1, "rate_coefficient": "1 /s"}}
    assert material.predict({**other, "step": SQUEEZE}, at_s=[0.6, 5.0]) == inside
    protocol = {"step": SQUEEZE, "output": {"times": ["0.6 s", "5 s"]}}
    trajectory = palpate.simulate({"material": material, **protocol})
    assert trajectory == palpate.simulate({"material": str(path), **protocol}) == inside.trajectory
    named = tmp_path / "named.toml"
    named.write_text('material = "ball.toml"\n')
    for model in (material, path, named, {"material": material}, {"material": str(path)}):
        state = palpate.ContactState(model)
        # The file that a protocol names is looked for beside it, and need not be there where the state goes.
        assert state == palpate.ContactState(material) == pickle.loads(pickle.dumps(state))
    assert len(set(palpate.ContactStates([material, path]).step(0.1, 1e-3).tolist())) == 1
    runs = palpate.simulate_many({"material": material, **protocol}, {"law.exponent": [material.parameters["exponent"]]}, times_s=[5.0])
    assert runs["force_n"][0, 0] == pytest.approx(trajectory.force_n[1], rel=1e-12)
    with pytest.raises(palpate.OptionError, match="law: expected either this or material, found both"):
        palpate.simulate({"material": material, **protocol, "law": {}})


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_a_material_describes_the_body_of_a_record(material: palpate.Material) -> None:
    bare = palpate.read(RECORD)
    analysis = bare.analyze(test=material, compare=False)
    assert "modulus" in analysis.to_json() and analysis == palpate.read(RECORD, test=material).analyze(compare=False)
    again = bare.calibrate(test=material, alternatives=[]).material
    assert again.parameters["exponent"] == pytest.approx(material.parameters["exponent"], rel=1e-2)


@pytest.mark.parametrize("law", ["standard-linear-solid", "prony:2", "fung:2", "latency:5"])
def test_every_law_makes_a_material_that_can_be_kept(record: palpate.Record, law: str, tmp_path: Path) -> None:
    calibration = record.calibrate(law=law, alternatives=[])
    material = calibration.material
    assert material.law == law and calibration.sentence is None
    material.write(tmp_path / "material.toml")
    assert palpate.Material.read(tmp_path / "material.toml") == material
    force = palpate.simulate({"material": material, "step": SQUEEZE}).force_n
    assert np.array_equal(material.predict(SQUEEZE).force_n, force)
    if law == "latency:5":
        given = material.estimates["exponent"]
        assert given.value == 5.0 and given.standard_error is None and given.interval is None
        assert np.isnan(material.parameter_table["low"][1])
    else:
        with pytest.raises(palpate.ModelError, match="latency law alone"):
            palpate.ContactState(material)


@pytest.mark.parametrize(("rate", "factor"), [("by-strain", "strain_factor"), ("by-direction", "unloading_factor")])
def test_a_rate_coefficient_that_varies_is_one_more_number(record: palpate.Record, rate: str, factor: str, tmp_path: Path) -> None:
    calibration = record.calibrate(rate=rate, alternatives=["prony:2"])
    material = calibration.material
    low, high = material.estimates[factor].interval or (np.nan, np.nan)
    assert low < 1.0 < high  # the ball's coefficient is constant
    assert len(calibration.laws["law"]) == 4  # the other rates are alternatives, too
    material.write(tmp_path / "material.toml")
    assert palpate.Material.read(tmp_path / "material.toml") == material == pickle.loads(pickle.dumps(material))
    force = palpate.simulate({"material": material, "step": SQUEEZE}).force_n
    assert np.array_equal(material.predict(SQUEEZE).force_n, force)


def test_profile_intervals_stand_beside_the_others(record: palpate.Record) -> None:
    requested = record.calibrate(alternatives=[], profile=True)
    numbers = polars.DataFrame(requested.parameter_table)
    assert numbers["parameter"].to_list() == ["modulus_pa", "exponent", "rate_coefficient_per_s", "layer_thickness_m"]
    value, low, high = (numbers[name].to_numpy() for name in ("value", "profile_low", "profile_high"))
    assert (low < value).all() and (value < high).all()
    # The record tells all four: χ² is nearly a parabola of the logarithms, and both intervals nearly agree.
    for end in ("low", "high"):
        np.testing.assert_allclose(np.log(numbers[f"profile_{end}"] / value), np.log(numbers[end] / value), rtol=0.1)
    assert "Profile interval" in requested.report() and pickle.loads(pickle.dumps(requested)) == requested
    assert "profile_low" not in polars.DataFrame(record.calibrate(alternatives=[]).parameter_table).columns


def test_an_instrument_gives_budgets(record: palpate.Record) -> None:
    ball = {"shape": "ball", "radius": "35 mm"}
    instrument = {"force_gain": "1 %", "radius": {"standard": "0.1 mm", "type": "A", "freedom": 4}}
    test = {"specimen": ball, "contact": {"touch": "as recorded"}, "instrument": instrument}
    calibration = record.calibrate(test=test, alternatives=[])
    budgets = polars.DataFrame(calibration.budgets)
    modulus = budgets.filter(polars.col("parameter") == "modulus_pa")
    assert modulus["input"].to_list() == ["scatter of the samples", "gain of the force", "radius"]
    assert modulus["evaluation"].to_list() == ["A", "B", "A"]
    # E is proportional to the force: c u = E 0.01/√3.
    gain = modulus["contribution"][1] / modulus["value"][1]
    assert abs(gain - 0.01 / np.sqrt(3)) < 1e-6
    error = calibration.material.estimates["modulus_pa"].standard_error
    assert error is not None and abs(np.linalg.norm(modulus["contribution"].to_numpy()) / error - 1) < 1e-9
    assert calibration.to_dict()["laws"][0]["budgets"][0]["type_b_standard_uncertainty"] > 0
    material = calibration.material
    assert pickle.loads(pickle.dumps(material)) == material and "[[calibration.systematic]]" in material.to_toml()
    analysis = record.analyze(test=test)
    strains = polars.DataFrame(analysis.budgets).filter(polars.col("parameter") == "equilibrium")
    assert set(strains["hold"]) == {1, 2, 3, 4, 5} and (strains["combined_standard_uncertainty"].to_numpy() > 0).all()
    assert len(record.calibrate(alternatives=[]).budgets) == 0


def test_all_of_it_comes_back(calibration: palpate.Calibration, material: palpate.Material) -> None:
    prediction = material.predict(SQUEEZE)
    for thing in (calibration, material, prediction):
        for twin in (pickle.loads(pickle.dumps(thing)), copy.copy(thing), copy.deepcopy(thing)):
            assert twin == thing and repr(twin) == repr(thing)
            assert twin._repr_html_() == thing._repr_html_()
    assert str(pickle.loads(pickle.dumps(calibration))) == str(calibration)
    assert material != palpate.Material.read(ROOT / "examples/records/ball-material.toml")
    assert "<svg" in calibration._repr_html_() and "<svg" in prediction._repr_html_()
    assert "modulus" in material._repr_html_() and repr(material).startswith("<palpate.Material latency: modulus_pa=27989 [27973, 28005] Pa")


def test_a_number_that_is_left_open_is_a_warning(material: palpate.Material, tmp_path: Path) -> None:
    t = np.linspace(0, 20, 1000)
    force, displacement = 2 * np.minimum(t, 1) + 0.01 * np.sin(50 * t), 5e-3 * np.minimum(t, 1)
    elastic = palpate.Record.from_arrays(time_s=t, displacement_m=displacement, force_n=force)
    with pytest.warns(palpate.PalpateWarning, match="left a parameter open"):
        calibration = elastic.calibrate(law="prony:4", test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[])
    assert not calibration.is_good and calibration.material.log_covariance is None
    # Superfluous terms end on one another or at the edge of what is sought.
    assert calibration.remarks[0].startswith(("Terms of the series merged", "The search ended at a bound"))
    assert pickle.loads(pickle.dumps(calibration)) == calibration
    # As `palpate calibrate` writes one whose search ended at a bound.
    lines = material.to_toml().splitlines(keepends=True)
    left_out = ("confidence", "freedom", "covariance", "  [", "]", "standard_error", "interval")
    (tmp_path / "open.toml").write_text("".join(line for line in lines if not line.startswith(left_out)))
    bare = palpate.Material.read(tmp_path / "open.toml")
    assert bare.log_covariance is None and bare.confidence is None
    assert bare.estimates["modulus_pa"].interval is None and np.isnan(bare.parameter_table["low"]).all()
    with pytest.warns(palpate.PalpateWarning, match="left a parameter open: the intervals are not known"):
        prediction = bare.predict(SQUEEZE, at_s=[5.0])
    assert np.isnan([prediction.force_low_n, prediction.reading_high_n, prediction.force_standard_error_n]).all()
    assert prediction.force_n > 0 and ",," in prediction.to_csv() and "nan" not in prediction.to_csv().lower()
    assert pickle.loads(pickle.dumps(bare)) == bare


@pytest.mark.parametrize(
    ("flags", "keywords", "kind"),
    [
        (["--law", "power"], {"law": "power"}, palpate.OptionError),
        (["--fit-until", "200 s"], {"fit_until_s": 200.0}, palpate.OptionError),
        (["--equilibrium", "hertz", "--poisson-ratio", "0.7"], {"equilibrium": "hertz", "poisson_ratio": 0.7}, palpate.ModelError),
    ],
)
def test_what_cannot_be_calibrated_has_the_words_of_the_command_line(
    record: palpate.Record, flags: list[str], keywords: dict[str, Any], kind: type[Exception]
) -> None:
    with pytest.raises(kind) as caught:
        record.calibrate(alternatives=[], **keywords)
    reported = command("calibrate", RECORD, "--test", TEST, "--no-alternatives", *flags).stderr
    assert reported.strip() == f"error: {RECORD}: {caught.value}"


def test_a_record_without_a_body_or_without_a_motion_is_refused(record: palpate.Record) -> None:
    bare = palpate.read(RECORD)
    with pytest.raises(palpate.OptionError, match=r"needs the geometry of the body, which is not described\nhint: .*\[specimen\]"):
        bare.calibrate()
    assert bare.calibrate(test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[]).is_good
    still = palpate.Record.from_arrays(time_s=record.time_s, force_n=record.force_n)
    with pytest.raises(palpate.RecordError, match="needs the displacement of the jaw, which the record does not have"):
        still.calibrate(test=TEST)


def test_a_tip_on_a_gel_is_calibrated_by_the_law_of_its_description() -> None:
    tip = {"shape": "conical tip", "half_angle": "35 deg", "thickness": "20 um", "poisson_ratio": 0.5}
    gel = palpate.simulate({
        "specimen": {**tip, "modulus": "1 kPa"},
        "law": {"name": "latency", "exponent": 1, "rate_coefficient": "2 /s"},
        "contact": {"layers": 4},
        "step": [{"to": "1 um", "rate": "2 um/s", "hold": "20 s"}],
    })
    test = {"specimen": tip, "contact": {"touch": "as recorded"}}
    record = palpate.Record.from_arrays(time_s=gel.time_s, force_n=gel.force_n, displacement_m=gel.displacement_m)
    analysis = record.analyze(test=test)
    assert analysis.loading_modulus_pa is not None and analysis.loading_modulus_standard_error_pa is not None
    assert 2e3 < analysis.loading_modulus_pa < 4e3
    fits = polars.DataFrame(analysis.fits).filter(polars.col("law") == "latency:1", polars.col("domain") == "time")
    assert fits["equilibrium_modulus_pa"][0] == pytest.approx(1e3, rel=2e-3)
    calibrated = record.calibrate(law="latency:1", test=test, alternatives=[]).material
    assert calibrated.equilibrium == "hertz"
    assert calibrated.parameters["modulus_pa"] == pytest.approx(1e3, rel=1e-2)


@pytest.mark.parametrize(
    ("keywords", "reported"),
    [
        ({"law": "foo"}, 'no law is called "foo"'),
        ({"alternatives": ["foo"]}, 'no law is called "foo"'),
        ({"alternatives": "prony:2"}, "alternatives: expected a list of laws, found 'prony:2'"),
        ({"equilibrium": "flat"}, 'equilibrium is one of "uniform-strain", "hertz", "table", found "flat"'),
        ({"poisson_ratio": 0.3}, "poisson_ratio is for Hertz's law, which is not requested\nhint: add equilibrium=\"hertz\""),
        ({"confidence": 95}, "confidence is a share between 0 and 1, found 95"),
    ],
)
def test_a_wrong_option_is_named(record: palpate.Record, keywords: dict[str, Any], reported: str) -> None:
    with pytest.raises(palpate.OptionError) as caught:
        record.calibrate(**keywords)
    assert reported in str(caught.value)


def test_a_material_file_that_is_none_has_the_words_of_the_command_line(material: palpate.Material, tmp_path: Path) -> None:
    text = material.to_toml()
    edited = {
        "edited.toml": text.replace('radius = "0.035 m"', 'radius = "-1 m"'),
        "later.toml": text.replace("version = 1", "version = 7"),
        "changed.toml": text.replace("exponent = 5", "exponent = 6", 1),
        "protocol.toml": HOLD.read_text(),
    }
    for name in [*edited, "none.toml"]:
        if name in edited:
            (tmp_path / name).write_text(edited[name])
        kind: type[Exception] = palpate.OptionError if name in edited else FileNotFoundError
        with pytest.raises(kind) as caught:
            palpate.Material.read(tmp_path / name)
        reported = command("predict", tmp_path / name, "--protocol", HOLD).stderr
        assert reported.strip() == f"error: {caught.value}"
    # A contact is not stepped by a parameter that was not calibrated, either.
    for make in (palpate.ContactState, lambda path: palpate.ContactStates(path, 2)):
        with pytest.raises(palpate.OptionError, match="a value edited by hand is no longer calibrated, found 6"):
            make(tmp_path / "changed.toml")
    with pytest.raises(palpate.PalpateError, match="cannot write"):
        material.write(tmp_path / "edited.toml" / "inside.toml")
    with pytest.raises(IsADirectoryError, match="expected a file, found a directory"):
        palpate.Material.read(tmp_path)


@pytest.mark.parametrize(
    ("protocol", "keywords", "kind", "reported"),
    [
        ("none.toml", {}, FileNotFoundError, "none.toml: no such file"),
        ([], {}, palpate.OptionError, "step: missing"),
        ([{"to": "80 mm", "rate": "10 mm/s"}], {}, palpate.OptionError, "step[0].to: expected a displacement below"),
        ([{"to": 5, "rate": "10 mm/s"}], {}, palpate.OptionError, 'add the unit, such as to = "5 mm"'),
        (SQUEEZE, {"at_s": [99.0]}, palpate.ModelError, "sample times must rise from 0 s to 10.6 s at most, found 99 s"),
        (SQUEEZE, {"at_s": [5.0, 1.0]}, palpate.ModelError, "found 1 s at index 1"),
        (SQUEEZE, {"at_s": 5.0}, palpate.OptionError, "at_s: expected a column of numbers, found float 5.0"),
        (SQUEEZE, {"confidence": 1}, palpate.OptionError, "confidence is a share between 0 and 1, found 1"),
    ],
)
def test_what_cannot_be_predicted_is_stated(
    material: palpate.Material, protocol: Any, keywords: dict[str, Any], kind: type[Exception], reported: str
) -> None:
    with pytest.raises(kind) as caught:
        material.predict(protocol, **keywords)
    assert reported in str(caught.value)


def test_findings_on_the_record_are_those_of_its_analysis(calibration: palpate.Calibration, record: palpate.Record) -> None:
    """A calibration was silent on repaired rows and gaps that the analysis of the same record states."""
    assert [found.code for found in calibration.findings] == [found["code"] for found in calibration.to_dict()["findings"]]
    force = record.force_n.copy()
    force[300:303] = 9999.0
    astray = palpate.Record.from_arrays(time_s=record.time_s, displacement_m=record.displacement_m, force_n=force)
    assert "dropouts_repaired" in [found.code for found in astray.calibrate(test=TEST, alternatives=[]).findings]
