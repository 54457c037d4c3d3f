"""The measurements of docs/validation/cluster.md, with one command; as root, for Slurm:

    python validation/cluster/measure.py PALPATE [--curves 1000000] [--shards N] [--kills 100] [--workers 1000] [--only runs,kills,scaling]
        [--seed 1] [--write]

PALPATE is the command, called `palpate`. Python needs `validation/cluster/requirements.txt`, and the package palpate for the parts on
Dask, which are left out without it. The table is printed; with --write it goes to docs/validation/cluster.md. Exit code 1 if a row was
lost or doubled, or a byte differs. A Slurm of two nodes runs on this host meanwhile (`slurm.sh`).
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
import runs
import scaling
from _cluster import PROCESSORS, ROOT, Job, succeeded

PAGE = ROOT / "docs" / "validation" / "cluster.md"
PARTS = ("runs", "kills", "scaling")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--curves", type=int, default=1_000_000)
    parser.add_argument("--shards", type=int, default=40, help="shards of the runs; about a minute each is good")
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
    parts = wanted.only.split(",")
    if not set(parts) <= set(PARTS):
        parser.error(f"expected some of {', '.join(PARTS)}, found {wanted.only}")
    with_dask = importlib.util.find_spec("palpate") is not None and importlib.util.find_spec("palpate.dask") is not None
    texts, well = [], True
    with tempfile.TemporaryDirectory(prefix="palpate-cluster-") as name:
        scratch = pathlib.Path(name)
        if "runs" in parts:
            curves.write(scratch / "runs", wanted.curves, 1000, seed=wanted.seed)
            text, good = runs.page(Job(palpate, scratch / "runs"), scratch, wanted.curves, wanted.shards, with_dask)
            texts.append(text)
            well &= good
        if "kills" in parts or "scaling" in parts:
            curves.write(scratch / "few", 1000, 100, seed=wanted.seed)
        if "kills" in parts:
            text, good = kills.page(Job(palpate, scratch / "few"), scratch, wanted.kills, wanted.seed, with_dask)
            texts.append(text)
            well &= good
        if "scaling" in parts:
            texts.append(scaling.page(Job(palpate, scratch / "few"), scratch, 1000, wanted.workers, wanted.empty_shards))
    version = succeeded([str(palpate), "--version"]).split("\n")[0]
    left_out = "" if with_dask else "The parts on `palpate.dask` were left out: the package was not installed.\n\n"
    command = " ".join(argument for argument in sys.argv[1:] if argument != "--write").replace(str(wanted.palpate), "PALPATE")
    text = f"""# Clusters

Written by `python validation/cluster/measure.py {command} --write`: {version}, {platform.system()} {platform.release()},
{PROCESSORS} processors; Slurm has two nodes of one processor each on this host. How to run a batch on a cluster:
[Clusters](../guides/cluster.md).

{left_out}{chr(10).join(texts)}"""
    print(text)
    if wanted.write:
        PAGE.write_text(text)
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
