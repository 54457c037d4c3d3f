"""Least squares taken to more digits than a double holds: Gauss-Newton in mpmath from a good start."""

import mpmath as mp


def polish(model, y, start, dps=40):
    """Minimise sum (y - model(p)[0])^2; model(p) returns values and one list of partials per parameter.

    Returns parameters, RSS and covariance s^2 (J^T J)^-1 with s^2 = RSS/(N - p), as mpf. Each step is
    halved until RSS does not grow, so the result is a minimum reached downhill from `start`."""
    with mp.workdps(dps):
        p = [mp.mpf(v) for v in start]
        y = [mp.mpf(v) for v in y]
        size = len(p)

        def look(q):
            f, jac = model(q)
            res = [a - b for a, b in zip(y, f)]
            return res, jac, mp.fsum(e * e for e in res)

        res, jac, rss = look(p)
        for _ in range(400):
            normal = mp.matrix(size, size)
            grad = mp.matrix(size, 1)
            for i in range(size):
                grad[i] = mp.fsum(a * b for a, b in zip(jac[i], res))
                for j in range(i + 1):
                    normal[i, j] = normal[j, i] = mp.fsum(a * b for a, b in zip(jac[i], jac[j]))
            step = mp.lu_solve(normal, grad)
            relative = max(abs(step[i]) / (abs(p[i]) + mp.mpf("1e-10")) for i in range(size))
            if relative < mp.mpf("1e-22"):
                break
            scale = mp.mpf(1)
            while True:
                q = [p[i] + scale * step[i] for i in range(size)]
                trial = look(q)
                if trial[2] <= rss or scale < mp.mpf("1e-9"):
                    break
                scale /= 2
            p, (res, jac, rss) = q, trial
        else:
            raise ArithmeticError("no convergence")
        inverse = mp.inverse(normal)
        s2 = rss / (len(y) - size)
        return p, rss, [[s2 * inverse[i, j] for j in range(size)] for i in range(size)]
