"""Cards of `palpate export`, run: MuJoCo, Drake and FElupe where they are installed, the text of the others evaluated.

    pip install mujoco drake felupe
    python validation/simulators/cards.py > page.md

Each contact is driven at prescribed depth and speed, and its force compared with `Material.predict`, the law that the card was fitted to.
Prony cards are read back from their text; that of FElupe is a cube that is compressed and held.
"""

from __future__ import annotations

import importlib.util
import math
import re
import sys
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import palpate

ROOT = Path(__file__).resolve().parents[2]
# The harness of MuJoCo is that of the tests.
sys.path.insert(0, str(ROOT / "crates/palpate-python/tests/simulators"))
MASS_KG = 0.25
HOLD_TIMES_S = (1.0, 10.0, 60.0)
# What the tables of contacts and of continua show.
CONTACTS = ("mujoco", "drake", "physx", "isaac", "newton")
CONTINUA = ("abaqus", "openradioss", "febio", "felupe")


def materials() -> dict[str, palpate.Material]:
    """The example, and bodies whose parameters are known: simulated, then calibrated."""
    found = {"ball, n = 5.04 (calibrated)": palpate.Material.read(ROOT / "examples/records/ball-material.toml")}
    ball = {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}
    block = {"shape": "block", "area": "10 cm^2", "length": "40 mm", "modulus": "100 kPa"}
    for name, specimen, exponent, rate in [("ball, n = 2", ball, 2, "20 /s"), ("block, n = 3", block, 3, "2000 /s")]:
        steps = [{"to": to, "rate": "500 mm/min", "hold": "60 s"} for to in ("4 mm", "8 mm")]
        law = {"name": "latency", "exponent": exponent, "rate_coefficient": rate}
        made = palpate.simulate({"specimen": specimen, "law": law, "step": steps})
        record = palpate.Record.from_arrays(time_s=made.time_s, displacement_m=made.displacement_m, force_n=made.force_n)
        test = {"specimen": {key: value for key, value in specimen.items() if key != "modulus"}}
        found[name] = record.calibrate(test=test, law=f"latency:{exponent}", alternatives=[]).material
    return found


# Drake: the body of the card fixed to the world, one jaw on a slide.


def surface(root: ET.Element) -> float:
    """Where the surface of the body is, m from its centre: the mesh of a pressure field has a radius that is 0.04 % larger."""
    size = root.find(".//size")
    if size is not None:
        return 0.5 * float((size.text or "nan").split()[0])
    radii = {str(found.get("name")): float(found.findtext(".//radius") or "nan") for found in root.iter("collision")}
    return radii["hydroelastic"] / 1.0004 if "hydroelastic" in radii else radii["point"]


def drake_forces(card: palpate.Card, depths_m: np.ndarray, speed_m_per_s: float, share: float) -> np.ndarray:
    """Force in N at displacements of the jaws (m) and their speed; `share` is what one contact has of it."""
    from pydrake.geometry import AddContactMaterial, AddRigidHydroelasticProperties, Box, ProximityProperties
    from pydrake.math import RigidTransform
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ContactModel, CoulombFriction
    from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=0.0)
    plant.set_contact_model(ContactModel.kHydroelasticWithFallback)
    Parser(plant).AddModelsFromString(card.text, "sdf")
    body = plant.GetBodyByName("palpate_body")
    plant.WeldFrames(plant.world_frame(), body.body_frame())
    jaw = plant.AddRigidBody("jaw", plant.AddModelInstance("jaw"), SpatialInertia.SolidBoxWithMass(1.0, 0.1, 0.4, 0.4))
    properties = ProximityProperties()
    AddRigidHydroelasticProperties(0.4, properties)
    AddContactMaterial(dissipation=0.0, point_stiffness=1e12, friction=CoulombFriction(0.5, 0.5), properties=properties)
    plant.RegisterCollisionGeometry(jaw, RigidTransform([0.05, 0.0, 0.0]), Box(0.1, 0.4, 0.4), "jaw", properties)
    joint = plant.AddJoint(PrismaticJoint("x", plant.world_frame(), jaw.body_frame(), [1.0, 0.0, 0.0]))
    plant.Finalize()
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    own = plant.GetMyMutableContextFromRoot(context)
    root = ET.fromstring(card.text)
    half = surface(root)
    forces = []
    for depth in depths_m:
        joint.set_translation(own, half - share * depth)
        joint.set_translation_rate(own, -share * speed_m_per_s)
        results = plant.get_contact_results_output_port().Eval(own)
        total = sum(abs(results.point_pair_contact_info(i).contact_force()[0]) for i in range(results.num_point_pair_contacts()))
        total += sum(abs(results.hydroelastic_contact_info(i).F_Ac_W().translational()[0]) for i in range(results.num_hydroelastic_contacts()))
        forces.append(total)
    return np.array(forces)


