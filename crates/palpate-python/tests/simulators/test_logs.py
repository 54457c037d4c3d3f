"""Logs of ROS 2 that palpate writes, read by other software: `rosbags` and, where it is installed, the `mcap` packages."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rosbags")

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture(scope="module")
def logs() -> Any:
    """The module `validation/simulators/logs.py`."""
    spec = importlib.util.spec_from_file_location("validation_of_logs", ROOT / "validation/simulators/logs.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    # Its dataclasses look for it there.
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_rosbags_reads_every_log_to_the_bit(logs: Any, tmp_path: Path) -> None:
    results = logs.compared(tmp_path, readers=["rosbags"])
    assert {result.command for result in results} == {"simulate", "predict", "watch"}
    for result in results:
        assert result.numbers > 1000 and result.differing == 0, result


def test_a_log_of_another_motion_would_be_found(logs: Any, tmp_path: Path) -> None:
    log, table = logs.simulated(tmp_path)
    other = tmp_path / "other.mcap"
    protocol = (tmp_path / "squeeze.toml").read_text(encoding="utf-8").replace("10 mm", "10.001 mm")
    (tmp_path / "other.toml").write_text(protocol, encoding="utf-8")
    logs.palpate(tmp_path, "simulate", "other.toml", "--out", other.name)
    assert logs.differing(logs.read_with_rosbags(log), table) == 0
    assert logs.differing(logs.read_with_rosbags(other), table) > 0
