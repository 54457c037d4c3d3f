"""Interrupts of long work: how soon a command and a Python call end, and what they leave behind.

    python validation/interrupts.py PALPATE [--times 5] [--seed 1] [--limit-s 0.2] [--only NAME] [--write]

PALPATE is the command; the Python package has to be installed for the Python that runs this. Every job gets an input that takes more than
2 s, found by trying larger ones. Commands hear SIGINT and SIGTERM at random times, calls of Python SIGINT. From the signal until the process
has ended, or KeyboardInterrupt has been raised, at most --limit-s may pass; one second later the process may use no more than --busy-ms of
processor time within 0.3 s (six times the median of six windows of 0.05 s), no file may have changed since, and no temporary file may be
left. After parallel work in a process, a fork of it has to do the same work with the same result within 10 s. With --write the table goes to
docs/validation/interrupts.md, where rows of jobs that did not run stay as they are. Exit code 1 if anything is not as required. The limits are
those of a release build on an idle machine.
"""

import argparse
import json
import os
import pathlib
import platform
import random
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "validation" / "interrupts.md"
EXAMPLES = ROOT / "examples"
TEMPORARY, MANIFEST = ".palpate-", ".palpate-files"
LONG_S = 2.0
# A call below this needs no ear for signals.
SHORT_S = 0.05
FORK_S = 10.0
AT_THE_END = 0.3

# What all scripts begin with. `size` is what is made larger until the work takes long; `shared` is a folder with the inputs of that size,
# `out` an empty one.
COMMON = '''
import json, os, pathlib, pickle, signal, sys, time, warnings
signal.signal(signal.SIGINT, signal.default_int_handler)
warnings.simplefilter("ignore")
import numpy as np, palpate
size, shared, out, examples = int(sys.argv[1]), *map(pathlib.Path, sys.argv[2:5])
SPECIMEN = {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"}
SCENE = {"specimen": SPECIMEN, "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"}}
def hold(samples, seed=0):
    t = np.linspace(0.0, 60.0, samples)
    return t, 1 + (1 + 4 * t) ** -0.25 + np.random.default_rng(seed).normal(0.0, 1e-3, samples)
def series(samples, presses=20):
    t = np.linspace(0.0, 20.0 * presses, samples)
    depth = 5e-4 * np.minimum(t % 20, 1) + 5e-4 * (t // 20)
    noise = np.random.default_rng(1).normal(0.0, 1e-2, samples)
    return t, depth, 400 * depth * (1 + (1 + 2 * (t % 20)) ** -0.5) + noise
def record(samples, presses=20):
    t, depth, force = series(samples, presses)
    return palpate.Record.from_arrays(time_s=t, displacement_m=depth, force_n=force)
def table(path, samples, presses=20):
    with open(path, "w") as file:
        file.write("time_s,displacement_m,force_n\\n")
        for t, x, f in zip(*series(samples, presses)):
            file.write(f"{t:.6f},{x:.9f},{f:.6f}\\n")
def protocol(**tables):
    return {**SCENE, "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "1000 s"}], **tables}
def material():
    return palpate.Material.read(examples / "records/ball-material.toml")
TEST = {"specimen": SPECIMEN}
'''

BUSY = '''
import time
def busy_ms():
    # Work that goes on is in every window; what a virtual machine takes at a waking is charged to one or two.
    windows = []
    for _ in range(6):
        used = time.process_time()
        time.sleep(0.05)
        windows.append(time.process_time() - used)
    return 3e3 * sum(sorted(windows)[2:4])
'''

CHILD = BUSY + '''
print("ready", flush=True)
begin = time.monotonic()
kind = "returned"
try:
    made = work()
    returned = time.monotonic()
except KeyboardInterrupt:
    kind = "KeyboardInterrupt"
except BaseException as error:
    kind = f"{type(error).__name__}: {str(error)[:200]}"
ended = time.monotonic()
signal.signal(signal.SIGINT, signal.SIG_IGN)
def files():
    return {str(path): path.stat().st_mtime_ns for path in out.rglob("*")}
print(json.dumps([kind, begin, ended]), flush=True)
if len(sys.argv) > 5:
    at_once = files()
    time.sleep(1.0)
    busy = busy_ms()
    now = files()
    changed = sorted(str(pathlib.Path(name).relative_to(out)) for name in {*now, *at_once} if now.get(name) != at_once.get(name))
    print(json.dumps([busy, changed, sorted(now)]), flush=True)
os._exit(0)
'''


