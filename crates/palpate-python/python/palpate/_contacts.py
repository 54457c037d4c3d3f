"""Contacts that are simulated: one, its energy, and many."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from palpate import _palpate, _units
from palpate._descriptions import described, toml
from palpate._options import DriveBy, EnergyBy
from palpate._palpate import OptionError, Record, Table, Trajectory
from palpate._progress import bar


def simulate(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    *,
    specimen: Mapping[str, Any] | None = None,
    law: Mapping[str, Any] | None = None,
    contact: Mapping[str, Any] | None = None,
    output: Mapping[str, Any] | None = None,
    drive: Record | None = None,
    drive_by: DriveBy = "displacement",
) -> Trajectory:
    """Simulate squeeze, hold, creep and release by a protocol.

    Parameters
    ----------
    protocol
        Path of a protocol (TOML), a `Protocol`, or a mapping with its tables: ``{"specimen": {...}, "law": {...}, "step": [{...}, ...]}``.
        Quantities are texts with a unit, such as ``"radius": "35 mm"``, quantities of pint, or numbers in SI under a key that says the
        unit, such as ``"radius_m": 0.035``; ``_m``, ``_s``, ``_n``, ``_pa``, ``_m2``, ``_per_s``, ``_m_per_s`` and ``_n_per_s`` do.
        ``"material"``, a `Material` or the path of its file, stands for specimen, law and contact.
    specimen, law, contact, output
        Tables that stand in place of those of a mapping.
    drive
        A measured record whose displacement, or force, the body follows in place of the steps.
    drive_by
        Which of both: "displacement" or "force".

    Returns
    -------
    Trajectory
        Time, displacement, force and strains in SI, with contacts lost and regained.

    Raises
    ------
    OptionError
        A protocol that says what no contact can do; the message names the key.
    RecordError
        A record without a displacement that is to drive by it.
    ModelError
        A motion that the body cannot take.

    Examples
    --------
    >>> import palpate
    >>> trajectory = palpate.simulate({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    ... })
    >>> round(float(trajectory.force_n[-1]), 2)
    1.56
    """
    replaced = {"specimen": specimen, "law": law, "contact": contact, "output": output}
    replaced = {name: table for name, table in replaced.items() if table is not None}
    driver = _driver(drive, drive_by)
    if isinstance(protocol, Mapping) and not hasattr(protocol, "data_vars"):
        return _palpate.simulate(None, toml({**protocol, **replaced}), *driver)
    path, text = described(protocol)
    if replaced:
        raise OptionError(f"{', '.join(replaced)}: tables replace those of a mapping, found the path of a protocol")
    return _palpate.simulate(path, text, *driver)


def _driver(drive: Any, drive_by: str) -> tuple[Any, str]:
    """The columns of the record that drives, and which of them does."""
    if drive is None:
        return None, drive_by
    if not isinstance(drive, Record):
        raise OptionError(f"drive: expected a Record, found {type(drive).__name__}\nhint: read it with palpate.read(...)")
    return (drive.time_s, drive.displacement_m, drive.force_n), drive_by


def energy(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    *,
    by: EnergyBy = "time",
    drive: Record | None = None,
    drive_by: DriveBy = "displacement",
) -> Table:
    """Work of the jaw in a protocol: what the body gives back, stores and loses.

    Work is integrated along with the contact, not from samples. ``simulate(protocol).plot(x="displacement_m")`` draws the loops of
    force against displacement whose areas the cycles have.

    Parameters
    ----------
    protocol, drive, drive_by
        As for `simulate`.
    by
        Rows by "time", by "step" of the drive, or by "cycle" of squeeze and release.

    Returns
    -------
    Table
        Energies in J, of both contacts of a body that is squeezed from two sides. By time: ``time_s``, ``work_j``, ``given_back_j``,
        ``stored_j``, ``lost_j``. By step: ``step``, ``from_s``, ``until_s``, displacements, ``work_j``, ``given_back_j``, ``lost_j``. By
        cycle: ``cycle``, ``from_s``, ``until_s``, ``done_j``, ``given_back_j``, ``lost_j``, ``share_lost``, and whether it is ``closed``:
        the jaw is back, to 1 % of its travel, and what the body holds, to 1 % of the work done. ``lost_j`` went to heat, in open cycles too; of a
        body whose contact grows it is the area of a closed loop. What the law does not say of such a body is missing.

    Raises
    ------
    OptionError, RecordError, ModelError
        As for `simulate`.

    Examples
    --------
    >>> import palpate
    >>> cycle = palpate.energy({
    ...     "specimen": {"shape": "block", "area": "10 cm^2", "length": "40 mm", "modulus": "100 kPa"},
    ...     "law": {"name": "latency", "exponent": 3, "rate_coefficient": "100 /s"},
    ...     "step": [{"to": "4 mm", "rate": "4 mm/s"}, {"to": "0 mm", "rate": "4 mm/s", "hold": "10 min"}],
    ... }, by="cycle")
    >>> round(float(cycle["share_lost"][0]), 3)
    0.791
    """
    path, text = described(protocol)
    return _palpate.energy(path, text, *_driver(drive, drive_by), by)


def simulate_many(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    numbers: Mapping[str, Any],
    *,
    times_s: Any = None,
    progress: bool | None = None,
) -> Table:
    """Simulate one protocol with many numbers, on all processors and without the GIL.

    Parameters
    ----------
    protocol
        Path of a protocol (TOML), or a mapping with its tables, as for `simulate`.
    numbers
        Arrays of one length by the path of the number they replace, in SI:
        ``{"law.rate_coefficient": [1e3, 1e4], "specimen.radius": [0.035, 0.03], "step[1].hold": [10, 60]}``. A path may state the unit,
        as ``"specimen.radius_m"`` does; entries of lists count from 1, as in protocols' files. Run i takes the
        value i of each. A number has to stand in the protocol to be replaced.
    times_s : array_like, shape (T,), optional
        Times at which the force is wanted, rising and inside the motion.
    progress
        As for `fit_many`.

    Returns
    -------
    Table
        A row a run, with the columns of ``palpate sweep``: the numbers, peak force and its time, force, displacement and
        strains at the end, work and losses, what each step ends with, and why a run was refused. With ``times_s`` also
        ``force_n``, an array of shape (runs, T).

    Raises
    ------
    OptionError
        A protocol that is wrong, a number that does not stand in it, arrays of different lengths.
    ModelError
        Times outside the motion.

    Examples
    --------
    >>> import palpate
    >>> protocol = {
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ...     "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    ... }
    >>> runs = palpate.simulate_many(protocol, {"specimen.radius": [0.03, 0.035]}, times_s=[0.6, 10.6])
    >>> [round(force, 2) for force in runs["force_end_n"].tolist()]
    [1.48, 1.56]
    >>> runs["force_n"].shape
    (2, 2)
    """
    path, text = described(protocol)
    if not isinstance(numbers, Mapping):
        example = '{"law.exponent": [3, 5]}'
        raise OptionError(f"numbers: expected arrays by the path of a number, such as {example}, found {type(numbers).__name__}")
    columns = [(str(number), values) for number, values in numbers.items()]
    for number, values in columns:
        _check_dimension(number, values)
    try:
        runs = len(columns[0][1]) if columns else 0
    except TypeError:
        # No array: the compiled part says what is wrong with it.
        runs = 0
    with bar(progress, runs, "run") as tell:
        return _palpate.simulate_many(path, text, columns, times_s, tell)


def _check_dimension(path: str, values: Any) -> None:
    """Refuses quantities of a dimension beside a path without its unit: nothing says whether it is that of the number."""
    first: Any = values[0] if isinstance(values, (list, tuple)) and values else values
    if _units.is_quantity(first) and not first.dimensionless and not _units.ending(path):
        message = f"{path}: expected numbers in SI, found quantities in {first.units}"
        raise OptionError(f"{message}\nhint: end the path in its unit, as in specimen.radius_m")
