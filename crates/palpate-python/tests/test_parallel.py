"""Calls after fork, forkserver and spawn, under joblib, dask and in threads: each in a process of its own that must end."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

WORK = """
import concurrent.futures, multiprocessing, sys, warnings
import numpy as np
import palpate

T = np.linspace(0.0, 40.0, 200)
CURVES = np.array([0.2 + 0.1 * (1 + 2 * T) ** -0.25 + 1e-4 * np.sin(k + 30 * T) for k in range(8)])
PROTOCOL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
}

def work(seed):
    # Everything that has threads of its own: fits of many curves, many runs, a fit that takes long, a comparison.
    fits = palpate.fit_many(T, CURVES + 1e-6 * seed, law="latency:5")
    runs = palpate.simulate_many(PROTOCOL, {"specimen.radius": [0.03, 0.035]})
    profile = palpate.fit_hold(T, CURVES[0], intervals="profile")
    compared = palpate.compare(T, CURVES[0], laws=["latency", "maxwell"])
    return fits["equilibrium"].tolist(), runs["force_end_n"].tolist(), profile.parameters["exponent"], compared.law
"""

PROCESSES = """
if __name__ == "__main__":
    warnings.simplefilter("ignore", DeprecationWarning)
    here = [work(seed) for seed in range(4)]
    with multiprocessing.get_context("{way}").Pool(2) as pool:
        assert pool.map(work, range(4)) == here
"""
# The way in which it used to hang: a fork while another thread computes.
FORK_BESIDE = """
if __name__ == "__main__":
    import threading
    warnings.simplefilter("ignore", DeprecationWarning)
    here = [work(seed) for seed in range(2)]
    done = threading.Event()
    def busy():
        while not done.is_set():
            work(0)
    beside = threading.Thread(target=busy)
    beside.start()
    for _ in range(3):
        with multiprocessing.get_context("fork").Pool(2) as pool:
            assert pool.map(work, range(2)) == here
    done.set()
    # Before 3.14 CPython may crash where a thread comes back from native code while the interpreter ends.
    beside.join()
"""
THREADS = """
if __name__ == "__main__":
    here = [work(seed) for seed in range(8)]
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert list(pool.map(work, range(8))) == here
"""
JOBLIB = """
if __name__ == "__main__":
    import joblib
    here = [work(seed) for seed in range(4)]
    for backend in ("loky", "threading", "multiprocessing"):
        warnings.simplefilter("ignore", DeprecationWarning)
        assert joblib.Parallel(2, backend=backend)(joblib.delayed(work)(seed) for seed in range(4)) == here
"""
DASK = """
if __name__ == "__main__":
    import dask
    here = [work(seed) for seed in range(4)]
    for scheduler in ("threads", "processes"):
        with dask.config.set(scheduler=scheduler, num_workers=2):
            assert list(dask.compute(*[dask.delayed(work)(seed) for seed in range(4)])) == here
"""
WAYS = {
    **{way: PROCESSES.format(way=way) for way in ("fork", "forkserver", "spawn")},
    "fork-beside-work": FORK_BESIDE,
    "threads": THREADS,
    "joblib": JOBLIB,
    "dask": DASK,
}


@pytest.mark.skipif(sys.platform == "win32", reason="forks of POSIX")
@pytest.mark.parametrize("way", WAYS)
def test_results_are_those_of_one_call_after_the_other(way: str, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(WORK + WAYS[way], encoding="utf-8")
    ran = subprocess.run([sys.executable, "-W", "error::RuntimeWarning", str(script)], capture_output=True, text=True, timeout=100)
    assert ran.returncode == 0, ran.stderr
