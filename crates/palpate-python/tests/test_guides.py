"""The Python code of the guides and of the README runs, block after block, as a reader would enter it."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import palpate
import pytest

ROOT = Path(__file__).parents[3]


def blocks(document: str) -> list[str]:
    """The blocks marked ``python``; code of software that the tests do not install is marked ``py``."""
    text = (ROOT / document).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)


def test_code_for_users_of_other_software(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    found = blocks("docs/guides/coming-from.md")
    assert len(found) > 5
    names: dict[str, object] = {}
    for block in found:
        exec(block, names)


@pytest.mark.filterwarnings("ignore:beyond the test:palpate.PalpateWarning")
def test_the_tour_of_the_readme(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    (tour,) = blocks("crates/palpate-python/README.md")
    exec(tour, {})
    # What the comment beside it says.
    printed = capsys.readouterr().out.splitlines()[0]
    assert f"# {printed}, at 95 %" in tour
    assert (tmp_path / "study/report.html").exists()


def test_the_names_of_the_guide_to_watching_are_those_of_the_observer() -> None:
    guide = (ROOT / "docs/guides/watch.md").read_text(encoding="utf-8")
    keys, meanings = zip(*re.findall(r"^\| (`[a-z_`, ]+`) \| (.*) \|$", guide, flags=re.MULTILINE), strict=True)
    named = re.findall(r"`([a-z_]+)`", " ".join(keys)) + re.findall(r"`([a-z_]*standard_error[a-z_]*)`", " ".join(meanings))
    assert len(named) > 15
    assert set(named) - {"holds"} <= set(dir(palpate.Observation))
    (block,) = blocks("docs/guides/watch.md")
    assert set(re.findall(r"(\w+)=", block)) <= set(inspect.signature(palpate.Observer).parameters)
    assert set(re.findall(r"state\.(\w+)", block)) | set(re.findall(r'\["(\w+)"\]', block)) <= set(dir(palpate.Observation))
