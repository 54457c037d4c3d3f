"""Forecasts of holds from their first third, against what came: the combination of all laws, single laws, and the law that is named.

    python validation/forecasts.py FOLDER [--share 0.3333] [--fewest 60] [--write]

FOLDER holds records of any format that palpate reads; a file NAME.toml beside NAME.csv describes it. The package has to be installed for
the Python that runs this. Every hold of at least --fewest samples is cut at --share of its duration. A ratio is the root mean square error
of a forecast over that of the law which turns out to be the best of all, by the samples behind the cut and with their noise. A hold is
covered where the 95 % band contains 95 % of these samples. Where a record has several holds, each is also forecast beside the others, and
beside those before it. What fixed weights of all laws would reach is found by SciPy. With --write the table goes to docs/validation/forecasts.md.
"""

import argparse
import pathlib
import statistics
import sys
import warnings
from dataclasses import dataclass

import numpy as np
import palpate
from scipy.optimize import minimize

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "forecasts.md"
NEAR = 1.2
# Laws whose forecasts are combined with fixed weights, for comparison.
COMBINED = ["latency", "logarithmic", "power", "stretched", "fractional-zener", "standard-linear-solid", "prony:2", "prony:3", "diffusion"]
# Laws whose continuation is known, of a hold of 10 s that changes by about 2: by name, F(t).
SIMULATED = {
    "exponential, 3 s": lambda t: 1 + 2 * np.exp(-t / 3),
    "exponential, 10 s": lambda t: 1 + 2 * np.exp(-t / 10),
    "exponential, 20 s": lambda t: 1 + 2 * np.exp(-t / 20),
    "exponentials, 1 and 10 s": lambda t: 1 + np.exp(-t) + np.exp(-t / 10),
    "latency, n = 5": lambda t: 1 + 2 * (1 + 8 * t) ** -0.25,
    "latency, n = 2": lambda t: 1 + 2 / (1 + t),
    "power, exponent 0.1": lambda t: 3 * (1 + 5 * t) ** -0.1,
    "logarithm": lambda t: 3 - 0.4 * np.log1p(10 * t),
    "square root of time": lambda t: 1 + 2 * np.exp(-np.sqrt(t / 3)),
}
SIZES, REPEATED, SAMPLES = (1e-3, 1e-2), 60, 300


@dataclass
class Forecast:
    """One forecast of a hold: its root mean square error behind the cut, and whether its band covered these samples."""

    error: float
    covered: bool


@dataclass
class Hold:
    """What came of one hold."""

    file: str
    samples: int
    # By what else was known of the body: "alone", "others", "before".
    forecasts: dict[str, Forecast]
    # Root mean square errors of the laws.
    laws: dict[str, float]
    named: str | None
    certainty: str | None
    # Mean products of the errors of two members, over the square of the best law's error: the combination, then `COMBINED`.
    products: np.ndarray

    @property
    def best(self):
        return min(self.laws.values())

    def ratio(self, law):
        return self.laws.get(law, np.inf) / self.best


def holds(folder, fewest):
    """The holds of all records below a folder: the file, times and the signal that relaxes or creeps."""
    for path in sorted(folder.rglob("*")):
        if not path.is_file() or path.suffix in (".toml", ".md"):
            continue
        described = path.with_suffix(".toml")
        try:
            records = palpate.read_all(path, test=described if described.exists() else None)
        except palpate.PalpateError as error:
            print(f"{path.relative_to(folder)}: {str(error).splitlines()[0]}", file=sys.stderr)
            continue
        for record in records:
            try:
                phases = record.segments()
            except palpate.PalpateError:
                continue
            for phase in phases:
                first, last = phase["first_row"], phase["last_row"] + 1
                if phase["phase"] != "hold" or last - first < fewest:
                    continue
                creeps = phase["mode"] == "force_held" and record.displacement_m is not None
                signal = record.displacement_m if creeps else record.force_n
                yield str(path.relative_to(folder)), record.time_s[first:last], signal[first:last], "displacement" if creeps else "force"


