"""A gripper holds a soft ball for ten minutes: contact with memory beside MuJoCo's own.

    python simulators/mujoco/build.py
    python examples/mujoco/hold_ball.py target/mujoco-4.0.0/libpalpate_mujoco.so [--out hold_ball.svg]

The fingers close by 5 mm each, lift the ball by 50 mm, and hold it. With palpate.contact the force relaxes as the calibrated ball does and
the ball stays where it is; with MuJoCo's contact the force stays, and the ball creeps downwards, faster without the iterations of its
noslip solver. Needs mujoco and matplotlib.
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


def hold(name: str, noslip: int = 0, duration_s: float = 600.0) -> dict[str, np.ndarray]:
    """Time, normal force at the left finger and height of the ball over the lift."""
    m = model(name)
    m.opt.noslip_iterations = noslip
    d = mujoco.MjData(m)
    rows = []
    while d.time < duration_s:
        if d.time < 2.5:
            for _ in range(20):
                command(d)
                mujoco.mj_step(m, d)
        else:
            # Commands have their last values.
            mujoco.mj_step(m, d, nstep=100)
        rows.append([d.time, left_force(m, d), d.body("ball").xpos[2] - d.joint("lift").qpos[0]])
    time_s, force_n, height_m = np.array(rows).T
    return {"time_s": time_s, "force_n": force_n, "height_m": height_m}


def creep(run: dict[str, np.ndarray], since_s: float = 10.0) -> float:
    """How far the ball moves relative to the lift from then to the end, or until it is lost, m."""
    held = run["height_m"][(run["time_s"] >= since_s) & (run["time_s"] < lost(run))]
    return float(held[-1] - held[0])


def lost(run: dict[str, np.ndarray]) -> float:
    """When the fingers no longer touch the ball, s; infinite if they hold it to the end."""
    free = run["time_s"][(run["force_n"] == 0) & (run["time_s"] > 2)]
    return float(free[0]) if len(free) else float("inf")


RUNS = {
    "palpate.contact": ("with_memory.xml", 0),
    "MuJoCo's contact": ("without_memory.xml", 0),
    "MuJoCo's contact, noslip": ("without_memory.xml", 5),
}


def draw(runs: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "palpate"
    from matplotlib import pyplot

    figure, (forces, heights) = pyplot.subplots(2, sharex=True, figsize=(7, 5.5), layout="constrained")
    for label, run in runs.items():
        forces.plot(run["time_s"], run["force_n"], label=label)
        heights.plot(run["time_s"], 1e3 * (run["height_m"] - run["height_m"][0]))
    forces.set(ylabel="force of a finger (N)", xscale="log", xlim=(0.2, None))
    heights.set(ylabel="ball over the lift (mm)", xlabel="time (s)", ylim=(-30, 2))
    forces.legend()
    figure.savefig(path, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plugin", help="library of simulators/mujoco/build.py")
    parser.add_argument("--out", type=Path, default=Path("hold_ball.svg"))
    options = parser.parse_args()
    mujoco.mj_loadPluginLibrary(options.plugin)
    runs = {label: hold(name, noslip) for label, (name, noslip) in RUNS.items()}
    for label, run in runs.items():
        force_n = np.interp([10.0, 600.0], run["time_s"], run["force_n"])
        print(f"{label}: {force_n[0]:.3f} N after 10 s, {force_n[1]:.3f} N after 600 s", end=", ")
        print(f"creep {1e3 * creep(run):.2g} mm, lost at {lost(run):.0f} s")
    draw(runs, options.out)


if __name__ == "__main__":
    main()
