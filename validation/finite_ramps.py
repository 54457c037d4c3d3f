"""Shapes averaged over a loading, from mpmath at 40 digits: int phi(t - s) d gamma(s), with derivatives by the parameters.

A loading is a piecewise linear gamma(s), s <= 0, given as (time, value) from 0 to 1. Inputs are doubles and used as exactly
those doubles. Every value is computed in two ways that share nothing: from the antiderivative Phi of the shape, piece
by piece, and by quadrature of the shape itself. Derivatives are differences of the first at 1e-15 with 70 digits.
"""

import functools

import mpmath as mp

from _common import write_reference
from special_functions import mittag_leffler

DIGITS = 40
AGREE = mp.mpf("1e-11")  # between the two ways; the quadrature has kinks to get over

LOADINGS = {
    "ramp": [(-1.0, 0.0), (0.0, 1.0)],
    "irregular": [(-2.0, 0.0), (-1.5, 0.25), (-1.4375, 0.25), (-0.875, 1.25), (-0.25, 0.875), (-0.03125, 1.125), (0.0, 1.0)],
    "slow then fast": [(-1000.0, 0.0), (-0.125, 0.25), (0.0, 1.0)],
}
TIMES = [0.0, 1e-6, 0.0078125, 0.3, 1.0, 40.0]
SHAPES = [
    ("exponential", (1e-3,)), ("exponential", (1.0,)), ("exponential", (300.0,)),
    ("stretched", (0.5, 0.05)), ("stretched", (3.0, 0.4)), ("stretched", (40.0, 0.7)), ("stretched", (2.0, 1.3)),
    ("stretched", (1.0, 2.0)),
    ("power_decay", (5.0, 0.3)), ("power_growth", (0.5, 0.2)), ("logarithm", (20.0,)),
    ("mittag_leffler", (0.5, 0.1)), ("mittag_leffler", (5.0, 0.6)), ("mittag_leffler", (1.0, 1.0)),
    ("fung_continuous", (0.05, 8.0)), ("fung_continuous", (2.0, 3.0)),
    ("diffusion", (0.2,)), ("diffusion", (6.0,)),
]


def shape(name, parameters, x):
    """phi(x); the parameters are a rate and a pure number, for Fung's spectrum ln of the ratio of its rates."""
    s = parameters[0] * x
    if name == "exponential":
        return mp.exp(-s)
    if name == "stretched":
        return mp.exp(-(s ** parameters[1]))
    if name == "power_decay":
        return (1 + s) ** -parameters[1]
    if name == "power_growth":
        return s ** parameters[1]
    if name == "logarithm":
        return mp.log1p(s)
    if name == "mittag_leffler":
        return mittag_leffler(parameters[1], s) if s else mp.mpf(1)
    if name == "fung_continuous":
        return (mp.e1(s) - mp.e1(s * mp.exp(parameters[1]))) / parameters[1] if s else mp.mpf(1)
    odd = range(1, 4001, 2) if s < 0.001 else range(1, int(mp.sqrt(110 / s)) + 5, 2)
    if s < 0.001:  # the faces do not feel each other
        return 1 - 4 * mp.sqrt(s / mp.pi**3)
    return 8 / mp.pi**2 * sum(mp.exp(-k * k * s) / k**2 for k in odd)


def antiderivative(name, parameters, x):
    """int_0^x phi."""
    rate, s = parameters[0], parameters[0] * x
    if s == 0:
        return mp.mpf(0)
    if name == "exponential":
        return -mp.expm1(-s) / rate
    if name == "stretched":
        return mp.gammainc(1 / parameters[1], 0, s ** parameters[1]) / (parameters[1] * rate)
    if name == "power_decay":
        return ((1 + s) ** (1 - parameters[1]) - 1) / ((1 - parameters[1]) * rate)
    if name == "power_growth":
        return s ** (1 + parameters[1]) / ((1 + parameters[1]) * rate)
    if name == "logarithm":
        return ((1 + s) * mp.log1p(s) - s) / rate
    if name == "mittag_leffler":  # x E_{alpha,2}(-s^alpha)
        return x * two_parameter(parameters[1], s)
    if name == "fung_continuous":
        def exchanged(s):  # int_0^s E1
            return s * mp.e1(s) - mp.expm1(-s)
        ratio = mp.exp(parameters[1])
        return (exchanged(s) - exchanged(ratio * s) / ratio) / (parameters[1] * rate)
    # sum over odd k of 8/pi^2 (1 - exp(-k^2 s))/k^4, with sum 1/k^4 = pi^4/96
    if s < 0.001:
        return (s - mp.mpf(8) / 3 * s * mp.sqrt(s / mp.pi**3)) / rate
    odd = range(1, int(mp.sqrt(160 / s)) + 5, 2)
    return 8 / mp.pi**2 * (mp.pi**4 / 96 - sum(mp.exp(-k * k * s) / k**4 for k in odd)) / rate


