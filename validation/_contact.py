"""The contact layer of a squeezed ball, solved twice by methods that share nothing but the equation.

    dx/dt = g - v sgn(x)|x|^n,   g = (du/dt)(m-1)/r,   u = d/sides,   x = 0 at the start
    strain = x + u/r,            F = E strain pi (2 r u - u^2)

`Exact`: mpmath. A hold has a closed form; a ramp is autonomous, so time is a quadrature of x (a Gauss
hypergeometric function away from the steady state) that is inverted by Newton's method.
`integrate`: SciPy DOP853 at a relative tolerance of 1e-13, restarted at every kink and zero crossing.
"""

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp


# ---------------------------------------------------------------- travel


def ramp_and_hold(stops_mm, speed_mm_min, hold_s, start_mm=0.0):
    """Knots [t, d] (s, m) of a jaw that goes to each stop at a constant speed and waits there."""
    t, d = 0.0, start_mm
    knots = [[0.0, start_mm / 1000.0]]
    for i, stop in enumerate(stops_mm):
        t = round(t + abs(stop - d) / speed_mm_min * 60.0, 9)
        d = stop
        knots.append([t, d / 1000.0])
        hold = hold_s[i] if isinstance(hold_s, (list, tuple)) else hold_s
        if hold > 0:
            t = round(t + hold, 9)
            knots.append([t, d / 1000.0])
    return knots


def travel_at(knots, t):
    """Exact linear interpolation of the knots at t, and the slope of the piece that ends at t."""
    t = mp.mpf(t)
    for (ta, da), (tb, db) in zip(knots, knots[1:]):
        if t <= mp.mpf(tb):
            ta, da, tb, db = map(mp.mpf, (ta, da, tb, db))
            slope = (db - da) / (tb - ta)
            return da + slope * (t - ta), slope
    return mp.mpf(knots[-1][1]), mp.mpf(0)


# ---------------------------------------------------------------- mpmath


def relax(x0, rate, n, dt):
    """dx/dt = -rate sgn(x)|x|^n for dt."""
    x0, rate, n, dt = map(mp.mpf, (x0, rate, n, dt))
    if x0 == 0 or dt == 0:
        return x0
    if n == 1:
        return x0 * mp.exp(-rate * dt)
    s = 1 + (n - 1) * rate * abs(x0) ** (n - 1) * dt
    return mp.mpf(0) if s <= 0 else x0 * s ** (-1 / (n - 1))


_SPLIT = mp.mpf("0.9")


def _newton(residual, slope, guess, low, high):
    """Root of an increasing residual between low and high; Newton, halving when it leaves."""
    x = guess
    goal = mp.mpf(10) ** (8 - mp.mp.dps)
    for _ in range(200):
        f = residual(x)
        if f > 0:
            high = x
        else:
            low = x
        step = f / slope(x)
        new = x - step
        if not low < new < high:
            if abs(step) <= goal * max(1, abs(x)):
                return x
            new = (low + high) / 2
        if abs(new - x) <= goal * abs(new):
            return new
        x = new
    raise ArithmeticError("no convergence")


class _Ramp:
    """dy/dtau = 1 - sgn(y)|y|^n."""

    def __init__(self, n):
        self.n = mp.mpf(n)

    def since_zero(self, y):
        """tau from 0 to y, for y up to 0.9 (negative y: minus the time to reach 0)."""
        z = y ** self.n if y >= 0 else -abs(y) ** self.n
        return y * mp.hyp2f1(1, 1 / self.n, 1 + 1 / self.n, z) if y else mp.mpf(0)

    def density(self, p, side):
        """dtau/dp with y = 1 + side e^p."""
        e = mp.exp(p)
        if side < 0 and e >= 1:
            return mp.mpf(1)
        return e / (side * mp.expm1(self.n * mp.log1p(side * e)))

    def between(self, p_low, p_high, side):
        pieces = int(mp.ceil((p_high - p_low) / 2)) or 1
        edges = [p_low + (p_high - p_low) * k / pieces for k in range(pieces + 1)]
        return mp.quad(lambda p: self.density(p, side), edges, method="gauss-legendre")

    def toward_one(self, p0, tau, side):
        """1 + side e^p after tau from e^p0."""
        if tau == 0:
            return 1 + side * mp.exp(p0)
        low = p0 - 2
        while self.between(low, p0, side) < tau:
            low -= p0 - low
            if low < -3 * mp.mp.dps:  # e^p is below the working precision
                return mp.mpf(1)
        p = _newton(lambda p: tau - self.between(p, p0, side), lambda p: self.density(p, side),
                    (low + p0) / 2, low, p0)
        return 1 + side * mp.exp(p)

    def advance(self, y0, tau):
        if y0 == 1 or tau == 0:
            return y0
        if y0 > 1:
            return self.toward_one(mp.log(y0 - 1), tau, 1)
        if y0 > _SPLIT:
            return self.toward_one(mp.log(1 - y0), tau, -1)
        target = self.since_zero(y0) + tau
        if target <= 0:
            q = _newton(lambda q: -self.since_zero(-q) + target, lambda q: 1 / (1 + q**self.n),
                        -target, mp.mpf(0), -y0 * (1 + mp.mpf(10) ** (5 - mp.mp.dps)))
            return -q
        edge = self.since_zero(_SPLIT)
        if target >= edge:
            return self.toward_one(mp.log(1 - _SPLIT), target - edge, -1)
        return _newton(lambda y: self.since_zero(y) - target, lambda y: 1 / (1 - y**self.n),
                       min(target, _SPLIT), mp.mpf(0), _SPLIT)


