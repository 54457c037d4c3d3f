"""Which grid and which smoothing a relaxation spectrum should have: foresight of simulated holds.

Not a reference: it prints how well the first third of a hold predicts the rest, for every rule tried. Holds are sums of 1 to
5 exponentials, latency laws, stretched exponentials, powers and logarithms, of 200 to 2000 samples evenly or
logarithmically spaced, signal to noise 1e2 to 1e5, the noise white or with correlation 0.8. The error is the rms distance
from the law without noise, over the drop of the whole hold.
"""

import argparse
import itertools
import multiprocessing

import numpy as np
from scipy.optimize import nnls

STRENGTHS = 10.0 ** np.arange(-12, 1.1, 1.0)
RULES = ("one sigma", "bic", "gcv", "none")


def law(kind, rng):
    """A relaxation over 0..1."""
    level = rng.uniform(0, 3)
    if kind.startswith("exp"):
        k = int(kind[3:])
        tau, a = 10 ** np.sort(rng.uniform(-2.3, 0.3, k)), rng.uniform(0.3, 1, k)
        return lambda t: level + np.exp(-t[:, None] / tau) @ a
    if kind == "latency":
        n, rate = rng.uniform(1.5, 9), 10 ** rng.uniform(0, 3)
        return lambda t: level + (1 + (n - 1) * rate * t) ** (-1 / (n - 1))
    if kind == "stretched":
        beta, rate = rng.uniform(0.3, 0.8), 10 ** rng.uniform(-0.3, 1.5)
        return lambda t: level + np.exp(-((rate * t) ** beta))
    alpha, start = rng.uniform(0.03, 0.5), 10 ** rng.uniform(-3, -1)
    if kind == "power":
        return lambda t: (1 + t / start) ** -alpha
    return lambda t: 1 - 0.05 * np.log1p(t / start)


KINDS = ("exp1", "exp2", "exp3", "exp5", "latency", "stretched", "power", "logarithm")


def hold(seed):
    """Times, law without noise, and samples."""
    rng = np.random.default_rng(seed)
    f = law(KINDS[seed % 8], rng)
    count = int(10 ** rng.uniform(np.log10(200), np.log10(2000)))
    even = rng.random() < 0.5
    t = np.linspace(0, 1, count) if even else np.r_[0, np.geomspace(1e-3, 1, count - 1)]
    noise = rng.normal(size=count)
    rho = 0.8 * (seed // 8 % 2)
    for i in range(1, count):
        noise[i] = rho * noise[i - 1] + np.sqrt(1 - rho * rho) * noise[i]
    y = f(t)
    return t, y, y + noise * (y[0] - y[-1]) * 10 ** -rng.uniform(2, 5), rho


def penalty(kind, n):
    """Rows whose squares are added: amplitudes, their first or their second differences."""
    return {"ridge": np.eye(n), "first": np.diff(np.eye(n), axis=0), "second": np.diff(np.eye(n), 2, axis=0)}[kind]


def spectra(t, y, slowest, per_decade, kind):
    """The prediction of every rule, as functions of time."""
    shortest = max(t[1], 1e-6 * t[-1])
    decades = np.log10(slowest * t[-1] / shortest)
    tau = np.geomspace(shortest, slowest * t[-1], int(np.ceil(per_decade * decades - 1e-6)) + 1)
    n, count, low, span = len(tau), len(t), y.min(), np.ptp(y)
    one = np.ones_like(t)
    columns = np.column_stack([np.exp(-t[:, None] / tau), one, -one, (y - low) / span]) / np.sqrt(count)
    r = np.linalg.qr(columns, mode="r")
    rows = penalty(kind, n)
    found, rss, freedom = [], [], []
    for strength in STRENGTHS:
        below = np.hstack([np.sqrt(strength) * rows, np.zeros((len(rows), 2))])
        x = nnls(np.vstack([r[:, :-1], below]), np.r_[r[:, -1], np.zeros(len(rows))], maxiter=5000)[0]
        free = np.flatnonzero(x[:n] > 0)
        c = np.column_stack([r[:, free], r[:, n]])
        smooth = np.zeros((len(free) + 1,) * 2)
        smooth[:-1, :-1] = (rows.T @ rows)[np.ix_(free, free)]
        freedom.append(np.trace(np.linalg.pinv(c.T @ c + strength * smooth) @ c.T @ c))
        rss.append(np.sum((r[:, :-1] @ x - r[:, -1]) ** 2))
        found.append(x)
    rss, freedom = np.array(rss), np.array(freedom)
    chosen = {
        "one sigma": np.flatnonzero(rss <= rss[0] * (1 + np.sqrt(2 / count)))[-1],
        "bic": np.argmin(np.log(rss) + freedom * np.log(count) / count),
        "gcv": np.argmin(rss / (1 - freedom / count) ** 2), "none": 0,
    }
    at = lambda x: lambda t: low + span * (np.exp(-t[:, None] / tau) @ x[:n] + x[n] - x[n + 1])
    return {rule: at(found[i]) for rule, i in chosen.items()}


def errors(seed):
    """Correlation of the noise, and the error of every rule."""
    t, truth, y, rho = hold(seed)
    known, out = t <= 1 / 3, {}
    for grid in itertools.product((3, 10, 30), (4, 8), ("ridge", "first", "second")):
        for rule, predict in spectra(t[known], y[known], *grid).items():
            error = np.sqrt(np.mean((predict(t) - truth)[~known] ** 2))
            out[(*grid, rule)] = error / (truth[0] - truth[-1])
    return rho, out


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--holds", type=int, default=960)
    holds = parser.parse_args().holds
    with multiprocessing.Pool() as pool:
        results = pool.map(errors, range(holds), chunksize=8)
    table = []
    for key in results[0][1]:
        parts = [np.array([e[key] for rho, e in results if (rho > 0) == red]) for red in (False, True)]
        table.append(([np.exp(np.mean(np.log(p))) for p in parts] + [np.quantile(p, 0.9) for p in parts], key))
    print("mean (geometric) and 90 % quantile in 1e-4 of the drop: white mean, correlated mean, white 90 %, correlated 90 %")
    for numbers, (slowest, per_decade, kind, rule) in sorted(table, key=lambda row: np.prod(row[0][:2])):
        print(" ".join(f"{1e4 * v:6.1f}" for v in numbers), f" to {slowest} durations, {per_decade} a decade, {kind}, {rule}")
