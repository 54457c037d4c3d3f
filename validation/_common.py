"""Shared by the validation scripts: writing a reference file, reading back exact doubles."""

import importlib.metadata
import json
import pathlib
import platform

HERE = pathlib.Path(__file__).resolve().parent
LIMIT = 150_000  # bytes; reference files are committed, so they stay small


def write_reference(script, packages, tolerance, cases, **extra):
    """Write reference/<script>.json: one case per line, doubles in their shortest exact form."""
    made_by = {"script": f"validation/{script}.py", "python": platform.python_version()}
    made_by.update({name: importlib.metadata.version(name) for name in packages})
    head = {"made_by": made_by, "tolerance": tolerance, **extra}
    lines = [f"{json.dumps(k)}: {json.dumps(v, allow_nan=False)}" for k, v in head.items()]
    body = ",\n".join(json.dumps(c, allow_nan=False) for c in cases)
    text = "{\n" + ",\n".join(lines) + ',\n"cases": [\n' + body + "\n]\n}\n"
    json.loads(text)
    assert len(text) < LIMIT, f"{script}: {len(text)} bytes"
    path = HERE / "reference" / f"{script}.json"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    print(f"{path.name}: {len(cases)} cases, {len(text)} bytes")


def round_up(value, digits=2):
    """A bound printed with few digits, never below the value."""
    value = float(value)
    if value == 0.0:
        return 0.0
    text = f"{value:.{digits - 1}e}"
    if float(text) < value:
        mantissa, exponent = text.split("e")
        step = 10.0 ** (1 - digits)
        text = f"{float(mantissa) + step:.{digits - 1}f}e{exponent}"
    return float(text)
