"""NIST StRD nonlinear regression problems that are the relaxation law in other clothes.

    y = y_e + delta phi(x; lambda, n)

    Misra1a  b1 (1 - exp(-b2 x))            n = 1    lambda = b2   y_e = b1, delta = -b1
    Misra1b  b1 (1 - (1 + b2 x/2)^-2)       n = 3/2  lambda = b2   y_e = b1, delta = -b1
    Misra1d  b1 b2 x / (1 + b2 x)           n = 2    lambda = b2   y_e = b1, delta = -b1
    Misra1c  b1 (1 - (1 + 2 b2 x)^(-1/2))   n = 3    lambda = b2   y_e = b1, delta = -b1
    BoxBOD   b1 (1 - exp(-b2 x))            n = 1    lambda = b2   y_e = b1, delta = -b1
    Bennett5 b1 (b2 + x)^(-1/b3)            n = 1 + b3, lambda = 1/(b2 b3), y_e = 0, delta = b1 b2^(-1/b3)

Data and certified values are read from the .dat files published by NIST (public domain) in the folder given
as argument (default: $PALPATE_DATA/nist). Every mapping is checked: the law at the mapped certified values
has to reproduce NIST's own formula and the certified RSS, and a 40-digit Gauss-Newton fit of NIST's formula
has to land on the certified parameters and standard deviations.
"""

import os
import pathlib
import re
import sys

import mpmath as mp

from _common import write_reference
from _fit import polish

mp.mp.dps = 40


def phi(z, n):
    return mp.exp(-z) if n == 1 else (1 + (n - 1) * z) ** (-1 / (mp.mpf(n) - 1))


def rising(n):
    """b1 (1 - phi(b2 x; n)) and its partials, written as NIST writes the formula."""
    def model(x, b):
        b1, b2 = b
        if n == 1:
            e = mp.exp(-b2 * x)
            return b1 * (1 - e), 1 - e, b1 * x * e
        if n == 1.5:
            s = 1 + b2 * x / 2
            return b1 * (1 - s**-2), 1 - s**-2, b1 * x * s**-3
        if n == 2:
            s = 1 + b2 * x
            return b1 * b2 * x / s, b2 * x / s, b1 * x / s**2
        s = 1 + 2 * b2 * x
        return b1 * (1 - 1 / mp.sqrt(s)), 1 - 1 / mp.sqrt(s), b1 * x * s ** mp.mpf(-1.5)
    return model


def bennett(x, b):
    b1, b2, b3 = b
    f = b1 * (b2 + x) ** (-1 / b3)
    return f, f / b1, -f / (b3 * (b2 + x)), f * mp.log(b2 + x) / b3**2


PROBLEMS = {
    "Misra1a": (1.0, rising(1)), "Misra1b": (1.5, rising(1.5)), "Misra1c": (3.0, rising(3)),
    "Misra1d": (2.0, rising(2)), "BoxBOD": (1.0, rising(1)), "Bennett5": (None, bennett),
}


def read(path, number=float):
    lines = path.read_text(encoding="ascii").splitlines()
    rows = [re.findall(r"[-+\d.E]+", line.split("=")[1]) for line in lines if re.match(r"\s+b\d\s*=", line)]
    value = {}
    for key in ("Residual Sum of Squares", "Residual Standard Deviation", "Degrees of Freedom"):
        value[key] = next(line.split(":")[1].split()[0] for line in lines if line.startswith(key))
    start = max(i for i, line in enumerate(lines) if line.startswith("Data:"))
    data = [line.split() for line in lines[start + 1:] if line.strip()]
    y, x = [number(d[0]) for d in data], [number(d[1]) for d in data]
    assert int(value["Degrees of Freedom"]) == len(y) - len(rows)
    return rows, value, x, y


def main():
    default = pathlib.Path(os.environ.get("PALPATE_DATA", "data")) / "nist"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    cases = []
    for name, (n, model) in PROBLEMS.items():
        rows, value, x, y = read(folder / f"{name}.dat")
        b = [mp.mpf(r[2]) for r in rows]
        sd = [mp.mpf(r[3]) for r in rows]
        rss = mp.mpf(value["Residual Sum of Squares"])
        if n is None:
            y_e, delta = mp.mpf(0), b[0] * b[1] ** (-1 / b[2])
            lam, exponent, link = 1 / (b[1] * b[2]), 1 + b[2], "y_e = 0"
        else:
            y_e, delta, lam, exponent, link = b[0], -b[0], b[1], mp.mpf(n), "y_e + delta = 0"
        for s in x:  # the law is NIST's formula
            a, c = y_e + delta * phi(lam * mp.mpf(s), exponent), model(mp.mpf(s), b)[0]
            assert abs(a - c) < mp.mpf("1e-30") * abs(b[0])

        def whole(p):
            out = [model(mp.mpf(s), p) for s in x]
            return [o[0] for o in out], [[o[k] for o in out] for k in range(1, len(p) + 1)]

        p, best, cov = polish(whole, y, b)
        for got, want in zip(p, b):
            assert abs(got / want - 1) < 1e-9, (name, got, want)
        for i, want in enumerate(sd):
            assert abs(mp.sqrt(cov[i][i]) / want - 1) < 1e-8, (name, i)
        assert abs(best / rss - 1) < 1e-9
        print(f"{name:9s} n {float(exponent):.10f}  lambda {float(lam):.10e}"
              f"  parameters off {float(max(abs(g / w - 1) for g, w in zip(p, b))):.0e}"
              f"  RSS off {float(abs(best / rss - 1)):.0e}")
        free = None
        if n is not None:  # the same data with y_e and delta both free: our own fit, not certified
            def open_law(q):
                rows = []
                for s in map(mp.mpf, x):
                    z = mp.exp(q[2]) * s
                    f = phi(z, n)
                    rows.append((q[0] + q[1] * f, mp.mpf(1), f, -q[1] * z * f ** mp.mpf(n)))
                return [o[0] for o in rows], [[o[k] for o in rows] for k in (1, 2, 3)]

            q, q_rss, q_cov = polish(open_law, y, [y_e, delta, mp.log(lam)])
            free = {"y_e": float(q[0]), "delta": float(q[1]), "lambda": float(mp.exp(q[2])),
                    "ln_lambda": float(q[2]), "rss": float(q_rss),
                    "standard_errors": [float(mp.sqrt(q_cov[i][i])) for i in range(3)]}
        cases.append({
            "name": name, "x": x, "y": y,
            "starts": [[float(r[k]) for r in rows] for k in (0, 1)],
            "certified": [float(v) for v in b], "certified_sd": [float(v) for v in sd],
            "certified_rss": float(rss), "certified_residual_sd": float(value["Residual Standard Deviation"]),
            "degrees_of_freedom": int(value["Degrees of Freedom"]),
            "fixed_n": n, "constraint": link,
            "y_e": float(y_e), "delta": float(delta), "lambda": float(lam), "n": float(exponent),
            "unconstrained": free,
        })
    write_reference(
        "nist", ["mpmath"],
        {"parameters_relative": 1e-9, "sd_relative": 1e-8, "rss_relative": 1e-9,
         "note": "certified values have 11 digits; y_e, delta, lambda, n are their images under the mapping; "
                 "the certified parameters are b1, b2 (b3) of NIST's formula; `constraint` says which of "
                 "y_e, delta the problem ties down; `unconstrained` (not certified) is the same fit with y_e, "
                 "delta and ln lambda all free, standard errors in that order"},
        cases)


if __name__ == "__main__":
    main()