@dataclass
class Work:
    """A call of Python, or a command: how its inputs are made, and how large they may get."""

    name: str
    call: str = ""
    setup: str = ""
    prepare: str = ""
    command: tuple = ()
    size: int = 1000
    most: int = 100_000_000
    takes_s: float = 0.0
    latencies: list = field(default_factory=list)
    busy_ms: list = field(default_factory=list)
    failures: list = field(default_factory=list)


# What commands read, by the functions above; SIZE, SHARED and OUT stand for what the scripts call size, shared and out.
RECORD = "table(shared / 'record.csv', size); (shared / 'ball.toml').write_text((examples / 'records/ball.toml').read_text())"
RECORDS = "(shared / 'records').mkdir(); [table(shared / f'records/{i:05}.csv', 400 + i % 50, 2) for i in range(size)]"
BODY = '[specimen]\\nshape = "ball"\\nradius = "35 mm"\\nmodulus = "28 kPa"\\n[law]\\nname = "latency"\\nexponent = 5\\nrate_coefficient = "2e4 /s"\\n'
STEP = '[[step]]\\nto = "5 mm"\\nrate = "500 mm/min"\\nhold = "{hold} s"\\n[output]\\nsample_rate = "{rate} Hz"\\n'
SWEEP = f"""(shared / 'sweep.toml').write_text('{BODY}{STEP.format(hold=10, rate=20)}[sweep]\\nlaw.rate_coefficient = "log 1e3..1e6 /s, ' + str(size) + '"\\n')"""
PROTOCOL = f"""(shared / 'protocol.toml').write_text('{BODY}{STEP.format(hold=1000, rate="' + str(size) + '")}')"""
LOGGED = "table(shared / 'record.csv', size)"
MATERIAL = str(EXAMPLES / "records" / "ball-material.toml")
TEST = ("--test", "SHARED/ball.toml")


def commands():
    record = "SHARED/record.csv"
    return [
        Work("analyze", command=("analyze", record, *TEST, "--out", "OUT/study"), prepare=RECORD, size=20_000),
        Work("analyze, profile", command=("analyze", record, *TEST, "--intervals", "profile"), prepare=RECORD, size=5000),
        Work("batch to CSV", command=("batch", "SHARED/records", "--out", "OUT/table.csv"), prepare=RECORDS, size=50, most=20_000),
        Work("batch to Parquet", command=("batch", "SHARED/records", "--out", "OUT/table.parquet"), prepare=RECORDS, size=50, most=20_000),
        Work("sweep", command=("sweep", "SHARED/sweep.toml", "--out", "OUT/t.parquet", "--figure", "OUT/t.svg"), prepare=SWEEP, size=2000, most=4_000_000),
        Work("calibrate", command=("calibrate", record, *TEST, "--out", "OUT/material.toml"), prepare=RECORD, size=2000),
        Work("compare", command=("compare", record, "--out", "OUT/laws"), prepare=RECORD, size=5000),
        Work("simulate", command=("simulate", "SHARED/protocol.toml", "--out", "OUT/series.csv", "--figure", "OUT/f.svg"), prepare=PROTOCOL, size=100, most=9900),
        Work("simulate to standard output", command=("simulate", "SHARED/protocol.toml"), prepare=PROTOCOL, size=100, most=9900),
        Work("inspect", command=("inspect", record, "--figure", "OUT/phases.svg"), prepare=LOGGED, size=100_000, most=20_000_000),
        Work("convert to CSV", command=("convert", record, "--out", "OUT/plain.csv"), prepare=LOGGED, size=100_000, most=20_000_000),
        Work("convert to Parquet", command=("convert", record, "--out", "OUT/plain.parquet"), prepare=LOGGED, size=100_000, most=20_000_000),
        Work("convert to JSON", command=("convert", record, "--out", "OUT/plain.json"), prepare=LOGGED, size=100_000, most=20_000_000),
        Work("predict", command=("predict", MATERIAL, "--protocol", "SHARED/protocol.toml", "--out", "OUT/force.csv"), prepare=PROTOCOL, size=10, most=9900),
        Work("grip", command=("grip", MATERIAL, "--mass", "250g", "--friction", "0.6", "--hold", "SIZE s", "--band", "2.1..3 N", "--regrip", "work", "--out", "OUT/grip"), size=100, most=10_000),
        Work("watch", command=("watch", record, "--speed", "max", "--slip-force", "1 N"), prepare=LOGGED, size=100_000, most=20_000_000),
        Work("reproduce", command=("reproduce", "--out", "OUT/paper", "--figures", "svg,png"), size=1, most=1),
    ]


