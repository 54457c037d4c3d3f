"""Messages of a gripper to estimates of its contact: all of the node that needs no ROS.

`Bridge` takes `sensor_msgs/JointState` and `geometry_msgs/WrenchStamped`, feeds a `palpate.Observer` with them, and returns the messages to be
published. It reads attributes alone and makes messages of the classes that it is given, so that the classes of rclpy and of `rosbags` serve
alike.

Readings join by their stamps: the displacement is interpolated between two joint states at the stamp of each wrench. A wrench waits for the
joint state after it, at most `max_wait_s`; then it is used without a displacement. Joint states wait for wrenches that come late, by up to
`max_wait_s` and `RESERVE_S`; a wrench that comes later is used without a displacement too.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import palpate

#: Results that are published as `std_msgs/Float64`, each under its name with its unit behind; attributes of `palpate.Observation`.
RESULTS = ("equilibrium_force_n", "excess_strain", "time_to_slip_s", "time_to_slip_low_s", "time_to_slip_high_s")

#: Where `diagnostic_msgs/DiagnosticArray` is published.
DIAGNOSTICS = "diagnostics"

#: How long joint states are kept for wrenches beyond `max_wait_s`, s.
RESERVE_S = 2.0

#: The classes of messages that a bridge makes.
TYPES = (
    "builtin_interfaces/msg/Time",
    "std_msgs/msg/Header",
    "std_msgs/msg/Float64",
    "diagnostic_msgs/msg/DiagnosticArray",
    "diagnostic_msgs/msg/DiagnosticStatus",
    "diagnostic_msgs/msg/KeyValue",
)


class Publication(NamedTuple):
    """A message and its topic, relative to the namespace of the results."""

    topic: str
    message: Any


@dataclass(frozen=True)
class Settings:
    """What a bridge needs to know of the gripper and of the grip, in SI units.

    `joint` is the joint of the finger, empty where there is none to listen to. `metres_per_position` converts its position to a
    displacement that grows as the gripper closes: -1 for a gap in metres, 2 for the travel of one of two fingers. `newtons_per_force`
    converts the component `force_axis` of the wrench to a force that is positive in compression, -1 where the sensor reports pushing as
    negative.
    """

    joint: str = ""
    metres_per_position: float = 1.0
    force_axis: str = "z"
    newtons_per_force: float = 1.0
    slip_force_n: float | None = None
    warn_before_s: float = 1.0
    confidence: float = 0.95
    material: str | None = None
    exponent: float | None = None
    max_wait_s: float = 0.1
    jump_back_s: float = 0.5
    repeat_warnings_s: float = 10.0

    def __post_init__(self) -> None:
        if self.force_axis not in ("x", "y", "z"):
            raise palpate.OptionError(f'force_axis: expected "x", "y" or "z", found "{self.force_axis}"')
        for name in ("metres_per_position", "newtons_per_force"):
            value = getattr(self, name)
            if not math.isfinite(value) or value == 0:
                raise palpate.OptionError(f"{name}: expected a finite number other than 0, found {value}")
        for name in ("max_wait_s", "jump_back_s", "repeat_warnings_s"):
            value = getattr(self, name)
            if not 0 <= value < math.inf:
                raise palpate.OptionError(f"{name}: expected a time of at least 0 s, found {value}")

    def observer(self) -> palpate.Observer:
        """The observer that these settings describe."""
        material = palpate.Material.read(self.material) if self.material else None
        return palpate.Observer(
            material,
            exponent=self.exponent,
            slip_force_n=self.slip_force_n,
            warn_before_s=self.warn_before_s,
            confidence=self.confidence,
        )


class Bridge:
    """Turns joint states and wrenches into estimates and warnings.

    Parameters
    ----------
    settings
        The gripper and the grip.
    types
        Classes of messages by name, those of `TYPES`: `rosbags` has them as `get_typestore(...).types`.

    Raises
    ------
    palpate.OptionError, palpate.ModelError, OSError
        As for `palpate.Observer` and `palpate.Material.read`.
    """

    def __init__(self, settings: Settings, types: Mapping[str, Any]) -> None:
        self._settings = settings
        self._types = {name: types[name] for name in TYPES}
        self._restart()

    def _restart(self) -> None:
        self._observer = self._settings.observer()
        self._joints: list[tuple[int, float]] = []
        #: Whether joint states have been dropped that were before all of these.
        self._dropped = False
        self._waiting: deque[tuple[int, float]] = deque()
        self._last: dict[str, int] = {}
        self._zero: int | None = None
        self._warned: dict[str, int] = {}
        self._others: set[str] = set()
        self._phase, self._warning = "free", "none"

    def joint_state(self, message: Any, received_ns: int = 0) -> list[Publication]:
        """Takes a `sensor_msgs/JointState`; `received_ns` stands in for a stamp of zero."""
        stamp = _stamp(message, received_ns)
        names, positions = list(message.name), message.position
        if self._settings.joint not in names[: len(positions)]:
            # Drivers of other joints may write to the topic; that ours is missing shows when a wrench waits in vain.
            self._others.update(names)
            return []
        index = names.index(self._settings.joint)
        out, is_next = self._ordered("joint states", stamp)
        if not is_next:
            return out
        position = float(positions[index])
        if not math.isfinite(position):
            return out + self._warn(stamp, "joint_not_finite", f"expected a finite position, found {position}")
        self._joints.append((stamp, self._settings.metres_per_position * position))
        self._drop(stamp - _nanoseconds(self._kept_s()))
        while self._waiting and self._waiting[0][0] <= stamp:
            out += self._feed(*self._waiting.popleft())
        return out

    def wrench(self, message: Any, received_ns: int = 0) -> list[Publication]:
        """Takes a `geometry_msgs/WrenchStamped`; `received_ns` stands in for a stamp of zero."""
        stamp = _stamp(message, received_ns)
        out, is_next = self._ordered("wrenches", stamp)
        if not is_next:
            return out
        force = float(getattr(message.wrench.force, self._settings.force_axis))
        if not math.isfinite(force):
            return out + self._warn(stamp, "wrench_not_finite", f"expected a finite force, found {force}")
        self._waiting.append((stamp, self._settings.newtons_per_force * force))
        if not self._settings.joint:
            return out + self._feed(*self._waiting.popleft())
        while self._waiting and self._joints and self._waiting[0][0] <= self._joints[-1][0]:
            out += self._feed(*self._waiting.popleft())
        longest = _nanoseconds(self._settings.max_wait_s)
        while self._waiting and stamp - self._waiting[0][0] > longest:
            out += self._warn(stamp, "joint_late", self._missing())
            out += self._feed(*self._waiting.popleft())
        return out

    def _kept_s(self) -> float:
        """How long joint states are kept."""
        return self._settings.max_wait_s + RESERVE_S

    def _drop(self, before: int) -> None:
        """Drops joint states before a stamp, all but the last of them; many at once, as the others move up."""
        old = bisect_right(self._joints, before, key=lambda one: one[0]) - 1
        if 2 * old > len(self._joints):
            del self._joints[:old]
            self._dropped = True

    def _missing(self) -> str:
        """That no position of the joint came in time, with the joints that did."""
        found = ", ".join(sorted(self._others))
        others = f", but states of {found}" if found else ""
        return f"expected a position of {self._settings.joint} every {self._settings.max_wait_s} s, found none{others}"

    def _ordered(self, what: str, stamp: int) -> tuple[list[Publication], bool]:
        """Whether a stamp is later than the last of its topic. A clock that goes back by more than `jump_back_s` begins anew."""
        last = self._last.get(what, -1)
        out: list[Publication] = []
        if stamp <= last:
            back = (last - stamp) / 1e9
            if back <= self._settings.jump_back_s:
                text = f"{what}: expected a later stamp, found one {back:g} s earlier; left out"
                return self._warn(stamp, f"order of {what}", text), False
            self._restart()
            out = self._warn(stamp, "clock", f"the clock went back by {back:g} s: the observer begins anew")
        self._last[what] = stamp
        return out, True

    def _displacement(self, stamp: int) -> float | None:
        """The displacement at a stamp: between two joint states, or that of the nearest within `max_wait_s`."""
        after = bisect_right(self._joints, stamp, key=lambda one: one[0])
        before = self._joints[after - 1] if after else None
        later = self._joints[after] if after < len(self._joints) else None
        if before and later:
            share = (stamp - before[0]) / (later[0] - before[0])
            return before[1] + share * (later[1] - before[1])
        nearest = before or later
        if nearest is None or abs(nearest[0] - stamp) > _nanoseconds(self._settings.max_wait_s):
            return None
        return nearest[1]

    def _feed(self, stamp: int, force: float) -> list[Publication]:
        """One tick of the observer."""
        if self._zero is None:
            self._zero = stamp
        warned: list[Publication] = []
        displacement = None
        if self._settings.joint and self._dropped and stamp < self._joints[0][0]:
            late = (self._joints[-1][0] - stamp) / 1e9
            text = f"wrenches: expected stamps at most {self._kept_s():g} s behind those of joint states, found one {late:g} s behind"
            warned = self._warn(stamp, "wrench_late", text)
        elif self._settings.joint:
            displacement = self._displacement(stamp)
        try:
            observed = self._observer.feed((stamp - self._zero) / 1e9, force, displacement)
        except palpate.PalpateError as error:
            return warned + self._warn(stamp, "refused", str(error))
        values = ((name, getattr(observed, name)) for name in RESULTS)
        float64 = self._types["std_msgs/msg/Float64"]
        out = [Publication(name, float64(data=float(value))) for name, value in values if value is not None]
        return warned + out + self._events(stamp, observed)

    def _events(self, stamp: int, observed: palpate.Observation) -> list[Publication]:
        """What changed with a tick: holds that begin and end, slip that is near or there."""
        status = self._types["diagnostic_msgs/msg/DiagnosticStatus"]
        out = []
        facts = [(name, getattr(observed, name)) for name in ("force_n", "held", "phase", *RESULTS)]
        if observed.began:
            out.append(self._report(stamp, status.OK, f"{observed.held} hold begins", facts))
        elif self._phase == "holding" and observed.phase != "holding":
            out.append(self._report(stamp, status.OK, "hold ends", facts))
        if observed.warning != self._warning and observed.warning == "soon":
            out.append(self._report(stamp, status.WARN, f"slip soon: predicted in {observed.time_to_slip_s:.3g} s", facts))
        if observed.warning != self._warning and observed.warning == "slipping":
            out.append(self._report(stamp, status.ERROR, f"slips, the force is {observed.force_n:.3g} N", facts))
        self._phase, self._warning = observed.phase, observed.warning
        return out

    def _warn(self, stamp: int, kind: str, text: str) -> list[Publication]:
        """Reports what is wrong with a message: a kind once, and again after `repeat_warnings_s`."""
        before = self._warned.get(kind)
        if before is not None and stamp - before < _nanoseconds(self._settings.repeat_warnings_s):
            return []
        self._warned[kind] = stamp
        level = self._types["diagnostic_msgs/msg/DiagnosticStatus"].WARN
        return [self._report(stamp, level, text, [("kind", kind)], "palpate: input")]

    def _report(
        self, stamp: int, level: Any, text: str, facts: Iterable[tuple[str, Any]], name: str = "palpate: contact"
    ) -> Publication:
        types = self._types
        values = [
            types["diagnostic_msgs/msg/KeyValue"](key=key, value=str(value)) for key, value in facts if value is not None
        ]
        status = types["diagnostic_msgs/msg/DiagnosticStatus"](
            level=level, name=name, message=text, hardware_id="", values=values
        )
        time = types["builtin_interfaces/msg/Time"](sec=stamp // 1_000_000_000, nanosec=stamp % 1_000_000_000)
        header = types["std_msgs/msg/Header"](stamp=time, frame_id="")
        return Publication(DIAGNOSTICS, types["diagnostic_msgs/msg/DiagnosticArray"](header=header, status=[status]))


def _stamp(message: Any, received_ns: int) -> int:
    """The stamp of a message in ns; where it is zero, which stands for none, when it was received."""
    stamp = message.header.stamp
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec) or received_ns


def _nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)
