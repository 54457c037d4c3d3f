"""Cards of other simulators: the same as the command's, well formed, with errors that hold."""

from __future__ import annotations

import ast
import json
import math
import pickle
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any, get_args

import palpate
import pytest
from conftest import ROOT
from palpate._options import Engine

BALL = "examples/records/ball-material.toml"
ENGINES: tuple[Engine, ...] = get_args(Engine)
LOAD: dict[str, Any] = {"mass_kg": 0.25}

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")


@pytest.fixture(autouse=True)
def _in_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    """Documents name their files as they were given."""
    monkeypatch.chdir(ROOT)


def command(engine: str, *flags: str) -> str:
    arguments = [sys.executable, "-m", "palpate", "export", engine, BALL, "--mass", "250g", *flags]
    return subprocess.run(arguments, capture_output=True, check=True).stdout.decode()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_card_is_that_of_the_command(engine: Engine, tmp_path: Path) -> None:
    card = palpate.export(BALL, engine, **LOAD)
    assert card.to_json() == command(engine, "--format", "json")
    assert card.text == str(card) == card.to_dict()["text"] == command(engine)
    card.write(tmp_path / "card")
    assert (tmp_path / "card").read_text(encoding="utf-8") == card.text
    assert pickle.loads(pickle.dumps(card)) == card


def test_every_option_is_that_of_the_command() -> None:
    keywords: dict[str, Any] = {
        **{"depth_m": 0.012, "speed_m_per_s": 0.01, "mass_kg": 0.25},
    }
    flags = ["--depth", "12 mm", "--speed", "10 mm/s", "--format", "json"]
    of_continua = ["--hold", "30 s", "--poisson-ratio", "0.4", "--terms-per-decade", "3"]
    of_contacts = ["--slowest", "4 mm/s", "--friction", "0.6"]
    abaqus = palpate.export(BALL, "abaqus", **keywords, hold_s=30.0, poisson_ratio=0.4, terms_per_decade=3.0)
    assert abaqus.to_json() == command("abaqus", *flags, *of_continua)
    drake = palpate.export(BALL, "drake", **keywords, slowest_m_per_s=0.004, friction=0.6)
    assert drake.to_json() == command("drake", *flags, *of_contacts)


@pytest.mark.parametrize("engine", ["mujoco", "drake", "febio"])
def test_xml_is_well_formed(engine: Engine) -> None:
    card = palpate.export(BALL, engine, **LOAD)
    found = ET.fromstring(card.text)
    assert found.tag == {"mujoco": "mujoco", "drake": "sdf", "febio": "febio_spec"}[engine]
    if engine == "mujoco":
        pair = found.find("default/default/pair")
        assert pair is not None
        stiffness, damping = map(float, pair.attrib["solref"].split())
        expected = card.parameters["solref_stiffness_per_s2"], card.parameters["solref_damping_per_s"]
        assert (-stiffness, -damping) == pytest.approx(expected, rel=1e-9)
    if engine == "drake":
        names = {"{http://drake.mit.edu}" + name for name in ("point_contact_stiffness", "hydroelastic_modulus")}
        values = {tag.tag: float(tag.text or "nan") for tag in found.iter() if tag.tag in names}
        assert values["{http://drake.mit.edu}hydroelastic_modulus"] == pytest.approx(card.parameters["hydroelastic_modulus_pa"], rel=1e-9)
        assert len(values) == 2


@pytest.mark.parametrize("engine", ["newton", "felupe"])
def test_python_is_python(engine: Engine) -> None:
    tree = ast.parse(palpate.export(BALL, engine, **LOAD).text)
    assert any(isinstance(node, ast.Import) and node.names[0].name == engine for node in tree.body)


def test_a_prony_series_is_the_hold() -> None:
    material = palpate.Material.read(BALL)
    card = palpate.export(material, "abaqus")
    # The depth and the speed of the test.
    range_ = material.calibration_range
    step = {"to": f"{range_['deepest_m']!r} m", "rate": f"{range_['fastest_m_per_s']!r} m/s", "hold": "60 s"}
    start = range_["deepest_m"] / range_["fastest_m_per_s"]
    times = [start + 60 * 10 ** (-k / 4) for k in range(16, -1, -1)]
    predicted = material.predict([step], at_s=[start, *times])
    remaining = 1 - sum(share for share, _ in card.prony)
    for time, force in zip(times, predicted.force_n[1:], strict=True):
        found = remaining + sum(share * math.exp(-(time - start) / tau) for share, tau in card.prony)
        assert found == pytest.approx(force / predicted.force_n[0], abs=2e-4)
    assert card.peak_force_n == pytest.approx(predicted.force_n[0], rel=1e-9)


def test_notes_are_warnings() -> None:
    with pytest.warns(palpate.PalpateWarning, match="beyond the test: the longest hold lasts 60.0 s"):
        palpate.export(BALL, "drake")
    with pytest.warns(palpate.PalpateWarning, match="the contact of PhysX has an error of up to"):
        palpate.export(BALL, "physx")


def test_bad_input_is_refused() -> None:
    with pytest.raises(palpate.OptionError, match='engine is one of "mujoco", .*, found "unity"'):
        palpate.export(BALL, "unity")  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    with pytest.raises(palpate.OptionError, match="a card for MuJoCo needs mass"):
        palpate.export(BALL, "mujoco")
    with pytest.raises(palpate.OptionError, match="expected a Material or the path of its file, found int"):
        palpate.export(7, "drake")  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    with pytest.raises(palpate.OptionError):
        palpate.export("examples/records/ball.toml", "drake")
    # The hint is a keyword as it is given.
    below = r"contact displacement must stay below the radius(.|\n)*hint: the test went to 15\.0 mm: depth_m=0\.015$"
    with pytest.raises(palpate.ModelError, match=below):
        palpate.export(BALL, "mujoco", mass_kg=0.2, depth_m=15)
    with pytest.raises(palpate.OptionError, match=r"friction is for engines of contacts, and the engine is febio\nhint: leave friction out"):
        palpate.export(BALL, "febio", friction=0.5)
    for keywords in ({"hold_s": 0.0}, {"speed_m_per_s": math.nan}, {"depth_m": -1.0}, {"mass_kg": math.inf}, {"friction": -0.1}):
        with pytest.raises(palpate.OptionError):
            palpate.export(BALL, "drake", **keywords)
    assert json.loads(palpate.export(BALL, "isaac").to_json())["engine"] == "isaac"