MANY = "t, y = hold(size); rows = np.array([hold(size, seed % 50)[1] for seed in range(30_000)])"
HELD = "t, y = hold(size)"
WHOLE = "of = record(size)"
FIT = "fit = palpate.fit_hold(*hold(500)); t = np.linspace(0.0, 60.0, size)"
ANALYSIS = "of = record(size).analyze(test=TEST, compare=False)"
TRAJECTORY = "of = palpate.simulate(protocol(output={'sample_rate': f'{size} Hz'}))"
PREDICTION = "of = material().predict([{'to': '5 mm', 'rate': '500 mm/min', 'hold': '20 s'}], at_s=np.linspace(0.1, 20, size))"
OBSERVED = "t, x, f = series(size); of = palpate.Observer(slip_force_n=1.0).feed_many(t, f, x)"
CONTACTS = "of = palpate.ContactStates(SCENE, size); to = np.full(size, 2e-3)"


def calls():
    big, csv = {"size": 20_000}, {"size": 100_000, "most": 20_000_000, "prepare": LOGGED}
    again = "; text = pickle.dumps(of)"
    return [
        Work("fit_hold", "palpate.fit_hold(t, y)", HELD, size=100_000, most=20_000_000),
        Work("fit_hold, prony:4", "palpate.fit_hold(t, y, law='prony:4')", HELD, size=100_000, most=20_000_000),
        Work("fit_hold, huber", "palpate.fit_hold(t, y, loss='huber')", HELD, size=100_000, most=20_000_000),
        Work("fit_hold, profile", "palpate.fit_hold(t, y, intervals='profile')", HELD, size=10_000, most=20_000_000),
        Work("fit_hold, bootstrap", "palpate.fit_hold(t, y, intervals='bootstrap')", HELD, size=10_000, most=20_000_000),
        Work("Fit.predict", "fit.predict(t)", FIT, size=1_000_000, most=100_000_000),
        Work("Fit.predict, interval", "fit.predict(t, interval=0.95)", FIT, size=1_000_000, most=30_000_000),
        Work("fit_many, 30,000 curves", "palpate.fit_many(t, rows)", MANY, size=25, most=4000),
        Work("fit_many, 30,000 lists", "palpate.fit_many([t] * 30_000, lists)", MANY + "; t = t.tolist(); lists = rows.tolist()", size=25, most=1000),
        Work("fit_many, a long curve each", "palpate.fit_many(t, rows, law='prony:4')", "t, y = hold(size); rows = np.array([y, y, y, y])", size=100_000, most=500_000),
        Work("compare", "palpate.compare(t, y)", HELD, size=5000, most=5_000_000),
        Work("forecast", "palpate.forecast(t, y, 61 + t)", HELD, size=5000, most=5_000_000),
        Work("laws.latency", "palpate.laws.latency(t, 0, 1, 2, 5)", HELD, size=10_000_000, most=200_000_000),
        Work("read", "palpate.read(shared / 'record.csv')", **csv),
        Work("read_all", "palpate.read_all(shared / 'record.csv')", **csv),
        Work("inspect", "palpate.inspect(shared / 'record.csv')", **csv),
        Work("convert to CSV", "palpate.convert(shared / 'record.csv', out / 'plain.csv')", **csv),
        Work("convert to Parquet", "palpate.convert(shared / 'record.csv', out / 'plain.parquet')", **csv),
        Work("convert to JSON", "palpate.convert(shared / 'record.csv', out / 'plain.json')", **csv),
        Work("watch", "palpate.watch(shared / 'record.csv', slip_force_n=1.0)", **csv),
        Work("Record.from_arrays", "palpate.Record.from_arrays(time_s=t, displacement_m=x, force_n=f)", "t, x, f = series(size)", size=3_000_000, most=50_000_000),
        Work("Record.segments", "of.segments()", WHOLE, size=100_000, most=20_000_000),
        Work("Record.analyze", "of.analyze(test=TEST)", WHOLE, **big),
        Work("Record.analyze, profile", "of.analyze(test=TEST, intervals='profile')", WHOLE, **big),
        Work("Record.compare", "of.compare()", WHOLE, size=5000),
        Work("Record.calibrate", "of.calibrate(test=TEST)", WHOLE, size=2000),
        Work("Record.calibrate, profile", "of.calibrate(test=TEST, profile=True)", WHOLE, size=1000),
        Work("iteration over a Record", "sum(1 for _ in of)", WHOLE, size=300_000, most=10_000_000),
        Work("pickle of a Record", "pickle.dumps(of)", WHOLE, size=300_000, most=20_000_000),
        Work("Record from a pickle", "pickle.loads(text)", WHOLE + again, size=300_000, most=20_000_000),
        Work("Analysis.report", "of.report(out / 'study', figures=['svg', 'png'])", ANALYSIS, size=50_000, most=3_000_000),
        Work("Analysis._repr_html_", "of._repr_html_()", ANALYSIS, size=50_000, most=3_000_000),
        Work("str(Analysis) from a pickle", "str(pickle.loads(text))", ANALYSIS + again, size=50_000, most=3_000_000),
        Work("Analysis.to_json", "of.to_json()", ANALYSIS, size=50_000, most=1_000_000),
        Work("Calibration._repr_html_", "of._repr_html_()", "of = record(size, 3).calibrate(test=TEST, alternatives=[])", size=20_000, most=1_000_000),
        Work("Calibration.to_json", "of.to_json()", "of = record(size, 3).calibrate(test=TEST, alternatives=[])", size=20_000, most=1_000_000),
        Work("pickle of a Calibration", "pickle.dumps(of)", "of = record(size, 3).calibrate(test=TEST, alternatives=[])", size=20_000, most=1_000_000),
        Work("simulate", "palpate.simulate(protocol(output={'sample_rate': f'{size} Hz'}))", size=1000, most=9900),
        Work("simulate, many steps", "palpate.simulate(p)", "p = protocol(step=[{'to': f'{5 + i % 2} mm', 'rate': '500 mm/min', 'hold': '1 s'} for i in range(size)])", size=1000, most=1_000_000),
        Work("simulate_many", "palpate.simulate_many(protocol(), {'specimen.radius': np.linspace(0.03, 0.04, size)})", size=1000, most=1_000_000),
        Work("simulate_many, times", "palpate.simulate_many(protocol(), {'specimen.radius': np.linspace(0.03, 0.04, 20)}, times_s=np.linspace(0.1, 900, size))", size=10_000, most=5_000_000),
        Work("Trajectory.to_csv", "of.to_csv()", TRAJECTORY, size=200, most=3000),
        Work("iteration over a Trajectory", "sum(1 for _ in of)", TRAJECTORY, size=200, most=3000),
        Work("pickle of a Trajectory", "pickle.dumps(of)", TRAJECTORY, size=200, most=3000),
        Work("Material.predict", "material().predict([{'to': '5 mm', 'rate': '500 mm/min', 'hold': '20 s'}], at_s=np.linspace(0.1, 20, size))", size=1000, most=3_000_000),
        Work("Prediction._repr_html_", "of._repr_html_()", PREDICTION, size=20_000, most=2_000_000),
        Work("Prediction.to_csv", "of.to_csv()", PREDICTION, size=20_000, most=2_000_000),
        Work("Material.grip", "material().grip(mass_kg=0.25, friction=0.6, hold_s=float(size), band_n=(2.1, 3.0), regrip='work', objective='work', confidence=0.9)", size=100, most=300_000_000),
        Work("Grip.report", "of.report(out / 'grip')", "of = material().grip(mass_kg=0.25, friction=0.6, hold_s=float(size), band_n=(2.1, 3.0))", size=100, most=10**7),
        Work("Grip._repr_html_", "of._repr_html_()", "of = material().grip(mass_kg=0.25, friction=0.6, hold_s=float(size), band_n=(2.1, 3.0))", size=100, most=10**7),
        Work("Observer.feed_many", "palpate.Observer(slip_force_n=1.0).feed_many(t, f, x)", "t, x, f = series(size)", size=100_000, most=20_000_000),
        Work("Observer.feed_many, material", "palpate.Observer(material(), slip_force_n=1.0).feed_many(t, f, x)", "t, x, f = series(size)", size=50_000, most=20_000_000),
        Work("iteration over a Table", "sum(1 for _ in of)", OBSERVED, size=50_000, most=3_000_000),
        Work("a column of a Table", "of['phase']", OBSERVED, size=100_000, most=10_000_000),
        Work("pickle of a Table", "pickle.dumps(of)", OBSERVED, size=100_000, most=10_000_000),
        Work("ContactStates", "palpate.ContactStates([SCENE] * size)", size=3000, most=3_000_000),
        Work("ContactStates.step", "of.step(0.1, to)", CONTACTS, size=300_000, most=20_000_000),
        Work("pickle of ContactStates", "pickle.dumps(of)", CONTACTS, size=300_000, most=20_000_000),
        Work("batch to CSV", "palpate.batch([shared / 'records'], out / 'table.csv')", prepare=RECORDS, size=50, most=20_000),
        Work("batch to Parquet", "palpate.batch([shared / 'records'], out / 'table.parquet', laws=['prony:2'])", prepare=RECORDS, size=50, most=20_000),
        Work("sweep", "palpate.sweep(shared / 'sweep.toml', out / 't.parquet', figure=out / 't.svg')", prepare=SWEEP, size=2000, most=4_000_000),
        Work("reproduce", "palpate.reproduce(out / 'paper', figures=['svg', 'png'])", size=1, most=1),
    ]


