# What Warp compiles: its annotations are types of Warp, and functions for any type of number have none.
# mypy: ignore-errors
# pyright: reportInvalidTypeForm=false, reportGeneralTypeIssues=false, reportAttributeAccessIssue=false, reportOperatorIssue=false
# pyright: reportArgumentType=false, reportAssignmentType=false, reportCallIssue=false, reportIndexIssue=false
"""The step of a contact as functions and kernels of Warp.

The functions take any of the two structs of parameters, and numbers of its type. They are those of
``crates/palpate/src/simulate/step.rs``, and have no adjoint.
"""

import functools
import types
from typing import Any

from palpate._frameworks import framework

wp = framework("warp", "warp-lang", "palpate.warp")
wp.set_module_options({"enable_backward": False})


@wp.struct
class ContactParameters32:
    """A body and its law in SI, in single precision; see `palpate.warp.contact_parameters`."""

    modulus_pa: wp.float32
    depth_m: wp.float32
    layers: wp.float32
    radius_m: wp.float32
    area_m2: wp.float32
    exponent: wp.float32
    rate_coefficient_per_s: wp.float32
    share: wp.float32
    bonded: wp.float32


@wp.struct
class ContactParameters64:
    """A body and its law in SI, in double precision; see `palpate.warp.contact_parameters`."""

    modulus_pa: wp.float64
    depth_m: wp.float64
    layers: wp.float64
    radius_m: wp.float64
    area_m2: wp.float64
    exponent: wp.float64
    rate_coefficient_per_s: wp.float64
    share: wp.float64
    bonded: wp.float64


@wp.func
def log_1p(z: Any):
    """ln(1 + z) to rounding; Warp has none."""
    one = type(z)(1.0)
    u = one + z
    if u == one:
        return z
    if z > one:
        return wp.log(u)
    return wp.log(u) * (z / (u - one))


@wp.func
def relaxed(p: Any, excess: Any, elapsed: Any):
    """Excess strain after some time at constant equilibrium strain, equations (4) and (5)."""
    zero = type(excess)(0.0)
    one = type(excess)(1.0)
    if excess == zero:
        return zero
    size = wp.abs(excess)
    if p.exponent == type(excess)(5.0):
        square = size * size
        return excess / wp.sqrt(wp.sqrt(one + type(excess)(4.0) * (p.rate_coefficient_per_s * (square * square) * elapsed)))
    over = p.exponent - one
    scaled = p.rate_coefficient_per_s * wp.pow(size, over) * elapsed
    z = over * scaled
    if z <= -one:
        return zero
    if z == zero:
        return excess * wp.exp(-scaled)
    return excess * wp.exp(-log_1p(z) / over)


@wp.func
def excess_of(p: Any, jaw: Any, behind: Any):
    """Excess strain of the contact layer between the jaw and the node behind it (m)."""
    return (jaw - behind) * p.layers / p.depth_m - jaw / p.depth_m


@wp.func
def pressed(p: Any, jaw: Any, excess: Any, dt: Any, to: Any):
    """Node behind the layer and excess strain after a step in contact."""
    kick = type(excess)(0.5) * (to - jaw) * (p.layers - type(excess)(1.0)) / p.depth_m
    after = relaxed(p, excess + kick, dt) + kick
    return to - p.depth_m / p.layers * (after + to / p.depth_m), after


@wp.func
def free(p: Any, behind: Any, dt: Any):
    """The surface after a step on its own."""
    return p.depth_m * relaxed(p, behind / p.depth_m, dt / p.layers)


@wp.func
def contact_force(p: Any, jaw: Any, excess: Any):
    """Contact force F = E strain A(u), equation (11), N; 0 while the jaw is off."""
    zero = type(jaw)(0.0)
    strain = excess + jaw / p.depth_m
    if p.bonded == zero and strain <= zero:
        return zero
    area = p.area_m2
    if p.radius_m > zero:
        inside = wp.max(jaw, zero)
        area = type(jaw)(3.141592653589793) * inside * (type(jaw)(2.0) * p.radius_m - inside)
    return p.modulus_pa * strain * area


