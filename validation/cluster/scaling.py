"""Where scaling ends: the serial parts of a job on a cluster, measured, and a simulation of 1,000 workers with empty shards.

Scheduler, workers and client are processes of their own; the workers are objects in one process and share its threads. An empty shard
writes three small files under temporary names and renames them, as a shard of palpate does, so all that a shard costs beside its analysis
is there.
"""

from __future__ import annotations

import argparse
import asyncio
import heapq
import json
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import dask
from distributed import Client, Worker

import curves as curves_of
from _cluster import Job, cpu_s, queued, succeeded, table, wait_for_slurm

# No timer of a worker but its heartbeat: a thousand of them are in one process.
QUIET = {
    "distributed.admin.system-monitor.interval": "1h",
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.memory.terminate": False,
    "distributed.comm.timeouts.connect": "300s",
}
IDLE_S = 5.0
THREADS = 16
FOLDERS = ("parameters", "failures", "table")


def empty_shard(out: str, number: int) -> int:
    """What a shard of no tests leaves: three files, each complete before it has its name."""
    for folder in FOLDERS:
        path = f"{out}/{folder}/{number}.parquet"
        with open(f"{path}.new", "wb") as file:
            file.write(b"PAR1" * 256)
            file.flush()
            os.fsync(file.fileno())
        os.rename(f"{path}.new", path)
    return number


def folders(out: pathlib.Path) -> pathlib.Path:
    for folder in FOLDERS:
        (out / folder).mkdir(parents=True)
    return out


async def _workers(address: str, count: int, note: pathlib.Path) -> None:
    # A thread for each worker would be a thousand threads, each of which asks for the interpreter 200 times a second while it waits.
    threads = ThreadPoolExecutor(THREADS)
    made = [
        Worker(address, nthreads=1, name=number, executor=threads, memory_limit=0, local_directory=str(note.parent), dashboard=False)
        for number in range(count)
    ]
    for at in range(0, count, 50):
        await asyncio.gather(*made[at : at + 50])
    note.write_text("")
    await asyncio.gather(*(one.finished() for one in made))


def simulated(scratch: pathlib.Path, workers: int, shards: int) -> dict[str, float]:
    """Empty shards by so many workers: seconds, and the processor time of each process."""
    base = scratch / f"simulated-{workers}"
    base.mkdir()
    file, note = base / "scheduler.json", base / "workers"
    # Both import the function from this file.
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)}
    scheduler = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "distributed.cli.dask_scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            "--scheduler-file",
            str(file),
        ],
        stdout=subprocess.DEVNULL,
        stderr=(base / "scheduler.txt").open("w"),
        env=environment,
    )
    crowd = None
    try:
        while not file.exists():
            time.sleep(0.05)
        address = json.loads(file.read_text())["address"]
        start = time.perf_counter()
        crowd = subprocess.Popen(
            [sys.executable, __file__, "--workers", str(workers), "--address", address, "--note", str(note)],
            stderr=(base / "workers.txt").open("w"),
            env=environment,
        )
        while not note.exists():
            if crowd.poll() is not None:
                raise SystemExit((base / "workers.txt").read_text()[-3000:])
            time.sleep(0.05)
        joined_s = time.perf_counter() - start
        out = folders(base / "out")
        with Client(address) as client:
            client.wait_for_workers(workers)
            # What heartbeats take, without a shard.
            idle = [cpu_s(scheduler.pid), cpu_s(crowd.pid)]
            time.sleep(IDLE_S)
            before = [cpu_s(scheduler.pid), cpu_s(crowd.pid), time.process_time()]
            idle = [(then - now) / IDLE_S for now, then in zip(idle, before, strict=False)]
            start = time.perf_counter()
            done = client.gather(client.map(empty_shard, [str(out)] * shards, range(shards), pure=False))
            wall_s = time.perf_counter() - start
            after = [cpu_s(scheduler.pid), cpu_s(crowd.pid), time.process_time()]
        assert sorted(done) == list(range(shards)), "a shard is missing"
        assert all(len(list((out / folder).iterdir())) == shards for folder in FOLDERS), "a file is missing or doubled"
        spent = [then - now for now, then in zip(before, after, strict=True)]
        return {
            "joined_s": joined_s,
            "wall_s": wall_s,
            "scheduler_s": spent[0],
            "workers_s": spent[1],
            "client_s": spent[2],
            "scheduler_idle": idle[0],
            "workers_idle": idle[1],
        }
    finally:
        for process in (scheduler, crowd):
            if process is not None:
                process.kill()
                process.wait()
        shutil.rmtree(base, ignore_errors=True)


