"""The step of a contact by a force over arrays; see `_twin_step`.

The formula is that of ``step_force`` in ``crates/palpate/src/simulate/step.rs``: while the force stands, the excess strain obeys the law in
a time of its own that goes K times as fast, with K between 1/m and 1; a mean of K at both ends of the step makes it of second order.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from palpate._twin_step import ContactArrays, ContactParameters, Library, area, chosen, force, relaxed

#: Steps of Newton's method in a bracket; a dozen suffice but for the smallest forces.
NEWTON_STEPS = 60


def step_force(
    library: Library, parameters: ContactParameters, state: ContactArrays, dt_s: Any, force_n: Any
) -> tuple[ContactArrays, Any]:
    """Applies forces (N) within a time step (s); returns state and displacements of the jaws (m).

    A step that cannot be made leaves the state as it is.
    """
    xp, p = library.xp, parameters
    shape = xp.broadcast_shapes(*(xp.shape(value) for value in (*p, *state, dt_s, force_n)))
    state = ContactArrays(*(xp.broadcast_to(value, shape) for value in state))
    is_strip = xp.logical_and(p.bonded > 0.0, xp.logical_not(p.radius_m > 0.0))
    sound = xp.isfinite(dt_s) & (dt_s >= 0.0) & xp.isfinite(force_n) & xp.logical_or(force_n >= 0.0, is_strip)
    dt = xp.where(sound, dt_s, xp.zeros_like(state.jaw_m))
    to = xp.where(sound, force_n, xp.zeros_like(state.jaw_m))
    thickness = p.depth_m / p.layers
    before = xp.maximum(force(library, p, state), 0.0)
    halfway = 0.5 * (before + xp.maximum(to, 0.0)) + 0.5 * xp.minimum(to, 0.0)
    u, first_fits = _carried(library, p, halfway, -state.behind_m / thickness, 1.0 / thickness)
    excess = (u - state.behind_m) / thickness - u / p.depth_m
    first = _pace(xp, p, u, excess)
    guess = relaxed(xp, p, excess, first * dt)
    u, second_fits = _carried(library, p, halfway, guess, 1.0 / p.depth_m)
    after = relaxed(xp, p, excess, 0.5 * (first + _pace(xp, p, u, guess)) * dt)
    u, third_fits = _carried(library, p, halfway, after, 1.0 / p.depth_m)
    behind = u - thickness * (after + u / p.depth_m)
    jaw, last_fits = _carried(library, p, to, -behind / thickness, 1.0 / thickness)
    good = sound & first_fits & second_fits & third_fits & last_fits
    moved = chosen(xp, good, ContactArrays(jaw, behind, (jaw - behind) / thickness - jaw / p.depth_m), state)
    return moved, moved.jaw_m / p.share


def _pace(xp: Any, p: ContactParameters, u: Any, excess: Any) -> Any:
    """K = (S′ε depth + S)/(S′ε depth + m S) with the force per strain S(u) = E A."""
    stiffness = p.modulus_pa * area(xp, p, u)
    growth = xp.where((p.radius_m > 0.0) & (u >= 0.0), 2.0 * np.pi * p.modulus_pa * (p.radius_m - u), 0.0)
    bend = growth * (excess + u / p.depth_m) * p.depth_m
    whole = bend + p.layers * stiffness
    return xp.where(whole > 0.0, (bend + stiffness) / xp.where(whole > 0.0, whole, 1.0), 1.0 / p.layers)


def _carried(library: Library, p: ContactParameters, load: Any, offset: Any, slope: Any) -> tuple[Any, Any]:
    """The contact displacement u (m) at which E A(u) (offset + slope u) is a force (N), and whether the body can take it."""
    xp = library.xp
    like = load + offset * slope
    free = -offset / slope + xp.zeros_like(like)
    is_round, is_bonded = p.radius_m > 0.0, p.bonded > 0.0
    # Of a body of constant section the force is linear in u.
    linear = (load / (p.modulus_pa * xp.where(is_round, 1.0, p.area_m2)) - offset) / slope
    low, high = xp.maximum(free, 0.0), p.depth_m + xp.zeros_like(like)

    def off(u: Any, p: ContactParameters, load: Any, offset: Any, slope: Any) -> Any:
        return p.modulus_pa * area(xp, p, u) * (offset + slope * u) - load

    fixed = library.constant((p, load, offset, slope))

    def newton(bracket: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
        u, low, high = bracket
        p, _, offset, slope = fixed
        value = off(u, *fixed)
        growth = 2.0 * np.pi * p.modulus_pa * (p.radius_m - u)
        rise = growth * (offset + slope * u) + p.modulus_pa * area(xp, p, u) * slope
        high, low = xp.where(value > 0.0, u, high), xp.where(value > 0.0, low, u)
        by_newton = u - value / xp.where(rise == 0.0, 1.0, rise)
        inside = (by_newton > low) & (by_newton < high)
        return xp.where(inside, by_newton, 0.5 * (low + high)), low, high

    start = library.constant((0.5 * (low + high), low, high))
    found, _, _ = library.repeat(NEWTON_STEPS, newton, start)
    u = xp.where(is_round, library.root(off, found, (p, load, offset, slope)), linear)
    u = xp.where(load == 0.0, free, u)
    is_strip = xp.logical_and(is_bonded, xp.logical_not(is_round))
    fits = xp.logical_or(is_strip, u < p.depth_m) & xp.logical_not(xp.logical_and(is_round, is_bonded) & (u < 0.0))
    too_much = xp.logical_and(is_round, (off(high, p, load, offset, slope) <= 0.0) & (load != 0.0))
    return u, fits & xp.logical_not(too_much)
