"""Special functions behind three relaxation shapes, from mpmath at 40 digits and more.

    mittag_leffler   E_alpha(-s^alpha), 0.05 <= alpha <= 1, with its derivatives in ln s and alpha
    e1               E1(x) = int_x^oo exp(-u)/u du
    fung             [E1(a t) - E1(b t)] / ln(b/a) at t = 1, with its derivatives in ln a and ln b
    diffusion        (8/pi^2) sum over odd k of exp(-k^2 s)/k^2, with its derivative in ln s

Inputs are doubles and used as exactly those doubles. Every number is computed in two ways that share nothing:
the Mittag-Leffler function from its power or asymptotic series and from the integral of its spectrum, E1 by mpmath
and by quadrature, Fung's shape by E1 and as the mean of exp(-x) over ln x, diffusion as the sum and as its
Poisson transform (below s = 1e-6 by that alone).
"""

import mpmath as mp

from _common import write_reference

DIGITS = 40
AGREE = mp.mpf("1e-25")  # relative, between the two ways
TINY = mp.mpf("1e-300")  # below this the doubles end; the tests take 0 for it

ALPHA = [0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.9999, 0.999999, 1.0]
S = [1e-30, 1e-12, 1e-6, 1e-3, 0.03, 0.4, 1.0, 3.0, 8.0, 14.0, 20.0, 26.0, 33.0, 45.0, 90.0, 1e3, 1e6, 1e12, 1e30]
SWITCH = [0.9900001, 0.995]  # palpate changes its form at 0.99


def power_series(alpha, s):
    """sum (-1)^k s^(alpha k) / Gamma(alpha k + 1); the largest term is about e^s, so take that many digits more."""
    with mp.workdps(int(mp.mp.dps + 0.44 * s + 10)):
        x, total, k, power = mp.mpf(s) ** alpha, mp.mpf(0), 0, mp.mpf(1)
        small = mp.mpf(10) ** (-mp.mp.dps)
        while True:
            term = power * mp.rgamma(alpha * k + 1)
            total += term
            if alpha * k > s + 2 and abs(term) < small:
                return total
            k, power = k + 1, -power * x


def asymptotic_series(alpha, s):
    """-sum_{k>=1} (-1)^k s^(-alpha k) / Gamma(1 - alpha k), good to about e^-s."""
    x, total, size = mp.mpf(s) ** -alpha, mp.mpf(0), mp.inf
    for k in range(1, int(s / alpha)):
        term = -((-x) ** k) * mp.rgamma(1 - alpha * k)
        total += term
        bound = x**k * mp.gamma(alpha * k)  # the term without the sine that may be 0
        if bound < mp.mpf(10) ** (-mp.mp.dps) * abs(total) or bound > size:
            break
        size = bound
    return total


def mittag_leffler(alpha, s):
    """E_alpha(-s^alpha) by the series that fits."""
    alpha = mp.mpf(alpha)
    if alpha == 1:
        return mp.exp(-mp.mpf(s))
    return power_series(alpha, s) if s <= 150 else asymptotic_series(alpha, s)


def spectral_integral(alpha, s):
    """int exp(-s e^u) sin(pi alpha) / (2 pi (cosh(alpha u) + cos(pi alpha))) du."""
    alpha, s = mp.mpf(alpha), mp.mpf(s)
    sine, cosine = mp.sin(mp.pi * alpha), mp.cos(mp.pi * alpha)
    width = mp.pi * (1 - alpha) / alpha
    # Not cosh + cos, which cancels where the spectrum is a needle.
    low = 2 * mp.sin(mp.pi * (1 - alpha) / 2) ** 2

    def spectrum(u):
        return mp.exp(-s * mp.exp(u)) * sine / (2 * mp.pi * (2 * mp.sinh(alpha * u / 2) ** 2 + low))

    edge = -mp.log(s)
    end = mp.log(250) + edge
    left = min(edge, 0) - 110 / alpha
    marks = [left, end] + [edge + d for d in (-40, -15, -6, -3, -1, 0, 1, 2, 3, 4)]
    marks += [sign * width * 4**k for sign in (-1, 1) for k in range(0, 20) if width * 4**k < 200] + [0]
    marks += [k / alpha for k in range(-300, 301, 5)]
    marks = sorted({m for m in marks if left <= m <= end})
    with mp.extradps(int(max(0, mp.log10(s))) + 6):  # mp.quad stops at an absolute error
        return mp.quad(spectrum, marks, maxdegree=9)


