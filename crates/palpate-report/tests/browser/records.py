"""Records as tests of pages need them: synthetic, seeded, with the names that people and attackers give."""

from __future__ import annotations

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
