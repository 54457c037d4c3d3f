"""How 95 % intervals do under noise of many kinds, most of which no fit was made for.

    python validation/noise_kinds.py [--holds 500] [--samples 400] [--write]

Runs `cargo run --release -p palpate --example noise_study`, which simulates the holds and fits the law that they follow. With --write the
table goes to docs/validation/noise.md. A width is the median over that of an interval which knows the spread of the estimates. Not a
reference: nothing in the tests reads it.
"""

import argparse
import json
import math
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "noise.md"

HEAD = """# Noise of many kinds

Coverage of 95 % intervals, in %, over the parameters of four laws (latency with n = 5 and with n free, standard linear solid, Prony series
of two times), {holds} simulated holds (±{error:.1f} % a number): the least, the mean and the greatest. Width: the median over
that of an interval which knows the spread of the estimates. A random walk is given by the size of its steps over that of the white noise.
One command writes this page:

```sh
python validation/noise_kinds.py --holds {holds} --samples {samples} --write
```
"""

TABLE = """
## {samples} samples

| noise | least | mean | greatest | width, least | mean | greatest |
|---|--:|--:|--:|--:|--:|--:|
"""

TAIL = """
Intervals are not to be relied on where the least coverage is far below 95 %: under a slow drift that is hidden in white noise; under noise
whose power goes as 1/f, in holds of one to three hundred samples above all; and of a dozen or two samples, under noise that correlates over
several of them or follows the signal. For noise that follows the signal those samples count in which the signal is large: starts, amplitudes and
rates of a hold of any length suffer if only a few of its samples lie within its shortest time. Otherwise equilibria suffer first. White noise
pays for it: a drift that the residuals cannot rule out makes its intervals wider than they need be.
"""

# Of few samples fewer kinds can be told apart; of more, others.
KINDS_OF = {
    12: ("white", "AR(1) 0.7", "AR(1) 0.9", "ARMA(2, 1)", "walk 0.1 and white", "logarithmic times"),
    25: ("white", "AR(1) 0.7", "ARMA(2, 1)", "walk 0.1 and white", "proportional", "logarithmic times", "logarithmic times, and white"),
    50: ("white", "AR(1) 0.9", "1/f", "proportional", "proportional, logarithmic times", "logarithmic times, and white"),
    100: ("white", "AR(1) 0.9", "low-pass filter", "1/f", "walk 1 and white", "proportional", "logarithmic times, and white"),
    200: ("white", "AR(1) 0.9", "low-pass filter", "1/f", "walk 1 and white", "proportional"),
    1000: ("white", "AR(1) 0.9", "low-pass filter", "1/f", "walk 1 and white", "walk 0.03 and white"),
}


def table(holds, samples, *names):
    command = ["cargo", "run", "--quiet", "--release", "-p", "palpate", "--example", "noise_study", str(holds), str(samples), *names]
    out = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    kinds = {}
    for row in map(json.loads, out.splitlines()):
        kinds.setdefault(row["noise"], []).append(row)
    text = TABLE.format(samples=samples)
    for name, rows in kinds.items():
        covered = [100 * row["covered"] / row["found"] for row in rows]
        widths = [math.inf if row["width"] is None else row["width"] for row in rows]
        numbers = [*(f"{number:.1f}" for number in (min(covered), sum(covered) / len(rows), max(covered))),
                   *(f"{number:.2f}" if number < math.inf else "open" for number in (min(widths), sum(widths) / len(rows), max(widths)))]
        text += f"| {name} | {' | '.join(numbers)} |\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--holds", type=int, default=500)
    parser.add_argument("--samples", type=int, default=400)
    parser.add_argument("--write", action="store_true", help="write docs/validation/noise.md")
    chosen = parser.parse_args()
    page = HEAD.format(holds=chosen.holds, samples=chosen.samples, error=196 * (0.95 * 0.05 / chosen.holds) ** 0.5)
    page += table(chosen.holds, chosen.samples)
    page += "".join(table(chosen.holds, samples, *names) for samples, names in KINDS_OF.items())
    page += TAIL
    print(page)
    if chosen.write:
        PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
