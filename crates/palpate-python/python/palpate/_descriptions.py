"""Descriptions of tests, bodies and protocols, as Python states them: paths, mappings, and materials."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

from palpate import _units
from palpate._palpate import Material, OptionError, Record, Trajectory, mapping_text
from palpate.protocols import Step

Description = Union[str, os.PathLike[str], Mapping[str, Any], Material, None]


def described(test: Description) -> tuple[str | os.PathLike[str] | None, str | None]:
    """A description as a path or as the text of one; a mapping has the tables of the file."""
    if isinstance(test, Mapping) and not hasattr(test, "data_vars"):
        return None, toml(test)
    if isinstance(test, Trajectory):
        raise OptionError("expected a protocol or its path, found a Trajectory\nhint: pass the protocol that it was simulated from")
    if isinstance(test, (list, tuple)):
        hint = 'steps alone have no body: {"specimen": {...}, "law": {...}, "step": [...]}, or material.predict(steps)'
        raise OptionError(f"expected a description or its path, found a {type(test).__name__}\nhint: {hint}")
    if isinstance(test, Material):
        return None, test.to_toml()
    if test is not None and not isinstance(test, (str, bytes, os.PathLike)):
        hint = "a mapping has the tables of the file"
        if isinstance(test, Record) or any(hasattr(type(test), name) for name in ("columns", "data_vars", "__array__", "__arrow_c_stream__")):
            hint = "a measured motion drives a body: simulate(protocol, drive=palpate.Record.from_arrays(table))"
        raise OptionError(f"expected a description or its path, found a {type(test).__name__}\nhint: {hint}")
    return test, None


def driven(protocol: Any) -> tuple[str | os.PathLike[str] | None, str | None]:
    """A protocol of a body that is known, which may be its steps alone."""
    if isinstance(protocol, (list, tuple)):
        return described({"step": protocol})
    if isinstance(protocol, Mapping) and "step" not in protocol and any(_is_of_step(str(key)) for key in protocol):
        raise OptionError("expected a protocol or a list of steps, found one step\nhint: put it into a list")
    return described(protocol)


def _is_of_step(key: str) -> bool:
    return key.removesuffix(_units.ending(key)) in Step.__dataclass_fields__


def _with_body(table: Mapping[str, Any]) -> Mapping[str, Any]:
    """A protocol whose ``material`` is one in memory, with the tables of that body."""
    material = table.get("material")
    if not isinstance(material, Material):
        return table
    import tomllib

    tables = ("specimen", "law", "contact")
    for name in tables:
        if name in table:
            raise OptionError(f"{name}: expected either this or material, found both\nhint: remove {name} or material")
    body = tomllib.loads(material.to_toml())
    return {**{name: table[name] for name in table if name != "material"}, **{name: body[name] for name in tables}}


def toml(table: Mapping[str, Any]) -> str:
    """A mapping as the text of a description."""
    return mapping_text(_with_body(table))
