"""What the installed package brings beside its code."""

from __future__ import annotations

from importlib.metadata import distribution
from pathlib import Path

import pytest

LICENCES = {
    "LICENSE-MIT": "LICENSE-MIT",
    "LICENSE-APACHE": "LICENSE-APACHE",
    "OFL.txt": "crates/palpate-report/fonts/OFL.txt",
    "THIRD-PARTY-LICENSES": "crates/palpate-python/THIRD-PARTY-LICENSES",
}


@pytest.mark.parametrize(("name", "source"), LICENCES.items())
def test_the_wheel_holds_the_licences_of_its_content(root: Path, name: str, source: str) -> None:
    package = distribution("palpate")
    assert name in (package.metadata.get_all("License-File") or [])
    assert package.read_text(f"licenses/{name}") == (root / source).read_text(encoding="utf-8")
