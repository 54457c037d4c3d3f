"""A gripper holds a soft ball for ten minutes: contact with memory beside MuJoCo's own.

    python simulators/mujoco/build.py
    python examples/mujoco/hold_ball.py target/mujoco-4.0.0/libpalpate_mujoco.so [--out hold_ball.svg]

The fingers close by 5 mm each, lift the ball by 50 mm, and hold it. With palpate.contact the force relaxes as the calibrated ball does and
the ball stays where it is; with MuJoCo's contact the force stays, and the ball creeps downwards. Needs mujoco and matplotlib.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MATERIAL = "examples/records/ball-material.toml"
SQUEEZE_M, LIFT_M = 0.005, 0.05


def model(name: str) -> mujoco.MjModel:
    """The gripper of one of the files beside this one, whatever the working directory is."""
    text = (HERE / name).read_text().replace(f'value="{MATERIAL}"', f'value="{ROOT / MATERIAL}"')
    return mujoco.MjModel.from_xml_string(text, {"gripper.xml": (HERE / "gripper.xml").read_bytes()})


def command(d: mujoco.MjData) -> None:
    """Close within 0.5 s from 0.2 s on, lift within 1 s from 1 s on, hold."""
    closed = SQUEEZE_M * np.clip((d.time - 0.2) / 0.5, 0.0, 1.0)
    d.ctrl[:] = [LIFT_M * np.clip(d.time - 1.0, 0.0, 1.0), closed, closed]


def left_force(m: mujoco.MjModel, d: mujoco.MjData) -> float:
    """Normal force of the left finger on the ball, N: the second number of palpate.sensor, or the sum over contacts of MuJoCo."""
    if m.nsensor:
        return float(d.sensor("left").data[1])
    left, total, wrench = m.geom("left").id, 0.0, np.zeros(6)
    for index in range(d.ncon):
        if left in d.contact[index].geom:
            mujoco.mj_contactForce(m, d, index, wrench)
            total += wrench[0]
    return total


def hold(name: str, duration_s: float = 600.0, every_s: float = 0.1) -> dict[str, np.ndarray]:
    """Time, normal force at the left finger and height of the ball over the lift."""
    m = model(name)
    d = mujoco.MjData(m)
    rows = []
    at_once = round(every_s / m.opt.timestep)
    while d.time < duration_s:
        # Commands change within the first two seconds alone.
        for steps in [1] * at_once if d.time < 2.5 else [at_once]:
            command(d)
            mujoco.mj_step(m, d, nstep=steps)
        rows.append([d.time, left_force(m, d), d.body("ball").xpos[2] - d.joint("lift").qpos[0]])
    time_s, force_n, height_m = np.array(rows).T
    return {"time_s": time_s, "force_n": force_n, "height_m": height_m}


def creep(run: dict[str, np.ndarray], since_s: float = 10.0) -> float:
    """How far the ball moves relative to the lift from then to the end, m."""
    held = run["height_m"][run["time_s"] >= since_s]
    return float(held[-1] - held[0])


def draw(runs: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "palpate"
    from matplotlib import pyplot

    figure, (forces, heights) = pyplot.subplots(2, sharex=True, figsize=(7, 5.5), layout="constrained")
    for label, run in runs.items():
        forces.plot(run["time_s"], run["force_n"], label=label)
        heights.plot(run["time_s"], 1e3 * (run["height_m"] - run["height_m"][0]), label=label)
    forces.set(ylabel="force of a finger (N)", xscale="log", xlim=(0.2, None))
    heights.set(ylabel="ball over the lift (mm)", xlabel="time (s)")
    forces.legend()
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plugin", help="library of simulators/mujoco/build.py")
    parser.add_argument("--out", type=Path, default=Path("hold_ball.svg"))
    options = parser.parse_args()
    mujoco.mj_loadPluginLibrary(options.plugin)
    runs = {"palpate.contact": hold("with_memory.xml"), "MuJoCo's contact": hold("without_memory.xml")}
    for label, run in runs.items():
        print(f"{label}: {run['force_n'].max():.2f} N at most, {run['force_n'][-1]:.2f} N after 600 s, creep {1e3 * creep(run):.2g} mm")
    draw(runs, options.out)


if __name__ == "__main__":
    main()
