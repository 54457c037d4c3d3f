"""Ten NIST StRD problems as laws of a hold: certified numbers, and the same minimum in palpate's numbers.

    Misra1a, b, d, c   b1 (1 - phi(x; b2, n)), n = 1, 3/2, 2, 3     creep, instantaneous 0: amplitude b1, rate b2
    BoxBOD             b1 (1 - exp(-b2 x))                          creep, instantaneous 0: amplitude b1, rate b2
    Bennett5           b1 (b2 + x)^(-1/b3)                          relaxation, constant 0: amplitude b1 b2^(-1/b3);
                       power: rate 1/b2, alpha 1/b3; latency: rate 1/(b2 b3), exponent 1 + b3
    Lanczos1, 2, 3     b1 e^(-b2 x) + b3 e^(-b4 x) + b5 e^(-b6 x)   relaxation, constant 0: amplitudes, rates
    MGH17              b1 + b2 e^(-b4 x) + b3 e^(-b5 x)             relaxation: constant, amplitudes, rates

NIST's formula is fitted to NIST's decimals by Gauss-Newton in mpmath (60 digits), which has to land on every digit of
the certified values. The minimum and its covariance are then mapped (delta method), and the mapped numbers checked
to be the minimum of the law itself by one more fit. A double is not the decimal: `values_of_doubles` is the fit of
the printed doubles, which differs for Lanczos1 only, whose residuals (1e-13) are near the rounding of a double.
"""

import os
import pathlib
import sys

import mpmath as mp

import nist
from _common import write_reference
from _fit import polish

mp.mp.dps = 60


def exponential_sum(amplitudes, rates, constant=None):
    """sum b[a] exp(-b[r] x) + b[constant] and its partials."""
    def model(x, b):
        out = [mp.mpf(0)] * len(b)
        value = mp.mpf(0)
        if constant is not None:
            value, out[constant] = b[constant], mp.mpf(1)
        for a, r in zip(amplitudes, rates):
            e = mp.exp(-b[r] * x)
            value, out[a], out[r] = value + b[a] * e, e, -b[a] * x * e
        return (value, *out)
    return model


def to_creep(b):
    """amplitude, ln_rate."""
    one, zero = mp.mpf(1), mp.mpf(0)
    return [b[0], mp.log(b[1])], [[one, zero], [zero, 1 / b[1]]]


def to_power(b):
    """amplitude, ln_rate, alpha of amplitude (1 + rate t)^-alpha."""
    b1, b2, b3 = b
    amplitude = b1 * b2 ** (-1 / b3)
    return ([amplitude, -mp.log(b2), 1 / b3],
            [[amplitude / b1, -amplitude / (b2 * b3), amplitude * mp.log(b2) / b3**2],
             [0, -1 / b2, 0], [0, 0, -1 / b3**2]])


def to_latency(b):
    """amplitude, ln_rate, exponent."""
    values, rows = to_power(b)
    return ([values[0], -mp.log(b[1] * b[2]), 1 + b[2]], [rows[0], [0, -1 / b[1], -1 / b[2]], [0, 0, 1]])


def to_prony(amplitudes, rates, constant=None):
    """constant, amplitudes, ln rates, fastest first."""
    def mapping(b):
        order = sorted(range(len(rates)), key=lambda k: -b[rates[k]])
        linear = ([constant] if constant is not None else []) + [amplitudes[k] for k in order]
        values = [b[k] for k in linear] + [mp.log(b[rates[k]]) for k in order]
        rows = [[mp.mpf(k == j) for j in range(len(b))] for k in linear]
        rows += [[(j == rates[k]) / b[rates[k]] for j in range(len(b))] for k in order]
        return values, rows
    return mapping


def law_value(case, t, p):
    """The law at palpate's numbers, written anew."""
    p = list(p)
    constant = p.pop(0) if case["parameters"][0] == "constant" else mp.mpf(0)
    if case["law"] == "prony":
        k = len(p) // 2
        return constant + mp.fsum(a * mp.exp(-mp.exp(q) * t) for a, q in zip(p[:k], p[k:]))
    rate = mp.exp(p[1])
    if case["law"] == "power":
        return p[0] * (1 + rate * t) ** -p[2]
    phi = nist.phi(rate * t, mp.mpf(case["fixed"]["exponent"]) if "exponent" in case["fixed"] else p[2])
    return p[0] * (1 - phi) if case["kind"] == "creep" else p[0] * phi


def creep(n, text):
    return {"model": nist.rising(n), "views": [
        ("latency", "creep", {"instantaneous": 0.0, "exponent": float(n)}, ["amplitude", "ln_rate"], to_creep, text)]}


LANCZOS = {"model": exponential_sum([0, 2, 4], [1, 3, 5]), "views": [
    ("prony", "relaxation", {"constant": 0.0},
     ["amplitude_1", "amplitude_2", "amplitude_3", "ln_rate_1", "ln_rate_2", "ln_rate_3"],
     to_prony([0, 2, 4], [1, 3, 5]), "amplitudes b5, b3, b1, ln rates ln b6, ln b4, ln b2 (fastest first)")]}
