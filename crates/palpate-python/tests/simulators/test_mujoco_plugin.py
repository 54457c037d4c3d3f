"""The engine plug-ins palpate.contact and palpate.sensor of MuJoCo: forces, states, friction, bad input.

They run where PALPATE_MUJOCO_PLUGIN names the library of ``simulators/mujoco/build.py`` for the installed MuJoCo.
"""

from __future__ import annotations

import copy
import os
import re
import threading
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest
from numpy.typing import NDArray

LIBRARY = os.environ.get("PALPATE_MUJOCO_PLUGIN")
if not LIBRARY:
    pytest.skip("PALPATE_MUJOCO_PLUGIN names no library of simulators/mujoco/build.py", allow_module_level=True)
mujoco = pytest.importorskip("mujoco")
mujoco.mj_loadPluginLibrary(LIBRARY)

ROOT = Path(__file__).resolve().parents[4]
MATERIAL = ROOT / "examples/records/ball-material.toml"

BALL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
DESCRIPTION = """[specimen]
shape = 'ball'
radius = '35 mm'
modulus = '28 kPa'
[law]
name = 'latency'
exponent = 5
rate_coefficient = '2e4 /s'
"""
LINEAR = DESCRIPTION[: DESCRIPTION.index("[law]")] + """[law]
name = 'standard-linear-solid'
overshoot = 1
time = '2 s'
"""
# A soft fingertip of 12 mm radius on a rigid core, pressed from one side.
TIP = """[specimen]
shape = 'pad'
radius = '12 mm'
thickness = '8 mm'
modulus = '100 kPa'
[law]
name = 'latency'
exponent = 3.5
rate_coefficient = '300 /s'
[contact]
layers = 6
squeezed_from = 'one side'
"""

State = NDArray[np.float64]


def instance(name: str, description: str, **keys: object) -> str:
    configured = {"description": description.replace("\n", "&#10;"), **keys}
    lines = "".join(f'<config key="{key}" value="{value}"/>' for key, value in configured.items())
    return f'<instance name="{name}">{lines}</instance>'


def jaw(description: str = DESCRIPTION, option: str = "", **keys: object) -> Any:
    """A jaw on a slide joint that squeezes a body."""
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="0.001" gravity="0 0 0" {option}/>
      <extension>
        <plugin plugin="palpate.contact">{instance("jaw", description, joint="jaw", **keys)}</plugin>
        <plugin plugin="palpate.sensor"/>
      </extension>
      <worldbody><body><joint name="jaw" type="slide"/><geom size="0.01" mass="1" contype="0" conaffinity="0"/></body></worldbody>
      <sensor><plugin name="jaw" plugin="palpate.sensor"><config key="contact" value="jaw"/></plugin></sensor>
    </mujoco>""")


def gripper(gravity: str = "0 0 -9.81", option: str = "", body: str = "", description: str = DESCRIPTION, **keys: object) -> Any:
    """Two fingers that squeeze a ball of 100 g, or the given body, by 5 mm each; the geoms meet at the start."""
    is_tip = bool(body)
    pairs = {side: (("body", side) if is_tip else (side, "body")) for side in ("left", "right")}
    instances = "".join(instance(side, description, geom1=a, geom2=b, **keys) for side, (a, b) in pairs.items())
    sensors = "".join(
        f'<plugin name="{side}" plugin="palpate.sensor"><config key="contact" value="{side}"/></plugin>' for side in pairs
    )
    shape = 'type="sphere" size="0.012"' if is_tip else 'type="box" size="0.01 0.03 0.03"'
    offset = 0.012 + 0.02 if is_tip else 0.045
    fingers = "".join(
        f'<body name="{side}" pos="{sign * offset} 0 0"><joint name="{side}" type="slide" axis="{-sign} 0 0"/>'
        f'<geom name="{side}" {shape} mass="0.2"/></body>'
        for side, sign in (("left", -1), ("right", 1))
    )
    body = body or '<geom name="body" type="sphere" size="0.035" mass="0.1"/>'
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="0.001" integrator="implicitfast" gravity="{gravity}" {option}/>
      <default><geom contype="0" conaffinity="0" friction="0.8 0.005 0.0001"/></default>
      <extension><plugin plugin="palpate.contact">{instances}</plugin><plugin plugin="palpate.sensor"/></extension>
      <worldbody>{fingers}<body name="body" gravcomp="0"><freejoint name="body"/>{body}</body></worldbody>
      <actuator>
        <position name="left" joint="left" kp="20000" kv="100"/><position name="right" joint="right" kp="20000" kv="100"/>
      </actuator>
      <sensor>{sensors}</sensor>
    </mujoco>""")


