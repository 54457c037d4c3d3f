"""Contacts whose rate coefficient depends on the equilibrium strain or on the direction, under motions and under forces.

    dx/dt = (du/dt)(m-1)/depth - v(u/depth, sgn x) sgn(x)|x|^n        a motion of the jaw
    E A(u) (u - w)/l = F(t),  dw/dt = l v(u/depth, sgn x) sgn(x)|x|^n  a force; x = (u - w)/l - u/depth, l = depth/m
    v = v0 f^(strain/0.1), or v0 for x > 0 and f v0 for x < 0

SciPy twice, restarted at every kink: DOP853 at a relative tolerance of 1e-12 and Radau at 1e-10. The printed numbers are
DOP853's.
"""

import math

from scipy.integrate import solve_ivp

from _common import round_up, write_reference
from creep import BALL, BLOCK, Body, sample_times


def case(name, drive, knots, n, v, m, rate, factor, body=BALL):
    return {"name": name, "drive": drive, **body, "exponent": float(n), "rate_coefficient": float(v), "layers": float(m),
            "rate": rate, "factor": factor, "knots": knots}


STEPS = [[0.0, 0.0], [0.6, 0.005], [5.6, 0.005], [6.2, 0.010], [11.2, 0.010], [11.8, 0.005], [31.8, 0.005]]
SQUEEZE = [[0.0, 0.0], [1.8, 0.015], [61.8, 0.015], [62.4, 0.012], [92.4, 0.012]]
SLOW = [[0.0, 0.0], [600.0, 0.020], [700.0, 0.020], [900.0, 0.015], [1000.0, 0.015]]
SAW = [[0.0, 0.0], [1.0, 0.010], [2.0, 0.004], [3.0, 0.012], [5.0, 0.006], [9.0, 0.006]]
CREEP = [[0.0, 0.0], [1.0, 10.0], [61.0, 10.0], [62.0, 3.0], [122.0, 3.0]]
RECOVERY = [[0.0, 0.0], [2.0, 8.0], [12.0, 8.0], [12.5, 0.0], [40.0, 0.0]]

CASES = [
    case("steps, slower deeper", "motion", STEPS, 5, 2e4, 8, "strain", 0.2),
    case("steps, faster deeper", "motion", STEPS, 5, 5e3, 8, "strain", 6.0),
    case("squeeze, n = 2.5", "motion", SQUEEZE, 2.5, 30, 8, "strain", 0.05),
    case("saw, n = 1", "motion", SAW, 1, 0.8, 4, "strain", 0.3),
    case("slow ramps", "motion", SLOW, 3, 2e3, 8, "strain", 0.4),
    case("block, slower deeper", "motion", STEPS, 4, 4e3, 8, "strain", 0.1, BLOCK),
    case("steps, slower back", "motion", STEPS, 5, 2e4, 8, "direction", 0.2),
    case("saw, faster back", "motion", SAW, 3, 50, 8, "direction", 5.0),
    case("saw, n = 1, slower back", "motion", SAW, 1, 0.8, 4, "direction", 0.25),
    case("creep, slower deeper", "force", CREEP, 5, 2e4, 8, "strain", 0.2),
    case("creep, slower back", "force", CREEP, 3, 100, 8, "direction", 0.3),
    case("recovery of a block", "force", RECOVERY, 5, 2e4, 8, "strain", 0.2, BLOCK),
]


class Varying(Body):
    def rate(self, u, x):
        if self.case["rate"] == "strain":
            v = self.v * self.case["factor"] ** (u / self.depth / 0.1)
        else:
            v = self.v * (self.case["factor"] if x < 0.0 else 1.0)
        return v * math.copysign(abs(x) ** self.n, x)

    def speed(self, force, behind):
        u = self.contact(force, behind)
        return self.layer * self.rate(u, (u - behind) / self.layer - u / self.depth)


def solve(given, method, rtol, times):
    """(u, x) at the times."""
    body, found = Varying(given), []
    moves, state = given["drive"] == "motion", 0.0
    for index, ((ta, a), (tb, b)) in enumerate(zip(given["knots"], given["knots"][1:])):
        last = index == len(given["knots"]) - 2
        at = lambda t, ta=ta, tb=tb, a=a, b=b: a + (b - a) * (t - ta) / (tb - ta)  # noqa: E731
        # Two sides: each contact takes half the travel.
        drive = 0.5 * (b - a) / (tb - ta) * (given["layers"] - 1) / body.depth
        if moves:
            slope = lambda t, y: [drive - body.rate(0.5 * at(t), y[0])]  # noqa: E731
        else:
            slope = lambda t, y: [body.speed(at(t), y[0])]  # noqa: E731
        crossing = lambda t, y: y[0]  # noqa: E731
        crossing.terminal = True
        inside = [t for t in times if ta <= t < tb or (last and t == tb)]
        start = ta
        while start < tb:
            # Under a force x³ is smooth enough to step over.
            events = None
            if moves and given["rate"] == "direction" and state != 0.0:
                crossing.direction = -math.copysign(1.0, state)
                events = crossing
            part = [t for t in inside if start <= t]
            run = solve_ivp(slope, (start, tb), [state], method=method, rtol=rtol, events=events,
                            atol=1e-3 * rtol * (1.0 if moves else body.depth), dense_output=True, first_step=1e-6 * (tb - start))
            assert run.success, run.message
            end = run.t[-1]
            for t in part:
                if t < end or (t == tb and end == tb):
                    y = float(run.sol(t)[0]) if t < end else run.y[0][-1]
                    found.append((0.5 * at(t), y) if moves else (body.contact(at(t), y), body.excess(at(t), y)))
            state, start = run.y[0][-1], end
            if run.status == 1:
                # Past the crossing, on its other side.
                state = math.copysign(1e-18, drive)
    return found


def main():
    cases = []
    for given in CASES:
        times = sample_times(given["knots"])
        found, other = solve(given, "DOP853", 1e-12, times), solve(given, "Radau", 1e-10, times)
        assert len(found) == len(other) == len(times), given["name"]
        off = max(abs(a - b) for (_, a), (_, b) in zip(found, other))
        print(f"{given['name']:28s} x up to {max(abs(x) for _, x in found):.4f}, Radau {off:.1e}", flush=True)
        assert off < 1e-7, given["name"]
        cases.append({**given, "times": times, "contact_displacement": [u for u, _ in found],
                      "excess_strain": [x for _, x in found], "agreement": round_up(off)})
    worst = max(c["agreement"] for c in cases)
    write_reference("varying_rates", ["scipy", "numpy"],
                    {"strain": 1e-5, "direction": 1e-8,
                     "note": f"DOP853 at 1e-12 and Radau at 1e-10 differ by {worst:.1e} in excess strain at most"}, cases)


if __name__ == "__main__":
    main()
