"""Shards, merges, jobs and nodes of Slurm and processes of Dask killed at random times: what the next run makes of what they left.

Each kill is SIGKILL. Half of those of shards and merges come at any time, half while a temporary file is there. After some kills all is
run again to the end, and the merged table is compared with that of the plain command.
"""

from __future__ import annotations

import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from _cluster import Job, lost_and_doubled, queued, run, same_bytes, succeeded, table, wait_for_slurm

SHARDS = 4
TEMPORARY = ".palpate-"
# The share of each kind among all kills.
SHARES = {
    "a shard": 0.35,
    "a merge": 0.15,
    "a job of Slurm, by SIGKILL": 0.1,
    "a job of Slurm, by a requeue": 0.1,
    "a node of Slurm": 0.05,
    "a worker of Dask": 0.1,
    "the client of Dask": 0.1,
    "the scheduler of Dask": 0.05,
}


@dataclass
class Count:
    kills: int = 0
    # Those that met a process with work done and not yet ended.
    writing: int = 0
    compared: int = 0
    differ: int = 0
    lost: int = 0
    doubled: int = 0


class Kills:
    def __init__(self, job: Job, scratch: pathlib.Path, seed: int) -> None:
        self.job, self.scratch, self.chance = job, scratch, random.Random(seed)
        self.rounds = 0
        # Daemons that stand in for killed ones.
        self.daemons: list[subprocess.Popen[bytes]] = []
        self.counts = {name: Count() for name in SHARES}
        succeeded(job.batch("--out", str(job.plain)))
        self.shard_s = self._lasts(job.shard(self.fresh(), 1, SHARDS))

    def fresh(self) -> pathlib.Path:
        """A folder for shards that is not there."""
        self.rounds += 1
        return self.scratch / f"round-{self.rounds}"

    def _lasts(self, command: list[str]) -> float:
        start = time.perf_counter()
        succeeded(command)
        return time.perf_counter() - start

    def compare(self, name: str, out: pathlib.Path) -> None:
        """The merged table against the plain one; the shards are removed."""
        count, merged = self.counts[name], out.with_name(f"{out.name}.parquet")
        lost, doubled = lost_and_doubled(self.job.plain, merged)
        left = [path for path in (*out.rglob(f"{TEMPORARY}*"), *out.parent.glob(f"{TEMPORARY}*"))]
        count.compared += 1
        count.differ += not same_bytes(self.job.plain, merged)
        count.lost += lost
        count.doubled += doubled
        if left:
            print(f"{name}: temporary files left: {left[:3]}", file=sys.stderr)
        shutil.rmtree(out)
        merged.unlink()

    def killed(self, name: str, command: list[str], folder: pathlib.Path, lasts_s: float) -> bool:
        """Starts a command and kills it; whether it had not ended."""
        aimed = self.chance.random() < 0.5
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if aimed:
            while process.poll() is None and not _temporary(folder):
                pass
            time.sleep(self.chance.uniform(0, 2e-3))
        else:
            time.sleep(self.chance.uniform(0, lasts_s))
        writing = _temporary(folder)
        process.kill()
        met = process.wait() == -signal.SIGKILL
        self.counts[name].kills += met
        self.counts[name].writing += met and writing
        return met

    def shards(self, name: str, kills: int) -> None:
        while self.counts[name].kills < kills:
            out = self.fresh()
            for number in range(1, SHARDS + 1):
                command = self.job.shard(out, number, SHARDS)
                for _ in range(3):
                    if self.counts[name].kills < kills:
                        self.killed(name, command, out, self.shard_s)
                succeeded(command)
            succeeded(self.job.merge(out))
            self.compare(name, out)

    def merges(self, name: str, kills: int) -> None:
        whole = self.fresh()
        for number in range(1, SHARDS + 1):
            succeeded(self.job.shard(whole, number, SHARDS))
        lasts_s = self._lasts(self.job.merge(whole))
        while self.counts[name].kills < kills:
            out = self.fresh()
            shutil.copytree(whole, out)
            merged = out.with_name(f"{out.name}.parquet")
            # Another table stands there in every second round; a kill leaves it or the new one whole.
            old = self.job.plain.with_name("plain_parameters.parquet").read_bytes()
            if self.rounds % 2:
                merged.write_bytes(old)
            self.killed(name, self.job.merge(out), out.parent, lasts_s)
            if merged.exists() and merged.read_bytes() not in (old, self.job.plain.read_bytes()):
                self.counts[name].differ += 1
            succeeded(self.job.merge(out))
            self.compare(name, out)

    def slurm(self, name: str, kills: int, kill: Callable[[str], bool]) -> None:
        while self.counts[name].kills < kills:
            out = self.fresh()
            self._submit(out)
            for _ in range(self.chance.randint(1, 3)):
                if self.counts[name].kills == kills:
                    break
                while not (running := queued("--states=RUNNING", "--name=palpate")) and queued():
                    time.sleep(0.05)
                time.sleep(self.chance.uniform(0, self.shard_s))
                if running:
                    self.counts[name].kills += kill(self.chance.choice(running))
            wait_for_slurm()
            if not out.with_name(f"{out.name}.parquet").exists():
                # The merge has found a shard missing.
                self._submit(out)
                wait_for_slurm()
            self.compare(name, out)

    def node(self, job: str) -> bool:
        """Kills the node that a job runs on, all processes at once as a loss of power does, and starts it again after a while."""
        node = run(["squeue", "--noheader", "--format=%N %A", f"--jobs={job}"]).stdout.split()
        if len(node) != 2:
            return False
        conf = pathlib.Path(os.environ["SLURM_CONF"])
        daemon = int((conf.parent / f"slurmd-{node[0]}.pid").read_text())
        steps = run(["pgrep", "--full", rf"^slurmstepd: \[{node[1]}\."]).stdout.split()
        pids = [daemon, *(pid for step in steps for pid in _descendants(int(step)))]
        for pid in pids:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
        time.sleep(self.chance.uniform(2, 4))
        log = (conf.parent / f"{node[0]}.out").open("ab")
        self.daemons.append(subprocess.Popen(["slurmd", "-D", "-c", "-N", node[0]], stdout=log, stderr=log))
        return bool(steps)

    def _submit(self, out: pathlib.Path) -> None:
        succeeded(self.job.submit(out, SHARDS), cwd=self.scratch, env=self.job.environment())

    def dask(self, name: str, kills: int) -> None:
        while self.counts[name].kills < kills:
            out = self.fresh()
            with _dask(self.scratch) as (scheduler, file):
                client = self._client(out, file)
                note = out.with_name(f"{out.name}.json")
                while not note.exists() and client.poll() is None:
                    time.sleep(0.02)
                workers = json.loads(note.read_text())["workers"]
                time.sleep(self.chance.uniform(0, SHARDS * self.shard_s / len(workers)))
                pids = {
                    "a worker of Dask": self.chance.choice(workers),
                    "the client of Dask": client.pid,
                    "the scheduler of Dask": scheduler.pid,
                }
                if client.poll() is None:
                    subprocess.run(["kill", "-KILL", str(pids[name])], check=True)
                    self.counts[name].kills += 1
                if name == "the client of Dask":
                    # The workers still run its shards when the next one comes.
                    client.wait()
                    note.unlink()
                    client = self._client(out, file)
                code = client.wait(300) if name != "the scheduler of Dask" else None
                client.kill()
                client.wait()
            if name == "the scheduler of Dask":
                with _dask(self.scratch) as (_, file):
                    code = self._client(out, file).wait(300)
            if code:
                print(f"{name}: the client ended with {code}: {out.with_name(f'{out.name}.txt').read_text()[-2000:]}", file=sys.stderr)
                self.counts[name].differ += 1
                continue
            self.compare(name, out)

    def _client(self, out: pathlib.Path, file: pathlib.Path) -> subprocess.Popen[bytes]:
        script = pathlib.Path(__file__).with_name("dask_job.py")
        log = out.with_name(f"{out.name}.txt").open("w")
        command = [
            sys.executable,
            str(script),
            str(self.job.folder),
            str(out),
            str(SHARDS),
            "--workers",
            "2",
            "--scheduler-file",
            str(file),
        ]
        return subprocess.Popen(command, stdout=log, stderr=log)


