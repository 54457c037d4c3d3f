"""Damaged pickles: objects made from states that no object of palpate has written, and all that can be requested of them.

A state is what `__reduce__` says: a maker and its arguments. Damage alters one place of an argument, or bytes of the whole pickle. Whatever
comes of it, palpate has to answer with an object or an error of its own: no panic, no other end of the process, within 2 s and 1 GB.

States are tried in a process of its own, which says which one it is at, so that the next process goes on behind the one that ended it.
`test_damaged_states.py` tries a sample, `validation/damaged_states.py` all of them.
"""

from __future__ import annotations

import argparse
import copy
import inspect
import io
import json
import os
import pickle
import random
import re
import resource
import select
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import palpate
from damage import inside, of_argument, of_bytes

ROOT = Path(__file__).resolve().parents[3]
BALL = ROOT / "examples/records/ball.csv", ROOT / "examples/records/ball.toml"
SCENE: dict[str, Any] = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
SQUEEZE = [{"to": "5 mm", "rate": "500 mm/min", "hold": "2 s"}]
# What pickles keep bytes in.
PIECE = "palpate._palpate", "_Piece"
# What a damaged state may be answered with; PalpateError is a ValueError.
ANSWERS = (ValueError, TypeError, OverflowError, pickle.UnpicklingError, EOFError)
GIGABYTE = 1 << 30
# Questions of a tenth of a second and more are put to one state of so many.
AT_LENGTH = {"analyze()", "compare()", "calibrate()", "predict", "grip"}
EVERY = 8


# Objects, one of each class at least, as small as they get.


def _hold(samples: int = 24) -> tuple[Any, Any]:
    t = np.linspace(0.0, 40.0, samples)
    return t, 0.2 + 0.1 * (1 + 2 * t) ** -0.25 + 1e-4 * np.sin(40 * t)


def _record(stiffness: float = 2.0) -> palpate.Record:
    t = np.linspace(0.0, 20.0, 80)
    depth = np.minimum(t, 1.0)
    force = stiffness * depth * (1 + 0.5 * np.exp(-t / 3)) + 1e-3 * np.sin(50 * t)
    return palpate.Record.from_arrays(time_s=t, displacement_m=5e-3 * depth, force_n=force)


def _material() -> palpate.Material:
    return palpate.Material.read(ROOT / "examples/records/ball-material.toml")


def _grip(**keywords: Any) -> palpate.Grip:
    return _material().grip(mass_kg=0.25, friction=0.6, **keywords)


def _schedule() -> palpate.Grip:
    return _grip(hold_s=2.0, band_n=(2.1, 3.0))


def _observed(observer: palpate.Observer) -> palpate.Observer:
    record = _record()
    observer.feed_many(record.time_s, record.force_n, record.displacement_m)
    return observer


def _batch() -> palpate.BatchResult:
    with tempfile.TemporaryDirectory() as folder:
        record, out = Path(folder, "record.csv"), Path(folder, "table.csv")
        _csv(record)
        return palpate.batch([record], out, test={"specimen": SCENE["specimen"]}, laws=["maxwell"])


def _csv(path: Path) -> None:
    record = _record()
    assert record.displacement_m is not None
    rows = zip(record.time_s, record.displacement_m, record.force_n, strict=True)
    path.write_text("time_s,displacement_m,force_n\n" + "".join(f"{t},{x},{f}\n" for t, x, f in rows))


def _read() -> palpate.Record:
    with tempfile.TemporaryDirectory() as folder:
        _csv(Path(folder, "record.csv"))
        return palpate.read(Path(folder, "record.csv"), test={"specimen": SCENE["specimen"], "contact": {"touch": "as recorded"}})


def _pressed() -> palpate.ContactState:
    state = palpate.ContactState(SCENE)
    state.step(0.5, 4e-3)
    return state


def _pressed_ones() -> palpate.ContactStates:
    states = palpate.ContactStates([SCENE, SCENE])
    states.step(0.5, [4e-3, 2e-3])
    return states


