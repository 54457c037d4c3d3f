"""Unilateral contact: a jaw can push but not pull.

In contact the layer obeys the bonded law. When the strain x + u/r falls to 0 under a retreating jaw the jaw
leaves; the surface, free of stress, is a dent u_s that recovers by

    du_s/dt = -l v (u_s/r)^n,   l = r/m

and contact resumes when the jaw meets it, with x = -u_s/r. Every length is one contact's share, d/sides.

Printed: mpmath (quadratures, closed forms, event times by root finding at 30 digits). Compared with SciPy
DOP853 and its event location; the largest distances stand in each case.
"""

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

from _common import round_up, write_reference
from _contact import integrate_piece, push, ramp_and_hold, relax, travel_at
from contact_force import UP, protocol

mp.mp.dps = 30


def with_scipy(case, times):
    """(events, {t: (surface share, excess strain or None)}) by SciPy alone."""
    r, m, v, n, sides = (case[k] for k in
                         ("radius", "layers", "rate_coefficient", "exponent", "sides"))
    x, dent = 0.0, None  # dent is None while in contact
    events, out = [], {case["knots"][0][0]: (0.0, 0.0)}
    for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
        slope = (db - da) / (tb - ta) / sides

        def jaw(t):
            return da / sides + slope * (t - ta)

        t = ta
        while t < tb:
            if dent is None:
                values, stop, x, hit = integrate_piece(
                    x, slope * (m - 1) / r, v, n, (t, tb), times,
                    [lambda s, y: y + jaw(s) / r] if slope < 0 else [])
                for s, value in values.items():
                    out[s] = (jaw(s), value)
                t = stop
                if hit is not None:
                    events.append(("loss", t))
                    dent = jaw(t) / r
            else:
                def meet(s, w):
                    return w[0] - jaw(s) / r

                meet.terminal, meet.direction = True, -1
                inside = sorted({s for s in times if t < s <= tb} | {tb})
                sol = solve_ivp(lambda _, w: [-v / m * max(w[0], 0.0) ** n], (t, tb), [dent],
                                method="DOP853", rtol=1e-13, atol=1e-16, t_eval=inside, events=meet)
                for s, w in zip(sol.t, sol.y[0] if len(sol.t) else []):
                    out[float(s)] = (float(w) * r, None)
                if sol.status == 1:
                    t = float(sol.t_events[0][0])
                    events.append(("contact", t))
                    x, dent = -jaw(t) / r, None
                else:
                    t, dent = tb, float(sol.y[0][-1])
    return events, out


def with_mpmath(case, times, hints):
    """The same by quadrature and closed form; `hints` are event times to start the root finding from."""
    r, m, v, n = (mp.mpf(case[k]) for k in ("radius", "layers", "rate_coefficient", "exponent"))
    sides, knots = case["sides"], case["knots"]
    marks = sorted({mp.mpf(t) for t, _ in knots} | {mp.mpf(t) for t in times})
    events, hints, out = [], list(hints), {}

    def share(t):
        return travel_at(knots, t)[0] / sides

    t, x, dent = mp.mpf(0), mp.mpf(0), None
    out[t] = (mp.mpf(0), mp.mpf(0))
    for stop in marks[1:]:
        slope = travel_at(knots, stop)[1] / sides
        g = slope * (m - 1) / r
        while t < stop:
            here, x_here, dent_here = t, x, dent

            def gap(s):
                """Strain in contact, distance to the jaw when free: an event where it reaches 0."""
                if dent_here is None:
                    return push(x_here, g, v, n, s - here) + share(s) / r
                return relax(dent_here, v / m, n, s - here) - share(s) / r

            until = stop
            if hints and hints[0][1] < stop:
                kind, guess = hints[0]
                low, high = max(mp.mpf(guess) - mp.mpf("1e-5"), here), min(mp.mpf(guess) + mp.mpf("1e-5"), stop)
                assert gap(low) > 0 > gap(high), (case["name"], kind, guess)
                until = mp.findroot(gap, (low, high), solver="anderson", tol=mp.mpf("1e-50"))
                hints.pop(0)
                events.append((kind, until))
            if dent is None:
                x = push(x, g, v, n, until - t)
                if until < stop:
                    dent = share(until) / r
            else:
                dent = relax(dent, v / m, n, until - t)
                if until < stop:
                    x, dent = -share(until) / r, None
            t = until
        out[stop] = (share(stop), x) if dent is None else (dent * r, None)
        # nothing may have been missed: the surface never passes the jaw, strain never turns negative
        if dent is None:
            assert x + share(stop) / r > -mp.mpf("1e-25")
        else:
            assert dent * r > share(stop)
    return events, {float(s): value for s, value in out.items()}


