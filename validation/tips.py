"""Rigid tips on an elastic half space and on a layer: forces and contact radii of a sphere, a cone and a flat punch.

Frictionless contact of a body of revolution f(r) with a layer of thickness h on a rigid base (Hayes et al., J. Biomech. 5, 1972; Dhaliwal
and Rau, Int. J. Engng Sci. 8, 1970) is the Fredholm equation

    pi/2 phi(x) - int_0^a phi(t) int_0^inf (1 - L(w h)) cos(w x) cos(w t) dw dt = g(x),    F = pi E/(1 - nu^2) int_0^a phi dt

with g = delta for a punch of radius a, delta - x^2/R for a paraboloid, delta - pi/2 x cot(alpha) for a cone, and phi(a) = 0 for the last
two. L is 1 for a half space and, for a layer, with k = 3 - 4 nu,

    bonded    (2 k sinh 2w - 4 w)/(2 k cosh 2w + 1 + k^2 + 4 w^2)
    sliding   (cosh 2w - 1)/(sinh 2w + 2 w)

Solved by Gauss-Legendre quadrature with 48 nodes; 32 nodes agree. The half space is also the closed forms of Hertz and Sneddon, the punch on
a bonded layer the table of Hayes et al., and the sphere that is no paraboloid Sneddon's equation.
"""

import math

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad
from scipy.optimize import brentq

from _common import round_up, write_reference

WAVES, WEIGHTS = leggauss(400)
WAVES, WEIGHTS = 15 * (WAVES + 1), 15 * WEIGHTS
# Contact radius on a half space over thickness; palpate accepts up to a half.
RATIOS = [0.05, 0.2, 0.3, 0.4, 0.49]
# Hayes et al. (1972), kappa of a punch on a bonded layer, by a/h: nu = 0.3, 0.4, 0.5.
HAYES = {0.2: [1.207, 1.232, 1.281], 0.4: [1.472, 1.542, 1.683]}


def lost(w, nu, base):
    """1 - L."""
    w = np.asarray(w, float)
    e2 = np.exp(-2 * w)
    if base == "bonded":
        k = 3 - 4 * nu
        return 1 - (k * (1 - e2 * e2) - 4 * w * e2) / (k * (1 + e2 * e2) + (1 + k * k + 4 * w * w) * e2)
    return 1 - (1 - e2) ** 2 / (1 - e2 * e2 + 4 * w * e2)


def kernel(x, t, nu, base):
    if base is None:
        return np.zeros((len(x), len(t)))
    return (np.cos(np.outer(x, WAVES)) * lost(WAVES, nu, base) * WEIGHTS) @ np.cos(np.outer(t, WAVES)).T


def solve(tip, a, nu, base, nodes):
    """Indentation and F (1 - nu^2)/E at contact radius a, with the thickness as the unit of length; profiles of size 1."""
    x, w = leggauss(nodes)
    x, w = a * (x + 1) / 2, a * w / 2
    system = math.pi / 2 * np.eye(nodes) - kernel(x, x, nu, base) * w
    flat = np.linalg.solve(system, np.ones(nodes))
    if tip == "punch":
        return 1.0, math.pi * (flat @ w)
    profile = {"sphere": lambda x: x * x, "cone": lambda x: math.pi / 2 * x}[tip]
    form = np.linalg.solve(system, profile(x))
    edge = kernel(np.array([a]), x, nu, base)[0] * w
    indentation = (profile(a) + edge @ form) / (1 + edge @ flat)
    return indentation, math.pi * ((indentation * flat - form) @ w)


def at_ratio(tip, ratio, nu, base, nodes):
    """Indentation and force where the contact radius on a half space is `ratio` of the thickness."""
    if tip == "punch":
        return solve(tip, ratio, nu, base, nodes)
    wanted = ratio**2 if tip == "sphere" else math.pi / 2 * ratio
    a = brentq(lambda a: solve(tip, a, nu, base, nodes)[0] / wanted - 1, 0.3 * ratio, 3 * ratio, xtol=1e-14)
    return solve(tip, a, nu, base, nodes)


def half_space(tip, indentation, ratio):
    return {"sphere": 4 / 3 * indentation**1.5, "cone": 2 / math.pi * indentation**2, "punch": 2 * ratio}[tip]


def main():
    cases, worst = [], 0.0
    for base in (None, "bonded", "sliding"):
        for nu in (0.0, 0.2, 0.3, 0.4, 0.5) if base == "bonded" else (0.3, 0.5):
            for tip in ("sphere", "cone", "punch"):
                for ratio in RATIOS:
                    indentation, force = at_ratio(tip, ratio, nu, base, 48)
                    again = at_ratio(tip, ratio, nu, base, 32)[1]
                    worst = max(worst, abs(again / force - 1))
                    if base is None:
                        worst = max(worst, abs(half_space(tip, indentation, ratio) / force - 1))
                    if base == "bonded" and tip == "punch" and ratio in HAYES and nu in (0.3, 0.4, 0.5):
                        table = HAYES[ratio][(0.3, 0.4, 0.5).index(nu)]
                        assert abs(force / (2 * ratio) / table - 1) < 1e-3, (nu, ratio, force / (2 * ratio), table)
                    cases.append({"tip": tip, "base": base, "poisson_ratio": nu, "radius": ratio if tip == "punch" else 1.0,
                                  "indentation": indentation, "force": force})
    assert worst < 1e-9, worst
    moments = []
    for base in ("bonded", "sliding"):
        for nu in np.linspace(0, 0.5, 11):
            k0, k2 = (quad(lambda w: w**j * float(lost(w, nu, base)), 0, 60, epsabs=1e-12, limit=400)[0] for j in (0, 2))
            moments.append([base, round(float(nu), 2), k0, k2])
    for share in (0.02, 0.1, 0.5):
        a = brentq(lambda a: a / 2 * math.log((1 + a) / (1 - a)) - share, 1e-6, 1 - 1e-12)
        exact = 0.5 * ((a * a + 1) * math.log((1 + a) / (1 - a)) - 2 * a)
        print(f"sphere at u = {share} R: Hertz {100 * (4 / 3 * share**1.5 / exact - 1):.1f} % above Sneddon")
    print(f"48 and 32 nodes, and the half space in closed form, agree to {worst:.1e}")
    write_reference("tips", ["scipy", "numpy"], {"half_space": 1e-9, "layer": 0.02}, cases, moments=moments,
                    agreement=round_up(worst))


if __name__ == "__main__":
    main()