def judged(file, hold, others, share):
    """What the first part of a hold says of the rest; None where it says nothing. Others are holds, and whether they came before."""
    t, y, quantity = hold
    cut = t[0] + share * (t[-1] - t[0])
    first = int(np.searchsorted(t, cut, side="right"))
    whole = palpate.compare(t, y, quantity=quantity, cuts=[share]).to_dict()
    laws = {law["law"]: forecast["error"] * whole["change"] for law in whole["laws"] for forecast in law["forecasts"] if forecast}
    if not laws:
        return None
    rest = y[first:]
    members = []

    def forecast(beside):
        table = palpate.forecast(t[:first], y[:first], t[first:], quantity=quantity, others=beside)
        members.append(table["value"])
        inside = (table["low"] <= rest) & (rest <= table["high"])
        return Forecast(float(np.sqrt(np.mean((table["value"] - rest) ** 2))), bool(inside.mean() >= 0.95))

    forecasts = {"alone": forecast(None)}
    known = {"others": [other for other, _ in others], "before": [other for other, before in others if before]}
    forecasts.update({name: forecast(beside) for name, beside in known.items() if beside})
    alone, response = members[0], "creep" if quantity == "displacement" else "relaxation"
    fitted = (palpate.fit_hold(t[:first], y[:first], law=law, response=response).predict(t[first:]) if law in laws else alone for law in COMBINED)
    errors = (np.array([alone, *fitted]) - rest) / min(laws.values())
    verdict = palpate.compare(t[:first], y[:first], quantity=quantity)
    return Hold(file, len(t), forecasts, laws, verdict.law, verdict.certainty, errors @ errors.T / len(rest))


def weighted(holds, weights):
    """Ratios of the combination with these weights."""
    return np.sqrt([weights @ hold.products @ weights for hold in holds])


def fixed(holds):
    """The weights, of sum 1 and none below 0, of the least mean logarithm of the ratio."""
    count = 1 + len(COMBINED)

    def softmax(x):
        powers = np.exp(x - x.max())
        return powers / powers.sum()

    starts = [np.zeros(count), *(4.0 * np.eye(count))]
    found = [minimize(lambda x: np.log(weighted(holds, softmax(x))).mean(), start) for start in starts]
    return softmax(min(found, key=lambda result: result.fun).x)


def ceiling(found):
    """What fixed weights of all laws would reach: in hindsight, and chosen on all other files."""
    in_hindsight = weighted(found, fixed(found))
    apart = []
    for file in {hold.file for hold in found}:
        weights = fixed([hold for hold in found if hold.file != file])
        apart += list(weighted([hold for hold in found if hold.file == file], weights))
    only_one = np.mean([sum(hold.ratio(law) <= NEAR for law in hold.laws) == 1 for hold in found])
    return 100 * only_one, share_of(in_hindsight), share_of(apart)


def share_of(ratios):
    """Share of ratios that are near 1 and their median, as two cells."""
    return f"{100 * np.mean([ratio <= NEAR for ratio in ratios]):.0f} | {statistics.median(ratios):.2f}"


def cells(found, name):
    """Near, ratio and covered of the forecasts by what was known, as three cells; of the holds that have one."""
    known = [(hold, hold.forecasts[name]) for hold in found if name in hold.forecasts]
    if not known:
        return "– | – | –"
    return f"{share_of([forecast.error / hold.best for hold, forecast in known])} | {100 * np.mean([forecast.covered for _, forecast in known]):.0f}"


def row(name, found):
    spectrum = [hold.ratio("spectrum") for hold in found]
    return f"| {name} | {len(found)} | {cells(found, 'alone')} | {cells(found, 'others')} | {cells(found, 'before')} | {share_of(spectrum)} |"


def simulated():
    """Rows of the table of laws whose continuation is known: how many new samples lie in the band at twice and three times the duration."""
    t, later = np.linspace(0.0, 10.0, SAMPLES), np.array([20.0, 30.0])
    rows = []
    for name, law in SIMULATED.items():
        cells = []
        for size in SIZES:
            inside = np.zeros(2)
            for seed in range(REPEATED):
                rng = np.random.default_rng(seed)
                table = palpate.forecast(t, law(t) + size * rng.normal(size=SAMPLES), later)
                fresh = law(later) + size * rng.normal(size=2)
                inside += (table["low"] <= fresh) & (fresh <= table["high"])
            cells += [f"{100 * share:.0f}" for share in inside / REPEATED]
        rows.append(f"| {name} | {' | '.join(cells)} |")
    return rows