EXAMPLES: dict[str, Callable[[], Any]] = {
    "Record": _record,
    "Record, described": _read,
    "Record, force alone": lambda: palpate.Record.from_arrays(time_s=_hold()[0], force_n=_hold()[1]),
    "Analysis": lambda: _record().analyze(test={"specimen": SCENE["specimen"]}, compare=False),
    "Analysis, compared": lambda: _record().analyze(),
    "Finding": lambda: palpate.read(BALL[0]).analyze(compare=False).findings[0],
    "RecordComparison": lambda: _record().compare(laws=["latency", "maxwell"]),
    "Calibration": lambda: _record().calibrate(alternatives=["maxwell"], test={"specimen": {"shape": "ball", "radius": "35 mm"}}),
    "SeveralCalibrations": lambda: palpate.calibrate(
        [_record(), _record(2.2)], shared="all", law="prony:1", test={"specimen": {"shape": "ball", "radius": "35 mm"}}
    ),
    "Material": _material,
    "Material, linear": lambda: _record().calibrate(law="prony:2", alternatives=[], test={"specimen": SCENE["specimen"]}).material,
    "Prediction": lambda: _material().predict(SQUEEZE, at_s=[0.5, 1.0, 2.0]),
    "Trajectory": lambda: palpate.simulate({**SCENE, "step": SQUEEZE, "output": {"sample_rate": "4 Hz"}}),
    "Grip": _schedule,
    "Grip, force": lambda: _grip(control="force", force_n=1.5, hold_s=1.0),
    "PositionHold": lambda: _grip(squeeze_m=5e-3).squeeze,
    "BackOff": lambda: _schedule().back_off,
    "ForceHold": lambda: _schedule().force_held,
    "Schedule": lambda: _schedule().schedule,
    "Fit": lambda: palpate.fit_hold(*_hold()),
    "Fit, prony": lambda: palpate.fit_hold(*_hold(), law="prony:2"),
    "Fit, stretched": lambda: palpate.fit_hold(*_hold(), law="stretched"),
    "Fit, fractional": lambda: palpate.fit_hold(*_hold(), law="fractional-zener"),
    "Fit, profile": lambda: palpate.fit_hold(*_hold(), intervals="profile"),
    "Estimate": lambda: palpate.fit_hold(*_hold()).estimates["exponent"],
    "Comparison": lambda: palpate.compare(*_hold(), laws=["latency:5", "maxwell"]),
    "Observation": lambda: palpate.Observer(slip_force_n=2.0).feed(0.0, 1.0, 1e-3),
    "Observation, hold": lambda: _observed(palpate.Observer(slip_force_n=1.0)).feed(21.0, 2.0, 5e-3),
    "Observer": lambda: _observed(palpate.Observer(slip_force_n=1.0)),
    "Observer, material": lambda: _observed(palpate.Observer(_material(), slip_force_n=1.0)),
    "ContactState": _pressed,
    "ContactStates": _pressed_ones,
    "BatchResult": _batch,
    "Table": lambda: _record().segments(),
    "Table, observed": lambda: palpate.Observer().feed_many(*(column[:6] for column in _hold())),
    "Table, lists": lambda: palpate.simulate_many({**SCENE, "step": SQUEEZE}, {"specimen.radius": [0.03, 0.04]}, times_s=[1.0, 2.0]),
}


def picklable() -> set[str]:
    """Names of the classes that say how they are pickled."""
    classes = (getattr(palpate, name) for name in palpate.__all__)
    return {found.__name__ for found in classes if isinstance(found, type) and "__reduce__" in vars(found)}


def _plain(arguments: tuple[Any, ...]) -> tuple[Any, ...]:
    """Arguments of a maker with the bytes of their pieces."""

    def plain(argument: Any) -> Any:
        if not isinstance(argument, list):
            return argument
        return [piece.__reduce__()[1][0] if type(piece).__name__ == PIECE[1] else piece for piece in argument]

    return tuple(map(plain, arguments))


class Made(NamedTuple):
    """What a pickle asks for: a maker by name, and its arguments."""

    maker: tuple[str, str]
    arguments: tuple[Any, ...]


class Maker:
    """What stands for a class of palpate while a pickle is read."""

    def __init__(self, name: str) -> None:
        self.name = name


class Careful(pickle._Unpickler):
    """Reads a pickle without calling anything: only classes of palpate, and their makers."""

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == ("builtins", "getattr"):
            return self.maker
        if (module == "palpate" and name in picklable()) or (module, name) == PIECE:
            return Maker(name)
        raise pickle.UnpicklingError(f"{module}.{name} is not of palpate")

    @staticmethod
    def maker(of: Any, name: Any) -> Any:
        if not isinstance(of, Maker) or not isinstance(name, str) or not name.startswith("_from_"):
            raise pickle.UnpicklingError("no maker")
        if of.name == PIECE[1]:
            return lambda piece: piece
        return lambda *arguments: Made((of.name, name), arguments)


