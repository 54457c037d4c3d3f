"""What the installed package brings beside its code."""

from __future__ import annotations

import doctest
import tomllib
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from typing import Any, get_args

import palpate
import pytest
from palpate import _palpate
from palpate._options import Intervals, LawName, Loss, Missing, Noise, Response

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


def test_the_package_says_what_it_offers() -> None:
    assert palpate.__version__ == distribution("palpate").version
    offered = {name for name in dir(palpate) if not name.startswith("_")}
    assert offered == set(palpate.__all__)
    assert all(hasattr(palpate, name) for name in dir(palpate))


def compiled_examples() -> Iterator[Any]:
    for name, found in vars(_palpate).items():
        members = vars(found).items() if isinstance(found, type) else ()
        for place, one in [(name, found), *((f"{name}.{member}", one) for member, one in members)]:
            if ">>>" in (text := getattr(one, "__doc__", None) or ""):
                yield pytest.param(place, text, id=place)


@pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")
@pytest.mark.parametrize(("place", "text"), list(compiled_examples()))
def test_examples_of_the_compiled_part_are_true(place: str, text: str) -> None:
    """No tool finds them there: one had lost its import, another its number."""
    example = doctest.DocTestParser().get_doctest(text, {}, place, None, 0)
    assert doctest.DocTestRunner().run(example).failed == 0


def test_the_oldest_versions_that_are_declared_are_tested(root: Path) -> None:
    package = root / "crates/palpate-python"
    project = tomllib.loads((package / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    declared = [*project["dependencies"], *(one for extra in project["optional-dependencies"].values() for one in extra)]
    tested = (package / "tests/requirements-oldest.in").read_text(encoding="utf-8").split()
    whole = [one.replace(">=", "==") + ".0" * (2 - one.count(".")) for one in declared]
    assert [one for one in whole if one not in tested] == []


def words_of(option: str) -> dict[str, Any]:
    return {option: "nothing"}


@pytest.mark.parametrize(
    ("option", "words"), [("response", Response), ("loss", Loss), ("noise", Noise), ("intervals", Intervals), ("nan", Missing)]
)
def test_the_words_of_options_are_those_of_the_compiled_part(option: str, words: Any) -> None:
    with pytest.raises(palpate.OptionError) as caught:
        palpate.fit_hold([0.0], [0.0], **words_of(option))
    known = str(caught.value).partition("one of ")[2].partition(", found")[0]
    assert known.split(", ") == [f'"{word}"' for word in get_args(words)]


def test_the_laws_that_editors_offer_are_laws() -> None:
    offered = set(get_args(get_args(LawName)[0]))
    assert {name for name in palpate.laws.names() if ":" not in name} <= offered
    for law in offered - {"spectrum"}:
        with pytest.raises(palpate.FitError):
            palpate.fit_hold([], [], law=law, response="creep" if law == "kelvin-voigt" else "relaxation")
