"""The step of a contact over arrays: one formula for every library of arrays, here and in `palpate.jax`.

The formula is that of ``crates/palpate/src/simulate/step.rs``: half the drive, the closed form (4), (5) of the law, the other half
(Strang 1968). A jaw that leaves or meets the body within a step does so where 30 bisections find it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

#: Bisections of the moment at which the jaw leaves or meets the body: a thousandth of a millionth of the step.
BISECTIONS = 30


class ContactParameters(NamedTuple):
    """A body and its law in SI, each a number or an array over contacts.

    The contact layer has the strain ε = x + u/depth with the excess strain x and the contact displacement u = share · displacement. Its
    force is E ε A(u), with A = π u (2 radius − u) of a ball and a pad, and the section of a body of constant section.
    """

    #: Young's modulus E, Pa.
    modulus_pa: Any
    #: Distance from the undeformed contact to the plane that does not move, m.
    depth_m: Any
    #: Number of layers m, 1 or more.
    layers: Any
    #: Radius of a ball, outer radius of a pad, m; 0 of a body of constant section.
    radius_m: Any
    #: Section of a strip, a cylinder or a block, m²; 0 of a ball and a pad.
    area_m2: Any
    #: Exponent n of the law, above 0.
    exponent: Any
    #: Rate coefficient v, 1/s.
    rate_coefficient_per_s: Any
    #: Share of the displacement that one contact takes: 1/2 of a body that is squeezed from two sides, else 1.
    share: Any
    #: 1 where body and jaw are bonded, 0 where the jaw can only push.
    bonded: Any


class ContactArrays(NamedTuple):
    """State of contacts between two steps.

    The first two are the state of `palpate.ContactState`. The third follows from them, ε − u/depth, and is kept because the difference
    has lost most of its digits in single precision.
    """

    #: One contact's share of the displacement of the jaw, m.
    jaw_m: Any
    #: Displacement of the node behind the contact layer, m.
    behind_m: Any
    #: Excess strain x of the contact layer.
    excess: Any


class Library(NamedTuple):
    """A library of arrays, and what it does in its own way."""

    #: numpy, or jax.numpy.
    xp: Any
    #: ``branch(which, one, other)`` calls one of two functions without arguments.
    branch: Callable[[Any, Callable[[], Any], Callable[[], Any]], Any]
    #: ``repeat(count, function, start)`` calls a function of one argument on its own results.
    repeat: Callable[[int, Callable[[Any], Any], Any], Any]
    #: A tree of arrays that is taken as constant in derivatives.
    constant: Callable[[Any], Any]
    #: ``root(function, at, arguments)``: the root at which ``function(at, *arguments)`` is zero, with its derivatives in the arguments.
    root: Callable[[Callable[..., Any], Any, tuple[Any, ...]], Any]


def _repeated(count: int, function: Callable[[Any], Any], start: Any) -> Any:
    for _ in range(count):
        start = function(start)
    return start


NUMPY = Library(
    xp=np,
    branch=lambda which, one, other: one() if which else other(),
    repeat=_repeated,
    constant=lambda tree: tree,
    root=lambda function, at, arguments: at,
)


def state_of(parameters: ContactParameters, jaw_m: Any, behind_m: Any) -> ContactArrays:
    """The state with the jaw and the node behind the contact layer at these displacements (m)."""
    strain = (jaw_m - behind_m) * parameters.layers / parameters.depth_m
    return ContactArrays(jaw_m, behind_m, strain - jaw_m / parameters.depth_m)


def accepts(library: Library, parameters: ContactParameters, dt_s: Any, displacement_m: Any) -> Any:
    """Whether `palpate.ContactState` accepts a step: numbers that are finite, no step below 0 s, a displacement within the body."""
    xp, p = library.xp, parameters
    to = p.share * displacement_m
    is_round, is_bonded = p.radius_m > 0.0, p.bonded > 0.0
    # A strip in grips may be stretched and pressed to any length; a bonded ball cannot be pulled off.
    is_strip = xp.logical_and(is_bonded, xp.logical_not(is_round))
    too_deep = xp.logical_and(to >= p.depth_m, xp.logical_not(is_strip))
    pulled_off = xp.logical_and(to < 0.0, xp.logical_and(is_round, is_bonded))
    refused = xp.logical_or(too_deep, pulled_off)
    return xp.isfinite(displacement_m) & xp.isfinite(dt_s) & (dt_s >= 0.0) & xp.logical_not(refused)


def force(library: Library, parameters: ContactParameters, state: ContactArrays) -> Any:
    """Contact force F = E ε A(u), N; 0 while the jaw is off."""
    xp, p = library.xp, parameters
    strain = state.excess + state.jaw_m / p.depth_m
    value = p.modulus_pa * strain * area(xp, p, state.jaw_m)
    return xp.where(xp.logical_or(p.bonded > 0.0, strain > 0.0), value, xp.zeros_like(value))


def stiffness(library: Library, parameters: ContactParameters, state: ContactArrays) -> Any:
    """∂F/∂displacement with the node behind the layer at rest, N/m: what a step of 0 s sees; 0 while the jaw is off."""
    xp, p = library.xp, parameters
    strain = state.excess + state.jaw_m / p.depth_m
    growth = xp.where((p.radius_m > 0.0) & (state.jaw_m >= 0.0), 2.0 * np.pi * (p.radius_m - state.jaw_m), 0.0)
    value = p.share * p.modulus_pa * (area(xp, p, state.jaw_m) * p.layers / p.depth_m + strain * growth)
    return xp.where(_touches(xp, p, state), value, xp.zeros_like(value))


def step(
    library: Library, parameters: ContactParameters, state: ContactArrays, dt_s: Any, displacement_m: Any
) -> tuple[ContactArrays, Any]:
    """Moves jaws to their displacements within a time step; returns state and force.

    A step that `accepts` denies leaves the state as it is; its force is that of the state.
    """
    xp, p = library.xp, parameters
    shape = xp.broadcast_shapes(*(xp.shape(value) for value in (*p, *state, dt_s, displacement_m)))
    state = ContactArrays(*(xp.broadcast_to(value, shape) for value in state))
    good = accepts(library, p, dt_s, displacement_m)
    dt = xp.where(good, dt_s, xp.zeros_like(state.jaw_m))
    # A product with NaN has derivatives of NaN, also where another is chosen.
    to = xp.where(good, p.share * xp.where(good, displacement_m, 0.0), state.jaw_m)
    touching = _touches(xp, p, state)
    pressed, free = _pressed(xp, p, state, dt, to), _free(xp, p, state, dt, to)
    leaves = touching & xp.logical_not(_touches(xp, p, pressed))
    meets = xp.logical_not(touching) & (free.behind_m <= free.jaw_m)
    same = chosen(xp, touching, pressed, free)

    def crossing() -> ContactArrays:
        share = _crossing(library, same.jaw_m, p, state, dt, to, touching)
        at, after = state.jaw_m + share * (to - state.jaw_m), (1.0 - share) * dt
        leaving = _pressed(xp, p, state, share * dt, at)
        surface = leaving._replace(behind_m=xp.maximum(leaving.jaw_m, leaving.behind_m))
        left = _free(xp, p, surface, after, to)
        meeting = _free(xp, p, state, share * dt, at)
        met = _pressed(xp, p, state_of(p, meeting.behind_m, meeting.behind_m), after, to)
        return chosen(xp, leaves, left, chosen(xp, meets, met, same))

    moved = library.branch(xp.any(leaves | meets), crossing, lambda: same)
    moved = chosen(xp, good, moved, state)
    return moved, force(library, p, moved)


def numpy_step(parameters: ContactParameters, state: ContactArrays, dt_s: Any, displacement_m: Any) -> tuple[ContactArrays, Any]:
    """`step` with NumPy, without its warning where a hold is longer than any number of relaxation times."""
    with np.errstate(over="ignore"):
        return step(NUMPY, parameters, state, dt_s, displacement_m)


def chosen(xp: Any, which: Any, one: ContactArrays, other: ContactArrays) -> ContactArrays:
    return ContactArrays(*(xp.where(which, a, b) for a, b in zip(one, other, strict=True)))


def _touches(xp: Any, p: ContactParameters, state: ContactArrays) -> Any:
    return xp.logical_or(p.bonded > 0.0, state.jaw_m >= state.behind_m)


def area(xp: Any, p: ContactParameters, u: Any) -> Any:
    inside = xp.maximum(u, 0.0)
    return xp.where(p.radius_m > 0.0, np.pi * inside * (2.0 * p.radius_m - inside), p.area_m2)


def _crossing(library: Library, like: Any, *arguments: Any) -> Any:
    """Where in 0…1 of the step the jaw leaves or meets the body."""
    xp, fixed = library.xp, library.constant(arguments)

    def halved(bracket: tuple[Any, Any]) -> tuple[Any, Any]:
        above, below = bracket
        middle = 0.5 * (above + below)
        is_apart = _apart(xp, middle, *fixed) > 0.0
        return xp.where(is_apart, middle, above), xp.where(is_apart, below, middle)

    above, _ = library.repeat(BISECTIONS, halved, (xp.zeros_like(like), xp.ones_like(like)))
    return library.root(lambda share, *arguments: _apart(xp, share, *arguments), above, arguments)


def _apart(xp: Any, share: Any, p: ContactParameters, state: ContactArrays, dt: Any, to: Any, touching: Any) -> Any:
    """Above zero while a jaw that touches still does, and while one that is off still is."""
    at = state.jaw_m + share * (to - state.jaw_m)
    pressed, free = _pressed(xp, p, state, share * dt, at), _free(xp, p, state, share * dt, at)
    # The strain rather than jaw − behind, of which single precision has fewer digits.
    strained = p.depth_m / p.layers * (pressed.excess + at / p.depth_m)
    return xp.where(touching, strained, free.behind_m - free.jaw_m)


def _pressed(xp: Any, p: ContactParameters, state: ContactArrays, dt: Any, to: Any) -> ContactArrays:
    """In contact all along."""
    kick = 0.5 * (to - state.jaw_m) * (p.layers - 1.0) / p.depth_m
    excess = relaxed(xp, p, state.excess + kick, dt) + kick
    return ContactArrays(to, to - p.depth_m / p.layers * (excess + to / p.depth_m), excess)


def _free(xp: Any, p: ContactParameters, state: ContactArrays, dt: Any, to: Any) -> ContactArrays:
    """The surface on its own: the law itself in a time that is slower by the number of layers."""
    left = relaxed(xp, p, state.behind_m / p.depth_m, dt / p.layers)
    return state_of(p, to, p.depth_m * left)


def relaxed(xp: Any, p: ContactParameters, excess: Any, elapsed: Any) -> Any:
    """Excess strain after some time at constant equilibrium strain: x₀ [1 + (n − 1) λ t]^(−1/(n − 1)) with λ = v |x₀|ⁿ⁻¹.

    The branches of ``where`` that are not taken have finite derivatives, too.
    """
    over = p.exponent - 1.0
    is_zero = excess == 0.0
    scaled = p.rate_coefficient_per_s * xp.where(is_zero, 1.0, xp.abs(excess)) ** over * elapsed
    scaled = xp.where(is_zero & (over != 0.0), xp.zeros_like(scaled), scaled)
    scaled = xp.minimum(scaled, xp.finfo(scaled.dtype).max)
    z = over * scaled
    # Near n = 1 and for short times ln(1 + z)/(n − 1) by its series: smooth in n.
    # Below n = 1 what is little is gone at once, so a body at rest stays there and has no derivative.
    small, ended = xp.abs(z) < 1e-4, (z <= -1.0) | (is_zero & (over < 0.0) & (elapsed > 0.0))
    little = xp.where(small, z, 0.0)
    series = xp.where(small, scaled, 0.0) * (1.0 - little * (1.0 / 2.0 - little * (1.0 / 3.0 - little * (1.0 / 4.0))))
    inside = small | ended
    logarithm = xp.log1p(xp.where(inside, 1.0, z)) / xp.where(inside, 1.0, over)
    left = xp.exp(-xp.where(small, series, logarithm))
    return excess * xp.where(ended, xp.zeros_like(left), left)
