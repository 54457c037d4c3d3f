"""Speed of the Python package against SciPy and lmfit, in one run.

    maturin build --profile dist --manifest-path crates/palpate-python/Cargo.toml --out wheels
    pip install wheels/palpate-*.whl scipy lmfit
    python validation/python_speed.py [--write]

Each figure is the fastest of several runs in turn, so that what else the machine does counts for all alike. SciPy and lmfit get
starting values near the truth and the closed form in NumPy; palpate gets none. With --write the table goes to
validation/results/python_speed.md.
"""

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

import lmfit
import numpy as np
import palpate
import scipy
from scipy.optimize import curve_fit

RUNS = int(os.environ.get("RUNS", "7"))


def law(t, equilibrium, amplitude, rate, exponent):
    """The closed form in NumPy."""
    return equilibrium + amplitude * (1 + (exponent - 1) * rate * t) ** (-1 / (exponent - 1))


def fastest(*works):
    """Seconds of each work, the fastest of several turns."""
    best = [float("inf")] * len(works)
    for _ in range(RUNS):
        for place, work in enumerate(works):
            start = time.perf_counter()
            work()
            best[place] = min(best[place], time.perf_counter() - start)
    return best


def repeated(work, count):
    """The same work many times."""

    def run():
        for _ in range(count):
            work()

    return run


