"""The recipes of docs/guides/cluster.md: the guide shows the files, and each that can run here makes the bytes of the plain command.

    python validation/cluster/recipes.py PALPATE [--curves 600] [--shards 4]

As root, for Slurm (`slurm.sh`). Those of Slurm and Snakemake run always, those of Dask with the package palpate installed; HyperQueue and
Nextflow run where `hq` and `nextflow` are installed. Exit code 1 if a recipe fails.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator

import curves
from _cluster import RECIPES, ROOT, Job, run, same_bytes, succeeded, wait_for_slurm

GUIDE = ROOT / "docs" / "guides" / "cluster.md"


def not_shown() -> list[str]:
    """Files of recipes that the guide does not contain as they are."""
    guide = GUIDE.read_text()
    return [path.name for path in sorted(RECIPES.iterdir()) if path.is_file() and f"\n{path.read_text().rstrip()}\n```" not in guide]


def recipes(job: Job, shards: int, scratch: pathlib.Path) -> Iterator[tuple[str, pathlib.Path, list[list[str]]]]:
    """Name, table and commands of every recipe that can run here."""
    words = [str(shards), str(job.folder / "records"), str(job.folder / "test.toml")]
    yield "Slurm array", scratch / "array.parquet", [[str(RECIPES / "submit.sh"), *words, "array"]]
    snakemake = [sys.executable, "-m", "snakemake", "--quiet", "--cores", "2", "--snakefile", str(RECIPES / "Snakefile"), "--config"]
    yield "Snakemake", scratch / "snake.parquet", [[*snakemake, f"shards={shards}", f"records={words[1]}", f"test={words[2]}", "out=snake"]]
    if shutil.which("hq"):
        yield "HyperQueue", scratch / "hq.parquet", [[str(RECIPES / "hyperqueue.sh"), *words, "hq"]]
    if shutil.which("nextflow"):
        # Its names of records are those of the folder of a task.
        nextflow = ["nextflow", "run", str(RECIPES / "main.nf"), "--shards", words[0], "--records", words[1], "--test", words[2]]
        plain = [str(job.palpate), "batch", "records", "--test", words[2], "--out", str(job.plain)]
        yield "Nextflow", scratch / "table.parquet", [nextflow, ["ln", "-s", words[1], "records"], plain]
    if importlib.util.find_spec("palpate") and importlib.util.find_spec("palpate.dask"):
        yield "Dask, SLURMCluster", scratch / "cluster.parquet", [[sys.executable, str(RECIPES / "slurm_cluster.py"), *words, "cluster"]]
        # Scheduler, client and two workers share two processors.
        runner = ["srun", "--ntasks=4", "--nodes=2", "--overcommit", sys.executable, str(RECIPES / "slurm_runner.py"), *words, "runner"]
        yield "Dask, SLURMRunner", scratch / "runner.parquet", [runner]


def snakemake_killed(job: Job, shards: int, scratch: pathlib.Path) -> pathlib.Path:
    """Snakemake killed after its first shard, and run again as the guide says."""
    [command] = next(commands for name, _, commands in recipes(job, shards, scratch) if name == "Snakemake")
    command = [*command[:-1], "out=killed"]
    process = subprocess.Popen(
        command, cwd=scratch, env=job.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    while process.poll() is None and not list(scratch.glob("killed/table/*-of-*.parquet")):
        time.sleep(0.02)
    os.killpg(process.pid, 9)
    process.wait()
    at = command.index("--config")
    succeeded([*command[:at], "--unlock", *command[at:]], cwd=scratch, env=job.environment())
    succeeded([*command[:at], "--rerun-incomplete", *command[at:]], cwd=scratch, env=job.environment())
    return scratch / "killed.parquet"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--curves", type=int, default=600)
    parser.add_argument("--shards", type=int, default=4)
    wanted = parser.parse_args()
    if "SLURM_CONF" not in os.environ:
        slurm = pathlib.Path(__file__).with_name("slurm.sh")
        os.execv(slurm, [str(slurm), sys.executable, *sys.argv])
    failed = [f"{name}: docs/guides/cluster.md does not show the file as it is" for name in not_shown()]
    with tempfile.TemporaryDirectory(prefix="palpate-recipes-") as name:
        scratch = pathlib.Path(name)
        curves.write(scratch / "in", wanted.curves, 100)
        job = Job(wanted.palpate.resolve(), scratch / "in")
        succeeded(job.batch("--out", str(job.plain)))

        def check(name: str, table: pathlib.Path, said: str) -> None:
            good = same_bytes(job.plain, table)
            print(f"{name}: {'the bytes of the plain command' if good else 'FAILED'}", flush=True)
            if not good:
                logs = "".join(path.read_text() for path in scratch.glob("slurm-*.txt"))
                failed.append(
                    f"{name}: expected the bytes of the plain command, found {'others' if table.exists() else 'no table'}\n{said}{logs}"
                )

        for title, table, commands in recipes(job, wanted.shards, scratch):
            said = ""
            for command in commands:
                done = run(command, cwd=scratch, env=job.environment())
                said += done.stdout + done.stderr
            wait_for_slurm()
            check(title, table, said)
        check("Snakemake, killed and run again", snakemake_killed(job, wanted.shards, scratch), "")
    print("\n".join(failed), file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
