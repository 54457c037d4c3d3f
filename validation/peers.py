"""Palpate beside SciPy on the same machine: run time of a simulation and a fit, throughput of an analysis.

    python validation/peers.py                        SciPy's side, and Rust's from `--example timing`
    python validation/peers.py --palpate PATH         also times `PATH analyze` on a 1e6-row CSV file
    python validation/peers.py --palpate PATH --write also writes validation/results/peers.md

1. simulate: eight layers, five stops of 5 mm at 500 mm/min held 10 s, back to 0, 66 s at 100 Hz.
   SciPy: solve_ivp, LSODA, rtol 1e-8, atol 1e-10, restarted at the kinks. Median of 7.
   Twice: all eight layers, and the contact layer alone (the force needs no other).
2. fit: 1000 points of a hold, n = 5, parameters y_e, delta, ln lambda.
   SciPy: curve_fit (Levenberg-Marquardt), analytic Jacobian, started 10 % off. Median of 200.
3. laws: 1000 points of a hold, free numbers as named; SciPy's curve_fit with an analytic Jacobian and lmfit's Model
   (its own numerical Jacobian), both started 10 to 20 % off, where palpate is given no start. Median of 50 and 5.
4. analyze: wall time, MB/s and peak memory, median of 3.
"""

import argparse
import json
import os
import pathlib
import platform
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.optimize import curve_fit

ROOT = pathlib.Path(__file__).resolve().parent.parent
R, E, N_EXP, V, M = 0.035, 2.8e4, 5, 2e4, 8


def knots():
    t, d, out = 0.0, 0.0, [(0.0, 0.0)]
    for stop in (5, 10, 15, 20, 25):
        t, d = t + 0.6, stop / 1000
        out.append((t, d))
        t += 10.0
        out.append((t, d))
    out += [(t + 3.0, 0.0), (t + 13.0, 0.0)]
    return out


def simulate():
    """Jaw force at 100 Hz."""
    behind = 1.0 - np.arange(M - 1) / M
    grid = np.linspace(0.0, 66.0, 6601)
    w, t_out, force = np.zeros(M - 1), [0.0], [0.0]
    steps = knots()
    for (ta, da), (tb, db) in zip(steps, steps[1:]):
        slope = (db - da) / (tb - ta) / 2 / R
        start = da / 2 / R
        u, inner = np.empty(M), np.zeros(M)

        def rhs(t, w):
            u[0], u[1:] = start + slope * (t - ta), w
            inner[:-1] = w
            x = M * (u[:-1] - inner[:-1]) - u[:-1] / behind
            return V / M * np.sign(x) * np.abs(x) ** N_EXP

        at = grid[(grid > ta + 1e-9) & (grid <= tb + 1e-9)]
        at = np.append(np.minimum(at, tb), [] if len(at) and abs(at[-1] - tb) < 1e-9 else [tb])
        sol = solve_ivp(rhs, (ta, tb), w, method="LSODA", rtol=1e-8, atol=1e-10, t_eval=at)
        assert sol.success, sol.message
        w = sol.y[:, -1]
        top = start + slope * (sol.t - ta)
        strain = M * (top - sol.y[0])
        t_out.extend(sol.t)
        force.extend(E * strain * np.pi * R * R * (2 * top - top * top))
    return np.array(t_out), np.array(force)


def simulate_contact_layer():
    """The same force from the contact layer alone, which is all that it depends on: one unknown, plain floats."""
    grid = np.linspace(0.0, 66.0, 6601)
    x, force = 0.0, [np.zeros(1)]
    steps = knots()
    for (ta, da), (tb, db) in zip(steps, steps[1:]):
        slope = (db - da) / (tb - ta) / 2 / R
        g = slope * (M - 1)

        def rhs(_, y):
            value = y[0]
            return (g - V * abs(value) ** (N_EXP - 1) * value,)

        at = grid[(grid > ta + 1e-9) & (grid <= tb + 1e-9)]
        at = np.append(np.minimum(at, tb), [] if len(at) and abs(at[-1] - tb) < 1e-9 else [tb])
        sol = solve_ivp(rhs, (ta, tb), [x], method="LSODA", rtol=1e-8, atol=1e-10, t_eval=at)
        assert sol.success, sol.message
        x = sol.y[0, -1]
        top = da / 2 / R + slope * (sol.t - ta)
        force.append(E * (sol.y[0] + top) * np.pi * R * R * (2 * top - top * top))
    return np.concatenate(force)


