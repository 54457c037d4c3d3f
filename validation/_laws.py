"""The laws of a hold and their global least-squares fit.

A law is linear in its first numbers and not in the others: y(t) = sum_j a_j A_j(t; q), with q the logarithms of the
rates (1/s) and the plain exponents. Relaxation: A = 1, phi_1, phi_2 ..; creep: A = 1, 1 - phi_1 .., t. For given q
the best a is a linear fit (variable projection), so only q is searched, without knowledge of the truth.
"""

import itertools

import lmfit
import mpmath as mp
import numpy as np
from scipy.optimize import least_squares

import _shapes as sh
from _fit import polish

EXPONENTS = {"exponent": (0.2, 30.0), "stretch": (0.05, 2.0), "alpha": (0.05, 8.0), "order": (0.05, 0.97)}
STARTS = 60


class Law:
    """`linear` and `nonlinear` name the numbers in the order of every vector and matrix."""

    def __init__(self, name, shape, nonlinear, creep=False, constant="constant", flow=False, fixed=None):
        self.name, self.shape, self.creep, self.constant, self.flow = name, shape, creep, constant, flow
        self.fixed, self.kind = fixed or {}, "creep" if creep else "relaxation"
        count = sum(n.startswith("ln_rate_") for n in nonlinear) if name in ("prony", "fung", "burgers") else 1
        amplitudes = ["amplitude"] if count < 2 else [f"amplitude_{k + 1}" for k in range(count)]
        if name == "logarithmic":
            constant, amplitudes = "start", ["slope"]
        self.linear = ([constant] if constant else []) + amplitudes + (["flow_rate"] if flow else [])
        self.nonlinear = list(nonlinear)
        self.names = self.linear + self.nonlinear

    def columns(self, f, t, q):
        """Columns A_j and partials[k][j] = dA_j/dq_k."""
        phi, partials = self.shape(f, t, q)
        if self.creep:
            phi, partials = [1 - p for p in phi], [[-d for d in row] for row in partials]
        before = [1 + 0 * t] if self.constant else []
        after = [t] if self.flow else []
        return before + phi + after, [[0 * c for c in before] + row + [0 * c for c in after] for row in partials]

    def value(self, t, p, f=sh.Doubles):
        columns, partials = self.columns(f, t, p[len(self.linear):])
        slopes = [sum(a * d for a, d in zip(p, row)) for row in partials]
        return sum(a * c for a, c in zip(p, columns)), columns + slopes

    def bounds(self, t):
        step = np.min(np.diff(t))
        rate = (np.log(1e-2 / (t[-1] - t[0])), np.log(1e2 / step))
        return np.array([rate if n.startswith("ln_rate") else EXPONENTS[n] for n in self.nonlinear]).T


def linear_fit(law, t, y, w, q):
    """Best linear numbers, weighted residual, and its Jacobian in q after projection (Kaufman)."""
    columns, partials = law.columns(sh.Doubles, t, q)
    a_matrix = np.column_stack(columns) * w[:, None]
    scale = np.linalg.norm(a_matrix, axis=0) + 1e-300
    u, s, vt = np.linalg.svd(a_matrix / scale, full_matrices=False)
    s_inverse = np.where(s > 1e-14 * s[0], 1 / s, 0.0)
    a = vt.T @ (s_inverse * (u.T @ (y * w))) / scale
    slopes = np.column_stack([sum(v * d for v, d in zip(a, row)) for row in partials]) * w[:, None]
    return a, a_matrix @ a - y * w, slopes - u @ (u.T @ slopes)


def descend(law, t, y, w, q0, low, high):
    fit = least_squares(lambda q: linear_fit(law, t, y, w, q)[1], np.clip(q0, low + 1e-6, high - 1e-6),
                        lambda q: linear_fit(law, t, y, w, q)[2], bounds=(low, high), x_scale="jac",
                        xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=200)
    return 2 * fit.cost, list(fit.x)


def search(law, t, y, w, rng):
    """Best (chi-square, q) of a grid, its 15 best points and random starts; share of starts that reach it."""
    low, high = law.bounds(t)
    size = len(low)
    axes = [np.linspace(a + 1e-3, b - 1e-3, {1: 200, 2: 36, 3: 14}[size]) for a, b in zip(low, high)]
    many = sum(n.startswith("ln_rate_") for n in law.nonlinear) == size  # exponentials may trade places
    grid = []
    for q in itertools.product(*axes):
        if not many or all(a > b for a, b in zip(q, q[1:])):
            grid.append((float(np.sum(linear_fit(law, t, y, w, q)[1] ** 2)), q))
    grid.sort()
    starts = [q for _, q in grid[:15]] + [rng.uniform(low, high) for _ in range(STARTS)]
    found = sorted(descend(law, t, y, w, q, low, high) for q in starts)
    best = found[0]
    assert best[0] <= grid[0][0] * (1 + 1e-9)
    q = np.array(sorted(best[1], reverse=True) if many else best[1])
    assert np.all(q > low + 1e-3) and np.all(q < high - 1e-3), (law.name, q, low, high)
    return best[0], q, sum(f[0] <= best[0] * (1 + 1e-7) for f in found), len(found)


