"""Contacts simulated: whole protocols, and one step at a time."""

from __future__ import annotations

import copy
import csv
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import polars
import pytest
from palpate._palpate import mapping_text
from conftest import ROOT, relaxation

PAPER: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}


def test_a_protocol_gives_what_the_command_line_gives(root: Path, tmp_path: Path) -> None:
    path, out = root / "examples/protocols/grip.toml", tmp_path / "grip.csv"
    subprocess.run([sys.executable, "-m", "palpate", "simulate", str(path), "--out", str(out)], check=True)
    with out.open() as file:
        rows = list(csv.DictReader(file))
    frame = polars.DataFrame(palpate.simulate(path))
    assert frame.columns == list(rows[0])
    for name in frame.columns:
        assert [float(row[name]) for row in rows] == frame[name].cast(polars.Float64).to_list()


def test_a_mapping_is_a_protocol_whose_tables_can_be_replaced() -> None:
    trajectory = palpate.simulate(PAPER)
    assert len(trajectory) == len(trajectory.time_s) == len(polars.DataFrame(trajectory))
    assert trajectory.time_s[-1] == pytest.approx(10.6) and trajectory.in_contact.all() and trajectory.events == []
    excess = trajectory.strain - trajectory.equilibrium_strain
    np.testing.assert_allclose(trajectory.excess_strain, excess, atol=1e-15)
    stiff = palpate.simulate(PAPER, specimen={**PAPER["specimen"], "modulus": "56 kPa"})
    np.testing.assert_allclose(stiff.force_n, 2 * trajectory.force_n, rtol=1e-12)
    sparse = palpate.simulate(PAPER, output={"times": ["0 s", "0.6 s", "10.6 s"]})
    assert sparse.force_n[-1] == pytest.approx(trajectory.force_n[-1], rel=1e-12)
    with pytest.raises(palpate.OptionError, match="tables replace those of a mapping"):
        palpate.simulate("protocol.toml", law={})
    with pytest.raises(palpate.OptionError, match="specimen"):
        palpate.simulate({**PAPER, "specimen": {}})
    with pytest.raises(FileNotFoundError, match="nothing.toml"):
        palpate.simulate("nothing.toml")


def test_a_trajectory_can_be_kept() -> None:
    trajectory = palpate.simulate(PAPER)
    assert pickle.loads(pickle.dumps(trajectory)) == copy.deepcopy(trajectory) == trajectory


def test_steps_follow_the_protocol() -> None:
    trajectory = palpate.simulate(PAPER)
    state = palpate.ContactState(PAPER)
    assert state.force_n == 0.0
    forces = [0.0]
    for dt, displacement in zip(np.diff(trajectory.time_s), trajectory.displacement_m[1:]):
        forces.append(state.step(float(dt), float(displacement)))
    largest = trajectory.force_n.max()
    assert np.max(np.abs(np.array(forces) - trajectory.force_n)) < 2e-3 * largest
    assert state.is_touching and state.surface_m == pytest.approx(2.5e-3) and forces[-1] == state.force_n


def test_a_state_can_be_copied_and_sent() -> None:
    state = palpate.ContactState(PAPER)
    state.step(0.1, 2e-3)
    twins = [copy.copy(state), copy.deepcopy(state), pickle.loads(pickle.dumps(state))]
    assert all(twin == state for twin in twins)
    state.step(0.1, 3e-3)
    assert all(twin != state for twin in twins)
    assert all(twin.step(0.1, 3e-3) == state.force_n for twin in twins)
    # Under a force that stays the body creeps, at first not at all.
    assert state.step_force(1e-9, state.force_n) == pytest.approx(3e-3, rel=1e-5)
    assert state.step_force(0.1, state.force_n) > 3e-3


