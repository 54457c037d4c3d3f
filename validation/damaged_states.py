"""Damaged pickles of every class of the Python package, tried by the ten thousand.

    python validation/damaged_states.py [--most 3000] [--seed 1] [--patience-s 2] [--only NAME] [--write]

The package has to be installed for the Python that runs this. `crates/palpate-python/tests/damaged.py` describes what is damaged, how, and
what an object made of it is asked; `test_damaged_states.py` beside it tries a sample. --most is the number of damaged states of each example.
A failure is a panic (caught or not), another end of the process, an exception that is none of palpate's nor ValueError, TypeError,
OverflowError, UnpicklingError or EOFError, no answer within --patience-s, or more than 1 GB. With --write the table goes to
docs/validation/damaged-states.md. Exit code 1 if there are failures.
"""

import argparse
import pathlib
import sys
from collections import Counter

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "damaged-states.md"
sys.path.insert(0, str(ROOT / "crates" / "palpate-python" / "tests"))

import damaged  # noqa: E402


def cell(text):
    return " ".join(text.split()).replace("|", "\\|")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--patience-s", type=float, default=2.0)
    parser.add_argument("--only", action="append", help="only examples whose name begins like this; may be repeated")
    parser.add_argument("--write", action="store_true", help="write the table to docs/validation/damaged-states.md")
    requested = parser.parse_args()
    names = [name for name in damaged.EXAMPLES if not requested.only or name.startswith(tuple(requested.only))]
    rows, failures, states = [], [], 0
    for name in names:
        tried = damaged.tried(requested.seed, requested.most, [name], requested.patience_s)
        count = Counter(failure.kind if failure.kind in ("panic", "death", "hang") else "exception" for failure in tried.failures)
        kinds = " | ".join(str(count[kind]) for kind in ("panic", "exception", "hang", "death"))
        rows.append(f"| {name} | {tried.states[name]} | {tried.objects[name]} | {kinds} |")
        print(rows[-1], flush=True)
        failures += tried.failures
        states += tried.states[name]
    found = [
        f"| {failure.kind} | {cell(failure.where or failure.message)} | {times} | {failure.example} | {cell(failure.damage)} | {cell(failure.use)} |"
        for failure, times in damaged.fewest(failures)
    ]
    listed = f"""
| what | where, or what it said | times | example | shortest damage | question |
|---|---|--:|---|---|---|
{chr(10).join(found)}
"""
    page = f"""# Damaged states

{states:,} damaged pickles of the Python package, each read, and every answer of the object taken: text, properties, methods, equality, a
pickle. Answers without an object have to be an error of palpate, ValueError, TypeError, OverflowError, UnpicklingError or EOFError, within
{requested.patience_s:g} s and 1 GB. Failures: {len(failures)}. One command writes this page:

```sh
python validation/damaged_states.py --most {requested.most} --seed {requested.seed} --patience-s {requested.patience_s:g} --write
```

| example | damaged states | objects made | panics | other exceptions | no answer | ends of the process |
|---|--:|--:|--:|--:|--:|--:|
{chr(10).join(rows)}
{listed if found else ""}"""
    print(page)
    if requested.write:
        PAGE.write_text(page, encoding="utf-8")
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
