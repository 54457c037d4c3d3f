"""The task of `palpate.gym`: what is gripped, how fingers move, what counts, and how bodies are drawn."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from os import PathLike
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from palpate._palpate import ContactStates, Material, ModelError, OptionError

#: A ball of 35 mm that relaxes by the latency law with n = 5.
BALL: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
#: Parameters of bodies that differ between environments, as `palpate.ContactStates` names them.
OF_BODY = ("modulus_pa", "radius_m", "exponent", "rate_coefficient_per_s", "layer_thickness_m")
#: Those of the load.
OF_LOAD = ("mass_kg", "friction")
#: Draws beyond so many standard deviations are put there.
_WIDEST = 4.0

Control = Literal["position", "force", "impedance"]


@dataclass(frozen=True)
class SoftGripTask:
    """Settings of the environments of `palpate.gym`; lengths, times and forces in SI.

    Examples
    --------
    >>> from palpate.gym import SoftGripTask
    >>> task = SoftGripTask(mass_kg=0.2, friction=0.5)
    >>> round(task.needed_force_n(), 3)  # 0.2 kg * 9.80665 m/s^2 / (2 * 0.5)
    1.961
    """

    #: The body: a description as for `palpate.ContactStates`, a `palpate.Material`, or the path of a file of either.
    model: Any = field(default_factory=lambda: BALL)
    #: What an action is: a displacement that the jaw goes to, a force, or where a spring pulls the finger.
    control: Control = "position"
    #: Whether every episode draws a body from the covariance of a `palpate.Material`.
    posterior: bool = False
    #: Parameters that every episode draws between two numbers, evenly: those of ``ContactStates`` by name, ``mass_kg``, ``friction``; with
    #: `posterior` none of those that the material has, which are drawn together.
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    #: Mass that is held, kg, and coefficient of friction between finger and body.
    mass_kg: float = 0.2
    friction: float = 0.5
    #: Gravity, m/s^2.
    gravity_m_per_s2: float = 9.80665
    #: When the support begins to give way, s, and how long it takes to carry nothing, s.
    lift_s: float = 1.0
    lift_takes_s: float = 0.5
    #: Displacement of the jaw at an action of 1, m, and its largest speed, m/s.
    travel_m: float = 0.02
    speed_m_per_s: float = 0.05
    #: Force at an action of 1, N, and that which crushes the body, N.
    force_n: float = 10.0
    crush_force_n: float = 20.0
    #: Resistance of the finger to motion, N s/m, with a force or an impedance; stiffness of its spring, N/m, with an impedance.
    damping_n_s_per_m: float = 50.0
    stiffness_n_per_m: float = 1000.0
    #: Time of a step, s, and equal parts that contact and finger take it in.
    period_s: float = 0.02
    substeps: int = 4
    #: Slip at which the body is lost, m.
    slip_limit_m: float = 5e-3
    #: Cost of a force of `force_n`, of slip at 0.1 m/s or faster, and of a body that is lost or crushed.
    force_cost: float = 0.5
    slip_cost: float = 0.5
    loss_cost: float = 10.0

    def __post_init__(self) -> None:
        if self.control not in ("position", "force", "impedance"):
            raise OptionError(f'control is one of "position", "force", "impedance", found {self.control!r}')
        for one in fields(self):
            value = getattr(self, one.name)
            if one.type == "float":
                least_is_allowed = one.name in ("lift_s", "gravity_m_per_s2") or one.name.endswith("_cost")
                _number(one.name, value, least_is_allowed)
        if isinstance(self.substeps, bool) or not isinstance(self.substeps, int) or self.substeps < 1:
            raise OptionError(f"substeps: expected a whole number, 1 or more, found {self.substeps!r}")
        if self.posterior:
            if isinstance(self.model, (str, PathLike)):
                object.__setattr__(self, "model", Material.read(self.model))
            twice = [name for name in _posterior(self.model)[0] if name in self.ranges]
            if twice:
                hint = f"leave {twice[0]} out of ranges, or use posterior=False"
                raise OptionError(f"ranges: expected no parameter that posterior=True draws, found {twice[0]}\nhint: {hint}")
        for name, ends in self.ranges.items():
            if name not in (*OF_BODY, *OF_LOAD):
                raise OptionError(f"ranges: expected names among {', '.join((*OF_BODY, *OF_LOAD))}, found {name}")
            low, high = _ends(name, ends)
            if not low <= high:
                raise OptionError(f"ranges: {name}: expected a lower and an upper end, found {low} and {high}")

    def needed_force_n(self) -> float:
        """Least force at a finger that holds the mass, m g/(2 mu), N."""
        return self.mass_kg * self.gravity_m_per_s2 / (2.0 * self.friction)


def task_of(settings: Mapping[str, Any]) -> SoftGripTask:
    """The task with settings by name."""
    known = [one.name for one in fields(SoftGripTask)]
    for name in settings:
        if name not in known:
            raise OptionError(f"settings: expected names among {', '.join(known)}, found {name}")
    return SoftGripTask(**settings)


def refuse_bond(task: SoftGripTask) -> None:
    """Refuses a body that is bonded to its jaws, which would pull: fingers only press."""
    contact = ContactStates(task.model, 1)
    # Off the body there is no force; a bond pulls there, or cannot be taken there.
    force = contact.step(0.0, -1e-6, errors="mask")
    if contact.failed[0] or force[0] < 0.0:
        hint = "set separation = true under [contact] of the test description where the jaws only press, and calibrate again"
        raise ModelError(f"model: separation = false in the material: its contacts can pull, fingers can only press\nhint: {hint}")


def refuse_ranges(task: SoftGripTask) -> None:
    """Refuses ranges some of whose draws would be no body, such as layers thicker than it: what an end of each makes is one, so is all between."""
    ends = {name: ends for name, ends in task.ranges.items() if name in OF_BODY}
    names, logs, _ = _posterior(task.model) if task.posterior else ((), np.empty(0), None)
    likely = dict(zip(names, np.exp(logs).tolist(), strict=True))
    for corner in itertools.product(*ends.values()):
        try:
            ContactStates(task.model, 1, **likely, **dict(zip(ends, corner, strict=True)))
        except ModelError as error:
            reason = re.sub(r", contact \d+", "", str(error))
            found = ", ".join(f"{name} = {value:g}" for name, value in zip(ends, corner, strict=True))
            raise ModelError(f"ranges: expected a body at both ends of each, found none at {found}: {reason}\nhint: narrow the range") from None


def slid(
    speed: NDArray[np.float64], before: NDArray[np.float64], after: NDArray[np.float64], dt: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speed (m/s) and way (m) of bodies after a time dt (s) in which the pull by mass goes straight from before to after (m/s^2).

    No body is drawn back: dv/dt is the pull while v > 0 or the pull is above 0. So v falls to 0 once at most, and rises from there again where
    the pull rises above 0.
    """
    rise = (after - before) / dt
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(before * before - 2.0 * rise * speed)
        stops = np.where(before > 0.0, -(before + root) / rise, 2.0 * speed / (root - before))
        stands = (stops >= 0.0) & (stops < dt)
        rest = np.where(stands & (rise > 0.0), np.clip(dt + before / rise, 0.0, dt), 0.0)
    goes = np.where(stands, stops, dt)
    way = goes * (speed + goes * (before / 2.0 + goes * rise / 6.0)) + rise * rest**3 / 6.0
    last = np.where(stands, rise * rest**2 / 2.0, speed + dt * (before + after) / 2.0)
    return np.maximum(last, 0.0), np.maximum(way, 0.0)


