"""Speed of the Python package beside SciPy, lmfit, numba, JAX and rheojax, in one run.

    maturin build --profile dist --manifest-path crates/palpate-python/Cargo.toml --out wheels
    pip install wheels/palpate-*.whl scipy lmfit numba jax
    python validation/python_speed.py [--write]

Each time is the fastest of several runs; works of one row are run in turn, so that what else the machine does counts for all alike. Fits by
SciPy and lmfit start near the truth and have the closed form in NumPy, which takes most of their time; palpate has no starting values, and its
fits include the noise of the residuals and intervals for it; those with `noise="white"` take it for white, as SciPy and lmfit do. A fit counts only where its residual is no larger than theirs. Steps of contacts
by NumPy, numba and JAX are the same closed form (n = 5) for contacts that stay closed, without checks; forces agree to 1e-12. rheojax has no
law of this kind: its two Maxwell modes stand beside two exponential terms. What is not installed is left out and named. With --write the table
goes to validation/results/python_speed.md.
"""

import importlib.util
import os
import platform
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import palpate

PEERS = ["scipy", "lmfit", "numba", "jax", "rheojax"]
THERE = [peer for peer in PEERS if importlib.util.find_spec(peer)]
RUNS = int(os.environ.get("RUNS", "15"))
MODEL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}


def law(t, equilibrium, amplitude, rate, exponent):
    """The closed form in NumPy."""
    return equilibrium + amplitude * (1 + (exponent - 1) * rate * t) ** (-1 / (exponent - 1))


def law_5(t, equilibrium, amplitude, rate):
    return law(t, equilibrium, amplitude, rate, 5.0)


def prony(t, equilibrium, first, rate, second, slow):
    return equilibrium + first * np.exp(-rate * t) + second * np.exp(-slow * t)


def fastest(works, seconds=0.02):
    """Seconds of each work, the fastest of several turns of some hundredths of a second."""
    counts = []
    for work in works:
        work()
        start = time.perf_counter()
        work()
        counts.append(max(1, int(seconds / (time.perf_counter() - start + 1e-9))))
    best = [float("inf")] * len(works)
    for _ in range(RUNS):
        for place, (work, count) in enumerate(zip(works, counts)):
            start = time.perf_counter()
            for _ in range(count):
                work()
            best[place] = min(best[place], (time.perf_counter() - start) / count)
    return best