class Bench:
    """Runs works in processes of their own."""

    def __init__(self, palpate, python, scratch, patience_s):
        self.palpate, self.python, self.scratch, self.patience_s = palpate, python, scratch, patience_s
        self.shared, self.out = scratch / "shared", scratch / "out"

    def prepare(self, work):
        """The inputs of a size, made once."""
        shutil.rmtree(self.shared, ignore_errors=True)
        self.shared.mkdir()
        if work.prepare:
            script = f"{COMMON}\n{work.prepare}\n"
            subprocess.run([self.python, "-c", script, *self.arguments(work)], check=True)
        # A disk that still takes the inputs lets a job wait for its own bytes.
        os.sync()

    def arguments(self, work):
        return [str(work.size), str(self.shared), str(self.out), str(EXAMPLES)]

    def empty(self):
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir()

    def begin(self, work, *more):
        """Begins a work; it has started when this returns."""
        self.empty()
        if work.command:
            words = {"SIZE": str(work.size), "SHARED": str(self.shared), "OUT": str(self.out)}
            command = list(work.command)
            for word, value in words.items():
                command = [argument.replace(word, value) for argument in command]
            # Nobody reads what it prints, and nobody closes the pipe.
            return subprocess.Popen([self.palpate, *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.out)
        script = f"{COMMON}\n{work.setup}\ndef work():\n    return {work.call}\n{CHILD}"
        command = [self.python, "-c", script, *self.arguments(work), *more]
        # Without a buffer, so that each line is read when it is there, and none before it is asked for.
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, bufsize=0)
        if process.stdout.readline() != b"ready\n":
            raise RuntimeError(f"{work.name}: {process.stderr.read().decode()[-2000:]}")
        return process

    def lasts(self, work):
        """Seconds of one undisturbed run."""
        process = self.begin(work)
        begin = time.monotonic()
        if work.command:
            code = process.wait()
            if code not in (0, 1):
                raise RuntimeError(f"{work.name} ended with {code}")
            return time.monotonic() - begin
        line, said = process.communicate()
        if not line:
            raise RuntimeError(f"{work.name}: ended with {process.returncode} at size {work.size}: {said.decode()[-200:]}")
        kind, begin, ended = json.loads(line)
        if kind != "returned":
            raise RuntimeError(f"{work.name}: {kind}")
        return ended - begin

    def size(self, work):
        """Makes the input larger until the work takes long."""
        while True:
            self.prepare(work)
            work.takes_s = self.lasts(work)
            if work.takes_s >= LONG_S or work.size >= work.most:
                return
            more = min(5.0, max(1.3, 1.5 * LONG_S / work.takes_s))
            work.size = min(work.most, int(work.size * more) + 1)

    def interrupted(self, work, number, chance, limits):
        """Interrupts one run at a random time; False where it was over before."""
        process = self.begin(work, "watched")
        # Results are put together and written at the end, which is short: it gets a share of its own.
        begin, end = (0.9, 1.0) if chance.random() < AT_THE_END else (0.02, 0.9)
        time.sleep(chance.uniform(begin, end) * work.takes_s)
        sent = time.monotonic()
        process.send_signal(number)
        return (self.of_command if work.command else self.of_call)(work, process, sent, number, limits)

    def of_command(self, work, process, sent, number, limits):
        try:
            code = process.wait(self.patience_s)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            work.latencies.append(self.patience_s)
            work.failures.append(f"runs on {self.patience_s:.0f} s after {number.name}")
            return True
        if code in (0, 1):
            return False
        latency = time.monotonic() - sent
        self.late(work, latency, limits)
        if code not in (-number, 128 + number):
            work.failures.append(f"exit code {code} after {number.name}")
        self.left(work, [str(path) for path in self.out.rglob("*")])
        return True

    def of_call(self, work, process, sent, number, limits):
        lines = []
        for _ in range(2):
            # A line at a time: the process says what happened at once, and what it does a second later.
            ready, _, _ = select.select([process.stdout], [], [], self.patience_s)
            if not ready:
                process.kill()
                process.communicate()
                work.latencies.append(self.patience_s)
                work.failures.append(f"runs on {self.patience_s:.0f} s after {number.name}")
                return True
            lines.append(process.stdout.readline())
        process.communicate()
        if not all(lines):
            work.failures.append(f"ended with {process.returncode} after {number.name}")
            return True
        (kind, _, ended), (busy_ms, changed, files) = map(json.loads, lines)
        if ended < sent:
            return False
        self.late(work, ended - sent, limits)
        if kind != "KeyboardInterrupt":
            work.failures.append(f"{'it returned' if kind == 'returned' else kind} instead of KeyboardInterrupt")
        work.busy_ms.append(busy_ms)
        if busy_ms > limits.busy_ms:
            work.failures.append(f"{busy_ms:.0f} ms of processor time within 0.3 s, one second later")
        changed = [name for name in changed if TEMPORARY not in name or name.endswith(MANIFEST)] or changed
        if changed:
            others = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
            work.failures.append(f"{changed[0]}{others} changed after KeyboardInterrupt")
        # What a thread was still writing when the process ended is left too.
        self.left(work, [*files, *map(str, self.out.rglob("*"))])
        return True

    def late(self, work, latency, limits):
        work.latencies.append(latency)
        if latency > limits.limit_s:
            work.failures.append(f"{latency:.2f} s")

    def left(self, work, files):
        """Temporary files among those that are there."""
        for name in files:
            path = pathlib.Path(name)
            if path.name.startswith(TEMPORARY) and path.name != MANIFEST:
                work.failures.append("a temporary file is left")
                return