def _descendants(pid: int) -> list[int]:
    """A process and all below it."""
    children = run(["pgrep", "--parent", str(pid)]).stdout.split()
    return [pid, *(below for child in children for below in _descendants(int(child)))]


def _temporary(folder: pathlib.Path) -> bool:
    """Whether a temporary file is in a folder or in one of its own."""
    for place in (folder, folder / "table", folder / "parameters", folder / "failures", folder / "shards"):
        try:
            if any(path.name.startswith(TEMPORARY) for path in place.iterdir()):
                return True
        except OSError:
            continue
    return False


@contextmanager
def _dask(scratch: pathlib.Path) -> Iterator[tuple[subprocess.Popen[bytes], pathlib.Path]]:
    """A scheduler and two workers as processes of their own; all are killed at the end."""
    file = scratch / f"scheduler-{time.monotonic_ns()}.json"
    log = file.with_suffix(".txt").open("w")
    begin = lambda *words: subprocess.Popen(
        [sys.executable, "-m", "distributed.cli." + words[0], *words[1:], "--scheduler-file", str(file)],
        stdout=log,
        stderr=log,
        start_new_session=True,
    )
    scheduler = begin("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    while not file.exists():
        time.sleep(0.05)
    workers = begin("dask_worker", "--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--local-directory", str(scratch))
    try:
        yield scheduler, file
    finally:
        for process in (scheduler, workers):
            # With the workers that the nannies have started.
            subprocess.run(["kill", "-KILL", "--", f"-{process.pid}"], stderr=subprocess.DEVNULL, check=False)
            process.wait()


def page(job: Job, scratch: pathlib.Path, kills: int, seed: int, with_dask: bool) -> tuple[str, bool]:
    """The table of this part, in Markdown, and whether nothing was lost, doubled or different."""
    test = Kills(job, scratch, seed)
    parts: dict[str, Callable[[str, int], None]] = {
        "a shard": test.shards,
        "a merge": test.merges,
        "a job of Slurm, by SIGKILL": lambda name, count: test.slurm(
            name, count, lambda job: run(["scancel", "--signal=KILL", "--full", job]).returncode == 0
        ),
        "a job of Slurm, by a requeue": lambda name, count: test.slurm(
            name, count, lambda job: run(["scontrol", "requeue", job]).returncode == 0
        ),
        "a node of Slurm": lambda name, count: test.slurm(name, count, test.node),
        **({name: test.dask for name in SHARES if "Dask" in name} if with_dask else {}),
    }
    rows: list[tuple[object, ...]] = []
    for name, part in parts.items():
        try:
            part(name, round(kills * SHARES[name]))
        finally:
            while test.daemons:
                test.daemons.pop().terminate()
        one = test.counts[name]
        rows.append((name, one.kills, one.writing or "", one.compared, one.differ, one.lost, one.doubled))
        print(rows[-1], file=sys.stderr, flush=True)
    of = lambda at: sum(row[at] or 0 for row in rows)  # type: ignore[misc]
    rows.append(("**all**", of(1), "", of(3), of(4), of(5), of(6)))
    head = ("killed", "kills", "while writing", "tables compared", "other bytes", "rows lost", "rows doubled")
    text = f"""{SHARDS} shards of about {test.shard_s:.1f} s, seed {seed}. Every kill is SIGKILL at a random time. *While writing*: a temporary file was there at that moment.

{table(head, rows)}
"""
    return text, not any(of(at) for at in (4, 5, 6))