def test_a_number_in_si_stands_under_a_key_with_its_unit() -> None:
    bare: dict[str, Any] = {
        "specimen": {"shape": "ball", "radius_m": 0.035, "modulus_pa": np.float64(28e3)},
        "law": {"name": "latency", "exponent": 5, "rate_coefficient_per_s": 20_000},
        "step": [{"to_m": 0.005, "rate_m_per_s": 0.5 / 60, "hold_s": 10}],
        "output": {"times_s": np.array([0.6, 5.0])},
    }
    texts: dict[str, Any] = {
        "specimen": {"shape": "ball", "radius": "0.035 m", "modulus": "28 kPa"},
        "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
        "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
        "output": {"times": ["0.6 s", "5 s"]},
    }
    assert palpate.simulate(bare).force_n == pytest.approx(palpate.simulate(texts).force_n, rel=1e-12)
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"radius_m": "35 mm"}, "specimen.radius_m: expected a number in m, found '35 mm'\nhint: write the number alone, or radius = \"... m\""),
        ({"radius_m": float("nan")}, "specimen.radius_m: expected a finite number, found nan"),
        ({"radius_m": 0.035, "radius": "35 mm"}, "specimen.radius_m: expected either this or specimen.radius, found both"),
        ({"radius_s": 0.035}, 'specimen.radius = "0.035 s": "s" is not a unit of length'),
    ]
    for specimen, reported in wrong:
        with pytest.raises(palpate.OptionError) as caught:
            palpate.simulate({**texts, "specimen": {"shape": "ball", "modulus": "28 kPa", **specimen}})
        assert reported in str(caught.value)
    with pytest.raises(palpate.OptionError, match=r'specimen.radius = 0.035: .*\n.*radius = "0.035 mm".*; or a number in SI: radius_m = 0.035'):
        palpate.simulate({**texts, "specimen": {"shape": "ball", "modulus": "28 kPa", "radius": 0.035}})


def test_a_wrong_key_of_a_mapping_is_named_by_its_path() -> None:
    step = {"to": "5 mm", "rate": "500 mm/min"}
    material = palpate.Material.read(ROOT / "examples/records/ball-material.toml")
    wrong = [{**step, "holds": "10 s"}]
    for call in (
        lambda: palpate.simulate({**PAPER, "step": wrong}),
        lambda: palpate.simulate_many({**PAPER, "step": wrong}, {"law.exponent": [5.0]}),
        lambda: material.predict(wrong),
    ):
        with pytest.raises(palpate.OptionError) as caught:
            call()
        assert str(caught.value).startswith("protocol: step[0].holds: unknown key") and "did you mean hold?" in str(caught.value)
    with pytest.raises(palpate.OptionError, match=r"^protocol: step\[1\].hold = 10: expected a unit"):
        material.predict([step, {**step, "hold": 10}])
    with pytest.raises(palpate.OptionError, match=r"^test: specimen.radus: unknown key"):
        palpate.read(ROOT / "examples/records/ball.csv", test={"specimen": {"shape": "ball", "radus": "35 mm"}})
    with pytest.raises(palpate.OptionError, match=r"^model: law.exponents: unknown key"):
        palpate.ContactState({**PAPER, "law": {"name": "latency", "exponents": 5}})


def test_what_no_body_can_do_is_refused() -> None:
    state = palpate.ContactState(PAPER)
    for dt, displacement in [(-1.0, 1e-3), (float("nan"), 1e-3), (0.1, float("inf")), (0.1, 1.0)]:
        with pytest.raises(palpate.ModelError):
            state.step(dt, displacement)
    assert state.force_n == 0.0
    linear = {**PAPER, "law": {"name": "standard-linear-solid", "overshoot": 3, "time": "2 s"}}
    found = r'law\.name: a contact is stepped by the latency law alone, found "standard-linear-solid"\nhint: palpate\.ContactStates'
    with pytest.raises(palpate.ModelError, match=found):
        palpate.ContactState(linear)


