"""Results as text and in notebooks."""

from __future__ import annotations

import re
from html import escape
from typing import Any

import numpy as np

from palpate import _palpate
from palpate._convert import table_of


def _texts(rows: list[list[Any]]) -> list[list[str]]:
    def text(value: Any) -> str:
        if value is None or (isinstance(value, float) and np.isnan(value)):
            return ""
        return f"{value:.6g}" if isinstance(value, float) else str(value)

    return [[text(value) for value in row] for row in rows]


def _rows(result: Any) -> list[list[Any]]:
    """What a result comes to, as a table whose first row has the names of the columns."""
    if isinstance(result, _palpate.Fit):
        head = ["parameter", "value", "standard error", "low", "high", "unit"]
        estimates = result.estimates.items()
        return [head, *([name, one.value, one.standard_error, *(one.interval or (None, None)), one.unit] for name, one in estimates)]
    table = table_of(result)
    if isinstance(result, (_palpate.Comparison, _palpate.RecordComparison)):
        return [table.column_names, *(list(row.values()) for row in table)]
    numbers = {name: values for name in table.column_names if isinstance(values := table[name], np.ndarray)}
    ends = ([name, *map(float, (v[0], v[-1], np.min(v), np.max(v)))] for name, v in numbers.items() if len(v))
    return [["series", "first", "last", "least", "greatest"], *ends]


def _heading(result: Any) -> str:
    if isinstance(result, _palpate.Record):
        return f"{result.title}: {len(result)} samples"
    if isinstance(result, _palpate.Fit):
        return f"{result.law}: {result.termination}, rmse {result.rmse:.6g}, AIC {result.aic:.6g}, BIC {result.bic:.6g}"
    return repr(result).strip("<>").removeprefix("palpate.")


def _remarks(result: Any) -> list[str]:
    """What is to be heeded beside the numbers, in sentences."""
    remark = result._noise_remark if isinstance(result, _palpate.Fit) else None
    return [] if remark is None else ["; ".join(remark)]


def summary(self: Any) -> str:
    """What this result comes to, as text."""
    if "__str__" in vars(type(self)):
        return str(self)
    rows = _texts(_rows(self))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows)
    return "\n".join([_heading(self), *lines, *_remarks(self)]) + "\n"


def _repr_html_(self: Any) -> str:
    """What this result comes to, for notebooks."""
    head, *body = _texts(_rows(self))

    def cells(row: list[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in row) + "</tr>"

    rows = "".join(cells(row, "td") for row in body)
    remarks = "".join(f"<p>{escape(remark)}</p>" for remark in _remarks(self))
    return f"<p>{escape(_heading(self))}</p><table><thead>{cells(head, 'th')}</thead><tbody>{rows}</tbody></table>{remarks}"


#: The parts of a format of numbers: what pads the whole, and what each number is written by.
_FORMAT = re.compile(r"(?:(.?)([<>=^]))?([-+ ]?)(z?#?)(0?)(\d*)(.*)", re.DOTALL)


def formatted(value: float, error: float | None, spec: str) -> str:
    """An estimate with its standard error, each by a format of numbers, padded together to its width."""
    fill, align, sign, alternate, zero, width, rest = _FORMAT.fullmatch(spec).groups()  # type: ignore[union-attr]
    plain = alternate + rest
    text = format(value, sign + plain)
    if error is not None:
        text += f" ± {format(error, plain)}"
    # The whole is no number that zeros could fill up behind its sign.
    align = ">" if align in (None, "=") or zero else align
    return f"{text:{fill or ' '}{align}{width}}" if width else text
