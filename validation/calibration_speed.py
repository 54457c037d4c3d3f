"""Calibrations by palpate beside scipy.optimize.least_squares over the same simulation, in one run.

    python validation/calibration_speed.py            prints the table
    python validation/calibration_speed.py --write    also writes validation/results/calibration_speed.md

1. example: examples/records/ball.csv, the latency law alone, with its profiles, and with its four alternatives.
2. long: 24 holds of a ball, 13,000 samples of 0.02 N noise, the latency law and six alternatives; and 13,000 samples in every hold.
3. SciPy: the four parameters of the latency law (modulus, n, v, layer thickness) from one start, each off by a factor of 1.2, by
   least_squares (trf, x_scale "jac") over palpate.simulate of the protocol behind the example. palpate searches a grid for its start.

The package has to be installed for the Python that runs this, built for release.
"""

import argparse
import os
import pathlib
import platform
import tomllib
import warnings

import numpy as np
import palpate
import scipy
from scipy.optimize import least_squares

from peers import median_time, show

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "validation" / "results" / "calibration_speed.md"
RECORDS = ROOT / "examples" / "records"
PROTOCOL = ROOT / "examples" / "protocols" / "ball-record.toml"
ALTERNATIVES = ["standard-linear-solid", "prony:2", "prony:3", "fung:2"]
SIX = [*ALTERNATIVES, "fung:1", "latency:3"]
HOLDS = 24
RADIUS_M = 0.035


def long_record(samples):
    """24 holds of a ball up and down, as many samples in all."""
    protocol = tomllib.loads(PROTOCOL.read_text(encoding="utf-8"))
    depths = [2 + 3 * (min(i % 8, 8 - i % 8)) for i in range(HOLDS)]
    steps = [{"to": f"{depth} mm", "rate": "500 mm/min", "hold": "20 s"} for depth in depths]
    trajectory = palpate.simulate({**protocol, "step": steps, "output": {"sample_rate": f"{samples / (HOLDS * 20.4):.6f} Hz"}})
    noise = np.random.default_rng(5).normal(0.0, 0.02, len(trajectory.force_n))
    test = {"specimen": {"shape": "ball", "radius": f"{RADIUS_M} m"}, "contact": {"squeezed_from": "two sides", "separation": True,
                                                                              "touch": "as recorded"}}
    record = palpate.Record.from_arrays(time_s=trajectory.time_s, force_n=trajectory.force_n + noise,
                                        displacement_m=trajectory.displacement_m)
    return record, test


def by_scipy(record):
    """Parameters by SciPy from one start, and the evaluations of the simulation it took."""
    protocol = tomllib.loads(PROTOCOL.read_text(encoding="utf-8"))
    time, force = np.asarray(record.time_s), np.asarray(record.force_n)
    calls = 0

    def residuals(logs):
        nonlocal calls
        calls += 1
        modulus, exponent, rate, thickness = np.exp(logs)
        trajectory = palpate.simulate({
            **protocol,
            "specimen": {"shape": "ball", "radius_m": RADIUS_M, "modulus_pa": modulus},
            "law": {"name": "latency", "exponent": exponent, "rate_coefficient_per_s": rate},
            "contact": {"layer_thickness_m": thickness, "squeezed_from": "two sides", "separation": True},
        })
        return np.interp(time, trajectory.time_s, trajectory.force_n) - force

    start = np.log(np.array([28e3, 5.0, 2e4, RADIUS_M / 8]) * [1.2, 0.83, 1.2, 0.83])
    found = least_squares(residuals, start, x_scale="jac")
    return np.exp(found.x), np.sqrt(2 * found.cost / len(time)), calls


def rows(runs):
    example = palpate.read(RECORDS / "ball.csv", test=RECORDS / "ball.toml")
    alone = median_time(lambda: example.calibrate(alternatives=[]), runs)
    profiles = median_time(lambda: example.calibrate(alternatives=[], profile=True), runs)
    compared = median_time(lambda: example.calibrate(alternatives=ALTERNATIVES), runs)
    yield f"| example, 2,061 samples: latency law | {show(alone)} | |"
    yield f"| the same with profiles | {show(profiles)} | {profiles / alone:.1f} times the law alone |"
    yield f"| the same with four alternatives | {show(compared)} | |"
    for samples in (13_000, HOLDS * 13_000):
        record, test = long_record(samples)
        seven = median_time(lambda: record.calibrate(test=test, alternatives=SIX), 1)
        yield f"| {HOLDS} holds, {len(record.time_s):,} samples: seven laws | {show(seven)} | |"
    parameters, rmse, calls = by_scipy(example)
    scipy_time = median_time(lambda: by_scipy(example), 1)
    ours = example.calibrate(alternatives=[])
    values = ours.material.parameters
    off = max(abs(a / b - 1) for a, b in zip(parameters, [values["modulus_pa"], values["exponent"],
                                                          values["rate_coefficient_per_s"], values["layer_thickness_m"]]))
    yield (f"| SciPy, latency law from one start, {calls} simulations | {show(scipy_time)} | {scipy_time / alone:.1f} times palpate; "
           f"leaves {rmse:.5f} N, palpate {ours.rmse_n:.5f} N; parameters within {off:.1%} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    options = parser.parse_args()
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    text = "\n".join([
        "# Speed of calibrations",
        "",
        "Made by `python validation/calibration_speed.py --write`; its header says what is timed.",
        f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, SciPy {scipy.__version__}.",
        "",
        "| what | time | beside |",
        "|---|---|---|",
        *rows(options.runs),
        "",
    ])
    print(text)
    if options.write:
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
