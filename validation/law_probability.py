"""Probabilities that `compare` states, against what came, on measured and on simulated holds; and the regression that they come from.

    python validation/law_probability.py FOLDER [--fewest 60] [--simulated 600] [--seed 17] [--fit] [--write]

FOLDER holds records of any format that palpate reads, as for forecasts.py; the package has to be installed for the Python that runs this.
Of every measured hold of at least --fewest samples the first third and the first half are seen, and the first third of its first third. Of
simulated holds (eleven kinds of laws, five kinds of noise) a third or a half is seen. *Right*: no law that was compared has an error in the
rest, noise included, that is smaller than that of the named one by more than a fifth.

With --fit the coefficients of crates/palpate/src/forecast/probability.rs are found again, on the measured holds and on simulated ones of
--seed; measured holds count twice as much in all. Ridge 1. With --write the page docs/validation/law-probability.md is written. Takes some
ten minutes on two processors.
"""

import argparse
import multiprocessing
import pathlib
import sys
import warnings
from dataclasses import dataclass

import forecasts
import numpy as np
import palpate

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "law-probability.md"
NEAR = 1.2
BINS = [0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0]
KINDS = ["latency", "latency:5", "standard-linear-solid", "prony:2", "prony:3", "stretched", "power", "logarithmic", "log-normal spectrum", "diffusion", "25 random times"]
# Kinds that are exactly a law that is compared.
EXACT = ["latency", "latency:5", "standard-linear-solid", "prony:2", "prony:3", "stretched", "logarithmic"]
NOISES = ["white", "white", "AR(1) 0.9", "1/f", "white and random walk"]


@dataclass
class Case:
    """What was said of the first part of a hold, and what came."""

    source: str
    right: bool
    ratio: float
    # Whether the set of the test has the law that turned out to be the best, and one within a fifth of it.
    has_best: bool
    has_near: bool
    alike: int
    certainty: str
    probability: float
    reservation: str | None
    held_out: bool
    signs: list
    # Whether the law that made a simulated hold is near the best; None for others.
    true_law_near: bool | None = None


def signs(compared):
    """What the probability follows from, as in probability.rs."""
    law = compared["verdict"]["law"]
    rows = {row["law"]: row for row in compared["laws"]}
    change, noise = compared["change"], max(compared["noise"], 1e-4 * compared["change"])
    good = [row for row in compared["laws"] if row["forward_score"] is not None and (row["law"] == "spectrum" or row["termination"] in ("converged", "amplitude_at_bound"))]
    good = good or [row for row in compared["laws"] if row["forward_score"] is not None]
    standing = [row for row in good if row["law"] != "spectrum" and row["delta_bic"] <= 10]
    usable = standing + [row for row in good if row["law"] == "spectrum"] if standing else good
    bic = rows[law]["delta_bic"]
    evidence = min((row["delta_bic"] for row in usable if row["law"] not in (law, "spectrum")), default=np.inf) - bic
    last = [found for found in rows[law]["forecasts"] if found][-1]
    return [
        1.0,
        float(np.log(max(last["error"] * change / noise, 1.0))),
        float(np.sign(evidence) * 0.5 * np.log1p(min(abs(evidence), 1000.0))),
        float(np.log(rows[law]["forward_score"] / min(row["forward_score"] for row in usable))),
        float(len(compared["verdict"]["indistinguishable"]) == 1),
        float(np.log(noise / change) + 4.0),
    ]


def case(source, t, y, quantity, share):
    """None where the first part, or no law in the rest, says anything."""
    first = int(np.searchsorted(t, t[0] + share * (t[-1] - t[0]), side="right"))
    try:
        whole = palpate.compare(t, y, quantity=quantity, cuts=[share]).to_dict()
        seen = palpate.compare(t[:first], y[:first], quantity=quantity).to_dict()
    except palpate.PalpateError:
        return None
    errors = {row["law"]: row["forecasts"][0]["error"] for row in whole["laws"] if row["forecasts"] and row["forecasts"][0]}
    verdict = seen["verdict"]
    if not errors or not verdict:
        return None
    best = min(errors.values())
    ratio = errors.get(verdict["law"], np.inf) / best
    near = {law for law, error in errors.items() if error <= NEAR * best}
    alike = verdict["indistinguishable"]
    held_out = seen["ranking"] == "forward"
    return Case(
        source,
        ratio <= NEAR,
        ratio,
        min(errors, key=errors.get) in alike,
        bool(near.intersection(alike)),
        len(alike),
        verdict["certainty"],
        verdict["probability"],
        verdict["reservation"],
        held_out,
        signs(seen) if held_out else [],
        source in near if source in EXACT and source in errors else None,
    )


def measured(folder, fewest):
    for file, t, y, quantity in forecasts.holds(folder, fewest):
        t, y = np.asarray(t), np.asarray(y)
        third = int(np.searchsorted(t, t[0] + (t[-1] - t[0]) / 3, side="right"))
        for t_seen, y_seen, share in ((t, y, 1 / 3), (t, y, 0.5), (t[:third], y[:third], 1 / 3)):
            if len(t_seen) >= fewest:
                found = case(file, t_seen, y_seen, quantity, share)
                if found:
                    yield found


