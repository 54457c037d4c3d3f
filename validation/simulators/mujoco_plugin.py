"""The MuJoCo plug-in beside `palpate.simulate` and beside MuJoCo's own contact: error of force, time of a step, creep of a held ball.

    python simulators/mujoco/build.py
    PALPATE_MUJOCO_PLUGIN=target/mujoco-4.0.0/libpalpate_mujoco.so python validation/simulators/mujoco_plugin.py

Errors are those of forces every millisecond against `simulate`, which integrates to a tolerance and was compared with SciPy
(`validation/contact_force.py`). Times are of the processor, the fastest of several runs taken in turn. It takes about a minute.
"""

from __future__ import annotations

import os
import sys
import time
from importlib.metadata import version
from pathlib import Path

import mujoco
import numpy as np
import palpate

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples/mujoco"))
import hold_ball  # noqa: E402  (the example whose figures these are)

MODEL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
DESCRIPTION = """[specimen]
shape = 'ball'
radius = '35 mm'
modulus = '28 kPa'
[law]
name = 'latency'
exponent = 5
rate_coefficient = '2e4 /s'
""".replace("\n", "&#10;")
LEVELS_MM = (5, 10, 15, 20, 25, 20, 15, 10, 5, 0)


def jaw(substeps: int = 1) -> mujoco.MjModel:
    """A jaw on a slide joint that squeezes the ball of the paper."""
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
      <option timestep="0.001" gravity="0 0 0"/>
      <extension>
        <plugin plugin="palpate.contact"><instance name="jaw"><config key="description" value="{DESCRIPTION}"/>
          <config key="joint" value="jaw"/><config key="substeps" value="{substeps}"/></instance></plugin>
        <plugin plugin="palpate.sensor"/>
      </extension>
      <worldbody><body><joint name="jaw" type="slide"/><geom size="0.01" mass="1"/></body></worldbody>
      <sensor><plugin name="jaw" plugin="palpate.sensor"><config key="contact" value="jaw"/></plugin></sensor>
    </mujoco>""")


def error(rate: str, substeps: int) -> float:
    """Largest error of the force over the largest force, every millisecond of the steps of the paper with holds of 1 s."""
    steps = [{"to": f"{to} mm", "rate": rate, "hold": "1 s"} for to in LEVELS_MM]
    run = palpate.simulate({**MODEL, "step": steps, "output": {"sample_rate": "1000 Hz"}})
    times = np.arange(0, run.time_s[-1], 1e-3)
    places, forces = (np.interp(times, run.time_s, column) for column in (run.displacement_m, run.force_n))
    m = jaw(substeps)
    d = mujoco.MjData(m)
    worst = 0.0
    for place, force in zip(places, forces, strict=True):
        d.qpos[0], d.qvel[0] = place, 0.0
        mujoco.mj_step(m, d)
        worst = max(worst, abs(d.sensor("jaw").data[1] - force))
    return worst / forces.max()


def without(xml: str, *parts: str) -> str:
    """A model without what stands between two marks each."""
    for begin, end in zip(parts[::2], parts[1::2], strict=True):
        while begin in xml:
            head, tail = xml.split(begin, 1)
            xml = head + tail.split(end, 1)[1]
    return xml


def models() -> dict[str, mujoco.MjModel]:
    """One jaw on a fixed ball, and the gripper of the example, each without contact, with MuJoCo's and with the plug-in."""
    one = f"""<mujoco>
      <option timestep="0.001" integrator="implicitfast"/>
      <!--plugin--><extension><plugin plugin="palpate.contact"><instance name="jaw"><config key="description" value="{DESCRIPTION}"/>
        <config key="geom1" value="jaw"/><config key="geom2" value="ball"/></instance></plugin></extension><!--end-->
      <worldbody>
        <body name="jaw" pos="-0.045 0 0"><joint name="jaw" type="slide" axis="1 0 0"/>
          <geom name="jaw" type="box" size="0.01 0.03 0.03" mass="0.2"/></body>
        <geom name="ball" type="sphere" size="0.035"/>
      </worldbody>
      <actuator><position joint="jaw" kp="20000" kv="100"/></actuator>
      <!--exclude--><contact><exclude body1="world" body2="jaw"/></contact><!--end-->
    </mujoco>"""
    assets = {"gripper.xml": (ROOT / "examples/mujoco/gripper.xml").read_bytes()}
    with_memory = (ROOT / "examples/mujoco/with_memory.xml").read_text().replace(
        f'value="{hold_ball.MATERIAL}"', f'value="{ROOT / hold_ball.MATERIAL}"'
    )
    no_sensor = without(with_memory, "<sensor>", "</sensor>", '<plugin plugin="palpate.sensor"/>', "\n")
    no_plugin = without(no_sensor, "<extension>", "</extension>")
    from_string = mujoco.MjModel.from_xml_string
    return {
        "jaw, no contact": from_string(without(one, "<!--plugin-->", "<!--end-->")),
        "jaw, MuJoCo's contact": from_string(without(one, "<!--plugin-->", "<!--end-->", "<!--exclude-->", "<!--end-->")),
        "jaw, palpate.contact": from_string(one),
        "gripper, no finger contact": from_string(no_plugin, assets),
        "gripper, MuJoCo's contact at both fingers": hold_ball.model("without_memory.xml"),
        "gripper, palpate.contact at both fingers": from_string(no_sensor, assets),
    }