FORKS = {
    "fit_many": ("t, y = hold(200); rows = np.array([hold(200, seed)[1] for seed in range(200)])", "palpate.fit_many(t, rows)"),
    "simulate_many": ("radii = np.linspace(0.03, 0.04, 50)", "palpate.simulate_many(protocol(), {'specimen.radius': radii})"),
    "batch": ("[table(out / f'{i}.csv', 400, 2) for i in range(4)]", "palpate.batch([out / f'{i}.csv' for i in range(4)], out / f'{os.getpid()}.csv')"),
    "Record.analyze": ("of = record(2000, 2)", "of.analyze(test=TEST)"),
    "compare": ("t, y = hold(500)", "palpate.compare(t, y)"),
}

FORKED = {
    "os.fork": """
before = work()
child = os.fork()
if child == 0:
    os._exit(0 if work() == before else 3)
code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
os._exit(code if work() == before else 4)
""",
    "multiprocessing, fork": """
import multiprocessing
before = work()
def again(_):
    return work() == before
with multiprocessing.get_context("fork").Pool(2) as pool:
    same = all(pool.map(again, range(4)))
os._exit(0 if same and work() == before else 3)
""",
}


def forks(bench, names):
    """Parallel work, and the same once more in a fork: a row each, and what failed."""
    for name, (setup, call) in FORKS.items():
        for how, code in FORKED.items():
            if names and not any(f"{how}, {name}".startswith(begin) for begin in names):
                continue
            bench.empty()
            script = f"{COMMON}\n{setup}\ndef work():\n    return {call}\n{code}"
            work = Work(f"{how}, {name}")
            begin = time.monotonic()
            process = subprocess.Popen([bench.python, "-c", script, *bench.arguments(work)], stderr=subprocess.PIPE, start_new_session=True)
            try:
                _, said = process.communicate(timeout=FORK_S + 5.0)
                if process.returncode:
                    words = {3: "another result in the fork", 4: "another result after the fork"}
                    work.failures.append(words.get(process.returncode, f"ended with {process.returncode}: {said.decode()[-200:]}"))
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                work.failures.append(f"no result within {FORK_S:.0f} s")
            work.takes_s = time.monotonic() - begin
            yield work


