"""Speed of `palpate.ContactStates` beside the same step in NumPy, numba and JAX, and of the environments of `palpate.gym`.

    python validation/simulators/contact_states.py

Every library takes steps of the same contacts, closed balls with n = 5 that may not pull: state and displacements as doubles, a new state and forces
out. Contacts of palpate are also checked and may leave their bodies, which the others leave out; with errors="raise" all of them are checked before
the first is moved. One core and two are two processes: the
first is bound to one core. The rounds of all libraries go in turn, and the best of each counts; a pause before each lets the threads of the library
before it fall asleep, which wait for more work in a loop.
"""

from __future__ import annotations

import importlib.metadata
import json
import math
import os
import platform
import subprocess
import sys
import time

COUNTS = [10**power for power in range(7)]
ROUNDS, ROUND_S, PAUSE_S = 15, 0.04, 0.04
ENVIRONMENTS, STEPS = 4096, 400
MODEL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
DEPTH, THICKNESS, RATE, MODULUS = 0.035, 0.035 / 8, 2e4, 28e3
DT = 1e-3
OURS, OTHERS = ("palpate, raise", "palpate, mask"), ("NumPy", "numba", "JAX")


def surrogate(xp):
    """A step of closed contacts as expressions over arrays: the new state, and the forces."""

    def step(jaw, behind, to, dt):
        u = 0.5 * to
        kick = 0.5 * ((u - jaw) * (7 / DEPTH))
        x = (jaw - behind) * (1 / THICKNESS) - jaw * (1 / DEPTH) + kick
        square = x * x
        x = x / xp.sqrt(xp.sqrt(1 + 4 * (RATE * (square * square) * dt))) + kick
        behind = u - THICKNESS * (x + u * (1 / DEPTH))
        strain = (u - behind) * (1 / THICKNESS)
        area = math.pi * u * (2 * DEPTH - u)
        return u, behind, xp.where(strain > 0, MODULUS * strain * area, 0.0)

    return step


def compiled(parallel):
    """The same as a loop of numba, in place."""
    import numba
    import numpy as np

    def step(jaw, behind, to, dt, force):
        for i in numba.prange(jaw.size):
            u = 0.5 * to[i]
            kick = 0.5 * ((u - jaw[i]) * (7 / DEPTH))
            x = (jaw[i] - behind[i]) * (1 / THICKNESS) - jaw[i] * (1 / DEPTH) + kick
            square = x * x
            x = x / np.sqrt(np.sqrt(1 + 4 * (RATE * (square * square) * dt))) + kick
            left = u - THICKNESS * (x + u * (1 / DEPTH))
            strain = (u - left) * (1 / THICKNESS)
            area = math.pi * u * (2 * DEPTH - u)
            jaw[i] = u
            behind[i] = left
            force[i] = MODULUS * strain * area if strain > 0 else 0.0

    return numba.njit(step, parallel=parallel, fastmath=False)


def steppers(count):
    """A function for each library that takes a step to displacements, and returns the forces."""
    import jax
    import numpy as np
    import palpate

    jax.config.update("jax_enable_x64", True)
    import jax.numpy as jnp

    contacts, out = palpate.ContactStates(MODEL, count), np.empty(count)
    masked, masked_out = palpate.ContactStates(MODEL, count), np.empty(count)
    plain = surrogate(np)
    plain_state = [np.zeros(count), np.zeros(count)]

    def numpy_step(to):
        plain_state[0], plain_state[1], force = plain(*plain_state, to, DT)
        return force

    # Its parallel loop is in vectors, on one thread too; the plain one begins sooner.
    loop = compiled(count >= 1000)
    columns = [np.zeros(count), np.zeros(count)]
    force = np.empty(count)

    def numba_step(to):
        loop(*columns, to, DT, force)
        return force

    jitted = jax.jit(surrogate(jnp), donate_argnums=(0, 1))
    jax_state = [jnp.zeros(count), jnp.zeros(count)]

    def jax_step(to):
        jax_state[0], jax_state[1], found = jitted(*jax_state, to, DT)
        return found.block_until_ready()

    def palpate_step(to):
        return contacts.step(DT, to, out=out)

    def masked_step(to):
        return masked.step(DT, to, out=masked_out, errors="mask")

    steps = {"palpate, raise": palpate_step, "palpate, mask": masked_step, "NumPy": numpy_step, "numba": numba_step}
    return {**{name: (step, np.asarray) for name, step in steps.items()}, "JAX": (jax_step, jnp.asarray)}


