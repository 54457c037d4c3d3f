"""Whole real records: laws calibrated on the first part of each, and how well they predict the rest.

    python validation/whole_records.py DATA [--palpate PALPATE]     writes docs/validation/whole-records.md

DATA is the folder of public records (the one that PALPATE_DATA names for the tests). PALPATE is the command, by default the one in the
path. Records of others are not part of this repository. Needs nothing but Python and palpate; takes some minutes, nearly all
for the record of 24 holds.
"""

import argparse
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "whole-records.md"
LAWS = "standard-linear-solid,prony:2,prony:3,fung:2,fung:3"

# Record, description, times to fit until, and what happens before and after.
RECORDS = [
    (
        "Silicone strip in steps, one level",
        "silicone-steps/2_7-5_E2pin_20mm_capac_relax.csv",
        "examples/tests/silicone-steps.toml",
        {
            "62 s": "the first stretch and its hold; predicted: all unloading and four more stretches",
            "160 s": "two and a half cycles; predicted: the next two and a half",
        },
    ),
    (
        "Silicone strip in steps, three levels",
        "silicone-steps/1_7-5_Epin_20mm_v1.csv",
        "examples/tests/silicone-steps.toml",
        {
            "200 s": "three stretches to 4 mm; predicted: stretches to 8 mm and 12 mm, up to 1400 s",
            "560 s": "stretches to 4 mm and 8 mm; predicted: stretches to 8 mm and 12 mm, up to 1400 s",
        },
    ),
    (
        "Soft foam in compression",
        "foam/XtraSoft.csv",
        "validation/records/foam.toml",
        {"35 s": "the only ramp and half of its hold; predicted: the other half, and the unloading"},
    ),
    (
        "VHB 4910 tape in tension, stretched 2.5 times",
        "vhb4910/relax_2d5.csv",
        "validation/records/vhb4910.toml",
        {
            "60 s": "the ramp and 50 s of its hold; predicted: 30 minutes",
            "200 s": "the ramp and 190 s of its hold; predicted: 30 minutes",
            "600 s": "the ramp and ten minutes of its hold; predicted: another twenty",
        },
    ),
    (
        "VHB 4910 tape in tension, stretched 3 times",
        "vhb4910/relax_3d0.csv",
        "validation/records/vhb4910.toml",
        {
            "60 s": "the ramp and 50 s of its hold; predicted: 30 minutes",
            "200 s": "the ramp and 190 s of its hold; predicted: 30 minutes",
            "600 s": "the ramp and ten minutes of its hold; predicted: another twenty",
        },
    ),
]

HEAD = """# Whole real records

Published records, each calibrated on its first part, ramps and holds alike, and predicted on the rest. One command writes this page:

```sh
python validation/whole_records.py "$PALPATE_DATA"
```

*Residual* is the root mean square of measured minus simulated force over the fitted part, *held-out error* that over the rest, both **in %
of the largest force of the record** and including the noise of the samples; the smallest held-out error is bold. *p* is the number of
parameters of a law, *ΔBIC* the difference from the best fit. Brackets mark a search that did not converge or
parameters at a bound; such a law has no ΔBIC.
[Calibration of a whole record](../theory/calibration.md) describes the method.

Conclusions:

- On half-hour holds the latency law with a constant v predicts best from the first ten minutes, with some tenth of the error of a Prony
  series of three terms. From less than a minute only the law with v by strain, which fits the ramp, predicts well.
- The law that fits best need not predict best. On records of one stretch v by strain leaves the smallest residual everywhere, mostly with a
  parameter at its bound: one level shows no trend, and its factor adapts to the ramp instead. From ten minutes of VHB, and on foam, it
  predicts worse than constant v.
- On silicone in steps up and down v by direction fits as well as any law or better. Fitted to more than one cycle, its held-out error is
  no larger than that of constant v; all laws lie within a factor of 1.5 of each other there.
- One ramp and half a hold of foam determine the equilibrium force only at one displacement: no law predicts the unloading.

The records are not part of this repository. Cross-sections that their authors do not give are assumed; they affect only the modulus and no
value on this page.
"""


def calibrated(palpate, data, record, test, until):
    """The JSON document of one calibration."""
    command = [palpate, "calibrate", str(data / record), "--test", str(ROOT / test), "--fit-until", until]
    command += ["--rate", "by-strain", "--alternatives", LAWS, "--format", "json"]
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    if made.returncode not in (0, 1):
        raise SystemExit(f"{' '.join(command)}\n{made.stderr}")
    return json.loads(made.stdout)


def percent(share):
    return f"{100 * share:#.2g}".rstrip(".")


def rows(document):
    """A row for each law; those that could not be fitted say why."""
    known = [law["holdout"]["relative"] for law in document["laws"] if law["holdout"]]
    for law in document["laws"]:
        if not law["holdout"]:
            yield f"| {law['law']} | | | | {law['error']} |"
            continue
        predicted = percent(law["holdout"]["relative"])
        if law["holdout"]["relative"] == min(known):
            predicted = f"**{predicted}**"
        if law["termination"] != "converged" or law["log_covariance"] is None:
            predicted = f"({predicted})"
        # A search that did not end at an optimum has no rank.
        behind = "" if law["delta_bic"] is None else f"{law['delta_bic']:.0f}"
        yield f"| {law['law']} | {law['free_parameters']} | {percent(law['relative'])} | {behind} | {predicted} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--palpate", default="palpate")
    requested = parser.parse_args()
    page = [HEAD]
    for title, record, test, parts in RECORDS:
        page.append(f"\n## {title}\n")
        for until, what in parts.items():
            document = calibrated(requested.palpate, requested.data.resolve(), record, test, until)
            samples = next(law["holdout"]["samples"] for law in document["laws"] if law["holdout"])
            page.append(f"\nFitted up to {until}: {what}. {document['fitted']} samples fitted, {samples} predicted.\n\n")
            page.append(f"<!-- palpate calibrate {record} --test {test} --fit-until \"{until}\" --rate by-strain --alternatives {LAWS} -->\n\n")
            page.append("| Law | p | Residual (%) | ΔBIC | Held-out error (%) |\n| --- | --: | --: | --: | --: |\n")
            page.extend(f"{row}\n" for row in rows(document))
            print(f"{record}, {until}", flush=True)
    PAGE.write_text("".join(page), encoding="utf-8")


if __name__ == "__main__":
    main()
