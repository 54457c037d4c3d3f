"""Calibrated bodies as cards of other simulators."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from palpate._options import Engine
from palpate._palpate import Material, OptionError, _card


@dataclass(frozen=True)
class Card:
    """A material in the terms of another simulator, fitted to a loading and a hold that the law predicts.

    Made by `export`. Errors are shares of the force at the end of the fastest loading.
    """

    engine: str
    """The simulator."""
    text: str
    """The card: native text of the simulator, which begins with comments on its range and its error."""
    parameters: dict[str, float]
    """The parameters of the simulator by name, in SI."""
    prony: list[tuple[float, float]]
    """Share of the initial force and time constant (s) of every term of a Prony series; none of a contact."""
    peak_force_n: float
    """Force at the end of the fastest loading, N."""
    loading_error: float | None
    """Largest error in loading; None of a Prony series, which is of the hold alone."""
    hold_error: dict[float, float]
    """Error in the hold (card less law) by time, s."""
    extrapolations: list[str]
    """How depth, speed or time go beyond the test of the material, a sentence each."""
    _document: str = field(repr=False)

    def to_json(self) -> str:
        """The document that ``palpate export --format json`` prints."""
        return self._document

    def to_dict(self) -> dict[str, Any]:
        """The same as plain objects."""
        document: dict[str, Any] = json.loads(self._document)
        return document

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the text of the card to a file."""
        Path(path).write_text(self.text, encoding="utf-8", newline="\n")

    def __str__(self) -> str:
        return self.text


def export(
    material: Material | str | os.PathLike[str],
    engine: Engine,
    *,
    depth_m: float | None = None,
    speed_m_per_s: float | None = None,
    slowest_m_per_s: float | None = None,
    hold_s: float = 60.0,
    mass_kg: float | None = None,
    friction: float | None = None,
    poisson_ratio: float | None = None,
    terms_per_decade: float = 2.0,
) -> Card:
    """A material as a card of another simulator: what ``palpate export`` prints.

    Rigid-body engines ("mujoco", "drake", "physx", "isaac", "newton") get a contact without memory, fitted to the loading that the law
    predicts so that its largest error is least. Finite elements ("abaqus", "openradioss", "febio", "felupe") get a Prony series of the
    hold after that loading.

    Parameters
    ----------
    material
        A `Material`, or the path of its file.
    engine
        The simulator.
    depth_m
        Displacement of the jaw up to which the card is fitted, m; the deepest squeeze of the test if left out.
    speed_m_per_s, slowest_m_per_s
        Fastest and slowest speed of the jaw, m/s; those of the test if left out. Where the test has one, the slowest
        is half of it, or the least of 0.6 to 0.9 of it at which the error of a contact in loading is not above 2 %.
    hold_s
        Length of the hold that a Prony series covers, s.
    mass_kg
        Mass of the body, kg; "mujoco" needs it, because its contact is per mass.
    friction
        Coefficient of friction between jaw and body, of a contact; that of the engine if left out.
    poisson_ratio
        Poisson's ratio of a Prony card; that of Hertz's law, or else 0.49, if left out.
    terms_per_decade
        Terms of a Prony series in each decade of time.

    Returns
    -------
    Card
        The text of the card, its parameters and its errors.

    Raises
    ------
    OptionError
        An engine that there is not, a mass that is missing, a number out of its range, an option that does not change the card of
        the engine.
    ModelError
        A depth that the body does not have; a Prony series of an exponent below 1.

    Warns
    -----
    PalpateWarning
        A depth, speed or hold beyond the test; a contact whose error in loading is above 2 % of the peak force.

    Examples
    --------
    >>> import palpate
    >>> made = palpate.simulate({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "60 s"}, {"to": "9 mm", "rate": "500 mm/min", "hold": "60 s"}],
    ... })
    >>> record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
    >>> material = record.calibrate(test={"specimen": {"shape": "ball", "radius": "35 mm"}}, alternatives=[]).material
    >>> card = palpate.export(material, "abaqus")
    >>> card.text.splitlines()[-1].count(","), max(abs(error) for error in card.hold_error.values()) < 2e-4
    (2, True)
    """
    if not isinstance(material, Material):
        if not isinstance(material, (str, os.PathLike)):
            raise OptionError(f"material: expected a Material or the path of its file, found {type(material).__name__}")
        material = Material.read(material)
    document = _card(
        material,
        engine,
        depth_m=depth_m,
        speed_m_per_s=speed_m_per_s,
        slowest_m_per_s=slowest_m_per_s,
        hold_s=hold_s,
        mass_kg=mass_kg,
        friction=friction,
        poisson_ratio=poisson_ratio,
        terms_per_decade=terms_per_decade,
    )
    found = json.loads(document)
    return Card(
        engine=found["engine"],
        text=found["text"],
        parameters={parameter["name"]: parameter["value"] for parameter in found["parameters"]},
        prony=[(term["share"], term["time_constant_s"]) for term in found["prony"]],
        peak_force_n=found["peak_force_n"],
        loading_error=found["loading_error"],
        hold_error={row["time_s"]: row["error"] for row in found["hold"]},
        extrapolations=found["extrapolations"],
        _document=document,
    )
