"""Random motions of many contacts and what `palpate.ContactState` makes of them, for the twins of its step.

Bodies, steps and displacements are numbers that single precision has exactly, so that twins in single precision take the same ones.
"""

import pathlib
import struct
import sys
import types

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "crates/palpate-python/python/palpate"

#: Shape, sizes in SI, layers, sides.
BODIES = [
    ("ball", {"radius_m": 0.035}, 8.0, "two sides"),
    ("pad", {"radius_m": 0.02, "thickness_m": 0.005}, 4.0, "one side"),
    ("block", {"area_m2": 4e-4, "length_m": 0.04}, 6.5, "one side"),
    ("strip", {"width_m": 0.01, "thickness_m": 0.002, "length_m": 0.08}, 8.0, "two sides"),
]
#: Exponent, and rate coefficient in 1/s: excess strains of some percent fall within about a second.
LAWS = [(5.0, 2e4), (3.0, 200.0), (1.0, 0.7), (1.75, 9.0), (0.625, 0.3)]


def single(value):
    """The nearest number that single precision has."""
    return float(np.float32(value))


def models():
    """Descriptions: every body, bonded and not, under every law."""
    made = []
    for shape, sizes, layers, sides in BODIES:
        for separation in (True, False):
            for exponent, rate in LAWS:
                made.append(
                    {
                        "specimen": {
                            "shape": shape,
                            "modulus_pa": 28e3,
                            **{key: single(size) for key, size in sizes.items()},
                        },
                        "law": {"name": "latency", "exponent": exponent, "rate_coefficient_per_s": single(rate)},
                        "contact": {"layers": layers, "squeezed_from": sides, "separation": separation},
                    }
                )
    return made


def program(parameters, steps, seed):
    """Lengths of steps, s, and displacements of every contact, m: ramps, holds, retreats beyond the surface, returns and jumps.

    `parameters` are arrays over contacts.
    """
    rng = np.random.default_rng(seed)
    contacts = len(parameters.depth_m)
    is_strip = (parameters.bonded > 0) & (parameters.radius_m == 0)
    low = np.where(is_strip, -1.5, np.where(parameters.bonded > 0, 0.0, -0.15))
    reach = parameters.depth_m / parameters.share
    dt = np.exp(rng.uniform(np.log(1e-4), np.log(0.3), steps))
    at, to, left = np.zeros(contacts), np.zeros(contacts), np.zeros(contacts, dtype=int)
    displacements = np.empty((steps, contacts))
    for step in range(steps):
        fresh = left == 0
        kind = rng.uniform(size=contacts)
        goal = np.where(kind < 0.3, to, rng.uniform(low, 0.6, contacts))
        # Some motions are to where the jaw leaves, by little.
        goal = np.where((kind > 0.9) & (low < 0), rng.uniform(-0.02, 0.05, contacts), goal)
        to = np.where(fresh, goal, to)
        left = np.where(fresh, rng.integers(1, 12, contacts), left)
        at, left = at + (to - at) / left, left - 1
        displacements[step] = at * reach
    return single_array(dt), single_array(displacements)


def single_array(values):
    return np.asarray(values, dtype=np.float32).astype(np.float64)


def stacked(numbers):
    """Parameters of many contacts, each an array over them."""
    return type(numbers[0])(*(np.array(values) for values in zip(*numbers)))


def load_program(parameters, steps, seed):
    """Lengths of steps, s, and forces on every contact, N: of either sign, none, and some that no displacement carries."""
    rng = np.random.default_rng(seed)
    shape = steps, len(parameters.depth_m)
    section = np.where(parameters.radius_m > 0, 0.3 * np.pi * parameters.radius_m**2, parameters.area_m2)
    loads = parameters.modulus_pa * section * rng.uniform(-0.1, 0.5, shape) * (rng.uniform(size=shape) < 0.8)
    loads[9::10] *= 20
    return np.exp(rng.uniform(np.log(1e-4), np.log(0.3), steps)), loads


def state_of(contact):
    """Share of the displacement of the jaw and displacement of the node behind the layer, m, of a `palpate.ContactState`."""
    return struct.unpack("<8xdd", contact.__reduce__()[1][1])


def of_rust(descriptions, dt, displacements):
    """Forces, N, and states (jaw, behind), m, of `palpate.ContactState` after every step."""
    import palpate

    contacts = [palpate.ContactState(description) for description in descriptions]
    forces, states = np.empty_like(displacements), np.empty((*displacements.shape, 2))
    for step, (length, to) in enumerate(zip(dt, displacements)):
        for index, contact in enumerate(contacts):
            forces[step, index] = contact.step(length, to[index])
            states[step, index] = state_of(contact)
    return forces, states


def of_rust_loads(descriptions, dt, loads):
    """States (jaw, behind), m, after every step by a force, and how many steps were refused."""
    import palpate

    contacts = [palpate.ContactState(description) for description in descriptions]
    states, refused = np.empty((*loads.shape, 2)), 0
    for step, (length, to) in enumerate(zip(dt, loads)):
        for index, contact in enumerate(contacts):
            try:
                contact.step_force(length, to[index])
            except palpate.ModelError:
                refused += 1
            states[step, index] = state_of(contact)
    return states, refused


def reference(seed=1, steps=200):
    """Parameters, program and answers: a mapping of arrays."""
    from palpate._twin_parameters import contact_numbers

    described = models()
    parameters = stacked([contact_numbers(one) for one in described])
    dt, displacements = program(parameters, steps, seed)
    forces, states = of_rust(described, dt, displacements)
    return {
        **{f"parameters_{name}": values for name, values in parameters._asdict().items()},
        "dt_s": dt,
        "displacement_m": displacements,
        "force_n": forces,
        "state_m": states,
    }


def without_wheel():
    """Makes the twins importable without the compiled part of palpate, where that is not installed."""
    try:
        import palpate  # noqa: F401
    except ImportError:
        package = types.ModuleType("palpate")
        package.__path__ = [str(PACKAGE)]
        sys.modules["palpate"] = package


def parameters_of(stored):
    """The parameters in a mapping of `reference`."""
    from palpate._twin_step import ContactParameters

    return ContactParameters(*(stored[f"parameters_{name}"] for name in ContactParameters._fields))


def differences(stored, forces, states):
    """Largest differences of a twin from Rust by body: of the node behind the layer over the depth, and of the force over its peak."""
    parameters = parameters_of(stored)
    of_node = np.abs(states[..., 1] - stored["state_m"][..., 1]) / parameters.depth_m
    of_force = np.abs(forces - stored["force_n"]) / np.abs(stored["force_n"]).max(axis=0)
    by_body = {}
    for index, description in enumerate(models()):
        key = f"{description['specimen']['shape']}, {'unilateral' if description['contact']['separation'] else 'bonded'}"
        worst = by_body.get(key, (0.0, 0.0))
        by_body[key] = (max(worst[0], of_node[:, index].max()), max(worst[1], of_force[:, index].max()))
    return by_body


def crossings(stored):
    """How many times a jaw left its body, and met it."""
    touching = stored["state_m"][..., 0] >= stored["state_m"][..., 1]
    unilateral = stored["parameters_bonded"] == 0
    before, after = touching[:-1, unilateral], touching[1:, unilateral]
    return int((before & ~after).sum()), int((~before & after).sum())
