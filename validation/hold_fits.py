"""Fits of y(t) = y_e + delta phi(t; lambda, n) to noisy synthetic holds, global optimum included.

Data are drawn with a fixed seed, rounded to 9 significant digits, and the rounded data are what is fitted.
The search for the optimum knows nothing of the truth: for given (ln lambda, n) the law is linear in
(y_e, delta), so RSS is scanned on a fine grid of (ln lambda, n); then 240 random starts go through
scipy.optimize.least_squares, and the best of all is polished by Gauss-Newton in mpmath (40 digits).
lmfit, started at the optimum and again from a distance, has to find the same numbers.
Covariance is s^2 (J^T J)^-1 with s^2 = RSS/(N - p), parameters in the order of `parameters`.
"""

import lmfit
import mpmath as mp
import numpy as np
from scipy.optimize import least_squares

from _common import write_reference
from _fit import polish

N_LOW, N_HIGH = 0.1, 30.0
STARTS = 240


def shape(t, log_lambda, n):
    """phi and its partials in ln lambda and n, in doubles."""
    z, a = np.exp(log_lambda) * t, n - 1.0
    w = a * z
    live = w > -1.0
    w = np.where(live, w, 0.0)
    small = np.abs(w) < 0.02
    safe = np.where(small, 1.0, w)
    ratio = np.where(small, sum((-w) ** k / (k + 1) for k in range(10)), np.log1p(safe) / safe)
    bend = np.where(small, sum((-w) ** k * (k + 1) / (k + 2) for k in range(10)),
                    (np.log1p(safe) - safe / (1 + safe)) / safe**2)
    p = np.where(live, np.exp(-z * ratio), 0.0)
    return p, -p * z / (1 + w), p * z * z * bend


def shape_mp(t, log_lambda, n):
    z, a = mp.exp(log_lambda) * t, n - 1
    if a == 0:
        p = mp.exp(-z)
        return p, -z * p, p * z * z / 2
    s = 1 + a * z
    if s <= 0:
        return mp.mpf(0), mp.mpf(0), mp.mpf(0)
    log = mp.log(s)
    p = mp.exp(-log / a)
    return p, -z * p / s, p * (log / a**2 - z / (a * s))


def linear_part(t, y, log_lambda, n):
    """y_e, delta, RSS that are best for given (ln lambda, n)."""
    p = shape(t, log_lambda, n)[0]
    pc, yc = p - p.mean(), y - y.mean()
    spp = pc @ pc
    delta = (pc @ yc) / spp if spp > 0 else 0.0
    return y.mean() - delta * p.mean(), delta, float(np.sum((yc - delta * pc) ** 2))


def search(t, y, n_fixed, rng):
    """Every local optimum met, best first: list of (rss, [y_e, delta, ln lambda, n])."""
    span, first = t[-1] - t[0], np.min(np.diff(t))
    low, high = np.log(1e-3 / span), np.log(1e8 / first)

    def residual(q):
        f = q[0] + q[1] * shape(t, q[2], q[3] if n_fixed is None else n_fixed)[0]
        return f - y

    def jacobian(q):
        p, dl, dn = shape(t, q[2], q[3] if n_fixed is None else n_fixed)
        cols = [np.ones_like(t), p, q[1] * dl] + ([q[1] * dn] if n_fixed is None else [])
        return np.column_stack(cols)

    logs = np.linspace(low, high, 240)
    exponents = np.geomspace(N_LOW, N_HIGH, 60) if n_fixed is None else [n_fixed]
    grid = [(linear_part(t, y, L, n)[2], L, n) for L in logs for n in exponents]
    starts = [(L, n) for _, L, n in sorted(grid)[:20]]
    starts += [(rng.uniform(low, high), np.exp(rng.uniform(np.log(N_LOW), np.log(N_HIGH)))
                if n_fixed is None else n_fixed) for _ in range(STARTS)]
    found, scale = [], np.ptp(y)
    for L, n in starts:
        y_e, delta, _ = linear_part(t, y, L, n)
        q0 = [y_e, delta, L] + ([n] if n_fixed is None else [])
        lower = [-np.inf, -np.inf, low] + ([N_LOW] if n_fixed is None else [])
        upper = [np.inf, np.inf, high] + ([N_HIGH] if n_fixed is None else [])
        q0[2] = min(max(q0[2], low + 1e-9), high - 1e-9)
        if n_fixed is None:
            q0[3] = min(max(q0[3], N_LOW + 1e-9), N_HIGH - 1e-9)
        fit = least_squares(residual, q0, jacobian, bounds=(lower, upper), x_scale="jac",
                            xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=300)
        found.append((2 * fit.cost, list(fit.x)))
    found.sort(key=lambda item: item[0])
    best = found[0]
    reached = sum(abs(f[0] - best[0]) <= 1e-7 * best[0] for f in found)
    assert best[0] <= min(g[0] for g in grid) * (1 + 1e-9)
    q = best[1]
    assert low + 1 < q[2] < high - 1 and abs(q[1]) < 50 * scale, q
    if n_fixed is None:
        assert N_LOW * 1.5 < q[3] < N_HIGH / 1.5, q
    return best, reached, len(found)


