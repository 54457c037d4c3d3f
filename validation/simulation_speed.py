"""Simulations by palpate beside SciPy, numba and JAX on the same machine, in the same run.

    python validation/simulation_speed.py            prints the table
    python validation/simulation_speed.py --write    also writes validation/results/simulation_speed.md

1. force: protocol (a), five stops of 5 mm at 500 mm/min held 10 s, back to 0, 66 s at 100 Hz; time per output sample.
2. layers: all m layers at the end of protocol (a). SciPy: solve_ivp restarted at the kinks, rtol 1e-8, atol 1e-10 of the
   radius, the fastest of DOP853, RK45, LSODA and LSODA with a banded Jacobian. palpate: strain_wave_within 1e-8.
3. batch: 10,000 balls of 8 layers, each with its own radius, modulus and rate coefficient, 5 mm in 0.6 s and a hold of
   10 s; the final force within 1e-6, each by simulate_force, on all cores: a thread
   integrates the ramp once, since they share n. numba and JAX: classical Runge-Kutta at 1 ms, contacts in blocks of 64 side by side
   and spread over the cores (numba), or all of them as arrays in one compiled loop (JAX). They are run for a part of the
   steps, with all contacts, and the time is scaled up.
4. step: one tick of a controller (ContactState::step).

palpate's side is `cargo run --profile dist --example timing -- --simulations`.
"""

import argparse
import json
import os
import pathlib
import platform
import subprocess
import time

import jax
import jax.numpy as jnp
import numba
import numpy as np
import scipy
from scipy.integrate import solve_ivp

from peers import R, V, knots, median_time, show

ROOT = pathlib.Path(__file__).resolve().parent.parent
COUNT, LAYERS, RAMP, HOLD, STEP, TRAVEL = 10_000, 8, 0.6, 10.0, 1e-3, 0.005
BLOCK = 64
SAMPLES = 6601


def rust_times():
    command = ["cargo", "run", "--profile", "dist", "-q", "-p", "palpate", "--example", "timing", "--", "--simulations"]
    out = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return {row["name"]: row for row in map(json.loads, out.splitlines())}


def layers_by_scipy(m, method, banded=False):
    """u_2 .. u_m over r at the end of protocol (a)."""
    behind = 1.0 - np.arange(m - 1) / m
    w, steps = np.zeros(m - 1), knots()
    options = {"lband": 1, "uband": 0} if banded else {}
    for (ta, da), (tb, db) in zip(steps, steps[1:]):
        slope, start = (db - da) / (tb - ta) / 2 / R, da / 2 / R
        u = np.empty(m)

        def rhs(t, w):
            u[0], u[1:] = start + slope * (t - ta), w
            x = m * (u[:-1] - w) - u[:-1] / behind
            square = x * x
            return V / m * (square * square * x)

        sol = solve_ivp(rhs, (ta, tb), w, method=method, rtol=1e-8, atol=1e-10, t_eval=[tb], **options)
        assert sol.success, sol.message
        w = sol.y[:, -1]
    return w


def best_of_scipy(m, runs):
    """Seconds of the fastest method, and its name."""
    found = []
    reference = layers_by_scipy(m, "DOP853")
    methods = [("DOP853", False), ("LSODA", True)] + ([("RK45", False), ("LSODA", False)] if m < 100 else [])
    for method, banded in methods:
        assert np.max(np.abs(layers_by_scipy(m, method, banded) - reference)) < 1e-8
        seconds = median_time(lambda: layers_by_scipy(m, method, banded), runs)
        found.append((seconds, method + (", banded" if banded else "")))
    return min(found)


def contacts():
    """Radius, modulus and rate coefficient of the contacts, as in examples/timing.rs."""
    part = np.arange(COUNT) / COUNT
    return 0.03 + 0.01 * part, 2e4 + 1e4 * part, 1e4 * (1 + part)


@numba.njit(parallel=True, fastmath=True)
def blocked_rk4(radius, rate, steps, first, w):
    """Classical Runge-Kutta for u_2 .. u_m over the radius; w[block, layer, lane] is carried on."""
    nodes = LAYERS - 1
    for block in numba.prange(w.shape[0]):
        k, total, top = np.zeros((nodes, BLOCK)), np.zeros((nodes, BLOCK)), np.empty(BLOCK)
        point = np.empty((nodes, BLOCK))
        for step in range(first, first + steps):
            for stage in range(4):
                part = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                travel = TRAVEL / 2 * min((step + part) * STEP / RAMP, 1.0)
                weight = 1.0 / 6 if stage in (0, 3) else 1.0 / 3
                for lane in range(BLOCK):
                    top[lane] = travel / radius[block * BLOCK + lane]
                for i in range(nodes):
                    for lane in range(BLOCK):
                        point[i, lane] = w[block, i, lane] + part * STEP * k[i, lane]
                for i in range(nodes):
                    left = LAYERS / (LAYERS - i)
                    outer = top if i == 0 else point[i - 1]
                    for lane in range(BLOCK):
                        x = LAYERS * (outer[lane] - point[i, lane]) - outer[lane] * left
                        square = x * x
                        k[i, lane] = rate[block * BLOCK + lane] / LAYERS * (square * square * x)
                if stage == 0:
                    for i in range(nodes):
                        for lane in range(BLOCK):
                            total[i, lane] = weight * k[i, lane]
                else:
                    for i in range(nodes):
                        for lane in range(BLOCK):
                            total[i, lane] += weight * k[i, lane]
            for i in range(nodes):
                for lane in range(BLOCK):
                    w[block, i, lane] += STEP * total[i, lane]


