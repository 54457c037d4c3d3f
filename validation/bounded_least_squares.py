"""Least squares with bounds: SciPy's nnls and lsq_linear on problems of 1 to 40 columns.

Each case holds the normal equations, the bounds, the solution and the least value of a^T G a - 2 b^T a. SciPy works on the
columns themselves, not on the normal equations. A solution is written only if the conditions of an optimum hold to
1e-11 and, where it can be tried, trf and bvls agree.
"""

import argparse

import numpy as np
from scipy.optimize import lsq_linear, nnls

from _common import write_reference

NAME = "bounded_least_squares"
OPTIMUM = 1e-11  # largest slope at the optimum, in units of |b|


def check(gram, right, lower, upper, a):
    """Largest violation of the conditions of an optimum."""
    slope = (gram @ a - right) / np.linalg.norm(right)
    inside = (a > lower) & (a < upper)
    worst = np.abs(slope[inside]).max(initial=0.0)
    worst = max(worst, (-slope[(a == lower) & (a < upper)]).max(initial=0.0))
    return max(worst, slope[(a == upper) & (a > lower)].max(initial=0.0))


def on_bounds(a, lower, upper, columns, y):
    """The same answer with numbers exactly at their bounds, or exactly solved for."""
    tol = 1e-9 * (1.0 + np.abs(a))
    at_lower, at_upper = a - lower < tol, upper - a < tol
    a = np.where(at_lower, lower, np.where(at_upper, upper, 0.0))
    free = ~(at_lower | at_upper)
    if free.any():
        a[free] = np.linalg.lstsq(columns[:, free], y - columns[:, ~free] @ a[~free], rcond=None)[0]
    return a


def case(name, columns, y, lower, upper):
    """One case, solved twice."""
    if np.all(lower == 0.0) and np.all(np.isinf(upper)):
        raw, made_by = nnls(columns, y)[0], "nnls"
    else:
        raw, made_by = lsq_linear(columns, y, (lower, upper), method="bvls", tol=1e-15, max_iter=2000).x, "bvls"
    a = on_bounds(raw, lower, upper, columns, y)
    other = lsq_linear(columns, y, (lower, upper), method="trf", tol=1e-15, lsq_solver="exact", max_iter=5000).x
    cost = lambda x: np.sum((columns @ x - y) ** 2)
    gram, right = columns.T @ columns, columns.T @ y
    assert cost(a) <= cost(other) * (1 + 1e-9) + 1e-14, (name, cost(a), cost(other))
    assert check(gram, right, lower, upper, a) < OPTIMUM, (name, check(gram, right, lower, upper, a))
    finite = lambda bounds: [None if np.isinf(b) else float(b) for b in bounds]
    return {
        "name": name, "solver": made_by, "gram": gram.ravel().tolist(), "right": right.tolist(),
        "lower": finite(lower), "upper": finite(upper), "solution": a.tolist(),
        "value": float(a @ gram @ a - 2 * right @ a),
    }


def cases():
    """Random columns with and without bounds in the way; exponentials of a relaxation with noise."""
    rng = np.random.default_rng(20)
    for size in (1, 2, 3, 4, 6, 10):
        columns, y = rng.normal(size=(3 * size + 4, size)), rng.normal(size=3 * size + 4)
        free = np.full(size, np.inf)
        yield case(f"random, {size} non-negative", columns, y, np.zeros(size), free)
        width = rng.uniform(0.01, 0.4, size)
        center = rng.normal(size=size) * 0.2
        yield case(f"random, {size} in boxes", columns, y, center - width, center + width)
        some = rng.random(size) < 0.5
        yield case(f"random, {size} half of them free", columns, y, np.where(some, -free, 0.0), free)
    t = np.linspace(0.0, 1.0, 300)
    for size, noise in ((6, 1e-2), (12, 1e-3), (20, 1e-2)):
        tau = np.geomspace(0.01, 5.0, size)
        columns = np.column_stack([np.exp(-t[:, None] / tau), np.ones_like(t)])
        y = 0.3 + np.exp(-t / 0.05) + 0.5 * np.exp(-t / 0.4) + noise * rng.normal(size=t.size)
        lower = np.r_[np.zeros(size), -np.inf]
        yield case(f"{size} exponentials and a constant", columns, y, lower, np.full(size + 1, np.inf))


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__).parse_args()
    tolerance = {
        "value_relative": 1e-12, "solution": 1e-7,
        "note": "solution relative to its largest number; normal equations square the condition of the columns",
    }
    write_reference(NAME, ["numpy", "scipy"], tolerance, list(cases()))
