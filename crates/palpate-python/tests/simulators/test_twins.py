"""The step of a contact in other frameworks against that of Rust.

What needs JAX, Warp or Drake is skipped where they are not installed; validation/simulators/twins.py needs all of them.
"""

from __future__ import annotations

import importlib.util
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest
from palpate import _twin_force, _twin_step
from palpate._twin_parameters import contact_numbers
from palpate._twin_step import NUMPY

BALL = {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}
LATENCY = {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"}
MODEL = {"specimen": BALL, "law": LATENCY}


@pytest.fixture(scope="module")
def programs() -> Iterator[Any]:
    """The motions of the validation."""
    folder = Path(__file__).parents[4] / "validation/simulators"
    spec = importlib.util.spec_from_file_location("_programs", folder / "_programs.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["_programs"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["_programs"]


@pytest.fixture(scope="module")
def stored(programs: Any) -> Any:
    """A short motion of every body under every law, and what Rust makes of it."""
    made = programs.reference(seed=3, steps=80)
    assert min(programs.crossings(made)) > 20
    return made


def largest(programs: Any, stored: Any, forces: Any, states: Any) -> float:
    return float(max(max(pair) for pair in programs.differences(stored, forces, states).values()))


def test_the_formula_over_arrays_is_the_step_of_rust(programs: Any, stored: Any) -> None:
    parameters = programs.parameters_of(stored)
    at_rest = np.zeros(len(parameters.depth_m))
    state = _twin_step.state_of(parameters, at_rest, at_rest)
    forces, states = np.empty_like(stored["force_n"]), np.empty_like(stored["state_m"])
    for step, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"], strict=True)):
        state, forces[step] = _twin_step.numpy_step(parameters, state, dt, to)
        states[step] = np.stack([state.jaw_m, state.behind_m], axis=-1)
    assert largest(programs, stored, forces, states) < 1e-12


def test_a_step_by_a_force_is_that_of_rust(programs: Any) -> None:
    described = programs.models()
    parameters = programs.stacked([contact_numbers(one) for one in described])
    dt, loads = programs.load_program(parameters, 60, 5)
    expected, refused = programs.of_rust_loads(described, dt, loads)
    assert 100 < refused < loads.size / 2
    at_rest = np.zeros(len(described))
    state = _twin_step.state_of(parameters, at_rest, at_rest)
    for index, (length, to) in enumerate(zip(dt, loads, strict=True)):
        state, displacements = _twin_force.step_force(NUMPY, parameters, state, length, to)
        found = np.stack([state.jaw_m, state.behind_m], axis=-1)
        assert np.abs(found - expected[index]).max() < 1e-12 * parameters.depth_m.min()
        assert (displacements == state.jaw_m / parameters.share).all()


@pytest.mark.parametrize("contact", [{}, {"separation": False}])
@pytest.mark.parametrize("specimen", [BALL, {"shape": "block", "area": "4 cm^2", "length": "40 mm", "modulus": "1 MPa"}])
def test_a_twin_accepts_what_rust_accepts(specimen: dict[str, Any], contact: dict[str, Any]) -> None:
    model = {"specimen": specimen, "law": LATENCY, "contact": contact}
    parameters = contact_numbers(model)
    start = _twin_step.state_of(parameters, np.float64(0.0), np.float64(0.0))
    far = np.nextafter(parameters.depth_m / parameters.share, 0.0)
    for dt in (0.0, 1e-3, 1e300, -1e-9, math.nan, math.inf):
        for to in (0.0, 1e-3, -1e-3, -1.0, far, parameters.depth_m / parameters.share, 10.0, math.nan, math.inf, -math.inf):
            try:
                force = palpate.ContactState(model).step(dt, to)
            except palpate.ModelError:
                force = None
            step = np.float64(dt), np.float64(to)
            assert bool(_twin_step.accepts(NUMPY, parameters, *step)) is (force is not None), (dt, to)
            state, of_twin = _twin_step.numpy_step(parameters, start, *step)
            assert of_twin == pytest.approx(force or 0.0, rel=1e-12, abs=1e-15)
            assert force is not None or (state.jaw_m == 0.0 and state.behind_m == 0.0)


def test_the_stiffness_is_the_slope_of_a_step_of_no_time() -> None:
    parameters = contact_numbers(MODEL)
    state = _twin_step.state_of(parameters, np.float64(0.0), np.float64(0.0))
    state, _ = _twin_step.numpy_step(parameters, state, 0.3, np.float64(5e-3))
    ends = [_twin_step.numpy_step(parameters, state, 0.0, np.float64(5e-3 + h))[1] for h in (-1e-7, 1e-7)]
    assert _twin_step.stiffness(NUMPY, parameters, state) == pytest.approx((ends[1] - ends[0]) / 2e-7, rel=1e-7)
    off, _ = _twin_step.numpy_step(parameters, state, 1e-3, np.float64(-1e-3))
    assert _twin_step.stiffness(NUMPY, parameters, off) == 0.0


def test_every_body_has_its_depth_and_section() -> None:
    number = {"radius": "1.1 m", "thickness": "0.7 m", "width": "1.3 m", "diameter": "1.7 m", "length": "2.3 m", "area": "3.1 m^2"}
    area = {"strip": 1.3 * 0.7, "cylinder": math.pi / 4 * 1.7**2, "block": 3.1}
    for shape, keys in {
        "ball": ["radius"],
        "pad": ["radius", "thickness"],
        "strip": ["width", "thickness", "length"],
        "cylinder": ["diameter", "length"],
        "block": ["area", "length"],
    }.items():
        specimen = {"shape": shape, "modulus": "28 kPa", **{key: number[key] for key in keys}}
        found = contact_numbers({"specimen": specimen, "law": LATENCY, "contact": {"squeezed_from": "one side", "layers": 2.5}})
        depth = {"ball": 1.1, "pad": 0.7}.get(shape, 2.3)
        assert (found.depth_m, found.layers, found.share, found.bonded) == (depth, 2.5, 1.0, 0.0)
        assert found.radius_m == (1.1 if shape in ("ball", "pad") else 0.0)
        assert found.area_m2 == pytest.approx(area.get(shape, 0.0), rel=1e-15)
        # Squeezed from two sides, one half of it.
        both = contact_numbers({"specimen": specimen, "law": LATENCY, "contact": {"squeezed_from": "two sides", "layer_thickness": "0.1 m"}})
        half = depth if shape in ("ball", "pad") else depth / 2
        assert (both.depth_m, both.share) == (half, 0.5) and both.layers == pytest.approx(half / 0.1, rel=1e-15)


def test_files_and_materials_are_contacts_too(root: Path) -> None:
    path = root / "examples/records/ball-material.toml"
    numbers = contact_numbers(path)
    assert numbers == contact_numbers(palpate.Material.read(path)) == contact_numbers({"material": str(path), "step": []})
    parameters = palpate.Material.read(path).parameters
    assert numbers.modulus_pa == parameters["modulus_pa"] and numbers.exponent == parameters["exponent"]
    assert contact_numbers(root / "examples/protocols/paper-a.toml").bonded == 1.0


def test_what_has_no_twin_is_refused() -> None:
    tip = {"shape": "spherical tip", "radius": "5 um", "modulus": "1 kPa", "poisson_ratio": 0.5}
    hertz = {**BALL, "equilibrium": "hertz", "poisson_ratio": 0.5}
    table = {"shape": "ball", "radius": "35 mm", "equilibrium_forces": [["0 mm", "0 N"], ["5 mm", "1 N"], ["10 mm", "4 N"]]}
    linear = {"name": "standard-linear-solid", "overshoot": 1.0, "time": "2 s"}
    for specimen, law, message in (
        (tip, LATENCY, "expected a body that a twin has, ball, pad"),
        (hertz, LATENCY, "specimen: expected the force of uniform strain"),
        (table, LATENCY, "specimen: expected the force of uniform strain"),
        (BALL, linear, "latency law alone"),
        (BALL, {**LATENCY, "unloading_factor": 2.0}, "one rate coefficient"),
    ):
        with pytest.raises(palpate.ModelError, match=message):
            contact_numbers({"specimen": specimen, "law": law})
    with pytest.raises(palpate.OptionError, match="radius"):
        contact_numbers({"specimen": {"shape": "ball", "modulus": "28 kPa"}, "law": LATENCY})


def test_jax_takes_the_step(programs: Any, stored: Any) -> None:
    jax = pytest.importorskip("jax", reason="jax is not installed")
    jax.config.update("jax_enable_x64", True)
    from palpate import jax as twin

    parameters = twin.contact_parameters(programs.parameters_of(stored), "float64")
    state, step = twin.contact_state(parameters), jax.jit(twin.contact_step)
    forces, states = np.empty_like(stored["force_n"]), np.empty_like(stored["state_m"])
    for index, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"], strict=True)):
        state, forces[index] = step(parameters, state, dt, to)
        states[index] = np.stack([state.jaw_m, state.behind_m], axis=-1)
    assert largest(programs, stored, forces, states) < 1e-12


def test_warp_takes_the_step(programs: Any, stored: Any) -> None:
    wp = pytest.importorskip("warp", reason="warp-lang is not installed")
    from palpate import warp as twin

    parameters = programs.parameters_of(stored)
    contacts = twin.Contacts(parameters, len(parameters.depth_m), device="cpu")
    forces, states = np.empty_like(stored["force_n"]), np.empty_like(stored["state_m"])
    for index, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"], strict=True)):
        forces[index] = contacts.step(dt, wp.array(to, dtype=wp.float64, device="cpu")).numpy()
        states[index] = contacts.state.numpy()[:, :2]
    assert largest(programs, stored, forces, states) < 1e-12
    contacts.step(1e-3, wp.array(np.full(len(contacts), np.nan), dtype=wp.float64, device="cpu"))
    assert (contacts.force_n.numpy() == forces[-1]).all() and (contacts.refused.numpy() == 1).all()


def test_drake_takes_the_step() -> None:
    pytest.importorskip("pydrake", reason="drake is not installed")
    from palpate import drake as twin

    from pydrake.systems.analysis import Simulator  # pyright: ignore[reportMissingImports]

    contact, rust = twin.ContactSystem(MODEL, 1e-3), palpate.ContactState(MODEL)
    simulator = Simulator(contact)
    context = simulator.get_mutable_context()
    port: Any = contact.GetOutputPort("force_n")
    contact.GetInputPort("displacement_m").FixValue(context, [0.0])
    for step, to in enumerate((0.0, 1e-3, 3e-3, 1e-3, -1e-3, 2e-3)):
        simulator.AdvanceTo(1e-3 * step)
        contact.GetInputPort("displacement_m").FixValue(context, [to])
        force = rust.step(1e-3 if step else 0.0, to)
        assert port.Eval(context)[0] == pytest.approx(force, rel=1e-11, abs=1e-12)
    simulator.AdvanceTo(6e-3)
    contact.GetInputPort("displacement_m").FixValue(context, [math.nan])
    with pytest.warns(palpate.PalpateWarning, match="expected a displacement within the body"):
        assert port.Eval(context)[0] == pytest.approx(rust.force_n, rel=1e-11)
