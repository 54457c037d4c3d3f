"""Three holds that share the numbers of the material and keep their own constants and amplitudes.

    latency   y_h = e_h + D_h phi(t; v |D_h|^(n - 1), n)     v, n shared: the rate of a hold follows from its drop
    SLS       y_h = e_h + D_h exp(-t/tau)                    tau shared
    Prony-2   y_h = e_h + sum_i D_ih exp(-t/tau_i)           tau_1, tau_2 shared

Least squares over all samples, equal weights. SLS and Prony-2 are linear in all but the rates: searched and polished
as in `law_fits.py`. In the joint latency fit D_h is nonlinear too: 120 random starts of all eight numbers, the best
polished in mpmath (40 digits). lmfit agrees to 1e-3 standard errors (it differentiates numerically).
Covariance is s^2 (J^T J)^-1, s^2 = RSS/(N - p).
"""

import math

import lmfit
import mpmath as mp
import numpy as np
from scipy.optimize import least_squares

from _common import write_reference
from _fit import polish
from _laws import Law, fit, law, line, logs, rounded
from _shapes import Digits, Doubles

LN = math.log
STARTS = 120


class Joint(Law):
    """A law with shared nonlinear numbers; `which` numbers the hold of every sample."""

    def __init__(self, base, which, spans):
        self.base, self.which, self.spans = base, which, spans
        self.name, self.nonlinear = base.name, base.nonlinear
        self.holds = range(max(which) + 1)
        self.linear = [f"{name}_hold_{h + 1}" for h in self.holds for name in base.linear]
        self.names = self.linear + self.nonlinear

    def columns(self, f, t, q):
        columns, partials = self.base.columns(f, t, q)

        def split(row):
            return [np.where(self.which == h, c, 0 * t) for h in self.holds for c in row]
        return split(columns), [split(row) for row in partials]

    def bounds(self, t):
        return np.mean([self.base.bounds(s) for s in self.spans], axis=0)


def latency_model(f, times, p):
    """Values and partials in ln v, n, e_1.., D_1.. of all samples."""
    count = len(times)
    log_v, n, e, d = p[0], p[1], p[2: 2 + count], p[2 + count:]
    values, partials = [], [[] for _ in p]
    for h, t in enumerate(times):
        log_drop = f.log(abs(d[h]))
        phi, by_rate, by_n = f.latency(t, log_v + (n - 1) * log_drop, n)
        own = {0: d[h] * by_rate, 1: d[h] * (by_n + log_drop * by_rate), 2 + h: 1 + 0 * t,
               2 + count + h: phi + (n - 1) * by_rate}
        values.extend(e[h] + d[h] * phi)
        for k, column in enumerate(partials):
            column.extend(own.get(k, 0 * t))
    return values, partials


def draw(f_value, noise, rng, times):
    return [rounded(v + rng.normal(0.0, noise, len(t)), 7) for v, t in zip(f_value, times)]


def result(name, which, names, shared, times, ys, truth, p, covariance, rss, reached, tried):
    errors = [float(mp.sqrt(covariance[k][k])) for k in range(len(p))]
    count = sum(map(len, times))
    print(f"{name:24s} N {count}  starts {reached}/{tried}  shared " + "  ".join(
        f"{n} {float(v):.4f}+-{s:.4f}" for n, v, s in zip(names, p, errors) if n in shared), flush=True)
    return {"name": name, "law": which, "kind": "relaxation", "truth": truth, "shared": shared,
            "holds": [{"t": t.tolist(), "y": y.tolist()} for t, y in zip(times, ys)], "parameters": names,
            "values": [float(v) for v in p], "standard_errors": errors,
            "covariance": [[float(v) for v in row] for row in covariance], "rss": float(rss),
            "starts_at_optimum": int(reached), "starts": tried}