def held(m: Any, squeeze: float = 0.005, seconds: float = 2.0) -> Any:
    """Closed without gravity within half a second, then held with it."""
    d = mujoco.MjData(m)
    gravity = m.opt.gravity.copy()
    m.opt.gravity[:] = 0
    for tick in range(500):
        d.ctrl[:] = squeeze * (tick + 1) / 500
        mujoco.mj_step(m, d)
    m.opt.gravity[:] = gravity
    mujoco.mj_step(m, d, nstep=round(seconds / m.opt.timestep))
    return d


def whole(m: Any, d: Any) -> State:
    state = np.empty(mujoco.mj_stateSize(m, mujoco.mjtState.mjSTATE_INTEGRATION))
    mujoco.mj_getState(m, d, state, mujoco.mjtState.mjSTATE_INTEGRATION)
    return state


@pytest.fixture
def warnings() -> Iterator[list[str]]:
    """What the engine warns of."""
    found: list[str] = []
    mujoco.set_mju_user_warning(lambda text: found.append(text if isinstance(text, str) else text.decode()))
    yield found
    mujoco.set_mju_user_warning(None)


def along(m: Any, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces at a jaw whose position is prescribed at each step."""
    d = mujoco.MjData(m)
    forces = np.empty_like(places)
    for tick, place in enumerate(places):
        d.qpos[0], d.qvel[0] = place, 0.0
        mujoco.mj_step(m, d)
        forces[tick] = d.sensor("jaw").data[1]
    return forces


def paper_steps() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Displacements every millisecond, and forces there, of the paper's ball squeezed and let go step by step."""
    steps = [{"to": f"{to} mm", "rate": "500 mm/min", "hold": "2 s"} for to in (5, 10, 15, 5, 0)]
    run = palpate.simulate({**BALL, "step": steps, "output": {"sample_rate": "1000 Hz"}})
    times = np.arange(0, run.time_s[-1], 1e-3)
    places = np.interp(times, run.time_s, run.displacement_m)
    forces = np.interp(times, run.time_s, run.force_n)
    return places, forces


def test_the_force_at_a_joint_is_that_of_simulate() -> None:
    places, forces = paper_steps()
    found = along(jaw(), places)
    assert np.abs(found - forces).max() < 1e-4 * forces.max()
    # The other way round, from another first touch.
    found = along(jaw(closing=-1, touch=0.01), 0.01 - places)
    assert np.abs(found - forces).max() < 1e-4 * forces.max()


def test_the_force_between_geoms_is_that_of_simulate() -> None:
    places, forces = paper_steps()
    m = gripper(gravity="0 0 0")
    d = mujoco.MjData(m)
    for tick, (place, force) in enumerate(zip(places[:4000], forces[:4000], strict=True)):
        d.qpos[:] = m.qpos0
        d.joint("left").qpos[0] = d.joint("right").qpos[0] = 0.5 * place
        d.qvel[:] = 0
        mujoco.mj_step(m, d)
        for side in ("left", "right"):
            assert abs(d.sensor(side).data[1] - force) < 1e-4 * forces.max(), tick
        excess, _, _, _, displacement = d.sensor("left").data
        assert abs(displacement - 0.5 * place) < 1e-12 and excess >= 0


def test_substeps_reduce_the_error_of_fast_motions() -> None:
    run = palpate.simulate({**BALL, "step": [{"to": "20 mm", "rate": "200 mm/s", "hold": "0.1 s"}], "output": {"sample_rate": "1000 Hz"}})
    times = np.arange(0, 0.2, 1e-3)
    places, forces = (np.interp(times, run.time_s, column) for column in (run.displacement_m, run.force_n))
    once, often = (np.abs(along(jaw(substeps=substeps), places) - forces).max() for substeps in (1, 4))
    assert often < once / 8


def test_the_engine_saves_copies_and_resets_the_memory() -> None:
    m = gripper()
    d = held(m)
    state = whole(m, d)
    twin = copy.copy(d)  # mj_copyData
    mujoco.mj_step(m, d, nstep=500)
    expected, measured = whole(m, d), d.sensordata.copy()

    mujoco.mj_step(m, twin, nstep=500)
    assert np.array_equal(whole(m, twin), expected) and np.array_equal(twin.sensordata, measured)

    restored = mujoco.MjData(m)
    mujoco.mj_setState(m, restored, state, mujoco.mjtState.mjSTATE_INTEGRATION)
    mujoco.mj_step(m, restored, nstep=500)
    assert np.array_equal(whole(m, restored), expected)

    # An evaluation without a step changes nothing of what follows.
    mujoco.mj_setState(m, restored, state, mujoco.mjtState.mjSTATE_INTEGRATION)
    for _ in range(3):
        mujoco.mj_forward(m, restored)
    mujoco.mj_step(m, restored, nstep=500)
    assert np.array_equal(whole(m, restored), expected)

    mujoco.mj_resetData(m, restored)
    assert not restored.plugin_state.any()
    again = held(m)
    mujoco.mj_step(m, again, nstep=500)
    assert np.array_equal(whole(m, again), expected)


def test_a_body_between_the_fingers_does_not_creep() -> None:
    for gravity in ("0 0 -9.81", "0 -6 -7", "2 -5 -8"):
        m = gripper(gravity)
        d = held(m, seconds=10)
        before = d.joint("body").qpos.copy()
        force = d.sensor("left").data[1]
        mujoco.mj_step(m, d, nstep=60_000)
        moved = np.abs(d.joint("body").qpos - before)
        across = moved[1:3].max()
        # Along the fingers the ball follows the relaxation of both sides.
        assert d.sensor("left").data[1] < force - 1e-3
        assert across < 1e-9, (gravity, moved)
        assert d.sensor("left").data[2] > 0.5 and 0 < d.sensor("left").data[3] < 1


def test_two_fingertips_hold_a_box() -> None:
    box = '<geom name="body" type="box" size="0.02 0.03 0.04" mass="0.1"/>'
    m = gripper("0 -4 -8", body=box, description=TIP)
    d = held(m, squeeze=0.004, seconds=5)
    before = d.joint("body").qpos.copy()
    mujoco.mj_step(m, d, nstep=20_000)
    assert np.abs(d.joint("body").qpos - before)[1:].max() < 1e-9
    assert d.sensor("left").data[2] > 0


def test_a_ball_that_falls_on_a_plane_comes_to_rest_on_it() -> None:
    m = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="0.001"/>
      <default><geom contype="0" conaffinity="0"/></default>
      <extension><plugin plugin="palpate.contact">{instance("floor", DESCRIPTION, geom1="floor", geom2="ball", normal_damping=2)}</plugin>
        <plugin plugin="palpate.sensor"/></extension>
      <worldbody><geom name="floor" type="plane" size="1 1 1"/>
        <body pos="0 0 0.06"><freejoint/><geom name="ball" size="0.035" mass="0.1"/></body></worldbody>
      <sensor><plugin name="floor" plugin="palpate.sensor"><config key="contact" value="floor"/></plugin></sensor></mujoco>""")
    d = mujoco.MjData(m)
    forces = []
    for _ in range(20_000):
        mujoco.mj_step(m, d)
        forces.append(d.sensor("floor").data[1])
    assert forces[0] == 0 and max(forces) > 0.981
    assert abs(forces[-1] - 0.981) < 1e-4 and abs(d.qvel[2]) < 1e-4
    # The impact squeezed it beyond E (u/r) pi (2 r u - u^2) = 0.981 N, which is at 2.403 mm, and it recovers from there.
    deep = d.sensor("floor").data[4]
    assert 0.002403 < deep < 0.0035 and d.sensor("floor").data[0] < 0
    mujoco.mj_step(m, d, nstep=20_000)
    assert 0.002403 < d.sensor("floor").data[4] < deep - 1e-5


@pytest.mark.parametrize(("integrator", "settles", "shakes"), [("IMPLICITFAST", 0.00145, 0.0025), ("RK4", 0.0035, 0.0055)])
def test_a_ball_that_is_held_lightly_comes_to_rest(integrator: str, settles: float, shakes: float, warnings: list[str]) -> None:
    """Damping that was critical for the mass, not for its rotation, shook it for ever from 1.39 ms on, with RK4 from 3.24 ms on."""
    for timestep in (settles, shakes):
        m = gripper(gravity="0 0 0")
        m.opt.timestep, m.opt.integrator = timestep, getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
        d = mujoco.MjData(m)
        for _ in range(round(0.5 / timestep)):
            d.ctrl[:] = 0.0005 * min(d.time / 0.4, 1)
            mujoco.mj_step(m, d)
        d.joint("body").qvel[:] = [0, 1e-3, 0, 0.01, 0.01, 0.01]
        mujoco.mj_step(m, d, nstep=round(2.0 / timestep))
        fastest = np.abs(d.joint("body").qvel).max()
        found = [text for text in warnings if "friction may shake for ever: expected a time step of" in text]
        assert (fastest < 1e-5, len(found)) == ((True, 0) if timestep == settles else (False, 2)), (timestep, fastest, warnings)
        # Once in the life of the data.
        mujoco.mj_resetData(m, d)
        d.joint("left").qpos[0] = d.joint("right").qpos[0] = 0.0005
        mujoco.mj_step(m, d, nstep=10)
        assert len([text for text in warnings if "may shake" in text]) == len(found)


def test_what_is_held_off_its_centre_does_not_turn() -> None:
    box = '<geom name="body" type="box" size="0.02 0.03 0.04" pos="0 0.004 0" mass="0.1"/>'
    m = gripper(body=box, description=TIP)
    d = held(m, squeeze=0.004, seconds=5)
    before = d.joint("body").qpos.copy()
    mujoco.mj_step(m, d, nstep=20_000)
    assert np.abs(d.joint("body").qpos - before)[1:].max() < 1e-9
    # The load is that of the weight and of its moment at the radius torsion/mu: 0.49 N and 0.1 g 4 mm/2 over 0.005 m/0.8.
    weight = 0.1 * 9.81 / 2
    assert abs(d.sensor("left").data[3] - np.hypot(weight, weight * 0.004 * 0.8 / 0.005)) < 1e-3


def test_data_of_one_model_step_on_two_threads() -> None:
    m = gripper()
    start = held(m, seconds=0.1)
    alone, twins = copy.copy(start), [copy.copy(start) for _ in range(2)]
    mujoco.mj_step(m, alone, nstep=5000)
    threads = [threading.Thread(target=mujoco.mj_step, args=(m, twin), kwargs={"nstep": 5000}) for twin in twins]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(whole(m, twin), whole(m, alone)) for twin in twins)


def test_what_is_held_too_weakly_slips_and_falls() -> None:
    m = gripper()
    d = held(m, squeeze=0.0006, seconds=0.06)
    _, force, margin, load, _ = d.sensor("left").data
    assert 0 < 2 * 0.8 * force < 0.1 * 9.81
    assert abs(margin) < 1e-9 and abs(load - 0.8 * force) < 1e-9
    assert d.body("body").xpos[2] < -0.002


def test_the_load_of_a_sensor_is_the_whole_of_the_tangential_force() -> None:
    # The deflection of the bristle alone had a load of 0.30 N beside 1.80 N of friction, and a margin while it slid.
    m = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="0.0002" gravity="0 0 0"/>
      <default><geom contype="0" conaffinity="0" friction="0.6"/></default>
      <extension><plugin plugin="palpate.contact">{instance("tip", TIP, geom1="plate", geom2="tip")}</plugin>
        <plugin plugin="palpate.sensor"/></extension>
      <worldbody><body pos="0 0 -0.01"><joint name="x" type="slide" axis="1 0 0"/><geom name="plate" type="box" size="0.1 0.1 0.01" mass="0.5"/></body>
        <body pos="0 0 0.012"><joint name="z" type="slide" axis="0 0 -1"/><geom name="tip" size="0.012" mass="0.3"/></body></worldbody>
      <sensor><plugin name="tip" plugin="palpate.sensor"><config key="contact" value="tip"/></plugin></sensor></mujoco>""")
    d = mujoco.MjData(m)
    d.joint("z").qpos[0] = 0.002
    mujoco.mj_step(m, d)
    # Struck: its force is that of the damping, then of both.
    d.joint("x").qvel[0] = 0.5
    slid, stuck = 0, 0
    for _ in range(2000):
        d.joint("z").qpos[0], d.joint("z").qvel[0] = 0.002, 0.0
        mujoco.mj_step(m, d)
        _, force, margin, load, _ = d.sensor("tip").data
        assert load == pytest.approx(abs(d.joint("x").qfrc_passive[0]), abs=1e-12) and margin == pytest.approx(0.6 * force - load, abs=1e-12)
        slid, stuck = slid + (margin < 1e-12), stuck + (margin > 0.1 * force)
    assert slid > 50 and stuck > 50


