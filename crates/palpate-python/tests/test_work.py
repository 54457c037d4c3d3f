"""Long work: beside other threads, ended by Ctrl-C, without leaks."""

from __future__ import annotations

import concurrent.futures
import os
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import palpate
import pytest
from conftest import relaxation


def test_threads_fit_side_by_side() -> None:
    curves = [relaxation(noise=1e-4, seed=seed) for seed in range(16)]
    alone = [palpate.fit_hold(t, y) for t, y in curves]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda curve: palpate.fit_hold(*curve), curves)) == alone


def test_other_threads_run_meanwhile() -> None:
    t, _ = relaxation(1000)
    rows = np.array([relaxation(1000, 1e-4, seed)[1] for seed in range(300)])
    count, done = 0, threading.Event()

    def counts() -> None:
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counts)
    thread.start()
    before = time.perf_counter()
    palpate.fit_many(t, rows, law="prony:3")
    took = time.perf_counter() - before
    done.set()
    thread.join()
    assert count > 20 * took, f"{count} turns in {took} s"


FITS = """
t = np.linspace(0, 60, 20000)
rows = np.array([1 + palpate.laws.latency(t, 0, 1, 2, n) + 1e-3 * np.sin(7 * n * t) for n in np.linspace(2, 8, 60)])
work = lambda: palpate.fit_many(t, rows, law="prony:4")
"""

CALIBRATIONS = """
t = np.linspace(0, 20, 1000)
record = palpate.Record.from_arrays(
    time_s=t, displacement_m=np.minimum(t, 1) * 5e-3, force_n=2 * np.minimum(t, 1) + 0.01 * np.sin(50 * t)
)
work = lambda: record.calibrate(law="prony:4", test={"specimen": {"shape": "ball", "radius": "35 mm"}})
"""

ANALYSES = """
t = np.linspace(0, 400, 20000)
depth = 1e-3 * np.minimum(t % 20, 1) + 1e-3 * (t // 20)
force = 400 * depth * (1 + np.exp(-(t % 20))) + 0.01 * np.sin(50 * t)
record = palpate.Record.from_arrays(time_s=t, displacement_m=depth, force_n=force)
work = lambda: record.analyze(test={"specimen": {"shape": "ball", "radius": "35 mm"}})
"""

SEARCHES = """
t = np.linspace(0, 60, 200_000)
y = 1 + palpate.laws.latency(t, 0, 1, 2, 5) + 1e-3 * np.sin(37 * t)
work = lambda: palpate.fit_hold(t, y, law="prony:4", loss="huber")
"""

PHASES = """
t = np.linspace(0, 400, 500_000)
depth = 1e-3 * np.minimum(t % 20, 1) + 1e-3 * (t // 20)
force = 400 * depth * (1 + np.exp(-(t % 20))) + np.random.default_rng(1).normal(0, 0.01, len(t))
record = palpate.Record.from_arrays(time_s=t, displacement_m=depth, force_n=force)
work = record.segments
"""

# It was an OSError where the writer of Arrow heard it.
PICKLES = """
import pickle
t = np.linspace(0, 20_000, 400_000)
depth = 1e-3 * np.minimum(t % 20, 1)
table = palpate.Observer(slip_force_n=1.0).feed_many(t, 400 * depth * (1 + np.exp(-(t % 20))), depth)
work = lambda: pickle.dumps(table)
"""

INTERRUPTED = """
import numpy as np, palpate, threading, time, os, signal
signal.signal(signal.SIGINT, signal.default_int_handler)
{work}
def interrupt():
    time.sleep(0.5)
    global at
    at = time.perf_counter()
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    while True:
        work()
except KeyboardInterrupt:
    heard = time.perf_counter() - at
    time.sleep(1)
    used = time.process_time()
    time.sleep(0.5)
    print(heard, time.process_time() - used, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize("work", [FITS, SEARCHES, PHASES, CALIBRATIONS, ANALYSES, PICKLES], ids=["fits", "searches", "phases", "calibrations", "analyses", "pickles"])
def test_ctrl_c_ends_the_work(work: str) -> None:
    before = signal.getsignal(signal.SIGINT)
    script = INTERRUPTED.format(work=work)
    reported = subprocess.run([sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, timeout=120, check=True)
    heard, busy = map(float, reported.stdout.split())
    assert heard < 0.2 * float(os.environ.get("PALPATE_PATIENCE", "3"))
    # A second later no processor is busy with it.
    assert busy < 0.1, busy
    assert signal.getsignal(signal.SIGINT) is before


def test_ten_thousand_calls_leak_nothing() -> None:
    t, y = relaxation(50)

    def calls(count: int) -> int:
        for _ in range(count):
            fit = palpate.fit_hold(t, y, law="standard-linear-solid")
            fit.predict(t, interval=0.9)
            fit.estimates["time_constant_s"].interval
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    first = calls(1000)
    assert calls(10_000) - first < 4096, "more than 4 MB"
