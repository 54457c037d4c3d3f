"""The MuJoCo card, run: forces of its contact between two jaws, against the law."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import palpate
import pytest
from mujoco_cards import contact_force, jaws, mujoco, mujoco_forces, mujoco_model, squeeze

ROOT = Path(__file__).resolve().parents[4]
BALL = ROOT / "examples/records/ball-material.toml"

pytestmark = pytest.mark.filterwarnings("ignore::palpate.PalpateWarning")


def stated(card: palpate.Card, before: str) -> float:
    """The number behind some words in the comments of a card."""
    words = " ".join(card.text.split())
    return float(words.partition(before)[2].split()[0])


def calibrated(specimen: dict[str, Any], modulus: str, exponent: float, rate: str, *, sides: str | None = None) -> palpate.Material:
    """A body whose parameters are known: simulated, then calibrated."""
    contact = {"contact": {"squeezed_from": sides}} if sides else {}
    steps = [{"to": to, "rate": "500 mm/min", "hold": "60 s"} for to in ("4 mm", "8 mm")]
    law = {"name": "latency", "exponent": exponent, "rate_coefficient": rate}
    made = palpate.simulate({"specimen": {**specimen, "modulus": modulus}, "law": law, "step": steps, **contact})
    record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
    return record.calibrate(test={"specimen": specimen, **contact}, law=f"latency:{exponent}", alternatives=[]).material


def largest_error(material: palpate.Material, card: palpate.Card) -> float:
    """Largest error of a card in its scene, as a share of the peak force, at many more depths than it was fitted to."""
    document = card.to_dict()
    depth, share = document["depth_m"], document["contact_displacement_m"] / document["depth_m"]
    worst = 0.0
    for speed in np.geomspace(document["slowest_m_per_s"], document["fastest_m_per_s"], 5):
        depths = np.linspace(1 / 60, 1.0, 1200) * depth
        law = material.predict([{"to": f"{depth!r} m", "rate": f"{float(speed)!r} m/s"}], at_s=depths / speed).force_n
        forces = mujoco_forces(card, share * depths, share * float(speed))
        worst = max(worst, float(np.max(np.abs(forces - law))) / card.peak_force_n)
    return worst


@pytest.mark.parametrize("mass_kg", [0.05, 0.25])
def test_loading_in_mujoco_is_that_of_the_law(mass_kg: float) -> None:
    material = palpate.Material.read(BALL)
    card = palpate.export(material, "mujoco", mass_kg=mass_kg, friction=0.6)
    assert card.loading_error is not None and card.loading_error < 0.02
    assert largest_error(material, card) == pytest.approx(card.loading_error, abs=5e-4)


BLOCK: dict[str, Any] = {"shape": "block", "area": "12 cm^2", "length": "60 mm"}
PAD: dict[str, Any] = {"shape": "pad", "radius": "40 mm", "thickness": "25 mm"}


@pytest.mark.parametrize(("specimen", "sides", "count"), [(BLOCK, None, 1), (PAD, None, 1), (BLOCK, "two sides", 2)])
def test_the_scene_of_a_card_has_the_jaws_that_its_body_is_squeezed_by(specimen: dict[str, Any], sides: str | None, count: int) -> None:
    """A body squeezed from one side is held at its back: between two jaws its force would be that of two contacts in series."""
    material = calibrated(specimen, "28 kPa", 5, "20000 /s", sides=sides)
    # A small depth, whose narrow first peak of the error is found too.
    for depth_m in (0.003, 0.008):
        card = palpate.export(material, "mujoco", mass_kg=0.2, depth_m=depth_m)
        model = mujoco.MjModel.from_xml_string(mujoco_model(card))
        assert len(jaws(model)) == count == len(model.pair_geom1)
        assert card.loading_error is not None
        assert largest_error(material, card) == pytest.approx(card.loading_error, rel=0.02, abs=5e-4)


@pytest.mark.parametrize("mass_kg", [0.005, 0.2])
def test_a_body_squeezed_from_one_side_gave_way_the_more_the_lighter_it_was(mass_kg: float) -> None:
    material = calibrated(BLOCK, "28 kPa", 5, "20000 /s")
    card = palpate.export(material, "mujoco", mass_kg=mass_kg)
    actuator = '<actuator><position joint="palpate_jaw" kp="5e6" kv="1e5"/></actuator></mujoco>'
    model = mujoco.MjModel.from_xml_string(mujoco_model(card, gravity=True).replace("</mujoco>", actuator))
    model.opt.timestep, model.opt.integrator = 5e-4, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    data = mujoco.MjData(model)
    document = card.to_dict()
    while data.time < 2 * document["depth_m"] / document["fastest_m_per_s"] + 1.0:
        data.ctrl[0] = min(document["depth_m"], 0.5 * document["fastest_m_per_s"] * data.time)
        mujoco.mj_step(model, data)
    travel = float(data.joint("palpate_jaw").qpos[0])
    pushed_back = float(data.body("palpate_body").xpos[0])
    assert travel == pytest.approx(document["depth_m"], abs=2e-5) and 0 < pushed_back < 1e-4 * travel
    held = mujoco_forces(card, [travel], 0.0)[0]
    assert contact_force(model, data) == pytest.approx(held, rel=5e-3)
    # The force does not depend on the mass that the card is for, but for what the contact itself would move.
    heavy = mujoco_forces(palpate.export(material, "mujoco", mass_kg=10.0), [travel], 0.0)[0]
    assert held == pytest.approx(heavy, rel=1e-3)


@pytest.mark.parametrize("jaw_kg", [0.25, 1.0])
@pytest.mark.parametrize("is_free", [False, True], ids=["on a slide", "free"])
def test_the_factor_for_light_jaws_gives_the_force_of_heavy_ones(jaw_kg: float, is_free: bool) -> None:
    mass_kg = 0.25
    card = palpate.export(BALL, "mujoco", mass_kg=mass_kg)
    words = " ".join(card.text.split())
    assert "multiply both numbers of solref by 0.250 (w1 + w2), with w from model.body_invweight0[id][0]" in words
    assert "it is 1/M where model.body_simple[id] is 2" in words
    factor = 1 + mass_kg / (jaw_kg if is_free else 3 * jaw_kg)

    def scaled(by: float) -> str:
        root = ET.fromstring(mujoco_model(card))
        pair = root.find("default/default/pair")
        assert pair is not None
        pair.set("solref", " ".join(repr(by * float(number)) for number in pair.attrib["solref"].split()))
        for body in root.findall("worldbody/body"):
            if body.get("name") == "palpate_body":
                continue
            geom = body.find("geom")
            assert geom is not None
            geom.set("mass", repr(jaw_kg))
            for axis in ("0 1 0", "0 0 1") if is_free else ():
                ET.SubElement(body, "joint", type="slide", axis=axis)
        return ET.tostring(root, encoding="unicode")

    model = mujoco.MjModel.from_xml_string(scaled(1.0))
    inverse = {name: float(model.body(name).invweight0[0]) for name in ("palpate_body", "palpate_left_jaw")}
    # What the card refers to for any other body.
    assert mass_kg * sum(inverse.values()) == pytest.approx(factor, rel=1e-6)
    document = card.to_dict()
    speed = document["contact_displacement_m"] / document["depth_m"] * document["fastest_m_per_s"]
    places = np.linspace(0.2, 1.0, 5) * document["contact_displacement_m"]
    heavy = mujoco_forces(card, places, speed)
    corrected = mujoco_forces(card, places, speed, xml=scaled(factor))
    assert corrected == pytest.approx(heavy, rel=0.03)
    # Without it the force is too small, by more than that tolerance.
    assert (mujoco_forces(card, places, speed, xml=scaled(1.0)) < 0.97 * heavy).all()


@pytest.mark.parametrize(("axis", "w_of_m"), [("1 0 0", 1.0), ("0.6 0.8 0", 1 / 3)], ids=["along an axis", "oblique"])
def test_the_factor_is_that_of_the_compiled_model_and_not_of_the_masses(axis: str, w_of_m: float) -> None:
    """Cards stated 1 + m/(3 M) for any jaw on one slide joint; with its centre of mass at its origin a third of the force was missing."""
    mass_kg = jaw_kg = 0.25
    card = palpate.export(BALL, "mujoco", mass_kg=mass_kg)
    found = ET.fromstring(card.text).find("default/default/pair")
    assert found is not None
    solref = [float(number) for number in found.attrib["solref"].split()]
    # The box is turned, so that its face is across the axis.
    turned = "0" if axis == "1 0 0" else "53.13010235415598"

    def model(factor: float) -> Any:
        scaled = " ".join(repr(factor * number) for number in solref)
        fingers = "".join(
            f"""<body name="{name}" pos="{' '.join(str(sign * 0.045 * float(part)) for part in axis.split())}">
            <joint name="{name}" type="slide" axis="{axis}" range="-1 1"/>
            <geom name="{name}" type="box" size="0.01 0.06 0.06" euler="0 0 {turned}" mass="{jaw_kg}"/></body>"""
            for name, sign in (("left", -1), ("right", 1))
        )
        pairs = "".join(
            f'<pair geom1="ball" geom2="{name}" solref="{scaled}" solreffriction="{found.get("solreffriction")}" '
            f'solimp="{found.get("solimp")}" condim="4"/>'
            for name in ("left", "right")
        )
        drives = "".join(f'<position joint="{name}" kp="1e6" kv="{2 * (1e6 * jaw_kg) ** 0.5}"/>' for name in ("left", "right"))
        return mujoco.MjModel.from_xml_string(
            f"""<mujoco><option cone="elliptic" impratio="1000000" timestep="2e-4" gravity="0 0 0" integrator="implicitfast"/>
            <compiler angle="degree"/><worldbody><body name="ball"><freejoint/><geom name="ball" type="sphere" size="0.035" mass="{mass_kg}"/></body>
            {fingers}</worldbody><contact>{pairs}</contact><actuator>{drives}</actuator></mujoco>"""
        )

    def held(factor: float) -> float:
        compiled = model(factor)
        data, force = mujoco.MjData(compiled), np.zeros(6)
        while data.time < 2.5:
            push = min(0.005, 0.004 * data.time)
            data.ctrl[:] = push, -push
            mujoco.mj_step(compiled, data)
        assert data.ncon == 2
        mujoco.mj_contactForce(compiled, data, 0, force)
        return float(force[0])

    compiled = model(1.0)
    w = [float(compiled.body_invweight0[compiled.body(name).id][0]) for name in ("ball", "left")]
    assert w == pytest.approx([1 / mass_kg, w_of_m / jaw_kg])
    assert (compiled.body_simple[compiled.body("left").id] == 2) == (w_of_m == 1.0)
    heavy = mujoco_forces(card, np.array([0.005]), 0.0)[0]
    assert held(mass_kg * sum(w)) == pytest.approx(heavy, rel=1e-2)
    assert held(1.0) < 0.8 * heavy


BALL_2 = ({"shape": "ball", "radius": "35 mm"}, "28 kPa", 2, "20 /s")
BLOCK_3 = ({"shape": "block", "area": "10 cm^2", "length": "40 mm"}, "100 kPa", 3, "2000 /s")


@pytest.mark.parametrize(("body", "modulus", "exponent", "rate"), [BALL_2, BLOCK_3], ids=["ball", "block"])
def test_a_card_has_the_widest_range_of_speeds_that_it_fits(body: dict[str, Any], modulus: str, exponent: int, rate: str) -> None:
    material = calibrated(body, modulus, exponent, rate)
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
        squeeze(model, data, indentation, 0.0)
        mujoco.mj_step(model, data)
        heights.append(float(data.body("palpate_body").xpos[2]))
    assert abs(data.body("palpate_body").xpos[0]) < 1e-6
    half = len(heights) // 2
    creep_mm_per_min = 60e3 * (heights[half] - heights[-1]) / ((len(heights) - 1 - half) * model.opt.timestep)
    assert creep_mm_per_min == pytest.approx(stated(card, "the body creeps by"), rel=0.05)
    assert creep_mm_per_min < 0.2
