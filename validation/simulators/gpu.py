"""The twins of the step on a CUDA device: contacts a second by number and precision, and agreement with the CPU.

    python validation/simulators/gpu.py --write-reference FILE   where palpate is installed: motions and forces of ContactState, < 200 kB
    python validation/simulators/gpu.py --reference FILE          where numpy is, and warp-lang or jax for CUDA; prints Markdown
    python validation/simulators/gpu.py                           the same where palpate is installed, too
    python validation/simulators/gpu.py --device cpu --most 1e5   the same on the CPU
"""

import argparse
import importlib.util
import os
import platform
import statistics
import subprocess
import time
from functools import partial

# Warp and JAX share the device.
os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")

import _programs
import numpy as np

_programs.without_wheel()

#: Seconds for one figure.
BUDGET_S = 1.0


def warp_runs(stored, real, device):
    """Forces and states of a program by Warp."""
    import palpate.warp
    import warp as wp

    parameters = _programs.parameters_of(stored)
    contacts = palpate.warp.Contacts(parameters, len(parameters.depth_m), dtype=real, device=device)
    forces, states = np.empty(stored["force_n"].shape), np.empty(stored["state_m"].shape)
    for step, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"])):
        contacts.step(float(dt), wp.array(to, dtype=real, device=device))
        forces[step], states[step] = contacts.force_n.numpy(), contacts.state.numpy()[:, :2]
    return forces, states


def jax_runs(stored, kind, device):
    """The same by JAX, compiled."""
    import jax
    import palpate.jax as twin

    with jax.default_device(device):
        parameters = twin.contact_parameters(_programs.parameters_of(stored), kind)
        step = jax.jit(twin.contact_step)
        state = twin.contact_state(parameters)
        forces, states = np.empty(stored["force_n"].shape), np.empty(stored["state_m"].shape)
        for index, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"])):
            state, force = step(parameters, state, dt, to)
            forces[index], states[index] = force, np.stack([state.jaw_m, state.behind_m], axis=-1)
    return forces, states


def timed(step, synchronise):
    """Median time of one call, s."""
    for _ in range(3):
        step()
    synchronise()
    began, times = time.perf_counter(), []
    while time.perf_counter() - began < BUDGET_S or len(times) < 5:
        start = time.perf_counter()
        for _ in range(5):
            step()
        synchronise()
        times.append((time.perf_counter() - start) / 5)
    return statistics.median(times)


def one_ball(stored):
    """Parameters of the paper's ball, unilateral."""
    parameters = _programs.parameters_of(stored)
    return type(parameters)(*(values[:1] for values in parameters))


def positions(count):
    """Two positions of jaws between which they go to and fro, m."""
    first = np.linspace(1e-3, 2e-2, count)
    return first, first + 5e-5


def warp_time(stored, count, real, device):
    import palpate.warp
    import warp as wp

    contacts = palpate.warp.Contacts(one_ball(stored), count, dtype=real, device=device)
    to = [wp.array(values, dtype=real, device=device) for values in positions(count)]
    turn = iter(range(1 << 62))
    return timed(lambda: contacts.step(1e-3, to[next(turn) % 2]), lambda: wp.synchronize_device(device))


def jax_time(stored, count, kind, device):
    import jax
    import jax.numpy as jnp
    import palpate.jax as twin

    with jax.default_device(device):
        parameters = twin.contact_parameters(type(one_ball(stored))(*(v[0] for v in one_ball(stored))), kind)
        to = [jnp.asarray(values, kind) for values in positions(count)]
        step = jax.jit(twin.contact_step, donate_argnums=1)
        held = [twin.contact_state(parameters, shape=(count,)), None]
        turn = iter(range(1 << 62))

        def once():
            held[0], held[1] = step(parameters, held[0], 1e-3, to[next(turn) % 2])

        return timed(once, lambda: jax.block_until_ready(held))


def million(count, seconds):
    return f"{count / seconds / 1e6:.3g}"


def twins(device):
    """The twins that can run here: title, its program, its time for a step of a number of contacts, its limit."""
    found, versions = [], []
    if importlib.util.find_spec("warp"):
        import warp as wp

        wp.config.log_level = wp.LOG_WARNING
        versions.append(f"Warp {wp.__version__}")
        for title, real, limit in (("Warp, double", wp.float64, 1e-12), ("Warp, single", wp.float32, 1e-6)):
            found.append((title, partial(warp_runs, real=real, device=device), partial(warp_time, real=real, device=device), limit))
    if importlib.util.find_spec("jax"):
        import jax
        import jax.numpy as jnp

        jax.config.update("jax_enable_x64", True)
        versions.append(f"JAX {jax.__version__}")
        on = jax.devices("cpu" if device == "cpu" else "gpu")[0]
        for title, kind, limit in (("JAX, double", jnp.float64, 1e-12), ("JAX, single", jnp.float32, 1e-6)):
            found.append((title, partial(jax_runs, kind=kind, device=on), partial(jax_time, kind=kind, device=on), limit))
    return found, versions


def name_of(device):
    """What the device is called."""
    if device == "cpu":
        return "the CPU"
    query = ["nvidia-smi", "--query-gpu=name,driver_version", "--format=csv,noheader"]
    return subprocess.run(query, capture_output=True, text=True, check=True).stdout.splitlines()[0]


def page(stored=None, device="cuda:0", most=1e7):
    """The section as Markdown."""
    stored = stored or _programs.reference()
    found, versions = twins(device)
    left, met = _programs.crossings(stored)
    lines = [
        f"## Twins of the step on {name_of(device)}",
        "",
        f"{', '.join(versions)}, Python {platform.python_version()}. Largest difference from `palpate.ContactState` on the CPU over "
        f"{stored['force_n'].size} steps of {stored['force_n'].shape[1]} contacts, in which a jaw left its body {left} times and met it "
        f"{met} times: of the node behind the contact layer over the depth, and of the force over its peak.",
        "",
        "| twin | node | force |",
        "|---|---:|---:|",
    ]
    wrong = []
    for title, run, _, limit in found:
        worst = np.max(list(_programs.differences(stored, *run(stored)).values()), axis=0)
        lines.append(f"| {title} | {worst[0]:.1e} | {worst[1]:.1e} |")
        if not worst.max() <= limit:
            wrong.append(title)
    lines += [
        "",
        "Millions of contacts a second, a step of 1 ms of balls of n = 5 in contact, one launch a step:",
        "",
        f"| contacts | {' | '.join(title for title, *_ in found)} |",
        f"|---:|{'---:|' * len(found)}",
    ]
    count = 1000
    while count <= most:
        lines.append(f"| {count} | {' | '.join(million(count, seconds(stored, count)) for _, _, seconds, _ in found)} |")
        count *= 10
    if wrong:
        lines += ["", f"**Beyond the limits: {', '.join(wrong)}.**"]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write-reference", metavar="FILE")
    parser.add_argument("--reference", metavar="FILE")
    parser.add_argument("--device", default="cuda:0")
    parser.add_argument("--most", type=float, default=1e7)
    options = parser.parse_args()
    if options.write_reference:
        np.savez_compressed(options.write_reference, **_programs.reference(steps=100))
        return
    stored = dict(np.load(options.reference)) if options.reference else None
    section = page(stored, options.device, options.most)
    print(section)
    if "Beyond the limits" in section:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