def latency(name, log_v, n, constants, drops, times, noise, seed):
    rng = np.random.default_rng(seed)
    truth = [log_v, n, *constants, *drops]
    flat, _ = latency_model(Doubles, times, truth)
    ends = np.cumsum([len(t) for t in times])[:-1]
    ys = draw(np.split(np.array(flat), ends), noise, rng, times)
    y = np.concatenate(ys)
    sign = np.array([np.sign(a[0] - a[-1]) for a in ys])
    low = np.array([-40.0, 0.2] + [-np.inf] * 3 + [0.0 if s > 0 else -np.inf for s in sign])
    high = np.array([60.0, 30.0] + [np.inf] * 3 + [np.inf if s > 0 else 0.0 for s in sign])
    found = []
    for _ in range(STARTS):
        k = np.exp(rng.uniform(LN(0.5), LN(15.0)))
        d = np.array([a[0] - a[-1] for a in ys]) * rng.uniform(0.8, 2.0)
        rate = rng.uniform(LN(0.1 / times[0][-1]), LN(10.0 / times[0][1]))
        q = [rate - (k - 1) * LN(abs(d[0])), k, *[a[-1] for a in ys], *d]
        got = least_squares(lambda p: np.array(latency_model(Doubles, times, p)[0]) - y, np.clip(q, low, high),
                            lambda p: np.array(latency_model(Doubles, times, p)[1]).T, bounds=(low, high),
                            x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=400)
        found.append((2 * got.cost, list(got.x)))
    found.sort()
    exact = [Digits.array(t) for t in times]
    p, rss, covariance = polish(lambda q: latency_model(Digits, exact, q), [float(v) for v in y], found[0][1])
    assert abs(rss / found[0][0] - 1) < 1e-8 and 0.3 < p[1] < 20
    names = ["ln_rate_coefficient", "exponent"] + [f"{a}_hold_{h + 1}" for a in ("constant", "amplitude")
                                                   for h in range(3)]
    errors = [float(mp.sqrt(covariance[k][k])) for k in range(len(p))]
    params = lmfit.Parameters()
    for a, v, s in zip(names, p, errors):
        params.add(a, value=float(v) + 0.3 * s)
    other = lmfit.minimize(lambda r: np.array(latency_model(Doubles, times, [r[a].value for a in names])[0]) - y,
                           params, method="leastsq", xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=40000)
    for a, v, s in zip(names, p, errors):
        assert abs(other.params[a].value - float(v)) < 1e-3 * s, (name, a)  # lmfit's difference quotients
        assert abs(other.params[a].stderr / s - 1) < 1e-3, (name, a)
    for got, v, s in zip(found[0][1], p, errors):
        assert abs(got - float(v)) < 1e-5 * s, (name, got, v)
    reached = sum(c[0] <= found[0][0] * (1 + 1e-7) for c in found)
    return result(name, "latency", names, names[:2], times, ys, truth, p, covariance, rss, reached, STARTS)


def exponential(name, base, linear, q, times, noise, seed):
    rng = np.random.default_rng(seed)
    ys = draw([base.value(t, list(a) + list(q))[0] for a, t in zip(linear, times)], noise, rng, times)
    which = np.concatenate([np.full(len(t), h) for h, t in enumerate(times)])
    joint = Joint(base, which, times)
    got = fit(joint, np.concatenate(times), np.concatenate(ys), None, rng)
    truth = [v for a in linear for v in a] + list(q)
    return result(name, base.name, joint.names, joint.nonlinear, times, ys, truth, got["p"], got["covariance"],
                  got["chi2"], got["reached"], got["tried"])


def main():
    sls, two = law("standard_linear_solid"), law("prony", count=2)
    log = [logs(1e-2, 30.0, 60), logs(1e-2, 60.0, 70), logs(2e-2, 100.0, 65)]
    even = [line(10.0, 61), line(12.0, 61), line(15.0, 76)]
    cases = [
        latency("quintic, three steps", LN(2e4), 5.0, [0.07, 0.15, 0.22], [0.13, 0.10, 0.16], log, 3e-4, 301),
        latency("loading and unloading", LN(2.0), 2.5, [2.0, 1.0, 0.5], [1.0, -0.8, -0.4], even, 5e-3, 302),
        exponential("SLS", sls, [(8.0, 4.0), (12.0, 3.0), (5.0, -2.0)], [LN(0.4)], even, 3e-2, 303),
        exponential("Prony-2", two, [(8.0, 2.0, 3.0), (12.0, 1.5, 2.5), (5.0, -1.0, -2.0)], [LN(4.0), LN(0.1)], log,
                    1e-2, 304),
    ]
    write_reference(
        "joint_fits", ["numpy", "scipy", "lmfit", "mpmath"],
        {"values_in_standard_errors": 1e-4, "standard_errors_relative": 1e-4, "rss_relative": 1e-8,
         "note": "printed values are good to the last digit (40-digit Gauss-Newton); standard_errors and covariance "
                 "are in the order of `parameters`; ln_rate_coefficient is ln v with v |amplitude|^(n-1) in 1/s"},
        cases)


if __name__ == "__main__":
    main()
