"""Contacts with memory as systems of Drake: between a displacement and a force, at joints, and between bodies of a MultibodyPlant.

>>> import palpate.drake
>>> from pydrake.systems.analysis import Simulator
>>> contact = palpate.drake.ContactSystem({
...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
... }, period_s=1e-3)
>>> simulator = Simulator(contact)
>>> context = simulator.get_mutable_context()
>>> displacement = contact.GetInputPort("displacement_m")
>>> fixed = displacement.FixValue(context, [0.0])
>>> for k in range(101):
...     status = simulator.AdvanceTo(1e-3 * k)
...     fixed = displacement.FixValue(context, [5e-5 * k])
>>> round(float(contact.GetOutputPort("force_n").Eval(context)[0]), 3)
3.886

A contact has two numbers of discrete state, those of a `palpate.ContactState`: the share of the displacement of the jaw, and the
displacement of the node behind the contact layer, m. They are updated every period; between two updates outputs are a step from the last
one to now. So the force at an update is that of `ContactState.step` with steps of one period, and a context holds all there is to save.

A step that the body cannot make, such as to a displacement beyond it or to NaN, leaves the state as it is; the force is that of the state,
and the first such step gives a `palpate.PalpateWarning`.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from palpate import _twin_step
from palpate._palpate import OptionError, PalpateWarning
from palpate._twin_parameters import AT_TOUCH_M, BOND, UNBOUND, contact_numbers
from palpate._twin_step import NUMPY, ContactArrays, ContactParameters

try:
    from pydrake.common.cpp_param import List  # pyright: ignore[reportMissingImports]
    from pydrake.common.value import Value  # pyright: ignore
    from pydrake.math import RigidTransform  # pyright: ignore[reportMissingImports]
    from pydrake.multibody.math import SpatialForce  # pyright: ignore[reportMissingImports]
    from pydrake.multibody.plant import ExternallyAppliedSpatialForce  # pyright: ignore[reportMissingImports]
    from pydrake.systems.framework import LeafSystem  # pyright: ignore[reportMissingImports]
except ImportError as error:
    raise ImportError(f"palpate.drake needs drake, which is not installed: {error}") from None

__all__ = ["BodyContactSystem", "ContactSystem", "JointContactSystem"]

_Doubles = NDArray[np.float64]


class ContactSystem(LeafSystem):
    """Contacts that follow displacements.

    Input port ``displacement_m``, output ports ``force_n``, ``stiffness_n_per_m`` (slope of the force in the displacement with the node
    behind the contact layer at rest) and ``surface_m`` (displacement of the surface of the body at one contact), each with one number a
    contact.

    Parameters
    ----------
    model : path, mapping or Material, or a list of them
        As for `palpate.ContactState`, of a ball, a pad, a strip, a cylinder or a block with the force of uniform strain and the latency
        law: one for all contacts, or one each.
    period_s : float
        Time between two updates of the state, s; the time step of a discrete plant.
    count : int
        How many contacts.

    Raises
    ------
    OptionError, ModelError
        A description that makes no contact, or one that has no twin.
    """

    def __init__(self, model: Any, period_s: float, *, count: int = 1) -> None:
        LeafSystem.__init__(self)
        models = list(model) if isinstance(model, (list, tuple)) else [model]
        if count < 1 or len(models) not in (1, count):
            raise OptionError(f"model: expected one model, or one for each of {count} contacts, found {len(models)}")
        if not (np.isfinite(period_s) and period_s > 0.0):
            raise OptionError(f"period_s: expected a finite number above 0, found {period_s}")
        numbers = [contact_numbers(one) for one in models]
        #: Parameters, each an array over contacts.
        self.parameters = ContactParameters(*(np.broadcast_to(np.array(values), count) for values in zip(*numbers, strict=True)))
        self._count, self._warned = count, False
        self._state = self.DeclareDiscreteState(2 * count)
        #: Time of the last update, s.
        self._last = self.DeclareDiscreteState(np.array([-1.0]))
        self._declare_input()
        # A discrete plant updates itself by an unrestricted event, which Drake handles before discrete ones: as one of these, this update
        # would find the plant a step ahead.
        self.DeclarePeriodicUnrestrictedUpdateEvent(period_sec=period_s, offset_sec=0.0, update=self._update)
        for name, value in (("force_n", self._forces), ("stiffness_n_per_m", self._stiffnesses), ("surface_m", self._surfaces)):
            self.DeclareVectorOutputPort(name, count, _calculation(value))

    def _declare_input(self) -> None:
        self.DeclareVectorInputPort("displacement_m", self._count)

    def _displacements(self, context: Any) -> Any:
        """Displacements of the jaws now, m."""
        return _input(self, "displacement_m", context)

    def reset(self, context: Any) -> None:
        """Puts the contacts of a context back to first touch and rest."""
        context.get_mutable_discrete_state(self._state).SetFromVector(np.zeros(2 * self._count))
        context.get_mutable_discrete_state(self._last).SetFromVector(np.array([-1.0]))

    def _stepped(self, context: Any) -> tuple[ContactArrays, _Doubles]:
        """State and forces now: a step from the last update."""
        jaw, behind = np.array(context.get_discrete_state(self._state).value()).reshape(2, self._count)
        last = context.get_discrete_state(self._last).value()[0]
        sound = np.isfinite(jaw) & np.isfinite(behind)
        state = _twin_step.state_of(self.parameters, np.where(sound, jaw, 0.0), np.where(sound, behind, 0.0))
        # Before the first update the contact takes its displacement at once.
        elapsed = np.float64(max(0.0, context.get_time() - last) if last >= 0.0 else 0.0)
        to = np.asarray(self._displacements(context), dtype=np.float64)
        good = sound & _twin_step.accepts(NUMPY, self.parameters, elapsed, to)
        if not good.all() and not self._warned:
            self._warned = True
            which = int(np.argmin(good))
            found = f"{to[which]} m" if sound[which] else f"a state of {jaw[which]} m, {behind[which]} m"
            warnings.warn(
                f"contact {which}: expected a displacement within the body and a finite state, found {found}; the contact stays as it was",
                PalpateWarning,
                stacklevel=2,
            )
        return _twin_step.numpy_step(self.parameters, state, elapsed, to)

    def _update(self, context: Any, state: Any) -> None:
        contacts, _ = self._stepped(context)
        discrete = state.get_mutable_discrete_state()
        discrete.get_mutable_vector(self._state).SetFromVector(np.concatenate([contacts.jaw_m, contacts.behind_m]))
        discrete.get_mutable_vector(self._last).SetFromVector(np.array([context.get_time()]))

    def _forces(self, context: Any) -> _Doubles:
        return self._stepped(context)[1]

    def _stiffnesses(self, context: Any) -> _Doubles:
        slopes: _Doubles = _twin_step.stiffness(NUMPY, self.parameters, self._stepped(context)[0])
        return slopes

    def _surfaces(self, context: Any) -> Any:
        state, _ = self._stepped(context)
        return np.where(self.parameters.bonded > 0.0, state.jaw_m, np.maximum(state.jaw_m, state.behind_m))


class JointContactSystem(ContactSystem):
    """Contacts at prismatic joints: the position of the joint is the displacement of the jaw.

    Input port ``plant_state``, from ``plant.get_state_output_port()``; output port ``generalized_force``, to
    ``plant.get_applied_generalized_force_input_port()``, beside those of `ContactSystem`.

    Parameters
    ----------
    plant : MultibodyPlant
        A finalized plant.
    joints : sequence of PrismaticJoint
        One joint a contact.
    model, period_s
        As for `ContactSystem`.
    touch_m : float or sequence of float
        Position of the joint at first touch, m.
    direction : float or sequence of float
        1 where the jaw closes as the position rises, -1 where it closes as it falls.

    Raises
    ------
    OptionError
        A joint with more than one position; once the simulation begins, a body that is bonded to its jaw (``separation = false``) at a joint
        before first touch: it would pull the jaw to itself.
    """

    def __init__(
        self,
        plant: Any,
        joints: Sequence[Any],
        model: Any,
        period_s: float,
        *,
        touch_m: float | Sequence[float] = 0.0,
        direction: float | Sequence[float] = 1.0,
    ) -> None:
        for joint in joints:
            if joint.num_positions() != 1 or joint.num_velocities() != 1:
                raise OptionError(f"joints: expected joints with one position, found {joint.name()}")
        self._plant_states, self._velocities = plant.num_multibody_states(), plant.num_velocities()
        self._positions_at = np.array([joint.position_start() for joint in joints])
        self._velocities_at = np.array([joint.velocity_start() for joint in joints])
        self._touch, self._direction = _each(touch_m, len(joints), "touch_m"), _each(direction, len(joints), "direction")
        ContactSystem.__init__(self, model, period_s, count=len(joints))
        self.DeclareVectorOutputPort("generalized_force", self._velocities, _calculation(self._generalized))

    def _declare_input(self) -> None:
        self.DeclareVectorInputPort("plant_state", self._plant_states)

    def _displacements(self, context: Any) -> Any:
        positions = _input(self, "plant_state", context)[self._positions_at]
        displacements_m = self._direction * (positions - self._touch)
        apart = (self.parameters.bonded > 0.0) & (displacements_m < -AT_TOUCH_M)
        if apart.any() and context.get_discrete_state(self._last).value()[0] < 0.0:
            ahead_m = -displacements_m[apart].min()
            raise OptionError(f"model: {BOND} a joint that starts {ahead_m:.3g} m before first touch; {UNBOUND}")
        return displacements_m

    def _generalized(self, context: Any) -> _Doubles:
        forces = np.zeros(self._velocities)
        np.add.at(forces, self._velocities_at, -self._direction * self._forces(context))
        return forces


class BodyContactSystem(ContactSystem):
    """Contacts between pairs of bodies, along the line between a point of each; without friction.

    Input port ``body_poses``, from ``plant.get_body_poses_output_port()``; output port ``spatial_forces``, to
    ``plant.get_applied_spatial_force_input_port()``, beside those of `ContactSystem`. The contact of Drake between the two must be off, by
    a collision filter or without collision geometry. The approach beyond first touch is the displacement of one contact, from however many
    sides the body is squeezed: a ball between two fingers has two contacts.

    Parameters
    ----------
    pairs : sequence of (RigidBody, RigidBody)
        Bodies of one plant.
    model, period_s
        As for `ContactSystem`.
    touch_m : float or sequence of float
        Distance of the two points at first touch, m.
    points_m : array_like, shape (len(pairs), 2, 3)
        The points in the frames of the bodies, m; their origins if left out.

    Raises
    ------
    OptionError
        A body that is bonded (``separation = false``): it would pull from any distance.
    """

    def __init__(
        self,
        pairs: Sequence[tuple[Any, Any]],
        model: Any,
        period_s: float,
        *,
        touch_m: float | Sequence[float],
        points_m: Any = None,
    ) -> None:
        self._pairs = [(one.index(), other.index()) for one, other in pairs]
        self._touch = _each(touch_m, len(pairs), "touch_m")
        self._points = np.zeros((len(pairs), 2, 3)) if points_m is None else np.asarray(points_m, dtype=np.float64)
        if self._points.shape != (len(pairs), 2, 3):
            raise OptionError(f"points_m: expected an array of shape {(len(pairs), 2, 3)}, found {self._points.shape}")
        ContactSystem.__init__(self, model, period_s, count=len(pairs))
        if (self.parameters.bonded > 0.0).any():
            raise OptionError(f"model: {BOND} another from any distance; {UNBOUND}")
        self.DeclareAbstractOutputPort("spatial_forces", Value[List[ExternallyAppliedSpatialForce]], self._spatial)

    def _declare_input(self) -> None:
        self.DeclareAbstractInputPort("body_poses", Value[List[RigidTransform]]())

    def _lines(self, context: Any) -> _Doubles:
        """From the first point of each pair to the second, in the axes of the world, m."""
        poses = _input(self, "body_poses", context)
        pairs = zip(self._pairs, self._points, strict=True)
        ends = [[poses[int(body)].multiply(point) for body, point in zip(pair, points, strict=True)] for pair, points in pairs]
        ends_m: _Doubles = np.asarray(ends)
        return ends_m[:, 1] - ends_m[:, 0]

    def _displacements(self, context: Any) -> Any:
        return (self._touch - np.linalg.norm(self._lines(context), axis=1)) / self.parameters.share

    def _spatial(self, context: Any, output: Any) -> None:
        applied = []
        for pair, points, force, line in zip(self._pairs, self._points, self._forces(context), self._lines(context), strict=True):
            push = force * line / max(float(np.linalg.norm(line)), np.finfo(float).tiny)
            for body, point, sign in zip(pair, points, (-1.0, 1.0), strict=True):
                one = ExternallyAppliedSpatialForce()
                one.body_index, one.p_BoBq_B = body, point
                one.F_Bq_W = SpatialForce(tau=np.zeros(3), f=sign * push)
                applied.append(one)
        output.set_value(applied)


def _input(system: Any, name: str, context: Any) -> Any:
    return system.GetInputPort(name).Eval(context)


def _calculation(value: Any) -> Any:
    def calculate(context: Any, output: Any) -> None:
        output.SetFromVector(value(context))

    return calculate


def _each(values: float | Sequence[float], count: int, name: str) -> _Doubles:
    given = np.asarray(values, dtype=np.float64)
    if given.shape not in ((), (count,)) or not np.isfinite(given).all():
        raise OptionError(f"{name}: expected one finite number, or one for each of {count}, found {values}")
    return np.broadcast_to(given, count)
