"""Contacts whose layer relaxes by a linear law, under motions of the jaw.

    strain = e + sum x_k,  dx_k/dt = g_k de/dt - l_k x_k,  e = u1/depth,  F = E A(u1) strain
    jaw off: strain = 0, de/dt = sum l_k x_k / (1 + sum g_k)

Series: SciPy's DOP853 at a relative tolerance of 1e-13, contact lost and regained as events of the integrator.
Fractional Zener, G = 1 + g E_a(-(t/tau)^a): by superposition, the integral of the Mittag-Leffler function over a ramp as
a quadrature of its spectrum in mpmath at 30 digits.
"""

import math

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

from _common import write_reference
from _contact import ramp_and_hold, travel_at
from creep import sample_times

mp.mp.dps = 30
BALL = {"shape": "ball", "size": [0.035], "modulus": 2.8e4, "sides": 2}
BLOCK = {"shape": "block", "size": [1e-3, 0.05], "modulus": 1e5, "sides": 1}
STEPS = ramp_and_hold([5, 15, 8], 500, 10)
RELEASE = [[0.0, 0.0], [1.0, 0.012], [20.0, 0.012], [20.5, 0.004], [30.0, 0.004], [31.0, -0.002], [60.0, -0.002],
           [62.0, 0.01], [80.0, 0.01], [80.2, 0.0], [300.0, 0.0]]
THREE = [[1.0, 0.01], [0.5, 0.3], [2.0, 6.0]]
CASES = [
    {"name": "standard linear solid, ball, glued", **BALL, "terms": [[7.0, 0.5]], "bonded": True, "knots": STEPS},
    {"name": "three terms, ball, glued", **BALL, "terms": THREE, "bonded": True, "knots": STEPS},
    {"name": "three terms, ball, let go", **BALL, "terms": THREE, "bonded": False, "knots": RELEASE},
    {"name": "two terms, block, let go", **BLOCK, "terms": [[3.0, 0.02], [1.0, 2.0]], "bonded": False, "knots": RELEASE},
]
FRACTIONAL = [
    {"name": "fractional, order 1/2", **BALL, "overshoot": 3.0, "time": 2.0, "order": 0.5, "bonded": True, "knots": STEPS},
    {"name": "fractional, order 0.85", **BLOCK, "overshoot": 1.0, "time": 20.0, "order": 0.85, "bonded": True, "knots": STEPS},
]


def depth_of(case):
    return case["size"][0] if case["shape"] == "ball" else case["size"][1] / (2 if case["sides"] == 2 else 1)


def force_of(case, u, strain):
    area = math.pi * u * (2 * case["size"][0] - u) if case["shape"] == "ball" else case["size"][0]
    return case["modulus"] * area * strain


def solve(case, times):
    """Force and surface displacement at the times, and the events."""
    depth = depth_of(case)
    g, rate = np.transpose(case["terms"])
    whole, x, touching, found, events = 1.0 + g.sum(), np.zeros(len(g)), True, {}, []
    for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
        speed = (db - da) / (tb - ta) / case["sides"] / depth
        jaw = lambda t, ta=ta, da=da, speed=speed: da / case["sides"] / depth + speed * (t - ta)  # noqa: E731
        t = ta
        while t < tb:
            if touching:
                rhs = lambda s, y: g * speed - rate * y  # noqa: E731
                margin = lambda s, y: jaw(s) + y.sum()  # noqa: E731
            else:
                rhs = lambda s, y: g * (rate @ y) / whole - rate * y  # noqa: E731
                margin = lambda s, y: -y.sum() - jaw(s)  # noqa: E731
            margin.terminal, margin.direction = True, -1
            inside = sorted({s for s in times if t <= s <= tb} | {tb})
            run = solve_ivp(rhs, (t, tb), x, method="DOP853", rtol=1e-13, atol=1e-17, t_eval=inside,
                            events=None if case["bonded"] else margin, first_step=1e-6 * (tb - t))
            assert run.success, run.message
            for s, y in zip(run.t, run.y.T):
                e = jaw(s) if touching else -y.sum()
                found[float(s)] = (force_of(case, e * depth, e + y.sum()) if touching else 0.0, e * depth)
            if run.status == 1:
                t, x = float(run.t_events[0][0]), run.y_events[0][0]
                events.append(["lost" if touching else "regained", t])
                touching = not touching
            else:
                t, x = tb, run.y[:, -1]
    return [found[t] for t in times], events


def ramp_response(order, s):
    """Integral of E_a(-r^a) from 0 to s."""
    if s == 0:
        return mp.mpf(0)
    a = mp.mpf(order)

    def inner(q):
        p = mp.exp(a * q)
        weight = mp.sin(mp.pi * a) / mp.pi / (p + 2 * mp.cos(mp.pi * a) + 1 / p)
        r = mp.exp(q)
        return weight * -mp.expm1(-r * s) / r

    return mp.quad(inner, [-150, -60, -30, -15, -6, -2, 0, 2, 6, 15, 30, 80])


def fractional(case, times):
    depth, tau = depth_of(case), mp.mpf(case["time"])
    forces = []
    for t in times:
        e = mp.mpf(travel_at(case["knots"], t)[0]) / case["sides"] / depth
        excess = mp.mpf(0)
        for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
            if ta >= t or da == db:
                continue
            speed = (mp.mpf(db) - mp.mpf(da)) / (mp.mpf(tb) - mp.mpf(ta)) / case["sides"] / depth
            until = min(mp.mpf(tb), mp.mpf(t))
            excess += speed * tau * (ramp_response(case["order"], (mp.mpf(t) - mp.mpf(ta)) / tau)
                                     - ramp_response(case["order"], (mp.mpf(t) - until) / tau))
        strain = e + case["overshoot"] * excess
        forces.append(float(force_of(case, float(e) * depth, float(strain))))
    return forces


def main():
    cases = []
    for given in CASES:
        times = sample_times(given["knots"])
        found, events = solve(given, times)
        print(f"{given['name']:36s} force up to {max(f for f, _ in found):.3f} N, {len(events)} events", flush=True)
        cases.append({**given, "times": times, "force": [f for f, _ in found],
                      "contact_displacement": [u for _, u in found], "events": events})
    for given in FRACTIONAL:
        times = sample_times(given["knots"])[::3]
        force = fractional(given, times)
        print(f"{given['name']:36s} force up to {max(force):.3f} N", flush=True)
        cases.append({**given, "times": times, "force": force})
    write_reference("linear_contacts", ["scipy", "numpy", "mpmath"],
                    {"force_relative_to_largest": 1e-10, "fractional_relative_to_largest": 1e-8,
                     "displacement_over_depth": 1e-10, "event_time": 1e-8}, cases)


if __name__ == "__main__":
    main()