@dataclass(frozen=True)
class Case:
    """A damaged state."""

    example: str
    damage: str
    make: Callable[[], Any]
    whole: bool = False


def cases(name: str, of: Any, seed: int, most: int = 4000) -> list[Case]:
    """Damage to an object, more than `most` where there is as much, in an order that the seed decides."""
    chance = random.Random(f"{seed} {name}")

    def places(count: int, share: int) -> Iterator[int]:
        yield from sorted(chance.sample(range(count), min(count, most // (2 * share) + 1)))

    arguments = _plain(of.__reduce__()[1])
    found: list[Case] = []
    # One state and the number of its format, or several parts.
    alone = sum(not isinstance(argument, int) for argument in arguments) == 1
    for index, argument in enumerate(arguments):
        at = "$format" if isinstance(argument, int) else "$" if alone else f"${index + 1}"
        for what, make in of_argument(argument, at, places):
            found.append(Case(name, what, partial(inside, list(arguments), index, make)))
    dumped = pickle.dumps(of)

    def in_head(count: int, _: int) -> Iterator[int]:
        # The opcodes are at both ends; what lies between is the arguments.
        yield from (place for place in range(count) if place < 100 or place >= count - 8)

    found.extend(Case(name, what, make, whole=True) for what, make in of_bytes(dumped, "pickle", in_head))
    chance.shuffle(found)
    return found


# Use: all that can be requested of an object.


def _calls(of: Any, folder: Path) -> Iterator[tuple[str, Callable[[], Any]]]:
    """Calls with arguments, by class."""
    t = np.linspace(30.0, 32.0, 40)
    match of:
        case palpate.Observer():
            yield "feed", lambda: of.feed(29.9, 1.5, 5e-3)
            yield "feed_many", lambda: of.feed_many(t, 1.4 + 0 * t, 5e-3 + 0 * t)
            yield "feed_many, opening", lambda: of.feed_many(t + 10, 3 - 0.1 * (t - 30), 5e-3 - 1e-3 * (t - 30))
        case palpate.ContactState():
            yield "step", lambda: [of.step(0.1, 1e-3 * i) for i in (1, 5, 3, 0, -1, 2)]
            yield "step_force", lambda: of.step_force(0.1, 1.0)
        case palpate.ContactStates():
            yield "step", lambda: [of.step(0.1, 1e-3 * i) for i in (1, 5, 3, 0, -1, 2)]
            yield "step_force", lambda: of.step_force(0.1, 1.0)
        case palpate.Fit():
            yield "predict", lambda: of.predict([0.0, 1.0, 50.0])
            yield "predict, interval", lambda: of.predict(elapsed_s=[0.0, 1.0, 50.0], interval=0.9, of="sample")
        case palpate.Material():
            yield "predict", lambda: of.predict(SQUEEZE, at_s=[1.0, 2.0])
            yield "grip", lambda: of.grip(mass_kg=0.25, friction=0.6, squeeze_m=5e-3)
            yield "observer", lambda: palpate.Observer(of, slip_force_n=1.0).feed_many(t, 1.4 + 0 * t, 5e-3 + 0 * t)
            yield "write", lambda: of.write(folder / "material.toml")
        case palpate.Record():
            yield "analyze", lambda: of.analyze(compare=False)
        case palpate.Analysis() | palpate.Grip():
            yield "report", lambda: of.report(folder / "report")
        case palpate.Table():
            for name in of.column_names:
                yield f"[{name!r}]", partial(of.__getitem__, name)
        case _:
            pass


def uses(of: Any, folder: Path, depth: int = 0) -> Iterator[tuple[str, Callable[[], Any]]]:
    """Names and calls of all that can be requested of an object, and of the objects that it gives."""
    if not type(of).__module__.startswith("palpate"):
        return
    yield "repr", lambda: repr(of)
    yield "str", lambda: str(of)
    yield "==", lambda: (of == of, of == copy.copy(of), of == 1)
    if depth == 0:
        yield "pickle", lambda: pickle.loads(pickle.dumps(of)) == of
        yield "deepcopy", lambda: copy.deepcopy(of)
    for name in dir(type(of)):
        if name in ("__len__", "__float__", "__arrow_c_stream__", "_repr_html_", "__iter__"):
            yield name, (lambda: [*of]) if name == "__iter__" else getattr(of, name)
        if name.startswith("_"):
            continue
        try:
            value = getattr(of, name)
        except BaseException:
            # Requested again where it is distinguished; a panic is no Exception.
            yield name, partial(getattr, of, name)
            continue
        if not callable(value):
            inside = value.values() if isinstance(value, dict) else value if isinstance(value, list) else [value]
            for one in list(inside)[:2]:
                for what, ask in uses(one, folder, depth + 1) if depth < 2 else ():
                    yield f"{name}.{what}", ask
            continue
        if all(of.default is not of.empty for of in inspect.signature(value).parameters.values()):
            yield f"{name}()", value
    if depth == 0:
        yield from _calls(of, folder)


# A process that tries states, and says where it is.


def _answers(ask: Callable[[], Any]) -> tuple[Any, str]:
    """What came, and what is wrong with it."""
    try:
        return ask(), ""
    except ANSWERS as error:
        return None, f"panic: {error}" if "palpate made a mistake of its own" in str(error) else ""
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        kind = type(error).__name__
        return None, f"{'panic' if kind == 'PanicException' else kind}: {str(error)[:300]}"


def _object(case: Case) -> Any:
    state = case.make()
    if not case.whole:
        maker, _ = _state(case.example)
        return maker(*state)
    try:
        made = Careful(io.BytesIO(state)).load()
    except Exception as error:
        # Before palpate hears of it.
        raise pickle.UnpicklingError(str(error)) from None
    if not isinstance(made, Made):
        return None
    maker = getattr(getattr(palpate, made.maker[0]), made.maker[1], None)
    return None if maker is None else maker(*made.arguments)


_STATES: dict[str, tuple[Any, tuple[Any, ...]]] = {}


def _state(name: str) -> tuple[Any, tuple[Any, ...]]:
    if name not in _STATES:
        _STATES[name] = EXAMPLES[name]().__reduce__()[:2]
    return _STATES[name]


def _limit_memory() -> None:
    now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (now + GIGABYTE, resource.RLIM_INFINITY))


def work(seed: int, most: int, first: int, names: list[str]) -> None:
    """Tries states and reports by lines: at which one it is, and what is wrong with it. Standard error is a file that can be read."""
    warnings.simplefilter("ignore")
    lines = os.fdopen(os.dup(1), "w", buffering=1)
    with tempfile.TemporaryDirectory() as folder:
        index = 0
        for name in names:
            left = first - index
            if left >= most and index + most <= first:
                # Each example counts for as many, whether it has them or not.
                index += most
                continue
            lines.write(f"{json.dumps(name)}\n")
            of = EXAMPLES[name]()
            _STATES[name] = of.__reduce__()[:2]
            damaged = cases(name, of, seed, most)[:most]
            _limit_memory()
            for number, case in enumerate(damaged):
                if index + number < first:
                    continue
                lines.write(f"{json.dumps([index + number, name, case.damage])}\n")
                for found in answers_of(case, Path(folder), number % EVERY == 0, heard=2):
                    lines.write(f"{json.dumps(found)}\n")
            index += most
        lines.write("null\n")


def _panic(stated: str) -> tuple[str, str]:
    """Where a panic happened and what it stated, from standard error."""
    found = re.search(r"panicked at (?:.*/registry/src/[^/]*/)?([^\n]*?):\n(.*?)\n", stated, re.DOTALL)
    return (found.group(1), found.group(2)[:300]) if found else ("", "")


def answers_of(case: Case, folder: Path, at_length: bool = True, heard: int | None = None) -> Iterator[dict[str, str]]:
    """Makes an object of a damaged state and asks it everything: the names of the questions, and what is wrong with the answers.

    `heard` is a file that standard error goes to: there a panic says where it happened.
    """

    def wrong(use: str, message: str) -> Iterator[dict[str, str]]:
        kind, _, text = message.partition(": ")
        where = ""
        if heard is not None:
            where, stated = _panic(os.pread(heard, 1 << 16, 0).decode("utf-8", "replace"))
            os.ftruncate(heard, 0)
            os.lseek(heard, 0, os.SEEK_SET)
            if where:
                # Heard even where the panic itself was caught.
                kind, text = "panic", stated
        if kind:
            yield {"use": use, "kind": kind, "where": where, "message": text}

    of, message = _answers(lambda: _object(case))
    yield from wrong("make", message)
    if of is None:
        return
    for use, ask in uses(of, folder):
        if not at_length and use in AT_LENGTH:
            continue
        yield {"use": use}
        _, message = _answers(ask)
        yield from wrong(use, message)


@dataclass(frozen=True)
class Failure:
    """A damaged state that was not answered as it should be."""

    example: str
    damage: str
    use: str
    kind: str
    where: str
    message: str


@dataclass(frozen=True)
class Tried:
    """How many states were tried by example, how many of them made an object, and what went wrong."""

    states: dict[str, int]
    objects: dict[str, int]
    failures: list[Failure]


def tried(seed: int, most: int, names: list[str] | None = None, patience_s: float = 2.0, deaths: int = 5) -> Tried:
    """Tries up to `most` damaged states of each example; after `deaths` ends of the process the rest of an example is left out."""
    names = list(EXAMPLES) if names is None else names
    result = Tried(dict.fromkeys(names, 0), dict.fromkeys(names, 0), [])
    died: dict[str, int] = dict.fromkeys(names, 0)
    first = 0
    while first < most * len(names):
        at, end = _process(seed, most, first, names, patience_s, result)
        if at is None and end:
            raise RuntimeError(f"the process that tries states ended before any: {end}")
        if at is None or not end:
            break
        first, name, damage = at
        kind, _, message = end.partition(": ")
        result.failures.append(Failure(name, damage, "", kind, "", message))
        died[name] += 1
        first = first + 1 if died[name] < deaths else (first // most + 1) * most
    return result


def _process(
    seed: int, most: int, first: int, names: list[str], patience_s: float, result: Tried
) -> tuple[tuple[int, str, str] | None, str]:
    """One process; the state that it was at, and how it ended if not well."""
    command = [sys.executable, __file__, "--seed", str(seed), "--most", str(most), "--first", str(first), *names]
    environment = {**os.environ, "MALLOC_ARENA_MAX": "1", "RUST_BACKTRACE": "0"}
    at: tuple[int, str, str] | None = None
    listing, use = True, "make"
    heard = tempfile.TemporaryFile()
    with heard, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=heard, env=environment) as process:
        assert process.stdout is not None
        pending, last = b"", time.monotonic()
        while True:
            ready, _, _ = select.select([process.stdout], [], [], patience_s)
            if not ready:
                # All damage is listed before the first state of an example.
                if time.monotonic() - last < (60.0 if listing else patience_s):
                    continue
                process.kill()
                return at, f"hang: no answer to {use} in {patience_s} s"
            read = os.read(process.stdout.fileno(), 1 << 16)
            last = time.monotonic()
            if not read:
                code, stated = process.wait(), os.pread(heard.fileno(), 1 << 16, 0).decode("utf-8", "replace").strip()
                return at, f"death: the process ended with {code} at {use}: {stated[-200:]}"
            *lines, pending = (pending + read).split(b"\n")
            for found in map(json.loads, lines):
                listing = isinstance(found, str)
                if found is None:
                    return at, ""
                if isinstance(found, list):
                    at, use = (int(found[0]), str(found[1]), str(found[2])), "make"
                    result.states[at[1]] += 1
                elif at is not None and isinstance(found, dict) and len(found) == 1:
                    # The first question is put to every object.
                    result.objects[at[1]] += found["use"] == "repr"
                    use = found["use"]
                elif at is not None and isinstance(found, dict):
                    result.failures.append(Failure(at[1], at[2], **found))


def fewest(failures: list[Failure]) -> list[tuple[Failure, int]]:
    """One failure of each kind and place, the one of the shortest damage, and how many there are."""
    groups: dict[tuple[str, ...], list[Failure]] = {}
    for failure in failures:
        # Without a place in the code the question says most.
        place = (failure.where,) if failure.where else (failure.example.split(",")[0], failure.use.rpartition(".")[2])
        groups.setdefault((failure.kind, *place), []).append(failure)
    return [(min(group, key=lambda failure: (len(failure.damage), failure.damage)), len(group)) for _, group in sorted(groups.items())]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--most", type=int, required=True)
    parser.add_argument("--first", type=int, required=True)
    parser.add_argument("names", nargs="+")
    requested = parser.parse_args()
    work(requested.seed, requested.most, requested.first, requested.names)


if __name__ == "__main__":
    main()
