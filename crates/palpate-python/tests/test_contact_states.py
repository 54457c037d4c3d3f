"""Many contacts in one step: in place, by parts, with a mask, with values of each, under linear laws."""

from __future__ import annotations

import copy
import pickle
import threading
from typing import Any

import numpy as np
import palpate
import pytest

MODEL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
PRONY: dict[str, Any] = {
    "specimen": {"shape": "block", "area": "10 cm^2", "length": "50 mm", "modulus": "30 kPa"},
    "law": {"name": "prony", "terms": [{"overshoot": 1.0, "time": "2 s"}, {"overshoot": 0.5, "time": "0.1 s"}]},
}


def test_a_step_writes_into_the_array_that_is_given() -> None:
    contacts, plain = palpate.ContactStates(MODEL, 20), palpate.ContactStates(MODEL, 20)
    to, out = np.linspace(1e-3, 5e-3, 20), np.full(20, np.nan)
    assert contacts.step(0.1, to, out=out) is out and np.array_equal(out, plain.step(0.1, to))
    assert contacts.step_force(0.1, 1.0, out) is out and np.array_equal(out, plain.step_force(0.1, 1.0))
    read_only = np.empty(20)
    read_only.flags.writeable = False
    for wrong in (np.empty(19), np.empty(20, np.float32), np.empty(40)[::2], [0.0] * 20, read_only, contacts.state[:, 0]):
        with pytest.raises(palpate.OptionError, match="out: expected a writable array of 20 doubles one behind the other"):
            contacts.step(0.1, to, out=wrong)  # type: ignore[arg-type]
    assert contacts == plain
    # What is read may be what is written to, or the state itself.
    before = contacts.step(0.1, contacts.state[:, 0].copy() * 2)
    assert np.array_equal(before, contacts.step(0.0, contacts.state[:, 0] * 2))


def test_the_state_is_an_array_in_place() -> None:
    contacts = palpate.ContactStates(MODEL, 4)
    state = contacts.state
    assert state.shape == (4, 2) and not state.any()
    contacts.step(0.5, [1e-3, 2e-3, 3e-3, 4e-3])
    assert np.allclose(state[:, 0], [5e-4, 1e-3, 1.5e-3, 2e-3], rtol=1e-15)
    # What is written is the state.
    other = palpate.ContactStates(MODEL, 4)
    other.state[...] = state
    assert other == contacts and np.array_equal(other.force_n, contacts.force_n)
    other.state = state[::-1]
    assert np.array_equal(other.force_n, contacts.force_n[::-1])
    other.state = other.state
    for wrong in (np.zeros((2, 4)), np.zeros(8), np.full((4, 2), np.nan), "no"):
        with pytest.raises((palpate.OptionError, palpate.ModelError), match="shape|finite"):
            other.state = wrong
    assert np.array_equal(other.force_n, contacts.force_n[::-1])


def test_a_jaw_written_beyond_the_body_has_no_force() -> None:
    """The formulas went on: −6032 N at 0.1 m of a ball of 35 mm."""
    contacts = palpate.ContactStates(MODEL, 3)
    contacts.step(0.5, 5e-3)
    contacts.state[0] = [0.1, 0.0]
    assert np.isnan(contacts.force_n).tolist() == np.isnan(contacts.stiffness_n_per_m).tolist() == [True, False, False]
    # It keeps its state in a step that fails, without a force, and goes on with one that it can take.
    forces = contacts.step(0.1, [1.0, 5e-3, 5e-3], errors="mask")
    assert forces[0] == 0.0 and contacts.failed.tolist() == [True, False, False] and contacts.state[0, 0] == 0.1
    contacts.step(0.1, 5e-3)
    assert np.isfinite(contacts.force_n).all()


def test_one_contact_shows_what_contacts_show() -> None:
    one, many = palpate.ContactState(MODEL), palpate.ContactStates(MODEL, 9)
    one.step(0.0, 7e-3)
    many.step(0.0, 7e-3)
    # 3.5 mm of each contact over a layer of 35/8 mm, of which 3.5/35 stays.
    assert one.excess_strain == pytest.approx(0.7, abs=1e-14)
    assert one.stiffness_n_per_m == pytest.approx(many.stiffness_n_per_m[8], rel=1e-14)
    assert one.force_n == many.force_n[8]
    step_m = 1e-7
    slope = (copy.copy(one).step(0.0, 7e-3 + step_m) - copy.copy(one).step(0.0, 7e-3 - step_m)) / (2 * step_m)
    assert one.stiffness_n_per_m == pytest.approx(slope, rel=1e-6)