def relaxation(chance, kind, t):
    """A course from 1 to 0 of a kind, with a time from a hundredth of the hold to more than it."""
    last = t[-1]
    time = last * np.exp(chance.uniform(np.log(0.01), np.log(1.5)))
    if kind == "latency":
        n = chance.uniform(1.5, 9)
        y = (1 + (n - 1) * t / time) ** (-1 / (n - 1))
    elif kind == "latency:5":
        y = (1 + 4 * t / time) ** -0.25
    elif kind == "standard-linear-solid":
        y = np.exp(-t / time)
    elif kind.startswith("prony"):
        count = int(kind[-1])
        times = time * np.cumprod(np.r_[1, np.exp(-chance.uniform(1, 3, count - 1))])
        y = chance.uniform(0.2, 1, count) @ np.exp(-t / times[:, None])
    elif kind == "stretched":
        y = np.exp(-((t / time) ** chance.uniform(0.25, 0.9)))
    elif kind == "power":
        y = (1 + 10 * t / time) ** -chance.uniform(0.05, 0.6)
    elif kind == "logarithmic":
        y = -np.log1p(10 * t / time)
    elif kind == "log-normal spectrum":
        u, width = np.linspace(-4, 4, 161), chance.uniform(0.5, 2)
        y = np.exp(-u * u / 2) @ np.exp(-t / (time * np.exp(width * u))[:, None])
    elif kind == "diffusion":
        k = np.arange(1, 200)[:, None]
        y = (np.exp(-k * k * t / time) / k**2).sum(0)
    else:
        times = last * np.exp(chance.uniform(np.log(1e-3), np.log(5), 25))
        y = chance.exponential(1, 25) @ np.exp(-t / times[:, None])
    return (y - y[-1]) / (y[0] - y[-1])


