"""How 95 % intervals do where a hold ends before the body has relaxed.

    python validation/short_holds.py [--holds 300] [--samples 400] [--write]

Runs `cargo run --release -p palpate --example short_holds`, which simulates holds of 0.3 to 10 s of laws with times of 0.3 to 3 s, and fits the
law that they follow: by the automatic method, and by curvature alone. With --write the table goes to docs/validation/short-holds.md. Not a
reference: nothing in the tests reads it.
"""

import argparse
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "short-holds.md"

HEAD = """# Holds shorter than the relaxation

Coverage of 95 % intervals, in %, over {holds} simulated holds of {samples} samples with white noise (±{error:.1f} % a number, more where few fits have
an interval): of the equilibrium, and of the parameter of the law that is covered least. *By curvature* are the same fits with intervals from the
curvature at the optimum. *After*: bands of the curve 1.5 and 5 times as long after the start of the hold as it lasts. *Open*: intervals of the equilibrium with an end that the data leave open, in % of those there are. *None*: holds whose
fit did not reach an optimum inside its range, so that no interval is stated, in % of all. Noise is in % of the drop. Laws: latency with
n = 5 and relative rate 2 /s, with n = 3 found; a standard linear solid of 2 s; a Prony series of 0.3 and 3 s. One command writes this page:

```sh
python validation/short_holds.py --holds {holds} --samples {samples} --write
```

| law | hold, s | noise, % | equilibrium | by curvature | least | by curvature | after 1.5 | by curvature | after 5 | by curvature | open | none | profiles | ms a fit | by curvature |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|
"""

TAIL = """
The least is an amplitude or a time of a Prony series where terms merge: which of two terms a fit calls the first is then chance.
"""


def studied(holds, samples, *method):
    command = ["cargo", "run", "--quiet", "--release", "-p", "palpate", "--example", "short_holds", str(holds), str(samples), *method]
    out = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    cases = {}
    for row in map(json.loads, out.splitlines()):
        cases.setdefault((row["law"], row["seconds"], row["noise"]), []).append(row)
    return cases


def covered(row):
    return 100 * (1 - (row["below"] + row["above"]) / row["found"])


def line(case, rows, plain):
    law, seconds, noise = case
    counted = [f"{law} | {seconds:g} | {100 * noise:g}"]
    if rows[0]["found"] == 0:
        return f"| {counted[0]} |  |  |  |  |  |  |  |  |  | 100 |  |  |  |"
    for of in (covered(rows[0]), covered(plain[0]), min(map(covered, rows)), min(map(covered, plain))):
        counted.append(f"{of:.0f}")
    first = rows[0]
    for ahead in range(2):
        counted += [f"{100 * of[0]['predicted'][ahead] / of[0]['predictions']:.0f}" for of in (rows, plain)]
    counted.append(f"{100 * first['open'] / first['found']:.0f}")
    counted.append(f"{100 * (1 - first['found'] / first['holds']):.0f}")
    counted.append(f"{100 * first['profiles'] / first['holds']:.0f}")
    counted += [f"{of[0]['milliseconds']:.2f}" for of in (rows, plain)]
    return f"| {' | '.join(counted)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--holds", type=int, default=300)
    parser.add_argument("--samples", type=int, default=400)
    parser.add_argument("--write", action="store_true", help="write docs/validation/short-holds.md")
    chosen = parser.parse_args()
    found, plain = studied(chosen.holds, chosen.samples), studied(chosen.holds, chosen.samples, "curvature")
    page = HEAD.format(holds=chosen.holds, samples=chosen.samples, error=196 * (0.95 * 0.05 / chosen.holds) ** 0.5)
    page += "\n".join(line(case, found[case], plain[case]) for case in sorted(found)) + "\n" + TAIL
    print(page)
    if chosen.write:
        PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