def mittag_leffler_case(alpha, s):
    value = mittag_leffler(alpha, s)
    if 0 < alpha < 1:
        other = spectral_integral(alpha, s)
        assert abs(other / value - 1) < AGREE, (alpha, s, mp.nstr(value, 20), mp.nstr(other, 20))
    if alpha == 0.5 and s < 1e6:
        root = mp.sqrt(s)
        assert abs(mp.exp(s) * mp.erfc(root) / value - 1) < AGREE, s
    with mp.workdps(DIGITS + 30):
        step = mp.mpf("1e-15")
        exact, at = mp.mpf(alpha), mp.mpf(s)
        series = power_series if s <= 150 else asymptotic_series
        by_alpha = (series(exact + step, at) - series(exact - step, at)) / (2 * step)
        up, down = mittag_leffler(alpha, at * mp.exp(step)), mittag_leffler(alpha, at * mp.exp(-step))
        by_log = (up - down) / (2 * step) if value > TINY else mp.mpf(0)
    return {"of": "mittag_leffler", "alpha": alpha, "s": s, "value": value, "by_log_s": by_log, "by_alpha": by_alpha}


def e1_case(x):
    value = mp.e1(x)
    at = mp.mpf(x)
    marks = [0] + [at * 4**k for k in range(-2, 55) if at * 4**k < 90] + [90, 140]
    tail = mp.quad(lambda u: mp.exp(-u) / (at + u), marks)
    assert abs(tail * mp.exp(-at) / value - 1) < AGREE, x
    return {"of": "e1", "x": x, "value": value}


def fung_case(slow, fast):
    a, b = mp.mpf(slow), mp.mpf(fast)
    span = mp.log(b / a)
    with mp.workdps(2 * DIGITS):
        span = mp.log(b / a)
        value = (mp.e1(a) - mp.e1(b)) / span
        by_slow, by_fast = (value - mp.exp(-a)) / span, (mp.exp(-b) - value) / span
    parts = int(span) + 8 + int(min(b - a, 500) / 20)
    # e^-a stands outside: mp.quad stops at an absolute error.
    mean = mp.exp(-a) * mp.quad(lambda w: mp.exp(-a * mp.expm1(span * w)), mp.linspace(0, 1, 2 * parts + 1))
    assert abs(mean / value - 1) < AGREE, (slow, fast, mean, value)
    return {"of": "fung", "slow": slow, "fast": fast, "value": value, "by_log_slow": by_slow, "by_log_fast": by_fast}


def diffusion_case(s):
    at, scale = mp.mpf(s), 8 / mp.pi**2
    sine = mp.sqrt(mp.pi / at) / 4
    images = 1 + 2 * mp.nsum(lambda m: (-1) ** int(m) * mp.exp(-((mp.pi * m) ** 2) / (4 * at)), [1, int(8 * s**0.5) + 3])
    # ierfc(y) = exp(-y^2)/sqrt(pi) - y erfc(y)
    def ierfc(y):
        return mp.exp(-y * y) / mp.sqrt(mp.pi) - y * mp.erfc(y)

    root = mp.sqrt(at)
    last = int(8 * s**0.5) + 3
    reflected = sum((-1) ** m * ierfc(mp.pi * m / (2 * root)) for m in range(1, last + 1))
    value = 1 - 4 * mp.sqrt(at / mp.pi**3) * (1 + 2 * mp.sqrt(mp.pi) * reflected)
    by_log = -at * scale * sine * images
    if s >= 1e-6:
        odd = range(1, int((100 / s) ** 0.5) + 4, 2)
        total = scale * sum(mp.exp(-k * k * at) / k**2 for k in odd)
        slope = -at * scale * sum(mp.exp(-k * k * at) for k in odd)
        # The Poisson transform cancels for large s: absolute agreement there.
        assert abs(total - value) < AGREE and abs(slope - by_log) < AGREE * at, (s, total, value)
        value, by_log = total, slope
    return {"of": "diffusion", "s": s, "value": value, "by_log_s": by_log}


