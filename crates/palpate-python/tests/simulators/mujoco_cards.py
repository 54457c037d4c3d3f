"""The MuJoCo card between two jaws, whose positions and speeds are set before every evaluation."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np
import palpate


def mujoco_model(card: palpate.Card, *, gravity: bool = False) -> str:
    """The model of a card with two heavy jaws that slide along x, as MJCF; the inner face of each is at the position of its joint."""
    root = ET.fromstring(card.text)
    option, world = root.find("option"), root.find("worldbody")
    assert option is not None and world is not None
    body = world.find("body")
    assert body is not None
    option.set("gravity", "0 0 -9.80665" if gravity else "0 0 0")
    height = body.attrib["pos"].split()[2]
    for name, side in (("left", -1.0), ("right", 1.0)):
        jaw = ET.SubElement(world, "body", name=name, pos=f"0 0 {height}")
        ET.SubElement(jaw, "joint", name=name, type="slide", axis="1 0 0")
        ET.SubElement(jaw, "geom", type="box", size="0.05 0.2 0.2", pos=f"{side * 0.05} 0 0", mass="1e6")
    return ET.tostring(root, encoding="unicode")


def squeeze(data: Any, half: float, indentation_m: float, speed_m_per_s: float) -> None:
    """Puts both jaws at an indentation (m) of the body, whose half width is `half` (m), with a speed of it (m/s)."""
    for name, side in (("left", -1.0), ("right", 1.0)):
        data.joint(name).qpos[0] = side * (half - indentation_m)
        data.joint(name).qvel[0] = -side * speed_m_per_s


def mujoco_forces(card: palpate.Card, indentations_m: Any, speed_m_per_s: float) -> Any:
    """Mean force of the two contacts in N at indentations (m) and their speed."""
    model = mujoco.MjModel.from_xml_string(mujoco_model(card))
    data = mujoco.MjData(model)
    half = float(model.geom("palpate_body").size[0])
    forces = []
    for indentation in indentations_m:
        mujoco.mj_resetData(model, data)
        squeeze(data, half, float(indentation), speed_m_per_s)
        mujoco.mj_forward(model, data)
        total, force = 0.0, np.zeros(6)
        for contact in range(data.ncon):
            mujoco.mj_contactForce(model, data, contact, force)
            total += float(force[0])
        forces.append(0.5 * total)
    return np.array(forces)