@wp.func
def contact_stiffness(p: Any, jaw: Any, behind: Any, excess: Any):
    """Slope of the force in the displacement with the node behind the layer at rest, N/m; 0 while the jaw is off."""
    zero = type(jaw)(0.0)
    pi = type(jaw)(3.141592653589793)
    if p.bonded == zero and jaw < behind:
        return zero
    area = p.area_m2
    growth = type(jaw)(0.0)
    if p.radius_m > zero:
        inside = wp.max(jaw, zero)
        area = pi * inside * (type(jaw)(2.0) * p.radius_m - inside)
        if jaw >= zero:
            growth = type(jaw)(2.0) * pi * (p.radius_m - jaw)
    return p.share * p.modulus_pa * (area * p.layers / p.depth_m + (excess + jaw / p.depth_m) * growth)


@wp.func
def contact_accepts(p: Any, dt: Any, displacement: Any):
    """Whether a step can be made: finite numbers, no step below 0 s, a displacement within the body."""
    zero = type(dt)(0.0)
    to = p.share * displacement
    if not (wp.isfinite(dt) and wp.isfinite(displacement)):
        return False
    if dt < zero:
        return False
    is_round = p.radius_m > zero
    is_bonded = p.bonded > zero
    if to >= p.depth_m and (is_round or not is_bonded):
        return False
    if to < zero and is_round and is_bonded:
        return False
    return True


@wp.func
def apart(p: Any, jaw: Any, behind: Any, excess: Any, dt: Any, to: Any, touching: bool):
    """Above zero while a jaw that touches still does, and while one that is off still is."""
    if touching:
        node, after = pressed(p, jaw, excess, dt, to)
        return after + to / p.depth_m
    return free(p, behind, dt) - to


@wp.func
def crossing(p: Any, jaw: Any, behind: Any, excess: Any, dt: Any, to: Any, touching: bool):
    """Where between 0 and 1 of the step the jaw leaves or meets the body, by 30 bisections."""
    above = type(dt)(0.0)
    below = type(dt)(1.0)
    for _bisection in range(30):
        middle = type(dt)(0.5) * (above + below)
        if apart(p, jaw, behind, excess, middle * dt, jaw + middle * (to - jaw), touching) > type(dt)(0.0):
            above = middle
        else:
            below = middle
    return above


@wp.func
def contact_step(p: Any, jaw: Any, behind: Any, excess: Any, dt: Any, displacement: Any):
    """Moves the jaw to a displacement (m) within a time step (s); returns jaw, behind, excess and the force (N).

    A step that `contact_accepts` denies leaves the three as they are; its force is theirs.
    """
    if not contact_accepts(p, dt, displacement):
        return jaw, behind, excess, contact_force(p, jaw, excess)
    to = p.share * displacement
    is_bonded = p.bonded > type(dt)(0.0)
    touching = is_bonded or jaw >= behind
    if touching:
        held, after = pressed(p, jaw, excess, dt, to)
        if is_bonded or to >= held:
            return to, held, after, contact_force(p, to, after)
    else:
        surface = free(p, behind, dt)
        if surface > to:
            return to, surface, excess_of(p, to, surface), type(dt)(0.0)
    share = crossing(p, jaw, behind, excess, dt, to, touching)
    at = jaw + share * (to - jaw)
    rest = (type(dt)(1.0) - share) * dt
    if touching:
        node, unused = pressed(p, jaw, excess, share * dt, at)
        left = free(p, wp.max(at, node), rest)
        gone = excess_of(p, to, left)
        return to, left, gone, contact_force(p, to, gone)
    touch = free(p, behind, share * dt)
    met, strained = pressed(p, touch, excess_of(p, touch, touch), rest, to)
    return to, met, strained, contact_force(p, to, strained)


@wp.func
def along_tree(
    body: int,
    world: int,
    point: wp.vec3,
    force: wp.vec3,
    body_parentid: wp.array(dtype=int),
    body_rootid: wp.array(dtype=int),
    body_dofadr: wp.array(dtype=int),
    body_dofnum: wp.array(dtype=int),
    subtree_com: wp.array2d(dtype=wp.vec3),
    cdof: wp.array2d(dtype=wp.spatial_vector),
    qfrc: wp.array2d(dtype=float),
):
    """Adds a force on a point of a body to the generalised forces, as the transpose of the Jacobian does."""
    offset = point - subtree_com[world, body_rootid[body]]
    at = int(body)
    while at > 0:
        first = body_dofadr[at]
        for k in range(body_dofnum[at]):
            dof = cdof[world, first + k]
            moved = wp.spatial_bottom(dof) + wp.cross(wp.spatial_top(dof), offset)
            wp.atomic_add(qfrc, world, first + k, wp.dot(moved, force))
        at = body_parentid[at]


