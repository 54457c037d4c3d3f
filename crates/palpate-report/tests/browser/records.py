"""Records as tests of pages need them: synthetic, seeded, with the names that people and attackers give."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np

HOSTILE = "\"><img src=x onerror=alert(1)><script>alert(2)<" + "/script>"


def steps(levels_mm: list[float], hold_s: float, rate_hz: float, seed: int) -> np.ndarray:
    """A body that relaxes by the latency law with n = 5 after every step: time, displacement, force with noise."""
    noise = np.random.default_rng(seed)
    rows, start, before = [], 0.0, 0.0
    for level in levels_mm:
        ramp = np.arange(0.0, 1.0, 1.0 / rate_hz)
        hold = np.arange(0.0, hold_s, 1.0 / rate_hz)
        excess = 0.25 * (level - before)
        relaxed = level + excess * (1.0 + 4.0 * 0.8 * hold) ** -0.25
        rows.append(np.c_[start + ramp, before + (level - before) * ramp, before + (level + excess - before) * ramp])
        rows.append(np.c_[start + 1.0 + hold, np.full(hold.size, level), relaxed])
        start, before = start + 1.0 + hold_s, level
    table = np.concatenate(rows)
    table[:, 2] += 0.004 * noise.standard_normal(len(table))
    return table


def write(path: Path, table: np.ndarray) -> Path:
    header = "Time (s),Displacement (mm),Force (N)"
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.5f")
    return path


def write_mcap(path: Path, table: np.ndarray) -> Path:
    """The same as a robot logs it: messages of one topic in JSON, whose numbers have no units (mcap.dev/spec)."""

    def text(content: str) -> bytes:
        return struct.pack("<I", len(content)) + content.encode()

    def record(kind: int, body: bytes) -> bytes:
        return bytes([kind]) + struct.pack("<Q", len(body)) + body

    magic = b"\x89MCAP0\r\n"
    parts = [magic, record(0x01, text("") + text("by hand"))]
    parts.append(record(0x03, struct.pack("<H", 1) + text("press") + text("jsonschema") + text('{"type":"object"}')))
    parts.append(record(0x04, struct.pack("<HH", 1, 1) + text("/press") + text("json") + struct.pack("<I", 0)))
    for number, (time_s, displacement_mm, force_n) in enumerate(table):
        at_ns = 1_700_000_000_000_000_000 + int(time_s * 1e9)
        message = json.dumps({"displacement": displacement_mm, "force": force_n}).encode()
        parts.append(record(0x05, struct.pack("<HIQQ", 1, number, at_ns, at_ns) + message))
    parts += [record(0x0F, struct.pack("<I", 0)), record(0x02, struct.pack("<QQI", 0, 0, 0)), magic]
    path.write_bytes(b"".join(parts))
    return path