def spring_forces(card: palpate.Card, depths_m: np.ndarray, speed_m_per_s: float, share: float) -> np.ndarray:
    """Force in N of stiffness and damping read back from the text of the card."""
    patterns = {
        "physx": (r", -([0-9.e+-]+)f\);", r"setDamping\(([0-9.e+-]+)f\)"),
        "isaac": (r"compliantContactStiffness = (\S+)", r"compliantContactDamping = (\S+)"),
        "newton": (r"ke=([0-9.e+-]+)", r"kd=([0-9.e+-]+)"),
    }
    stiffness, damping = (float(re.findall(pattern, card.text)[-1]) for pattern in patterns[card.engine])
    return stiffness * share * depths_m + damping * share * speed_m_per_s


def contact_forces(card: palpate.Card, depths_m: np.ndarray, speed_m_per_s: float, share: float) -> np.ndarray | None:
    """Force of the card by its engine, or by its text where the engine does not run here; None where it is not installed."""
    if card.engine == "mujoco":
        if not importlib.util.find_spec("mujoco"):
            return None
        from mujoco_cards import mujoco_forces

        return mujoco_forces(card, share * depths_m, share * speed_m_per_s)
    if card.engine == "drake":
        return drake_forces(card, depths_m, speed_m_per_s, share) if importlib.util.find_spec("pydrake") else None
    return spring_forces(card, depths_m, speed_m_per_s, share)


def contact_errors(material: palpate.Material, card: palpate.Card) -> tuple[float, list[float]] | None:
    """Largest error in loading and errors in the hold, in % of the peak force, of the card as it runs."""
    document = card.to_dict()
    depth, share = document["depth_m"], document["contact_displacement_m"] / document["depth_m"]
    worst = 0.0
    for speed in np.geomspace(document["slowest_m_per_s"], document["fastest_m_per_s"], 5):
        depths = np.linspace(1 / 60, 1.0, 240) * depth
        law = material.predict([{"to": f"{depth!r} m", "rate": f"{float(speed)!r} m/s"}], at_s=depths / speed).force_n
        forces = contact_forces(card, depths, float(speed), share)
        if forces is None:
            return None
        worst = max(worst, float(np.max(np.abs(forces - law))))
    held = contact_forces(card, np.array([depth]), 0.0, share)
    assert held is not None
    hold = [100 * (float(held[0]) - force) / card.peak_force_n for force in hold_forces(material, document)]
    return 100 * worst / card.peak_force_n, hold


def hold_forces(material: palpate.Material, document: dict[str, Any]) -> list[float]:
    """Force by the law in the hold, N."""
    start = document["depth_m"] / document["fastest_m_per_s"]
    step = {"to": f"{document['depth_m']!r} m", "rate": f"{document['fastest_m_per_s']!r} m/s", "hold": "61 s"}
    forces = material.predict([step], at_s=[start + time for time in HOLD_TIMES_S]).force_n
    return [float(force) for force in forces]


# Prony series, read back.


