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
    """The body: its shape with the sizes of that shape, and its stiffness; the keys of ``[specimen]``.

    Lengths, areas and the modulus are above 0. A shape takes its own sizes alone.

    Parameters
    ----------
    shape : str
        "ball", "pad", "strip", "dumbbell", "cylinder", "cone and plate", "block", "profile", a tip on a flat sample ("spherical tip",
        "conical tip", "pyramidal tip", "flat punch"), or "none".
    radius : quantity
        Radius of a ball, a spherical tip or a flat punch; outer radius of a pad, m.
    modulus : quantity
        Young's modulus, Pa.
    diameter : quantity
        Diameter of a cylinder, or of a cone and plate, m.
    width : quantity
        Width of the section of a strip, m.
    thickness : quantity
        Thickness of a strip, a dumbbell, the soft layer of a pad, or the sample under a tip, m.
    length : quantity
        Free length along the force of a strip, a cylinder or a block, m.
    area : quantity
        Section of a block, m^2.
    depth : quantity
        Depth of a profile, m.
    cone_angle : quantity
        Angle between a cone and its plate, rad; above 0 and below pi/4.
    half_angle : quantity
        Half angle of a conical or pyramidal tip, rad; above 0 and below pi/2.
    widths : rows
        Widths of a dumbbell: rows of place, m, rising, and width, m.
    areas : rows
        Contact area of a profile: rows of displacement, m, rising, and area, m^2.
    equilibrium_forces : rows
        Measured equilibrium force in place of a modulus: rows of displacement, m, rising, and force, N.
    equilibrium : str
        Law of the force once relaxation is over: "uniform strain" (if left out) or "hertz".
    poisson_ratio : float
        Poisson's ratio of "hertz" and of tips, from 0 to 0.5; 0.5 is incompressible.
    base : str
        How a sample lies on what is below it, under a tip: "bonded" (if left out) or "sliding".
    """

    shape: Shape
    radius: Quantity = _in("m")
    modulus: Quantity = _in("Pa")
    diameter: Quantity = _in("m")
    width: Quantity = _in("m")
    thickness: Quantity = _in("m")
    length: Quantity = _in("m")
    area: Quantity = _in("m^2")
    depth: Quantity = _in("m")
    cone_angle: Quantity = _in("rad")
    half_angle: Quantity = _in("rad")
    widths: Rows | None = _in("m", "m")
    areas: Rows | None = _in("m", "m^2")
    equilibrium_forces: Rows | None = _in("m", "N")
    equilibrium: Literal["uniform strain", "hertz"] | None = None
    poisson_ratio: float | None = None
    base: Literal["bonded", "sliding"] | None = None


@dataclass(frozen=True)
class Law(_Table):
    """The law of the strain with its parameters; the keys of ``[law]``. All numbers are above 0.

    Parameters
    ----------
    name : str
        "latency" (takes `exponent`, `rate_coefficient` and one of the factors), "standard-linear-solid" (`overshoot`, `time`), "prony"
        (`terms`), "fung" (`shares`) or "fractional-zener" (`overshoot`, `time`, `order`).
    exponent : float
        Exponent n of the latency law, strain rate = -v (e - e_e)^n; 1 is an exponential.
    rate_coefficient : quantity
        Rate coefficient v of the latency law, 1/s.
    strain_factor : float
        Factor of v for every 0.1 of equilibrium strain; 1 if left out.
    unloading_factor : float
        Factor of v while the strain rises to its equilibrium, after unloading; 1 if left out.
    overshoot : float
        Force at the start of a hold over that at its end, less 1.
    time : quantity
        Relaxation time, s.
    order : float
        Order alpha of the power t^alpha, from 0.05 to below 1.
    terms : list
        Terms of a Prony series, each with ``overshoot`` and ``time`` or ``time_s``.
    shares : list
        Terms of Fung's function, each with ``share`` of the force at the start and ``rate`` or ``rate_per_s``; their sum is below 1.
    memory : str
        What a linear law remembers: the "strain", with the contact area at the time, or the "force".
    """

    name: Literal["latency", "standard-linear-solid", "prony", "fung", "fractional-zener"]
    exponent: float | None = None
    rate_coefficient: Quantity = _in("/s")
    strain_factor: float | None = None
    unloading_factor: float | None = None
    overshoot: float | None = None
    time: Quantity = _in("s")
    order: float | None = None
    terms: Sequence[Mapping[str, Any]] | None = None
    shares: Sequence[Mapping[str, Any]] | None = None
    memory: Literal["strain", "force"] | None = None


@dataclass(frozen=True, kw_only=True)
class Step(_Table):
    """A move of the jaw to a displacement or a force, and a hold; either may be left out. The keys of ``[[step]]``.

    A step has `to` with `rate`, or `to_force` with `force_rate`, and one of `hold` and `hold_force`.

    Parameters
    ----------
    to : quantity
        Displacement since first touch at the end of the move, m; below 0 the jaw has left the body.
    rate : quantity
        Speed of the jaw, m/s; above 0 in both directions.
    to_force : quantity
        Force at the end of the move, N.
    force_rate : quantity
        Rate of the force, N/s; above 0 in both directions.
    hold : quantity
        How long the position is held after the move, s; 0 or more.
    hold_force : quantity
        How long the force is held after the move, s; 0 or more.
    """

    to: Quantity = _in("m")
    rate: Quantity = _in("m/s")
    to_force: Quantity = _in("N")
    force_rate: Quantity = _in("N/s")
    hold: Quantity = _in("s")
    hold_force: Quantity = _in("s")


@dataclass(frozen=True, kw_only=True)
class Protocol(_Table):
    """A body, its law, and the steps of the jaw; or a material, which is both, in place of the first two.

    Parameters
    ----------
    step : list
        Moves and holds, in order: a `Step` or a mapping with its keys each, one or more.
    specimen : Specimen or mapping
        The body.
    law : Law or mapping
        The law of its strain.
    contact : mapping
        How the jaw meets the body: ``layers`` or ``layer_thickness``, ``squeezed_from`` and ``separation``.
    output : mapping
        Times of the samples: ``sample_rate`` or ``times``.
    material : Material or str
        A calibrated body, or the path of its file, in place of `specimen`, `law` and `contact`.
    sweep : mapping
        Values by the path of the parameter that they replace, for `palpate.sweep`.
    title : str
        For reports.
    """

    step: Sequence[Step | Mapping[str, Any]]
    specimen: Specimen | Mapping[str, Any] | None = None
    law: Law | Mapping[str, Any] | None = None
    contact: Mapping[str, Any] | None = None
    output: Mapping[str, Any] | None = None
    material: Material | str | None = None
    sweep: Mapping[str, Any] | None = None
    title: str | None = None

    def __post_init__(self) -> None:
        if isinstance(self.step, (str, Mapping)) or not isinstance(self.step, Sequence):
            raise OptionError(f"step: expected a list of steps, found {type(self.step).__name__}\nhint: put it into a list")