def test_runge_kutta_and_others_agree() -> None:
    forces = []
    for integrator in ("Euler", "RK4", "implicit", "implicitfast"):
        m = gripper()
        m.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
        forces.append(held(m, seconds=1).sensor("left").data[1])
    assert np.ptp(forces) < 1e-3 * forces[0]


def lifted(integrator: str, timestep: float) -> float:
    """How far the ball of the example sinks between the fingers, m, while they rise by 50 mm within a second."""
    folder = ROOT / "examples/mujoco"
    scene = (folder / "with_memory.xml").read_text().replace('value="examples', f'value="{ROOT}/examples')
    m = mujoco.MjModel.from_xml_string(scene, {"gripper.xml": (folder / "gripper.xml").read_bytes()})
    m.opt.integrator, m.opt.timestep = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}"), timestep
    d = mujoco.MjData(m)
    before = 0.0
    for tick in range(round(2.5 / timestep)):
        time = tick * timestep
        d.ctrl[:] = [0.05 * np.clip(time - 1, 0, 1), *[0.005 * np.clip((time - 0.2) / 0.5, 0, 1)] * 2]
        mujoco.mj_step(m, d)
        if time <= 0.9:
            before = d.joint("ball").qpos[2] - d.joint("lift").qpos[0]
    return float(before - d.joint("ball").qpos[2] + d.joint("lift").qpos[0])