def _numbers(text: str) -> list[float]:
    return [float(word) for word in re.findall(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", text)]


def prony_terms(card: palpate.Card) -> list[tuple[float, float]]:
    """Shares of the initial stress and time constants (s) that stand in the text of a card."""
    text = card.text
    if card.engine == "abaqus":
        rows = [_numbers(line) for line in text.split("TIME=PRONY\n")[1].splitlines()]
        return [(share, time) for share, _, time in rows]
    if card.engine == "openradioss":
        section = [block.split("\n#")[0] for block in re.split(r"MU_1\n| G_I\n|TAU_I\n", text)[1:]]
        relaxed, moduli, times = _numbers(section[0])[0], _numbers(section[1]), _numbers(section[2])
        whole = relaxed + sum(moduli)
        return [(modulus / whole, time) for modulus, time in zip(moduli, times, strict=True)]
    if card.engine == "febio":
        tags = [(tag.tag, float(tag.text or "nan")) for tag in ET.fromstring(text).iter() if re.fullmatch(r"[gt][1-6]", tag.tag)]
        shares, times = [value for tag, value in tags if tag[0] == "g"], [value for tag, value in tags if tag[0] == "t"]
        return [(share / (1 + sum(shares)), time) for share, time in zip(shares, times, strict=True)]
    names: dict[str, list[float]] = {}
    for name in ("SHARES", "TIME_CONSTANTS_S"):
        names[name] = _numbers(text.split(f"{name} = [\n")[1].split("]")[0])
    return list(zip(names["SHARES"], names["TIME_CONSTANTS_S"], strict=True))


def felupe_relaxation(card: palpate.Card, times_s: list[float]) -> list[float]:
    """Force of a cube of the card's material, compressed at once and held, over that at the start; steps end at these times (s)."""
    import felupe

    names: dict[str, Any] = {}
    exec(compile(card.text, "card.py", "exec"), names)
    umat = names["umat"]
    mesh = felupe.Cube(n=2)
    field = felupe.FieldContainer([felupe.Field(felupe.RegionHexahedron(mesh), dim=3)])
    solid = felupe.SolidBody(umat=umat, field=field)
    fixed = {
        "left": felupe.Boundary(field[0], fx=0.0, skip=(0, 1, 1)),
        "front": felupe.Boundary(field[0], fy=0.0, skip=(1, 0, 1)),
        "bottom": felupe.Boundary(field[0], fz=0.0, skip=(1, 1, 0)),
        "move": felupe.Boundary(field[0], fx=1.0, skip=(0, 1, 1), value=-0.01),
    }
    dof0, dof1 = felupe.dof.partition(field, fixed)
    ext0 = felupe.dof.apply(field, fixed, dof0)
    # Renamed in FElupe 10.2.
    solve = felupe.newtonraphson if hasattr(felupe, "newtonraphson") else felupe.newtonrhapson
    forces, before = [], 0.0
    for time in [1e-9, *times_s]:
        umat.kwargs["time_step_s"] = time - before
        before = time
        solve(items=[solid], dof0=dof0, dof1=dof1, ext0=ext0, verbose=False)
        # As it was assembled last: another assembly would be another time step.
        force = solid.results.force.toarray().reshape(-1, 3)
        forces.append(float(force[fixed["move"].points, 0].sum()))
    return [force / forces[0] for force in forces[1:]]


def prony_errors(material: palpate.Material, card: palpate.Card) -> tuple[int, float, list[float], str]:
    """Terms, largest error over six decades of the hold, errors at 1, 10 and 60 s, in % of the peak force; and how it was evaluated."""
    document = card.to_dict()
    start, depth, speed = document["depth_m"] / document["fastest_m_per_s"], document["depth_m"], document["fastest_m_per_s"]
    times = sorted([60.0 * 10 ** (-k / 10) for k in range(61)] + [1.0, 10.0])
    step = {"to": f"{depth!r} m", "rate": f"{speed!r} m/s", "hold": "61 s"}
    law = material.predict([step], at_s=[start + time for time in times]).force_n / card.peak_force_n
    terms = prony_terms(card)
    remaining = 1 - sum(share for share, _ in terms)
    if card.engine == "felupe" and importlib.util.find_spec("felupe"):
        found, how = felupe_relaxation(card, times), "run"
    else:
        found, how = [remaining + sum(share * math.exp(-time / tau) for share, tau in terms) for time in times], "text evaluated"
    errors = [100 * (one - other) for one, other in zip(found, law, strict=True)]
    at = [errors[times.index(time)] for time in HOLD_TIMES_S]
    return len(terms), max(abs(error) for error in errors), at, how


def page() -> str:
    """The section of the page on simulators."""
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    contacts = [
        "| material | engine | share of the speed | error stated | error found | hold 1, 10, 60 s | how |",
        "|---|---|---|---:|---:|---|---|",
    ]
    continua = ["| material | engine | terms | largest error | hold 1, 10, 60 s | how |", "|---|---|---:|---:|---|---|"]
    for name, material in materials().items():
        for engine in CONTACTS:
            card = palpate.export(material, engine, mass_kg=MASS_KG, friction=0.6)
            assert card.loading_error is not None
            found = contact_errors(material, card)
            document = card.to_dict()
            share = document["slowest_m_per_s"] / document["fastest_m_per_s"]
            stated = f"{share:.1f} to 1 | {100 * card.loading_error:.2f} %"
            how = "run" if engine in ("mujoco", "drake") else "text evaluated"
            if found is None:
                contacts.append(f"| {name} | {engine} | {stated} | not installed | | |")
                continue
            hold = ", ".join(f"{error:+.1f}" for error in found[1])
            contacts.append(f"| {name} | {engine} | {stated} | {found[0]:.2f} % | {hold} % | {how} |")
        for engine in CONTINUA:
            terms, worst, at, how = prony_errors(material, palpate.export(material, engine))
            hold = ", ".join(f"{error:+.4f}" for error in at)
            continua.append(f"| {name} | {engine} | {terms} | {worst:.4f} % | {hold} % | {how} |")
    return "\n".join(
        [
            "## Cards",
            "",
            "Errors in % of the force at the end of loading, against `Material.predict`, from a sixtieth of the depth of the test to all of it, over the speeds of the card: "
            "from a share of the speed of the test to all of it, by default the widest range at which the error is not above 2 %, or from half of "
            "it where there is none. MuJoCo and Drake run the card at prescribed depth and speed; for the others stiffness and damping are read "
            "back from the text. In a hold these contacts keep their force: they have no memory. The force of a block jumps at first touch: no "
            "stiffness and dissipation of Drake bring its largest error below the one stated.",
            "",
            *contacts,
            "",
            "Prony cards, two terms a decade, against the simulated hold over 60 µs to 60 s.",
            "",
            *continua,
            "",
        ]
    )


if __name__ == "__main__":
    print(page())