def hold_data():
    rng = np.random.default_rng(7)
    t = np.linspace(0.0, 10.0, 1000)
    y = 0.357 + 0.133 * (1 + 4 * 6.26 * t) ** -0.25 + rng.normal(0.0, 2e-4, t.size)
    return t, y


def fit(t, y):
    def law(t, y_e, delta, log_lambda):
        return y_e + delta * (1 + 4 * np.exp(log_lambda) * t) ** -0.25

    def jacobian(t, y_e, delta, log_lambda):
        z = np.exp(log_lambda) * t
        p = (1 + 4 * z) ** -0.25
        out = np.empty((t.size, 3))
        out[:, 0], out[:, 1], out[:, 2] = 1.0, p, -delta * z * p**5
        return out

    return curve_fit(law, t, y, p0=(0.33, 0.145, np.log(6.9)), jac=jacobian)


def exponentials():
    """1 + 0.5 exp(-4 t) + 0.5 exp(-0.4 t), the hold of examples/timing.rs."""
    rng = np.random.default_rng(7)
    t = np.linspace(0.0, 10.0, 1000)
    return t, 1 + 0.5 * np.exp(-4 * t) + 0.5 * np.exp(-0.4 * t) + rng.normal(0.0, 1e-3, t.size)


def power(t, y_e, delta, log_rate, n):
    return y_e + delta * (1 + (n - 1) * np.exp(log_rate) * t) ** (-1 / (n - 1))


def power_jacobian(t, y_e, delta, log_rate, n):
    s, p = np.exp(log_rate) * t, n - 1
    z = p * s
    phi = (1 + z) ** (-1 / p)
    by_n = phi * (np.log1p(z) / p - s / (1 + z)) / p
    return np.column_stack([np.ones_like(t), phi, -delta * s * phi / (1 + z), delta * by_n])


def exponential(t, y_e, delta, log_rate):
    return y_e + delta * np.exp(-np.exp(log_rate) * t)


def exponential_jacobian(t, y_e, delta, log_rate):
    s = np.exp(log_rate) * t
    phi = np.exp(-s)
    return np.column_stack([np.ones_like(t), phi, -delta * s * phi])


def two(t, y_e, a, b, log_rate, log_other):
    return y_e + a * np.exp(-np.exp(log_rate) * t) + b * np.exp(-np.exp(log_other) * t)


def two_jacobian(t, y_e, a, b, log_rate, log_other):
    s, u = np.exp(log_rate) * t, np.exp(log_other) * t
    p, q = np.exp(-s), np.exp(-u)
    return np.column_stack([np.ones_like(t), p, q, -a * s * p, -b * u * q])


def latency_five(t, y_e, delta, log_rate):
    return y_e + delta * (1 + 4 * np.exp(log_rate) * t) ** -0.25


