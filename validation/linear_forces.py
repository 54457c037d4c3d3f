"""Linear contacts under a force (creep, recovery), and with a memory of force instead of strain (Fung's quasi-linear law).

    memory of strain   q = u/depth,  F = S(u) (q + sum x_k),  S = E A(u)
    memory of force    q = Fe(u),    F = q + sum x_k          Fe = S u/depth, or Hertz's 4/3 E/(1 - nu^2) sqrt(r) u^(3/2)
    both               z_k = x_k - g_k q,  dz_k/dt = -l_k (z_k + g_k q)

z does not jump with the force. SciPy twice: DOP853 at a relative tolerance of 1e-13 and Radau at 1e-11, restarted at every kink;
u by Brent's method. The printed numbers are DOP853's, `agreement` the largest distance between the two, relative to the largest.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from _common import round_up, write_reference
from _contact import ramp_and_hold
from creep import RECOVERY, SAW, STEPS, sample_times
from linear_contacts import BALL, BLOCK, RELEASE, THREE

HERTZ = {**BALL, "poisson_ratio": 0.5}
SPREAD = [[1.0, 1e-3], [0.5, 0.05], [0.8, 1.5], [2.0, 40.0], [0.3, 2e3]]
PULLED = [[0.0, 0.0], [2.0, 8.0], [10.0, 8.0], [13.0, -6.0], [20.0, -6.0]]
SQUEEZES = ramp_and_hold([5, 15, 8], 500, 10)


def case(name, body, terms, memory, knots, bonded=False, motion=False):
    return {"name": name, **body, "terms": terms, "memory": memory, "bonded": bonded, "motion": motion, "knots": knots}


CASES = [
    case("ball, recovery", BALL, [[7.0, 0.5]], "strain", RECOVERY),
    case("ball, steps, three terms", BALL, THREE, "strain", STEPS),
    case("ball, saw, three terms", BALL, THREE, "strain", SAW),
    case("ball, recovery, six decades", BALL, SPREAD, "strain", RECOVERY),
    case("block, pulled and pressed", BLOCK, THREE, "strain", PULLED, bonded=True),
    case("ball, steps, memory of force", BALL, THREE, "force", STEPS),
    case("ball, saw, memory of force", BALL, SPREAD, "force", SAW),
    case("Hertz, recovery, memory of force", HERTZ, THREE, "force", RECOVERY),
    case("Hertz, saw, memory of strain", HERTZ, THREE, "strain", SAW),
    case("ball glued, memory of force", BALL, THREE, "force", SQUEEZES, bonded=True, motion=True),
    case("ball let go, memory of force", BALL, THREE, "force", RELEASE, motion=True),
    case("Hertz, let go, memory of force", HERTZ, SPREAD, "force", RELEASE, motion=True),
    case("Hertz, let go, memory of strain", HERTZ, THREE, "strain", RELEASE, motion=True),
]


class Body:
    def __init__(self, case):
        self.case, self.ball = case, case["shape"] == "ball"
        self.depth = case["size"][0] if self.ball else case["size"][1] / (2 if case["sides"] == 2 else 1)
        self.g, self.rate = np.transpose(case["terms"])
        self.whole = 1.0 + self.g.sum()
        self.of_force = case["memory"] == "force"

    def relaxed(self, u):
        if "poisson_ratio" in self.case:
            modulus = self.case["modulus"] / (1 - self.case["poisson_ratio"] ** 2)
            return 4 / 3 * modulus * math.sqrt(self.depth) * max(u, 0.0) ** 1.5
        return self.stiffness(u) * u / self.depth

    def stiffness(self, u):
        if "poisson_ratio" in self.case:
            modulus = self.case["modulus"] / (1 - self.case["poisson_ratio"] ** 2)
            return 4 / 3 * modulus * math.sqrt(self.depth) * math.sqrt(max(u, 0.0)) * self.depth
        if not self.ball:
            return self.case["modulus"] * self.case["size"][0]
        return self.case["modulus"] * math.pi * max(u, 0.0) * (2 * self.depth - u)

    def q(self, u):
        return self.relaxed(u) if self.of_force else u / self.depth

    def force(self, u, z):
        total = self.whole * self.q(u) + z.sum()
        return total if self.of_force else self.stiffness(u) * total

    def place(self, q):
        """u at which the memory is of q."""
        if not self.of_force:
            return q * self.depth
        if not self.ball:
            return q * self.depth / self.stiffness(0.0)
        if q <= 0.0:
            return 0.0
        return brentq(lambda u: self.relaxed(u) - q, 0.0, self.depth, xtol=1e-18, rtol=4 * np.finfo(float).eps)

    def free(self, z):
        return self.place(-z.sum() / self.whole)

    def carried(self, force, z):
        if force == 0.0:
            return self.free(z)
        if self.of_force:
            return self.place((force - z.sum()) / self.whole)
        if not self.ball:
            return (force / self.stiffness(0.0) - z.sum()) / self.whole * self.depth
        low = max(-z.sum() / self.whole * self.depth, 0.0)
        return brentq(lambda u: self.force(u, z) - force, low, self.depth, xtol=1e-18, rtol=4 * np.finfo(float).eps)

    def fading(self, u, z):
        return -self.rate * (z + self.g * self.q(u))


def under_force(case, method, rtol, times):
    body, z, found = Body(case), np.zeros(len(case["terms"])), []
    pieces = [(a, b) for a, b in zip(case["knots"], case["knots"][1:]) if b[0] > a[0]]
    for index, ((ta, fa), (tb, fb)) in enumerate(pieces):
        force = lambda t, ta=ta, fa=fa, tb=tb, fb=fb: fa + (fb - fa) * (t - ta) / (tb - ta)  # noqa: E731
        last = index + 1 == len(pieces)
        inside = [t for t in times if ta <= t < tb or (last and t == tb)]
        run = solve_ivp(lambda t, z: body.fading(body.carried(force(t), z), z), (ta, tb), z, method=method, rtol=rtol,
                        atol=1e-16 if method == "DOP853" else 1e-15, t_eval=sorted(set(inside) | {tb}), first_step=1e-7 * (tb - ta))
        assert run.success, run.message
        state = dict(zip(run.t, run.y.T))
        found += [body.carried(force(t), state[t]) for t in inside]
        z = run.y[:, -1]
    return np.array(found), []


def under_motion(case, method, rtol, times):
    body, z, touching, found, events = Body(case), np.zeros(len(case["terms"])), True, {}, []
    for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
        jaw = lambda t, ta=ta, da=da, tb=tb, db=db: (da + (db - da) * (t - ta) / (tb - ta)) / case["sides"]  # noqa: E731
        t = ta
        while t < tb:
            if touching:
                rhs = lambda s, z: body.fading(jaw(s), z)  # noqa: E731
                margin = lambda s, z: body.whole * body.q(jaw(s)) + z.sum() + (1e-12 if s == 0 else 0)  # noqa: E731
            else:
                rhs = lambda s, z: body.fading(body.free(z), z)  # noqa: E731
                margin = lambda s, z: body.free(z) - jaw(s)  # noqa: E731
            margin.terminal, margin.direction = True, -1
            inside = sorted({s for s in times if t <= s <= tb} | {tb})
            run = solve_ivp(rhs, (t, tb), z, method=method, rtol=rtol, atol=1e-16 if method == "DOP853" else 1e-15, t_eval=inside,
                            events=None if case["bonded"] else margin, first_step=1e-7 * (tb - t))
            assert run.success, run.message
            for s, y in zip(run.t, run.y.T):
                u = jaw(s) if touching else body.free(y)
                found[float(s)] = (body.force(u, y) if touching else 0.0, u)
            if run.status == 1:
                t, z = float(run.t_events[0][0]), run.y_events[0][0]
                events.append(["lost" if touching else "regained", t])
                touching = not touching
            else:
                t, z = tb, run.y[:, -1]
    return np.array([found[t] for t in times]), events


def main():
    cases = []
    for given in CASES:
        times = sample_times(given["knots"])
        solve = under_motion if given["motion"] else under_force
        found, events = solve(given, "DOP853", 1e-13, times)
        again, _ = solve(given, "Radau", 1e-11, times)
        size = np.abs(found).max(axis=0)
        agreement = float((np.abs(found - again).max(axis=0) / size).max())
        print(f"{given['name']:36s} {np.max(size):.4g}, {len(events)} events, methods agree to {agreement:.1e}", flush=True)
        series = {"displacement": found.tolist()}
        if given["motion"]:
            series = {"force": found[:, 0].tolist(), "displacement": found[:, 1].tolist(), "events": events}
        cases.append({**given, "times": times, **series, "agreement": round_up(agreement)})
    write_reference("linear_forces", ["scipy", "numpy"],
                    {"force_relative_to_largest": 1e-9, "displacement_relative_to_largest": 1e-9, "event_time": 1e-7}, cases)


if __name__ == "__main__":
    main()
