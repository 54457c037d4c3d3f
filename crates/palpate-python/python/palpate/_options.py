"""The words that options take, for editors and checkers of types; every list is that of the compiled part."""

from __future__ import annotations

from typing import Literal, TypeAlias, Union

#: A law by its name, or with a number: ``"latency:5"``, ``"prony:2"``.
LawName: TypeAlias = Union[
    Literal[
        "latency",
        "latency:2",
        "latency:3",
        "latency:5",
        "latency:7",
        "prony:1",
        "prony:2",
        "prony:3",
        "prony:4",
        "fung:1",
        "fung:2",
        "maxwell",
        "kelvin-voigt",
        "standard-linear-solid",
        "burgers",
        "spectrum",
        "fung-continuous",
        "stretched",
        "power",
        "logarithmic",
        "fractional-zener",
        "diffusion",
    ],
    str,
]
Response: TypeAlias = Literal["relaxation", "creep"]
Loss: TypeAlias = Literal["squares", "huber", "tukey"]
Noise: TypeAlias = Literal["residuals", "white"]
Intervals: TypeAlias = Literal["automatic", "curvature", "profile", "bootstrap"]
Missing: TypeAlias = Literal["raise", "omit"]
Quantity: TypeAlias = Literal["force", "strain", "displacement"]
Control: TypeAlias = Literal["position", "force"]
DriveBy: TypeAlias = Literal["displacement", "force"]
EnergyBy: TypeAlias = Literal["time", "step", "cycle"]
Engine: TypeAlias = Literal["mujoco", "drake", "physx", "isaac", "newton", "abaqus", "openradioss", "febio", "felupe"]
