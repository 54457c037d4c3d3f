"""A contact watched tick by tick."""

from __future__ import annotations

import copy
import json
import math
import pickle
import subprocess
import sys
import time
from typing import Any

import numpy as np
import palpate
import pytest
from conftest import ROOT
from numpy.typing import NDArray

RECORD, TEST = ROOT / "examples/records/ball.csv", ROOT / "examples/records/ball.toml"
PATH = ROOT / "examples/records/ball-material.toml"


@pytest.fixture(scope="module")
def material() -> palpate.Material:
    return palpate.Material.read(PATH)


def ticks() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    record = palpate.read(RECORD, test=TEST)
    assert record.displacement_m is not None
    return record.time_s, record.force_n, record.displacement_m


def attributes(observed: palpate.Observation) -> dict[str, Any]:
    """All that is known, by name."""
    names = [name for name in dir(palpate.Observation) if not name.startswith("_")]
    return {name: getattr(observed, name) for name in names if getattr(observed, name) is not None}


def watched(*flags: str) -> list[dict[str, Any]]:
    """The ticks that `palpate watch` tells of the ball, with never as an infinite time."""
    arguments = ["watch", str(RECORD), "--test", str(TEST), "--format", "jsonl", "--every", "1 ms", *flags]
    ran = subprocess.run([sys.executable, "-m", "palpate", *arguments], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    reported = [line for line in map(json.loads, ran.stdout.splitlines()) if line.pop("event") == "tick"]
    for line in reported:
        for key in ("time_to_slip_s", "time_to_slip_low_s", "time_to_slip_high_s"):
            if key in line or line.get("slips") == "never":
                line[key] = math.inf if line.get(key) is None else line[key]
    return reported


@pytest.mark.parametrize(
    ("flags", "keywords"),
    [
        ([], {}),
        (["--slip-force", "3 N", "--warn-before", "0.5 s", "--exponent", "4"], {"slip_force_n": 3.0, "warn_before_s": 0.5, "exponent": 4.0}),
        (["--slip-force", "3 N", "--exponent-standard-error", "0.5"], {"slip_force_n": 3.0, "exponent_standard_error": 0.5}),
        (["--slip-force", "3 N", "--material", str(PATH), "--confidence", "0.8"], {"slip_force_n": 3.0, "material": PATH, "confidence": 0.8}),
    ],
    ids=["usual", "slip", "exponent", "material"],
)
def test_observations_are_those_of_the_command_line_to_the_last_bit(flags: list[str], keywords: dict[str, Any]) -> None:
    if "material" in keywords:
        keywords = {**keywords, "material": palpate.Material.read(PATH)}
    t, force, displacement = ticks()
    one, many = palpate.Observer(**keywords), palpate.Observer(**keywords)
    observed = [one.feed(*tick) for tick in zip(t, force, displacement, strict=True)]
    reported = watched(*flags)
    assert len(reported) == len(observed) == len(t)
    for line, now in zip(reported, observed, strict=True):
        ours = attributes(now)
        began, warning = ours.pop("began"), ours["warning"]
        if "slip_force_n" not in keywords:
            assert ours.pop("warning") == "none"
        assert ours == line and isinstance(began, bool) and warning in ("none", "soon", "slipping")
    # The same in one call.
    table = many.feed_many(t, force, displacement)
    assert many == one and len(table) == len(observed)
    assert set(table.column_names) == {name for name in dir(palpate.Observation) if not name.startswith("_")}
    for name in table.column_names:
        for cell, now in zip(table[name], observed, strict=True):
            known = getattr(now, name)
            assert (cell is None or cell != cell) if known is None else cell == known, name


def test_a_slip_is_predicted_and_a_hold_that_stays_is_not() -> None:
    t = np.arange(30_001) * 1e-3
    hold = palpate.laws.latency(np.maximum(t - 0.5, 0.0), 1.2, 1.7, 6.0, 5.0)
    force, displacement = np.where(t < 0.5, 5.8 * t, hold), np.minimum(0.01 * t, 0.005)
    slips_at = t[500 + np.argmax(force[500:] < 2.0)]
    observed = palpate.Observer(slip_force_n=2.0, warn_before_s=0.2).feed_many(t, force, displacement)
    before = (t > 0.8) & (t < slips_at)
    predicted = t[before] + observed["time_to_slip_s"][before]
    np.testing.assert_allclose(predicted, slips_at, atol=0.02)
    assert np.all(observed["time_to_slip_low_s"][before] <= observed["time_to_slip_high_s"][before])
    soon, slipping = observed["warning"].index("soon"), observed["warning"].index("slipping")
    assert slips_at - 0.4 < t[soon] < t[slipping] < slips_at + 0.01
    assert observed["equilibrium_force_n"][-1] == pytest.approx(1.2, abs=2e-3)
    assert observed["relative_rate_per_s"][-1] == pytest.approx(6.0 / (1 + 4 * 6.0 * 29.5), rel=1e-2)
    stays = palpate.Observer(slip_force_n=1.0).feed_many(t, force, displacement)
    assert stays["slips"][-1] == "never" and stays["time_to_slip_s"][-1] == math.inf and "soon" not in stays["warning"]
    # Without a displacement a hold is given from its force alone.
    unknown = palpate.Observer().feed_many(t, force + np.random.default_rng(1).normal(0.0, 0.01, len(t)))
    assert unknown["slips"] == [None] * len(t) and np.isnan(unknown["time_to_slip_s"]).all() and unknown["held"][-1] == "displacement"


def test_a_material_tells_the_excess_strain(material: palpate.Material) -> None:
    trajectory = palpate.simulate({"material": material, "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "5 s"}]})
    t, displacement = trajectory.time_s, trajectory.displacement_m
    rises = np.concatenate([[True], np.diff(t) > 0])
    noise = np.random.default_rng(1).normal(0.0, 0.01, len(t))
    observed = palpate.Observer(material).feed_many(t[rises], (trajectory.force_n + noise)[rises], displacement[rises])
    off = np.abs(observed["excess_strain"] - trajectory.excess_strain[rises])
    late = t[rises] > 1.0
    assert np.all(off[late] < 5 * observed["excess_strain_standard_error"][late]) and late.sum() > 50
    assert observed["excess_strain_standard_error"][-1] < 0.1 * trajectory.excess_strain.max()
    assert np.isnan(palpate.Observer().feed_many(t[rises], trajectory.force_n[rises], displacement[rises])["excess_strain"]).all()


@pytest.mark.parametrize("informed", [False, True])
def test_an_observer_goes_on_elsewhere_to_the_last_bit(material: palpate.Material, informed: bool) -> None:
    t, force, displacement = ticks()
    observer = palpate.Observer(material if informed else None, slip_force_n=3.0, displacement_noise_m=1e-6, force_noise_n=0.05)
    for cut in (0, 5, 40, 700):
        here = copy.copy(observer)
        here.feed_many(t[:cut], force[:cut], displacement[:cut])
        twins = [pickle.loads(pickle.dumps(here)), copy.copy(here), copy.deepcopy(here)]
        expected = here.feed_many(t[cut:], force[cut:], displacement[cut:])
        for twin in twins:
            assert (twin != here) and twin.material == observer.material and twin.slip_force_n == 3.0
            assert twin.feed_many(t[cut:], force[cut:], displacement[cut:]) == expected
            assert twin == here and repr(twin) == repr(here)
    last = observer.feed(0.0, 0.0, 0.0)
    assert pickle.loads(pickle.dumps(last)) == last == copy.deepcopy(last)
    assert observer.warn_before_s == 1.0 and observer.confidence == 0.95
    make, parts = observer.__reduce__()
    with pytest.raises(palpate.PalpateError, match=r"expected the bytes of an observer with these options, found others\nhint: "):
        make(*parts[:-1], parts[-1][:-1])


@pytest.mark.parametrize(
    ("tick", "kind", "reported"),
    [
        ((0.5, 1.0, 1e-3), palpate.RecordError, "time must rise from tick to tick, found 0.5 s after 1 s\nhint: after a clock was set"),
        ((1.0, 1.0, 1e-3), palpate.RecordError, "time must rise from tick to tick, found 1 s after 1 s"),
        ((2.0, math.nan, 1e-3), palpate.RecordError, "the force at 2 s must be a finite number, found NaN\nhint: leave the tick out"),
        ((2.0, 1.0, math.inf), palpate.RecordError, "the displacement at 2 s must be a finite number, found inf"),
        ((math.nan, 1.0, 1e-3), palpate.RecordError, "the time at 1 s must be a finite number, found NaN"),
        ((2.0, 1.0, 1.0), palpate.ModelError, "at 2 s the body of the material cannot take a displacement of 1 m\nhint: count displacement"),
    ],
)
def test_a_tick_that_cannot_be_taken_changes_nothing(
    material: palpate.Material, tick: tuple[float, float, float], kind: type[Exception], reported: str
) -> None:
    observer = palpate.Observer(material)
    observer.feed(0.0, 0.1, 1e-4)
    observer.feed(1.0, 1.0, 1e-3)
    before = copy.copy(observer)
    with pytest.raises(kind) as caught:
        observer.feed(*tick)
    assert reported in str(caught.value) and observer == before
    # In an array it is named, and none of the others is taken either.
    times, forces, places = zip((1.2, 1.0, 1e-3), (1.4, 1.0, 1e-3), tick, strict=True)
    with pytest.raises(kind) as caught:
        observer.feed_many(times, forces, places)
    assert str(caught.value).startswith("tick 2: ") and observer == before


def test_columns_that_do_not_fit_are_refused() -> None:
    observer = palpate.Observer()
    with pytest.raises(palpate.RecordError, match="expected columns of one length, found 3 times, 2 forces"):
        observer.feed_many([0, 1, 2], [0, 1])
    with pytest.raises(palpate.RecordError, match="found 2 times, 2 forces, 1 displacements"):
        observer.feed_many([0, 1], [0, 1], [0])
    with pytest.raises(palpate.OptionError, match="force_n: expected numbers, found"):
        observer.feed_many([0, 1], ["a", "b"])
    assert len(observer.feed_many([], [])) == 0 and observer == palpate.Observer()


@pytest.mark.parametrize(
    ("keywords", "reported"),
    [
        ({"exponent": 0.5}, "the exponent must be from 1 to 30, found 0.5"),
        ({"exponent_standard_error": -1.0}, "the deviation of the exponent must be from 0 to 10, found -1"),
        ({"slip_force_n": 0.0}, "the slip force must be above 0 N, found 0"),
        ({"warn_before_s": -1.0}, "the time to warn before slip must be 0 s or more, found -1"),
        ({"confidence": 95.0}, "the confidence must be between 0 and 1, found 95"),
        ({"force_noise_n": 0.1}, "displacement_noise_m: expected the noise of both readings or of none, found force_noise_n alone\nhint: "),
        ({"displacement_noise_m": 1e-6}, "force_noise_n: expected the noise of both readings or of none"),
        ({"stiffness_standard_error": 2.0}, "the deviation of the stiffness must be from 0 to 1, found 2"),
        ({"touch_standard_error_m": math.nan}, "the deviation of first touch must be 0 m or more, found NaN"),
    ],
)
def test_a_wrong_option_is_named(keywords: dict[str, Any], reported: str) -> None:
    with pytest.raises(palpate.OptionError) as caught:
        palpate.Observer(**keywords)
    assert reported in str(caught.value)


def test_a_material_says_the_exponent_itself_and_obeys_the_latency_law(material: palpate.Material) -> None:
    for name in ("exponent", "exponent_standard_error"):
        with pytest.raises(palpate.OptionError, match=f"{name}: expected either this or material, found both\nhint: leave {name} out"):
            palpate.Observer(material, **{name: 1.0})
    linear = palpate.read(RECORD, test=TEST).calibrate(law="standard-linear-solid", alternatives=[]).material
    with pytest.raises(palpate.ModelError, match="knows a hold of the latency law alone, the material obeys a linear law\nhint: calibrate with law="):
        palpate.Observer(linear)
    with pytest.raises(TypeError):
        palpate.Observer(PATH)  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]


def test_ten_times_the_ticks_take_ten_times_as_long() -> None:
    t = np.arange(200_000) * 1e-3
    force = palpate.laws.latency(t, 1.2, 1.7, 6.0, 5.0)
    displacement = np.full(len(t), 5e-3)

    # The time of this process on the processor, tick count beside tick count: other work on the machine that lasts for one of the two counts alone changes neither.
    def seconds(count: int) -> float:
        start = time.process_time()
        table = palpate.Observer().feed_many(t[:count], force[:count], displacement[:count])
        assert len(table) == count
        return time.process_time() - start

    pairs = [(seconds(20_000), seconds(200_000)) for _ in range(4)]
    assert min(many / few for few, many in pairs) < 20, pairs
