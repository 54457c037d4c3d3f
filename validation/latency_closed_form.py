"""The relaxation shape phi(t; lambda, n) and its two derivatives, from mpmath at 50 digits.

    phi = [1 + (n-1) lambda t]^(-1/(n-1))     n != 1
    phi = exp(-lambda t)                      n == 1
    n < 1: zero from t = 1/((1-n) lambda) on

Every input is a double and is used as exactly that double, so the printed outputs are the correctly
rounded values of the function at the printed inputs. Beside each output stands an absolute tolerance:
how far a careful double-precision evaluation may be off when lambda*t and n-1 are each rounded.
"""

import math

import mpmath as mp

from _common import round_up, write_reference

mp.mp.dps = 50
EPS = mp.mpf(2) ** -52
TINY = mp.mpf("1e-307")  # results below this may be subnormal or flushed to zero

N = [0.2, 0.5, 0.9, 0.999, 0.999999, 1 - 1e-12, 1.0, 1 + 1e-12, 1.000001, 1.001,
     1.5, 2.0, 3.0, 5.0, 7.3, 9.0, 15.0, 50.0]
Z = [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0,
     100.0, 300.0, 700.0, 1e3, 1e4, 1e6, 1e9, 1e12]
LAMBDA = [1.0, 0.037, 1300.0]  # taken in turn; t = z / lambda
END = [0.5, 0.9, 0.99, 0.999999, 1 - 1e-12, 1.0, 1 + 1e-12, 1.1]  # fractions of the finite end


def shape(z, a):
    """(phi, d phi/d ln lambda, d phi/d n) at z = lambda t, a = n - 1."""
    if a == 0:
        p = mp.exp(-z)
        return p, -z * p, p * z * z / 2
    s = 1 + a * z
    if s <= 0:
        return mp.mpf(0), mp.mpf(0), mp.mpf(0)
    # For small |a z| the derivative in n loses about 2 log10(1/(a z)) digits: take them in advance.
    lost = int(max(0, -2 * mp.log10(abs(a * z)))) if z else 0
    with mp.workdps(mp.mp.dps + lost + 10):
        log = mp.log(1 + a * z)
        p = mp.exp(-log / a)
        return p, -z * p / (1 + a * z), p * (log / a**2 - z / (a * (1 + a * z)))


def case(lam, t, n):
    z = mp.mpf(lam) * mp.mpf(t)
    a = mp.mpf(n) - 1
    exact = shape(z, a)
    # Response to a rounding of z (two roundings) and of n - 1 (one), worst of the four corners.
    spread = [mp.mpf(0)] * 3
    for sz in (-1, 1):
        for sa in (-1, 1):
            moved = shape(z * (1 + sz * EPS), a * (1 + sa * EPS / 2))
            spread = [max(s, abs(x - y)) for s, x, y in zip(spread, moved, exact)]
    log_p = abs(mp.log(exact[0])) if exact[0] > 0 else mp.mpf(0)
    base = [16 * EPS * (1 + log_p), 16 * EPS * (1 + log_p), mp.mpf("1e-11")]
    tol = [4 * s + b * abs(x) + TINY for s, b, x in zip(spread, base, exact)]
    return {
        "n": n, "lambda": lam, "t": t,
        "phi": float(exact[0]), "dphi_dlnlambda": float(exact[1]), "dphi_dn": float(exact[2]),
        "tol_phi": round_up(tol[0]), "tol_dlnlambda": round_up(tol[1]), "tol_dn": round_up(tol[2]),
    }


def check_against_quadrature():
    """phi must solve d phi/dz = -phi^n from phi = 1; the derivatives must match mpmath's own differences."""
    for n in (0.5, 0.999, 1.5, 5.0, 7.3):
        a = mp.mpf(n) - 1
        for z in (mp.mpf("0.3"), mp.mpf("1.7")):
            p, dl, dn = shape(z, a)
            back = mp.quad(lambda q: q ** -(a + 1), [p, 1])
            assert abs(back - z) < mp.mpf("1e-40"), (n, z)
            assert abs(mp.diff(lambda l: shape(z * mp.exp(l), a)[0], 0) - dl) < mp.mpf("1e-20")
            assert abs(mp.diff(lambda b: shape(z, b)[0], a) - dn) < mp.mpf("1e-20")


def in_doubles(lam, t, n):
    """One careful double-precision evaluation, to show that the printed tolerances can be met."""
    z, a = lam * t, n - 1.0
    w = a * z
    if w <= -1.0:
        return 0.0, 0.0, 0.0
    log_ratio = math.log1p(w) / w if w else 1.0  # ln(1+w)/w
    p = math.exp(-z * log_ratio)
    if abs(w) < 0.02:  # sum_k (-w)^k (k+1)/(k+2) = [ln(1+w) - w/(1+w)] / w^2
        bend = sum((-w) ** k * (k + 1) / (k + 2) for k in range(12))
        return p, -z * p / (1 + w), p * z * z * bend
    return p, -z * p / (1 + w), p * (math.log1p(w) - w / (1 + w)) / a / a


def main():
    check_against_quadrature()
    cases, turn = [], 0
    for n in N:
        zs = list(Z)
        if n < 0.99:
            zs += [f / (1 - n) for f in END]
        for z in zs:
            lam = LAMBDA[turn % len(LAMBDA)]
            turn += 1
            cases.append(case(lam, z / lam, n))
    for c in cases:
        got = in_doubles(c["lambda"], c["t"], c["n"])
        for x, name, tol in zip(got, ("phi", "dphi_dlnlambda", "dphi_dn"),
                                ("tol_phi", "tol_dlnlambda", "tol_dn")):
            assert abs(x - c[name]) <= c[tol], (c, got)
    write_reference(
        "latency_closed_form", ["mpmath"],
        {"note": "absolute, per case and per output: |computed - printed| <= tol_*; "
                 "printed values are correctly rounded, and below 5e-324 they are 0"},
        cases)


if __name__ == "__main__":
    main()
