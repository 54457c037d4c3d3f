"""All node displacements of the layer cascade, for whole numbers of layers.

    x_i = (u_i - u_{i+1})/l - u_i/L_i,   L_i = r - (i-1) l,   l = r/m,   u_{m+1} = 0
    du_{i+1}/dt = l v sgn(x_i)|x_i|^n     i = 1 .. m-1;   u_1 = d/sides is imposed

x_m = 0 by construction. SciPy's DOP853 (relative tolerance 1e-13) is printed; `agreement_u` is its largest
distance from SciPy's Radau, an implicit method, at 1e-12. x_1 is checked against mpmath as well.
"""

import numpy as np
from scipy.integrate import solve_ivp

from _common import round_up, write_reference
from _contact import Exact, excess_of_layers, ramp_and_hold
from contact_force import DOWN, UP, protocol


def solve(case, times, method, rtol, atol):
    r, m, v, n = case["radius"], int(case["layers"]), case["rate_coefficient"], case["exponent"]
    excess, behind = excess_of_layers(m)
    out, w = {}, np.zeros(m - 1)
    for (ta, da), (tb, db) in zip(case["knots"], case["knots"][1:]):
        slope = (db - da) / (tb - ta) / case["sides"] / r
        start = da / case["sides"] / r

        def rhs(t, w):
            x = excess(w, start + slope * (t - ta))[:-1]
            return v / m * np.sign(x) * np.abs(x) ** n

        def jac(t, w):
            x = excess(w, start + slope * (t - ta))[:-1]
            k = v / m * n * np.abs(x) ** (n - 1)
            j = np.diag(-k * m)
            rows = np.arange(1, m - 1)
            j[rows, rows - 1] = k[1:] * (m - 1.0 / behind[1:m - 1])
            return j

        inside = sorted({t for t in times if ta < t <= tb} | {tb})
        sol = solve_ivp(rhs, (ta, tb), w, method=method, rtol=rtol, atol=atol, t_eval=inside,
                        **({"jac": jac} if method == "Radau" else {}))
        assert sol.status == 0, sol.message
        for t, y in zip(sol.t, sol.y.T):
            top = start + slope * (t - ta)
            out[float(t)] = (np.concatenate([[top], y]) * r, excess(y, top))
        w = sol.y[:, -1]
    return [out[t] for t in times]


def main():
    paper_up = ramp_and_hold(UP + [0.0], 500.0, 10.0)
    short_up = ramp_and_hold([10.0, 20.0, 5.0], 500.0, 4.0)
    cases = []
    for case, times in [
        (protocol("two layers, quintic", paper_up, 5, 2e4, 2), [0.6, 10.6, 30.0, 43.0, 53.0, 64.0]),
        (protocol("two layers, linear", short_up, 1, 3, 2), [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]),
        (protocol("paper up, eight layers", paper_up, 5, 2e4, 8), [0.6, 10.6, 21.2, 43.0, 53.0, 65.0]),
        (protocol("paper down, eight layers", ramp_and_hold(DOWN, 500.0, 10.0), 5, 2e4, 8),
         [1.5, 3.0, 13.6, 24.2, 40.0, 55.4]),
        (protocol("eight layers, linear, one side", short_up, 1, 20, 8, sides=1),
         [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]),
        (protocol("eight layers, cubic", short_up, 3, 500, 8), [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]),
        (protocol("64 layers, quintic", short_up, 5, 2e4, 64), [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]),
        (protocol("64 layers, square law", short_up, 2, 2e3, 64), [0.6, 1.2, 3.0, 6.4, 10.4, 14.0]),
    ]:
        a = solve(case, times, "DOP853", 1e-13, 1e-17)
        b = solve(case, times, "Radau", 1e-12, 1e-16)
        exact = Exact(case)
        off_u = max(np.max(np.abs(p[0] - q[0])) for p, q in zip(a, b))
        off_x = max(np.max(np.abs(p[1] - q[1])) for p, q in zip(a, b))
        off_1 = max(abs(p[1][0] - float(exact.excess(t))) for p, t in zip(a, times))
        print(f"{case['name']:32s} u: {off_u:.1e} m  x: {off_x:.1e}  x_1 to mpmath: {off_1:.1e}", flush=True)
        assert off_u < 1e-12 and off_1 < 1e-11
        cases.append({**case, "times": times,
                      "displacement": [[float(v) for v in p[0]] for p in a],
                      "excess_strain": [[float(v) for v in p[1][:-1]] + [0.0] for p in a],
                      "agreement_u": round_up(off_u), "agreement_x": round_up(off_x)})
    write_reference(
        "cascade", ["scipy", "numpy", "mpmath"],
        {"displacement": 1e-12, "excess_strain": 1e-10,
         "note": "absolute, m and 1; from the distance of two solvers (agreement_*) with room"},
        cases)


if __name__ == "__main__":
    main()
