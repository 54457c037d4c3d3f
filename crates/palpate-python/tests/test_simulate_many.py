"""Many runs in one call, and many contacts in one step."""

from __future__ import annotations

import re
import threading
from typing import Any

import numpy as np
import palpate
import polars
import pyarrow
import pytest
from conftest import relaxation

MODEL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
PROTOCOL: dict[str, Any] = {**MODEL, "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}]}


def one(radius_m: float, rate: float, hold_s: float) -> palpate.Trajectory:
    return palpate.simulate(
        {
            "specimen": {**MODEL["specimen"], "radius": f"{radius_m!r} m"},
            "law": {**MODEL["law"], "rate_coefficient": f"{rate!r} /s"},
            "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": f"{hold_s!r} s"}],
        }
    )


def test_every_run_is_the_one_it_would_be_alone() -> None:
    rng = np.random.default_rng(3)
    radii, rates, holds = rng.uniform(0.02, 0.05, 40), 10 ** rng.uniform(3, 5, 40), rng.uniform(5, 50, 40)
    numbers = {"specimen.radius": radii, "law.rate_coefficient": rates, "step[1].hold": holds}
    runs = palpate.simulate_many(PROTOCOL, numbers, times_s=[0.5, 1.0, 5.0])
    assert runs["force_n"].shape == (40, 3) and list(runs["run"]) == list(range(1, 41))
    assert np.array_equal(runs["specimen_radius_m"], radii)
    for row in (0, 17, 39):
        alone = one(float(radii[row]), float(rates[row]), float(holds[row]))
        assert runs["force_end_n"][row] == pytest.approx(alone.force_n[-1], rel=1e-12)
        assert runs["peak_force_n"][row] == pytest.approx(alone.force_n.max(), rel=1e-9)
        near = [int(np.argmin(abs(alone.time_s - t))) for t in (1.0, 5.0)]
        assert runs["force_n"][row][1:] == pytest.approx(alone.force_n[near], rel=1e-3)
    frame = polars.DataFrame(runs)
    assert frame["force_n"].dtype == polars.Array(polars.Float64, 3)
    assert pyarrow.table(runs).num_rows == 40


def test_a_run_that_no_body_can_take_says_why_and_stops_no_other() -> None:
    runs = palpate.simulate_many(PROTOCOL, {"step[1].to": [0.005, 0.2]}, times_s=[0.1])
    assert runs["refused"][0] is None and "0.2" in runs["refused"][1].replace("200", "0.2")
    assert np.isnan(runs["force_end_n"][1]) and np.isnan(runs["force_n"][1]).all()


@pytest.mark.parametrize(
    ("numbers", "times_s", "kind", "text"),
    [
        ({"law.expnent": [1.0]}, None, palpate.OptionError, "did you mean law.exponent?"),
        ({"law.exponent": 5}, None, palpate.OptionError, "law.exponent: expected a column of numbers, found int 5"),
        ([5.0], None, palpate.OptionError, "numbers: expected arrays by the path of a number"),
        ({"law.exponent": [1.0, 2.0], "specimen.radius": [0.03]}, None, palpate.OptionError, "2 values, as the other"),
        ({"law.exponent": [1.0]}, [0.1, 1e3], palpate.ModelError, "1000"),
        ({"law.exponent": ["five"]}, None, palpate.OptionError, "law.exponent"),
    ],
)
def test_what_is_wrong_is_stated(numbers: Any, times_s: Any, kind: type[Exception], text: str) -> None:
    with pytest.raises(kind, match=text.replace("?", r"\?")):
        palpate.simulate_many(PROTOCOL, numbers, times_s=times_s)


def test_progress_is_reported() -> None:
    tqdm = pytest.importorskip("tqdm.auto")
    observed: list[int] = []

    class Bar(tqdm.tqdm):  # type: ignore[misc, name-defined]
        def update(self, n: float | None = 1) -> bool | None:
            observed.append(int(n or 0))
            return None

    original, tqdm.tqdm = tqdm.tqdm, Bar
    try:
        t, y = relaxation(100, 1e-4)
        palpate.fit_many([t] * 50, [y] * 50, progress=True)
        palpate.simulate_many(PROTOCOL, {"law.exponent": np.linspace(2, 6, 30)}, progress=True)
    finally:
        tqdm.tqdm = original
    assert observed[-1] == 30 and 50 in observed