def main():
    t = np.linspace(0.0, 40.0, 1000)
    random = np.random.default_rng(1)
    rows = law(t, 0.2, 0.1, 0.5, 5.0) + random.normal(0.0, 1e-4, (1000, t.size))
    y, start = rows[0], [0.19, 0.11, 0.6, 4.5]
    bounds = ([-1.0, 0.0, 1e-4, 1.01], [1.0, 1.0, 1e3, 30.0])
    model = lmfit.Model(law)
    guess = model.make_params(
        equilibrium=start[0],
        amplitude={"value": start[1], "min": 0},
        rate={"value": start[2], "min": 1e-4},
        exponent={"value": start[3], "min": 1.01, "max": 30},
    )
    lines = []

    def row(what, seconds, per, bound, peer=""):
        lines.append(f"| {what} | {seconds} | {per} | {bound} |{peer}")
        print(lines[-1], flush=True)

    held = model.make_params(equilibrium=start[0], amplitude=start[1], rate=start[2], exponent={"value": 5, "vary": False})

    def law_5(t, equilibrium, amplitude, rate):
        return law(t, equilibrium, amplitude, rate, 5.0)

    works = [
        (lambda: palpate.fit_hold(t, y), 20),
        (lambda: palpate.fit_hold(t, y, law="latency:5"), 50),
        (lambda: curve_fit(law, t, y, p0=start, bounds=bounds), 3),
        (lambda: curve_fit(law, t, y, p0=start), 5),
        (lambda: curve_fit(law_5, t, y, p0=start[:3]), 5),
        (lambda: model.fit(y, guess, t=t), 2),
        (lambda: model.fit(y, held, t=t), 2),
    ]
    times = fastest(*(repeated(work, count) for work, count in works))
    ours, fixed, scipys, free, scipy_5, lms, lms_5 = (time / count for time, (_, count) in zip(times, works))
    for own, theirs in [
        (palpate.fit_hold(t, y), law(t, *curve_fit(law, t, y, p0=start)[0])),
        (palpate.fit_hold(t, y, law="latency:5"), law_5(t, *curve_fit(law_5, t, y, p0=start[:3])[0])),
    ]:
        assert own.residual_square <= np.sum((theirs - y) ** 2) * (1 + 1e-9), "not the same optimum"
    row("`fit_hold`, 1000 samples, n = 5", f"{1e6 * fixed:.0f} µs", "", "")
    row("`scipy.optimize.curve_fit`, n = 5", f"{1e3 * scipy_5:.2f} ms", f"{scipy_5 / fixed:.0f}", "10")
    row("lmfit `Model.fit`, n = 5", f"{1e3 * lms_5:.2f} ms", f"{lms_5 / fixed:.0f}", "80")
    row("`fit_hold`, 1000 samples, n found", f"{1e6 * ours:.0f} µs", "", "")
    row("`scipy.optimize.curve_fit`, n found, n > 1", f"{1e3 * scipys:.2f} ms", f"{scipys / ours:.0f}", "10")
    row("`scipy.optimize.curve_fit`, n found, no bounds", f"{1e3 * free:.2f} ms", f"{free / ours:.0f}", "10")
    row("lmfit `Model.fit`, n found", f"{1e3 * lms:.2f} ms", f"{lms / ours:.0f}", "80")

    [many] = fastest(lambda: palpate.fit_many(t, rows))
    cores = len(os.sched_getaffinity(0))

    def one_core(law):
        alone = [sys.executable, "-c", ONE_CORE, law]
        environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
        return float(subprocess.run(alone, capture_output=True, text=True, check=True, env=environment).stdout)

    one, one_5 = one_core("latency"), one_core("latency:5")
    row("`fit_many`, 1000 × 1000, one core, n = 5", f"{1000 / one_5:.0f} fits/s", f"{scipy_5 * 1000 / one_5:.0f}", "15")
    row("`fit_many`, 1000 × 1000, one core, n found", f"{1000 / one:.0f} fits/s", f"{scipys * 1000 / one:.0f} (bounded), {free * 1000 / one:.0f}", "15")
    row(f"`fit_many`, 1000 × 1000, {cores} cores", f"{1000 / many:.0f} fits/s", f"{one / many:.2f} times one core", "")

    tiny = np.array([0.0, 1.0])
    calls = 100_000
    [called] = fastest(repeated(lambda: palpate.laws.names, calls))
    [overhead] = fastest(repeated(lambda: palpate._palpate.latency(tiny, 1.0, 1.0, 1.0, 2.0), calls))
    row("a call of the law on two times", f"{1e6 * (overhead - called) / calls:.2f} µs", "", "3 µs")

    model = {
        "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
        "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    }
    step = palpate.ContactState(model).step

    def stepped():
        for _ in range(calls):
            step(1e-3, 2e-3)

    [steps] = fastest(stepped)
    row("a step of `ContactState`", f"{1e9 * steps / calls:.0f} ns", "", "300 ns")
    contacts, to = palpate.ContactStates(model, 1000), np.full(1000, 2e-3)
    [together] = fastest(repeated(lambda: contacts.step(1e-3, to), 100))
    row("a step of 1000 `ContactStates`", f"{1e6 * together / 100:.0f} µs", f"{steps / calls * 1e5 / together:.1f} times as fast", "")

    load = [sys.executable, "-c", LOAD]
    loads = [float(subprocess.run(load, capture_output=True, text=True, check=True).stdout) for _ in range(RUNS)]
    row("import, NumPy loaded", f"{1e3 * min(loads):.1f} ms", "", "60 ms")

    if "--write" in sys.argv:
        page = f"""# Speed of the Python package

Written by `validation/python_speed.py`: palpate {subprocess.run(["palpate", "--version"], capture_output=True, text=True, check=True).stdout.split()[1]}, CPython {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}, lmfit {lmfit.__version__}, {cores} cores.
The fastest of {RUNS} runs in turn. SciPy and lmfit start near the truth; palpate has no starting values. Ratios are to palpate's row for the same n.

| what | time or rate | ratio | requested |
|---|---:|---:|---:|
{chr(10).join(lines)}
"""
        (Path(__file__).parent / "results" / "python_speed.md").write_text(page, encoding="utf-8")


ONE_CORE = """
import sys, time, numpy as np, palpate
t = np.linspace(0.0, 40.0, 1000)
clean = palpate.laws.latency(t, 0.2, 0.1, 0.5, 5.0)
rows = clean + np.random.default_rng(1).normal(0.0, 1e-4, (1000, t.size))
best = 9e9
for _ in range(5):
    start = time.perf_counter()
    palpate.fit_many(t, rows, law=sys.argv[1])
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