def shown(seconds):
    for unit, size in [("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)]:
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


class Rows:
    """The table: a line for palpate alone, and one for each peer."""

    def __init__(self):
        self.lines = []

    def add(self, what, own, peers, bound):
        """`own` and the works of `peers` by name in turn; how long palpate takes."""
        names = [name for name, work in peers.items() if work]
        seconds, *others = fastest([own] + [peers[name] for name in names])
        for name, other in zip(names, others) if names else [("", None)]:
            there = f"{shown(other)} | {other / seconds:.3g}" if other else "|"
            self.put(f"| {what} | {shown(seconds)} | {bound} | {name} | {there} |")
        return seconds

    def put(self, line):
        self.lines.append(line)
        print(line, flush=True)


def fit_peers(t, y, model, start, names):
    """The same fit by SciPy and lmfit."""
    peers, square = {}, np.inf
    if "scipy" in THERE:
        from scipy.optimize import curve_fit

        peers["SciPy `curve_fit`"] = lambda: curve_fit(model, t, y, p0=start, maxfev=20_000)
        square = float(np.sum((model(t, *curve_fit(model, t, y, p0=start, maxfev=20_000)[0]) - y) ** 2))
    if "lmfit" in THERE:
        import lmfit

        described = lmfit.Model(model)
        guess = described.make_params(**dict(zip(names, start)))
        peers["lmfit `Model.fit`"] = lambda: described.fit(y, guess, t=t)
    return peers, square


def fits(rows):
    """Fits of 1000 samples, of the law that made them and of others, and their bands."""
    t = np.linspace(0.0, 40.0, 1000)
    noise = np.random.default_rng(1).normal(0.0, 1e-4, t.size)
    hold, two = law(t, 0.2, 0.1, 0.5, 5.0) + noise, prony(t, 0.2, 0.1, 1 / 1.5, 0.07, 1 / 15) + noise
    all_names = ["equilibrium", "amplitude", "rate", "exponent"]
    prony_names = ["equilibrium", "first", "rate", "second", "slow"]
    for what, y, name, model, start, names, bound in [
        ("fit, n = 5", hold, "latency:5", law_5, [0.19, 0.11, 0.6], all_names[:3], "15 µs"),
        ("fit, n free", hold, "latency", law, [0.19, 0.11, 0.6, 4.5], all_names, "80 µs"),
        ("fit, Prony of 2 terms", two, "prony:2", prony, [0.19, 0.11, 0.6, 0.06, 0.06], prony_names, "200 µs"),
        ("misfit, n free on two exponentials", two, "latency", law, [0.2, 0.17, 0.5, 2.0], all_names, ""),
        ("misfit, Prony of 2 terms on n = 5", hold, "prony:2", prony, [0.23, 0.04, 1.0, 0.03, 0.1], prony_names, ""),
    ]:
        peers, square = fit_peers(t, y, model, start, names)
        if name == "prony:2" and "rheojax" in THERE:
            from rheojax.models import GeneralizedMaxwell

            peers["rheojax `GeneralizedMaxwell`"] = lambda y=y: GeneralizedMaxwell(n_modes=2).fit(t, y, test_mode="relaxation")
        fit = palpate.fit_hold(t, y, law=name)
        assert fit.residual_square <= square * (1 + 1e-9), f"{what}: not the same optimum"
        seconds = rows.add(what, lambda: palpate.fit_hold(t, y, law=name), peers, bound)
        rows.add(f'{what}, `noise="white"`', lambda: palpate.fit_hold(t, y, law=name, noise="white"), peers, bound)
        bands = {}
        if "scipy" in THERE:
            bands["delta method in NumPy"] = delta_method(t, y, model, start)
        rows.add(f"band of 1000 points, {what}", lambda: fit.predict(t, interval=0.95), bands, f"{shown(seconds)}, its fit")
    for what, name, noise, bound in [
        ("n = 5", "latency:5", "residuals", "60000 fits/s"),
        ('n = 5, `noise="white"`', "latency:5", "white", "60000 fits/s"),
        ("n free", "latency", "residuals", ""),
    ]:
        seconds = one_core(name, noise)
        rows.put(f"| `fit_many`, 1000 × 1000, one core, {what} | {1000 / seconds:.0f} fits/s | {bound} | | | |")


def delta_method(t, y, model, start):
    """A band by the covariance of white noise and differences of the curve, as one writes it in NumPy."""
    from scipy.optimize import curve_fit
    from scipy.stats import t as student

    best, covariance = curve_fit(model, t, y, p0=start, maxfev=20_000)
    factor = student.ppf(0.975, t.size - len(best))

    def band():
        value = model(t, *best)
        slopes = []
        for i, x in enumerate(best):
            step = 1e-6 * max(abs(x), 1e-3)
            slopes.append((model(t, *(best + step * (np.arange(best.size) == i))) - value) / step)
        slopes = np.array(slopes)
        half = factor * np.sqrt(np.einsum("it,ij,jt->t", slopes, covariance, slopes))
        return value, value - half, value + half

    return band


def one_core(name, noise):
    """Seconds of 1000 fits in a process of one thread."""
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    command = [sys.executable, "-c", ONE_CORE, name, noise]
    return float(subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout)


def surrogate(library, root):
    """A step of closed contacts with n = 5 as arrays: jaw and node behind after it, and the forces."""

    def step(jaw, behind, to, dt):
        depth, thickness, rate, modulus = 0.035, 0.035 / 8, 2e4, 28e3
        u = 0.5 * to
        kick = 0.5 * (u - jaw) * 7 / depth
        x = (jaw - behind) / thickness - jaw / depth + kick
        square = x * x
        x = x / root(root(1 + 4 * rate * square * square * dt)) + kick
        behind = u - thickness * (x + u / depth)
        return u, behind, modulus * (u - behind) / thickness * (np.pi * u * (2 * depth - u))

    return step


def contacts(rows):
    """Steps of one contact and of 10,000, and how long many models take to be made."""
    step = palpate.ContactState(MODEL).step
    rows.add("step of one contact", lambda: step(1e-3, 2e-3), {}, "500 ns")
    count = 10_000
    to = np.full(count, 2e-3)
    many, zero = palpate.ContactStates(MODEL, count), np.zeros(count)
    first = many.step(1e-3, to)
    peers = {}
    plain = surrogate(np, np.sqrt)
    state = plain(zero, zero, to, 1e-3)
    assert np.allclose(first, state[2], rtol=1e-12), "the surrogate is another model"
    peers["NumPy"] = lambda: plain(state[0], state[1], to, 1e-3)
    if "numba" in THERE:
        import numba

        @numba.njit(parallel=True)
        def compiled(jaw, behind, to, dt, force):
            for i in numba.prange(jaw.size):
                u = 0.5 * to[i]
                kick = 0.5 * (u - jaw[i]) * 7 / 0.035
                x = (jaw[i] - behind[i]) / (0.035 / 8) - jaw[i] / 0.035 + kick
                square = x * x
                x = x / np.sqrt(np.sqrt(1 + 4 * 2e4 * square * square * dt)) + kick
                behind[i] = u - 0.035 / 8 * (x + u / 0.035)
                jaw[i] = u
                force[i] = 28e3 * (u - behind[i]) / (0.035 / 8) * (np.pi * u * (0.07 - u))

        arrays = [zero.copy(), zero.copy(), to, 1e-3, zero.copy()]
        compiled(*arrays)
        assert np.allclose(first, arrays[4], rtol=1e-12)
        peers["numba, parallel"] = lambda: compiled(*arrays)
    if "jax" in THERE:
        import jax
        import jax.numpy as jnp

        jax.config.update("jax_enable_x64", True)
        jitted = jax.jit(surrogate(jnp, jnp.sqrt))
        there = [jnp.asarray(column) for column in (zero, zero, to)]
        assert np.allclose(first, jitted(*there, 1e-3)[2], rtol=1e-12)
        peers["JAX, compiled"] = lambda: jitted(*there, 1e-3)[2].block_until_ready()
    rows.add("step of 10,000 contacts", lambda: many.step(1e-3, to), peers, "100 µs")
    for exponent in (1, 2.5):
        other = palpate.ContactStates({**MODEL, "law": {**MODEL["law"], "exponent": exponent, "rate_coefficient": "10 /s"}}, count)
        rows.add(f"step of 10,000 contacts, n = {exponent}", lambda: other.step(1e-3, to), {}, "")
    own = [{**MODEL, "specimen": {**MODEL["specimen"], "radius_m": 0.03 + 1e-6 * i}} for i in range(4096)]
    for model in own:
        del model["specimen"]["radius"]
    rows.add("4096 models made, all different", lambda: palpate.ContactStates(own), {}, "20 ms")
    rows.add("4096 models made, all alike", lambda: palpate.ContactStates([MODEL] * 4096), {}, "20 ms")


def small(rows):
    """What a call costs."""
    tiny = np.array([0.0, 1.0])
    rows.add("a call of the law on two times", lambda: palpate._palpate.latency(tiny, 1.0, 1.0, 1.0, 2.0), {}, "3 µs")
    load = [sys.executable, "-c", LOAD]
    loads = [float(subprocess.run(load, capture_output=True, text=True, check=True).stdout) for _ in range(RUNS)]
    rows.put(f"| import, NumPy loaded | {shown(min(loads))} | 60 ms | | | |")


def main():
    rows = Rows()
    fits(rows)
    contacts(rows)
    small(rows)
    if "--write" in sys.argv:
        versions = ", ".join(f"{peer} {version(peer)}" for peer in ["numpy", *THERE])
        absent = [peer for peer in PEERS if peer not in THERE]
        left = f" Not installed here: {', '.join(absent)}." if absent else ""
        page = f"""# Speed of the Python package

Written by `validation/python_speed.py`: palpate {palpate.__version__}, CPython {platform.python_version()}, {versions}, {len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[0]:.1f} at the end.{left}
The fastest of {RUNS} runs in turn. Ratios are the peer's time over palpate's, of the same run. Peers start near the truth; palpate has no starting values.

| what | palpate | requested | peer | its time | ratio |
|---|---:|---:|---|---:|---:|
{chr(10).join(rows.lines)}
"""
        (Path(__file__).parent / "results" / "python_speed.md").write_text(page, encoding="utf-8")


ONE_CORE = """
import sys, time, numpy as np, palpate
t = np.linspace(0.0, 40.0, 1000)
clean = palpate.laws.latency(t, 0.2, 0.1, 0.5, 5.0)
rows = clean + np.random.default_rng(1).normal(0.0, 1e-4, (1000, t.size))
best = 9e9
for _ in range(9):
    start = time.perf_counter()
    palpate.fit_many(t, rows, law=sys.argv[1], noise=sys.argv[2])
    best = min(best, time.perf_counter() - start)
print(best)
"""

LOAD = """
import time, numpy
start = time.perf_counter()
import palpate
print(time.perf_counter() - start)
"""

if __name__ == "__main__":
    main()