def with_lmfit(t, y, n_fixed, start, away):
    """lmfit from `start` moved by `away` standard errors; numerical Jacobian, its own covariance."""
    params = lmfit.Parameters()
    for name, value, move in zip(("y_e", "delta", "ln_lambda", "n"), start, away):
        params.add(name, value=value + move)
    if n_fixed is None:
        params["n"].min, params["n"].max = N_LOW, N_HIGH
    else:
        params.add("n", value=n_fixed, vary=False)

    def residual(p):
        return p["y_e"] + p["delta"] * shape(t, p["ln_lambda"].value, p["n"].value)[0] - y

    return lmfit.minimize(residual, params, method="leastsq", xtol=1e-13, ftol=1e-13, gtol=1e-13,
                          max_nfev=20000)


def hold(name, y_e, delta, lam, n, duration, count, spacing, noise, fit_n, seed):
    rng = np.random.default_rng(seed)
    if spacing == "linear":
        t = np.linspace(0.0, duration, count)
    else:
        t = np.concatenate([[0.0], np.geomspace(duration * 1e-4, duration, count - 1)])
    t = np.array([float(f"{v:.8e}") for v in t])
    y = y_e + delta * shape(t, np.log(lam), n)[0] + rng.normal(0.0, noise, count)
    y = np.array([float(f"{v:.8e}") for v in y])

    best, reached, tried = search(t, y, fit_n, rng)
    start = best[1]

    def model(p):
        nn = p[3] if fit_n is None else mp.mpf(fit_n)
        rows = [shape_mp(mp.mpf(float(s)), p[2], nn) for s in t]
        cols = [[mp.mpf(1)] * count, [a for a, _, _ in rows], [p[1] * b for _, b, _ in rows]]
        if fit_n is None:
            cols.append([p[1] * c for _, _, c in rows])
        return [p[0] + p[1] * a for a, _, _ in rows], cols

    p, rss, cov = polish(model, [float(v) for v in y], start)
    assert abs(rss / best[0] - 1) < 1e-8
    se = [mp.sqrt(cov[i][i]) for i in range(len(p))]

    worst = 0.0
    for k in (0.0, 1.0):
        other = with_lmfit(t, y, fit_n, [float(v) for v in p], [k * float(s) for s in se])
        names = ["y_e", "delta", "ln_lambda", "n"][: len(p)]
        worst = max([worst] + [abs(other.params[a].value - float(b)) / float(s)
                               for a, b, s in zip(names, p, se)])
        for a, s in zip(names, se):
            assert abs(other.params[a].stderr / float(s) - 1) < 2e-3, (name, a)
    assert worst < 1e-4, (name, worst)
    assert max(abs(a) for a in map(float, se[2:])) < 1.5, (name, [float(s) for s in se])

    print(f"{name:36s} N {count:4d}  n {float(p[3]) if fit_n is None else fit_n:7.3f}"
          f"  y_e {float(p[0]):.5f}+-{float(se[0]):.5f}  ln lambda {float(p[2]):.4f}+-{float(se[2]):.4f}"
          f"  starts {reached}/{tried}  lmfit {worst:.0e} se", flush=True)
    return {
        "name": name, "well_defined": True, "fixed_n": fit_n,
        "truth": {"y_e": y_e, "delta": delta, "lambda": lam, "n": n, "noise": noise},
        "t": t.tolist(), "y": y.tolist(),
        "parameters": ["y_e", "delta", "ln_lambda", "n"][: len(p)],
        "y_e": float(p[0]), "delta": float(p[1]), "lambda": float(mp.exp(p[2])),
        "ln_lambda": float(p[2]), "n": float(p[3]) if fit_n is None else fit_n,
        "standard_errors": [float(s) for s in se],
        "covariance": [[float(v) for v in row] for row in cov],
        "rss": float(rss), "starts_at_optimum": int(reached), "starts": tried,
    }


