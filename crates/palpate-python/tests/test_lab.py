"""The lab is in the package too: the command of `python -m palpate`."""

from __future__ import annotations

import signal
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest


def test_the_lab_is_in_the_package(tmp_path: Path) -> None:
    (tmp_path / "press.csv").write_text("Time (s),Force (N)\n0,1\n1,2\n")
    words = [sys.executable, "-m", "palpate", "lab", str(tmp_path), "--no-open"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as lab:
        assert lab.stdout is not None
        address = lab.stdout.readline().strip()
        with urllib.request.urlopen(address + "api/folder") as answer:
            assert b'"name":"press.csv"' in answer.read()
        with pytest.raises(urllib.error.HTTPError, match="404") as refused:
            urllib.request.urlopen("/".join(address.split("/")[:3]))
        refused.value.close()
        lab.send_signal(signal.SIGINT)
        assert lab.wait(10) != 0
    assert [entry.name for entry in tmp_path.iterdir()] == ["press.csv"]
