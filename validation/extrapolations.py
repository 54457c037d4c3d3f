"""How often the intervals of predictions beyond the test contain what was measured, on whole real records.

    python validation/extrapolations.py DATA [--write]

DATA is the folder of public records. The latency law is calibrated on the first part of each record of whole_records.py and predicts the rest
along its measured motion. A reading is covered where its 95 % interval contains it. "Parameters alone" is the same material with a range that
nothing lies beyond. The package has to be installed for the Python that runs this. With --write the table goes to
docs/validation/extrapolations.md.
"""

import argparse
import pathlib
import re
import tempfile
import warnings

import numpy as np
import palpate

from whole_records import RECORDS, ROOT

PAGE = ROOT / "docs" / "validation" / "extrapolations.md"
WIDE = {
    "longest_hold": '"1e9 s"',
    "longest_force_hold": '"1e9 s"',
    "deepest": '"1e3 m"',
    "fastest": '"1e3 m/s"',
    "largest_force": '"1e9 N"',
    "farthest_retreat": '"1e3 m"',
    "loadings": "1000000",
}


def without_end(material):
    """The same material with a range that nothing lies beyond."""
    text = material.to_toml()
    for name, value in WIDE.items():
        text = re.sub(rf"^{name} = .*$", f"{name} = {value}", text, flags=re.MULTILINE)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "material.toml")
        path.write_text(text, encoding="utf-8")
        return palpate.Material.read(path)


def seconds(text):
    return float(text.removesuffix(" s"))


def figures(prediction, held, force):
    """Share of the held-out readings inside the interval, and its median half width over the largest force."""
    low, high = np.array(prediction.reading_low_n)[held], np.array(prediction.reading_high_n)[held]
    inside = (low <= force[held]) & (force[held] <= high)
    return np.mean(inside), np.median(high - low) / 2 / np.max(np.abs(force))


def rows(data):
    for title, record, test, parts in RECORDS:
        measured = palpate.read(data / record, test=ROOT / test)
        for until, what in parts.items():
            calibration = measured.calibrate(alternatives=[], fit_until_s=seconds(until))
            times, force = np.array(calibration.time_s), np.array(calibration.force_n)
            held = np.arange(len(times)) >= calibration.fitted
            material = calibration.material
            head = f"| {title}, up to {until} | {what.split('predicted: ')[-1]} "
            if material.log_covariance is None:
                yield head + "| – | – | – | – | the test leaves a parameter open |"
                continue
            beyond = material.predict(measured, at_s=times)
            inside, half = figures(beyond, held, force)
            alone, narrow = figures(without_end(material).predict(measured, at_s=times), held, force)
            named = "; ".join(text.split(":")[0] for text in beyond.extrapolations)
            yield head + f"| {alone:.0%} | {narrow:.1%} | {inside:.0%} | {half:.1%} | {named} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    options = parser.parse_args()
    warnings.simplefilter("ignore", palpate.PalpateWarning)
    table = [
        "| record | predicted | covered, parameters alone | half width | covered | half width | beyond the test |",
        "|---|---|--:|--:|--:|--:|---|",
    ]
    for row in rows(options.data.resolve()):
        table.append(row)
        print(row, flush=True)
    if options.write:
        PAGE.write_text(
            "# Intervals beyond the test\n\n"
            'Written by `python validation/extrapolations.py "$PALPATE_DATA" --write`. The latency law is calibrated on the first part of each\n'
            "record and predicts the rest along its measured motion. *Covered* is the share of the held-out readings inside their 95 % interval,\n"
            "*half width* the median of half of it in per cent of the largest force: for the uncertainty of the parameters and noise alone, and with\n"
            "[what palpate adds beyond the test](../theory/calibration.md#prediction). A band that covers less than 95 % inside the range of the test\n"
            "shows that the law is wrong there: no interval contains that.\n\n" + "\n".join(table) + "\n",
            encoding="utf-8",
        )


if __name__ == "__main__":
    main()