def test_the_error_of_a_step_falls_with_its_square() -> None:
    def squeezed(steps: int) -> float:
        state = palpate.ContactState(PAPER)
        return [state.step(0.1 / steps, 5e-3 * k / steps) for k in range(1, steps + 1)][-1]

    exact = squeezed(20_000)
    errors = [squeezed(steps) / exact - 1 for steps in (1, 10, 100)]
    assert errors == pytest.approx([0.63, 0.012, 1.25e-4], rel=0.03)


def test_a_mapping_may_hold_any_number_and_text() -> None:
    plain = palpate.simulate(PAPER)
    law = {**PAPER["law"], "exponent": np.int64(PAPER["law"]["exponent"])}
    assert palpate.simulate({**PAPER, "law": law}) == plain
    law["exponent"] = np.float32(PAPER["law"]["exponent"])
    assert palpate.simulate({**PAPER, "law": law, "title": "ball \U0001f600 \x7f \"α\"\n"}).force_n[-1] == plain.force_n[-1]
    wrong: list[tuple[Any, str]] = [
        (float("nan"), "law.exponent: expected a finite number, found nan"),
        (np.float32("inf"), "law.exponent: expected a finite number, found inf"),
        (None, "law.exponent: expected a text, a number, a list or a table, found NoneType"),
    ]
    for value, reported in wrong:
        with pytest.raises(palpate.OptionError, match=reported):
            palpate.simulate({**PAPER, "law": {**law, "exponent": value}})
    with pytest.raises(palpate.OptionError, match='such as radius = "0.035 mm" or "0.035 m"'):
        palpate.simulate({**PAPER, "specimen": {**PAPER["specimen"], "radius": 0.035}})


def test_laws_are_compared_by_what_they_predict() -> None:
    t, y = relaxation(800, 1e-4)
    comparison = palpate.compare(t, y, laws=["latency:5", "standard-linear-solid", "prony:2"])
    assert comparison.law == "latency:5" and comparison.certainty == "clear"
    assert comparison.probability is not None and comparison.probability >= 0.9
    assert comparison.sentence is not None and "n = 5" in comparison.sentence
    assert comparison.laws["law"][0] == "latency:5" and len(comparison.laws) == 3
    assert comparison.to_dict()["signal"] == "force"
    with pytest.raises(palpate.OptionError, match='no law is called "x"'):
        palpate.compare(t, y, laws=["x"])
    with pytest.raises(palpate.OptionError, match="quantity is"):
        palpate.compare(t, y, quantity="charge")  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]


def test_a_mapping_is_the_text_that_it_says() -> None:
    text = mapping_text({
        "title": 'a "b" \\ \x7f \n é',
        "specimen": {"radius_m": 0.035, "areas": [["1 mm", "2 mm^2"]], "poisson_ratio": np.float32(0.5)},
        "contact": {"layers": np.int64(8), "can_separate": np.bool_(True)},
        "output": {"times_s": np.array([0.0, 1.5])},
    })
    import tomllib

    assert tomllib.loads(text) == {
        "title": 'a "b" \\ \x7f \n é',
        "specimen": {"radius": "0.035 m", "areas": [["1 mm", "2 mm^2"]], "poisson_ratio": 0.5},
        "contact": {"layers": 8, "can_separate": True},
        "output": {"times": ["0.0 s", "1.5 s"]},
    }
    endless: dict[str, Any] = {}
    endless["step"] = endless
    wrong: Any
    for wrong, message in [
        ({"law": {"exponent": float("inf")}}, "law.exponent: expected a finite number, found inf"),
        ({"step": [{}, {"hold": None}]}, r"step\[1\].hold: expected a text, a number, a list or a table, found NoneType"),
        ({"step": [{"hold_s": True}]}, r"step\[0\].hold_s: expected a number in s, found True"),
        (endless, "at most 64 deep"),
    ]:
        with pytest.raises(palpate.OptionError, match=message):
            mapping_text(wrong)
