"""Protocols as typed data: bodies, laws and steps, whose keywords editors know.

Every quantity is a number in SI, a text with a unit, or a quantity of pint. Each of these is a mapping with the keys of a protocol's file,
and stands wherever a mapping does; what is left out is not there.

>>> import palpate
>>> from palpate import Law, Protocol, Specimen, Step
>>> protocol = Protocol(
...     specimen=Specimen("ball", radius=0.035, modulus="28 kPa"),
...     law=Law("latency", exponent=5, rate_coefficient=2e4),
...     step=[Step(to=0.005, rate="500 mm/min", hold=10)],
... )
>>> dict(protocol.step[0])
{'to_m': 0.005, 'rate': '500 mm/min', 'hold_s': 10}
>>> round(float(palpate.simulate(protocol).force_n[-1]), 2)
1.56
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from numbers import Real
from typing import Any, Literal, TypeAlias, Union

from palpate import _units
from palpate._palpate import Material, OptionError

__all__ = ["Law", "Protocol", "Specimen", "Step"]

#: A number in SI, a text with a unit, or a quantity of pint.
Quantity: TypeAlias = Union[float, str, Any]
Shape: TypeAlias = Literal[
    "ball",
    "pad",
    "strip",
    "dumbbell",
    "cylinder",
    "cone and plate",
    "block",
    "profile",
    "spherical tip",
    "conical tip",
    "pyramidal tip",
    "flat punch",
    "none",
]
Rows: TypeAlias = Sequence[tuple[Quantity, Quantity]]


def _in(*units: str) -> Any:
    """A field that is a quantity in this unit, or rows of one in each; it may be left out."""
    return field(default=None, metadata={"units": units})


class _Table(Mapping[str, Any]):
    """A table of a protocol, by the names of its fields; numbers stand under keys that state the unit."""

    def _entries(self) -> dict[str, Any]:
        made: dict[str, Any] = {}
        for one in fields(self):  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
            value, units = getattr(self, one.name), one.metadata.get("units", ())
            if value is None:
                continue
            if len(units) > 1:
                made[one.name] = [[_stated(cell, unit) for cell, unit in zip(row, units, strict=True)] for row in value]
            elif units and _is_number(value):
                end = next((end for end, unit in _units.ENDINGS.items() if unit == units[0]), "")
                # Angles have no key that states their unit.
                made[one.name + end] = value if end else _stated(value, units[0])
            else:
                made[one.name] = value
        return made

    def __getitem__(self, key: str) -> Any:
        return self._entries()[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries())

    def __len__(self) -> int:
        return len(self._entries())


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _stated(value: Any, unit: str) -> Any:
    return f"{float(value)!r} {unit}" if _is_number(value) else value


@dataclass(frozen=True)
class Specimen(_Table):
    """The body: its shape with the sizes of that shape, and its stiffness; the keys of ``[specimen]``."""

    shape: Shape
    #: Radius of a ball, a spherical tip or a flat punch; outer radius of a pad, m.
    radius: Quantity = _in("m")
    #: Young's modulus, Pa.
    modulus: Quantity = _in("Pa")
    #: Diameter of a cylinder, or of a cone and plate, m.
    diameter: Quantity = _in("m")
    #: Width of the section of a strip, m.
    width: Quantity = _in("m")
    #: Thickness of a strip, a dumbbell, the soft layer of a pad, or the sample under a tip, m.
    thickness: Quantity = _in("m")
    #: Free length along the force, m.
    length: Quantity = _in("m")
    #: Section of a block, m^2.
    area: Quantity = _in("m^2")
    #: Depth of a profile, m.
    depth: Quantity = _in("m")
    #: Angle between a cone and its plate, rad.
    cone_angle: Quantity = _in("rad")
    #: Half angle of a conical or pyramidal tip, rad.
    half_angle: Quantity = _in("rad")
    #: Widths of a dumbbell: rows of place and width, m.
    widths: Rows | None = _in("m", "m")
    #: Contact area of a profile: rows of displacement, m, and area, m^2.
    areas: Rows | None = _in("m", "m^2")
    #: Measured equilibrium force in place of a modulus: rows of displacement, m, and force, N.
    equilibrium_forces: Rows | None = _in("m", "N")
    equilibrium: Literal["uniform strain", "hertz"] | None = None
    poisson_ratio: float | None = None
    base: Literal["bonded", "sliding"] | None = None


@dataclass(frozen=True)
class Law(_Table):
    """The law of the strain with its parameters; the keys of ``[law]``."""

    name: Literal["latency", "standard-linear-solid", "prony", "fung", "fractional-zener"]
    exponent: float | None = None
    #: Rate coefficient of the latency law, 1/s.
    rate_coefficient: Quantity = _in("/s")
    strain_factor: float | None = None
    unloading_factor: float | None = None
    overshoot: float | None = None
    #: Relaxation time, s.
    time: Quantity = _in("s")
    order: float | None = None
    #: Terms of a Prony series, each with ``overshoot`` and ``time`` or ``time_s``.
    terms: Sequence[Mapping[str, Any]] | None = None
    #: Terms of Fung's function, each with ``share`` and ``rate`` or ``rate_per_s``.
    shares: Sequence[Mapping[str, Any]] | None = None
    memory: Literal["strain", "force"] | None = None


@dataclass(frozen=True, kw_only=True)
class Step(_Table):
    """A move of the jaw to a displacement or a force, and a hold; either may be left out. The keys of ``[[step]]``."""

    #: Displacement since first touch at the end of the move, m.
    to: Quantity = _in("m")
    #: Speed of the jaw, m/s.
    rate: Quantity = _in("m/s")
    #: Force at the end of the move, N.
    to_force: Quantity = _in("N")
    #: Rate of the force, N/s.
    force_rate: Quantity = _in("N/s")
    #: How long the position is held, s.
    hold: Quantity = _in("s")
    #: How long the force is held, s.
    hold_force: Quantity = _in("s")


@dataclass(frozen=True, kw_only=True)
class Protocol(_Table):
    """A body, its law, and the steps of the jaw; or a material, which is both, in place of the first two."""

    step: Sequence[Step | Mapping[str, Any]]
    specimen: Specimen | Mapping[str, Any] | None = None
    law: Law | Mapping[str, Any] | None = None
    contact: Mapping[str, Any] | None = None
    output: Mapping[str, Any] | None = None
    material: Material | str | None = None
    #: Values by the path of the parameter that they replace, for `palpate.sweep`.
    sweep: Mapping[str, Any] | None = None
    title: str | None = None

    def __post_init__(self) -> None:
        if isinstance(self.step, (str, Mapping)) or not isinstance(self.step, Sequence):
            raise OptionError(f"step: expected a list of steps, found {type(self.step).__name__}\nhint: put it into a list")
