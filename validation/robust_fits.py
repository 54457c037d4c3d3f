"""Huber and Tukey fits of holds with gross outliers.

With residuals r_i = y_i - f_i and u_i = r_i / scale, the numbers and the scale solve together

    sum w(u_i) r_i df_i/dp = 0        scale = median |r_i| / 0.6745     (about zero, all samples, no N - p)
    Huber   w = min(1, k/|u|)         k = 1.345
    Tukey   w = (1 - (u/c)^2)^2, 0 for |u| > c      c = 4.685

The median of an even number of values is the mean of the middle two. Iterated to a fixed point: scale and weights from
the residuals, one Gauss-Newton step of the weighted problem, until nothing moves; Huber from the least-squares
optimum, Tukey from the Huber solution with the scale still free. Huber is reached from 20 other starts as well.
Checks: both equations hold, and scipy's least_squares with the same loss at the final scale finds the same numbers.
"""

import math

import numpy as np
from scipy.optimize import least_squares

from _common import write_reference
from _laws import fit, hold, law, line, logs, rounded

LN = math.log
HUBER, TUKEY, NORMAL = 1.345, 4.685, 0.6745


def huber(u):
    return np.minimum(1.0, HUBER / np.maximum(np.abs(u), 1e-300))


def tukey(u):
    return np.maximum(0.0, 1.0 - (u / TUKEY) ** 2) ** 2


def look(which, t, y, p):
    """Residuals, Jacobian of the law, scale."""
    value, slopes = which.value(t, p)
    r = y - value
    return r, np.column_stack(slopes), np.median(np.abs(r)) / NORMAL


def fixed_point(which, t, y, weight, start):
    p, steps = np.array(start, dtype=float), []
    for _ in range(3000):
        r, jacobian, scale = look(which, t, y, p)
        root = np.sqrt(weight(r / scale))
        norm = np.linalg.norm(jacobian * root[:, None], axis=0)
        step = np.linalg.lstsq(jacobian * root[:, None] / norm, root * r, rcond=None)[0] / norm
        p = p + step
        steps.append(float(np.max(np.abs(step) * norm / scale)))
        if steps[-1] < 1e-14 or (len(steps) > 50 and steps[-1] < 1e-12 and steps[-1] >= min(steps[-20:-1])):
            break  # at the rounding of a double
    else:
        raise ArithmeticError(f"no fixed point: {steps[-5:]}")
    r, jacobian, scale = look(which, t, y, p)
    w = weight(r / scale)
    balance = np.abs(jacobian.T @ (w * r)) / (np.linalg.norm(jacobian, axis=0) * scale)
    assert np.max(balance) < 1e-11, balance
    return p, float(scale), w, len(steps)


def by_scipy(which, t, y, p, scale, loss, limit):
    """The same loss with the scale given, from a start a little away."""
    away = p * (1 + 1e-4)
    span = np.abs(p) + 1e-3
    got = least_squares(lambda q: look(which, t, y, q)[0], away, lambda q: -look(which, t, y, q)[1], loss=loss,
                        f_scale=limit * scale, x_scale=span, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=5000)
    return got.x


def tukey_loss(z):
    inside = np.maximum(0.0, 1.0 - z)
    return np.array([(1.0 - inside**3) / 3.0, inside**2, -2.0 * inside])


def spoil(y, size, share, rng):
    """Outliers of 8 to 40 noise levels, mostly on one side."""
    index = np.sort(rng.choice(len(y), round(share * len(y)), replace=False))
    y = y.copy()
    y[index] += size * rng.uniform(8.0, 40.0, len(index)) * np.where(rng.uniform(size=len(index)) < 0.75, 1.0, -1.0)
    return rounded(y, 7), index


def case(name, which, linear, q, t, noise, share, seed):
    y, _, rng = hold(which, linear, q, t, noise, seed)
    y, index = spoil(y, noise, share, rng)
    plain = fit(which, t, y, None, rng)
    start = [float(v) for v in plain["p"]]
    out = {"name": f"{which.name}: {name}", "law": which.name, "kind": which.kind, "fixed": which.fixed,
           "truth": list(linear) + list(q), "noise": noise, "outliers": index.tolist(), "t": t.tolist(),
           "y": y.tolist(), "parameters": which.names, "least_squares": start}
    p = np.array(start)
    for method, weight, loss, limit in (("huber", huber, "huber", HUBER), ("tukey", tukey, tukey_loss, TUKEY)):
        p, scale, w, steps = fixed_point(which, t, y, weight, p)
        jacobian = look(which, t, y, p)[1]
        error = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian))) * scale
        other = by_scipy(which, t, y, p, scale, loss, limit)
        off = float(np.max(np.abs(other - p) / error))
        assert off < 1e-5, (name, method, off)
        if method == "huber":
            for _ in range(20):
                elsewhere = np.array(start) + error * rng.normal(0.0, 2.0, len(p))
                again = fixed_point(which, t, y, weight, elsewhere)[0]
                assert np.max(np.abs(again - p) / error) < 1e-9, (name, again, p)
        print(f"{out['name']:36s} {method}  scale/noise {scale / noise:.4f}  sum w {np.sum(w):8.4f} of {len(t)}"
              f"  zero {int(np.sum(w == 0)):2d} of {len(index)}  from truth "
              f"{np.round((p - out['truth']) / error, 2)} se (least squares "
              f"{np.round((np.array(start) - out['truth']) / error, 1)})  scipy {off:.0e} se", flush=True)
        out[method] = {"values": p.tolist(), "scale": scale, "sum_of_weights": float(np.sum(w)),
                       "zero_weights": int(np.sum(w == 0)), "weights_below_half": int(np.sum(w < 0.5))}
    return out


def main():
    fifth, sls = law("latency", exponent=5.0), law("standard_linear_solid")
    cases = [
        case("falling, 6 %", fifth, [0.36, 0.13], [LN(6.0)], line(10.0, 101), 1e-3, 0.06, 401),
        case("rising, 10 %, log times", fifth, [2.0, -1.0], [LN(3.0)], logs(1e-2, 60.0, 80), 5e-3, 0.10, 402),
        case("falling, 8 %", sls, [8.0, 4.0], [LN(0.4)], line(10.0, 101), 5e-2, 0.08, 403),
        case("rising, 5 %", sls, [1.0, -0.6], [LN(1.0)], line(6.0, 60), 5e-3, 0.05, 404),
    ]
    write_reference(
        "robust_fits", ["numpy", "scipy", "lmfit", "mpmath"],
        {"values_relative": 1e-8, "scale_relative": 1e-8, "sum_of_weights_absolute": 1e-6,
         "note": "relative to max(|value|, 1e-3); the fixed point itself holds to 1e-11 of its terms"},
        cases, definitions={
            "huber": "w = min(1, 1.345/|u|), u = r/scale; from the least-squares optimum",
            "tukey": "w = (1 - (u/4.685)^2)^2, 0 beyond; from the Huber solution",
            "scale": "median |r| / 0.6745 over all samples, about zero, of the final residuals",
        })


if __name__ == "__main__":
    main()
