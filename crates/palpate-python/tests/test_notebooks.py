"""The notebooks run from end to end, are kept without output, and their code is typed."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

FOLDER = ROOT / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def cells(notebook: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return found


def code(notebook: Path) -> str:
    return "\n\n".join("".join(cell["source"]) for cell in cells(notebook) if cell["cell_type"] == "code") + "\n"


def test_none_is_missing() -> None:
    assert [notebook.stem for notebook in NOTEBOOKS] == ["gallery", "many_curves", "paper", "relaxation_test", "will_it_hold"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_it_is_kept_without_output(notebook: Path) -> None:
    for cell in cells(notebook):
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [] and cell["execution_count"] is None


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda notebook: notebook.stem)
def test_it_runs(notebook: Path) -> None:
    script = "import matplotlib\nmatplotlib.use('Agg')\n" + code(notebook)
    ran = subprocess.run([sys.executable, "-W", "error::DeprecationWarning", "-c", script], cwd=FOLDER, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr


def test_their_code_is_typed(tmp_path: Path) -> None:
    for notebook in NOTEBOOKS:
        (tmp_path / f"{notebook.stem}.py").write_text(code(notebook), encoding="utf-8")
    for checker in (["mypy", "--strict"], ["pyright", "--pythonpath", sys.executable]):
        ran = subprocess.run([sys.executable, "-m", *checker, "."], cwd=tmp_path, capture_output=True, text=True)
        assert ran.returncode == 0, f"{checker}\n{ran.stdout}{ran.stderr}"
