"""How often the 95 % intervals of palpate's fits contain the truth.

    python validation/interval_coverage.py            1000 holds a case (300 for profiles and the bootstrap)

Runs `cargo run --release -p palpate --example coverage_study`, which simulates the holds, and writes
validation/results/coverage.md and coverage.svg. Not a reference: nothing in the tests reads it; the fast version that the
tests run is crates/palpate/tests/fits/coverage.rs. Needs matplotlib for the figure.
"""

import json
import math
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "coverage"  # the same picture makes the same file
import matplotlib.pyplot as plt  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "validation" / "results"
# A drift that the residuals cannot rule out widens intervals, and standard errors more than them.
WHITE, CORRELATED, BY_ERROR = (0.93, 0.98), (0.90, 0.97), (0.93, 0.99)


def study(arguments):
    command = ["cargo", "run", "--quiet", "--release", "-p", "palpate", "--example", "coverage_study", *arguments]
    out = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [json.loads(line) for line in out.splitlines()]


def share(row, what="covered"):
    return row[what] / row["holds"]


def pick(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def table(rows):
    lines = ["| law | parameter | interval, white noise | interval, AR(1) | ± 1.96 se, white noise | ± 1.96 se, AR(1) "
             "| ± 1.96 white se, AR(1) | profile, AR(1) | bootstrap, AR(1) |",
             "|---|---|---:|---:|---:|---:|---:|---:|---:|"]
    for white in pick(rows, method="Curvature", noise=0):
        key = {"case": white["case"], "parameter": white["parameter"]}
        own = pick(rows, method="Curvature", noise=0.9, **key)[0]
        others = [pick(rows, method=method, noise=0.9, **key) for method in ("Profile", "Bootstrap")]
        shown = [f"{100 * share(found[0]):.1f}" if found else "–" for found in others]
        lines.append(f"| {key['case']} | {key['parameter']} | {100 * share(white):.1f} | {100 * share(own):.1f} "
                     f"| {100 * share(white, 'by_error'):.1f} | {100 * share(own, 'by_error'):.1f} "
                     f"| {100 * share(own, 'by_white_error'):.1f} | {' | '.join(shown)} |")
    return "\n".join(lines)


def figure(rows):
    rows = pick(rows, method="Curvature")
    labels = [f"{row['case']}: {row['parameter'].replace('_', ' ')}" for row in pick(rows, noise=0)]
    fig, axis = plt.subplots(figsize=(8.0, 5.2), layout="constrained")
    axis.axvspan(100 * WHITE[0], 100 * WHITE[1], color="0.9", lw=0, label="93 to 97 %")
    axis.axvline(95, color="0.6", lw=1)
    for noise, what, name, mark, colour in [(0, "covered", "white noise", "o", "#0072b2"),
                                            (0.9, "covered", "AR(1) noise of 0.9", "s", "#d55e00"),
                                            (0.9, "by_white_error", "AR(1) noise, taken for white", "x", "0.4")]:
        chosen = pick(rows, noise=noise)
        x = [100 * share(row, what) for row in chosen]
        error = [196 * math.sqrt(p / 100 * (1 - p / 100) / row["holds"]) for p, row in zip(x, chosen)]
        place = [-i + (0.15 if noise == 0 else -0.15) for i in range(len(x))]
        axis.errorbar(x, place, xerr=error, fmt=mark, color=colour, ms=4, lw=1, label=name)
    axis.set(yticks=[-i for i in range(len(labels))], yticklabels=labels, xlim=(30, 100),
             xlabel=f"intervals that contain the truth, % of {rows[0]['holds']} holds")
    axis.legend(loc="center", bbox_to_anchor=(0.5, 0.5), frameon=False, fontsize=9)
    axis.spines[["top", "right"]].set_visible(False)
    path = RESULTS / "coverage.svg"
    fig.savefig(path, metadata={"Date": None})
    assert path.stat().st_size < 150_000, path.stat().st_size


def extremes(rows, what="covered", **wanted):
    shares = [100 * share(row, what) for row in pick(rows, **wanted)]
    return f"{min(shares):.1f} to {max(shares):.1f} %"


def main():
    rows = study(sys.argv[1:])
    for row in pick(rows, method="Curvature"):
        low, high = WHITE if row["noise"] == 0 else CORRELATED
        assert row["open"] == 0 and low <= share(row) <= high, row
        assert BY_ERROR[0] <= share(row, "by_error") <= BY_ERROR[1], row
    few = pick(rows, method="Profile")[0]["holds"]
    many = pick(rows, method="Curvature")[0]["holds"]
    RESULTS.mkdir(exist_ok=True)
    figure(rows)
    text = f"""# Coverage of 95 % intervals

Simulated holds of 1000 samples over 10 s, drop 1 (two drops of 0.5 for Prony), noise 10⁻³ (SLS: 10⁻²), {many} holds a law and
noise; a share of 95 % is then known to ±{196 * math.sqrt(0.95 * 0.05 / many):.1f} %. Intervals of the fit itself cover {extremes(rows, method="Curvature", noise=0)} for white noise
and {extremes(rows, method="Curvature", noise=0.9)} for AR(1) noise of 0.9; value ± 1.96 standard errors (se) covers {extremes(rows, "by_error", method="Curvature", noise=0)} and
{extremes(rows, "by_error", method="Curvature", noise=0.9)}. With the standard error for white noise (white se) the latter would be {extremes(rows, "by_white_error", method="Curvature", noise=0.9)}.

![coverage](coverage.svg)

Share of holds, in %, whose interval contains the truth. Profile and bootstrap: AR(1) noise, {few} holds (±{196 * math.sqrt(0.95 * 0.05 / few):.1f} %); over
both noises profiles cover {extremes(rows, method="Profile")}, the bootstrap {extremes(rows, method="Bootstrap")}. `rate_coefficient_per_s` follows
from others and has no profile.

{table(rows)}

Written by `validation/interval_coverage.py`; the holds are those of `crates/palpate/tests/common/coverage.rs`.
"""
    (RESULTS / "coverage.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
