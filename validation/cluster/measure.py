"""The measurements of docs/validation/cluster.md, with one command; as root, for Slurm:

    python validation/cluster/measure.py PALPATE [--million 1000000] [--million-shards 18] [--paired 200000] [--rounds 5]
        [--curves 90000] [--shards 2] [--kills 100] [--workers 1000] [--only million,pairs,runs,kills,scaling]
        [--seed 1] [--write]

PALPATE is the command, called `palpate`. Python needs `validation/cluster/requirements.txt`, and the package palpate for the parts on
Dask, which are left out without it. The tables are printed; with --write they go to docs/validation/cluster.md, where those of the other
parts stay. Exit code 1 if a row was lost or doubled, or a byte differs. A Slurm of two nodes runs on this host meanwhile (`slurm.sh`).
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import pathlib
import platform
import sys
import tempfile

import curves
import kills
import pairs
import runs
import scaling
from _cluster import PROCESSORS, ROOT, Job, succeeded

PAGE = ROOT / "docs" / "validation" / "cluster.md"
# The parts with the titles of their sections.
PARTS = {"million": "A million curves", "pairs": "Overhead", "runs": "One worker and two", "kills": "Kills", "scaling": "Scaling"}
HEAD = """# Clusters

A batch on a cluster against the plain command, by `validation/cluster/measure.py`; Slurm has two nodes of one processor each on this host.
How to run a batch on a cluster: [Clusters](../guides/cluster.md).
"""


def measured(part: str, wanted: argparse.Namespace, scratch: pathlib.Path, with_dask: bool) -> tuple[str, bool]:
    """The text of one part, and whether all is well."""
    folder = scratch / part
    count = {"million": wanted.million, "pairs": wanted.paired, "runs": wanted.curves, "kills": 1000, "scaling": 20_000}[part]
    curves.write(folder, count, min(1000, count // 10), seed=wanted.seed)
    job = Job(wanted.palpate, folder)
    if part == "million":
        return runs.page(job, scratch, count, wanted.million_shards, (2,), with_dask)
    if part == "pairs":
        return pairs.page(job, scratch, count, wanted.paired_shards, wanted.rounds, with_dask)
    if part == "runs":
        return runs.page(job, scratch, count, wanted.shards, (1, 2), with_dask)
    if part == "kills":
        return kills.page(job, scratch, wanted.kills, wanted.seed, with_dask)
    return scaling.page(job, scratch, count, wanted.workers, wanted.empty_shards), True


def sections(text: str) -> dict[str, str]:
    """The sections of a page by their titles."""
    parts = text.split("\n## ")[1:]
    return {part.split("\n", 1)[0]: part.split("\n", 1)[1].strip("\n") for part in parts}


def page(found: dict[str, str]) -> str:
    return "\n".join([HEAD, *(f"## {title}\n\n{found[title]}\n" for title in PARTS.values() if title in found)])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--million", type=int, default=1_000_000, help="curves of the longest runs, on both processors")
    parser.add_argument("--million-shards", type=int, default=18, help="their shards; about a minute each is good")
    parser.add_argument("--paired", type=int, default=200_000, help="curves of the runs that take turns")
    parser.add_argument("--paired-shards", type=int, default=4, help="their shards")
    parser.add_argument("--rounds", type=int, default=5, help="how often each of them has its turn")
    parser.add_argument("--curves", type=int, default=90_000, help="curves of the runs on one processor and on two")
    parser.add_argument("--shards", type=int, default=2, help="their shards")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--workers", type=int, default=1000)
    parser.add_argument("--empty-shards", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--write", action="store_true")
    wanted = parser.parse_args()
    palpate = wanted.palpate.resolve()
    if palpate.name != "palpate":
        parser.error(f"expected the command under the name palpate, which recipes call, found {palpate.name}")
    if "SLURM_CONF" not in os.environ:
        slurm = pathlib.Path(__file__).with_name("slurm.sh")
        os.execv(slurm, [str(slurm), sys.executable, *sys.argv])
    wanted.palpate = palpate
    parts = wanted.only.split(",")
    if not set(parts) <= set(PARTS):
        parser.error(f"expected some of {', '.join(PARTS)}, found {wanted.only}")
    with_dask = importlib.util.find_spec("palpate") is not None and importlib.util.find_spec("palpate.dask") is not None
    shown = succeeded([str(palpate), "--version"])
    if with_dask and shown != succeeded([sys.executable, "-m", "palpate", "--version"]):
        parser.error("the command and the package palpate are of two builds, whose tables differ: take the command of the package's environment")
    version = shown.split("\n")[0]
    options = " ".join(argument for argument in sys.argv[2:] if argument != "--write")
    origin = f"`measure.py PALPATE {options}`: {version}, {platform.system()} {platform.release()}, {PROCESSORS} processors."
    left_out = "" if with_dask else " Without the parts on `palpate.dask`, which was not installed."
    found, well = sections(PAGE.read_text()) if wanted.write and PAGE.exists() else {}, True
    for part in parts:
        with tempfile.TemporaryDirectory(prefix="palpate-cluster-") as scratch:
            text, good = measured(part, wanted, pathlib.Path(scratch), with_dask)
        well &= good
        found[PARTS[part]] = f"{text.strip()}\n\n{origin}{left_out}"
        if wanted.write:
            PAGE.write_text(page(found))
    print(page(found))
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