def solve(case, times):
    hints, other = with_scipy(case, times)
    events, states = with_mpmath(case, times, hints)
    assert [k for k, _ in hints] == [k for k, _ in events]
    modulus, r = mp.mpf(case["modulus"]), mp.mpf(case["radius"])

    def force(state):
        u, x = state
        return mp.mpf(0) if x is None else modulus * (x + u / r) * mp.pi * (2 * r * u - u * u)

    off_t = max(abs(a[1] - b[1]) for a, b in zip(events, hints))
    off_u = max(abs(states[t][0] - other[t][0]) for t in times)
    off_f = max(abs(force(states[t]) - force((mp.mpf(other[t][0]), None if other[t][1] is None
                                              else mp.mpf(other[t][1])))) for t in times)
    print(f"{case['name']:40s} {[(k, round(float(t), 6)) for k, t in events]}"
          f"  t {float(off_t):.0e}  u {float(off_u):.0e}  F {float(off_f):.0e}", flush=True)
    assert off_t < 1e-9 and off_u < 1e-11 and off_f < 1e-7
    assert all(force(states[t]) >= -mp.mpf("1e-25") for t in times)
    return {**case, "events": [{"kind": k, "time": float(t)} for k, t in events],
            "times": times, "in_contact": [states[t][1] is not None for t in times],
            "surface_displacement": [float(states[t][0]) for t in times],
            "jaw_share": [float(travel_at(case["knots"], t)[0] / case["sides"]) for t in times],
            "force": [float(force(states[t])) for t in times],
            "agreement_event_time": round_up(off_t), "agreement_displacement": round_up(off_u),
            "agreement_force": round_up(off_f)}


def main():
    paper = ramp_and_hold(UP + [0.0], 500.0, 10.0)
    again = ramp_and_hold([25.0, 0.0, 20.0, 0.0], 500.0, [10.0, 1.0, 5.0, 4.0])
    catches_up = ramp_and_hold([25.0, 6.0, 2.0], 500.0, [10.0, 8.0, 6.0])
    slowing = [[0.0, 0.0], [2.0, 0.02], [4.0, 0.02], [5.5, 0.003], [25.5, 0.001], [30.0, 0.004]]
    beyond = [[0.0, 0.0], [2.0, 0.016], [6.0, 0.016], [8.0, -0.004], [9.0, -0.004], [11.0, 0.016], [15.0, 0.016]]
    cases = [
        solve(protocol("paper up and off", paper, 5, 2e4, 8), [0.6, 43.0, 53.0, 54.0, 55.5, 56.0, 57.0, 60.0, 66.0]),
        solve(protocol("pressed again before it recovers", again, 5, 2e4, 8),
              [3.0, 13.0, 14.0, 16.0, 17.0, 17.5, 18.0, 19.4, 24.4, 25.0, 26.5, 30.8]),
        solve(protocol("dent comes back to a waiting jaw", catches_up, 5, 2e4, 8),
              [3.0, 13.0, 14.5, 15.28, 16.0, 20.0, 23.28, 23.5, 24.0, 29.0]),
        solve(protocol("slower retreat lets it catch up", slowing, 3, 500, 8),
              [2.0, 4.0, 4.5, 5.5, 6.0, 10.0, 20.0, 25.5, 27.0, 30.0]),
        solve(protocol("linear law, twice", again, 1, 4, 8),
              [3.0, 13.0, 14.0, 16.0, 16.5, 17.5, 18.0, 19.4, 24.4, 26.0, 27.0, 30.8]),
        solve(protocol("square law, 64 layers, one side, beyond first touch", beyond, 2, 200, 64, sides=1),
              [1.0, 2.0, 6.0, 7.0, 8.0, 9.0, 9.6, 10.5, 11.0, 15.0]),
    ]
    write_reference(
        "separation", ["mpmath", "scipy", "numpy"],
        {"event_time": 1e-9, "displacement": 1e-11, "force": 1e-7,
         "note": "absolute, s, m and N; printed values carry all their digits, the tolerances cover the distance "
                 "from SciPy (agreement_*); at `times` in_contact is false from loss to contact"},
        cases)


if __name__ == "__main__":
    main()
