"""What shards cost against the plain command, in runs that take turns, so that a machine whose speed changes does not decide.

    python validation/cluster/pairs.py PALPATE [--curves 200000] [--shards 4] [--rounds 5] [--turn 0] [--seed 1]

Each round runs the plain command with two threads, the shards by two processes at a time with their merge, and, where palpate.dask is
installed, a LocalCluster of two workers with the merge, in another order each time. Times are compared within a round. Nothing else may run.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import pathlib
import platform
import shutil
import statistics
import tempfile
from concurrent.futures import ThreadPoolExecutor

import curves
from _cluster import Cost, Job, Measured, same_bytes, succeeded, table
from runs import dask, plain

WORKERS = 2


def by_processes(job: Job, out: pathlib.Path, shards: int) -> Cost:
    """Shards by as many processes at a time as there are workers, and their merge."""
    with Measured(job.palpate) as cost:
        with ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(lambda number: succeeded(job.shard(out, number, shards)), range(1, shards + 1)))
        succeeded(job.merge(out))
    return cost


def by_dask(job: Job, out: pathlib.Path, shards: int) -> Cost:
    of_workers, of_client, _ = dask(job, out, shards, WORKERS)
    of_client.cpu_s += of_workers.cpu_s
    return of_client


def page(job: Job, scratch: pathlib.Path, count: int, shards: int, rounds: int, with_dask: bool, begin: int = 0) -> tuple[str, bool]:
    """The table of this part, in Markdown, and whether all merged tables are those of the plain command; the first round
    begins with this of the runs."""
    kinds = {"plain command, 2 threads": None, "shards, 2 processes at a time": by_processes, "LocalCluster, 2 workers": by_dask}
    if not with_dask:
        del kinds["LocalCluster, 2 workers"]
    found: dict[str, list[Cost]] = {name: [] for name in kinds}
    same = dict.fromkeys(kinds, 0)
    for turn in range(begin, begin + rounds):
        merged: dict[str, pathlib.Path] = {}
        names = list(kinds)
        for name in names[turn % len(names) :] + names[: turn % len(names)]:
            run = kinds[name]
            if run is None:
                found[name].append(plain(job, WORKERS))
                continue
            out = scratch / f"turn-{turn}-{names.index(name)}"
            found[name].append(run(job, out, shards))
            merged[name] = out.with_name(f"{out.name}.parquet")
            shutil.rmtree(out)
        for name, path in merged.items():
            same[name] += same_bytes(job.plain, path)
    first, *others = kinds
    median = lambda name, of: f"{statistics.median(of(cost) for cost in found[name]):.1f}"
    wall, cpu = (lambda cost: cost.wall_s), (lambda cost: cost.cpu_s)

    def ratio(name: str, of) -> str:
        ratios = sorted(100 * (of(one) / of(other) - 1) for one, other in zip(found[name], found[first], strict=True))
        return f"{statistics.median(ratios):+.1f} % ({ratios[0]:+.1f} to {ratios[-1]:+.1f})"

    rows: list[tuple[object, ...]] = [(first, median(first, wall), median(first, cpu), "", "", "")]
    rows += [
        (name, median(name, wall), median(name, cpu), ratio(name, wall), ratio(name, cpu), f"{same[name]} of {rounds}") for name in others
    ]
    head = ("run", "time, s", "processor time, s", "time against plain", "processor time against plain", "same bytes")
    spread = sorted(cost.cpu_s for cost in found[first])
    text = f"""{rounds} rounds of {count} curves of 256 samples in {shards} shards of about {spread[0] / shards:.0f} s of processor time; the three runs of a round take turns. Medians, and
the least and the most of the rounds. The time ends with the merged table, and has the start of processes in it. The plain command alone
took {spread[0]:.1f} to {spread[-1]:.1f} s of processor time for the same work.

{table(head, rows)}
"""
    return text, all(same[name] == rounds for name in others)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--curves", type=int, default=200_000)
    parser.add_argument("--shards", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--turn", type=int, default=0, help="which of the three runs begins")
    parser.add_argument("--seed", type=int, default=1)
    wanted = parser.parse_args()
    with_dask = importlib.util.find_spec("distributed") is not None
    with tempfile.TemporaryDirectory(prefix="palpate-pairs-") as scratch:
        folder = pathlib.Path(scratch) / "records-of-all"
        curves.write(folder, wanted.curves, 1000, seed=wanted.seed)
        text, well = page(Job(wanted.palpate.resolve(), folder), pathlib.Path(scratch), wanted.curves, wanted.shards, wanted.rounds, with_dask, wanted.turn)
    print(text)
    print(f"{platform.system()} {platform.release()}, {len(os.sched_getaffinity(0))} of {os.cpu_count()} processors")
    raise SystemExit(0 if well else 1)


if __name__ == "__main__":
    main()