@functools.cache
def reciprocal_gamma(alpha, k):
    with mp.workdps(150):
        return mp.rgamma(alpha * k + 2)


def two_parameter(alpha, s):
    """E_{alpha,2}(-s^alpha): the power series with the digits that it loses, or the asymptotic one."""
    if s > 150:
        total, size = mp.mpf(0), mp.inf
        for k in range(1, 4000):
            term = -((-(s ** -alpha)) ** k) * mp.rgamma(2 - alpha * k)
            bound = s ** (-alpha * k) * mp.gamma(abs(alpha * k - 1) + mp.mpf("0.01"))
            if k > 2 / alpha and bound > size:
                break
            total, size = total + term, bound
            if bound < mp.mpf(10) ** (-mp.mp.dps) * abs(total):
                break
        return total
    with mp.workdps(int(mp.mp.dps + 0.44 * s + 10)):
        x, total, k, power = s**alpha, mp.mpf(0), 0, mp.mpf(1)
        small = mp.mpf(10) ** (-mp.mp.dps)
        while True:
            term = power * reciprocal_gamma(alpha, k)
            total += term
            if alpha * k > 2 and abs(term) < small:
                return total
            k, power = k + 1, -power * x


def pieces(loading):
    for (before, low), (after, high) in zip(loading, loading[1:]):
        yield mp.mpf(before), mp.mpf(after), mp.mpf(high) - mp.mpf(low)


def average(name, parameters, loading, t):
    total = mp.mpf(0)
    for before, after, change in pieces(loading):
        ends = antiderivative(name, parameters, t - before) - antiderivative(name, parameters, t - after)
        total += change * ends / (after - before)
    return total


def by_quadrature(name, parameters, loading, t):
    total = mp.mpf(0)
    for before, after, change in pieces(loading):
        if change == 0:
            continue
        short, long = t - after, t - before
        ratio = [short] + [m for m in (short + (long - short) * mp.mpf(2) ** -k for k in range(40, 0, -4)) if m > short] + [long]
        total += change * mp.quad(lambda x: shape(name, parameters, x), ratio) / (after - before)
    return total


def case(name, parameters, loading, t):
    exact = [mp.mpf(parameter) for parameter in parameters]
    path, at = LOADINGS[loading], mp.mpf(t)
    value = average(name, exact, path, at)
    derivatives = []
    with mp.workdps(70):
        step = mp.mpf("1e-15")
        for i in range(len(exact)):
            def moved(by):  # the rate moves in its logarithm
                return [exact[0] * mp.exp(by)] + exact[1:] if i == 0 else [exact[0], exact[1] + by]

            if name == "mittag_leffler" and i == 1 and exact[1] == 1:
                side = [average(name, moved(-k * step), path, at) for k in (0, 1, 2)]
                derivatives.append((3 * side[0] - 4 * side[1] + side[2]) / (2 * step))
                continue
            derivatives.append((average(name, moved(step), path, at) - average(name, moved(-step), path, at)) / (2 * step))
    return {"shape": name, "parameters": list(parameters), "loading": loading, "time": t, "value": float(value),
            "derivatives": [float(d) for d in derivatives]}


def main():
    mp.mp.dps = DIGITS
    cases = []
    for name, parameters in SHAPES:
        cases += [case(name, parameters, loading, t) for loading in LOADINGS for t in TIMES]
        print(name, *parameters, flush=True)
    # The second way, at 20 digits, where it is quick.
    mp.mp.dps = 20
    worst = mp.mpf(0)
    for one in cases:
        if one["time"] not in (0.0, 0.3) or one["shape"] in ("mittag_leffler",) and one["loading"] == "slow then fast":
            continue
        parameters = [mp.mpf(parameter) for parameter in one["parameters"]]
        other = by_quadrature(one["shape"], parameters, LOADINGS[one["loading"]], mp.mpf(one["time"]))
        error = abs(other - one["value"]) / max(1, abs(one["value"]))
        assert error < AGREE, (one, other)
        worst = max(worst, error)
    print("quadrature agrees to", mp.nstr(worst, 2))
    write_reference("finite_ramps", ["mpmath"], {"value": 1e-12, "derivative": 1e-10, "note": "of 1, or of the value above 1"},
                    cases, loadings=LOADINGS)


if __name__ == "__main__":
    main()