def page(found, requested, left_out):
    files = {}
    for hold in found:
        files.setdefault(hold.file, []).append(hold)
    rows = [row(name, of) for name, of in files.items()]
    several = [hold for hold in found if "others" in hold.forecasts]
    words = []
    for word in ("clear", "likely", "open"):
        of = [hold for hold in found if hold.certainty == word]
        if of:
            right = sum(hold.ratio(hold.named) <= NEAR for hold in of)
            words.append(f"| {word} | {len(of)} | {100 * right / len(of):.0f} |")
    only_one, in_hindsight, apart = ceiling(found)
    return f"""# Forecasts

What the first {100 * requested.share:.0f} % of a hold says of the rest, on {len(found)} holds of {len(files)} published records, which others measured and which are no
part of this repository. The forecast combines all laws. *Alone*: with weights from what each predicts within that first part. *Others*: where
a record has several holds, with weights from what each predicts of the other holds too, which are known whole, and with the courses of those
that are longer by half as members. *Before*: the same with the holds before it only. *Near*: holds in which the root mean square error of the forecast is within 20 % of that of the law which turns out to
be the best, in %; nobody knows that law before. *Ratio*: the median of one error over the other. *Covered*: holds in which the 95 % band
contains 95 % of the samples that follow. Last the dense spectrum alone. Members, cuts, their importance, the ridge, and how much other holds
count were chosen on these holds, among some ninety variants: other holds will do worse, by how much is not known. Not judged: {left_out} holds whose
first part says nothing. One command writes this page:

```sh
python validation/forecasts.py "$PALPATE_DATA" --share {requested.share:.4f} --fewest {requested.fewest} --write
```

| file | holds | alone: near | ratio | covered | others: near | ratio | covered | before: near | ratio | covered | spectrum: near | ratio |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|
{row("**all**", found)}
{row("**records of several holds**", several)}
{chr(10).join(rows)}

How near a combination can come is limited: in {only_one:.0f} % of the holds a single law is within 20 % of the best one, and it is not the same from
hold to hold. The same laws and the combination with one set of fixed weights for all holds, for comparison:

| weights | near | ratio |
|---|--:|--:|
| those of the least mean logarithm of the ratio on these very holds | {in_hindsight} |
| the same for each file from the holds of all others | {apart} |

The law that `compare` names from the same first part, by its certainty: holds, and in how many % of them its forecast is within 20 % of
that of the best law.

| certainty | holds | right |
|---|--:|--:|
{chr(10).join(words)}

## Laws whose continuation is known

Shares of new samples within the 95 % band at twice and three times the duration of a hold of 10 s, in %, {REPEATED} simulated holds of {SAMPLES} samples
each, with white noise of {SIZES[0]} and {SIZES[1]} (the hold changes by 1 to 2). The band follows from how laws have predicted the hold so far: a law
that levels off only after the hold has ended looks until then like one that does not, and the band lies too low for it.

| law | noise {SIZES[0]}: 20 s | 30 s | noise {SIZES[1]}: 20 s | 30 s |
|---|--:|--:|--:|--:|
{chr(10).join(simulated())}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--share", type=float, default=1 / 3, help="of a hold that is seen")
    parser.add_argument("--fewest", type=int, default=60, help="samples of a hold")
    parser.add_argument("--write", action="store_true", help="write the table to docs/validation/forecasts.md")
    requested = parser.parse_args()
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    records = {}
    for file, t, y, quantity in holds(requested.folder, requested.fewest):
        records.setdefault((file, quantity), []).append((np.asarray(t), np.asarray(y), quantity))
    found, left_out = [], 0
    for (file, _), of in records.items():
        for index, hold in enumerate(of):
            nearest = sorted((other for other in range(len(of)) if other != index), key=lambda other: abs(other - index))
            try:
                result = judged(file, hold, [(of[other][:2], other < index) for other in nearest], requested.share)
            except palpate.PalpateError:
                result = None
            if result is None:
                left_out += 1
                continue
            found.append(result)
            errors = ", ".join(f"{name} {forecast.error / result.best:.2f}" for name, forecast in result.forecasts.items())
            print(f"{file}: {result.samples} samples, times the best: {errors}", flush=True)
    if not found:
        sys.exit("no hold could be judged")
    text = page(found, requested, left_out)
    print(text)
    if requested.write:
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