def law_times():
    """Seconds of SciPy and lmfit per law."""
    import lmfit

    hold, both = hold_data(), exponentials()
    t = both[0]
    one = (t, 1 + np.exp(-0.8 * t) + np.random.default_rng(3).normal(0.0, 1e-3, t.size))
    laws = {
        "fit_hold_1000": (latency_five, None, hold, (0.33, 0.145, np.log(6.9))),
        "fit_hold_1000_free_exponent": (power, power_jacobian, hold, (0.33, 0.145, np.log(6.9), 4.5)),
        "fit_standard-linear-solid_1000": (exponential, exponential_jacobian, one, (0.9, 1.1, np.log(0.9))),
        "fit_prony:2_1000": (two, two_jacobian, both, (0.9, 0.55, 0.45, np.log(4.5), np.log(0.36))),
    }
    times = {}
    for name, (law, jacobian, (t, y), start) in laws.items():
        if jacobian is None:
            scipy_time = median_time(lambda: fit(t, y), 50)
        else:
            scipy_time = median_time(lambda: curve_fit(law, t, y, p0=start, jac=jacobian), 50)
        model = lmfit.Model(law)
        names = model.param_names
        lmfit_time = median_time(lambda: model.fit(y, t=t, **dict(zip(names, start))), 5)
        times[name] = (scipy_time, lmfit_time)
    return times


def median_time(what, runs):
    what()
    times = []
    for _ in range(runs):
        begin = time.perf_counter()
        what()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def rust_times():
    command = ["cargo", "run", "--profile", "dist", "-q", "-p", "palpate", "--example", "timing"]
    try:
        out = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        print("no times from Rust:", (getattr(error, "stderr", "") or str(error)).strip()[-400:], file=sys.stderr)
        return {}
    rows = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    return {row["name"]: row["seconds"] for row in rows}


def make_csv(path, rows):
    """Time (s), jaw travel (mm), force (N): the protocol above, a jaw that cannot pull, a little noise."""
    rng = np.random.default_rng(11)
    t = np.linspace(0.0, knots()[-1][0], rows)
    x, d, x0 = np.zeros(rows), np.interp(t, *zip(*knots())), 0.0
    steps = knots()
    for (ta, da), (tb, db) in zip(steps, steps[1:]):
        part = (t > ta) & (t <= tb) if ta > 0 else t <= tb
        g = (db - da) / (tb - ta) / 2 * (M - 1) / R
        if g == 0:
            lam = V * abs(x0) ** 4
            x[part] = x0 * (1 + 4 * lam * (t[part] - ta)) ** -0.25
            x0 *= (1 + 4 * lam * (tb - ta)) ** -0.25
        else:
            sol = solve_ivp(lambda _, y: [g - V * np.sign(y[0]) * abs(y[0]) ** 5], (ta, tb), [x0],
                            method="DOP853", rtol=1e-10, atol=1e-12, dense_output=True)
            x[part], x0 = sol.sol(t[part])[0], sol.y[0][-1]
    u = d / 2
    force = np.maximum(0.0, E * (x + u / R) * np.pi * (2 * R * u - u * u))
    table = np.column_stack([t, d * 1000 + rng.normal(0, 2e-4, rows), force + rng.normal(0, 0.01, rows)])
    np.savetxt(path, table, fmt=["%.6f", "%.5f", "%.5f"], delimiter=",",
               header="time_s,displacement_mm,force_n", comments="")


# Peak memory is taken in a small process of its own: a child's figure starts at its parent's.
MEASURE = """
import json, os, subprocess, sys, time
begin = time.perf_counter()
child = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(child.pid, 0)
child.returncode = 0
print(json.dumps([time.perf_counter() - begin, usage.ru_maxrss, os.waitstatus_to_exitcode(status)]))
"""


def analyze(binary, template, rows):
    with tempfile.TemporaryDirectory() as folder:
        csv, out = os.path.join(folder, "record.csv"), os.path.join(folder, "report.json")
        code = f"import sys; sys.path.insert(0, {str(ROOT / 'validation')!r}); import peers; peers.make_csv({csv!r}, {rows})"
        subprocess.run([sys.executable, "-c", code], check=True)
        size = os.path.getsize(csv) / 1e6
        arguments = [a.format(csv=csv, json=out) for a in shlex.split(template)]
        runs = []
        for _ in range(3):
            done = subprocess.run([sys.executable, "-S", "-c", MEASURE, str(pathlib.Path(binary).resolve()),
                                   *arguments], capture_output=True, text=True, check=True)
            wall, peak, status = json.loads(done.stdout)
            if status != 0:
                sys.exit(f"{binary} {' '.join(arguments)} ended with {status}: {done.stderr[-800:]}")
            runs.append((wall, peak / 1024))  # ru_maxrss is in KiB on Linux
        wall = statistics.median(r[0] for r in runs)
        return size, wall, max(r[1] for r in runs)


