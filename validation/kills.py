"""Kills of long jobs: files stay whole, and the same command ends the work with the same bytes.

    python validation/kills.py PALPATE [--kills 1000] [--seed 1] [--write]

PALPATE is the command. `batch`, `sweep` and `analyze --out` run over simulated records, where nothing was before, over the result of an
earlier run, and over an interrupted run. Each run is killed (SIGKILL): two of five at any time, the others while they write, from the
moment on at which a temporary file is seen, or an output that is new. After each kill every output has to be absent or whole, old or new;
after the same command has run again, the folder has to have the files and the bytes of an undisturbed run, and no temporary file. With
--write the table goes to docs/validation/kills.md. Exit code 1 if a kill did harm. The inputs are made so large that a run takes 0.3 s.
"""

import argparse
import hashlib
import math
import os
import pathlib
import platform
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "kills.md"
TEMPORARY = ".palpate-"
# The names that an analysis wrote, for the next one; no temporary file.
MANIFEST = ".palpate-files"
# A run shorter than this ends before most kills; one much longer takes time only.
SHORTEST_S = 0.3
# What a kill aims at, with its share.
AIMS = {"any time": 0.4, "temporary file": 0.3, "new output": 0.3}

BODY = """[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
"""

SWEEP = """title = "Squeeze"
{body}
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"

[contact]
layers = 8

[[step]]
to = "10 mm"
rate = "500 mm/min"
hold = "10 s"

[output]
sample_rate = "20 Hz"

[sweep]
law.rate_coefficient = "log 1e3..{most} /s, 24"
step.1.rate = "log 5..5000 mm/min, {count}"
"""


