"""Batches, sweeps and fits on the workers of a Dask cluster: of this machine, of Slurm, or of whatever else gives a Dask client.

A batch or a sweep is divided into shards, the same that ``palpate batch --shard 3/40`` runs. Each is one task, which leaves its tables and
a manifest in a folder that all workers share. What is finished is not computed again: a cluster that was ended goes on where it stood, and
the merged table has the same bytes for any number of workers, shards and kills.

Needs ``dask`` and ``distributed``: ``pip install palpate[dask]``.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import palpate
from palpate import _progress
from palpate._fits import fit_many as _fit_many
from palpate._options import Intervals, LawName
from palpate._palpate import _BUILD, BatchResult, OptionError, PalpateError, _checked, _checked_sweep, _forget, _found, _run_slice, _sliced

if TYPE_CHECKING:
    import dask.dataframe as dd
    import pandas
    from distributed import Client, Future

    from palpate._palpate import _Slice, _SlicedFile

#: A shard by its text, and what runs it.
_Task: TypeAlias = tuple[str, Callable[[], None]]

__all__ = ["SETTINGS", "Shards", "batch", "fit_many", "sweep"]

#: Settings of Dask for a cluster whose tasks are shards: processes that compute for a minute need not look at themselves 100 times a second.
#: `dask.config.set(palpate.dask.SETTINGS)` before the cluster is made; the cluster that is made here without a client has them.
SETTINGS = {
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.admin.tick.interval": "500ms",
}

#: How often a shard is tried whose worker ended, beside the tries of the scheduler.
_TRIES = 4
#: How often tasks are looked at, at first and while none ends; how often workers; how long a shard waits that another client is at, and a
#: manifest may be late, s.
_POLL_S, _POLL_AT_MOST_S, _LOOK_S, _LOCKED_S, _LATE_S = 0.02, 0.25, 2.0, 2.0, 30.0
#: How long a cluster of this machine may be without a worker, s.
_WITHOUT_WORKERS_S = 30.0
_AGAIN = "hint: what is finished stays; another call goes on with the rest"
#: Shards of a sweep, if nothing else is stated.
_SWEEP_SHARDS = 64
#: Bytes of a shard in a large batch.
_SHARD_BYTES = 16 << 20
#: Bytes of a shard in a small one.
_SMALL_SHARD_BYTES = 256 << 10


@dataclass(frozen=True)
class Shards:
    """The finished shards of a batch or a sweep: three folders of Parquet files with the same columns each."""

    #: The folder of all.
    folder: Path
    #: How many shards there are.
    count: int
    #: Rows of the table.
    rows: int
    #: Tests of the batch; runs of the sweep.
    tests: int
    #: How many of them have no results.
    failed: int

    @property
    def table(self) -> Path:
        """Folder with the table, a file a shard: ``pandas.read_parquet(shards.table)``."""
        return self.folder / "table"

    @property
    def parameters(self) -> Path:
        """Folder with the table of the parameters of a batch."""
        return self.folder / "parameters"

    @property
    def failures(self) -> Path:
        """Folder with the table of the tests of a batch without rows: ``record``, ``part``, ``message``, ``hint``."""
        return self.folder / "failures"

    def merge(
        self, out: str | os.PathLike[str], *, map: Sequence[str] | None = None, csv_locale: str | None = None
    ) -> BatchResult | tuple[int, int]:
        """One table of all shards: `palpate.merge` of the folder."""
        return palpate.merge([self.folder], out, map=map, csv_locale=csv_locale)


def batch(
    files: Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    client: Client | None = None,
    *,
    shards: int | None = None,
    storage_options: Mapping[str, Any] | None = None,
    test: Any = None,
    columns: Any = None,
    laws: Sequence[LawName] | None = None,
    intervals: Intervals | None = None,
    fit_until_s: float | None = None,
    restart: bool = False,
    progress: bool | None = None,
) -> Shards:
    """Analyse many records on the workers of a Dask cluster, into a folder of shards.

    Parameters
    ----------
    files
        Files, folders with files, or patterns, as for `palpate.batch`; also addresses of fsspec with ``://``, such as
        ``"s3://bucket/curves/*.csv"`` or ``"zip://*.csv::map.zip"``, each of which is fetched by the worker that analyses it.
    out
        Folder of the shards, which all workers share.
    client
        Client of the cluster; if left out, the client at hand, or a cluster of this machine with a worker a processor.
    shards
        How many shards the files make; if left out, as many as the folder has already, or shards of at most 16 MiB of files.
    storage_options
        What fsspec needs besides the addresses.
    test, columns, laws, intervals, fit_until_s, restart
        As for `palpate.batch`.
    progress
        Whether to show a bar of tqdm; if left out, where tqdm is there, standard error is a terminal and it takes a while.

    Returns
    -------
    Shards
        The folders of the tables, with how many tests failed.

    Raises
    ------
    OptionError
        An option that is wrong; workers without palpate, or with another build of it.
    PalpateError
        Shards that could not be finished, with the reason of each. The others are, and another call goes on with those that are missing.

    Examples
    --------
    >>> from distributed import Client, LocalCluster
    >>> with LocalCluster(n_workers=2) as cluster, Client(cluster) as client:  # doctest: +SKIP
    ...     done = palpate.dask.batch(["curves"], "holds", client, test="cell.toml")
    >>> done.merge("holds.parquet")  # doctest: +SKIP
    """
    folder = _folder(out, shards)
    options = {"test": test, "columns": columns, "laws": laws, "intervals": intervals, "fit_until_s": fit_until_s}
    # What is wrong is refused once, before anything is submitted.
    _checked(**options)
    listed = list(_files([files] if isinstance(files, (str, os.PathLike)) else files, dict(storage_options or {})))
    if not listed:
        raise OptionError("files: expected files, found none")
    count = shards or _count_of(folder) or _count_for(listed)
    names = [file[0] for file in listed if not isinstance(file[1], int)] + ([test] if isinstance(test, (str, os.PathLike)) else [])
    here = os.getcwd() if any(not os.path.isabs(name) for name in names) else None

    def tasks() -> Iterator[_Task]:
        for one in _sliced(listed, count):
            own = listed[one[4] : one[4] + one[5]]
            yield f"{one[0]}/{one[1]}", partial(_batch_shard, _BUILD, here, one, own, folder, options)

    return _driven(client, tasks(), count, folder, progress, restart=restart)


def sweep(
    protocol: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str],
    client: Client | None = None,
    *,
    shards: int | None = None,
    restart: bool = False,
    progress: bool | None = None,
) -> Shards:
    """Simulate the runs of a protocol with a table ``[sweep]`` on the workers of a Dask cluster, into a folder of shards.

    Parameters
    ----------
    protocol, restart
        As for `palpate.sweep`.
    out, client, progress
        As for `batch`.
    shards
        How many shards the runs make; if left out, as many as the folder has already, or 64.

    Returns
    -------
    Shards
        The folder of the table, with how many runs were refused.

    Raises
    ------
    OptionError, PalpateError
        As for `batch`; a protocol without a sweep.
    """
    folder = _folder(out, shards)
    count = shards or _count_of(folder) or _SWEEP_SHARDS
    stated = protocol if isinstance(protocol, Mapping) else Path(protocol).resolve()
    _checked_sweep(stated)

    def tasks() -> Iterator[_Task]:
        for number in range(1, count + 1):
            yield f"{number}/{count}", partial(_sweep_shard, _BUILD, stated, folder, f"{number}/{count}")

    return _driven(client, tasks(), count, folder, progress, restart=restart)


def fit_many(
    time_s: Any, signal: Any = None, *, by: str | Sequence[str] | None = None, time: str | None = None, **options: Any
) -> dd.DataFrame:
    """Fit a law to the holds in a collection of Dask, each partition by `palpate.fit_many` on the worker that has it.

    Parameters
    ----------
    time_s, signal
        A `dask.dataframe.DataFrame`, a row a sample, with `by`, `time` and ``signal=`` the names of its columns; or a `dask.array.Array`
        ``signal`` of shape (curves, samples) with ``time_s`` one array for all curves or a Dask array of that shape; or a `dask.bag.Bag`
        of pairs (time_s, signal).
    by, time
        As for `palpate.fit_many`. Rows of one curve are brought together first, unless `by` is the index of the data frame.
    options
        ``law``, ``fixed``, ``bounds`` and all others of `palpate.fit_many`.

    Returns
    -------
    dask.dataframe.DataFrame
        A row a curve with the columns of `palpate.fit_many`, computed when its values are needed. Of an array the index is the number
        of the curve; of a data frame and of a bag there is no column ``curve``.

    Raises
    ------
    OptionError
        As for `palpate.fit_many`; a collection of another kind.
    """
    import dask.array as da
    import dask.bag as db
    import dask.dataframe as dd
    from dask.delayed import delayed

    options = {**options, "progress": False}
    if isinstance(time_s, dd.DataFrame):
        names = [by] if isinstance(by, str) else list(by or ())
        if not names or time is None or not isinstance(signal, str):
            raise OptionError("expected the names of columns beside a data frame: by, time and signal")
        columns = [*names, time, signal]
        is_index = names == [time_s.index.name]
        missing = [name for name in columns if name not in time_s.columns and not (is_index and name == names[0])]
        if missing:
            raise OptionError(f"expected columns {', '.join(columns)}, found no {', '.join(missing)}")
        # A shuffle does not keep the order of rows, in which the times of a curve rise.
        is_together = is_index and time_s.known_divisions
        numbered = time_s if is_together else time_s.assign(**{_ROW: 1})
        together = time_s if is_together else numbered.assign(**{_ROW: numbered[_ROW].cumsum()}).shuffle(on=names)
        labels = time_s._meta_nonempty.reset_index() if is_index else time_s._meta_nonempty
        times, signals = _example_hold()
        example = labels[names].iloc[[0] * len(times)].assign(**{time: times, signal: signals})
        meta = _fit_frame(example, names, time, signal, options).iloc[:0]
        return together.map_partitions(_fit_frame, names, time, signal, options, meta, meta=meta)
    if isinstance(time_s, db.Bag):
        parts = [delayed(_fit_pairs)(part, options) for part in time_s.to_delayed()]
        return dd.from_delayed(parts, meta=_example(options).drop(columns="curve"))
    if not isinstance(signal, da.Array) or signal.ndim != 2:
        kinds = "a dask.dataframe.DataFrame, a dask.bag.Bag, or a signal that is a dask.array.Array of shape (curves, samples)"
        raise OptionError(f"expected {kinds}, found {type(time_s).__name__} and {type(signal).__name__}")
    rows = signal.rechunk({1: -1})  # pyright: ignore[reportArgumentType]
    if any(size != size for size in rows.chunks[0]):
        rows = rows.compute_chunk_sizes()
    signals = rows.to_delayed()[:, 0]
    times = [time_s] * len(signals)
    if isinstance(time_s, da.Array):
        times = list(time_s.rechunk(rows.chunks).to_delayed()[:, 0]) if time_s.ndim == 2 else [delayed(time_s)] * len(signals)
    starts = [sum(rows.chunks[0][:index]) for index in range(len(signals))]
    fit = delayed(_fit_rows)
    parts = [fit(own, block, start, options) for own, block, start in zip(times, signals, starts, strict=True)]
    return dd.from_delayed(parts, meta=_example(options))


# The column of the numbers of rows, from 1.
_ROW = "_palpate_row"


def _example_hold() -> tuple[Any, Any]:
    """A hold that every law can be fitted to."""
    import numpy as np

    times = np.linspace(0.0, 10.0, 64)
    return times, 1.0 + (1.0 + 2.0 * times) ** -0.25


def _example(options: Mapping[str, Any]) -> pandas.DataFrame:
    """The columns of a table of fits, without rows."""
    times, signal = _example_hold()
    return _fit_many([times], [signal], **options).to_pandas().iloc[:0]


def _fit_frame(
    part: pandas.DataFrame, by: list[str], time: str, signal: str, options: Mapping[str, Any], meta: pandas.DataFrame | None = None
) -> pandas.DataFrame:
    if part.empty and meta is not None:
        return meta
    part = part.sort_values(_ROW) if _ROW in part.columns else part
    part = part.reset_index() if by == [part.index.name] else part
    fits = _fit_many(part[[*by, time, signal]], by=by, time=time, signal=signal, **options).to_pandas()
    # Labels tell curves apart, not their number in a partition.
    return fits if "curve" in by else fits.drop(columns="curve")


def _fit_pairs(part: Iterable[tuple[Any, Any]], options: Mapping[str, Any]) -> pandas.DataFrame:
    pairs = list(part)
    fits = _fit_many([time for time, _ in pairs], [signal for _, signal in pairs], **options).to_pandas() if pairs else _example(options)
    # A bag does not know how many pairs are in other partitions.
    return fits.drop(columns="curve")


def _fit_rows(time_s: Any, signal: Any, start: int, options: Mapping[str, Any]) -> pandas.DataFrame:
    fits = _fit_many(time_s, signal, **options).to_pandas()
    return fits.assign(curve=fits["curve"] + start).set_axis(range(start, start + len(fits)), axis=0)


def _files(names: Iterable[str | os.PathLike[str]], storage_options: dict[str, Any]) -> Iterator[_SlicedFile]:
    """Files on disks by their names, others by name, size and what fetches them; in the order of a batch."""
    for name in names:
        if not isinstance(name, (str, os.PathLike)):
            raise OptionError(f"files: expected paths and addresses, found {type(name).__name__}")
        if "://" not in os.fspath(name):
            yield from ((path, None) for path in _found([name]))
            continue
        try:
            import fsspec
        except ImportError:
            raise OptionError(f"{name}: expected fsspec to reach it, found none\nhint: install fsspec") from None
        system, _, paths = fsspec.get_fs_token_paths(name, storage_options=storage_options)
        details = {path: system.info(path) for path in paths}
        found = sorted(path for path, about in details.items() if about["type"] == "file")
        if not found:
            raise OptionError(f"{name}: expected files, found none")
        chain = os.fspath(name).partition("::")[2]
        for path in found:
            own = system.unstrip_protocol(path) + (f"::{chain}" if chain else "")
            yield own, int(details[path]["size"] or 0), partial(_fetched, system, path)


def _fetched(system: Any, path: str) -> bytes:
    return bytes(system.cat_file(path))


def _folder(out: str | os.PathLike[str], shards: int | None) -> Path:
    """The folder of the shards, where it can be one and their number is one."""
    folder = Path(out).resolve()
    if folder.suffix in (".parquet", ".csv") or folder.is_file():
        raise OptionError(f"{folder}: expected a folder for shards, found the name of a file\nhint: name a folder; merge() makes one table of it")
    if shards is not None and not (isinstance(shards, int) and shards >= 1):
        raise OptionError(f"shards: expected a whole number from 1 on, found {shards!r}")
    return folder


def _count_of(folder: Path) -> int | None:
    """How many shards a folder has, where it has shards of one division."""
    counts = {path.stem.partition("-of-")[2] for kind in ("shards/*.json", "*.journal") for path in folder.glob(kind)}
    return int(counts.pop()) if len(counts) == 1 and all(count.isdecimal() for count in counts) else None


def _count_for(files: Sequence[_SlicedFile]) -> int:
    """How many shards files make: it depends on nothing but them, so that another call finds the same."""

    def size(file: _SlicedFile) -> int:
        if isinstance(file[1], int):
            return file[1]
        try:
            return os.stat(file[0]).st_size
        except OSError:
            return 0

    total = sum(map(size, files))
    return max(total // _SHARD_BYTES, min(64, total // _SMALL_SHARD_BYTES)) + 1


def _batch_shard(
    build: str, here: str | None, one: _Slice, files: Sequence[_SlicedFile], folder: Path, options: Mapping[str, Any]
) -> None:
    _check_build(build)
    if here is not None and os.getcwd() != here:
        raise OptionError(
            f"files: expected workers in {here}, found one in {os.getcwd()}\nhint: name the files by absolute paths, or start the workers there"
        )
    _run_slice(one, files, folder, **options)


def _sweep_shard(build: str, protocol: Any, folder: Path, shard: str) -> None:
    _check_build(build)
    palpate.sweep(protocol, folder, shard=shard, threads=1)


def _check_build(build: str) -> None:
    if build != _BUILD:
        raise OptionError(f"expected the same build of palpate everywhere, found {palpate.__version__} of another one on this worker")


@contextmanager
def _connected(client: Client | None) -> Iterator[Client]:
    """The client, that at hand, or one of a cluster of this machine."""
    try:
        import dask.config
        import distributed
    except ImportError:
        raise OptionError("expected distributed, found none\nhint: pip install palpate[dask]") from None
    if client is None:
        try:
            client = distributed.default_client()
        except ValueError:
            processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
            with dask.config.set(SETTINGS):
                cluster = distributed.LocalCluster(n_workers=processors, threads_per_worker=1, dashboard_address=":0")
            with cluster, distributed.Client(cluster) as own:
                yield own
            return
    if client.asynchronous:
        raise OptionError("client: expected one that waits for results, found one with asynchronous=True")
    yield client


def _check_workers(client: Client) -> None:
    """Refuses workers without palpate, or with another build of it, before anything is computed."""

    # A nested function travels as its code: a worker that lacks palpate can run it.
    def build() -> str | None:
        try:
            from palpate._palpate import _BUILD as found
        except ImportError:
            return None
        return found

    builds: dict[str, Any] = client.run(build, on_error="return")  # pyright: ignore[reportAssignmentType]
    without = sorted(worker for worker, found in builds.items() if found is None)
    if without:
        raise OptionError(f"expected palpate on every worker, found none on {_listed(without)}\nhint: install palpate {palpate.__version__} there")
    # A worker that has just ended gives an error; the one in its place is heard with its first shard.
    others = sorted(worker for worker, found in builds.items() if isinstance(found, str) and found != _BUILD)
    if others:
        raise OptionError(
            f"expected the same build of palpate everywhere, found another one on {_listed(others)}\nhint: install palpate {palpate.__version__} there"
        )


def _listed(names: Sequence[str], most: int = 5) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def _driven(client: Client | None, tasks: Iterator[_Task], count: int, folder: Path, progress: bool | None, *, restart: bool) -> Shards:
    """Runs all tasks, a bounded number of them with the scheduler at a time; one that fails stops no other.

    Nothing is gathered from workers, which may end behind a finished task: the manifest of a shard says what came of it. A restart forgets
    each shard once, here: a worker that ended with a shard is to go on from what it left.
    """
    with _connected(client) as client, _progress.bar(progress, count, "shard") as tell:
        from distributed import KilledWorker, LocalCluster

        _check_workers(client)
        running: dict[Future, _Try] = {}
        waiting: list[_Try] = []
        refused: list[str] = []
        done: list[str] = []
        # A cluster of this machine starts no worker anew once its nannies have ended; others may have workers that wait in a queue.
        limit_s = _WITHOUT_WORKERS_S if isinstance(client.cluster, LocalCluster) else float("inf")
        looked = with_workers = time.monotonic()
        window, poll_s = _window(client), _POLL_S
        try:
            while len(done) + len(refused) < count:
                now = time.monotonic()
                if now - looked > _LOOK_S:
                    looked, window = now, _window(client)
                    with_workers = now if window else with_workers
                    if now - with_workers > limit_s:
                        shards = ", ".join(sorted(one.shard for one in running.values()))
                        raise PalpateError(f"expected workers, found none for {limit_s:.0f} s; shards that were running: {shards}\n{_AGAIN}")
                ready = [one for one in waiting if one.not_before <= now]
                waiting = [one for one in waiting if one.not_before > now]
                while len(running) + len(ready) < max(window, 1) and (task := next(tasks, None)) is not None:
                    ready.append(_Try(*task, forget=restart))
                for one in ready:
                    try:
                        one = one.anew(folder)
                    except BlockingIOError:
                        waiting.append(replace(one, not_before=now + _LOCKED_S))
                        continue
                    running[client.submit(one.work, pure=False, key=f"palpate-{one.shard}-{os.urandom(4).hex()}")] = one
                ended = [future for future in running if future.status != "pending"]
                if not ended:
                    time.sleep(poll_s)
                poll_s = _POLL_S if ended else min(1.2 * poll_s, _POLL_AT_MOST_S)
                for future in ended:
                    one = running.pop(future)
                    error = _error(future)
                    if isinstance(error, KilledWorker) and one.tries < _TRIES:
                        waiting.append(replace(one, tries=one.tries + 1))
                    elif isinstance(error, BlockingIOError):
                        # Another client is at it; once it has finished there is nothing left to do.
                        waiting.append(replace(one, not_before=now + _LOCKED_S))
                    elif isinstance(error, KilledWorker):
                        refused.append(f"{one.shard}: every worker that ran it ended, at last {error.last_worker}")
                    elif error is not None:
                        refused.append(f"{one.shard}: {str(error) or type(error).__name__}")
                    else:
                        done.append(one.shard)
                if tell is not None:
                    tell(len(done) + len(refused))
        finally:
            if client.status == "running":
                client.cancel(list(running))
    if refused:
        reasons = "\n".join(f"  {reason}" for reason in refused[:10]) + (f"\n  and {len(refused) - 10} more" if len(refused) > 10 else "")
        raise PalpateError(f"{len(refused)} of {count} shards could not be finished:\n{reasons}\n{_AGAIN}")
    found = [_manifest(folder, shard) for shard in done]
    if len({(one["settings"], one["plan_sha256"]) for one in found}) > 1:
        raise PalpateError(
            f"{folder}: expected shards of one call, found those of another one with other files or options, which wrote here meanwhile\n"
            "hint: give each its own folder, and call again"
        )
    rows, tests, failed = (sum(int(one[name]) for one in found) for name in ("rows", "tests", "failed"))
    return Shards(folder, count, rows, tests, failed)


@dataclass(frozen=True)
class _Try:
    """A shard that is to be run, and how often it was."""

    shard: str
    work: Callable[[], None]
    tries: int = 1
    #: Of the clock that only rises, s.
    not_before: float = 0.0
    #: Whether what there is of it is to be forgotten first.
    forget: bool = False

    def anew(self, folder: Path) -> _Try:
        """The same, once what there is of it is forgotten where it should be."""
        if self.forget:
            _forget(folder, self.shard)
        return replace(self, forget=False)


def _window(client: Client) -> int:
    """How many shards are with the scheduler at a time; none where there is no worker."""
    if client.status != "running":
        raise PalpateError(f"expected a connection to the scheduler, found it {client.status}\n{_AGAIN}")
    threads: dict[str, int] = client.nthreads()  # pyright: ignore[reportAssignmentType]
    return 2 * sum(threads.values()) + 8 if threads else 0


def _error(future: Future) -> BaseException | None:
    """Why a task that ended has no result."""
    if future.status == "finished":
        return None
    if future.status == "error":
        error: BaseException | None = future.exception()  # pyright: ignore[reportAssignmentType]
        return error
    return PalpateError("the scheduler gave it up")


def _manifest(folder: Path, shard: str) -> Mapping[str, Any]:
    """What a finished shard says of itself, which a file system of a network may show some seconds late."""
    path = folder / "shards" / f"{shard.replace('/', '-of-')}.json"
    end = time.monotonic() + _LATE_S
    while not path.exists() and time.monotonic() < end:
        time.sleep(_POLL_S)
    if not path.exists():
        raise PalpateError(f"{path}: expected the manifest of a finished shard, found none\nhint: all workers need the same folder under this name")
    return dict(json.loads(path.read_text()))
