"""The Python code of the guides runs, block after block, as a reader would enter it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def blocks(guide: str) -> list[str]:
    """The blocks marked ``python``; code of software that the tests do not install is marked ``py``."""
    text = (ROOT / "docs" / "guides" / guide).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)


def test_code_for_users_of_other_software(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    found = blocks("coming-from.md")
    assert len(found) > 5
    names: dict[str, object] = {}
    for block in found:
        exec(block, names)
