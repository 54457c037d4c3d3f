"""Profile-likelihood 95 % intervals of the numbers of a law.

One number is held at v and the others are fitted again: chi^2(v). The interval is where the F-test of lmfit's
conf_interval stays below 0.95:

    F(chi^2(v)) = (chi^2(v)/chi^2_min - 1)(N - p) < F_0.95(1, N - p)

Each end is a root found to 1e-11 (brentq) of a profile that is refitted from the neighbouring point and from a grid
of starts; lmfit.conf_interval, which stops at 5e-5 of the value, has to agree where it finds an end. An end is open
where even the limiting law (a straight line, as rate -> 0) stays below the bound; lmfit reports infinity, or gives up.
"""

import itertools
import math
import warnings

import lmfit
import numpy as np
from scipy.optimize import brentq, least_squares
from scipy.stats import f as f_distribution

from _common import write_reference
from _laws import fit, hold, law, line, linear_fit, logs, with_lmfit
from _shapes import Doubles

LN = math.log
PROBABILITY = 0.95


class Profile:
    """chi^2 of the best fit with one number held."""

    def __init__(self, which, t, y, index):
        self.law, self.t, self.y, self.index = which, t, y, index
        self.linear = len(which.linear)

    def residual(self, free, value):
        """Residual at the free nonlinear numbers, the linear ones eliminated."""
        k = self.index - self.linear
        q = np.clip(free if k < 0 else np.insert(free, k, value), -50.0, 50.0)  # a trial step may be wild
        columns, _ = self.law.columns(Doubles, self.t, q)
        y = self.y
        if k < 0:
            y = y - value * columns[self.index]
            columns = columns[: self.index] + columns[self.index + 1:]
        a = np.column_stack(columns)
        u = np.linalg.svd(a / (np.linalg.norm(a, axis=0) + 1e-300), full_matrices=False)[0]
        r = y - u @ (u.T @ y)
        return r - u @ (u.T @ r)

    def chi2(self, value, starts):
        """Best of all starts, and where it is."""
        if len(starts[0]) == 0:
            return float(np.sum(self.residual([], value) ** 2)), ()
        found = []
        for q in starts:
            got = least_squares(self.residual, q, jac="3-point", args=(value,), x_scale="jac", method="lm",
                                xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=4000)
            found.append((2 * got.cost, tuple(got.x)))
        return min(found)

    def grid(self, q, errors):
        """Starts around the optimum, two and eight standard errors away in each free number."""
        free = [k for k in range(len(q)) if k != self.index - self.linear]
        moves = itertools.product(*[(-8.0, -2.0, 0.0, 2.0, 8.0) for _ in free])
        return [tuple(q[k] + m * errors[self.linear + k] for k, m in zip(free, move)) for move in moves]


