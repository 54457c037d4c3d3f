"""Damage to values, texts and bytes: what is altered, and how it is called.

Every function yields pairs of a description and what makes the damaged value, so that nothing large is made before it is wanted.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

# What it is called, and what makes the damaged value.
Damage = tuple[str, Callable[[], Any]]
NUMBERS: list[Any] = [0, -1, 1, 3, 0.5, 1e308, -1e308, 5e-324, 1e-30, 2**31, 2**63, 2**64 - 1, 10**30, 10**400, float("nan")]
TOML_NUMBERS = ["0", "-1", "nan", "inf", "1e308", "-1e308", "1e-320", "1e30", "4294967296", "9223372036854775807", "1" + "0" * 30]
OTHERS: list[Any] = [None, "", "x", [], {}, True]
WORDS = ["", "latency:1e308", "prony:1000000000", "fung:64", "\0", "é\u202e<b>", "a" * 100_000]


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:30]}… ({len(text)} characters)"


def _ends(count: int) -> list[int]:
    """All places of a short list, some of a long one."""
    return list(range(count)) if count <= 3 else [0, count // 2, count - 1]


def _same(value: Any) -> Any:
    return value


def _put(value: Any, start: int, end: int, other: Any) -> Any:
    """A list, a text or bytes with something else from `start` to `end`."""
    return value[:start] + other + value[end:]


def inside(value: list[Any], place: int, make: Callable[[], Any]) -> list[Any]:
    """The list with something else at a place."""
    return [*value[:place], make(), *value[place + 1 :]]


def _under(value: dict[str, Any], key: str, make: Callable[[], Any]) -> dict[str, Any]:
    return {**value, key: make()}


def _dumped(make: Callable[[], Any]) -> str:
    return json.dumps(make())


def _encoded(make: Callable[[], str]) -> bytes:
    return make().encode("utf-8", "surrogatepass")


def of_value(value: Any, at: str) -> Iterator[Damage]:
    """Damage to a value of JSON and to all inside it."""
    if isinstance(value, bool) or value is None:
        others: list[Any] = [not value, 0, 1e308, "x", [], {}, None]
    elif isinstance(value, (int, float)):
        others = [*NUMBERS, -value, value * 1e6, *OTHERS]
    elif isinstance(value, str):
        others = [*WORDS, *OTHERS, 1e308]
    else:
        others = [*OTHERS, -1]
    for other in others:
        yield f"{at} = {_shown(other)}", partial(_same, other)
    if isinstance(value, str) and "\n" in value and len(value) < 10_000:
        yield from of_toml(value, at)
    if isinstance(value, list):
        yield from _of_list(value, at)
    if isinstance(value, dict):
        yield from _of_table(value, at)


def _of_list(value: list[Any], at: str) -> Iterator[Damage]:
    count = len(value)
    if count:
        yield f"{at} without the first", partial(_put, value, 0, 1, [])
        yield f"{at} without the last", partial(_put, value, count - 1, count, [])
        yield f"{at} twice", partial(_put, value, count, count, value)
        yield f"{at} backwards", partial(_same, value[::-1])
        yield f"{at} of nothing", partial(_same, [None] * count)
        if len(repr(value[0])) < 1000:
            yield f"{at} first one 2000 times", partial(_same, value[:1] * 2000)
    for place in _ends(count):
        for what, make in of_value(value[place], f"{at}[{place}]"):
            yield what, partial(inside, value, place, make)


def _of_table(value: dict[str, Any], at: str) -> Iterator[Damage]:
    yield f"{at} with another key", partial(_same, {**value, "other": 1})
    for key in value:
        yield f"{at} without {key}", partial(_same, {name: value[name] for name in value if name != key})
        for what, make in of_value(value[key], f"{at}.{key}"):
            yield what, partial(_under, value, key, make)
    for one, other in zip(value, list(value)[1:], strict=False):
        yield f"{at}: {one} and {other} changed over", partial(_same, {**value, one: value[other], other: value[one]})


def of_toml(text: str, at: str) -> Iterator[Damage]:
    """Damage to numbers, lines and words of TOML."""
    for found in re.finditer(r"(?<![\w#.])-?\d+(\.\d+)?(e[-+]?\d+)?", text):
        key = text[text.rfind("\n", 0, found.start()) + 1 : found.start()].strip()
        for number in TOML_NUMBERS:
            yield f"{at}: {key} {number}", partial(_put, text, *found.span(), number)
    start = 0
    for line in text.splitlines(keepends=True):
        shown = repr(line.strip()[:60])
        yield f"{at} without line {shown}", partial(_put, text, start, start + len(line), "")
        yield f"{at} with line {shown} twice", partial(_put, text, start, start, line)
        start += len(line)
    for found in re.finditer(r'"([^"\n]*)"', text):
        for word in ["", "x", *WORDS]:
            what = f"{at}: text {found.group(1)[:40]!r} becomes {_shown(word)}"
            yield what, partial(_put, text, *found.span(1), json.dumps(word)[1:-1])


WHOLE = [np.array([number], "<f8").tobytes() for number in [np.nan, np.inf, -np.inf, 1e308, -1e308, -1.0, 0.0, 5e-324]]
COUNTS = [number.to_bytes(8, "little") for number in [0, 1, 65, 2**16, 2**31 - 1, 2**32, 2**62, 2**63, 2**64 - 1]]


def of_bytes(data: bytes, at: str, places: Callable[[int, int], Iterator[int]]) -> Iterator[Damage]:
    """Damage to bytes: `places(count, share)` says where."""
    count = len(data)
    for place in places(count, 1):
        for bit in (0, 3, 7):
            yield f"{at}, bit {bit} of byte {place}", partial(_put, data, place, place + 1, bytes([data[place] ^ (1 << bit)]))
        for number in (0, 255):
            yield f"{at}, byte {place} = {number}", partial(_put, data, place, place + 1, bytes([number]))
    for place in places(count, 2):
        yield f"{at}, cut to {place}", partial(_put, data, place, count, b"")
        yield f"{at}, without byte {place}", partial(_put, data, place, place + 1, b"")
        yield f"{at}, {place} bytes from the front to the end", partial(_same, data[place:] + data[:place])
        for eight in [*WHOLE, *COUNTS]:
            what = f"{at}, bytes from {place} = {eight.hex()}"
            yield what, partial(_put, data, place, min(place + 8, count), eight[: count - place])
    yield f"{at}, empty", partial(_same, b"")
    yield f"{at}, twice", partial(_same, data * 2)


def of_text(text: str, at: str, places: Callable[[int, int], Iterator[int]]) -> Iterator[Damage]:
    """Damage to a text: as JSON or TOML where it is that, and as letters."""
    try:
        document = json.loads(text)
    except ValueError:
        yield from of_toml(text, at)
    else:
        for what, make in of_value(document, at):
            yield what, partial(_dumped, make)
    yield f"{at} = 100000 brackets", partial(_same, "[" * 100_000)
    for place in places(len(text), 4):
        yield f"{at}, cut to {place}", partial(_put, text, place, len(text), "")
        yield f"{at}, without letter {place}", partial(_put, text, place, place + 1, "")
        yield f"{at}, surrogate at {place}", partial(_put, text, place, place + 1, "\udc80")


def of_argument(value: Any, at: str, places: Callable[[int, int], Iterator[int]]) -> Iterator[Damage]:
    """Damage to an argument of a maker."""
    if isinstance(value, str):
        yield from of_text(value, at, places)
    elif isinstance(value, bytes) and value.startswith((b"{", b"[")):
        for what, make in of_text(value.decode(), at, places):
            yield what, partial(_encoded, make)
    elif isinstance(value, bytes):
        yield from of_bytes(value, at, places)
    elif isinstance(value, list):
        yield f"{at} without the last", partial(_same, value[:-1])
        yield f"{at} twice", partial(_same, value * 2)
        # A part of a text is none: its pieces are damaged together, and come back as one.
        is_text = len(value) > 1 and isinstance(value[0], bytes) and value[0].startswith((b"{", b"["))
        if is_text:
            for what, make in of_text(b"".join(value).decode(), at, places):
                yield what, partial(inside, [b""], 0, partial(_encoded, make))
        for place, one in enumerate([] if is_text else value):
            # One piece is the whole.
            alone = isinstance(one, bytes) and len(value) == 1
            for what, make in of_argument(one, at if alone else f"{at}[{place}]", places):
                yield what, partial(inside, value, place, make)
    others: list[Any] = [None, 0, 2, -1, 2**40, "", b"", []]
    for other in others:
        yield f"{at} = {other!r}", partial(_same, other)
