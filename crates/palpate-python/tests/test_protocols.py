"""Protocols as typed data, records that drive a body, and what a squeeze costs."""

from __future__ import annotations

import csv
import inspect
import pickle
import subprocess
import sys
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import palpate
import pint
import pytest
from palpate import Law, Protocol, Specimen, Step
from palpate.protocols import Shape
from scipy.integrate import trapezoid

UNITS: Any = pint.UnitRegistry()
BALL = Specimen("ball", radius=0.035, modulus="28 kPa")
LATENCY = Law("latency", exponent=5, rate_coefficient=2e4)
SQUEEZE = Protocol(specimen=BALL, law=LATENCY, step=[Step(to=0.005, rate="500 mm/min", hold=10)])
TEXTS: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}
CYCLE = Protocol(
    specimen=Specimen("block", area=1e-3, length="40 mm", modulus=1e5),
    law=Law("latency", exponent=3, rate_coefficient=100 / UNITS.s),
    step=[Step(to=4 * UNITS.mm, rate=0.004), Step(to=0, rate=0.004)],
)


def test_a_protocol_of_numbers_texts_and_quantities_is_that_of_the_file() -> None:
    assert palpate.simulate(SQUEEZE) == palpate.simulate(TEXTS)
    quantities = replace(SQUEEZE, step=[Step(to=5 * UNITS.mm, rate="500 mm/min", hold=10_000 * UNITS.ms)])
    np.testing.assert_allclose(palpate.simulate(quantities).force_n[-1], palpate.simulate(TEXTS).force_n[-1], rtol=1e-12)
    assert pickle.loads(pickle.dumps(SQUEEZE)) == SQUEEZE
    runs = palpate.simulate_many(SQUEEZE, {"step[1].hold": [5.0, 10.0]})
    assert runs["force_end_n"][1] == palpate.simulate(SQUEEZE).force_n[-1]


def test_a_typed_body_stands_wherever_a_mapping_does(root: Path) -> None:
    state = palpate.ContactState({"specimen": BALL, "law": LATENCY})
    assert state.step(0.5, 4e-3) > 0
    record = palpate.read(root / "examples/records/ball.csv", test={"specimen": BALL})
    assert "modulus" in record.analyze(compare=False).to_json()
    material = palpate.Material.read(root / "examples/records/ball-material.toml")
    step = Step(to="4 mm", rate="500 mm/min", hold="5 s")
    assert material.predict([step]) == material.predict([{"to": "4 mm", "rate": "500 mm/min", "hold": "5 s"}])
    assert palpate.simulate(Protocol(material=material, step=[step])).force_n[-1] > 0


@pytest.mark.parametrize(
    ("step", "reported"),
    [
        (Step(to=0.005, rate=0.01, hold=-1), r"step\[1\]\.hold: expected a time of 0 s or more"),
        (Step(to=0.005, rate=0.01, hold="10 mm"), r"step\[1\]\.hold = \"10 mm\": \"mm\" is not a unit of time"),
        (Step(to=0.005, rate=0.01, hold=3 * UNITS.N), r"step\[1\]\.hold = \"3.0 N\": \"N\" is not a unit of time"),
        (Step(to=float("nan"), rate=0.01), r"step\[1\]\.to_m: expected a finite number, found nan"),
        (Step(to=0.005), r"step\[1\]"),
        ({"to": "5 mm", "rate": "1 mm/s", "holdd": "1 s"}, r"step\[1\]\.holdd: unknown key"),
    ],
)
def test_errors_name_the_key(step: Any, reported: str) -> None:
    with pytest.raises(palpate.OptionError, match=reported):
        palpate.simulate(replace(SQUEEZE, step=[*SQUEEZE.step, step]))


def test_the_help_of_a_protocol_explains_every_field() -> None:
    """Fields had comments in the source alone."""
    for kind in (Law, Protocol, Specimen, Step):
        text = inspect.getdoc(kind) or ""
        assert [one.name for one in fields(kind) if f"\n{one.name} : " not in text] == []


def test_what_is_no_protocol_says_what_is() -> None:
    """A list and a trajectory were TypeErrors that expected str, bytes or os.PathLike."""
    calls: list[Any] = [palpate.simulate, palpate.energy]
    for call in (*calls, lambda steps: palpate.simulate_many(steps, {"law.exponent": [3.0]})):
        with pytest.raises(palpate.OptionError, match="expected a description or its path, found a list\nhint: steps alone have no body"):
            call(list(SQUEEZE.step))
        with pytest.raises(palpate.OptionError, match="found a Trajectory\nhint: pass the protocol that it was simulated from"):
            call(palpate.simulate(SQUEEZE))


def test_steps_are_a_list() -> None:
    with pytest.raises(palpate.OptionError, match="step: expected a list of steps, found Step\nhint: put it into a list"):
        replace(SQUEEZE, step=Step(to=1, rate=1))  # type: ignore[arg-type] # pyright: ignore