PLAIN = "amplitude = b1, ln_rate = ln b2"
PROBLEMS = {
    "Misra1a": creep(1, PLAIN), "Misra1b": creep(1.5, PLAIN), "Misra1c": creep(3, PLAIN), "Misra1d": creep(2, PLAIN),
    "BoxBOD": creep(1, PLAIN),
    "Bennett5": {"model": nist.bennett, "views": [
        ("power", "relaxation", {"constant": 0.0}, ["amplitude", "ln_rate", "alpha"], to_power,
         "amplitude = b1 b2^(-1/b3), ln_rate = -ln b2, alpha = 1/b3"),
        ("latency", "relaxation", {"constant": 0.0}, ["amplitude", "ln_rate", "exponent"], to_latency,
         "amplitude = b1 b2^(-1/b3), ln_rate = -ln(b2 b3), exponent = 1 + b3")]},
    "Lanczos1": LANCZOS, "Lanczos2": LANCZOS, "Lanczos3": LANCZOS,
    "MGH17": {"model": exponential_sum([1, 2], [3, 4], 0), "views": [
        ("prony", "relaxation", {}, ["constant", "amplitude_1", "amplitude_2", "ln_rate_1", "ln_rate_2"],
         to_prony([1, 2], [3, 4], 0), "constant = b1, amplitudes b3, b2, ln rates ln b5, ln b4 (fastest first)")]},
}


def refit(model, x, y, start):
    def whole(p):
        rows = [model(s, p) for s in x]
        return [r[0] for r in rows], [[r[k] for r in rows] for k in range(1, len(p) + 1)]
    return polish(whole, y, start, dps=60)


def same_digits(value, text):
    """Units of the last printed digit between value and text."""
    exponent = int(text.upper().split("E")[1])
    return float(abs(value - mp.mpf(text)) / mp.mpf(10) ** (exponent - 10))


def propagate(rows, covariance):
    size = len(covariance)
    return [[mp.fsum(a[i] * covariance[i][j] * b[j] for i in range(size) for j in range(size)) for b in rows]
            for a in rows]


def view(name, x, y, p, rss, covariance, doubles, spec):
    law, kind, fixed, parameters, mapping, text = spec
    values, rows = mapping(p)
    cov = propagate(rows, covariance)
    case = {"law": law, "kind": kind, "fixed": fixed, "parameters": parameters, "algebra": text}
    residuals = [law_value(case, s, values) - v for s, v in zip(x, y)]
    assert abs(mp.fsum(r * r for r in residuals) / rss - 1) < mp.mpf("1e-20"), name
    for k in range(len(values)):  # the gradient of RSS vanishes in the law's own numbers
        step = abs(values[k]) * mp.mpf("1e-25") + mp.mpf("1e-25")
        moved = [v + step * (i == k) for i, v in enumerate(values)]
        slope = [(law_value(case, s, moved) - law_value(case, s, values)) / step for s in x]
        cosine = mp.fsum(a * b for a, b in zip(slope, residuals)) / mp.sqrt(mp.fsum(a * a for a in slope) * rss)
        assert abs(cosine) < mp.mpf("1e-12"), (name, parameters[k], cosine)
    return {**case, "values": [float(v) for v in values],
            "standard_errors": [float(mp.sqrt(cov[k][k])) for k in range(len(values))],
            "covariance": [[float(c) for c in row] for row in cov],
            "values_of_doubles": [float(v) for v in mapping(doubles)[0]]}


def main():
    default = pathlib.Path(os.environ.get("PALPATE_DATA", "data")) / "nist"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else default
    cases = []
    for name, problem in PROBLEMS.items():
        rows, value, x, y = nist.read(folder / f"{name}.dat", mp.mpf)
        start = [mp.mpf(r[2]) for r in rows]
        p, rss, covariance = refit(problem["model"], x, y, start)
        ulps = {"parameters": max(same_digits(v, r[2]) for v, r in zip(p, rows)),
                "standard_errors": max(same_digits(mp.sqrt(covariance[k][k]), r[3]) for k, r in enumerate(rows)),
                "rss": same_digits(rss, value["Residual Sum of Squares"])}
        print(f"{name:9s} units of the 11th digit: " + "  ".join(f"{k} {v:.2f}" for k, v in ulps.items()), flush=True)
        assert max(ulps.values()) < 0.501, name
        printed_x, printed_y = [[mp.mpf(float(v)) for v in column] for column in (x, y)]
        doubles, doubles_rss, _ = refit(problem["model"], printed_x, printed_y, start)
        cases.append({
            "name": name, "x": [float(v) for v in x], "y": [float(v) for v in y],
            "starts": [[float(r[k]) for r in rows] for k in (0, 1)],
            "certified": [float(r[2]) for r in rows], "certified_standard_errors": [float(r[3]) for r in rows],
            "certified_rss": float(value["Residual Sum of Squares"]),
            "degrees_of_freedom": int(value["Degrees of Freedom"]),
            "refit": [float(v) for v in p],
            "refit_standard_errors": [float(mp.sqrt(covariance[k][k])) for k in range(len(p))],
            "rss": float(rss), "rss_of_doubles": float(doubles_rss),
            "laws": [view(name, x, y, p, rss, covariance, doubles, spec) for spec in problem["views"]],
        })
    write_reference(
        "nist_laws", ["mpmath"],
        {"certified_relative": 1e-10, "values_relative": 1e-9, "standard_errors_relative": 1e-8, "rss_relative": 1e-9,
         "note": "certified values have 11 digits; the refit of NIST's decimals in 60 digits has every one of "
                 "them; values, standard_errors and covariance of `laws` are that refit under `algebra`, "
                 "s^2 (J^T J)^-1 with s^2 = RSS/(N - p). Lanczos1: in doubles the residuals drown (no RSS to test); "
                 "values_relative is of max(1, |value|)"},
        cases)


if __name__ == "__main__":
    main()