def record(path, seed, holds=2, samples=400):
    """A simulated record: presses, each held; its noise is that of `seed`."""
    noise = random.Random(seed)
    exponent, period = 3 + noise.random() * 3, 20.0
    lines = ["time_s,displacement_mm,force_n"]
    for index in range(holds * samples):
        time_s = index * period / samples
        held, press = time_s % period, time_s // period
        depth = 3 * (press + min(held, 1.0))
        elapsed = max(held - 1.0, 0.0)
        force = 0.4 * depth * (0.6 + 0.4 * (1 + 2 * elapsed) ** (-1 / (exponent - 1)))
        lines.append(f"{time_s:.4f},{depth + noise.gauss(0, 1e-3):.6f},{force + noise.gauss(0, 5e-3):.6f}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


@dataclass
class Job:
    """A command in a folder with its inputs, what it writes, and what an earlier run may have left there."""

    name: str
    arguments: list
    prepare: object  # (folder, size, old): writes the inputs of the run, or those of the earlier one
    outputs: tuple
    watched: tuple  # the folders that temporary files may appear in
    first: str  # the output that is in its place first
    size: int = 4
    # What another run leaves beside its outputs: it is not compared byte by byte, as pieces stand in the order of their ends.
    kept: tuple = ()


def batch_inputs(folder, size, old):
    (folder / "records").mkdir(exist_ok=True)
    (folder / "test.toml").write_text(BODY.replace("28 kPa", "20 kPa") if old else BODY)
    for index in range(size):
        path = folder / "records" / f"{index:03}.csv"
        if not path.exists():
            record(path, index)


def sweep_inputs(folder, size, old):
    (folder / "sweep.toml").write_text(SWEEP.format(body=BODY, most="2e6" if old else "1e6", count=size))


def convert_inputs(folder, size, old):
    # One record of many samples; the columns of the earlier one are others.
    record(folder / "record.csv", 7 if old else 8, samples=400 * size)


def analyze_inputs(folder, size, old):
    # The earlier record has other holds, and its report has pictures as PNG that the next one takes away.
    record(folder / "record.csv", 7 if old else 8, holds=2 if old else 3, samples=100 * size)
    (folder / "test.toml").write_text(BODY)


def jobs():
    def batch(ending):
        arguments = ["batch", "records", "--test", "test.toml", "--out", f"table.{ending}", "--threads", "3"]
        outputs = (f"table.{ending}", f"table_parameters.{ending}")
        journal = f"table.{ending}.journal"
        return Job(f"batch, {ending}", arguments, batch_inputs, outputs, (".", journal), outputs[1], kept=(journal,))

    sweep = ["sweep", "sweep.toml", "--out", "table.parquet", "--threads", "3"]
    analyze = ["analyze", "record.csv", "--test", "test.toml", "--out", "study", "--no-compare"]
    return [
        batch("csv"),
        batch("parquet"),
        Job("sweep", sweep, sweep_inputs, ("table.parquet",), (".", "table.parquet.parts"), "table.parquet"),
        Job("sweep, figure", [*sweep, "--figure", "map.svg"], sweep_inputs, ("table.parquet", "map.svg"), (".", "table.parquet.parts"), "map.svg"),
        Job("analyze", analyze, analyze_inputs, ("study",), ("study", "study/figures"), "study/figures/record.svg"),
        Job("convert", ["convert", "record.csv", "--out", "plain.csv"], convert_inputs, ("plain.csv",), (".",), "plain.csv"),
    ]


def digests(folder):
    """All files below a folder with the digests of their bytes; empty folders too."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        try:
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
        except FileNotFoundError:
            # A run that has not ended takes its files away.
            continue
    return found


def temporary(names):
    parts = ((name, part) for name in names for part in pathlib.PurePath(name).parts)
    return sorted({name for name, part in parts if part.startswith(TEMPORARY) and part != MANIFEST})


def outputs(job, found):
    """What a job wrote, by name: its files, and those below its folders."""
    return {name: digest for name, digest in found.items() if pathlib.PurePath(name).parts[0] in job.outputs and digest != "folder"}


@dataclass
class Start:
    """A state that a run begins at, and what an undisturbed run makes of it."""

    job: Job
    name: str
    folder: pathlib.Path
    arguments: list
    code: int
    before: dict
    after: dict
    lasts_s: float
    # How long it runs on once it has come to each aim.
    since_s: dict


@dataclass
class Count:
    kills: int = 0
    writing: int = 0
    new: int = 0
    failures: list = field(default_factory=list)


def run(palpate, arguments, folder):
    return subprocess.run([palpate, *arguments], cwd=folder, capture_output=True, text=True, check=False)


def place(path):
    """Which file is at a path; None where none is."""
    try:
        return path.stat().st_ino
    except FileNotFoundError:
        return None


class Watched:
    """The outputs of a job that runs, and whether it has come to writing them."""

    def __init__(self, job, folder):
        self.watched, self.first = [folder / name for name in job.watched], folder / job.first
        self.outputs = [folder / name for name in job.outputs]
        self.at_first = [place(path) for path in (self.first, *self.outputs)]

    def is_new(self):
        """Whether the first output is there."""
        return place(self.first) != self.at_first[0]

    def is_writing(self):
        """Whether a temporary file is there, or an output that is new."""
        if [place(path) for path in (self.first, *self.outputs)] != self.at_first:
            return True
        for folder in self.watched:
            try:
                if any(entry.name.startswith(TEMPORARY) and entry.name != MANIFEST for entry in os.scandir(folder)):
                    return True
            except OSError:
                continue
        return False


def undisturbed(palpate, start_folder, job, arguments, scratch, turns=3):
    """Exit code, files and times of an undisturbed run, the median of some."""
    lasts, since, after, code = [], [], None, 0
    for _ in range(turns):
        folder = scratch / "undisturbed"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(start_folder, folder)
        watched, seen = Watched(job, folder), {}
        begin = time.perf_counter()
        process = subprocess.Popen([palpate, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None:
            for aim, reached in (("temporary file", watched.is_writing), ("new output", watched.is_new)):
                if aim not in seen and reached():
                    seen[aim] = time.perf_counter()
            time.sleep(1e-4)
        end = time.perf_counter()
        lasts.append(end - begin)
        since.append({aim: end - at for aim, at in seen.items()})
        found = digests(folder)
        if after is not None:
            assert outputs(job, after) == outputs(job, found), f"{job.name}: two undisturbed runs differ"
        after, code = found, process.returncode
    assert code in (0, 1), f"{job.name}: {' '.join(arguments)} ended with {code}"
    assert outputs(job, after), f"{job.name}: no outputs"
    assert not temporary(after), f"{job.name}: an undisturbed run leaves {temporary(after)}"
    # The longest, so that no part of it is out of reach; an aim that was over too soon to be seen takes what lies before.
    longest = {aim: max((times.get(aim, 0.0) for times in since)) for aim in AIMS}
    return code, after, sorted(lasts)[turns // 2], longest


def sized(palpate, job, scratch):
    """Makes the inputs so large that a run lasts long enough to be killed within."""
    while True:
        folder = scratch / "sized"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        job.prepare(folder, job.size, False)
        begin = time.perf_counter()
        assert run(palpate, job.arguments, folder).returncode in (0, 1)
        lasts = time.perf_counter() - begin
        if lasts >= SHORTEST_S or job.size > 2000:
            return
        job.size = math.ceil(job.size * min(4.0, 1.2 * SHORTEST_S / lasts))


def starts(palpate, job, scratch):
    """The states to begin at: nothing there, an earlier result, and parts of this one."""
    sized(palpate, job, scratch)
    for name in ("nothing", "earlier result", "earlier result and parts"):
        folder = scratch / f"{job.name}, {name}"
        folder.mkdir()
        arguments = list(job.arguments)
        if name != "nothing":
            job.prepare(folder, job.size, True)
            png = ["--figures", "svg,png"] if job.name == "analyze" else []
            assert run(palpate, [*arguments, *png], folder).returncode in (0, 1)
        job.prepare(folder, job.size, False)
        if name.endswith("parts"):
            if job.name in ("analyze", "convert"):
                continue
            # Half of the work is there when the run begins.
            process = subprocess.Popen([palpate, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.5 * SHORTEST_S)
            process.kill()
            process.wait()
        before = digests(folder)
        code, after, lasts, since = undisturbed(palpate, folder, job, arguments, scratch)
        yield Start(job, name, folder, arguments, code, before, after, lasts, since)


def killed(palpate, start, chance, aim, sooner, folder):
    """Runs and kills, and says whether it had come to writing; None where it was over before. `sooner` shortens the wait."""
    watched = Watched(start.job, folder)
    reached = {"temporary file": watched.is_writing, "new output": watched.is_new}.get(aim)
    wait = sooner * chance.uniform(0, 1.05 * start.lasts_s if reached is None else start.since_s[aim])
    process = subprocess.Popen([palpate, *start.arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if reached is not None:
        # Looked for without a pause only near the time at which it is expected.
        time.sleep(max(0.5 * (start.lasts_s - start.since_s[aim]), 0.0))
        while process.poll() is None and not reached():
            pass
        until = time.perf_counter() + wait
        while time.perf_counter() < until:
            pass
    else:
        time.sleep(wait)
    process.send_signal(signal.SIGKILL)
    return watched.is_writing() if process.wait() == -signal.SIGKILL else None


def harm(palpate, start, folder):
    """What is wrong after a kill, and after the same command has run again."""
    job, before, after = start.job, outputs(start.job, start.before), outputs(start.job, start.after)
    now = digests(folder)
    for name, digest in outputs(job, now).items():
        if temporary([name]) or name.endswith(MANIFEST):
            continue
        if digest not in (before.get(name), after.get(name)):
            yield f"{name} is neither the old one nor the new one"
    for name in before:
        if name not in now and name in after:
            yield f"{name} is gone"
    again = run(palpate, start.arguments, folder)
    if again.returncode != start.code:
        yield f"run again, it ends with {again.returncode} instead of {start.code}: {again.stderr.strip()[-300:]}"
    then = digests(folder)
    left = temporary(then)
    if left:
        yield f"run again, {', '.join(left[:3])} is left" + (f", and {len(left) - 3} more" if len(left) > 3 else "")
    compared = {name: digest for name, digest in then.items() if not temporary([name])}
    for name in sorted({*compared, *start.after}):
        if pathlib.PurePath(name).parts[0] in job.kept and name in compared and name in start.after:
            continue
        if compared.get(name) != start.after.get(name):
            yield f"run again, {name} {'differs' if name in compared and name in start.after else 'is there' if name in compared else 'is missing'}"


def generic(failure):
    """A failure without the random part of a name."""
    words = [word.split(TEMPORARY)[0] + TEMPORARY + "…" if TEMPORARY in word and not word.endswith(MANIFEST) else word for word in failure.split(" ")]
    return " ".join(dict.fromkeys(words)) if TEMPORARY in failure else failure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="only jobs whose name begins like this")
    parser.add_argument("--write", action="store_true", help="write the table to docs/validation/kills.md")
    requested = parser.parse_args()
    palpate, chance = requested.palpate.resolve(), random.Random(requested.seed)
    with tempfile.TemporaryDirectory(prefix="kills-") as scratch:
        scratch = pathlib.Path(scratch)
        chosen = [job for job in jobs() if job.name.startswith(requested.only or "")]
        begins = [start for job in chosen for start in starts(palpate, job, scratch)]
        counts = [Count() for _ in begins]
        for turn in range(requested.kills):
            start, count = begins[turn % len(begins)], counts[turn % len(begins)]
            aim = chance.choices(list(AIMS), AIMS.values())[0]
            for attempt in range(50):
                folder = scratch / "killed"
                shutil.rmtree(folder, ignore_errors=True)
                shutil.copytree(start.folder, folder)
                stage = killed(palpate, start, chance, aim, 0.8**attempt, folder)
                if stage is not None:
                    break
            else:
                sys.exit(f"{start.job.name}, {start.name}: 50 runs ended before the kill")
            count.kills += 1
            count.writing += stage
            found = outputs(start.job, digests(folder))
            count.new += any(found.get(name) == digest != outputs(start.job, start.before).get(name) for name, digest in outputs(start.job, start.after).items())
            for failure in harm(palpate, start, folder):
                count.failures.append(failure)
                print(f"kill {turn + 1}, {start.job.name}, {start.name}: {failure}", file=sys.stderr, flush=True)
    lines = ["| job | what was there | a run, s | kills | of these while it wrote | with an output new | failures |", "|---|---|--:|--:|--:|--:|--:|"]
    for start, count in zip(begins, counts):
        lines.append(f"| {start.job.name} | {start.name} | {start.lasts_s:.2f} | {count.kills} | {count.writing} | {count.new} | {len(count.failures)} |")
    total = Counter(generic(failure) for count in counts for failure in count.failures)
    version = run(palpate, ["--version"], None).stdout.split()[1]
    kills, failures = sum(count.kills for count in counts), sum(total.values())
    page = f"""# Kills

{kills} runs of palpate {version} killed (SIGKILL) at random times, most of them while they wrote. After each kill every output has to be
absent, or whole and old, or whole and new; after the same command has run again, the folder has to have the files and the bytes of an
undisturbed run, and no temporary file. Failures: {failures}. One command writes this page:

```sh
python validation/kills.py PALPATE --kills {requested.kills} --seed {requested.seed} --write
```

{chr(10).join(lines)}

{platform.system()} {platform.release().split("-")[0]}, {len(os.sched_getaffinity(0))} cores. *What was there* is the folder before the run: *earlier result* is that of other
inputs, *parts* those of an interrupted run.
"""
    print(page)
    for failure, times in total.most_common():
        print(f"{times} × {failure}")
    if requested.write:
        PAGE.write_text(page, encoding="utf-8")
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
