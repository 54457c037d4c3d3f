"""Contacts in the worlds of MuJoCo Warp and Newton; see `palpate.warp`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from palpate._frameworks import framework
from palpate._twin_parameters import AT_TOUCH_M, BOND, UNBOUND
from palpate._warp_contacts import Contacts

wp = framework("warp", "warp-lang", "palpate.warp")


class _MujocoContacts(Contacts):
    """Contacts of the worlds of MuJoCo Warp, the contacts of a world side by side."""

    def __init__(self, m: Any, d: Any, model: Any, each: int, touch_m: Any, dtype: Any) -> None:
        # The stages of a Runge-Kutta step are no steps of a contact.
        if int(m.opt.integrator) == 1:
            raise ValueError("integrator: expected Euler or implicitfast, found RK4, which evaluates forces between steps")
        self.worlds = int(d.nworld)
        super().__init__(model, self.worlds * each, dtype=dtype, device=d.qpos.device)
        self._touch = _each(touch_m, each, "touch_m", self.device)
        self._before: Any = None

    def attach(self, m: Any) -> None:
        """Makes the contacts a passive force of a model: after a passive callback that it has already.

        MuJoCo Warp computes no passive forces where springs and dampers are both disabled.
        """
        self._before = m.callback.passive
        m.callback.passive = self

    def __call__(self, m: Any, d: Any) -> None:
        """Steps the contacts to where the worlds are, and adds their forces to ``d.qfrc_passive``.

        A world that was reset, whose time went back, begins with contacts at rest. A second evaluation at the same time is a step of 0 s.
        """
        if self._before is not None:
            self._before(m, d)
        self._launch(m, d)

    def _launch(self, m: Any, d: Any) -> None:
        raise NotImplementedError

    def _outputs(self, d: Any) -> list[Any]:
        return [self.state, self.last, self.force_n, self.refused, d.qfrc_passive]


class JointContacts(_MujocoContacts):
    """Contacts at slide joints of MuJoCo Warp: the position of the joint is the displacement of the jaw.

    Parameters
    ----------
    m, d
        Model and data of MuJoCo Warp.
    model
        As for `contact_parameters`: one for all, one a joint, or one for each joint of each world.
    joints : sequence of int
        Ids of slide joints, such as ``mj_model.joint("finger").id``.
    touch_m : float or sequence of float
        Position of the joint at first touch, m.
    direction : float or sequence of float
        1 where the jaw closes as the position rises, -1 where it closes as it falls.
    dtype : warp.float32 or warp.float64
        Of the states.

    Raises
    ------
    ValueError
        A joint that is no slide joint; a body that is bonded to its jaw (``separation = false``) at a joint before first touch: it would
        pull the jaw to itself.

    Examples
    --------
    ::

        contacts = palpate.warp.JointContacts(m, d, "ball.toml", [mj_model.joint("finger").id], touch_m=0.02)
        contacts.attach(m)
        mujoco_warp.step(m, d)
    """

    def __init__(
        self,
        m: Any,
        d: Any,
        model: Any,
        joints: Sequence[int],
        *,
        touch_m: float | Sequence[float] = 0.0,
        direction: float | Sequence[float] = 1.0,
        dtype: Any = wp.float64,
    ) -> None:
        super().__init__(m, d, model, len(joints), touch_m, dtype)
        types = m.jnt_type.numpy()
        for joint in joints:
            # mjJNT_SLIDE
            if not (0 <= joint < len(types) and types[joint] == 2):
                raise ValueError(f"joints: expected ids of slide joints, found {joint}")
        self._direction = _each(direction, len(joints), "direction", self.device)
        addresses = m.jnt_qposadr.numpy()[np.asarray(joints)]
        bonded = np.tile(_bonded(self.parameters), self.worlds * len(joints) // len(self.parameters))
        ahead_m = self._direction.numpy() * (self._touch.numpy() - d.qpos.numpy()[:, addresses])
        apart = bonded.reshape(ahead_m.shape) & (ahead_m > AT_TOUCH_M)
        if apart.any():
            raise ValueError(f"model: {BOND} a joint that starts {ahead_m[apart].max():.3g} m before first touch; {UNBOUND}")
        at = np.asarray(joints)
        self._qposadr = wp.array(addresses, dtype=int, device=self.device)
        self._dofadr = wp.array(m.jnt_dofadr.numpy()[at], dtype=int, device=self.device)

    def _launch(self, m: Any, d: Any) -> None:
        inputs = [self.parameters, self._qposadr, self._dofadr, self._touch, self._direction, m.opt.timestep, d.time, d.qpos]
        shape = (self.worlds, len(self._qposadr))
        wp.launch(self._kernels.joints, dim=shape, inputs=[*inputs, *self._outputs(d)], device=self.device)


class GeomContacts(_MujocoContacts):
    """Contacts between pairs of geoms of MuJoCo Warp, along the line of their centres; without friction.

    The contact of MuJoCo between the two must be off, by ``<exclude>`` or ``contype``. The approach beyond first touch is the
    displacement of one contact, from however many sides the body is squeezed: a ball between two fingers has two contacts.

    Parameters
    ----------
    m, d, model, dtype
        As for `JointContacts`.
    pairs : sequence of (int, int)
        Ids of geoms, such as ``mj_model.geom("pad").id``.
    touch_m : float or sequence of float
        Distance of the two centres at first touch, m.

    Raises
    ------
    ValueError
        A body that is bonded (``separation = false``): it would pull from any distance.
    """

    def __init__(
        self,
        m: Any,
        d: Any,
        model: Any,
        pairs: Sequence[tuple[int, int]],
        *,
        touch_m: float | Sequence[float],
        dtype: Any = wp.float64,
    ) -> None:
        super().__init__(m, d, model, len(pairs), touch_m, dtype)
        _refuse_bonds(self.parameters)
        self._pairs = _pairs(pairs, 0, len(m.geom_bodyid), self.device)

    def _launch(self, m: Any, d: Any) -> None:
        tree = [m.geom_bodyid, m.body_parentid, m.body_rootid, m.body_dofadr, m.body_dofnum, d.subtree_com, d.cdof]
        inputs = [self.parameters, self._pairs, self._touch, *tree, m.opt.timestep, d.time, d.geom_xpos]
        shape = (self.worlds, len(self._pairs))
        wp.launch(self._kernels.geoms, dim=shape, inputs=[*inputs, *self._outputs(d)], device=self.device)


class NewtonContacts(Contacts):
    """Contacts between pairs of bodies of Newton, along the line between a point of each; without friction.

    The approach beyond first touch is the displacement of one contact, as in `GeomContacts`. Shapes that Newton collides must be filtered.

    Parameters
    ----------
    newton_model
        A ``newton.Model``.
    model
        As for `contact_parameters`: one for all pairs, or one each.
    pairs : sequence of (int, int)
        Indices of bodies; -1 is the world.
    touch_m : float or sequence of float
        Distance of the two points at first touch, m.
    points_m : array_like, shape (len(pairs), 2, 3)
        The points in the frames of the bodies, m; their origins if left out.
    dtype : warp.float32 or warp.float64
        Of the states.

    Raises
    ------
    ValueError
        A body that is bonded (``separation = false``): it would pull from any distance.

    Examples
    --------
    ::

        contacts = palpate.warp.NewtonContacts(model, "ball.toml", [(finger, ball)], touch_m=0.035)
        state_0.clear_forces()
        contacts.apply(state_0, dt_s)
        solver.step(state_0, state_1, control, None, dt_s)
    """

    def __init__(
        self,
        newton_model: Any,
        model: Any,
        pairs: Sequence[tuple[int, int]],
        *,
        touch_m: float | Sequence[float],
        points_m: Any = None,
        dtype: Any = wp.float64,
    ) -> None:
        super().__init__(model, len(pairs), dtype=dtype, device=newton_model.device)
        _refuse_bonds(self.parameters)
        self._pairs = _pairs(pairs, -1, newton_model.body_count, self.device)
        self._touch = _each(touch_m, len(pairs), "touch_m", self.device)
        points = np.zeros((len(pairs), 2, 3)) if points_m is None else np.asarray(points_m, dtype=np.float64)
        if points.shape != (len(pairs), 2, 3):
            raise ValueError(f"points_m: expected an array of shape {(len(pairs), 2, 3)}, found {points.shape}")
        self._points = wp.array(points.astype(np.float32), dtype=wp.vec3, device=self.device)
        self._body_com = newton_model.body_com

    def apply(self, state: Any, dt_s: float) -> None:
        """Steps the contacts to where the bodies are, and adds their forces to ``state.body_f``.

        Once a step of the solver, after ``state.clear_forces()``; the first call makes a step of 0 s.
        """
        inputs = [self.parameters, float(dt_s), self._pairs, self._points, self._touch, self._body_com, state.body_q]
        outputs = [self.state, self.last, self.force_n, self.refused, state.body_f]
        wp.launch(self._kernels.bodies, dim=len(self), inputs=[*inputs, *outputs], device=self.device)


def _bonded(parameters: Any) -> Any:
    return parameters.numpy()["bonded"] > 0.0


def _refuse_bonds(parameters: Any) -> None:
    if _bonded(parameters).any():
        raise ValueError(f"model: {BOND} another from any distance; {UNBOUND}")


def _each(values: float | Sequence[float], count: int, name: str, device: Any) -> Any:
    given = np.asarray(values, dtype=np.float32)
    if given.shape not in ((), (count,)) or not np.isfinite(given).all():
        raise ValueError(f"{name}: expected one finite number, or one for each of {count}, found {values}")
    return wp.array(np.broadcast_to(given, count).copy(), dtype=float, device=device)


def _pairs(pairs: Sequence[tuple[int, int]], least: int, count: int, device: Any) -> Any:
    given = np.asarray(pairs, dtype=np.int32)
    if given.ndim != 2 or given.shape[1] != 2 or (given < least).any() or (given >= count).any():
        raise ValueError(f"pairs: expected two indices from {least} to {count - 1} each, found {pairs}")
    return wp.array(given, dtype=wp.vec2i, device=device)