def step_times():
    """Seconds of a step of every library by number of contacts."""
    import numpy as np

    found = {}
    for count in COUNTS:
        rng = np.random.default_rng(count)
        places = [rng.uniform(4e-3, 5e-3, count), rng.uniform(4.2e-3, 5.2e-3, count)]
        there = {name: (step, [made(to) for to in places]) for name, (step, made) in steppers(count).items()}
        forces = {}
        for k in range(6):
            forces = {name: np.asarray(step(tos[k % 2])).copy() for name, (step, tos) in there.items()}
        for name, force in forces.items():
            assert np.allclose(force, forces["palpate, raise"], rtol=1e-11), f"{name}: another model"
        best = dict.fromkeys(there, math.inf)
        repeats = {}
        for name, (step, tos) in there.items():
            start = time.perf_counter()
            step(tos[0])
            repeats[name] = max(2, min(20_000, int(ROUND_S / (time.perf_counter() - start)))) // 2 * 2
        for _ in range(ROUNDS):
            for name, (step, tos) in there.items():
                time.sleep(PAUSE_S)
                for k in range(4):
                    step(tos[k & 1])
                start = time.perf_counter()
                for k in range(repeats[name]):
                    step(tos[k & 1])
                best[name] = min(best[name], (time.perf_counter() - start) / repeats[name])
        found[count] = best
    return found


def environment_rates():
    """Steps of environments a second of processor time, by control and how bodies are drawn."""
    import numpy as np
    import palpate.gym

    found = {}
    ranges = {"modulus_pa": (2e4, 4e4), "radius_m": (0.03, 0.04), "rate_coefficient_per_s": (1e4, 4e4), "mass_kg": (0.1, 0.3), "friction": (0.4, 0.8)}
    for control in ("position", "force", "impedance"):
        for drawn in ("one body", "bodies drawn by episode"):
            envs = palpate.gym.SoftGripVectorEnv(ENVIRONMENTS, control=control, ranges={} if drawn == "one body" else ranges)
            envs.reset(seed=1)
            rng = np.random.default_rng(2)
            actions = [rng.uniform(-0.6, 0.2, (ENVIRONMENTS, 1)).astype(np.float32) for _ in range(8)]
            best = 0.0
            for _ in range(5):
                start = time.process_time()
                for k in range(STEPS):
                    envs.step(actions[k % 8])
                best = max(best, ENVIRONMENTS * STEPS / (time.process_time() - start))
            found[f"{control}, {drawn}"] = best
    return found


def measured(cores):
    """The results of a process with so many cores."""
    environment = {**os.environ, "NUMBA_NUM_THREADS": str(cores), "RAYON_NUM_THREADS": str(cores)}
    if cores == 1:
        environment["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false"
    command = [sys.executable, __file__, "--cores", str(cores)]
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def shown(seconds):
    """A time with its unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def table(times, cores):
    names = [*OURS, *OTHERS]
    lines = [
        f"| contacts, {cores} core{'s' if cores > 1 else ''} | {' | '.join(names)} | a contact, mask | fastest other / raise | fastest other / mask |",
        "|---:" * (len(names) + 4) + "|",
    ]
    for count, best in times.items():
        fastest = min(best[name] for name in OTHERS)
        cells = [shown(best[name]) for name in names]
        each = best[OURS[1]] / int(count) * 1e9
        ratios = [f"{fastest / best[name]:.2f}" for name in OURS]
        lines.append(f"| {int(count):,} | {' | '.join(cells)} | {each:.3g} ns | {' | '.join(ratios)} |")
    return "\n".join(lines)


def page(cores=(1, 2)):
    """The section of the table of simulators."""
    found = {count: measured(count) for count in cores}
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in ("palpate", "numpy", "numba", "jax", "gymnasium"))
    parts = [
        "## Many contacts, and environments for learning",
        f"Written by `validation/simulators/contact_states.py`: {versions}, CPython {platform.python_version()}, "
        f"{len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[0]:.1f} at the end. Time of a step in place with `out=`, best of {ROUNDS} rounds in turn, with a pause before each; "
        "JAX compiled, its state donated; numba with its plain loop below 1,000 contacts, with `prange` from there on.",
        *(table(results["steps"], count) for count, results in found.items()),
        f"Steps of {ENVIRONMENTS:,} environments of `palpate.gym`, each with {4} substeps of its contact, a second of processor time on one core:",
        "| control | million steps |\n|---|---:|\n" + "\n".join(f"| {name} | {rate / 1e6:.1f} |" for name, rate in found[1]["environments"].items()),
    ]
    return "\n\n".join(parts) + "\n"


def child(cores):
    """What a process with so many cores prints."""
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])
    results = {"steps": step_times()}
    if cores == 1:
        results["environments"] = environment_rates()
    print(json.dumps(results))


if __name__ == "__main__":
    if "--cores" in sys.argv:
        child(int(sys.argv[sys.argv.index("--cores") + 1]))
    else:
        print(page())