def show(seconds):
    if seconds is None:
        return "-"
    for scale, unit in ((1, "s"), (1e-3, "ms"), (1e-6, "us")):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--palpate", help="the palpate program to time")
    parser.add_argument("--analyze-args", default="analyze {csv} --format json",
                        help="its arguments; {csv} and {json} are replaced (default: %(default)r)")
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--write", action="store_true", help="write validation/results/peers.md")
    args = parser.parse_args()

    t, force = simulate()
    golden = 30.9911170463  # N at 43.0 s, from contact_force.py
    assert abs(force[np.argmin(abs(t - 43.0))] / golden - 1) < 1e-5
    assert np.max(np.abs(simulate_contact_layer() - force)) < 1e-4
    th, yh = hold_data()
    peer = {"simulate_protocol_a": median_time(simulate, 7), "contact_layer": median_time(simulate_contact_layer, 7),
            "fit_hold_1000": median_time(lambda: fit(th, yh), 200)}
    rust = rust_times()

    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
               platform.processor()) if os.path.exists("/proc/cpuinfo") else platform.processor()
    lines = ["# Beside SciPy", "",
             f"{cpu}; Python {platform.python_version()}, SciPy {scipy.__version__}, "
             f"NumPy {np.__version__}.", "",
             "| task | SciPy | palpate | ratio |", "|---|---:|---:|---:|"]
    for name, key, what in (
            ("simulate_protocol_a", "simulate_protocol_a_force", "force, 66 s at 100 Hz; SciPy: LSODA, 8 layers"),
            ("contact_layer", "simulate_protocol_a_force", "the same; SciPy: LSODA, contact layer alone"),
            ("fit_hold_1000", "fit_hold_1000", "fit: 1000-point hold, n = 5 (curve_fit, analytic Jacobian)")):
        ours = rust.get(key)
        ratio = f"{peer[name] / ours:.0f}" if ours else "-"
        lines.append(f"| {what} | {show(peer[name])} | {show(ours)} | {ratio} |")
    lines += ["", "| law, 1000 samples, with covariance | SciPy curve_fit | lmfit | palpate, no start given | ratios |",
              "|---|---:|---:|---:|---:|"]
    for key, (scipy_time, lmfit_time) in law_times().items():
        ours = rust.get(key)
        ratios = f"{scipy_time / ours:.0f}, {lmfit_time / ours:.0f}" if ours else "-"
        what = key.removeprefix("fit_").replace("_1000", "").replace("hold", "latency").replace("_", ", ")
        lines.append(f"| {what} | {show(scipy_time)} | {show(lmfit_time)} | {show(ours)} | {ratios} |")
    rest = [(name, seconds) for name, seconds in rust.items() if name.startswith(("fit_", "compare_"))]
    lines += ["", "palpate alone: " + "; ".join(f"{name} {show(seconds)}" for name, seconds in rest) + "."]
    if args.palpate:
        size, wall, peak = analyze(args.palpate, args.analyze_args, args.rows)
        lines += ["", f"`palpate analyze` of a CSV file with {args.rows:.0e} rows ({size:.1f} MB) to JSON: "
                      f"{wall:.2f} s wall, {size / wall:.0f} MB/s, peak memory {peak:.0f} MiB "
                      "(median of 3; the file is read from a warm cache)."]
    lines += ["", "SciPy's right-hand sides are written in Python (the eight layers on NumPy arrays); its fit starts "
                  "10 % from the answer. What palpate does in the same places is in "
                  "crates/palpate/examples/timing.rs."]
    text = "\n".join(lines) + "\n"
    print(text)
    if args.write:
        path = ROOT / "validation" / "results" / "peers.md"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