def by_numba(radius, rate, steps):
    blocks = -(-len(radius) // BLOCK)
    pad = blocks * BLOCK - len(radius)
    radius, rate = np.pad(radius, (0, pad), mode="edge"), np.pad(rate, (0, pad), mode="edge")
    w = np.zeros((blocks, LAYERS - 1, BLOCK))
    blocked_rk4(radius, rate, steps, 0, w)
    return w[:, 0, :].ravel()[: len(radius) - pad]


def jax_stepper(radius, rate):
    left = jnp.asarray(LAYERS / (LAYERS - np.arange(LAYERS - 1)))[:, None]
    radius, rate = jnp.asarray(radius), jnp.asarray(rate)

    def slopes(w, at):
        top = TRAVEL / 2 * jnp.minimum(at * STEP / RAMP, 1.0) / radius
        outer = jnp.concatenate([top[None], w[:-1]])
        x = LAYERS * (outer - w) - outer * left
        square = x * x
        return rate / LAYERS * (square * square * x)

    def step(number, w):
        at = number.astype(w.dtype)
        a = slopes(w, at)
        b = slopes(w + STEP / 2 * a, at + 0.5)
        c = slopes(w + STEP / 2 * b, at + 0.5)
        d = slopes(w + STEP * c, at + 1.0)
        return w + STEP / 6 * (a + 2 * b + 2 * c + d)

    return jax.jit(lambda steps: jax.lax.fori_loop(0, steps, step, jnp.zeros((LAYERS - 1, radius.size))))


def forces(radius, modulus, node):
    """Force from u_2 over the radius."""
    u = TRAVEL / 2 / radius
    return modulus * LAYERS * (u - node) * np.pi * radius**2 * (2 * u - u * u)


def timed(what):
    begin = time.perf_counter()
    what()
    return time.perf_counter() - begin


def machine():
    if os.path.exists("/proc/cpuinfo"):
        lines = [line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
        return f"{lines[0] if lines else platform.processor()}, {len(os.sched_getaffinity(0))} threads"
    return platform.processor()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write validation/results/simulation_speed.md")
    args = parser.parse_args()
    jax.config.update("jax_enable_x64", True)

    rust = rust_times()
    ours = {name: row["seconds"] for name, row in rust.items()}
    radius, modulus, rate = contacts()
    steps, part = round((RAMP + HOLD) / STEP), 530
    # The last four contacts to the end: the same forces.
    node = by_numba(radius[-4:], rate[-4:], steps)
    off = np.max(np.abs(forces(radius[-4:], modulus[-4:], node) / np.array(rust["forces"]["forces"]) - 1))
    assert off < 1e-6, off
    by_numba(radius, rate, 1)
    numba_time = min(timed(lambda: by_numba(radius, rate, part)) for _ in range(3)) * steps / part
    stepper = jax_stepper(radius, rate)
    stepper(1).block_until_ready()
    jax_part = part // 10
    jax_time = min(timed(lambda: stepper(jax_part).block_until_ready()) for _ in range(2)) * steps / jax_part
    same = np.max(np.abs(np.asarray(stepper(jax_part))[0] - by_numba(radius, rate, jax_part)))
    assert same < 1e-12, same

    lines = ["# Simulations beside SciPy, numba and JAX", "",
             f"{machine()}; Python {platform.python_version()}, SciPy {scipy.__version__}, NumPy {np.__version__}, "
             f"numba {numba.__version__}, JAX {jax.__version__} (on the processor). The machine was shared: "
             "times wander, ratios are from one run.", "",
             "| work | peer | its time | palpate | ratio | wanted |", "|---|---|---:|---:|---:|---:|"]
    for m, runs, wanted in ((8, 7, 50), (512, 3, 40)):
        seconds, method = best_of_scipy(m, runs)
        own = ours[f"strain_wave_{m}_layers"]
        lines.append(f"| all {m} layers, protocol (a), 1e-8 | SciPy {method} | {show(seconds)} | {show(own)} | "
                     f"{seconds / own:.0f} | {wanted} |")
    for name, seconds in (("numba, blocked RK4 at 1 ms", numba_time), ("JAX, RK4 at 1 ms", jax_time)):
        own = ours["batch_force"]
        lines.append(f"| 10,000 contacts, 8 layers, ramp and hold: final force | {name} | {show(seconds)} | {show(own)} | "
                     f"{seconds / own:.0f} | 50 |")
    sample = ours["simulate_protocol_a_force"] / SAMPLES
    tick = ours["real_time_step_1000"] / 1000
    lines += ["", "| work | palpate | wanted |", "|---|---:|---:|",
              f"| force of protocol (a) at 100 Hz, one output sample | {show(sample)} | 10 ns |",
              f"| one step of a controller | {show(tick)} | 50 ns |",
              f"| 10,000 contacts with an exponent each: final force | {show(ours['batch_force_own_exponents'])} | - |",
              "", f"Forces at the end agree with numba's to {off:.0e} of themselves. numba and JAX were run for {part} and "
                  f"{jax_part} of {steps} steps with all contacts. SciPy's right-hand sides are NumPy arrays."]
    text = "\n".join(lines) + "\n"
    print(text)
    if args.write:
        (ROOT / "validation" / "results" / "simulation_speed.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