@wp.func
def wrench_at(body: int, point: wp.vec3, force: wp.vec3, pose: wp.transform, body_com: wp.array(dtype=wp.vec3)):
    """A force on a point as a wrench of Newton: force, and torque about the centre of mass, in the axes of the world."""
    return wp.spatial_vector(force, wp.cross(point - wp.transform_point(pose, body_com[body]), force))


@wp.func
def advance(
    p: Any,
    i: int,
    dt: Any,
    displacement: Any,
    state: wp.array2d(dtype=Any),
    force: wp.array(dtype=Any),
    refused: wp.array(dtype=int),
):
    """Steps contact i in place, counts a step that cannot be made, and returns the force."""
    if not contact_accepts(p, dt, displacement):
        refused[i] = refused[i] + 1
    jaw, behind, excess, f = contact_step(p, state[i, 0], state[i, 1], state[i, 2], dt, displacement)
    state[i, 0] = jaw
    state[i, 1] = behind
    state[i, 2] = excess
    force[i] = f
    return f


@wp.func
def clear(i: int, state: wp.array2d(dtype=Any)):
    """At first touch and at rest."""
    state[i, 0] = state.dtype(0.0)
    state[i, 1] = state.dtype(0.0)
    state[i, 2] = state.dtype(0.0)


@wp.func
def elapsed_since(i: int, now: float, timestep: float, state: wp.array2d(dtype=Any), last: wp.array(dtype=float)):
    """Length of the step that ends now, s: none where the time is the same; where it went back the contact begins anew."""
    before = last[i]
    last[i] = now
    if before < 0.0 or now < before:
        clear(i, state)
        return 0.0
    if now > before:
        return timestep
    return 0.0