def degenerate(name, t, y, why):
    return {"name": name, "well_defined": False, "fixed_n": None, "why": why,
            "t": [float(f"{v:.8e}") for v in t], "y": [float(f"{v:.8e}") for v in y]}


def main():
    cases = [
        # name, y_e, delta, lambda, n, duration, count, spacing, noise, n of the fit (None: free), seed
        hold("exponential, falling", 2.0, 1.0, 0.6, 1.0, 10.0, 60, "linear", 0.01, 1.0, 1),
        hold("exponential, rising", 0.3, -0.2, 1.5, 1.0, 8.0, 30, "linear", 0.002, 1.0, 2),
        hold("hyperbola, falling", 5.0, 3.0, 2.0, 2.0, 20.0, 100, "linear", 0.02, 2.0, 3),
        hold("hyperbola, rising, log times", 0.1, -0.4, 4.0, 2.0, 100.0, 80, "log", 0.002, 2.0, 4),
        hold("cubic, falling", 0.35, 0.1, 1.2, 3.0, 30.0, 200, "linear", 2e-4, 3.0, 5),
        hold("quintic, falling, 10 s", 0.357, 0.133, 6.26, 5.0, 10.0, 400, "linear", 2e-4, 5.0, 6),
        hold("quintic, rising, 10 s", 0.071, -0.133, 6.26, 5.0, 10.0, 250, "linear", 2e-4, 5.0, 7),
        hold("quintic data, cubic fit", 0.357, 0.133, 6.26, 5.0, 10.0, 200, "linear", 2e-4, 3.0, 8),
        hold("newtons, quintic, log times", 15.0, 10.0, 8.0, 5.0, 600.0, 120, "log", 0.02, 5.0, 9),
        hold("free, near 1", 1.0, 1.0, 0.8, 1.0, 12.0, 150, "linear", 0.003, None, 10),
        hold("free, below 1", 0.5, 0.5, 0.3, 0.6, 12.0, 120, "linear", 0.003, None, 11),
        hold("free, square, log times", 2.0, -1.0, 3.0, 2.0, 200.0, 100, "log", 0.003, None, 12),
        hold("free, cubic, falling", 0.35, 0.1, 5.0, 3.0, 60.0, 300, "linear", 1e-4, None, 13),
        hold("free, 4.4, long, log times", 20.0, 9.0, 2.0, 4.42, 1800.0, 200, "log", 0.01, None, 14),
        hold("free, quintic, rising, log times", 0.071, -0.133, 6.26, 5.0, 300.0, 160, "log", 2e-4, None, 15),
        hold("free, 7.3, log times", 1.0, 0.8, 20.0, 7.3, 2000.0, 140, "log", 5e-4, None, 16),
    ]
    t = np.linspace(0.0, 10.0, 50)
    cases += [
        degenerate("constant", t, np.full(50, 0.25), "no change: delta is 0 and lambda means nothing"),
        degenerate("straight line", t, 1.0 - 0.02 * t,
                   "the fit runs to lambda -> 0 with delta -> infinity (or n -> 0): no interior optimum"),
    ]
    write_reference(
        "hold_fits", ["numpy", "scipy", "lmfit", "mpmath"],
        {"parameters_in_standard_errors": 1e-4, "standard_errors_relative": 1e-4, "rss_relative": 1e-8,
         "note": "printed values are good to the last digit (40-digit Gauss-Newton); the tolerances are "
                 "what a double-precision optimiser can be held to; lmfit agrees to 1e-4 standard errors"},
        cases, n_bounds=[N_LOW, N_HIGH])


if __name__ == "__main__":
    main()
