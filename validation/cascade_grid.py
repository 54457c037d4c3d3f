"""All node displacements over the whole range of exponents, rate coefficients and numbers of layers.

The equations are those of cascade.py. SciPy's DOP853 (relative tolerance 1e-13) is printed; `agreement` is its largest distance from
LSODA with the banded Jacobian at 1e-12, an implicit method, in units of the radius. Below n = 1 the law has no derivative at rest,
where an explicit method crawls and an implicit one errs: there the distance is what it is, and the tolerance follows it.
"""

import numpy as np
from scipy.integrate import solve_ivp

from _common import round_up, write_reference
from _contact import excess_of_layers, ramp_and_hold
from contact_force import protocol

SHORT = ramp_and_hold([10.0, 20.0, 5.0], 500.0, 4.0)
LOADING = ramp_and_hold([10.0], 500.0, 0.4)
TIMES = [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]
FEW = [1.2, 6.4]
CASES = [
    (protocol("n = 1/2, two layers", LOADING, 0.5, 0.2, 2), [0.3, 0.6, 1.2, 1.4, 1.6]),
    (protocol("n = 1/2, eight layers", LOADING, 0.5, 0.05, 8), [0.3, 0.6, 1.2, 1.4, 1.6]),
    (protocol("n = 1, one layer", SHORT, 1, 3, 1), TIMES),
    (protocol("n = 1, slow, eight layers", SHORT, 1, 0.05, 8), TIMES),
    (protocol("n = 1, 512 layers", SHORT, 1, 50, 512), FEW),
    (protocol("n = 3/2, eight layers", SHORT, 1.5, 8, 8), TIMES),
    (protocol("n = 3/2, 64 layers", SHORT, 1.5, 200, 64), FEW),
    (protocol("n = 3, two layers, fast", SHORT, 3, 3000, 2), TIMES),
    (protocol("n = 3, 512 layers", SHORT, 3, 500, 512), FEW),
    (protocol("n = 5, 512 layers", SHORT, 5, 2e4, 512), FEW),
    (protocol("n = 7.3, eight layers", SHORT, 7.3, 5e4, 8), TIMES),
    (protocol("n = 7.3, 64 layers", SHORT, 7.3, 5e4, 64), FEW),
]


def solve(case, times, method, rtol):
    r, m, v, n = case["radius"], int(case["layers"]), case["rate_coefficient"], case["exponent"]
    excess, behind = excess_of_layers(m)
    out, w = {}, np.zeros(m - 1)
    for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
        slope = (db - da) / (tb - ta) / case["sides"] / r
        start = da / case["sides"] / r
        inside = sorted({t for t in times if ta < t <= tb} | {tb})
        if m == 1:
            out.update({float(t): np.array([start + slope * (t - ta)]) for t in inside})
            continue

        def rhs(t, w):
            x = excess(w, start + slope * (t - ta))[:-1]
            return v / m * np.sign(x) * np.abs(x) ** n

        def jac(t, w):
            x = excess(w, start + slope * (t - ta))[:-1]
            k = v / m * n * np.maximum(np.abs(x), 1e-12) ** (n - 1)
            bands = np.zeros((min(2, m - 1), m - 1))
            bands[0] = -k * m
            bands[1:, :-1] = k[1:] * (m - 1.0 / behind[1:m - 1])
            return bands

        options = {"jac": jac, "lband": min(1, m - 2), "uband": 0} if method == "LSODA" else {}
        run = solve_ivp(rhs, (ta, tb), w, method=method, rtol=rtol, atol=1e-16, t_eval=inside, **options)
        assert run.status == 0, run.message
        for t, y in zip(run.t, run.y.T):
            out[float(t)] = np.concatenate([[start + slope * (t - ta)], y])
        w = run.y[:, -1]
    return np.array([out[t] for t in times]) * r


def main():
    cases = []
    for case, times in CASES:
        a, b = solve(case, times, "DOP853", 1e-13), solve(case, times, "LSODA", 1e-12)
        off = np.max(np.abs(a - b)) / case["radius"]
        print(f"{case['name']:28s} {off:.1e} of the radius", flush=True)
        rows = [[float(f"{u:.14e}") for u in row] for row in a]
        cases.append({**case, "times": times, "displacement": rows, "agreement": round_up(off)})
    worst = max(case["agreement"] for case in cases)
    write_reference("cascade_grid", ["scipy", "numpy"],
                    {"displacement_over_radius": 1e-10, "strain": 1e-8, "note": f"the two methods differ by {worst} of the radius at most"}, cases)


if __name__ == "__main__":
    main()
