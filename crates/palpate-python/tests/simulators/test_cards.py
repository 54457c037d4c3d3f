"""The MuJoCo card, run: forces of its contact between two jaws, against the law."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest
from mujoco_cards import mujoco, mujoco_forces, mujoco_model, squeeze

ROOT = Path(__file__).resolve().parents[4]
BALL = ROOT / "examples/records/ball-material.toml"

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")


def stated(card: palpate.Card, before: str) -> float:
    """The number behind some words in the comments of a card."""
    words = " ".join(card.text.split())
    return float(words.partition(before)[2].split()[0])


@pytest.mark.parametrize("mass_kg", [0.05, 0.25])
def test_loading_in_mujoco_is_that_of_the_law(mass_kg: float) -> None:
    material = palpate.Material.read(BALL)
    card = palpate.export(material, "mujoco", mass_kg=mass_kg, friction=0.6)
    assert card.loading_error is not None and card.loading_error < 0.02
    document = card.to_dict()
    depth, share = document["depth_m"], document["contact_displacement_m"] / document["depth_m"]
    worst = 0.0
    for speed in np.geomspace(document["slowest_m_per_s"], document["fastest_m_per_s"], 5):
        depths = np.linspace(1 / 60, 1.0, 60) * depth
        law = material.predict([{"to": f"{depth!r} m", "rate": f"{float(speed)!r} m/s"}], at_s=depths / speed).force_n
        forces = mujoco_forces(card, share * depths, share * float(speed))
        worst = max(worst, float(np.max(np.abs(forces - law))) / card.peak_force_n)
    assert worst == pytest.approx(card.loading_error, abs=5e-4)


BALL_2 = ({"shape": "ball", "radius": "35 mm"}, "28 kPa", 2, "20 /s")
BLOCK_3 = ({"shape": "block", "area": "10 cm^2", "length": "40 mm"}, "100 kPa", 3, "2000 /s")


@pytest.mark.parametrize(("body", "modulus", "exponent", "rate"), [BALL_2, BLOCK_3], ids=["ball", "block"])
def test_a_card_has_the_widest_range_of_speeds_that_it_fits(body: dict[str, Any], modulus: str, exponent: int, rate: str) -> None:
    model = {"specimen": {**body, "modulus": modulus}, "law": {"name": "latency", "exponent": exponent, "rate_coefficient": rate}}
    steps = [{"to": to, "rate": "500 mm/min", "hold": "60 s"} for to in ("4 mm", "8 mm")]
    made = palpate.simulate({**model, "step": steps})
    record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
    material = record.calibrate(test={"specimen": body}, law=f"latency:{exponent}", alternatives=[]).material
    card = palpate.export(material, "mujoco", mass_kg=0.25)
    document = card.to_dict()
    share = document["slowest_m_per_s"] / document["fastest_m_per_s"]
    assert card.loading_error is not None and card.loading_error < 0.02
    assert share == pytest.approx(0.8 if body is BALL_2[0] else 0.9)
    # What is wider has a larger error, and states it.
    wider = palpate.export(material, "mujoco", mass_kg=0.25, slowest_m_per_s=0.5 * document["fastest_m_per_s"])
    assert wider.loading_error is not None and wider.loading_error > 0.02


def test_the_hold_in_mujoco_does_not_relax_as_the_card_states() -> None:
    card = palpate.export(BALL, "mujoco", mass_kg=0.25)
    document = card.to_dict()
    held = mujoco_forces(card, [document["contact_displacement_m"]], 0.0)[0]
    for row in document["hold"]:
        assert held == pytest.approx(row["card_force_n"], rel=1e-3)


def test_a_body_in_a_grip_stays_there() -> None:
    """Integrated with gravity at half of the largest stable step that the card states: it stays, and creeps as slowly as stated."""
    card = palpate.export(BALL, "mujoco", mass_kg=0.25, friction=0.6)
    model = mujoco.MjModel.from_xml_string(mujoco_model(card, gravity=True))
    model.opt.timestep = 0.5 * stated(card, "Time steps above")
    data = mujoco.MjData(model)
    indentation, heights = card.to_dict()["contact_displacement_m"], []
    for _ in range(int(4.0 / model.opt.timestep)):
        squeeze(data, indentation, 0.0)
        mujoco.mj_step(model, data)
        heights.append(float(data.body("palpate_body").xpos[2]))
    assert abs(data.body("palpate_body").xpos[0]) < 1e-6
    half = len(heights) // 2
    creep_mm_per_min = 60e3 * (heights[half] - heights[-1]) / ((len(heights) - 1 - half) * model.opt.timestep)
    assert creep_mm_per_min == pytest.approx(stated(card, "the body creeps by"), rel=0.05)
    assert creep_mm_per_min < 0.2
