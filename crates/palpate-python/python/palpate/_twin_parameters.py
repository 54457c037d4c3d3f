"""The numbers of a description that the twins of the step need, in SI."""

from __future__ import annotations

import math
import re
import tomllib
from typing import Any

from palpate._palpate import ContactState, ModelError, OptionError
from palpate._twin_step import ContactParameters

#: Units of what describes a body and its law, in SI. What is read with them is compared with what Rust reads of the same description.
UNITS = {
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "nm": 1e-9, "in": 0.0254},
    "area": {
        **{f"{unit}{two}": factor for unit, factor in (("m", 1.0), ("cm", 1e-4), ("mm", 1e-6)) for two in ("²", "^2", "2")},
        **{"µm²": 1e-12, "um^2": 1e-12},
    },
    "pressure": {
        **{"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "psi": 4.448_221_615_260_5 / (0.0254 * 0.0254)},
        **{"N/mm²": 1e6, "N/mm^2": 1e6, "N/mm2": 1e6, "N/m^2": 1.0},
    },
    "rate": {**dict.fromkeys(("/s", "1/s", "s^-1", "s⁻¹"), 1.0), **dict.fromkeys(("/min", "1/min"), 1.0 / 60.0)},
}

#: The shapes that a twin has, with the keys of their sizes.
SHAPES = {
    "ball": ("radius",),
    "pad": ("radius", "thickness"),
    "strip": ("width", "thickness", "length"),
    "cylinder": ("diameter", "length"),
    "block": ("area", "length"),
}


def contact_numbers(model: Any) -> ContactParameters:
    """The parameters of a contact as floats.

    Parameters
    ----------
    model : path, mapping or Material
        As for `palpate.ContactState`: a protocol's tables ``specimen``, ``law`` and ``contact``.

    Raises
    ------
    OptionError
        A description that makes no contact; the message names the key.
    ModelError
        A law other than latency with one rate coefficient, or a body other than a ball, a pad, a strip, a cylinder or a block with the
        force of uniform strain.

    Examples
    --------
    >>> ball = contact_numbers({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ... })
    >>> ball.radius_m, ball.modulus_pa, ball.layers, ball.share
    (0.035, 28000.0, 8.0, 0.5)
    """
    described = ContactState(model)
    # A description that needs no file: the one that a pickle has.
    tables = tomllib.loads(described.__reduce__()[1][0])
    body, law, contact = tables["specimen"], tables["law"], tables.get("contact", {})
    shape = body["shape"]
    if shape not in SHAPES:
        raise ModelError(f"specimen.shape: expected a body that a twin has, {', '.join(SHAPES)}, found {shape}")
    for key in ("equilibrium_forces", "poisson_ratio"):
        if key in body:
            raise ModelError(f"specimen.{key}: expected the force of uniform strain, the only one that a twin has, found {key}")
    sizes = {key: _si(body[key], "area" if key == "area" else "length", f"specimen.{key}") for key in SHAPES[shape]}
    modulus = _si(body["modulus"], "pressure", "specimen.modulus")
    rate = _si(law["rate_coefficient"], "rate", "law.rate_coefficient")
    two_sides = contact.get("squeezed_from", "two sides" if shape == "ball" else "one side") == "two sides"
    depth, area = _depth_and_area(shape, sizes, two_sides)
    layers, stated = contact.get("layers", 8), {}
    if "layer_thickness" in contact:
        thickness = _si(contact["layer_thickness"], "length", "contact.layer_thickness")
        layers, stated = depth / thickness, {"layer_thickness_m": thickness}
    bonded = not contact.get("separation", True)
    same = {
        "specimen": {
            "shape": shape,
            "modulus_pa": modulus,
            **{f"{key}{'_m2' if key == 'area' else '_m'}": size for key, size in sizes.items()},
        },
        "law": {"name": "latency", "exponent": law["exponent"], "rate_coefficient_per_s": rate},
        "contact": {
            "squeezed_from": "two sides" if two_sides else "one side",
            "separation": not bonded,
            **(stated or {"layers": layers}),
        },
    }
    if ContactState(same) != described:
        raise ModelError(f"expected numbers in SI that describe the same contact, found {same}")
    return ContactParameters(
        modulus_pa=modulus,
        depth_m=depth,
        layers=float(layers),
        radius_m=sizes.get("radius", 0.0),
        area_m2=area,
        exponent=float(law["exponent"]),
        rate_coefficient_per_s=rate,
        share=0.5 if two_sides else 1.0,
        bonded=float(bonded),
    )


def _depth_and_area(shape: str, sizes: dict[str, float], two_sides: bool) -> tuple[float, float]:
    """Depth, m, and section, m²; 0 of a body whose contact grows."""
    match shape:
        case "ball":
            return sizes["radius"], 0.0
        case "pad":
            return sizes["thickness"], 0.0
        case "strip":
            area = sizes["width"] * sizes["thickness"]
        case "cylinder":
            area = math.pi / 4.0 * sizes["diameter"] ** 2
        case _:
            area = sizes["area"]
    return sizes["length"] / 2.0 if two_sides else sizes["length"], area


def _si(text: str, dimension: str, key: str) -> float:
    """A quantity with its unit as a number in SI, rounded as Rust does: 35 mm is exactly 0.035."""
    found = re.fullmatch(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", text)
    factor = UNITS[dimension].get(found[2].replace("\u03bc", "\u00b5")) if found else None
    if found is None or factor is None:
        raise OptionError(f"{key}: expected a unit of {dimension} ({', '.join(UNITS[dimension])}), found {text!r}")
    value, inverse = float(found[1]), round(1.0 / factor)
    return value / inverse if factor < 1.0 and 1.0 / inverse == factor else value * factor