def with_lmfit(law, t, y, w, start, **more):
    """lmfit's own minimiser, numerical Jacobian and covariance."""
    params = lmfit.Parameters()
    for name, value in zip(law.names, start):
        params.add(name, value=value)

    def residual(p):
        return (law.value(t, [p[n].value for n in law.names])[0] - y) * w

    minimizer = lmfit.Minimizer(residual, params, **more)
    return minimizer, minimizer.minimize(method="leastsq", xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=40000)


def fit(law, t, y, sigma, rng):
    """The global optimum: numbers of `law.names`, covariance (mpf), chi-square; checked against lmfit."""
    w = np.ones_like(t) if sigma is None else 1 / sigma
    chi2, q, reached, tried = search(law, t, y, w, rng)
    start = list(linear_fit(law, t, y, w, q)[0]) + list(q)
    with mp.workdps(40):
        f = sh.Digits
        exact_t, exact_w = f.array(t), 1 / f.array(np.ones_like(t) if sigma is None else sigma)

        def model(p):
            value, slopes = law.value(exact_t, p, f)
            return list(value * exact_w), [list(s * exact_w) for s in slopes]

        p, best, covariance = polish(model, list(f.array(y) * exact_w), start)
    assert abs(best / chi2 - 1) < 1e-8, (law.name, float(best), chi2)
    errors = np.array([float(mp.sqrt(covariance[k][k])) for k in range(len(p))])
    off, spread = 0.0, 0.0
    for away in (0.0, 0.3):
        _, other = with_lmfit(law, t, y, w, np.array([float(v) for v in p]) + away * errors)
        for k, name in enumerate(law.names):
            off = max(off, abs(other.params[name].value - float(p[k])) / errors[k])
            if away == 0.0:  # stderr from lmfit's difference quotients
                spread = max(spread, abs(other.params[name].stderr / errors[k] - 1))
    assert off < 1e-4 and spread < 1e-4, (law.name, off, spread)
    return {"p": p, "chi2": best, "covariance": covariance, "errors": errors, "lmfit": other,
            "reached": int(reached), "tried": tried, "off": off, "spread": spread}


def rounded(values, digits):
    return np.array([float(f"{v:.{digits - 1}e}") for v in values])


def hold(law, linear, q, t, noise, seed, weighted=False):
    """A noisy hold: t, y (7 digits) and sigma (3 digits) or None, and the generator for the search."""
    rng = np.random.default_rng(seed)
    sigma = rounded(noise * rng.uniform(0.4, 2.0, len(t)), 3) if weighted else None
    y = law.value(t, list(linear) + list(q))[0]
    y = y + rng.normal(size=len(t)) * (noise if sigma is None else sigma)
    return rounded(y, 7), sigma, rng


def line(duration, count):
    return rounded(np.linspace(0.0, duration, count), 6)


def logs(first, last, count, zero=True):
    t = rounded(np.geomspace(first, last, count - zero), 5)
    return np.concatenate([[0.0], t]) if zero else t


def law(name, **more):
    """A law by its name; keywords: exponent, count, creep."""
    exponent, count, creep = more.get("exponent"), more.get("count", 1), more.get("creep", False)
    rates = ["ln_rate"] if count == 1 else [f"ln_rate_{k + 1}" for k in range(count)]
    one = sh.exponentials
    if name == "latency":
        fixed = {} if exponent is None else {"exponent": exponent}
        return Law(name, sh.latency(exponent), ["ln_rate"] + ["exponent"] * (exponent is None), creep, fixed=fixed)
    if name == "power" and creep:
        grown = Law(name, sh.power_growth, ["alpha"])
        grown.kind = "creep"
        return grown
    return {
        "maxwell": lambda: Law(name, one, rates, constant=None),
        "kelvin_voigt": lambda: Law(name, one, rates, creep=True, constant=None),
        "standard_linear_solid": lambda: Law(name, one, rates, creep),
        "burgers": lambda: Law(name, one, rates, creep, "constant" if creep else None, flow=creep),
        "prony": lambda: Law(name, one, rates, creep),
        "fung": lambda: Law(name, one, rates),
        "fung_continuous": lambda: Law(name, sh.continuous, ["ln_rate_fast", "ln_rate_slow"], creep),
        "stretched": lambda: Law(name, sh.stretched, ["ln_rate", "stretch"], creep),
        "power": lambda: Law(name, sh.power_decay, ["ln_rate", "alpha"], constant=None),
        "logarithmic": lambda: Law(name, sh.logarithm, rates),
        "fractional_zener": lambda: Law(name, sh.mittag_leffler, ["ln_rate", "order"], creep),
        "diffusion": lambda: Law(name, sh.sheet, rates, creep),
    }[name]()