# A process without palpate, after work with as much memory as the largest jobs have.
CONTROL = f"""{BUSY}
import numpy as np
worst = 0.0
for _ in range(10):
    held = np.ones(400_000_000)
    freed = np.ones(200_000_000)
    del freed
    time.sleep(1.0)
    worst = max(worst, busy_ms())
print(worst)
"""


def summary(failures):
    """Failures of one kind in one line: how often, and the worst of the times."""
    late = sorted(float(failure.split()[0]) for failure in failures if failure.endswith(" s") and failure.split()[0].replace(".", "").isdigit())
    found = [f"{len(late)} × late" ] if late else []
    others = [failure for failure in failures if not (failure.endswith(" s") and failure.split()[0].replace(".", "").isdigit())]
    kinds = dict.fromkeys("processor time one second later" if "processor time" in failure else failure for failure in others)
    for kind in kinds:
        count = sum(failure == kind or (kind.startswith("processor") and "processor time" in failure) for failure in others)
        found.append(f"{count} × {kind}")
    return "; ".join(found)


def row(kind, work):
    latency = f"{1e3 * max(work.latencies):.0f}" if work.latencies else ""
    busy = f"{max(work.busy_ms):.1f}" if work.busy_ms else ""
    return f"| {kind} | {work.name} | {work.takes_s:.1f} | {len(work.latencies)} | {latency} | {busy} | {summary(work.failures)} |"