def test_a_changed_base_of_the_state_is_refused() -> None:
    contacts = palpate.ContactStates(MODEL, 4)
    base: Any = contacts.state.base
    base.dtype = np.float32
    with pytest.raises(palpate.OptionError, match="found it changed"):
        contacts.step(0.1, 1e-3)
    base.dtype = np.float64
    contacts.step(0.1, 1e-3)


def test_substeps_are_steps() -> None:
    for model in (MODEL, PRONY):
        contacts, plain = palpate.ContactStates(model, 9), palpate.ContactStates(model, 9)
        to, forces = np.linspace(1e-3, 5e-3, 9), np.empty(0)
        for k in range(1, 11):
            forces = plain.step(0.01, to * k / 10)
        np.testing.assert_allclose(contacts.step(0.1, to, substeps=10), forces, rtol=1e-12)
    for wrong in (0, -1, 10**7, 10**30, 1.5, "two"):
        with pytest.raises(palpate.OptionError, match=f"substeps: expected a whole number from 1 to 1000000, found {wrong}"):
            contacts.step(0.1, to, substeps=wrong)  # type: ignore[arg-type] # pyright: ignore


@pytest.mark.parametrize("model", [MODEL, PRONY])
def test_masked_contacts_keep_their_state_and_force(model: dict[str, Any]) -> None:
    contacts = palpate.ContactStates(model, 30)
    before = contacts.step(0.1, 2e-3)
    to = np.full(30, 3e-3)
    to[[4, 9, 11]] = [np.nan, np.inf, 1.0]
    contacts.state[20, 1] = np.nan
    old = contacts.state.copy()
    with pytest.raises(palpate.ModelError, match="contact 4: displacement must be a finite number"):
        contacts.step(0.1, to)
    assert np.array_equal(contacts.state, old, equal_nan=True)
    forces = contacts.step(0.1, to, errors="mask")
    failed = [4, 9, 11, 20]
    assert np.flatnonzero(contacts.failed).tolist() == failed and np.isfinite(forces).all()
    np.testing.assert_allclose(forces[failed], [*before[[4, 9, 11]], 0.0], rtol=1e-14)
    assert np.array_equal(contacts.state[failed], old[failed], equal_nan=True)
    assert (np.delete(forces, failed) > before[0]).all()
    contacts.reset(contacts.failed)
    assert not contacts.state[failed].any() and contacts.state[[0, 29]].all()
    contacts.step(0.1, 1e-3)
    assert not contacts.failed.any()
    # By force too: nothing carries that much.
    places = contacts.step_force(0.1, [1e9] + [0.1] * 29, errors="mask")
    assert contacts.failed.tolist() == [True] + [False] * 29 and places[0] == pytest.approx(1e-3)
    contacts.reset()
    assert not contacts.state.any()
    with pytest.raises(palpate.OptionError, match='errors is one of "raise", "mask", found "ignore"'):
        contacts.step(0.1, 1e-3, errors="ignore")  # type: ignore[arg-type]
    for wrong in ([True], np.zeros(30), "yes"):
        with pytest.raises(palpate.OptionError, match="mask: expected 30 truth values"):
            contacts.reset(wrong)


@pytest.mark.parametrize("dt", [-1.0, np.nan, np.inf])
def test_time_steps_that_are_none_are_refused_or_masked(dt: float) -> None:
    contacts = palpate.ContactStates(MODEL, 3)
    forces = contacts.step(0.1, 2e-3)
    with pytest.raises(palpate.ModelError, match="contact 0: time step must be a finite number of 0 s or more"):
        contacts.step(dt, 3e-3)
    assert np.array_equal(contacts.step(dt, 3e-3, errors="mask"), forces) and contacts.failed.all()
    # Any other is a step: no time at all, and more than any body takes.
    assert (contacts.step(0.0, 3e-3) > forces).all() and np.isfinite(contacts.step(1e300, 3e-3)).all()