def test_what_is_lifted_creeps_with_no_integrator() -> None:
    # 0.192 and 2.127 mm with RK4, when the bristle followed the sum of speeds by time.
    for timestep in (0.001, 0.002):
        sunk = [lifted(integrator, timestep) for integrator in ("Euler", "RK4")]
        assert abs(sunk[1] - sunk[0]) < 1e-6 and abs(sunk[0] - 79.8e-6) < 1e-6, (timestep, sunk)


def test_jaws_that_are_moved_as_mocap_bodies_lift_what_they_hold() -> None:
    # They have no velocity in MuJoCo: the ball fell while they rose.
    pairs = "".join(instance(side, DESCRIPTION, geom1=side, geom2="ball") for side in ("left", "right"))
    jaws = "".join(f'<body name="{side}" mocap="true"><geom name="{side}" type="box" size="0.01 0.03 0.03"/></body>' for side in ("left", "right"))
    m = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="0.001"/>
      <default><geom contype="0" conaffinity="0" friction="0.8 0.005 0.0001"/></default>
      <extension><plugin plugin="palpate.contact">{pairs}</plugin></extension>
      <worldbody>{jaws}<body name="ball"><freejoint/><geom name="ball" size="0.035" mass="0.1"/></body></worldbody></mujoco>""")
    d = mujoco.MjData(m)
    for tick in range(2500):
        place, lift = 0.045 - 0.005 * min(tick / 500, 1), 0.05 * np.clip(1e-3 * tick - 1, 0, 1)
        m.opt.gravity[2] = -9.81 if tick > 600 else 0
        d.mocap_pos[:] = [[-place, 0, lift], [place, 0, lift]]
        mujoco.mj_step(m, d)
    assert -1e-4 < d.qpos[2] - 0.05 < -5e-5


def test_the_stiffness_of_friction_is_in_transitions_by_differences() -> None:
    m = gripper()
    d = held(m)
    transition = np.zeros((2 * m.nv, 2 * m.nv))
    mujoco.mjd_transitionFD(m, d, 1e-6, True, transition, None, None, None)
    # A ball that is put lower by hand is drawn back by both contacts.
    down = m.nv + 4, 4
    assert transition[down] / m.opt.timestep < -1000


def finite(d: Any) -> bool:
    return bool(np.isfinite(d.qpos).all() and np.isfinite(d.sensordata).all() and np.isfinite(d.plugin_state).all())


def test_a_displacement_beyond_the_body_is_reported_once_and_has_a_force(warnings: list[str]) -> None:
    m = jaw()
    places = np.concatenate([np.linspace(0, 0.1, 200), np.full(50, 0.1), np.linspace(0.1, 0, 200)])
    forces = along(m, places)
    assert np.isfinite(forces).all() and forces[200] > forces[120] > forces[60] > 0 and forces[-1] == 0
    assert len([text for text in warnings if "beyond the 0.07 m that the body takes" in text]) == 1, warnings


def test_a_displacement_beyond_the_calibration_is_reported_once(warnings: list[str]) -> None:
    m = mujoco.MjModel.from_xml_string(f"""<mujoco><extension><plugin plugin="palpate.contact"><instance name="jaw">
      <config key="material" value="{MATERIAL}"/><config key="joint" value="jaw"/></instance></plugin></extension>
      <worldbody><body><joint name="jaw" type="slide"/><geom size="0.01" mass="1"/></body></worldbody></mujoco>""")
    d = mujoco.MjData(m)
    for place in (0.005, 0.016, 0.018, 0.02):
        d.qpos[0] = place
        mujoco.mj_forward(m, d)
    found = [text for text in warnings if "beyond the 0.015001 m of its calibration" in text]
    assert len(found) == 1, warnings
    mujoco.mj_resetData(m, d)
    d.qpos[0] = 0.02
    mujoco.mj_forward(m, d)
    assert len([text for text in warnings if "of its calibration" in text]) == 2


@pytest.mark.parametrize("spoil", [
    lambda d: d.plugin_state.__setitem__(slice(None), np.nan),
    lambda d: d.plugin_state.__setitem__(2, np.inf),
    lambda d: d.plugin_state.__setitem__(slice(None), 1e300),
    lambda d: d.qpos.__setitem__(0, np.nan),
    lambda d: d.qvel.__setitem__(slice(None), np.inf),
])
def test_states_that_are_not_finite_begin_anew(warnings: list[str], spoil: Callable[[Any], None]) -> None:
    m = gripper()
    d = held(m, seconds=0.1)
    spoil(d)
    mujoco.mj_step(m, d, nstep=100)
    assert finite(d), warnings
    assert len([text for text in warnings if "begins anew" in text]) <= 2


def test_steps_of_no_time_and_of_much_time() -> None:
    m = jaw()
    d = mujoco.MjData(m)
    d.qpos[0] = 0.01
    m.opt.timestep = 1e-9
    mujoco.mj_step(m, d)
    at_once = d.sensor("jaw").data[1]
    contact = palpate.ContactState(BALL)
    assert abs(at_once - contact.step(0.0, 0.01)) < 1e-12 * at_once
    d.time += 1e9
    d.qpos[0], d.qvel[0] = 0.01, 0
    mujoco.mj_forward(m, d)
    much_later = d.sensor("jaw").data[1]
    assert abs(much_later - contact.step(1e9, 0.01)) < 1e-12 * much_later
    # E (u/r) pi (2 r u - u^2) at u = 5 mm; x = (4 v t)^(-1/4) of u/r = 1/7 is still in excess.
    equilibrium = 28e3 / 7 * np.pi * (0.07 - 0.005) * 0.005
    assert abs(much_later / equilibrium - 1 - 7 * (4 * 2e4 * 1e9) ** -0.25) < 1e-6
    d.time = 0.0
    mujoco.mj_step(m, d)
    assert finite(d)


def test_a_reset_in_the_middle_begins_with_an_untouched_body() -> None:
    m = gripper()
    d = held(m)
    mujoco.mj_resetData(m, d)
    mujoco.mj_forward(m, d)
    # The geoms meet to rounding.
    assert abs(d.sensor("left").data[1]) < 1e-20 and abs(d.sensor("left").data[0]) < 1e-12


@pytest.mark.parametrize(("keys", "expected"), [
    ({"joint": "other"}, 'joint: expected the name of a joint, found "other"'),
    ({"joint": "jaw", "geom1": "jaw"}, "expected the keys geom1 and geom2, or the key joint"),
    ({"joint": "jaw", "substeps": "1.5"}, "substeps: expected a whole number of 1 to 1000, found 1.5"),
    ({"joint": "jaw", "closing": "2"}, "closing: expected 1 or -1, found 2"),
    ({"joint": "jaw", "touch": "1 mm"}, 'touch: expected a number of'),
    ({"joint": "jaw", "material": "ball.toml"}, "expected one of the keys material (a file) and description (its text), found both"),
    ({"joint": "jaw", "description": "[specimen]"}, "specimen"),
    ({"joint": "jaw", "description": LINEAR.replace("\n", "&#10;")}, 'which is stepped here, found "standard-linear-solid"; hint: palpate.ContactStates'),
    ({"joint": "jaw", "description": None, "material": "/no/such.toml"}, "/no/such.toml"),
    ({"joint": "jaw", "friction": "0.5"}, "friction: expected none with a joint"),
    ({"geom1": "jaw", "geom2": "wall", "touch": "0.1"}, "touch: expected none with geoms"),
])
def test_wrong_configurations_are_refused_with_a_reason(keys: dict[str, Any], expected: str) -> None:
    configured = {"description": DESCRIPTION.replace("\n", "&#10;"), **keys}
    lines = "".join(f'<config key="{key}" value="{value}"/>' for key, value in configured.items() if value is not None)
    xml = f"""<mujoco><extension><plugin plugin="palpate.contact"><instance name="grip">{lines}</instance></plugin></extension>
      <worldbody><geom name="wall" size="1 1 1" type="plane"/>
      <body><joint name="jaw" type="slide"/><geom name="jaw" size="0.01" mass="1"/></body></worldbody></mujoco>"""
    with pytest.raises((ValueError, mujoco.FatalError), match=re.escape(expected)):
        mujoco.MjData(mujoco.MjModel.from_xml_string(xml))


BONDED = DESCRIPTION + "[contact]\nseparation = false\n"


def test_a_bonded_body_does_not_pull_a_jaw_across_a_gap() -> None:
    # A block as `palpate calibrate` has it by default drew a finger across 5 mm with 27 N in the first step.
    words = "separation = false in the description: a bonded body would pull"
    hint = ".*set separation = true under .contact. of the test description where the jaw only presses, and calibrate again"
    with pytest.raises((ValueError, mujoco.FatalError), match=f"{words} a geom from any distance{hint}"):
        mujoco.MjData(gripper(description=BONDED))
    with pytest.raises((ValueError, mujoco.FatalError), match=f"{words} the joint, which starts 0.005 m before first touch{hint}"):
        mujoco.MjData(jaw(BONDED, touch=0.005))
    with pytest.raises((ValueError, mujoco.FatalError), match="starts 0.005 m before first touch"):
        mujoco.MjData(jaw(BONDED, touch=-0.005, closing=-1))


def test_a_jaw_that_is_bonded_to_a_body_pulls_it_from_first_touch_on() -> None:
    places = np.concatenate([np.linspace(0, 0.004, 50), np.linspace(0.004, 0, 50)])
    forces = along(jaw(BONDED), places)
    assert forces.max() > 0.5 and forces.min() < -0.05


@pytest.mark.skipif(not hasattr(mujoco, "mjtSleepPolicy"), reason="this version does not put bodies to sleep")
def test_a_body_that_may_fall_asleep_is_refused() -> None:
    # A ball that slept on the table stayed there while the fingers closed on it and rose.
    description = DESCRIPTION.replace("\n", "&#10;")
    lines = "".join(f'<config key="{key}" value="{value}"/>' for key, value in {"description": description, "geom1": "table", "geom2": "ball"}.items())

    def data(sleep: str) -> Any:
        return mujoco.MjData(mujoco.MjModel.from_xml_string(f"""<mujoco><option><flag sleep="enable"/></option>
          <extension><plugin plugin="palpate.contact"><instance name="grip">{lines}</instance></plugin></extension>
          <worldbody><geom name="table" size="1 1 1" type="plane"/>
            <body name="ball" {sleep}><freejoint/><geom name="ball" size="0.035" mass="0.1"/></body></worldbody></mujoco>"""))

    with pytest.raises(mujoco.FatalError, match='the body "ball" may fall asleep, and this contact does not wake it: set sleep="never" on it'):
        data("")
    assert data('sleep="never"').time == 0.0


def test_the_displacement_of_bodies_apart_is_less_their_distance() -> None:
    for shape, half in (('type="box" size="0.01 0.03 0.03"', 0.01), ('type="sphere" size="0.012"', 0.012), ('type="capsule" size="0.01 0.02"', 0.01)):
        m = mujoco.MjModel.from_xml_string(f"""<mujoco><option gravity="0 0 0"/><default><geom contype="0" conaffinity="0"/></default>
          <extension><plugin plugin="palpate.contact">{instance("far", DESCRIPTION, geom1="jaw", geom2="ball")}</plugin>
            <plugin plugin="palpate.sensor"/></extension>
          <worldbody><body><joint name="jaw" type="slide" axis="1 0 0"/><geom name="jaw" {shape} mass="1"/></body>
            <geom name="ball" size="0.035"/></worldbody>
          <sensor><plugin name="far" plugin="palpate.sensor"><config key="contact" value="far"/></plugin></sensor></mujoco>""")
        d = mujoco.MjData(m)
        for gap in (0.001, 0.03, 0.06, 0.5, 40.0, 1e7):
            d.qpos[0] = -(0.035 + half + gap)
            mujoco.mj_step(m, d)
            excess, force, _, _, displacement = d.sensor("far").data
            assert displacement == pytest.approx(-gap, rel=1e-6) and force == 0 and excess == 0
        # The memory is that of a body that is let go, from wherever the jaw comes back.
        d.qpos[0] = -(0.035 + half - 0.002)
        mujoco.mj_step(m, d)
        assert d.sensor("far").data[1] > 0.5


@pytest.mark.parametrize("away", [0.001, 1.0])
def test_a_body_that_was_taken_away_and_put_back_is_not_deflected(away: float) -> None:
    m = gripper("0 0 -20")
    d = held(m, seconds=0.5)
    assert d.sensor("left").data[3] > 0.5
    m.opt.gravity[:] = 0
    place = d.joint("body").qpos.copy()
    # Off both fingers, by less than the depth of the body and by more.
    d.ctrl[:] = -away
    d.joint("left").qpos[0] = d.joint("right").qpos[0] = -away
    d.qvel[:] = 0
    mujoco.mj_step(m, d, nstep=3)
    assert d.sensor("left").data[4] == pytest.approx(-away, abs=1e-4)
    d.ctrl[:] = 0.005
    d.joint("left").qpos[0] = d.joint("right").qpos[0] = 0.005
    d.joint("body").qpos[:] = place
    d.qvel[:] = 0
    mujoco.mj_forward(m, d)
    assert d.sensor("left").data[1] > 1 and d.sensor("left").data[3] < 1e-9


def test_friction_on_a_plane_has_the_arm_of_the_squeezed_ball_whichever_geom_is_first() -> None:
    spins = []
    for geoms in ({"geom1": "floor", "geom2": "ball"}, {"geom1": "ball", "geom2": "floor"}):
        m = mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="1e-4" gravity="0 0 0"/>
          <default><geom contype="0" conaffinity="0" friction="0.5"/></default>
          <extension><plugin plugin="palpate.contact">{instance("floor", DESCRIPTION, **geoms)}</plugin></extension>
          <worldbody><geom name="floor" type="plane" size="1 1 1"/>
            <body pos="0 0 0.03"><freejoint/><geom name="ball" size="0.035" mass="0.1"/></body></worldbody></mujoco>""")
        d = mujoco.MjData(m)
        # It slides along x and is 5 mm deep.
        d.qvel[0] = 1.0
        mujoco.mj_forward(m, d)
        force, moment = d.qfrc_passive[0], d.qfrc_passive[4]
        assert force < 0 and moment / force == pytest.approx(-0.03, rel=1e-6)
        spins.append(moment)
    assert spins[0] == pytest.approx(spins[1], rel=1e-9)


