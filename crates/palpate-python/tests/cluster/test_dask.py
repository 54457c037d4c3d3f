"""Batches, sweeps and fits on a Dask cluster of this machine: the bytes of the plain call, whatever workers do."""

from __future__ import annotations

import os
import signal
import time
import zipfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pandas
import palpate.dask
import pytest
from distributed import Client, LocalCluster, WorkerPlugin
from palpate._palpate import OptionError, PalpateError

pytestmark = pytest.mark.filterwarnings("default")

PROTOCOL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    "step": [{"to": "5 mm", "rate": "500 mm/min", "hold": "10 s"}],
    "sweep": {"law.exponent": [3, 5], "specimen.radius": "linear 30..40 mm, 100"},
}


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        yield client


def hold(seconds: float) -> str:
    """Displacement and force of a ramp of 1 s and a hold."""
    times = np.arange(0.0, 1.0 + seconds, 0.05)
    force = np.where(times < 1.0, 2.0 * times, 1.0 + (1.0 + 4.0 * np.maximum(times - 1.0, 0.0)) ** -0.25)
    rows = "".join(f"{t:.3f},{min(t, 1.0):.5f},{f:.6f}\n" for t, f in zip(times, force, strict=True))
    return "time_s,displacement_mm,force_n\n" + rows


@pytest.fixture
def curves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "curves"
    folder.mkdir()
    for index in range(8):
        (folder / f"c{index}.csv").write_text(hold(4.0 + index))
    (folder / "broken.csv").write_text("time,force\n1,x\n")
    with zipfile.ZipFile(folder / "map.zip", "w") as archive:
        for index in range(5):
            archive.writestr(f"m{index}.csv", hold(6.0 + index))
    return folder


def test_a_batch_is_that_of_the_plain_call(client: Client, curves: Path, tmp_path: Path) -> None:
    whole = palpate.batch([curves], tmp_path / "whole.parquet")
    done = palpate.dask.batch([curves], tmp_path / "holds", client, shards=7)
    assert (done.count, done.tests, done.failed, done.rows) == (7, 14, 1, whole.rows)
    assert done.merge(tmp_path / "merged.parquet") == whole
    assert (tmp_path / "merged.parquet").read_bytes() == (tmp_path / "whole.parquet").read_bytes()
    # The folders are datasets, and failures are a table.
    assert len(pandas.read_parquet(done.table)) == len(pandas.read_parquet(tmp_path / "whole.parquet"))
    failures = pandas.read_parquet(done.failures)
    assert [Path(path).name for path in failures.record] == ["broken.csv"] and "found `x`" in failures.message[0]
    # Nothing is computed again, and the folder knows its division.
    written = {path: path.stat().st_mtime_ns for path in done.table.iterdir()}
    assert palpate.dask.batch([curves], tmp_path / "holds", client) == done
    assert {path: path.stat().st_mtime_ns for path in done.table.iterdir()} == written


def test_a_sweep_is_that_of_the_plain_call(client: Client, tmp_path: Path) -> None:
    palpate.sweep(PROTOCOL, tmp_path / "whole.parquet")
    done = palpate.dask.sweep(PROTOCOL, tmp_path / "runs", client, shards=5)
    assert (done.count, done.tests, done.failed) == (5, 200, 0)
    assert done.merge(tmp_path / "merged.parquet") == (200, 0)
    assert (tmp_path / "merged.parquet").read_bytes() == (tmp_path / "whole.parquet").read_bytes()


def test_files_of_fsspec_are_fetched_by_workers(client: Client, curves: Path, tmp_path: Path) -> None:
    done = palpate.dask.batch([f"zip://*.csv::{curves}/map.zip", curves / "c0.csv"], tmp_path / "holds", client, shards=3)
    assert (done.tests, done.failed) == (6, 0)
    table = pandas.read_parquet(done.table)
    assert table.record.nunique() == 6 and table.record.str.startswith("zip://m0.csv::").any()
    with pytest.raises(OptionError, match="expected files, found none"):
        palpate.dask.batch([f"zip://*.txt::{curves}/map.zip"], tmp_path / "none", client)


