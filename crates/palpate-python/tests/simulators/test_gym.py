"""The environments of palpate.gym: gymnasium's own checks, seeds, masks, ends, and actions that are none. Takes some seconds."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest

gymnasium = pytest.importorskip("gymnasium")

import palpate.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402
from palpate.gym import SoftGripTask, SoftGripVectorEnv  # noqa: E402

CONTROLS = ["position", "force", "impedance"]
RANGES: dict[str, tuple[float, float]] = {"modulus_pa": (2e4, 4e4), "radius_m": (0.03, 0.04), "exponent": (3.0, 5.0), "mass_kg": (0.1, 0.3), "friction": (0.4, 0.8)}


def pushed(envs: SoftGripVectorEnv, share: float) -> np.ndarray[Any, Any]:
    """Actions of one share of the most that can be commanded."""
    return np.full((envs.num_envs, 1), 2.0 * share - 1.0, np.float32)


@pytest.mark.parametrize("control", CONTROLS)
def test_gymnasium_accepts_the_environment(control: str) -> None:
    env = gymnasium.make("palpate/SoftGrip-v0", control=control)
    check_env(env.unwrapped)
    assert env.spec is not None and env.spec.max_episode_steps == 500


def test_make_vec_makes_the_vector_environment() -> None:
    envs = gymnasium.make_vec("palpate/SoftGrip-v0", num_envs=6, ranges=RANGES)
    assert isinstance(envs.unwrapped, SoftGripVectorEnv) and envs.num_envs == 6
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    observations, infos = envs.reset(seed=1)
    assert observations in envs.observation_space and infos == {}
    envs.action_space.seed(1)
    for _ in range(20):
        observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
        assert observations in envs.observation_space and observations.dtype == np.float32
        assert rewards.shape == terminations.shape == truncations.shape == (6,) and terminations.dtype == np.bool_


def test_a_body_that_is_bonded_to_its_jaws_is_refused() -> None:
    # It pulled with 13 N while the jaws opened, slipped under no load, and the force below 0 was rewarded.
    block = {
        "specimen": {"shape": "block", "area": "9 cm^2", "length": "40 mm", "modulus": "30 kPa"},
        "law": {"name": "latency", "exponent": 4, "rate_coefficient": "1e3 /s"},
    }
    for specimen in (block["specimen"], {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}):
        for law in (block["law"], {"name": "prony", "terms": [{"overshoot": 1.0, "time": "2 s"}]}):
            model = {"specimen": specimen, "law": law}
            SoftGripVectorEnv(2, model={**model, "contact": {"separation": True}})
            with pytest.raises(palpate.ModelError, match="separation = false in the material: .* fingers can only press\n.*separation = true"):
                SoftGripVectorEnv(2, model={**model, "contact": {"separation": False}})


def test_ranges_whose_ends_make_no_body_are_refused_at_once() -> None:
    # Such draws were repeated: the largest was 0.035 m for 0.1, and of 10 resets of 4096 environments 6 raised.
    expected = (
        "ranges: expected a body at both ends of each, found none at layer_thickness_m = 0.1: layer_thickness_m: "
        "layer thickness must be above 0 m and at most the depth of 0.035 m, found 0.1 m\nhint: narrow the range"
    )
    with pytest.raises(palpate.ModelError) as refused:
        SoftGripVectorEnv(2, ranges={"layer_thickness_m": (1e-3, 0.1)})
    assert str(refused.value) == expected
    # Each end alone is one, both together are not.
    with pytest.raises(palpate.ModelError, match="found none at radius_m = 0.01, layer_thickness_m = 0.02: .*at most the depth of 0.01 m"):
        SoftGripVectorEnv(2, ranges={"radius_m": (0.01, 0.04), "layer_thickness_m": (1e-3, 0.02)})
    with pytest.raises(palpate.ModelError, match="exponent: the body and its law have no such parameter"):
        law = {"name": "prony", "terms": [{"overshoot": 1.0, "time": "2 s"}]}
        SoftGripVectorEnv(2, model={"specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}, "law": law}, ranges={"exponent": (2, 3)})


def test_ranges_are_drawn_evenly_up_to_the_largest_that_is_a_body() -> None:
    envs = SoftGripVectorEnv(4096, ranges={"layer_thickness_m": (1e-3, 0.035)})
    envs.reset(seed=0)
    shares = np.sort((envs.bodies.of_body["layer_thickness_m"] - 1e-3) / 0.034)
    # Kolmogorov and Smirnov's distance at 0.1 %.
    assert np.abs(shares - (np.arange(4096) + 0.5) / 4096).max() < 1.95 / np.sqrt(4096)


def run(seed: int, mode: AutoresetMode = AutoresetMode.NEXT_STEP, steps: int = 120, **settings: Any) -> list[Any]:
    envs = SoftGripVectorEnv(32, autoreset_mode=mode, ranges=RANGES, max_episode_steps=50, **settings)
    found: list[Any] = [envs.reset(seed=seed)[0]]
    actions = np.random.default_rng(9)
    for _ in range(steps):
        observations, rewards, terminations, truncations, _ = envs.step(actions.uniform(-1, 1, (32, 1)).astype(np.float32))
        found += [observations, rewards, terminations, truncations]
    return found


@pytest.mark.parametrize("control", CONTROLS)
def test_a_seed_makes_the_same_episodes(control: str) -> None:
    first, again, other = (run(seed, control=control) for seed in (3, 3, 4))
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert not all(np.array_equal(a, b) for a, b in zip(first, other, strict=True))


@pytest.mark.parametrize("control", CONTROLS)
def test_one_environment_is_one_of_many(control: str) -> None:
    settings: dict[str, Any] = {"control": control, "mass_kg": 0.15}
    envs, env = SoftGripVectorEnv(3, **settings), palpate.gym.SoftGripEnv(**settings)
    (observations, _), (observation, _) = envs.reset(seed=0), env.reset(seed=0)
    rng = np.random.default_rng(2)
    for _ in range(100):
        action = rng.uniform(-1, 0.5, (1, 1)).astype(np.float32)
        observations, rewards, terminations, _, _ = envs.step(np.repeat(action, 3, axis=0))
        observation, reward, terminated, _, _ = env.step(action[0])
        assert np.array_equal(observations, np.repeat(observation[None], 3, axis=0)) and (rewards == reward).all()
        if terminated:
            assert terminations.all()
            break


@pytest.mark.parametrize("mass_kg", [0.1, 0.2])
def test_the_force_that_is_needed_holds_and_less_does_not(mass_kg: float) -> None:
    task = SoftGripTask(control="force", mass_kg=mass_kg)
    for share, holds in ((1.05, True), (0.95, False)):
        envs = SoftGripVectorEnv(2, max_episode_steps=None, control="force", mass_kg=mass_kg)
        envs.reset(seed=0)
        lost, infos = np.zeros(2, np.bool_), dict[str, Any]()
        observations: Any = None
        for _ in range(250):
            observations, _, terminations, _, infos = envs.step(pushed(envs, share * task.needed_force_n() / task.force_n))
            lost |= terminations
            if terminations.any():
                break
        assert lost.all() != holds and infos["lost"].all() != holds
        if holds:
            # The body creeps, and the finger follows until its force is the one that was commanded.
            assert infos["force_n"] == pytest.approx([share * task.needed_force_n()] * 2, rel=1e-2)
            assert observations[0, 2] == pytest.approx(task.needed_force_n() / task.force_n, rel=1e-6)


def stated(task: SoftGripTask, share: float, time_s: float, step_s: float) -> np.ndarray[Any, Any]:
    """Forces at the end of every period by the equation of the finger as the class states it, in Euler steps of a contact by itself."""
    contact, place, force, forces = palpate.ContactState(task.model), 0.0, 0.0, []
    each = round(task.period_s / step_s)
    for k in range(1, round(time_s / step_s) + 1):
        spring = task.stiffness_n_per_m * (share * task.travel_m - place)
        speed = ((share * task.force_n if task.control == "force" else spring) - force) / task.damping_n_s_per_m
        speed = min(max(speed, -task.speed_m_per_s), task.speed_m_per_s)
        place = min(max(place + step_s * speed, 0.0), task.travel_m)
        force = contact.step(step_s, place)
        if k % each == 0:
            forces.append(force)
    return np.array(forces)


BLOCK = {
    "specimen": {"shape": "block", "area": "10 cm^2", "length": "50 mm", "modulus": "30 kPa"},
    "law": {"name": "latency", "exponent": 3, "rate_coefficient": "200 /s"},
}


@pytest.mark.parametrize(
    ("settings", "share"),
    [({"control": "force"}, 0.3), ({"control": "impedance"}, 0.5), ({"control": "force", "damping_n_s_per_m": 2.0, "model": BLOCK}, 0.3)],
)
def test_a_finger_moves_by_the_equation_that_is_stated(settings: dict[str, Any], share: float) -> None:
    """One linear step a period was taken: 13 % less force than by the equation after 0.1 s, whatever the substeps."""
    task = SoftGripTask(mass_kg=0.05, **settings)
    exact = 2.0 * stated(task, share, 0.2, 2e-5) - stated(task, share, 0.2, 4e-5)

    def errors(substeps: int) -> np.ndarray[Any, Any]:
        envs = SoftGripVectorEnv(1, substeps=substeps, mass_kg=0.05, **settings)
        envs.reset(seed=0)
        forces = np.array([float(envs.step(pushed(envs, share))[4]["force_n"][0]) for _ in exact])
        off: np.ndarray[Any, Any] = np.abs(forces / exact - 1.0)
        return off

    usual, finer, finest = errors(SoftGripTask.substeps), errors(32), errors(128)
    assert usual.max() < 1e-2 and usual[4] < 5e-3
    # Of order 2: 8 and 32 times the substeps.
    assert finer.max() < usual.max() / 16 and finest.max() < max(usual.max() / 200, 1e-4)


def test_a_finger_without_much_resistance_goes_to_its_force_at_once() -> None:
    envs = SoftGripVectorEnv(1, control="force", damping_n_s_per_m=1e-6, mass_kg=0.05, speed_m_per_s=10.0)
    envs.reset(seed=0)
    forces = [float(envs.step(pushed(envs, 0.3))[4]["force_n"][0]) for _ in range(10)]
    assert forces[3:] == pytest.approx([3.0] * 7, rel=1e-3)


def test_a_squeeze_relaxes_until_it_lets_go() -> None:
    squeeze_m = 5.5e-3
    envs = SoftGripVectorEnv(1, max_episode_steps=None, mass_kg=0.2, lift_s=0.3, lift_takes_s=0.01)
    envs.reset(seed=0)
    alone, place, forces, infos = palpate.ContactState(envs.task.model), 0.0, [], dict[str, Any]()
    for _ in range(1000):
        _, _, terminations, _, infos = envs.step(pushed(envs, squeeze_m / envs.task.travel_m))
        forces.append(float(infos["force_n"][0]))
        # The contact of the environment is that of ContactState, in four parts a step.
        way = np.linspace(place, min(squeeze_m, place + envs.task.speed_m_per_s * envs.task.period_s), 5)[1:]
        last = [alone.step(envs.task.period_s / 4, float(to)) for to in way][-1]
        place = float(way[-1])
        assert forces[-1] == pytest.approx(last, rel=1e-5)
        if terminations.any():
            break
    assert 2.0 < 0.02 * len(forces) < 15.0 and max(forces) > envs.task.needed_force_n() > forces[-1]
    assert infos["lost"][0] and not infos["crushed"][0] and infos["slip_m"][0] > envs.task.slip_limit_m


def test_too_much_force_crushes() -> None:
    envs = SoftGripVectorEnv(4, crush_force_n=3.0)
    envs.reset(seed=0)
    rewards, infos = np.empty(0), dict[str, Any]()
    for _ in range(50):
        _, rewards, terminations, _, infos = envs.step(pushed(envs, 1.0))
        if terminations.any():
            break
    assert infos["crushed"].all() and not infos["lost"].any() and (infos["force_n"] > 3.0).all()
    assert rewards == pytest.approx(1.0 - 0.5 * infos["force_n"] / 10.0 - 10.0)


def test_a_jaw_that_would_go_beyond_the_body_crushes_it() -> None:
    # It stayed at 0, with a reward of 1.
    envs = SoftGripVectorEnv(1, travel_m=0.1, speed_m_per_s=5.0)
    envs.reset(seed=0)
    _, rewards, terminations, _, infos = envs.step(pushed(envs, 1.0))
    assert terminations[0] and infos["crushed"][0] and not infos["lost"][0] and rewards[0] == 1.0 - 10.0


@pytest.mark.parametrize("lift_takes_s", [0.02, 0.5])
def test_slip_does_not_depend_on_the_time_of_a_step(lift_takes_s: float) -> None:
    def slips(period_s: float) -> np.ndarray[Any, Any]:
        envs = SoftGripVectorEnv(
            1, max_episode_steps=None, period_s=period_s, mass_kg=0.2, lift_s=0.3, lift_takes_s=lift_takes_s, slip_limit_m=1.0
        )
        envs.reset(seed=0)
        # A squeeze that is not enough, and one that catches the body again.
        moves = [(0.2, 45), (0.4, 15)]
        found = []
        for share, steps in moves:
            for _ in range(round(steps * 0.02 / period_s)):
                infos = envs.step(pushed(envs, share))[4]
                found.append(float(infos["slip_m"][0]))
        return np.array(found)

    coarse, fine = slips(0.02), slips(5e-4)[39::40]
    assert fine[-1] == fine[-2] > 2e-3
    np.testing.assert_allclose(coarse, fine, rtol=0.02, atol=0.02 * 1e-3)


@pytest.mark.parametrize("control", CONTROLS)
def test_an_action_of_nan_leaves_the_command_and_one_beyond_is_the_most(control: str) -> None:
    plain, odd = (SoftGripVectorEnv(4, control=control) for _ in range(2))
    plain.reset(seed=0)
    odd.reset(seed=0)
    for k in range(60):
        action = pushed(plain, 0.3)
        other = action.copy()
        if k > 5:
            other[1] = np.nan
        expected, found = plain.step(action), odd.step(other)
        assert all(np.array_equal(np.asarray(a), np.asarray(b)) for a, b in zip(expected[:4], found[:4], strict=True))
    expected, found = plain.step(pushed(plain, 1.0)), odd.step(np.full((4, 1), np.inf))
    assert np.array_equal(expected[0], found[0])
    for wrong in (np.zeros(4), np.zeros((3, 1)), np.zeros((4, 2))):
        with pytest.raises(palpate.OptionError, match=r"actions: expected an array of shape \(4, 1\)"):
            plain.step(wrong)


def dropping(mode: AutoresetMode) -> SoftGripVectorEnv:
    """Two that are squeezed may hold, two that are not are lost soon."""
    envs = SoftGripVectorEnv(4, autoreset_mode=mode, lift_s=0.0, lift_takes_s=0.02, max_episode_steps=40)
    envs.reset(seed=0)
    return envs


SQUEEZED = np.array([[0.0], [-1.0], [0.0], [-1.0]], np.float32)


def until_lost(envs: SoftGripVectorEnv) -> tuple[Any, ...]:
    for _ in range(40):
        found = envs.step(SQUEEZED)
        if found[2].any():
            return found
    raise AssertionError("none was lost")


def test_a_mode_has_a_name_and_a_value() -> None:
    for mode in AutoresetMode:
        for word in (mode, mode.name, mode.value):
            assert SoftGripVectorEnv(1, autoreset_mode=word).autoreset_mode is mode
    with pytest.raises(palpate.OptionError, match="autoreset_mode: expected one of NEXT_STEP, SAME_STEP, DISABLED, found 'next'"):
        SoftGripVectorEnv(1, autoreset_mode="next")


def test_the_next_step_begins_an_episode() -> None:
    envs = dropping(AutoresetMode.NEXT_STEP)
    observations, _, terminations, _, infos = until_lost(envs)
    lost = terminations.copy()
    # A step that is refused was the first of the episode.
    with pytest.raises(palpate.OptionError):
        envs.step(np.zeros(4))
    assert lost[[1, 3]].all() and "final_obs" not in infos and (observations[lost, 2] > 0).all()
    observations, rewards, terminations, truncations, _ = envs.step(SQUEEZED)
    assert not observations[lost].any() and not rewards[lost].any() and not (terminations | truncations)[lost].any()
    assert (observations[~lost, 3] > 0).all()
    observations, rewards, *_ = envs.step(SQUEEZED)
    assert observations[lost, 3] == pytest.approx(1 / 40) and (rewards[lost] > 0).all()


def test_the_same_step_begins_an_episode_and_keeps_the_last_observation() -> None:
    envs, plain = dropping(AutoresetMode.SAME_STEP), dropping(AutoresetMode.NEXT_STEP)
    (observations, rewards, terminations, _, infos), expected = until_lost(envs), until_lost(plain)
    lost = terminations
    assert np.array_equal(lost, expected[2]) and np.array_equal(rewards, expected[1])
    assert np.array_equal(infos["_final_obs"], lost) and np.array_equal(infos["final_obs"], expected[0])
    assert not observations[lost].any() and np.array_equal(observations[~lost], expected[0][~lost])
    observations, *_ = envs.step(SQUEEZED)
    assert observations[lost, 3] == pytest.approx(1 / 40)


def test_a_mask_begins_episodes_where_nothing_else_does() -> None:
    envs = dropping(AutoresetMode.DISABLED)
    observations, _, terminations, _, _ = until_lost(envs)
    mask = np.array([False, True, False, False])
    observations, _ = envs.reset(options={"reset_mask": mask})
    assert not observations[1].any() and observations[[0, 2, 3], 3].all()
    for wrong in ([True], np.zeros(4)):
        with pytest.raises(palpate.OptionError, match="reset_mask: expected 4 truth values"):
            envs.reset(options={"reset_mask": wrong})


def test_episodes_are_truncated() -> None:
    envs = SoftGripVectorEnv(3, max_episode_steps=7)
    envs.reset(seed=0)
    ends = [envs.step(pushed(envs, 0.5))[3].tolist() for _ in range(16)]
    # The eighth step is the reset.
    assert [index for index, end in enumerate(ends, 1) if all(end)] == [7, 15]


def test_bodies_are_drawn_by_episode_from_ranges() -> None:
    envs = SoftGripVectorEnv(500, ranges=RANGES)
    envs.reset(seed=5)
    columns = {**envs.bodies.of_body, "mass_kg": envs.bodies.mass_kg, "friction": envs.bodies.friction}
    assert set(columns) == set(RANGES)
    for name, (low, high) in RANGES.items():
        assert low <= columns[name].min() < low + 0.05 * (high - low) and high - 0.05 * (high - low) < columns[name].max() <= high, name
    before = {name: values.copy() for name, values in columns.items()}
    envs.reset(options={"reset_mask": np.arange(500) < 10})
    for name, values in columns.items():
        assert (values[:10] != before[name][:10]).all() and np.array_equal(values[10:], before[name][10:]), name
    # A stiffer body has more force at the same squeeze.
    for _ in range(20):
        envs.step(pushed(envs, 0.2))
    model = {"specimen": {"shape": "ball", "radius_m": float(columns["radius_m"][7]), "modulus_pa": float(columns["modulus_pa"][7])}}
    law = {"name": "latency", "exponent": float(columns["exponent"][7]), "rate_coefficient_per_s": 2e4}
    alone = palpate.ContactStates({**model, "law": law}, 1)
    alone.state = envs.contacts.state[7:8]
    assert alone.force_n[0] == pytest.approx(envs.contacts.force_n[7], rel=1e-12)


def calibrated() -> palpate.Material:
    made = palpate.simulate({**palpate.gym.SoftGripTask().model, "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "20 s"}, {"to": "9 mm", "rate": "500 mm/min", "hold": "20 s"}]})
    noise = np.random.default_rng(1).normal(0.0, 0.02, len(made.force_n))
    record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n + noise)
    return record.calibrate(test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[]).material


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_bodies_are_drawn_from_the_covariance_of_a_calibration() -> None:
    material = calibrated()
    envs = SoftGripVectorEnv(4000, model=material, posterior=True)
    envs.reset(seed=2)
    assert material.log_covariance is not None
    logs = np.log([envs.bodies.of_body[name] for name in material.parameters])
    root = np.sqrt(np.diag(material.log_covariance))
    assert np.abs(logs.mean(axis=1) - np.log(list(material.parameters.values()))) == pytest.approx(0 * root, abs=0.1 * root.max())
    np.testing.assert_allclose(np.corrcoef(logs), material.log_covariance / np.outer(root, root), atol=0.1)
    np.testing.assert_allclose(logs.std(axis=1), root, rtol=0.06)
    envs.step(pushed(envs, 0.3))


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_a_parameter_is_drawn_from_the_covariance_or_from_a_range_but_not_from_both() -> None:
    material = calibrated()
    found = "ranges: expected no parameter that posterior=True draws, found modulus_pa\nhint: leave modulus_pa"
    with pytest.raises(palpate.OptionError, match=found):
        SoftGripVectorEnv(3, model=material, posterior=True, ranges={"modulus_pa": (2e4, 4e4)})
    # What the material does not have comes from its range.
    envs = SoftGripVectorEnv(100, model=material, posterior=True, ranges={"radius_m": (0.03, 0.04), "mass_kg": (0.1, 0.2)})
    envs.reset(seed=1)
    assert set(envs.bodies.of_body) == {*material.parameters, "radius_m"}
    assert np.ptp(envs.bodies.of_body["radius_m"]) > 0.008 and np.ptp(envs.bodies.mass_kg) > 0.08


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
def test_a_file_of_a_material_has_its_covariance(tmp_path: Path) -> None:
    path = tmp_path / "material.toml"
    calibrated().write(path)
    envs = SoftGripVectorEnv(3, model=path, posterior=True)
    envs.reset(seed=1)
    assert len(np.unique(envs.bodies.of_body["modulus_pa"])) == 3


@pytest.mark.parametrize("steps", [100, 1000])
def test_the_time_that_is_observed_is_that_of_the_episode_however_it_is_made(steps: int) -> None:
    # `gymnasium.make` does not pass the length on: the time went to 0.2 within 100 steps, and was 1 from step 500 of 1000 on.
    env = gymnasium.make("palpate/SoftGrip-v0", max_episode_steps=steps, span_steps=steps, control="force", mass_kg=0.01)
    envs = gymnasium.make_vec("palpate/SoftGrip-v0", 1, max_episode_steps=steps, control="force", mass_kg=0.01)
    env.reset(seed=0)
    envs.reset(seed=0)
    truncated = False
    action = np.array([-0.2], np.float32)
    for step in range(1, steps + 1):
        observed, _, _, truncated, _ = env.step(action)
        of_vector = envs.step(action[None])[0]
        assert observed[3] == of_vector[0, 3] == pytest.approx(step / steps, rel=1e-6)
    assert truncated


def test_draws_from_a_posterior_that_are_no_body_are_repeated() -> None:
    # Layers cannot be thicker than the ball of 35 mm: half of the draws are none.
    material = palpate.Material.read(Path(__file__).resolve().parents[4] / "examples/records/ball-material.toml")
    envs = SoftGripVectorEnv(300, model=material, posterior=True, ranges={"mass_kg": (0.1, 0.2)})
    assert envs.bodies.posterior is not None
    names, mean, root = envs.bodies.posterior
    layer = names.index("layer_thickness_m")
    mean[layer], root[layer] = np.log(0.035), 0.05
    envs.reset(seed=1)
    thickness = envs.bodies.of_body["layer_thickness_m"]
    assert thickness.max() <= 0.035 and len(np.unique(thickness)) == 300
    shares = np.sort((envs.bodies.mass_kg - 0.1) / 0.1)
    assert np.abs(shares - (np.arange(300) + 0.5) / 300).max() < 1.95 / np.sqrt(300)
    with pytest.raises(palpate.ModelError, match="layer thickness must be above 0 m and at most the depth"):
        SoftGripVectorEnv(2, ranges={"layer_thickness_m": (0.04, 0.05)})


@pytest.mark.parametrize(
    ("settings", "text"),
    [
        ({"control": "torque"}, "control is one of"),
        ({"mass_kg": -1.0}, "mass_kg: expected a number above 0, found -1.0"),
        ({"friction": float("nan")}, "friction: expected a number above 0"),
        ({"substeps": 0}, "substeps: expected a whole number"),
        ({"posterior": True}, "posterior: expected a palpate.Material"),
        ({"ranges": {"stiffness": (1, 2)}}, "ranges: expected names among modulus_pa"),
        ({"ranges": {"mass_kg": (2, 1)}}, "ranges: mass_kg: expected a lower and an upper end"),
        ({"ranges": {"mass_kg": 1}}, "ranges: mass_kg: expected a lower and an upper end, found 1"),
        ({"frictoin": 0.5}, "settings: expected names among model, control, .*, found frictoin"),
        ({"num_envs": 0}, "num_envs: expected a whole number, 1 or more"),
        ({"model": {"specimen": {"shape": "ball"}}}, "law"),
    ],
)
def test_settings_that_are_none_are_refused(settings: dict[str, Any], text: str) -> None:
    with pytest.raises(palpate.PalpateError, match=text):
        SoftGripVectorEnv(**settings)


def test_the_code_of_the_guide_runs() -> None:
    root = Path(__file__).parents[4]
    blocks = (root / "docs/guides/simulators-learning.md").read_text(encoding="utf-8").split("```python\n")[1:]
    assert len(blocks) > 2
    code = "\n".join(block.split("```")[0] for block in blocks)
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