def file_s(scratch: pathlib.Path, shards: int = 500) -> float:
    """Time of the three files of one shard."""
    out = folders(scratch / "files")
    start = time.perf_counter()
    for number in range(shards):
        empty_shard(str(out), number)
    took = time.perf_counter() - start
    shutil.rmtree(out)
    return took / shards


def slurm_s(jobs: int = 40) -> tuple[float, float]:
    """Time of a submission, and of a job of an array that does nothing, over both nodes."""
    start = time.perf_counter()
    for _ in range(jobs):
        succeeded(["sbatch", "--output=/dev/null", "--hold", "--wrap=true"])
    submission_s = (time.perf_counter() - start) / jobs
    succeeded(["scancel", "--state=PENDING", "--user", str(os.getuid())])
    wait_for_slurm()
    start = time.perf_counter()
    succeeded(["sbatch", "--output=/dev/null", f"--array=1-{jobs}", "--wrap=true"])
    while queued():
        time.sleep(0.02)
    return submission_s, (time.perf_counter() - start) / jobs


def _children_s() -> float:
    """Processor time of all commands that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def curve_s(job: Job, scratch: pathlib.Path, curves: int, shards: int = 4, rounds: int = 5) -> tuple[float, float, float]:
    """Processor time of a start of the command, and of the analysis and of the merge, per curve: the difference of a run and of another
    with a hundredth of the curves, which take turns, so that what a command costs once is not in it."""
    few = scratch / "few"
    curves_of.write(few, curves // 100, 10, seed=1)
    runs = [(job, scratch / "merged"), (Job(job.palpate, few), scratch / "merged-few")]

    def timed(*commands: list[str]) -> float:
        before = _children_s()
        for command in commands:
            succeeded(command)
        return _children_s() - before

    start_s = min(timed([str(job.palpate), "--version"]) for _ in range(rounds))
    analysed = [timed(*(one.shard(out, number, shards) for number in range(1, shards + 1))) for one, out in runs]
    merged = [min(times) for times in zip(*([timed(one.merge(out)) for one, out in runs] for _ in range(rounds)), strict=True)]
    more = curves - curves // 100
    return start_s, (analysed[0] - analysed[1]) / more, (merged[0] - merged[1]) / more


def efficiency(workers: int, shards: int, shard_s: float, serial_s: float, spread: float = 0.1, seed: int = 1) -> tuple[float, float]:
    """Time of a job, and its share that all workers are busy, by a discrete-event model: one scheduler hands out shards one after the other,
    and each takes its time, with a relative standard deviation `spread`, on a worker."""
    chance = random.Random(seed)
    free = [0.0] * workers
    scheduler = end = work = 0.0
    for _ in range(shards):
        scheduler = max(scheduler, heapq.heappop(free)) + serial_s
        lasts = shard_s * max(chance.gauss(1, spread), 0.1)
        heapq.heappush(free, scheduler + lasts)
        work += lasts
        end = max(end, scheduler + lasts)
    return end, work / (workers * end)


def page(job: Job, scratch: pathlib.Path, curves: int, most: int, shards: int) -> str:
    """The tables of this part, in Markdown."""
    rows: list[tuple[object, ...]] = []
    runs: dict[int, dict[str, float]] = {}
    for workers in sorted({10, 100, most}):
        one = runs[workers] = simulated(scratch, workers, shards)
        idle = (f"{100 * one[name]:.1f} %" for name in ("scheduler_idle", "workers_idle"))
        each = (f"{1e3 * one[f'{name}_s'] / shards:.2f}" for name in ("scheduler", "workers", "client"))
        rows.append((workers, f"{one['joined_s']:.1f}", f"{one['wall_s']:.1f}", *idle, *each))
        print(rows[-1], file=sys.stderr, flush=True)
    scheduler_s = max(one["scheduler_s"] for one in runs.values()) / shards
    client_s = max(one["client_s"] for one in runs.values()) / shards
    files_s = file_s(scratch)
    submission_s, job_s = slurm_s()
    start_s, analysis_s, merged_s = curve_s(job, scratch, curves)
    costs = [
        ("start of the command", f"{1e3 * start_s:.0f}", "once per shard, parallel"),
        ("analysis of a curve", f"{1e3 * analysis_s:.2f}", "parallel"),
        ("scheduler of Dask, per shard", f"{1e3 * scheduler_s:.2f}", "serial"),
        ("client of Dask, per shard", f"{1e3 * client_s:.2f}", "serial"),
        ("three files of a shard, written, synchronised, renamed", f"{1e3 * files_s:.2f}", "serial at worst"),
        ("submission to Slurm by `sbatch`, per call", f"{1e3 * submission_s:.1f}", "once per array"),
        ("job of an array that does nothing, two nodes", f"{1e3 * job_s:.0f}", "per job and node pair"),
        ("merge, per curve", f"{1e3 * merged_s:.4f}", "serial"),
    ]
    serial_s = max(scheduler_s, client_s, files_s)
    shard_s = 60.0
    per_shard = shard_s / analysis_s
    ends = []
    for workers in (1, 2, 10, 100, 1000, 10_000):
        # Ten shards a worker, of a minute, so that the work grows with the workers.
        count = 10 * workers
        lasts_s, busy = efficiency(workers, count, shard_s, serial_s)
        merge = count * per_shard * merged_s
        whole = busy * lasts_s / (lasts_s + merge)
        million = count * per_shard / 1e6
        ends.append((workers, count, f"{million:.1f}", f"{lasts_s:.0f}", f"{100 * busy:.1f} %", f"{merge:.0f}", f"{100 * whole:.1f} %"))
    return f"""{shards} empty shards by Dask; the workers are objects of one process, scheduler and client are processes of their own. *Idle*: the share of
