"""Records that several tests use."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def root() -> Path:
    """Folder of the repository."""
    return ROOT


@pytest.fixture
def example() -> Path:
    """The example record of the README."""
    return ROOT / "examples" / "records" / "ball-steps.csv"


def relaxation(samples: int = 400, noise: float = 0.0, seed: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A hold of the latency law with n = 5, l = 0.5/s, y_e = 0.2, D = 0.1."""
    t = np.linspace(0.0, 40.0, samples)
    y = 0.2 + 0.1 * (1 + 2 * t) ** -0.25
    return t, y + np.random.default_rng(seed).normal(0.0, noise, samples) if noise else y
