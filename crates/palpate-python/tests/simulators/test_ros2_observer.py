"""The ROS 2 node of `examples/ros2`, without ROS: its messages are those of `rosbags`."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest

pytest.importorskip("rosbags")
from rosbags.typesys import Stores, get_typestore  # noqa: E402

ROOT = Path(__file__).resolve().parents[4]
PACKAGE = ROOT / "examples/ros2/palpate_observer"
STORE: Any = get_typestore(Stores.ROS2_JAZZY)
START = 1_700_000_000 * 10**9
SLIP_N = 5.3

BALL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "contact": {"layers": 8, "squeezed_from": "two sides"},
    "output": {"sample_rate": "100 Hz"},
}
SQUEEZE = {"to": "10 mm", "rate": "500 mm/min", "hold": "20 s"}
RELEASE = {"to": "-2 mm", "rate": "500 mm/min", "hold": "5 s"}


@pytest.fixture(scope="module")
def bridge_module() -> Iterator[Any]:
    """The module `bridge`, which needs no ROS."""
    sys.path.insert(0, str(PACKAGE))
    yield importlib.import_module("palpate_observer.bridge")
    sys.path.remove(str(PACKAGE))


def header(time_ns: int) -> Any:
    types = STORE.types
    stamp = types["builtin_interfaces/msg/Time"](sec=time_ns // 10**9, nanosec=time_ns % 10**9)
    return types["std_msgs/msg/Header"](stamp=stamp, frame_id="")


def joint_state(time_ns: int, position: float, joint: str = "finger") -> Any:
    one = np.array([position])
    return STORE.types["sensor_msgs/msg/JointState"](
        header=header(time_ns), name=["arm", joint], position=np.array([0.5, position]), velocity=0 * one[:0], effort=one[:0]
    )


def wrench(time_ns: int, force: float) -> Any:
    types = STORE.types
    vector, zero = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
    inner = types["geometry_msgs/msg/Wrench"](force=vector(x=0.0, y=0.0, z=force), torque=zero)
    return types["geometry_msgs/msg/WrenchStamped"](header=header(time_ns), wrench=inner)


class Grip:
    """A bridge, and all that it published."""

    def __init__(self, module: Any, **settings: Any) -> None:
        self.bridge = module.Bridge(module.Settings(joint="finger", slip_force_n=SLIP_N, **settings), STORE.types)
        self.numbers: dict[str, list[tuple[float, float]]] = {}
        self.reports: list[tuple[float, int, str, str]] = []
        self.now = 0.0

    def take(self, published: list[Any]) -> None:
        for topic, message in published:
            # What is published can be sent.
            STORE.serialize_cdr(message, message.__msgtype__)
            if topic == "diagnostics":
                [status], stamp = message.status, message.header.stamp
                time = stamp.sec - START // 10**9 + 1e-9 * stamp.nanosec
                self.reports.append((time, int(status.level), status.name, status.message))
            else:
                self.numbers.setdefault(topic, []).append((self.now, message.data))

    def joint(self, time: float, position: float, **more: Any) -> None:
        self.take(self.bridge.joint_state(joint_state(START + round(1e9 * time), position, **more)))

    def wrench(self, time: float, force: float) -> None:
        self.now = time
        self.take(self.bridge.wrench(wrench(START + round(1e9 * time), force)))

    def warnings(self) -> list[str]:
        return [text for _, _, name, text in self.reports if name == "palpate: input"]

    def values(self, topic: str) -> list[float]:
        return [value for _, value in self.numbers[topic]]

    def at(self, topic: str, time: float) -> float:
        return next(value for when, value in self.numbers[topic] if when >= time)


def simulated(*steps: dict[str, str]) -> Any:
    return palpate.simulate({**BALL, "step": list(steps)})


def play(grip: Grip, series: Any, shift: float = 0.0) -> None:
    """Joint states at 50 Hz, wrenches at 100 Hz and 3 ms later, as from two drivers."""
    time, position, force = series.time_s, series.displacement_m, series.force_n
    for index in range(len(time)):
        if index % 2 == 0:
            grip.joint(shift + time[index], position[index])
        grip.wrench(shift + time[index] + 0.003, float(np.interp(time[index] + 0.003, time, force)))


def slip_time(series: Any, after: float = 0.0) -> float:
    """When the simulated force has fallen to that of slip, s."""
    time, force = series.time_s, series.force_n
    peak = int(np.argmax(np.where(time >= after, force, 0.0)))
    fallen = peak + int(np.argmax(force[peak:] <= SLIP_N))
    return float(np.interp(-SLIP_N, -force[fallen - 1 : fallen + 1], time[fallen - 1 : fallen + 1]))


def test_a_simulated_grip_publishes_equilibrium_and_time_to_slip(bridge_module: Any) -> None:
    series, grip = simulated(SQUEEZE), Grip(bridge_module)
    play(grip, series)
    slips = slip_time(series)
    assert 1.5 < slips < 20, slips
    # Half of the way from the end of the ramp to slip.
    now = (1.2 + slips) / 2
    assert grip.at("time_to_slip_s", now) == pytest.approx(slips - now, rel=0.1)
    # A wrench waits up to 20 ms for the next joint state, and what is published then is from its stamp on.
    low, high = grip.at("time_to_slip_low_s", now), grip.at("time_to_slip_high_s", now)
    assert low - 0.03 <= slips - now <= high + 0.03, (low, slips - now, high)
    # E (u/r) A(u) at u = 5 mm.
    truth = 28e3 * (5 / 35) * math.pi * (0.07 * 0.005 - 0.005**2)
    assert grip.numbers["equilibrium_force_n"][-1][1] == pytest.approx(truth, rel=0.02)
    levels = [(level, text) for _, level, name, text in grip.reports if name == "palpate: contact"]
    assert levels[0] == (0, "displacement hold begins")
    assert [level for level, _ in levels[1:]] == [1, 2] and levels[1][1].startswith("slip soon"), levels
    assert grip.reports[-1][0] == pytest.approx(slips, abs=0.15)
    assert grip.warnings() == []


def test_two_grips_one_after_the_other(bridge_module: Any) -> None:
    series, grip = simulated(SQUEEZE, RELEASE, SQUEEZE), Grip(bridge_module)
    play(grip, series)
    texts = [text for _, _, name, text in grip.reports if name == "palpate: contact"]
    assert texts.count("displacement hold begins") >= 2 and "hold ends" in texts, texts
    again = 1.2 + 20 + 1.44 + 5
    slips = slip_time(series, again)
    now = (again + 1.44 + slips) / 2
    assert grip.at("time_to_slip_s", now) == pytest.approx(slips - now, rel=0.15)
    assert grip.warnings() == []


def test_a_clock_that_goes_back_begins_anew(bridge_module: Any) -> None:
    series, grip, once = simulated(SQUEEZE), Grip(bridge_module), Grip(bridge_module)
    play(once, series)
    play(grip, series)
    first = {topic: len(values) for topic, values in grip.numbers.items()}
    play(grip, series, shift=-100.0)
    assert len(grip.warnings()) == 1 and "clock went back by" in grip.warnings()[0], grip.warnings()
    # The same readings again give the same results again: nothing of the first run is left.
    for topic, values in grip.numbers.items():
        again = [value for _, value in values[first[topic] :]]
        assert again == pytest.approx([value for _, value in once.numbers[topic]], rel=1e-6), topic


def test_messages_that_are_late_are_left_out(bridge_module: Any) -> None:
    series, grip, clean = simulated(SQUEEZE), Grip(bridge_module), Grip(bridge_module)
    play(clean, series)
    time, position, force = series.time_s, series.displacement_m, series.force_n
    for index in range(len(time)):
        if index % 2 == 0:
            grip.joint(time[index], position[index])
        grip.wrench(time[index] + 0.003, float(np.interp(time[index] + 0.003, time, force)))
        if index > 50 and index % 7 == 0:
            grip.wrench(time[index] - 0.02, 99.0)
            grip.joint(time[index] - 0.05, 1.0)
    warned = grip.warnings()
    assert {text.split(":")[0] for text in warned} == {"wrenches", "joint states"}
    # Each kind once, and again after 10 s.
    assert len(warned) == 2 * 3, warned
    assert grip.values("equilibrium_force_n") == clean.values("equilibrium_force_n")


class Recorder:
    """An observer that keeps what it is fed with."""

    def __init__(self, observer: palpate.Observer) -> None:
        self.observer = observer
        self.fed: list[tuple[float, float | None]] = []

    def feed(self, time: float, force: float, displacement: float | None) -> palpate.Observation:
        self.fed.append((time, displacement))
        return self.observer.feed(time, force, displacement)


@pytest.mark.parametrize(("late", "warns"), [(0.1, False), (0.3, False), (1.9, False), (5.0, True)])
def test_a_late_wrench_has_the_displacement_of_its_stamp(bridge_module: Any, late: float, warns: bool) -> None:
    # Of joint states at 1 kHz 256 were kept, and a wrench 0.3 s late had the displacement of 45 ms after it, without a warning.
    grip = Grip(bridge_module)
    recorder = Recorder(grip.bridge._observer)
    grip.bridge._observer = recorder
    for tick in range(8000):
        grip.joint(1e-3 * tick, 1e-5 * tick)
        if tick % 100 == 0 and 1e-3 * tick >= late:
            grip.wrench(1e-3 * tick - late, 1.0)
    # The first wrench is of 0 s, the zero of the times.
    found = [(time, displacement) for time, displacement in recorder.fed if displacement is not None]
    assert all(displacement == pytest.approx(0.01 * time, abs=1e-9) for time, displacement in found)
    assert len(recorder.fed) > 25
    if warns:
        assert len(found) < len(recorder.fed)
        expected = "wrenches: expected stamps at most 2.1 s behind those of joint states, found one 5 s behind"
        assert grip.warnings() == [expected]
    else:
        assert len(found) == len(recorder.fed) and grip.warnings() == []
        assert len(grip.bridge._joints) < 5000


def test_a_missing_joint_is_reported_once_and_the_force_alone_is_observed(bridge_module: Any) -> None:
    series, grip = simulated(SQUEEZE), Grip(bridge_module, repeat_warnings_s=1000.0)
    for index, time in enumerate(series.time_s):
        grip.joint(time, series.displacement_m[index], joint="thumb")
        grip.wrench(time, series.force_n[index])
    [warning] = grip.warnings()
    assert warning == "expected a position of finger every 0.1 s, found none, but states of arm, thumb"
    truth = 28e3 * (5 / 35) * math.pi * (0.07 * 0.005 - 0.005**2)
    assert grip.numbers["equilibrium_force_n"][-1][1] == pytest.approx(truth, rel=0.05)


def test_values_that_are_no_numbers_are_left_out(bridge_module: Any) -> None:
    series, grip, clean = simulated(SQUEEZE), Grip(bridge_module), Grip(bridge_module)
    time, position, force = series.time_s, series.displacement_m, series.force_n
    for index in range(len(time)):
        for each in (grip, clean):
            each.joint(time[index], position[index])
            if index % 10:
                each.wrench(time[index], force[index])
        if index % 10 == 0:
            grip.wrench(time[index], math.nan)
            grip.joint(time[index] + 0.001, math.inf)
    assert {text for text in grip.warnings()} == {
        "expected a finite force, found nan",
        "expected a finite position, found inf",
    }
    assert len(grip.warnings()) == 2 * 3
    assert grip.numbers == clean.numbers


def test_a_material_gives_the_excess_strain_and_a_message_without_a_stamp_the_time_of_reception(bridge_module: Any) -> None:
    settings = bridge_module.Settings(joint="", slip_force_n=1.0, material=str(ROOT / "examples/records/ball-material.toml"))
    by_reception = bridge_module.Bridge(settings, STORE.types)
    joined = Grip(bridge_module, material=settings.material)
    series = simulated({**SQUEEZE, "hold": "2 s"})
    published: list[Any] = []
    for index, time in enumerate(series.time_s):
        joined.joint(time, series.displacement_m[index])
        joined.wrench(time, series.force_n[index])
        published += by_reception.wrench(wrench(0, series.force_n[index]), received_ns=START + round(1e9 * time))
    assert joined.warnings() == []
    # The excess strain of the simulation, whose ball the material was calibrated on.
    assert joined.numbers["excess_strain"][-1][1] == pytest.approx(series.excess_strain[-1], rel=0.05)
    levels = [message.status[0].level for topic, message in published if topic == "diagnostics"]
    assert levels and max(levels) == 0, "a hold and no warning"


def test_settings_that_cannot_be_used_are_refused(bridge_module: Any) -> None:
    for settings in ({"force_axis": "w"}, {"metres_per_position": 0.0}, {"max_wait_s": -1.0}, {"newtons_per_force": math.nan}):
        with pytest.raises(palpate.OptionError, match=next(iter(settings))):
            bridge_module.Settings(**settings)


def test_the_package_is_complete() -> None:
    for name in ("package.xml", "setup.py", "setup.cfg", "resource/palpate_observer", "launch/observer.launch.py", "config/observer.yaml"):
        assert (PACKAGE / name).is_file(), name
    for path in PACKAGE.rglob("*.py"):
        compile(path.read_text(encoding="utf-8"), str(path), "exec")