def _number(name: str, value: Any, zero: bool) -> float:
    wanted = "0 or more" if zero else "above 0"
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (math.isfinite(number) and (number > 0.0 or (zero and number == 0.0))):
        raise OptionError(f"{name}: expected a number {wanted}, found {value!r}")
    return number


def _ends(name: str, ends: Any) -> tuple[float, float]:
    try:
        low, high = ends
    except (TypeError, ValueError):
        raise OptionError(f"ranges: {name}: expected a lower and an upper end, found {ends!r}") from None
    return _number(f"ranges: {name}", low, False), _number(f"ranges: {name}", high, False)


def _posterior(model: Any) -> tuple[tuple[str, ...], NDArray[np.float64], NDArray[np.float64]]:
    """Names of the parameters of a material, the means of their logarithms, and a root of the covariance of these."""
    if not isinstance(model, Material):
        raise OptionError(f"posterior: expected a palpate.Material as the model, found {type(model).__name__}\nhint: palpate.Material.read(path) and Record.calibrate(...).material are some")
    covariance = model.log_covariance
    if covariance is None:
        raise OptionError("posterior: expected a material with a covariance, found one whose record leaves a parameter open")
    names = tuple(model.parameters)
    unknown = [name for name in names if name not in OF_BODY]
    if unknown or len(covariance) != len(names):
        raise OptionError(f"posterior: expected a material of the latency law with a modulus, found parameters {', '.join(names)}")
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    return names, np.log([model.parameters[name] for name in names]), root


class Bodies:
    """Parameters of the bodies of many environments, in place; every episode draws its own."""

    def __init__(self, task: SoftGripTask, count: int) -> None:
        self.task = task
        self.mass_kg = np.full(count, float(task.mass_kg))
        self.friction = np.full(count, float(task.friction))
        self.posterior = _posterior(task.model) if task.posterior else None
        names = [] if self.posterior is None else list(self.posterior[0])
        names += [name for name in task.ranges if name in OF_BODY]
        #: Values of contacts, for `ContactStates.reset`.
        self.of_body = {name: np.ones(count) for name in names}

    def draw_posterior(self, rng: np.random.Generator, mask: NDArray[np.bool_]) -> None:
        """Draws what is drawn from the covariance of a material, in the environments that the mask marks."""
        if self.posterior is None:
            return
        names, mean, root = self.posterior
        draws = rng.standard_normal((int(np.count_nonzero(mask)), len(names))).clip(-_WIDEST, _WIDEST)
        values = np.exp(mean + draws @ root.T)
        for place, name in enumerate(names):
            self.of_body[name][mask] = values[:, place]

    def draw(self, rng: np.random.Generator, mask: NDArray[np.bool_]) -> None:
        """Draws the parameters of the environments that the mask marks."""
        count = int(np.count_nonzero(mask))
        self.draw_posterior(rng, mask)
        for name, (low, high) in self.task.ranges.items():
            column = self.of_body[name] if name in OF_BODY else getattr(self, name)
            column[mask] = rng.uniform(low, high, count)