def test_two_contacts_with_a_body_that_is_squeezed_from_one_side_are_in_series() -> None:
    """A free block between two fingers needs the description of two sides; held by the world, one side is right."""
    block = "[specimen]\nshape = 'block'\narea = '12 cm^2'\nlength = '60 mm'\nmodulus = '28 kPa'\n" + DESCRIPTION[DESCRIPTION.index("[law]") :]
    sided = {sides: block + f"[contact]\nsqueezed_from = '{sides}'\n" for sides in ("one side", "two sides")}
    expected = palpate.ContactState(tomllib.loads(block)).step(0.0, 0.004)
    geom = '<geom name="body" type="sphere" size="0.035" mass="0.1"/>'

    def forces(description: str) -> Any:
        m = gripper("0 0 0", description=description)
        d = mujoco.MjData(m)
        d.joint("left").qpos[0] = d.joint("right").qpos[0] = 0.002
        mujoco.mj_forward(m, d)
        return np.array([d.sensor(side).data[1] for side in ("left", "right")])

    assert forces(sided["two sides"]) == pytest.approx(expected, rel=1e-9)
    assert forces(sided["one side"]) == pytest.approx(0.5 * expected, rel=1e-9)
    # One finger, and a body that the world holds: all of the travel is at its contact.
    m = mujoco.MjModel.from_xml_string(f"""<mujoco><default><geom contype="0" conaffinity="0"/></default>
      <extension><plugin plugin="palpate.contact">{instance("jaw", sided["one side"], geom1="jaw", geom2="body")}</plugin>
        <plugin plugin="palpate.sensor"/></extension>
      <worldbody><body pos="-0.045 0 0"><joint name="jaw" type="slide" axis="1 0 0"/>
        <geom name="jaw" type="box" size="0.01 0.03 0.03"/></body>{geom}</worldbody>
      <sensor><plugin name="jaw" plugin="palpate.sensor"><config key="contact" value="jaw"/></plugin></sensor></mujoco>""")
    d = mujoco.MjData(m)
    d.qpos[0] = 0.004
    mujoco.mj_forward(m, d)
    assert d.sensor("jaw").data[1] == pytest.approx(expected, rel=1e-9)


def test_a_sensor_needs_an_instance_of_a_contact() -> None:
    xml = """<mujoco><extension><plugin plugin="palpate.sensor"/></extension>
      <worldbody><body><joint type="slide"/><geom size="0.01" mass="1"/></body></worldbody>
      <sensor><plugin plugin="palpate.sensor"><config key="contact" value="left"/></plugin></sensor></mujoco>"""
    with pytest.raises((ValueError, mujoco.FatalError), match='expected the name of an instance of palpate.contact, found "left"'):
        mujoco.MjData(mujoco.MjModel.from_xml_string(xml))


def test_transitions_by_differences_leave_the_memory_as_it_is() -> None:
    m = gripper()
    d = held(m)
    before = whole(m, d)
    transition = np.zeros((2 * m.nv, 2 * m.nv))
    mujoco.mjd_transitionFD(m, d, 1e-6, True, transition, None, None, None)
    assert np.array_equal(whole(m, d), before)
    # One finger inwards: the ball is pushed away by the tangent stiffness of that contact.
    ball = slice(m.nv + 2, m.nv + 3)
    slopes = transition[ball, 0] / m.opt.timestep
    assert slopes[0] > 0 and np.isfinite(transition).all()
