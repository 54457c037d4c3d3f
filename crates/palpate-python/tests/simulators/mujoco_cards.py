"""The MuJoCo card, run: positions and speeds of its jaws are set before every evaluation."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

import numpy as np
import palpate
import pytest

# Its functions are compiled: checkers of types know none of them.
mujoco: Any = pytest.importorskip("mujoco")


def mujoco_model(card: palpate.Card, *, gravity: bool = False) -> str:
    """The model of a card, with gravity or without."""
    root = ET.fromstring(card.text)
    option = root.find("option")
    assert option is not None
    option.set("gravity", "0 0 -9.80665" if gravity else "0 0 0")
    return ET.tostring(root, encoding="unicode")


def jaws(model: Any) -> list[tuple[str, float]]:
    """The jaws of a card with the direction in which each closes: two, or one where the back of the body is held."""
    names = {"palpate_left_jaw": 1.0, "palpate_right_jaw": -1.0, "palpate_jaw": 1.0}
    return [(name, way) for name, way in names.items() if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) >= 0]


def squeeze(model: Any, data: Any, indentation_m: float, speed_m_per_s: float) -> None:
    """Puts the jaws at an indentation (m) of the body with a speed of it (m/s); their joints are at 0 where they touch it."""
    for name, way in jaws(model):
        data.joint(name).qpos[0] = way * indentation_m
        data.joint(name).qvel[0] = way * speed_m_per_s


def contact_force(model: Any, data: Any) -> float:
    """Mean force of the jaws in N."""
    total, force = 0.0, np.zeros(6)
    for contact in range(data.ncon):
        mujoco.mj_contactForce(model, data, contact, force)
        total += float(force[0])
    return total / len(jaws(model))


def mujoco_forces(card: palpate.Card, indentations_m: Any, speed_m_per_s: float, *, xml: str | None = None) -> Any:
    """Mean force of a jaw in N at indentations (m) and their speed, of a card or of its model as it was changed."""
    model = mujoco.MjModel.from_xml_string(xml or mujoco_model(card))
    data = mujoco.MjData(model)
    forces = []
    for indentation in indentations_m:
        mujoco.mj_resetData(model, data)
        squeeze(model, data, float(indentation), speed_m_per_s)
        mujoco.mj_forward(model, data)
        forces.append(contact_force(model, data))
    return np.array(forces)