a processor that {", ".join(map(str, runs))} workers take without a shard. The last columns are processor time per shard in ms, heartbeats
included. Every shard ran once and left its three files. The time of many workers is that of the one process they share here; on a cluster
only scheduler and client are shared.

{table(("workers", "time to join, s", "time of the shards, s", "scheduler, idle", "workers, idle", "scheduler", "all workers", "client"), rows)}

The constants of the model:

{table(("cost", "ms", "kind"), costs)}

A scheduler hands out shards one after the other, at most one per {1e3 * serial_s:.1f} ms, the largest of the serial costs per shard. It keeps
at most 60 s / {1e3 * serial_s:.1f} ms = {60 / serial_s:.0f} workers busy with shards of a minute. The discrete-event model, ten shards of 60 s
(± 10 %) for each worker, gives:

{table(("workers", "shards", "million curves", "time, s", "workers busy", "merge, s", "busy with the merge"), ends)}

Where it ends: a million curves are {1e6 * analysis_s / shard_s:.0f} shards of a minute, and no more workers than shards are of use. The merge is
one process, {1e6 * merged_s:.0f} s for a million curves, and takes as long as the analysis on {analysis_s / merged_s:.0f} workers; with more
workers it is the longest step. The scheduler comes after it, at {60 / serial_s:.0f} workers.
"""


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--workers", type=int, required=True)
    parser.add_argument("--address", required=True)
    parser.add_argument("--note", type=pathlib.Path, required=True)
    wanted = parser.parse_args()
    with dask.config.set(QUIET):
        asyncio.run(_workers(wanted.address, wanted.workers, wanted.note))