def e1_rule(nodes=16, scale=4.5):
    """u_j, w_j with e^x E1(x) = int exp(-u)/(x+u) du = sum w_j/(x+u_j) for x >= 1, to 6e-16 relative.

    With u = scale v/(1-v) the integrand is (1-v) / (x + (scale-x) v), so u_j, w_j come from the Gauss rule in v for
    the weight (1-v) exp(-u): the Stieltjes procedure on a fine trapezoid, then the eigenvalues of the Jacobi matrix.
    """
    with mp.workdps(120):
        scale, step, points = mp.mpf(scale), mp.mpf(1) / 64, []
        for k in range(-6 * 64, 6 * 64):
            t = k * step
            u = mp.exp(t - mp.exp(-t))
            weight = step * u * (1 + mp.exp(-t)) * mp.exp(-u)
            if weight > mp.mpf("1e-70"):
                points.append((u / (u + scale), weight * scale / (u + scale)))
        last, this, norm = [mp.mpf(0)] * len(points), [mp.mpf(1)] * len(points), None
        jacobi, total = mp.zeros(nodes), sum(w for _, w in points)
        for k in range(nodes):
            new = sum(w * p * p for (_, w), p in zip(points, this))
            jacobi[k, k] = sum(w * v * p * p for (v, w), p in zip(points, this)) / new
            ratio = new / norm if k else mp.mpf(0)
            if k:
                jacobi[k, k - 1] = jacobi[k - 1, k] = mp.sqrt(ratio)
            last, this = this, [(v - jacobi[k, k]) * p - ratio * q for (v, _), p, q in zip(points, this, last)]
            norm = new
        with mp.workdps(50):
            middle, vectors = mp.eigsy(jacobi)
        rule = [(scale * v / (1 - v), total * vectors[0, j] ** 2 / (1 - v)) for j, v in enumerate(middle)]
    for x in (1, 1.1, 1.5, 2, 4, 10, 40, 100, 1000, 1e9):
        exact = mp.e1(x) if x < 700 else mp.mpf(0)
        exact = exact * mp.exp(x) if exact else mp.quad(lambda u: mp.exp(-u) / (x + u), [0, 1, 5, 20, 100])
        assert abs(sum(w / (x + u) for u, w in rule) / exact - 1) < 6e-16, x
    return [[float(u), float(w)] for u, w in rule]


def main():
    mp.mp.dps = DIGITS
    rule = e1_rule()
    cases = [mittag_leffler_case(alpha, s) for alpha in ALPHA for s in S]
    cases += [mittag_leffler_case(alpha, s) for alpha in SWITCH for s in (1e-6, 0.03, 3.0, 20.0, 1e6)]
    cases += [e1_case(x) for x in (1e-30, 1e-12, 1e-6, 1e-3, 0.02, 0.1, 0.3, 0.56, 0.8, 0.97, 0.9999999, 1.0, 1.0000001,
                                   1.05, 1.3, 1.9, 2.7, 4.0, 6.0, 9.0, 14.0, 22.0, 40.0, 80.0, 200.0, 500.0, 690.0)]
    fung = [(1e-15, 1e-9), (1e-9, 1e-6), (1e-6, 0.01), (0.001, 0.9), (0.001, 1.1), (0.001, 30.0), (1e-12, 1e4), (0.3, 0.31),
            (0.5, 0.9), (0.7, 1.0), (1.0, 1.6), (1.0, 1.7), (2.0, 2.9), (2.0, 3.1), (5.0, 5.9), (5.0, 6.1), (30.0, 30.5),
            (30.0, 40.0), (0.2, 0.2000001), (1.0, 1.000000000001), (300.0, 301.5), (600.0, 690.0), (1e-8, 1.01e-8)]
    cases += [fung_case(*pair) for pair in fung]
    cases += [diffusion_case(s) for s in (1e-30, 1e-12, 1e-6, 1e-3, 0.01, 0.05, 0.066, 0.0666666, 0.0666667, 0.067, 0.08, 0.12, 0.3,
                                          0.7, 1.0, 2.0, 5.0, 12.0, 40.0, 200.0, 690.0)]
    for case in cases:
        for key, number in case.items():
            case[key] = number if key == "of" else float(number)
    write_reference(
        "special_functions", ["mpmath"],
        {"note": "correctly rounded; two methods agree to 1e-25", "mittag_leffler": 1e-10, "derivative": 1e-8, "others": 1e-13},
        cases, e1_rule=rule)


if __name__ == "__main__":
    main()