def written():
    """The rows of the page as it is, by kind and job, and the jobs that are short; those that there are no more are left out."""
    known = {*(("command", work.name) for work in commands()), *(("Python", work.name) for work in calls())}
    known |= {("fork", f"{how}, {name}") for name in FORKS for how in FORKED}
    lines = PAGE.read_text(encoding="utf-8").splitlines() if PAGE.exists() else []
    cells = [(tuple(line.split(" | ")[:2]), line) for line in lines if line.startswith(("| command |", "| Python |", "| fork |"))]
    rows = {(kind.removeprefix("| "), name): line for (kind, name), line in cells}
    short = " ".join(lines).partition("Always below")[2].partition(": ")[2].rstrip(".").split(", ")
    return {key: line for key, line in rows.items() if key in known}, [name for name in short if ("Python", name) in known]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("palpate", type=pathlib.Path)
    parser.add_argument("--python", default=sys.executable, help="Python with the package")
    parser.add_argument("--times", type=int, default=5, help="interrupts of each job and signal")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit-s", type=float, default=0.2)
    parser.add_argument("--busy-ms", type=float, default=10.0, help="processor time within 0.3 s that no work is")
    parser.add_argument("--patience-s", type=float, default=60.0, help="when what does not end is killed")
    parser.add_argument("--only", action="append", help="only jobs whose name begins like this; may be repeated")
    parser.add_argument("--skip", action="append", default=[], choices=["commands", "calls", "forks"])
    parser.add_argument("--write", action="store_true", help="write the table to docs/validation/interrupts.md")
    requested = parser.parse_args()
    rows, short = written()

    def done(kind, work):
        rows[kind, work.name] = row(kind, work)
        print(rows[kind, work.name], flush=True)

    with tempfile.TemporaryDirectory(prefix="interrupts-") as scratch:
        bench = Bench(requested.palpate.resolve(), requested.python, pathlib.Path(scratch), requested.patience_s)
        kinds = [("command", commands(), (signal.SIGINT, signal.SIGTERM)), ("Python", calls(), (signal.SIGINT,))]
        for kind, works, numbers in kinds:
            if {"command": "commands", "Python": "calls"}[kind] in requested.skip:
                continue
            for work in works:
                if requested.only and not any(work.name.startswith(begin) for begin in requested.only):
                    continue
                # The times do not depend on which other jobs run.
                chance = random.Random(f"{requested.seed} {kind} {work.name}")
                try:
                    bench.size(work)
                    short = [name for name in short if name != work.name]
                    if work.takes_s < SHORT_S:
                        short.append(work.name)
                        rows.pop((kind, work.name), None)
                        continue
                    for number in numbers:
                        for _ in range(requested.times):
                            tries = 0
                            while not bench.interrupted(work, number, chance, requested) and tries < 10:
                                tries += 1
                except (RuntimeError, subprocess.CalledProcessError) as error:
                    work.failures.append(" ".join(str(error).split())[-300:])
                done(kind, work)
        if "forks" not in requested.skip:
            for work in forks(bench, requested.only):
                done("fork", work)
    failed = sum(not text.endswith("|  |") for text in rows.values())
    idle = float(subprocess.run([requested.python, "-c", CONTROL], capture_output=True, text=True, check=True).stdout)
    version = subprocess.run([requested.palpate, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    page = f"""# Interrupts

Jobs of palpate {version} interrupted at random times. Commands hear SIGINT and SIGTERM, calls of Python SIGINT. Required: the process has ended, or
KeyboardInterrupt is raised, within {1e3 * requested.limit_s:.0f} ms; one second later the process uses no more than {requested.busy_ms:.0f} ms of processor time in 0.3 s and has changed
no file; no temporary file is left. (A process of NumPy alone that holds 3.2 GB, frees 1.6 GB and sleeps used up to {idle:.0f} ms.)
After parallel work a fork of the process does the same work again with the same result within {FORK_S:.0f} s. Jobs that are not as required:
{failed} of {len(rows)}. What Python makes of a result is Python's: it frees a list of all rows (millions of dicts) before it raises KeyboardInterrupt,
so that iterations keep no row here. One command writes this page; with `--only` it measures some jobs again and leaves the rows of others, so that
rows may be of several runs:

```sh
python validation/interrupts.py PALPATE --times {requested.times} --seed {requested.seed} --write
```

| what | job | takes, s | interrupts | worst latency, ms | processor time within 0.3 s, one second later, ms | failures |
|---|---|--:|--:|--:|--:|---|
{chr(10).join(rows.values())}

{platform.system()} {platform.release().split("-")[0]}, {len(os.sched_getaffinity(0))} cores, CPython {platform.python_version()}. Inputs were made larger until a job took {LONG_S:.0f} s, or as large as memory
allows.{f" Always below {1e3 * SHORT_S:.0f} ms: {', '.join(short)}." if short else ""}
"""
    print(page)
    if requested.write:
        PAGE.write_text(page, encoding="utf-8")
    if failed:
        sys.exit(1)


if __name__ == "__main__":
    main()