def push(x0, g, v, n, dt):
    """x after dt of dx/dt = g - v sgn(x)|x|^n."""
    x0, g, v, n, dt = map(mp.mpf, (x0, g, v, n, dt))
    if g == 0:
        return relax(x0, v, n, dt)
    if dt == 0:
        return x0
    if n == 1:
        return g / v + (x0 - g / v) * mp.exp(-v * dt)
    side = mp.sign(g)
    scale = (abs(g) / v) ** (1 / n)
    return side * scale * _Ramp(n).advance(side * x0 / scale, abs(g) * dt / scale)


class Exact:
    """The bonded contact layer along a protocol."""

    def __init__(self, case):
        self.case = case
        self.knots = case["knots"]
        self.r, self.m, self.v, self.n = (mp.mpf(case[k]) for k in
                                          ("radius", "layers", "rate_coefficient", "exponent"))
        self.sides = case["sides"]
        self.at_knots = [mp.mpf(0)]
        for (ta, _), (tb, _) in zip(self.knots, self.knots[1:]):
            self.at_knots.append(self._from(len(self.at_knots) - 1, mp.mpf(tb)))

    def drive(self, t):
        """g on the piece that ends at t."""
        return travel_at(self.knots, t)[1] / self.sides * (self.m - 1) / self.r

    def _from(self, k, t):
        tb = self.knots[k + 1][0]
        return push(self.at_knots[k], self.drive(tb), self.v, self.n, t - mp.mpf(self.knots[k][0]))

    def excess(self, t):
        t = mp.mpf(t)
        for k in range(len(self.knots) - 1):
            if t <= mp.mpf(self.knots[k + 1][0]):
                return self._from(k, t)
        return relax(self.at_knots[-1], self.v, self.n, t - mp.mpf(self.knots[-1][0]))

    def share(self, t):
        """u, the share of one contact."""
        return travel_at(self.knots, t)[0] / self.sides

    def force(self, t, x=None):
        x = self.excess(t) if x is None else x
        u = self.share(t)
        return mp.mpf(self.case["modulus"]) * (x + u / self.r) * mp.pi * (2 * self.r * u - u * u)


# ---------------------------------------------------------------- SciPy


def integrate_piece(x0, g, v, n, span, times=(), events=()):
    """x at `times` within span, x at its end (or at the first of `events`, functions of (t, x)).

    Returns values, end time, end x, index of the event that stopped it or None."""
    values, (t, stop) = {}, span
    x = x0
    while True:
        def rhs(_, y):
            return [g - v * np.sign(y[0]) * abs(y[0]) ** n]

        def zero(_, y):
            return y[0]

        zero.terminal = True
        # a zero crossing is a kink of the right side: stop there, go on from exactly zero
        watch = [zero] if x != 0 else []
        for e in events:
            def wrapped(s, y, e=e):
                return e(s, y[0])
            wrapped.terminal = True
            wrapped.direction = -1
            watch.append(wrapped)
        inside = [s for s in times if t < s <= stop]
        sol = solve_ivp(rhs, (t, stop), [x], method="DOP853", rtol=1e-13, atol=1e-16,
                        t_eval=sorted(set(inside + [stop])), events=watch or None,
                        first_step=min((stop - t), 1e-6))
        assert sol.status >= 0, sol.message
        for s, y in zip(sol.t, sol.y[0] if len(sol.t) else []):
            values[s] = float(y)
        if sol.status == 0:
            return values, stop, float(sol.y[0][-1]), None
        hits = [(e[0], i) for i, e in enumerate(sol.t_events) if len(e)]
        t_hit, which = min(hits)
        if x == 0 or which > 0:
            return values, float(t_hit), float(sol.y_events[which][0][0]), which - (x != 0)
        t, x = float(t_hit), 0.0
        if g == 0:  # n < 1: x has come to rest
            for s in times:
                if t < s <= stop:
                    values[s] = 0.0
            values[stop] = 0.0
            return values, stop, 0.0, None


def integrate(case, times):
    """x of the bonded contact layer at `times`, by SciPy alone."""
    r, m, v, n = (case[k] for k in ("radius", "layers", "rate_coefficient", "exponent"))
    knots, x, out = case["knots"], 0.0, {case["knots"][0][0]: 0.0}
    for (ta, da), (tb, db) in zip(knots, knots[1:]):
        g = (db - da) / (tb - ta) / case["sides"] * (m - 1) / r
        values, _, x, _ = integrate_piece(x, g, v, n, (ta, tb), times)
        out.update(values)
    return [out[t] for t in times]


def excess_of_layers(layers):
    """Excess strains of all layers from u_2 .. u_m and u_1, in units of the depth."""
    behind = 1.0 - np.arange(layers) / layers  # L_i

    def excess(w, top):
        u = np.concatenate([[top], w, [0.0]])
        return layers * (u[:-1] - u[1:]) - u[:-1] / behind

    return excess, behind
