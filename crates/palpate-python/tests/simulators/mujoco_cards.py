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


def squeeze(data: Any, indentation_m: float, speed_m_per_s: float) -> None:
    """Puts both jaws at an indentation (m) of the body with a speed of it (m/s); their joints are at 0 where they touch it."""
    for name, way in (("palpate_left_jaw", 1.0), ("palpate_right_jaw", -1.0)):
        data.joint(name).qpos[0] = way * indentation_m
        data.joint(name).qvel[0] = way * speed_m_per_s


def mujoco_forces(card: palpate.Card, indentations_m: Any, speed_m_per_s: float) -> Any:
    """Mean force of the two contacts in N at indentations (m) and their speed."""
    model = mujoco.MjModel.from_xml_string(mujoco_model(card))
    data = mujoco.MjData(model)
    forces = []
    for indentation in indentations_m:
        mujoco.mj_resetData(model, data)
        squeeze(data, float(indentation), speed_m_per_s)
        mujoco.mj_forward(model, data)
        total, force = 0.0, np.zeros(6)
        for contact in range(data.ncon):
            mujoco.mj_contactForce(model, data, contact, force)
            total += float(force[0])
        forces.append(0.5 * total)
    return np.array(forces)
