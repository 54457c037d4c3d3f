"""Shapes of the laws of a hold, each written once, for doubles and for mpmath.

A shape takes functions `f` (`Doubles` or `Digits`), times t and the nonlinear numbers q (logarithms of rates in 1/s,
plain exponents) and returns its columns and, for every number of q, the partials of the columns.
"""

import math

import mpmath as mp
import numpy as np
from scipy import special

from hold_fits import shape, shape_mp


class Doubles:
    """Elementary functions of arrays of doubles."""

    exp, log, sin, cos, e1, erfc = np.exp, np.log, np.sin, np.cos, special.exp1, special.erfc
    digits, latency = 16, staticmethod(shape)

    @staticmethod
    def array(values):
        return np.asarray(values, dtype=float)

    @staticmethod
    def pi():
        return math.pi


class Digits:
    """The same of object arrays of mpf."""

    exp, log, sin, cos, e1, erfc, array = (
        np.vectorize(g, otypes=[object]) for g in (mp.exp, mp.log, mp.sin, mp.cos, mp.e1, mp.erfc, mp.mpf))
    digits, latency = 40, np.vectorize(shape_mp, otypes=[object] * 3)

    @staticmethod
    def pi():
        return +mp.pi


def log_time(f, t):
    """ln t; -10^4 stands for ln 0, so that t^b = exp(b ln t) and t^b ln t vanish there."""
    start = t == 0
    return np.where(start, f.array(-1e4), f.log(np.where(start, f.array(1.0), t)))


def exponentials(f, t, q):
    z = [f.exp(k) * t for k in q]
    phi = [f.exp(-a) for a in z]
    return phi, [[-z[k] * phi[k] if j == k else 0 * t for j in range(len(q))] for k in range(len(q))]


def latency(n):
    """[1 + (n - 1) lambda t]^(-1/(n - 1)); n = None: free."""
    def columns(f, t, q):
        phi, by_rate, by_n = f.latency(t, q[0], q[1] if n is None else f.array(n))
        return [phi], [[by_rate], [by_n]][: len(q)]
    return columns


def stretched(f, t, q):
    log_u = log_time(f, t) + q[0]
    w = f.exp(q[1] * log_u)
    phi = f.exp(-w)
    return [phi], [[-q[1] * w * phi], [-log_u * w * phi]]


def continuous(f, t, q):
    """[E1(slow t) - E1(fast t)] / ln(fast/slow); q = ln fast, ln slow."""
    start, span = t == 0, q[0] - q[1]
    safe = np.where(start, f.array(1.0), t)
    fast, slow = f.exp(q[0]) * safe, f.exp(q[1]) * safe
    phi = np.where(start, 1 + 0 * t, (f.e1(slow) - f.e1(fast)) / span)
    e_fast, e_slow = (np.where(start, 1 + 0 * t, f.exp(-z)) for z in (fast, slow))
    return [phi], [[(e_fast - phi) / span], [(phi - e_slow) / span]]


def power_decay(f, t, q):
    """(1 + t/t0)^(-alpha); q = ln(1/t0), alpha."""
    z = f.exp(q[0]) * t
    log = f.log(1 + z)
    phi = f.exp(-q[1] * log)
    return [phi], [[-q[1] * z / (1 + z) * phi], [-log * phi]]


def power_growth(f, t, q):
    """(t / 1 s)^alpha, as a column and not as 1 - phi."""
    log = log_time(f, t)
    p = f.exp(q[0] * log)
    return [p], [[log * p]]


def logarithm(f, t, q):
    """-ln(1 + t/t0); q = ln(1/t0)."""
    z = f.exp(q[0]) * t
    return [-f.log(1 + z)], [[-z / (1 + z)]]


def mittag_leffler(f, t, q):
    """E_a(-(lambda t)^a) = int exp(-lambda t e^s) W(s) ds, W = sin(pi a) / (2 pi (cosh(a s) + cos(pi a))).

    The trapezoidal rule converges geometrically: the integrand is analytic within pi/2 (the exponential) and
    pi (1 - a)/a (the poles of W) of the real axis, and falls off exponentially on both sides."""
    pi, a, number = f.pi(), q[1], float(q[1])
    sin, cos = f.sin(pi * a), f.cos(pi * a)
    u = f.exp(q[0]) * t
    depth = 2.303 * (f.digits + 2)
    width = 0.95 * min(math.pi / 2, math.pi * (1 - number) / number)
    h = 2.0 ** math.floor(math.log2(2 * math.pi * width / depth))  # a power of two: exact nodes
    right = math.log(depth / float(min(v for v in u if v > 0)))
    s = f.array(h * np.arange(math.floor(-depth / number / h), math.ceil(right / h) + 1))
    up = f.exp(a * s)
    cosh, sinh = (up + 1 / up) / 2, (up - 1 / up) / 2
    bottom = cosh + cos
    w = h * sin / (2 * pi * bottom)
    w_a = h * (pi * cos * bottom - sin * (s * sinh - pi * sin)) / (2 * pi * bottom**2)
    z = np.outer(u, f.exp(s))
    e = f.exp(-z)
    start = t == 0
    phi, by_rate, by_a = (e * w).sum(axis=1), -(z * e * w).sum(axis=1), (e * w_a).sum(axis=1)
    return [np.where(start, 1 + 0 * t, phi)], [[by_rate], [np.where(start, 0 * t, by_a)]]


def sheet(f, t, q):
    """(8/pi^2) sum_{k odd} exp(-k^2 x)/k^2, x = lambda t, for x > 1;
    1 - (4/pi) sqrt(x) [pi^(-1/2) + 2 sum (-1)^j ierfc(j pi/(2 sqrt x))] below (its image under Poisson summation)."""
    pi = f.pi()
    x = f.exp(q[0]) * t
    start, late = x == 0, x > 1
    big = np.where(late, x, f.array(1.0))
    small = np.where(start | late, f.array(1.0), x)
    terms = [(k, f.exp(-k * k * big)) for k in range(1, 14, 2)]
    phi_late = 8 / pi**2 * sum(e / k**2 for k, e in terms)
    flux_late = 8 / pi**2 * big * sum(e for _, e in terms)
    root, root_pi = small ** f.array(0.5), pi ** f.array(0.5)
    arguments = [(j, j * pi / (2 * root)) for j in range(1, 9)]
    images = sum((-1) ** j * (f.exp(-a * a) / root_pi - a * f.erfc(a)) for j, a in arguments)
    phi_early = 1 - 4 / pi * root * (1 / root_pi + 2 * images)
    flux_early = 2 / pi * root / root_pi * (1 + 2 * sum((-1) ** j * f.exp(-a * a) for j, a in arguments))
    phi = np.where(start, 1 + 0 * t, np.where(late, phi_late, phi_early))
    flux = np.where(start, 0 * t, np.where(late, flux_late, flux_early))
    return [phi], [[-flux]]