def end(profile, best, errors, side, bound):
    """Where the profile meets the bound; None where it does not within 2000 standard errors, or before the law is a
    straight line to 1e-6 of its change (a lower rate is the same line, and beyond the digits of a double)."""
    flat = -6 * LN(10.0) - LN(profile.t[-1]) if profile.law.names[profile.index].startswith("ln_rate") else -np.inf
    centre, error = best[profile.index], errors[profile.index]
    starts = profile.grid(best[profile.linear:], errors)
    near, warm, step = centre, starts[len(starts) // 2], 0.25 * error
    with np.errstate(all="ignore"):
        while True:
            far = near + side * step
            chi2, at = profile.chi2(far, [warm])
            if chi2 > bound:
                break
            near, warm, step = far, at, 1.3 * step
            if abs(far - centre) > 2000 * error or far < flat:
                return None
        root = brentq(lambda v: profile.chi2(v, [warm, at])[0] / bound - 1, near, far, xtol=1e-13, rtol=1e-13)
        wide, _ = profile.chi2(root, starts)
        assert wide > bound * (1 - 1e-9), ("another minimum", profile.index, side, wide / bound)
    return float(root)


def by_lmfit(which, t, y, best):
    w = np.ones_like(t)
    minimizer, result = with_lmfit(which, t, y, w, best, nan_policy="omit")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        ends = {}
        for name in which.names:
            try:
                found = lmfit.conf_interval(minimizer, result, p_names=[name], sigmas=[PROBABILITY])[name]
                ends[name] = (found[0][1], found[-1][1])
            except (ValueError, lmfit.minimizer.MinimizerException) as trouble:
                ends[name] = (str(trouble), str(trouble))
    return ends


def case(name, which, linear, q, t, noise, seed):
    y, _, rng = hold(which, linear, q, t, noise, seed)
    got = fit(which, t, y, None, rng)
    best, errors, chi2 = [float(v) for v in got["p"]], got["errors"], float(got["chi2"])
    count, size = len(t), len(best)
    quantile = float(f_distribution.ppf(PROBABILITY, 1, count - size))
    bound = chi2 * (1 + quantile / (count - size))
    straight = float(np.sum((y - np.polyval(np.polyfit(t, y, 1), t)) ** 2))
    others = by_lmfit(which, t, y, best)
    lower, upper, worst = [], [], 0.0
    for k, label in enumerate(which.names):
        ends = [end(Profile(which, t, y, k), best, errors, side, bound) for side in (-1, 1)]
        for mine, theirs in zip(ends, others[label]):
            if mine is None:
                assert straight < 0.97 * bound, (name, label)
                assert isinstance(theirs, str) or not abs(theirs - best[k]) < 20 * errors[k], (name, label, theirs)
            else:
                assert not isinstance(theirs, str), (name, label, theirs)
                worst = max(worst, abs(theirs - mine) / errors[k])
                assert abs(theirs - mine) < 5e-5 * abs(mine) + 1e-6 * errors[k], (name, label, mine, theirs)
        lower.append(ends[0])
        upper.append(ends[1])
        shown = [f"{(e - best[k]) / errors[k]:+.4f}" if e is not None else "open" for e in ends]
        print(f"{which.name + ': ' + name:40s} {label:10s} {best[k]:.6g} +- {errors[k]:.2g}  ends in se: {shown}"
              f"  lmfit {others[label]}", flush=True)
    return {
        "name": f"{which.name}: {name}", "law": which.name, "kind": which.kind, "fixed": which.fixed,
        "t": t.tolist(), "y": y.tolist(), "parameters": which.names, "values": best,
        "standard_errors": errors.tolist(), "chi_square": chi2, "probability": PROBABILITY, "f_quantile": quantile,
        "chi_square_bound": bound, "lower": lower, "upper": upper,
        "open_lower": [v is None for v in lower], "open_upper": [v is None for v in upper],
        "chi_square_straight_line": straight, "lmfit_agreement_in_standard_errors": worst,
    }


def main():
    free, fifth = law("latency"), law("latency", exponent=5.0)
    sls, two, kww = law("standard_linear_solid"), law("prony", count=2), law("stretched")
    cases = [
        case("n free", free, [0.36, 0.13], [LN(6.0), 4.0], logs(1e-2, 60.0, 80), 5e-3, 201),
        case("n free, rising", free, [2.0, -1.0], [LN(2.0), 2.0], line(20.0, 101), 3e-2, 202),
        case("n = 5", fifth, [0.36, 0.13], [LN(6.0)], line(10.0, 101), 8e-3, 203),
        case("falling", sls, [8.0, 4.0], [LN(0.15)], line(12.0, 61), 0.15, 204),
        case("rising", sls, [1.0, -0.6], [LN(0.8)], logs(1e-2, 4.0, 60), 0.03, 205),
        case("two times", two, [10.0, 2.0, 3.0], [LN(3.0), LN(0.2)], line(20.0, 101), 0.12, 206),
        case("falling", kww, [2.0, 3.0], [LN(0.4), 0.6], logs(1e-2, 30.0, 80), 0.12, 207),
        case("equilibrium not identified", sls, [8.0, 4.0], [LN(0.06)], line(6.0, 61), 0.15, 215),
        case("n = 5, equilibrium not identified", fifth, [0.5, 0.5], [LN(0.05)], line(6.0, 61), 1e-2, 213),
    ]
    write_reference(
        "profile_intervals", ["numpy", "scipy", "lmfit", "mpmath"],
        {"ends_in_standard_errors": 1e-5,
         "note": "ends are roots of a profile good to 1e-9 in chi-square; lmfit stops its root search at 5e-5 of the "
                 "value. null: the end is open (the profile never reaches chi_square_bound; chi_square_straight_line, "
                 "the limit rate -> 0, stays below it), so minus or plus infinity"},
        cases)


if __name__ == "__main__":
    main()
