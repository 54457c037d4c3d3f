"""The step of a contact in JAX: `ContactState.step` as a pure function that can be compiled, mapped and differentiated.

>>> import palpate.jax
>>> ball = palpate.jax.contact_parameters({
...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
... })
>>> state = palpate.jax.contact_state(ball)
>>> for k in range(100):
...     state, force_n = palpate.jax.contact_step(ball, state, 1e-3, 5e-5 * (k + 1))
>>> round(float(force_n), 3)
3.886

Everything works on arrays of any shape, too: parameters, states and displacements of many contacts broadcast against each other. That is
faster than ``jax.vmap``, under which every step contains the search for the moment at which a jaw leaves or meets its body.

JAX computes in single precision unless ``jax.config.update("jax_enable_x64", True)`` stands first. In double precision a step is that of
`ContactState` to 1e-12 of depth and peak force, in single precision to 1e-6. In single precision a long hold at short steps stands still
once the excess strain falls by less than half a unit in its last place a step; longer steps are exact in a hold.

Gradients are those of the closed form, and where a jaw leaves or meets its body those of the moment at which it does.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from palpate import _twin_force, _twin_step
from palpate._frameworks import framework
from palpate._twin_step import ContactArrays, ContactParameters, Library

jax = framework("jax", "jax", "palpate.jax")
jnp = framework("jax.numpy", "jax", "palpate.jax")

__all__ = [
    "ContactArrays",
    "ContactParameters",
    "contact_accepts",
    "contact_force",
    "contact_parameters",
    "contact_state",
    "contact_step",
    "contact_step_force",
    "contact_stiffness",
]


def _constant(tree: Any) -> Any:
    return jax.tree.map(jax.lax.stop_gradient, tree)


def _root(function: Callable[..., Any], at: Any, arguments: tuple[Any, ...]) -> Any:
    """A root with the derivatives of the place: of f(s, θ) = 0 follows ds/dθ = −(∂f/∂θ)/(∂f/∂s). Its value stays the same."""
    at, fixed = _constant(at), _constant(arguments)
    slope = jax.jvp(lambda s: function(s, *fixed), (at,), (jnp.ones_like(at),))[1]
    # No slope where nothing crosses, and none that is a number where the law has none at x = 0.
    is_steep = jnp.isfinite(slope) & (jnp.abs(slope) > jnp.finfo(slope.dtype).tiny)
    moved = jnp.where(is_steep, -function(at, *arguments) / jnp.where(is_steep, slope, 1.0), 0.0)
    return at + (moved - jax.lax.stop_gradient(moved))


_JAX = Library(
    xp=jnp,
    branch=lambda which, one, other: jax.lax.cond(which, one, other),
    repeat=lambda count, function, start: jax.lax.fori_loop(0, count, lambda _, value: function(value), start),
    constant=_constant,
    root=_root,
)
# Compiled once for a shape, where a caller compiles nothing.
_stepped: Callable[..., tuple[ContactArrays, Any]] = jax.jit(partial(_twin_step.step, _JAX))
_stepped_by_force: Callable[..., tuple[ContactArrays, Any]] = jax.jit(partial(_twin_force.step_force, _JAX))


def contact_parameters(model: Any, dtype: Any = None) -> ContactParameters:
    """The parameters of a contact as arrays of JAX.

    Parameters
    ----------
    model : path, mapping, Material or ContactParameters
        As for `palpate.ContactState`, of a ball, a pad, a strip, a cylinder or a block with the force of uniform strain and the latency
        law; or parameters, to be converted.
    dtype : dtype, optional
        Their type; that of JAX for floats if left out.

    Returns
    -------
    ContactParameters
        A tree of arrays: `jax.grad` differentiates with respect to it, ``_replace(modulus_pa=...)`` puts arrays over contacts into it.

    Raises
    ------
    OptionError, ModelError
        A description that makes no contact, or one that has no twin.

    Examples
    --------
    >>> import palpate.jax
    >>> pad = {"shape": "pad", "radius": "10 mm", "thickness": "2 mm", "modulus": "100 kPa"}
    >>> law = {"name": "latency", "exponent": 3, "rate_coefficient": "50 /s"}
    >>> float(palpate.jax.contact_parameters({"specimen": pad, "law": law}).exponent)
    3.0
    """
    if not isinstance(model, ContactParameters):
        from palpate._twin_parameters import contact_numbers

        model = contact_numbers(model)
    return ContactParameters(*(jnp.asarray(value, dtype or float) for value in model))


def contact_state(parameters: ContactParameters, jaw_m: Any = 0.0, behind_m: Any = 0.0, shape: tuple[int, ...] = ()) -> ContactArrays:
    """The state of contacts, at first touch and at rest if nothing else is given.

    Parameters
    ----------
    parameters : ContactParameters
        Of one contact or many.
    jaw_m, behind_m : array_like
        One contact's share of the displacement of the jaw, and the displacement of the node behind the contact layer, m: the two numbers
        of a `palpate.ContactState`.
    shape : tuple of int
        Shape of the states of contacts that have the same parameters.

    Examples
    --------
    >>> import palpate.jax
    >>> block = {"shape": "block", "area": "1 cm^2", "length": "10 mm", "modulus": "1 MPa"}
    >>> law = {"name": "latency", "exponent": 1, "rate_coefficient": "1 /s"}
    >>> parameters = palpate.jax.contact_parameters({"specimen": block, "law": law})
    >>> palpate.jax.contact_state(parameters, shape=(4,)).jaw_m.shape
    (4,)
    """
    kind = jnp.result_type(parameters.depth_m)
    shape = jnp.broadcast_shapes(shape, jnp.shape(jaw_m), jnp.shape(behind_m), *(jnp.shape(value) for value in parameters))
    jaw, behind = (jnp.broadcast_to(jnp.asarray(value, kind), shape) for value in (jaw_m, behind_m))
    return _twin_step.state_of(parameters, jaw, behind)


def contact_step(parameters: ContactParameters, state: ContactArrays, dt_s: Any, displacement_m: Any) -> tuple[ContactArrays, Any]:
    """Moves jaws to their displacements within a time step, as `ContactState.step` does.

    Half the drive, the closed form (4), (5) of the law over the step, and the other half (Strang 1968): second order in ``dt_s``, exact
    while a jaw stands still, stable at any step.

    Parameters
    ----------
    parameters, state
        Of one contact or many.
    dt_s : array_like
        Length of the step, s; 0 or more.
    displacement_m : array_like
        Where the jaws stand at its end, m; they go there at constant speed.

    Returns
    -------
    state : ContactArrays
    force_n : array
        Force at the end of the step, N. A step that `contact_accepts` denies leaves the state as it is; its force is that of the state,
        and its gradient with respect to the step is zero.
    """
    kind = jnp.result_type(state.jaw_m)
    return _stepped(parameters, state, jnp.asarray(dt_s, kind), jnp.asarray(displacement_m, kind))


def contact_step_force(parameters: ContactParameters, state: ContactArrays, dt_s: Any, force_n: Any) -> tuple[ContactArrays, Any]:
    """Applies forces within a time step, as `ContactState.step_force` does.

    The layer takes half the change at once, creeps for ``dt_s``, and takes the other half: second order in ``dt_s``, stable at any.

    Parameters
    ----------
    parameters, state
        Of one contact or many.
    dt_s : array_like
        Length of the step, s; 0 or more.
    force_n : array_like
        The force at the end of the step, N; at 0 N the jaw follows the surface.

    Returns
    -------
    state : ContactArrays
    displacement_m : array
        Displacement of the jaw at the end of the step, m. A step that cannot be made, of a force that no displacement carries or that
        pulls where nothing can be pulled, leaves the state as it is.
    """
    kind = jnp.result_type(state.jaw_m)
    return _stepped_by_force(parameters, state, jnp.asarray(dt_s, kind), jnp.asarray(force_n, kind))


def contact_accepts(parameters: ContactParameters, dt_s: Any, displacement_m: Any) -> Any:
    """Whether `contact_step` moves the contact: finite numbers, no step below 0 s, a displacement within the body.

    `palpate.ContactState` raises where this is false.
    """
    kind = jnp.result_type(parameters.depth_m)
    return _twin_step.accepts(_JAX, parameters, jnp.asarray(dt_s, kind), jnp.asarray(displacement_m, kind))


def contact_force(parameters: ContactParameters, state: ContactArrays) -> Any:
    """Contact force F = E ε A(u) of equation (11), N; 0 while the jaw is off."""
    return _twin_step.force(_JAX, parameters, state)


def contact_stiffness(parameters: ContactParameters, state: ContactArrays) -> Any:
    """Slope of the force in the displacement of the jaw with the node behind the layer at rest, N/m; 0 while the jaw is off.

    It is the slope that a step of 0 s sees, and the one that an implicit integrator of the robot needs.
    """
    return _twin_step.stiffness(_JAX, parameters, state)