def step_times(runs: int = 25, steps: int = 4000) -> dict[str, float]:
    """Microseconds of a step of each model with its fingers closed, the fastest of several runs taken in turn."""
    ready = {}
    for name, m in models().items():
        d = mujoco.MjData(m)
        d.ctrl[m.nu > 1 :] = hold_ball.SQUEEZE_M
        mujoco.mj_step(m, d, nstep=2000)
        ready[name] = (m, d)
    best = dict.fromkeys(ready, float("inf"))
    for _ in range(runs):
        for name, (m, d) in ready.items():
            start = time.process_time()
            mujoco.mj_step(m, d, nstep=steps)
            best[name] = min(best[name], 1e6 * (time.process_time() - start) / steps)
    return best


def callback_time(runs: int = 25, steps: int = 4000) -> tuple[float, float]:
    """Microseconds of a step with and without a Python callback of passive forces that steps a `palpate.ContactState`."""
    m = mujoco.MjModel.from_xml_string("""<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody>
      <body><joint type="slide"/><geom size="0.01" mass="1"/></body></worldbody></mujoco>""")
    d, contact = mujoco.MjData(m), palpate.ContactState(MODEL)
    d.qpos[0] = 0.005

    def passive(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.qfrc_passive[0] -= contact.step(1e-3, data.qpos[0])

    best = [float("inf")] * 2
    for _ in range(runs):
        for place, function in enumerate((None, passive)):
            mujoco.set_mjcb_passive(function)
            d.qpos[0], d.qvel[0] = 0.005, 0.0
            start = time.process_time()
            mujoco.mj_step(m, d, nstep=steps)
            best[place] = min(best[place], 1e6 * (time.process_time() - start) / steps)
    mujoco.set_mjcb_passive(None)
    return best[0], best[1]


def page(library: str | None = None) -> str:
    """The section of the page as Markdown."""
    library = library or os.environ["PALPATE_MUJOCO_PLUGIN"]
    if not loaded:
        mujoco.mj_loadPluginLibrary(library)
        loaded.append("palpate")
    lines = [f"## MuJoCo plug-in\n\nMuJoCo {version('mujoco')}, palpate {palpate.__version__}.\n"]
    lines.append("Largest error of the force over the largest force, in steps of 1 ms, against `simulate`: the paper's ball,")
    lines.append("5 to 25 mm and back.\n")
    lines.append("| speed of the jaw | 1 substep | 2 | 4 |\n|---|---:|---:|---:|")
    for rate in ("500 mm/min", "50 mm/s", "200 mm/s"):
        lines.append(f"| {rate} | " + " | ".join(f"{error(rate, substeps):.1e}" for substeps in (1, 2, 4)) + " |")
    times = step_times()
    lines.append("\nTime of a step (`mj_step` with many steps a call, implicitfast, 1 ms).\n")
    lines.append("| model | µs | over no contact |\n|---|---:|---:|")
    for name, found in times.items():
        base = times["jaw, no contact" if name.startswith("jaw") else "gripper, no finger contact"]
        lines.append(f"| {name} | {found:.2f} | {found / base:.2f} |")
    plain, called = callback_time()
    lines.append(
        f"\nA Python callback of passive forces that steps a `palpate.ContactState` takes {called - plain:.2f} µs a call "
        f"({called:.2f} µs a step, {plain:.2f} without)."
    )
    lines.append("\nA ball of 100 g held for ten minutes (`examples/mujoco/hold_ball.py`), from 10 s on.\n")
    lines.append("| contact | force at 10 s (N) | force at 600 s (N) | creep (mm) | lost at (s) |\n|---|---:|---:|---:|---:|")
    for label, (name, noslip) in hold_ball.RUNS.items():
        run = hold_ball.hold(name, noslip)
        first, last = np.interp([10.0, 600.0], run["time_s"], run["force_n"])
        lost = hold_ball.lost(run)
        end = f"{lost:.0f}" if np.isfinite(lost) else ""
        lines.append(f"| {label} | {first:.3f} | {last:.3f} | {1e3 * hold_ball.creep(run):.2g} | {end} |")
    return "\n".join(lines) + "\n"


loaded: list[str] = []

if __name__ == "__main__":
    print(page(), end="")
