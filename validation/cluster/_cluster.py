"""What the measurements of clusters share: processes with their cost, the queue of Slurm, and rows compared by DuckDB."""

from __future__ import annotations

import filecmp
import os
import pathlib
import subprocess
import threading
import time
from dataclasses import dataclass, field

import duckdb

ROOT = pathlib.Path(__file__).resolve().parents[2]
RECIPES = ROOT / "examples" / "cluster"
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
PROCESSORS = os.cpu_count() or 1


@dataclass
class Job:
    """Curves to be analysed, the command, and the table that the command makes of them at once."""

    palpate: pathlib.Path
    folder: pathlib.Path
    plain: pathlib.Path = field(init=False)

    def __post_init__(self) -> None:
        self.plain = self.folder / "plain.parquet"

    def batch(self, *options: str) -> list[str]:
        return [str(self.palpate), "batch", str(self.folder / "records"), "--test", str(self.folder / "test.toml"), *options]

    def shard(self, out: pathlib.Path, number: int, of: int) -> list[str]:
        return self.batch("--out", str(out), "--shard", f"{number}/{of}", "--threads", "1")

    def merge(self, out: pathlib.Path) -> list[str]:
        return [str(self.palpate), "merge", str(out), "--out", f"{out}.parquet"]

    def submit(self, out: pathlib.Path, of: int) -> list[str]:
        """The recipe of the guide: an array of shards and a merge after it."""
        return [str(RECIPES / "submit.sh"), str(of), str(self.folder / "records"), str(self.folder / "test.toml"), str(out)]

    def environment(self) -> dict[str, str]:
        """That of a recipe, which calls the command by its name."""
        return {**os.environ, "PATH": f"{self.palpate.parent}{os.pathsep}{os.environ['PATH']}"}


@dataclass
class Cost:
    """What some processes took: time, processor time, the most memory of one of them, and what others took meanwhile."""

    wall_s: float = 0.0
    cpu_s: float = 0.0
    peak_bytes: int = 0
    # Processor time of all other processes as a share of that of the machine.
    others: float = 0.0


class Measured:
    """Measures the processes that run one command, or those of `pids`, while its block runs."""

    def __init__(self, executable: pathlib.Path | None = None, pids: list[int] | None = None) -> None:
        self.executable = executable and executable.resolve()
        self.pids = pids
        self.cost = Cost()
        self._found: dict[int, tuple[float, int]] = {}
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._watch)

    def __enter__(self) -> Cost:
        self._before, self._start = _busy_s(), time.perf_counter()
        self._thread.start()
        return self.cost

    def __exit__(self, *_: object) -> None:
        self._done.set()
        self._thread.join()
        self.cost.wall_s = time.perf_counter() - self._start
        self.cost.cpu_s = sum(cpu for cpu, _ in self._found.values())
        self.cost.peak_bytes = max((peak for _, peak in self._found.values()), default=0)
        self.cost.others = max(_busy_s() - self._before - self.cost.cpu_s, 0) / (self.cost.wall_s * PROCESSORS)

    def _watch(self) -> None:
        while True:
            for pid in self.pids or _pids_of(self.executable):
                try:
                    cpu, peak = _cpu_and_peak(pid)
                    self._found[pid] = cpu, max(peak, self._found.get(pid, (0.0, 0))[1])
                except (OSError, ValueError, IndexError):
                    # It has ended: what was read last stands.
                    continue
            if self._done.wait(0.1):
                return


def _pids_of(executable: pathlib.Path | None) -> list[int]:
    found = []
    for entry in os.scandir("/proc"):
        if entry.name.isdecimal():
            try:
                # The command of the Python package is a script, which its interpreter runs.
                words = pathlib.Path(f"/proc/{entry.name}/cmdline").read_bytes().split(b"\0")[:2]
                if os.readlink(f"/proc/{entry.name}/exe") == str(executable) or str(executable).encode() in words:
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


def _cpu_and_peak(pid: int) -> tuple[float, int]:
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    # One that has just ended has none.
    peak = max((int(line.split()[1]) * 1024 for line in status.splitlines() if line.startswith("VmHWM")), default=0)
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S, peak


def cpu_s(pid: int) -> float:
    """Processor time of one process."""
    return _cpu_and_peak(pid)[0]


def _busy_s() -> float:
    """Processor time that all processes have had since the machine started."""
    user, nice, system, _idle, _wait, irq, soft, *_ = map(int, pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:])
    return (user + nice + system + irq + soft) / TICKS_PER_S


def run(command: list[str], **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)  # type: ignore[call-overload]


def succeeded(command: list[str], **options: object) -> str:
    """What a command prints; one that fails ends the measurement."""
    done = run(command, **options)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def queued(*options: str) -> list[str]:
    """Jobs of Slurm that have not ended, each task of an array by its own number."""
    return succeeded(["squeue", "--noheader", "--array", "--format=%A", *options]).split()


def wait_for_slurm(limit_s: float = 3600) -> None:
    end = time.monotonic() + limit_s
    while queued():
        if time.monotonic() > end:
            raise SystemExit(f"expected an empty queue after {limit_s:.0f} s, found:\n{succeeded(['squeue'])}")
        time.sleep(0.1)


def same_bytes(plain: pathlib.Path, merged: pathlib.Path) -> bool:
    """Whether both tables of a batch are the same, byte for byte."""
    beside = [path.with_name(f"{path.stem}_parameters.parquet") for path in (plain, merged)]
    return all(path.exists() for path in (merged, *beside)) and filecmp.cmp(plain, merged, False) and filecmp.cmp(*beside, False)


def lost_and_doubled(plain: pathlib.Path, merged: pathlib.Path) -> tuple[int, int]:
    """Rows of the plain table that the other lacks, and rows of the other that the plain one lacks, counted with their number."""
    read = lambda path: f"from read_parquet('{path}')"
    count = lambda one, other: duckdb.sql(f"select count(*) from ({read(one)} except all {read(other)})").fetchall()[0][0]
    return count(plain, merged), count(merged, plain)


def table(head: tuple[str, ...], rows: list[tuple[object, ...]]) -> str:
    """A table in Markdown: the first column at the left, numbers at the right."""
    line = lambda cells: "| " + " | ".join(map(str, cells)) + " |"
    return "\n".join([line(head), "|---|" + "--:|" * (len(head) - 1), *map(line, rows)])
