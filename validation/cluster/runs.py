"""One batch by the plain command, as a Slurm array and through Dask: time, memory, bytes."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

from _cluster import Cost, Job, Measured, lost_and_doubled, same_bytes, succeeded, table, wait_for_slurm

MIB = 1 << 20


def plain(job: Job, threads: int) -> Cost:
    """The plain command, from the beginning."""
    for left in (job.plain, job.plain.with_name("plain_parameters.parquet")):
        left.unlink(missing_ok=True)
    shutil.rmtree(f"{job.plain}.journal", ignore_errors=True)
    with Measured(job.palpate) as cost:
        succeeded(job.batch("--out", str(job.plain), "--threads", str(threads)))
    return cost


def slurm(job: Job, out: pathlib.Path, shards: int) -> Cost:
    """The recipe of the guide: an array and its merge."""
    with Measured(job.palpate) as cost:
        succeeded(job.submit(out, shards), cwd=out.parent, env=job.environment())
        wait_for_slurm()
    return cost


def dask(job: Job, out: pathlib.Path, shards: int, workers: int) -> tuple[Cost, Cost, float]:
    """A LocalCluster: the cost of its workers and of its client, whose time ends with the merged table, and the time until workers are there."""
    script = pathlib.Path(__file__).with_name("dask_job.py")
    command = [sys.executable, str(script), str(job.folder), str(out), str(shards), "--workers", str(workers)]
    start = time.perf_counter()
    client = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    note = out.with_name(f"{out.name}.json")
    with Measured(pids=[client.pid]) as of_client:
        while not note.exists() and client.poll() is None:
            time.sleep(0.05)
        start_s = time.perf_counter() - start
        pids = json.loads(note.read_text())["workers"] if note.exists() else [os.getpid()]
        with Measured(pids=pids) as of_workers:
            _, said = client.communicate()
    if client.returncode:
        raise SystemExit(f"{' '.join(command)} ended with {client.returncode}:\n{said}")
    return of_workers, of_client, start_s


def page(
    job: Job, scratch: pathlib.Path, curves: int, shards: int, workers: tuple[int, ...], with_dask: bool
) -> tuple[str, bool]:
    """The tables of this part, in Markdown, and whether all merged tables are those of the plain command; Dask has so many workers each time."""
    rows: list[tuple[object, ...]] = []
    memory: list[tuple[object, ...]] = []
    alone = {threads: plain(job, threads) for threads in workers}
    two = alone[2]
    well = True

    def row(name: str, against: Cost | None, cost: Cost, out: pathlib.Path | None, cpu_s: float) -> None:
        nonlocal well
        shown = ["", "", ""]
        if out is not None:
            merged = out.with_name(f"{out.name}.parquet")
            lost, doubled = lost_and_doubled(job.plain, merged)
            same = same_bytes(job.plain, merged)
            shown = ["yes" if same else "**no**", lost, doubled]
            well &= same
        more = lambda now, then: f"{100 * (now / then - 1):+.1f} %"
        overhead = ["", ""] if against is None else [more(cost.wall_s, against.wall_s), more(cpu_s, against.cpu_s)]
        rows.append((name, f"{cost.wall_s:.1f}", f"{cpu_s:.1f}", *overhead, f"{100 * cost.others:.0f} %", *shown))
        print(rows[-1], file=sys.stderr, flush=True)

    for threads, cost in alone.items():
        row(f"plain command, {threads} thread{'s' * (threads > 1)}", None, cost, None, cost.cpu_s)
    memory.append(("plain command, 2 threads", f"{two.peak_bytes / MIB:.0f}", "", ""))
    out = scratch / "slurm"
    cost = slurm(job, out, shards)
    row(f"Slurm, 2 nodes, {shards} shards", two, cost, out, cost.cpu_s)
    memory.append(("Slurm, a job", f"{cost.peak_bytes / MIB:.0f}", "", ""))
    for count, against in alone.items() if with_dask else ():
        out = scratch / f"dask-{count}"
        of_workers, of_client, start_s = dask(job, out, shards, count)
        # The time of the client, which began first.
        of_client.others = max(of_client.others - of_workers.cpu_s / of_client.wall_s / (os.cpu_count() or 1), 0)
        row(
            f"LocalCluster, {count} worker{'s' * (count > 1)}, {shards} shards",
            against,
            of_client,
            out,
            of_client.cpu_s + of_workers.cpu_s,
        )
        memory.append(
            (
                f"LocalCluster, {count} worker{'s' * (count > 1)}",
                f"{of_workers.peak_bytes / MIB:.0f}",
                f"{of_client.peak_bytes / MIB:.0f}",
                f"{start_s:.1f}",
            )
        )
    head = (
        "run",
        "time, s",
        "processor time, s",
        "time against plain",
        "processor time against plain",
        "others' load",
        "same bytes",
        "rows lost",
        "rows doubled",
    )
    text = f"""{curves} curves of 256 samples, {shards} shards of about {two.cpu_s / shards:.0f} s of processor time. The time ends with the merged table. Slurm with two
nodes and two workers stand against two threads of the plain command{', one worker against one thread' * (1 in workers)}. *Others' load* is the share of both
processors that processes outside the measurement took meanwhile; where it is large, times say little. Rows are compared with those of the plain table by DuckDB.

{table(head, rows)}

The largest resident memory of one process, and the part of the time that Dask takes to start, whatever the size of the batch:

{table(("run", "command or worker, MiB", "client, MiB", "start of client and workers, s"), memory)}
"""
    return text, well
