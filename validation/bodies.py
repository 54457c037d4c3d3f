"""Bodies other than the paper's: Hertz's ball, a body by a table of its contact area, a body by a table of its equilibrium force.

    F = S(u1) (x + u1/depth),  S = E A(u1)                                    area from a table
                               S = 4/3 E/(1 - nu^2) sqrt(r u1) depth          Hertz
                               S = depth F_e(u1)/u1                           measured, F_e/u1 between the rows by PCHIP

x of the contact layer is that of any body. Driven by a motion: SciPy's DOP853 at a relative tolerance of 1e-13, restarted at kinks.
Driven by a force: as in creep.py, DOP853 and Radau. Tables between their rows: scipy.interpolate.PchipInterpolator.
"""

import math

import numpy as np
from scipy.interpolate import PchipInterpolator

import creep
from _common import round_up, write_reference
from _contact import integrate

AREAS = [[0.0, 0.0], [0.0005, 1e-5], [0.001, 6e-5], [0.002, 9e-5], [0.004, 2e-4], [0.008, 2e-4], [0.01, 2.6e-4]]
FORCES = [[0.0, 0.0], [0.0005, 0.02], [0.0012, 0.07], [0.003, 0.3], [0.006, 0.9], [0.009, 1.8]]
PUNCH = {"body": "profile", "depth": 0.012, "modulus": 1e5, "rows": AREAS}
BALL = {"body": "hertz", "depth": 0.02, "modulus": 5e4, "poisson_ratio": 0.5}
FINGER = {"body": "measured", "depth": 0.015, "modulus": 1.0, "rows": FORCES}
PUSH = [[0.0, 0.0], [2.0, 0.003], [12.0, 0.003], [15.0, 0.0075], [40.0, 0.0075], [42.0, 0.005], [60.0, 0.005]]
LOAD = [[0.0, 0.0], [3.0, 0.8], [20.0, 0.8], [25.0, 0.2], [60.0, 0.2]]


def law(n, v, m):
    return {"exponent": float(n), "rate_coefficient": float(v), "layers": float(m)}


MOTIONS = [
    {"name": "punch by its areas, two sides", **PUNCH, **law(3, 50, 8), "sides": 2, "knots": PUSH},
    {"name": "punch by its areas, one side", **PUNCH, **law(5, 2e4, 8.5), "sides": 1, "knots": PUSH},
    {"name": "Hertz's ball, two sides", **BALL, **law(2, 30, 8), "sides": 2, "knots": PUSH},
    {"name": "finger by its forces, one side", **FINGER, **law(1.5, 4, 16), "sides": 1, "knots": PUSH},
]
FORCED = [
    {"name": "punch by its areas, 0.8 N", **PUNCH, **law(3, 50, 8), "sides": 1, "knots": LOAD},
    {"name": "Hertz's ball, 0.8 N", **BALL, **law(2, 30, 8), "sides": 1, "knots": LOAD},
    {"name": "finger by its forces, 0.8 N", **FINGER, **law(1.5, 4, 16), "sides": 1, "knots": LOAD},
]


def stiffness_of(case):
    depth = case["depth"]
    if case["body"] == "hertz":
        nu = case["poisson_ratio"]
        return lambda u: 4 / 3 * case["modulus"] / (1 - nu * nu) * math.sqrt(depth * max(u, 0.0)) * depth
    if case["body"] == "profile":
        area = PchipInterpolator(*np.transpose(case["rows"]))
        return lambda u: case["modulus"] * float(area(u))
    (u1, f1), (u2, f2) = case["rows"][1:3]
    touch = max(0.0, f1 / u1 - u1 * (f2 / u2 - f1 / u1) / (u2 - u1))
    rows = [(0.0, touch)] + [(u, f / u) for u, f in case["rows"][1:]]
    ratio = PchipInterpolator(*np.transpose(rows))
    return lambda u: depth * float(ratio(u))


class AnyBody(creep.Body):
    def __init__(self, case):
        self.case = {"modulus": 1.0, "shape": case["body"]}
        self.n, self.v, self.depth = case["exponent"], case["rate_coefficient"], case["depth"]
        self.layer = self.depth / case["layers"]
        self.area = stiffness_of(case)


def main():
    cases = []
    for given in MOTIONS:
        times = creep.sample_times(given["knots"])
        excess = integrate({**given, "radius": given["depth"]}, times)
        share = np.interp(times, *np.transpose(given["knots"])) / given["sides"]
        stiffness = stiffness_of(given)
        force = [stiffness(u) * (x + u / given["depth"]) for u, x in zip(share, excess)]
        cases.append({**given, "times": times, "driven_by": "displacement", "force": force})
        print(f"{given['name']:34s} force up to {max(force):.4f} N", flush=True)
    for given in FORCED:
        times, body = creep.sample_times(given["knots"]), AnyBody(given)
        found, other = (creep.solve(given, *how, times, body) for how in (("DOP853", 1e-13), ("Radau", 1e-11)))
        off = max(abs(a - b) for (a, _), (b, _) in zip(found, other)) / body.depth
        print(f"{given['name']:34s} u up to {1e3 * max(u for u, _ in found):.3f} mm, Radau {off:.1e}", flush=True)
        assert off < 1e-8, given["name"]
        cases.append({**given, "times": times, "driven_by": "force", "contact_displacement": [u for u, _ in found],
                      "agreement": round_up(off)})
    write_reference("bodies", ["scipy", "numpy"],
                    {"force_relative_to_largest": 1e-10, "displacement_over_depth": 1e-9}, cases)


if __name__ == "__main__":
    main()
