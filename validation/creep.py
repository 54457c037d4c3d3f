"""A squeezed ball or block under a force: displacement and excess strain of the contact, creep and recovery.

    E A(u1) (u1 - u2)/l = F(t),  du2/dt = l v sgn(x)|x|^n,  x = (u1 - u2)/l - u1/depth,  l = depth/m
    ball: A = pi (2 r u1 - u1^2), depth = r;  block: A constant, depth = half its length (two sides)

SciPy twice: DOP853 at a relative tolerance of 1e-13 and Radau at 1e-11, restarted at every kink of the force; u1 by Brent's
method. The printed numbers are DOP853's, `agreement` the largest distance between the two in that case, over the depth.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from _common import round_up, write_reference

BALL = {"shape": "ball", "size": [0.035], "modulus": 2.8e4}
BLOCK = {"shape": "block", "size": [1e-3, 0.08], "modulus": 1e5}  # section in m2, length in m


def case(name, knots, n, v, m, body=BALL):
    return {"name": name, **body, "exponent": float(n), "rate_coefficient": float(v), "layers": float(m), "knots": knots}


SQUEEZE = [[0.0, 0.0], [1.0, 10.0], [61.0, 10.0]]
STEPS = [[0.0, 5.0], [20.0, 5.0], [20.0, 12.0], [50.0, 12.0], [50.0, 2.0], [90.0, 2.0]]
RECOVERY = [[0.0, 0.0], [2.0, 15.0], [12.0, 15.0], [12.0, 0.0], [112.0, 0.0]]
SAW = [[0.0, 0.0], [3.0, 9.0], [6.0, 1.0], [8.0, 14.0], [11.0, 3.0], [15.0, 3.0]]

CASES = [
    case("the paper's ball, 10 N", SQUEEZE, 5, 2e4, 8),
    case("steps", STEPS, 5, 2e4, 8),
    case("recovery", RECOVERY, 5, 2e4, 8),
    case("saw", SAW, 5, 2e4, 8),
    case("linear law", RECOVERY, 1, 0.5, 8),
    case("square law, thin layers", SAW, 2, 50, 64),
    case("n = 3/2", SQUEEZE, 1.5, 8, 8.5),
    case("cubic, hardly flows", STEPS, 3, 5, 2),
    case("n = 7.3", STEPS, 7.3, 5e6, 8),
    case("512 layers", SAW, 3, 2e4, 512),
    case("block, linear law", STEPS, 1, 0.2, 8, BLOCK),
    case("block, n = 5, pulled and pressed", [[0.0, 0.0], [2.0, 8.0], [10.0, 8.0], [13.0, -6.0], [20.0, -6.0]], 5, 2e5, 8, BLOCK),
]


class Body:
    def __init__(self, case):
        self.case = case
        self.n, self.v = case["exponent"], case["rate_coefficient"]
        self.depth = case["size"][0] if case["shape"] == "ball" else case["size"][1] / 2
        self.layer = self.depth / case["layers"]

    def area(self, u):
        if self.case["shape"] == "block":
            return self.case["size"][0]
        return math.pi * u * (2 * self.depth - u)

    def contact(self, force, behind):
        if force == 0.0:
            return behind
        off = lambda u: self.case["modulus"] * (u - behind) / self.layer * self.area(u) - force  # noqa: E731
        if self.case["shape"] == "block":
            return behind + force * self.layer / (self.case["modulus"] * self.area(0.0))
        return brentq(off, max(behind, 0.0), self.depth, xtol=1e-18, rtol=4 * np.finfo(float).eps)

    def excess(self, force, behind):
        u = self.contact(force, behind)
        return (u - behind) / self.layer - u / self.depth

    def speed(self, force, behind):
        x = self.excess(force, behind)
        return self.layer * self.v * math.copysign(abs(x) ** self.n, x)


def solve(case, method, rtol, times, body=None):
    """(u1, x) at the times, of which those at a step are after it."""
    body, behind, found = body or Body(case), 0.0, []
    pieces = [(a, b) for a, b in zip(case["knots"], case["knots"][1:]) if b[0] > a[0]]
    for index, ((ta, fa), (tb, fb)) in enumerate(pieces):
        last = index == len(pieces) - 1
        force = lambda t, ta=ta, tb=tb, fa=fa, fb=fb: fa + (fb - fa) * (t - ta) / (tb - ta)  # noqa: E731
        inside = [t for t in times if ta <= t < tb or (last and t == tb)]
        run = solve_ivp(lambda t, y: [body.speed(force(t), y[0])], (ta, tb), [behind], method=method, rtol=rtol,
                        atol=1e-3 * rtol * body.depth, t_eval=sorted({*inside, tb}),
                        first_step=1e-6 * (tb - ta))
        assert run.success, run.message
        for t, y in zip(run.t, run.y[0]):
            if t in inside:
                found.append((body.contact(force(t), y), body.excess(force(t), y)))
        behind = run.y[0][-1]
    return found


def sample_times(knots):
    times = {t for t, _ in knots}
    for (ta, _), (tb, _) in zip(knots, knots[1:]):
        times |= {round(ta + f * (tb - ta), 6) for f in (0.013, 0.11, 0.47, 0.83)}
    return sorted(times)


def main():
    cases = []
    for given in CASES:
        times = sample_times(given["knots"])
        found, other = solve(given, "DOP853", 1e-13, times), solve(given, "Radau", 1e-11, times)
        off = max(abs(a - b) for (a, _), (b, _) in zip(found, other)) / Body(given).depth
        print(f"{given['name']:34s} u up to {1e3 * max(u for u, _ in found):.3f} mm, Radau {off:.1e}", flush=True)
        assert off < 1e-9, given["name"]
        cases.append({**given, "times": times, "contact_displacement": [u for u, _ in found],
                      "excess_strain": [x for _, x in found], "agreement": round_up(off)})
    golden = dict(zip(cases[0]["times"], cases[0]["contact_displacement"]))
    for t, u in [(1.0, 5.8829871173), (61.0, 7.4530053453)]:
        assert abs(1e3 * golden[t] - u) < 6e-11, (t, golden[t])
    worst = max(c["agreement"] for c in cases)
    write_reference("creep", ["scipy", "numpy"],
                    {"displacement_over_depth": 1e-11, "excess_strain": 1e-10,
                     "note": f"DOP853 at 1e-13 and Radau at 1e-11 differ by {worst:.1e} of the depth at most"}, cases)


if __name__ == "__main__":
    main()