@functools.cache
def kernels(real: Any) -> types.SimpleNamespace:
    """The kernels for numbers of one type, wp.float32 or wp.float64; each is compiled when it is launched first."""
    parameters_type = ContactParameters64 if real == wp.float64 else ContactParameters32

    @wp.kernel(module="unique", enable_backward=False)
    def step(
        parameters: wp.array(dtype=parameters_type),
        dt: real,
        displacement: wp.array(dtype=real),
        state: wp.array2d(dtype=real),
        force: wp.array(dtype=real),
        refused: wp.array(dtype=int),
    ):
        i = wp.tid()
        advance(parameters[i % parameters.shape[0]], i, dt, displacement[i % displacement.shape[0]], state, force, refused)

    @wp.kernel(module="unique", enable_backward=False)
    def stiffness(parameters: wp.array(dtype=parameters_type), state: wp.array2d(dtype=real), slope: wp.array(dtype=real)):
        i = wp.tid()
        slope[i] = contact_stiffness(parameters[i % parameters.shape[0]], state[i, 0], state[i, 1], state[i, 2])

    @wp.kernel(module="unique", enable_backward=False)
    def reset(mask: wp.array(dtype=bool), state: wp.array2d(dtype=real), last: wp.array(dtype=float)):
        i = wp.tid()
        # A mask of worlds stands for all contacts of each.
        if mask[i // (state.shape[0] // mask.shape[0])]:
            clear(i, state)
            last[i] = -1.0

    @wp.kernel(module="unique", enable_backward=False)
    def joints(
        parameters: wp.array(dtype=parameters_type),
        qposadr: wp.array(dtype=int),
        dofadr: wp.array(dtype=int),
        touch: wp.array(dtype=float),
        direction: wp.array(dtype=float),
        timestep: wp.array(dtype=float),
        time: wp.array(dtype=float),
        qpos: wp.array2d(dtype=float),
        state: wp.array2d(dtype=real),
        last: wp.array(dtype=float),
        force: wp.array(dtype=real),
        refused: wp.array(dtype=int),
        qfrc: wp.array2d(dtype=float),
    ):
        world, c = wp.tid()
        i = world * qposadr.shape[0] + c
        dt = elapsed_since(i, time[world], timestep[world % timestep.shape[0]], state, last)
        displacement = real(direction[c] * (qpos[world, qposadr[c]] - touch[c]))
        f = float(advance(parameters[i % parameters.shape[0]], i, real(dt), displacement, state, force, refused))
        wp.atomic_add(qfrc, world, dofadr[c], -direction[c] * f)

    @wp.kernel(module="unique", enable_backward=False)
    def geoms(
        parameters: wp.array(dtype=parameters_type),
        pairs: wp.array(dtype=wp.vec2i),
        touch: wp.array(dtype=float),
        geom_bodyid: wp.array(dtype=int),
        body_parentid: wp.array(dtype=int),
        body_rootid: wp.array(dtype=int),
        body_dofadr: wp.array(dtype=int),
        body_dofnum: wp.array(dtype=int),
        subtree_com: wp.array2d(dtype=wp.vec3),
        cdof: wp.array2d(dtype=wp.spatial_vector),
        timestep: wp.array(dtype=float),
        time: wp.array(dtype=float),
        geom_xpos: wp.array2d(dtype=wp.vec3),
        state: wp.array2d(dtype=real),
        last: wp.array(dtype=float),
        force: wp.array(dtype=real),
        refused: wp.array(dtype=int),
        qfrc: wp.array2d(dtype=float),
    ):
        world, c = wp.tid()
        one = pairs[c][0]
        other = pairs[c][1]
        a = geom_xpos[world, one]
        b = geom_xpos[world, other]
        i = world * pairs.shape[0] + c
        dt = elapsed_since(i, time[world], timestep[world % timestep.shape[0]], state, last)
        p = parameters[i % parameters.shape[0]]
        # Two geoms approach by one contact's share of a displacement.
        displacement = real(touch[c] - wp.length(b - a)) / p.share
        push = float(advance(p, i, real(dt), displacement, state, force, refused)) * wp.normalize(b - a)
        along_tree(
            geom_bodyid[one], world, a, -push, body_parentid, body_rootid, body_dofadr, body_dofnum, subtree_com, cdof, qfrc
        )
        along_tree(
            geom_bodyid[other], world, b, push, body_parentid, body_rootid, body_dofadr, body_dofnum, subtree_com, cdof, qfrc
        )

    @wp.kernel(module="unique", enable_backward=False)
    def bodies(
        parameters: wp.array(dtype=parameters_type),
        dt: float,
        pairs: wp.array(dtype=wp.vec2i),
        points: wp.array2d(dtype=wp.vec3),
        touch: wp.array(dtype=float),
        body_com: wp.array(dtype=wp.vec3),
        body_q: wp.array(dtype=wp.transform),
        state: wp.array2d(dtype=real),
        last: wp.array(dtype=float),
        force: wp.array(dtype=real),
        refused: wp.array(dtype=int),
        body_f: wp.array(dtype=wp.spatial_vector),
    ):
        i = wp.tid()
        one = pairs[i][0]
        other = pairs[i][1]
        a = points[i, 0]
        b = points[i, 1]
        # A point of the world stands in its coordinates.
        if one >= 0:
            a = wp.transform_point(body_q[one], a)
        if other >= 0:
            b = wp.transform_point(body_q[other], b)
        p = parameters[i % parameters.shape[0]]
        displacement = real(touch[i] - wp.length(b - a)) / p.share
        elapsed = real(dt)
        if last[i] < 0.0:
            elapsed = real(0.0)
        last[i] = 0.0
        push = float(advance(p, i, elapsed, displacement, state, force, refused)) * wp.normalize(b - a)
        if one >= 0:
            wp.atomic_add(body_f, one, wrench_at(one, a, -push, body_q[one], body_com))
        if other >= 0:
            wp.atomic_add(body_f, other, wrench_at(other, b, push, body_q[other], body_com))

    return types.SimpleNamespace(
        parameters_type=parameters_type, step=step, stiffness=stiffness, reset=reset, joints=joints, geoms=geoms, bodies=bodies
    )