def test_values_of_each_contact_are_descriptions_of_each() -> None:
    rng = np.random.default_rng(1)
    modulus, radius, exponent = rng.uniform(1e4, 1e5, 17), rng.uniform(0.03, 0.05, 17), rng.uniform(2, 6, 17)
    rate, thickness = 10 ** rng.uniform(0, 4, 17), rng.uniform(2e-3, 6e-3, 17)
    contacts = palpate.ContactStates(
        MODEL, modulus_pa=modulus, radius_m=radius, exponent=exponent, rate_coefficient_per_s=rate, layer_thickness_m=thickness
    )
    models = [
        {
            "specimen": {"shape": "ball", "radius_m": radius[i], "modulus_pa": modulus[i]},
            "law": {"name": "latency", "exponent": exponent[i], "rate_coefficient_per_s": rate[i]},
            "contact": {"layer_thickness_m": thickness[i]},
        }
        for i in range(17)
    ]
    each = palpate.ContactStates(models)
    assert len(contacts) == 17
    for k in range(1, 20):
        to = 5e-4 * k * rng.uniform(0.5, 1.0, 17)
        np.testing.assert_allclose(contacts.step(0.01, to), each.step(0.01, to), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(contacts.stiffness_n_per_m, each.stiffness_n_per_m, rtol=1e-12)
    np.testing.assert_allclose(contacts.step_force(0.1, 1.0), each.step_force(0.1, 1.0), rtol=1e-12)
    # Other values in the middle, of some.
    mask = np.arange(17) == 5
    contacts.reset(mask, modulus_pa=2 * modulus)
    forces = contacts.step(0.0, 1e-3)
    each.reset(mask)
    assert forces[5] == pytest.approx(2 * each.step(0.0, 1e-3)[5], rel=1e-12)
    with pytest.raises(palpate.ModelError, match="exponent, contact 5: exponent n must be a number above 0"):
        contacts.reset(mask, exponent=-1.0)


def test_values_that_are_none_are_refused() -> None:
    wrong: list[tuple[dict[str, Any], type[Exception], str]] = [
        ({"modulus_pa": [1e4, -1.0, 1e4]}, palpate.ModelError, "modulus_pa, contact 1: modulus must be above 0 Pa, found -1 Pa"),
        ({"modulus_pa": [1e4, 1e4]}, palpate.OptionError, "modulus_pa: expected one number or 3, one a contact, found 2"),
        ({"layer_thickness_m": 1.0}, palpate.ModelError, "layer thickness must be above 0 m"),
        ({"exponent": "five"}, palpate.OptionError, "exponent"),
    ]
    for values, kind, text in wrong:
        with pytest.raises(kind, match=text):
            palpate.ContactStates(MODEL, 3, **values)
    with pytest.raises(palpate.OptionError, match="count: expected how many contacts"):
        palpate.ContactStates(MODEL, modulus_pa=1e4)
    with pytest.raises(palpate.OptionError, match="modulus_pa: values for each contact need one model for all"):
        palpate.ContactStates([MODEL, MODEL], modulus_pa=[1e4, 2e4])
    with pytest.raises(palpate.ModelError, match="exponent: the body and its law have no such parameter"):
        palpate.ContactStates(PRONY, 2, exponent=2.0)
    with pytest.raises(palpate.ModelError, match="contact 1: expected a law of the kind of contact 0"):
        palpate.ContactStates([MODEL, PRONY])
    varying = {**MODEL, "law": {**MODEL["law"], "strain_factor": 0.5}}
    with pytest.raises(palpate.ModelError, match="contact is stepped by a latency law with one rate coefficient"):
        palpate.ContactStates(varying, 2)


@pytest.mark.parametrize("memory", ["strain", "force"])
def test_linear_contacts_follow_simulate(memory: str) -> None:
    for specimen in (PRONY["specimen"], MODEL["specimen"]):
        scene = {"specimen": specimen, "law": {**PRONY["law"], "memory": memory}}
        # Down, held, let go, down again.
        steps = [("6 mm", 20), ("6 mm", 100), ("1 mm", 20), ("1 mm", 60), ("7 mm", 30), ("7 mm", 200)]
        protocol = {
            **scene,
            "step": [{"to": "6 mm", "rate": "30 mm/s", "hold": "1 s"}, {"to": "1 mm", "rate": "25 mm/s", "hold": "0.6 s"}, {"to": "7 mm", "rate": "20 mm/s", "hold": "2 s"}],
            "output": {"sample_rate": "100 Hz"},
        }
        expected = palpate.simulate(protocol)
        contacts = palpate.ContactStates(scene, 3)
        assert contacts.state.shape == (3, 3)
        place, time, found = 0.0, 0.0, []
        for to, count in steps:
            start, target = place, float(to.split()[0]) * 1e-3
            for k in range(1, count + 1):
                place = start + (target - start) * k / count
                time += 0.01
                found.append((time, contacts.step(0.01, place, substeps=10)[1]))
        times, forces = np.array(found).T
        near = np.interp(times, expected.time_s, expected.force_n)
        tolerance = 1e-7 if memory == "strain" or "block" in specimen.values() else 2e-4
        np.testing.assert_allclose(forces, near, atol=tolerance * expected.force_n.max())
        slope = contacts.stiffness_n_per_m
        moved = copy.deepcopy(contacts)
        assert (moved.step(0.0, place + 1e-7)[0] - forces[-1]) / 1e-7 == pytest.approx(slope[0], rel=1e-4)


def test_pickles_and_copies_keep_states_and_values() -> None:
    for contacts in (
        palpate.ContactStates(MODEL, 5),
        palpate.ContactStates(MODEL, exponent=[2.0, 3.0, 4.0], modulus_pa=[1e4, 2e4, 3e4]),
        palpate.ContactStates([PRONY, {**PRONY, "law": {"name": "standard-linear-solid", "overshoot": 2, "time": "1 s"}}]),
    ):
        contacts.step(0.1, 2e-3)
        for other in (pickle.loads(pickle.dumps(contacts)), copy.copy(contacts), copy.deepcopy(contacts)):
            assert other == contacts and other.state is not contacts.state
            assert np.array_equal(other.step(0.1, 3e-3), copy.copy(contacts).step(0.1, 3e-3))
            assert other != contacts


def test_pickles_keep_which_contacts_failed() -> None:
    contacts = palpate.ContactStates(MODEL, 5)
    contacts.step(0.1, [1e-3, 1e-3, np.nan, 1e-3, 1e-3], errors="mask")
    for other in (pickle.loads(pickle.dumps(contacts)), copy.deepcopy(contacts)):
        assert other.failed.tolist() == [False, False, True, False, False] == contacts.failed.tolist()


def test_pickles_of_format_4_are_read() -> None:
    contacts = palpate.ContactStates(MODEL, 3)
    contacts.step(0.1, [1e-3, 2e-3, 3e-3])
    reduced: Any = contacts.__reduce__()
    make, (texts, *_) = reduced
    states = b"".join(b"contact1" + np.array(row, "<f8").tobytes() for row in contacts.state)
    assert make(texts, [states], 4) == contacts
    with pytest.raises(palpate.PalpateError, match="expected a pickle of format 4, found format 3"):
        make(texts, [states], 3)
    with pytest.raises(palpate.ModelError, match="expected states of 24 bytes"):
        make(texts, [states[:-1]], 4)


def test_the_number_of_contacts_changes_no_bit() -> None:
    # More than one core takes at once.
    count = 50_000
    to = np.linspace(-1e-3, 8e-3, count)
    many, few = palpate.ContactStates(MODEL, count), palpate.ContactStates(MODEL, 10)
    for dt in (0.01, 0.1):
        forces = many.step(dt, to, substeps=2)
        some = slice(count - 10, count)
        assert np.array_equal(forces[some], few.step(dt, to[some], substeps=2))
    assert np.array_equal(many.step_force(0.1, 0.5)[some], few.step_force(0.1, 0.5))
    wrong = to.copy()
    wrong[[40_000, 30_000]] = 1.0
    before = many.state.copy()
    with pytest.raises(palpate.ModelError, match="contact 30000"):
        many.step(0.1, wrong)
    assert np.array_equal(many.state, before)
    # So many steps that Ctrl-C is looked for in between.
    with pytest.raises(palpate.ModelError, match="contact 30000"):
        many.step(0.1, wrong, substeps=100)
    assert np.array_equal(many.state, before)
    few.state = many.state[some]
    assert np.array_equal(many.step(0.1, to, substeps=100)[some], few.step(0.1, to[some], substeps=100))


def test_two_threads_cannot_step_one_object_at_once() -> None:
    contacts = palpate.ContactStates(MODEL, 200_000)
    errors: list[BaseException] = []

    def work() -> None:
        for _ in range(20):
            try:
                contacts.step(0.01, 1e-3, substeps=5)
            except RuntimeError as error:
                errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all("borrowed" in str(error) for error in errors)
    assert np.isfinite(contacts.force_n).all() and len(set(contacts.force_n.tolist())) == 1


def test_states_that_no_body_has_are_refused_or_go_on_as_documented() -> None:
    specimen = {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}
    ball = {"specimen": specimen, "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"}}
    linear = {**ball, "law": {"name": "standard-linear-solid", "overshoot": 1.0, "time": "2 s"}}
    for model in (ball, linear):
        contacts = palpate.ContactStates(model, 2)
        # 36 mm at one contact of a ball of 35 mm: its contact area would be that of the other side.
        for number, message in ((0.036, "contact 1: contact displacement must stay below the radius of 0.035 m"), (np.nan, "contact 1: .* finite")):
            with pytest.raises(palpate.ModelError, match=message):
                contacts.state = np.array([[0.0, 0.0], [number, 0.0]])
        assert not contacts.state.any()
    contacts = palpate.ContactStates(ball, 3)
    contacts.state[0] = [np.nan, 0.0]
    contacts.state[1] = [1e9, 0.0]
    contacts.state[2] = [0.5, 0.1]
    assert np.isnan(contacts.force_n).all() and np.isnan(contacts.stiffness_n_per_m).all()
    forces = contacts.step(1e-3, 1e-3, errors="mask")
    assert contacts.failed.tolist() == [True, True, False]
    assert np.isfinite(forces[[0, 2]]).all() and contacts.state[2, 0] == 5e-4