def test_a_killed_worker_loses_and_doubles_nothing(curves: Path, tmp_path: Path) -> None:
    palpate.batch([curves], tmp_path / "whole.parquet")
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        killed = 0

        def kill(after_s: float) -> None:
            time.sleep(after_s)
            os.kill(next(iter(cluster.workers.values())).pid, signal.SIGKILL)  # pyright: ignore[reportAttributeAccessIssue]

        from threading import Thread

        for after_s in (0.05, 0.2):
            killer = Thread(target=kill, args=(after_s,))
            killer.start()
            done = palpate.dask.batch([curves], tmp_path / "holds", client, shards=9, restart=killed == 0)
            killer.join()
            killed += 1
    done.merge(tmp_path / "merged.parquet")
    assert (tmp_path / "merged.parquet").read_bytes() == (tmp_path / "whole.parquet").read_bytes()


def _poison() -> bytes:
    os.kill(os.getpid(), signal.SIGKILL)
    return b""


def test_a_file_that_ends_its_process_three_times_is_a_failure(curves: Path, tmp_path: Path) -> None:
    """The file is fetched by a function that kills the worker; its neighbours in the shard are analysed all the same.

    A restart once forgot with each try what the one before it had noted, until no worker was left.
    """
    from palpate import _palpate, dask as own

    files = [(path, None) for path in sorted(curves.glob("c*.csv"))]
    files.insert(3, ("poison.csv", 1000, _poison))  # type: ignore[arg-type]
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        slices = _palpate._sliced(files, 2)
        tasks = (
            (f"{one[0]}/{one[1]}", partial(own._batch_shard, _palpate._BUILD, None, one, files[one[4] : one[4] + one[5]], tmp_path / "holds", {}))
            for one in slices
        )
        done = own._driven(client, tasks, 2, tmp_path / "holds", False, restart=True)
    assert (done.tests, done.failed) == (9, 1)
    failures = pandas.read_parquet(done.failures)
    assert failures.record.tolist() == ["poison.csv"]
    assert "the process ended each of 3 times" in failures.message[0]