def noise(chance, count, kind):
    e = chance.normal(size=count)
    if kind == "AR(1) 0.9":
        for i in range(1, count):
            e[i] = 0.9 * e[i - 1] + np.sqrt(1 - 0.81) * e[i]
    elif kind == "1/f":
        k = np.maximum(np.arange(count // 2 + 1), 1)
        e = np.fft.irfft(np.fft.rfft(e) / np.sqrt(k), count)
        e /= e.std()
    elif kind == "white and random walk":
        walk = np.cumsum(chance.normal(size=count))
        e = 0.8 * e + 0.3 * walk / walk.std()
    return e


def simulated_one(numbers):
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    chance = np.random.default_rng(numbers)
    kind = str(chance.choice(KINDS))
    count = int(np.exp(chance.uniform(np.log(100), np.log(4000))))
    t = np.linspace(0, 60, count)
    y = chance.uniform(0, 2) + relaxation(chance, kind, t)
    size = np.exp(chance.uniform(np.log(2e-4), np.log(4e-2)))
    y = y + size * noise(chance, count, str(chance.choice(NOISES)))
    return case(kind, t, y, "force", float(chance.choice([1 / 3, 0.5])))


def simulated(count, seed):
    with multiprocessing.get_context("spawn").Pool() as pool:
        return [found for found in pool.imap(simulated_one, [(seed, i) for i in range(count)]) if found]


def regression(x, right, weight, ridge=1.0):
    """Coefficients of a logistic regression, by Newton's method; the first is not drawn to 0."""
    beta = np.zeros(x.shape[1])
    drawn = np.r_[0.0, np.full(x.shape[1] - 1, ridge)]
    for _ in range(50):
        p = 1 / (1 + np.exp(-x @ beta))
        slope = x.T @ (weight * (p - right)) + drawn * beta
        beta -= np.linalg.solve((x * (weight * p * (1 - p))[:, None]).T @ x + np.diag(drawn + 1e-9), slope)
    return beta


def arrays(cases):
    cases = [of for of in cases if of.held_out]
    return np.array([of.signs for of in cases]), np.array([float(of.right) for of in cases]), [of.source for of in cases]


def weights(real, count):
    """Measured holds count twice as much as simulated ones, all together."""
    return np.r_[np.full(real, 2.0), np.full(count, real / max(count, 1))]


def fitted(real, made):
    (x, right, _), (x_made, right_made, _) = arrays(real), arrays(made)
    both = regression(np.r_[x, x_made], np.r_[right, right_made], weights(len(x), len(x_made)))
    return both, regression(x, right, np.ones(len(x))), regression(x_made, right_made, np.ones(len(x_made)))


def left_out(real, made):
    """Probabilities of measured holds by regressions on all files but their own."""
    (x, right, files), (x_made, right_made, _) = arrays(real), arrays(made)
    files, found = np.array(files), np.zeros(len(x))
    for file in set(files):
        others = files != file
        beta = regression(np.r_[x[others], x_made], np.r_[right[others], right_made], weights(others.sum(), len(x_made)))
        found[~others] = 1 / (1 + np.exp(-x[~others] @ beta))
    return found, right


def bins(probabilities, right):
    """The text of two cells a bin: how many, and in how many % of them it was right."""
    for low, high in zip(BINS, BINS[1:]):
        inside = (probabilities >= low) & ((probabilities < high) | (high == 1.0))
        yield f"{inside.sum()} | {100 * right[inside].mean():.0f}" if inside.any() else "0 | "


def page(real, made, requested):
    p_real, right_real = np.array([of.probability for of in real if of.held_out]), np.array([of.right for of in real if of.held_out])
    p_made, right_made = np.array([of.probability for of in made if of.held_out]), np.array([of.right for of in made if of.held_out])
    p_left, right_left = left_out(real, made)
    cells = zip(BINS, BINS[1:], bins(p_real, right_real), bins(p_left, right_left), bins(p_made, right_made))
    rows = [f"| {100 * low:.0f} to {100 * high:.0f} | {one} | {other} | {third} |" for low, high, one, other, third in cells]
    words = []
    for word in ("clear", "likely", "open"):
        of = [[one for one in cases if one.certainty == word] for cases in (real, made)]
        share = [f"{len(cases)} | {100 * np.mean([one.right for one in cases]):.0f}" if cases else "0 | " for cases in of]
        words.append(f"| {word} | {' | '.join(share)} |")
    sets = []
    for name, cases in (("measured", real), ("simulated", made)):
        for held, what in ((True, "forecasts"), (False, "BIC alone")):
            of = [one for one in cases if one.held_out == held]
            if of:
                counted = [100 * np.mean([one.right for one in of]), np.median([one.ratio for one in of]), np.mean([one.alike for one in of])]
                counted += [100 * np.mean([one.has_best for one in of]), 100 * np.mean([one.has_near for one in of])]
                sets.append(f"| {name}, {what} | {len(of)} | {counted[0]:.0f} | {counted[1]:.2f} | {counted[2]:.1f} | {counted[3]:.0f} | {counted[4]:.0f} |")
    files = len({of.source for of in real})
    true = [of for of in made if of.true_law_near is not None]
    return f"""# How probable it is that the named law predicts best

`compare` names a law for a hold and states with which probability no other one predicts what follows better by more than a fifth. Here are
these probabilities and what came, on {len(real)} first parts of holds of {files} published records, which others measured and which are no part of this
repository (a hold gives up to three, so that they are not independent), and of {len(made)} simulated holds of {len(KINDS)} kinds of laws under {len(set(NOISES))} kinds of
noise. *Right*: no law that was compared has an error in the rest, noise included, that is smaller by more than a fifth, in %. The probability is
a regression on these measured holds and on simulated ones of another seed than here; *file left out* are regressions without the file that is judged.

```sh
python validation/law_probability.py "$PALPATE_DATA" --simulated {requested.simulated} --seed {requested.seed} --write
```

| stated, % | measured: holds | right | file left out: holds | right | simulated: holds | right |
|---|--:|--:|--:|--:|--:|--:|
{chr(10).join(rows)}

Where nothing could be held out, the probability is the same for all holds; they are not in this table. It is no more than
that, 32 %, where more than half of the relaxation is still to come by the named law, and where another law was better at every cut point.

| word | measured: holds | right | simulated: holds | right |
|---|--:|--:|--:|--:|
{chr(10).join(words)}

The law that is named, and the set of laws that are not distinguishable from the best: the median error of the named law over that of the law
that turned out to be the best, the size of the set, and in how many % of the holds it contains that best law, or one within a fifth of it.

| holds | number | right | ratio | laws in the set | contains the best | one near it |
|---|--:|--:|--:|--:|--:|--:|
{chr(10).join(sets)}

The set says which laws the forecasts so far do not distinguish. It is not a promise about the next stretch: a law that was worse than another
so far is better later in as many holds as the column before the last lacks.

How much there is to win: of {len(true)} simulated holds whose law is one of those that are compared, that law itself, fitted to the same first part, is
within a fifth of the best in {100 * np.mean([of.true_law_near for of in true]):.0f} %, and the law that `compare` names in {100 * np.mean([of.right for of in true]):.0f} %. Which of twelve laws comes closest to one noisy continuation is partly chance.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--fewest", type=int, default=60, help="samples of a hold")
    parser.add_argument("--simulated", type=int, default=600)
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--fit", action="store_true", help="print the coefficients instead of the page")
    parser.add_argument("--write", action="store_true", help="write the page")
    requested = parser.parse_args()
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    real = list(measured(requested.folder, requested.fewest))
    if not real:
        sys.exit("no hold could be judged")
    made = simulated(requested.simulated, requested.seed)
    if requested.fit:
        for name, beta in zip(("both", "measured", "simulated"), fitted(real, made)):
            print(name, ", ".join(f"{of:.2f}" for of in beta))
        without = [np.mean([of.right for of in cases if not of.held_out]) for cases in (real, made)]
        print(f"nothing held out: {(2 * without[0] + without[1]) / 3:.2f}, {without[0]:.2f}, {without[1]:.2f}")
        found, right = left_out(real, made)
        for low, cell in zip(BINS, bins(found, right)):
            print(f"from {low}: {cell}")
        return
    text = page(real, made, requested)
    print(text)
    if requested.write:
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