def test_every_shape_is_known_and_takes_si() -> None:
    sizes: dict[str, dict[str, Any]] = {
        "ball": {"radius": 0.03},
        "pad": {"radius": 0.01, "thickness": 0.005},
        "strip": {"width": 0.01, "thickness": 0.005, "length": 0.05},
        "dumbbell": {"thickness": 0.002, "widths": [(0, 0.025), (0.06, 0.006), (0.12, 0.025)]},
        "cylinder": {"diameter": 0.02, "length": 0.03},
        "block": {"area": 1e-3, "length": 0.04},
        "profile": {"depth": 0.02, "areas": [(0, 0), (0.001, 4e-5), (0.01, 5e-4)]},
        "spherical tip": {"radius": 0.01, "poisson_ratio": 0.5},
        "conical tip": {"half_angle": 0.6, "thickness": 0.01, "poisson_ratio": 0.5},
        "pyramidal tip": {"half_angle": "35 deg", "thickness": 0.01, "poisson_ratio": 0.5},
        "flat punch": {"radius": 0.005, "poisson_ratio": 0.5},
    }
    assert set(sizes) == set(get_args(Shape)) - {"none", "cone and plate"}
    for shape, size in sizes.items():
        specimen: Any = Specimen(shape, modulus=2e4, **size)  # type: ignore[arg-type] # pyright: ignore
        trajectory = palpate.simulate(replace(SQUEEZE, specimen=specimen, step=[Step(to=1e-3, rate=1e-3)]))
        assert trajectory.force_n[-1] > 0, shape


def test_a_record_drives_the_body() -> None:
    run = palpate.simulate(SQUEEZE)
    record = palpate.Record.from_arrays(time_s=run.time_s, force_n=run.force_n, displacement_m=run.displacement_m)
    driven = palpate.simulate(SQUEEZE, drive=record)
    np.testing.assert_array_equal(driven.time_s, run.time_s)
    np.testing.assert_allclose(driven.force_n, run.force_n, rtol=1e-6, atol=1e-9)
    by_force = palpate.simulate(SQUEEZE, drive=record, drive_by="force")
    np.testing.assert_allclose(by_force.displacement_m[1:], run.displacement_m[1:], rtol=2e-3)
    # The steps of the protocol do not matter then.
    assert palpate.simulate({"specimen": BALL, "law": LATENCY}, drive=record) == driven
    alone = palpate.Record.from_arrays(time_s=run.time_s, force_n=run.force_n)
    with pytest.raises(palpate.RecordError, match='expected a displacement to replay, found none\nhint: replay the force with drive_by="force"'):
        palpate.simulate(SQUEEZE, drive=alone)
    with pytest.raises(palpate.OptionError, match="drive: expected a Record, found str\nhint: read it"):
        palpate.simulate(SQUEEZE, drive="press.csv")  # type: ignore[arg-type] # pyright: ignore
    with pytest.raises(palpate.OptionError, match='drive_by is one of "displacement", "force", found "time"'):
        palpate.simulate(SQUEEZE, drive=record, drive_by="time")  # type: ignore[arg-type] # pyright: ignore


def test_the_work_of_a_cycle_is_the_area_of_its_loop() -> None:
    run = palpate.simulate({**CYCLE, "output": {"sample_rate": "5 kHz"}})
    area = trapezoid(run.force_n, run.displacement_m)
    over_time, steps, cycle = (palpate.energy(CYCLE, by=by) for by in ("time", "step", "cycle"))
    # The jaw is back and the body is not: it still stores what it has not lost.
    assert cycle["closed"] == [False] and cycle["lost_j"][0] == pytest.approx(over_time["lost_j"][-1], rel=1e-12)
    rested = palpate.energy(replace(CYCLE, step=[*CYCLE.step[:1], Step(to=0, rate=0.004, hold=600.0)]), by="cycle")
    assert rested["lost_j"].tolist() == pytest.approx([area], rel=1e-2) and rested["closed"] == [True]
    assert over_time["work_j"][-1] == pytest.approx(area, rel=1e-5)
    np.testing.assert_allclose(over_time["stored_j"] + over_time["lost_j"], over_time["work_j"], atol=1e-12)
    assert steps["work_j"].sum() == pytest.approx(over_time["work_j"][-1], rel=1e-9)
    assert rested["share_lost"][0] == pytest.approx(rested["lost_j"][0] / rested["done_j"][0])
    grown = palpate.energy(SQUEEZE)
    assert np.isnan(grown["stored_j"]).all() and grown["work_j"][-1] > 0
    with pytest.raises(palpate.OptionError, match='by is one of "time", "step", "cycle", found "hold"'):
        palpate.energy(CYCLE, by="hold")  # type: ignore[arg-type] # pyright: ignore


def test_energies_are_those_of_the_command(root: Path, tmp_path: Path) -> None:
    protocol = root / "examples/protocols/creep.toml"
    files = {"time": "--energy", "step": "--energy-by-step", "cycle": "--energy-by-cycle"}
    flags = [word for by, flag in files.items() for word in (flag, str(tmp_path / f"{by}.csv"))]
    subprocess.run([sys.executable, "-m", "palpate", "simulate", protocol, *flags], check=True, capture_output=True)
    for by in files:
        table = palpate.energy(protocol, by=by)  # type: ignore[arg-type] # pyright: ignore
        with (tmp_path / f"{by}.csv").open() as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        assert len(rows) == len(table) > 0
        key = "done_j" if by == "cycle" else "work_j"
        assert table[key].tolist() == pytest.approx([float(row[key]) for row in rows], rel=1e-6, abs=1e-12)