def test_workers_of_another_build_and_two_clients_are_refused(client: Client, curves: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("palpate.dask._BUILD", "another")
    with pytest.raises(OptionError, match="expected the same build of palpate everywhere, found another one on tcp://"):
        palpate.dask.batch([curves], tmp_path / "holds", client)
    assert not (tmp_path / "holds").exists()
    monkeypatch.undo()
    # Another client is at work in the same folder for a second.
    import fcntl
    from threading import Timer

    journal = tmp_path / "holds" / "1-of-2.journal"
    journal.mkdir(parents=True)
    with (journal / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        Timer(1.0, fcntl.flock, (lock, fcntl.LOCK_UN)).start()
        assert palpate.dask.batch([curves], tmp_path / "holds", client, shards=2).tests == 14
        fcntl.flock(lock, fcntl.LOCK_EX)
        Timer(1.0, fcntl.flock, (lock, fcntl.LOCK_UN)).start()
        assert palpate.dask.batch([curves], tmp_path / "holds", client, shards=2, restart=True).tests == 14


def test_shards_that_another_client_wrote_meanwhile_with_other_options_are_refused(client: Client, curves: Path, tmp_path: Path) -> None:
    """Both calls once came back with a result, of tables of which a part was the other's."""
    from palpate import _palpate, dask as own

    files = [(path, None) for path in sorted(curves.glob("c*.csv"))]
    tasks = (
        (f"{one[0]}/2", partial(own._batch_shard, _palpate._BUILD, None, one, files[one[4] : one[4] + one[5]], tmp_path / "holds", options))
        for one, options in zip(_palpate._sliced(files, 2), ({}, {"fit_until_s": 3.0}), strict=True)
    )
    with pytest.raises(PalpateError, match="expected shards of one call, found those of another one with other files or options"):
        own._driven(client, tasks, 2, tmp_path / "holds", False, restart=False)


def test_a_protocol_without_a_sweep_is_refused_before_anything_runs(client: Client, tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"expected the table \[sweep\]"):
        palpate.dask.sweep({name: value for name, value in PROTOCOL.items() if name != "sweep"}, tmp_path / "runs", client)
    assert not (tmp_path / "runs").exists()


def test_what_is_wrong_is_refused_once_before_anything_runs(client: Client, curves: Path, tmp_path: Path) -> None:
    wrong: list[tuple[dict[str, object], str]] = [
        ({"shards": 0}, "shards: expected a whole number from 1 on, found 0"),
        ({"laws": ["newton"]}, "newton"),
        ({"test": {"specimen": {"shape": "cube"}}}, "shape"),
        ({"out": tmp_path / "holds.parquet"}, "expected a folder for shards"),
        ({"files": []}, "files: expected files, found none"),
        ({"files": [tmp_path / "none.csv"]}, "no such file"),
    ]
    for given, expected in wrong:
        arguments: dict[str, object] = {"files": [curves], "out": tmp_path / "holds", **given}
        with pytest.raises((OptionError, OSError), match=expected):
            palpate.dask.batch(client=client, **arguments)  # type: ignore[arg-type]
    assert not (tmp_path / "holds").exists()


class _EndsWorkers(WorkerPlugin):  # type: ignore[misc]
    """Ends the process of a worker whenever it runs shard 2."""

    def setup(self, worker: object) -> None:
        from palpate import dask as own

        run = vars(own)["_run_slice"]

        def poisoned(one: tuple[int, ...], *arguments: object, **options: object) -> None:
            if one[0] == 2:
                os.kill(os.getpid(), signal.SIGKILL)
            run(one, *arguments, **options)

        own.__dict__["_run_slice"] = poisoned


def test_a_shard_that_ends_every_worker_is_named_and_the_call_comes_back(curves: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It once hung where all workers were gone, or blamed another shard whose worker had ended behind it."""
    monkeypatch.setattr("palpate.dask._TRIES", 1)
    monkeypatch.setattr("palpate.dask._WITHOUT_WORKERS_S", 5.0)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        client.register_plugin(_EndsWorkers())
        with pytest.raises(PalpateError, match="2/4"):
            palpate.dask.batch([curves], tmp_path / "holds", client, shards=4)
    assert not (tmp_path / "holds/shards/2-of-4.json").exists()


def test_collections_are_fitted_by_partitions(client: Client) -> None:
    import dask.config
    import dask.array as da
    import dask.bag as db
    import dask.dataframe as dd

    times = np.linspace(0.0, 10.0, 80)
    signals = np.array([1.0 + (1.0 + (index % 5 + 1) * times) ** -0.25 for index in range(40)])
    expected = palpate.fit_many(times, signals, law="latency:5").to_pandas()
    assert expected.pop("error").isna().all()

    def values(found: pandas.DataFrame) -> pandas.DataFrame:
        # Dask has texts of a type of its own.
        assert found.pop("error").isna().all()
        return found

    array = da.from_array(signals, chunks=(11, 30))  # pyright: ignore[reportArgumentType]
    found = palpate.dask.fit_many(times, array, law="latency:5").compute()
    pandas.testing.assert_frame_equal(values(found), expected, check_dtype=False)
    pairs = db.from_sequence([(times, signal) for signal in signals], npartitions=3)
    found = palpate.dask.fit_many(pairs, law="latency:5").compute().reset_index(drop=True)
    pandas.testing.assert_frame_equal(values(found), expected.drop(columns="curve"), check_dtype=False)
    long = pandas.DataFrame({"cell": np.repeat([f"c{index:02}" for index in range(40)], 80), "t": np.tile(times, 40), "f": signals.ravel()})
    frame = dd.from_pandas(long, npartitions=7)
    # The shuffle of threads, over the disk, does not keep the order of rows.
    for method, scheduler in (("p2p", client), ("disk", "threads")):
        with dask.config.set({"dataframe.shuffle.method": method}):
            found = palpate.dask.fit_many(frame, "f", by="cell", time="t", law="latency:5").compute(scheduler=scheduler)
        found = found.sort_values("cell").reset_index(drop=True)
        pandas.testing.assert_frame_equal(values(found).drop(columns="cell"), expected.drop(columns="curve"), check_dtype=False)
    for wrong in ({"by": "cell", "time": "x"}, {"time": "t"}):
        with pytest.raises(OptionError, match="expected"):
            palpate.dask.fit_many(frame, "f", **wrong)
    with pytest.raises(OptionError, match="expected a dask.dataframe.DataFrame"):
        palpate.dask.fit_many([1.0], [2.0])


def test_arrays_that_are_not_aligned_are_fitted() -> None:
    """Arrays that come from a worker are, at times, at odd addresses of memory."""
    times = np.linspace(0.0, 10.0, 80)
    signal = 1.0 + (1.0 + 2.0 * times) ** -0.25
    raw = np.frombuffer(b"\0" + signal.tobytes(), dtype=np.uint8)[1:].view(np.float64)
    assert not raw.flags.aligned
    assert palpate.fit_many(times, raw.reshape(1, -1))["exponent"][0] == palpate.fit_many(times, signal.reshape(1, -1))["exponent"][0]