def test_contacts_side_by_side_are_contacts() -> None:
    contacts = palpate.ContactStates(MODEL, 5)
    alone = [palpate.ContactState(MODEL) for _ in range(5)]
    to = np.linspace(1e-3, 5e-3, 5)
    for step in range(20):
        forces = contacts.step(0.01, to * min(1.0, step / 10))
        assert np.array_equal(forces, [c.step(0.01, float(d) * min(1.0, step / 10)) for c, d in zip(alone, to, strict=True)])
    assert np.array_equal(contacts.force_n, [c.force_n for c in alone]) and contacts.is_touching.all()
    assert np.array_equal(contacts.step_force(0.01, 1.0), [c.step_force(0.01, 1.0) for c in alone])
    softer = {**MODEL, "specimen": {**MODEL["specimen"], "modulus": "10 kPa"}}
    mixed = palpate.ContactStates([MODEL, softer])
    stiff, soft = mixed.step(0.1, 2e-3)
    assert len(mixed) == 2 and stiff / soft == pytest.approx(2.8, rel=1e-9)


def test_a_step_that_cannot_be_made_moves_no_contact() -> None:
    contacts = palpate.ContactStates(MODEL, 3)
    contacts.step(0.1, 1e-3)
    before = contacts.force_n
    with pytest.raises(palpate.ModelError, match="contact 2"):
        contacts.step(0.1, [1e-3, 1e-3, float("nan")])
    with pytest.raises(palpate.OptionError, match="expected one number or 3, one a contact, found 2"):
        contacts.step(0.1, [1e-3, 1e-3])
    for count in (0, -1, 10**12, 3.5, "3", None):
        with pytest.raises(palpate.OptionError, match=f"of one model, 1 to 100000000, .* found {str(count).lower()}"):
            palpate.ContactStates(MODEL, count)  # type: ignore[arg-type]
    for models, count in (([MODEL, MODEL], 3), ([], None)):
        with pytest.raises(palpate.OptionError, match="found a list and 3|found an empty list"):
            palpate.ContactStates(models, count)
    assert np.array_equal(contacts.force_n, before)


def test_threads_share_the_work() -> None:
    results: list[Any] = [None] * 4

    def work(index: int) -> None:
        results[index] = palpate.simulate_many(PROTOCOL, {"law.exponent": np.linspace(2, 6, 20)})["force_end_n"]

    threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result, results[0]) for result in results)


def test_a_path_may_state_the_unit() -> None:
    """``specimen.radius_m``, which a mapping takes, was an unknown parameter."""
    plain = palpate.simulate_many(PROTOCOL, {"specimen.radius": [0.03], "law.rate_coefficient": [1e4]})
    assert plain == palpate.simulate_many(PROTOCOL, {"specimen.radius_m": [0.03], "law.rate_coefficient_per_s": [1e4]})
    for path in ("specimen.radius_s", "law.exponent_m", "step[3].hold"):
        with pytest.raises(palpate.OptionError, match=f"^protocol: {re.escape(path)}: unknown parameter"):
            palpate.simulate_many(PROTOCOL, {path: [0.03]})


def test_a_number_of_a_step_has_one_path_here_and_in_sweeps() -> None:
    both = [palpate.simulate_many(PROTOCOL, {path: [2.0, 10.0]}) for path in ("step[1].hold", "step.1.hold")]
    assert both[0] == both[1]
    with pytest.raises(palpate.OptionError, match="either this or"):
        palpate.simulate_many(PROTOCOL, {"step[1].hold": [1.0], "step.1.hold": [2.0]})


def test_contacts_side_by_side_are_contacts_alone() -> None:
    rng = np.random.default_rng(4)
    models = [
        {**MODEL, "law": {**MODEL["law"], "exponent": exponent}, "specimen": {**MODEL["specimen"], "radius": f"{30 + i} mm"}}
        for i, exponent in enumerate([5] * 9 + [3, 2.5, 1, 7, 5])
    ]
    together, alone = palpate.ContactStates(models), [palpate.ContactState(model) for model in models]
    for _ in range(60):
        to, dt = rng.uniform(-1e-3, 8e-3, len(models)), rng.uniform(0.0, 0.05)
        forces = [state.step(dt, place) for state, place in zip(alone, to)]
        np.testing.assert_allclose(together.step(dt, to), forces, rtol=1e-11, atol=1e-12)
        assert together.is_touching.tolist() == [state.is_touching for state in alone]


def test_models_that_are_alike_are_one_and_the_first_wrong_one_is_refused() -> None:
    odd = {**MODEL, "specimen": {**MODEL["specimen"], "radius": "35"}}
    assert len(palpate.ContactStates([MODEL] * 5000)) == 5000
    with pytest.raises(palpate.OptionError, match="specimen.radius"):
        palpate.ContactStates([MODEL, odd, MODEL])
